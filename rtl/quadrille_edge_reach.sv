// SPDX-License-Identifier: Apache-2.0
// How far an edge function falls and rises over a tile and over a block, from its value at the first pixel: what
// tile_walk adds to that value. Combinational.
//
// Over n x n pixels it reaches from value + (n-1) low to value + (n-1) high, low = min(0, gx) + min(0, gy), high
// likewise. Ties are counted in: a zero has the sign of (gx, gy), the first that is not 0, or none (tie_pos_o,
// tie_neg_o), so that 'somewhere negative' is value + fall < 0 and 'somewhere positive' is value + rise >= 0.
module quadrille_edge_reach #(
    localparam int GRAD = quadrille_pkg::GRAD_BITS, REACH = quadrille_pkg::REACH_BITS
) (
    input logic [GRAD-1:0] gx_i, gy_i,
    input logic gx_zero_i, gy_zero_i,  // gx, gy are 0: kept in registers, for the test takes long
    output logic tie_pos_o, tie_neg_o,
    output logic [REACH-1:0] fall_tile_o, rise_tile_o, fall_block_o, rise_block_o
);
  localparam int TL = quadrille_pkg::TILE_LOG2;
  localparam int BL = TL + quadrille_pkg::BLOCK_LOG2;

  logic [REACH-1:0] gx, gy, low, high;
  logic x_neg, y_neg;
  assign gx = REACH'($signed(gx_i));
  assign gy = REACH'($signed(gy_i));
  assign x_neg = gx_i[GRAD-1];
  assign y_neg = gy_i[GRAD-1];
  assign low = (x_neg ? gx : '0) + (y_neg ? gy : '0);
  assign high = (x_neg ? '0 : gx) + (y_neg ? '0 : gy);
  assign tie_neg_o = x_neg || (gx_zero_i && y_neg);
  assign tie_pos_o = !tie_neg_o && !(gx_zero_i && gy_zero_i);

  // (n-1) low, less 1 where a zero counts as negative; (n-1) high, less 1 where it does not count as positive. -x is ~x
  // + 1, and that one or none is the carry-in ({a, 1} + {b, carry}).
  assign fall_tile_o = REACH'(({low << TL, 1'b1} + {~low, !tie_neg_o}) >> 1);
  assign rise_tile_o = REACH'(({high << TL, 1'b1} + {~high, tie_pos_o}) >> 1);
  assign fall_block_o = REACH'(({low << BL, 1'b1} + {~low, !tie_neg_o}) >> 1);
  assign rise_block_o = REACH'(({high << BL, 1'b1} + {~high, tie_pos_o}) >> 1);
endmodule
