// Mean value weights M_i, up to a common factor, from t_i = n_i / d_i and rho_i. Stages 11 to 17, one pixel per enabled clock.
//
//     M_i = N_i e'_i  *  rho'_i f'_i      N_i = n_{i-1} d_i + n_i d_{i-1}, e'_i = d_{i+1} d_{i+2}, f'_i = 1
//
// Cured notch (two neighbouring t of opposite sign): N_i = n n' + d d' there, times the half-angle tangent's numerator in f'.
// Singular pixels replace N, e', rho' in stage 15; two_edge uses the N adders for its edges' denominators rho k + rho' k'.
// Weights are magnitudes (they have one sign). class_*_i = singular_class's word at the stage named; k_* are k_eff.
module mean_value_weights #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int E = quadrille_pkg::EXP_BITS,
    localparam int PE = quadrille_pkg::PORT_EXP_BITS
) (
    input logic clk_i,
    input logic en_i,
    // stage 6
    input logic [4*E-1:0] rho_exp_i,
    input logic [4*S-1:0] rho_sig_i,
    // stage 10
    input logic [6*E-1:0] n_exp_i,
    input logic [6*S-1:0] n_sig_i,
    input logic [6*E-1:0] d_exp_i,
    input logic [6*S-1:0] d_sig_i,
    input logic [12:0] class_10_i,
    input logic [3:0] k_neg_10_i,
    input logic [4*PE-1:0] k_exp_10_i,
    input logic [4*S-1:0] k_sig_10_i,
    // stages 13, 14
    input logic [12:0] class_13_i,
    input logic [12:0] class_14_i,
    input logic [4*PE-1:0] k_exp_14_i,
    input logic [4*S-1:0] k_sig_14_i,
    // stage 17
    output logic [4*E-1:0] m_exp_o,
    output logic [4*S-1:0] m_sig_o
);
  localparam logic [S-1:0] ONE_SIG = {1'b1, (S - 1)'(0)};

  // ---- rho for stage 11 and stage 15 --------------------------------------------------------------------------------------
  logic [4*(E+S)-1:0] rho_10, rho_14;

  delay_line #(.WIDTH(4 * (E + S)), .DEPTH(4)) u_delay_rho_10 (
      .clk_i,
      .en_i,
      .data_i({rho_exp_i, rho_sig_i}),
      .data_o(rho_10)
  );

  delay_line #(.WIDTH(4 * (E + S)), .DEPTH(4)) u_delay_rho_14 (
      .clk_i,
      .en_i,
      .data_i(rho_10),
      .data_o(rho_14)
  );

  logic [4*E-1:0] rho_exp_10, rho_exp_14;
  logic [4*S-1:0] rho_sig_10, rho_sig_14;

  assign {rho_exp_10, rho_sig_10} = rho_10;
  assign {rho_exp_14, rho_sig_14} = rho_14;

  // ---- Class bits of the stages -------------------------------------------------------------------------------------------
  logic two_edge_10, cured_10;
  logic [3:0] differ_10;
  logic [1:0] first_13, second_13;
  logic two_corner_14, on_vertex_14, two_edge_14, cured_14, override_14;
  logic [3:0] differ_14;
  logic [1:0] first_14, second_14;
  logic unused_class;

  assign two_edge_10 = class_10_i[10];
  assign cured_10 = class_10_i[8];
  assign differ_10 = class_10_i[7:4];
  assign first_13 = class_13_i[3:2];
  assign second_13 = class_13_i[1:0];
  assign two_corner_14 = class_14_i[12];
  assign on_vertex_14 = class_14_i[11];
  assign two_edge_14 = class_14_i[10];
  assign cured_14 = class_14_i[8];
  assign differ_14 = class_14_i[7:4];
  assign first_14 = class_14_i[3:2];
  assign second_14 = class_14_i[1:0];
  assign override_14 = two_corner_14 || on_vertex_14 || two_edge_14;
  assign unused_class = ^{class_10_i[12:11], class_10_i[9], class_10_i[3:0], class_13_i[12:4], class_14_i[9]};

  // ---- Stages 11 to 13: N_i; stage 11: e_i = d_i d_{i+1} ------------------------------------------------------------------
  logic [4*E-1:0] sum_exp_13;
  logic [4*S-1:0] sum_sig_13;
  logic [4*(E+S)-1:0] e_14;

  for (genvar g = 0; g < 4; g++) begin : gen_sum
    localparam int P = (g + 3) % 4;  // edge i-1
    localparam int Q = (g + 1) % 4;  // vertex and edge i+1

    logic [E-1:0] a_exp, b_exp, c_exp, d_exp;
    logic [S-1:0] a_sig, b_sig, c_sig, d_sig;
    logic ab_neg, cd_neg;
    logic subtract;

    assign subtract = quadrille_pkg::NOTCH_EXACT == 0 && differ_10[g];

    always_comb begin
      a_exp = n_exp_i[P*E+:E];
      a_sig = n_sig_i[P*S+:S];
      b_exp = d_exp_i[g*E+:E];
      b_sig = d_sig_i[g*S+:S];
      ab_neg = 1'b0;
      c_exp = n_exp_i[g*E+:E];
      c_sig = n_sig_i[g*S+:S];
      d_exp = d_exp_i[P*E+:E];
      d_sig = d_sig_i[P*S+:S];
      cd_neg = subtract;
      if (two_edge_10) begin
        a_exp = rho_exp_10[g*E+:E];
        a_sig = rho_sig_10[g*S+:S];
        b_exp = E'($signed(k_exp_10_i[g*PE+:PE]));
        b_sig = k_sig_10_i[g*S+:S];
        ab_neg = k_neg_10_i[g];
        c_exp = rho_exp_10[Q*E+:E];
        c_sig = rho_sig_10[Q*S+:S];
        d_exp = E'($signed(k_exp_10_i[Q*PE+:PE]));
        d_sig = k_sig_10_i[Q*S+:S];
        cd_neg = k_neg_10_i[Q];
      end else if (cured_10 && differ_10[g]) begin
        b_exp = n_exp_i[g*E+:E];
        b_sig = n_sig_i[g*S+:S];
        c_exp = d_exp_i[g*E+:E];
        c_sig = d_sig_i[g*S+:S];
        cd_neg = 1'b0;
      end
    end

    logic ab_neg_11, cd_neg_11;
    logic [E-1:0] ab_exp_11, cd_exp_11;
    logic [2*S-1:0] ab_prod_11, cd_prod_11;
    logic sum_neg_13;
    logic unused;

    fp_raw_product u_ab (
        .clk_i,
        .en_i,
        .neg_i(ab_neg),
        .a_exp_i(a_exp),
        .a_sig_i(a_sig),
        .b_exp_i(b_exp),
        .b_sig_i(b_sig),
        .neg_o(ab_neg_11),
        .exp_o(ab_exp_11),
        .prod_o(ab_prod_11)
    );

    fp_raw_product u_cd (
        .clk_i,
        .en_i,
        .neg_i(cd_neg),
        .a_exp_i(c_exp),
        .a_sig_i(c_sig),
        .b_exp_i(d_exp),
        .b_sig_i(d_sig),
        .neg_o(cd_neg_11),
        .exp_o(cd_exp_11),
        .prod_o(cd_prod_11)
    );

    fp_sum #(.TERMS(2)) u_sum (
        .clk_i,
        .en_i,
        .neg_i({cd_neg_11, ab_neg_11}),
        .exp_i({cd_exp_11, ab_exp_11}),
        .prod_i({cd_prod_11, ab_prod_11}),
        .neg_o(sum_neg_13),
        .exp_o(sum_exp_13[g*E+:E]),
        .sig_o(sum_sig_13[g*S+:S])
    );

    assign unused = sum_neg_13;  // the magnitude is what is wanted

    logic [E-1:0] e_exp_11;
    logic [S-1:0] e_sig_11;

    fp_multiply u_e (
        .clk_i,
        .en_i,
        .a_exp_i(d_exp_i[g*E+:E]),
        .a_sig_i(d_sig_i[g*S+:S]),
        .b_exp_i(d_exp_i[Q*E+:E]),
        .b_sig_i(d_sig_i[Q*S+:S]),
        .exp_o(e_exp_11),
        .sig_o(e_sig_11)
    );

    delay_line #(.WIDTH(E + S), .DEPTH(3)) u_delay_e (
        .clk_i,
        .en_i,
        .data_i({e_exp_11, e_sig_11}),
        .data_o(e_14[g*(E+S)+:E+S])
    );
  end

  // ---- Stage 11: the cure's factors f_a = n13 d20, f_b = n20 d13, f_c = d13 d20 (pair 4 is 20, pair 5 is 13) ---------------
  logic [3*(E+S)-1:0] f_11, f_14;

  fp_multiply u_fa (
      .clk_i,
      .en_i,
      .a_exp_i(n_exp_i[5*E+:E]),
      .a_sig_i(n_sig_i[5*S+:S]),
      .b_exp_i(d_exp_i[4*E+:E]),
      .b_sig_i(d_sig_i[4*S+:S]),
      .exp_o(f_11[S+:E]),
      .sig_o(f_11[0+:S])
  );

  fp_multiply u_fb (
      .clk_i,
      .en_i,
      .a_exp_i(n_exp_i[4*E+:E]),
      .a_sig_i(n_sig_i[4*S+:S]),
      .b_exp_i(d_exp_i[5*E+:E]),
      .b_sig_i(d_sig_i[5*S+:S]),
      .exp_o(f_11[E+S+S+:E]),
      .sig_o(f_11[E+S+:S])
  );

  fp_multiply u_fc (
      .clk_i,
      .en_i,
      .a_exp_i(d_exp_i[5*E+:E]),
      .a_sig_i(d_sig_i[5*S+:S]),
      .b_exp_i(d_exp_i[4*E+:E]),
      .b_sig_i(d_sig_i[4*S+:S]),
      .exp_o(f_11[2*(E+S)+S+:E]),
      .sig_o(f_11[2*(E+S)+:S])
  );

  delay_line #(.WIDTH(3 * (E + S)), .DEPTH(3)) u_delay_f (
      .clk_i,
      .en_i,
      .data_i(f_11),
      .data_o(f_14)
  );

  // ---- Stages 14, 15: N_a + N_b of two edges ------------------------------------------------------------------------------
  logic [E-1:0] na_exp_13, nb_exp_13, both_exp_15;
  logic [S-1:0] na_sig_13, nb_sig_13, both_sig_15;
  logic both_neg_15, unused_neg;

  one_of_four #(.WIDTH(E)) u_na_exp (
      .words_i(sum_exp_13),
      .index_i(first_13),
      .word_o(na_exp_13)
  );
  one_of_four #(.WIDTH(S)) u_na_sig (
      .words_i(sum_sig_13),
      .index_i(first_13),
      .word_o(na_sig_13)
  );
  one_of_four #(.WIDTH(E)) u_nb_exp (
      .words_i(sum_exp_13),
      .index_i(second_13),
      .word_o(nb_exp_13)
  );
  one_of_four #(.WIDTH(S)) u_nb_sig (
      .words_i(sum_sig_13),
      .index_i(second_13),
      .word_o(nb_sig_13)
  );

  fp_sum #(.TERMS(2)) u_both (
      .clk_i,
      .en_i,
      .neg_i(2'b00),
      .exp_i({nb_exp_13, na_exp_13}),
      .prod_i({1'b0, nb_sig_13, (S - 1)'(0), 1'b0, na_sig_13, (S - 1)'(0)}),
      .neg_o(both_neg_15),
      .exp_o(both_exp_15),
      .sig_o(both_sig_15)
  );

  assign unused_neg = both_neg_15;

  logic [4*(E+S)-1:0] sum_14;
  logic [E+S-1:0] na_14, nb_14;
  logic [4*E-1:0] sum_exp_14;
  logic [4*S-1:0] sum_sig_14;

  delay_line #(.WIDTH(4 * (E + S)), .DEPTH(1)) u_delay_sum (
      .clk_i,
      .en_i,
      .data_i({sum_exp_13, sum_sig_13}),
      .data_o(sum_14)
  );

  delay_line #(.WIDTH(2 * (E + S)), .DEPTH(1)) u_delay_two (
      .clk_i,
      .en_i,
      .data_i({na_exp_13, na_sig_13, nb_exp_13, nb_sig_13}),
      .data_o({na_14, nb_14})
  );

  assign {sum_exp_14, sum_sig_14} = sum_14;

  // |k_eff| of the two corners
  logic [PE-1:0] k_exp_first_14, k_exp_second_14;
  logic [S-1:0] k_sig_first_14, k_sig_second_14;
  logic [E+S-1:0] k_first_14, k_second_14;

  one_of_four #(.WIDTH(PE)) u_k_exp_first (
      .words_i(k_exp_14_i),
      .index_i(first_14),
      .word_o(k_exp_first_14)
  );
  one_of_four #(.WIDTH(S)) u_k_sig_first (
      .words_i(k_sig_14_i),
      .index_i(first_14),
      .word_o(k_sig_first_14)
  );
  one_of_four #(.WIDTH(PE)) u_k_exp_second (
      .words_i(k_exp_14_i),
      .index_i(second_14),
      .word_o(k_exp_second_14)
  );
  one_of_four #(.WIDTH(S)) u_k_sig_second (
      .words_i(k_sig_14_i),
      .index_i(second_14),
      .word_o(k_sig_second_14)
  );

  assign k_first_14 = {E'($signed(k_exp_first_14)), k_sig_first_14};
  assign k_second_14 = {E'($signed(k_exp_second_14)), k_sig_second_14};

  // ---- Stage 15: overrides. Stage 16: h_i, g_i. Stage 17: M_i --------------------------------------------------------------
  for (genvar g = 0; g < 4; g++) begin : gen_weight
    localparam int P = (g + 3) % 4;
    localparam int Q = (g + 1) % 4;

    logic is_first, is_second;  // corner g is the first, second singular corner
    logic on_a, on_b;  // corner g is on the first, second of two edges
    logic take_both_15;
    logic [E+S-1:0] num_d, num_q, num_15;
    logic [E+S-1:0] e_15, rho_15, f_15;

    assign is_first = first_14 == 2'(g);
    assign is_second = second_14 == 2'(g);
    assign on_a = first_14 == 2'(g) || first_14 == 2'(P);
    assign on_b = second_14 == 2'(g) || second_14 == 2'(P);

    always_comb begin
      num_d = {sum_exp_14[g*E+:E], sum_sig_14[g*S+:S]};
      if (two_corner_14) num_d = is_first ? k_second_14 : is_second ? k_first_14 : '0;
      else if (on_vertex_14) num_d = is_first ? {E'(0), ONE_SIG} : '0;
      else if (two_edge_14) num_d = on_a ? nb_14 : on_b ? na_14 : '0;
    end

    always_ff @(posedge clk_i) begin
      if (en_i) begin
        num_q <= num_d;
        take_both_15 <= two_edge_14 && on_a && on_b;
        e_15 <= override_14 ? {E'(0), ONE_SIG} : e_14[Q*(E+S)+:E+S];
        rho_15 <= (two_corner_14 || on_vertex_14) ? {E'(0), ONE_SIG} : {rho_exp_14[g*E+:E], rho_sig_14[g*S+:S]};
        f_15 <= !cured_14 ? {E'(0), ONE_SIG} : !differ_14[g] ? f_14[2*(E+S)+:E+S] : f_14[(g%2)*(E+S)+:E+S];
      end
    end

    assign num_15 = take_both_15 ? {both_exp_15, both_sig_15} : num_q;

    logic [E-1:0] h_exp_16, g_exp_16;
    logic [S-1:0] h_sig_16, g_sig_16;

    fp_multiply u_h (
        .clk_i,
        .en_i,
        .a_exp_i(num_15[S+:E]),
        .a_sig_i(num_15[0+:S]),
        .b_exp_i(e_15[S+:E]),
        .b_sig_i(e_15[0+:S]),
        .exp_o(h_exp_16),
        .sig_o(h_sig_16)
    );

    fp_multiply u_g (
        .clk_i,
        .en_i,
        .a_exp_i(rho_15[S+:E]),
        .a_sig_i(rho_15[0+:S]),
        .b_exp_i(f_15[S+:E]),
        .b_sig_i(f_15[0+:S]),
        .exp_o(g_exp_16),
        .sig_o(g_sig_16)
    );

    fp_multiply u_m (
        .clk_i,
        .en_i,
        .a_exp_i(h_exp_16),
        .a_sig_i(h_sig_16),
        .b_exp_i(g_exp_16),
        .b_sig_i(g_sig_16),
        .exp_o(m_exp_o[g*E+:E]),
        .sig_o(m_sig_o[g*S+:S])
    );
  end
endmodule
