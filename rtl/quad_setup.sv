// Setup of one quad: origin tile, 6 linear and 10 quadratic functions (value at the origin, first and second differences),
// visibility of the clauses. README.md section 4 has the clocks: PREP, then one job per dot unit and clock, 8 (ordinary) or 37
// (homogeneous) clocks, 2 clocks of drain, DONE until taken.
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
  localparam logic [W-1:0] ONE = W'(1) << FRAC;

  localparam logic [2:0] IDLE = 3'd0;
  localparam logic [2:0] PREP = 3'd1;
  localparam logic [2:0] RUN = 3'd2;
  localparam logic [2:0] DRAIN = 3'd3;
  localparam logic [2:0] DONE = 3'd4;

  // ---- Bounding box, at start ---------------------------------------------------------------------------------------------
  logic ordinary;
  logic empty_x, empty_y, empty;
  logic [TC-1:0] first_x, first_y, count_x, count_y;

  assign ordinary = w_i[0*W+:W] == ONE && w_i[1*W+:W] == ONE && w_i[2*W+:W] == ONE && w_i[3*W+:W] == ONE;
  assign empty = empty_x || empty_y;

  bounding_range u_range_x (
      .position_i(x_i),
      .ordinary_i(ordinary),
      .scissor0_i(scissor_x0_i),
      .scissor1_i(scissor_x1_i),
      .empty_o(empty_x),
      .first_o(first_x),
      .count_o(count_x)
  );

  bounding_range u_range_y (
      .position_i(y_i),
      .ordinary_i(ordinary),
      .scissor0_i(scissor_y0_i),
      .scissor1_i(scissor_y1_i),
      .empty_o(empty_y),
      .first_o(first_y),
      .count_o(count_y)
  );

  // ---- State --------------------------------------------------------------------------------------------------------------
  logic [2:0] state_q;
  logic [5:0] step_q;
  logic drain_q;
  logic ordinary_q;
  logic last;

  assign last = step_q == (ordinary_q ? LAST_ORDINARY : LAST_HOMOGENEOUS);
  assign idle_o = state_q == IDLE;
  assign done_o = state_q == DONE;
  assign homogeneous_o = !ordinary_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      state_q <= IDLE;
      step_q <= '0;
      drain_q <= 1'b0;
    end else begin
      case (state_q)
        IDLE: if (start_i) state_q <= PREP;
        PREP: begin
          state_q <= RUN;
          step_q <= '0;
        end
        RUN: begin
          step_q <= step_q + 6'd1;
          drain_q <= 1'b0;
          if (last) state_q <= DRAIN;
        end
        DRAIN: begin
          drain_q <= 1'b1;
          if (drain_q) state_q <= DONE;
        end
        default: if (take_i) state_q <= IDLE;
      endcase
    end
  end

  always_ff @(posedge clk_i) begin
    if (start_i) begin
      ordinary_q <= ordinary;
      slot_o <= slot_i;
      tile_x0_o <= empty ? '0 : first_x;
      tile_y0_o <= empty ? '0 : first_y;
      tiles_x_o <= empty ? '0 : count_x;
      tiles_y_o <= empty ? '0 : count_y;
    end
  end

  // ---- Vertices, moved to the origin pixel in PREP (a shift: W = ONE or the origin is 0) -----------------------------------
  logic [T-1:0] origin_x, origin_y;
  logic [4*T-1:0] tx_q, ty_q;
  logic [4*W-1:0] w_q;

  assign origin_x = T'(tile_x0_o) << (quadrille_pkg::TILE_LOG2 + FRAC);
  assign origin_y = T'(tile_y0_o) << (quadrille_pkg::TILE_LOG2 + FRAC);

  for (genvar g = 0; g < 4; g++) begin : gen_vertex
    always_ff @(posedge clk_i) begin
      if (start_i) begin
        tx_q[g*T+:T] <= x_i[g*T+:T];
        ty_q[g*T+:T] <= y_i[g*T+:T];
        w_q[g*W+:W] <= w_i[g*W+:W];
      end else if (state_q == PREP) begin
        tx_q[g*T+:T] <= tx_q[g*T+:T] - origin_x;
        ty_q[g*T+:T] <= ty_q[g*T+:T] - origin_y;
      end
    end
  end

  // ---- Jobs of the two dot units ------------------------------------------------------------------------------------------
  logic [3:0] k0, k1;  // function of unit 0, unit 1
  logic is_value0, is_value1, is_linear, is_gradient, is_curvature, is_det;
  logic [2:0] det_step;  // step - 29

  assign is_linear = step_q <= 6'd5;  // unit 0 only
  assign is_value0 = step_q <= 6'd7;
  assign is_value1 = step_q <= 6'd7;
  assign is_gradient = step_q >= 6'd8 && step_q <= 6'd23;
  assign is_curvature = step_q >= 6'd24 && step_q <= 6'd28;
  assign is_det = step_q >= 6'd29;
  assign det_step = step_q[2:0] - 3'd5;

  always_comb begin
    if (step_q <= 6'd5) k0 = step_q[3:0];
    else if (step_q <= 6'd7) k0 = step_q[3:0] + 4'd2;
    else if (step_q <= 6'd13) k0 = step_q[3:0] - 4'd8;
    else if (step_q <= 6'd23) k0 = step_q[3:0] - 4'd14;
    else k0 = {step_q[2:0], 1'b0};  // 2 (step - 24): 24 = 0 mod 8
    if (step_q <= 6'd7) k1 = step_q[3:0];
    else if (step_q <= 6'd23) k1 = k0;
    else k1 = {step_q[2:0], 1'b1};
  end

  logic [1:0] i0, j0, i1, j1;  // vertices
  logic [1:0] det_m;
  logic [1:0] det_f;
  logic [T-1:0] txi0, txj0, tyi0, tyj0, txi1, txj1, tyi1, tyj1, txm, tym;
  logic [W-1:0] wi0, wj0, wi1, wj1, wm;
  logic [63:0] det_value, det_gx, det_gy;

  assign i0 = quadrille_pkg::pair_first(k0);
  assign j0 = quadrille_pkg::pair_second(k0);
  assign i1 = quadrille_pkg::pair_first(k1);
  assign j1 = quadrille_pkg::pair_second(k1);

  // d = 0..3: E01 . V2, E23 . V0, E12 . V3, E30 . V1
  always_comb begin
    case (det_step[2:1])
      2'd0: begin
        det_f = 2'd0;
        det_m = 2'd2;
      end
      2'd1: begin
        det_f = 2'd2;
        det_m = 2'd0;
      end
      2'd2: begin
        det_f = 2'd1;
        det_m = 2'd3;
      end
      default: begin
        det_f = 2'd3;
        det_m = 2'd1;
      end
    endcase
  end

  assign txi0 = tx_q[i0*T+:T];
  assign txj0 = tx_q[j0*T+:T];
  assign tyi0 = ty_q[i0*T+:T];
  assign tyj0 = ty_q[j0*T+:T];
  assign wi0 = w_q[i0*W+:W];
  assign wj0 = w_q[j0*W+:W];
  assign txi1 = tx_q[i1*T+:T];
  assign txj1 = tx_q[j1*T+:T];
  assign tyi1 = ty_q[i1*T+:T];
  assign tyj1 = ty_q[j1*T+:T];
  assign wi1 = w_q[i1*W+:W];
  assign wj1 = w_q[j1*W+:W];
  assign txm = tx_q[det_m*T+:T];
  assign tym = ty_q[det_m*T+:T];
  assign wm = w_q[det_m*W+:W];
  assign det_value = 64'($signed(lin_value_o[det_f*VAL+:VAL]));
  assign det_gx = 64'($signed(lin_gx_o[det_f*GRAD+:GRAD]));
  assign det_gy = 64'($signed(lin_gy_o[det_f*GRAD+:GRAD]));

  logic [DOT-1:0] a0, b0, c0, d0, a1, b1, c1, d1;
  logic subtract0, subtract1;

  always_comb begin
    // values
    a0 = DOT'($signed(txi0));
    b0 = is_linear ? DOT'($signed(tyj0)) : DOT'($signed(txj0));
    c0 = DOT'($signed(tyi0));
    d0 = is_linear ? DOT'($signed(txj0)) : DOT'($signed(tyj0));
    subtract0 = is_linear;
    a1 = DOT'($signed(txi1));
    b1 = DOT'($signed(txj1));
    c1 = DOT'($signed(tyi1));
    d1 = DOT'($signed(tyj1));
    subtract1 = 1'b0;
    if (is_gradient && step_q <= 6'd13) begin
      a0 = DOT'($signed(tyi0));
      b0 = DOT'($signed(wj0));
      c0 = DOT'($signed(wi0));
      d0 = DOT'($signed(tyj0));
      subtract0 = 1'b1;
      a1 = DOT'($signed(wi1));
      b1 = DOT'($signed(txj1));
      c1 = DOT'($signed(txi1));
      d1 = DOT'($signed(wj1));
      subtract1 = 1'b1;
    end else if (is_gradient) begin
      a0 = DOT'($signed(txi0));
      b0 = DOT'($signed(wj0));
      c0 = DOT'($signed(wi0));
      d0 = DOT'($signed(txj0));
      a1 = DOT'($signed(tyi1));
      b1 = DOT'($signed(wj1));
      c1 = DOT'($signed(wi1));
      d1 = DOT'($signed(tyj1));
    end else if (is_curvature) begin
      a0 = DOT'($signed(wi0));
      b0 = DOT'($signed(wj0));
      c0 = '0;
      d0 = '0;
      a1 = DOT'($signed(wi1));
      b1 = DOT'($signed(wj1));
      c1 = '0;
      d1 = '0;
    end else if (is_det && !det_step[0]) begin
      a0 = DOT'($signed(txm));
      b0 = DOT'(det_gx[31:0]);
      c0 = DOT'($signed(tym));
      d0 = DOT'(det_gy[31:0]);
      a1 = DOT'($signed(txm));
      b1 = DOT'($signed(det_gx[63:32]));
      c1 = DOT'($signed(tym));
      d1 = DOT'($signed(det_gy[63:32]));
    end else if (is_det) begin
      a0 = DOT'($signed(wm));
      b0 = DOT'(det_value[31:0]);
      c0 = '0;
      d0 = '0;
      a1 = DOT'($signed(wm));
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

  // ---- What the job at the units' outputs is, two clocks after its step ----------------------------------------------------
  logic value_linear, value0, value1, gradient_linear, gradient_quad, curvature, det;
  logic [3:0] dest0, dest1;
  logic [1:0] dest_det;
  logic run;

  assign run = state_q == RUN;

  logic [16:0] job;
  logic [16:0] job_q1, job_q2;

  assign job = {
    run && is_linear,
    run && is_value0 && !is_linear,
    run && is_value1,
    run && is_gradient && step_q <= 6'd13,
    run && is_gradient && step_q > 6'd13,
    run && is_curvature,
    run && is_det,
    k0,
    k1,
    det_step[2:1]
  };
  assign {value_linear, value0, value1, gradient_linear, gradient_quad, curvature, det, dest0, dest1, dest_det} = job_q2;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      job_q1 <= '0;
      job_q2 <= '0;
    end else begin
      job_q1 <= job;
      job_q2 <= job_q1;
    end
  end

  // ---- Destinations -------------------------------------------------------------------------------------------------------
  for (genvar g = 0; g < 6; g++) begin : gen_linear
    localparam int I = 32'(quadrille_pkg::pair_first(4'(g)));
    localparam int J = 32'(quadrille_pkg::pair_second(4'(g)));
    logic [GRAD-1:0] rise_x, rise_y;  // gx, gy of an ordinary quad

    assign rise_x = (GRAD'($signed(ty_q[I*T+:T])) - GRAD'($signed(ty_q[J*T+:T]))) << FRAC;
    assign rise_y = (GRAD'($signed(tx_q[J*T+:T])) - GRAD'($signed(tx_q[I*T+:T]))) << FRAC;

    always_ff @(posedge clk_i) begin
      if (value_linear && dest0 == g) lin_value_o[g*VAL+:VAL] <= VAL'(result0);
      if (ordinary_q && run) begin
        lin_gx_o[g*GRAD+:GRAD] <= rise_x;
        lin_gy_o[g*GRAD+:GRAD] <= rise_y;
      end else if (gradient_linear && dest0 == g) begin
        lin_gx_o[g*GRAD+:GRAD] <= GRAD'(result0);
        lin_gy_o[g*GRAD+:GRAD] <= GRAD'(result1);
      end
    end
  end

  for (genvar g = 0; g < 10; g++) begin : gen_quadratic
    localparam int I = 32'(quadrille_pkg::pair_first(4'(g)));
    localparam int J = 32'(quadrille_pkg::pair_second(4'(g)));
    logic [GRAD-1:0] rise_x, rise_y;  // -gx, -gy, complete
    logic [CURV-1:0] curve;

    assign rise_x = ordinary_q ? (GRAD'($signed(tx_q[I*T+:T])) + GRAD'($signed(tx_q[J*T+:T]))) << FRAC : GRAD'(result0);
    assign rise_y = ordinary_q ? (GRAD'($signed(ty_q[I*T+:T])) + GRAD'($signed(ty_q[J*T+:T]))) << FRAC : GRAD'(result1);
    assign curve = ordinary_q ? CURV'(1) << (2 * FRAC) : (g % 2 == 0) ? CURV'(result0) : CURV'(result1);

    always_ff @(posedge clk_i) begin
      if (value0 && dest0 == g) quad_value_o[g*QVAL+:QVAL] <= QVAL'(VAL'(result0) >> QDROP);
      if (value1 && dest1 == g) quad_value_o[g*QVAL+:QVAL] <= QVAL'(VAL'(result1) >> QDROP);
      if ((ordinary_q && run) || (gradient_quad && dest0 == g)) begin
        quad_gx_o[g*QGRAD+:QGRAD] <= QGRAD'((GRAD'(0) - rise_x) >> QDROP);
        quad_gy_o[g*QGRAD+:QGRAD] <= QGRAD'((GRAD'(0) - rise_y) >> QDROP);
      end
      if ((ordinary_q && run) || (curvature && (g % 2 == 0 ? dest0 == g : dest1 == g))) begin
        quad_q_o[g*QCURV+:QCURV] <= QCURV'(curve >> QDROP);
      end
    end
  end

  // ---- Determinants d_012, d_023, d_123, d_013 and what they say ------------------------------------------------------------
  logic [3:0] det_neg, det_zero, det_pos;

  for (genvar g = 0; g < 4; g++) begin : gen_det
    logic [DET-1:0] det_q;

    always_ff @(posedge clk_i) begin
      if (start_i) det_q <= '0;
      else if (det && dest_det == g) det_q <= det_q + DET'($signed(result0)) + (DET'($signed(result1)) << 32);
    end

    assign det_neg[g] = det_q[DET-1];
    assign det_zero[g] = det_q == '0;
    assign det_pos[g] = !det_neg[g] && !det_zero[g];
  end

  logic some_pos, some_neg;  // among d_123, -d_023, d_013, -d_012

  assign some_pos = det_pos[2] || det_neg[1] || det_pos[3] || det_neg[0];
  assign some_neg = det_neg[2] || det_pos[1] || det_neg[3] || det_pos[0];
  assign hull_o = !ordinary_q && !(some_pos && some_neg);
  assign visible_o = (ordinary_q || hull_o) ? 4'b1111 : {det_neg[1], det_neg[0], det_pos[1], det_pos[0]};

`ifndef SYNTHESIS
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      assert (!start_i || idle_o);
      assert (!take_i || done_o);
    end
  end
`endif
endmodule
