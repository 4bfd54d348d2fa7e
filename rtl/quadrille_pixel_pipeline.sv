// SPDX-License-Identifier: Apache-2.0
`include "quadrille_assert.svh"

// From pixels' positions to their fragments, PIXELS_PER_CLOCK a clock: a pipeline of LATENCY registers that never waits.
//
// The pixels of a clock are of one row of one tile. What they have in common is here: that row's values, the slot index, which travels
// with them, and what is read from the slot bank by it, one register before its users; all else is in pixel_lane.
// Register n is written n clocks after the pixels enter. The boundaries between units have the registers quadrille_pkg::DIFF_STAGE to
// FRAGMENT_STAGE (SPEC.md, Pixel pipeline). An end beat (end, no lane valid) travels with the pixels; at the last register it releases its slot.
module quadrille_pixel_pipeline #(
    localparam int P = quadrille_pkg::PIXELS_PER_CLOCK,
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int PE = quadrille_pkg::PORT_EXP_BITS,
    localparam int N = quadrille_pkg::ATTRIBUTE_SLOTS,
    localparam int V = quadrille_pkg::VIEWPORT_BITS,
    localparam int DB = quadrille_pkg::DEPTH_BITS,
    localparam int ID = quadrille_pkg::QUAD_ID_BITS,
    localparam int FB = quadrille_pkg::FRAGMENT_BITS,
    localparam int TILE_LOG2 = quadrille_pkg::TILE_LOG2,
    localparam int OFFSET_DIGITS = TILE_LOG2 / 2 + 1,
    localparam int VAL = quadrille_pkg::VAL_BITS,
    localparam int GRAD = quadrille_pkg::GRAD_BITS,
    localparam int QVAL = quadrille_pkg::QVAL_BITS,
    localparam int QGRAD = quadrille_pkg::QGRAD_BITS,
    localparam int QCURV = quadrille_pkg::QCURV_BITS,
    localparam int LENGTH2 = quadrille_pkg::LENGTH2_BITS,
    localparam int SLOT = quadrille_pkg::QUAD_SLOTS_LOG2,
    localparam int AO = quadrille_pkg::ATTR_OUT_BITS,
    localparam int LIMITS = quadrille_pkg::DEPTH_LIMIT_BITS,
    localparam int TERMS = quadrille_pkg::BLEND_TERMS,
    localparam int SETS = 3 + N
) (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    // Draw state
    input logic hold_i,  // operands that nothing depends on do not switch (skip bit 4)
    input logic depth_on_i,
    input logic [3:0] attributes_i,
    // Emission: the pixels' row. Those of a homogeneous quad are valid with their last part
    input logic end_i,
    input logic [1:0] part_i,
    input logic [SLOT-1:0] slot_i,
    input logic [V-TILE_LOG2-1:0] tile_x_i,
    input logic [V-1:0] y_i,
    input logic [2*OFFSET_DIGITS-1:0] row_digits_i,
    input logic [6*VAL-1:0] lin_value_i,
    input logic [6*GRAD-1:0] lin_gx_i,
    input logic [6*GRAD-1:0] lin_gy_i,
    input logic [4*QVAL-1:0] quad_value_i,
    input logic [4*QGRAD-1:0] quad_gx_i,
    input logic [4*QGRAD-1:0] quad_gy_i,
    input logic [4*QCURV-1:0] quad_q_i,
    // The pixel of each lane
    input logic [P-1:0] valid_i,
    input logic [P*TILE_LOG2-1:0] dx_i,
    input logic [P-1:0] front_i,
    input logic [P-1:0] tie_i,
    // Slot bank
    output logic [SLOT-1:0] length2_slot_o,
    input logic [6*LENGTH2-1:0] length2_i,
    output logic [SLOT-1:0] norm_slot_o,
    input logic norm_plane_i,
    output logic [SLOT-1:0] product_slot_o,
    input logic [3:0] product_k_neg_i,
    input logic [4*PE-1:0] product_k_exp_i,
    input logic [4*S-1:0] product_k_sig_i,
    output logic [SLOT-1:0] override_slot_o,
    input logic [4*PE-1:0] override_k_exp_i,
    input logic [4*S-1:0] override_k_sig_i,
    output logic [SLOT-1:0] blend_slot_o,
    input logic [TERMS-1:0] blend_neg_i,
    input logic [TERMS*PE-1:0] blend_exp_i,
    input logic [TERMS*S-1:0] blend_sig_i,
    input logic blend_hull_i,
    output logic [SLOT-1:0] base_slot_o,
    input logic [N*AO-1:0] base_attr_i,
    input logic [DB:0] base_depth_i,
    input logic [LIMITS-1:0] base_limits_i,
    output logic [SLOT-1:0] output_slot_o,
    input logic [ID-1:0] output_id_i,
    input logic output_hull_i,
    input logic output_homogeneous_i,
    output logic release_o,
    // Fragments
    output logic discard_o,  // pixels of which none is a fragment, in the clock in which they would have been
    output logic [P*quadrille_pkg::LATENCY-1:0] lane_valid_o,  // a pixel is in register n of a lane
    output logic [P-1:0] count_norm_o,  // for performance_counters, else 0: a lane takes on the numbers of its pixel
    output logic [P-1:0] count_area_o,  // at RATIO_STAGE: a lane's weights are areas
    output logic [SETS-1:0] count_sum_o,  // the sums that are not of zeros
    output logic [P-1:0] fragment_valid_o,
    output logic [P*FB-1:0] fragment_o  // zero in a lane without a fragment
);
  // Registers at the boundaries
  localparam int DIFF = quadrille_pkg::DIFF_STAGE;
  localparam int RATIO = quadrille_pkg::RATIO_STAGE;
  localparam int OVERRIDE = quadrille_pkg::OVERRIDE_STAGE;
  localparam int WEIGHT = quadrille_pkg::WEIGHT_STAGE;
  localparam int LAST = quadrille_pkg::LATENCY - 1;  // the output register

  logic [LAST:0] end_q;
  logic [P-1:0] pixel;  // in the last register, drawn or discarded

  assign release_o = end_q[LAST];
  assign discard_o = pixel != '0 && fragment_valid_o == '0;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) end_q <= '0;
    else end_q <= {end_q[LAST-1:0], end_i};
  end

  // ---- Side band: slot, tile column, row -----------------------------------------------------------------------------------
  // A read of the slot bank ends in a register: the slot leaves two registers before the data's user; three for interpolation, bases
  // and squared lengths, whose memories have a register of their own.
  typedef struct packed {
    logic [SLOT-1:0] slot;
    logic [V-TILE_LOG2-1:0] tile_x;
    logic [V-1:0] y;
  } tag_t;
  localparam int TAG = SLOT + V - TILE_LOG2 + V;
  tag_t diff_tag, product_tag, override_tag, blend_tag, base_tag, output_tag;

  quadrille_delay_line #(.WIDTH(TAG), .DEPTH(DIFF + 1)) u_diff_tag (.clk_i, .data_i({slot_i, tile_x_i, y_i}), .data_o(diff_tag));
  quadrille_delay_line #(.WIDTH(TAG), .DEPTH(RATIO - 1 - DIFF)) u_product_tag (.clk_i, .data_i(diff_tag), .data_o(product_tag));
  quadrille_delay_line #(.WIDTH(TAG), .DEPTH(OVERRIDE - 1 - RATIO)) u_override_tag (
      .clk_i,
      .data_i(product_tag),
      .data_o(override_tag)
  );
  quadrille_delay_line #(.WIDTH(TAG), .DEPTH(WEIGHT - OVERRIDE)) u_blend_tag (.clk_i, .data_i(override_tag), .data_o(blend_tag));
  quadrille_delay_line #(.WIDTH(TAG), .DEPTH(LAST - 3 - WEIGHT)) u_base_tag (.clk_i, .data_i(blend_tag), .data_o(base_tag));
  quadrille_delay_line #(.WIDTH(TAG), .DEPTH(3)) u_output_tag (.clk_i, .data_i(base_tag), .data_o(output_tag));

  // ---- Reads of the slot bank -----------------------------------------------------------------------------------------------
  logic norm_plane;
  logic [3:0] product_k_neg;
  logic [4*PE-1:0] product_k_exp, override_k_exp;
  logic [4*S-1:0] product_k_sig, override_k_sig;
  logic [TERMS-1:0] blend_neg;
  logic [TERMS*PE-1:0] blend_exp;
  logic [TERMS*S-1:0] blend_sig;
  logic [N*AO-1:0] base_attr;
  logic [DB:0] base_depth;
  logic [LIMITS-1:0] limits_q, base_limits;
  logic [ID-1:0] output_id;
  logic output_hull, output_homogeneous;
  tag_t fragment_tag;  // output_tag in step with what was read

  assign norm_slot_o = diff_tag.slot;
  assign product_slot_o = product_tag.slot;
  assign override_slot_o = override_tag.slot;
  assign blend_slot_o = blend_tag.slot;
  assign base_slot_o = base_tag.slot;
  assign output_slot_o = output_tag.slot;

  always_ff @(posedge clk_i) begin
    norm_plane <= norm_plane_i;
    product_k_neg <= product_k_neg_i;
    product_k_exp <= product_k_exp_i;
    product_k_sig <= product_k_sig_i;
    override_k_exp <= override_k_exp_i;
    override_k_sig <= override_k_sig_i;
    base_attr <= base_attr_i;
    base_depth <= base_depth_i;
    {base_limits, limits_q} <= {limits_q, base_limits_i};  // used a clock after the bases
    output_id <= output_id_i;
    output_hull <= output_hull_i;
    output_homogeneous <= output_homogeneous_i;
    fragment_tag <= output_tag;
  end

  // Sums that the fragment does not depend on are those of zeros, by the registers' reset: neither their products nor what follows
  // from them switches. k_eff divides the attributes; W divides Z and says, of a quad whose hull holds the eye, what is behind it.
  logic [SETS-1:0] sum_active;

  assign sum_active[0] = !hold_i || attributes_i != '0;
  assign sum_active[1] = !hold_i || depth_on_i || blend_hull_i;
  assign sum_active[2] = !hold_i || depth_on_i;

  for (genvar g = 0; g < SETS; g++) begin : gen_term
    localparam int CORNERS = (g < 3) ? 4 : 3;
    localparam int FIRST = (g < 3) ? 4 * g : 12 + 3 * (g - 3);

    if (g >= 3) begin : gen_attribute
      assign sum_active[g] = !hold_i || attributes_i > 4'(g - 3);
    end

    always_ff @(posedge clk_i) begin
      blend_neg[FIRST+:CORNERS] <= blend_neg_i[FIRST+:CORNERS];
      blend_exp[FIRST*PE+:CORNERS*PE] <= blend_exp_i[FIRST*PE+:CORNERS*PE];
      blend_sig[FIRST*S+:CORNERS*S] <= blend_sig_i[FIRST*S+:CORNERS*S];
      if (!sum_active[g]) begin
        blend_neg[FIRST+:CORNERS] <= '0;
        blend_exp[FIRST*PE+:CORNERS*PE] <= '0;
        blend_sig[FIRST*S+:CORNERS*S] <= '0;
      end
    end
  end

  assign count_sum_o = quadrille_pkg::PERFORMANCE_COUNTERS != 0 ? sum_active : '0;

  // ---- The row: value + r gy of all functions ---------------------------------------------------------------------------------
  logic [TILE_LOG2-1:0] row;
  logic [6*VAL-1:0] lin_row;
  logic [6*GRAD-1:0] lin_gx;
  logic [4*QVAL-1:0] quad_row;
  logic [4*QGRAD-1:0] quad_gx;
  logic [4*QCURV-1:0] quad_q;

  assign row = y_i[TILE_LOG2-1:0];

  quadrille_row_functions u_row (
      .clk_i,
      .row_digits_i,
      .lin_value_i,
      .lin_gx_i,
      .lin_gy_i,
      .quad_value_i,
      .quad_gx_i,
      .quad_gy_i,
      .quad_q_i,
      .lin_row_o(lin_row),
      .lin_gx_o(lin_gx),
      .quad_row_o(quad_row),
      .quad_gx_o(quad_gx),
      .quad_q_o(quad_q)
  );

  // What law_of_cosines needs of quad and part; both come to it a clock after the squared distances.
  localparam int DIFFERENCE = quadrille_pkg::FORWARD_DIFFERENCE_STAGES;
  logic [1:0] part;
  logic squares_q;
  logic [6*LENGTH2-1:0] length2_q;

  quadrille_delay_line #(.WIDTH(2), .DEPTH(DIFFERENCE)) u_part (
      .clk_i,
      .data_i(part_i),
      .data_o(part)
  );
  quadrille_delay_line #(.WIDTH(SLOT), .DEPTH(DIFFERENCE - 1)) u_length2_slot (
      .clk_i,
      .data_i(slot_i),
      .data_o(length2_slot_o)
  );

  always_ff @(posedge clk_i) begin
    squares_q <= part == quadrille_pkg::PART_SQUARES;
    length2_q <= length2_i;
  end

  // ---- The pixels -------------------------------------------------------------------------------------------------------------
  for (genvar g = 0; g < P; g++) begin : gen_lane
    assign pixel[g] = lane_valid_o[g*quadrille_pkg::LATENCY+LAST];

    quadrille_pixel_lane u_lane (
        .clk_i,
        .rst_ni,
        .hold_i,
        .depth_on_i,
        .attributes_i,
        .valid_i(valid_i[g]),
        .row_i(row),
        .dx_i(dx_i[g*TILE_LOG2+:TILE_LOG2]),
        .front_i(front_i[g]),
        .tie_i(tie_i[g]),
        .lin_row_i(lin_row),
        .lin_gx_i(lin_gx),
        .quad_row_i(quad_row),
        .quad_gx_i(quad_gx),
        .quad_q_i(quad_q),
        .part_i(part),
        .squares_i(squares_q),
        .length2_i(length2_q),
        .norm_plane_i(norm_plane),
        .product_k_neg_i(product_k_neg),
        .product_k_exp_i(product_k_exp),
        .product_k_sig_i(product_k_sig),
        .override_k_exp_i(override_k_exp),
        .override_k_sig_i(override_k_sig),
        .blend_neg_i(blend_neg),
        .blend_exp_i(blend_exp),
        .blend_sig_i(blend_sig),
        .base_attr_i(base_attr),
        .base_depth_i(base_depth),
        .base_limits_i(base_limits),
        .output_id_i(output_id),
        .output_hull_i(output_hull),
        .output_homogeneous_i(output_homogeneous),
        .output_tile_x_i(fragment_tag.tile_x),
        .output_y_i(fragment_tag.y),
        .valid_o(lane_valid_o[g*quadrille_pkg::LATENCY+:quadrille_pkg::LATENCY]),
        .count_norm_o(count_norm_o[g]),
        .count_area_o(count_area_o[g]),
        .fragment_valid_o(fragment_valid_o[g]),
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
