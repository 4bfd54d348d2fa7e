// SPDX-License-Identifier: Apache-2.0
// Master of AXI4-Lite for wrap_bench: its tasks make accesses, with pauses at random when `paused`.
module wrap_master (
    input logic clk, paused,
    input logic [9:0] lots,  // random bits
    output logic [7:0] awaddr,
    output logic awvalid,
    input logic awready,
    output logic [31:0] wdata,
    output logic [3:0] wstrb,
    output logic wvalid,
    input logic wready,
    input logic [1:0] bresp,
    input logic bvalid,
    output logic bready,
    output logic [7:0] araddr,
    output logic arvalid,
    input logic arready,
    input logic [31:0] rdata,
    input logic [1:0] rresp,
    input logic rvalid,
    output logic rready
);
  logic [31:0] read_value;
  logic [1:0] write_response, read_response;
  int errors = 0;

  initial {awvalid, wvalid, arvalid, bready, rready} = '0;

  task error(input string what);
    begin
      if (errors < 5) $display("wrap: %0t: %s", $time, what);
      errors = errors + 1;
    end
  endtask

  // A write, a read, or both at once; their results in write_response, read_value, read_response.
  task transfer(input logic writes, input logic [7:0] write_address, input logic [31:0] data, input logic [3:0] strobe,
                input logic reads, input logic [7:0] read_address);
    logic aw_to_do, w_to_do, ar_to_do, b_to_come, r_to_come;
    begin
      {aw_to_do, w_to_do, b_to_come} = {3{writes}};
      {ar_to_do, r_to_come} = {2{reads}};
      while (b_to_come || r_to_come) begin
        @(posedge clk);
        if (awvalid && awready) awvalid <= 1'b0;
        if (wvalid && wready) wvalid <= 1'b0;
        if (arvalid && arready) arvalid <= 1'b0;
        if (aw_to_do && (!paused || lots[1:0] == 2'd0)) begin
          awvalid <= 1'b1;
          awaddr <= write_address;
          aw_to_do = 1'b0;
        end
        if (w_to_do && (!paused || lots[3:2] == 2'd0)) begin
          wvalid <= 1'b1;
          wdata <= data;
          wstrb <= strobe;
          w_to_do = 1'b0;
        end
        if (ar_to_do && (!paused || lots[5:4] == 2'd0)) begin
          arvalid <= 1'b1;
          araddr <= read_address;
          ar_to_do = 1'b0;
        end
        if (bready && bvalid === 1'b1) begin
          if (!b_to_come || aw_to_do || w_to_do) error("a write response without a write");
          b_to_come = 1'b0;
          write_response = bresp;
        end
        if (rready && rvalid === 1'b1) begin
          if (!r_to_come || ar_to_do) error("read data without a read");
          r_to_come = 1'b0;
          read_value = rdata;
          read_response = rresp;
        end
        bready <= b_to_come && (!paused || lots[7:6] == 2'd0);
        rready <= r_to_come && (!paused || lots[9:8] == 2'd0);
      end
    end
  endtask

  // Two writes and two reads, of which no response is taken before all were offered; what was read, in `piled`.
  logic [63:0] piled;
  task pile_up(input logic [7:0] write_address, input logic [31:0] first, input logic [31:0] second,
               input logic [7:0] read_first, input logic [7:0] read_second);
    int writes, words, reads, responses, values;  // taken
    int clocks;
    begin
      {writes, words, reads, responses, values, clocks} = '0;
      {awvalid, wvalid, arvalid} <= 3'b111;
      awaddr <= write_address;
      wdata <= first;
      wstrb <= 4'b1111;
      araddr <= read_first;
      while ((responses < 2 || values < 2) && clocks < 100) begin
        @(posedge clk);
        if (awvalid && awready) writes = writes + 1;
        if (wvalid && wready) words = words + 1;
        if (arvalid && arready) reads = reads + 1;
        awvalid <= writes < 2;
        wvalid <= words < 2;
        arvalid <= reads < 2;
        if (words == 1) wdata <= second;
        if (reads == 1) araddr <= read_second;
        if (bready && bvalid === 1'b1) responses = responses + 1;
        if (rready && rvalid === 1'b1) begin
          piled = {piled[31:0], rdata};
          values = values + 1;
        end
        clocks = clocks + 1;
        bready <= clocks > 12 && writes == 2 && words == 2 && responses < 2;
        rready <= clocks > 12 && reads == 2 && values < 2;
      end
      if (responses < 2 || values < 2) error("not two responses of two accesses");
      repeat (4) @(posedge clk);
      if (bvalid || rvalid) error("a third response");
    end
  endtask
endmodule
