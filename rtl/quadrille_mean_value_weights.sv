// SPDX-License-Identifier: Apache-2.0
// Mean value weights M_i, up to a common factor, from u = r r' + |D| and v = |A| of the six vertex pairs. One pixel per
// clock.
//
//     M_0 : M_1 : M_2 : M_3 = abc : a : c : b      a^2 = q_23 / q_01, b^2 = q_12 / q_30, c^2 = q_13 / q_20 (root_ratio)
//
// with a, b, c as fractions, so that a weight is a product of three numbers: no sum of weights' terms, and nothing
// cancels. Singular pixels take the same way with other factors. Weights are magnitudes (they have one sign).
//
//     RATIO_STAGE  ratio_products (denominator_operands)  root_ratio      OVERRIDE_STAGE                  WEIGHT_STAGE
//                                                         fp_sum: N       weight_factors      factor_products
//
// A plane_quad's weights are areas instead: of the triangle 012 or, behind the diagonal, 023, the one opposite each
// corner, |A| as it comes. They take the place of r on its way to weight_factors; singular pixels are as ever.
//
// class_i is singular_class's word; k_* are k_eff. Inputs enter at ROOT_STAGE (root), RATIO_STAGE, and one register
// before OVERRIDE_STAGE (override_*); M leaves at WEIGHT_STAGE (quadrille_pkg).
module quadrille_mean_value_weights #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS, E = quadrille_pkg::EXP_BITS, PE = quadrille_pkg::PORT_EXP_BITS,
    localparam int CLASS = quadrille_pkg::CLASS_BITS
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
    input logic [CLASS-1:0] class_i,
    input logic plane_i,  // the quad's: weights are areas
    input logic behind_diagonal_i,
    input logic [3:0] k_neg_i,
    input logic [4*PE-1:0] k_exp_i,
    input logic [4*S-1:0] k_sig_i,
    // at OVERRIDE_STAGE - 1
    input logic [4*PE-1:0] override_k_exp_i,
    input logic [4*S-1:0] override_k_sig_i,
    // for performance_counters, else 0; at RATIO_STAGE: the weights are areas, which are not multiplied
    output logic count_area_o,
    // at WEIGHT_STAGE
    output logic [4*E-1:0] m_exp_o,
    output logic [4*S-1:0] m_sig_o
);
  localparam int TERM = quadrille_pkg::TERM_BITS;
  localparam int RANK = quadrille_pkg::RANK_BITS;
  localparam int F = E + S;  // a number: {exp, sig}

  // ---- What waits: r for the denominators and the factors, the class for the factors and their products ------------
  localparam int TO_RATIO = quadrille_pkg::RATIO_STAGE - quadrille_pkg::ROOT_STAGE;
  localparam int TO_N = quadrille_pkg::N_STAGE - quadrille_pkg::RATIO_STAGE;  // where factors are chosen
  logic [4*F-1:0] root, late_root;
  logic [CLASS-1:0] late_class, product_class;

  for (genvar g = 0; g < 4; g++) begin : gen_root
    quadrille_delay_line #(.WIDTH(F), .DEPTH(TO_RATIO)) u_delay_root (
        .clk_i, .data_i({root_exp_i[g*E+:E], root_sig_i[g*S+:S]}), .data_o(root[g*F+:F])
    );
  end

  logic area;  // the weights are areas
  logic late_area, factor_area;
  logic [4*F-1:0] root_or_area;
  logic [6*E-1:0] product_v_exp;  // v where it is multiplied
  logic [6*S-1:0] product_v_sig;

  if (quadrille_pkg::PLANE_QUADS != 0) begin : gen_plane
    logic [5*F-1:0] v;  // of the edges and E20

    for (genvar g = 0; g < 5; g++) begin : gen_v
      assign v[g*F+:F] = {v_exp_i[g*E+:E], v_sig_i[g*S+:S]};
    end

    assign area = plane_i && !(class_i[quadrille_pkg::CLASS_TWO_CORNER] || class_i[quadrille_pkg::CLASS_ON_VERTEX] ||
        class_i[quadrille_pkg::CLASS_TWO_EDGE]);
    assign root_or_area[0+:F] = !area ? root[0+:F] : behind_diagonal_i ? v[2*F+:F] : v[F+:F];
    assign root_or_area[F+:F] = !area ? root[F+:F] : behind_diagonal_i ? '0 : v[4*F+:F];
    assign root_or_area[2*F+:F] = !area ? root[2*F+:F] : behind_diagonal_i ? v[3*F+:F] : v[0+:F];
    assign root_or_area[3*F+:F] = !area ? root[3*F+:F] : behind_diagonal_i ? v[4*F+:F] : '0;

    // The ratios' operands do not switch: u is held where it comes from.
    assign product_v_exp = plane_i ? '0 : v_exp_i;
    assign product_v_sig = plane_i ? '0 : v_sig_i;

    quadrille_delay_line #(.WIDTH(1), .DEPTH(TO_N)) u_delay_area (.clk_i, .data_i(area), .data_o(late_area));
    quadrille_delay_line #(.WIDTH(1), .DEPTH(1)) u_delay_factor_area (.clk_i, .data_i(late_area), .data_o(factor_area));
  end else begin : gen_no_plane
    logic unused_plane;
    assign unused_plane = ^{plane_i, behind_diagonal_i, area};
    assign area = 1'b0;
    assign late_area = 1'b0;
    assign factor_area = 1'b0;
    assign root_or_area = root;
    assign product_v_exp = v_exp_i;
    assign product_v_sig = v_sig_i;
  end

  assign count_area_o = quadrille_pkg::PERFORMANCE_COUNTERS != 0 && area;

  quadrille_delay_line #(.WIDTH(4 * F), .DEPTH(TO_N)) u_delay_late_root (
      .clk_i, .data_i(root_or_area), .data_o(late_root)
  );

  quadrille_delay_line #(.WIDTH(CLASS), .DEPTH(TO_N)) u_delay_late_class (
      .clk_i, .data_i(class_i), .data_o(late_class)
  );

  quadrille_delay_line #(.WIDTH(CLASS), .DEPTH(1 + quadrille_pkg::PRODUCT_STAGES)) u_delay_product_class (
      .clk_i, .data_i(late_class), .data_o(product_class)
  );

  // ---- Products of the ratios, or of the denominators of two edges -------------------------------------------------
  logic [4*F-1:0] edge_root, edge_k;
  logic [3:0] edge_neg, term_neg;
  logic [2:0] near_cancels, far_cancels;
  logic [3*F-1:0] own;
  logic [6*F-1:0] product;
  logic [4*RANK-1:0] rank;
  logic [4*TERM-1:0] term;
  quadrille_denominator_operands u_edges (
      .class_i, .root_i(root), .k_neg_i, .k_exp_i, .k_sig_i, .root_o(edge_root), .k_o(edge_k), .neg_o(edge_neg)
  );

  quadrille_ratio_products u_products (
      .clk_i, .u_exp_i, .u_sig_i, .v_exp_i(product_v_exp), .v_sig_i(product_v_sig), .d_neg_i,
      .two_edge_i(class_i[quadrille_pkg::CLASS_TWO_EDGE]), .edge_root_i(edge_root), .edge_k_i(edge_k),
      .edge_neg_i(edge_neg), .near_cancels_o(near_cancels), .far_cancels_o(far_cancels), .own_o(own),
      .product_o(product), .rank_o(rank), .neg_o(term_neg), .term_o(term)
  );

  // ---- The three ratios a, b, c, and the denominators of two edges -------------------------------------------------
  logic [3*F-1:0] num, den;
  logic [2*F-1:0] edge_n;
  logic [1:0] edge_n_neg;

  for (genvar g = 0; g < 3; g++) begin : gen_ratio
    quadrille_root_ratio u_ratio (
        .clk_i, .near_cancels_i(near_cancels[g]), .far_cancels_i(far_cancels[g]), .z_exp_i(product[g*F+S+:E]),
        .z_sig_i(product[g*F+:S]), .w_exp_i(product[(3+g)*F+S+:E]), .w_sig_i(product[(3+g)*F+:S]),
        .own_exp_i(own[g*F+S+:E]), .own_sig_i(own[g*F+:S]), .num_exp_o(num[g*F+S+:E]), .num_sig_o(num[g*F+:S]),
        .den_exp_o(den[g*F+S+:E]), .den_sig_o(den[g*F+:S])
    );
  end

  for (genvar g = 0; g < 2; g++) begin : gen_denominator
    quadrille_fp_sum #(.TERMS(2)) u_sum (
        .clk_i, .rank_i(rank[2*g*RANK+:2*RANK]), .neg_i(term_neg[2*g+:2]), .term_i(term[2*g*TERM+:2*TERM]),
        .neg_o(edge_n_neg[g]), .exp_o(edge_n[g*F+S+:E]), .sig_o(edge_n[g*F+:S])
    );
  end

  // ---- Factors and their products ----------------------------------------------------------------------------------
  logic [4*F-1:0] x, y, z;
  quadrille_weight_factors u_factors (
      .clk_i, .class_i(late_class), .area_i(late_area), .num_i(num), .den_i(den), .root_i(late_root), .edge_n_i(edge_n),
      .k_exp_i(override_k_exp_i), .k_sig_i(override_k_sig_i), .x_o(x), .y_o(y), .z_o(z)
  );

  quadrille_factor_products u_weights (
      .clk_i, .class_i(product_class), .area_i(factor_area), .x_i(x), .y_i(y), .z_i(z), .m_exp_o, .m_sig_o
  );

  logic unused;
  assign unused = ^edge_n_neg;
endmodule
