// SPDX-License-Identifier: Apache-2.0
`include "quadrille_assert.svh"

// The quad slots: allocation, and everything that a pixel needs to know about its quad, read by slot index.
//
// Two banks. Vertex bank, written at start: id, k_eff (k, or W without perspective), W, Z, b as significand numbers with port
// exponents, bases and depth limits. Function bank, written at take: gx, gy and tie signs of the linear functions, squared lengths, visibility, hull,
// homogeneous.
// Reads of the front end, of squared lengths, for interpolation and of bases end in registers, the pixel pipeline's others are combinational; a slot lives from start until the end beat leaves the pipeline. Not reset, except the pointers.
module quadrille_quad_slots #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int PE = quadrille_pkg::PORT_EXP_BITS,
    localparam int N = quadrille_pkg::ATTRIBUTE_SLOTS,
    localparam int AP = quadrille_pkg::ATTR_PORT_BITS,
    localparam int AO = quadrille_pkg::ATTR_OUT_BITS,
    localparam int DB = quadrille_pkg::DEPTH_BITS,
    localparam int LIMITS = quadrille_pkg::DEPTH_LIMIT_BITS,
    localparam int TERMS = quadrille_pkg::BLEND_TERMS,
    localparam int ID = quadrille_pkg::QUAD_ID_BITS,
    localparam int GRAD = quadrille_pkg::GRAD_BITS,
    localparam int LENGTH2 = quadrille_pkg::LENGTH2_BITS,
    localparam int SLOT = quadrille_pkg::QUAD_SLOTS_LOG2
) (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    // Allocation
    input logic start_i,
    input logic release_i,  // the quad's end beat is in the pipeline's last register, two clocks behind its slot's at output_slot_i
    input logic drop_i,  // a quad that setup leaves out
    input logic [SLOT-1:0] drop_slot_i,
    output logic [SLOT-1:0] alloc_o,
    output logic available_o,
    output logic busy_o,
    // Vertex bank, written at start
    input logic perspective_i,
    input logic plane_i,
    input logic [ID-1:0] id_i,
    input logic [3:0] w_neg_i,
    input logic [4*PE-1:0] w_exp_i,
    input logic [4*S-1:0] w_sig_i,
    input logic [4*PE-1:0] k_exp_i,
    input logic [4*S-1:0] k_sig_i,
    input logic [3:0] z_neg_i,
    input logic [4*PE-1:0] z_exp_i,
    input logic [4*S-1:0] z_sig_i,
    input logic [3*N*AP-1:0] attr_i,  // of v1, v2, v3
    input logic [N*AO-1:0] base_attr_i,
    input logic [DB:0] base_depth_i,
    input logic [LIMITS-1:0] depth_limits_i,
    // Function bank, written at take
    input logic take_i,
    input logic [SLOT-1:0] take_slot_i,
    input logic [6*GRAD-1:0] lin_gx_i,
    input logic [6*GRAD-1:0] lin_gy_i,
    input logic [6*LENGTH2-1:0] length2_i,
    input logic [4:0] tie_pos_i,
    input logic [4:0] tie_neg_i,
    input logic [3:0] visible_i,
    input logic hull_i,
    input logic homogeneous_i,
    // Read for coverage: there a clock after stamp_load_i, until the next
    input logic stamp_load_i,
    input logic [SLOT-1:0] stamp_slot_i,
    output logic [5*GRAD-1:0] stamp_gx_o,
    output logic [5*GRAD-1:0] stamp_gy_o,
    output logic [4:0] stamp_tie_pos_o,
    output logic [4:0] stamp_tie_neg_o,
    output logic [3:0] stamp_visible_o,
    // Read for emission: there a clock after the slot
    input logic [SLOT-1:0] emit_slot_i,
    output logic [6*GRAD-1:0] emit_gx_o,
    output logic [6*GRAD-1:0] emit_gy_o,
    // Read for the dot products of an ordinary quad: there a clock after the slot
    input logic [SLOT-1:0] length2_slot_i,
    output logic [6*LENGTH2-1:0] length2_o,
    // Read for the significand numbers: whether the quad's weights are areas
    input logic [SLOT-1:0] norm_slot_i,
    output logic norm_plane_o,
    // Read of k_eff for the weights' products and for the overrides
    input logic [SLOT-1:0] product_slot_i,
    output logic [3:0] product_k_neg_o,
    output logic [4*PE-1:0] product_k_exp_o,
    output logic [4*S-1:0] product_k_sig_o,
    input logic [SLOT-1:0] override_slot_i,
    output logic [4*PE-1:0] override_k_exp_o,
    output logic [4*S-1:0] override_k_sig_o,
    // Read for interpolation: term sets k_eff, W, Z of four vertices, b0, b1, ... of v1, v2, v3; there a clock after the slot
    input logic [SLOT-1:0] blend_slot_i,
    output logic [TERMS-1:0] blend_neg_o,
    output logic [TERMS*PE-1:0] blend_exp_o,
    output logic [TERMS*S-1:0] blend_sig_o,
    output logic blend_hull_o,
    // Read for the output's sums: there a clock after the slot
    input logic [SLOT-1:0] base_slot_i,
    output logic [N*AO-1:0] base_attr_o,
    output logic [DB:0] base_depth_o,
    output logic [LIMITS-1:0] base_limits_o,
    // Read for the output
    input logic [SLOT-1:0] output_slot_i,
    output logic [ID-1:0] output_id_o,
    output logic output_hull_o,
    output logic output_homogeneous_o
);
  localparam int SLOTS = 1 << SLOT;

  // ---- Allocation: one slot after the other; those of dropped quads are free earlier than older ones, so that the next may be in use --
  logic [SLOT-1:0] alloc_q, output_slot_q, release_slot_q;
  logic [SLOTS-1:0] in_use_q;

  assign alloc_o = alloc_q;
  assign available_o = !in_use_q[alloc_q];
  assign busy_o = in_use_q != '0;

  always_ff @(posedge clk_i) begin
    {release_slot_q, output_slot_q} <= {output_slot_q, output_slot_i};  // of the end beat in the pipeline's last register
    if (!rst_ni) begin
      alloc_q <= '0;
      in_use_q <= '0;
    end else begin
      alloc_q <= alloc_q + SLOT'(start_i || (in_use_q[alloc_q] && in_use_q != '1));
      if (release_i) in_use_q[release_slot_q] <= 1'b0;
      if (drop_i) in_use_q[drop_slot_i] <= 1'b0;
      if (start_i) in_use_q[alloc_q] <= 1'b1;
    end
  end

  // ---- Vertex bank --------------------------------------------------------------------------------------------------------
  // k_eff, which is read three times, in a small memory per vertex; the other term sets, read once for interpolation, in one word.
  localparam int WORD = 1 + PE + S;
  localparam int SETS = 3 + N;
  localparam int BLEND = (TERMS - 4) * WORD;
  // Block RAM: a slot that a pixel reads is in use, so it is never the one that is written (asserted in quadrille).
  (* ram_style = "block", no_rw_check *) logic [BLEND-1:0] blend_q[0:SLOTS-1];
  logic [BLEND-1:0] write_blend, blend_word;

  always_ff @(posedge clk_i) begin
    if (start_i) blend_q[alloc_q] <= write_blend;
    blend_word <= blend_q[blend_slot_i];
  end

  for (genvar v = 0; v < 4; v++) begin : gen_vertex
    logic k_neg;
    logic [PE-1:0] k_exp;
    logic [S-1:0] k_sig;

    assign k_neg = perspective_i ? 1'b0 : w_neg_i[v];
    assign k_exp = perspective_i ? k_exp_i[v*PE+:PE] : w_exp_i[v*PE+:PE];
    assign k_sig = perspective_i ? k_sig_i[v*S+:S] : w_sig_i[v*S+:S];

    // An attribute has no term of vertex 0.
    for (genvar t = 0; t < ((v == 0) ? 3 : SETS); t++) begin : gen_term
      localparam int PLACE = (t < 3) ? 4 * t + v : 12 + 3 * (t - 3) + v - 1;
      logic [WORD-1:0] read_word;

      assign blend_neg_o[PLACE] = read_word[WORD-1];
      assign blend_exp_o[PLACE*PE+:PE] = read_word[S+:PE];
      assign blend_sig_o[PLACE*S+:S] = read_word[0+:S];

      if (t == 0) begin : gen_k
        logic [WORD-1:0] bank_q[0:SLOTS-1];
        logic [WORD-1:0] product_word, override_word;

        always_ff @(posedge clk_i) begin
          if (start_i) bank_q[alloc_q] <= {k_neg, k_exp, k_sig};
          read_word <= bank_q[blend_slot_i];
        end

        assign product_word = bank_q[product_slot_i];
        assign override_word = bank_q[override_slot_i];
        assign product_k_neg_o[v] = product_word[WORD-1];
        assign product_k_exp_o[v*PE+:PE] = product_word[S+:PE];
        assign product_k_sig_o[v*S+:S] = product_word[0+:S];
        assign override_k_exp_o[v*PE+:PE] = override_word[S+:PE];
        assign override_k_sig_o[v*S+:S] = override_word[0+:S];
        logic unused_neg;
        assign unused_neg = override_word[WORD-1];  // magnitude only
      end else begin : gen_blend
        localparam int AT = (PLACE - 4) * WORD;
        assign read_word = blend_word[AT+:WORD];

        if (t == 1) begin : gen_w
          assign write_blend[AT+:WORD] = {w_neg_i[v], w_exp_i[v*PE+:PE], w_sig_i[v*S+:S]};
        end else if (t == 2) begin : gen_z
          assign write_blend[AT+:WORD] = {z_neg_i[v], z_exp_i[v*PE+:PE], z_sig_i[v*S+:S]};
        end else begin : gen_b
          assign write_blend[AT+:WORD] = attr_i[((v-1)*N+t-3)*AP+:AP];
        end
      end
    end
  end

  // Block RAM as blend_q, and a memory of its own, for it is read later.
  localparam int BASE = N * AO + DB + 1 + LIMITS;
  (* ram_style = "block", no_rw_check *) logic [BASE-1:0] base_q[0:SLOTS-1];
  logic [BASE-1:0] base_word;

  always_ff @(posedge clk_i) begin
    if (start_i) base_q[alloc_q] <= {base_attr_i, base_depth_i, depth_limits_i};
    base_word <= base_q[base_slot_i];
  end

  assign {base_attr_o, base_depth_o, base_limits_o} = base_word;

  logic [ID-1:0] id_q[0:SLOTS-1];

  always_ff @(posedge clk_i) if (start_i) id_q[alloc_q] <= id_i;

  assign output_id_o = id_q[output_slot_i];

  if (quadrille_pkg::PLANE_QUADS != 0) begin : gen_plane
    logic [SLOTS-1:0] plane_q;

    always_ff @(posedge clk_i) if (start_i) plane_q[alloc_q] <= plane_i;

    assign norm_plane_o = plane_q[norm_slot_i];
  end else begin : gen_no_plane
    logic unused_plane;
    assign unused_plane = ^{plane_i, norm_slot_i};
    assign norm_plane_o = 1'b0;
  end

  // ---- Function bank ------------------------------------------------------------------------------------------------------
  for (genvar g = 0; g < 6; g++) begin : gen_linear
    logic [GRAD-1:0] gx_q[0:SLOTS-1];
    logic [GRAD-1:0] gy_q[0:SLOTS-1];

    always_ff @(posedge clk_i) begin
      if (take_i) begin
        gx_q[take_slot_i] <= lin_gx_i[g*GRAD+:GRAD];
        gy_q[take_slot_i] <= lin_gy_i[g*GRAD+:GRAD];
      end
      emit_gx_o[g*GRAD+:GRAD] <= gx_q[emit_slot_i];
      emit_gy_o[g*GRAD+:GRAD] <= gy_q[emit_slot_i];
    end

    if (g < 5) begin : gen_stamp
      always_ff @(posedge clk_i) begin
        if (stamp_load_i) begin
          stamp_gx_o[g*GRAD+:GRAD] <= gx_q[stamp_slot_i];
          stamp_gy_o[g*GRAD+:GRAD] <= gy_q[stamp_slot_i];
        end
      end
    end
  end

  (* ram_style = "block", no_rw_check *) logic [6*LENGTH2-1:0] length2_q[0:SLOTS-1];  // as blend_q

  always_ff @(posedge clk_i) begin
    if (take_i) length2_q[take_slot_i] <= length2_i;
    length2_o <= length2_q[length2_slot_i];
  end

  logic [13:0] stamp_q[0:SLOTS-1];
  logic [1:0] class_q[0:SLOTS-1];

  always_ff @(posedge clk_i) begin
    if (take_i) begin
      stamp_q[take_slot_i] <= {tie_pos_i, tie_neg_i, visible_i};
      class_q[take_slot_i] <= {hull_i, homogeneous_i};
    end
    blend_hull_o <= class_q[blend_slot_i][1];
    if (stamp_load_i) {stamp_tie_pos_o, stamp_tie_neg_o, stamp_visible_o} <= stamp_q[stamp_slot_i];
  end

  assign {output_hull_o, output_homogeneous_o} = class_q[output_slot_i];

`ifndef SYNTHESIS
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      `QUADRILLE_ASSERT(assert_start_has_slot, !start_i || available_o, "start comes with a free slot")
      `QUADRILLE_ASSERT(assert_release_in_use, !release_i || busy_o, "a slot released was in use")
    end
  end
`endif
endmodule
