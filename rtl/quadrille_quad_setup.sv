// SPDX-License-Identifier: Apache-2.0
`include "quadrille_assert.svh"
`include "quadrille_types.svh"

// Setup of one quad: origin tile, 6 linear functions (value at the origin, first differences), squared lengths of its sides and
// diagonals, visibility of the clauses. SPEC.md has the clocks: two for the bounding box, while vertex_assembly holds the
// quad; start; then a step a clock, in which every pair of dot units has a job: 6 steps or, of a homogeneous quad, 40; with two pairs 3 or 24.
// Half of a homogeneous quad's ask whether it misses the scissor (separate_i; else 20 or 11 steps).
//
// Four quads may be here, one behind the other: one does its steps (front_*), one whose results are still to come waits (middle_*), of one
// they come, six clocks after their jobs (sum_*), one waits complete for take_i (the outputs). So the steps go on while results are on their way and while
// the walk is busy. A quad starts only when those before it will surely have moved on by the time its first result comes.
//
// Linear function f: f*VAL_BITS, exact, two's complement. Squared lengths: unsigned, without their QDROP lowest bits.
// A quad that cannot give a fragment by its triangles' areas (reject_i), or misses the scissor, is dropped: an ordinary one while its last
// result comes, else when it is complete. An empty bounding box gives zero tiles.
module quadrille_quad_setup #(
    localparam int T = quadrille_pkg::T_BITS,
    localparam int W = quadrille_pkg::W_BITS,
    localparam int V = quadrille_pkg::VIEWPORT_BITS,
    localparam int TC = quadrille_pkg::TC_BITS,
    localparam int VAL = quadrille_pkg::VAL_BITS,
    localparam int GRAD = quadrille_pkg::GRAD_BITS,
    localparam int REACH = quadrille_pkg::REACH_BITS,
    localparam int RISE = quadrille_pkg::RISE_BITS,
    localparam int LENGTH2 = quadrille_pkg::LENGTH2_BITS,
    localparam int OUT = quadrille_pkg::DOT_OUT_BITS,
    localparam int PAIRS = quadrille_pkg::PRODUCT_PAIRS,
    localparam int TL = quadrille_pkg::TILE_LOG2,
    localparam int SLOT = quadrille_pkg::QUAD_SLOTS_LOG2,
    localparam int EDGE_WIDTH = VAL + 2 * GRAD
) (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    input logic [quadrille_pkg::STATE_BITS-1:0] state_i,
    // Quad in: held until start_i, which needs ready_o
    input logic held_i,
    input logic start_i,
    output logic ready_o,
    input logic empty_i,  // no pixel centre inside scissor and bounding box
    input logic [SLOT-1:0] slot_i,
    input logic [quadrille_pkg::QUAD_BITS-1:0] quad_i,
    // Jobs of vertex_products; their step is repeated while wait_i. The edge functions of DET jobs: value, gx, gy
    input logic wait_i,
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
  logic [quadrille_pkg::QUAD_SLOTS_LOG2-1:0] setup_slot;
  logic [quadrille_pkg::TC_BITS-1:0] setup_tile_x0, setup_tile_y0, setup_tiles_x, setup_tiles_y;
  logic [quadrille_pkg::TILE_LOG2-1:0] setup_last_row;
  logic [4*quadrille_pkg::T_BITS-1:0] setup_x, setup_y;
  logic [4*quadrille_pkg::W_BITS-1:0] setup_w;
  logic setup_homogeneous, setup_hull;
  logic [3:0] setup_visible;
  logic [6*quadrille_pkg::VAL_BITS-1:0] setup_lin_value;
  logic [6*quadrille_pkg::GRAD_BITS-1:0] setup_lin_gx, setup_lin_gy;
  logic [4:0] setup_tie_pos, setup_tie_neg;
  logic [5*quadrille_pkg::REACH_BITS-1:0] setup_fall_tile, setup_rise_tile, setup_fall_block, setup_rise_block;
  logic [6*quadrille_pkg::LENGTH2_BITS-1:0] setup_length2;
  localparam int FRAC = quadrille_pkg::FRAC;
  localparam int QDROP = quadrille_pkg::QDROP;
  localparam int DET = quadrille_pkg::DET_BITS;
  localparam int CLOCKS = quadrille_pkg::VERTEX_PRODUCT_CLOCKS;

  // ---- Bounding box: clamped in the first clock in which the quad is there, its tiles in the second -------------------------
  localparam logic [1:0] NEW = 2'd0;
  localparam logic [1:0] CLAMPED = 2'd1;
  localparam logic [1:0] BOXED = 2'd2;
  logic [1:0] box_state_q;
  logic [TC-1:0] first_x, first_y, count_x, count_y;
  logic [TL-1:0] last_column, last_row;
  logic [TC-1:0] box_x0_q, box_y0_q, box_x_q, box_y_q;
  logic [TL-1:0] box_row_q;

  quadrille_bounding_range u_range_x (
      .clk_i,
      .load_i(box_state_q == NEW),
      .low_i(quad.low_x),
      .high_i(quad.high_x),
      .ordinary_i(quad.ordinary),
      .scissor0_i(state.scissor_x0),
      .scissor1_i(state.scissor_x1),
      .first_o(first_x),
      .count_o(count_x),
      .last_o(last_column)
  );

  quadrille_bounding_range u_range_y (
      .clk_i,
      .load_i(box_state_q == NEW),
      .low_i(quad.low_y),
      .high_i(quad.high_y),
      .ordinary_i(quad.ordinary),
      .scissor0_i(state.scissor_y0),
      .scissor1_i(state.scissor_y1),
      .first_o(first_y),
      .count_o(count_y),
      .last_o(last_row)
  );

  always_ff @(posedge clk_i) begin
    if (!rst_ni || start_i) box_state_q <= NEW;
    else if (box_state_q == NEW) box_state_q <= held_i ? CLAMPED : NEW;
    else box_state_q <= BOXED;
  end

  always_ff @(posedge clk_i) begin
    if (box_state_q == CLAMPED) begin
      box_x0_q <= empty_i ? '0 : first_x;
      box_y0_q <= empty_i ? '0 : first_y;
      box_x_q <= empty_i ? '0 : count_x;
      box_y_q <= empty_i ? '0 : count_y;
      box_row_q <= last_row;
    end
  end

  // ---- The four quads -----------------------------------------------------------------------------------------------------
  logic run_q;  // steps are left
  logic [5:0] step_q;
  logic front_q;  // a quad has started; in the next clock it is in the middle too, which is free then
  logic middle_q;  // a quad waits for results to come
  logic sum_q;  // results are of a quad that is not among the outputs yet
  logic complete_q;  // all are there
  logic done_q;  // a quad is among the outputs
  logic left_out_q;  // one that cannot give a fragment
  logic last, run_end, advance, hand_over, gone;
  logic drop_result, drop_summed;
  logic alone;  // one quad at most, but for one that goes and for the outputs, is before the next one

  // The step is the last one, and done. With one pair of units the next quad's first result then comes in the very clock after the last of
  // this one; with two pairs a function's reach is a clock behind, so that the steps pause for one.
  assign run_end = run_q && last && !wait_i;
  assign advance = middle_q && (!sum_q || hand_over || drop_summed);
  assign hand_over = complete_q && !drop_summed && (!done_q || gone);
  assign gone = take_i || drop_result;
  assign alone = !(sum_q && middle_q) || drop_summed;
  assign ready_o = box_state_q == BOXED && (!run_q || (PAIRS == 1 && run_end)) && alone && (!(sum_q || middle_q) || !done_q || gone);

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      run_q <= 1'b0;
      front_q <= 1'b0;
      middle_q <= 1'b0;
      sum_q <= 1'b0;
      done_q <= 1'b0;
    end else begin
      run_q <= start_i || (run_q && !run_end);
      front_q <= start_i;
      middle_q <= front_q || (middle_q && !advance);
      sum_q <= advance || (sum_q && !hand_over && !drop_summed);
      done_q <= hand_over || (done_q && !gone);
    end
  end

  // ---- What goes with a quad: slot, tiles, vertices relative to the origin pixel (a shift: W = ONE or the origin is 0) --------
  localparam int PLACE = SLOT + 4 * TC + TL + 1 + 4 * (2 * T + W);
  logic [T-1:0] origin_x, origin_y;
  logic [4*T-1:0] from_origin_x, from_origin_y;
  logic front_ordinary_q, sum_ordinary;
  logic [SLOT-1:0] front_slot_q;
  logic [4*TC-1:0] front_tiles_q;
  logic [TL-1:0] front_row_q;
  logic [4*T-1:0] tx_q, ty_q;
  logic [4*W-1:0] w_q;
  logic [PLACE-1:0] middle_place_q, sum_place_q;

  assign origin_x = T'(box_x0_q) << (TL + FRAC);
  assign origin_y = T'(box_y0_q) << (TL + FRAC);
  assign sum_ordinary = sum_place_q[PLACE-1];

  always_ff @(posedge clk_i) begin
    if (start_i) begin
      front_ordinary_q <= quad.ordinary;
      front_slot_q <= slot_i;
      front_tiles_q <= {box_x0_q, box_y0_q, box_x_q, box_y_q};
      front_row_q <= box_row_q;
    end
    if (front_q) middle_place_q <= {front_ordinary_q, front_slot_q, front_tiles_q, front_row_q, tx_q, ty_q, w_q};
    if (advance) sum_place_q <= middle_place_q;
    if (hand_over) begin
      {setup_slot, setup_tile_x0, setup_tile_y0, setup_tiles_x, setup_tiles_y, setup_last_row, setup_x, setup_y, setup_w} <= sum_place_q[PLACE-2:0];
      setup_homogeneous <= !sum_ordinary;
    end
  end

  // ---- Steps --------------------------------------------------------------------------------------------------------------
  // Of an ordinary quad the edge functions and with each its pair's squared length; its gradients need no product. Of a homogeneous quad
  // each edge function's gradient, then its value; then the determinants, vector times vector, in two steps, gradient and value. By then
  // its edge function has both: with two pairs of units a step without a job is needed. In a step pair p of the units has function
  // PAIRS group + p, or the determinant (4 / PAIRS) p + group.
  // Then for scissor_separation: the vertices from two corners of the scissor (sides), and like a determinant each edge of either
  // triangle at one of its corners, value and gradient. The corner takes the place of a vertex that is not needed any more.
  // With one pair of units E30 comes late: until E20 has been at both corners its register holds E20 too, which else no product reaches.
  localparam logic [5:0] LAST_ORDINARY = 6'(6 / PAIRS - 1);
  localparam logic [5:0] FUNCTIONS_END = (PAIRS == 1) ? 6'd10 : 6'd6;
  localparam logic [5:0] DETERMINANTS = (PAIRS == 1) ? 6'd10 : 6'd7;
  localparam logic [5:0] SIDES = DETERMINANTS + 6'(8 / PAIRS);
  localparam logic [5:0] LATE = (PAIRS == 1) ? 6'd30 : 6'd15;  // of E30; with two pairs nothing, the determinants' signs are to come
  localparam logic [5:0] CORNERS = (PAIRS == 1) ? 6'd26 : 6'd18;
  localparam logic [5:0] LAST_TOGETHER = (PAIRS == 1) ? LATE + 6'd1 : SIDES - 6'd1;  // without state.skip[3]
  localparam logic [5:0] LAST_SEPARATE = (PAIRS == 1) ? 6'd39 : 6'd23;

  logic to_late;  // the next step is LATE
  logic is_function, is_late, is_edge, is_gradient, is_det, is_side, is_corner;
  logic det_second;  // of a determinant, or of an edge at a corner
  logic [5:0] det_step, side_step;  // 2 group + half
  logic side_far;  // from the corner (x1, y1)
  logic [1:0] side_vertex;
  logic [PAIRS-1:0] corner_triangle, corner_negated;
  logic [2:0] group;

  assign last = step_q == (front_ordinary_q ? LAST_ORDINARY : state.skip[3] ? LAST_SEPARATE : LAST_TOGETHER);
  assign to_late = PAIRS == 1 && !state.skip[3] && step_q == SIDES - 6'd1;
  assign is_late = PAIRS == 1 && step_q[5:1] == LATE[5:1];
  assign is_function = step_q < FUNCTIONS_END || is_late;
  assign is_edge = front_ordinary_q || (is_function && step_q[0]);
  assign is_gradient = !front_ordinary_q && is_function && !step_q[0];
  assign is_det = !front_ordinary_q && step_q >= DETERMINANTS && step_q < SIDES;
  assign is_side = !front_ordinary_q && step_q >= SIDES && step_q < SIDES + 6'(8 / PAIRS);
  assign is_corner = !front_ordinary_q && step_q >= CORNERS && !is_late;
  assign det_step = step_q - DETERMINANTS;
  assign det_second = is_corner ? step_q[0] : det_step[0];
  assign side_step = step_q - SIDES;
  assign side_far = (PAIRS == 1) ? side_step[2] : side_step[1];
  assign side_vertex = (PAIRS == 1) ? side_step[1:0] : {side_step[0], 1'b0};

  always_comb begin
    group = step_q[3:1];
    if (front_ordinary_q) group = step_q[2:0];
    else if (is_late) group = 3'd3;
    else if (PAIRS == 1 && step_q[3:1] >= 3'd3) group = step_q[3:1] + 3'd1;
  end

  always_ff @(posedge clk_i) begin
    if (start_i) step_q <= '0;
    else step_q <= wait_i ? step_q : to_late ? LATE : step_q + 6'd1;
  end

  // ---- Corners of the scissor in a vertex's place, in pixels: chosen while the edge function's value is multiplied -------------
  logic [6*VAL-1:0] lin_value_q;
  logic [6*GRAD-1:0] lin_gx_q, lin_gy_q;
  logic [PAIRS*EDGE_WIDTH-1:0] edge_words;  // value, gx, gy
  logic [3:0] negative, zero;  // of d_012, d_023, d_123, d_013
  logic [PAIRS*(V+1)-1:0] corner_x, corner_y;
  logic side_far_q;
  logic [V:0] offset_x, offset_y;  // of a MOVE, a clock after the job
  logic [PAIRS*3-1:0] kinds;
  logic [PAIRS*4-1:0] functions;

  always_ff @(posedge clk_i) side_far_q <= side_far;

  for (genvar p = 0; p < PAIRS; p++) begin : gen_corner
    logic far_x, far_y, is_diagonal;  // E20, whose sense is reversed in the triangle 023

    // With one pair of units E20 of either triangle in steps 26 to 29, from 32 on E01, E12, E23, E30; with two E20 in 18, 19.
    assign is_diagonal = (PAIRS == 1) ? !step_q[5] : step_q[2:1] == 2'd1;
    assign corner_triangle[p] = (PAIRS == 2) ? 1'(p) : step_q[2];
    assign corner_negated[p] = corner_triangle[p] ? negative[1] ^ is_diagonal : negative[0];
    assign far_x = edge_words[p*EDGE_WIDTH+2*GRAD-1] == corner_negated[p];
    assign far_y = edge_words[p*EDGE_WIDTH+GRAD-1] == corner_negated[p];
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
    assign to_corner = IS_CORNER && run_q && is_corner && !step_q[0];
    assign to_one = IS_CORNER && run_q && !front_ordinary_q && state.skip[3] && step_q == CORNERS - 6'd1;

    always_ff @(posedge clk_i) begin
      if (to_corner) begin
        tx_q[g*T+V+1+:T-V-1] <= '0;
        ty_q[g*T+V+1+:T-V-1] <= '0;
      end else if (start_i) begin
        tx_q[g*T+V+1+:T-V-1] <= from_origin_x[g*T+V+1+:T-V-1];
        ty_q[g*T+V+1+:T-V-1] <= from_origin_y[g*T+V+1+:T-V-1];
      end
      if (to_corner || start_i) begin
        tx_q[g*T+:V+1] <= to_corner ? corner_x[P*(V+1)+:V+1] : from_origin_x[g*T+:V+1];
        ty_q[g*T+:V+1] <= to_corner ? corner_y[P*(V+1)+:V+1] : from_origin_y[g*T+:V+1];
      end
      if (to_one) w_q[g*W+:W] <= W'(1);
      else if (start_i) w_q[g*W+:W] <= quad.w[g*W+:W];
    end
  end

  assign jobs_o = {kinds, functions, tx_q, ty_q, w_q, offset_x, offset_y};
  assign edges_o = edge_words;
  assign setup_o = {setup_slot, setup_tile_x0, setup_tile_y0, setup_tiles_x, setup_tiles_y, setup_last_row, setup_x,
      setup_y, setup_w, setup_homogeneous, setup_hull, setup_visible, setup_lin_value, setup_lin_gx, setup_lin_gy,
      setup_tie_pos, setup_tie_neg, setup_fall_tile, setup_rise_tile, setup_fall_block, setup_rise_block,
      setup_length2};

  for (genvar p = 0; p < PAIRS; p++) begin : gen_job
    // d_012 = E01 . V2, d_023 = E23 . V0, d_123 = E12 . V3, d_013 = E01 . V3, or E30 . V1 where the second pair of units has it.
    // With two pairs E20 is in the place of the edge that the pair has no use for.
    logic [1:0] determinant, det_edge, det_vertex, corner_edge, edge_index;
    logic [2:0] kind;
    logic [3:0] job_function;
    logic [4*EDGE_WIDTH-1:0] words;

    for (genvar g = 0; g < 4; g++) begin : gen_word
      localparam int F = (PAIRS == 2 && g == 3 * (1 - p)) ? 4 : g;

      assign words[g*EDGE_WIDTH+:EDGE_WIDTH] = {lin_value_q[F*VAL+:VAL], lin_gx_q[F*GRAD+:GRAD], lin_gy_q[F*GRAD+:GRAD]};
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
        kind = (det_second ^ is_corner) ? quadrille_pkg::DET_VALUE : quadrille_pkg::DET_GRADIENT;
        job_function = is_det ? 4'd6 + 4'(det_vertex) : 4'd7 + 4'(p);
      end else begin
        kind = is_edge ? quadrille_pkg::EDGE : quadrille_pkg::EDGE_GRADIENT;
        job_function = 4'(PAIRS) * 4'(group) + 4'(p);
      end
    end

    assign kinds[p*3+:3] = kind;
    assign functions[p*4+:4] = job_function;
    assign corner_edge = (PAIRS == 1) ? (step_q[5] ? step_q[2:1] : 2'd3) :
        (p == 0) ? step_q[2:1] - 2'd2 : (step_q[2:1] == 2'd1) ? 2'd0 : step_q[2:1];
    assign edge_index = is_corner ? corner_edge : det_edge;

    quadrille_one_of_four #(.WIDTH(EDGE_WIDTH)) u_edge (
        .words_i(words),
        .index_i(edge_index),
        .word_o(edge_words[p*EDGE_WIDTH+:EDGE_WIDTH])
    );
  end

  // ---- Gradients of an ordinary quad: differences of coordinates, which wait beside the products of the value's job ----------
  // gx = Ty_i - Ty_j, gy = Tx_j - Tx_i, both times 2^FRAC.
  logic [PAIRS*RISE-1:0] apart_x, apart_y;

  quadrille_delay_line #(.WIDTH(2 * PAIRS * RISE), .DEPTH(CLOCKS - 1)) u_apart (
      .clk_i,
      .data_i({products.apart_x, products.apart_y}),
      .data_o({apart_x, apart_y})
  );

  // ---- What the jobs are whose results are there ----------------------------------------------------------------------------
  localparam int JOB = 5 + 3 + 2 * PAIRS + 1 + 1;
  logic step_done;
  logic edge_job, gradient_job, det_job, side_job, corner_job, second_job, ordinary_job;
  logic [2:0] job_group;  // of sides: which corner, vertex
  logic [PAIRS-1:0] job_triangle, job_negated;
  logic [JOB-1:0] job;
  logic [CLOCKS*JOB-1:0] job_q;

  assign step_done = run_q && !wait_i;
  assign job = {
    {5{step_done}} & {is_edge, is_gradient, is_det, is_side, is_corner},
    is_side ? {side_far, side_vertex} : group,
    corner_triangle,
    corner_negated,
    det_second,
    front_ordinary_q
  };
  assign {edge_job, gradient_job, det_job, side_job, corner_job, job_group, job_triangle, job_negated, second_job, ordinary_job} =
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

  // ---- Destinations: functions load from few buses -------------------------------------------------------------------------
  logic load_gradient, load_reach_q;
  logic [2:0] reach_group_q;

  assign load_gradient = gradient_job || (edge_job && ordinary_job);

  always_ff @(posedge clk_i) begin
    load_reach_q <= load_gradient;
    reach_group_q <= job_group;
  end

  for (genvar p = 0; p < PAIRS; p++) begin : gen_result
    logic [OUT-1:0] result0, result1;
    logic [VAL-1:0] value;
    logic [LENGTH2-1:0] length2;
    logic [GRAD-1:0] gx, gy;
    logic tie_pos, tie_neg;
    logic [REACH-1:0] fall_tile, rise_tile, fall_block, rise_block;
    logic [GRAD-1:0] reach_gx_q, reach_gy_q;

    assign result0 = products.result0[p*OUT+:OUT];
    assign result1 = products.result1[p*OUT+:OUT];
    assign value = VAL'(result0);
    assign length2 = LENGTH2'(result1 >> QDROP);
    assign gx = ordinary_job ? GRAD'($signed(apart_y[p*RISE+:RISE])) << FRAC : GRAD'(result0);
    assign gy = ordinary_job ? GRAD'($signed(apart_x[p*RISE+:RISE])) << FRAC : GRAD'(result1);

    // The reach of a function whose gradient was loaded in the clock before.
    always_ff @(posedge clk_i) {reach_gx_q, reach_gy_q} <= {gx, gy};

    quadrille_edge_reach u_reach (
        .gx_i(reach_gx_q),
        .gy_i(reach_gy_q),
        .tie_pos_o(tie_pos),
        .tie_neg_o(tie_neg),
        .fall_tile_o(fall_tile),
        .rise_tile_o(rise_tile),
        .fall_block_o(fall_block),
        .rise_block_o(rise_block)
    );

    logic unused;
    assign unused = ^{result0, result1};  // the upper bits, in small configurations
  end

  localparam int REACHES = 2 + 4 * REACH;
  logic [6*LENGTH2-1:0] length2_q;

  for (genvar g = 0; g < 6; g++) begin : gen_function
    localparam int P = g % PAIRS;
    localparam logic [2:0] GROUP = 3'(g / PAIRS);
    logic mine;

    assign mine = job_group == GROUP || (PAIRS == 1 && g == 3 && job_group == 3'd4 && !ordinary_job);

    always_ff @(posedge clk_i) begin
      if (edge_job && mine) begin
        lin_value_q[g*VAL+:VAL] <= gen_result[P].value;
        length2_q[g*LENGTH2+:LENGTH2] <= gen_result[P].length2;
      end
      if (load_gradient && mine) begin
        lin_gx_q[g*GRAD+:GRAD] <= gen_result[P].gx;
        lin_gy_q[g*GRAD+:GRAD] <= gen_result[P].gy;
      end
      if (hand_over) begin
        setup_lin_value[g*VAL+:VAL] <= lin_value_q[g*VAL+:VAL];
        setup_length2[g*LENGTH2+:LENGTH2] <= length2_q[g*LENGTH2+:LENGTH2];
        setup_lin_gx[g*GRAD+:GRAD] <= lin_gx_q[g*GRAD+:GRAD];
        setup_lin_gy[g*GRAD+:GRAD] <= lin_gy_q[g*GRAD+:GRAD];
      end
    end

    if (g < 5) begin : gen_reach  // not of the diagonal 13, which is no edge of a clause
      logic [REACHES-1:0] reach_q;

      always_ff @(posedge clk_i) begin
        if (load_reach_q && reach_group_q == GROUP) begin
          reach_q <= {
            gen_result[P].tie_pos,
            gen_result[P].tie_neg,
            gen_result[P].fall_tile,
            gen_result[P].rise_tile,
            gen_result[P].fall_block,
            gen_result[P].rise_block
          };
        end
        if (hand_over) begin
          {
            setup_tie_pos[g],
            setup_tie_neg[g],
            setup_fall_tile[g*REACH+:REACH],
            setup_rise_tile[g*REACH+:REACH],
            setup_fall_block[g*REACH+:REACH],
            setup_rise_block[g*REACH+:REACH]
          } <= reach_q;
        end
      end
    end
  end

  // ---- Determinants d_012, d_023, d_123, d_013, a pair of units' own one after the other in one accumulator ------------------
  // The edges at the scissor's corners come to it behind them: then the last determinant's sign is kept (kept_*).
  localparam int DETS = 4 / PAIRS;
  logic cornered_q;
  logic [PAIRS-1:0] corner_neg, corner_zero;
  logic judge_q;
  logic [PAIRS-1:0] judge_triangle_q, judge_negated_q;

  always_ff @(posedge clk_i) begin
    cornered_q <= corner_job || (cornered_q && !det_job);
    judge_q <= corner_job && second_job;
    {judge_triangle_q, judge_negated_q} <= {job_triangle, job_negated};
  end

  for (genvar p = 0; p < PAIRS; p++) begin : gen_determinant
    logic [DET-1:0] det_q;
    logic [DETS-2:0] det_neg_q, det_zero_q;  // of those before the last, the latest at bit 0
    logic det_neg, det_zero, kept_neg_q, kept_zero_q;

    assign det_neg = det_q[DET-1];
    assign det_zero = det_q == '0;
    assign corner_neg[p] = det_neg;
    assign corner_zero[p] = det_zero;

    always_ff @(posedge clk_i) begin
      if (!cornered_q) {kept_neg_q, kept_zero_q} <= {det_neg, det_zero};
      if (det_job || corner_job) begin
        det_q <= (second_job ? det_q : '0) + DET'($signed(products.result0[p*OUT+:OUT])) + (DET'($signed(products.result1[p*OUT+:OUT])) << 32);
        if (det_job && !second_job) begin
          det_neg_q <= (DETS - 1)'({det_neg_q, det_neg});
          det_zero_q <= (DETS - 1)'({det_zero_q, det_zero});
        end
      end
    end

    assign negative[p*DETS+DETS-1] = cornered_q ? kept_neg_q : det_neg;
    assign zero[p*DETS+DETS-1] = cornered_q ? kept_zero_q : det_zero;

    for (genvar k = 0; k < DETS - 1; k++) begin : gen_before
      assign negative[p*DETS+k] = det_neg_q[DETS-2-k];
      assign zero[p*DETS+k] = det_zero_q[DETS-2-k];
    end
  end

  logic hull;
  logic [3:0] visible;  // of the clauses, as setup_visible

  quadrille_eye_in_hull u_eye_in_hull (
      .ordinary_i(sum_ordinary),
      .negative_i(negative),
      .zero_i(zero),
      .hull_o(hull),
      .visible_o(visible)
  );

  // ---- Triangles that miss the scissor --------------------------------------------------------------------------------------
  logic [PAIRS-1:0] side_x_neg, side_y_neg;
  logic [3:0] sum_w_neg;
  logic [4:0] gx_neg, gy_neg;
  logic [1:0] separated;

  for (genvar p = 0; p < PAIRS; p++) begin : gen_side
    assign side_x_neg[p] = products.result0[p*OUT+OUT-1];
    assign side_y_neg[p] = products.result1[p*OUT+OUT-1];
  end

  for (genvar g = 0; g < 4; g++) begin : gen_w_sign
    assign sum_w_neg[g] = sum_place_q[g*W+W-1];
  end

  for (genvar g = 0; g < 5; g++) begin : gen_gradient_sign
    assign gx_neg[g] = lin_gx_q[g*GRAD+GRAD-1];
    assign gy_neg[g] = lin_gy_q[g*GRAD+GRAD-1];
  end

  quadrille_scissor_separation u_separation (
      .clk_i,
      .clear_i(det_job),
      .side_i(side_job),
      .far_i(job_group[2]),
      .vertex_i(job_group[1:0]),
      .x_neg_i(side_x_neg),
      .y_neg_i(side_y_neg),
      .w_neg_i(sum_w_neg),
      .gx_neg_i(gx_neg),
      .gy_neg_i(gy_neg),
      .edge_i({PAIRS{judge_q}}),
      .triangle_i(judge_triangle_q),
      .negated_i(judge_negated_q),
      .value_neg_i(corner_neg),
      .value_zero_i(corner_zero),
      .separated_o(separated)
  );

  logic [3:0] missing;

  assign missing = {4{cornered_q && !sum_ordinary && !hull}} & {separated, separated};

  always_ff @(posedge clk_i) if (hand_over) {setup_hull, setup_visible} <= {hull, visible};

  // ---- Left out: both triangles of expression (12) without area, or turned away -------------------------------------------------
  // An ordinary quad's triangles have the areas of E01 + E12 + E20 and E23 + E30 - E20, anywhere: added up as the values come, and known a
  // clock before all is. A homogeneous quad's clauses are those of its determinants, but for triangles that miss the scissor.
  localparam int AREA = VAL + 2;
  logic [AREA-1:0] area_012_q, area_023_q;
  logic [3:0] area_signs_q, wanted, turned;  // as the clauses of setup_visible

  // By their group: with one pair of units 01, 12, 23, 30, 20; with two 01 and 12, 23 and 30, 20 (and 13, which is in neither).
  logic [AREA-1:0] area_value, area_value2;  // of the first pair of units, of the second
  logic [AREA-1:0] area_012_next, area_023_next;
  logic in_012, in_023, diagonal;

  assign area_value = AREA'($signed(gen_result[0].value));
  assign area_value2 = (PAIRS == 1) ? '0 : AREA'($signed(gen_result[PAIRS-1].value));
  assign diagonal = job_group == ((PAIRS == 1) ? 3'd4 : 3'd2);
  assign in_012 = job_group < ((PAIRS == 1) ? 3'd2 : 3'd1);
  assign in_023 = (PAIRS == 1) ? job_group[2:1] == 2'd1 : job_group == 3'd1;
  assign area_012_next = (job_group == 3'd0 ? '0 : area_012_q) + (in_012 || diagonal ? area_value : '0) + (in_012 ? area_value2 : '0);
  assign area_023_next = (job_group == 3'd0 ? '0 : area_023_q) + (in_023 ? area_value : diagonal ? ~area_value : '0) +
      (in_023 ? area_value2 : '0) + AREA'(diagonal);

  always_ff @(posedge clk_i) begin
    if (edge_job) begin
      area_012_q <= area_012_next;
      area_023_q <= area_023_next;
      area_signs_q <= {
        area_023_next[AREA-1],
        area_012_next[AREA-1],
        !area_023_next[AREA-1] && area_023_next != '0,
        !area_012_next[AREA-1] && area_012_next != '0
      };
    end
  end

  assign wanted = {{2{state.cull != 2'd1}}, {2{state.cull != 2'd2}}};
  assign turned = (sum_ordinary ? area_signs_q : visible) & wanted;
  assign drop_summed = sum_q && (end_q[END_CLOCKS-1] || complete_q) && sum_ordinary && state.skip[1] && (area_signs_q & wanted) == '0 && !drop_result;

  always_ff @(posedge clk_i) begin
    if (hand_over) left_out_q <= !sum_ordinary && ((state.skip[1] && turned == '0) || (turned != '0 && (turned & ~missing) == '0));
  end

  if (quadrille_pkg::PERFORMANCE_COUNTERS != 0) begin : gen_count
    logic line_q, job_now;

    always_ff @(posedge clk_i) if (hand_over) line_q <= visible == '0;

    assign job_now = run_q && !wait_i && (is_edge || is_gradient || is_det || is_side || is_corner);
    assign events_o = {drop_result ? line_q : area_signs_q == '0, job_now, front_q || middle_q || sum_q || done_q};
  end else begin : gen_no_count
    assign events_o = '0;
  end

  assign drop_result = done_q && left_out_q;
  assign drop_o = drop_result || drop_summed;
  assign drop_slot_o = drop_result ? setup_slot : sum_place_q[PLACE-2-:SLOT];
  assign valid_o = done_q && !left_out_q;

  logic unused;
  assign unused = ^{last_column, det_step[5:3], side_step[5:3]};

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
      `QUADRILLE_ASSERT(assert_corner_steps,
          !run_q || front_ordinary_q || step_q < CORNERS - 6'd1 || !front_q,
          "a corner step takes no vertex that is to move on")
    end
  end
`endif
endmodule
