// hull_o of eye_in_hull. The eye, the origin, is in the hull of the vertices V_i if there are b_i >= 0, not all 0, with sum b_i V_i = 0.
// - Then hull_o is high. By the identity (V_i x V_j) (sum b V) = b_l c_k - b_k c_l, c the determinants with their signs, b_l c_k = b_k c_l for all
//   k and l. So these products have like signs; with hull_o low no b has that. b may be real: of it the rule sees signs alone.
// - Where hull_o is high and some determinant is not 0, c or -c is such a b: sum c_i V_i = 0, and no two c have opposite signs.
// So hull_o is exact but for four determinants of 0 (vertices in a plane through the eye), for which it is high.
// Nothing is assumed. The identities are proved of the determinants, the signs of any numbers in their place (det_i), which is more, and quick.
// Identities modulo 2^BITS at all places are identities of integers: both sides are linear in each variable, with factors of 1 and -1.
module eye_in_hull_proof #(
    parameter int BITS = quadrille_pkg::DET_BITS
) (
    input logic [4*BITS-1:0] x_i,
    input logic [4*BITS-1:0] y_i,
    input logic [4*BITS-1:0] w_i,
    input logic [4*BITS-1:0] b_i,
    input logic [4*BITS-1:0] det_i
);
  // ---- Signs: quad_setup's of the determinants, then the rule ------------------------------------------------------------------
  logic [3:0] negative, zero, positive;
  logic [3:0] c_pos, c_neg, b_pos, b_neg;  // c: d_123, -d_023, d_013, -d_012
  logic hull, ordinary_hull;
  logic [3:0] unused, ordinary_visible;

  for (genvar i = 0; i < 4; i++) begin : gen_sign
    assign negative[i] = det_i[i*BITS+BITS-1];
    assign zero[i] = det_i[i*BITS+:BITS] == '0;
    assign positive[i] = !negative[i] && !zero[i];
    assign b_neg[i] = b_i[i*BITS+BITS-1];
    assign b_pos[i] = !b_neg[i] && b_i[i*BITS+:BITS] != '0;
  end

  assign c_pos = {negative[0], positive[3], negative[1], positive[2]};
  assign c_neg = {positive[0], negative[3], positive[1], negative[2]};

  quadrille_eye_in_hull u_homogeneous (
      .ordinary_i(1'b0),
      .negative_i(negative),
      .zero_i(zero),
      .hull_o(hull),
      .visible_o(unused)
  );

  // All W are positive: the eye is outside, and all that (12) accepts is in front of it.
  quadrille_eye_in_hull u_ordinary (
      .ordinary_i(1'b1),
      .negative_i(negative),
      .zero_i(zero),
      .hull_o(ordinary_hull),
      .visible_o(ordinary_visible)
  );

  // ---- Identities ------------------------------------------------------------------------------------------------------------
  logic [15*BITS-1:0] unused_edges;
  logic [4*BITS-1:0] det, c;

  quad_products #(.BITS(BITS)) u_products (.x_i, .y_i, .w_i, .edge_o(unused_edges), .det_o(det));

  assign c = {-det[0+:BITS], det[3*BITS+:BITS], -det[BITS+:BITS], det[2*BITS+:BITS]};

  logic [3*BITS-1:0] sum_b, sum_c;  // of b V, of c V: x, y, w

  for (genvar a = 0; a < 3; a++) begin : gen_axis
    logic [4*BITS-1:0] v;
    logic [BITS-1:0] v0, v1, v2, v3;

    assign v = (a == 0) ? x_i : (a == 1) ? y_i : w_i;
    assign {v3, v2, v1, v0} = v;
    assign sum_b[a*BITS+:BITS] = b_i[0+:BITS] * v0 + b_i[BITS+:BITS] * v1 + b_i[2*BITS+:BITS] * v2 + b_i[3*BITS+:BITS] * v3;
    assign sum_c[a*BITS+:BITS] = c[0+:BITS] * v0 + c[BITS+:BITS] * v1 + c[2*BITS+:BITS] * v2 + c[3*BITS+:BITS] * v3;
  end

  // Of each pair k < l, (k, l, i, j) an even permutation.
  logic [15:0] identity, like_signs;

  for (genvar k = 0; k < 4; k++) begin : gen_k
    for (genvar l = 0; l < 4; l++) begin : gen_l
      if (k < l) begin : gen_pair
        localparam int LOW = (k != 0) ? 0 : (l != 1) ? 1 : 2;
        localparam int HIGH = (l != 3) ? 3 : (k != 2) ? 2 : 1;
        localparam int I = ((k + l) % 2 == 1) ? LOW : HIGH;
        localparam int J = ((k + l) % 2 == 1) ? HIGH : LOW;
        logic [BITS-1:0] xi, yi, wi, xj, yj, wj, side, factor;

        assign xi = x_i[I*BITS+:BITS];
        assign yi = y_i[I*BITS+:BITS];
        assign wi = w_i[I*BITS+:BITS];
        assign xj = x_i[J*BITS+:BITS];
        assign yj = y_i[J*BITS+:BITS];
        assign wj = w_i[J*BITS+:BITS];
        assign side = (yi * wj - wi * yj) * sum_b[0+:BITS] + (wi * xj - xi * wj) * sum_b[BITS+:BITS] + (xi * yj - yi * xj) * sum_b[2*BITS+:BITS];
        assign factor = b_i[l*BITS+:BITS] * c[k*BITS+:BITS] - b_i[k*BITS+:BITS] * c[l*BITS+:BITS];
        assign identity[4*k+l] = side == factor;
        assign like_signs[4*k+l] = (b_pos[l] && c_pos[k]) == (b_pos[k] && c_pos[l]) && (b_pos[l] && c_neg[k]) == (b_pos[k] && c_neg[l]);
      end else begin : gen_none
        assign identity[4*k+l] = 1'b1;
        assign like_signs[4*k+l] = 1'b1;
      end
    end
  end

  always_comb begin
    assert (identity == '1);
    assert (hull || b_neg != '0 || b_pos == '0 || like_signs != '1);
    assert (sum_c == '0);
    assert (!hull || c_pos == '0 || c_neg == '0);
    assert (!ordinary_hull && ordinary_visible == '1);
  end
endmodule
