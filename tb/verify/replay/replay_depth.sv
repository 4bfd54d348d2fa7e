// Suite `depth`: draw state, hull flag, bases, corners' depths and the `sum` boundary in, the fragment's valid, saturated flag, depth and
// attributes out. The two reciprocals, quad_reject for the limits of depth, then fragment_output.
module replay_depth (
    `include "replay_ports.svh"
);
  `include "replay_fields.svh"
  localparam int S = quadrille_pkg::SIGNIFICAND_BITS;
  localparam int E = quadrille_pkg::EXP_BITS;
  localparam int N = quadrille_pkg::ATTRIBUTE_SLOTS;
  localparam int DB = quadrille_pkg::DEPTH_BITS;
  localparam int V = quadrille_pkg::VIEWPORT_BITS;
  localparam int ID = quadrille_pkg::QUAD_ID_BITS;
  localparam int AO = quadrille_pkg::ATTR_OUT_BITS;
  localparam int CODE = quadrille_pkg::CORNER_DEPTH_BITS;
  localparam int LIMITS = quadrille_pkg::DEPTH_LIMIT_BITS;
  localparam int PORT = quadrille_pkg::FRAGMENT_STAGE - quadrille_pkg::SUM_STAGE;  // clocks to the port
  localparam int STATE = 1 + 4 + 1;
  localparam int BASES = N * AO + DB + 1;
  localparam int CORNERS = 2 * (DB + 1) + 2 * CODE;
  localparam int NUMERATORS = (N + 1) * (1 + E + S);

  // ---- Reciprocals, the numerators wait -----------------------------------------------------------------------------------
  logic rk_neg, rw_neg;
  logic [E-1:0] rk_exp, rw_exp;
  logic [S-1:0] rk_sig, rw_sig;

  quadrille_reciprocal u_reciprocal_k (
      .clk_i,
      .neg_i(den_k_neg_i),
      .exp_i(den_k_exp_i),
      .sig_i(den_k_sig_i),
      .neg_o(rk_neg),
      .exp_o(rk_exp),
      .sig_o(rk_sig)
  );

  quadrille_reciprocal u_reciprocal_w (
      .clk_i,
      .neg_i(den_w_neg_i),
      .exp_i(den_w_exp_i),
      .sig_i(den_w_sig_i),
      .neg_o(rw_neg),
      .exp_o(rw_exp),
      .sig_o(rw_sig)
  );

  logic [NUMERATORS-1:0] late_numerator;
  logic [STATE-1:0] late_state;
  logic [BASES-1:0] late_base;
  logic [CORNERS-1:0] late_corners;

  quadrille_delay_line #(.WIDTH(NUMERATORS), .DEPTH(quadrille_pkg::RECIPROCAL_STAGES)) u_numerator (
      .clk_i, .data_i({attr_neg_i, attr_exp_i, attr_sig_i, z_neg_i, z_exp_i, z_sig_i}), .data_o(late_numerator));
  quadrille_delay_line #(.WIDTH(STATE), .DEPTH(PORT - 2)) u_state (
      .clk_i, .data_i({depth_on_i, attributes_i, hull_i}), .data_o(late_state));
  quadrille_delay_line #(.WIDTH(BASES), .DEPTH(PORT - 3)) u_base (.clk_i, .data_i({base_attr_i, base_depth_i}), .data_o(late_base));
  quadrille_delay_line #(.WIDTH(CORNERS), .DEPTH(PORT - 4)) u_corners (
      .clk_i, .data_i({znear_i, zfar_i, depth_low_i, depth_high_i}), .data_o(late_corners));

  // ---- Limits of depth. quad_reject wants a quad's corners for two clocks: two of it in turn -------------------------------
  logic turn;
  logic [CORNERS-1:0] kept_corners;
  logic [2*LIMITS-1:0] limits;
  logic [3:0] unused_reject;

  always_ff @(posedge clk_i) begin
    turn <= rst_ni && !turn;
    kept_corners <= late_corners;
  end

  for (genvar g = 0; g < 2; g++) begin : gen_limits
    logic [DB:0] znear, zfar;
    logic [CODE-1:0] low, high;

    assign {znear, zfar, low, high} = (turn == 1'(g)) ? late_corners : kept_corners;

    quadrille_quad_reject u_reject (
        .clk_i,
        .depth_on_i(1'b1),
        .znear_i(znear),
        .zfar_i(zfar),
        .accept_i(1'b0),
        .first_i(1'b0),
        .w_i({quadrille_pkg::W_BITS{1'b0}}),
        .low_i(low),
        .high_i(high),
        .behind_o(unused_reject[2*g]),
        .depth_o(unused_reject[2*g+1]),
        .limits_o(limits[g*LIMITS+:LIMITS])
    );
  end

  // ---- Quotients. Bases are looked at three clocks before the port, limits and state two, hull one ------------------------
  logic [N-1:0] attr_neg;
  logic [N*E-1:0] attr_exp;
  logic [N*S-1:0] attr_sig;
  logic z_neg;
  logic [E-1:0] z_exp;
  logic [S-1:0] z_sig;
  logic depth_on, early_hull, hull;
  logic [3:0] attributes;
  logic [N*AO-1:0] base_attr;
  logic [DB:0] base_depth;

  assign {attr_neg, attr_exp, attr_sig, z_neg, z_exp, z_sig} = late_numerator;
  assign {depth_on, attributes, early_hull} = late_state;
  assign {base_attr, base_depth} = late_base;

  quadrille_delay_line #(.WIDTH(1), .DEPTH(1)) u_hull (.clk_i, .data_i(early_hull), .data_o(hull));

  logic [ID+2*V:0] identity;  // quad, x, y, front
  logic [6:0] class_flags;
  logic unused;

  quadrille_fragment_output u_output (
      .clk_i,
      .rst_ni,
      .depth_on_i(depth_on),
      .attributes_i(attributes),
      .attr_neg_i(attr_neg),
      .attr_exp_i(attr_exp),
      .attr_sig_i(attr_sig),
      .z_neg_i(z_neg),
      .z_exp_i(z_exp),
      .z_sig_i(z_sig),
      .rk_neg_i(rk_neg),
      .rk_exp_i(rk_exp),
      .rk_sig_i(rk_sig),
      .rw_neg_i(rw_neg),
      .rw_exp_i(rw_exp),
      .rw_sig_i(rw_sig),
      .base_attr_i(base_attr),
      .base_depth_i(base_depth),
      .depth_limits_i(limits[turn*LIMITS+:LIMITS]),
      .valid_i(1'b1),
      .id_i(ID'(0)),
      .hull_i(hull),
      .homogeneous_i(1'b0),
      .x_i(V'(0)),
      .y_i(V'(0)),
      .front_i(1'b0),
      .tie_i(1'b0),
      .flags_i(quadrille_pkg::CLASS_FLAGS'(0)),
      .valid_o(drawn_o),
      .fragment_o({identity, saturated_o, class_flags, depth_o, attr_o})
  );

  assign unused = ^{identity, class_flags, unused_reject};

  replay_valid #(.LATENCY(PORT)) u_valid (.*);
endmodule
