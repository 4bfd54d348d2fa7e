// SPDX-License-Identifier: Apache-2.0
// AXI4-Lite slave of 32-bit registers: the five channels become a write and a read, each a clock long and independent
// of the other. One write and one read at a time; every output is a register. An error of the register side becomes
// SLVERR.
module quadrille_axi4_lite #(
    localparam int ADDRESS = quadrille_register_map_pkg::ADDRESS_BITS
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
    // Registers: addresses of whole words
    output logic write_o,
    output logic [ADDRESS-1:0] write_address_o,
    output logic [31:0] write_data_o,
    output logic [3:0] write_strobe_o,
    input logic write_error_i,
    output logic [ADDRESS-1:0] read_address_o,
    input logic [31:0] read_data_i,
    input logic read_error_i
);
  logic address_q, data_q, read_q;  // taken, and not yet done
  logic read;
  assign s_axi_awready = !address_q;
  assign s_axi_wready = !data_q;
  assign s_axi_arready = !read_q;
  assign write_o = address_q && data_q && (!s_axi_bvalid || s_axi_bready);
  assign read = read_q && (!s_axi_rvalid || s_axi_rready);

  always_ff @(posedge aclk) begin
    if (!aresetn) begin
      address_q <= 1'b0;
      data_q <= 1'b0;
      read_q <= 1'b0;
      s_axi_bvalid <= 1'b0;
      s_axi_rvalid <= 1'b0;
    end else begin
      address_q <= address_q ? !write_o : s_axi_awvalid;
      data_q <= data_q ? !write_o : s_axi_wvalid;
      read_q <= read_q ? !read : s_axi_arvalid;
      s_axi_bvalid <= write_o || (s_axi_bvalid && !s_axi_bready);
      s_axi_rvalid <= read || (s_axi_rvalid && !s_axi_rready);
    end
  end

  always_ff @(posedge aclk) begin
    if (s_axi_awready) write_address_o <= {s_axi_awaddr[ADDRESS-1:2], 2'b00};
    if (s_axi_wready) {write_strobe_o, write_data_o} <= {s_axi_wstrb, s_axi_wdata};
    if (s_axi_arready) read_address_o <= {s_axi_araddr[ADDRESS-1:2], 2'b00};
    if (write_o) s_axi_bresp <= {write_error_i, 1'b0};
    if (read) {s_axi_rresp, s_axi_rdata} <= {read_error_i, 1'b0, read_data_i};
  end

  logic unused;
  assign unused = ^{s_axi_awaddr[1:0], s_axi_araddr[1:0]};

  quadrille_handshake_rules #(.WIDTH(ADDRESS)) u_rules_aw (
      .clk_i(aclk), .rst_ni(aresetn), .valid_i(s_axi_awvalid), .ready_i(s_axi_awready), .payload_i(s_axi_awaddr)
  );
  quadrille_handshake_rules #(.WIDTH(36)) u_rules_w (
      .clk_i(aclk), .rst_ni(aresetn), .valid_i(s_axi_wvalid), .ready_i(s_axi_wready),
      .payload_i({s_axi_wstrb, s_axi_wdata})
  );
  quadrille_handshake_rules #(.WIDTH(2)) u_rules_b (
      .clk_i(aclk), .rst_ni(aresetn), .valid_i(s_axi_bvalid), .ready_i(s_axi_bready), .payload_i(s_axi_bresp)
  );
  quadrille_handshake_rules #(.WIDTH(ADDRESS)) u_rules_ar (
      .clk_i(aclk), .rst_ni(aresetn), .valid_i(s_axi_arvalid), .ready_i(s_axi_arready), .payload_i(s_axi_araddr)
  );
  quadrille_handshake_rules #(.WIDTH(34)) u_rules_r (
      .clk_i(aclk), .rst_ni(aresetn), .valid_i(s_axi_rvalid), .ready_i(s_axi_rready),
      .payload_i({s_axi_rresp, s_axi_rdata})
  );
endmodule
