// The truth that every other body is measured against: homogeneous, switched mean value coordinates of Hormann and
// Tarini, "A Quadrilateral Rendering Primitive" (2004), with exact integers where the input is integer and 113-bit
// floating point behind them. No epsilon decides anything here.
#pragma once

#include "golden/reference/coverage_rows.hpp"
#include "golden/reference/sample.hpp"
#include "golden/reference/truth_lanes.hpp"
#include "model/port/config.hpp"
#include "model/port/records.hpp"
#include "model/support/float113.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <type_traits>
#include <variant>
#include <vector>

namespace quadrille::golden {

/// A pixel by its column and row.
struct PixelPlace {
  int x = 0, y = 0;
};

/// The part of a ReferenceSample that needs no weights (save `visible` when `eye_in_hull`).
struct Coverage {
  bool covered = false;  ///< inside by expression (12) with ties as if the pixel centre were moved by (+eps, +eps^2)
  bool front = false;    ///< counter-clockwise as seen on the screen: the negated form of (12), for y points down
  bool visible = false;  ///< in front of the eye; false where not covered
  bool eye_in_hull = false;  ///< the eye is in the convex hull of the four vertices: `visible` is the sign of sum(M w)
  std::uint8_t flags = 0;    ///< flag_tie (an all-zero edge function counts as 0) and flag_homogeneous
};

namespace detail {

/// Four homogeneous vertices relative to pixel centres, and what depends on them alone. Coord = int64 with Product =
/// __int128 (every product and sum below exact for any int32 vertices and pixels), or Float113 for both.
/// Edges are numbered 01, 12, 23, 30, and 20 (the diagonal).
template <class Coord, class Product>
struct TruthGeometry {
  std::array<Coord, 4> x{}, y{}, w{};
  std::array<std::int8_t, 5> tie_sign{};  ///< sign of an edge function that is 0 at the pixel; 0 for an all-zero edge
  int det_012 = 0, det_023 = 0;           ///< signs of V_i . (V_j x V_k)
  bool flat = false;                      ///< all four determinants are 0: eye and vertices lie in one plane
  bool eye_in_hull = false;

  void finish();
};

/// Values of the vertices, w in units of 1: k, k (z~ - base w~) and k_eff (a - base) of a snapped quad, b of its vertex
/// 0 being 0. Those of the port are exact in either Number; others are within 2^-64.
template <class Number>
struct VertexValues {
  std::array<Number, 4> k{}, z{}, w{};
  std::array<std::array<Number, 4>, max_attribute_slots> b{};

  VertexValues() = default;
  template <class Other>
  explicit VertexValues(const VertexValues<Other>& from) {
    const auto copy = [](const auto& a, auto& to) {
      for (std::size_t i = 0; i < 4; ++i) to[i] = static_cast<Number>(a[i]);
    };
    copy(from.k, k);
    copy(from.z, z);
    copy(from.w, w);
    for (std::size_t a = 0; a < b.size(); ++a) copy(from.b[a], b[a]);
  }
};

}  // namespace detail

/// One quad, ready to be asked about any pixel. Two ways in:
///  - snapped: X, Y, W in units of 2^-frac relative to pixel centres at the integers; k, Z, b the rounded numbers of
///    the port, to which the quad's bases are added; depth is clamped to the corners' codes. A, D and R^2 are exact
///    integers, hence coverage, ties and singular classes are exact.
///  - as given: pixel centres at +0.5, k = 1, Z = z~, b = a (w a without perspective), no base. The same formulas in
///    Float113; edge functions round at 113 bits, so a tie is recognised when that rounding gives 0.
/// The weights carry a relative error of about 2^-108 times `ReferenceSample::condition`; results are rounded to
/// double.
class TruthQuad {
 public:
  /// Uses the formats of the port and of the output; the truth never drops bits of D and R^2. Throws
  /// std::invalid_argument when a vertex is (0, 0, 0) or draw.attributes is out of range.
  TruthQuad(const SnappedQuad& quad, const Config& config, const DrawState& draw);
  /// Attributes beyond the vector given for a vertex count as 0. Throws std::invalid_argument for a vertex that is
  /// (0, 0, *, 0) or not finite, or draw.attributes out of range. flag_homogeneous means w <= 0: the guard band is a
  /// matter of snapping.
  TruthQuad(const WindowQuad& quad, const DrawState& draw);

