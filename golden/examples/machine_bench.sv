// The whole machine on your quads: a bench to copy. Any configuration; its structs are the ports, field by field.
//
//     quadrille golden generate --quads F.quads --size 64x64 --out DIR      then run this with +files=DIR/input/
//
// It offers the beats of stimulus.hex, prints the first fragments field by field, and compares all with response.hex. +stall lowers
// fragment_ready in every other clock. +files=BEGIN: what the names of its files begin with.
module machine_bench;
  localparam int S = quadrille_pkg::SIGNIFICAND_BITS;
  localparam int PE = quadrille_pkg::PORT_EXP_BITS;
  localparam int N = quadrille_pkg::ATTRIBUTE_SLOTS;
  localparam int AO = quadrille_pkg::ATTR_OUT_BITS;
  localparam int V = quadrille_pkg::VIEWPORT_BITS;
  localparam int DB = quadrille_pkg::DEPTH_BITS;
  localparam int FRAC = quadrille_pkg::ATTRIBUTE_FRAC_BITS;
  localparam int LANES = quadrille_pkg::PIXELS_PER_CLOCK;
  localparam int LANE = quadrille_pkg::FRAGMENT_BITS;

  // ---- The ports as structs: README.md of rtl/ has units and meanings -------------------------------------------------------
  typedef struct packed {
    logic [V:0] scissor_x0, scissor_y0, scissor_x1, scissor_y1;
    logic [1:0] cull;
    logic perspective, depth;
    logic [DB:0] znear, zfar;
    logic [3:0] attributes;
    logic [7:0] skip;
  } state_t;

  typedef struct packed {
    logic [quadrille_pkg::QUAD_ID_BITS-1:0] id;
    logic signed [quadrille_pkg::T_BITS-1:0] x, y;
    logic signed [quadrille_pkg::W_BITS-1:0] w;
    logic signed [PE-1:0] k_exp;
    logic [S-1:0] k_sig;
    logic z_neg;
    logic signed [PE-1:0] z_exp;
    logic [S-1:0] z_sig;
    logic [N-1:0] attr_neg;
    logic [N*PE-1:0] attr_exp;
    logic [N*S-1:0] attr_sig;
    logic [N*AO-1:0] base_attr;
    logic [DB:0] base_depth;
    logic signed [DB+1:0] depth_low, depth_high;
  } vertex_t;

  typedef struct packed {
    logic [quadrille_pkg::QUAD_ID_BITS-1:0] quad;
    logic [V-1:0] x, y;
    logic front;
    logic [7:0] flags;
    logic [DB:0] depth;
    logic [N*AO-1:0] attr;
  } fragment_t;

  // ---- The machine -----------------------------------------------------------------------------------------------------------
  logic clk = 1'b0, rst_n = 1'b0;
  state_t state;
  vertex_t vertex;
  logic vertex_valid = 1'b0, fragment_ready = 1'b1;
  logic vertex_ready, fragment_valid, busy;
  logic [LANES*LANE-1:0] fragments;
  logic [LANES-1:0] mask;

  // Without $finish, so that benches of several machines run beside each other.
  logic done = 1'b0;
  initial while (!done) #1 clk = !clk;

  quadrille u_quadrille (
      .clk_i(clk),
      .rst_ni(rst_n),
      .state_i(state),
      .clear_hidden_i(1'b0),
      .flush_i(1'b0),
      .vertex_i(vertex),
      .vertex_valid_i(vertex_valid),
      .vertex_ready_o(vertex_ready),
      .fragment_o(fragments),
      .fragment_mask_o(mask),
      .fragment_valid_o(fragment_valid),
      .fragment_ready_i(fragment_ready),
      .busy_o(busy),
      .counter_index_i('0),
      .counter_o()
  );

  // ---- Files: records of golden/vectors/README.md ------------------------------------------------------------------------------
  string files;
  int states, beats, responses, count = 0, differences = 0;
  logic [16+quadrille_pkg::VERTEX_BITS-1:0] beat;  // {draw, vertex_t}
  logic [80+LANE-1:0] response;  // {draw, clock, clock with stalls, fragment_t}
  fragment_t fragment, expected;
  logic [LANE-1:0] all_expected[$];

  function automatic int open(input string name);
    open = $fopen(name, "r");
    if (open == 0) $fatal(1, "%s: cannot be read", name);
  endfunction

  // Inputs change at the falling edge; what both sides show there is transferred at the next rising one.
  initial begin
    if ($bits(state) != quadrille_pkg::STATE_BITS || $bits(vertex) != quadrille_pkg::VERTEX_BITS || $bits(fragment) != LANE)
      $fatal(1, "the structs are not the ports");
    if (!$value$plusargs("files=%s", files)) files = "quadrille_";
    states = open({files, "states.hex"});
    beats = open({files, "stimulus.hex"});
    responses = open({files, "response.hex"});
    while ($fscanf(responses, "%h", response) == 1) all_expected.push_back(response[LANE-1:0]);
    if ($fscanf(states, "%h", state) != 1) $fatal(1, "no draw state");
    repeat (4) @(negedge clk);
    rst_n = 1'b1;
    @(negedge clk);
    while ($fscanf(beats, "%h", beat) == 1) begin
      vertex = beat[quadrille_pkg::VERTEX_BITS-1:0];
      vertex_valid = 1'b1;
      while (!vertex_ready) @(negedge clk);
      @(negedge clk);
    end
    vertex_valid = 1'b0;
    while (busy || fragment_valid) @(negedge clk);
    $display("%m: %0d fragments, %0d missing, %0d differences", count, all_expected.size(), differences);
    if (count == 0 || all_expected.size() != 0 || differences != 0) $fatal(1, "failed");
    done = 1'b1;
  end

  always @(negedge clk) begin
    fragment_ready = $test$plusargs("stall") == 0 || !fragment_ready;
    if (fragment_valid && fragment_ready) begin
      for (int lane = 0; lane < LANES; lane++) begin
        if (mask[lane]) begin
          fragment = fragments[lane*LANE+:LANE];
          if (all_expected.size() == 0) $fatal(1, "more fragments than response.hex has");
          expected = all_expected.pop_front();
          if (fragment !== expected) differences = differences + 1;
          if (count < 3 || (fragment !== expected && differences <= 3))
            $display("quad %0d at (%0d, %0d): %0s, front %b, depth %f, attribute 0 %f", fragment.quad, fragment.x, fragment.y,
                     fragment === expected ? "agrees" : "differs", fragment.front, $itor(fragment.depth) / (1 << DB),
                     $itor($signed(fragment.attr[AO-1:0])) / (1 << FRAC));
          count = count + 1;
        end
      end
    end
  end
endmodule
