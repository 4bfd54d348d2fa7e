// Suite `forward_difference`: the 16 functions of a tile and a pixel of it in, A, D and r^2 at that pixel out.
module replay_forward_difference (
    `include "replay_ports.svh"
);
  `include "replay_fields.svh"
  localparam int VAL = quadrille_pkg::VAL_BITS;
  localparam int GRAD = quadrille_pkg::GRAD_BITS;
  localparam int QVAL = quadrille_pkg::QVAL_BITS;
  localparam int QGRAD = quadrille_pkg::QGRAD_BITS;
  localparam int QCURV = quadrille_pkg::QCURV_BITS;

  localparam int TILE_LOG2 = quadrille_pkg::TILE_LOG2;
  logic [2*(TILE_LOG2/2+1)-1:0] row_digits_i, dx_digits_i;
  logic [2*(TILE_LOG2+1)-1:0] norm_digits_i;

  offset_digits u_offset (
      .row_digits_o(row_digits_i),
      .dx_digits_o(dx_digits_i),
      .norm_digits_o(norm_digits_i),
      .*
  );

  for (genvar g = 0; g < 6; g++) begin : gen_linear
    forward_difference #(
        .VALUE_BITS(VAL),
        .GRAD_BITS(GRAD),
        .QUADRATIC(1'b0)
    ) u_difference (
        .value_i(lin_value_i[g*VAL+:VAL]),
        .gx_i(lin_gx_i[g*GRAD+:GRAD]),
        .gy_i(lin_gy_i[g*GRAD+:GRAD]),
        .q_i(1'b0),
        .value_o(a_o[g*VAL+:VAL]),
        .*
    );
  end

  logic [10*QVAL-1:0] quad_o;
  assign {r2_o, d_o} = quad_o;

  for (genvar g = 0; g < 10; g++) begin : gen_quadratic
    forward_difference #(
        .VALUE_BITS(QVAL),
        .GRAD_BITS(QGRAD),
        .CURV_BITS(QCURV)
    ) u_difference (
        .value_i(quad_value_i[g*QVAL+:QVAL]),
        .gx_i(quad_gx_i[g*QGRAD+:QGRAD]),
        .gy_i(quad_gy_i[g*QGRAD+:QGRAD]),
        .q_i(quad_q_i[g*QCURV+:QCURV]),
        .value_o(quad_o[g*QVAL+:QVAL]),
        .*
    );
  end

  replay_valid #(.LATENCY(quadrille_pkg::FORWARD_DIFFERENCE_STAGES)) u_valid (.*);
endmodule
