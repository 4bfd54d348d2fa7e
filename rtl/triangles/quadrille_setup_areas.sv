// SPDX-License-Identifier: Apache-2.0
// Triangle machine: signed area of an ordinary triangle, E01 + E12 + E20 at any place, added up as the values come.
module quadrille_setup_areas #(
    localparam int VAL = quadrille_pkg::VAL_BITS, PAIRS = quadrille_pkg::PRODUCT_PAIRS
) (
    input logic clk_i, edge_job_i,
    input logic [2:0] job_group_i,
    input logic [PAIRS*VAL-1:0] value_i,
    output logic [3:0] signs_o  // as the clauses of visible: bit 2 negative, bit 0 positive
);
  localparam int AREA = VAL + 2;
  logic [AREA-1:0] area_q, area_next;
  assign area_next = (job_group_i == 3'd0 ? '0 : area_q) + AREA'($signed(value_i[0+:VAL]));

  always_ff @(posedge clk_i) begin
    if (edge_job_i) begin
      area_q <= area_next;
      signs_o <= {1'b0, area_next[AREA-1], 1'b0, !area_next[AREA-1] && area_next != '0};
    end
  end
endmodule
