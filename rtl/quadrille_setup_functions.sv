// SPDX-License-Identifier: Apache-2.0
`include "quadrille_types.svh"
// The linear functions of quad_setup from their results: value, gradient, what they reach over a tile and a block, tie
// signs; squared lengths.
module quadrille_setup_functions #(
    localparam int VAL = quadrille_pkg::VAL_BITS, GRAD = quadrille_pkg::GRAD_BITS, REACH = quadrille_pkg::REACH_BITS,
    localparam int RISE = quadrille_pkg::RISE_BITS, LENGTH2 = quadrille_pkg::LENGTH2_BITS,
    localparam int OUT = quadrille_pkg::DOT_OUT_BITS, PAIRS = quadrille_pkg::PRODUCT_PAIRS
) (
    input logic clk_i,
    input logic [quadrille_pkg::PRODUCTS_BITS-1:0] products_i,
    // The jobs whose results are there
    input logic edge_job_i, gradient_job_i,
    input logic [2:0] job_group_i,
    input logic ordinary_job_i,
    output logic [PAIRS*VAL-1:0] value_o,  // of the results
    // Functions so far
    output logic [6*VAL-1:0] lin_value_o,
    output logic [6*GRAD-1:0] lin_gx_o, lin_gy_o,
    output logic [9:0] ties_o,  // tie_pos, tie_neg
    output logic [20*REACH-1:0] reaches_o,  // fall_tile, rise_tile, fall_block, rise_block
    output logic [6*LENGTH2-1:0] length2_o
);
  localparam int FRAC = quadrille_pkg::FRAC;
  localparam int QDROP = quadrille_pkg::QDROP, CLOCKS = quadrille_pkg::VERTEX_PRODUCT_CLOCKS;
  `QUADRILLE_IN(`QUADRILLE_PRODUCTS_T, products)

  // ---- Gradients of an ordinary quad: differences of coordinates, which wait beside the products --------------------
  // gx = Ty_i - Ty_j, gy = Tx_j - Tx_i, both times 2^FRAC.
  logic [PAIRS*RISE-1:0] apart_x, apart_y;
  quadrille_delay_line #(.WIDTH(2 * PAIRS * RISE), .DEPTH(CLOCKS - 1)) u_apart (
      .clk_i, .data_i({products.apart_x, products.apart_y}), .data_o({apart_x, apart_y})
  );

  // ---- Destinations: functions load from few buses -----------------------------------------------------------------
  logic load_gradient, load_reach_q;
  logic [2:0] reach_group_q;
  assign load_gradient = gradient_job_i || (edge_job_i && ordinary_job_i);

  always_ff @(posedge clk_i) begin
    load_reach_q <= load_gradient;
    reach_group_q <= job_group_i;
  end

  for (genvar p = 0; p < PAIRS; p++) begin : gen_result
    logic [OUT-1:0] result0, result1;
    logic [VAL-1:0] value;
    logic [LENGTH2-1:0] length2;
    logic [GRAD-1:0] gx, gy;
    logic tie_pos, tie_neg;
    logic [REACH-1:0] fall_tile, rise_tile, fall_block, rise_block;
    logic [GRAD-1:0] reach_gx_q, reach_gy_q;
    logic gx_zero_q, gy_zero_q;
    assign result0 = products.result0[p*OUT+:OUT];
    assign result1 = products.result1[p*OUT+:OUT];
    assign value = VAL'(result0);
    assign value_o[p*VAL+:VAL] = value;
    assign length2 = LENGTH2'(result1 >> QDROP);
    assign gx = ordinary_job_i ? GRAD'($signed(apart_y[p*RISE+:RISE])) << FRAC : GRAD'(result0);
    assign gy = ordinary_job_i ? GRAD'($signed(apart_x[p*RISE+:RISE])) << FRAC : GRAD'(result1);

    // The reach of a function whose gradient was loaded in the clock before.
    always_ff @(posedge clk_i) {reach_gx_q, reach_gy_q, gx_zero_q, gy_zero_q} <= {gx, gy, gx == '0, gy == '0};

    quadrille_edge_reach u_reach (
        .gx_i(reach_gx_q), .gy_i(reach_gy_q), .gx_zero_i(gx_zero_q), .gy_zero_i(gy_zero_q), .tie_pos_o(tie_pos),
        .tie_neg_o(tie_neg), .fall_tile_o(fall_tile), .rise_tile_o(rise_tile), .fall_block_o(fall_block),
        .rise_block_o(rise_block)
    );

    logic unused;
    assign unused = ^{result0, result1};  // the upper bits, in small configurations
  end

  for (genvar g = 0; g < 6; g++) begin : gen_function
    localparam int P = g % PAIRS;
    localparam logic [2:0] GROUP = 3'(g / PAIRS);
    logic mine;
    assign mine = job_group_i == GROUP || (PAIRS == 1 && g == 3 && job_group_i == 3'd4 && !ordinary_job_i);

    always_ff @(posedge clk_i) begin
      if (edge_job_i && mine) begin
        lin_value_o[g*VAL+:VAL] <= gen_result[P].value;
        length2_o[g*LENGTH2+:LENGTH2] <= gen_result[P].length2;
      end
      if (load_gradient && mine) begin
        lin_gx_o[g*GRAD+:GRAD] <= gen_result[P].gx;
        lin_gy_o[g*GRAD+:GRAD] <= gen_result[P].gy;
      end
    end

    if (g < 5) begin : gen_reach  // not of the diagonal 13, which is no edge of a clause
      always_ff @(posedge clk_i) begin
        if (load_reach_q && reach_group_q == GROUP) begin
          {ties_o[5+g], ties_o[g]} <= {gen_result[P].tie_pos, gen_result[P].tie_neg};
          reaches_o[(15+g)*REACH+:REACH] <= gen_result[P].fall_tile;
          reaches_o[(10+g)*REACH+:REACH] <= gen_result[P].rise_tile;
          reaches_o[(5+g)*REACH+:REACH] <= gen_result[P].fall_block;
          reaches_o[g*REACH+:REACH] <= gen_result[P].rise_block;
        end
      end
    end
  end
endmodule
