// Suite `setup`: four vertices and the scissor rectangle in, the `setup` boundary out. One quad at a time, as long as quad_setup takes.
module replay_setup (
    `include "replay_ports.svh"
);
  `include "replay_fields.svh"
  localparam int SLOT = quadrille_pkg::QUAD_SLOTS_LOG2;

  // What follows from the gradients is not of the boundary: the walk and the coverage show it.
  logic [4:0] tie_pos_o, tie_neg_o;
  logic [5*quadrille_pkg::REACH_BITS-1:0] fall_tile_o, rise_tile_o, fall_block_o, rise_block_o;

  // What vertex_assembly finds out beat by beat.
  localparam int T = quadrille_pkg::T_BITS;
  localparam int W = quadrille_pkg::W_BITS;
  localparam logic [W-1:0] ONE = W'(1) << quadrille_pkg::FRAC;
  logic ordinary;
  logic [T-1:0] low_x, high_x, low_y, high_y;

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
  end

  quad_setup u_setup (
      .ordinary_i(ordinary),
      .low_x_i(low_x),
      .high_x_i(high_x),
      .low_y_i(low_y),
      .high_y_i(high_y),
      .start_i(valid_i && ready_o),
      .slot_i(SLOT'(0)),
      .idle_o(ready_o),
      .take_i(valid_o),
      .done_o(valid_o),
      .*
  );
endmodule
