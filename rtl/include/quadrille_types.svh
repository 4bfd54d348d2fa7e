// SPDX-License-Identifier: Apache-2.0
// The bundles of the machine: packed structs, first member most significant. Between modules a bundle is a flat vector
// of quadrille_pkg::<NAME>_BITS: Icarus Verilog reads no struct of a package, Yosys no struct at a port.
// `QUADRILLE_IN(`QUADRILLE_SETUP_T, setup) makes the struct `setup` of the port setup_i. A clocked block takes a member
// through a wire: else Verilator packs the whole bundle in every clock.
`ifndef QUADRILLE_TYPES_SVH
`define QUADRILLE_TYPES_SVH

`define QUADRILLE_IN(kind, name) \
  /*verilator lint_off UNUSEDSIGNAL*/ kind name; /*verilator lint_on UNUSEDSIGNAL*/ assign name = name``_i;

// Draw state.
`define QUADRILLE_STATE_T struct packed { \
    logic [quadrille_pkg::VIEWPORT_BITS:0] scissor_x0, scissor_y0, scissor_x1, scissor_y1; \
    logic [1:0] cull; \
    logic perspective, depth; \
    logic [quadrille_pkg::DEPTH_BITS:0] znear, zfar; \
    logic [3:0] attributes; \
    logic [7:0] skip; \
  }

// A beat of the port.
`define QUADRILLE_VERTEX_T struct packed { \
    logic [quadrille_pkg::QUAD_ID_BITS-1:0] id; \
    logic [quadrille_pkg::T_BITS-1:0] x, y; \
    logic [quadrille_pkg::W_BITS-1:0] w; \
    logic [quadrille_pkg::PORT_EXP_BITS-1:0] k_exp; \
    logic [quadrille_pkg::SIGNIFICAND_BITS-1:0] k_sig; \
    logic z_neg; \
    logic [quadrille_pkg::PORT_EXP_BITS-1:0] z_exp; \
    logic [quadrille_pkg::SIGNIFICAND_BITS-1:0] z_sig; \
    logic [quadrille_pkg::ATTRIBUTE_SLOTS*quadrille_pkg::ATTR_PORT_BITS-1:0] attr; \
    logic [quadrille_pkg::ATTRIBUTE_SLOTS*quadrille_pkg::ATTR_OUT_BITS-1:0] base_attr; \
    logic [quadrille_pkg::DEPTH_BITS:0] base_depth; \
    logic [quadrille_pkg::CORNER_DEPTH_BITS-1:0] depth_low, depth_high; \
  }

// The quad of vertex_assembly: of four vertices, vertex 0 at the low end; attr of vertices 1 to 3.
`define QUADRILLE_QUAD_T struct packed { \
    logic [quadrille_pkg::QUAD_ID_BITS-1:0] id; \
    logic [4*quadrille_pkg::T_BITS-1:0] x, y; \
    logic [4*quadrille_pkg::W_BITS-1:0] w; \
    logic ordinary; \
    logic [quadrille_pkg::T_BITS-1:0] low_x, high_x, low_y, high_y; \
    logic [3:0] w_neg; \
    logic [4*quadrille_pkg::PORT_EXP_BITS-1:0] w_exp; \
    logic [4*quadrille_pkg::SIGNIFICAND_BITS-1:0] w_sig; \
    logic [4*quadrille_pkg::PORT_EXP_BITS-1:0] k_exp; \
    logic [4*quadrille_pkg::SIGNIFICAND_BITS-1:0] k_sig; \
    logic [3:0] z_neg; \
    logic [4*quadrille_pkg::PORT_EXP_BITS-1:0] z_exp; \
    logic [4*quadrille_pkg::SIGNIFICAND_BITS-1:0] z_sig; \
    logic [3*quadrille_pkg::ATTRIBUTE_SLOTS*quadrille_pkg::ATTR_PORT_BITS-1:0] attr; \
    logic [quadrille_pkg::ATTRIBUTE_SLOTS*quadrille_pkg::ATTR_OUT_BITS-1:0] base_attr; \
    logic [quadrille_pkg::DEPTH_BITS:0] base_depth; \
    logic [quadrille_pkg::CORNER_DEPTH_BITS-1:0] depth_low, depth_high; \
  }

