// One function of the pixel position from the context of its tile: value + r gy + q r^2 (stage 0: row), + dx gx + q dx^2 (stage 1:
// column). Exact modulo 2^VALUE_BITS. Latency 2, one pixel an enabled clock.
//
// Two's complement throughout; r, dx are unsigned. A linear function has q = 0.
module forward_difference #(
    parameter int VALUE_BITS = 64,
    parameter int GRAD_BITS = 48,
    parameter int CURV_BITS = 1,
    localparam int TILE_LOG2 = quadrille_pkg::TILE_LOG2
) (
    input logic clk_i,
    input logic en_i,
    input logic [TILE_LOG2-1:0] row_i,
    input logic [TILE_LOG2-1:0] dx_i,
    input logic [VALUE_BITS-1:0] value_i,
    input logic [GRAD_BITS-1:0] gx_i,
    input logic [GRAD_BITS-1:0] gy_i,
    input logic [CURV_BITS-1:0] q_i,
    output logic [VALUE_BITS-1:0] value_o
);
  localparam int SQUARE_BITS = 2 * TILE_LOG2;

  logic [SQUARE_BITS-1:0] row_square, dx_square;
  logic [VALUE_BITS-1:0] row_d, row_q;
  logic [VALUE_BITS-1:0] column_d;
  logic [GRAD_BITS-1:0] gx_q;
  logic [CURV_BITS-1:0] curv_q;
  logic [TILE_LOG2-1:0] dx_q;

  assign row_square = SQUARE_BITS'(row_i) * SQUARE_BITS'(row_i);
  assign dx_square = SQUARE_BITS'(dx_q) * SQUARE_BITS'(dx_q);
  assign row_d = value_i + VALUE_BITS'($signed(gy_i)) * VALUE_BITS'(row_i) + VALUE_BITS'($signed(q_i)) * VALUE_BITS'(row_square);
  assign column_d = row_q + VALUE_BITS'($signed(gx_q)) * VALUE_BITS'(dx_q) + VALUE_BITS'($signed(curv_q)) * VALUE_BITS'(dx_square);

  always_ff @(posedge clk_i) begin
    if (en_i) begin
      row_q <= row_d;
      gx_q <= gx_i;
      curv_q <= q_i;
      dx_q <= dx_i;
      value_o <= column_d;
    end
  end
endmodule
