// SPDX-License-Identifier: Apache-2.0
`include "quadrille_assert.svh"
`include "quadrille_types.svh"
// From pixels' positions to their fragments, PIXELS_PER_CLOCK a clock: a pipeline of LATENCY registers that never
// waits.
//
// The pixels of a clock are of one row of one tile. What they have in common is here: that row's values, the slot
// index, which travels with them, and what is read from the slot bank by it, one register before its users; all else is
// in pixel_lane. Register n is written n clocks after the pixels enter. The boundaries between units have the registers
// quadrille_pkg::DIFF_STAGE to FRAGMENT_STAGE (SPEC.md, Pixel pipeline). An end beat (end, no lane valid) travels with
// the pixels; at the last register it releases its slot.
module quadrille_pixel_pipeline #(
    localparam int P = quadrille_pkg::PIXELS_PER_CLOCK, V = quadrille_pkg::VIEWPORT_BITS,
    localparam int FB = quadrille_pkg::FRAGMENT_BITS, TILE_LOG2 = quadrille_pkg::TILE_LOG2,
    localparam int GRAD = quadrille_pkg::GRAD_BITS, SLOT = quadrille_pkg::QUAD_SLOTS_LOG2
) (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    input logic [quadrille_pkg::STATE_BITS-1:0] state_i,
    // Emission: pixels of a row, those of a homogeneous quad valid with their last part; their tile, its quad's
    // gradients
    input logic [quadrille_pkg::PIXELS_BITS-1:0] pixels_i,
    input logic [quadrille_pkg::CONTEXT_BITS-1:0] tile_i,
    input logic [6*GRAD-1:0] lin_gx_i, lin_gy_i,
    // Vertex bank
    output logic [quadrille_pkg::READS_BITS-1:0] reads_o,
    input logic [quadrille_pkg::TERMS_BITS-1:0] terms_i,
    output logic release_o,  // the end beat of a quad is in the last register; of this slot
    output logic [SLOT-1:0] release_slot_o,
    // Fragments
    output logic discard_o,  // pixels of which none is a fragment, in the clock in which they would have been
    output logic [P*quadrille_pkg::LATENCY-1:0] lane_valid_o,  // a pixel is in register n of a lane
    output logic [P-1:0] count_norm_o,  // for performance_counters, else 0: a lane takes on the numbers of its pixel
    output logic [P-1:0] count_area_o,  // at RATIO_STAGE: a lane's weights are areas
    output logic [P-1:0] fragment_valid_o,
    output logic [P*FB-1:0] fragment_o  // zero in a lane without a fragment
);
  `QUADRILLE_IN(`QUADRILLE_PIXELS_T, pixels)
  `QUADRILLE_IN(`QUADRILLE_CONTEXT_T, tile)
  `QUADRILLE_READS_T reads;
  // Registers at the boundaries
  localparam int DIFF = quadrille_pkg::DIFF_STAGE, RATIO = quadrille_pkg::RATIO_STAGE;
  localparam int OVERRIDE = quadrille_pkg::OVERRIDE_STAGE, WEIGHT = quadrille_pkg::WEIGHT_STAGE;
  localparam int LAST = quadrille_pkg::LATENCY - 1;  // the output register

  logic [LAST:0] end_q;
  logic [P-1:0] pixel;  // in the last register, drawn or discarded
  assign release_o = end_q[LAST];
  assign discard_o = pixel != '0 && fragment_valid_o == '0;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) end_q <= '0;
    else end_q <= {end_q[LAST-1:0], pixels.end_token};
  end

  // ---- Side band: slot, tile column, row ---------------------------------------------------------------------------
  // A read of the slot bank ends in a register: the slot leaves two registers before the data's user; three for
  // interpolation, bases and squared lengths, whose memories have a register of their own.
  typedef struct packed {
    logic [SLOT-1:0] slot;
    logic [V-TILE_LOG2-1:0] tile_x;
    logic [V-1:0] y;
  } tag_t;
  localparam int TAG = SLOT + V - TILE_LOG2 + V;
  tag_t tag, diff_tag, product_tag, override_tag, blend_tag, base_tag, output_tag;

  assign tag.slot = tile.slot;
  assign tag.tile_x = tile.tile_x[V-TILE_LOG2-1:0];
  assign tag.y = {tile.tile_y[V-TILE_LOG2-1:0], pixels.row};

  quadrille_delay_line #(.WIDTH(TAG), .DEPTH(DIFF + 1)) u_diff_tag (.clk_i, .data_i(tag), .data_o(diff_tag));
  quadrille_delay_line #(.WIDTH(TAG), .DEPTH(RATIO - 1 - DIFF)) u_product_tag (.clk_i, .data_i(diff_tag),
      .data_o(product_tag));
  quadrille_delay_line #(.WIDTH(TAG), .DEPTH(OVERRIDE - 1 - RATIO)) u_override_tag (
      .clk_i, .data_i(product_tag), .data_o(override_tag)
  );
  quadrille_delay_line #(.WIDTH(TAG), .DEPTH(WEIGHT - OVERRIDE)) u_blend_tag (.clk_i, .data_i(override_tag),
      .data_o(blend_tag));
  quadrille_delay_line #(.WIDTH(TAG), .DEPTH(LAST - 3 - WEIGHT)) u_base_tag (.clk_i, .data_i(blend_tag),
      .data_o(base_tag));
  quadrille_delay_line #(.WIDTH(TAG), .DEPTH(3)) u_output_tag (.clk_i, .data_i(base_tag), .data_o(output_tag));

  tag_t fragment_tag;  // output_tag in step with what was read
  logic [SLOT-1:0] length2_slot;
  assign reads.length2 = length2_slot;
  assign reads.norm = diff_tag.slot;
  assign reads.product = product_tag.slot;
  assign reads.overrides = override_tag.slot;
  assign reads.blend = blend_tag.slot;
  assign reads.base = base_tag.slot;
  assign reads.outputs = output_tag.slot;
  assign reads_o = reads;

  logic [SLOT-1:0] output_slot_q;

  always_ff @(posedge clk_i) begin
    fragment_tag <= output_tag;
    {release_slot_o, output_slot_q} <= {output_slot_q, output_tag.slot};
  end

  // ---- The row: value + r gy of all functions ----------------------------------------------------------------------
  logic [quadrille_pkg::ROW_BITS-1:0] line;
  quadrille_row_functions u_row (
      .clk_i, .row_digits_i(pixels.row_digits), .tile_i, .gx_i(lin_gx_i), .gy_i(lin_gy_i), .row_o(line)
  );

  // What law_of_cosines needs of quad and part; both come to it a clock after the squared distances.
  localparam int DIFFERENCE = quadrille_pkg::FORWARD_DIFFERENCE_STAGES;
  logic [1:0] part;
  logic squares_q;
  quadrille_delay_line #(.WIDTH(2), .DEPTH(DIFFERENCE)) u_part (.clk_i, .data_i(pixels.part), .data_o(part));
  quadrille_delay_line #(.WIDTH(SLOT), .DEPTH(DIFFERENCE - 1)) u_length2_slot (
      .clk_i, .data_i(tile.slot), .data_o(length2_slot)
  );

  always_ff @(posedge clk_i) squares_q <= part == quadrille_pkg::PART_SQUARES;

  // ---- The pixels --------------------------------------------------------------------------------------------------
  for (genvar g = 0; g < P; g++) begin : gen_lane
    assign pixel[g] = lane_valid_o[g*quadrille_pkg::LATENCY+LAST];

    quadrille_pixel_lane u_lane (
        .clk_i, .rst_ni, .state_i, .valid_i(pixels.valid[g]), .row_i(pixels.row),
        .dx_i(pixels.dx[g*TILE_LOG2+:TILE_LOG2]), .front_i(pixels.front[g]), .tie_i(pixels.tie[g]), .line_i(line),
        .part_i(part), .squares_i(squares_q), .terms_i, .output_tile_x_i(fragment_tag.tile_x),
        .output_y_i(fragment_tag.y), .valid_o(lane_valid_o[g*quadrille_pkg::LATENCY+:quadrille_pkg::LATENCY]),
        .events_o({count_norm_o[g], count_area_o[g]}), .fragment_valid_o(fragment_valid_o[g]),
        .fragment_o(fragment_o[g*FB+:FB])
    );
  end

  logic unused;
  assign unused = ^fragment_tag.slot;

`ifndef SYNTHESIS
  // An end beat carries no pixel.
  always_ff @(posedge clk_i) if (rst_ni) `QUADRILLE_ASSERT(assert_end_alone,
      pixel == '0 || !end_q[LAST],
      "an end entry has no pixels")
`endif
endmodule