// A quad that setup is done with: its tiles, functions and vertices relative to its first tile.
`define QUADRILLE_SETUP_T struct packed { \
    logic [quadrille_pkg::QUAD_SLOTS_LOG2-1:0] slot; \
    logic [quadrille_pkg::TC_BITS-1:0] tile_x0, tile_y0, tiles_x, tiles_y; \
    logic [quadrille_pkg::TILE_LOG2-1:0] last_row; \
    logic [4*quadrille_pkg::T_BITS-1:0] x, y; \
    logic [4*quadrille_pkg::W_BITS-1:0] w; \
    logic homogeneous, hull; \
    logic [3:0] visible; \
    logic [6*quadrille_pkg::VAL_BITS-1:0] lin_value; \
    logic [6*quadrille_pkg::GRAD_BITS-1:0] lin_gx, lin_gy; \
    logic [4:0] tie_pos, tie_neg; \
    logic [5*quadrille_pkg::REACH_BITS-1:0] fall_tile, rise_tile, fall_block, rise_block; \
    logic [6*quadrille_pkg::LENGTH2_BITS-1:0] length2; \
  }

// Jobs of vertex_products: kind and function of each pair of units, the vertices, and a clock later the offset of a
// MOVE.
`define QUADRILLE_JOBS_T struct packed { \
    logic [quadrille_pkg::PRODUCT_PAIRS*3-1:0] kind; \
    logic [quadrille_pkg::PRODUCT_PAIRS*4-1:0] functions; \
    logic [4*quadrille_pkg::T_BITS-1:0] x, y; \
    logic [4*quadrille_pkg::W_BITS-1:0] w; \
    logic [quadrille_pkg::VIEWPORT_BITS:0] offset_x, offset_y; \
  }

// What each pair of units makes of its job: the vertices and how far they are apart a clock later, then the results.
`define QUADRILLE_PRODUCTS_T struct packed { \
    logic [quadrille_pkg::PRODUCT_PAIRS*quadrille_pkg::T_BITS-1:0] xi, yi, xj, yj; \
    logic [quadrille_pkg::PRODUCT_PAIRS*quadrille_pkg::RISE_BITS-1:0] apart_x, apart_y; \
    logic [quadrille_pkg::PRODUCT_PAIRS*quadrille_pkg::DOT_OUT_BITS-1:0] result0, result1; \
  }

// A tile that the walk hits; column and row from the quad's first.
`define QUADRILLE_TILE_T struct packed { \
    logic [quadrille_pkg::QUAD_SLOTS_LOG2-1:0] slot; \
    logic [quadrille_pkg::TC_BITS-1:0] tile_x, tile_y, column, row; \
    logic [quadrille_pkg::TILE_LOG2-1:0] last_row; \
    logic [6*quadrille_pkg::VAL_BITS-1:0] lin_value; \
  }

