#include "tb/sweep/given_truth.hpp"

#include "golden/reference/truth.hpp"
#include "model/support/parallel.hpp"

#include <algorithm>
#include <array>

namespace quadrille::sweep {
namespace {

constexpr int rows_of_a_band = 8;

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

GivenTruth::GivenTruth(const SweepInput& input, unsigned threads, const Stop& stop)
    : stride_(1 + Columns{static_cast<std::size_t>(input.attributes)}.count()), first_{0} {
  DrawState state = input.state;
  state.attributes = input.attributes;
  std::vector<Band> bands;
  for (std::size_t q = 0; q < input.quads.size(); ++q) {
    const golden::PixelRect box = golden::TruthQuad(input.quads[q], state).bounds();
    for (int y = box.y0; y < box.y1; y += rows_of_a_band) bands.push_back({q, y, std::min(y + rows_of_a_band, box.y1)});
  }

  const auto draw = [&](std::size_t unit) {
    stop.check();
    const Band& band = bands[unit];
    const WindowQuad& quad = input.quads[band.quad];
    const golden::TruthQuad truth(quad, state);
    BandResult out;
    for (int y = band.y0; y < band.y1; ++y) {
      const golden::PixelSpan row = truth.rows().row(y);
      for (int x = row.x0; x < row.x1; ++x) {
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
