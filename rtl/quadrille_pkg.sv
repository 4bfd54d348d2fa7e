// SPDX-License-Identifier: Apache-2.0
// Widths and number formats of Quadrille: the only place where a width is computed.
//
// Every configuration key is a macro QUADRILLE_<KEY> (set with -D), with its default here. -1 asks for the automatic
// value
// where SPEC.md, Widths, gives one. Every derived width stands once, with its reason. All are `verilator public`, so
// that the C++ model reads back the very numbers that the RTL was built with.
`ifndef QUADRILLE_VIEWPORT_BITS
`define QUADRILLE_VIEWPORT_BITS 12
`endif
`ifndef QUADRILLE_GUARD_BITS
`define QUADRILLE_GUARD_BITS 3
`endif
`ifndef QUADRILLE_SUBPIXEL_BITS
`define QUADRILLE_SUBPIXEL_BITS 8
`endif
`ifndef QUADRILLE_HOMOGENEOUS_FRAC_BITS
`define QUADRILLE_HOMOGENEOUS_FRAC_BITS 7
`endif
`ifndef QUADRILLE_QUADRATIC_FRAC_BITS
`define QUADRILLE_QUADRATIC_FRAC_BITS -1
`endif
`ifndef QUADRILLE_SIGNIFICAND_BITS
`define QUADRILLE_SIGNIFICAND_BITS 18
`endif
`ifndef QUADRILLE_NOTCH_EXACT
`define QUADRILLE_NOTCH_EXACT 1
`endif
`ifdef QUADRILLE_RSQRT_SEGMENTS_LOG2  // the names that these two had while the tables were of 1/sqrt
`define QUADRILLE_SQRT_SEGMENTS_LOG2 `QUADRILLE_RSQRT_SEGMENTS_LOG2
`endif
`ifdef QUADRILLE_RSQRT_DEGREE
`define QUADRILLE_SQRT_DEGREE `QUADRILLE_RSQRT_DEGREE
`endif
`ifndef QUADRILLE_SQRT_SEGMENTS_LOG2
`define QUADRILLE_SQRT_SEGMENTS_LOG2 -1
`endif
`ifndef QUADRILLE_SQRT_DEGREE
`define QUADRILLE_SQRT_DEGREE 2
`endif
`ifndef QUADRILLE_RECIP_SEGMENTS_LOG2
`define QUADRILLE_RECIP_SEGMENTS_LOG2 -1
`endif
`ifndef QUADRILLE_RECIP_DEGREE
`define QUADRILLE_RECIP_DEGREE 2
`endif
`ifndef QUADRILLE_ALIGN_GUARD_BITS
`define QUADRILLE_ALIGN_GUARD_BITS 2
`endif
`ifndef QUADRILLE_ATTRIBUTE_SLOTS
`define QUADRILLE_ATTRIBUTE_SLOTS 4
`endif
`ifndef QUADRILLE_ATTRIBUTE_INT_BITS
`define QUADRILLE_ATTRIBUTE_INT_BITS 7
`endif
`ifndef QUADRILLE_ATTRIBUTE_FRAC_BITS
`define QUADRILLE_ATTRIBUTE_FRAC_BITS -1
`endif
`ifndef QUADRILLE_DEPTH_BITS
`define QUADRILLE_DEPTH_BITS 24
`endif
`ifndef QUADRILLE_TILE_LOG2
`define QUADRILLE_TILE_LOG2 3
`endif
`ifndef QUADRILLE_PIXELS_PER_CLOCK
`define QUADRILLE_PIXELS_PER_CLOCK 1
`endif
`ifndef QUADRILLE_DOT_UNITS
`define QUADRILLE_DOT_UNITS 2
`endif
`ifndef QUADRILLE_QUAD_SLOTS_LOG2
`define QUADRILLE_QUAD_SLOTS_LOG2 3
`endif
`ifndef QUADRILLE_TILE_SLOTS_LOG2
`define QUADRILLE_TILE_SLOTS_LOG2 2
`endif
`ifndef QUADRILLE_STAMP_FIFO_LOG2
`define QUADRILLE_STAMP_FIFO_LOG2 3
`endif
`ifndef QUADRILLE_PERFORMANCE_COUNTERS
`define QUADRILLE_PERFORMANCE_COUNTERS 0
`endif
`ifndef QUADRILLE_HIERARCHICAL_Z_BITS
`define QUADRILLE_HIERARCHICAL_Z_BITS 0
`endif
`ifndef QUADRILLE_HIERARCHICAL_Z_TILES_LOG2
`define QUADRILLE_HIERARCHICAL_Z_TILES_LOG2 12
`endif
`ifndef QUADRILLE_PLANE_QUADS
`define QUADRILLE_PLANE_QUADS 0
`endif
`ifndef QUADRILLE_QUAD_ID_BITS
`define QUADRILLE_QUAD_ID_BITS 24
`endif

package quadrille_pkg;

  // ---- Configuration keys ------------------------------------------------------------------------------------------
  localparam int VIEWPORT_BITS /*verilator public*/ = `QUADRILLE_VIEWPORT_BITS;
  localparam int GUARD_BITS /*verilator public*/ = `QUADRILLE_GUARD_BITS;
  localparam int SUBPIXEL_BITS /*verilator public*/ = `QUADRILLE_SUBPIXEL_BITS;
  localparam int HOMOGENEOUS_FRAC_BITS /*verilator public*/ = `QUADRILLE_HOMOGENEOUS_FRAC_BITS;
  localparam int SIGNIFICAND_BITS /*verilator public*/ = `QUADRILLE_SIGNIFICAND_BITS;
  localparam int NOTCH_EXACT /*verilator public*/ = `QUADRILLE_NOTCH_EXACT;
  localparam int SQRT_DEGREE /*verilator public*/ = `QUADRILLE_SQRT_DEGREE;
  localparam int RECIP_DEGREE /*verilator public*/ = `QUADRILLE_RECIP_DEGREE;
  localparam int ALIGN_GUARD_BITS /*verilator public*/ = `QUADRILLE_ALIGN_GUARD_BITS;
  localparam int ATTRIBUTE_SLOTS /*verilator public*/ = `QUADRILLE_ATTRIBUTE_SLOTS;
  localparam int ATTRIBUTE_INT_BITS /*verilator public*/ = `QUADRILLE_ATTRIBUTE_INT_BITS;
  localparam int DEPTH_BITS /*verilator public*/ = `QUADRILLE_DEPTH_BITS;
  localparam int TILE_LOG2 /*verilator public*/ = `QUADRILLE_TILE_LOG2;
  localparam int PIXELS_PER_CLOCK /*verilator public*/ = `QUADRILLE_PIXELS_PER_CLOCK;
  localparam int DOT_UNITS /*verilator public*/ = `QUADRILLE_DOT_UNITS;
  localparam int QUAD_SLOTS_LOG2 /*verilator public*/ = `QUADRILLE_QUAD_SLOTS_LOG2;
  localparam int TILE_SLOTS_LOG2 /*verilator public*/ = `QUADRILLE_TILE_SLOTS_LOG2;
  localparam int STAMP_FIFO_LOG2 /*verilator public*/ = `QUADRILLE_STAMP_FIFO_LOG2;
  localparam int HIERARCHICAL_Z_BITS /*verilator public*/ = `QUADRILLE_HIERARCHICAL_Z_BITS;
  localparam int HIERARCHICAL_Z_TILES_LOG2 /*verilator public*/ = `QUADRILLE_HIERARCHICAL_Z_TILES_LOG2;
  localparam int PLANE_QUADS /*verilator public*/ = `QUADRILLE_PLANE_QUADS;
  localparam int QUAD_ID_BITS /*verilator public*/ = `QUADRILLE_QUAD_ID_BITS;

  localparam int PERFORMANCE_COUNTERS /*verilator public*/ = `QUADRILLE_PERFORMANCE_COUNTERS;

  // ---- Keys with an automatic value --------------------------------------------------------------------------------
  localparam int QUADRATIC_FRAC_KEY = `QUADRILLE_QUADRATIC_FRAC_BITS;
  localparam int SQRT_SEGMENTS_KEY = `QUADRILLE_SQRT_SEGMENTS_LOG2;
  localparam int RECIP_SEGMENTS_KEY = `QUADRILLE_RECIP_SEGMENTS_LOG2;
  localparam int ATTRIBUTE_FRAC_KEY = `QUADRILLE_ATTRIBUTE_FRAC_BITS;

  // fraction bits of X, Y, W at the port
  localparam int FRAC /*verilator public*/ = SUBPIXEL_BITS + HOMOGENEOUS_FRAC_BITS;
  // a product of two positions has 2 FRAC fraction bits: keep all unless told otherwise
  localparam int QUADRATIC_FRAC_BITS /*verilator public*/ = (QUADRATIC_FRAC_KEY < 0) ? 2 * FRAC : QUADRATIC_FRAC_KEY;
  // segments for a table error below one unit: the error falls by 2^3 (degree 2) or 2^2 (degree 1) per doubling
  localparam int SQRT_AUTO = (SQRT_DEGREE == 1) ? (SIGNIFICAND_BITS + 1) / 2 : (SIGNIFICAND_BITS - 4 + 2) / 3;
  localparam int SQRT_SEGMENTS_LOG2 /*verilator public*/ =
      (SQRT_SEGMENTS_KEY >= 0) ? SQRT_SEGMENTS_KEY : (SQRT_AUTO < 3) ? 3 : SQRT_AUTO;
  localparam int RECIP_AUTO = (RECIP_DEGREE == 1) ? (SIGNIFICAND_BITS + 2) / 2 : (SIGNIFICAND_BITS - 2 + 2) / 3;
  localparam int RECIP_SEGMENTS_LOG2 /*verilator public*/ =
      (RECIP_SEGMENTS_KEY >= 0) ? RECIP_SEGMENTS_KEY : (RECIP_AUTO < 3) ? 3 : RECIP_AUTO;
  // two bits below the significand, so that the output grid adds little to the arithmetic error; never fewer than 24,
  // for a base may be far greater than the differences to it
  localparam int ATTRIBUTE_FRAC_AUTO = (SIGNIFICAND_BITS + 2 < 24) ? 24 : SIGNIFICAND_BITS + 2;
  localparam int ATTRIBUTE_FRAC_BITS /*verilator public*/ = (ATTRIBUTE_FRAC_KEY < 0) ? ATTRIBUTE_FRAC_AUTO :
      ATTRIBUTE_FRAC_KEY;

  // ---- Derived widths ----------------------------------------------------------------------------------------------
  // integer bits of a position, sign apart
  localparam int POS_INT /*verilator public*/ = VIEWPORT_BITS + GUARD_BITS;
  // signed: |X| <= 2^(POS_INT+FRAC) inclusive, and S = X - W x adds less than the same again
  localparam int T_BITS /*verilator public*/ = POS_INT + FRAC + 2;
  // signed: |W| <= 2^FRAC inclusive
  localparam int W_BITS /*verilator public*/ = FRAC + 2;
  // signed A, D, R^2 <= 2 max|S|^2, max|S| <= 2^(POS_INT+FRAC) (1 + 2^-GUARD_BITS + a block)
  localparam int VAL_BITS /*verilator public*/ = 2 * (POS_INT + FRAC) + ((GUARD_BITS >= 2) ? 3 : 4);
  // signed first differences: two products |T| |W|, |W| has one bit less than its width allows
  localparam int GRAD_BITS /*verilator public*/ = T_BITS + W_BITS - 1;
  // signed W W'
  localparam int CURV_BITS /*verilator public*/ = 2 * FRAC + 2;
  // low bits of D and R^2 that are dropped (arithmetic shift right)
  localparam int QDROP /*verilator public*/ = 2 * FRAC - QUADRATIC_FRAC_BITS;
  localparam int QVAL_BITS /*verilator public*/ = VAL_BITS - QDROP;
  localparam int QGRAD_BITS /*verilator public*/ = GRAD_BITS - QDROP;
  localparam int QCURV_BITS /*verilator public*/ = CURV_BITS - QDROP;
  // unsigned |V - V'|^2: two squares of at most twice a position
  localparam int LENGTH2_BITS /*verilator public*/ = 2 * (POS_INT + FRAC) + 4 - QDROP;
  // signed difference of two positions
  localparam int RISE_BITS /*verilator public*/ = T_BITS + 1;
  // signed exponents inside: numbers of the port, weights, sums and a quotient of two sums stay within +-2^10, a bit to
  // spare
  localparam int EXP_BITS /*verilator public*/ = 12;
  // of a regular pixel's weights: |exponent| (SPEC.md, mean_value_weights; proved in golden/analysis)
  localparam int WEIGHT_EXP_LIMIT = 120;
  // signed exponents of k, Z, b at the port
  localparam int PORT_EXP_BITS /*verilator public*/ = 9;
  // fraction bits of an aligned sum
  localparam int PREC_BITS /*verilator public*/ = SIGNIFICAND_BITS - 1 + ALIGN_GUARD_BITS;
  // a term of a sum: a product's two integer bits and PREC_BITS fraction bits
  localparam int TERM_BITS /*verilator public*/ = PREC_BITS + 2;
  // order of exponents as unsigned numbers, with a place below all of them for zero
  localparam int RANK_BITS /*verilator public*/ = EXP_BITS + 1;
  // bits of a table's accumulator below the result
  localparam int TABLE_GUARD /*verilator public*/ = 3;
  // digits of a row in its tile (radix4_digits)
  localparam int ROW_DIGIT_BITS = 2 * (TILE_LOG2 / 2 + 1);
  // tile edge and stamp width in pixels; a block is BLOCK_TILES x BLOCK_TILES tiles
  localparam int TILE /*verilator public*/ = 1 << TILE_LOG2;
  localparam int BLOCK_LOG2 /*verilator public*/ = 3;
  localparam int BLOCK_TILES /*verilator public*/ = 1 << BLOCK_LOG2;
  // tile coordinate or tile count: the count reaches 2^(VIEWPORT_BITS-TILE_LOG2) inclusive
  localparam int TC_BITS /*verilator public*/ = VIEWPORT_BITS - TILE_LOG2 + 1;
  // signed reach of an edge function over a block: two first differences times its edge in pixels
  localparam int REACH_BITS /*verilator public*/ = GRAD_BITS + 1 + TILE_LOG2 + BLOCK_LOG2;
  // {neg, exp, sig}
  localparam int ATTR_PORT_BITS /*verilator public*/ = 1 + PORT_EXP_BITS + SIGNIFICAND_BITS;
  // two's complement
  localparam int ATTR_OUT_BITS /*verilator public*/ = 1 + ATTRIBUTE_INT_BITS + ATTRIBUTE_FRAC_BITS;
  // signed code of a corner's depth: -1, below 0, to 2^DEPTH_BITS + 1, above 1
  localparam int CORNER_DEPTH_BITS /*verilator public*/ = DEPTH_BITS + 2;
  // {outside, near_cuts, far_cuts, least, greatest} of a quad's depths (quad_reject)
  localparam int DEPTH_LIMIT_BITS = 3 + 2 * (DEPTH_BITS + 1);
  // terms of the weighted sums: k, W, Z of four corners, an attribute of the last three, for corner 0's is the base
  // itself
  localparam int BLEND_TERMS = 4 * 3 + 3 * ATTRIBUTE_SLOTS;
  // operands of a dot unit: T_BITS <= 32, and the unsigned low halves of the determinants need a sign bit
  localparam int DOT_BITS /*verilator public*/ = 33;
  // a.b +- c.d
  localparam int DOT_OUT_BITS /*verilator public*/ = 2 * DOT_BITS + 1;
  // V . (V' x V''): three terms |T| |GRAD| or |W| |VAL|
  localparam int DET_BITS /*verilator public*/ = T_BITS + GRAD_BITS + 4;
  // entries of the tile ring: as many again as tiles in flight, for those on the way from the walk to their first stamp
  localparam int RING_LOG2 /*verilator public*/ = TILE_SLOTS_LOG2 + 1;
  // places of the stamp FIFO: four more than stamps may wait, for the rows on their way, which have a place each until
  // it is known whether they are covered
  localparam int STAMP_PLACES /*verilator public*/ = (1 << STAMP_FIFO_LOG2) + 4;

  // bits of a tile's farthest depth; without hidden tiles what their units, which then are nowhere, are looked at with
  localparam int DEPTH_CODE_BITS = (HIERARCHICAL_Z_BITS == 0) ? 12 : HIERARCHICAL_Z_BITS;
  // A clear wipes the places of their epoch, 2^HIDDEN_SECTION_LOG2
  localparam int HIDDEN_SECTION_LOG2 = 4;
  localparam int HIDDEN_EPOCH_BITS = HIERARCHICAL_Z_TILES_LOG2 - HIDDEN_SECTION_LOG2;


  // ---- performance_counters ---------------------------------------------------------------------------------------
  // wraps around after 14 s at 300 MHz: whoever counts for longer reads them more often than that
  localparam int COUNTER_BITS /*verilator public*/ = 32;
  localparam int COUNTER_INDEX_BITS /*verilator public*/ = 6;

  // ---- Jobs of vertex_products -------------------------------------------------------------------------------------
  localparam logic [2:0] EDGE = 3'd0;
  localparam logic [2:0] EDGE_GRADIENT = 3'd1;
  localparam logic [2:0] DOT = 3'd2;
  localparam logic [2:0] DOT_GRADIENT = 3'd3;
  localparam logic [2:0] SQUARES = 3'd4;
  localparam logic [2:0] MOVE = 3'd5;
  localparam logic [2:0] DET_VALUE = 3'd6;
  localparam logic [2:0] DET_GRADIENT = 3'd7;
  // pairs of dot units, a job each a clock
  localparam int PRODUCT_PAIRS /*verilator public*/ = DOT_UNITS / 2;
  // functions of a tile that may come to the ring in one clock: SQUARES gives two
  localparam int CONTEXT_BUSES /*verilator public*/ = 2 * PRODUCT_PAIRS;
  // from a job to its results: pair, operands, partial products, their middle ones, products, result
  localparam int VERTEX_PRODUCT_CLOCKS /*verilator public*/ = 6;

  // ---- Parts of a pixel --------------------------------------------------------------------------------------------
  // A pixel of an ordinary quad is whole. One of a homogeneous quad comes in three parts, one a clock, with four
  // quadratic functions each: the dot products of the edges, of the diagonals, then the squared distances, with which
  // it is a pixel. In the tile ring the word of a part is so many entries behind the tile's (squares: none).
  localparam logic [1:0] PART_WHOLE = 2'd0;
  localparam logic [1:0] PART_EDGES = 2'd1;
  localparam logic [1:0] PART_DIAGONALS = 2'd2;
  localparam logic [1:0] PART_SQUARES = 2'd3;
  localparam int HOMOGENEOUS_PARTS /*verilator public*/ = 3;

  // ---- Class of a pixel: the word of singular_class, by bit position -----------------------------------------------
  // At most one of the first four is set. FIRST and SECOND: low bits of the numbers of the lowest two corners or edges
  // concerned.
  localparam int CLASS_TWO_CORNER = 8;
  localparam int CLASS_ON_VERTEX = 7;
  localparam int CLASS_TWO_EDGE = 6;
  localparam int CLASS_ON_EDGE = 5;
  localparam int CLASS_NOTCH = 4;
  localparam int CLASS_FIRST = 2;
  localparam int CLASS_SECOND = 0;
  localparam int CLASS_BITS = 9;
  localparam int CLASS_KINDS = CLASS_BITS - CLASS_ON_EDGE;  // the singular kinds, at its upper end
  localparam int CLASS_FLAGS = CLASS_BITS - CLASS_NOTCH;  // what a fragment shows: those and the notch
  // at its upper end: one of them is set where the pixel is not regular
  localparam int CLASS_OVERRIDES = CLASS_BITS - CLASS_TWO_EDGE;

  // ---- Latency of the pixel pipeline (SPEC.md, model/port/latency.hpp) ---------------------------------------------
  // Clocks from a unit's inputs to its outputs.
  localparam int FORWARD_DIFFERENCE_ROW_STAGES /*verilator public*/ = 1;
  localparam int FORWARD_DIFFERENCE_COLUMN_STAGES /*verilator public*/ = 2;  // column, bend
  localparam int FORWARD_DIFFERENCE_STAGES /*verilator public*/ = FORWARD_DIFFERENCE_ROW_STAGES +
      FORWARD_DIFFERENCE_COLUMN_STAGES;
  localparam int LAW_OF_COSINES_STAGES /*verilator public*/ = 2;  // sum, difference
  localparam int FP_NORMALISE_STAGES /*verilator public*/ = 2;  // long shifts, short shifts
  localparam int NORMALISE_STAGES /*verilator public*/ = 1 + FP_NORMALISE_STAGES;  // magnitude
  localparam int SQRT_STAGES /*verilator public*/ = 4;  // table, inner product, outer product, clamp
  localparam int RECIPROCAL_STAGES /*verilator public*/ = SQRT_STAGES;  // the same polynomial
  localparam int PRODUCT_STAGES /*verilator public*/ = 1;  // fp_multiply, fp_raw_product
  // from the product: distances, align, add, magnitude
  localparam int FP_SUM_STAGES /*verilator public*/ = 4 + FP_NORMALISE_STAGES;
  localparam int FP_ADD_STAGES /*verilator public*/ = 3;  // order, align, add
  localparam int FIXED_POINT_STAGES /*verilator public*/ = 2;  // distance, shift
  // sum, clamp, output
  localparam int FRAGMENT_OUTPUT_STAGES /*verilator public*/ = PRODUCT_STAGES + FIXED_POINT_STAGES + 3;
  // Registers at the boundaries; register 0 is written by the edge that ends the clock in which the pixel is at the
  // input.
  localparam int DIFF_STAGE /*verilator public*/ = FORWARD_DIFFERENCE_STAGES + LAW_OF_COSINES_STAGES - 1;
  localparam int NORM_STAGE /*verilator public*/ = DIFF_STAGE + NORMALISE_STAGES;
  localparam int ROOT_STAGE /*verilator public*/ = NORM_STAGE + SQRT_STAGES;
  // r r', its sum with |D|
  localparam int RATIO_STAGE /*verilator public*/ = ROOT_STAGE + PRODUCT_STAGES + FP_ADD_STAGES;
  // operands, products, the denominators of two edges; beside them the roots, their products, and which is a factor;
  // then the register in which the overrides have been applied
  localparam int N_STAGE /*verilator public*/ = RATIO_STAGE + 1 + PRODUCT_STAGES + FP_SUM_STAGES;
  localparam int OVERRIDE_STAGE /*verilator public*/ = N_STAGE + 1;
  // the first product, the sum of two of them, which of both is M; beside them the second product
  localparam int WEIGHT_STAGE /*verilator public*/ = OVERRIDE_STAGE + PRODUCT_STAGES + FP_ADD_STAGES + 1;
  localparam int SUM_STAGE /*verilator public*/ = WEIGHT_STAGE + PRODUCT_STAGES + FP_SUM_STAGES;
  localparam int FRAGMENT_STAGE /*verilator public*/ = SUM_STAGE + RECIPROCAL_STAGES + FRAGMENT_OUTPUT_STAGES;
  // clocks from a pixel at the input to the last register
  localparam int LATENCY /*verilator public*/ = FRAGMENT_STAGE + 1;
  // places of the fragment FIFO: at full rate a place that the pixels of a clock take is free again after LATENCY and 7
  // clocks (3 from emission to the pipeline, 2 through the FIFO, 2 until the count of free places knows)
  localparam int FRAGMENT_FIFO_LOG2 /*verilator public*/ = $clog2(LATENCY + 7);

  // ---- Bundles, as include/quadrille_types.svh declares them; VERTEX, STATE, FRAGMENT: the ports' (README.md) -------
  localparam int STATE_BITS /*verilator public*/ = 4 * (VIEWPORT_BITS + 1) + 2 * (DEPTH_BITS + 1) + 16;
  localparam int VERTEX_BITS /*verilator public*/ = QUAD_ID_BITS + 2 * T_BITS + W_BITS + 2 * PORT_EXP_BITS +
      2 * SIGNIFICAND_BITS + ATTRIBUTE_SLOTS * ATTR_PORT_BITS + ATTRIBUTE_SLOTS * ATTR_OUT_BITS + DEPTH_BITS + 1 +
      2 * CORNER_DEPTH_BITS + 1;
  localparam int QUAD_BITS = QUAD_ID_BITS + 2 * 4 * T_BITS + 4 * W_BITS + 4 * T_BITS + 3 * 4 * PORT_EXP_BITS +
      3 * 4 * SIGNIFICAND_BITS + 3 * ATTRIBUTE_SLOTS * ATTR_PORT_BITS + ATTRIBUTE_SLOTS * ATTR_OUT_BITS +
      DEPTH_BITS + 1 + 2 * CORNER_DEPTH_BITS + 9;
  localparam int SETUP_BITS = QUAD_SLOTS_LOG2 + 4 * TC_BITS + TILE_LOG2 + 2 * 4 * T_BITS + 4 * W_BITS + 6 * VAL_BITS +
      2 * 6 * GRAD_BITS + 4 * 5 * REACH_BITS + 6 * LENGTH2_BITS + 16;
  localparam int JOBS_BITS = PRODUCT_PAIRS * 3 + PRODUCT_PAIRS * 4 + 2 * 4 * T_BITS + 4 * W_BITS +
      2 * (VIEWPORT_BITS + 1);
  localparam int PRODUCTS_BITS = 4 * PRODUCT_PAIRS * T_BITS + 2 * PRODUCT_PAIRS * RISE_BITS +
      2 * PRODUCT_PAIRS * DOT_OUT_BITS;
  localparam int TILE_BITS = QUAD_SLOTS_LOG2 + 4 * TC_BITS + TILE_LOG2 + 6 * VAL_BITS;
  localparam int TEST_BITS = 4 * TC_BITS + 2 * BLOCK_LOG2 + 4;
  localparam int WORDS_BITS = 3 * RING_LOG2 + CONTEXT_BUSES * QVAL_BITS + 2 * CONTEXT_BUSES * QGRAD_BITS +
      PRODUCT_PAIRS * QCURV_BITS + 14;
  localparam int TAG_BITS = QUAD_SLOTS_LOG2 + 2 * TC_BITS + TILE_LOG2 + 2;
  localparam int EDGES_BITS = 2 * 5 * GRAD_BITS + 14;
  localparam int ROWS_BITS = TILE_LOG2 + TILE + 4;
  localparam int STAMP_BITS = RING_LOG2 + 1 + TILE_LOG2 + 3 * TILE + 2;
  localparam int PIXELS_BITS = TILE_LOG2 + ROW_DIGIT_BITS + PIXELS_PER_CLOCK * TILE_LOG2 + 3 * PIXELS_PER_CLOCK + 3;
  localparam int CONTEXT_BITS = QUAD_SLOTS_LOG2 + 2 * TC_BITS + 6 * VAL_BITS + 4 * QVAL_BITS + 2 * 4 * QGRAD_BITS +
      4 * QCURV_BITS;
  localparam int ROW_BITS = 6 * VAL_BITS + 6 * GRAD_BITS + 4 * QVAL_BITS + 4 * QGRAD_BITS + 4 * QCURV_BITS;
  localparam int READS_BITS = 7 * QUAD_SLOTS_LOG2;
  localparam int TERMS_BITS = 6 * LENGTH2_BITS + 2 * 4 * PORT_EXP_BITS + 2 * 4 * SIGNIFICAND_BITS + BLEND_TERMS +
      BLEND_TERMS * PORT_EXP_BITS + BLEND_TERMS * SIGNIFICAND_BITS + ATTRIBUTE_SLOTS * ATTR_OUT_BITS +
      DEPTH_BITS + 1 + DEPTH_LIMIT_BITS + QUAD_ID_BITS + 7;
  localparam int FRONT_EVENTS_BITS = 12;
  localparam int TILES_EVENTS_BITS = 16;
  localparam int PIXEL_EVENTS_BITS = PIXELS_PER_CLOCK * LATENCY + 3 * PIXELS_PER_CLOCK + 3 + ATTRIBUTE_SLOTS + 1;
  // quad, x, y, front, flags, depth, attributes: of one lane
  localparam int FRAGMENT_BITS /*verilator public*/ =
      QUAD_ID_BITS + 2 * VIEWPORT_BITS + 1 + 8 + DEPTH_BITS + 1 + ATTRIBUTE_SLOTS * ATTR_OUT_BITS;

  // ---- Function pairs: 0-3 edges 01 12 23 30, 4 diagonal 20, 5 diagonal 13, 6-9 squares 00 11 22 33 -----------------
  function automatic logic [1:0] pair_first(input logic [3:0] k);
    case (k)
      4'd0, 4'd6: pair_first = 2'd0;
      4'd1, 4'd5, 4'd7: pair_first = 2'd1;
      4'd2, 4'd4, 4'd8: pair_first = 2'd2;
      default: pair_first = 2'd3;
    endcase
  endfunction

  function automatic logic [1:0] pair_second(input logic [3:0] k);
    case (k)
      4'd3, 4'd4, 4'd6: pair_second = 2'd0;
      4'd0, 4'd7: pair_second = 2'd1;
      4'd1, 4'd8: pair_second = 2'd2;
      default: pair_second = 2'd3;
    endcase
  endfunction

  // ---- Products of significands, 2 SIGNIFICAND_BITS wide and, but for 0, with a one in the upper two places --------
  // fp_multiply of SPEC.md: {exponent, significand} of the product truncated; exp: sum of the factors' exponents.
  function automatic logic [EXP_BITS+SIGNIFICAND_BITS-1:0] truncated_product(
      input logic [EXP_BITS-1:0] exp, input logic [2*SIGNIFICAND_BITS-1:0] product, input logic nonzero);
    truncated_product = {
      !nonzero ? EXP_BITS'(0) : product[2*SIGNIFICAND_BITS-1] ? exp + EXP_BITS'(1) : exp,  // the sum before the product
      product[2*SIGNIFICAND_BITS-1] ? product[2*SIGNIFICAND_BITS-1-:SIGNIFICAND_BITS] :
          product[2*SIGNIFICAND_BITS-2-:SIGNIFICAND_BITS]
    };
  endfunction

  // The bits of a product that a sum aligns.
  function automatic logic [TERM_BITS-1:0] product_term(input logic [2*SIGNIFICAND_BITS-1:0] product);
    product_term = TERM_BITS'(product >> (2 * SIGNIFICAND_BITS - TERM_BITS));
  endfunction

  // A lone number as a term of a sum: its product by 1.
  function automatic logic [TERM_BITS-1:0] lone_term(input logic [SIGNIFICAND_BITS-1:0] sig);
    lone_term = TERM_BITS'(sig) << (TERM_BITS - SIGNIFICAND_BITS - 1);
  endfunction

  // ---- Rank of a number among others: 0 for zero, else {1, exponent + 2^(EXP_BITS-1)} ------------------------------
  function automatic logic [RANK_BITS-1:0] exponent_rank(input logic [EXP_BITS-1:0] exp, input logic nonzero);
    exponent_rank = {1'b1, ~exp[EXP_BITS-1], exp[EXP_BITS-2:0]} & {RANK_BITS{nonzero}};
  endfunction

  // The exponent; 0 for zero.
  function automatic logic [EXP_BITS-1:0] rank_exponent(input logic [RANK_BITS-1:0] rank);
    rank_exponent = {~rank[EXP_BITS-1], rank[EXP_BITS-2:0]} & {EXP_BITS{rank[EXP_BITS]}};
  endfunction

endpackage
