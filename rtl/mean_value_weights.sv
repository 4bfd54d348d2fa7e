// Mean value weights M_i, up to a common factor, from t_i = n_i / d_i and rho_i. One pixel per clock.
//
//     M_i = N_i e'_i  *  rho'_i f'_i      N_i = n_{i-1} d_i + n_i d_{i-1}, e'_i = d_{i+1} d_{i+2}, f'_i = 1
//
// Cured notch (two neighbouring t of opposite sign): N_i = n n' + d d' there, times the half-angle tangent's numerator in f'.
// Singular pixels replace N, e', rho' at OVERRIDE_STAGE; two_edge uses the N adders for its edges' denominators rho k + rho' k'.
// Weights are magnitudes (they have one sign). class_i is singular_class's word; k_* are k_eff. Inputs enter at RHO_STAGE (rho),
// RATIO_STAGE, and one register before OVERRIDE_STAGE (override_*); M leaves at WEIGHT_STAGE (quadrille_pkg).
module mean_value_weights #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int E = quadrille_pkg::EXP_BITS,
    localparam int PE = quadrille_pkg::PORT_EXP_BITS
) (
    input logic clk_i,
    // at RHO_STAGE
    input logic [4*E-1:0] rho_exp_i,
    input logic [4*S-1:0] rho_sig_i,
    // at RATIO_STAGE
    input logic [6*E-1:0] n_exp_i,
    input logic [6*S-1:0] n_sig_i,
    input logic [6*E-1:0] d_exp_i,
    input logic [6*S-1:0] d_sig_i,
    input logic [12:0] class_i,
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
  localparam logic [S-1:0] ONE_SIG = {1'b1, (S - 1)'(0)};

  // ---- What waits: rho for the products and the overrides, the class for the overrides --------------------------------------
  localparam int TO_RATIO = quadrille_pkg::RATIO_STAGE - quadrille_pkg::RHO_STAGE;
  localparam int TO_N = quadrille_pkg::N_STAGE - quadrille_pkg::RATIO_STAGE;
  localparam int TO_OVERRIDE = quadrille_pkg::OVERRIDE_STAGE - 1 - quadrille_pkg::RATIO_STAGE;  // where overrides are chosen
  logic [4*E-1:0] rho_exp, late_rho_exp;
  logic [4*S-1:0] rho_sig, late_rho_sig;
  logic [12:0] n_class, late_class;

  delay_line #(.WIDTH(4 * (E + S)), .DEPTH(TO_RATIO)) u_delay_rho (
      .clk_i,
      .data_i({rho_exp_i, rho_sig_i}),
      .data_o({rho_exp, rho_sig})
  );

  delay_line #(.WIDTH(4 * (E + S)), .DEPTH(TO_OVERRIDE)) u_delay_late_rho (
      .clk_i,
      .data_i({rho_exp, rho_sig}),
      .data_o({late_rho_exp, late_rho_sig})
  );

  delay_line #(.WIDTH(13), .DEPTH(TO_N)) u_delay_class (
      .clk_i,
      .data_i(class_i),
      .data_o(n_class)
  );

  delay_line #(.WIDTH(13), .DEPTH(TO_OVERRIDE - TO_N)) u_delay_late_class (
      .clk_i,
      .data_i(n_class),
      .data_o(late_class)
  );

  // ---- Class bits ---------------------------------------------------------------------------------------------------------
  logic two_edge, cured;  // with n and d
  logic [3:0] differ;
  logic late_two_corner, late_on_vertex, late_two_edge, late_cured, late_override;  // with N and what waits
  logic [3:0] late_differ;
  logic [1:0] late_first, late_second;
  logic unused_class;

  assign two_edge = class_i[10];
  assign cured = class_i[8];
  assign differ = class_i[7:4];
  assign late_two_corner = late_class[12];
  assign late_on_vertex = late_class[11];
  assign late_two_edge = late_class[10];
  assign late_cured = late_class[8];
  assign late_differ = late_class[7:4];
  assign late_first = late_class[3:2];
  assign late_second = late_class[1:0];
  assign late_override = late_two_corner || late_on_vertex || late_two_edge;
  assign unused_class = late_class[9];

  // ---- N_i and e_i = d_i d_{i+1} ------------------------------------------------------------------------------------------
  logic [4*E-1:0] n_sum_exp;
  logic [4*S-1:0] n_sum_sig;
  logic [4*(E+S)-1:0] late_e;

  for (genvar g = 0; g < 4; g++) begin : gen_sum
    localparam int P = (g + 3) % 4;  // edge i-1
    localparam int Q = (g + 1) % 4;  // vertex and edge i+1

    logic [E-1:0] a_exp, b_exp, c_exp, d_exp;
    logic [S-1:0] a_sig, b_sig, c_sig, d_sig;
    logic ab_neg, cd_neg;
    logic subtract;

    assign subtract = quadrille_pkg::NOTCH_EXACT == 0 && differ[g];

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
      if (two_edge) begin
        a_exp = rho_exp[g*E+:E];
        a_sig = rho_sig[g*S+:S];
        b_exp = E'($signed(k_exp_i[g*PE+:PE]));
        b_sig = k_sig_i[g*S+:S];
        ab_neg = k_neg_i[g];
        c_exp = rho_exp[Q*E+:E];
        c_sig = rho_sig[Q*S+:S];
        d_exp = E'($signed(k_exp_i[Q*PE+:PE]));
        d_sig = k_sig_i[Q*S+:S];
        cd_neg = k_neg_i[Q];
      end else if (cured && differ[g]) begin
        b_exp = n_exp_i[g*E+:E];
        b_sig = n_sig_i[g*S+:S];
        c_exp = d_exp_i[g*E+:E];
        c_sig = d_sig_i[g*S+:S];
        cd_neg = 1'b0;
      end
    end

    // The factors get a register of their own before the multipliers.
    logic ab_neg_q, cd_neg_q;
    logic [E-1:0] a_exp_q, b_exp_q, c_exp_q, d_exp_q;
    logic [S-1:0] a_sig_q, b_sig_q, c_sig_q, d_sig_q;

    always_ff @(posedge clk_i) begin
      {ab_neg_q, a_exp_q, a_sig_q, b_exp_q, b_sig_q} <= {ab_neg, a_exp, a_sig, b_exp, b_sig};
      {cd_neg_q, c_exp_q, c_sig_q, d_exp_q, d_sig_q} <= {cd_neg, c_exp, c_sig, d_exp, d_sig};
    end

    logic [RANK-1:0] ab_rank, cd_rank;
    logic ab_term_neg, cd_term_neg;
    logic [TERM-1:0] ab_term, cd_term;
    logic n_sum_neg;
    logic unused;

    fp_term u_ab (
        .clk_i,
        .neg_i(ab_neg_q),
        .a_exp_i(a_exp_q),
        .a_sig_i(a_sig_q),
        .b_exp_i(b_exp_q),
        .b_sig_i(b_sig_q),
        .rank_o(ab_rank),
        .neg_o(ab_term_neg),
        .term_o(ab_term)
    );

    fp_term u_cd (
        .clk_i,
        .neg_i(cd_neg_q),
        .a_exp_i(c_exp_q),
        .a_sig_i(c_sig_q),
        .b_exp_i(d_exp_q),
        .b_sig_i(d_sig_q),
        .rank_o(cd_rank),
        .neg_o(cd_term_neg),
        .term_o(cd_term)
    );

    fp_sum #(.TERMS(2)) u_sum (
        .clk_i,
        .rank_i({cd_rank, ab_rank}),
        .neg_i({cd_term_neg, ab_term_neg}),
        .term_i({cd_term, ab_term}),
        .neg_o(n_sum_neg),
        .exp_o(n_sum_exp[g*E+:E]),
        .sig_o(n_sum_sig[g*S+:S])
    );

    assign unused = n_sum_neg;  // the magnitude is what is wanted

    logic [E-1:0] e_exp;
    logic [S-1:0] e_sig;

    fp_multiply u_e (
        .clk_i,
        .a_exp_i(d_exp_i[g*E+:E]),
        .a_sig_i(d_sig_i[g*S+:S]),
        .b_exp_i(d_exp_i[Q*E+:E]),
        .b_sig_i(d_sig_i[Q*S+:S]),
        .exp_o(e_exp),
        .sig_o(e_sig)
    );

    delay_line #(.WIDTH(E + S), .DEPTH(TO_OVERRIDE - quadrille_pkg::PRODUCT_STAGES)) u_delay_e (
        .clk_i,
        .data_i({e_exp, e_sig}),
        .data_o(late_e[g*(E+S)+:E+S])
    );
  end

  // ---- The cure's factors f_a = n13 d20, f_b = n20 d13, f_c = d13 d20 (pair 4 is 20, pair 5 is 13) -------------------------
  logic [3*(E+S)-1:0] f, late_f;

  fp_multiply u_fa (
      .clk_i,
      .a_exp_i(n_exp_i[5*E+:E]),
      .a_sig_i(n_sig_i[5*S+:S]),
      .b_exp_i(d_exp_i[4*E+:E]),
      .b_sig_i(d_sig_i[4*S+:S]),
      .exp_o(f[S+:E]),
      .sig_o(f[0+:S])
  );

  fp_multiply u_fb (
      .clk_i,
      .a_exp_i(n_exp_i[4*E+:E]),
      .a_sig_i(n_sig_i[4*S+:S]),
      .b_exp_i(d_exp_i[5*E+:E]),
      .b_sig_i(d_sig_i[5*S+:S]),
      .exp_o(f[E+S+S+:E]),
      .sig_o(f[E+S+:S])
  );

  fp_multiply u_fc (
      .clk_i,
      .a_exp_i(d_exp_i[5*E+:E]),
      .a_sig_i(d_sig_i[5*S+:S]),
      .b_exp_i(d_exp_i[4*E+:E]),
      .b_sig_i(d_sig_i[4*S+:S]),
      .exp_o(f[2*(E+S)+S+:E]),
      .sig_o(f[2*(E+S)+:S])
  );

  delay_line #(.WIDTH(3 * (E + S)), .DEPTH(TO_OVERRIDE - quadrille_pkg::PRODUCT_STAGES)) u_delay_f (
      .clk_i,
      .data_i(f),
      .data_o(late_f)
  );

  // ---- N_a + N_b of two edges ---------------------------------------------------------------------------------------------
  logic [E-1:0] na_exp, nb_exp, both_exp;
  logic [S-1:0] na_sig, nb_sig, both_sig;

  one_of_four #(.WIDTH(E)) u_na_exp (
      .words_i(n_sum_exp),
      .index_i(n_class[3:2]),
      .word_o(na_exp)
  );
  one_of_four #(.WIDTH(S)) u_na_sig (
      .words_i(n_sum_sig),
      .index_i(n_class[3:2]),
      .word_o(na_sig)
  );
  one_of_four #(.WIDTH(E)) u_nb_exp (
      .words_i(n_sum_exp),
      .index_i(n_class[1:0]),
      .word_o(nb_exp)
  );
  one_of_four #(.WIDTH(S)) u_nb_sig (
      .words_i(n_sum_sig),
      .index_i(n_class[1:0]),
      .word_o(nb_sig)
  );

  // Lone numbers are terms with the fraction bits of a product by 1.
  fp_add u_both (
      .clk_i,
      .a_rank_i(quadrille_pkg::exponent_rank(na_exp, na_sig[S-1])),
      .a_term_i(TERM'(na_sig) << (TERM - S - 1)),
      .b_rank_i(quadrille_pkg::exponent_rank(nb_exp, nb_sig[S-1])),
      .b_term_i(TERM'(nb_sig) << (TERM - S - 1)),
      .exp_o(both_exp),
      .sig_o(both_sig)
  );

  logic [4*(E+S)-1:0] late_n;
  logic [E+S-1:0] late_na, late_nb;
  logic [4*E-1:0] late_n_exp;
  logic [4*S-1:0] late_n_sig;

  delay_line #(.WIDTH(4 * (E + S)), .DEPTH(TO_OVERRIDE - TO_N)) u_delay_n (
      .clk_i,
      .data_i({n_sum_exp, n_sum_sig}),
      .data_o(late_n)
  );

  delay_line #(.WIDTH(2 * (E + S)), .DEPTH(TO_OVERRIDE - TO_N)) u_delay_two (
      .clk_i,
      .data_i({na_exp, na_sig, nb_exp, nb_sig}),
      .data_o({late_na, late_nb})
  );

  assign {late_n_exp, late_n_sig} = late_n;

  // |k_eff| of the two corners
  logic [PE-1:0] first_k_exp, second_k_exp;
  logic [S-1:0] first_k_sig, second_k_sig;
  logic [E+S-1:0] first_k, second_k;

  one_of_four #(.WIDTH(PE)) u_k_exp_first (
      .words_i(override_k_exp_i),
      .index_i(late_first),
      .word_o(first_k_exp)
  );
  one_of_four #(.WIDTH(S)) u_k_sig_first (
      .words_i(override_k_sig_i),
      .index_i(late_first),
      .word_o(first_k_sig)
  );
  one_of_four #(.WIDTH(PE)) u_k_exp_second (
      .words_i(override_k_exp_i),
      .index_i(late_second),
      .word_o(second_k_exp)
  );
  one_of_four #(.WIDTH(S)) u_k_sig_second (
      .words_i(override_k_sig_i),
      .index_i(late_second),
      .word_o(second_k_sig)
  );

  assign first_k = {E'($signed(first_k_exp)), first_k_sig};
  assign second_k = {E'($signed(second_k_exp)), second_k_sig};

  // ---- Overrides, then h_i and g_i, then M_i -------------------------------------------------------------------------------
  for (genvar g = 0; g < 4; g++) begin : gen_weight
    localparam int P = (g + 3) % 4;
    localparam int Q = (g + 1) % 4;

    logic is_first, is_second;  // corner g is the first, second singular corner
    logic on_a, on_b;  // corner g is on the first, second of two edges
    logic [E+S-1:0] num_d, num_q;
    logic [E+S-1:0] e_q, rho_q, f_q;

    assign is_first = late_first == 2'(g);
    assign is_second = late_second == 2'(g);
    assign on_a = late_first == 2'(g) || late_first == 2'(P);
    assign on_b = late_second == 2'(g) || late_second == 2'(P);

    always_comb begin
      num_d = {late_n_exp[g*E+:E], late_n_sig[g*S+:S]};
      if (late_two_corner) num_d = is_first ? second_k : is_second ? first_k : '0;
      else if (late_on_vertex) num_d = is_first ? {E'(0), ONE_SIG} : '0;
      else if (late_two_edge && on_a && on_b) num_d = {both_exp, both_sig};
      else if (late_two_edge) num_d = on_a ? late_nb : on_b ? late_na : '0;
    end

    always_ff @(posedge clk_i) begin
      num_q <= num_d;
      e_q <= late_override ? {E'(0), ONE_SIG} : late_e[Q*(E+S)+:E+S];
      rho_q <= (late_two_corner || late_on_vertex) ? {E'(0), ONE_SIG} : {late_rho_exp[g*E+:E], late_rho_sig[g*S+:S]};
      f_q <= !late_cured ? {E'(0), ONE_SIG} : !late_differ[g] ? late_f[2*(E+S)+:E+S] : late_f[(g%2)*(E+S)+:E+S];
    end

    logic [E-1:0] h_exp, g_exp;
    logic [S-1:0] h_sig, g_sig;

    fp_multiply u_h (
        .clk_i,
        .a_exp_i(num_q[S+:E]),
        .a_sig_i(num_q[0+:S]),
        .b_exp_i(e_q[S+:E]),
        .b_sig_i(e_q[0+:S]),
        .exp_o(h_exp),
        .sig_o(h_sig)
    );

    fp_multiply u_g (
        .clk_i,
        .a_exp_i(rho_q[S+:E]),
        .a_sig_i(rho_q[0+:S]),
        .b_exp_i(f_q[S+:E]),
        .b_sig_i(f_q[0+:S]),
        .exp_o(g_exp),
        .sig_o(g_sig)
    );

    fp_multiply u_m (
        .clk_i,
        .a_exp_i(h_exp),
        .a_sig_i(h_sig),
        .b_exp_i(g_exp),
        .b_sig_i(g_sig),
        .exp_o(m_exp_o[g*E+:E]),
        .sig_o(m_sig_o[g*S+:S])
    );
  end
endmodule
