`include "quadrille_types.svh"

// Suite `setup`: four vertices and the scissor rectangle in, the `setup` boundary out. One quad at a time, as long as quad_setup takes.
module replay_setup (
    `include "replay_ports.svh"
);
  `include "replay_fields.svh"
  localparam int SLOT = quadrille_pkg::QUAD_SLOTS_LOG2;

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
  logic [quadrille_pkg::JOBS_BITS-1:0] jobs;
  logic [PAIRS*(quadrille_pkg::VAL_BITS+2*quadrille_pkg::GRAD_BITS)-1:0] edges;
  logic [quadrille_pkg::PRODUCTS_BITS-1:0] products;
  logic [quadrille_pkg::SETUP_BITS-1:0] setup_i;
  `QUADRILLE_IN(`QUADRILLE_SETUP_T, setup)
  `QUADRILLE_QUAD_T quad;
  `QUADRILLE_STATE_T state;
  logic drop, jobs_valid;
  logic [SLOT-1:0] drop_slot;
  logic [2:0] events;  // of performance_counters

  always_comb begin
    state = '0;
    state.scissor_x0 = scissor_x0_i;
    state.scissor_y0 = scissor_y0_i;
    state.scissor_x1 = scissor_x1_i;
    state.scissor_y1 = scissor_y1_i;
    quad = '0;
    quad.x = x_i;
    quad.y = y_i;
    quad.w = w_i;
    quad.ordinary = ordinary;
    quad.low_x = low_x;
    quad.high_x = high_x;
    quad.low_y = low_y;
    quad.high_y = high_y;
  end

  quadrille_vertex_products u_products (
      .clk_i,
      .tile_valid_i(1'b0),
      .tile_i(quadrille_pkg::JOBS_BITS'(0)),
      .setup_valid_i(jobs_valid),
      .setup_i(jobs),
      .edges_i(edges),
      .products_o(products)
  );

  quadrille_quad_setup u_setup (
      .clk_i,
      .rst_ni,
      .state_i(state),
      .held_i(valid_i),
      .start_i(valid_i && ready_o),
      .ready_o,
      .slot_i(SLOT'(0)),
      .empty_i(empty_x || empty_y),
      .quad_i(quad),
      .wait_i(1'b0),
      .jobs_valid_o(jobs_valid),
      .jobs_o(jobs),
      .edges_o(edges),
      .products_i(products),
      .take_i(valid_o),
      .valid_o,
      .setup_o(setup_i),
      .drop_o(drop),
      .drop_slot_o(drop_slot),
      .events_o(events)
  );

  // Of the bundle what is of the boundary.
  assign {slot_o, tile_x0_o, tile_y0_o, tiles_x_o, tiles_y_o} = {setup.slot, setup.tile_x0, setup.tile_y0, setup.tiles_x, setup.tiles_y};
  assign {homogeneous_o, hull_o, visible_o} = {setup.homogeneous, setup.hull, setup.visible};
  assign {lin_value_o, lin_gx_o, lin_gy_o, length2_o} = {setup.lin_value, setup.lin_gx, setup.lin_gy, setup.length2};

  logic unused;
  assign unused = ^{drop, drop_slot, events};
endmodule
