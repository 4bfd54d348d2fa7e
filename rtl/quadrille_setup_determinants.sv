// SPDX-License-Identifier: Apache-2.0
`include "quadrille_types.svh"
// The determinants d_012, d_023, d_123, d_013 of quad_setup, a pair of units' own ones one after the other in one
// accumulator, and behind them the edge functions at the scissor's corners: then the last determinant's sign is kept
// (kept_*).
module quadrille_setup_determinants #(
    localparam int OUT = quadrille_pkg::DOT_OUT_BITS, DET = quadrille_pkg::DET_BITS,
    localparam int PAIRS = quadrille_pkg::PRODUCT_PAIRS
) (
    input logic clk_i,
    input logic [quadrille_pkg::PRODUCTS_BITS-1:0] products_i,
    // The jobs whose results are there; the second of two results is added
    input logic det_job_i, corner_job_i, second_job_i,
    output logic [3:0] negative_o, zero_o,
    output logic cornered_o,  // a corner came behind them
    output logic [PAIRS-1:0] corner_neg_o, corner_zero_o
);
  `QUADRILLE_IN(`QUADRILLE_PRODUCTS_T, products)

  localparam int DETS = 4 / PAIRS;

  always_ff @(posedge clk_i) cornered_o <= corner_job_i || (cornered_o && !det_job_i);

  for (genvar p = 0; p < PAIRS; p++) begin : gen_determinant
    logic [DET-1:0] det_q;
    logic [DETS-2:0] det_neg_q, det_zero_q;  // of those before the last, the latest at bit 0
    logic det_neg, det_zero, kept_neg_q, kept_zero_q;
    assign det_neg = det_q[DET-1];
    assign det_zero = det_q == '0;
    assign corner_neg_o[p] = det_neg;
    assign corner_zero_o[p] = det_zero;

    always_ff @(posedge clk_i) begin
      if (!cornered_o) {kept_neg_q, kept_zero_q} <= {det_neg, det_zero};
      if (det_job_i || corner_job_i) begin
        det_q <= (second_job_i ? det_q : '0) + DET'($signed(products.result0[p*OUT+:OUT])) +
            (DET'($signed(products.result1[p*OUT+:OUT])) << 32);
        if (det_job_i && !second_job_i) begin
          det_neg_q <= (DETS - 1)'({det_neg_q, det_neg});
          det_zero_q <= (DETS - 1)'({det_zero_q, det_zero});
        end
      end
    end

    assign negative_o[p*DETS+DETS-1] = cornered_o ? kept_neg_q : det_neg;
    assign zero_o[p*DETS+DETS-1] = cornered_o ? kept_zero_q : det_zero;

    for (genvar k = 0; k < DETS - 1; k++) begin : gen_before
      assign negative_o[p*DETS+k] = det_neg_q[DETS-2-k];
      assign zero_o[p*DETS+k] = det_zero_q[DETS-2-k];
    end
  end

endmodule
