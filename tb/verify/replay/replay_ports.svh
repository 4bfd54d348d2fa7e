    // The ports of every wrapper of a stage. A stimulus is taken in a clock with valid_i and ready_o; responses come in order.
    input logic clk_i,
    input logic rst_ni,
    input logic valid_i,
    output logic ready_o,
    input logic [`REPLAY_STIMULUS_BITS-1:0] stimulus_i,
    output logic valid_o,
    output logic [`REPLAY_RESPONSE_BITS-1:0] response_o
