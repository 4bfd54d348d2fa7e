// Self-checking bench of a stage: feeds a vector in each clock in which the wrapper is ready, compares every response bit by bit, in order.
//
// Knows nothing of the machine. Macros: REPLAY_DUT (the wrapper), REPLAY_STIMULUS_BITS, REPLAY_RESPONSE_BITS, REPLAY_VECTORS (the most
// vectors it can hold). Plusargs: +suite=NAME +stimulus=FILE +response=FILE +vectors=N, and +latency=N for a stage whose response i
// must come N clocks after stimulus i. Prints the first difference and "NAME: N vectors, M mismatches"; ends with $fatal unless M = 0.
// With +record=FILE the responses go into that file, a line each, and any M will do.
`timescale 1ns / 1ns
module replay_stage;
  localparam int STIMULUS_BITS = `REPLAY_STIMULUS_BITS;
  localparam int RESPONSE_BITS = `REPLAY_RESPONSE_BITS;
  localparam int CAPACITY = `REPLAY_VECTORS;
  localparam int SILENCE = 10000;  // clocks without a response before the run is given up
  localparam int DRAIN = 100;  // clocks after the last response in which no other may follow

  string suite, stimulus_file, response_file, record_file;
  int vectors, latency;
  int record = 0;  // its file
  logic [STIMULUS_BITS-1:0] stimuli[0:CAPACITY-1];
  logic [RESPONSE_BITS-1:0] responses[0:CAPACITY-1];

  logic clk = 1'b0;
  logic rst_n = 1'b0;

  always #5 clk = !clk;

  initial begin
    latency = 0;
    if (!$value$plusargs("suite=%s", suite)) $fatal(1, "+suite=NAME is missing");
    if (!$value$plusargs("stimulus=%s", stimulus_file)) $fatal(1, "+stimulus=FILE is missing");
    if (!$value$plusargs("response=%s", response_file)) $fatal(1, "+response=FILE is missing");
    if (!$value$plusargs("vectors=%d", vectors)) $fatal(1, "+vectors=N is missing");
    if (!$value$plusargs("latency=%d", latency)) latency = 0;
    if ($value$plusargs("record=%s", record_file)) begin
      record = $fopen(record_file, "w");
      if (record == 0) $fatal(1, "%s: cannot be written", record_file);
    end
    if (vectors < 1) $fatal(1, "%s: no vectors", suite);
    if (vectors > CAPACITY) $fatal(1, "%s: more vectors than REPLAY_VECTORS", suite);
    $readmemh(stimulus_file, stimuli, 0, vectors - 1);
    $readmemh(response_file, responses, 0, vectors - 1);
    repeat (4) @(posedge clk);
    rst_n <= 1'b1;
  end

  // ---- Device under test ---------------------------------------------------------------------------------------------------
  int sent = 0;
  logic valid, ready, response_valid;
  logic [STIMULUS_BITS-1:0] stimulus;
  logic [RESPONSE_BITS-1:0] response, expected;

  assign valid = rst_n && sent < vectors;
  assign stimulus = stimuli[sent];

  `REPLAY_DUT u_dut (
      .clk_i(clk),
      .rst_ni(rst_n),
      .valid_i(valid),
      .ready_o(ready),
      .stimulus_i(stimulus),
      .valid_o(response_valid),
      .response_o(response)
  );

  // ---- Comparison ----------------------------------------------------------------------------------------------------------
  int received = 0;
  int mismatches = 0;
  int cycle = 0;
  int silence = 0;

  assign expected = responses[received];

  always @(posedge clk) begin
    if (rst_n) begin
      cycle <= cycle + 1;
      silence <= response_valid ? 0 : silence + 1;
      if (valid && ready) sent <= sent + 1;
      if (response_valid !== 1'b0 && response_valid !== 1'b1) $fatal(1, "%s: valid_o is not 0 or 1 in clock %0d", suite, cycle);
      if (response_valid === 1'b1) begin
        if (received >= sent) $fatal(1, "%s: a response without a stimulus in clock %0d", suite, cycle);
        if (latency != 0 && cycle != received + latency)
          $fatal(1, "%s: response %0d came in clock %0d, not %0d", suite, received + 1, cycle, received + latency);
        if (^expected === 1'bx) $fatal(1, "%s: line %0d of the response is missing or no number", suite, received + 1);
        if (response !== expected) begin
          if (mismatches == 0)
            $display("%s: first difference in line %0d: stimulus %h expected %h actual %h", suite, received + 1, stimuli[received],
                     expected, response);
          mismatches <= mismatches + 1;
        end
        if (record != 0) $fdisplay(record, "%h", response);
        received <= received + 1;
      end
      if (received < vectors && silence > SILENCE)
        $fatal(1, "%s: %0d responses of %0d, then none for %0d clocks", suite, received, vectors, SILENCE);
      if (received == vectors && silence > DRAIN) begin
        $display("%s: %0d vectors, %0d mismatches", suite, received, mismatches);
        if (mismatches != 0 && record == 0) $fatal(1, "%s: failed", suite);
        $finish;
      end
    end
  end
endmodule
