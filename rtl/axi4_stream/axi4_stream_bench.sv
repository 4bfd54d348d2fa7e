// SPDX-License-Identifier: Apache-2.0
// Self-checking bench of quadrille_axi4_stream: plays the draws of a machine suite of golden vectors twice, first with every interface
// open in each clock, then with pauses of the masters and backpressure of the slave at random, and of every draw but each fourth one, two or three
// beats of a quad that does not come. Compares every fragment, their order and
// number (lane 0 of a beat first), TKEEP and TLAST, that TVALID and payload stay until TREADY, and in four-state simulators that no bit is unknown.
//
// Plusargs: +set=DIRECTORY of the suite, +draws= +beats= +fragments=N lines of its states, stimulus and response, at most LINES.
// Prints "axi4_stream: N fragments in D draws, M mismatches" for either pass; ends with $fatal unless M = 0.
module axi4_stream_bench;
  localparam int LINES = 4096;  // of each file, at most
  localparam int SILENCE = 100000;  // clocks in which nothing moves before the run is given up
  localparam int STATE = quadrille_pkg::STATE_BITS;
  localparam int VERTEX = quadrille_pkg::VERTEX_BITS;
  localparam int FRAGMENT = quadrille_pkg::FRAGMENT_BITS;
  localparam int STATE_TDATA = (STATE + 7) / 8 * 8;
  localparam int VERTEX_TDATA = (VERTEX + 7) / 8 * 8;
  localparam int LANES = quadrille_pkg::PIXELS_PER_CLOCK;
  localparam int LANE_TDATA = (FRAGMENT + 7) / 8 * 8;
  localparam int FRAGMENT_TDATA = LANES * LANE_TDATA;

  logic [STATE-1:0] states[0:LINES-1];
  logic [16+VERTEX-1:0] stimuli[0:LINES-1];  // {draw, vertex}
  logic [80+FRAGMENT-1:0] responses[0:LINES-1];  // {draw, two clocks of the bare machine, fragment}

  logic clk = 1'b0;
  logic rst_n = 1'b0;

  always #5 clk = !clk;

  string set;
  int draws, beats, fragments;

  initial begin
    if (!$value$plusargs("set=%s", set)) $fatal(1, "+set=DIRECTORY is missing");
    if (!$value$plusargs("draws=%d", draws)) $fatal(1, "+draws=N is missing");
    if (!$value$plusargs("beats=%d", beats)) $fatal(1, "+beats=N is missing");
    if (!$value$plusargs("fragments=%d", fragments)) $fatal(1, "+fragments=N is missing");
    if (draws < 1 || beats < 1 || fragments < 1) $fatal(1, "no vectors");
    if (draws > LINES || beats > LINES || fragments > LINES) $fatal(1, "more than %0d lines", LINES);
    $readmemh({set, "/states.hex"}, states, 0, draws - 1);
    $readmemh({set, "/stimulus.hex"}, stimuli, 0, beats - 1);
    $readmemh({set, "/response.hex"}, responses, 0, fragments - 1);
    repeat (4) @(negedge clk);
    rst_n = 1'b1;
  end

  // ---- Masters and slave ----------------------------------------------------------------------------------------------------
  logic paused = 1'b0;  // the second pass
  logic [31:0] lots = 32'd1;  // xorshift
  int state = 0, beat = 0, draw = 0, number = 0;  // next state and vertex, draw and fragment that are expected
  logic [1:0] over = 2'd0;  // beats behind the draw's quads, of a quad that is not complete, that are still to come
  logic state_held = 1'b0, vertex_held = 1'b0;  // offered and not taken: stays
  logic [16+VERTEX-1:0] stimulus;
  logic [15:0] next_draw;  // of the beat after it
  logic last_beat;
  logic state_tvalid, state_tready, vertex_tvalid, vertex_tready, vertex_tlast;
  logic fragment_tvalid, fragment_tready, fragment_tlast;
  logic [FRAGMENT_TDATA-1:0] fragment_tdata;
  logic [FRAGMENT_TDATA/8-1:0] fragment_tkeep;

  function automatic logic [31:0] xorshift(input logic [31:0] x);
    x = x ^ (x << 13);
    x = x ^ (x >> 17);
    return x ^ (x << 5);
  endfunction

  assign stimulus = stimuli[beat];
  assign next_draw = 16'(stimuli[beat+1] >> VERTEX);
  assign last_beat = beat + 1 == beats || next_draw != stimulus[VERTEX+:16];
  assign state_tvalid = rst_n && state < draws && (!paused || state_held || lots[1:0] == 2'd0);
  assign vertex_tvalid = rst_n && beat < beats && (!paused || vertex_held || lots[2]);
  assign vertex_tlast = last_beat && (over == 2'd1 || (over == 2'd0 && (!paused || stimulus[VERTEX+:2] == 2'd0)));
  assign fragment_tready = rst_n && (!paused || lots[4:3] == 2'd0);

  quadrille_axi4_stream u_dut (  // rubbish in the padding, and everywhere while not valid
      .aclk(clk),
      .aresetn(rst_n),
      .s_axis_state_tdata(state_tvalid ? {{(STATE_TDATA - STATE) {1'b1}}, states[state]} : {STATE_TDATA{1'b1}}),
      .s_axis_state_tuser(1'b1),  // every draw of a set begins with nothing hidden
      .s_axis_state_tvalid(state_tvalid),
      .s_axis_state_tready(state_tready),
      .s_axis_vertex_tdata(vertex_tvalid ? {{(VERTEX_TDATA - VERTEX) {1'b1}}, stimulus[VERTEX-1:0]} : {VERTEX_TDATA{1'b1}}),
      .s_axis_vertex_tlast(!vertex_tvalid || vertex_tlast),
      .s_axis_vertex_tvalid(vertex_tvalid),
      .s_axis_vertex_tready(vertex_tready),
      .m_axis_fragment_tdata(fragment_tdata),
      .m_axis_fragment_tkeep(fragment_tkeep),
      .m_axis_fragment_tlast(fragment_tlast),
      .m_axis_fragment_tvalid(fragment_tvalid),
      .m_axis_fragment_tready(fragment_tready)
  );

  // ---- Comparison -----------------------------------------------------------------------------------------------------------
  localparam int PAYLOAD = 1 + FRAGMENT_TDATA / 8 + FRAGMENT_TDATA;
  logic [PAYLOAD-1:0] payload, payload_q;
  logic waiting_q = 1'b0;  // valid and not taken in the clock before
  logic [FRAGMENT-1:0] response;
  logic [LANE_TDATA/8-1:0] lane_tkeep;
  logic [LANE_TDATA-1:0] lane_tdata;
  int next;  // fragment: `number` and the lanes of this beat that were looked at
  int mismatches = 0, silence = 0;

  assign payload = {fragment_tlast, fragment_tkeep, fragment_tdata};

  function automatic logic expected_here(input int n);  // response n belongs to this draw
    return n < fragments && 16'(responses[n] >> (FRAGMENT + 64)) == draw[15:0];
  endfunction

  task automatic mismatch(input string what);
    begin
      if (mismatches == 0) $display("axi4_stream: fragment %0d, draw %0d: %s", next + 1, draw, what);
      mismatches = mismatches + 1;
    end
  endtask

  always @(posedge clk) begin
    if (rst_n) begin
      next = number;
      lots <= xorshift(lots);
      state_held <= state_tvalid && !state_tready;
      vertex_held <= vertex_tvalid && !vertex_tready;
      if (state_tvalid && state_tready) state <= state + 1;
      if (vertex_tvalid && vertex_tready) begin
        if (stimulus[VERTEX+:16] != draw[15:0] || state != draw + 1) mismatch("a vertex is taken before its draw");
        // The last beat of a draw is sent again so many times, as any beat.
        if (last_beat && !vertex_tlast) over <= over == 2'd0 ? stimulus[VERTEX+:2] : over - 2'd1;
        else over <= 2'd0;
        if (!last_beat || vertex_tlast) beat <= beat + 1;
      end

      waiting_q <= fragment_tvalid && !fragment_tready;
      payload_q <= payload;
      if (fragment_tvalid !== 1'b0 && fragment_tvalid !== 1'b1) mismatch("TVALID is unknown");
      if (waiting_q && (fragment_tvalid !== 1'b1 || payload !== payload_q)) mismatch("TVALID or payload did not stay");
      if (fragment_tvalid === 1'b1 && fragment_tready) begin
        if (fragment_tlast) begin
          if (expected_here(number)) mismatch("the draw ends too early");
          if (payload !== {1'b1, {(PAYLOAD - 1) {1'b0}}}) mismatch("the draw's end is no null beat");
          draw <= draw + 1;
        end else begin
          if (fragment_tkeep === {(FRAGMENT_TDATA / 8) {1'b0}}) mismatch("a beat without a fragment");
          for (int lane = 0; lane < LANES; lane = lane + 1) begin
            lane_tkeep = fragment_tkeep[lane*LANE_TDATA/8+:LANE_TDATA/8];
            lane_tdata = fragment_tdata[lane*LANE_TDATA+:LANE_TDATA];
            if (lane_tkeep === {(LANE_TDATA / 8) {1'b0}}) begin
              if (lane_tdata !== {LANE_TDATA{1'b0}}) mismatch("TDATA in a lane without a fragment");
            end else if (!expected_here(next)) begin
              mismatch("a fragment too many");
            end else begin
              response = FRAGMENT'(responses[next]);
              if (lane_tkeep !== {(LANE_TDATA / 8) {1'b1}}) mismatch("TKEEP");
              if (lane_tdata !== {{(LANE_TDATA - FRAGMENT) {1'b0}}, response}) begin
                if (mismatches == 0) $display("axi4_stream: expected %h actual %h", response, lane_tdata);
                mismatch("fragment");
              end
              next = next + 1;
            end
          end
          number <= next;
        end
      end

      silence <= (vertex_tvalid && vertex_tready) || (fragment_tvalid && fragment_tready) ? 0 : silence + 1;
      if (silence > SILENCE) $fatal(1, "nothing moves in draw %0d", draw);
      if (draw == draws) begin
        if (number != fragments || beat != beats) mismatch("not all was drawn");
        if (paused) $display("axi4_stream: %0d fragments in %0d draws with pauses, %0d mismatches", number, draws, mismatches);
        else $display("axi4_stream: %0d fragments in %0d draws, %0d mismatches", number, draws, mismatches);
        if (mismatches != 0) $fatal(1, "failed");
        if (paused) $finish;
        paused <= 1'b1;
        state <= 0;
        beat <= 0;
        draw <= 0;
        number <= 0;
      end
    end
  end
endmodule
