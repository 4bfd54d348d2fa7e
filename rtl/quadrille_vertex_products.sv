// SPDX-License-Identifier: Apache-2.0
`include "quadrille_types.svh"
// The multipliers of the front: pairs of dot_units, and which coordinates of a pair of vertices they multiply. A job a
// clock for each of PRODUCT_PAIRS pairs of units, results VERTEX_PRODUCT_CLOCKS later: pair, operands, then dot_unit's
// registers. Without a job on its way they hold.
//
// Two users: tile_context (tile_*), which comes first and then has all units, and quad_setup. A job is a kind and a
// function, whose pair of vertices i, j (quadrille_pkg::pair_first, pair_second) it takes from its user's four
// vertices:
//
//     kind                result0              result1
//     EDGE                Xi Yj - Yi Xj        (Xj - Xi)^2 + (Yi - Yj)^2
//     EDGE_GRADIENT       Yi Wj - Wi Yj        Wi Xj - Xi Wj
//     DOT                 Xi Xj + Yi Yj        Wi Wj
//     DOT_GRADIENT        Xi Wj + Wi Xj        Yi Wj + Wi Yj
//     SQUARES             Xi^2 + Yi^2          Xj^2 + Yj^2
//     MOVE                Xi - Wi offset_x     Yi - Wi offset_y
//     DET_VALUE           Wi (value's low 32 bits, unsigned)           Wi (value's high bits)
//     DET_GRADIENT        Xi gx + Yi gy with their low 32 bits         with their high bits
//
// DET: the edge function that comes with the job. Flat vectors over the pairs of units: that of pair p at [p*WIDTH +:
// WIDTH].
module quadrille_vertex_products #(
    localparam int T = quadrille_pkg::T_BITS, W = quadrille_pkg::W_BITS, V = quadrille_pkg::VIEWPORT_BITS,
    localparam int VAL = quadrille_pkg::VAL_BITS, GRAD = quadrille_pkg::GRAD_BITS, RISE = quadrille_pkg::RISE_BITS,
    localparam int OUT = quadrille_pkg::DOT_OUT_BITS, PAIRS = quadrille_pkg::PRODUCT_PAIRS
) (
    input logic clk_i, tile_valid_i,
    input logic [quadrille_pkg::JOBS_BITS-1:0] tile_i,  // the offset is still there a clock later
    input logic setup_valid_i,
    input logic [quadrille_pkg::JOBS_BITS-1:0] setup_i,  // taken when there is none of a tile
    input logic [PAIRS*(VAL+2*GRAD)-1:0] edges_i,  // with the setup's jobs: value, gx, gy
    output logic [quadrille_pkg::PRODUCTS_BITS-1:0] products_o
);
  localparam int EDGE = VAL + 2 * GRAD;
  `QUADRILLE_IN(`QUADRILLE_JOBS_T, tile)
  `QUADRILLE_IN(`QUADRILLE_JOBS_T, setup)
  localparam int DOT = quadrille_pkg::DOT_BITS;

  logic [4*T-1:0] x, y;
  logic [4*W-1:0] w;
  logic tile_q, job;
  logic [quadrille_pkg::VERTEX_PRODUCT_CLOCKS-2:0] job_q;  // in register n is one
  logic [V:0] offset_x, offset_y;
  logic [PAIRS*T-1:0] all_xi, all_yi, all_xj, all_yj;
  logic [PAIRS*RISE-1:0] all_apart_x, all_apart_y;
  logic [PAIRS*OUT-1:0] result0, result1;
  assign products_o = {all_xi, all_yi, all_xj, all_yj, all_apart_x, all_apart_y, result0, result1};

  assign x = tile_valid_i ? tile.x : setup.x;
  assign y = tile_valid_i ? tile.y : setup.y;
  assign w = tile_valid_i ? tile.w : setup.w;
  assign offset_x = tile_q ? tile.offset_x : setup.offset_x;
  assign offset_y = tile_q ? tile.offset_y : setup.offset_y;

  assign job = tile_valid_i || setup_valid_i;

  always_ff @(posedge clk_i) {job_q, tile_q} <= {job_q[quadrille_pkg::VERTEX_PRODUCT_CLOCKS-3:0], job, tile_valid_i};

  for (genvar p = 0; p < PAIRS; p++) begin : gen_pair
    // ---- Pair -------------------------------------------------------------------------------------------------------
    logic [3:0] function_d;
    logic [T-1:0] xi_d, xj_d, yi_d, yj_d, xi, xj, yi, yj;
    logic [W-1:0] wi_d, wj_d, wi, wj;
    logic [2:0] kind;
    logic [63:0] edge_value, edge_gx, edge_gy;
    logic [RISE-1:0] apart_x_d, apart_y_d;
    assign function_d = tile_valid_i ? tile.functions[p*4+:4] : setup.functions[p*4+:4];

    quadrille_setup_pair u_pair (
        .function_i(function_d), .x_i(x), .y_i(y), .w_i(w), .xi_o(xi_d), .yi_o(yi_d), .wi_o(wi_d), .xj_o(xj_d),
        .yj_o(yj_d), .wj_o(wj_d)
    );

    always_ff @(posedge clk_i) begin
      if (job) begin
        kind <= tile_valid_i ? tile.kind[p*3+:3] : setup.kind[p*3+:3];
        {xi, yi, wi, xj, yj, wj} <= {xi_d, yi_d, wi_d, xj_d, yj_d, wj_d};
        edge_value <= 64'($signed(edges_i[p*EDGE+2*GRAD+:VAL]));
        edge_gx <= 64'($signed(edges_i[p*EDGE+GRAD+:GRAD]));
        edge_gy <= 64'($signed(edges_i[p*EDGE+:GRAD]));
      end
    end

    assign apart_x_d = RISE'($signed(xj)) - RISE'($signed(xi));
    assign apart_y_d = RISE'($signed(yi)) - RISE'($signed(yj));
    assign all_xi[p*T+:T] = xi;
    assign all_yi[p*T+:T] = yi;
    assign all_xj[p*T+:T] = xj;
    assign all_yj[p*T+:T] = yj;
    assign all_apart_x[p*RISE+:RISE] = apart_x_d;
    assign all_apart_y[p*RISE+:RISE] = apart_y_d;

    // ---- Operands --------------------------------------------------------------------------------------------------
    logic [DOT-1:0] x_i, x_j, y_i, y_j, w_i, w_j, apart_x, apart_y, a0, b0, c0, d0, a1, b1, c1, d1;
    logic subtract0, subtract1;
    assign x_i = DOT'($signed(xi));
    assign x_j = DOT'($signed(xj));
    assign y_i = DOT'($signed(yi));
    assign y_j = DOT'($signed(yj));
    assign w_i = DOT'($signed(wi));
    assign w_j = DOT'($signed(wj));
    assign apart_x = DOT'($signed(apart_x_d));
    assign apart_y = DOT'($signed(apart_y_d));

    always_ff @(posedge clk_i) begin
      if (job_q[0]) begin
        case (kind)
          quadrille_pkg::EDGE: begin
            {a0, b0, c0, d0} <= {x_i, y_j, y_i, x_j};
            {a1, b1, c1, d1} <= {apart_x, apart_x, apart_y, apart_y};
          end
          quadrille_pkg::EDGE_GRADIENT: begin
            {a0, b0, c0, d0} <= {y_i, w_j, w_i, y_j};
            {a1, b1, c1, d1} <= {w_i, x_j, x_i, w_j};
          end
          quadrille_pkg::DOT: begin
            {a0, b0, c0, d0} <= {x_i, x_j, y_i, y_j};
            {a1, b1, c1, d1} <= {w_i, w_j, y_i, DOT'(0)};
          end
          quadrille_pkg::DOT_GRADIENT: begin
            {a0, b0, c0, d0} <= {x_i, w_j, w_i, x_j};
            {a1, b1, c1, d1} <= {w_i, y_j, y_i, w_j};
          end
          quadrille_pkg::SQUARES: begin
            {a0, b0, c0, d0} <= {x_i, x_i, y_i, y_i};
            {a1, b1, c1, d1} <= {x_j, x_j, y_j, y_j};
          end
          quadrille_pkg::MOVE: begin
            {a0, b0, c0, d0} <= {x_i, DOT'(1), w_i, DOT'(offset_x)};
            {a1, b1, c1, d1} <= {y_i, DOT'(1), w_i, DOT'(offset_y)};
          end
          quadrille_pkg::DET_VALUE: begin
            {a0, b0, c0, d0} <= {w_i, DOT'(edge_value[31:0]), y_i, DOT'(0)};
            {a1, b1, c1, d1} <= {w_i, DOT'($signed(edge_value[63:32])), y_i, DOT'(0)};
          end
          default: begin  // DET_GRADIENT
            {a0, b0, c0, d0} <= {x_i, DOT'(edge_gx[31:0]), y_i, DOT'(edge_gy[31:0])};
            {a1, b1, c1, d1} <= {x_i, DOT'($signed(edge_gx[63:32])), y_i, DOT'($signed(edge_gy[63:32]))};
          end
        endcase
        subtract0 <= kind == quadrille_pkg::EDGE || kind == quadrille_pkg::EDGE_GRADIENT || kind == quadrille_pkg::MOVE;
        subtract1 <= kind == quadrille_pkg::EDGE_GRADIENT || kind == quadrille_pkg::MOVE;
      end
    end

    quadrille_dot_unit u_dot0 (
        .clk_i, .active_i(job_q != '0), .a_i(a0), .b_i(b0), .c_i(c0), .d_i(d0), .subtract_i(subtract0),
        .result_o(result0[p*OUT+:OUT])
    );

    quadrille_dot_unit u_dot1 (
        .clk_i, .active_i(job_q != '0), .a_i(a1), .b_i(b1), .c_i(c1), .d_i(d1), .subtract_i(subtract1),
        .result_o(result1[p*OUT+:OUT])
    );
  end
endmodule
