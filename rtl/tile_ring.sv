// Ring of tile contexts between the walk and the pixels. Write and stamp pointers have one extra bit.
//
// An entry lives until the last stamp of its tile has been emitted: the tail is the tile of the stamp FIFO's head, or, when the FIFO is
// empty, the entry of the row that coverage has at its end. It is a register: an entry is free two clocks after its last stamp was popped,
// which is the clock in which emission reads its values for the last time (asserted).
// Reads end in registers. Coverage: tag with fetch_i, values with load_i. Emission, every clock: the tag a clock after the pointer,
// all else two clocks after it, so that the quad's constants, found by the tag's slot, arrive together with it.
module tile_ring #(
    localparam int TC = quadrille_pkg::TC_BITS,
    localparam int VAL = quadrille_pkg::VAL_BITS,
    localparam int QVAL = quadrille_pkg::QVAL_BITS,
    localparam int QGRAD = quadrille_pkg::QGRAD_BITS,
    localparam int SLOT = quadrille_pkg::QUAD_SLOTS_LOG2,
    localparam int RING = quadrille_pkg::RING_LOG2
) (
    input logic clk_i,
    input logic rst_ni,
    // Write
    input logic push_i,
    output logic full_o,
    input logic end_i,
    input logic [SLOT-1:0] slot_i,
    input logic [TC-1:0] tile_x_i,
    input logic [TC-1:0] tile_y_i,
    input logic [6*VAL-1:0] lin_value_i,
    input logic [10*QVAL-1:0] quad_value_i,
    input logic [10*QGRAD-1:0] quad_gx_i,
    input logic [10*QGRAD-1:0] quad_gy_i,
    // Read for coverage
    input logic fetch_i,
    input logic [RING:0] fetch_ptr_i,
    output logic stamp_present_o,
    output logic stamp_end_o,
    output logic [SLOT-1:0] stamp_slot_o,
    output logic [TC-1:0] stamp_tile_x_o,
    output logic [TC-1:0] stamp_tile_y_o,
    input logic load_i,
    input logic [RING:0] load_ptr_i,
    output logic [5*VAL-1:0] stamp_lin_value_o,
    // Tail
    input logic [RING:0] stamp_ptr_i,
    input logic stamps_empty_i,
    input logic head_valid_i,
    input logic [RING:0] head_ptr_i,
    // Read for emission
    input logic emit_valid_i,
    input logic [RING:0] emit_ptr_i,
    output logic [SLOT-1:0] tag_slot_o,  // a clock after the pointer
    output logic [SLOT-1:0] emit_slot_o,  // two clocks after it, as all below
    output logic [TC-1:0] emit_tile_x_o,
    output logic [TC-1:0] emit_tile_y_o,
    output logic [6*VAL-1:0] emit_lin_value_o,
    output logic [10*QVAL-1:0] emit_quad_value_o,
    output logic [10*QGRAD-1:0] emit_quad_gx_o,
    output logic [10*QGRAD-1:0] emit_quad_gy_o
);
  localparam int ENTRIES = 1 << RING;

  logic [RING:0] write_q, tail_q;
  logic [RING:0] used;
  logic [RING-1:0] write_index, fetch_index, load_index, tag_index, emit_index_q;

  assign used = write_q - tail_q;
  assign full_o = used == (RING + 1)'(ENTRIES);
  assign stamp_present_o = fetch_ptr_i != write_q;
  assign write_index = write_q[RING-1:0];
  assign fetch_index = fetch_ptr_i[RING-1:0];
  assign load_index = load_ptr_i[RING-1:0];
  assign tag_index = emit_ptr_i[RING-1:0];

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      write_q <= '0;
      tail_q <= '0;
    end else begin
      if (push_i) write_q <= write_q + (RING + 1)'(1);
      if (head_valid_i) tail_q <= head_ptr_i;
      else if (stamps_empty_i) tail_q <= stamp_ptr_i;
    end
  end

  always_ff @(posedge clk_i) emit_index_q <= tag_index;

  // {end, slot, x, y}
  localparam int TAG = 1 + SLOT + 2 * TC;
  logic [TAG-1:0] tag_q[0:ENTRIES-1];
  logic [TAG-1:0] tag_word;
  logic [TC-1:0] tag_tile_x_q, tag_tile_y_q;

  assign tag_word = tag_q[tag_index];

  always_ff @(posedge clk_i) begin
    if (push_i) tag_q[write_index] <= {end_i, slot_i, tile_x_i, tile_y_i};
    if (fetch_i) {stamp_end_o, stamp_slot_o, stamp_tile_x_o, stamp_tile_y_o} <= tag_q[fetch_index];
    {tag_slot_o, tag_tile_x_q, tag_tile_y_q} <= tag_word[TAG-2:0];
    {emit_slot_o, emit_tile_x_o, emit_tile_y_o} <= {tag_slot_o, tag_tile_x_q, tag_tile_y_q};
  end

  for (genvar g = 0; g < 6; g++) begin : gen_linear
    logic [VAL-1:0] value_q[0:ENTRIES-1];

    always_ff @(posedge clk_i) begin
      if (push_i) value_q[write_index] <= lin_value_i[g*VAL+:VAL];
      emit_lin_value_o[g*VAL+:VAL] <= value_q[emit_index_q];
    end

    if (g < 5) begin : gen_stamp
      always_ff @(posedge clk_i) if (load_i) stamp_lin_value_o[g*VAL+:VAL] <= value_q[load_index];
    end
  end

  for (genvar g = 0; g < 10; g++) begin : gen_quadratic
    logic [QVAL-1:0] value_q[0:ENTRIES-1];
    logic [QGRAD-1:0] gx_q[0:ENTRIES-1];
    logic [QGRAD-1:0] gy_q[0:ENTRIES-1];

    always_ff @(posedge clk_i) begin
      if (push_i) begin
        value_q[write_index] <= quad_value_i[g*QVAL+:QVAL];
        gx_q[write_index] <= quad_gx_i[g*QGRAD+:QGRAD];
        gy_q[write_index] <= quad_gy_i[g*QGRAD+:QGRAD];
      end
      emit_quad_value_o[g*QVAL+:QVAL] <= value_q[emit_index_q];
      emit_quad_gx_o[g*QGRAD+:QGRAD] <= gx_q[emit_index_q];
      emit_quad_gy_o[g*QGRAD+:QGRAD] <= gy_q[emit_index_q];
    end
  end

  // The pointer's upper bit is for the tail alone.
  logic unused;
  assign unused = ^{fetch_ptr_i[RING], load_ptr_i[RING], emit_ptr_i[RING], tag_word[TAG-1]};

`ifndef SYNTHESIS
  logic value_valid_q;
  logic [RING:0] value_ptr_q, value_age;  // of the entry whose values emission reads

  assign value_age = write_q - value_ptr_q;

  always_ff @(posedge clk_i) begin
    value_valid_q <= rst_ni && emit_valid_i;
    value_ptr_q <= emit_ptr_i;
    if (rst_ni) begin
      assert (!push_i || !full_o);
      assert (used <= (RING + 1)'(ENTRIES));
      assert (!value_valid_q || value_age <= (RING + 1)'(ENTRIES));  // not written over yet
    end
  end
`endif
endmodule
