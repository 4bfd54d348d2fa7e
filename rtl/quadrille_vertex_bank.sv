// SPDX-License-Identifier: Apache-2.0
`include "quadrille_types.svh"
// What a pixel needs to know of its quad, by slot: written while it is offered id, k_eff (k, or W without
// perspective), W, Z, attributes as significand numbers with port exponents, bases, depth limits; when the walk takes
// the quad squared lengths and class.
//
// Each is read by the slot that the pipeline's register has there. Reads of squared lengths, for interpolation and of
// bases take two clocks, the others one. Not reset.
module quadrille_vertex_bank #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS, PE = quadrille_pkg::PORT_EXP_BITS,
    localparam int N = quadrille_pkg::ATTRIBUTE_SLOTS, AP = quadrille_pkg::ATTR_PORT_BITS,
    localparam int AO = quadrille_pkg::ATTR_OUT_BITS, DB = quadrille_pkg::DEPTH_BITS,
    localparam int LIMITS = quadrille_pkg::DEPTH_LIMIT_BITS, TERMS = quadrille_pkg::BLEND_TERMS,
    localparam int ID = quadrille_pkg::QUAD_ID_BITS, LENGTH2 = quadrille_pkg::LENGTH2_BITS,
    localparam int SLOT = quadrille_pkg::QUAD_SLOTS_LOG2, SETS = 3 + N
) (
    input logic clk_i,
    input logic [quadrille_pkg::STATE_BITS-1:0] state_i,
    // Written
    input logic offer_i,
    input logic [SLOT-1:0] start_slot_i,
    input logic plane_i,
    input logic [quadrille_pkg::QUAD_BITS-1:0] quad_i,
    input logic [LIMITS-1:0] limits_i,
    // Written at take
    input logic take_i,
    input logic [quadrille_pkg::SETUP_BITS-1:0] setup_i,
    // Read: blend has term sets k_eff, W, Z of four vertices, b0, b1, ... of v1, v2, v3
    input logic [quadrille_pkg::READS_BITS-1:0] reads_i,
    output logic [quadrille_pkg::TERMS_BITS-1:0] terms_o,
    output logic norm_plane_o,  // a clock earlier: the weights are areas
    output logic [SETS-1:0] sum_active_o  // terms of k, W, Z and attributes that are not held at 0
);
  localparam int SLOTS = 1 << SLOT;
  `QUADRILLE_IN(`QUADRILLE_STATE_T, state)
  `QUADRILLE_IN(`QUADRILLE_QUAD_T, quad)
  `QUADRILLE_IN(`QUADRILLE_SETUP_T, setup)
  `QUADRILLE_IN(`QUADRILLE_READS_T, reads)
  logic [6*LENGTH2-1:0] length2;
  logic norm_plane, output_hull, output_homogeneous;
  logic [3:0] product_k_neg;
  logic [4*PE-1:0] product_k_exp, override_k_exp;
  logic [4*S-1:0] product_k_sig, override_k_sig;
  logic [TERMS-1:0] blend_neg;
  logic [TERMS*PE-1:0] blend_exp;
  logic [TERMS*S-1:0] blend_sig;
  logic [N*AO-1:0] base_attr;
  logic [DB:0] base_depth;
  logic [LIMITS-1:0] base_limits;
  logic [quadrille_pkg::QUAD_ID_BITS-1:0] output_id;
  assign terms_o = {length2, norm_plane, product_k_neg, product_k_exp, product_k_sig, override_k_exp, override_k_sig,
      blend_neg, blend_exp, blend_sig, base_attr, base_depth, base_limits, output_id, output_hull, output_homogeneous};

  // k_eff divides the attributes; W divides Z and says, of a quad whose hull holds the eye, what is behind it.
  logic hold, blend_hull;
  assign hold = state.skip[4];
  assign sum_active_o[0] = !hold || state.attributes != '0;
  assign sum_active_o[1] = !hold || state.depth || blend_hull;
  assign sum_active_o[2] = !hold || state.depth;

  for (genvar g = 3; g < SETS; g++) begin : gen_active
    assign sum_active_o[g] = !hold || state.attributes > 4'(g - 3);
  end

  // k_eff, which is read three times, in a small memory per vertex; the other term sets, read once for interpolation,
  // in one word.
  localparam int WORD = 1 + PE + S, BLEND = (TERMS - 4) * WORD;
  // Block RAM: a slot that a pixel reads is in use, so it is never the one that is written (asserted).
  logic [BLEND-1:0] write_blend, blend_word;
  quadrille_memory #(.WIDTH(BLEND), .DEPTH(SLOTS), .BLOCK(1)) u_blend (
      .clk_i, .write_i(offer_i), .write_place_i(start_slot_i), .write_data_i(write_blend), .read_i(1'b1),
      .read_place_i(reads.blend), .clear_i(1'b0), .data_o(blend_word)
  );

  for (genvar v = 0; v < 4; v++) begin : gen_vertex
    logic k_neg;
    logic [PE-1:0] k_exp;
    logic [S-1:0] k_sig;
    assign k_neg = state.perspective ? 1'b0 : quad.w_neg[v];
    assign k_exp = state.perspective ? quad.k_exp[v*PE+:PE] : quad.w_exp[v*PE+:PE];
    assign k_sig = state.perspective ? quad.k_sig[v*S+:S] : quad.w_sig[v*S+:S];

    // An attribute has no term of vertex 0.
    for (genvar t = 0; t < ((v == 0) ? 3 : SETS); t++) begin : gen_term
      localparam int PLACE = (t < 3) ? 4 * t + v : 12 + 3 * (t - 3) + v - 1;
      logic [WORD-1:0] read_word;

      // Sums that the fragment does not depend on are those of zeros, by the registers' reset: neither their products
      // nor what follows from them switches.
      always_ff @(posedge clk_i) begin
        blend_neg[PLACE] <= read_word[WORD-1];
        blend_exp[PLACE*PE+:PE] <= read_word[S+:PE];
        blend_sig[PLACE*S+:S] <= read_word[0+:S];
        if (!sum_active_o[t]) begin
          blend_neg[PLACE] <= 1'b0;
          blend_exp[PLACE*PE+:PE] <= '0;
          blend_sig[PLACE*S+:S] <= '0;
        end
      end

      if (t == 0) begin : gen_k
        // The overrides need the magnitude only.
        quadrille_memory #(.WIDTH(WORD), .DEPTH(SLOTS)) u_k (
            .clk_i, .write_i(offer_i), .write_place_i(start_slot_i), .write_data_i({k_neg, k_exp, k_sig}),
            .read_i(1'b1), .read_place_i(reads.blend), .clear_i(1'b0), .data_o(read_word)
        );
        quadrille_memory #(.WIDTH(WORD), .DEPTH(SLOTS)) u_product_k (
            .clk_i, .write_i(offer_i), .write_place_i(start_slot_i), .write_data_i({k_neg, k_exp, k_sig}),
            .read_i(1'b1), .read_place_i(reads.product), .clear_i(1'b0),
            .data_o({product_k_neg[v], product_k_exp[v*PE+:PE], product_k_sig[v*S+:S]})
        );
        quadrille_memory #(.WIDTH(WORD - 1), .DEPTH(SLOTS)) u_override_k (
            .clk_i, .write_i(offer_i), .write_place_i(start_slot_i), .write_data_i({k_exp, k_sig}), .read_i(1'b1),
            .read_place_i(reads.overrides), .clear_i(1'b0), .data_o({override_k_exp[v*PE+:PE], override_k_sig[v*S+:S]})
        );
      end else begin : gen_blend
        localparam int AT = (PLACE - 4) * WORD;
        assign read_word = blend_word[AT+:WORD];

        if (t == 1) begin : gen_w
          assign write_blend[AT+:WORD] = {quad.w_neg[v], quad.w_exp[v*PE+:PE], quad.w_sig[v*S+:S]};
        end else if (t == 2) begin : gen_z
          assign write_blend[AT+:WORD] = {quad.z_neg[v], quad.z_exp[v*PE+:PE], quad.z_sig[v*S+:S]};
        end else begin : gen_b
          assign write_blend[AT+:WORD] = quad.attr[((v-1)*N+t-3)*AP+:AP];
        end
      end
    end
  end

  // Block RAM as u_blend, and a memory of its own, for it is read later.
  localparam int BASE = N * AO + DB + 1 + LIMITS;
  logic [BASE-1:0] base_word;
  quadrille_memory #(.WIDTH(BASE), .DEPTH(SLOTS), .BLOCK(1)) u_base (
      .clk_i, .write_i(offer_i), .write_place_i(start_slot_i),
      .write_data_i({quad.base_attr, quad.base_depth, limits_i}), .read_i(1'b1), .read_place_i(reads.base),
      .clear_i(1'b0), .data_o(base_word)
  );

  logic [LIMITS-1:0] limits_q;

  always_ff @(posedge clk_i) begin
    {base_attr, base_depth, limits_q} <= base_word;
    base_limits <= limits_q;  // used a clock after the bases
  end

  quadrille_memory #(.WIDTH(ID), .DEPTH(SLOTS)) u_id (
      .clk_i, .write_i(offer_i), .write_place_i(start_slot_i), .write_data_i(quad.id), .read_i(1'b1),
      .read_place_i(reads.outputs), .clear_i(1'b0), .data_o(output_id)
  );

  if (quadrille_pkg::PLANE_QUADS != 0) begin : gen_plane
    logic [SLOTS-1:0] plane_q;

    always_ff @(posedge clk_i) if (offer_i) plane_q[start_slot_i] <= plane_i;

    always_ff @(posedge clk_i) norm_plane <= plane_q[reads.norm];

    assign norm_plane_o = plane_q[reads.norm];
  end else begin : gen_no_plane
    logic unused_plane;
    assign unused_plane = ^{plane_i, reads.norm};
    assign norm_plane = 1'b0;
    assign norm_plane_o = 1'b0;
  end

  logic [6*LENGTH2-1:0] length2_word;
  quadrille_memory #(.WIDTH(6 * LENGTH2), .DEPTH(SLOTS), .BLOCK(1)) u_length2 (
      .clk_i, .write_i(take_i), .write_place_i(setup.slot), .write_data_i(setup.length2), .read_i(1'b1),
      .read_place_i(reads.length2), .clear_i(1'b0), .data_o(length2_word)
  );

  logic [SLOTS-1:0] hull_q, homogeneous_q;  // a bit a slot: registers

  always_ff @(posedge clk_i) begin
    if (take_i) hull_q[setup.slot] <= setup.hull;
    if (take_i) homogeneous_q[setup.slot] <= setup.homogeneous;
    length2 <= length2_word;
    blend_hull <= hull_q[reads.blend];
    {output_hull, output_homogeneous} <= {hull_q[reads.outputs], homogeneous_q[reads.outputs]};
  end
endmodule
