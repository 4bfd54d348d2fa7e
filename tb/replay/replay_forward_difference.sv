// Suite `forward_difference`: the 16 functions of a tile and a pixel of it in, A, D and r^2 at that pixel out. Latency 2.
module replay_forward_difference #(
    localparam int VAL = quadrille_pkg::VAL_BITS,
    localparam int GRAD = quadrille_pkg::GRAD_BITS,
    localparam int QVAL = quadrille_pkg::QVAL_BITS,
    localparam int QGRAD = quadrille_pkg::QGRAD_BITS,
    localparam int QCURV = quadrille_pkg::QCURV_BITS,
    localparam int TILE_LOG2 = quadrille_pkg::TILE_LOG2,
    localparam int STIMULUS_BITS = 2 * TILE_LOG2 + 6 * (VAL + 2 * GRAD) + 10 * (QVAL + 2 * QGRAD + QCURV),
    localparam int RESPONSE_BITS = 6 * VAL + 10 * QVAL
) (
    input logic clk_i,
    input logic rst_ni,
    input logic valid_i,
    output logic ready_o,
    input logic [STIMULUS_BITS-1:0] stimulus_i,
    output logic valid_o,
    output logic [RESPONSE_BITS-1:0] response_o
);
  localparam int LATENCY = 2;

  logic [TILE_LOG2-1:0] row, dx;
  logic [6*VAL-1:0] lin_value, a;
  logic [6*GRAD-1:0] lin_gx, lin_gy;
  logic [10*QVAL-1:0] quad_value, quad;
  logic [10*QGRAD-1:0] quad_gx, quad_gy;
  logic [10*QCURV-1:0] quad_q;

  assign {row, dx, lin_value, lin_gx, lin_gy, quad_value, quad_gx, quad_gy, quad_q} = stimulus_i;
  assign response_o = {a, quad[0+:6*QVAL], quad[6*QVAL+:4*QVAL]};

  for (genvar g = 0; g < 6; g++) begin : gen_linear
    forward_difference #(
        .VALUE_BITS(VAL),
        .GRAD_BITS(GRAD),
        .CURV_BITS(1)
    ) u_difference (
        .clk_i,
        .en_i(1'b1),
        .row_i(row),
        .dx_i(dx),
        .value_i(lin_value[g*VAL+:VAL]),
        .gx_i(lin_gx[g*GRAD+:GRAD]),
        .gy_i(lin_gy[g*GRAD+:GRAD]),
        .q_i(1'b0),
        .value_o(a[g*VAL+:VAL])
    );
  end

  for (genvar g = 0; g < 10; g++) begin : gen_quadratic
    forward_difference #(
        .VALUE_BITS(QVAL),
        .GRAD_BITS(QGRAD),
        .CURV_BITS(QCURV)
    ) u_difference (
        .clk_i,
        .en_i(1'b1),
        .row_i(row),
        .dx_i(dx),
        .value_i(quad_value[g*QVAL+:QVAL]),
        .gx_i(quad_gx[g*QGRAD+:QGRAD]),
        .gy_i(quad_gy[g*QGRAD+:QGRAD]),
        .q_i(quad_q[g*QCURV+:QCURV]),
        .value_o(quad[g*QVAL+:QVAL])
    );
  end

  replay_valid #(.LATENCY(LATENCY)) u_valid (.clk_i, .rst_ni, .valid_i, .ready_o, .valid_o);
endmodule
