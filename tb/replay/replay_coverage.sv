// Suite `coverage`: one tile entry in, mask, front and tie of its rows out. A clock a row; rows that are not pushed count as zero.
module replay_coverage #(
    localparam int V = quadrille_pkg::VIEWPORT_BITS,
    localparam int TC = quadrille_pkg::TC_BITS,
    localparam int VAL = quadrille_pkg::VAL_BITS,
    localparam int GRAD = quadrille_pkg::GRAD_BITS,
    localparam int RING = quadrille_pkg::TILE_SLOTS_LOG2,
    localparam int TILE_LOG2 = quadrille_pkg::TILE_LOG2,
    localparam int TILE = quadrille_pkg::TILE,
    localparam int STIMULUS_BITS = 2 + 4 * (V + 1) + 2 * TC + 5 * (VAL + 2 * GRAD) + 4,
    localparam int RESPONSE_BITS = 3 * TILE * TILE
) (
    input logic clk_i,
    input logic rst_ni,
    input logic valid_i,
    output logic ready_o,
    input logic [STIMULUS_BITS-1:0] stimulus_i,
    output logic valid_o,
    output logic [RESPONSE_BITS-1:0] response_o
);
  logic [1:0] cull;
  logic [V:0] scissor_x0, scissor_y0, scissor_x1, scissor_y1;
  logic [TC-1:0] tile_x, tile_y;
  logic [5*VAL-1:0] lin_value;
  logic [5*GRAD-1:0] lin_gx, lin_gy;
  logic [3:0] visible;
  logic [RING:0] pointer;
  logic push, push_end;
  logic [TILE_LOG2-1:0] row;
  logic [TILE-1:0] mask, front, tie;

  assign {cull, scissor_x0, scissor_y0, scissor_x1, scissor_y1, tile_x, tile_y, lin_value, lin_gx, lin_gy, visible} = stimulus_i;

  stamp_coverage u_coverage (
      .clk_i,
      .rst_ni,
      .cull_i(cull),
      .scissor_x0_i(scissor_x0),
      .scissor_y0_i(scissor_y0),
      .scissor_x1_i(scissor_x1),
      .scissor_y1_i(scissor_y1),
      .stamp_ptr_o(pointer),
      .present_i(valid_i),
      .end_i(1'b0),
      .tile_x_i(tile_x),
      .tile_y_i(tile_y),
      .lin_value_i(lin_value),
      .lin_gx_i(lin_gx),
      .lin_gy_i(lin_gy),
      .visible_i(visible),
      .fifo_full_i(1'b0),
      .push_o(push),
      .end_o(push_end),
      .row_o(row),
      .mask_o(mask),
      .front_o(front),
      .tie_o(tie)
  );

  // The entry is taken with its last row; its rows are complete a clock later.
  logic [TILE_LOG2-1:0] count_q;

  assign ready_o = count_q == '1;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      count_q <= '0;
      valid_o <= 1'b0;
    end else begin
      if (valid_i) count_q <= count_q + TILE_LOG2'(1);
      valid_o <= valid_i && ready_o;
    end
  end

  logic [TILE*TILE-1:0] masks_q, fronts_q, ties_q;

  for (genvar g = 0; g < TILE; g++) begin : gen_row
    always_ff @(posedge clk_i) begin
      if (push && row == g) begin
        masks_q[g*TILE+:TILE] <= mask;
        fronts_q[g*TILE+:TILE] <= front;
        ties_q[g*TILE+:TILE] <= tie;
      end else if (count_q == '0) begin
        masks_q[g*TILE+:TILE] <= '0;
        fronts_q[g*TILE+:TILE] <= '0;
        ties_q[g*TILE+:TILE] <= '0;
      end
    end
  end

  assign response_o = {masks_q, fronts_q, ties_q};

  logic unused;
  assign unused = ^{pointer, push_end};
endmodule
