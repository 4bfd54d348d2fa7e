// Walks a quad's tiles, blocks of 8x8 tiles first, both in serpentine order, and pushes the tiles that may hold a covered pixel
// into the tile ring. One step a clock, block or tile; after the last block an end entry.
//
// State is value (and gx, gy of the quadratics) at the first pixel of the current block and of the current tile, moved by exact
// forward differences. The test is conservative over the extent: each edge function is 'somewhere positive', 'somewhere negative'
// or both, by its value and edge_reach. Does not look at the scissor rectangle.
module tile_walk #(
    localparam int TC = quadrille_pkg::TC_BITS,
    localparam int VAL = quadrille_pkg::VAL_BITS,
    localparam int GRAD = quadrille_pkg::GRAD_BITS,
    localparam int REACH = quadrille_pkg::REACH_BITS,
    localparam int QVAL = quadrille_pkg::QVAL_BITS,
    localparam int QGRAD = quadrille_pkg::QGRAD_BITS,
    localparam int QCURV = quadrille_pkg::QCURV_BITS,
    localparam int SLOT = quadrille_pkg::QUAD_SLOTS_LOG2
) (
    input logic clk_i,
    input logic rst_ni,
    input logic [1:0] cull_i,
    input logic reject_tiles_i,  // skip bit 0
    // Setup in
    input logic setup_done_i,
    output logic take_o,
    input logic [SLOT-1:0] slot_i,
    input logic [TC-1:0] tile_x0_i,
    input logic [TC-1:0] tile_y0_i,
    input logic [TC-1:0] tiles_x_i,
    input logic [TC-1:0] tiles_y_i,
    input logic [3:0] visible_i,
    input logic [6*VAL-1:0] lin_value_i,
    input logic [6*GRAD-1:0] lin_gx_i,
    input logic [6*GRAD-1:0] lin_gy_i,
    input logic [5*REACH-1:0] fall_tile_i,
    input logic [5*REACH-1:0] rise_tile_i,
    input logic [5*REACH-1:0] fall_block_i,
    input logic [5*REACH-1:0] rise_block_i,
    input logic [10*QVAL-1:0] quad_value_i,
    input logic [10*QGRAD-1:0] quad_gx_i,
    input logic [10*QGRAD-1:0] quad_gy_i,
    input logic [10*QCURV-1:0] quad_q_i,
    // Tile out; an end entry has a slot alone
    input logic ring_full_i,
    output logic push_o,
    output logic end_o,
    output logic [SLOT-1:0] slot_o,
    output logic [TC-1:0] tile_x_o,
    output logic [TC-1:0] tile_y_o,
    output logic [6*VAL-1:0] lin_value_o,
    output logic [10*QVAL-1:0] quad_value_o,
    output logic [10*QGRAD-1:0] quad_gx_o,
    output logic [10*QGRAD-1:0] quad_gy_o
);
  localparam int TILE_LOG2 = quadrille_pkg::TILE_LOG2;
  localparam int BLOCK_LOG2 = quadrille_pkg::BLOCK_LOG2;
  localparam int BLOCK_TILES = quadrille_pkg::BLOCK_TILES;
  localparam int TL = TILE_LOG2;  // log2 of a tile step in pixels
  localparam int BL = TILE_LOG2 + BLOCK_LOG2;  // log2 of a block step in pixels

  localparam logic [1:0] IDLE = 2'd0;
  localparam logic [1:0] BLOCK = 2'd1;
  localparam logic [1:0] WALK = 2'd2;
  localparam logic [1:0] FINISH = 2'd3;

  // ---- Position and control -----------------------------------------------------------------------------------------------
  logic [1:0] state_q;
  logic [TC-1:0] tile_x0_q, tile_y0_q, tiles_x_q, tiles_y_q;
  logic [TC-1:0] block_x_q, block_y_q;
  logic block_left_q;
  logic [BLOCK_LOG2-1:0] tile_x_q, tile_y_q;
  logic tile_left_q;
  logic [SLOT-1:0] slot_q;
  logic [3:0] visible_q;

  logic in_block, in_walk;
  logic may_cover, hit;
  logic enter_walk, step_tile, step_block, leave_block;
  logic empty;

  assign take_o = setup_done_i && state_q == IDLE;
  assign empty = tiles_x_i == '0 || tiles_y_i == '0;
  assign in_block = state_q == BLOCK;
  assign in_walk = state_q == WALK;
  assign hit = may_cover || !reject_tiles_i;

  // Ends of rows and columns. The rest of a block row, or 8.
  logic [TC-1:0] rest_x, rest_y, block_last_x, block_last_y;
  logic [BLOCK_LOG2-1:0] tile_last_x, tile_last_y;
  logic tile_row_end, tile_end, block_row_end, block_end;

  assign rest_x = tiles_x_q - TC'(1) - (block_x_q << BLOCK_LOG2);
  assign rest_y = tiles_y_q - TC'(1) - (block_y_q << BLOCK_LOG2);
  assign tile_last_x = (rest_x >= TC'(BLOCK_TILES - 1)) ? '1 : rest_x[BLOCK_LOG2-1:0];
  assign tile_last_y = (rest_y >= TC'(BLOCK_TILES - 1)) ? '1 : rest_y[BLOCK_LOG2-1:0];
  assign block_last_x = (tiles_x_q - TC'(1)) >> BLOCK_LOG2;
  assign block_last_y = (tiles_y_q - TC'(1)) >> BLOCK_LOG2;
  assign tile_row_end = tile_x_q == (tile_left_q ? '0 : tile_last_x);
  assign tile_end = tile_row_end && tile_y_q == tile_last_y;
  assign block_row_end = block_x_q == (block_left_q ? '0 : block_last_x);
  assign block_end = block_row_end && block_y_q == block_last_y;

  assign enter_walk = in_block && hit;
  assign step_tile = in_walk && !(hit && ring_full_i);
  assign leave_block = step_tile && tile_end;
  assign step_block = (in_block && !hit) || leave_block;

  assign end_o = state_q == FINISH;
  assign push_o = ((in_walk && hit) || end_o) && !ring_full_i;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      state_q <= IDLE;
    end else begin
      case (state_q)
        IDLE: if (take_o) state_q <= empty ? FINISH : BLOCK;
        FINISH: if (!ring_full_i) state_q <= IDLE;
        default: begin
          if (enter_walk) state_q <= WALK;
          if (step_block) state_q <= block_end ? FINISH : BLOCK;
        end
      endcase
    end
  end

  always_ff @(posedge clk_i) begin
    if (take_o) begin
      slot_q <= slot_i;
      visible_q <= visible_i;
      tile_x0_q <= tile_x0_i;
      tile_y0_q <= tile_y0_i;
      tiles_x_q <= tiles_x_i;
      tiles_y_q <= tiles_y_i;
      block_x_q <= '0;
      block_y_q <= '0;
      block_left_q <= 1'b0;
    end else if (step_block) begin
      if (block_row_end) begin
        block_y_q <= block_y_q + TC'(1);
        block_left_q <= !block_left_q;
      end else begin
        block_x_q <= block_left_q ? block_x_q - TC'(1) : block_x_q + TC'(1);
      end
    end
    if (enter_walk) begin
      tile_x_q <= '0;
      tile_y_q <= '0;
      tile_left_q <= 1'b0;
    end else if (step_tile) begin
      if (tile_row_end) begin
        tile_y_q <= tile_y_q + BLOCK_LOG2'(1);
        tile_left_q <= !tile_left_q;
      end else begin
        tile_x_q <= tile_left_q ? tile_x_q - BLOCK_LOG2'(1) : tile_x_q + BLOCK_LOG2'(1);
      end
    end
  end

  assign slot_o = slot_q;
  assign tile_x_o = tile_x0_q + (block_x_q << BLOCK_LOG2) + TC'(tile_x_q);
  assign tile_y_o = tile_y0_q + (block_y_q << BLOCK_LOG2) + TC'(tile_y_q);

  // ---- A step: of the block, or of the tile within it -----------------------------------------------------------------------
  // One set of adders does both: the clock that leaves a block moves the block alone, and the tile follows. A step to the left
  // subtracts: ~x, and the one that is missing enters as carry ({a, 1} + {b, carry}).
  logic of_block, row_end, back_x;

  assign of_block = in_block || tile_end;
  assign row_end = of_block ? block_row_end : tile_row_end;
  assign back_x = !row_end && (of_block ? block_left_q : tile_left_q);

  // ---- Linear functions and the extent test -------------------------------------------------------------------------------
  logic [4:0] some_pos, some_neg;

  for (genvar g = 0; g < 6; g++) begin : gen_linear
    logic [GRAD-1:0] gx_q, gy_q;
    logic [VAL-1:0] block_q, tile_q;
    logic [VAL-1:0] slope, move, next;

    assign slope = VAL'($signed(row_end ? gy_q : gx_q));
    assign move = (of_block ? slope << BL : slope << TL) ^ {VAL{back_x}};
    assign next = VAL'(({of_block ? block_q : tile_q, 1'b1} + {move, back_x}) >> 1);

    always_ff @(posedge clk_i) begin
      if (take_o) begin
        gx_q <= lin_gx_i[g*GRAD+:GRAD];
        gy_q <= lin_gy_i[g*GRAD+:GRAD];
      end
      if (take_o || step_block) block_q <= take_o ? lin_value_i[g*VAL+:VAL] : next;
      if (take_o || step_block || step_tile) tile_q <= take_o ? lin_value_i[g*VAL+:VAL] : next;
    end

    assign lin_value_o[g*VAL+:VAL] = tile_q;

    if (g < 5) begin : gen_test
      logic [REACH-1:0] fall_tile_q, fall_block_q, rise_tile_q, rise_block_q;
      logic [VAL-1:0] low, high;

      always_ff @(posedge clk_i) begin
        if (take_o) begin
          fall_tile_q <= fall_tile_i[g*REACH+:REACH];
          fall_block_q <= fall_block_i[g*REACH+:REACH];
          rise_tile_q <= rise_tile_i[g*REACH+:REACH];
          rise_block_q <= rise_block_i[g*REACH+:REACH];
        end
      end

      // Outside WALK the tile is the first of its block.
      assign low = tile_q + VAL'($signed(in_walk ? fall_tile_q : fall_block_q));
      assign high = tile_q + VAL'($signed(in_walk ? rise_tile_q : rise_block_q));
      assign some_neg[g] = low[VAL-1];
      assign some_pos[g] = !high[VAL-1];

      logic unused;
      assign unused = ^{low, high};
    end
  end

  logic back, front;
  logic back1, back2, front1, front2;  // clauses 1 and 2 of either orientation

  assign back1 = some_pos[4] && some_pos[0] && some_pos[1] && (some_pos[2] || some_pos[3]) && visible_q[0];
  assign back2 = some_neg[4] && some_pos[2] && some_pos[3] && (some_pos[0] || some_pos[1]) && visible_q[1];
  assign front1 = some_neg[4] && some_neg[0] && some_neg[1] && (some_neg[2] || some_neg[3]) && visible_q[2];
  assign front2 = some_pos[4] && some_neg[2] && some_neg[3] && (some_neg[0] || some_neg[1]) && visible_q[3];
  assign back = (back1 || back2) && cull_i != 2'd2;
  assign front = (front1 || front2) && cull_i != 2'd1;
  assign may_cover = back || front;

  // ---- Quadratic functions ------------------------------------------------------------------------------------------------
  // Moving by +-h: value +- h gx + h^2 q, gx +- 2h q. With the slope halfway, middle = gx +- h q, that is value +- h middle,
  // middle +- h q.
  for (genvar g = 0; g < 10; g++) begin : gen_quadratic
    logic [QCURV-1:0] curv_q;
    logic [QVAL-1:0] block_value_q, tile_value_q;
    logic [QGRAD-1:0] block_gx_q, block_gy_q, tile_gx_q, tile_gy_q;
    logic [QGRAD-1:0] bend, slope, middle, next_slope;
    logic [QVAL-1:0] rise, move, next_value;

    assign bend = (of_block ? QGRAD'($signed(curv_q)) << BL : QGRAD'($signed(curv_q)) << TL) ^ {QGRAD{back_x}};
    assign slope = of_block ? (row_end ? block_gy_q : block_gx_q) : (row_end ? tile_gy_q : tile_gx_q);
    assign middle = QGRAD'(({slope, 1'b1} + {bend, back_x}) >> 1);
    assign next_slope = QGRAD'(({middle, 1'b1} + {bend, back_x}) >> 1);
    assign rise = QVAL'($signed(middle));
    assign move = (of_block ? rise << BL : rise << TL) ^ {QVAL{back_x}};
    assign next_value = QVAL'(({of_block ? block_value_q : tile_value_q, 1'b1} + {move, back_x}) >> 1);

    always_ff @(posedge clk_i) begin
      if (take_o) curv_q <= quad_q_i[g*QCURV+:QCURV];
      if (take_o || step_block) block_value_q <= take_o ? quad_value_i[g*QVAL+:QVAL] : next_value;
      if (take_o || step_block || step_tile) tile_value_q <= take_o ? quad_value_i[g*QVAL+:QVAL] : next_value;
      if (take_o || (step_block && !row_end)) block_gx_q <= take_o ? quad_gx_i[g*QGRAD+:QGRAD] : next_slope;
      if (take_o || (step_block && row_end)) block_gy_q <= take_o ? quad_gy_i[g*QGRAD+:QGRAD] : next_slope;
      if (in_block || (step_tile && !row_end)) tile_gx_q <= in_block ? block_gx_q : next_slope;
      if (in_block || (step_tile && row_end)) tile_gy_q <= in_block ? block_gy_q : next_slope;
    end

    assign quad_value_o[g*QVAL+:QVAL] = tile_value_q;
    assign quad_gx_o[g*QGRAD+:QGRAD] = tile_gx_q;
    assign quad_gy_o[g*QGRAD+:QGRAD] = tile_gy_q;
  end
endmodule
