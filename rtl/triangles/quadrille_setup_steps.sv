// SPDX-License-Identifier: Apache-2.0
`include "quadrille_types.svh"
// Triangle machine: the steps of quad_setup with one pair of dot units. Functions 0, 1, 4 are the edges 01, 12, 20.
//
// Ordinary: their values, in three steps. Homogeneous: of each the gradient, then the value; two steps without a job,
// until E01 is there; the determinant E01 . V2 in two.
module quadrille_setup_steps #(
    localparam int T = quadrille_pkg::T_BITS, W = quadrille_pkg::W_BITS, V = quadrille_pkg::VIEWPORT_BITS,
    localparam int VAL = quadrille_pkg::VAL_BITS, GRAD = quadrille_pkg::GRAD_BITS, TC = quadrille_pkg::TC_BITS,
    localparam int PAIRS = quadrille_pkg::PRODUCT_PAIRS, EDGE_WIDTH = VAL + 2 * GRAD
) (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    input logic [quadrille_pkg::STATE_BITS-1:0] state_i,
    input logic load_i,
    input logic [quadrille_pkg::QUAD_BITS-1:0] quad_i,
    input logic [TC-1:0] tile_x0_i, tile_y0_i,
    input logic run_i, ordinary_i,
    input logic wait_i,  // never
    output logic last_o,
    output logic [quadrille_pkg::JOBS_BITS-1:0] jobs_o,
    output logic [PAIRS*EDGE_WIDTH-1:0] edges_o,
    output logic [4:0] kind_o,  // edge, gradient, determinant; no sides or corners
    output logic [2:0] group_o,
    output logic [PAIRS-1:0] triangle_o, negated_o,
    output logic second_o,
    input logic [6*VAL-1:0] lin_value_i,
    input logic [6*GRAD-1:0] lin_gx_i, lin_gy_i,
    input logic [3:0] negative_i
);
  `QUADRILLE_IN(`QUADRILLE_QUAD_T, quad)
  if (PAIRS != 1) begin : gen_one_pair
    $error("dot_units must be 2");
  end

  localparam logic [3:0] DETERMINANT = 4'd8;
  logic [3:0] step_q;
  logic [1:0] edge_index;  // 01, 12, 20
  logic is_edge, is_gradient, is_det;
  assign edge_index = ordinary_i ? step_q[1:0] : step_q[2:1];
  assign is_edge = ordinary_i || (step_q < 4'd6 && step_q[0]);
  assign is_gradient = !ordinary_i && step_q < 4'd6 && !step_q[0];
  assign is_det = !ordinary_i && step_q >= DETERMINANT;
  assign last_o = step_q == (ordinary_i ? 4'd2 : DETERMINANT + 4'd1);
  assign kind_o = {is_edge, is_gradient, is_det, 2'b00};
  assign group_o = {edge_index[1], 1'b0, edge_index[0]};  // 0, 1, 4
  assign second_o = step_q[0];
  assign {triangle_o, negated_o} = '0;

  always_ff @(posedge clk_i) begin
    if (load_i) step_q <= '0;
    else step_q <= step_q + 4'd1;
  end

  // ---- Vertices relative to the origin pixel -----------------------------------------------------------------------
  logic [T-1:0] origin_x, origin_y;
  logic [3*T-1:0] tx_q, ty_q;
  logic [3*W-1:0] w_q;
  assign origin_x = T'(tile_x0_i) << (quadrille_pkg::TILE_LOG2 + quadrille_pkg::FRAC);
  assign origin_y = T'(tile_y0_i) << (quadrille_pkg::TILE_LOG2 + quadrille_pkg::FRAC);

  for (genvar g = 0; g < 3; g++) begin : gen_vertex
    always_ff @(posedge clk_i) begin
      if (load_i) begin
        tx_q[g*T+:T] <= quad.x[g*T+:T] - origin_x;
        ty_q[g*T+:T] <= quad.y[g*T+:T] - origin_y;
        w_q[g*W+:W] <= quad.w[g*W+:W];
      end
    end
  end

  // ---- Jobs: the pair of a vertex with itself is a function from 6 on ----------------------------------------------
  logic [2:0] kind;
  logic [3:0] job_function;
  assign kind = is_edge ? quadrille_pkg::EDGE : is_gradient ? quadrille_pkg::EDGE_GRADIENT :
      second_o ? quadrille_pkg::DET_VALUE : quadrille_pkg::DET_GRADIENT;
  assign job_function = is_det ? 4'd8 : {1'b0, group_o};
  assign jobs_o = {kind, job_function, T'(0), tx_q, T'(0), ty_q, W'(0), w_q, (2 * (V + 1))'(0)};
  assign edges_o = {lin_value_i[0+:VAL], lin_gx_i[0+:GRAD], lin_gy_i[0+:GRAD]};

  logic unused;
  assign unused = ^{rst_ni, state_i, run_i, wait_i, lin_value_i, lin_gx_i, lin_gy_i, negative_i};
endmodule
