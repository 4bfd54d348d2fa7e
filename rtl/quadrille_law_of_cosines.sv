// SPDX-License-Identifier: Apache-2.0
// D of a pair of vertices at a pixel. Of an ordinary quad from what its four squared distances say, by the law of
// cosines: D_ij = (r2_i + r2_j - |V_i - V_j|^2) / 2; of a homogeneous quad, whose W differ, the value that comes
// (exact_i). Latency LAW_OF_COSINES_STAGES (2), one pixel a clock: the sum; the difference, or the value.
//
// All in units of 2^-QUADRATIC_FRAC_BITS. The difference of an ordinary quad is even unless QDROP takes bits that its
// positions have; then half of it is the floor. length2_i, exact_i and homogeneous_i come one clock after r2.
module quadrille_law_of_cosines #(
    localparam int QVAL = quadrille_pkg::QVAL_BITS, LENGTH2 = quadrille_pkg::LENGTH2_BITS
) (
    input logic clk_i,
    input logic [QVAL-1:0] r2_first_i, r2_second_i,
    input logic homogeneous_i,
    input logic [QVAL-1:0] exact_i,
    input logic [LENGTH2-1:0] length2_i,
    output logic [QVAL-1:0] d_o
);
  localparam int TWICE = QVAL + 1;  // 2 D: what the three have above it cancels

  logic [TWICE-1:0] sum_q, twice;

  always_ff @(posedge clk_i) sum_q <= TWICE'($signed(r2_first_i)) + TWICE'($signed(r2_second_i));

  assign twice = sum_q - TWICE'(length2_i);

  always_ff @(posedge clk_i) d_o <= homogeneous_i ? exact_i : twice[TWICE-1:1];

  logic unused;
  assign unused = twice[0];
endmodule
