// Mean value weights M_i, up to a common factor, from u = r r' + |D| and v = |A| of the six vertex pairs. One pixel per clock.
//
//     M_0 : M_1 : M_2 : M_3 = abc : a : c : b      a^2 = q_23 / q_01, b^2 = q_12 / q_30, c^2 = q_13 / q_20 (root_ratio)
//
// with a, b, c as fractions, so that a weight is a product of three numbers: no sum of weights' terms, and nothing cancels.
// Singular pixels replace the three at OVERRIDE_STAGE. On two edges (two_edge) the first two are r of an edge's other end and the other
// edge's denominator N = |r_j k_i + r_i k_j|, whose products take the multipliers of root_ratio's operands; a vertex on both edges has
// the sum of two such products. Weights are magnitudes (they have one sign).
//
// class_i is singular_class's word; k_* are k_eff. Inputs enter at ROOT_STAGE (root), RATIO_STAGE, and one register before
// OVERRIDE_STAGE (override_*); M leaves at WEIGHT_STAGE (quadrille_pkg).
module mean_value_weights #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int E = quadrille_pkg::EXP_BITS,
    localparam int PE = quadrille_pkg::PORT_EXP_BITS
) (
    input logic clk_i,
    // at ROOT_STAGE
    input logic [4*E-1:0] root_exp_i,
    input logic [4*S-1:0] root_sig_i,
    // at RATIO_STAGE
    input logic [6*E-1:0] u_exp_i,
    input logic [6*S-1:0] u_sig_i,
    input logic [6*E-1:0] v_exp_i,
    input logic [6*S-1:0] v_sig_i,
    input logic [5:0] d_neg_i,
    input logic [8:0] class_i,
    input logic [3:0] k_neg_i,
    input logic [4*PE-1:0] k_exp_i,
    input logic [4*S-1:0] k_sig_i,
    // at OVERRIDE_STAGE - 1
    input logic [4*PE-1:0] override_k_exp_i,
    input logic [4*S-1:0] override_k_sig_i,
    // at WEIGHT_STAGE
    output logic [4*E-1:0] m_exp_o,
    output logic [4*S-1:0] m_sig_o
);
  localparam int TERM = quadrille_pkg::TERM_BITS;
  localparam int RANK = quadrille_pkg::RANK_BITS;
  localparam int F = E + S;
  localparam logic [F-1:0] ONE = {E'(0), 1'b1, (S - 1)'(0)};

  // ---- What waits: r for the denominators and the overrides, the class for the overrides -------------------------------------
  localparam int TO_RATIO = quadrille_pkg::RATIO_STAGE - quadrille_pkg::ROOT_STAGE;
  localparam int TO_N = quadrille_pkg::N_STAGE - quadrille_pkg::RATIO_STAGE;  // where overrides are chosen
  logic [4*F-1:0] root, late_root;
  logic [8:0] late_class, sum_class, last_class;

  for (genvar g = 0; g < 4; g++) begin : gen_root
    delay_line #(.WIDTH(F), .DEPTH(TO_RATIO)) u_delay_root (
        .clk_i,
        .data_i({root_exp_i[g*E+:E], root_sig_i[g*S+:S]}),
        .data_o(root[g*F+:F])
    );
  end

  delay_line #(.WIDTH(4 * F), .DEPTH(TO_N)) u_delay_late_root (
      .clk_i,
      .data_i(root),
      .data_o(late_root)
  );

  delay_line #(.WIDTH(9), .DEPTH(TO_N)) u_delay_late_class (
      .clk_i,
      .data_i(class_i),
      .data_o(late_class)
  );

  delay_line #(.WIDTH(9), .DEPTH(1 + quadrille_pkg::PRODUCT_STAGES)) u_delay_sum_class (
      .clk_i,
      .data_i(late_class),
      .data_o(sum_class)
  );

  delay_line #(.WIDTH(9), .DEPTH(quadrille_pkg::FP_ADD_STAGES)) u_delay_last_class (
      .clk_i,
      .data_i(sum_class),
      .data_o(last_class)
  );

  // ---- Operands of a denominator: N = r_j k_i + r_i k_j of edge (i, j) ---------------------------------------------------------
  logic two_edge;
  logic [4*F-1:0] k;
  logic [1:0] first, second, after_first, after_second;
  // {first: r_j, r_i; second: r_j, r_i}, and k with its sign
  logic [4*F-1:0] edge_root, edge_k;
  logic [3:0] edge_neg;
  logic [4*2-1:0] root_index, k_index;

  assign two_edge = class_i[6];
  assign first = class_i[3:2];
  assign second = class_i[1:0];
  assign after_first = first + 2'd1;
  assign after_second = second + 2'd1;
  assign root_index = {second, after_second, first, after_first};
  assign k_index = {after_second, second, after_first, first};

  for (genvar g = 0; g < 4; g++) begin : gen_edge
    assign k[g*F+:F] = {E'($signed(k_exp_i[g*PE+:PE])), k_sig_i[g*S+:S]};

    one_of_four #(.WIDTH(F)) u_root (
        .words_i(root),
        .index_i(root_index[2*g+:2]),
        .word_o(edge_root[g*F+:F])
    );
    one_of_four #(.WIDTH(F)) u_k (
        .words_i(k),
        .index_i(k_index[2*g+:2]),
        .word_o(edge_k[g*F+:F])
    );
    one_of_four #(.WIDTH(1)) u_neg (
        .words_i(k_neg_i),
        .index_i(k_index[2*g+:2]),
        .word_o(edge_neg[g])
    );
  end

  // ---- Operands: of z and w of the three ratios, or of two denominators in z0, z1, z2, w0 -------------------------------------
  logic [6*F-1:0] operand_a_q, operand_b_q;  // z0, z1, z2, w0, w1, w2
  logic [3*F-1:0] own_q;
  logic [2:0] near_cancels_q, far_cancels_q;
  logic [3:0] edge_neg_q;

  always_ff @(posedge clk_i) edge_neg_q <= edge_neg;

  for (genvar g = 0; g < 3; g++) begin : gen_operand
    localparam int NEAR = (g == 0) ? 0 : g + 2;  // 01, 30, 20
    localparam int FAR = (g == 0) ? 2 : (g == 1) ? 1 : 5;  // 23, 12, 13
    logic near_cancels, far_cancels;
    logic [F-1:0] u_near, u_far, v_near, v_far;

    assign near_cancels = d_neg_i[NEAR] == (g < 2);  // edges cancel where D < 0, diagonals elsewhere
    assign far_cancels = d_neg_i[FAR] == (g < 2);
    assign u_near = {u_exp_i[NEAR*E+:E], u_sig_i[NEAR*S+:S]};
    assign u_far = {u_exp_i[FAR*E+:E], u_sig_i[FAR*S+:S]};
    assign v_near = {v_exp_i[NEAR*E+:E], v_sig_i[NEAR*S+:S]};
    assign v_far = {v_exp_i[FAR*E+:E], v_sig_i[FAR*S+:S]};

    always_ff @(posedge clk_i) begin
      operand_a_q[g*F+:F] <= two_edge ? edge_root[g*F+:F] : u_near;
      operand_b_q[g*F+:F] <= two_edge ? edge_k[g*F+:F] : u_far;
      own_q[g*F+:F] <= near_cancels ? v_near : far_cancels ? v_far : u_far;
      near_cancels_q[g] <= near_cancels;
      far_cancels_q[g] <= far_cancels;
    end

    if (g == 0) begin : gen_shared
      always_ff @(posedge clk_i) begin
        operand_a_q[3*F+:F] <= two_edge ? edge_root[3*F+:F] : v_far;
        operand_b_q[3*F+:F] <= two_edge ? edge_k[3*F+:F] : u_near;
      end
    end else begin : gen_own
      always_ff @(posedge clk_i) begin
        operand_a_q[(3+g)*F+:F] <= v_far;
        operand_b_q[(3+g)*F+:F] <= u_near;
      end
    end
  end

  // ---- Products ----------------------------------------------------------------------------------------------------------------
  logic [6*F-1:0] product;
  logic [6*RANK-1:0] rank;
  logic [6*TERM-1:0] term;
  logic [3*F-1:0] own;
  logic [2:0] near_cancels, far_cancels;
  logic [3:0] term_neg;

  for (genvar g = 0; g < 6; g++) begin : gen_product
    fp_product u_product (
        .clk_i,
        .a_exp_i(operand_a_q[g*F+S+:E]),
        .a_sig_i(operand_a_q[g*F+:S]),
        .b_exp_i(operand_b_q[g*F+S+:E]),
        .b_sig_i(operand_b_q[g*F+:S]),
        .exp_o(product[g*F+S+:E]),
        .sig_o(product[g*F+:S]),
        .rank_o(rank[g*RANK+:RANK]),
        .term_o(term[g*TERM+:TERM])
    );
  end

  delay_line #(.WIDTH(3 * F + 10), .DEPTH(quadrille_pkg::PRODUCT_STAGES)) u_delay_own (
      .clk_i,
      .data_i({own_q, near_cancels_q, far_cancels_q, edge_neg_q}),
      .data_o({own, near_cancels, far_cancels, term_neg})
  );

  // ---- The three ratios a, b, c, and the denominators of two edges ----------------------------------------------------------------
  logic [3*F-1:0] num, den;
  logic [2*F-1:0] edge_n;
  logic [1:0] edge_n_neg;

  for (genvar g = 0; g < 3; g++) begin : gen_ratio
    root_ratio u_ratio (
        .clk_i,
        .near_cancels_i(near_cancels[g]),
        .far_cancels_i(far_cancels[g]),
        .z_exp_i(product[g*F+S+:E]),
        .z_sig_i(product[g*F+:S]),
        .w_exp_i(product[(3+g)*F+S+:E]),
        .w_sig_i(product[(3+g)*F+:S]),
        .own_exp_i(own[g*F+S+:E]),
        .own_sig_i(own[g*F+:S]),
        .num_exp_o(num[g*F+S+:E]),
        .num_sig_o(num[g*F+:S]),
        .den_exp_o(den[g*F+S+:E]),
        .den_sig_o(den[g*F+:S])
    );
  end

  for (genvar g = 0; g < 2; g++) begin : gen_denominator
    fp_sum #(.TERMS(2)) u_sum (
        .clk_i,
        .rank_i(rank[2*g*RANK+:2*RANK]),
        .neg_i(term_neg[2*g+:2]),
        .term_i(term[2*g*TERM+:2*TERM]),
        .neg_o(edge_n_neg[g]),
        .exp_o(edge_n[g*F+S+:E]),
        .sig_o(edge_n[g*F+:S])
    );
  end

  // ---- Overrides ---------------------------------------------------------------------------------------------------------------
  logic late_two_corner, late_on_vertex, late_two_edge;
  logic [1:0] late_first, late_second;
  logic [4*F-1:0] override_k;
  logic [F-1:0] first_k, second_k;  // |k_eff| of the two corners

  assign late_two_corner = late_class[8];
  assign late_on_vertex = late_class[7];
  assign late_two_edge = late_class[6];
  assign late_first = late_class[3:2];
  assign late_second = late_class[1:0];

  for (genvar g = 0; g < 4; g++) begin : gen_override_k
    assign override_k[g*F+:F] = {E'($signed(override_k_exp_i[g*PE+:PE])), override_k_sig_i[g*S+:S]};
  end

  one_of_four #(.WIDTH(F)) u_k_first (
      .words_i(override_k),
      .index_i(late_first),
      .word_o(first_k)
  );
  one_of_four #(.WIDTH(F)) u_k_second (
      .words_i(override_k),
      .index_i(late_second),
      .word_o(second_k)
  );

  // ---- M_i = x y z ---------------------------------------------------------------------------------------------------------------
  logic [4*F-1:0] xy, m, late_m;

  for (genvar g = 0; g < 4; g++) begin : gen_weight
    localparam int P = (g + 3) % 4;
    localparam int Q = (g + 1) % 4;

    logic is_first, is_second;  // corner g is the first, second singular corner
    logic own_edge, edge_before;  // edge g, edge g-1 is one of the two
    logic n_of_first;  // the denominator for corner g is the first edge's
    logic [F-1:0] x_d, y_d, z_d, x_q, y_q, z_q;

    assign is_first = late_first == 2'(g);
    assign is_second = late_second == 2'(g);
    assign own_edge = is_first || is_second;
    assign edge_before = late_first == 2'(P) || late_second == 2'(P);
    // On one of the edges: the other's. On both: that of edge g, with r of corner g-1; the other term is formed in the place of corner
    // g+2, which is on neither and takes the denominator of edge g+1, with r of its corner before.
    assign n_of_first = (own_edge == edge_before) ? late_first == (own_edge ? 2'(g) : 2'(Q)) : late_second == 2'(g) || late_second == 2'(P);

    always_comb begin
      x_d = (g < 2) ? num[0+:F] : den[0+:F];
      y_d = (g == 0 || g == 3) ? num[F+:F] : den[F+:F];
      z_d = (g % 2 == 0) ? num[2*F+:F] : den[2*F+:F];
      if (late_two_corner) x_d = is_first ? second_k : is_second ? first_k : '0;
      if (late_on_vertex) x_d = is_first ? ONE : '0;
      if (late_two_edge) x_d = (own_edge && !edge_before) ? late_root[Q*F+:F] : late_root[P*F+:F];
      if (late_two_edge) y_d = n_of_first ? edge_n[0+:F] : edge_n[F+:F];
      if (late_two_corner || late_on_vertex) y_d = ONE;
      if (late_two_corner || late_on_vertex || late_two_edge) z_d = ONE;
    end

    always_ff @(posedge clk_i) {x_q, y_q, z_q} <= {x_d, y_d, z_d};

    fp_multiply u_xy (
        .clk_i,
        .a_exp_i(x_q[S+:E]),
        .a_sig_i(x_q[0+:S]),
        .b_exp_i(y_q[S+:E]),
        .b_sig_i(y_q[0+:S]),
        .exp_o(xy[g*F+S+:E]),
        .sig_o(xy[g*F+:S])
    );

    logic [F-1:0] late_z;

    delay_line #(.WIDTH(F), .DEPTH(quadrille_pkg::PRODUCT_STAGES)) u_delay_z (
        .clk_i,
        .data_i(z_q),
        .data_o(late_z)
    );

    fp_multiply u_m (
        .clk_i,
        .a_exp_i(xy[g*F+S+:E]),
        .a_sig_i(xy[g*F+:S]),
        .b_exp_i(late_z[S+:E]),
        .b_sig_i(late_z[0+:S]),
        .exp_o(m[g*F+S+:E]),
        .sig_o(m[g*F+:S])
    );
  end

  delay_line #(.WIDTH(4 * F), .DEPTH(quadrille_pkg::FP_ADD_STAGES - quadrille_pkg::PRODUCT_STAGES)) u_delay_m (
      .clk_i,
      .data_i(m),
      .data_o(late_m)
  );

  // ---- The corner on both of two neighbouring edges ------------------------------------------------------------------------------
  logic [1:0] corner;
  logic [F-1:0] term_a, term_b, both;

  assign corner = (sum_class[3:2] == 2'd0 && sum_class[1:0] == 2'd3) ? 2'd0 : sum_class[1:0];

  one_of_four #(.WIDTH(F)) u_term_a (
      .words_i(xy),
      .index_i(corner),
      .word_o(term_a)
  );
  one_of_four #(.WIDTH(F)) u_term_b (
      .words_i(xy),
      .index_i(corner + 2'd2),
      .word_o(term_b)
  );

  // Lone numbers are terms with the fraction bits of a product by 1.
  fp_add u_both (
      .clk_i,
      .a_rank_i(quadrille_pkg::exponent_rank(term_a[S+:E], term_a[S-1])),
      .a_term_i(TERM'(term_a[0+:S]) << (TERM - S - 1)),
      .b_rank_i(quadrille_pkg::exponent_rank(term_b[S+:E], term_b[S-1])),
      .b_term_i(TERM'(term_b[0+:S]) << (TERM - S - 1)),
      .exp_o(both[S+:E]),
      .sig_o(both[0+:S])
  );

  logic neighbours;  // two edges with a corner in common
  logic [1:0] last_corner;

  assign neighbours = last_class[6] && last_class[2] != last_class[0];
  assign last_corner = (last_class[3:2] == 2'd0 && last_class[1:0] == 2'd3) ? 2'd0 : last_class[1:0];

  for (genvar g = 0; g < 4; g++) begin : gen_output
    logic [F-1:0] m_q;

    always_ff @(posedge clk_i) begin
      m_q <= late_m[g*F+:F];
      if (neighbours && last_corner == 2'(g)) m_q <= both;
      if (neighbours && last_corner == 2'((g + 2) % 4)) m_q <= '0;
    end

    assign {m_exp_o[g*E+:E], m_sig_o[g*S+:S]} = m_q;
  end

  logic unused;
  assign unused = ^{edge_n_neg, late_class[5:4], last_class, sum_class[8:4], rank[4*RANK+:2*RANK], term[4*TERM+:2*TERM]};
endmodule
