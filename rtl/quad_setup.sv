// Setup of one quad: origin tile, 6 linear functions (value at the origin, first differences), squared lengths of its sides and
// diagonals, visibility of the clauses. README.md section 4 has the clocks: BOX, PREP, then one job of vertex_products a step, 6
// (ordinary) or 20 (homogeneous), and 6 clocks until the last one's result is there; done until taken. The next quad comes in and waits
// in PREP meanwhile.
//
// Linear function f: f*VAL_BITS, exact, two's complement. Squared lengths: unsigned, without their QDROP lowest bits.
// Does not test for a degenerate or culled quad; an empty bounding box gives zero tiles.
module quad_setup #(
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
    localparam int SLOT = quadrille_pkg::QUAD_SLOTS_LOG2
) (
    input logic clk_i,
    input logic rst_ni,
    // Quad in
    input logic start_i,
    input logic [SLOT-1:0] slot_i,
    input logic [4*T-1:0] x_i,
    input logic [4*T-1:0] y_i,
    input logic [4*W-1:0] w_i,
    input logic ordinary_i,  // all W are ONE
    input logic [T-1:0] low_x_i,  // least and greatest coordinates
    input logic [T-1:0] high_x_i,
    input logic [T-1:0] low_y_i,
    input logic [T-1:0] high_y_i,
    input logic [V:0] scissor_x0_i,
    input logic [V:0] scissor_y0_i,
    input logic [V:0] scissor_x1_i,
    input logic [V:0] scissor_y1_i,
    output logic idle_o,
    // Job of vertex_products, its step repeated while wait_i
    input logic wait_i,
    output logic [2:0] kind_o,
    output logic [3:0] function_o,
    output logic [4*T-1:0] x_o,
    output logic [4*T-1:0] y_o,
    output logic [4*W-1:0] w_o,
    output logic [VAL-1:0] edge_value_o,
    output logic [GRAD-1:0] edge_gx_o,
    output logic [GRAD-1:0] edge_gy_o,
    input logic [RISE-1:0] apart_x_i,
    input logic [RISE-1:0] apart_y_i,
    input logic [OUT-1:0] result0_i,
    input logic [OUT-1:0] result1_i,
    // Functions out
    input logic take_i,
    output logic done_o,
    output logic [SLOT-1:0] slot_o,
    output logic [TC-1:0] tile_x0_o,
    output logic [TC-1:0] tile_y0_o,
    output logic [TC-1:0] tiles_x_o,
    output logic [TC-1:0] tiles_y_o,
    output logic homogeneous_o,
    output logic hull_o,
    output logic [3:0] visible_o,
    output logic [6*VAL-1:0] lin_value_o,
    output logic [6*GRAD-1:0] lin_gx_o,
    output logic [6*GRAD-1:0] lin_gy_o,
    output logic [4:0] tie_pos_o,
    output logic [4:0] tie_neg_o,
    output logic [5*REACH-1:0] fall_tile_o,
    output logic [5*REACH-1:0] rise_tile_o,
    output logic [5*REACH-1:0] fall_block_o,
    output logic [5*REACH-1:0] rise_block_o,
    output logic [6*LENGTH2-1:0] length2_o,
    output logic [4*T-1:0] vertex_x_o,  // relative to the first tile's origin pixel
    output logic [4*T-1:0] vertex_y_o,
    output logic [4*W-1:0] vertex_w_o
);
  localparam int FRAC = quadrille_pkg::FRAC;
  localparam int QDROP = quadrille_pkg::QDROP;
  localparam int DET = quadrille_pkg::DET_BITS;
  localparam int CLOCKS = quadrille_pkg::VERTEX_PRODUCT_CLOCKS;
  localparam logic [5:0] LAST_ORDINARY = 6'd5;
  localparam logic [5:0] LAST_HOMOGENEOUS = 6'd19;

  localparam logic [1:0] IDLE = 2'd0;
  localparam logic [1:0] BOX = 2'd1;
  localparam logic [1:0] PREP = 2'd2;
  localparam logic [1:0] RUN = 2'd3;

  // ---- Bounding box: clamped at start, tiles in BOX -----------------------------------------------------------------------
  logic empty_x, empty_y, empty;
  logic [TC-1:0] first_x, first_y, count_x, count_y;

  assign empty = empty_x || empty_y;

  bounding_range u_range_x (
      .clk_i,
      .load_i(start_i),
      .low_i(low_x_i),
      .high_i(high_x_i),
      .ordinary_i,
      .scissor0_i(scissor_x0_i),
      .scissor1_i(scissor_x1_i),
      .empty_o(empty_x),
      .first_o(first_x),
      .count_o(count_x)
  );

  bounding_range u_range_y (
      .clk_i,
      .load_i(start_i),
      .low_i(low_y_i),
      .high_i(high_y_i),
      .ordinary_i,
      .scissor0_i(scissor_y0_i),
      .scissor1_i(scissor_y1_i),
      .empty_o(empty_y),
      .first_o(first_y),
      .count_o(count_y)
  );

  // ---- State --------------------------------------------------------------------------------------------------------------
  // The quad that comes in, up to the last step; behind it the one whose functions are computed and taken: busy_q from its first step
  // until it is taken, wait_q clocks until its last result is there.
  logic [1:0] state_q;
  logic [5:0] step_q;
  logic [SLOT-1:0] slot_q;
  logic next_ordinary_q, ordinary_q;
  logic [TC-1:0] box_x0_q, box_y0_q, box_x_q, box_y_q;
  logic busy_q;
  logic [2:0] wait_q;
  logic last, run;

  assign last = step_q == (ordinary_q ? LAST_ORDINARY : LAST_HOMOGENEOUS);
  assign run = state_q == PREP && (!busy_q || take_i);
  assign idle_o = state_q == IDLE;
  assign done_o = busy_q && state_q != RUN && wait_q == '0;
  assign homogeneous_o = !ordinary_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      state_q <= IDLE;
      step_q <= '0;
      busy_q <= 1'b0;
      wait_q <= '0;
    end else begin
      case (state_q)
        IDLE: if (start_i) state_q <= BOX;
        BOX: state_q <= PREP;
        PREP: if (run) state_q <= RUN;
        default: if (last && !wait_i) state_q <= IDLE;
      endcase
      step_q <= (state_q != RUN) ? '0 : step_q + 6'(!wait_i);
      busy_q <= run || (busy_q && !take_i);
      if (state_q == RUN) wait_q <= 3'(CLOCKS);
      else if (wait_q != '0) wait_q <= wait_q - 3'd1;
    end
  end

  always_ff @(posedge clk_i) begin
    if (start_i) begin
      next_ordinary_q <= ordinary_i;
      slot_q <= slot_i;
    end
    if (state_q == BOX) begin
      box_x0_q <= empty ? '0 : first_x;
      box_y0_q <= empty ? '0 : first_y;
      box_x_q <= empty ? '0 : count_x;
      box_y_q <= empty ? '0 : count_y;
    end
    if (run) begin
      ordinary_q <= next_ordinary_q;
      slot_o <= slot_q;
      tile_x0_o <= box_x0_q;
      tile_y0_o <= box_y0_q;
      tiles_x_o <= box_x_q;
      tiles_y_o <= box_y_q;
    end
  end

  // ---- Vertices, moved to the origin pixel in PREP (a shift: W = ONE or the origin is 0) -----------------------------------
  logic [T-1:0] origin_x, origin_y;
  logic [4*T-1:0] tx_q, ty_q;
  logic [4*W-1:0] w_q;

  assign origin_x = T'(box_x0_q) << (quadrille_pkg::TILE_LOG2 + FRAC);
  assign origin_y = T'(box_y0_q) << (quadrille_pkg::TILE_LOG2 + FRAC);

  for (genvar g = 0; g < 4; g++) begin : gen_vertex
    always_ff @(posedge clk_i) begin
      if (start_i) begin
        tx_q[g*T+:T] <= x_i[g*T+:T];
        ty_q[g*T+:T] <= y_i[g*T+:T];
        w_q[g*W+:W] <= w_i[g*W+:W];
      end else if (run) begin
        tx_q[g*T+:T] <= tx_q[g*T+:T] - origin_x;
        ty_q[g*T+:T] <= ty_q[g*T+:T] - origin_y;
      end
    end
  end

  always_ff @(posedge clk_i) if (state_q == RUN) {vertex_x_o, vertex_y_o, vertex_w_o} <= {tx_q, ty_q, w_q};

  // ---- Steps --------------------------------------------------------------------------------------------------------------
  // An edge function and its pair's squared length a step. An ordinary quad needs no product for the gradients, and no determinant. A
  // determinant, vector times vector, takes two steps: by then its edge function has its gradients.
  localparam logic [5:0] EDGE_END = 6'd6;
  localparam logic [5:0] GRADIENT_END = 6'd12;

  logic is_edge, is_gradient, is_det;
  logic [2:0] det_step;  // 2 (determinant) + half
  logic [1:0] det_edge, det_vertex;  // d_012 = E01 . V2, d_023 = E23 . V0, d_123 = E12 . V3, d_013 = E30 . V1

  assign is_edge = step_q < EDGE_END;
  assign is_gradient = !is_edge && step_q < GRADIENT_END;
  assign is_det = step_q >= GRADIENT_END;
  assign det_step = step_q[2:0] - GRADIENT_END[2:0];

  always_comb begin
    case (det_step[2:1])
      2'd0: {det_edge, det_vertex} = {2'd0, 2'd2};
      2'd1: {det_edge, det_vertex} = {2'd2, 2'd0};
      2'd2: {det_edge, det_vertex} = {2'd1, 2'd3};
      default: {det_edge, det_vertex} = {2'd3, 2'd1};
    endcase
  end

  always_comb begin
    if (is_edge) begin
      kind_o = quadrille_pkg::EDGE;
      function_o = step_q[3:0];
    end else if (is_gradient) begin
      kind_o = quadrille_pkg::EDGE_GRADIENT;
      function_o = step_q[3:0] - EDGE_END[3:0];
    end else begin
      kind_o = det_step[0] ? quadrille_pkg::DET_GRADIENT : quadrille_pkg::DET_VALUE;
      function_o = 4'd6 + 4'(det_vertex);  // the pair of the vertex with itself
    end
  end

  assign x_o = tx_q;
  assign y_o = ty_q;
  assign w_o = w_q;

  one_of_four #(.WIDTH(VAL)) u_edge_value (
      .words_i(lin_value_o[4*VAL-1:0]),
      .index_i(det_edge),
      .word_o(edge_value_o)
  );
  one_of_four #(.WIDTH(GRAD)) u_edge_gx (
      .words_i(lin_gx_o[4*GRAD-1:0]),
      .index_i(det_edge),
      .word_o(edge_gx_o)
  );
  one_of_four #(.WIDTH(GRAD)) u_edge_gy (
      .words_i(lin_gy_o[4*GRAD-1:0]),
      .index_i(det_edge),
      .word_o(edge_gy_o)
  );

  // ---- Gradients of an ordinary quad: differences of coordinates, which wait beside the products of the value's job ----------
  // gx = Ty_i - Ty_j, gy = Tx_j - Tx_i, both times 2^FRAC.
  logic [RISE-1:0] apart_x, apart_y;

  delay_line #(.WIDTH(2 * RISE), .DEPTH(CLOCKS - 1)) u_apart (
      .clk_i,
      .data_i({apart_x_i, apart_y_i}),
      .data_o({apart_x, apart_y})
  );

  // ---- What the job is whose results are there ------------------------------------------------------------------------------
  localparam int JOB = 3 + 4 + 1;
  logic edge_job, gradient_job, det_job, det_second;
  logic [3:0] dest;
  logic [JOB-1:0] job;
  logic [CLOCKS*JOB-1:0] job_q;

  assign job = {{3{state_q == RUN && !wait_i}} & {is_edge, is_gradient, is_det}, function_o, det_step[0]};
  assign {edge_job, gradient_job, det_job, dest, det_second} = job_q[CLOCKS*JOB-1-:JOB];

  always_ff @(posedge clk_i) begin
    if (!rst_ni) job_q <= '0;
    else job_q <= {job_q[(CLOCKS-1)*JOB-1:0], job};
  end

  // ---- Destinations: functions load from few buses -------------------------------------------------------------------------
  logic [VAL-1:0] value;
  logic [LENGTH2-1:0] length2;
  logic [GRAD-1:0] gx, gy;
  logic load_gradient;

  assign value = VAL'(result0_i);
  assign length2 = LENGTH2'(result1_i >> QDROP);
  assign gx = ordinary_q ? GRAD'($signed(apart_y)) << FRAC : GRAD'(result0_i);
  assign gy = ordinary_q ? GRAD'($signed(apart_x)) << FRAC : GRAD'(result1_i);
  assign load_gradient = ordinary_q ? edge_job : gradient_job;

  logic tie_pos, tie_neg;
  logic [REACH-1:0] fall_tile, rise_tile, fall_block, rise_block;

  // The reach of a function whose gradient was loaded in the clock before.
  logic load_reach_q;
  logic [3:0] reach_dest_q;
  logic [GRAD-1:0] reach_gx_q, reach_gy_q;

  always_ff @(posedge clk_i) begin
    load_reach_q <= load_gradient;
    {reach_dest_q, reach_gx_q, reach_gy_q} <= {dest, gx, gy};
  end

  edge_reach u_reach (
      .gx_i(reach_gx_q),
      .gy_i(reach_gy_q),
      .tie_pos_o(tie_pos),
      .tie_neg_o(tie_neg),
      .fall_tile_o(fall_tile),
      .rise_tile_o(rise_tile),
      .fall_block_o(fall_block),
      .rise_block_o(rise_block)
  );

  for (genvar g = 0; g < 6; g++) begin : gen_function
    always_ff @(posedge clk_i) begin
      if (edge_job && dest == g) begin
        lin_value_o[g*VAL+:VAL] <= value;
        length2_o[g*LENGTH2+:LENGTH2] <= length2;
      end
      if (load_gradient && dest == g) begin
        lin_gx_o[g*GRAD+:GRAD] <= gx;
        lin_gy_o[g*GRAD+:GRAD] <= gy;
      end
    end

    if (g < 5) begin : gen_reach  // not of the diagonal 13, which is no edge of a clause
      always_ff @(posedge clk_i) begin
        if (load_reach_q && reach_dest_q == g) begin
          tie_pos_o[g] <= tie_pos;
          tie_neg_o[g] <= tie_neg;
          fall_tile_o[g*REACH+:REACH] <= fall_tile;
          rise_tile_o[g*REACH+:REACH] <= rise_tile;
          fall_block_o[g*REACH+:REACH] <= fall_block;
          rise_block_o[g*REACH+:REACH] <= rise_block;
        end
      end
    end
  end

  logic unused;
  assign unused = ^{result0_i, result1_i};  // the upper bits, in small configurations

  // ---- Determinants d_012, d_023, d_123, d_013, one after the other in one accumulator ---------------------------------------
  logic [DET-1:0] det_q;
  logic [2:0] det_neg_q, det_zero_q;  // of those before the last, the latest at bit 0
  logic det_neg, det_zero;

  assign det_neg = det_q[DET-1];
  assign det_zero = det_q == '0;

  always_ff @(posedge clk_i) begin
    if (det_job) begin
      det_q <= (det_second ? det_q : '0) + DET'($signed(result0_i)) + (DET'($signed(result1_i)) << 32);
      if (!det_second) begin
        det_neg_q <= {det_neg_q[1:0], det_neg};
        det_zero_q <= {det_zero_q[1:0], det_zero};
      end
    end
  end

  logic [3:0] negative, zero, positive;
  logic some_pos, some_neg;  // among d_123, -d_023, d_013, -d_012

  assign negative = {det_neg, det_neg_q[0], det_neg_q[1], det_neg_q[2]};
  assign zero = {det_zero, det_zero_q[0], det_zero_q[1], det_zero_q[2]};
  assign positive = ~negative & ~zero;
  assign some_pos = positive[2] || negative[1] || positive[3] || negative[0];
  assign some_neg = negative[2] || positive[1] || negative[3] || positive[0];
  assign hull_o = !ordinary_q && !(some_pos && some_neg);
  assign visible_o = (ordinary_q || hull_o) ? 4'b1111 : {negative[1:0], positive[1:0]};

`ifndef SYNTHESIS
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      assert (!start_i || idle_o);
      assert (!take_i || done_o);
    end
  end
`endif
endmodule
