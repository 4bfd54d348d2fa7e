// The frame of one method against that of another, pixel by pixel: coverage, quads, attributes.
#pragma once

#include "tb/studies/compare/attribute_image.hpp"
#include "tb/support/error_stats.hpp"

#include <cstdint>
#include <vector>

namespace quadrille::compare {

/// An attribute off by more than this is wrong, not inaccurate.
inline constexpr double default_wrong_above = 1e-3;

/// Every pixel that either frame covers is `missing`, `extra`, of `other_quad`, one without a number in either frame,
/// or in `error`.
struct FrameError {
  static constexpr float neither_draws = -1;

  std::uint64_t method_covered = 0, reference_covered = 0;  ///< pixels, undefined ones included
  std::uint64_t missing = 0;                                ///< the reference covers them, the method does not
  std::uint64_t extra = 0;                                  ///< the reverse
  std::uint64_t other_quad = 0;                             ///< both cover them, with different quads
  /// Covered without finite numbers, whatever the other frame shows there.
  std::uint64_t method_undefined = 0, reference_undefined = 0;

  /// Largest |difference| of the channels, over the pixels where both show the same quad and have numbers. Its p999 is
  /// the nearest rank (the ceil(0.999 n)-th smallest) rounded up to a sixteenth of an octave, as everywhere.
  tb::ErrorStats error;
  /// Root mean square of those; 0 of nothing. In double, unlike error.rms(), whose fixed point loses errors below
  /// 2^-48: full precision for errors from 1e-150 to 1e150.
  double rms = 0;
  int x = -1, y = -1;  ///< where the largest one is, the first of equal ones in rows; -1 without any
  std::uint64_t wrong = 0;

  /// The error of each pixel in rows; neither_draws where both are empty, NaN where there is no error to take (white in
  /// golden::heat_colour).
  std::vector<float> image;
};

/// Throws std::invalid_argument when sizes or numbers of channels differ.
FrameError compare_frames(const AttributeImage& method, const AttributeImage& reference,
                          double wrong_above = default_wrong_above);

}  // namespace quadrille::compare
