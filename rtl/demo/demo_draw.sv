// SPDX-License-Identifier: Apache-2.0
// Draws pose after pose of the vertex ROM into two frame buffers of 320x240. One is shown while the other is cleared
// and drawn. They change places at the end of a frame on the screen, when a pose was shown long enough and the next is
// complete. A colour has 3 bits of red and of green, and 2 of blue.
module demo_draw #(
    parameter int POSES = 64, QUADS = 4,  // as poses.py
    parameter int HOLD = 3  // frames on the screen for a pose
) (
    input logic clk_i,
    input logic rst_ni,
    input logic frame_end_i,  // for a clock: the screen's last line was read
    input logic [8:0] x_i,  // place that the screen shows
    input logic [7:0] y_i,
    output logic [7:0] colour_o  // a clock later
);
  localparam int WIDTH = 320, HEIGHT = 240, PIXELS = WIDTH * HEIGHT, PLACE = $clog2(PIXELS);
  localparam int BEATS = POSES * QUADS * 4, BEAT = $clog2(BEATS), VERTEX = quadrille_pkg::VERTEX_BITS;
  localparam int V = quadrille_pkg::VIEWPORT_BITS, DB = quadrille_pkg::DEPTH_BITS;
  localparam int F = quadrille_pkg::ATTRIBUTE_FRAC_BITS, AO = quadrille_pkg::ATTR_OUT_BITS;
  localparam logic [7:0] BACKGROUND = 8'b001_001_01;

  function automatic logic [PLACE-1:0] place(input logic [8:0] x, input logic [7:0] y);
    place = PLACE'({y, 8'd0}) + PLACE'({y, 6'd0}) + PLACE'(x);
  endfunction

  // ---- What is under way -------------------------------------------------------------------------------------------
  typedef enum logic [1:0] {CLEAR, DRAW, READY} step_t;
  step_t step_q;
  logic front_q;  // the buffer that is shown
  logic [7:0] held_q;
  logic [PLACE-1:0] clear_q;
  logic drawn;

  always_ff @(posedge clk_i) begin
    if (frame_end_i && held_q != 8'd0) held_q <= held_q - 8'd1;
    case (step_q)
      CLEAR: begin
        clear_q <= clear_q + PLACE'(1);
        if (clear_q == PLACE'(PIXELS - 1)) begin
          clear_q <= '0;
          step_q <= DRAW;
        end
      end
      DRAW: if (drawn) step_q <= READY;
      default:
      if (frame_end_i && held_q == 8'd0) begin
        front_q <= !front_q;
        held_q <= 8'(HOLD - 1);
        step_q <= CLEAR;
      end
    endcase
    if (!rst_ni) begin
      step_q <= CLEAR;
      front_q <= 1'b0;
      held_q <= 8'd0;
      clear_q <= '0;
    end
  end

  // ---- Vertices: the ROM gives the beats of the port ---------------------------------------------------------------
  logic [VERTEX-1:0] rom[0:BEATS-1];
  initial $readmemh("vertices.hex", rom);
  logic [VERTEX-1:0] vertex_q;
  logic [BEAT-1:0] beat_q, beat;
  logic sent_q, valid_q, ready, taken;  // all beats of the pose are sent; vertex_q is the beat beat_q

  assign taken = valid_q && ready;
  assign beat = !taken ? beat_q : beat_q == BEAT'(BEATS - 1) ? '0 : beat_q + BEAT'(1);

  always_ff @(posedge clk_i) begin
    vertex_q <= rom[beat];
    beat_q <= beat;
    valid_q <= step_q == DRAW && !sent_q && !(taken && beat % BEAT'(4 * QUADS) == '0);
    if (taken && beat % BEAT'(4 * QUADS) == '0) sent_q <= 1'b1;
    if (step_q != DRAW) sent_q <= 1'b0;
    if (!rst_ni) begin
      beat_q <= '0;
      valid_q <= 1'b0;
      sent_q <= 1'b0;
    end
  end

  // ---- The machine -------------------------------------------------------------------------------------------------
  struct packed {
    logic [V:0] scissor_x0, scissor_y0, scissor_x1, scissor_y1;
    logic [1:0] cull;
    logic perspective, depth;
    logic [DB:0] znear, zfar;
    logic [3:0] attributes;
    logic [7:0] skip;
  } state;
  always_comb begin
    state = '0;
    state.scissor_x1 = (V + 1)'(WIDTH);
    state.scissor_y1 = (V + 1)'(HEIGHT);
    state.perspective = 1'b1;
    state.depth = 1'b1;
    state.zfar = {1'b1, {DB{1'b0}}};
    state.attributes = 4'd2;
    state.skip = 8'b00011011;  // all but hidden tiles and plane quads, which this machine does not have
  end

  /* verilator lint_off UNUSEDSIGNAL */
  struct packed {
    logic [quadrille_pkg::QUAD_ID_BITS-1:0] quad;
    logic [V-1:0] x, y;
    logic front;
    logic [7:0] flags;
    logic [DB:0] depth;
    logic [AO-1:0] v, u;
  } fragment;
  /* verilator lint_on UNUSEDSIGNAL */
  logic fragment_valid, busy;
  /* verilator lint_off PINCONNECTEMPTY */
  quadrille u_quadrille (
      .clk_i, .rst_ni, .state_i(state), .clear_hidden_i(1'b0), .flush_i(1'b0), .vertex_i(vertex_q),
      .vertex_valid_i(valid_q), .vertex_ready_o(ready), .fragment_o(fragment), .fragment_mask_o(),
      .fragment_valid_o(fragment_valid), .fragment_ready_i(1'b1), .busy_o(busy), .counter_index_i('0),
      .counter_o()
  );
  /* verilator lint_on PINCONNECTEMPTY */

  // ---- Colour: red is u, green v, in a checker of 8 x 8 ------------------------------------------------------------
  // The highest 3 bits of an attribute below 1; a concave quad gives values beyond its corners', too.
  function automatic logic [2:0] level(input logic [AO-1:0] value);
    level = value[AO-1] ? 3'd0 : |value[AO-2:F] ? 3'd7 : value[F-1-:3];
  endfunction

  logic [2:0] u, v;
  logic [7:0] colour;
  assign u = level(fragment.u);
  assign v = level(fragment.v);
  assign colour = u[0] ^ v[0] ? {u, v, 2'b11} : {1'b0, u[2:1], 1'b0, v[2:1], 2'b01};

  // ---- Depth test: a clock reads the depth, the next compares and writes -------------------------------------------
  // The next fragment may not be at the same place then. It never is: the end of a quad takes a clock of its own.
  logic test_q, pass, write;
  logic [PLACE-1:0] here, place_q, write_place, read_place;
  logic [DB:0] depth_q;
  logic [DB-1:0] stored;
  logic [7:0] colour_q;
  logic [15:0] colours;
  assign here = place(9'(fragment.x), 8'(fragment.y));
  assign pass = test_q && depth_q < {1'b0, stored};
  assign drawn = sent_q && !busy && !test_q;

  always_ff @(posedge clk_i) begin
    test_q <= rst_ni && fragment_valid;
    place_q <= here;
    depth_q <= fragment.depth;
    colour_q <= colour;
`ifndef SYNTHESIS
    assert (!(test_q && fragment_valid && here == place_q)) else $error("two fragments of a place follow each other");
`endif
  end

  assign write = step_q == CLEAR || pass;
  assign write_place = step_q == CLEAR ? clear_q : place_q;
  assign read_place = place(x_i, y_i);
  quadrille_memory #(.WIDTH(DB), .DEPTH(PIXELS), .BLOCK(1)) u_depth (
      .clk_i, .write_i(write), .write_place_i(write_place),
      .write_data_i(step_q == CLEAR ? {DB{1'b1}} : depth_q[DB-1:0]), .read_i(1'b1), .read_place_i(here),
      .clear_i(1'b0), .data_o(stored)
  );
  for (genvar g = 0; g < 2; g++) begin : gen_buffer
    quadrille_memory #(.WIDTH(8), .DEPTH(PIXELS), .BLOCK(1)) u_colour (
        .clk_i, .write_i(write && front_q != 1'(g)), .write_place_i(write_place),
        .write_data_i(step_q == CLEAR ? BACKGROUND : colour_q), .read_i(1'b1), .read_place_i(read_place),
        .clear_i(1'b0), .data_o(colours[8*g+:8])
    );
  end
  assign colour_o = front_q ? colours[15:8] : colours[7:0];
endmodule
