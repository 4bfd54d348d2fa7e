// SPDX-License-Identifier: Apache-2.0
// Collects four vertex beats v0..v3 into a quad. One beat a clock; a full buffer stops the port until start_i or drop_i clears it, in whose clock the
// next quad's first beat is taken. flush_i discards the beats of a quad of which fewer than four came before, and one that comes with it.
//
// vertex_ready_o depends on registers, start_i and drop_i, not on vertex_valid_i. The quad's id, bases and depth codes are those of v0.
// Beside the quad: whether all its W are ONE, W as significand numbers, and its least and greatest X and Y, kept up with each beat; and
// the judgements of its vertices by quad_reject, range_empty and depth_interval. Vertex i's field is at [i*width +: width] of each flat output;
// attributes are those of v1, v2, v3, for v0's are the bases.
module quadrille_vertex_assembly #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int PE = quadrille_pkg::PORT_EXP_BITS,
    localparam int T = quadrille_pkg::T_BITS,
    localparam int W = quadrille_pkg::W_BITS,
    localparam int DB = quadrille_pkg::DEPTH_BITS,
    localparam int H = quadrille_pkg::DEPTH_CODE_BITS,
    localparam int V = quadrille_pkg::VIEWPORT_BITS,
    localparam int ATTR = quadrille_pkg::ATTRIBUTE_SLOTS * quadrille_pkg::ATTR_PORT_BITS,
    localparam int BASE = quadrille_pkg::ATTRIBUTE_SLOTS * quadrille_pkg::ATTR_OUT_BITS,
    localparam int CODE = quadrille_pkg::CORNER_DEPTH_BITS
) (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    input logic [quadrille_pkg::VERTEX_BITS-1:0] vertex_i,
    input logic vertex_valid_i,
    output logic vertex_ready_o,
    input logic flush_i,
    input logic start_i,
    input logic drop_i,
    input logic depth_on_i,
    input logic [DB:0] znear_i,
    input logic [DB:0] zfar_i,
    input logic [V:0] scissor_x0_i,
    input logic [V:0] scissor_y0_i,
    input logic [V:0] scissor_x1_i,
    input logic [V:0] scissor_y1_i,
    output logic empty_o,  // no pixel centre inside scissor and bounding box
    output logic behind_o,
    output logic depth_o,
    output logic [H-1:0] near_o,
    output logic [H-1:0] far_o,
    output logic lowers_o,
    output logic full_o,
    output logic busy_o,
    output logic [quadrille_pkg::QUAD_ID_BITS-1:0] id_o,
    output logic [4*T-1:0] x_o,
    output logic [4*T-1:0] y_o,
    output logic [4*W-1:0] w_o,
    output logic [3:0] w_neg_o,
    output logic [4*PE-1:0] w_exp_o,
    output logic [4*S-1:0] w_sig_o,
    output logic ordinary_o,
    output logic [T-1:0] low_x_o,
    output logic [T-1:0] high_x_o,
    output logic [T-1:0] low_y_o,
    output logic [T-1:0] high_y_o,
    output logic [4*PE-1:0] k_exp_o,
    output logic [4*S-1:0] k_sig_o,
    output logic [3:0] z_neg_o,
    output logic [4*PE-1:0] z_exp_o,
    output logic [4*S-1:0] z_sig_o,
    output logic [3*ATTR-1:0] attr_o,
    output logic [BASE-1:0] base_attr_o,
    output logic [DB:0] base_depth_o,
    output logic [quadrille_pkg::DEPTH_LIMIT_BITS-1:0] depth_limits_o
);
  typedef struct packed {
    logic [quadrille_pkg::QUAD_ID_BITS-1:0] id;
    logic [T-1:0] x;
    logic [T-1:0] y;
    logic [W-1:0] w;
    logic [PE-1:0] k_exp;
    logic [S-1:0] k_sig;
    logic z_neg;
    logic [PE-1:0] z_exp;
    logic [S-1:0] z_sig;
    logic [ATTR-1:0] attr;
    logic [BASE-1:0] base_attr;
    logic [DB:0] base_depth;
    logic [CODE-1:0] depth_low;
    logic [CODE-1:0] depth_high;
  } vertex_t;

  vertex_t vertex;
  logic [1:0] count_q;
  logic full_q;
  logic accept;

  assign vertex = vertex_i;
  assign accept = vertex_valid_i && vertex_ready_o;
  assign vertex_ready_o = !full_q || start_i || drop_i;
  assign full_o = full_q;
  assign busy_o = full_q || (count_q != 2'd0);

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      count_q <= 2'd0;
      full_q <= 1'b0;
    end else begin
      if (flush_i) count_q <= 2'd0;
      else if (accept) count_q <= count_q + 2'd1;
      if (accept && count_q == 2'd3 && !flush_i) full_q <= 1'b1;
      else if (start_i || drop_i) full_q <= 1'b0;
    end
  end

  // Plain copies of the fields: a struct is not read inside a generate loop.
  logic [T-1:0] x, y;
  logic [W-1:0] w;
  logic [PE-1:0] k_exp, z_exp;
  logic [S-1:0] k_sig, z_sig;
  logic z_neg;
  logic [ATTR-1:0] attr;

  assign x = vertex.x;
  assign y = vertex.y;
  assign w = vertex.w;
  assign k_exp = vertex.k_exp;
  assign k_sig = vertex.k_sig;
  assign z_neg = vertex.z_neg;
  assign z_exp = vertex.z_exp;
  assign z_sig = vertex.z_sig;
  assign attr = vertex.attr;

  localparam logic [W-1:0] ONE = W'(1) << quadrille_pkg::FRAC;
  logic first;
  logic [CODE-1:0] depth_low_q, depth_high_q;

  assign first = count_q == 2'd0;

  always_ff @(posedge clk_i) begin
    if (accept && first) begin
      id_o <= vertex.id;
      base_attr_o <= vertex.base_attr;
      base_depth_o <= vertex.base_depth;
      depth_low_q <= vertex.depth_low;
      depth_high_q <= vertex.depth_high;
    end
    if (accept) begin
      ordinary_o <= (first || ordinary_o) && w == ONE;
      if (first || $signed(x) < $signed(low_x_o)) low_x_o <= x;
      if (first || $signed(x) > $signed(high_x_o)) high_x_o <= x;
      if (first || $signed(y) < $signed(low_y_o)) low_y_o <= y;
      if (first || $signed(y) > $signed(high_y_o)) high_y_o <= y;
    end
  end

  logic empty_x, empty_y;

  assign empty_o = empty_x || empty_y;

  quadrille_range_empty u_empty_x (
      .clk_i,
      .accept_i(accept),
      .first_i(first),
      .coordinate_i(x),
      .low_i(low_x_o),
      .scissor0_i(scissor_x0_i),
      .scissor1_i(scissor_x1_i),
      .ordinary_i(ordinary_o),
      .empty_o(empty_x)
  );

  quadrille_range_empty u_empty_y (
      .clk_i,
      .accept_i(accept),
      .first_i(first),
      .coordinate_i(y),
      .low_i(low_y_o),
      .scissor0_i(scissor_y0_i),
      .scissor1_i(scissor_y1_i),
      .ordinary_i(ordinary_o),
      .empty_o(empty_y)
  );

  // W as a significand number: exponent -FRAC..0, which fits the port's width.
  localparam int E = quadrille_pkg::EXP_BITS;
  logic w_neg;
  logic [W-1:0] w_magnitude;
  logic [E-1:0] w_exp;
  logic [S-1:0] w_sig;

  assign w_neg = w[W-1];
  assign w_magnitude = w_neg ? W'(0) - w : w;

  quadrille_fp_normalise #(
      .WIDTH(W),
      .REGISTERED(1'b0)
  ) u_w (
      .clk_i,
      .active_i(1'b1),
      .magnitude_i(w_magnitude),
      .bias_i(E'(0) - E'(quadrille_pkg::FRAC)),
      .exp_o(w_exp),
      .sig_o(w_sig)
  );

  logic unused;
  assign unused = ^w_exp[E-1:PE];

  quadrille_quad_reject u_reject (
      .clk_i,
      .depth_on_i,
      .znear_i,
      .zfar_i,
      .accept_i(accept),
      .first_i(first),
      .w_i(w),
      .low_i(depth_low_q),
      .high_i(depth_high_q),
      .behind_o,
      .depth_o,
      .limits_o(depth_limits_o)
  );

  if (quadrille_pkg::HIERARCHICAL_Z_BITS != 0) begin : gen_interval
    quadrille_depth_interval u_interval (
        .clk_i,
        .low_i(depth_low_q),
        .high_i(depth_high_q),
        .limits_i(depth_limits_o),
        .ordinary_i(ordinary_o),
        .near_o,
        .far_o,
        .lowers_o
    );
  end else begin : gen_no_interval
    assign near_o = '0;
    assign far_o = '0;
    assign lowers_o = 1'b0;
  end

  for (genvar g = 0; g < 4; g++) begin : gen_vertex
    logic [T-1:0] x_q, y_q;
    logic [W-1:0] w_q;
    logic w_neg_q;
    logic [PE-1:0] w_exp_q;
    logic [S-1:0] w_sig_q;
    logic [PE-1:0] k_exp_q, z_exp_q;
    logic [S-1:0] k_sig_q, z_sig_q;
    logic z_neg_q;

    always_ff @(posedge clk_i) begin
      if (accept && count_q == g) begin
        x_q <= x;
        y_q <= y;
        w_q <= w;
        {w_neg_q, w_exp_q, w_sig_q} <= {w_neg, w_exp[PE-1:0], w_sig};
        k_exp_q <= k_exp;
        k_sig_q <= k_sig;
        z_neg_q <= z_neg;
        z_exp_q <= z_exp;
        z_sig_q <= z_sig;
      end
    end

    if (g != 0) begin : gen_attributes
      logic [ATTR-1:0] attr_q;

      always_ff @(posedge clk_i) if (accept && count_q == g) attr_q <= attr;

      assign attr_o[(g-1)*ATTR+:ATTR] = attr_q;
    end

    assign x_o[g*T+:T] = x_q;
    assign y_o[g*T+:T] = y_q;
    assign w_o[g*W+:W] = w_q;
    assign w_neg_o[g] = w_neg_q;
    assign w_exp_o[g*PE+:PE] = w_exp_q;
    assign w_sig_o[g*S+:S] = w_sig_q;
    assign k_exp_o[g*PE+:PE] = k_exp_q;
    assign k_sig_o[g*S+:S] = k_sig_q;
    assign z_neg_o[g] = z_neg_q;
    assign z_exp_o[g*PE+:PE] = z_exp_q;
    assign z_sig_o[g*S+:S] = z_sig_q;
  end
endmodule
