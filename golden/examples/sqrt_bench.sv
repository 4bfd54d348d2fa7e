// Checks a square root of your own against golden vectors: suite `sqrt`, default configuration (S = 18, E = 12).
//
// Uses nothing of the project but stimulus.hex and response.hex. Where the fields lie, how many vectors there are and what the latency is
// stands in the suite's manifest.json:
//
//     exp[i] at bits [72 + 12 i +: 12], signed;  sig[i] at bits [18 i +: 18];  value = sig * 2^(exp - 17), sig = 0 is zero
//
// Run it with +dir=SUITE_DIRECTORY +vectors=N, N the manifest's counts.vectors. It counts the lines itself: $readmemh takes a missing
// or short file for granted, and leaves unknown bits (Icarus Verilog) or anything at all (Verilator) in its place.
module sqrt_bench;
  localparam int S = 18;
  localparam int E = 12;
  localparam int BITS = 4 * (E + S);
  localparam int LATENCY = 4;
  localparam int MOST = 1 << 20;  // vectors
  localparam int DIGITS = (BITS + 3) / 4;  // of a line

  string dir;
  int vectors;
  logic [BITS-1:0] stimuli[0:MOST-1];
  logic [BITS-1:0] responses[0:MOST-1];

  int file, character, column, lines;

  // Ends the run unless the file has `vectors` lines of as many hexadecimal digits as a record has.
  task check_file(input string name);
    begin
      file = $fopen(name, "r");
      if (file == 0) $fatal(1, "%s: cannot be read", name);
      column = 0;
      lines = 0;
      character = $fgetc(file);
      while (character >= 0) begin
        if (character == "\n") begin
          lines = lines + 1;
          if (column != DIGITS) $fatal(1, "%s:%0d: %0d digits, not %0d", name, lines, column, DIGITS);
          column = 0;
        end else begin
          column = column + 1;
          if (!((character >= "0" && character <= "9") || (character >= "a" && character <= "f")))
            $fatal(1, "%s:%0d: no hexadecimal number", name, lines + 1);
        end
        character = $fgetc(file);
      end
      $fclose(file);
      if (lines != vectors || column != 0) $fatal(1, "%s: %0d lines, not %0d", name, lines, vectors);
    end
  endtask

  initial begin
    if (!$value$plusargs("dir=%s", dir) || !$value$plusargs("vectors=%d", vectors)) $fatal(1, "+dir=DIR +vectors=N");
    if (vectors < 1 || vectors > MOST) $fatal(1, "%0d vectors", vectors);
    check_file({dir, "/stimulus.hex"});
    check_file({dir, "/response.hex"});
    $readmemh({dir, "/stimulus.hex"}, stimuli, 0, vectors - 1);
    $readmemh({dir, "/response.hex"}, responses, 0, vectors - 1);
  end

  logic clk = 1'b0;
  always #1 clk = !clk;

  int cycle = 0;
  logic [BITS-1:0] stimulus, response, expected;

  // A vector in each clock; response i is there LATENCY clocks after stimulus i.
  assign stimulus = stimuli[cycle];
  assign expected = responses[cycle-LATENCY];

  for (genvar i = 0; i < 4; i++) begin : gen_lane
    // Your module goes here.
    quadrille_sqrt u_sqrt (
        .clk_i(clk),
        .exp_i(stimulus[4*S+E*i+:E]),
        .sig_i(stimulus[S*i+:S]),
        .exp_o(response[4*S+E*i+:E]),
        .sig_o(response[S*i+:S])
    );
  end

  int differences = 0;

  always @(posedge clk) begin
    cycle <= cycle + 1;
    if (cycle >= LATENCY && response !== expected) begin
      differences = differences + 1;
      if (differences <= 5)
        $display("response.hex:%0d: stimulus %h expected %h actual %h", cycle - LATENCY + 1, stimuli[cycle-LATENCY], expected, response);
    end
    if (cycle == vectors + LATENCY - 1) begin
      $display("sqrt: %0d vectors, %0d differences", vectors, differences);
      if (differences != 0) $fatal(1, "sqrt: failed");
      $finish;
    end
  end
endmodule
