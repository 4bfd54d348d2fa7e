// Coverage of one tile row (a TILE x 1 stamp) a clock: the five edge functions at each pixel, the two clauses in both orientations,
// culling, the scissor rectangle. Stamps with a covered pixel go to the stamp FIFO, an end entry passes through.
//
// Ties: E = 0 counts as the sign of (dE/dx, dE/dy), the first that is not 0 (tie_pos_i, tie_neg_i); an edge function without
// gradient has no sign.
// Combinational from the ring entry and the row register; one clock per row, waits only when it has something to push.
module stamp_coverage #(
    localparam int V = quadrille_pkg::VIEWPORT_BITS,
    localparam int TC = quadrille_pkg::TC_BITS,
    localparam int VAL = quadrille_pkg::VAL_BITS,
    localparam int GRAD = quadrille_pkg::GRAD_BITS,
    localparam int RING = quadrille_pkg::TILE_SLOTS_LOG2,
    localparam int TILE_LOG2 = quadrille_pkg::TILE_LOG2,
    localparam int TILE = quadrille_pkg::TILE
) (
    input logic clk_i,
    input logic rst_ni,
    input logic [1:0] cull_i,
    input logic [V:0] scissor_x0_i,
    input logic [V:0] scissor_y0_i,
    input logic [V:0] scissor_x1_i,
    input logic [V:0] scissor_y1_i,
    // Tile ring
    output logic [RING:0] stamp_ptr_o,
    input logic present_i,
    input logic end_i,
    input logic [TC-1:0] tile_x_i,
    input logic [TC-1:0] tile_y_i,
    input logic [5*VAL-1:0] lin_value_i,
    // Quad
    input logic [5*GRAD-1:0] lin_gx_i,
    input logic [5*GRAD-1:0] lin_gy_i,
    input logic [4:0] tie_pos_i,
    input logic [4:0] tie_neg_i,
    input logic [3:0] visible_i,
    // Stamp FIFO
    input logic fifo_full_i,
    output logic push_o,
    output logic end_o,
    output logic [TILE_LOG2-1:0] row_o,
    output logic [TILE-1:0] mask_o,
    output logic [TILE-1:0] front_o,
    output logic [TILE-1:0] tie_o
);
  logic [RING:0] stamp_q;
  logic [TILE_LOG2-1:0] row_q;
  logic step_row, next_tile;
  logic any;

  // ---- Signs of the five edge functions -----------------------------------------------------------------------------------
  logic [TILE-1:0] pos0, pos1, pos2, pos3, pos4;
  logic [TILE-1:0] neg0, neg1, neg2, neg3, neg4;
  logic [5*TILE-1:0] pos, neg, zero;

  for (genvar g = 0; g < 5; g++) begin : gen_edge
    logic [VAL-1:0] gx, gy;
    logic [VAL-1:0] row_value_q, row_value;
    logic [TILE-1:0] is_zero, is_neg;

    assign gx = VAL'($signed(lin_gx_i[g*GRAD+:GRAD]));
    assign gy = VAL'($signed(lin_gy_i[g*GRAD+:GRAD]));
    assign row_value = (row_q == '0) ? lin_value_i[g*VAL+:VAL] : row_value_q;

    for (genvar dx = 0; dx < TILE; dx++) begin : gen_pixel
      logic [VAL-1:0] value;

      if (dx == 0) begin : gen_first
        assign value = row_value;
      end else begin : gen_next  // a tree: from the pixel without the highest one of dx
        localparam int HIGHEST = $clog2(dx + 1) - 1;
        assign value = gen_pixel[dx-(1<<HIGHEST)].value + (gx << HIGHEST);
      end
      assign is_zero[dx] = value == '0;
      assign is_neg[dx] = value[VAL-1];
    end

    assign zero[g*TILE+:TILE] = is_zero & {TILE{tie_pos_i[g] || tie_neg_i[g]}};  // an all-zero edge decides nothing
    assign neg[g*TILE+:TILE] = is_neg | (is_zero & {TILE{tie_neg_i[g]}});
    assign pos[g*TILE+:TILE] = (~is_neg & ~is_zero) | (is_zero & {TILE{tie_pos_i[g]}});

    always_ff @(posedge clk_i) if (step_row) row_value_q <= row_value + gy;
  end

  assign {pos4, pos3, pos2, pos1, pos0} = pos;
  assign {neg4, neg3, neg2, neg1, neg0} = neg;

  // ---- Scissor ------------------------------------------------------------------------------------------------------------
  logic [V:0] y;
  logic [TC-1:0] first_tile, end_tile;  // of the rectangle's columns
  logic [TILE_LOG2-1:0] first_dx, end_dx;
  logic [TILE-1:0] in_scissor;
  logic row_inside, right_of_first, in_first, left_of_end, in_end;

  assign y = {tile_y_i, row_q};
  assign row_inside = y >= scissor_y0_i && y < scissor_y1_i;
  assign {first_tile, first_dx} = scissor_x0_i;
  assign {end_tile, end_dx} = scissor_x1_i;
  assign right_of_first = tile_x_i > first_tile;
  assign in_first = tile_x_i == first_tile;
  assign left_of_end = tile_x_i < end_tile;
  assign in_end = tile_x_i == end_tile;

  always_comb begin
    for (int dx = 0; dx < TILE; dx++) begin
      in_scissor[dx] = row_inside && (right_of_first || (in_first && TILE_LOG2'(dx) >= first_dx))
          && (left_of_end || (in_end && TILE_LOG2'(dx) < end_dx));
    end
  end

  // ---- Clauses ------------------------------------------------------------------------------------------------------------
  logic [TILE-1:0] back, front;

  assign back = ((pos4 & pos0 & pos1 & (pos2 | pos3) & {TILE{visible_i[0]}})
      | (neg4 & pos2 & pos3 & (pos0 | pos1) & {TILE{visible_i[1]}})) & {TILE{cull_i != 2'd2}};
  assign front = ((neg4 & neg0 & neg1 & (neg2 | neg3) & {TILE{visible_i[2]}})
      | (pos4 & neg2 & neg3 & (neg0 | neg1) & {TILE{visible_i[3]}})) & {TILE{cull_i != 2'd1}};

  assign end_o = end_i;
  assign mask_o = end_i ? '0 : (back | front) & in_scissor;
  assign front_o = front & mask_o;
  assign tie_o = (zero[0+:TILE] | zero[TILE+:TILE] | zero[2*TILE+:TILE] | zero[3*TILE+:TILE] | zero[4*TILE+:TILE]) & mask_o;
  assign row_o = row_q;

  // ---- Control ------------------------------------------------------------------------------------------------------------
  assign any = end_i || mask_o != '0;
  assign push_o = present_i && any && !fifo_full_i;
  assign step_row = present_i && !end_i && !(any && fifo_full_i);
  assign next_tile = (step_row && row_q == '1) || (push_o && end_i);
  assign stamp_ptr_o = stamp_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      stamp_q <= '0;
      row_q <= '0;
    end else begin
      if (next_tile) stamp_q <= stamp_q + (RING + 1)'(1);
      if (step_row) row_q <= row_q + TILE_LOG2'(1);
    end
  end
endmodule
