// SPDX-License-Identifier: Apache-2.0
// The machine between AXI4-Stream interfaces: a draw is a beat of state, a packet of vertices, and a packet of fragments.
//
//     s_axis_state     one beat a draw: state_i of `quadrille`; TUSER: the depth buffer was cleared, nothing is hidden when the draw begins
//     s_axis_vertex    vertex_i, four beats a quad; TLAST with the draw's last beat
//     m_axis_fragment  fragment_o, TKEEP ones in the bytes of the lanes that have a fragment, at least one; then one null beat (TKEEP and
//                      TDATA 0) with TLAST, which ends the draw
//
// TDATA holds a record (rtl/README.md, Ports) at its low end, each lane's padded with zeros to whole bytes; padding that comes in is not read. The
// state of the next draw is taken behind the null beat. A packet of vertices that ends within a quad draws all but that quad: its beats
// are discarded (flush_i).
// Every TVALID comes from registers and waits for no TREADY; TREADY of the vertices does not wait for TVALID.
module quadrille_axi4_stream #(
    localparam int STATE_BYTES = (quadrille_pkg::STATE_BITS + 7) / 8,
    localparam int VERTEX_BYTES = (quadrille_pkg::VERTEX_BITS + 7) / 8,
    localparam int LANES = quadrille_pkg::PIXELS_PER_CLOCK,
    localparam int LANE_BYTES = (quadrille_pkg::FRAGMENT_BITS + 7) / 8,
    localparam int FRAGMENT_BYTES = LANES * LANE_BYTES
) (
    input logic aclk,
    input logic aresetn,
    input logic [8*STATE_BYTES-1:0] s_axis_state_tdata,
    input logic s_axis_state_tuser,
    input logic s_axis_state_tvalid,
    output logic s_axis_state_tready,
    input logic [8*VERTEX_BYTES-1:0] s_axis_vertex_tdata,
    input logic s_axis_vertex_tlast,
    input logic s_axis_vertex_tvalid,
    output logic s_axis_vertex_tready,
    output logic [8*FRAGMENT_BYTES-1:0] m_axis_fragment_tdata,
    output logic [FRAGMENT_BYTES-1:0] m_axis_fragment_tkeep,
    output logic m_axis_fragment_tlast,
    output logic m_axis_fragment_tvalid,
    input logic m_axis_fragment_tready
);
  localparam logic [1:0] STATE = 2'd0, VERTICES = 2'd1, DRAIN = 2'd2, LAST = 2'd3;

  logic [1:0] step_q;
  logic [quadrille_pkg::STATE_BITS-1:0] state_q;
  logic [LANES*quadrille_pkg::FRAGMENT_BITS-1:0] fragment;
  logic [LANES-1:0] mask;
  logic clear_q;  // asked for, and not yet done: reset wipes as well
  logic vertex_ready, vertex_open, fragment_valid, busy;

  assign s_axis_state_tready = step_q == STATE;
  assign vertex_open = step_q == VERTICES && !clear_q;
  assign s_axis_vertex_tready = vertex_open && vertex_ready;

  always_ff @(posedge aclk) begin
    if (!aresetn) begin
      step_q <= STATE;
    end else begin
      case (step_q)
        STATE: if (s_axis_state_tvalid) step_q <= VERTICES;
        VERTICES: if (s_axis_vertex_tvalid && s_axis_vertex_tready && s_axis_vertex_tlast) step_q <= DRAIN;
        DRAIN: if (!busy && !fragment_valid) step_q <= LAST;
        LAST: if (m_axis_fragment_tready) step_q <= STATE;
      endcase
    end
  end

  always_ff @(posedge aclk) begin
    if (!aresetn) clear_q <= 1'b0;
    else if (s_axis_state_tready) clear_q <= s_axis_state_tvalid && s_axis_state_tuser;
    else if (!busy) clear_q <= 1'b0;
  end

  always_ff @(posedge aclk) if (s_axis_state_tready) state_q <= s_axis_state_tdata[quadrille_pkg::STATE_BITS-1:0];

  logic [quadrille_pkg::COUNTER_BITS-1:0] unused_counter;

  quadrille u_quadrille (
      .clk_i(aclk),
      .rst_ni(aresetn),
      .state_i(state_q),
      .clear_hidden_i(clear_q && step_q == VERTICES),
      .flush_i(step_q == DRAIN),
      .vertex_i(s_axis_vertex_tdata[quadrille_pkg::VERTEX_BITS-1:0]),
      .vertex_valid_i(s_axis_vertex_tvalid && vertex_open),
      .vertex_ready_o(vertex_ready),
      .fragment_o(fragment),
      .fragment_mask_o(mask),
      .fragment_valid_o(fragment_valid),
      .fragment_ready_i(m_axis_fragment_tready),
      .busy_o(busy),
      .counter_index_i(quadrille_pkg::COUNTER_INDEX_BITS'(0)),
      .counter_o(unused_counter)
  );

  // The machine's fragments are zero in a lane without one, and never valid in the step LAST.
  assign m_axis_fragment_tvalid = fragment_valid || step_q == LAST;
  assign m_axis_fragment_tlast = step_q == LAST;
  for (genvar g = 0; g < LANES; g++) begin : gen_lane
    assign m_axis_fragment_tkeep[g*LANE_BYTES+:LANE_BYTES] = {LANE_BYTES{mask[g]}};
    assign m_axis_fragment_tdata[8*g*LANE_BYTES+:8*LANE_BYTES] =
        (8 * LANE_BYTES)'(fragment[g*quadrille_pkg::FRAGMENT_BITS+:quadrille_pkg::FRAGMENT_BITS]);
  end

  logic unused;
  assign unused = ^{s_axis_state_tdata, s_axis_vertex_tdata, unused_counter};

`ifndef SYNTHESIS
  always_ff @(posedge aclk) if (aresetn) assert (step_q != LAST || !fragment_valid);
`endif
endmodule
