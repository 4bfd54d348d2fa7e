// Setup of one quad: origin tile, 6 linear and 10 quadratic functions (value at the origin, first and second differences),
// visibility of the clauses. README.md section 4 has the clocks: BOX, PREP, then one job per dot unit and clock, 8 (ordinary) or 37
// (homogeneous) clocks, and 6 clocks until the last one's result is there; done until taken. The next quad comes in and waits in PREP
// meanwhile.
//
// Linear function f: f*VAL_BITS, exact. Quadratic function f: without its QDROP lowest bits. All two's complement.
// Does not test for a degenerate or culled quad; an empty bounding box gives zero tiles.
module quad_setup #(
    localparam int T = quadrille_pkg::T_BITS,
    localparam int W = quadrille_pkg::W_BITS,
    localparam int V = quadrille_pkg::VIEWPORT_BITS,
    localparam int TC = quadrille_pkg::TC_BITS,
    localparam int VAL = quadrille_pkg::VAL_BITS,
    localparam int GRAD = quadrille_pkg::GRAD_BITS,
    localparam int REACH = quadrille_pkg::REACH_BITS,
    localparam int QVAL = quadrille_pkg::QVAL_BITS,
    localparam int QGRAD = quadrille_pkg::QGRAD_BITS,
    localparam int QCURV = quadrille_pkg::QCURV_BITS,
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
    output logic [10*QVAL-1:0] quad_value_o,
    output logic [10*QGRAD-1:0] quad_gx_o,
    output logic [10*QGRAD-1:0] quad_gy_o,
    output logic [10*QCURV-1:0] quad_q_o
);
  localparam int FRAC = quadrille_pkg::FRAC;
  localparam int QDROP = quadrille_pkg::QDROP;
  localparam int CURV = quadrille_pkg::CURV_BITS;
  localparam int DOT = quadrille_pkg::DOT_BITS;
  localparam int OUT = quadrille_pkg::DOT_OUT_BITS;
  localparam int DET = quadrille_pkg::DET_BITS;
  localparam logic [5:0] LAST_ORDINARY = 6'd7;
  localparam logic [5:0] LAST_HOMOGENEOUS = 6'd36;
  localparam int JOB_CLOCKS = 6;  // from a step to its destination: pair, operands, dot_unit's other registers

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
        default: if (last) state_q <= IDLE;
      endcase
      step_q <= (state_q == RUN) ? step_q + 6'd1 : '0;
      busy_q <= run || (busy_q && !take_i);
      if (state_q == RUN) wait_q <= 3'(JOB_CLOCKS);
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

  // ---- Steps and the jobs of the two dot units ----------------------------------------------------------------------------
  // Values, one function a unit and step: unit 0 the linear functions, then squares 8 and 9; unit 1 quadratics 0 to 7. An ordinary
  // quad needs no product for the rest. Gradients: unit 0 along x, unit 1 along y. Curvatures: two functions. Determinants: two steps
  // each, vector times vector in two halves.
  localparam logic [5:0] LINEAR_END = 6'd6;
  localparam logic [5:0] VALUE_END = 6'd8;
  localparam logic [5:0] LINEAR_GRADIENT_END = 6'd14;
  localparam logic [5:0] GRADIENT_END = 6'd24;
  localparam logic [5:0] CURVATURE_END = 6'd29;

  logic is_linear, is_value, is_linear_gradient, is_quad_gradient, is_curvature, is_det;
  logic [2:0] det_step;  // 2 (determinant) + half
  logic [1:0] det_edge, det_vertex;  // d_012 = E01 . V2, d_023 = E23 . V0, d_123 = E12 . V3, d_013 = E30 . V1

  assign is_linear = step_q < LINEAR_END;  // of unit 0
  assign is_value = step_q < VALUE_END;
  assign is_linear_gradient = !is_value && step_q < LINEAR_GRADIENT_END;
  assign is_quad_gradient = step_q >= LINEAR_GRADIENT_END && step_q < GRADIENT_END;
  assign is_curvature = step_q >= GRADIENT_END && step_q < CURVATURE_END;
  assign is_det = step_q >= CURVATURE_END;
  assign det_step = step_q[2:0] - CURVATURE_END[2:0];

  always_comb begin
    case (det_step[2:1])
      2'd0: {det_edge, det_vertex} = {2'd0, 2'd2};
      2'd1: {det_edge, det_vertex} = {2'd2, 2'd0};
      2'd2: {det_edge, det_vertex} = {2'd1, 2'd3};
      default: {det_edge, det_vertex} = {2'd3, 2'd1};
    endcase
  end

  logic [3:0] k0, k1;  // function of unit 0, unit 1: its pair of vertices are the operands

  always_comb begin
    if (is_linear) k0 = step_q[3:0];
    else if (is_value) k0 = step_q[3:0] - LINEAR_END[3:0] + 4'd8;
    else if (is_linear_gradient) k0 = step_q[3:0] - VALUE_END[3:0];
    else if (is_quad_gradient) k0 = step_q[3:0] - LINEAR_GRADIENT_END[3:0];
    else if (is_curvature) k0 = {step_q[2:0] - GRADIENT_END[2:0], 1'b0};
    else k0 = 4'd6 + 4'(det_vertex);  // the square of the vertex
    k1 = is_value ? step_q[3:0] : is_curvature ? k0 | 4'd1 : k0;
  end

  // The vertices, and for a determinant the edge function, come in a register.
  logic [T-1:0] txi0_d, txj0_d, tyi0_d, tyj0_d, txi1_d, txj1_d, tyi1_d, tyj1_d;
  logic [W-1:0] wi0_d, wj0_d, wi1_d, wj1_d;
  logic [T-1:0] txi0, txj0, tyi0, tyj0, txi1, txj1, tyi1, tyj1;
  logic [W-1:0] wi0, wj0, wi1, wj1;

  setup_pair u_pair0 (
      .function_i(k0),
      .x_i(tx_q),
      .y_i(ty_q),
      .w_i(w_q),
      .xi_o(txi0_d),
      .yi_o(tyi0_d),
      .wi_o(wi0_d),
      .xj_o(txj0_d),
      .yj_o(tyj0_d),
      .wj_o(wj0_d)
  );

  setup_pair u_pair1 (
      .function_i(k1),
      .x_i(tx_q),
      .y_i(ty_q),
      .w_i(w_q),
      .xi_o(txi1_d),
      .yi_o(tyi1_d),
      .wi_o(wi1_d),
      .xj_o(txj1_d),
      .yj_o(tyj1_d),
      .wj_o(wj1_d)
  );

  logic [VAL-1:0] edge_value;
  logic [GRAD-1:0] edge_gx, edge_gy;
  logic [VAL-1:0] edge_value_q;
  logic [GRAD-1:0] edge_gx_q, edge_gy_q;
  logic [63:0] det_value, det_gx, det_gy;
  logic use_linear, use_linear_gradient, use_quad_gradient, use_curvature, use_det, use_second;  // of the step in the registers

  always_ff @(posedge clk_i) begin
    {txi0, txj0, tyi0, tyj0, wi0, wj0} <= {txi0_d, txj0_d, tyi0_d, tyj0_d, wi0_d, wj0_d};
    {txi1, txj1, tyi1, tyj1, wi1, wj1} <= {txi1_d, txj1_d, tyi1_d, tyj1_d, wi1_d, wj1_d};
    {edge_value_q, edge_gx_q, edge_gy_q} <= {edge_value, edge_gx, edge_gy};
    {use_linear, use_linear_gradient, use_quad_gradient, use_curvature, use_det, use_second} <= {
      is_linear, is_linear_gradient, is_quad_gradient, is_curvature, is_det, det_step[0]
    };
  end

  one_of_four #(.WIDTH(VAL)) u_edge_value (
      .words_i(lin_value_o[4*VAL-1:0]),
      .index_i(det_edge),
      .word_o(edge_value)
  );
  one_of_four #(.WIDTH(GRAD)) u_edge_gx (
      .words_i(lin_gx_o[4*GRAD-1:0]),
      .index_i(det_edge),
      .word_o(edge_gx)
  );
  one_of_four #(.WIDTH(GRAD)) u_edge_gy (
      .words_i(lin_gy_o[4*GRAD-1:0]),
      .index_i(det_edge),
      .word_o(edge_gy)
  );

  assign det_value = 64'($signed(edge_value_q));
  assign det_gx = 64'($signed(edge_gx_q));
  assign det_gy = 64'($signed(edge_gy_q));

  logic [DOT-1:0] a0, b0, c0, d0, a1, b1, c1, d1;
  logic subtract0, subtract1;

  always_comb begin
    // values
    a0 = DOT'($signed(txi0));
    b0 = use_linear ? DOT'($signed(tyj0)) : DOT'($signed(txj0));
    c0 = DOT'($signed(tyi0));
    d0 = use_linear ? DOT'($signed(txj0)) : DOT'($signed(tyj0));
    subtract0 = use_linear || use_linear_gradient;
    a1 = DOT'($signed(txi1));
    b1 = DOT'($signed(txj1));
    c1 = DOT'($signed(tyi1));
    d1 = DOT'($signed(tyj1));
    subtract1 = use_linear_gradient;
    if (use_linear_gradient) begin
      a0 = DOT'($signed(tyi0));
      b0 = DOT'($signed(wj0));
      c0 = DOT'($signed(wi0));
      d0 = DOT'($signed(tyj0));
      a1 = DOT'($signed(wi1));
      b1 = DOT'($signed(txj1));
      c1 = DOT'($signed(txi1));
      d1 = DOT'($signed(wj1));
    end else if (use_quad_gradient) begin
      a0 = DOT'($signed(txi0));
      b0 = DOT'($signed(wj0));
      c0 = DOT'($signed(wi0));
      d0 = DOT'($signed(txj0));
      a1 = DOT'($signed(tyi1));
      b1 = DOT'($signed(wj1));
      c1 = DOT'($signed(wi1));
      d1 = DOT'($signed(tyj1));
    end else if (use_curvature) begin
      a0 = DOT'($signed(wi0));
      b0 = DOT'($signed(wj0));
      c0 = '0;
      d0 = '0;
      a1 = DOT'($signed(wi1));
      b1 = DOT'($signed(wj1));
      c1 = '0;
      d1 = '0;
    end else if (use_det && !use_second) begin
      a0 = DOT'($signed(txi0));
      b0 = DOT'(det_gx[31:0]);
      c0 = DOT'($signed(tyi0));
      d0 = DOT'(det_gy[31:0]);
      a1 = DOT'($signed(txi0));
      b1 = DOT'($signed(det_gx[63:32]));
      c1 = DOT'($signed(tyi0));
      d1 = DOT'($signed(det_gy[63:32]));
    end else if (use_det) begin
      a0 = DOT'($signed(wi0));
      b0 = DOT'(det_value[31:0]);
      c0 = '0;
      d0 = '0;
      a1 = DOT'($signed(wi0));
      b1 = DOT'($signed(det_value[63:32]));
      c1 = '0;
      d1 = '0;
    end
  end

  logic [OUT-1:0] result0, result1;

  logic unused_result;
  assign unused_result = ^{result0, result1};  // the upper bits, in small configurations

  dot_unit u_dot0 (
      .clk_i,
      .a_i(a0),
      .b_i(b0),
      .c_i(c0),
      .d_i(d0),
      .subtract_i(subtract0),
      .result_o(result0)
  );

  dot_unit u_dot1 (
      .clk_i,
      .a_i(a1),
      .b_i(b1),
      .c_i(c1),
      .d_i(d1),
      .subtract_i(subtract1),
      .result_o(result1)
  );

  // ---- Gradients of an ordinary quad: sums of coordinates, which wait beside the products of the value's job ----------------
  // Linear: gx = Ty_i - Ty_j, gy = Tx_j - Tx_i. Quadratic: -gx = Tx_i + Tx_j, -gy = Ty_i + Ty_j. All times 2^FRAC.
  localparam int RISE = T + 1;
  logic [RISE-1:0] rise_x0_d, rise_y0_d, rise_x1_d, rise_y1_d;
  logic [RISE-1:0] rise_x0, rise_y0, rise_x1, rise_y1;

  assign rise_x0_d = use_linear ? RISE'($signed(tyi0)) - RISE'($signed(tyj0)) : {txi0, 1'b0};  // unit 0 has squares alone
  assign rise_y0_d = use_linear ? RISE'($signed(txj0)) - RISE'($signed(txi0)) : {tyi0, 1'b0};
  assign rise_x1_d = RISE'($signed(txi1)) + RISE'($signed(txj1));
  assign rise_y1_d = RISE'($signed(tyi1)) + RISE'($signed(tyj1));

  delay_line #(.WIDTH(4 * RISE), .DEPTH(JOB_CLOCKS - 1)) u_rise (
      .clk_i,
      .data_i({rise_x0_d, rise_y0_d, rise_x1_d, rise_y1_d}),
      .data_o({rise_x0, rise_y0, rise_x1, rise_y1})
  );

  // ---- What the job at the units' outputs is -----------------------------------------------------------------------------
  localparam int JOB = 6 + 2 * 4 + 1;
  logic value_linear, value, gradient_linear, gradient_quad, curvature, det, det_second;
  logic [3:0] dest0, dest1;
  logic [JOB-1:0] job;
  logic [JOB_CLOCKS*JOB-1:0] job_q;

  assign job = {
    {6{state_q == RUN}} & {is_linear, is_value, is_linear_gradient, is_quad_gradient, is_curvature, is_det},
    k0,
    k1,
    det_step[0]
  };
  assign {value_linear, value, gradient_linear, gradient_quad, curvature, det, dest0, dest1, det_second} = job_q[JOB_CLOCKS*JOB-1-:JOB];

  always_ff @(posedge clk_i) begin
    if (!rst_ni) job_q <= '0;
    else job_q <= {job_q[(JOB_CLOCKS-1)*JOB-1:0], job};
  end

  // ---- Destinations: functions load from few buses -------------------------------------------------------------------------
  logic [VAL-1:0] value0, value1;
  logic [GRAD-1:0] linear_gx, linear_gy;
  logic load_linear_gradient, load_quad_gradient, load_curvature;

  assign value0 = VAL'(result0);
  assign value1 = VAL'(result1);
  assign linear_gx = ordinary_q ? GRAD'($signed(rise_x0)) << FRAC : GRAD'(result0);
  assign linear_gy = ordinary_q ? GRAD'($signed(rise_y0)) << FRAC : GRAD'(result1);
  assign load_linear_gradient = ordinary_q ? value_linear : gradient_linear;
  assign load_quad_gradient = ordinary_q ? value : gradient_quad;
  assign load_curvature = ordinary_q ? value : curvature;

  logic tie_pos, tie_neg;
  logic [REACH-1:0] fall_tile, rise_tile, fall_block, rise_block;

  // The reach of a function whose gradient was loaded in the clock before.
  logic load_reach_q;
  logic [3:0] reach_dest_q;
  logic [GRAD-1:0] reach_gx_q, reach_gy_q;

  always_ff @(posedge clk_i) begin
    load_reach_q <= load_linear_gradient;
    {reach_dest_q, reach_gx_q, reach_gy_q} <= {dest0, linear_gx, linear_gy};
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

  for (genvar g = 0; g < 6; g++) begin : gen_linear
    logic load_gradient;

    assign load_gradient = load_linear_gradient && dest0 == g;

    always_ff @(posedge clk_i) begin
      if (value_linear && dest0 == g) lin_value_o[g*VAL+:VAL] <= value0;
      if (load_gradient) begin
        lin_gx_o[g*GRAD+:GRAD] <= linear_gx;
        lin_gy_o[g*GRAD+:GRAD] <= linear_gy;
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

  // Quadratics 0 to 7 have their values from unit 1, 8 and 9 from unit 0.
  for (genvar u = 0; u < 2; u++) begin : gen_unit
    localparam int FIRST = (u == 1) ? 0 : 8;
    localparam int END = (u == 1) ? 8 : 10;
    logic [GRAD-1:0] minus_gx, minus_gy;
    logic [QVAL-1:0] quad_value;
    logic [QGRAD-1:0] quad_gx, quad_gy;
    logic [3:0] dest;

    assign dest = (u == 1) ? dest1 : dest0;
    assign minus_gx = !ordinary_q ? GRAD'(result0) : GRAD'($signed((u == 1) ? rise_x1 : rise_x0)) << FRAC;
    assign minus_gy = !ordinary_q ? GRAD'(result1) : GRAD'($signed((u == 1) ? rise_y1 : rise_y0)) << FRAC;
    assign quad_value = QVAL'(((u == 1) ? value1 : value0) >> QDROP);
    assign quad_gx = QGRAD'((GRAD'(0) - minus_gx) >> QDROP);
    assign quad_gy = QGRAD'((GRAD'(0) - minus_gy) >> QDROP);

    for (genvar g = FIRST; g < END; g++) begin : gen_quadratic
      logic [CURV-1:0] curve;

      assign curve = ordinary_q ? CURV'(1) << (2 * FRAC) : (g % 2 == 0) ? CURV'(result0) : CURV'(result1);

      always_ff @(posedge clk_i) begin
        if (value && !(u == 0 && value_linear) && dest == g) quad_value_o[g*QVAL+:QVAL] <= quad_value;
        if (load_quad_gradient && dest == g) begin
          quad_gx_o[g*QGRAD+:QGRAD] <= quad_gx;
          quad_gy_o[g*QGRAD+:QGRAD] <= quad_gy;
        end
        if (load_curvature && (ordinary_q ? dest == g : (g % 2 == 0) ? dest0 == g : dest1 == g)) begin
          quad_q_o[g*QCURV+:QCURV] <= QCURV'(curve >> QDROP);
        end
      end
    end
  end

  // ---- Determinants d_012, d_023, d_123, d_013, one after the other in one accumulator ---------------------------------------
  logic [DET-1:0] det_q;
  logic [2:0] det_neg_q, det_zero_q;  // of those before the last, the latest at bit 0
  logic det_neg, det_zero;

  assign det_neg = det_q[DET-1];
  assign det_zero = det_q == '0;

  always_ff @(posedge clk_i) begin
    if (det) begin
      det_q <= (det_second ? det_q : '0) + DET'($signed(result0)) + (DET'($signed(result1)) << 32);
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
