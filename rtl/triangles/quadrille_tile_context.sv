// SPDX-License-Identifier: Apache-2.0
// Triangle machine: a tile has no quadratic functions. Its entry is complete when it is pushed.
module quadrille_tile_context #(
    localparam int RING = quadrille_pkg::RING_LOG2
) (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    input logic take_i,
    input logic [quadrille_pkg::SETUP_BITS-1:0] setup_i,
    output logic homogeneous_o,  // an entry in parts: none
    input logic push_i,
    output logic ready_o,
    input logic end_i,
    input logic [quadrille_pkg::TILE_BITS-1:0] tile_i,
    input logic [RING-1:0] entry_i,
    output logic job_valid_o,
    output logic [quadrille_pkg::JOBS_BITS-1:0] jobs_o,
    input logic [quadrille_pkg::PRODUCTS_BITS-1:0] products_i,
    output logic [quadrille_pkg::WORDS_BITS-1:0] words_o  // its last two bits: complete, in parts
);
  assign homogeneous_o = 1'b0;
  assign ready_o = 1'b1;
  assign job_valid_o = 1'b0;
  assign jobs_o = '0;
  assign words_o = quadrille_pkg::WORDS_BITS'({push_i, 1'b0});

  logic unused;
  assign unused = ^{clk_i, rst_ni, take_i, setup_i, end_i, tile_i, entry_i, products_i};
endmodule
