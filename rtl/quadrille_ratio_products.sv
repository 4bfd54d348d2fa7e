// SPDX-License-Identifier: Apache-2.0
// The products that the three ratios sqrt(q_far / q_near) are made of: z = u_near u_far and w = v_far u_near of each,
// and which of the pair's u and v goes by itself (own; root_ratio). On two edges four of the six multipliers form the
// products of the denominators N instead (denominator_operands). Latency 1 + PRODUCT_STAGES: operands, products; one
// pixel per clock.
//
// Ratios 0, 1, 2: pairs 23 / 01, 12 / 30, 13 / 20. The terms of q = r r' +- D cancel where D < 0 on an edge, where D >=
// 0 on a diagonal. Products 0 to 2 are z, 3 to 5 w; the terms of N are 0 to 3, their ranks come one clock before them.
// Numbers are {exp, sig}.
module quadrille_ratio_products #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS, E = quadrille_pkg::EXP_BITS, TERM = quadrille_pkg::TERM_BITS,
    localparam int RANK = quadrille_pkg::RANK_BITS, F = E + S
) (
    input logic clk_i,
    input logic [6*E-1:0] u_exp_i,
    input logic [6*S-1:0] u_sig_i,
    input logic [6*E-1:0] v_exp_i,
    input logic [6*S-1:0] v_sig_i,
    input logic [5:0] d_neg_i,
    // Of two edges
    input logic two_edge_i,
    input logic [4*F-1:0] edge_root_i, edge_k_i,
    input logic [3:0] edge_neg_i,
    // Of the ratios
    output logic [2:0] near_cancels_o, far_cancels_o,
    output logic [3*F-1:0] own_o,
    output logic [6*F-1:0] product_o,
    // Of the denominators
    output logic [4*RANK-1:0] rank_o,
    output logic [3:0] neg_o,
    output logic [4*TERM-1:0] term_o
);
  // ---- Operands -----------------------------------------------------------------------------------------------------
  logic [6*F-1:0] operand_a_q, operand_b_q;  // z0, z1, z2, w0, w1, w2
  logic [3*F-1:0] own_q;
  logic [2:0] near_cancels_q, far_cancels_q;
  logic [3:0] neg_q;

  always_ff @(posedge clk_i) neg_q <= edge_neg_i;

  for (genvar g = 0; g < 3; g++) begin : gen_operand
    localparam int NEAR = (g == 0) ? 0 : g + 2;  // 01, 30, 20
    localparam int FAR = (g == 0) ? 2 : (g == 1) ? 1 : 5;  // 23, 12, 13
    logic near_cancels, far_cancels;
    logic [F-1:0] u_near, u_far, v_near, v_far;
    assign near_cancels = d_neg_i[NEAR] == (g < 2);
    assign far_cancels = d_neg_i[FAR] == (g < 2);
    assign u_near = {u_exp_i[NEAR*E+:E], u_sig_i[NEAR*S+:S]};
    assign u_far = {u_exp_i[FAR*E+:E], u_sig_i[FAR*S+:S]};
    assign v_near = {v_exp_i[NEAR*E+:E], v_sig_i[NEAR*S+:S]};
    assign v_far = {v_exp_i[FAR*E+:E], v_sig_i[FAR*S+:S]};

    always_ff @(posedge clk_i) begin
      operand_a_q[g*F+:F] <= two_edge_i ? edge_root_i[g*F+:F] : u_near;
      operand_b_q[g*F+:F] <= two_edge_i ? edge_k_i[g*F+:F] : u_far;
      own_q[g*F+:F] <= near_cancels ? v_near : far_cancels ? v_far : u_far;
      near_cancels_q[g] <= near_cancels;
      far_cancels_q[g] <= far_cancels;
    end

    if (g == 0) begin : gen_shared
      always_ff @(posedge clk_i) begin
        operand_a_q[3*F+:F] <= two_edge_i ? edge_root_i[3*F+:F] : v_far;
        operand_b_q[3*F+:F] <= two_edge_i ? edge_k_i[3*F+:F] : u_near;
      end
    end else begin : gen_own
      always_ff @(posedge clk_i) begin
        operand_a_q[(3+g)*F+:F] <= v_far;
        operand_b_q[(3+g)*F+:F] <= u_near;
      end
    end
  end

  // ---- Products ----------------------------------------------------------------------------------------------------
  for (genvar g = 0; g < 4; g++) begin : gen_shared_product
    quadrille_fp_product u_product (
        .clk_i, .a_exp_i(operand_a_q[g*F+S+:E]), .a_sig_i(operand_a_q[g*F+:S]), .b_exp_i(operand_b_q[g*F+S+:E]),
        .b_sig_i(operand_b_q[g*F+:S]), .exp_o(product_o[g*F+S+:E]), .sig_o(product_o[g*F+:S]),
        .rank_o(rank_o[g*RANK+:RANK]), .term_o(term_o[g*TERM+:TERM])
    );
  end

  for (genvar g = 4; g < 6; g++) begin : gen_product
    quadrille_fp_multiply u_product (
        .clk_i, .a_exp_i(operand_a_q[g*F+S+:E]), .a_sig_i(operand_a_q[g*F+:S]), .b_exp_i(operand_b_q[g*F+S+:E]),
        .b_sig_i(operand_b_q[g*F+:S]), .exp_o(product_o[g*F+S+:E]), .sig_o(product_o[g*F+:S])
    );
  end

  quadrille_delay_line #(.WIDTH(3 * F + 10), .DEPTH(quadrille_pkg::PRODUCT_STAGES)) u_delay (
      .clk_i, .data_i({own_q, near_cancels_q, far_cancels_q, neg_q}),
      .data_o({own_o, near_cancels_o, far_cancels_o, neg_o})
  );
endmodule
