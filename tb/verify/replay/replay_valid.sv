// Handshake of a pipelined stage: ready in every clock, and a vector's valid comes out LATENCY clocks after it went in (LATENCY >= 2).
module replay_valid #(
    parameter int LATENCY = 2
) (
    input logic clk_i,
    input logic rst_ni,
    input logic valid_i,
    output logic ready_o,
    output logic valid_o
);
  logic [LATENCY-1:0] valid_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) valid_q <= '0;
    else valid_q <= {valid_q[LATENCY-2:0], valid_i};
  end

  assign ready_o = 1'b1;
  assign valid_o = valid_q[LATENCY-1];
endmodule
