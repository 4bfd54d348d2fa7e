`include "quadrille_types.svh"

// Suite `coverage`: one tile entry in, mask, front and tie of its rows out; rows that are not pushed count as zero. The stimulus stands
// for ring and slots, which hold what they were read for while the entry is in work.
module replay_coverage (
    `include "replay_ports.svh"
);
  `include "replay_fields.svh"
  localparam int TILE_LOG2 = quadrille_pkg::TILE_LOG2;
  localparam int TILE = quadrille_pkg::TILE;

  logic [quadrille_pkg::RING_LOG2:0] fetch_ptr, load_ptr;
  logic fetch, load, push;
  logic [quadrille_pkg::STAMP_BITS-1:0] stamp_i;
  `QUADRILLE_IN(`QUADRILLE_STAMP_T, stamp)
  `QUADRILLE_STATE_T state;
  `QUADRILLE_TAG_T tag;
  `QUADRILLE_EDGES_T edges;

  // The slot's tie signs, from the gradients that the vector has.
  localparam int GRAD = quadrille_pkg::GRAD_BITS;
  localparam int REACH = quadrille_pkg::REACH_BITS;
  logic [4:0] tie_pos_i, tie_neg_i;
  logic [5*4*REACH-1:0] unused_reach;

  for (genvar g = 0; g < 5; g++) begin : gen_tie
    quadrille_edge_reach u_reach (
        .gx_i(lin_gx_i[g*GRAD+:GRAD]),
        .gy_i(lin_gy_i[g*GRAD+:GRAD]),
        .gx_zero_i(lin_gx_i[g*GRAD+:GRAD] == '0),
        .gy_zero_i(lin_gy_i[g*GRAD+:GRAD] == '0),
        .tie_pos_o(tie_pos_i[g]),
        .tie_neg_o(tie_neg_i[g]),
        .fall_tile_o(unused_reach[(4*g+0)*REACH+:REACH]),
        .rise_tile_o(unused_reach[(4*g+1)*REACH+:REACH]),
        .fall_block_o(unused_reach[(4*g+2)*REACH+:REACH]),
        .rise_block_o(unused_reach[(4*g+3)*REACH+:REACH])
    );
  end

  logic fetched_q;
  logic [TILE_LOG2+1:0] count_q;  // clocks since the fetch

  logic [3:0] events;  // of performance_counters
  logic [quadrille_pkg::ROWS_BITS-1:0] rows;  // of hidden tiles, which hide nothing here

  always_comb begin
    state = '0;
    state.cull = cull_i;
    state.scissor_x0 = scissor_x0_i;
    state.scissor_y0 = scissor_y0_i;
    state.scissor_x1 = scissor_x1_i;
    state.scissor_y1 = scissor_y1_i;
    tag = '0;
    tag.tile_x = tile_x_i;
    tag.tile_y = tile_y_i;
    tag.last_row = '1;
    edges = '0;
    edges.gx = lin_gx_i;
    edges.gy = lin_gy_i;
    edges.tie_pos = tie_pos_i;
    edges.tie_neg = tie_neg_i;
    edges.visible = visible_i;
  end

  quadrille_stamp_coverage u_coverage (
      .clk_i,
      .rst_ni,
      .state_i(state),
      .present_i(valid_i && !fetched_q),
      .fetch_o(fetch),
      .fetch_ptr_o(fetch_ptr),
      .fetch_homogeneous_i(1'b0),
      .tag_i(tag),
      .load_o(load),
      .load_ptr_o(load_ptr),
      .lin_value_i,
      .edges_i(edges),
      .rows_o(rows),
      .wait_i(1'b0),
      .hidden_i(1'b0),
      .seen_i({TILE{1'b1}}),
      .freed_i(push),
      .push_o(push),
      .stamp_o(stamp_i),
      .events_o(events)
  );

  // The entry stays until the last of its rows has surely gone by: three registers, a clock a row, three registers.
  assign ready_o = count_q == '1;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      fetched_q <= 1'b0;
      count_q <= '0;
      valid_o <= 1'b0;
    end else begin
      if (ready_o) fetched_q <= 1'b0;
      else if (fetch) fetched_q <= 1'b1;
      if (fetched_q) count_q <= count_q + (TILE_LOG2 + 2)'(1);
      valid_o <= valid_i && ready_o;
    end
  end

  for (genvar g = 0; g < TILE; g++) begin : gen_row
    always_ff @(posedge clk_i) begin
      if (push && stamp.row == g) begin
        mask_o[g*TILE+:TILE] <= stamp.mask;
        front_o[g*TILE+:TILE] <= stamp.front;
        tie_o[g*TILE+:TILE] <= stamp.tie;
      end else if (fetch) begin
        mask_o[g*TILE+:TILE] <= '0;
        front_o[g*TILE+:TILE] <= '0;
        tie_o[g*TILE+:TILE] <= '0;
      end
    end
  end

  logic unused;
  assign unused = ^{fetch_ptr, load, load_ptr, events, rows};
endmodule
