// SPDX-License-Identifier: Apache-2.0
`include "quadrille_types.svh"
// The linear functions of tile_walk at the first pixel of its block and of its tile, and the extent test: is an edge
// function somewhere positive, somewhere negative.
module quadrille_walk_values #(
    localparam int VAL = quadrille_pkg::VAL_BITS, GRAD = quadrille_pkg::GRAD_BITS, REACH = quadrille_pkg::REACH_BITS
) (
    input logic clk_i, take_i,
    input logic [quadrille_pkg::SETUP_BITS-1:0] setup_i,
    // The walk: everything moves; a tile is under test, a block steps on; back to the block before, a block's tiles
    // end; the step is down, or to the left
    input logic go_i, in_walk_i, step_block_i, enter_walk_i, tile_end_i, row_end_i, back_i,
    output logic [4:0] some_pos_o,  // a clock after the test
    output logic [4:0] some_neg_o,
    output logic [6*VAL-1:0] lin_value_o  // two clocks after it: of the tile
);
  localparam int TL = quadrille_pkg::TILE_LOG2;  // log2 of a tile step in pixels
  localparam int BL = TL + quadrille_pkg::BLOCK_LOG2;  // log2 of a block step in pixels
  `QUADRILLE_IN(`QUADRILLE_SETUP_T, setup)

  // Outside WALK the tile is the first of the block to test. One set of adders steps blocks and tiles: a step to the
  // left subtracts: ~x, and the one that is missing enters as carry ({a, 1} + {b, carry}). After a block's last tile
  // comes the next block, which is there.
  logic [6*VAL-1:0] lin_value_q1;

  for (genvar g = 0; g < 6; g++) begin : gen_linear
    logic [GRAD-1:0] gx_q, gy_q;
    logic [VAL-1:0] block_q, tile_q, slope, move, next;
    assign slope = VAL'($signed(row_end_i ? gy_q : gx_q));
    assign move = (in_walk_i ? slope << TL : slope << BL) ^ {VAL{back_i}};
    assign next = VAL'(({tile_q, 1'b1} + {move, back_i}) >> 1);

    always_ff @(posedge clk_i) begin
      if (take_i) begin
        gx_q <= setup.lin_gx[g*GRAD+:GRAD];
        gy_q <= setup.lin_gy[g*GRAD+:GRAD];
        block_q <= setup.lin_value[g*VAL+:VAL];
        tile_q <= setup.lin_value[g*VAL+:VAL];
      end else if (go_i) begin
        if (step_block_i) block_q <= next;
        if (enter_walk_i) tile_q <= lin_value_q1[g*VAL+:VAL];
        else if (tile_end_i) tile_q <= block_q;
        else if (in_walk_i || step_block_i) tile_q <= next;
      end
      if (go_i) begin
        lin_value_q1[g*VAL+:VAL] <= tile_q;
        lin_value_o[g*VAL+:VAL] <= lin_value_q1[g*VAL+:VAL];
      end
    end

    if (g < 5) begin : gen_test
      logic [REACH-1:0] fall_tile_q, fall_block_q, rise_tile_q, rise_block_q;
      logic [VAL-1:0] low, high;

      always_ff @(posedge clk_i) begin
        if (take_i) begin
          fall_tile_q <= setup.fall_tile[g*REACH+:REACH];
          fall_block_q <= setup.fall_block[g*REACH+:REACH];
          rise_tile_q <= setup.rise_tile[g*REACH+:REACH];
          rise_block_q <= setup.rise_block[g*REACH+:REACH];
        end
        if (go_i) begin
          some_neg_o[g] <= low[VAL-1];
          some_pos_o[g] <= !high[VAL-1];
        end
      end

      assign low = tile_q + VAL'($signed(in_walk_i ? fall_tile_q : fall_block_q));
      assign high = tile_q + VAL'($signed(in_walk_i ? rise_tile_q : rise_block_q));

      logic unused;
      assign unused = ^{low, high};
    end
  end

endmodule
