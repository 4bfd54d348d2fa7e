// What a reference says about one pixel of one quad.
#pragma once

#include "model/port/records.hpp"

#include <array>
#include <cstdint>

namespace quadrille::golden {

struct ReferenceSample {
  bool covered = false;  ///< inside by the coverage rule (facing not yet culled, visibility not yet applied)
  bool front = false;    ///< counter-clockwise as seen on the screen
  bool visible = false;  ///< in front of the eye
  bool eye_in_hull =
      false;  ///< visibility was decided by the sign of sum(M w); a machine may differ where |visible_margin| is tiny
  bool undefined =
      false;  ///< the formulas as printed divide by zero here (float engine only); lambda etc. are not to be used
  std::uint8_t flags = 0;  ///< FragmentFlag bits on_edge, on_vertex, two_corner, two_edge, tie, homogeneous
  bool notch = false;  ///< neighbouring t differ in sign (A_{i-1} A_i < 0 for some i) and the weights are their sums,
                       ///< that is at no corner and on fewer than two edges (truth only)
  double visible_margin = 0;       ///< sum(M w) / sum(|M w|), in [-1, 1]
  double condition = 1;            ///< sum((|t_{i-1}| + |t_i|) k_i / R_i) / |sum(M k)| ; 1 at singular pixels
  std::array<double, 4> lambda{};  ///< perspective-correct weights; without perspective the screen-space ones
  double z = 0;                    ///< window z
  double z_condition = 1;          ///< sum(|M W|) / |sum(M W)|
  std::array<double, max_attribute_slots> attribute{};
  /// z and attributes without the bases of a snapped quad (truth only): exact relative to what varies over the quad,
  /// where the sums above are exact relative to their own size. Of a quad as given the same as above.
  double z_above = 0;
  std::array<double, max_attribute_slots> attribute_above{};

  friend bool operator==(const ReferenceSample&, const ReferenceSample&) = default;
};

}  // namespace quadrille::golden
