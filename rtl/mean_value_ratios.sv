// t_i = n_i / d_i of the six vertex pairs (edges 01 12 23 30, diagonals 20 13) without a division. Stages 7 to 10.
//
// s = |A| rho rho', c = |D| rho rho'. D < 0: n = 1 + c, d = s. D >= 0: n = s, d = 1 + c. Magnitudes only: t's sign is A's.
// A and D enter from stage 3, rho from stage 6; both leave at stage 10. One pixel per enabled clock.
module mean_value_ratios #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int E = quadrille_pkg::EXP_BITS
) (
    input logic clk_i,
    input logic en_i,
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
  for (genvar g = 0; g < 6; g++) begin : gen_pair
    localparam int I = 32'(quadrille_pkg::pair_first(4'(g)));
    localparam int J = 32'(quadrille_pkg::pair_second(4'(g)));

    // Stages 4 to 7: A and D wait for rho and rho rho'.
    logic [E-1:0] a_exp_7, d_exp_7;
    logic [S-1:0] a_sig_7, d_sig_7;
    logic d_neg_7, d_neg_9;

    delay_line #(.WIDTH(E + S), .DEPTH(4)) u_delay_a (
        .clk_i,
        .en_i,
        .data_i({a_exp_i[g*E+:E], a_sig_i[g*S+:S]}),
        .data_o({a_exp_7, a_sig_7})
    );

    delay_line #(.WIDTH(1 + E + S), .DEPTH(4)) u_delay_d (
        .clk_i,
        .en_i,
        .data_i({d_neg_i[g], d_exp_i[g*E+:E], d_sig_i[g*S+:S]}),
        .data_o({d_neg_7, d_exp_7, d_sig_7})
    );

    delay_line #(.WIDTH(1), .DEPTH(2)) u_delay_neg (
        .clk_i,
        .en_i,
        .data_i(d_neg_7),
        .data_o(d_neg_9)
    );

    // Stage 7: rho rho'.
    logic [E-1:0] rr_exp_7;
    logic [S-1:0] rr_sig_7;

    fp_multiply u_rr (
        .clk_i,
        .en_i,
        .a_exp_i(rho_exp_i[I*E+:E]),
        .a_sig_i(rho_sig_i[I*S+:S]),
        .b_exp_i(rho_exp_i[J*E+:E]),
        .b_sig_i(rho_sig_i[J*S+:S]),
        .exp_o(rr_exp_7),
        .sig_o(rr_sig_7)
    );

    // Stage 8: v = |A| rho rho' and the raw product |D| rho rho'.
    logic [E-1:0] v_exp_8, v_exp_9, c_exp_8;
    logic [S-1:0] v_sig_8, v_sig_9;
    logic [2*S-1:0] c_prod_8;
    logic c_neg_8;

    fp_multiply u_v (
        .clk_i,
        .en_i,
        .a_exp_i(a_exp_7),
        .a_sig_i(a_sig_7),
        .b_exp_i(rr_exp_7),
        .b_sig_i(rr_sig_7),
        .exp_o(v_exp_8),
        .sig_o(v_sig_8)
    );

    fp_raw_product u_c (
        .clk_i,
        .en_i,
        .neg_i(1'b0),
        .a_exp_i(d_exp_7),
        .a_sig_i(d_sig_7),
        .b_exp_i(rr_exp_7),
        .b_sig_i(rr_sig_7),
        .neg_o(c_neg_8),
        .exp_o(c_exp_8),
        .prod_o(c_prod_8)
    );

    delay_line #(.WIDTH(E + S), .DEPTH(1)) u_delay_v (
        .clk_i,
        .en_i,
        .data_i({v_exp_8, v_sig_8}),
        .data_o({v_exp_9, v_sig_9})
    );

    // Stages 9, 10: u = 1 + |c|; v goes beside it. The sign of D says which is which.
    logic [E-1:0] u_exp_10, v_exp_10;
    logic [S-1:0] u_sig_10, v_sig_10;
    logic swap_10;

    one_plus u_u (
        .clk_i,
        .en_i,
        .exp_i(c_exp_8),
        .prod_i(c_prod_8),
        .exp_o(u_exp_10),
        .sig_o(u_sig_10)
    );

    always_ff @(posedge clk_i) begin
      if (en_i) begin
        v_exp_10 <= v_exp_9;
        v_sig_10 <= v_sig_9;
        swap_10 <= d_neg_9;
      end
    end

    assign n_exp_o[g*E+:E] = swap_10 ? u_exp_10 : v_exp_10;
    assign n_sig_o[g*S+:S] = swap_10 ? u_sig_10 : v_sig_10;
    assign d_exp_o[g*E+:E] = swap_10 ? v_exp_10 : u_exp_10;
    assign d_sig_o[g*S+:S] = swap_10 ? v_sig_10 : u_sig_10;

    logic unused;
    assign unused = c_neg_8;  // |c|
  end
endmodule
