// SPDX-License-Identifier: Apache-2.0
`include "quadrille_assert.svh"
`include "quadrille_types.svh"
// Setup of one quad: origin tile, 6 linear functions (value at the origin, first differences), squared lengths of its
// sides and diagonals, visibility of the clauses. SPEC.md has the clocks: two for the bounding box, while
// the quad waits; start; then a step a clock, in which every pair of dot units has a job: 6 steps or,
// of a homogeneous quad, 40; with two pairs 3 or 24. Half of a homogeneous quad's ask whether it misses the scissor
// (separate_i; else 20 or 11 steps).
//
// Four quads may be here, one behind the other: one does its steps (front_*), one whose results are still to come waits
// (middle_*), of one they come, six clocks after their jobs (sum_*), one waits complete for take_i (the outputs). So
// the steps go on while results are on their way and while the walk is busy. A quad starts only when those before it
// will surely have moved on by the time its first result comes.
//
// Linear function f: f*VAL_BITS, exact, two's complement. Squared lengths: unsigned, without their QDROP lowest bits. A
// quad that cannot give a fragment by its triangles' areas (reject_i), or misses the scissor, is dropped: an ordinary
// one while its last result comes, else when it is complete. An empty bounding box gives zero tiles.
module quadrille_quad_setup #(
    localparam int T = quadrille_pkg::T_BITS, W = quadrille_pkg::W_BITS, TC = quadrille_pkg::TC_BITS,
    localparam int VAL = quadrille_pkg::VAL_BITS, GRAD = quadrille_pkg::GRAD_BITS, REACH = quadrille_pkg::REACH_BITS,
    localparam int LENGTH2 = quadrille_pkg::LENGTH2_BITS, OUT = quadrille_pkg::DOT_OUT_BITS,
    localparam int PAIRS = quadrille_pkg::PRODUCT_PAIRS, TL = quadrille_pkg::TILE_LOG2,
    localparam int SLOT = quadrille_pkg::QUAD_SLOTS_LOG2, EDGE_WIDTH = VAL + 2 * GRAD
) (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    input logic [quadrille_pkg::STATE_BITS-1:0] state_i,
    // Quad in: waits until start_i, which needs ready_o
    input logic held_i, start_i,
    output logic ready_o,
    input logic empty_i,  // no pixel centre inside scissor and bounding box
    input logic [SLOT-1:0] slot_i,
    input logic [quadrille_pkg::QUAD_BITS-1:0] quad_i,
    // Jobs of vertex_products; their step is repeated while wait_i. The edge functions of DET jobs: value, gx, gy
    input logic wait_i,
    output logic jobs_valid_o,
    output logic [quadrille_pkg::JOBS_BITS-1:0] jobs_o,
    output logic [PAIRS*EDGE_WIDTH-1:0] edges_o,
    input logic [quadrille_pkg::PRODUCTS_BITS-1:0] products_i,
    // Quad out, or left out, of this slot
    output logic valid_o,
    input logic take_i,
    output logic [quadrille_pkg::SETUP_BITS-1:0] setup_o,
    output logic drop_o,
    output logic [SLOT-1:0] drop_slot_o,
    // For performance_counters, else 0: a quad is left out for it is on a line, the dot units get a job, a quad is here
    output logic [2:0] events_o
);
  `QUADRILLE_IN(`QUADRILLE_STATE_T, state)
  `QUADRILLE_IN(`QUADRILLE_QUAD_T, quad)
  `QUADRILLE_IN(`QUADRILLE_PRODUCTS_T, products)
  localparam int CLOCKS = quadrille_pkg::VERTEX_PRODUCT_CLOCKS;
  logic boxed;
  logic [TC-1:0] box_x0, box_y0, box_columns, box_rows;
  logic [TL-1:0] box_last_row;
  quadrille_setup_box u_box (
      .clk_i, .rst_ni, .state_i, .held_i, .start_i, .empty_i, .quad_i, .boxed_o(boxed), .x0_o(box_x0), .y0_o(box_y0),
      .columns_o(box_columns), .rows_o(box_rows), .last_row_o(box_last_row)
  );

  // ---- The four quads ----------------------------------------------------------------------------------------------
  logic run_q;  // steps are left
  logic front_q;  // a quad has started; in the next clock it is in the middle too, which is free then
  logic middle_q;  // a quad waits for results to come
  logic sum_q;  // results are of a quad that is not among the outputs yet
  logic complete_q;  // all are there
  logic valid_q;  // a quad is among the outputs
  logic drop_q;  // or was, for it cannot give a fragment
  logic last, run_end, load, advance, outputs_free, hand_over, left_out, drop_summed;
  logic alone;  // one quad at most, but for one that goes and for the outputs, is before the next one

  // The step is the last one, and done. With one pair of units the next quad's first result then comes in the very
  // clock after the last of this one; with two pairs a function's reach is a clock behind, so that the steps pause for
  // one.
  assign run_end = run_q && last && !wait_i;
  assign load = !run_q || run_end;  // whether or not the quad starts, so that start reaches few registers
  assign advance = middle_q && (!sum_q || (complete_q && outputs_free) || drop_summed);
  assign outputs_free = !valid_q || take_i;
  assign hand_over = complete_q && !drop_summed && outputs_free;
  assign alone = !(sum_q && middle_q) || drop_summed;
  assign ready_o = boxed && (PAIRS == 1 ? load : !run_q) && alone && (!(sum_q || middle_q) || outputs_free);

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      run_q <= 1'b0;
      front_q <= 1'b0;
      middle_q <= 1'b0;
      sum_q <= 1'b0;
      valid_q <= 1'b0;
      drop_q <= 1'b0;
    end else begin
      run_q <= start_i || (run_q && !run_end);
      front_q <= start_i;
      middle_q <= front_q || (middle_q && !advance);
      sum_q <= advance || (sum_q && !hand_over && !drop_summed);
      valid_q <= hand_over ? !left_out : valid_q && !take_i;
      drop_q <= hand_over && left_out;
    end
  end

  // ---- What goes with a quad: slot, tiles, vertices relative to the origin pixel ------------------------------------
  localparam int PLACE = SLOT + 4 * TC + TL + 1 + 4 * (2 * T + W);
  logic front_ordinary_q, sum_ordinary;
  logic [SLOT-1:0] front_slot_q;
  logic [4*TC-1:0] front_tiles_q;
  logic [TL-1:0] front_row_q;
  logic [PLACE-1:0] middle_place_q, sum_place_q;
  /*verilator lint_off UNUSEDSIGNAL*/ `QUADRILLE_JOBS_T jobs;  /*verilator lint_on UNUSEDSIGNAL*/

  assign jobs_valid_o = run_q;
  assign jobs = jobs_o;
  assign sum_ordinary = sum_place_q[PLACE-1];

  always_ff @(posedge clk_i) begin
    if (load) begin
      front_ordinary_q <= quad.ordinary;
      front_slot_q <= slot_i;
      front_tiles_q <= {box_x0, box_y0, box_columns, box_rows};
      front_row_q <= box_last_row;
    end
    if (front_q) middle_place_q <= {front_ordinary_q, front_slot_q, front_tiles_q, front_row_q, jobs.x, jobs.y, jobs.w};
    if (advance) sum_place_q <= middle_place_q;
    if (complete_q && outputs_free) setup_o <= {sum_place_q[PLACE-2:0], !sum_ordinary, hull, visible, functions};
  end

  // ---- Steps, and what comes of them -------------------------------------------------------------------------------
  logic [4:0] kind;
  logic [2:0] group;
  logic [PAIRS-1:0] triangle, negated;
  logic second;
  logic [6*VAL-1:0] lin_value;
  logic [6*GRAD-1:0] lin_gx, lin_gy;
  logic hull;
  logic [3:0] visible;  // of the clauses, as setup.visible
  logic [6*EDGE_WIDTH+10+20*REACH+6*LENGTH2-1:0] functions;  // of setup_o
  assign functions[10+20*REACH+6*LENGTH2+:6*EDGE_WIDTH] = {lin_value, lin_gx, lin_gy};
  logic [3:0] negative, zero;  // d_012, d_023, d_123, d_013
  quadrille_setup_steps u_steps (
      .clk_i, .rst_ni, .state_i, .load_i(load), .quad_i, .tile_x0_i(box_x0), .tile_y0_i(box_y0), .run_i(run_q),
      .ordinary_i(front_ordinary_q), .wait_i, .last_o(last), .jobs_o, .edges_o, .kind_o(kind), .group_o(group),
      .triangle_o(triangle), .negated_o(negated), .second_o(second), .lin_value_i(lin_value), .lin_gx_i(lin_gx),
      .lin_gy_i(lin_gy), .negative_i(negative)
  );

  // ---- What the jobs are whose results are there -------------------------------------------------------------------
  localparam int JOB = 5 + 3 + 2 * PAIRS + 1 + 1;
  logic step_done, edge_job, gradient_job, det_job, side_job, corner_job, second_job, ordinary_job;
  logic [2:0] job_group;  // of sides: which corner, vertex
  logic [PAIRS-1:0] job_triangle, job_negated;
  logic [JOB-1:0] job;
  logic [CLOCKS*JOB-1:0] job_q;
  assign step_done = run_q && !wait_i;
  assign job = {{5{step_done}} & kind, group, triangle, negated, second, front_ordinary_q};
  assign {edge_job, gradient_job, det_job, side_job, corner_job, job_group, job_triangle, job_negated, second_job,
      ordinary_job} =
      job_q[CLOCKS*JOB-1-:JOB];

  // From a quad's last step until all is there: its result, with two pairs of units also the reach of its last edge.
  localparam int END_CLOCKS = CLOCKS + PAIRS - 1;
  logic [END_CLOCKS-1:0] end_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      job_q <= '0;
      end_q <= '0;
      complete_q <= 1'b0;
    end else begin
      job_q <= {job_q[(CLOCKS-1)*JOB-1:0], job};
      end_q <= {end_q[END_CLOCKS-2:0], run_end};
      complete_q <= (end_q[END_CLOCKS-1] || (complete_q && !hand_over)) && !drop_summed;
    end
  end

  logic [PAIRS*VAL-1:0] values;
  quadrille_setup_functions u_functions (
      .clk_i, .products_i, .edge_job_i(edge_job), .gradient_job_i(gradient_job), .job_group_i(job_group),
      .ordinary_job_i(ordinary_job), .value_o(values), .lin_value_o(lin_value), .lin_gx_o(lin_gx), .lin_gy_o(lin_gy),
      .ties_o(functions[20*REACH+6*LENGTH2+:10]), .reaches_o(functions[6*LENGTH2+:20*REACH]),
      .length2_o(functions[0+:6*LENGTH2])
  );

  logic cornered;
  logic [PAIRS-1:0] corner_neg, corner_zero;
  quadrille_setup_determinants u_determinants (
      .clk_i, .products_i, .det_job_i(det_job), .corner_job_i(corner_job), .second_job_i(second_job),
      .negative_o(negative), .zero_o(zero), .cornered_o(cornered), .corner_neg_o(corner_neg),
      .corner_zero_o(corner_zero)
  );

  quadrille_eye_in_hull u_eye_in_hull (
      .ordinary_i(sum_ordinary), .negative_i(negative), .zero_i(zero), .hull_o(hull), .visible_o(visible)
  );

  // ---- Triangles that miss the scissor -----------------------------------------------------------------------------
  logic [PAIRS-1:0] side_x_neg, side_y_neg;
  logic [3:0] sum_w_neg;
  logic [4:0] gx_neg, gy_neg;
  logic [1:0] separated;
  logic judge_q;
  logic [PAIRS-1:0] judge_triangle_q, judge_negated_q;

  always_ff @(posedge clk_i) begin
    judge_q <= corner_job && second_job;
    {judge_triangle_q, judge_negated_q} <= {job_triangle, job_negated};
  end

  for (genvar p = 0; p < PAIRS; p++) begin : gen_side
    assign side_x_neg[p] = products.result0[p*OUT+OUT-1];
    assign side_y_neg[p] = products.result1[p*OUT+OUT-1];
  end

  for (genvar g = 0; g < 4; g++) begin : gen_w_sign
    assign sum_w_neg[g] = sum_place_q[g*W+W-1];
  end

  for (genvar g = 0; g < 5; g++) begin : gen_gradient_sign
    assign gx_neg[g] = lin_gx[g*GRAD+GRAD-1];
    assign gy_neg[g] = lin_gy[g*GRAD+GRAD-1];
  end

  quadrille_scissor_separation u_separation (
      .clk_i, .clear_i(det_job), .side_i(side_job), .far_i(job_group[2]), .vertex_i(job_group[1:0]),
      .x_neg_i(side_x_neg), .y_neg_i(side_y_neg), .w_neg_i(sum_w_neg), .gx_neg_i(gx_neg), .gy_neg_i(gy_neg),
      .edge_i({PAIRS{judge_q}}), .triangle_i(judge_triangle_q), .negated_i(judge_negated_q), .value_neg_i(corner_neg),
      .value_zero_i(corner_zero), .separated_o(separated)
  );

  logic [3:0] missing;
  assign missing = {4{cornered && !sum_ordinary && !hull}} & {separated, separated};

  // ---- Left out: both triangles of expression (12) without area, or turned away ------------------------------------
  // An ordinary quad's triangles have the areas of E01 + E12 + E20 and E23 + E30 - E20, anywhere: added up as the
  // values come, and known a clock before all is. A homogeneous quad's clauses are those of its determinants, but for
  // triangles that miss the scissor.
  logic [3:0] area_signs, wanted, turned;  // as the clauses of setup.visible
  quadrille_setup_areas u_areas (
      .clk_i, .edge_job_i(edge_job), .job_group_i(job_group), .value_i(values), .signs_o(area_signs)
  );

  assign wanted = {{2{state.cull != 2'd1}}, {2{state.cull != 2'd2}}};
  assign turned = (sum_ordinary ? area_signs : visible) & wanted;
  assign drop_summed = sum_q && (end_q[END_CLOCKS-1] || complete_q) && sum_ordinary && state.skip[1] &&
      (area_signs & wanted) == '0 && !drop_q;
  assign left_out = !sum_ordinary && ((state.skip[1] && turned == '0) || (turned != '0 && (turned & ~missing) == '0));

  if (quadrille_pkg::PERFORMANCE_COUNTERS != 0) begin : gen_count
    logic line_q, job_now;

    always_ff @(posedge clk_i) if (hand_over) line_q <= visible == '0;

    assign job_now = run_q && !wait_i && kind != '0;
    assign events_o = {drop_q ? line_q : area_signs == '0, job_now, front_q || middle_q || sum_q || valid_q || drop_q};
  end else begin : gen_no_count
    assign events_o = '0;
  end

  assign drop_o = drop_q || drop_summed;
  assign drop_slot_o = drop_q ? setup_o[quadrille_pkg::SETUP_BITS-1-:SLOT] : sum_place_q[PLACE-2-:SLOT];
  assign valid_o = valid_q;

`ifndef SYNTHESIS
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      `QUADRILLE_ASSERT(assert_start_when_ready,
          !start_i || (held_i && ready_o),
          "start comes with a quad that is held, and ready")
      `QUADRILLE_ASSERT(assert_take_when_valid, !take_i || valid_o, "take comes with valid")
      `QUADRILLE_ASSERT(assert_one_place, !front_q || !middle_q, "a quad is in one place")
      `QUADRILLE_ASSERT(assert_results_owned,
          !(edge_job || gradient_job || det_job || side_job || corner_job) || sum_q || advance,
          "results have a quad")
      `QUADRILLE_ASSERT(assert_results_kept,
          !(edge_job || gradient_job || det_job) || !complete_q || hand_over || drop_summed,
          "results do not overwrite a quad that waits")
    end
  end
`endif
endmodule