// What the walk tests in a clock, a tile or a block; of the tile of the clock before: it was one, the quad covers it.
`define QUADRILLE_TEST_T struct packed { \
    logic go; \
    logic [quadrille_pkg::TC_BITS-1:0] column, row; \
    logic block_test; \
    logic [quadrille_pkg::TC_BITS-1:0] block_column, block_row; \
    logic [quadrille_pkg::BLOCK_LOG2-1:0] block_last_column, block_last_row; \
    logic tested, covered; \
  }

// Words of the tile ring; function g has bus g mod CONTEXT_BUSES, of q g mod PRODUCT_PAIRS.
`define QUADRILLE_WORDS_T struct packed { \
    logic [3:0] value_write; \
    logic [quadrille_pkg::RING_LOG2-1:0] value_entry; \
    logic [quadrille_pkg::CONTEXT_BUSES*quadrille_pkg::QVAL_BITS-1:0] value; \
    logic [3:0] gradient_write; \
    logic [quadrille_pkg::RING_LOG2-1:0] gradient_entry; \
    logic [quadrille_pkg::CONTEXT_BUSES*quadrille_pkg::QGRAD_BITS-1:0] gx, gy; \
    logic [3:0] q_write; \
    logic [quadrille_pkg::RING_LOG2-1:0] q_entry; \
    logic [quadrille_pkg::PRODUCT_PAIRS*quadrille_pkg::QCURV_BITS-1:0] q; \
    logic complete, complete_homogeneous; \
  }

// A tile in coverage's first register.
`define QUADRILLE_TAG_T struct packed { \
    logic end_token, homogeneous; \
    logic [quadrille_pkg::QUAD_SLOTS_LOG2-1:0] slot; \
    logic [quadrille_pkg::TC_BITS-1:0] tile_x, tile_y; \
    logic [quadrille_pkg::TILE_LOG2-1:0] last_row; \
  }

// Constants of a quad's edge functions.
`define QUADRILLE_EDGES_T struct packed { \
    logic [5*quadrille_pkg::GRAD_BITS-1:0] gx, gy; \
    logic [4:0] tie_pos, tie_neg; \
    logic [3:0] visible; \
  }

// Coverage's registers, for masked_depth: a tile moves on to the context's, to the rows'; a row is issued, the last
// one; two clocks later its pixels.
`define QUADRILLE_ROWS_T struct packed { \
    logic load, rows_load, issue, done; \
    logic [quadrille_pkg::TILE_LOG2-1:0] row; \
    logic [quadrille_pkg::TILE-1:0] covered; \
  }

// A row of a tile with covered pixels, or an end entry.
`define QUADRILLE_STAMP_T struct packed { \
    logic homogeneous, end_token; \
    logic [quadrille_pkg::RING_LOG2:0] tile_ptr; \
    logic [quadrille_pkg::TILE_LOG2-1:0] row; \
    logic [quadrille_pkg::TILE-1:0] mask, front, tie; \
  }

// What emission sends in a clock: pixels of one row of a tile, lane 0 at the low end.
`define QUADRILLE_PIXELS_T struct packed { \
    logic end_token; \
    logic [1:0] part; \
    logic [quadrille_pkg::TILE_LOG2-1:0] row; \
    logic [quadrille_pkg::ROW_DIGIT_BITS-1:0] row_digits; \
    logic [quadrille_pkg::PIXELS_PER_CLOCK*quadrille_pkg::TILE_LOG2-1:0] dx; \
    logic [quadrille_pkg::PIXELS_PER_CLOCK-1:0] valid, front, tie; \
  }

// The tile of those pixels.
`define QUADRILLE_CONTEXT_T struct packed { \
    logic [quadrille_pkg::QUAD_SLOTS_LOG2-1:0] slot; \
    logic [quadrille_pkg::TC_BITS-1:0] tile_x, tile_y; \
    logic [6*quadrille_pkg::VAL_BITS-1:0] lin_value; \
    logic [4*quadrille_pkg::QVAL_BITS-1:0] quad_value; \
    logic [4*quadrille_pkg::QGRAD_BITS-1:0] quad_gx, quad_gy; \
    logic [4*quadrille_pkg::QCURV_BITS-1:0] quad_q; \
  }

