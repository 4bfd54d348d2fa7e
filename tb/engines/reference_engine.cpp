#include "tb/engines/reference_engine.hpp"

#include "golden/reference/paper_float.hpp"
#include "golden/reference/truth.hpp"
#include "model/port/snap.hpp"
#include "model/port/stages.hpp"
#include "model/support/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <stdexcept>

namespace quadrille::tb {
namespace {

using golden::PaperFp32Quad;
using golden::PaperFp64Quad;
using golden::PixelRect;
using golden::ReferenceSample;
using golden::TruthQuad;

constexpr std::size_t quads_at_a_time = 4096;
constexpr int pixels_per_unit = 16384;

class ReferenceEngine final : public Engine {
 public:
  explicit ReferenceEngine(const EngineSettings& settings) : settings_(settings), limits_(settings) {}

  void draw(std::span<const WindowQuad> quads, int attributes, bool, const SampleSink& sink) override {
    DrawState state = settings_.state;
    state.attributes = attributes;
    for (std::size_t first = 0; first < quads.size(); first += quads_at_a_time)
      draw_some(quads, first, std::min(quads.size(), first + quads_at_a_time), state, sink);
  }

 private:
  struct Prepared {
    std::optional<TruthQuad> truth;
    std::optional<PaperFp64Quad> paper;
    std::optional<PaperFp32Quad> single;

    const golden::CoverageRows& rows() const { return truth ? truth->rows() : single ? single->rows() : paper->rows(); }
    const PixelRect& bounds() const { return rows().bounds(); }
  };
  /// Rows of one quad, or several small quads.
  struct Unit {
    std::size_t first, last;
    int y0, y1;
  };

  Prepared prepare(const WindowQuad& quad, const DrawState& state) const {
    Prepared result;
    const Config config = snapping_config(settings_.config, state.attributes);
    const SnappedQuad snapped = snap_as(quad, 0, config, state);  // refuses what no engine draws, also when not used
    const auto emplace = [&](auto& body) {
      if (settings_.snap)
        body.emplace(snapped, config, state);
      else
        body.emplace(quad, state);
    };
    if (settings_.kind == EngineKind::truth)
      emplace(result.truth);
    else if (settings_.kind == EngineKind::paper_single)
      emplace(result.single);
    else
      emplace(result.paper);
    return result;
  }

  void draw_some(std::span<const WindowQuad> quads, std::size_t first, std::size_t last, const DrawState& state,
                 const SampleSink& sink) const {
    std::vector<Prepared> prepared;
    constexpr std::size_t block = 64;
    ordered_parallel((last - first + block - 1) / block, settings_.threads,
                     [&](std::size_t unit) {
                       std::vector<Prepared> part;
                       for (std::size_t i = first + unit * block; i < std::min(last, first + (unit + 1) * block); ++i)
                         part.push_back(prepare(quads[i], state));
                       return part;
                     },
                     [&](std::size_t, std::vector<Prepared>&& part) {
                       std::move(part.begin(), part.end(), std::back_inserter(prepared));
                     });

    std::vector<Unit> units;
    for (std::size_t i = 0; i < prepared.size();) {
      const PixelRect& b = prepared[i].bounds();
      if (const int width = b.x1 - b.x0;
          !b.empty() && static_cast<std::int64_t>(width) * (b.y1 - b.y0) > pixels_per_unit) {
        const int rows = std::max(1, pixels_per_unit / width);
        for (int y = b.y0; y < b.y1; y += rows) units.push_back({i, i + 1, y, std::min(b.y1, y + rows)});
        ++i;
        continue;
      }
      std::int64_t area = 0;
      Unit unit{i, i, 0, state.height};
      while (i < prepared.size()) {
        const PixelRect& r = prepared[i].bounds();
        const std::int64_t more = r.empty() ? 0 : std::int64_t{r.x1 - r.x0} * (r.y1 - r.y0);
        if (area + more > pixels_per_unit) break;
        area += more;
        unit.last = ++i;
      }
      units.push_back(unit);
    }

    ordered_parallel(
        units.size(), settings_.threads,
        [&](std::size_t unit) {
          std::vector<EngineSample> samples;
          for (std::size_t i = units[unit].first; i < units[unit].last; ++i)
            draw_rows(prepared[i], quads[first + i], static_cast<std::uint32_t>(first + i), units[unit], state,
                      samples);
          return samples;
        },
        [&](std::size_t, std::vector<EngineSample>&& samples) {
          if (!samples.empty()) sink(samples);
        });
  }

  void draw_rows(const Prepared& quad, const WindowQuad& given, std::uint32_t index, const Unit& unit,
                 const DrawState& state, std::vector<EngineSample>& out) const {
    const PixelRect& bounds = quad.bounds();
    for (int y = std::max(unit.y0, bounds.y0); y < std::min(unit.y1, bounds.y1); ++y) {
      const golden::PixelSpan row = quad.rows().row(y);
      for (int x = row.x0; x < row.x1; ++x) {
        const ReferenceSample s = quad.truth    ? quad.truth->sample(x, y)
                                  : quad.single ? quad.single->sample(x, y)
                                                : quad.paper->sample(x, y);
        if (!s.covered || (!s.visible && !s.undefined)) continue;
        if (state.cull == (s.front ? Cull::front : Cull::back)) continue;
        if (state.depth && !s.undefined && !(s.z >= limits_.low && s.z <= limits_.high)) continue;
        EngineSample sample;
        sample.index = index;
        sample.quad = given.id;
        sample.x = static_cast<std::uint16_t>(x);
        sample.y = static_cast<std::uint16_t>(y);
        sample.front = s.front;
        sample.undefined = s.undefined;
        sample.flags = s.flags;
        sample.z = state.depth ? s.z : 0;
        sample.lambda = s.lambda;
        sample.attribute = s.attribute;
        out.push_back(sample);
      }
    }
  }

  /// Of window z: as given, or what the codes of the limits stand for, whose rounding is to nearest.
  struct Limits {
    explicit Limits(const EngineSettings& settings) : low(settings.state.znear), high(settings.state.zfar) {
      if (!settings.snap) return;
      const auto half_codes = [&](double z, int more) {
        return std::ldexp(2.0 * depth_code(z, settings.config) + more, -settings.config.depth_bits - 1);
      };
      low = half_codes(settings.state.znear, -1);
      high = half_codes(settings.state.zfar, 1);
    }
    double low, high;
  };

  EngineSettings settings_;
  Limits limits_;
};

}  // namespace

std::unique_ptr<Engine> make_reference_engine(const EngineSettings& settings) {
  return std::make_unique<ReferenceEngine>(settings);
}

}  // namespace quadrille::tb
