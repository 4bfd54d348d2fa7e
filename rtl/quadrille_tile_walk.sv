// SPDX-License-Identifier: Apache-2.0
`include "quadrille_assert.svh"
`include "quadrille_types.svh"
// Walks a quad's tiles, blocks of 8x8 tiles first, both in serpentine order, and pushes the tiles that may hold a
// covered pixel into the tile ring. One step a clock, block or tile; after the last block an end entry.
//
// State is the values of the linear functions at the first pixel of the current block and of the current tile, moved by
// exact forward differences. The test is conservative over the extent: each edge function is 'somewhere positive',
// 'somewhere negative' or both, by its value and edge_reach. The quadratic functions of a tile that is pushed are
// tile_context's.
//
// A homogeneous quad has no bounding box: its tiles begin at the screen's. With bound_i those left of the scissor
// rectangle and above it are left out: the walk approaches the scissor's first block, a block a clock without a test,
// stays in its columns of blocks, and pushes no tile before its first one. The order is that of the whole walk: in rows
// of blocks that go to the left, the approach ends at the right.
//
// The walk steps on before it knows what a test says: the test's signs come in a register, the hit is known the clock
// after, and a tile that is hit is in the register that pushes in the clock after that. Blocks are walked one ahead: a
// hit turns back to the block before, and the next one is ready when its tiles are done. A push that must wait stops
// everything, but the next quad comes in while the end entry waits.
module quadrille_tile_walk #(
    localparam int TC = quadrille_pkg::TC_BITS, SLOT = quadrille_pkg::QUAD_SLOTS_LOG2,
    localparam int TILE_LOG2 = quadrille_pkg::TILE_LOG2
) (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    input logic [quadrille_pkg::STATE_BITS-1:0] state_i,
    // Setup in
    input logic setup_valid_i,
    output logic take_o,
    input logic [quadrille_pkg::SETUP_BITS-1:0] setup_i,
    // Tile out; an end entry has a slot alone
    input logic ready_i,
    output logic push_o, end_o,
    output logic [quadrille_pkg::TILE_BITS-1:0] tile_o,
    // Hidden tiles: what is under test; a clock later whether it is hidden, a tile or a block
    output logic [quadrille_pkg::TEST_BITS-1:0] test_o,
    input logic hidden_i, block_hidden_i,
    // For performance_counters, else 0: a block was tested, its tiles will be, or it is hit and hidden; a tile was
    // tested, or is hit and hidden; a quad is here
    output logic [5:0] events_o
);
  `QUADRILLE_IN(`QUADRILLE_STATE_T, state)
  `QUADRILLE_IN(`QUADRILLE_SETUP_T, setup)
  localparam int BLOCK_LOG2 = quadrille_pkg::BLOCK_LOG2;
  localparam int LINEAR = 6 * quadrille_pkg::VAL_BITS;
  localparam int TL = TILE_LOG2;  // log2 of a tile step in pixels

  // FLUSH: until the end entry is in the ring, or the next quad comes. APPROACH: to the scissor's first block.
  typedef enum logic [2:0] {IDLE, BLOCK, WALK, FINISH, FLUSH, APPROACH} state_t;
  state_t state_q;

  logic [TC-1:0] test_column, test_row, block_column, block_row;
  logic [BLOCK_LOG2-1:0] block_last_column, block_last_row;
  logic covered;
  logic go;  // everything moves
  logic may_cover, hit, hit_tile, enter_walk;

  // ---- Position and control ----------------------------------------------------------------------------------------
  // block_*: the next block to test, while more_q; walk_*: the block whose tiles are tested.
  logic more_q;
  logic [TC-1:0] tile_x0_q, tile_y0_q;
  logic [TC-1:0] last_x_q, last_y_q;  // of the quad's tiles
  // the scissor's first tile, of an ordinary quad 0: its box is inside
  logic [TC-1:0] first_x, first_y, first_x_q, first_y_q;
  logic [TC-1:0] block_x_q, block_y_q, block_y_next;
  logic [TC-1:0] blocks_x_q, blocks_y_q;  // blocks behind it in its row, rows of blocks behind it
  logic block_left_q;
  logic [TC-1:0] walk_x_q, walk_y_q;
  logic [BLOCK_LOG2-1:0] tile_last_x_q, tile_last_y_q, tile_x_q, tile_y_q;
  logic tile_left_q;
  logic [SLOT-1:0] slot_q, slot_q1;
  logic [TILE_LOG2-1:0] last_row_q;
  logic [3:0] visible_q;
  logic empty, in_approach, in_block, in_walk, test_block, step_block, tile_end, block_end, first_column, last_column;
  logic last_row, one_column;
  logic apart;  // the scissor's first block is another than the quad's
  logic arrived;

  // The step after this clock's test: from the end of a row down, or to the left. Known a clock ahead, for it steers
  // the adders.
  logic row_end_q, back_q;
  logic [BLOCK_LOG2-1:0] tiles_q;  // behind the tile in its row

  // The test whose signs are known
  logic block_q1, tile_q1, end_q1;
  logic outside_q1;  // a tile before the scissor's first column or row of tiles
  logic push_q2, end_q2;
  logic [TC-1:0] block_x_q1, block_y_q1, column_q1, row_q1;
  logic [BLOCK_LOG2-1:0] tile_last_x_q1, tile_last_y_q1;

  // The last tile's entry has its functions' vertices when the end entry is where pushes wait.
  assign take_o = setup_valid_i && (state_q == IDLE || (state_q == FLUSH && end_q2));
  assign empty = setup.tiles_x == '0 || setup.tiles_y == '0;
  assign first_x = (state.skip[3] && setup.homogeneous) ? TC'(state.scissor_x0 >> TL) : '0;
  assign first_y = (state.skip[3] && setup.homogeneous) ? TC'(state.scissor_y0 >> TL) : '0;
  assign apart = first_x >> BLOCK_LOG2 != '0 || first_y >> BLOCK_LOG2 != '0;
  assign in_approach = state_q == APPROACH;
  assign in_block = state_q == BLOCK;
  assign in_walk = state_q == WALK;
  assign hit = may_cover || !state.skip[0];
  assign hit_tile = tile_q1 && hit && !outside_q1;
  assign enter_walk = block_q1 && hit && !block_hidden_i;
  assign test_block = in_block && more_q && !enter_walk;
  assign step_block = test_block || (in_approach && !arrived);

  assign tile_end = in_walk && row_end_q && tile_y_q == tile_last_y_q;
  assign block_end = row_end_q && blocks_y_q == '0;
  assign block_y_next = block_y_q + TC'(1);
  assign first_column = block_x_q == first_x_q >> BLOCK_LOG2;
  assign last_column = block_x_q == last_x_q >> BLOCK_LOG2;
  assign last_row = block_y_q == last_y_q >> BLOCK_LOG2;
  assign one_column = first_x_q >> BLOCK_LOG2 == last_x_q >> BLOCK_LOG2;
  // Down first, then to the end of the row at which the whole walk comes to the scissor.
  assign arrived = in_approach && !row_end_q && (block_left_q ? last_column : first_column);

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      state_q <= IDLE;
      block_q1 <= 1'b0;
      tile_q1 <= 1'b0;
      end_q1 <= 1'b0;
    end else begin
      if (take_o) begin
        state_q <= empty ? FINISH : apart ? APPROACH : BLOCK;
      end else if (go) begin
        case (state_q)
          IDLE: state_q <= IDLE;
          APPROACH: if (arrived) state_q <= BLOCK;
          BLOCK: if (enter_walk) state_q <= WALK;
          else if (!more_q) state_q <= FINISH;
          WALK: if (tile_end) state_q <= more_q ? BLOCK : FINISH;
          FINISH: state_q <= FLUSH;
          default: if (end_q2) state_q <= IDLE;
        endcase
      end
      if (go) begin
        block_q1 <= test_block;
        tile_q1 <= in_walk;
        end_q1 <= state_q == FINISH;
      end
    end
  end

  always_ff @(posedge clk_i) begin
    if (take_o) begin
      slot_q <= setup.slot;
      last_row_q <= setup.last_row;
      visible_q <= setup.visible;
      tile_x0_q <= setup.tile_x0;
      tile_y0_q <= setup.tile_y0;
      last_x_q <= setup.tiles_x - TC'(1);
      last_y_q <= setup.tiles_y - TC'(1);
      first_x_q <= first_x;
      first_y_q <= first_y;
      blocks_x_q <= (setup.tiles_x - TC'(1)) >> BLOCK_LOG2;
      blocks_y_q <= (setup.tiles_y - TC'(1)) >> BLOCK_LOG2;
      block_x_q <= '0;
      block_y_q <= '0;
      block_left_q <= 1'b0;
      more_q <= 1'b1;
    end else if (step_block && go) begin
      more_q <= !block_end;
      if (row_end_q) begin
        block_y_q <= block_y_next;
        block_left_q <= !block_left_q;
        blocks_y_q <= blocks_y_q - TC'(1);
      end else begin
        block_x_q <= back_q ? block_x_q - TC'(1) : block_x_q + TC'(1);
      end
      if (row_end_q || in_approach) blocks_x_q <= (last_x_q >> BLOCK_LOG2) - (first_x_q >> BLOCK_LOG2);
      else blocks_x_q <= blocks_x_q - TC'(1);
    end
    if (go) begin
      // Beside the test
      slot_q1 <= slot_q;
      block_x_q1 <= block_x_q;
      block_y_q1 <= block_y_q;
      tile_last_x_q1 <= block_last_column;
      tile_last_y_q1 <= block_last_row;
      outside_q1 <= test_column < first_x_q || test_row < first_y_q;
      column_q1 <= test_column;
      row_q1 <= test_row;
      if (enter_walk) begin
        walk_x_q <= block_x_q1;
        walk_y_q <= block_y_q1;
        tile_last_x_q <= tile_last_x_q1;
        tile_last_y_q <= tile_last_y_q1;
        tile_x_q <= '0;
        tile_y_q <= '0;
        tile_left_q <= 1'b0;
      end else if (in_walk) begin
        if (row_end_q) begin
          tile_y_q <= tile_y_q + BLOCK_LOG2'(1);
          tile_left_q <= !tile_left_q;
        end else begin
          tile_x_q <= tile_left_q ? tile_x_q - BLOCK_LOG2'(1) : tile_x_q + BLOCK_LOG2'(1);
        end
      end
    end
  end

  always_ff @(posedge clk_i) begin
    if (take_o) begin
      row_end_q <= apart ? first_y >> BLOCK_LOG2 != '0 : setup.tiles_x <= TC'(quadrille_pkg::BLOCK_TILES);
      back_q <= 1'b0;
    end else if (go) begin
      if (enter_walk) begin
        tiles_q <= tile_last_x_q1;
        row_end_q <= tile_last_x_q1 == '0;
        back_q <= 1'b0;
      end else if (tile_end) begin
        row_end_q <= blocks_x_q == '0;
        back_q <= block_left_q && blocks_x_q != '0;
      end else if (in_walk && row_end_q) begin
        tiles_q <= tile_last_x_q;
        row_end_q <= tile_last_x_q == '0;
        back_q <= !tile_left_q && tile_last_x_q != '0;
      end else if (in_walk) begin
        tiles_q <= tiles_q - BLOCK_LOG2'(1);
        row_end_q <= tiles_q == BLOCK_LOG2'(1);
        back_q <= tile_left_q && tiles_q != BLOCK_LOG2'(1);
      end else if (arrived) begin
        row_end_q <= one_column;
        back_q <= block_left_q && !one_column;
      end else if (in_approach) begin
        row_end_q <= row_end_q && block_y_next != first_y_q >> BLOCK_LOG2;
      end else if (test_block && row_end_q) begin
        row_end_q <= one_column;
        back_q <= !block_left_q && !one_column;
      end else if (test_block) begin
        row_end_q <= blocks_x_q == TC'(1);
        back_q <= block_left_q && blocks_x_q != TC'(1);
      end
    end
  end

  // ---- Extent test -------------------------------------------------------------------------------------------------
  logic [4:0] some_pos_q1, some_neg_q1;
  logic [quadrille_pkg::TILE_BITS-LINEAR-1:0] place_q;  // of the tile: all but its functions
  logic [LINEAR-1:0] tile_lin_value;
  assign tile_o = {place_q, tile_lin_value};
  quadrille_walk_values u_values (
      .clk_i, .take_i(take_o), .setup_i, .go_i(go), .in_walk_i(in_walk), .step_block_i(step_block),
      .enter_walk_i(enter_walk), .tile_end_i(tile_end), .row_end_i(row_end_q), .back_i(back_q),
      .some_pos_o(some_pos_q1), .some_neg_o(some_neg_q1), .lin_value_o(tile_lin_value)
  );

  logic back, front;
  quadrille_inside_expression u_inside (
      .cull_i(state.cull), .visible_i(visible_q), .pos_i(some_pos_q1), .neg_i(some_neg_q1), .back_o(back),
      .front_o(front)
  );

  assign may_cover = back || front;

  // ---- Push --------------------------------------------------------------------------------------------------------
  always_ff @(posedge clk_i) begin
    if (!rst_ni) {push_q2, end_q2} <= '0;
    else if (go) {push_q2, end_q2} <= {(hit_tile && !hidden_i) || end_q1, end_q1};
  end

  always_ff @(posedge clk_i) begin
    if (go) place_q <= {slot_q1, tile_x0_q + column_q1, tile_y0_q + row_q1, column_q1,
          row_q1, (row_q1 == last_y_q) ? last_row_q : {TILE_LOG2{1'b1}}};
  end

  assign events_o = {6{quadrille_pkg::PERFORMANCE_COUNTERS != 0}} & {
    block_q1 && go,
    enter_walk && go,
    go && block_q1 && hit && block_hidden_i,
    tile_q1 && go,
    go && hit_tile && hidden_i,
    state_q != IDLE
  };

  assign test_o = {go, test_column, test_row, test_block && go, block_column, block_row, block_last_column,
      block_last_row, tile_q1, covered};
  assign test_column = (walk_x_q << BLOCK_LOG2) | TC'(tile_x_q);
  assign test_row = (walk_y_q << BLOCK_LOG2) | TC'(tile_y_q);
  assign block_column = block_x_q << BLOCK_LOG2;
  assign block_row = block_y_q << BLOCK_LOG2;
  assign block_last_column = last_column ? last_x_q[BLOCK_LOG2-1:0] : BLOCK_LOG2'(quadrille_pkg::BLOCK_TILES - 1);
  assign block_last_row = last_row ? last_y_q[BLOCK_LOG2-1:0] : BLOCK_LOG2'(quadrille_pkg::BLOCK_TILES - 1);

  if (quadrille_pkg::HIERARCHICAL_Z_BITS != 0) begin : gen_covered
    quadrille_covered_square u_covered (
        .cull_i(state.cull), .some_pos_i(some_pos_q1), .some_neg_i(some_neg_q1), .covered_o(covered)
    );
  end else begin : gen_not_covered
    assign covered = 1'b0;
  end

  assign go = !push_q2 || ready_i;
  assign push_o = push_q2 && ready_i;
  assign end_o = end_q2;

`ifndef SYNTHESIS
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      `QUADRILLE_ASSERT(assert_take_after_push, !take_o || !push_q2 || end_q2, "take does not overtake a tile")
      `QUADRILLE_ASSERT(assert_enter_from_block, !enter_walk || in_block, "a walk is entered from a block")
      `QUADRILLE_ASSERT(assert_step_direction,
          !test_block || row_end_q || back_q == block_left_q,
          "a block step goes in the row's direction")
      `QUADRILLE_ASSERT(assert_inside_first,
          !test_block || (block_x_q >= first_x_q >> BLOCK_LOG2 && block_y_q >= first_y_q >> BLOCK_LOG2),
          "a block tested is not before the first one")
    end
  end
`endif
endmodule
