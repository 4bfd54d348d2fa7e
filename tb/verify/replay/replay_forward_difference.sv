// Suite `forward_difference`: the 16 functions of a tile, the squared lengths and a pixel of the tile in, A, D and r^2 at that pixel out.
module replay_forward_difference (
    `include "replay_ports.svh"
);
  `include "replay_fields.svh"
  localparam int VAL = quadrille_pkg::VAL_BITS;
  localparam int GRAD = quadrille_pkg::GRAD_BITS;
  localparam int QVAL = quadrille_pkg::QVAL_BITS;
  localparam int QGRAD = quadrille_pkg::QGRAD_BITS;
  localparam int QCURV = quadrille_pkg::QCURV_BITS;
  localparam int LENGTH2 = quadrille_pkg::LENGTH2_BITS;
  localparam int FORWARD = quadrille_pkg::FORWARD_DIFFERENCE_STAGES;
  localparam int LAW = quadrille_pkg::LAW_OF_COSINES_STAGES;

  localparam int TILE_LOG2 = quadrille_pkg::TILE_LOG2;
  logic [2*(TILE_LOG2/2+1)-1:0] row_digits, dx_digits;
  logic [2*(TILE_LOG2+1)-1:0] norm_digits;

  quadrille_radix4_digits #(.NUMBER_BITS(TILE_LOG2)) u_row_digits (
      .number_i(row_i),
      .digits_o(row_digits)
  );

  quadrille_offset_digits u_offset (
      .clk_i,
      .row_i,
      .dx_i,
      .dx_digits_o(dx_digits),
      .norm_digits_o(norm_digits)
  );

  logic [6*VAL-1:0] a;
  logic [10*QVAL-1:0] quadratic;  // D of a homogeneous quad, r^2

  for (genvar g = 0; g < 6; g++) begin : gen_linear
    logic [VAL-1:0] row;
    logic [GRAD-1:0] gx;
    logic unused;

    quadrille_forward_difference_row #(
        .VALUE_BITS(VAL),
        .GRAD_BITS(GRAD)
    ) u_row (
        .clk_i,
        .row_digits_i(row_digits),
        .value_i(lin_value_i[g*VAL+:VAL]),
        .gx_i(lin_gx_i[g*GRAD+:GRAD]),
        .gy_i(lin_gy_i[g*GRAD+:GRAD]),
        .q_i(1'b0),
        .row_o(row),
        .gx_o(gx),
        .q_o(unused)
    );

    quadrille_forward_difference_column #(
        .VALUE_BITS(VAL),
        .GRAD_BITS(GRAD),
        .QUADRATIC(1'b0)
    ) u_column (
        .clk_i,
        .dx_digits_i(dx_digits),
        .norm_digits_i(norm_digits),
        .row_i(row),
        .gx_i(gx),
        .q_i(1'b0),
        .value_o(a[g*VAL+:VAL])
    );
  end

  for (genvar g = 0; g < 10; g++) begin : gen_quadratic
    logic [QVAL-1:0] row;
    logic [QGRAD-1:0] gx;
    logic [QCURV-1:0] q;

    quadrille_forward_difference_row #(
        .VALUE_BITS(QVAL),
        .GRAD_BITS(QGRAD),
        .CURV_BITS(QCURV)
    ) u_row (
        .clk_i,
        .row_digits_i(row_digits),
        .value_i(quad_value_i[g*QVAL+:QVAL]),
        .gx_i(quad_gx_i[g*QGRAD+:QGRAD]),
        .gy_i(quad_gy_i[g*QGRAD+:QGRAD]),
        .q_i(quad_q_i[g*QCURV+:QCURV]),
        .row_o(row),
        .gx_o(gx),
        .q_o(q)
    );

    quadrille_forward_difference_column #(
        .VALUE_BITS(QVAL),
        .GRAD_BITS(QGRAD),
        .CURV_BITS(QCURV)
    ) u_column (
        .clk_i,
        .dx_digits_i(dx_digits),
        .norm_digits_i(norm_digits),
        .row_i(row),
        .gx_i(gx),
        .q_i(q),
        .value_o(quadratic[g*QVAL+:QVAL])
    );
  end

  // D, with what goes beside it: law_of_cosines takes the squared distances a clock before all else.
  logic [6*QVAL-1:0] exact;
  logic homogeneous;
  logic [6*LENGTH2-1:0] length2;

  quadrille_delay_line #(
      .WIDTH(1 + 6 * LENGTH2),
      .DEPTH(FORWARD + 1)
  ) u_quad (
      .clk_i,
      .data_i({homogeneous_i, length2_i}),
      .data_o({homogeneous, length2})
  );

  quadrille_delay_line #(.WIDTH(6 * QVAL), .DEPTH(1)) u_exact (
      .clk_i,
      .data_i(quadratic[6*QVAL-1:0]),
      .data_o(exact)
  );

  for (genvar g = 0; g < 6; g++) begin : gen_d
    localparam int FIRST = 6 + {30'd0, quadrille_pkg::pair_first(4'(g))};
    localparam int SECOND = 6 + {30'd0, quadrille_pkg::pair_second(4'(g))};
    quadrille_law_of_cosines u_law (
        .clk_i,
        .homogeneous_i(homogeneous),
        .exact_i(exact[g*QVAL+:QVAL]),
        .r2_first_i(quadratic[FIRST*QVAL+:QVAL]),
        .r2_second_i(quadratic[SECOND*QVAL+:QVAL]),
        .length2_i(length2[g*LENGTH2+:LENGTH2]),
        .d_o(d_o[g*QVAL+:QVAL])
    );
  end

  quadrille_delay_line #(
      .WIDTH(6 * VAL + 4 * QVAL),
      .DEPTH(LAW)
  ) u_beside (
      .clk_i,
      .data_i({a, quadratic[10*QVAL-1:6*QVAL]}),
      .data_o({a_o, r2_o})
  );

  replay_valid #(.LATENCY(FORWARD + LAW)) u_valid (.*);
endmodule
