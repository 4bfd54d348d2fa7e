// A bench of one's own against the model: four square roots (rtl/quadrille_sqrt.sv stands for yours) on random numbers and corners.
//
// Plusargs: "+settings=key=value key=value", the model's configuration (the one that the RTL was built with); +vectors=N; +seed=N.
// Ends with a fatal error when the model refuses something, and after the last vector if any differed.
module example_bench;
  import quadrille_dpi_pkg::*;

  localparam int S = quadrille_pkg::SIGNIFICAND_BITS;
  localparam int E = quadrille_pkg::EXP_BITS;
  localparam int LATENCY = 4;
  localparam int BITS = 4 * (E + S);  // {exp[4 of E], sig[4 of S]}: stimulus and response alike
  localparam int MAX_EXP = quadrille_pkg::QVAL_BITS - 2;  // of r^2, an integer
  localparam int SHOWN = 5;

  bit clk = 1'b0;
  always #1 clk = !clk;

  // ---- What is tested -----------------------------------------------------------------------------------------------------
  logic [4*E-1:0] exp, root_exp;
  logic [4*S-1:0] sig, root_sig;

  for (genvar g = 0; g < 4; g++) begin : gen_sqrt
    quadrille_sqrt u_sqrt (
        .clk_i(clk),
        .exp_i(exp[g*E+:E]),
        .sig_i(sig[g*S+:S]),
        .exp_o(root_exp[g*E+:E]),
        .sig_o(root_sig[g*S+:S])
    );
  end

  // ---- Stimuli: half of the significands are random, the others lie at the ends of an octave or are zero ------------------------
  function automatic logic [BITS-1:0] random_numbers();
    logic [4*E-1:0] exps;
    logic [4*S-1:0] sigs;
    for (int i = 0; i < 4; i++) begin
      logic [S-1:0] s;
      case ($urandom_range(7))
        0: s = '0;
        1: s = S'(1) << (S - 1);
        2: s = '1;
        3: s = (S'(1) << (S - 1)) | (S'(1) << $urandom_range(S - 2));
        default: s = (S'(1) << (S - 1)) | S'($urandom);
      endcase
      sigs[i*S+:S] = s;
      exps[i*E+:E] = (s == '0) ? '0 : E'($urandom_range(MAX_EXP));
    end
    return {exps, sigs};
  endfunction

  // ---- The run: a vector is driven at a falling edge and compared LATENCY falling edges later -----------------------------------
  chandle model;
  record_t stimuli[LATENCY], responses[LATENCY];  // of the vectors on their way
  string settings;
  int vectors, seed, bits_in, bits_out;
  int n = 0, mismatches = 0;

  initial begin
    if ($value$plusargs("settings=%s", settings) == 0) settings = "";
    if ($value$plusargs("vectors=%d", vectors) == 0) vectors = 10000;
    if ($value$plusargs("seed=%d", seed) == 0) seed = 1;
    void'($urandom(seed));
    if (quadrille_open(settings, model) != OK) $fatal(1, "%s", quadrille_error());
    if (quadrille_record_bits(model, "sqrt", bits_in, bits_out) != OK) $fatal(1, "%s", quadrille_error());
    if (bits_in != BITS || bits_out != BITS)
      $fatal(1, "the model's records have %0d and %0d bits, this bench's %0d: set both alike", bits_in, bits_out, BITS);
  end

  always @(negedge clk) begin
    if (n >= LATENCY && {root_exp, root_sig} != responses[n%LATENCY][BITS-1:0]) begin
      mismatches++;
      if (mismatches <= SHOWN)
        $display("vector %0d: stimulus %h: expected %h, actual %h", n - LATENCY, stimuli[n%LATENCY][BITS-1:0],
                 responses[n%LATENCY][BITS-1:0], {root_exp, root_sig});
    end
    if (n == vectors + LATENCY) begin
      quadrille_close(model);
      $display("sqrt: %0d vectors, %0d mismatches", vectors, mismatches);
      if (mismatches != 0) $fatal(1, "the device and the model disagree");
      $finish;
    end else begin
      stimuli[n%LATENCY] = record_t'(random_numbers());
      if (quadrille_sqrt(model, stimuli[n%LATENCY], responses[n%LATENCY]) != OK) $fatal(1, "%s", quadrille_error());
      {exp, sig} <= stimuli[n%LATENCY][BITS-1:0];
      n++;
    end
  end
endmodule
