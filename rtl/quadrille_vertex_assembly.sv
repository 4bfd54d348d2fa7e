// SPDX-License-Identifier: Apache-2.0
`include "quadrille_types.svh"
// Collects four vertex beats v0..v3 into a quad. One beat a clock; a full buffer stops the port until leave_i clears
// it, in whose clock the next quad's first beat is taken. flush_i discards the beats of a quad of which fewer than four
// came before, and one that comes with it.
//
// vertex_ready_o depends on registers and leave_i, not on vertex_valid_i. The quad's id, bases and depth codes are
// those of v0. A vertex's registers take the port's beat in each clock until it is accepted. Beside the quad: whether
// all its W are ONE, W as significand numbers, least and greatest X and Y, kept up with each beat; judgements of its
// vertices by quad_reject, range_empty and depth_interval. Vertex i's field is at [i*width +: width] of each flat
// output; attributes are those of v1, v2, v3, for v0's are the bases.
module quadrille_vertex_assembly #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS, PE = quadrille_pkg::PORT_EXP_BITS, T = quadrille_pkg::T_BITS,
    localparam int E = quadrille_pkg::EXP_BITS, W = quadrille_pkg::W_BITS,
    localparam int ATTR = quadrille_pkg::ATTRIBUTE_SLOTS * quadrille_pkg::ATTR_PORT_BITS
) (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    input logic [quadrille_pkg::STATE_BITS-1:0] state_i,
    input logic [quadrille_pkg::VERTEX_BITS-1:0] vertex_i,
    input logic vertex_valid_i,
    output logic vertex_ready_o,
    input logic flush_i, leave_i,
    output logic full_o, busy_o,
    output logic empty_o,  // no pixel centre inside scissor and bounding box
    output logic behind_o, depth_o,
    output logic [quadrille_pkg::DEPTH_LIMIT_BITS-1:0] limits_o,
    output logic [quadrille_pkg::QUAD_BITS-1:0] quad_o
);
  `QUADRILLE_IN(`QUADRILLE_STATE_T, state)
  `QUADRILLE_IN(`QUADRILLE_VERTEX_T, vertex)
  logic [quadrille_pkg::QUAD_ID_BITS-1:0] id;
  logic [4*quadrille_pkg::T_BITS-1:0] x, y;
  logic [4*quadrille_pkg::W_BITS-1:0] w;
  logic ordinary;
  logic [quadrille_pkg::T_BITS-1:0] low_x, high_x, low_y, high_y;
  logic [3:0] w_negs, z_neg;
  logic [E-1:0] w_exp;  // of the last vertex
  logic [S-1:0] w_sig;
  logic [3*PE-1:0] w_exps;  // of v0, v1, v2
  logic [3*S-1:0] w_sigs;
  logic [4*quadrille_pkg::PORT_EXP_BITS-1:0] k_exp, z_exp;
  logic [4*quadrille_pkg::SIGNIFICAND_BITS-1:0] k_sig, z_sig;
  logic [3*quadrille_pkg::ATTRIBUTE_SLOTS*quadrille_pkg::ATTR_PORT_BITS-1:0] attr;
  logic [quadrille_pkg::ATTRIBUTE_SLOTS*quadrille_pkg::ATTR_OUT_BITS-1:0] base_attr;
  logic [quadrille_pkg::DEPTH_BITS:0] base_depth;
  logic [quadrille_pkg::CORNER_DEPTH_BITS-1:0] depth_low, depth_high;
  logic [1:0] count_q;
  logic full_q, accept;
  assign accept = vertex_valid_i && vertex_ready_o;
  assign vertex_ready_o = !full_q || leave_i;
  assign full_o = full_q;
  assign quad_o = {id, x, y, w, ordinary, low_x, high_x, low_y, high_y, w_negs, w_exp[PE-1:0], w_exps, w_sig, w_sigs,
      k_exp, k_sig, z_neg, z_exp, z_sig, attr, base_attr, base_depth, depth_low, depth_high};
  assign busy_o = full_q || (count_q != 2'd0);

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      count_q <= 2'd0;
      full_q <= 1'b0;
    end else begin
      if (flush_i) count_q <= 2'd0;
      else if (accept) count_q <= count_q + 2'd1;
      if (accept && count_q == 2'd3 && !flush_i) full_q <= 1'b1;
      else if (leave_i) full_q <= 1'b0;
    end
  end

  localparam logic [W-1:0] ONE = W'(1) << quadrille_pkg::FRAC;
  logic first;
  assign first = count_q == 2'd0;

  always_ff @(posedge clk_i) begin
    if (first && vertex_ready_o) begin
      id <= vertex.id;
      base_attr <= vertex.base_attr;
      base_depth <= vertex.base_depth;
      depth_low <= vertex.depth_low;
      depth_high <= vertex.depth_high;
    end
    if (accept) begin
      ordinary <= (first || ordinary) && vertex.w == ONE;
      if (first || $signed(vertex.x) < $signed(low_x)) low_x <= vertex.x;
      if (first || $signed(vertex.x) > $signed(high_x)) high_x <= vertex.x;
      if (first || $signed(vertex.y) < $signed(low_y)) low_y <= vertex.y;
      if (first || $signed(vertex.y) > $signed(high_y)) high_y <= vertex.y;
    end
  end

  logic empty_x, empty_y;
  assign empty_o = empty_x || empty_y;

  quadrille_range_empty u_empty_x (
      .clk_i, .accept_i(accept), .first_i(first), .coordinate_i(vertex.x), .low_i(low_x), .scissor0_i(state.scissor_x0),
      .scissor1_i(state.scissor_x1), .ordinary_i(ordinary), .empty_o(empty_x)
  );

  quadrille_range_empty u_empty_y (
      .clk_i, .accept_i(accept), .first_i(first), .coordinate_i(vertex.y), .low_i(low_y), .scissor0_i(state.scissor_y0),
      .scissor1_i(state.scissor_y1), .ordinary_i(ordinary), .empty_o(empty_y)
  );

  // W as a significand number, a clock after its beat: exponent -FRAC..0, which fits the port's width.
  logic [W-1:0] w_magnitude_q;  // of the last vertex

  always_ff @(posedge clk_i) if (accept) w_magnitude_q <= vertex.w[W-1] ? W'(0) - vertex.w : vertex.w;

  quadrille_fp_normalise #(.WIDTH(W), .REGISTERED(1'b0)) u_w (
      .clk_i, .active_i(1'b1), .magnitude_i(w_magnitude_q), .bias_i(E'(0) - E'(quadrille_pkg::FRAC)), .exp_o(w_exp),
      .sig_o(w_sig)
  );

  logic unused;
  assign unused = ^w_exp[E-1:PE];

  quadrille_quad_reject u_reject (
      .clk_i, .depth_on_i(state.depth), .znear_i(state.znear), .zfar_i(state.zfar), .accept_i(accept), .first_i(first),
      .w_i(vertex.w), .low_i(depth_low), .high_i(depth_high), .behind_o, .depth_o, .limits_o(limits_o)
  );

  for (genvar g = 0; g < 4; g++) begin : gen_vertex
    always_ff @(posedge clk_i) begin
      if (count_q == g && (g != 0 || vertex_ready_o)) begin
        x[g*T+:T] <= vertex.x;
        y[g*T+:T] <= vertex.y;
        w[g*W+:W] <= vertex.w;
        w_negs[g] <= vertex.w[W-1];
        k_exp[g*PE+:PE] <= vertex.k_exp;
        k_sig[g*S+:S] <= vertex.k_sig;
        z_neg[g] <= vertex.z_neg;
        z_exp[g*PE+:PE] <= vertex.z_exp;
        z_sig[g*S+:S] <= vertex.z_sig;
      end
    end

    if (g != 3) begin : gen_w
      always_ff @(posedge clk_i) begin
        if (count_q == g + 1) begin
          w_exps[g*PE+:PE] <= w_exp[PE-1:0];
          w_sigs[g*S+:S] <= w_sig;
        end
      end
    end

    if (g != 0) begin : gen_attributes
      always_ff @(posedge clk_i) if (count_q == g) attr[(g-1)*ATTR+:ATTR] <= vertex.attr;
    end
  end
endmodule
