// What exact arithmetic has at the boundaries of the machine, of one snapped quad at one pixel: exact integers, then
// numbers of 113 bits, by the definitions that golden/reference/truth.hpp has, and with its weights.
#pragma once

#include "golden/reference/truth.hpp"
#include "model/one_pixel.hpp"
#include "model/support/float113.hpp"

#include <array>
#include <string>

namespace quadrille::explain {

/// A linear or quadratic function around a pixel: value + dx gx + dy gy + q (dx² + dy²), units 2^-2FRAC.
struct ExactForm {
  __int128 value = 0, gx = 0, gy = 0, q = 0;
};

/// A quad seen from a pixel, in integers.
class ExactView {
 public:
  ExactView(const SnappedQuad& quad, int x, int y);

  ExactForm linear(std::size_t pair) const;         ///< S_i × S_j of vertex_pair[pair]
  ExactForm quadratic(std::size_t k) const;         ///< S_i · S_j of pair k < 6; |S_i|² of vertex k - 6
  __int128 squared_length(std::size_t pair) const;  ///< |V_i - V_j|²

 private:
  std::array<__int128, 4> x_{}, y_{}, w_{};
};

/// From the roots on. Lengths are in units of 2^-FRAC, areas and products in 2^-2FRAC; weights and what follows have no
/// unit.
struct ExactPixel {
  /// `machine` gives the common factor of the weights, which have none of their own: the exact ones get the same sum.
  ExactPixel(const SnappedQuad& quad, const golden::TruthQuad& truth, const OnePixel& machine,
             const PipelineContext& context);

  std::array<Float113, 4> root{};
  std::array<Float113, 6> u{}, v{};
  std::array<Float113, 4> m{};
  Float113 den_k = 0, den_w = 0, num_z = 0;
  std::array<Float113, max_attribute_slots> num_a{};
  std::array<Float113, 4> lambda{};                       ///< of the weights: 0 where their sum is
  Float113 z = 0;                                         ///< clamped to the corners' codes
  std::array<Float113, max_attribute_slots> attribute{};  ///< not clamped
  golden::ReferenceSample truth;                          ///< the truth's own sample
};

inline Float113 magnitude(Float113 v) { return v < 0 ? -v : v; }
/// v · 2^exponent
Float113 scaled(Float113 v, int exponent);
/// floor(log2 |v|), v not 0.
int exponent_of(Float113 v);
/// `digits` significant digits.
std::string decimal(Float113 v, int digits);

}  // namespace quadrille::explain
