// Self-checking bench of the whole machine: plays the draws of a set twice, without stalls and with the stall pattern, and compares
// every bit of every fragment, their order and number (lane 0 of a clock first), the clock in which each is handed over, the clock in which
// each vertex beat is taken, and that the machine becomes idle.
//
// Macros: REPLAY_STATE_BITS, REPLAY_VERTEX_BITS, REPLAY_FRAGMENT_BITS (of a lane), REPLAY_LANES of the fragment port, and the most lines of each file REPLAY_DRAWS, REPLAY_BEATS,
// REPLAY_FRAGMENTS, REPLAY_STALLS. Plusargs: +suite=NAME, +states= +stimulus= +taken= +response= +stalls=FILE, +draws= +beats= +fragments=
// +pattern=N (lines of these files). A draw begins when the machine is not busy; clock 0 is the first clock in which its first beat
// may be offered. Every draw begins with nothing hidden: where the machine hides tiles, they are cleared between two draws. Prints the first difference and "NAME: N vectors, M mismatches"; ends with $fatal unless M = 0.
`timescale 1ns / 1ns
module replay_machine;
  localparam int STATE = `REPLAY_STATE_BITS;
  localparam int VERTEX = `REPLAY_VERTEX_BITS;
  localparam int FRAGMENT = `REPLAY_FRAGMENT_BITS;
  localparam int LANES = `REPLAY_LANES;
  localparam logic HIDES = quadrille_pkg::HIERARCHICAL_Z_BITS != 0;
  localparam int SILENCE = 2000000;  // clocks in which nothing moves before the run is given up: more than the longest walk

  string suite, states_file, stimulus_file, response_file, stalls_file, taken_file;
  int draws, beats, fragments, pattern;
  logic [STATE-1:0] states[0:`REPLAY_DRAWS-1];
  logic [16+VERTEX-1:0] stimuli[0:`REPLAY_BEATS-1];  // {draw, vertex}
  logic [79:0] taken[0:`REPLAY_BEATS-1];  // {draw, clock, clock_stalled}
  logic [80+FRAGMENT-1:0] responses[0:`REPLAY_FRAGMENTS-1];  // {draw, clock, clock_stalled, fragment}
  logic [1:0] stalls[0:`REPLAY_STALLS-1];  // {offer, ready}

  logic clk = 1'b0;
  logic rst_n = 1'b0;

  always #5 clk = !clk;

  initial begin
    if (!$value$plusargs("suite=%s", suite)) $fatal(1, "+suite=NAME is missing");
    if (!$value$plusargs("states=%s", states_file)) $fatal(1, "+states=FILE is missing");
    if (!$value$plusargs("stimulus=%s", stimulus_file)) $fatal(1, "+stimulus=FILE is missing");
    if (!$value$plusargs("taken=%s", taken_file)) $fatal(1, "+taken=FILE is missing");
    if (!$value$plusargs("response=%s", response_file)) $fatal(1, "+response=FILE is missing");
    if (!$value$plusargs("stalls=%s", stalls_file)) $fatal(1, "+stalls=FILE is missing");
    if (!$value$plusargs("draws=%d", draws)) $fatal(1, "+draws=N is missing");
    if (!$value$plusargs("beats=%d", beats)) $fatal(1, "+beats=N is missing");
    if (!$value$plusargs("fragments=%d", fragments)) $fatal(1, "+fragments=N is missing");
    if (!$value$plusargs("pattern=%d", pattern)) $fatal(1, "+pattern=N is missing");
    if (draws < 1 || beats < 1 || fragments < 1 || pattern < 1) $fatal(1, "%s: no vectors", suite);
    if (draws > `REPLAY_DRAWS || beats > `REPLAY_BEATS || fragments > `REPLAY_FRAGMENTS || pattern > `REPLAY_STALLS)
      $fatal(1, "%s: more lines than this bench was built for", suite);
    $readmemh(states_file, states, 0, draws - 1);
    $readmemh(stimulus_file, stimuli, 0, beats - 1);
    $readmemh(taken_file, taken, 0, beats - 1);
    $readmemh(response_file, responses, 0, fragments - 1);
    $readmemh(stalls_file, stalls, 0, pattern - 1);
    repeat (4) @(posedge clk);
    rst_n <= 1'b1;
  end

  // ---- Drivers -------------------------------------------------------------------------------------------------------------
  logic stalled = 1'b0;  // the second pass
  logic running = 1'b0;  // a draw; otherwise its state is being set, and what is hidden wiped
  logic clear = 1'b0;
  int draw = 0;
  int beat = 0;
  int number = 0;  // fragment
  int cycle = 0;  // of the draw
  int phase = 0;  // line of the stall pattern
  logic held = 1'b0;  // a beat was offered and not taken

  logic [16+VERTEX-1:0] stimulus;
  logic [1:0] allowed;
  logic offering, vertex_valid, vertex_ready, fragment_valid, fragment_ready, busy;
  logic [LANES-1:0] fragment_mask;
  logic [STATE-1:0] state;
  logic [VERTEX-1:0] vertex;
  logic [LANES*FRAGMENT-1:0] fragments_out;

  assign stimulus = stimuli[beat];
  assign state = states[draw];
  assign allowed = stalled ? stalls[phase] : 2'b11;
  assign offering = beat < beats && stimulus[VERTEX+:16] == draw[15:0];
  assign vertex_valid = rst_n && running && offering && (held || allowed[1]);
  assign vertex = vertex_valid ? stimulus[VERTEX-1:0] : {VERTEX{1'b1}};  // rubbish while not valid
  assign fragment_ready = !running || allowed[0];

  quadrille u_dut (
      .clk_i(clk),
      .rst_ni(rst_n),
      .state_i(state),
      .clear_hidden_i(clear),
      .flush_i(1'b0),
      .vertex_i(vertex),
      .vertex_valid_i(vertex_valid),
      .vertex_ready_o(vertex_ready),
      .fragment_o(fragments_out),
      .fragment_mask_o(fragment_mask),
      .fragment_valid_o(fragment_valid),
      .fragment_ready_i(fragment_ready),
      .busy_o(busy),
      .counter_index_i(6'd0),
      .counter_o()
  );

  // ---- Comparison ----------------------------------------------------------------------------------------------------------
  logic [80+FRAGMENT-1:0] response;
  logic [FRAGMENT-1:0] fragment;
  int next;  // fragment: `number` and the lanes of this clock that were looked at
  logic [31:0] expected_cycle, expected_taken;
  logic expected_here;  // the next response belongs to this draw
  string how = "";  // the pass, in messages
  int mismatches = 0;
  int silence = 0;
  longint clocks = 0;  // of a pass

  assign expected_taken = stalled ? taken[beat][31:0] : taken[beat][63:32];
  assign expected_here = number < fragments && responses[number][FRAGMENT+64+:16] == draw[15:0];

  // Blocking, as nothing else reads `mismatches`; neither does anything else read `next` and what is set in the loop over the lanes.
  task automatic mismatch(input string what);
    begin
      if (mismatches == 0)
        $display("%s: first difference in line %0d, draw %0d, clock %0d%s: %s", suite, next + 1, draw, cycle, how, what);
      mismatches = mismatches + 1;
    end
  endtask

  always @(posedge clk) begin
    if (rst_n && !running) begin
      clear <= 1'b0;
      silence <= silence + 1;
      if (busy !== 1'b0 && (!HIDES || busy !== 1'b1 || silence > SILENCE)) $fatal(1, "%s: busy before draw %0d", suite, draw);
      if (busy === 1'b0 && !clear) begin
        running <= 1'b1;
        cycle <= 0;
        phase <= 0;
        silence <= 0;
      end
    end else if (rst_n) begin
      next = number;
      cycle <= cycle + 1;
      clocks <= clocks + 1;
      phase <= (phase == pattern - 1) ? 0 : phase + 1;
      held <= vertex_valid && !vertex_ready;
      if (vertex_valid && vertex_ready) begin
        if (taken[beat][79:64] !== draw[15:0] || expected_taken !== cycle) begin
          if (mismatches == 0)
            $display("%s: first difference in line %0d of the beats, draw %0d%s: expected clock %0d actual clock %0d", suite, beat + 1, draw,
                     how, expected_taken, cycle);
          mismatches = mismatches + 1;
        end
        beat <= beat + 1;
      end
      silence <= ((vertex_valid && vertex_ready) || (fragment_valid && fragment_ready)) ? 0 : silence + 1;
      if (silence > SILENCE) $fatal(1, "%s: nothing moves in draw %0d", suite, draw);
      if (fragment_valid !== 1'b0 && fragment_valid !== 1'b1) mismatch("fragment_valid_o is not 0 or 1");
      if (|fragment_mask !== fragment_valid) mismatch("fragment_mask_o is not that of fragment_valid_o");
      for (int lane = 0; lane < LANES; lane = lane + 1) begin
        fragment = fragments_out[lane*FRAGMENT+:FRAGMENT];
        response = responses[next];
        expected_cycle = stalled ? response[FRAGMENT+:32] : response[FRAGMENT+32+:32];
        if (fragment_mask[lane] !== 1'b1) begin
          if (fragment !== {FRAGMENT{1'b0}}) mismatch("fragment_o is not zero in a lane without a fragment");
        end else if (fragment_ready) begin
          if (next >= fragments || response[FRAGMENT+64+:16] != draw[15:0]) begin
            mismatch("a fragment too many");
          end else begin
            if (fragment !== response[FRAGMENT-1:0]) begin
              if (mismatches == 0) $display("%s: expected %h actual %h", suite, response[FRAGMENT-1:0], fragment);
              mismatch("fragment");
            end else if (expected_cycle != cycle) begin
              if (mismatches == 0) $display("%s: expected clock %0d actual clock %0d", suite, expected_cycle, cycle);
              mismatch("clock");
            end
            next = next + 1;
          end
        end
      end
      number <= next;
      if (!offering && busy === 1'b0) begin
        if (expected_here) $fatal(1, "%s: idle after draw %0d without the fragment of line %0d", suite, draw, number + 1);
        if (vertex_ready !== 1'b1) mismatch("idle, but no beat is taken");
        running <= 1'b0;
        clear <= HIDES;
        silence <= 0;
        if (draw < draws - 1) begin
          draw <= draw + 1;
        end else begin
          $display("%s: %0d clocks%s", suite, clocks, how);
          if (beat != beats) $fatal(1, "%s: line %0d of the stimulus belongs to no draw", suite, beat + 1);
          if (number != fragments) $fatal(1, "%s: line %0d of the response belongs to no draw", suite, number + 1);
          if (stalled) begin
            $display("%s: %0d vectors, %0d mismatches", suite, number, mismatches);
            if (mismatches != 0) $fatal(1, "%s: failed", suite);
            $finish;
          end
          how = " with stalls";
          stalled <= 1'b1;
          draw <= 0;
          beat <= 0;
          number <= 0;
          clocks <= 0;
        end
      end
    end
  end
endmodule
