// Ring of tile contexts between the walk and the pixels. Write and stamp pointers have one extra bit.
//
// An entry lives until the last stamp of its tile has been emitted: the tail is the tile of the stamp FIFO's head, or the stamp
// pointer when the FIFO is empty. Two combinational reads: for coverage (stamp pointer) and for emission (the head's tile).
module tile_ring #(
    localparam int TC = quadrille_pkg::TC_BITS,
    localparam int VAL = quadrille_pkg::VAL_BITS,
    localparam int QVAL = quadrille_pkg::QVAL_BITS,
    localparam int QGRAD = quadrille_pkg::QGRAD_BITS,
    localparam int SLOT = quadrille_pkg::QUAD_SLOTS_LOG2,
    localparam int RING = quadrille_pkg::TILE_SLOTS_LOG2
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
    input logic [RING:0] stamp_ptr_i,
    output logic stamp_present_o,
    output logic stamp_end_o,
    output logic [SLOT-1:0] stamp_slot_o,
    output logic [TC-1:0] stamp_tile_x_o,
    output logic [TC-1:0] stamp_tile_y_o,
    output logic [5*VAL-1:0] stamp_lin_value_o,
    // Read for emission
    input logic head_valid_i,
    input logic [RING:0] head_ptr_i,
    output logic [SLOT-1:0] head_slot_o,
    output logic [TC-1:0] head_tile_x_o,
    output logic [TC-1:0] head_tile_y_o,
    output logic [6*VAL-1:0] head_lin_value_o,
    output logic [10*QVAL-1:0] head_quad_value_o,
    output logic [10*QGRAD-1:0] head_quad_gx_o,
    output logic [10*QGRAD-1:0] head_quad_gy_o
);
  localparam int ENTRIES = 1 << RING;

  logic [RING:0] write_q;
  logic [RING:0] tail, used;
  logic [RING-1:0] write_index, stamp_index, head_index;

  assign tail = head_valid_i ? head_ptr_i : stamp_ptr_i;
  assign used = write_q - tail;
  assign full_o = used == (RING + 1)'(ENTRIES);
  assign stamp_present_o = stamp_ptr_i != write_q;
  assign write_index = write_q[RING-1:0];
  assign stamp_index = stamp_ptr_i[RING-1:0];
  assign head_index = head_ptr_i[RING-1:0];

  always_ff @(posedge clk_i) begin
    if (!rst_ni) write_q <= '0;
    else if (push_i) write_q <= write_q + (RING + 1)'(1);
  end

  // {end, slot, x, y}
  localparam int TAG = 1 + SLOT + 2 * TC;
  logic [TAG-1:0] tag_q[0:ENTRIES-1];
  logic [TAG-1:0] head_tag;

  always_ff @(posedge clk_i) if (push_i) tag_q[write_index] <= {end_i, slot_i, tile_x_i, tile_y_i};

  assign {stamp_end_o, stamp_slot_o, stamp_tile_x_o, stamp_tile_y_o} = tag_q[stamp_index];
  assign head_tag = tag_q[head_index];
  assign {head_slot_o, head_tile_x_o, head_tile_y_o} = head_tag[TAG-2:0];

  for (genvar g = 0; g < 6; g++) begin : gen_linear
    logic [VAL-1:0] value_q[0:ENTRIES-1];

    always_ff @(posedge clk_i) if (push_i) value_q[write_index] <= lin_value_i[g*VAL+:VAL];

    assign head_lin_value_o[g*VAL+:VAL] = value_q[head_index];
    if (g < 5) begin : gen_stamp
      assign stamp_lin_value_o[g*VAL+:VAL] = value_q[stamp_index];
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
    end

    assign head_quad_value_o[g*QVAL+:QVAL] = value_q[head_index];
    assign head_quad_gx_o[g*QGRAD+:QGRAD] = gx_q[head_index];
    assign head_quad_gy_o[g*QGRAD+:QGRAD] = gy_q[head_index];
  end

`ifndef SYNTHESIS
  logic unused_end;
  assign unused_end = head_tag[TAG-1];

  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      assert (!push_i || !full_o);
      assert (used <= (RING + 1)'(ENTRIES));
    end
  end
`endif
endmodule
