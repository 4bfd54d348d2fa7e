// SPDX-License-Identifier: Apache-2.0
// Refuses an impossible configuration at elaboration, naming the rule it breaks. No hardware.

// A rule is an identifier: Verilator and Yosys print it as an error of elaboration, Icarus 11, which has none, as the
// name of a module that is missing.
`ifdef __ICARUS__
`define QUADRILLE_REQUIRE(RULE, CONDITION) if (!(CONDITION)) begin : gen_``RULE RULE u_stop (); end
`else
`define QUADRILLE_REQUIRE(RULE, CONDITION) if (!(CONDITION)) begin : gen_``RULE $error(`"RULE`"); end
`endif

module quadrille_config_check;
  localparam int VIEWPORT_BITS = quadrille_pkg::VIEWPORT_BITS, GUARD_BITS = quadrille_pkg::GUARD_BITS;
  localparam int POS_INT = quadrille_pkg::POS_INT, FRAC = quadrille_pkg::FRAC, S = quadrille_pkg::SIGNIFICAND_BITS;
  localparam int RK = quadrille_pkg::SQRT_SEGMENTS_LOG2, CK = quadrille_pkg::RECIP_SEGMENTS_LOG2;
  // max |S| in pixels: guard band, viewport, and the part of a block that hangs over
  localparam int REACH = (1 << POS_INT) + (1 << VIEWPORT_BITS) + (1 << (quadrille_pkg::TILE_LOG2 +
      quadrille_pkg::BLOCK_LOG2));

  `QUADRILLE_REQUIRE(viewport_bits_must_be_6_to_14, VIEWPORT_BITS >= 6 && VIEWPORT_BITS <= 14)
  `QUADRILLE_REQUIRE(guard_bits_must_be_1_to_4, GUARD_BITS >= 1 && GUARD_BITS <= 4)
  `QUADRILLE_REQUIRE(subpixel_bits_must_be_2_to_8,
      quadrille_pkg::SUBPIXEL_BITS >= 2 && quadrille_pkg::SUBPIXEL_BITS <= 8)
  `QUADRILLE_REQUIRE(homogeneous_frac_bits_must_be_4_to_10,
      quadrille_pkg::HOMOGENEOUS_FRAC_BITS >= 4 && quadrille_pkg::HOMOGENEOUS_FRAC_BITS <= 10)
  `QUADRILLE_REQUIRE(quadratic_frac_bits_must_be_at_most_twice_the_fraction_bits,
      quadrille_pkg::QUADRATIC_FRAC_BITS <= 2 * FRAC)
  `QUADRILLE_REQUIRE(significand_bits_must_be_8_to_26, S >= 8 && S <= 26)
  `QUADRILLE_REQUIRE(notch_exact_must_be_0_or_1, quadrille_pkg::NOTCH_EXACT >= 0 && quadrille_pkg::NOTCH_EXACT <= 1)
  `QUADRILLE_REQUIRE(sqrt_segments_log2_must_be_at_least_3_and_below_significand_bits, RK >= 3 && RK <= S - 1)
  `QUADRILLE_REQUIRE(recip_segments_log2_must_be_at_least_3_and_below_significand_bits, CK >= 3 && CK <= S - 1)
  `QUADRILLE_REQUIRE(sqrt_degree_must_be_1_or_2, quadrille_pkg::SQRT_DEGREE >= 1 && quadrille_pkg::SQRT_DEGREE <= 2)
  `QUADRILLE_REQUIRE(recip_degree_must_be_1_or_2, quadrille_pkg::RECIP_DEGREE >= 1 && quadrille_pkg::RECIP_DEGREE <= 2)
  `QUADRILLE_REQUIRE(align_guard_bits_must_be_0_to_6,
      quadrille_pkg::ALIGN_GUARD_BITS >= 0 && quadrille_pkg::ALIGN_GUARD_BITS <= 6)
  `QUADRILLE_REQUIRE(attribute_slots_must_be_1_to_8,
      quadrille_pkg::ATTRIBUTE_SLOTS >= 1 && quadrille_pkg::ATTRIBUTE_SLOTS <= 8)
  `QUADRILLE_REQUIRE(attribute_int_bits_must_be_1_to_15,
      quadrille_pkg::ATTRIBUTE_INT_BITS >= 1 && quadrille_pkg::ATTRIBUTE_INT_BITS <= 15)
  `QUADRILLE_REQUIRE(attribute_frac_bits_must_be_significand_bits_to_30,
      quadrille_pkg::ATTRIBUTE_FRAC_BITS >= S && quadrille_pkg::ATTRIBUTE_FRAC_BITS <= 30)
  `QUADRILLE_REQUIRE(depth_bits_must_be_8_to_30, quadrille_pkg::DEPTH_BITS >= 8 && quadrille_pkg::DEPTH_BITS <= 30)
  `QUADRILLE_REQUIRE(tile_log2_must_be_2_to_4, quadrille_pkg::TILE_LOG2 >= 2 && quadrille_pkg::TILE_LOG2 <= 4)
  `QUADRILLE_REQUIRE(pixels_per_clock_must_be_1_2_or_4,
      quadrille_pkg::PIXELS_PER_CLOCK == 1 || quadrille_pkg::PIXELS_PER_CLOCK == 2 ||
      quadrille_pkg::PIXELS_PER_CLOCK == 4)
  `QUADRILLE_REQUIRE(dot_units_must_be_2_or_4, quadrille_pkg::DOT_UNITS == 2 || quadrille_pkg::DOT_UNITS == 4)
  `QUADRILLE_REQUIRE(quad_slots_log2_must_be_1_to_4,
      quadrille_pkg::QUAD_SLOTS_LOG2 >= 1 && quadrille_pkg::QUAD_SLOTS_LOG2 <= 4)
  `QUADRILLE_REQUIRE(tile_slots_log2_must_be_1_to_4,
      quadrille_pkg::TILE_SLOTS_LOG2 >= 1 && quadrille_pkg::TILE_SLOTS_LOG2 <= 4)
  `QUADRILLE_REQUIRE(stamp_fifo_log2_must_be_1_to_5,
      quadrille_pkg::STAMP_FIFO_LOG2 >= 1 && quadrille_pkg::STAMP_FIFO_LOG2 <= 5)
  `QUADRILLE_REQUIRE(performance_counters_must_be_0_or_1,
      quadrille_pkg::PERFORMANCE_COUNTERS >= 0 && quadrille_pkg::PERFORMANCE_COUNTERS <= 1)
  `QUADRILLE_REQUIRE(hierarchical_z_bits_must_be_0_or_4_to_16,
      quadrille_pkg::HIERARCHICAL_Z_BITS == 0 || (quadrille_pkg::HIERARCHICAL_Z_BITS >= 4 &&
      quadrille_pkg::HIERARCHICAL_Z_BITS <= 16))
  `QUADRILLE_REQUIRE(hierarchical_z_bits_must_be_at_most_depth_bits,
      quadrille_pkg::HIERARCHICAL_Z_BITS <= quadrille_pkg::DEPTH_BITS)
  `QUADRILLE_REQUIRE(hierarchical_z_tiles_log2_must_be_6_to_16,
      quadrille_pkg::HIERARCHICAL_Z_TILES_LOG2 >= 6 && quadrille_pkg::HIERARCHICAL_Z_TILES_LOG2 <= 16)
  `QUADRILLE_REQUIRE(plane_quads_must_be_0_or_1, quadrille_pkg::PLANE_QUADS >= 0 && quadrille_pkg::PLANE_QUADS <= 1)
`ifdef QUADRILLE_PLANE_TOLERANCE_BITS
  // of a tolerance that plane quads had once
  `QUADRILLE_REQUIRE(plane_tolerance_bits_was_removed_plane_quads_takes_exactly_plane_ones,
      `QUADRILLE_PLANE_TOLERANCE_BITS == 0)
`endif
  `QUADRILLE_REQUIRE(quad_id_bits_must_be_8_to_32,
      quadrille_pkg::QUAD_ID_BITS >= 8 && quadrille_pkg::QUAD_ID_BITS <= 32)
  // with it a position fits a dot unit's operand: T_BITS <= 32
  `QUADRILLE_REQUIRE(a_d_and_r2_must_fit_64_bits_fewer_viewport_guard_or_fraction_bits, quadrille_pkg::VAL_BITS <= 64)
  `QUADRILLE_REQUIRE(a_block_over_the_edge_of_the_viewport_must_not_overflow_smaller_tile_log2_or_more_guard_bits,
      64'(2) * 64'(REACH) * 64'(REACH) < 64'(1) << (quadrille_pkg::VAL_BITS - 1 - 2 * FRAC))

  // The tables are a file of their own, made for one configuration.
  `QUADRILLE_REQUIRE(tables_must_be_of_this_significand_bits, quadrille_tables_pkg::SIGNIFICAND_BITS == S)
  `QUADRILLE_REQUIRE(tables_must_be_of_this_sqrt_segments_log2, quadrille_tables_pkg::SQRT_SEGMENTS_LOG2 == RK)
  `QUADRILLE_REQUIRE(tables_must_be_of_this_sqrt_degree,
      quadrille_tables_pkg::SQRT_DEGREE == quadrille_pkg::SQRT_DEGREE)
  `QUADRILLE_REQUIRE(tables_must_be_of_this_recip_segments_log2, quadrille_tables_pkg::RECIP_SEGMENTS_LOG2 == CK)
  `QUADRILLE_REQUIRE(tables_must_be_of_this_recip_degree,
      quadrille_tables_pkg::RECIP_DEGREE == quadrille_pkg::RECIP_DEGREE)
endmodule

`undef QUADRILLE_REQUIRE
