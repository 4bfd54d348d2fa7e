// SPDX-License-Identifier: Apache-2.0
`include "quadrille_assert.svh"
`include "quadrille_types.svh"
// The steps of quad_setup: which jobs a quad has, one for each pair of dot units a clock, and the vertices that they
// take.
module quadrille_setup_steps #(
    localparam int T = quadrille_pkg::T_BITS, W = quadrille_pkg::W_BITS, V = quadrille_pkg::VIEWPORT_BITS,
    localparam int VAL = quadrille_pkg::VAL_BITS, GRAD = quadrille_pkg::GRAD_BITS, TC = quadrille_pkg::TC_BITS,
    localparam int PAIRS = quadrille_pkg::PRODUCT_PAIRS, EDGE_WIDTH = VAL + 2 * GRAD
) (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    input logic [quadrille_pkg::STATE_BITS-1:0] state_i,
    // The quad that may start, and its first tile
    input logic load_i,
    input logic [quadrille_pkg::QUAD_BITS-1:0] quad_i,
    input logic [TC-1:0] tile_x0_i, tile_y0_i,
    // The quad that does its steps: is there one, all its W are ONE
    input logic run_i, ordinary_i,
    input logic wait_i,  // the step is repeated
    output logic last_o,  // it is the last one
    // Jobs, with the vertices relative to the origin pixel (a shift: W = ONE or the origin is 0); edge functions of DET
    // jobs
    output logic [quadrille_pkg::JOBS_BITS-1:0] jobs_o,
    output logic [PAIRS*EDGE_WIDTH-1:0] edges_o,
    // What the step is, one bit: edge, gradient, determinant, side, corner; its group, of a side: which corner, vertex;
    // of an edge at a corner: in the triangle 023, negated; the second of two steps
    output logic [4:0] kind_o,
    output logic [2:0] group_o,
    output logic [PAIRS-1:0] triangle_o, negated_o,
    output logic second_o,
    // Functions and determinants so far
    input logic [6*VAL-1:0] lin_value_i,
    input logic [6*GRAD-1:0] lin_gx_i, lin_gy_i,
    input logic [3:0] negative_i  // d_012, d_023, d_123, d_013
);
  `QUADRILLE_IN(`QUADRILLE_STATE_T, state)
  `QUADRILLE_IN(`QUADRILLE_QUAD_T, quad)
  logic [5:0] step_q;
  logic [T-1:0] origin_x, origin_y;
  logic [4*T-1:0] from_origin_x, from_origin_y, tx_q, ty_q;
  logic [4*W-1:0] w_q;
  assign origin_x = T'(tile_x0_i) << (quadrille_pkg::TILE_LOG2 + quadrille_pkg::FRAC);
  assign origin_y = T'(tile_y0_i) << (quadrille_pkg::TILE_LOG2 + quadrille_pkg::FRAC);

  // ---- Steps -------------------------------------------------------------------------------------------------------
  // Of an ordinary quad the edge functions and with each its pair's squared length; its gradients need no product. Of a
  // homogeneous quad each edge function's gradient, then its value; then the determinants, vector times vector, in two
  // steps, gradient and value. By then its edge function has both: with two pairs of units a step without a job is
  // needed. In a step pair p of the units has function PAIRS group + p, or the determinant (4 / PAIRS) p + group. Then
  // for scissor_separation: the vertices from two corners of the scissor (sides), and like a determinant each edge of
  // either triangle at one of its corners, value and gradient. The corner takes the place of a vertex that is not
  // needed any more. With one pair of units E30 comes late: until E20 has been at both corners its register holds E20
  // too, which else no product reaches.
  localparam logic [5:0] LAST_ORDINARY = 6'(6 / PAIRS - 1);
  localparam logic [5:0] FUNCTIONS_END = (PAIRS == 1) ? 6'd10 : 6'd6;
  localparam logic [5:0] DETERMINANTS = (PAIRS == 1) ? 6'd10 : 6'd7;
  localparam logic [5:0] SIDES = DETERMINANTS + 6'(8 / PAIRS);
  // of E30; with two pairs nothing, the determinants' signs are to come
  localparam logic [5:0] LATE = (PAIRS == 1) ? 6'd30 : 6'd15;
  localparam logic [5:0] CORNERS = (PAIRS == 1) ? 6'd26 : 6'd18;
  localparam logic [5:0] LAST_TOGETHER = (PAIRS == 1) ? LATE + 6'd1 : SIDES - 6'd1;  // without state.skip[3]
  localparam logic [5:0] LAST_SEPARATE = (PAIRS == 1) ? 6'd39 : 6'd23;

  // What a step is, is said of the next one and kept in registers: choosing vertices takes a clock.
  logic to_late, ordinary;  // it is LATE; its quad
  logic is_function, is_late, is_edge, is_gradient, is_det, is_side, is_corner, second;
  logic [5:0] step, det_step, side_step;  // the next one, 2 group + half
  logic side_far, side_far_q;  // from the corner (x1, y1)
  logic [1:0] side_vertex;
  logic [2:0] group;
  assign to_late = PAIRS == 1 && !state.skip[3] && step_q == SIDES - 6'd1;
  assign step = load_i ? '0 : wait_i ? step_q : to_late ? LATE : step_q + 6'd1;
  assign ordinary = load_i ? quad.ordinary : ordinary_i;
  assign is_late = PAIRS == 1 && step[5:1] == LATE[5:1];
  assign is_function = step < FUNCTIONS_END || is_late;
  assign is_edge = ordinary || (is_function && step[0]);
  assign is_gradient = !ordinary && is_function && !step[0];
  assign is_det = !ordinary && step >= DETERMINANTS && step < SIDES;
  assign is_side = !ordinary && step >= SIDES && step < SIDES + 6'(8 / PAIRS);
  assign is_corner = !ordinary && step >= CORNERS && !is_late;
  assign det_step = step - DETERMINANTS;
  assign second = is_corner ? step[0] : det_step[0];
  assign side_step = step - SIDES;
  assign side_far = (PAIRS == 1) ? side_step[2] : side_step[1];
  assign side_vertex = (PAIRS == 1) ? side_step[1:0] : {side_step[0], 1'b0};

  always_comb begin
    group = step[3:1];
    if (ordinary) group = step[2:0];
    else if (is_late) group = 3'd3;
    else if (PAIRS == 1 && step[3:1] >= 3'd3) group = step[3:1] + 3'd1;
  end

  always_ff @(posedge clk_i) begin
    step_q <= step;
    last_o <= step == (ordinary ? LAST_ORDINARY : state.skip[3] ? LAST_SEPARATE : LAST_TOGETHER);
    kind_o <= {is_edge, is_gradient, is_det, is_side, is_corner};
    group_o <= is_side ? {side_far, side_vertex} : group;
    second_o <= second;
  end

  // ---- Corners of the scissor in a vertex's place, in pixels: chosen while the edge's value is multiplied -----------
  logic [PAIRS*EDGE_WIDTH-1:0] edge_words;  // value, gx, gy
  logic [PAIRS*(V+1)-1:0] corner_x, corner_y;
  logic [V:0] offset_x, offset_y;  // of a MOVE, a clock after the job
  logic [PAIRS*3-1:0] kinds;
  logic [PAIRS*4-1:0] functions;

  always_ff @(posedge clk_i) side_far_q <= group_o[2];

  for (genvar p = 0; p < PAIRS; p++) begin : gen_corner
    logic far_x, far_y, is_diagonal;  // E20, whose sense is reversed in the triangle 023

    // With one pair of units E20 of either triangle in steps 26 to 29, from 32 on E01, E12, E23, E30; with two E20 in
    // 18, 19.
    assign is_diagonal = (PAIRS == 1) ? !step_q[5] : step_q[2:1] == 2'd1;
    assign triangle_o[p] = (PAIRS == 2) ? 1'(p) : step_q[2];
    assign negated_o[p] = triangle_o[p] ? negative_i[1] ^ is_diagonal : negative_i[0];
    assign far_x = edge_words[p*EDGE_WIDTH+2*GRAD-1] == negated_o[p];
    assign far_y = edge_words[p*EDGE_WIDTH+GRAD-1] == negated_o[p];
    assign corner_x[p*(V+1)+:V+1] = far_x ? state.scissor_x1 : state.scissor_x0;
    assign corner_y[p*(V+1)+:V+1] = far_y ? state.scissor_y1 : state.scissor_y0;
  end

  assign offset_x = side_far_q ? state.scissor_x1 : state.scissor_x0;
  assign offset_y = side_far_q ? state.scissor_y1 : state.scissor_y0;

  for (genvar g = 0; g < 4; g++) begin : gen_vertex
    localparam int P = (g == 2 && PAIRS == 2) ? 1 : 0;
    localparam bit IS_CORNER = g >= 1 && g <= PAIRS;
    logic to_corner, to_one;
    assign from_origin_x[g*T+:T] = quad.x[g*T+:T] - origin_x;
    assign from_origin_y[g*T+:T] = quad.y[g*T+:T] - origin_y;

    // All but the low bits of a corner are a synchronous reset.
    assign to_corner = IS_CORNER && run_i && kind_o[0] && !step_q[0];
    assign to_one = IS_CORNER && run_i && !ordinary_i && state.skip[3] && step_q == CORNERS - 6'd1;

    always_ff @(posedge clk_i) begin
      if (to_corner) begin
        tx_q[g*T+V+1+:T-V-1] <= '0;
        ty_q[g*T+V+1+:T-V-1] <= '0;
      end else if (load_i) begin
        tx_q[g*T+V+1+:T-V-1] <= from_origin_x[g*T+V+1+:T-V-1];
        ty_q[g*T+V+1+:T-V-1] <= from_origin_y[g*T+V+1+:T-V-1];
      end
      if (to_corner || load_i) begin
        tx_q[g*T+:V+1] <= to_corner ? corner_x[P*(V+1)+:V+1] : from_origin_x[g*T+:V+1];
        ty_q[g*T+:V+1] <= to_corner ? corner_y[P*(V+1)+:V+1] : from_origin_y[g*T+:V+1];
      end
      if (to_one) w_q[g*W+:W] <= W'(1);
      else if (load_i) w_q[g*W+:W] <= quad.w[g*W+:W];
    end
  end

  for (genvar p = 0; p < PAIRS; p++) begin : gen_job
    // d_012 = E01 . V2, d_023 = E23 . V0, d_123 = E12 . V3, d_013 = E01 . V3, or E30 . V1 where the second pair of
    // units has it. With two pairs E20 is in the place of the edge that the pair has no use for.
    logic [1:0] determinant, det_edge, det_vertex, corner_edge, edge_index;
    logic [2:0] kind;
    logic [3:0] job_function;
    logic [4*EDGE_WIDTH-1:0] words;

    for (genvar g = 0; g < 4; g++) begin : gen_word
      localparam int F = (PAIRS == 2 && g == 3 * (1 - p)) ? 4 : g;
      assign words[g*EDGE_WIDTH+:EDGE_WIDTH] = {lin_value_i[F*VAL+:VAL], lin_gx_i[F*GRAD+:GRAD],
          lin_gy_i[F*GRAD+:GRAD]};
    end

    assign determinant = (PAIRS == 1) ? det_step[2:1] : {1'(p), det_step[1]};

    always_comb begin
      case (determinant)
        2'd0: {det_edge, det_vertex} = {2'd0, 2'd2};
        2'd1: {det_edge, det_vertex} = {2'd2, 2'd0};
        2'd2: {det_edge, det_vertex} = {2'd1, 2'd3};
        default: {det_edge, det_vertex} = (PAIRS == 1) ? {2'd0, 2'd3} : {2'd3, 2'd1};
      endcase
      // The pair of a vertex with itself is a function from 6 on.
      if (is_side) begin
        kind = quadrille_pkg::MOVE;
        job_function = 4'd6 + 4'(side_vertex) + 4'(p);
      end else if (is_det || is_corner) begin
        kind = (second ^ is_corner) ? quadrille_pkg::DET_VALUE : quadrille_pkg::DET_GRADIENT;
        job_function = is_det ? 4'd6 + 4'(det_vertex) : 4'd7 + 4'(p);
      end else begin
        kind = is_edge ? quadrille_pkg::EDGE : quadrille_pkg::EDGE_GRADIENT;
        job_function = 4'(PAIRS) * 4'(group) + 4'(p);
      end
    end

    assign corner_edge = (PAIRS == 1) ? (step[5] ? step[2:1] : 2'd3) :
        (p == 0) ? step[2:1] - 2'd2 : (step[2:1] == 2'd1) ? 2'd0 : step[2:1];

    always_ff @(posedge clk_i) begin
      kinds[p*3+:3] <= kind;
      functions[p*4+:4] <= job_function;
      edge_index <= is_corner ? corner_edge : det_edge;
    end

    quadrille_one_of_four #(.WIDTH(EDGE_WIDTH)) u_edge (
        .words_i(words), .index_i(edge_index), .word_o(edge_words[p*EDGE_WIDTH+:EDGE_WIDTH])
    );
  end

  assign jobs_o = {kinds, functions, tx_q, ty_q, w_q, offset_x, offset_y};
  assign edges_o = edge_words;

  logic unused;
  assign unused = ^{det_step[5:3], side_step[5:3], lin_value_i, lin_gx_i, lin_gy_i, negative_i};

`ifndef SYNTHESIS
  logic front_q;  // the quad is in the middle a clock later

  always_ff @(posedge clk_i) begin
    front_q <= load_i;
    if (rst_ni) begin
      `QUADRILLE_ASSERT(assert_corner_steps,
          !run_i || ordinary_i || step_q < CORNERS - 6'd1 || !front_q,
          "a corner step takes no vertex that is to move on")
    end
  end
`endif
endmodule
