// Suite `setup`: four vertices and the scissor rectangle in, the `setup` boundary out. One quad at a time, as long as quad_setup takes.
module replay_setup #(
    localparam int T = quadrille_pkg::T_BITS,
    localparam int W = quadrille_pkg::W_BITS,
    localparam int V = quadrille_pkg::VIEWPORT_BITS,
    localparam int STIMULUS_BITS = 8 * T + 4 * W + 4 * (V + 1),
    localparam int SLOT = quadrille_pkg::QUAD_SLOTS_LOG2,
    localparam int TC = quadrille_pkg::TC_BITS,
    localparam int VAL = quadrille_pkg::VAL_BITS,
    localparam int GRAD = quadrille_pkg::GRAD_BITS,
    localparam int QVAL = quadrille_pkg::QVAL_BITS,
    localparam int QGRAD = quadrille_pkg::QGRAD_BITS,
    localparam int QCURV = quadrille_pkg::QCURV_BITS,
    localparam int RESPONSE_BITS = SLOT + 4 * TC + 6 + 6 * (VAL + 2 * GRAD) + 10 * (QVAL + 2 * QGRAD + QCURV)
) (
    input logic clk_i,
    input logic rst_ni,
    input logic valid_i,
    output logic ready_o,
    input logic [STIMULUS_BITS-1:0] stimulus_i,
    output logic valid_o,
    output logic [RESPONSE_BITS-1:0] response_o
);
  logic [4*T-1:0] x, y;
  logic [4*W-1:0] w;
  logic [V:0] scissor_x0, scissor_y0, scissor_x1, scissor_y1;
  logic [SLOT-1:0] slot;
  logic [TC-1:0] tile_x0, tile_y0, tiles_x, tiles_y;
  logic homogeneous, hull;
  logic [3:0] visible;
  logic [6*VAL-1:0] lin_value;
  logic [6*GRAD-1:0] lin_gx, lin_gy;
  logic [10*QVAL-1:0] quad_value;
  logic [10*QGRAD-1:0] quad_gx, quad_gy;
  logic [10*QCURV-1:0] quad_q;

  assign {x, y, w, scissor_x0, scissor_y0, scissor_x1, scissor_y1} = stimulus_i;
  assign response_o = {
    slot,
    tile_x0,
    tile_y0,
    tiles_x,
    tiles_y,
    homogeneous,
    hull,
    visible,
    lin_value,
    lin_gx,
    lin_gy,
    quad_value,
    quad_gx,
    quad_gy,
    quad_q
  };

  quad_setup u_setup (
      .clk_i,
      .rst_ni,
      .start_i(valid_i && ready_o),
      .slot_i(SLOT'(0)),
      .x_i(x),
      .y_i(y),
      .w_i(w),
      .scissor_x0_i(scissor_x0),
      .scissor_y0_i(scissor_y0),
      .scissor_x1_i(scissor_x1),
      .scissor_y1_i(scissor_y1),
      .idle_o(ready_o),
      .take_i(valid_o),
      .done_o(valid_o),
      .slot_o(slot),
      .tile_x0_o(tile_x0),
      .tile_y0_o(tile_y0),
      .tiles_x_o(tiles_x),
      .tiles_y_o(tiles_y),
      .homogeneous_o(homogeneous),
      .hull_o(hull),
      .visible_o(visible),
      .lin_value_o(lin_value),
      .lin_gx_o(lin_gx),
      .lin_gy_o(lin_gy),
      .quad_value_o(quad_value),
      .quad_gx_o(quad_gx),
      .quad_gy_o(quad_gy),
      .quad_q_o(quad_q)
  );
endmodule
