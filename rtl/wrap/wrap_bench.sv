// SPDX-License-Identifier: Apache-2.0
// Self-checking bench of quadrille_axi4. First the registers and protocol errors; then the draws of a machine suite of
// golden vectors twice: with every interface open in each clock and a frame a draw, then with pauses of masters and
// slaves at random, frames of several draws, and errors: vertices behind a draw's last quad that are no quad, or that
// follow a beat with a hole in TKEEP. A master of AXI4-Lite reads and writes all the while.
//
// Compares fragments, their order (lane 0 of a beat first) and number, TKEEP, TLAST, TUSER, registers, responses, the
// interrupt; in four-state simulators no bit may be unknown. quadrille_handshake_rules asserts that payloads stay.
//
// Plusargs: +set=DIRECTORY of the suite, +draws= +beats= +fragments=N lines of its states, stimulus, response (at
// most LINES), +seed=N. Prints "wrap: N fragments in D draws, M mismatches" twice; ends with $fatal unless M = 0.
module wrap_bench;
  localparam int LINES = 4096, SILENCE = 100000;  // clocks in which nothing moves before the run is given up
  localparam int STATE = quadrille_pkg::STATE_BITS, VERTEX = quadrille_pkg::VERTEX_BITS;
  localparam int FRAGMENT = quadrille_pkg::FRAGMENT_BITS, LANES = quadrille_pkg::PIXELS_PER_CLOCK;
  localparam int V = quadrille_pkg::VIEWPORT_BITS + 1, DB = quadrille_pkg::DEPTH_BITS + 1;
  localparam int VERTEX_BYTES = (VERTEX + 7) / 8, LANE_BYTES = (FRAGMENT + 7) / 8;
  localparam int LANE_TDATA = 8 * LANE_BYTES, FRAGMENT_TDATA = LANES * LANE_TDATA;
  localparam logic [1:0] OKAY = 2'b00, SLVERR = 2'b10;

  logic [STATE-1:0] states[0:LINES-1];
  logic [16+VERTEX-1:0] stimuli[0:LINES-1];  // {draw, vertex}
  logic [80+FRAGMENT-1:0] responses[0:LINES-1];  // {draw, two clocks of the bare machine, fragment}
  string set;
  int draws, beats, fragments, seed;

  logic clk = 1'b0, rst_n = 1'b0;
  always #5 clk = !clk;

  int mismatches = 0;
  task mismatch(input string what);
    begin
      if (mismatches < 5) $display("wrap: %0t: %s", $time, what);
      mismatches = mismatches + 1;
    end
  endtask

  // ---- Random bits, anew each clock --------------------------------------------------------------------------------
  logic paused = 1'b0;  // the second pass
  logic [31:0] lots;  // xorshift

  function automatic logic [31:0] xorshift(input logic [31:0] x);
    x = x ^ (x << 13);
    x = x ^ (x >> 17);
    return x ^ (x << 5);
  endfunction

  always @(posedge clk) lots <= xorshift(lots);

  // ---- Registers ---------------------------------------------------------------------------------------------------
  logic [7:0] awaddr, araddr;
  logic [31:0] wdata, rdata;
  logic [3:0] wstrb;
  logic [1:0] bresp, rresp;
  logic awvalid, wvalid, arvalid, bready, rready, awready, wready, arready, bvalid, rvalid, interrupt;
  wrap_master u_master (
      .clk, .paused, .lots(lots[14:5]), .awaddr, .awvalid, .awready, .wdata, .wstrb, .wvalid, .wready, .bresp, .bvalid,
      .bready, .araddr, .arvalid, .arready, .rdata, .rresp, .rvalid, .rready
  );

  task write(input logic [7:0] address, input logic [31:0] data, input logic [1:0] response);
    begin
      u_master.transfer(1'b1, address, data, 4'b1111, 1'b0, 8'd0);
      if (u_master.write_response !== response) mismatch("write response");
    end
  endtask

  task read(input logic [7:0] address);
    u_master.transfer(1'b0, 8'd0, 32'd0, 4'd0, 1'b1, address);
  endtask
  task expect_read(input logic [7:0] address, input logic [31:0] data, input string what);
    begin
      read(address);
      if (u_master.read_value !== data || u_master.read_response !== OKAY) begin
        if (mismatches < 5) $display("wrap: register %h: expected %h actual %h", address, data, u_master.read_value);
        mismatch(what);
      end
    end
  endtask
  // ---- Vertices ----------------------------------------------------------------------------------------------------
  int beat = 0, limit = 0;  // next vertex, the first that is not offered
  int started = 0, ahead = 0;  // draws begun; beats taken of a draw that is not
  logic [2:0] over = 3'd0;  // beats behind the draw's quads that are still to come
  logic vertex_held = 1'b0;  // offered and not taken: stays
  logic [16+VERTEX-1:0] stimulus;
  logic [15:0] next_draw;  // of the beat after it
  logic last_beat, vertex_tvalid, vertex_tready, vertex_tlast, hole;
  logic [VERTEX_BYTES-1:0] vertex_tkeep;

  // In the second pass, of every 8 draws: 3 end with so many beats more, which are no quad; 2 with 7 of which the first
  // has a hole in TKEEP, so that the quad among the other 6 must not be drawn.
  function automatic logic [2:0] extra(input logic [2:0] low);  // bits of the draw's number
    case (low)
      3'd1, 3'd2, 3'd3: return low;
      3'd4, 3'd6: return 3'd7;
      default: return 3'd0;
    endcase
  endfunction

  function automatic logic goes_on(input int d);
    return paused && d % 5 < 2 && d + 1 < draws;
  endfunction

  assign stimulus = stimuli[beat];
  assign next_draw = 16'(stimuli[beat+1] >> VERTEX);
  assign last_beat = beat + 1 == beats || next_draw != stimulus[VERTEX+:16];
  assign vertex_tvalid = rst_n && beat < limit && (!paused || vertex_held || lots[2]);
  assign vertex_tlast = last_beat &&
      (over == 3'd1 || (over == 3'd0 && (!paused || extra(stimulus[VERTEX+:3]) == 3'd0)));
  assign hole = over == 3'd7;
  assign vertex_tkeep = hole ? ~(VERTEX_BYTES'(1) << beat % VERTEX_BYTES) : {VERTEX_BYTES{1'b1}};

  always @(posedge clk) begin
    if (rst_n) begin
      vertex_held <= vertex_tvalid && !vertex_tready;
      if (vertex_tvalid && vertex_tready) begin
        // The last beat of a draw is sent again so many times, as any beat.
        if (last_beat && !vertex_tlast) over <= over == 3'd0 ? extra(stimulus[VERTEX+:3]) : over - 3'd1;
        else over <= 3'd0;
        if (!last_beat || vertex_tlast) beat <= beat + 1;
        ahead = int'(stimulus[VERTEX+:16]) < started ? 0 : ahead + 1;
        if (ahead > 2) mismatch("more vertices are taken before their draw than the spill register holds");
      end
    end
  end

  // ---- Device ------------------------------------------------------------------------------------------------------
  logic fragment_tvalid, fragment_tready, fragment_tlast, fragment_tuser;
  logic [FRAGMENT_TDATA-1:0] fragment_tdata;
  logic [FRAGMENT_TDATA/8-1:0] fragment_tkeep;

  assign fragment_tready = rst_n && (!paused || lots[4:3] == 2'd0);

  quadrille_axi4 u_dut (  // rubbish in the padding, and everywhere while not valid
      .aclk(clk),
      .aresetn(rst_n),
      .s_axi_awaddr(awvalid ? awaddr : lots[7:0]),
      .s_axi_awvalid(awvalid),
      .s_axi_awready(awready),
      .s_axi_wdata(wvalid ? wdata : lots),
      .s_axi_wstrb(wvalid ? wstrb : lots[3:0]),
      .s_axi_wvalid(wvalid),
      .s_axi_wready(wready),
      .s_axi_bresp(bresp),
      .s_axi_bvalid(bvalid),
      .s_axi_bready(bready),
      .s_axi_araddr(arvalid ? araddr : lots[7:0]),
      .s_axi_arvalid(arvalid),
      .s_axi_arready(arready),
      .s_axi_rdata(rdata),
      .s_axi_rresp(rresp),
      .s_axi_rvalid(rvalid),
      .s_axi_rready(rready),
      .s_axis_vertex_tdata(vertex_tvalid ? {{(8 * VERTEX_BYTES - VERTEX) {1'b1}}, stimulus[VERTEX-1:0]}
          : {(8 * VERTEX_BYTES) {1'b1}}),
      .s_axis_vertex_tkeep(vertex_tkeep),
      .s_axis_vertex_tlast(!vertex_tvalid || vertex_tlast),
      .s_axis_vertex_tvalid(vertex_tvalid),
      .s_axis_vertex_tready(vertex_tready),
      .m_axis_fragment_tdata(fragment_tdata),
      .m_axis_fragment_tkeep(fragment_tkeep),
      .m_axis_fragment_tlast(fragment_tlast),
      .m_axis_fragment_tuser(fragment_tuser),
      .m_axis_fragment_tvalid(fragment_tvalid),
      .m_axis_fragment_tready(fragment_tready),
      .interrupt_o(interrupt)
  );

  // ---- Fragments ---------------------------------------------------------------------------------------------------
  logic directed = 1'b1;  // flushed draws: frames without a fragment
  int first = 0, frames = 0, number = 0, silence = 0;  // first draw of the frame; frames, fragments so far
  int last, next;  // its last draw; `number` and the lanes of this beat that were looked at
  logic lost;  // vertices of the frame
  logic [FRAGMENT-1:0] response;
  logic [LANE_BYTES-1:0] lane_tkeep;
  logic [LANE_TDATA-1:0] lane_tdata;

  function automatic logic expected_here(input int n);  // response n belongs to this frame
    return n < fragments && int'(16'(responses[n] >> (FRAGMENT + 64))) <= last;
  endfunction

  always @(posedge clk) begin
    if (rst_n) begin
      next = number;
      last = first;
      lost = directed || (paused && extra(last[2:0]) != 3'd0);
      while (goes_on(last)) begin
        last = last + 1;
        lost = lost || extra(last[2:0]) != 3'd0;
      end
      if (fragment_tvalid !== 1'b0 && fragment_tvalid !== 1'b1) mismatch("TVALID is unknown");
      if (interrupt !== 1'b0 && interrupt !== 1'b1) mismatch("the interrupt is unknown");
      if (fragment_tvalid === 1'b1 && fragment_tready) begin
        if (fragment_tlast) begin
          if (!directed && expected_here(number)) mismatch("the frame ends too early");
          if (fragment_tkeep !== '0 || fragment_tdata !== '0) mismatch("the frame's end is no null beat");
          if (fragment_tuser !== lost) mismatch("TUSER is not whether vertices were lost");
          frames <= frames + 1;
          if (!directed) first <= last + 1;
        end else begin
          if (directed || fragment_tkeep === '0) mismatch("a beat without a fragment");
          if (fragment_tuser !== 1'b0) mismatch("TUSER without TLAST");
          for (int lane = 0; lane < LANES; lane = lane + 1) begin
            lane_tkeep = fragment_tkeep[lane*LANE_BYTES+:LANE_BYTES];
            lane_tdata = fragment_tdata[lane*LANE_TDATA+:LANE_TDATA];
            if (lane_tkeep === {LANE_BYTES{1'b0}}) begin
              if (lane_tdata !== {LANE_TDATA{1'b0}}) mismatch("TDATA in a lane without a fragment");
            end else if (!expected_here(next)) begin
              mismatch("a fragment too many");
            end else begin
              response = FRAGMENT'(responses[next]);
              if (lane_tkeep !== {LANE_BYTES{1'b1}}) mismatch("TKEEP");
              if (lane_tdata !== {{(LANE_TDATA - FRAGMENT) {1'b0}}, response}) begin
                if (mismatches == 0) $display("wrap: expected %h actual %h", response, lane_tdata);
                mismatch("fragment");
              end
              next = next + 1;
            end
          end
          number <= next;
        end
      end
      silence <= (vertex_tvalid && vertex_tready) || (fragment_tvalid && fragment_tready) ? 0 : silence + 1;
      if (silence > SILENCE) $fatal(1, "wrap: nothing moves in the frame of draw %0d", first);
    end
  end

  // ---- The driver --------------------------------------------------------------------------------------------------
  localparam logic [7:0] CONTROL = quadrille_register_map_pkg::CONTROL, STATUS = quadrille_register_map_pkg::STATUS;
  localparam logic [7:0] INTERRUPT = quadrille_register_map_pkg::INTERRUPT, ENABLE = quadrille_register_map_pkg::ENABLE;
  localparam logic [7:0] ID = quadrille_register_map_pkg::ID, MODE = quadrille_register_map_pkg::MODE;
  localparam logic [31:0] START = 32'd1, CLEAR = 32'd2, GOES_ON = 32'd4, FLUSH = 32'd8, IDLE = 32'd1, PENDING = 32'd2;

  // All bits of a register, by bytes too, while the other channels read ID. `mask`: the bits that it keeps.
  task check_register(input logic [7:0] address, input logic [31:0] mask);
    logic [31:0] data, held;
    logic [3:0] strobe;
    begin
      held = 32'd0;
      expect_read(address, held, "a register after reset");
      for (int i = 0; i < 8; i = i + 1) begin
        data = (i == 0) ? 32'hffffffff : lots;
        strobe = (i == 0) ? 4'b1111 : 4'b0001 << i % 4;
        for (int b = 0; b < 4; b = b + 1) if (strobe[b]) held[8*b+:8] = data[8*b+:8] & mask[8*b+:8];
        u_master.transfer(1'b1, address, data, strobe, 1'b1, ID);
        if (u_master.write_response !== OKAY) mismatch("write response");
        if (u_master.read_value !== quadrille_register_map_pkg::ID_RESET) mismatch("ID");
        if (u_master.read_response !== OKAY) mismatch("read response");
        expect_read(address, held, "a register that was written");
      end
    end
  endtask

  // Draw state of a draw of the suite: its records are state_t.
  task set_state(input logic [11:0] d);
    logic [V-1:0] x0, y0, x1, y1;
    logic [1:0] cull;
    logic perspective, depth;
    logic [DB-1:0] znear, zfar;
    logic [3:0] attributes;
    logic [7:0] skip;
    begin
      {x0, y0, x1, y1, cull, perspective, depth, znear, zfar, attributes, skip} = states[d];
      write(quadrille_register_map_pkg::SCISSOR_MIN, {16'(y0), 16'(x0)}, OKAY);
      write(quadrille_register_map_pkg::SCISSOR_MAX, {16'(y1), 16'(x1)}, OKAY);
      write(MODE, {16'd0, skip, attributes, depth, perspective, cull}, OKAY);
      write(quadrille_register_map_pkg::ZNEAR, 32'(znear), OKAY);
      write(quadrille_register_map_pkg::ZFAR, 32'(zfar), OKAY);
    end
  endtask

  task wait_status(input logic [31:0] mask, input logic [31:0] value);
    begin
      read(STATUS);
      while ((u_master.read_value & mask) != value) read(STATUS);
    end
  endtask

  // The first `count` beats are offered, and taken.
  task offer(input int count);
    begin
      limit = count;
      while (beat != count) @(posedge clk);
      limit = 0;
    end
  endtask

  task check_protocol;
    begin
      expect_read(ID, quadrille_register_map_pkg::ID_RESET, "ID");
      expect_read(STATUS, quadrille_register_map_pkg::STATUS_RESET, "STATUS after reset");
      paused = 1'b1;  // data may come before or after its address
      check_register(ENABLE, 32'h0000000f);
      check_register(quadrille_register_map_pkg::COUNTER_INDEX, 32'h0000003f);
      check_register(quadrille_register_map_pkg::SCISSOR_MIN, {16'((1 << V) - 1), 16'((1 << V) - 1)});
      check_register(quadrille_register_map_pkg::SCISSOR_MAX, {16'((1 << V) - 1), 16'((1 << V) - 1)});
      check_register(MODE, 32'h0000ffff);
      check_register(quadrille_register_map_pkg::ZNEAR, 32'((33'd1 << DB) - 33'd1));
      check_register(quadrille_register_map_pkg::ZFAR, 32'((33'd1 << DB) - 33'd1));
      write(ID, 32'd0, SLVERR);
      write(8'h38, 32'd0, SLVERR);
      read(8'h38);
      if (u_master.read_response !== SLVERR) mismatch("a register that is not there can be read");
      expect_read(CONTROL, 32'd0, "CONTROL");
      paused = 1'b0;
      // Two accesses each way before the first response is taken.
      read(MODE);
      u_master.pile_up(ENABLE, 32'd5, 32'd10, MODE, ID);
      if (u_master.piled !== {u_master.read_value, quadrille_register_map_pkg::ID_RESET}) mismatch("two reads");
      expect_read(ENABLE, 32'd10, "ENABLE behind two writes");

      // Of two draws the second waits; a third one, and the draw state, are refused.
      set_state(0);
      started = 1;
      write(CONTROL, START | CLEAR, OKAY);
      offer(2);
      wait_status(PENDING, 32'd0);
      expect_read(STATUS, 32'd0, "STATUS of a draw");
      write(CONTROL, START, OKAY);
      expect_read(STATUS, PENDING, "STATUS of a second draw");
      write(CONTROL, START, SLVERR);
      read(MODE);
      write(MODE, ~u_master.read_value, SLVERR);
      expect_read(MODE, u_master.read_value, "MODE, which is locked");
      expect_read(quadrille_register_map_pkg::DRAWS, 32'd0, "DRAWS");
      write(CONTROL, FLUSH, OKAY);
      wait_status(PENDING, 32'd0);
      write(CONTROL, FLUSH, OKAY);
      wait_status(IDLE, IDLE);
      beat = 0;
      while (frames != 2) @(posedge clk);
      expect_read(quadrille_register_map_pkg::DRAWS, 32'd2, "DRAWS");
      expect_read(quadrille_register_map_pkg::FRAGMENTS, 32'd0, "FRAGMENTS");

      // Interrupt: frames and draws have ended.
      write(ENABLE, 32'd0, OKAY);
      expect_read(INTERRUPT, 32'd3, "INTERRUPT");
      if (interrupt !== 1'b0) mismatch("an interrupt that is not enabled");
      for (int i = 0; i < 2; i = i + 1) begin
        write(ENABLE, 32'd1 << i, OKAY);
        if (interrupt !== 1'b1) mismatch("no interrupt");
        write(INTERRUPT, 32'd1 << i, OKAY);
        expect_read(INTERRUPT, 32'd2 >> 2 * i, "INTERRUPT that was cleared in part");
        if (interrupt !== 1'b0) mismatch("the interrupt stays");
      end
      // A beat that was taken before its draw is forgotten.
      offer(1);
      write(CONTROL, FLUSH, OKAY);
      beat = 0;
      directed = 1'b0;
      started = 0;
    end
  endtask

  task draw_all(input int draws_before, input int fragments_before);
    begin
      limit = beats;
      for (int d = 0; d < draws; d = d + 1) begin
        wait_status(PENDING, 32'd0);
        set_state(12'(d));
        started = d + 1;
        write(CONTROL, START | CLEAR | (goes_on(d) ? GOES_ON : 32'd0), OKAY);
      end
      while (first != draws) @(posedge clk);
      wait_status(IDLE, IDLE);
      expect_read(quadrille_register_map_pkg::DRAWS, draws_before + draws, "DRAWS");
      expect_read(quadrille_register_map_pkg::FRAGMENTS, fragments_before + fragments, "FRAGMENTS");
      expect_read(INTERRUPT, paused ? 32'hf : 32'h3, "INTERRUPT");
      write(INTERRUPT, 32'hf, OKAY);
      if (number != fragments || beat != beats) mismatch("not all was drawn");
      mismatches = mismatches + u_master.errors;
      if (paused) $display("wrap: %0d fragments in %0d draws with pauses, %0d mismatches", number, draws, mismatches);
      else $display("wrap: %0d fragments in %0d draws, %0d mismatches", number, draws, mismatches);
      if (mismatches != 0) $fatal(1, "failed");
      {first, number, started, limit, beat} = '0;
    end
  endtask

  always begin  // once; of an initial block Verilator takes no <=
    if (!$value$plusargs("set=%s", set)) $fatal(1, "+set=DIRECTORY is missing");
    if (!$value$plusargs("draws=%d", draws)) $fatal(1, "+draws=N is missing");
    if (!$value$plusargs("beats=%d", beats)) $fatal(1, "+beats=N is missing");
    if (!$value$plusargs("fragments=%d", fragments)) $fatal(1, "+fragments=N is missing");
    if (!$value$plusargs("seed=%d", seed)) seed = 1;
    if (draws < 1 || beats < 1 || fragments < 1) $fatal(1, "no vectors");
    if (draws > LINES || beats > LINES || fragments > LINES) $fatal(1, "more than %0d lines", LINES);
    $readmemh({set, "/states.hex"}, states, 0, draws - 1);
    $readmemh({set, "/stimulus.hex"}, stimuli, 0, beats - 1);
    $readmemh({set, "/response.hex"}, responses, 0, fragments - 1);
    lots = 32'h9e3779b9 ^ seed;
    repeat (4) @(negedge clk);
    rst_n = 1'b1;
    check_protocol;
    draw_all(2, 0);
    paused = 1'b1;
    draw_all(2 + draws, fragments);
    $finish;
    forever @(posedge clk);
  end
endmodule
