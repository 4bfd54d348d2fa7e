#include "tb/sweep/given_truth.hpp"

#include "golden/reference/truth.hpp"
#include "model/support/parallel.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace quadrille::sweep {
namespace {

constexpr int cell = 8;  ///< pixels, edge of a square that is looked at as a whole

/// The five edge functions of expression (12) in double with a bound of their rounding: enough to see that a square of
/// pixels lies outside. The truth's own test of every pixel of a large box takes far longer.
class OutsideTest {
 public:
  explicit OutsideTest(const WindowQuad& quad) {
    constexpr std::array<std::array<std::size_t, 2>, 5> ends{{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {2, 0}}};
    for (std::size_t k = 0; k < 5; ++k) {
      const WindowVertex &a = quad.vertex[ends[k][0]], &b = quad.vertex[ends[k][1]];
      edge_[k] = {a.y * b.w - a.w * b.y,
                  a.w * b.x - a.x * b.w,
                  a.x * b.y - a.y * b.x,
                  std::fabs(a.y * b.w) + std::fabs(a.w * b.y),
                  std::fabs(a.w * b.x) + std::fabs(a.x * b.w),
                  std::fabs(a.x * b.y) + std::fabs(a.y * b.x)};
    }
  }

  /// True only when no pixel of the square from (x, y) can be covered.
  bool outside(int x, int y) const {
    std::array<bool, 5> positive, negative;
    const double half = cell / 2.0, cx = x + half, cy = y + half;
    for (std::size_t k = 0; k < 5; ++k) {
      const Edge& e = edge_[k];
      const double value = e.gx * cx + e.gy * cy + e.c;
      // Roundings are a few 2^-53 of the magnitudes; 2^-40 is far above.
      const double reach =
          (std::fabs(e.gx) + std::fabs(e.gy)) * half + 0x1p-40 * (e.size_x * cx + e.size_y * cy + e.size_c);
      positive[k] = !(value + reach < 0);
      negative[k] = !(value - reach > 0);
    }
    const auto inside = [](const auto& p, const auto& n) {
      return (p[4] && p[0] && p[1] && (p[2] || p[3])) || (n[4] && p[2] && p[3] && (p[0] || p[1]));
    };
    return !inside(positive, negative) && !inside(negative, positive);
  }

 private:
  struct Edge {
    double gx, gy, c;
    double size_x, size_y, size_c;  ///< sums of magnitudes behind each coefficient
  };
  std::array<Edge, 5> edge_{};
};

/// Rows of one quad.
struct Band {
  std::size_t quad;
  int y0, y1;
};

struct BandResult {
  std::vector<std::uint32_t> pixel;
  std::vector<double> values;
};

}  // namespace

GivenTruth::GivenTruth(const SweepInput& input, unsigned threads)
    : stride_(1 + Columns{static_cast<std::size_t>(input.attributes)}.count()), first_{0} {
  DrawState state = input.state;
  state.attributes = input.attributes;
  std::vector<Band> bands;
  for (std::size_t q = 0; q < input.quads.size(); ++q) {
    const golden::PixelRect box = golden::TruthQuad(input.quads[q], state).bounds();
    for (int y = box.y0; y < box.y1; y += cell) bands.push_back({q, y, std::min(y + cell, box.y1)});
  }

  const auto draw = [&](std::size_t unit) {
    const Band& band = bands[unit];
    const WindowQuad& quad = input.quads[band.quad];
    const golden::TruthQuad truth(quad, state);
    const OutsideTest test(quad);
    BandResult out;
    std::vector<int> cells;
    for (int x = truth.bounds().x0; x < truth.bounds().x1; x += cell)
      if (!test.outside(x, band.y0)) cells.push_back(x);
    for (int y = band.y0; y < band.y1; ++y)
      for (const int x0 : cells)
        for (int x = x0; x < std::min(x0 + cell, truth.bounds().x1); ++x) {
          const golden::Coverage coverage = truth.cover(x, y);
          if (!coverage.covered || !coverage.visible || state.cull == (coverage.front ? Cull::front : Cull::back))
            continue;
          const golden::ReferenceSample sample = truth.sample(x, y);
          if (state.depth && !(sample.z >= state.znear && sample.z <= state.zfar)) continue;
          out.pixel.push_back(pack_pixel(x, y));
          out.values.push_back(sample.z);
          out.values.insert(out.values.end(), sample.lambda.begin(), sample.lambda.end());
          out.values.insert(out.values.end(), sample.attribute.begin(), sample.attribute.begin() + input.attributes);
          for (std::size_t channel = 0; channel < 3; ++channel) {
            double colour = 0;  // Σ M k c / Σ M k: the weights' own sum
            for (std::size_t i = 0; i < 4; ++i) colour += sample.lambda[i] * corner_colour[i][channel];
            out.values.push_back(colour);
          }
        }
    return out;
  };
  ordered_parallel(bands.size(), threads, draw, [&](std::size_t unit, const BandResult& result) {
    while (first_.size() <= bands[unit].quad) first_.push_back(pixel_.size());
    pixel_.insert(pixel_.end(), result.pixel.begin(), result.pixel.end());
    values_.insert(values_.end(), result.values.begin(), result.values.end());
  });
  while (first_.size() <= input.quads.size()) first_.push_back(pixel_.size());
}

}  // namespace quadrille::sweep
