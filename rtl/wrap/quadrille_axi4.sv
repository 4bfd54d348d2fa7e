// SPDX-License-Identifier: Apache-2.0
// The machine as a peripheral: registers by AXI4-Lite, vertices and fragments by AXI4-Stream, an interrupt. README.md
// has the registers and rules; quadrille_axi4_stream the streams. Every output but interrupt_o comes from registers.
module quadrille_axi4 #(
    localparam int ADDRESS = quadrille_register_map_pkg::ADDRESS_BITS,
    localparam int STATE_BYTES = (quadrille_pkg::STATE_BITS + 7) / 8,
    localparam int VERTEX_BYTES = (quadrille_pkg::VERTEX_BITS + 7) / 8,
    localparam int LANES = quadrille_pkg::PIXELS_PER_CLOCK,
    localparam int LANE_BYTES = (quadrille_pkg::FRAGMENT_BITS + 7) / 8,
    localparam int FRAGMENT_BYTES = LANES * LANE_BYTES
) (
    input logic aclk,
    input logic aresetn,  // synchronous, active low
    input logic [ADDRESS-1:0] s_axi_awaddr,
    input logic s_axi_awvalid,
    output logic s_axi_awready,
    input logic [31:0] s_axi_wdata,
    input logic [3:0] s_axi_wstrb,
    input logic s_axi_wvalid,
    output logic s_axi_wready,
    output logic [1:0] s_axi_bresp,
    output logic s_axi_bvalid,
    input logic s_axi_bready,
    input logic [ADDRESS-1:0] s_axi_araddr,
    input logic s_axi_arvalid,
    output logic s_axi_arready,
    output logic [31:0] s_axi_rdata,
    output logic [1:0] s_axi_rresp,
    output logic s_axi_rvalid,
    input logic s_axi_rready,
    input logic [8*VERTEX_BYTES-1:0] s_axis_vertex_tdata,
    input logic [VERTEX_BYTES-1:0] s_axis_vertex_tkeep,
    input logic s_axis_vertex_tlast,
    input logic s_axis_vertex_tvalid,
    output logic s_axis_vertex_tready,
    output logic [8*FRAGMENT_BYTES-1:0] m_axis_fragment_tdata,
    output logic [FRAGMENT_BYTES-1:0] m_axis_fragment_tkeep,
    output logic m_axis_fragment_tlast,
    output logic m_axis_fragment_tuser,
    output logic m_axis_fragment_tvalid,
    input logic m_axis_fragment_tready,
    output logic interrupt_o
);
  logic write, write_error, read_error;
  logic [ADDRESS-1:0] write_address, read_address;
  logic [31:0] write_data, read_data;
  logic [3:0] write_strobe;
  quadrille_axi4_lite u_lite (
      .aclk, .aresetn, .s_axi_awaddr, .s_axi_awvalid, .s_axi_awready, .s_axi_wdata, .s_axi_wstrb, .s_axi_wvalid,
      .s_axi_wready, .s_axi_bresp, .s_axi_bvalid, .s_axi_bready, .s_axi_araddr, .s_axi_arvalid, .s_axi_arready,
      .s_axi_rdata, .s_axi_rresp, .s_axi_rvalid, .s_axi_rready, .write_o(write), .write_address_o(write_address),
      .write_data_o(write_data), .write_strobe_o(write_strobe), .write_error_i(write_error),
      .read_address_o(read_address), .read_data_i(read_data), .read_error_i(read_error)
  );

  logic [quadrille_pkg::STATE_BITS-1:0] state;
  logic state_clear, state_goes_on, state_valid, state_ready, flush, draw_end, error_tlast, error_tkeep, take;
  logic [LANES-1:0] taken;
  logic [quadrille_pkg::COUNTER_INDEX_BITS-1:0] counter_index;
  logic [quadrille_pkg::COUNTER_BITS-1:0] counter;
  assign take = m_axis_fragment_tvalid && m_axis_fragment_tready;
  for (genvar g = 0; g < LANES; g++) begin : gen_lane
    assign taken[g] = take && m_axis_fragment_tkeep[g*LANE_BYTES];
  end

  quadrille_registers u_registers (
      .clk_i(aclk), .rst_ni(aresetn), .write_i(write), .write_address_i(write_address), .write_data_i(write_data),
      .write_strobe_i(write_strobe), .write_error_o(write_error), .read_address_i(read_address),
      .read_data_o(read_data), .read_error_o(read_error), .state_o(state), .state_clear_o(state_clear),
      .state_goes_on_o(state_goes_on), .state_valid_o(state_valid), .state_ready_i(state_ready), .flush_o(flush),
      .draw_end_i(draw_end), .frame_end_i(take && m_axis_fragment_tlast), .error_tlast_i(error_tlast),
      .error_tkeep_i(error_tkeep), .taken_i(taken), .counter_index_o(counter_index), .counter_i(counter), .interrupt_o
  );

  quadrille_axi4_stream u_stream (
      .aclk, .aresetn, .s_axis_state_tdata((8 * STATE_BYTES)'(state)),
      .s_axis_state_tuser({state_goes_on, state_clear}), .s_axis_state_tvalid(state_valid),
      .s_axis_state_tready(state_ready), .s_axis_vertex_tdata, .s_axis_vertex_tkeep, .s_axis_vertex_tlast,
      .s_axis_vertex_tvalid, .s_axis_vertex_tready, .m_axis_fragment_tdata, .m_axis_fragment_tkeep,
      .m_axis_fragment_tlast, .m_axis_fragment_tuser, .m_axis_fragment_tvalid, .m_axis_fragment_tready,
      .flush_i(flush), .draw_end_o(draw_end), .error_tlast_o(error_tlast), .error_tkeep_o(error_tkeep),
      .counter_index_i(counter_index), .counter_o(counter)
  );
endmodule
