// Quotients to fixed point, discard, output register. Latency FRAGMENT_OUTPUT_STAGES from numerators and reciprocals to the port:
// products, fixed_point, signs and depth limits, output.
//
// Attribute: two's complement, ATTRIBUTE_INT_BITS and ATTRIBUTE_FRAC_BITS, truncated toward zero, saturated. Depth: unsigned,
// 1 integer bit, DEPTH_BITS fraction bits. A pixel is discarded outside [znear, zfar], for negative depth, and, in a quad whose hull
// holds the eye, behind the eye. The register holds zeros whenever it is not valid. valid_i and the rest of a pixel's identity come one clock before the port; the draw state is looked at two before.
module fragment_output #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int E = quadrille_pkg::EXP_BITS,
    localparam int N = quadrille_pkg::ATTRIBUTE_SLOTS,
    localparam int V = quadrille_pkg::VIEWPORT_BITS,
    localparam int DB = quadrille_pkg::DEPTH_BITS,
    localparam int AO = quadrille_pkg::ATTR_OUT_BITS,
    localparam int ID = quadrille_pkg::QUAD_ID_BITS,
    localparam int FB = quadrille_pkg::FRAGMENT_BITS,
    localparam int FLAGS = quadrille_pkg::CLASS_FLAGS
) (
    input logic clk_i,
    input logic rst_ni,
    // Draw state
    input logic depth_on_i,
    input logic [DB:0] znear_i,
    input logic [DB:0] zfar_i,
    input logic [3:0] attributes_i,
    // Numerators and reciprocals
    input logic [N-1:0] attr_neg_i,
    input logic [N*E-1:0] attr_exp_i,
    input logic [N*S-1:0] attr_sig_i,
    input logic z_neg_i,
    input logic [E-1:0] z_exp_i,
    input logic [S-1:0] z_sig_i,
    input logic rk_neg_i,
    input logic [E-1:0] rk_exp_i,
    input logic [S-1:0] rk_sig_i,
    input logic rw_neg_i,
    input logic [E-1:0] rw_exp_i,
    input logic [S-1:0] rw_sig_i,
    // One clock before the port
    input logic valid_i,
    input logic [ID-1:0] id_i,
    input logic hull_i,
    input logic homogeneous_i,
    input logic [V-1:0] x_i,
    input logic [V-1:0] y_i,
    input logic front_i,
    input logic tie_i,
    input logic [FLAGS-1:0] flags_i,  // of the class, CLASS_NOTCH lowest
    // Port
    output logic valid_o,
    output logic [FB-1:0] fragment_o
);
  // ---- Attributes ---------------------------------------------------------------------------------------------------------
  localparam int TO_FIXED = quadrille_pkg::FIXED_POINT_STAGES;
  logic [N-1:0] overflow;
  logic [N*AO-1:0] attr;

  for (genvar g = 0; g < N; g++) begin : gen_attribute
    logic prod_neg, neg;
    logic [E-1:0] exp;
    logic [2*S-1:0] prod;
    logic used, saturated;
    logic [AO-2:0] fixed;

    fp_raw_product u_product (
        .clk_i,
        .neg_i(attr_neg_i[g] ^ rk_neg_i),
        .a_exp_i(attr_exp_i[g*E+:E]),
        .a_sig_i(attr_sig_i[g*S+:S]),
        .b_exp_i(rk_exp_i),
        .b_sig_i(rk_sig_i),
        .neg_o(prod_neg),
        .exp_o(exp),
        .prod_o(prod)
    );

    fixed_point #(
        .INT_BITS(quadrille_pkg::ATTRIBUTE_INT_BITS),
        .FRAC_BITS(quadrille_pkg::ATTRIBUTE_FRAC_BITS)
    ) u_fixed (
        .clk_i,
        .exp_i(exp),
        .prod_i(prod),
        .overflow_o(saturated),
        .fixed_o(fixed)
    );

    delay_line #(.WIDTH(1), .DEPTH(TO_FIXED)) u_delay_neg (.clk_i, .data_i(prod_neg), .data_o(neg));

    assign used = attributes_i > 4'(g);

    always_ff @(posedge clk_i) begin
      overflow[g] <= used && saturated;
      attr[g*AO+:AO] <= !used ? '0 : neg ? AO'(0) - {1'b0, fixed} : {1'b0, fixed};
    end
  end

  // ---- Depth --------------------------------------------------------------------------------------------------------------
  logic z_prod_neg, z_neg, w_zero, w_neg;
  logic [E-1:0] z_exp;
  logic [2*S-1:0] z_prod;
  logic z_saturated;
  logic [DB:0] z_fixed, z;
  logic z_below;
  logic [DB:0] depth_q;
  logic depth_discard_q, behind_q;

  fp_raw_product u_product_z (
      .clk_i,
      .neg_i(z_neg_i ^ rw_neg_i),
      .a_exp_i(z_exp_i),
      .a_sig_i(z_sig_i),
      .b_exp_i(rw_exp_i),
      .b_sig_i(rw_sig_i),
      .neg_o(z_prod_neg),
      .exp_o(z_exp),
      .prod_o(z_prod)
  );

  delay_line #(.WIDTH(1), .DEPTH(TO_FIXED)) u_delay_z_neg (.clk_i, .data_i(z_prod_neg), .data_o(z_neg));
  delay_line #(.WIDTH(2), .DEPTH(quadrille_pkg::PRODUCT_STAGES + TO_FIXED)) u_delay_w (
      .clk_i,
      .data_i({rw_sig_i == '0, rw_neg_i}),
      .data_o({w_zero, w_neg})
  );

  fixed_point #(
      .INT_BITS(1),
      .FRAC_BITS(DB)
  ) u_fixed_z (
      .clk_i,
      .exp_i(z_exp),
      .prod_i(z_prod),
      .overflow_o(z_saturated),
      .fixed_o(z_fixed)
  );

  assign z = (w_zero || z_saturated) ? '1 : z_fixed;
  assign z_below = !w_zero && z_neg && z != '0;

  always_ff @(posedge clk_i) begin
    depth_q <= depth_on_i ? z : (DB + 1)'(0);
    depth_discard_q <= depth_on_i && (z_below || z < znear_i || z > zfar_i);
    behind_q <= w_zero || w_neg;
  end

  // ---- Output register ----------------------------------------------------------------------------------------------------
  logic two_corner, on_vertex, two_edge, on_edge, notch;
  logic [7:0] flags;
  logic valid_d;
  logic [FB-1:0] fragment_d;

  assign {two_corner, on_vertex, two_edge, on_edge, notch} = flags_i;
  assign flags = {overflow != '0, notch, homogeneous_i, tie_i, two_edge, two_corner, on_vertex, on_edge};
  assign valid_d = valid_i && !(hull_i && behind_q) && !depth_discard_q;
  assign fragment_d = {id_i, x_i, y_i, front_i, flags, depth_q, attr};

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      valid_o <= 1'b0;
      fragment_o <= '0;
    end else begin
      valid_o <= valid_d;
      fragment_o <= valid_d ? fragment_d : '0;
    end
  end
endmodule
