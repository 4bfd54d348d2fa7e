// SPDX-License-Identifier: Apache-2.0
// Signed areas of the triangles 012 and 023 of an ordinary quad, E01 + E12 + E20 and E23 + E30 - E20 at any place,
// added up as the values come.
module quadrille_setup_areas #(
    localparam int VAL = quadrille_pkg::VAL_BITS, PAIRS = quadrille_pkg::PRODUCT_PAIRS
) (
    input logic clk_i, edge_job_i,
    input logic [2:0] job_group_i,
    input logic [PAIRS*VAL-1:0] value_i,
    output logic [3:0] signs_o  // as the clauses of visible: 023 negative, 012, 023 positive, 012
);
  localparam int AREA = VAL + 2;
  logic [AREA-1:0] area_012_q, area_023_q;

  // By their group: with one pair of units 01, 12, 23, 30, 20; with two 01 and 12, 23 and 30, 20 (and 13, which is in
  // neither).
  logic [AREA-1:0] area_value, area_value2;  // of the first pair of units, of the second
  logic [AREA-1:0] area_012_next, area_023_next;
  logic in_012, in_023, diagonal;
  assign area_value = AREA'($signed(value_i[0+:VAL]));
  assign area_value2 = (PAIRS == 1) ? '0 : AREA'($signed(value_i[(PAIRS-1)*VAL+:VAL]));
  assign diagonal = job_group_i == ((PAIRS == 1) ? 3'd4 : 3'd2);
  assign in_012 = job_group_i < ((PAIRS == 1) ? 3'd2 : 3'd1);
  assign in_023 = (PAIRS == 1) ? job_group_i[2:1] == 2'd1 : job_group_i == 3'd1;
  assign area_012_next = (job_group_i == 3'd0 ? '0 : area_012_q) + (in_012 || diagonal ? area_value : '0) + (in_012 ?
      area_value2 : '0);
  assign area_023_next = (job_group_i == 3'd0 ? '0 : area_023_q) + (in_023 ? area_value : diagonal ? ~area_value : '0) +
      (in_023 ? area_value2 : '0) + AREA'(diagonal);

  always_ff @(posedge clk_i) begin
    if (edge_job_i) begin
      area_012_q <= area_012_next;
      area_023_q <= area_023_next;
      signs_o <= {area_023_next[AREA-1], area_012_next[AREA-1], !area_023_next[AREA-1] && area_023_next != '0,
          !area_012_next[AREA-1] && area_012_next != '0};
    end
  end
endmodule
