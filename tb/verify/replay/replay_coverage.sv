// Suite `coverage`: one tile entry in, mask, front and tie of its rows out; rows that are not pushed count as zero. The stimulus stands
// for ring and slots, which hold what they were read for while the entry is in work.
module replay_coverage (
    `include "replay_ports.svh"
);
  `include "replay_fields.svh"
  localparam int TILE_LOG2 = quadrille_pkg::TILE_LOG2;
  localparam int TILE = quadrille_pkg::TILE;

  logic [quadrille_pkg::RING_LOG2:0] fetch_ptr, load_ptr, stamp_ptr;
  logic fetch, load, push, push_end, push_homogeneous;
  logic [TILE_LOG2-1:0] row;
  logic [TILE-1:0] mask, front, tie;

  // The slot's tie signs, from the gradients that the vector has.
  localparam int GRAD = quadrille_pkg::GRAD_BITS;
  localparam int REACH = quadrille_pkg::REACH_BITS;
  logic [4:0] tie_pos_i, tie_neg_i;
  logic [5*4*REACH-1:0] unused_reach;

  for (genvar g = 0; g < 5; g++) begin : gen_tie
    quadrille_edge_reach u_reach (
        .gx_i(lin_gx_i[g*GRAD+:GRAD]),
        .gy_i(lin_gy_i[g*GRAD+:GRAD]),
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

  logic count_masked, count_row, count_busy, count_behind;  // of performance_counters

  // Of masked_depth, which hides nothing here.
  logic rows_load, issue, rows_done;
  logic [TILE_LOG2-1:0] issue_row;
  logic [TILE-1:0] covered;

  quadrille_stamp_coverage u_coverage (
      .wait_i(1'b0),
      .hidden_i(1'b0),
      .rows_load_o(rows_load),
      .issue_o(issue),
      .rows_done_o(rows_done),
      .issue_row_o(issue_row),
      .covered_o(covered),
      .seen_i({TILE{1'b1}}),
      .present_i(valid_i && !fetched_q),
      .fetch_o(fetch),
      .fetch_ptr_o(fetch_ptr),
      .load_o(load),
      .load_ptr_o(load_ptr),
      .end_i(1'b0),
      .fetch_homogeneous_i(1'b0),
      .homogeneous_i(1'b0),
      .last_row_i({TILE_LOG2{1'b1}}),
      .homogeneous_o(push_homogeneous),
      .freed_i(push),
      .push_o(push),
      .end_o(push_end),
      .stamp_ptr_o(stamp_ptr),
      .row_o(row),
      .mask_o(mask),
      .front_o(front),
      .tie_o(tie),
      .count_masked_o(count_masked),
      .count_row_o(count_row),
      .count_busy_o(count_busy),
      .count_behind_o(count_behind),
      .*
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
      if (push && row == g) begin
        mask_o[g*TILE+:TILE] <= mask;
        front_o[g*TILE+:TILE] <= front;
        tie_o[g*TILE+:TILE] <= tie;
      end else if (fetch) begin
        mask_o[g*TILE+:TILE] <= '0;
        front_o[g*TILE+:TILE] <= '0;
        tie_o[g*TILE+:TILE] <= '0;
      end
    end
  end

  logic unused;
  assign unused = ^{fetch_ptr, load, load_ptr, stamp_ptr, push_end, push_homogeneous, count_masked, count_row, count_busy, count_behind,
      rows_load, issue, rows_done, issue_row, covered};
endmodule
