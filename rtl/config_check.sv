// Refuses an impossible configuration at elaboration, naming the rule it breaks. No hardware.
module config_check;
  localparam int VIEWPORT_BITS = quadrille_pkg::VIEWPORT_BITS;
  localparam int GUARD_BITS = quadrille_pkg::GUARD_BITS;
  localparam int POS_INT = quadrille_pkg::POS_INT;
  localparam int FRAC = quadrille_pkg::FRAC;
  localparam int S = quadrille_pkg::SIGNIFICAND_BITS;
  localparam int RK = quadrille_pkg::RSQRT_SEGMENTS_LOG2;
  localparam int CK = quadrille_pkg::RECIP_SEGMENTS_LOG2;
  // max |S| in pixels: guard band, viewport, and the part of a block that hangs over
  localparam int REACH = (1 << POS_INT) + (1 << VIEWPORT_BITS) + (1 << (quadrille_pkg::TILE_LOG2 + quadrille_pkg::BLOCK_LOG2));

  initial if (VIEWPORT_BITS < 6 || VIEWPORT_BITS > 14) $fatal(1, "viewport_bits must be 6 to 14");
  initial if (GUARD_BITS < 1 || GUARD_BITS > 4) $fatal(1, "guard_bits must be 1 to 4");
  initial if (quadrille_pkg::SUBPIXEL_BITS < 2 || quadrille_pkg::SUBPIXEL_BITS > 8) $fatal(1, "subpixel_bits must be 2 to 8");
  initial if (quadrille_pkg::HOMOGENEOUS_FRAC_BITS < 4 || quadrille_pkg::HOMOGENEOUS_FRAC_BITS > 10)
    $fatal(1, "homogeneous_frac_bits must be 4 to 10");
  initial if (quadrille_pkg::QUADRATIC_FRAC_BITS > 2 * FRAC) $fatal(1, "quadratic_frac_bits must be at most twice the fraction bits");
  initial if (S < 8 || S > 26) $fatal(1, "significand_bits must be 8 to 26");
  initial if (quadrille_pkg::NOTCH_EXACT < 0 || quadrille_pkg::NOTCH_EXACT > 1) $fatal(1, "notch_exact must be 0 or 1");
  initial if (RK < 3 || RK > S - 1) $fatal(1, "rsqrt_segments_log2 must be at least 3 and below significand_bits");
  initial if (CK < 3 || CK > S - 1) $fatal(1, "recip_segments_log2 must be at least 3 and below significand_bits");
  initial if (quadrille_pkg::RSQRT_DEGREE < 1 || quadrille_pkg::RSQRT_DEGREE > 2) $fatal(1, "rsqrt_degree must be 1 or 2");
  initial if (quadrille_pkg::RECIP_DEGREE < 1 || quadrille_pkg::RECIP_DEGREE > 2) $fatal(1, "recip_degree must be 1 or 2");
  initial if (quadrille_pkg::ALIGN_GUARD_BITS < 0 || quadrille_pkg::ALIGN_GUARD_BITS > 6) $fatal(1, "align_guard_bits must be 0 to 6");
  initial if (quadrille_pkg::ATTRIBUTE_SLOTS < 1 || quadrille_pkg::ATTRIBUTE_SLOTS > 8) $fatal(1, "attribute_slots must be 1 to 8");
  initial if (quadrille_pkg::ATTRIBUTE_INT_BITS < 1 || quadrille_pkg::ATTRIBUTE_INT_BITS > 8)
    $fatal(1, "attribute_int_bits must be 1 to 8");
  initial if (quadrille_pkg::ATTRIBUTE_FRAC_BITS < S || quadrille_pkg::ATTRIBUTE_FRAC_BITS > 30)
    $fatal(1, "attribute_frac_bits must be significand_bits to 30");
  initial if (quadrille_pkg::DEPTH_BITS < 8 || quadrille_pkg::DEPTH_BITS > 30) $fatal(1, "depth_bits must be 8 to 30");
  initial if (quadrille_pkg::TILE_LOG2 < 2 || quadrille_pkg::TILE_LOG2 > 4) $fatal(1, "tile_log2 must be 2 to 4");
  initial if (quadrille_pkg::PIXELS_PER_CLOCK != 1) $fatal(1, "pixels_per_clock must be 1");
  initial if (quadrille_pkg::QUAD_SLOTS_LOG2 < 1 || quadrille_pkg::QUAD_SLOTS_LOG2 > 4) $fatal(1, "quad_slots_log2 must be 1 to 4");
  initial if (quadrille_pkg::TILE_SLOTS_LOG2 < 1 || quadrille_pkg::TILE_SLOTS_LOG2 > 4) $fatal(1, "tile_slots_log2 must be 1 to 4");
  initial if (quadrille_pkg::STAMP_FIFO_LOG2 < 1 || quadrille_pkg::STAMP_FIFO_LOG2 > 5) $fatal(1, "stamp_fifo_log2 must be 1 to 5");
  initial if (quadrille_pkg::QUAD_ID_BITS < 8 || quadrille_pkg::QUAD_ID_BITS > 32) $fatal(1, "quad_id_bits must be 8 to 32");
  initial if (quadrille_pkg::VAL_BITS > 64) $fatal(1, "A, D and R^2 must fit 64 bits: fewer viewport, guard or fraction bits");
  initial if (quadrille_pkg::T_BITS > quadrille_pkg::DOT_BITS) $fatal(1, "a position must fit a dot unit operand");
  initial if (64'(2) * 64'(REACH) * 64'(REACH) >= 64'(1) << (quadrille_pkg::VAL_BITS - 1 - 2 * FRAC))
    $fatal(1, "a block that hangs over the viewport makes A, D or R^2 overflow: smaller tile_log2 or more guard_bits");
endmodule