  /// Everything about pixel (px, py): eq. (10), (11), (4) and (12) of the paper. Scissor, cull mode, znear and zfar are
  /// not applied. Where the pixel is not covered only `covered`, `eye_in_hull` and `flags` (tie, homogeneous) are set.
  ///
  /// With M_i = (t_{i-1} + t_i) / R_i: lambda'_i = M_i k_i / sum(M k), z = base + sum(M Z) / sum(M W), attribute =
  /// base + sum(M b) / sum(M k). Without perspective lambda_i = M_i W_i / sum(M W), attribute = base + sum(M b) /
  /// sum(M W).
  /// Singular pixels, in this order (the first that applies gives M and the flag):
  ///   two corners i, j at the pixel    M_i = |k_j|, M_j = |k_i|          lambda' = 1/2 each
  ///   one corner                       M_i = 1                           lambda' = 1
  ///   two edges (A = 0, D < 0) at once M_i = rho_i * |sum over the other edge of rho k|, added for a vertex on both;
  ///                                    rho = 1/R                         lambda' = mean of the two edge interpolations
  ///   one edge                         the general form gives the linear interpolation along the edge
  /// visible_margin is signed so that it is positive in front of the eye, and exactly 0 where sum(M w) vanishes
  /// identically (eye and vertices in a plane without the pixel's ray). Where sum(M W) = 0, z is its base and
  /// z_condition infinite.
  ///
  /// A filter in long double decides the pixels where no sum cancels, which it knows from bounds evaluated with the
  /// sums (as in Shewchuk's predicates, "Adaptive Precision Floating-Point Arithmetic", 1997): flags and signs are the
  /// same, values differ by at most 2^-53 of the largest term. Effort::all_bits leaves it out.
  enum class Effort { filter, all_bits };
  ReferenceSample sample(int px, int py, Effort effort = Effort::filter) const;

  /// sample() of many pixels, of which a second filter in double-double numbers decides most, eight at a time
  /// (truth_lanes.hpp): flags and signs are the same again, values those of all bits rounded to double but for their
  /// last bit (beside the largest term, where terms of both signs are summed). The same with any `lanes`. `decided`,
  /// for tests: which pixels it decided.
  void samples(std::span<const PixelPlace> pixels, std::span<ReferenceSample> out, LaneTarget lanes = lane_target(),
               std::vector<bool>* decided = nullptr) const;

  /// The filter cannot decide the pixel.
  bool needs_113_bits(int px, int py) const;

  /// The coverage part of sample() alone, without any weight (unless eye_in_hull).
  Coverage cover(int px, int py) const;

  /// M_0..M_3 up to a common factor of either sign, at any pixel, inside or not (eq. 8 in homogeneous form; at singular
  /// pixels as listed at sample()).
  std::array<Float113, 4> homogeneous_weights(int px, int py) const;

  /// Every pixel of the scissor that is covered and visible lies in them; of a quad with the eye in its hull every
  /// covered one.
  const CoverageRows& rows() const { return rows_; }
  PixelRect bounds() const { return rows_.bounds(); }

 private:
  using Exact = detail::TruthGeometry<std::int64_t, __int128>;
  using Rounded = detail::TruthGeometry<Float113, Float113>;

  std::variant<Exact, Rounded> geometry_;
  detail::VertexValues<Float113> exact_;
  detail::VertexValues<long double> quick_;  ///< the same for the filter
  std::optional<detail::LaneQuad> lanes_;    ///< for the second one, where the numbers are such that it can be asked
  int attributes_ = 0;
  bool perspective_ = true;
  bool homogeneous_ = false;
  bool unit_w_ = false;  ///< every w is exactly 1
  /// Added to the quotients: 0 of a quad as given, which has no corner codes either.
  std::array<double, max_attribute_slots> base_attribute_{};
  double base_z_ = 0, z_low_ = -std::numeric_limits<double>::infinity(), z_high_ = -z_low_;
  CoverageRows rows_;

  /// Sets lanes_, given S's coefficients.
  void set_lanes(const std::array<detail::TwoDoubles, 4>& x, const std::array<detail::TwoDoubles, 4>& y,
                 const std::array<double, 4>& w, bool eye_in_hull);
  /// From the quotients z_above and attribute_above of the sums: the values.
  void add_bases(ReferenceSample& sample) const;
  /// The pixel of a lane; false where it did not decide.
  bool take_lane(const detail::LaneSamples& from, std::size_t lane, int det_012, int det_023,
                 ReferenceSample& out) const;

  /// What singular pixels cross.
  const std::array<Float113, 4>& crossing() const { return perspective_ ? exact_.k : exact_.w; }
};

}  // namespace quadrille::golden
