// visible_o of eye_in_hull, with inside_expression: which of the pixels that expression (12) accepts are in front of the eye.
// At most one of its four clauses accepts the pixel p = (0, 0, 1) at the origin, ties included, and then there are b_i >= 0, not all 0: its
// triangle's three edge functions at p, with the orientation o of the clause, or, where all three are 0, their gx, or where these are 0, their gy.
// - Always sum b_i V_i = o det p, det the determinant of the triangle (of gx, gy: o det times that axis).
// - With the eye outside the hull (proof eye_in_hull) that is not 0. Nor are the edge functions all 0: det p would be 0. So p, if o det > 0, or
//   else -p, is a sum of the V_i with b >= 0, and never are both: these two would add up to 0. The clause is visible if o det > 0.
// So for weights M >= 0 with sum M_i V_i along p, whatever their values (the mean value weights are such), the pixel is drawn if and only if
// sum M_i W_i > 0. With the eye in the hull, and of ordinary quads, which are in front of it, all accepted pixels pass here.
// Nothing is assumed. Identities and signs as in eye_in_hull_proof: the signs of any numbers edge_i and det_i.
module visible_clause_proof #(
    parameter int BITS = quadrille_pkg::DET_BITS
) (
    input logic ordinary_i,
    input logic [4*BITS-1:0] x_i,
    input logic [4*BITS-1:0] y_i,
    input logic [4*BITS-1:0] w_i,
    input logic [15*BITS-1:0] edge_i,
    input logic [4*BITS-1:0] det_i
);
  // ---- Signs of the determinants, and of the edges at the pixel with ties: a value of 0 has the sign of (gx, gy), the first that is not 0 --------
  logic [3:0] negative, zero, positive;
  logic [14:0] edge_pos, edge_neg;  // gx, gy, values
  logic [4:0] pos, neg;
  logic hull;
  logic [3:0] visible;

  for (genvar d = 0; d < 4; d++) begin : gen_det_sign
    assign negative[d] = det_i[d*BITS+BITS-1];
    assign zero[d] = det_i[d*BITS+:BITS] == '0;
    assign positive[d] = !negative[d] && !zero[d];
  end

  for (genvar e = 0; e < 15; e++) begin : gen_edge_sign
    assign edge_neg[e] = edge_i[e*BITS+BITS-1];
    assign edge_pos[e] = !edge_neg[e] && edge_i[e*BITS+:BITS] != '0;
  end

  for (genvar k = 0; k < 5; k++) begin : gen_tie
    assign pos[k] = edge_pos[10+k] || (!edge_neg[10+k] && (edge_pos[k] || (!edge_neg[k] && edge_pos[5+k])));
    assign neg[k] = edge_neg[10+k] || (!edge_pos[10+k] && (edge_neg[k] || (!edge_pos[k] && edge_neg[5+k])));
  end

  quadrille_eye_in_hull u_eye_in_hull (
      .ordinary_i,
      .negative_i(negative),
      .zero_i(zero),
      .hull_o(hull),
      .visible_o(visible)
  );

  // ---- Which clause accepts the pixel, and what is drawn ---------------------------------------------------------------------
  logic [3:0] back, front, accepts;
  logic back_drawn, front_drawn;

  for (genvar k = 0; k < 4; k++) begin : gen_clause
    quadrille_inside_expression u_inside (
        .cull_i(2'd0),
        .visible_i(4'(1 << k)),
        .pos_i(pos),
        .neg_i(neg),
        .back_o(back[k]),
        .front_o(front[k])
    );
  end

  quadrille_inside_expression u_drawn (
      .cull_i(2'd0),
      .visible_i(visible),
      .pos_i(pos),
      .neg_i(neg),
      .back_o(back_drawn),
      .front_o(front_drawn)
  );

  assign accepts = back | front;

  // ---- Triangle t: 012 with E12, E20, E01 as factors of its vertices, 023 with E23, -E20, E30 -----------------------------------
  logic [15*BITS-1:0] edges;
  logic [4*BITS-1:0] det;
  logic [17:0] identity;  // 9 t + 3 component + axis
  logic [3:0] weights;  // of the clause's b none is negative, not all are 0

  quad_products #(.BITS(BITS)) u_products (.x_i, .y_i, .w_i, .edge_o(edges), .det_o(det));

  for (genvar t = 0; t < 2; t++) begin : gen_triangle
    logic [2:0] none_neg, none_pos;  // of the three gx, gy, values

    for (genvar r = 0; r < 3; r++) begin : gen_component
      localparam int FIRST = 5 * r + t + 1;  // its factors of V0 and V2; the diagonal's of V1, negated of V3
      localparam int LAST = 5 * r + 3 * t;
      localparam int DIAGONAL = 5 * r + 4;
      logic [BITS-1:0] first, last, diagonal;

      assign first = edges[FIRST*BITS+:BITS];
      assign last = edges[LAST*BITS+:BITS];
      assign diagonal = edges[DIAGONAL*BITS+:BITS];
      assign none_neg[r] = !edge_neg[FIRST] && !edge_neg[LAST] && !((t == 0) ? edge_neg[DIAGONAL] : edge_pos[DIAGONAL]);
      assign none_pos[r] = !edge_pos[FIRST] && !edge_pos[LAST] && !((t == 0) ? edge_pos[DIAGONAL] : edge_neg[DIAGONAL]);

      for (genvar a = 0; a < 3; a++) begin : gen_axis
        logic [4*BITS-1:0] v;
        logic [BITS-1:0] sum;

        assign v = (a == 0) ? x_i : (a == 1) ? y_i : w_i;
        if (t == 0) begin : gen_012
          assign sum = first * v[0+:BITS] + diagonal * v[BITS+:BITS] + last * v[2*BITS+:BITS];
        end else begin : gen_023
          assign sum = first * v[0+:BITS] - diagonal * v[3*BITS+:BITS] + last * v[2*BITS+:BITS];
        end
        assign identity[9*t+3*r+a] = sum == ((r == a) ? det[t*BITS+:BITS] : BITS'(0));
      end
    end

    // The first of value, gx, gy that is not 0 thrice decides.
    assign {weights[2+t], weights[t]} = !(none_neg[2] && none_pos[2]) ? {none_pos[2], none_neg[2]} :
        !(none_neg[0] && none_pos[0]) ? {none_pos[0], none_neg[0]} :
        !(none_neg[1] && none_pos[1]) ? {none_pos[1], none_neg[1]} : 2'b00;
  end

  always_comb begin
    assert ((accepts & (accepts - 4'd1)) == '0);
    assert (back[3:2] == '0 && front[1:0] == '0);
    assert ((accepts & ~weights) == '0);
    assert (identity == '1);
    assert (visible == ((ordinary_i || hull) ? 4'b1111 : {negative[1:0], positive[1:0]}));
    assert (!(ordinary_i && hull));
    assert (back_drawn == ((back & visible) != '0) && front_drawn == ((front & visible) != '0));
  end
endmodule
