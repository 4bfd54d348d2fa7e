// The clocked model beside the RTL: every output of every clock is compared, with gaps and stalls. +quads=FILE; output as of untimed.cpp.
module lockstep;
  import quadrille_machine_pkg::*;

  typedef struct packed {
    bit [23:0] quad;
    bit [11:0] x, y;
    bit front;
    bit [7:0] flags;
    bit [24:0] depth;
    bit [3:0][31:0] attribute;
  } fragment_t;  // the default configuration

  bit clk, rst_n, vertex_valid, taken, fragment_ready, clear, flush;
  vertex_port_t beats[$];
  wire vertex_ready, fragment_valid, busy, fragment_mask;
  wire fragment_t fragment;
  wire [quadrille_pkg::COUNTER_BITS-1:0] counter;
  // scissor 0,0,64,64; cull none; perspective; depth, from 0 to 1; four attributes; skip
  wire [quadrille_pkg::STATE_BITS-1:0] state = {13'd0, 13'd0, 13'd64, 13'd64, 2'd0, 1'b1, 1'b1, 25'd0, 25'h1000000, 4'd4, 8'h1b};
  vertex_port_t vertex;
  quadrille rtl (.clk_i(clk), .rst_ni(rst_n), .state_i(state), .clear_hidden_i(clear), .flush_i(flush), .vertex_i(vertex[quadrille_pkg::VERTEX_BITS-1:0]),
      .vertex_valid_i(vertex_valid), .vertex_ready_o(vertex_ready), .fragment_o(fragment), .fragment_mask_o(fragment_mask),
      .fragment_valid_o(fragment_valid), .fragment_ready_i(fragment_ready), .busy_o(busy), .counter_index_i('0), .counter_o(counter));

  function automatic void check(int status);
    if (status != OK) $fatal(1, "%s", quadrille_last_error());
  endfunction

  chandle model;
  initial begin
    string name;
    real positions[4][4], attributes[4][8];
    vertex_port_t quad[4];
    int file, id;
    check(quadrille_clocked_create("", model));
    check(quadrille_clocked_state_port(model, state_port_t'(state)));
    if ($value$plusargs("quads=%s", name) == 0) $fatal(1, "+quads=FILE is missing");
    file = $fopen(name, "r");
    for (id = 0; $fscanf(file, "%f", positions[0][0]) == 1; id++) begin
      for (int i = 1; i < 16; i++) void'($fscanf(file, "%f", positions[i/4][i%4]));
      for (int i = 0; i < 16; i++) void'($fscanf(file, "%f", attributes[i/4][i%4]));
      check(quadrille_quad_port(model, id, positions, attributes, quad));
      for (int i = 0; i < 4; i++) beats.push_back(quad[i]);
    end
    forever #1 clk = !clk;
  end

  int cycle, ready, valid, working, mask;
  fragment_port_t expected;
  always @(negedge clk) begin
    if (taken) void'(beats.pop_front());
    check(quadrille_clocked_output_ports(model, ready, valid, working, mask, expected));
    if (rst_n && {vertex_ready, fragment_valid, busy} != {ready[0], valid[0], working[0]}) $fatal(1, "clock %0d: ready, valid or busy", cycle);
    if (rst_n && fragment_valid && (!fragment_mask || fragment != fragment_t'(expected)))
      $fatal(1, "clock %0d: fragment %h, expected %h", cycle, fragment, fragment_t'(expected));
    if (beats.size() == 0 && busy == 0 && rst_n) begin
      $display("# %0d clocks alike", cycle);
      $finish;
    end
    // What both get at the next rising edge. A beat that was not taken stays on offer. Clears while busy and flushes between quads change
    // nothing.
    rst_n = cycle >= 2;
    vertex_valid = rst_n && beats.size() != 0 && ((vertex_valid && !taken) || $urandom_range(3) != 0);
    taken = vertex_valid && ready != 0;
    if (vertex_valid) vertex = beats[0];
    fragment_ready = $urandom_range(2) != 0;
    clear = working != 0 && $urandom_range(7) == 0;
    flush = beats.size() % 4 == 0 && !vertex_valid && $urandom_range(1) == 0;
    if (rst_n && fragment_valid && fragment_ready)
      $display("%0d %0d %0d %0d %0d %0d %0d %0d %0d %0d", fragment.quad, fragment.x, fragment.y, fragment.front, fragment.flags, fragment.depth,
               $signed(fragment.attribute[0]), $signed(fragment.attribute[1]), $signed(fragment.attribute[2]), $signed(fragment.attribute[3]));
    check(quadrille_clocked_flush_port(model, int'(flush)));
    check(quadrille_clocked_clock_ports(model, int'(!rst_n), int'(clear), int'(vertex_valid), vertex, int'(fragment_ready)));
    cycle++;
  end
endmodule
