// t_i = n_i / d_i of the six vertex pairs (edges 01 12 23 30, diagonals 20 13) without a division.
//
// s = |A| rho rho', c = |D| rho rho'. D < 0: n = 1 + c, d = s. D >= 0: n = s, d = 1 + c. Magnitudes only: t's sign is A's.
// A and D enter at NORM_STAGE, rho at RHO_STAGE; n and d leave at RATIO_STAGE (quadrille_pkg). One pixel per clock.
module mean_value_ratios #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int E = quadrille_pkg::EXP_BITS
) (
    input logic clk_i,
    input logic [6*E-1:0] a_exp_i,
    input logic [6*S-1:0] a_sig_i,
    input logic [5:0] d_neg_i,
    input logic [6*E-1:0] d_exp_i,
    input logic [6*S-1:0] d_sig_i,
    input logic [4*E-1:0] rho_exp_i,
    input logic [4*S-1:0] rho_sig_i,
    output logic [6*E-1:0] n_exp_o,
    output logic [6*S-1:0] n_sig_o,
    output logic [6*E-1:0] d_exp_o,
    output logic [6*S-1:0] d_sig_o
);
  localparam int WAIT = quadrille_pkg::RSQRT_STAGES + quadrille_pkg::PRODUCT_STAGES;  // of A and D for rho rho'

  for (genvar g = 0; g < 6; g++) begin : gen_pair
    localparam int I = {30'd0, quadrille_pkg::pair_first(4'(g))};
    localparam int J = {30'd0, quadrille_pkg::pair_second(4'(g))};

    // A and D wait for rho and rho rho'.
    logic [E-1:0] a_exp, d_exp;
    logic [S-1:0] a_sig, d_sig;
    logic d_neg, swap;

    delay_line #(.WIDTH(E + S), .DEPTH(WAIT)) u_delay_a (
        .clk_i,
        .data_i({a_exp_i[g*E+:E], a_sig_i[g*S+:S]}),
        .data_o({a_exp, a_sig})
    );

    delay_line #(.WIDTH(1 + E + S), .DEPTH(WAIT)) u_delay_d (
        .clk_i,
        .data_i({d_neg_i[g], d_exp_i[g*E+:E], d_sig_i[g*S+:S]}),
        .data_o({d_neg, d_exp, d_sig})
    );

    delay_line #(.WIDTH(1), .DEPTH(quadrille_pkg::PRODUCT_STAGES + quadrille_pkg::ONE_PLUS_STAGES)) u_delay_neg (
        .clk_i,
        .data_i(d_neg),
        .data_o(swap)
    );

    // rho rho'.
    logic [E-1:0] rr_exp;
    logic [S-1:0] rr_sig;

    fp_multiply u_rr (
        .clk_i,
        .a_exp_i(rho_exp_i[I*E+:E]),
        .a_sig_i(rho_sig_i[I*S+:S]),
        .b_exp_i(rho_exp_i[J*E+:E]),
        .b_sig_i(rho_sig_i[J*S+:S]),
        .exp_o(rr_exp),
        .sig_o(rr_sig)
    );

    // v = |A| rho rho' and the raw product |D| rho rho'.
    logic [E-1:0] v_exp, c_exp;
    logic [S-1:0] v_sig;
    logic [2*S-1:0] c_prod;
    logic c_neg;

    fp_multiply u_v (
        .clk_i,
        .a_exp_i(a_exp),
        .a_sig_i(a_sig),
        .b_exp_i(rr_exp),
        .b_sig_i(rr_sig),
        .exp_o(v_exp),
        .sig_o(v_sig)
    );

    fp_raw_product u_c (
        .clk_i,
        .neg_i(1'b0),
        .a_exp_i(d_exp),
        .a_sig_i(d_sig),
        .b_exp_i(rr_exp),
        .b_sig_i(rr_sig),
        .neg_o(c_neg),
        .exp_o(c_exp),
        .prod_o(c_prod)
    );

    // u = 1 + |c|; v waits for it. The sign of D says which is which.
    logic [E-1:0] u_exp, late_v_exp;
    logic [S-1:0] u_sig, late_v_sig;

    one_plus u_u (
        .clk_i,
        .exp_i(c_exp),
        .prod_i(c_prod),
        .exp_o(u_exp),
        .sig_o(u_sig)
    );

    delay_line #(.WIDTH(E + S), .DEPTH(quadrille_pkg::ONE_PLUS_STAGES)) u_delay_v (
        .clk_i,
        .data_i({v_exp, v_sig}),
        .data_o({late_v_exp, late_v_sig})
    );

    always_ff @(posedge clk_i) begin
      n_exp_o[g*E+:E] <= swap ? u_exp : late_v_exp;
      n_sig_o[g*S+:S] <= swap ? u_sig : late_v_sig;
      d_exp_o[g*E+:E] <= swap ? late_v_exp : u_exp;
      d_sig_o[g*S+:S] <= swap ? late_v_sig : u_sig;
    end

    logic unused;
    assign unused = c_neg;  // |c|
  end
endmodule
