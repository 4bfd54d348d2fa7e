// SPDX-License-Identifier: Apache-2.0
// What the machine did since reset: quads by what became of them, blocks and tiles, rows and stamps, pixels and fragments, products by unit,
// and clocks by what bound them. SPEC.md says which clock counts what. Read by index; a counter wraps around at 2^COUNTER_BITS.
//
// All inputs are of this clock; what they say is counted at its end, but for norm_active_i, norm_plane_i and sum_active_i, which are of operands
// on their way to the units that make products of them. Nothing of the machine depends on value_o.
module quadrille_performance_counters #(
    localparam int P = quadrille_pkg::PIXELS_PER_CLOCK,
    localparam int N = quadrille_pkg::ATTRIBUTE_SLOTS,
    localparam int PAIRS = quadrille_pkg::PRODUCT_PAIRS,
    localparam int LATENCY = quadrille_pkg::LATENCY,
    localparam int SETS = 3 + N,
    localparam int INDEX = quadrille_pkg::COUNTER_INDEX_BITS,
    localparam int WIDTH = quadrille_pkg::COUNTER_BITS
) (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    input logic [INDEX-1:0] index_i,
    output logic [WIDTH-1:0] value_o,  // 0 beyond the last counter
    // Quads
    input logic start_i,  // setup takes the quad of vertex_assembly
    input logic plane_i,  // which is a plane_quad
    input logic drop_vertices_i,  // or it is left out, for the first of these that holds, else by its depth
    input logic empty_i,
    input logic behind_i,
    input logic drop_i,  // setup leaves a quad out: on a line, or culled
    input logic drop_line_i,
    input logic take_i,  // the walk takes a quad
    input logic homogeneous_i,
    // Walk and coverage
    input logic block_test_i,
    input logic block_enter_i,
    input logic block_hidden_i,
    input logic tile_test_i,
    input logic tile_push_i,
    input logic tile_hidden_i,
    input logic tile_masked_i,  // coverage leaves a tile's rows out
    input logic row_i,  // and tests a row
    input logic stamp_push_i,
    // Pixels
    input logic [P*LATENCY-1:0] lane_valid_i,  // the pipeline's registers, those of a lane side by side
    input logic [P-1:0] drawn_i,  // fragments in the last one
    input logic [P-1:0] norm_active_i,  // a clock before NORM_STAGE: the lane takes the numbers on
    input logic [P-1:0] area_i,  // at RATIO_STAGE: the lane's weights are areas, which are not multiplied
    input logic norm_plane_i,  // three clocks before NORM_STAGE: the pixels are of a plane_quad
    input logic [SETS-1:0] sum_active_i,  // a clock before WEIGHT_STAGE: the terms of k, W, Z and the attributes are not held at 0
    // Dot units
    input logic context_job_i,  // of all pairs
    input logic setup_job_i,
    // What bounds the clock
    input logic head_i,  // emission has a stamp or an end entry
    input logic head_waits_i,  // and no place for its fragments
    input logic rows_i,  // coverage has a tile
    input logic rows_behind_i,  // and another one
    input logic walk_i,  // the walk has a quad
    input logic walk_behind_i,  // a quad waits for it
    input logic setup_i,  // setup has a quad
    input logic setup_behind_i,  // a quad waits for it, or for a slot
    input logic assembly_i,  // vertex_assembly holds vertices
    input logic wipe_i,  // hierarchical_z wipes places
    input logic busy_i
);
  // ---- Pixels in front of a unit with multipliers, and its products a pixel -------------------------------------------------
  localparam int ROOTS = 4;
  localparam int PAIRS_OF_VERTICES = 6;
  localparam int RATIOS = 3;
  localparam int WEIGHTS = 4;
  localparam int PER_SQRT = ROOTS * quadrille_pkg::SQRT_DEGREE;
  localparam int PER_RATIO = PAIRS_OF_VERTICES;
  localparam int PER_WEIGHT_RATIO = RATIOS * (2 + quadrille_pkg::SQRT_DEGREE + 1);  // of mean_value_weights, up to the ratios of roots
  localparam int PER_WEIGHT_FACTOR = 2 * WEIGHTS;  // and behind them
  localparam int PER_SUM = WEIGHTS;  // an attribute's has one less: none of corner 0
  localparam int PER_RECIPROCAL = quadrille_pkg::RECIP_DEGREE;
  localparam int PER_JOB = 4;  // a pair: two dot units of two products each

  localparam int BEFORE_OUTPUT = quadrille_pkg::FRAGMENT_STAGE - quadrille_pkg::FRAGMENT_OUTPUT_STAGES;
  localparam int COUNT = $clog2(P + 1);
  localparam int SUMS = $clog2(quadrille_pkg::BLEND_TERMS + 1);

  // Lanes whose numbers are not those of a pixel before, at the units between normalise and the ratios of roots.
  logic [P-1:0] norm_active, root_active, ratio_active;

  quadrille_delay_line #(
      .WIDTH(P),
      .DEPTH(1)
  ) u_norm_active (
      .clk_i,
      .data_i(norm_active_i),
      .data_o(norm_active)
  );
  quadrille_delay_line #(
      .WIDTH(P),
      .DEPTH(quadrille_pkg::ROOT_STAGE - quadrille_pkg::NORM_STAGE)
  ) u_root_active (
      .clk_i,
      .data_i(norm_active),
      .data_o(root_active)
  );
  quadrille_delay_line #(
      .WIDTH(P),
      .DEPTH(quadrille_pkg::RATIO_STAGE - quadrille_pkg::ROOT_STAGE)
  ) u_ratio_active (
      .clk_i,
      .data_i(root_active),
      .data_o(ratio_active)
  );

  logic norm_plane;  // of the pixels in NORM_STAGE

  quadrille_delay_line #(
      .WIDTH(1),
      .DEPTH(3)
  ) u_norm_plane (
      .clk_i,
      .data_i(norm_plane_i),
      .data_o(norm_plane)
  );

  // Sums that are not of zeros: k, W, Z, attributes. The pixels of a clock are of one quad.
  logic [SETS-1:0] sum_active, quotient_active, output_active;

  quadrille_delay_line #(
      .WIDTH(SETS),
      .DEPTH(1)
  ) u_sum_active (
      .clk_i,
      .data_i(sum_active_i),
      .data_o(sum_active)
  );
  quadrille_delay_line #(
      .WIDTH(SETS),
      .DEPTH(quadrille_pkg::SUM_STAGE - quadrille_pkg::WEIGHT_STAGE)
  ) u_quotient_active (
      .clk_i,
      .data_i(sum_active),
      .data_o(quotient_active)
  );
  quadrille_delay_line #(
      .WIDTH(SETS),
      .DEPTH(BEFORE_OUTPUT - quadrille_pkg::SUM_STAGE)
  ) u_output_active (
      .clk_i,
      .data_i(quotient_active),
      .data_o(output_active)
  );

  logic [COUNT-1:0] at_norm, at_sqrt, at_ratio, at_weight_ratio, at_weight, at_sum, at_reciprocal, at_output, drawn;
  logic [SUMS-1:0] terms, denominators, quotients;

  always_comb begin
    {at_norm, at_sqrt, at_ratio, at_weight_ratio, at_weight, at_sum, at_reciprocal, at_output, drawn} = '0;
    for (int g = 0; g < P; g++) begin
      at_norm = at_norm + COUNT'(lane_valid_i[g*LATENCY+quadrille_pkg::NORM_STAGE]);
      at_sqrt = at_sqrt + COUNT'(lane_valid_i[g*LATENCY+quadrille_pkg::NORM_STAGE] && norm_active[g]);
      at_ratio = at_ratio + COUNT'(lane_valid_i[g*LATENCY+quadrille_pkg::ROOT_STAGE] && root_active[g]);
      at_weight_ratio = at_weight_ratio + COUNT'(lane_valid_i[g*LATENCY+quadrille_pkg::RATIO_STAGE] && ratio_active[g]);
      at_weight = at_weight + COUNT'(lane_valid_i[g*LATENCY+quadrille_pkg::RATIO_STAGE] && !area_i[g]);
      at_sum = at_sum + COUNT'(lane_valid_i[g*LATENCY+quadrille_pkg::WEIGHT_STAGE]);
      at_reciprocal = at_reciprocal + COUNT'(lane_valid_i[g*LATENCY+quadrille_pkg::SUM_STAGE]);
      at_output = at_output + COUNT'(lane_valid_i[g*LATENCY+BEFORE_OUTPUT]);
      drawn = drawn + COUNT'(drawn_i[g]);
    end
    terms = '0;
    quotients = '0;
    for (int g = 0; g < SETS; g++) begin
      if (sum_active[g]) terms = terms + SUMS'((g < 3) ? PER_SUM : PER_SUM - 1);
      if (g >= 2) quotients = quotients + SUMS'(output_active[g]);  // z and the attributes
    end
    denominators = SUMS'(quotient_active[0]) + SUMS'(quotient_active[1]);
  end

  logic unused;
  assign unused = ^lane_valid_i;

  // ---- What bounds this clock: the first that holds -------------------------------------------------------------------------
  localparam int BOUNDS = 9;
  logic [BOUNDS-1:0] bound;  // from the first bit: pixels, output, stamps, walk, setup, vertices, wipe, drain, idle

  always_comb begin
    if (head_i) bound = head_waits_i ? 9'd2 : 9'd1;
    else if (rows_i && rows_behind_i) bound = 9'd4;
    else if (walk_behind_i) bound = 9'd8;
    else if (setup_behind_i) bound = 9'd16;
    else if (rows_i) bound = 9'd4;
    else if (walk_i) bound = 9'd8;
    else if (setup_i) bound = 9'd16;
    else if (assembly_i) bound = 9'd32;
    else if (wipe_i) bound = 9'd64;
    else if (busy_i) bound = 9'd128;
    else bound = 9'd256;
  end

  // ---- The counters, in the order of their indices --------------------------------------------------------------------------
  localparam int STEP = 8;  // bits of what a clock adds: at most 36 products of the sums in four lanes, 144
  localparam int LANES = 4;  // indices for the pixels of a lane, used or not
  localparam int COUNTERS = 41;
  logic [COUNTERS*STEP-1:0] step;
  logic [COUNTERS*WIDTH-1:0] value_q;
  logic [LANES-1:0] entered;

  for (genvar g = 0; g < LANES; g++) begin : gen_entered
    if (g < P) begin : gen_lane
      assign entered[g] = lane_valid_i[g*LATENCY];
    end else begin : gen_none
      assign entered[g] = 1'b0;
    end
  end

  assign step[0+:STEP] = STEP'(1);
  assign step[1*STEP+:STEP] = STEP'(start_i || drop_vertices_i);
  assign step[2*STEP+:STEP] = STEP'(drop_vertices_i && empty_i);
  assign step[3*STEP+:STEP] = STEP'(drop_vertices_i && !empty_i && behind_i);
  assign step[4*STEP+:STEP] = STEP'(drop_vertices_i && !empty_i && !behind_i);
  assign step[5*STEP+:STEP] = STEP'(drop_i && drop_line_i);
  assign step[6*STEP+:STEP] = STEP'(drop_i && !drop_line_i);
  assign step[7*STEP+:STEP] = STEP'(take_i && !homogeneous_i);
  assign step[8*STEP+:STEP] = STEP'(take_i && homogeneous_i);
  assign step[9*STEP+:STEP] = STEP'(start_i && plane_i);
  assign step[10*STEP+:STEP] = STEP'(block_test_i);
  assign step[11*STEP+:STEP] = STEP'(block_enter_i);
  assign step[12*STEP+:STEP] = STEP'(block_hidden_i);
  assign step[13*STEP+:STEP] = STEP'(tile_test_i);
  assign step[14*STEP+:STEP] = STEP'(tile_push_i);
  assign step[15*STEP+:STEP] = STEP'(tile_hidden_i);
  assign step[16*STEP+:STEP] = STEP'(tile_masked_i);
  assign step[17*STEP+:STEP] = STEP'(row_i);
  assign step[18*STEP+:STEP] = STEP'(stamp_push_i);
  for (genvar g = 0; g < LANES; g++) begin : gen_pixels
    assign step[(19+g)*STEP+:STEP] = STEP'(entered[g]);
  end
  assign step[23*STEP+:STEP] = norm_plane ? STEP'(at_norm) : '0;
  assign step[24*STEP+:STEP] = STEP'(drawn);
  assign step[25*STEP+:STEP] = (context_job_i || setup_job_i) ? STEP'(PAIRS * PER_JOB) : '0;
  assign step[26*STEP+:STEP] = STEP'(at_sqrt) * STEP'(PER_SQRT);
  assign step[27*STEP+:STEP] = STEP'(at_ratio) * STEP'(PER_RATIO);
  assign step[28*STEP+:STEP] = STEP'(at_weight_ratio) * STEP'(PER_WEIGHT_RATIO) + STEP'(at_weight) * STEP'(PER_WEIGHT_FACTOR);
  assign step[29*STEP+:STEP] = STEP'(at_sum) * STEP'(terms);
  assign step[30*STEP+:STEP] = STEP'(at_reciprocal) * STEP'(denominators) * STEP'(PER_RECIPROCAL);
  assign step[31*STEP+:STEP] = STEP'(at_output) * STEP'(quotients);
  for (genvar g = 0; g < BOUNDS; g++) begin : gen_bound
    assign step[(32+g)*STEP+:STEP] = STEP'(bound[g]);
  end

  for (genvar g = 0; g < COUNTERS; g++) begin : gen_counter
    always_ff @(posedge clk_i) begin
      if (!rst_ni) value_q[g*WIDTH+:WIDTH] <= '0;
      else value_q[g*WIDTH+:WIDTH] <= value_q[g*WIDTH+:WIDTH] + WIDTH'(step[g*STEP+:STEP]);
    end
  end

  always_comb begin
    value_o = '0;
    for (int i = 0; i < COUNTERS; i++) if (index_i == INDEX'(i)) value_o = value_q[i*WIDTH+:WIDTH];
  end
endmodule
