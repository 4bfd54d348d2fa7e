// Every key of the configuration once; all else about a key is read from here. Included by config.hpp and config.cpp,
// which say what KEY makes of an entry:
//   name, least and largest value, default (-1: derived, "auto"), unit;
//   the stage at which it enters, what it does to errors, what else it moves (all of ConfigKey);
//   the values that `quadrille sweep` tries of it where no axis is named: each can be built around the default;
//   what it is.
// model/key_traits_test.cpp holds every trait to what the machine does.
KEY(viewport_bits, 6, 14, 12, "bits", positions, unordered, clocks | area | proofs, "10:12",
    "pixel x and y lie in [0, 2^viewport_bits)")
KEY(guard_bits, 1, 4, 3, "bits", positions, unordered, clocks | area | proofs, "1:3",
    "guard band: |X| <= 2^(viewport_bits + guard_bits) pixels")
KEY(subpixel_bits, 2, 8, 8, "bits", positions, unordered, clocks | area | proofs, "2:8",
    "fraction bits of an ordinary vertex position")
KEY(homogeneous_frac_bits, 4, 10, 7, "bits", positions, unordered, clocks | area | proofs, "4:7",
    "further fraction bits of a homogeneous vertex")
KEY(quadratic_frac_bits, 0, 36, -1, "bits", differences, ordered, area | proofs, "0:28:4,auto",
    "kept fraction bits of D and r²; auto: all, 2·(subpixel + homogeneous)")
KEY(significand_bits, 8, 26, 18, "bits", normalise, ordered, area | proofs, "8:26",
    "s: bits of every multiplier operand after normalisation, tables included")
KEY(notch_exact, 0, 1, 1, "", none, none, nothing, "0,1", "flag 6 where neighbouring A differ in sign")
KEY(sqrt_segments_log2, 3, 14, -1, "log2", sqrt, ordered, area | proofs, "3:10,auto",
    "sqrt table segments per octave; auto: ceil((s-4)/3), degree 1 ceil(s/2), at least 3")
KEY(sqrt_degree, 1, 2, 2, "", sqrt, ordered, area | proofs, "1,2", "polynomial degree of the sqrt table")
KEY(recip_segments_log2, 3, 14, -1, "log2", reciprocal, ordered, area | proofs, "3:10,auto",
    "reciprocal table segments; auto: ceil((s-2)/3), degree 1 ceil((s+1)/2), at least 3")
KEY(recip_degree, 1, 2, 2, "", reciprocal, ordered, area | proofs, "1,2", "polynomial degree of the reciprocal table")
KEY(align_guard_bits, 0, 6, 2, "bits", ratios, ordered, area | proofs, "0:6",
    "fraction bits kept below the s bits of the largest term of a sum")
KEY(attribute_slots, 1, 8, 4, "", none, none, area, "1,2,4,8", "attributes per vertex at the port")
KEY(attribute_int_bits, 1, 15, 7, "bits", interpolate, ordered, area | proofs, "1:4",
    "integer bits of an output attribute, sign apart")
KEY(attribute_frac_bits, 8, 30, -1, "bits", interpolate, ordered, area | proofs, "18:26:2,auto",
    "fraction bits of an output attribute, at least s; auto: 24, or s + 2 if that is more")
KEY(depth_bits, 8, 30, 24, "bits", interpolate, ordered, clocks | area | proofs, "16:28:4", "fraction bits of window z")
KEY(tile_log2, 2, 4, 3, "log2 px", differences, unordered, clocks | area | proofs, "2:4",
    "tile edge, also the width of a stamp; a block is 8x8 tiles")
KEY(pixels_per_clock, 1, Config::most_pixels_per_clock, 1, "", none, none, clocks | area, "1,2,4",
    "lanes of the fragment port: 1, 2 or 4 pixels of a row")
KEY(dot_units, 2, 4, 2, "", none, none, clocks | area, "2,4", "multiplier pairs of setup and tile contexts: 2 or 4")
KEY(quad_slots_log2, 1, 4, 3, "log2", none, none, clocks | area, "1:4",
    "quads in flight between setup and their last fragment")
KEY(tile_slots_log2, 1, 4, 2, "log2", none, none, clocks | area, "1:4", "tile contexts in flight")
KEY(stamp_fifo_log2, 1, 5, 3, "log2", none, none, clocks | area, "1:5", "covered stamps that may wait")
KEY(hierarchical_z_bits, 0, 16, 0, "bits", none, none, clocks | area, "0,8,12,16",
    "fraction bits of a tile's farthest depth; 0: no hidden tiles")
KEY(hierarchical_z_tiles_log2, 6, 16, 12, "log2", none, none, clocks | area, "8:14:2",
    "tiles whose farthest depth is held")
KEY(plane_quads, 0, 1, 0, "", plane, unordered, area, "0,1",
    "exactly plane quads take areas for weights; 0: no hardware for them")
KEY(quad_id_bits, 8, 32, 24, "bits", none, ordered, area, "16,24,32", "width of the quad id")
KEY(performance_counters, 0, 1, 0, "", none, none, area, "0,1",
    "counters of what the machine did; 0: no hardware for them")
