// SPDX-License-Identifier: Apache-2.0
`include "quadrille_types.svh"
// The registers of quadrille_axi4, as registers.toml has them: draw state, commands, status, counters, interrupt.
//
// A START offers the draw state to quadrille_axi4_stream; until it is taken, draw state and START are locked. An access
// that is refused (no register there, a write to one that is read only, or one that is locked) is an error and changes
// nothing.
module quadrille_registers #(
    localparam int ADDRESS = quadrille_register_map_pkg::ADDRESS_BITS, LANES = quadrille_pkg::PIXELS_PER_CLOCK,
    localparam int V = quadrille_pkg::VIEWPORT_BITS, DB = quadrille_pkg::DEPTH_BITS
) (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    // quadrille_axi4_lite
    input logic write_i,
    input logic [ADDRESS-1:0] write_address_i,
    input logic [31:0] write_data_i,
    input logic [3:0] write_strobe_i,
    output logic write_error_o,
    input logic [ADDRESS-1:0] read_address_i,
    output logic [31:0] read_data_o,
    output logic read_error_o,
    // quadrille_axi4_stream
    output logic [quadrille_pkg::STATE_BITS-1:0] state_o,
    output logic state_clear_o, state_goes_on_o, state_valid_o,
    input logic state_ready_i,  // no draw is under way
    output logic flush_o,
    input logic draw_end_i, frame_end_i, error_tlast_i, error_tkeep_i,
    input logic [LANES-1:0] taken_i,  // lanes whose fragment the slave takes
    output logic [quadrille_pkg::COUNTER_INDEX_BITS-1:0] counter_index_o,
    input logic [quadrille_pkg::COUNTER_BITS-1:0] counter_i,
    output logic interrupt_o
);
  localparam int EVENTS = 4;
  `QUADRILLE_STATE_T state_q;
  logic pending_q;
  logic [EVENTS-1:0] interrupt_q, enable_q, events;
  logic [31:0] draws_q, fragments_q, fragments;
  assign state_o = state_q;
  assign state_valid_o = pending_q;
  assign interrupt_o = (interrupt_q & enable_q) != '0;

  // ---- Read: what a register holds; the words that can be written are named, for bytes that a write leaves alone ----
  logic [31:0] min_word, max_word, mode_word;
  assign min_word = {16'(state_q.scissor_y0), 16'(state_q.scissor_x0)};
  assign max_word = {16'(state_q.scissor_y1), 16'(state_q.scissor_x1)};
  assign mode_word = 32'({state_q.skip, state_q.attributes, state_q.depth, state_q.perspective, state_q.cull});

  always_comb begin
    read_error_o = 1'b0;
    case (read_address_i)
      quadrille_register_map_pkg::ID: read_data_o = quadrille_register_map_pkg::ID_RESET;
      quadrille_register_map_pkg::CONTROL: read_data_o = '0;
      quadrille_register_map_pkg::STATUS: read_data_o = {30'd0, pending_q, state_ready_i && !pending_q};
      quadrille_register_map_pkg::INTERRUPT: read_data_o = 32'(interrupt_q);
      quadrille_register_map_pkg::ENABLE: read_data_o = 32'(enable_q);
      quadrille_register_map_pkg::DRAWS: read_data_o = draws_q;
      quadrille_register_map_pkg::FRAGMENTS: read_data_o = fragments_q;
      quadrille_register_map_pkg::COUNTER_INDEX: read_data_o = 32'(counter_index_o);
      quadrille_register_map_pkg::COUNTER: read_data_o = counter_i;
      quadrille_register_map_pkg::SCISSOR_MIN: read_data_o = min_word;
      quadrille_register_map_pkg::SCISSOR_MAX: read_data_o = max_word;
      quadrille_register_map_pkg::MODE: read_data_o = mode_word;
      quadrille_register_map_pkg::ZNEAR: read_data_o = 32'(state_q.znear);
      quadrille_register_map_pkg::ZFAR: read_data_o = 32'(state_q.zfar);
      default: begin
        read_data_o = '0;
        read_error_o = 1'b1;
      end
    endcase
  end

  // ---- Write -------------------------------------------------------------------------------------------------------
  logic known, of_state, start, locked, write;
  logic [31:0] strobe, old, word;
  assign strobe = {{8{write_strobe_i[3]}}, {8{write_strobe_i[2]}}, {8{write_strobe_i[1]}}, {8{write_strobe_i[0]}}};
  assign word = (write_data_i & strobe) | (old & ~strobe);
  assign start = write_address_i == quadrille_register_map_pkg::CONTROL &&
      word[quadrille_register_map_pkg::CONTROL_START];
  assign locked = pending_q && (of_state || start);
  assign write = write_i && known && !locked;
  assign write_error_o = !known || locked;
  assign flush_o = write && write_address_i == quadrille_register_map_pkg::CONTROL &&
      word[quadrille_register_map_pkg::CONTROL_FLUSH];

  always_comb begin
    known = 1'b1;
    of_state = 1'b0;
    old = '0;
    case (write_address_i)
      quadrille_register_map_pkg::CONTROL, quadrille_register_map_pkg::INTERRUPT: ;
      quadrille_register_map_pkg::ENABLE: old = 32'(enable_q);
      quadrille_register_map_pkg::COUNTER_INDEX: old = 32'(counter_index_o);
      quadrille_register_map_pkg::SCISSOR_MIN: {of_state, old} = {1'b1, min_word};
      quadrille_register_map_pkg::SCISSOR_MAX: {of_state, old} = {1'b1, max_word};
      quadrille_register_map_pkg::MODE: {of_state, old} = {1'b1, mode_word};
      quadrille_register_map_pkg::ZNEAR: {of_state, old} = {1'b1, 32'(state_q.znear)};
      quadrille_register_map_pkg::ZFAR: {of_state, old} = {1'b1, 32'(state_q.zfar)};
      default: known = 1'b0;
    endcase
  end

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      state_q <= '0;
      enable_q <= '0;
      counter_index_o <= '0;
    end else if (write) begin
      case (write_address_i)
        quadrille_register_map_pkg::ENABLE: enable_q <= word[EVENTS-1:0];
        quadrille_register_map_pkg::COUNTER_INDEX: counter_index_o <= word[quadrille_pkg::COUNTER_INDEX_BITS-1:0];
        quadrille_register_map_pkg::SCISSOR_MIN: begin
          state_q.scissor_x0 <= word[quadrille_register_map_pkg::SCISSOR_MIN_X+:V+1];
          state_q.scissor_y0 <= word[quadrille_register_map_pkg::SCISSOR_MIN_Y+:V+1];
        end
        quadrille_register_map_pkg::SCISSOR_MAX: begin
          state_q.scissor_x1 <= word[quadrille_register_map_pkg::SCISSOR_MAX_X+:V+1];
          state_q.scissor_y1 <= word[quadrille_register_map_pkg::SCISSOR_MAX_Y+:V+1];
        end
        quadrille_register_map_pkg::MODE: begin
          state_q.cull <= word[quadrille_register_map_pkg::MODE_CULL+:2];
          state_q.perspective <= word[quadrille_register_map_pkg::MODE_PERSPECTIVE];
          state_q.depth <= word[quadrille_register_map_pkg::MODE_DEPTH];
          state_q.attributes <= word[quadrille_register_map_pkg::MODE_ATTRIBUTES+:4];
          state_q.skip <= word[quadrille_register_map_pkg::MODE_SKIP+:8];
        end
        quadrille_register_map_pkg::ZNEAR: state_q.znear <= word[DB:0];
        quadrille_register_map_pkg::ZFAR: state_q.zfar <= word[DB:0];
        default: ;
      endcase
    end
  end

  // ---- Draws and interrupt: an event of the clock in which its bit is cleared stays --------------------------------
  assign events[quadrille_register_map_pkg::INTERRUPT_FRAME_END] = frame_end_i;
  assign events[quadrille_register_map_pkg::INTERRUPT_DRAW_END] = draw_end_i;
  assign events[quadrille_register_map_pkg::INTERRUPT_ERROR_TLAST] = error_tlast_i;
  assign events[quadrille_register_map_pkg::INTERRUPT_ERROR_TKEEP] = error_tkeep_i;

  always_comb begin
    fragments = fragments_q;
    for (int i = 0; i < LANES; i++) fragments = fragments + 32'(taken_i[i]);
  end

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      pending_q <= 1'b0;
      interrupt_q <= '0;
      draws_q <= '0;
      fragments_q <= '0;
    end else begin
      pending_q <= pending_q ? !state_ready_i : write && start;
      if (write && write_address_i == quadrille_register_map_pkg::INTERRUPT)
        interrupt_q <= (interrupt_q & ~word[EVENTS-1:0]) | events;
      else interrupt_q <= interrupt_q | events;
      draws_q <= draws_q + 32'(draw_end_i);
      fragments_q <= fragments;
    end
  end

  always_ff @(posedge clk_i) begin
    if (write && start) begin
      state_clear_o <= word[quadrille_register_map_pkg::CONTROL_CLEAR_HIDDEN];
      state_goes_on_o <= word[quadrille_register_map_pkg::CONTROL_FRAME_GOES_ON];
    end
  end
endmodule
