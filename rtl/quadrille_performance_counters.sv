// SPDX-License-Identifier: Apache-2.0
`include "quadrille_types.svh"
// What the machine did since reset: quads by what became of them, blocks and tiles, rows and stamps, pixels and
// fragments, products by unit, and clocks by what bound them. SPEC.md says which clock counts what. Read by index; a
// counter wraps around at 2^COUNTER_BITS.
//
// All inputs are of this clock; what they say is counted at its end, but for norm_active_i, norm_plane_i and
// sum_active_i, which are of operands on their way to the units that make products of them. Nothing of the machine
// depends on value_o.
module quadrille_performance_counters #(
    localparam int P = quadrille_pkg::PIXELS_PER_CLOCK, N = quadrille_pkg::ATTRIBUTE_SLOTS,
    localparam int PAIRS = quadrille_pkg::PRODUCT_PAIRS, LATENCY = quadrille_pkg::LATENCY, SETS = 3 + N,
    localparam int INDEX = quadrille_pkg::COUNTER_INDEX_BITS, WIDTH = quadrille_pkg::COUNTER_BITS
) (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    input logic [INDEX-1:0] index_i,
    output logic [WIDTH-1:0] value_o,  // 0 beyond the last counter
    input logic take_i,  // the walk takes a quad
    input logic homogeneous_i, busy_i,
    input logic [quadrille_pkg::FRONT_EVENTS_BITS-1:0] front_i,
    input logic [quadrille_pkg::TILES_EVENTS_BITS-1:0] tiles_i,
    input logic [quadrille_pkg::PIXEL_EVENTS_BITS-1:0] pixel_i
);
  if (quadrille_pkg::PERFORMANCE_COUNTERS != 0) begin : gen_counters
    `QUADRILLE_IN(`QUADRILLE_FRONT_EVENTS_T, front)
    `QUADRILLE_IN(`QUADRILLE_TILES_EVENTS_T, tiles)
    `QUADRILLE_IN(`QUADRILLE_PIXEL_EVENTS_T, pixel)
    logic [P*LATENCY-1:0] lane_valid;
    logic [P-1:0] lanes_drawn, lanes_area;
    assign {lane_valid, lanes_drawn, lanes_area} = {pixel.lane_valid, pixel.drawn, pixel.area};

    // ---- Pixels in front of a unit with multipliers, and its products a pixel --------------------------------------
    localparam int ROOTS = 4, PAIRS_OF_VERTICES = 6, RATIOS = 3, WEIGHTS = 4;
    localparam int PER_SQRT = ROOTS * quadrille_pkg::SQRT_DEGREE, PER_RATIO = PAIRS_OF_VERTICES;
    // of mean_value_weights, up to the ratios of roots
    localparam int PER_WEIGHT_RATIO = RATIOS * (2 + quadrille_pkg::SQRT_DEGREE + 1);
    localparam int PER_WEIGHT_FACTOR = 2 * WEIGHTS;  // and behind them
    localparam int PER_SUM = WEIGHTS;  // an attribute's has one less: none of corner 0
    localparam int PER_RECIPROCAL = quadrille_pkg::RECIP_DEGREE;
    localparam int PER_JOB = 4;  // a pair: two dot units of two products each

    localparam int BEFORE_OUTPUT = quadrille_pkg::FRAGMENT_STAGE - quadrille_pkg::FRAGMENT_OUTPUT_STAGES;
    localparam int COUNT = $clog2(P + 1), SUMS = $clog2(quadrille_pkg::BLEND_TERMS + 1);

    // Lanes whose numbers are not those of a pixel before, at the units between normalise and the ratios of roots.
    logic [P-1:0] norm_active, root_active, ratio_active;
    quadrille_delay_line #(.WIDTH(P), .DEPTH(1)) u_norm_active (
        .clk_i, .data_i(pixel.norm_active), .data_o(norm_active)
    );
    quadrille_delay_line #(.WIDTH(P), .DEPTH(quadrille_pkg::ROOT_STAGE - quadrille_pkg::NORM_STAGE)) u_root_active (
        .clk_i, .data_i(norm_active), .data_o(root_active)
    );
    quadrille_delay_line #(.WIDTH(P), .DEPTH(quadrille_pkg::RATIO_STAGE - quadrille_pkg::ROOT_STAGE)) u_ratio_active (
        .clk_i, .data_i(root_active), .data_o(ratio_active)
    );

    logic norm_plane;  // of the pixels in NORM_STAGE
    quadrille_delay_line #(.WIDTH(1), .DEPTH(3)) u_norm_plane (.clk_i, .data_i(pixel.norm_plane), .data_o(norm_plane));

    // Sums that are not of zeros: k, W, Z, attributes. The pixels of a clock are of one quad.
    logic [SETS-1:0] sum_active, quotient_active, output_active;
    quadrille_delay_line #(.WIDTH(SETS), .DEPTH(1)) u_sum_active (
        .clk_i, .data_i(pixel.sum_active), .data_o(sum_active)
    );
    quadrille_delay_line #(
        .WIDTH(SETS),
        .DEPTH(quadrille_pkg::SUM_STAGE - quadrille_pkg::WEIGHT_STAGE)
    ) u_quotient_active (.clk_i, .data_i(sum_active), .data_o(quotient_active));
    quadrille_delay_line #(.WIDTH(SETS), .DEPTH(BEFORE_OUTPUT - quadrille_pkg::SUM_STAGE)) u_output_active (
        .clk_i, .data_i(quotient_active), .data_o(output_active)
    );

    logic [COUNT-1:0] at_norm, at_sqrt, at_ratio, at_weight_ratio, at_weight, at_sum, at_reciprocal, at_output, drawn;
    logic [SUMS-1:0] terms, denominators, quotients;

    always_comb begin
      {at_norm, at_sqrt, at_ratio, at_weight_ratio, at_weight, at_sum, at_reciprocal, at_output, drawn} = '0;
      for (int g = 0; g < P; g++) begin
        at_norm = at_norm + COUNT'(lane_valid[g*LATENCY+quadrille_pkg::NORM_STAGE]);
        at_sqrt = at_sqrt + COUNT'(lane_valid[g*LATENCY+quadrille_pkg::NORM_STAGE] && norm_active[g]);
        at_ratio = at_ratio + COUNT'(lane_valid[g*LATENCY+quadrille_pkg::ROOT_STAGE] && root_active[g]);
        at_weight_ratio = at_weight_ratio + COUNT'(lane_valid[g*LATENCY+quadrille_pkg::RATIO_STAGE] && ratio_active[g]);
        at_weight = at_weight + COUNT'(lane_valid[g*LATENCY+quadrille_pkg::RATIO_STAGE] && !lanes_area[g]);
        at_sum = at_sum + COUNT'(lane_valid[g*LATENCY+quadrille_pkg::WEIGHT_STAGE]);
        at_reciprocal = at_reciprocal + COUNT'(lane_valid[g*LATENCY+quadrille_pkg::SUM_STAGE]);
        at_output = at_output + COUNT'(lane_valid[g*LATENCY+BEFORE_OUTPUT]);
        drawn = drawn + COUNT'(lanes_drawn[g]);
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
    assign unused = ^pixel.lane_valid;

    // ---- What bounds this clock: the first that holds --------------------------------------------------------------
    localparam int BOUNDS = 9;
    logic [BOUNDS-1:0] bound;  // from the first bit: pixels, output, stamps, walk, setup, vertices, wipe, drain, idle

    always_comb begin
      if (tiles.head) bound = tiles.head_waits ? 9'd2 : 9'd1;
      else if (tiles.rows && tiles.rows_behind) bound = 9'd4;
      else if (front.walk_behind) bound = 9'd8;
      else if (front.setup_behind) bound = 9'd16;
      else if (tiles.rows) bound = 9'd4;
      else if (tiles.walk) bound = 9'd8;
      else if (front.setup) bound = 9'd16;
      else if (front.assembly) bound = 9'd32;
      else if (tiles.wipe) bound = 9'd64;
      else if (busy_i) bound = 9'd128;
      else bound = 9'd256;
    end

    // ---- The counters, in the order of their indices ---------------------------------------------------------------
    localparam int STEP = 8;  // bits of what a clock adds: at most 36 products of the sums in four lanes, 144
    localparam int LANES = 4;  // indices for the pixels of a lane, used or not
    localparam int COUNTERS = 41;
    logic [COUNTERS*STEP-1:0] step;
    logic [COUNTERS*WIDTH-1:0] value_q;
    logic [LANES-1:0] entered;

    for (genvar g = 0; g < LANES; g++) begin : gen_entered
      if (g < P) begin : gen_lane
        assign entered[g] = lane_valid[g*LATENCY];
      end else begin : gen_none
        assign entered[g] = 1'b0;
      end
    end

    assign step[0+:STEP] = STEP'(1);
    assign step[1*STEP+:STEP] = STEP'(front.start || front.drop_vertices);
    assign step[2*STEP+:STEP] = STEP'(front.drop_vertices && front.empty);
    assign step[3*STEP+:STEP] = STEP'(front.drop_vertices && !front.empty && front.behind);
    assign step[4*STEP+:STEP] = STEP'(front.drop_vertices && !front.empty && !front.behind);
    assign step[5*STEP+:STEP] = STEP'(front.drop && front.drop_line);
    assign step[6*STEP+:STEP] = STEP'(front.drop && !front.drop_line);
    assign step[7*STEP+:STEP] = STEP'(take_i && !homogeneous_i);
    assign step[8*STEP+:STEP] = STEP'(take_i && homogeneous_i);
    assign step[9*STEP+:STEP] = STEP'(front.start && front.plane);
    assign step[10*STEP+:STEP] = STEP'(tiles.block_test);
    assign step[11*STEP+:STEP] = STEP'(tiles.block_enter);
    assign step[12*STEP+:STEP] = STEP'(tiles.block_hidden);
    assign step[13*STEP+:STEP] = STEP'(tiles.tile_test);
    assign step[14*STEP+:STEP] = STEP'(tiles.tile_push);
    assign step[15*STEP+:STEP] = STEP'(tiles.tile_hidden);
    assign step[16*STEP+:STEP] = STEP'(tiles.tile_masked);
    assign step[17*STEP+:STEP] = STEP'(tiles.row);
    assign step[18*STEP+:STEP] = STEP'(tiles.stamp_push);
    for (genvar g = 0; g < LANES; g++) begin : gen_pixels
      assign step[(19+g)*STEP+:STEP] = STEP'(entered[g]);
    end
    assign step[23*STEP+:STEP] = norm_plane ? STEP'(at_norm) : '0;
    assign step[24*STEP+:STEP] = STEP'(drawn);
    assign step[25*STEP+:STEP] = (tiles.context_job || front.setup_job) ? STEP'(PAIRS * PER_JOB) : '0;
    assign step[26*STEP+:STEP] = STEP'(at_sqrt) * STEP'(PER_SQRT);
    assign step[27*STEP+:STEP] = STEP'(at_ratio) * STEP'(PER_RATIO);
    assign step[28*STEP+:STEP] = STEP'(at_weight_ratio) * STEP'(PER_WEIGHT_RATIO) +
        STEP'(at_weight) * STEP'(PER_WEIGHT_FACTOR);
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
  end else begin : gen_no_counters
    logic unused;
    assign unused = ^{clk_i, rst_ni, index_i, take_i, homogeneous_i, busy_i, front_i, tiles_i, pixel_i};
    assign value_o = '0;
  end
endmodule
