// SPDX-License-Identifier: Apache-2.0
`include "quadrille_assert.svh"
// The machine between AXI4-Stream interfaces: a draw is a beat of state and a packet of vertices; a frame, of one draw
// or more, is a packet of fragments.
//
//     s_axis_state     one beat a draw: state_i of `quadrille`; TUSER[0]: the depth buffer was cleared, nothing is
//                      hidden when the draw begins; TUSER[1]: the frame goes on behind this draw
//     s_axis_vertex    vertex_i, four beats a quad, TKEEP all ones; TLAST with the draw's last beat
//     m_axis_fragment  fragment_o, TKEEP ones in the bytes of the lanes that have a fragment, at least one; then one
//                      null beat (TKEEP and TDATA 0) with TLAST, which ends the frame; TUSER with it: vertices lost
//
// TDATA holds a record (rtl/README.md, Ports) at its low end, each lane's padded with zeros to whole bytes; padding
// that comes in is not read. Errors and flush_i: README.md. Vertices and fragments pass spill registers: every output
// is a register or made of the state of this module alone.
module quadrille_axi4_stream #(
    localparam int STATE_BYTES = (quadrille_pkg::STATE_BITS + 7) / 8,
    localparam int VERTEX_BYTES = (quadrille_pkg::VERTEX_BITS + 7) / 8,
    localparam int LANES = quadrille_pkg::PIXELS_PER_CLOCK,
    localparam int LANE_BYTES = (quadrille_pkg::FRAGMENT_BITS + 7) / 8,
    localparam int FRAGMENT_BYTES = LANES * LANE_BYTES
) (
    input logic aclk,
    input logic aresetn,  // synchronous, active low
    input logic [8*STATE_BYTES-1:0] s_axis_state_tdata,
    input logic [1:0] s_axis_state_tuser,
    input logic s_axis_state_tvalid,
    output logic s_axis_state_tready,
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
    input logic flush_i,
    // Events, a clock each
    output logic draw_end_o, error_tlast_o, error_tkeep_o,
    // A performance counter by its index
    input logic [quadrille_pkg::COUNTER_INDEX_BITS-1:0] counter_index_i,
    output logic [quadrille_pkg::COUNTER_BITS-1:0] counter_o
);
  localparam int VERTEX = quadrille_pkg::VERTEX_BITS, FRAGMENT = quadrille_pkg::FRAGMENT_BITS;
  localparam logic [2:0] STATE = 3'd0, VERTICES = 3'd1, DISCARD = 3'd2, DRAIN = 3'd3, LAST = 3'd4;

  logic [2:0] step_q;
  logic [1:0] beat_q;  // beats of a quad that the machine has
  logic goes_on_q, lost_q;
  logic clear_q;  // asked for, and not yet done: reset wipes as well
  logic [quadrille_pkg::STATE_BITS-1:0] state_q;

  // ---- Vertices ----------------------------------------------------------------------------------------------------
  logic [VERTEX-1:0] vertex;
  logic whole, last, valid, ready, open, vertex_ready, take;
  quadrille_spill #(.WIDTH(VERTEX + 2)) u_spill_vertex (
      .clk_i(aclk), .rst_ni(aresetn), .clear_i(flush_i), .valid_i(s_axis_vertex_tvalid), .ready_o(s_axis_vertex_tready),
      .data_i({&s_axis_vertex_tkeep, s_axis_vertex_tlast, s_axis_vertex_tdata[VERTEX-1:0]}), .valid_o(valid),
      .ready_i(ready), .data_o({whole, last, vertex})
  );

  assign open = step_q == VERTICES && !clear_q;
  assign ready = step_q == DISCARD || (open && (vertex_ready || !whole));
  assign take = valid && ready;
  assign error_tkeep_o = take && open && !whole;
  assign error_tlast_o = take && open && whole && last && beat_q != 2'd3;

  // ---- Draws -------------------------------------------------------------------------------------------------------
  logic busy, fragment_valid, spill_ready, drained;
  assign s_axis_state_tready = step_q == STATE;
  assign drained = step_q == DRAIN && !busy && !fragment_valid;
  assign draw_end_o = drained;

  always_ff @(posedge aclk) begin
    if (!aresetn) begin
      step_q <= STATE;
      beat_q <= 2'd0;
      lost_q <= 1'b0;
      clear_q <= 1'b0;
    end else begin
      case (step_q)
        STATE: begin
          beat_q <= 2'd0;
          if (s_axis_state_tvalid) step_q <= VERTICES;
          clear_q <= s_axis_state_tvalid && s_axis_state_tuser[0];
        end
        VERTICES: begin
          if (take && whole) beat_q <= beat_q + 2'd1;
          if (flush_i || (take && last)) step_q <= DRAIN;
          else if (error_tkeep_o) step_q <= DISCARD;
          if (flush_i || error_tkeep_o || error_tlast_o) lost_q <= 1'b1;
          if (!busy) clear_q <= 1'b0;
        end
        DISCARD: if (flush_i || (take && last)) step_q <= DRAIN;
        DRAIN: begin
          if (!busy) clear_q <= 1'b0;
          if (drained) step_q <= goes_on_q ? STATE : LAST;
        end
        default: begin
          if (spill_ready) step_q <= STATE;
          if (spill_ready) lost_q <= 1'b0;
        end
      endcase
    end
  end

  always_ff @(posedge aclk) begin
    if (s_axis_state_tready) state_q <= s_axis_state_tdata[quadrille_pkg::STATE_BITS-1:0];
    if (s_axis_state_tready) goes_on_q <= s_axis_state_tuser[1];
  end

  logic [LANES*FRAGMENT-1:0] fragment;
  logic [LANES-1:0] mask;
  quadrille u_quadrille (
      .clk_i(aclk), .rst_ni(aresetn), .state_i(state_q), .clear_hidden_i(clear_q && step_q == VERTICES),
      .flush_i(step_q == DRAIN), .vertex_i(vertex), .vertex_valid_i(valid && open && whole),
      .vertex_ready_o(vertex_ready), .fragment_o(fragment), .fragment_mask_o(mask), .fragment_valid_o(fragment_valid),
      .fragment_ready_i(spill_ready), .busy_o(busy), .counter_index_i, .counter_o
  );

  // ---- Fragments: those of the machine are zero in a lane without one, and never valid in the step LAST ------------
  logic [LANES-1:0] out_mask;
  logic [LANES*FRAGMENT-1:0] out_fragment;
  quadrille_spill #(.WIDTH(2 + LANES * (1 + FRAGMENT))) u_spill_fragment (
      .clk_i(aclk), .rst_ni(aresetn), .clear_i(1'b0), .valid_i(fragment_valid || step_q == LAST), .ready_o(spill_ready),
      .data_i({step_q == LAST, step_q == LAST && lost_q, mask, fragment}), .valid_o(m_axis_fragment_tvalid),
      .ready_i(m_axis_fragment_tready),
      .data_o({m_axis_fragment_tlast, m_axis_fragment_tuser, out_mask, out_fragment})
  );

  for (genvar g = 0; g < LANES; g++) begin : gen_lane
    assign m_axis_fragment_tkeep[g*LANE_BYTES+:LANE_BYTES] = {LANE_BYTES{out_mask[g]}};
    assign m_axis_fragment_tdata[8*g*LANE_BYTES+:8*LANE_BYTES] =
        (8 * LANE_BYTES)'(out_fragment[g*FRAGMENT+:FRAGMENT]);
  end

  logic unused;
  assign unused = ^{s_axis_state_tdata, s_axis_vertex_tdata};

  // ---- Protocol ----------------------------------------------------------------------------------------------------
  quadrille_handshake_rules #(.WIDTH(quadrille_pkg::STATE_BITS + 2)) u_rules_state (
      .clk_i(aclk), .rst_ni(aresetn), .valid_i(s_axis_state_tvalid), .ready_i(s_axis_state_tready),
      .payload_i({s_axis_state_tuser, s_axis_state_tdata[quadrille_pkg::STATE_BITS-1:0]})
  );
  quadrille_handshake_rules #(.WIDTH(VERTEX + 1 + VERTEX_BYTES)) u_rules_vertex (
      .clk_i(aclk), .rst_ni(aresetn), .valid_i(s_axis_vertex_tvalid), .ready_i(s_axis_vertex_tready),
      .payload_i({s_axis_vertex_tlast, s_axis_vertex_tkeep, s_axis_vertex_tdata[VERTEX-1:0]})
  );
  quadrille_handshake_rules #(.WIDTH(2 + 9 * FRAGMENT_BYTES)) u_rules_fragment (
      .clk_i(aclk), .rst_ni(aresetn), .valid_i(m_axis_fragment_tvalid), .ready_i(m_axis_fragment_tready),
      .payload_i({m_axis_fragment_tlast, m_axis_fragment_tuser, m_axis_fragment_tkeep, m_axis_fragment_tdata})
  );

`ifndef SYNTHESIS
  always_ff @(posedge aclk) begin
    if (aresetn) begin
      `QUADRILLE_ASSERT(assert_last_alone, step_q != LAST || !fragment_valid,
          "no fragment comes when a frame has ended")
      `QUADRILLE_ASSERT(assert_null_beat,
          !m_axis_fragment_tvalid || m_axis_fragment_tlast == (m_axis_fragment_tkeep == '0),
          "a null beat has TLAST, and no other beat")
    end
  end
`endif
endmodule
