// What the bounds allow each output of one pixel.
#pragma once

#include "golden/analysis/judged_quad.hpp"
#include "golden/reference/sample.hpp"

#include <array>
#include <cstddef>

namespace quadrille {

/// How far attributes and window z may be from the truth at one pixel: their tolerances (judged_quad.hpp) and half
/// a unit of the output, which is rounded.
struct AllowedErrors {
  std::array<double, 4> weight{};
  std::array<double, max_attribute_slots> attribute{};
  double depth = 0;  ///< infinite where sum(M W) cancels to what the weights' errors leave of it
};
/// Of one quad, of the attributes that `state` has in use. With perspective they come of the truth's weights in double,
/// not of 113-bit ones as JudgedQuad's: the same numbers but for rounding.
class ErrorBounds {
 public:
  /// `quad` must outlive this.
  ErrorBounds(const JudgedQuad& quad, const Config& config, const DrawState& state);

  /// `truth` is that of the pixel.
  AllowedErrors at(const golden::ReferenceSample& truth, int x, int y) const;

 private:
  double depth(const golden::ReferenceSample& truth) const;

  const JudgedQuad& quad_;
  std::size_t attributes_;
  double attribute_code_, depth_code_;  ///< half a code
  bool quick_;                          ///< nothing but the weights of eq. (10) is needed
  std::array<double, 4> z_{}, w_{};     ///< Z/k and W/k
  AllowedErrors fixed_;                 ///< of weights and attributes, where the pixel does not matter
};

}  // namespace quadrille
