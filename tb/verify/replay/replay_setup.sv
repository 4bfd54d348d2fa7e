// Suite `setup`: four vertices and the scissor rectangle in, the `setup` boundary out. One quad at a time, as long as quad_setup takes.
module replay_setup (
    `include "replay_ports.svh"
);
  `include "replay_fields.svh"
  localparam int SLOT = quadrille_pkg::QUAD_SLOTS_LOG2;

  // What follows from the gradients is not of the boundary: the walk and the coverage show it; the vertices, the tiles' functions.
  logic [4:0] tie_pos_o, tie_neg_o;
  logic [5*quadrille_pkg::REACH_BITS-1:0] fall_tile_o, rise_tile_o, fall_block_o, rise_block_o;
  logic [4*quadrille_pkg::T_BITS-1:0] vertex_x_o, vertex_y_o;
  logic [4*quadrille_pkg::W_BITS-1:0] vertex_w_o;
  logic [quadrille_pkg::TILE_LOG2-1:0] last_row_o;

  // What vertex_assembly finds out beat by beat.
  localparam int T = quadrille_pkg::T_BITS;
  localparam int W = quadrille_pkg::W_BITS;
  localparam int V = quadrille_pkg::VIEWPORT_BITS;
  localparam logic [W-1:0] ONE = W'(1) << quadrille_pkg::FRAC;
  logic ordinary;
  logic [T-1:0] low_x, high_x, low_y, high_y;
  logic empty_x, empty_y;

  always_comb begin
    low_x = x_i[0+:T];
    high_x = x_i[0+:T];
    low_y = y_i[0+:T];
    high_y = y_i[0+:T];
    ordinary = 1'b1;
    for (int i = 0; i < 4; i++) begin
      if ($signed(x_i[i*T+:T]) < $signed(low_x)) low_x = x_i[i*T+:T];
      if ($signed(x_i[i*T+:T]) > $signed(high_x)) high_x = x_i[i*T+:T];
      if ($signed(y_i[i*T+:T]) < $signed(low_y)) low_y = y_i[i*T+:T];
      if ($signed(y_i[i*T+:T]) > $signed(high_y)) high_y = y_i[i*T+:T];
      if (w_i[i*W+:W] != ONE) ordinary = 1'b0;
    end
    empty_x = none(ordinary, low_x, high_x, scissor_x0_i, scissor_x1_i);
    empty_y = none(ordinary, low_y, high_y, scissor_y0_i, scissor_y1_i);
  end

  // No pixel centre between least and greatest coordinate and inside the scissor.
  function automatic logic none(input logic ordinary_quad, input logic [T-1:0] low, input logic [T-1:0] high, input logic [V:0] begin_px,
                                input logic [V:0] end_px);
    localparam int FRAC = quadrille_pkg::FRAC;
    logic [T-1:0] first_px, last_px;

    first_px = $signed(low + T'((1 << FRAC) - 1)) >>> FRAC;
    last_px = $signed(high) >>> FRAC;
    none = begin_px >= end_px || (ordinary_quad && ($signed(first_px) > $signed(last_px) || $signed(first_px) >= $signed(T'(end_px)) ||
                                                    $signed(last_px) < $signed(T'(begin_px))));
  endfunction

  // The multipliers, for the setup alone.
  localparam int PAIRS = quadrille_pkg::PRODUCT_PAIRS;
  logic [PAIRS*3-1:0] job_kind;
  logic [PAIRS*4-1:0] job_function;
  logic [4*T-1:0] job_x, job_y;
  logic [4*W-1:0] job_w;
  logic [PAIRS*quadrille_pkg::VAL_BITS-1:0] edge_value;
  logic [PAIRS*quadrille_pkg::GRAD_BITS-1:0] edge_gx, edge_gy;
  logic [PAIRS*quadrille_pkg::RISE_BITS-1:0] apart_x, apart_y;
  logic [PAIRS*quadrille_pkg::DOT_OUT_BITS-1:0] result0, result1;
  logic [PAIRS*T-1:0] xi, yi, xj, yj;
  logic drop;
  logic [SLOT-1:0] drop_slot;
  logic count_line, count_job, count_busy;  // of performance_counters
  logic [V:0] offset_x, offset_y;

  quadrille_vertex_products u_products (
      .clk_i,
      .tile_valid_i(1'b0),
      .tile_kind_i((PAIRS * 3)'(0)),
      .tile_function_i((PAIRS * 4)'(0)),
      .tile_x_i((4 * T)'(0)),
      .tile_y_i((4 * T)'(0)),
      .tile_w_i((4 * W)'(0)),
      .offset_x_i((V + 1)'(0)),
      .offset_y_i((V + 1)'(0)),
      .setup_offset_x_i(offset_x),
      .setup_offset_y_i(offset_y),
      .setup_kind_i(job_kind),
      .setup_function_i(job_function),
      .setup_x_i(job_x),
      .setup_y_i(job_y),
      .setup_w_i(job_w),
      .edge_value_i(edge_value),
      .edge_gx_i(edge_gx),
      .edge_gy_i(edge_gy),
      .xi_o(xi),
      .yi_o(yi),
      .xj_o(xj),
      .yj_o(yj),
      .apart_x_o(apart_x),
      .apart_y_o(apart_y),
      .result0_o(result0),
      .result1_o(result1)
  );

  quadrille_quad_setup u_setup (
      .wait_i(1'b0),
      .kind_o(job_kind),
      .function_o(job_function),
      .x_o(job_x),
      .y_o(job_y),
      .w_o(job_w),
      .offset_x_o(offset_x),
      .offset_y_o(offset_y),
      .edge_value_o(edge_value),
      .edge_gx_o(edge_gx),
      .edge_gy_o(edge_gy),
      .apart_x_i(apart_x),
      .apart_y_i(apart_y),
      .result0_i(result0),
      .result1_i(result1),
      .ordinary_i(ordinary),
      .low_x_i(low_x),
      .high_x_i(high_x),
      .low_y_i(low_y),
      .high_y_i(high_y),
      .held_i(valid_i),
      .start_i(valid_i && ready_o),
      .ready_o,
      .slot_i(SLOT'(0)),
      .empty_i(empty_x || empty_y),
      .reject_i(1'b0),
      .separate_i(1'b0),
      .cull_i(2'd0),
      .drop_o(drop),
      .drop_slot_o(drop_slot),
      .count_line_o(count_line),
      .count_job_o(count_job),
      .count_busy_o(count_busy),
      .take_i(valid_o),
      .done_o(valid_o),
      .*
  );

  logic unused;
  assign unused = ^{xi, yi, xj, yj, drop, drop_slot, count_line, count_job, count_busy};
endmodule