// Functions in the row of a pixel.
`define QUADRILLE_ROW_T struct packed { \
    logic [6*quadrille_pkg::VAL_BITS-1:0] lin_value; \
    logic [6*quadrille_pkg::GRAD_BITS-1:0] lin_gx; \
    logic [4*quadrille_pkg::QVAL_BITS-1:0] quad_value; \
    logic [4*quadrille_pkg::QGRAD_BITS-1:0] quad_gx; \
    logic [4*quadrille_pkg::QCURV_BITS-1:0] quad_q; \
  }

// Slots that the pipeline's registers have where the vertex bank is read.
`define QUADRILLE_READS_T struct packed { \
    logic [quadrille_pkg::QUAD_SLOTS_LOG2-1:0] length2, norm, product, overrides, blend, base, outputs; \
  }

// Pixel terms: what the vertex bank has of a quad, each member where the pipeline uses it.
`define QUADRILLE_TERMS_T struct packed { \
    logic [6*quadrille_pkg::LENGTH2_BITS-1:0] length2; \
    logic norm_plane; \
    logic [3:0] product_k_neg; \
    logic [4*quadrille_pkg::PORT_EXP_BITS-1:0] product_k_exp; \
    logic [4*quadrille_pkg::SIGNIFICAND_BITS-1:0] product_k_sig; \
    logic [4*quadrille_pkg::PORT_EXP_BITS-1:0] override_k_exp; \
    logic [4*quadrille_pkg::SIGNIFICAND_BITS-1:0] override_k_sig; \
    logic [quadrille_pkg::BLEND_TERMS-1:0] blend_neg; \
    logic [quadrille_pkg::BLEND_TERMS*quadrille_pkg::PORT_EXP_BITS-1:0] blend_exp; \
    logic [quadrille_pkg::BLEND_TERMS*quadrille_pkg::SIGNIFICAND_BITS-1:0] blend_sig; \
    logic [quadrille_pkg::ATTRIBUTE_SLOTS*quadrille_pkg::ATTR_OUT_BITS-1:0] base_attr; \
    logic [quadrille_pkg::DEPTH_BITS:0] base_depth; \
    logic [quadrille_pkg::DEPTH_LIMIT_BITS-1:0] base_limits; \
    logic [quadrille_pkg::QUAD_ID_BITS-1:0] output_id; \
    logic output_hull, output_homogeneous; \
  }

// For performance_counters. Setup takes the quad that waits, a plane quad; or it is left out, for the first of
// empty and behind that holds, else by its depth; setup leaves a quad out, for it is on a line or culled; the dot
// units get a job of each pair; setup has a quad, one waits for it or for a slot, or for the walk; vertex_assembly
// holds vertices.
`define QUADRILLE_FRONT_EVENTS_T struct packed { \
    logic start, plane, drop_vertices, empty, behind, drop, drop_line, setup_job, setup, setup_behind, walk_behind; \
    logic assembly; \
  }

// Blocks and tiles of the walk; coverage leaves a tile's rows out, tests a row, has a tile, and another one; emission
// has a stamp or an end entry, and no place for its fragments; places are wiped.
`define QUADRILLE_TILES_EVENTS_T struct packed { \
    logic context_job, block_test, block_enter, block_hidden, tile_test, tile_hidden, walk, tile_push, tile_masked; \
    logic row, rows, rows_behind, stamp_push, head, head_waits, wipe; \
  }

// Of the lanes: registers with a pixel, those of a lane side by side; fragments in the last one; a clock before
// NORM_STAGE numbers are taken on; at RATIO_STAGE the weights are areas, which are not multiplied. Three clocks before
// NORM_STAGE the pixels are of a plane quad; a clock before WEIGHT_STAGE the terms of k, W, Z and the attributes are
// not held at 0.
`define QUADRILLE_PIXEL_EVENTS_T struct packed { \
    logic [quadrille_pkg::PIXELS_PER_CLOCK*quadrille_pkg::LATENCY-1:0] lane_valid; \
    logic [quadrille_pkg::PIXELS_PER_CLOCK-1:0] drawn, norm_active, area; \
    logic norm_plane; \
    logic [quadrille_pkg::ATTRIBUTE_SLOTS+2:0] sum_active; \
  }

`endif
