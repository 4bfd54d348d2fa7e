#include "model/port/snap.hpp"
#include "model/skips/hierarchical_z.hpp"
#include "model/support/parallel.hpp"
#include "model/untimed.hpp"
#include "tb/engines/machine_engine.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <stdexcept>

namespace quadrille::tb {
namespace {

/// Quads of a unit: so many, or those that may cover so many pixels.
constexpr std::size_t unit_quads = 512;
constexpr double unit_pixels = 1 << 20;

/// Pixels of the box around a quad, for units of bounded memory.
double pixels_around(const WindowQuad& quad, const DrawState& state) {
  double left = state.width, top = state.height, right = 0, bottom = 0;
  for (const WindowVertex& v : quad.vertex) {
    if (!(v.w > 0)) return static_cast<double>(state.width) * state.height;
    const double k = 1 / v.w, x = v.x * k, y = v.y * k;
    left = std::min(left, x), right = std::max(right, x);
    top = std::min(top, y), bottom = std::max(bottom, y);
  }
  const double width = std::min<double>(right, state.width) - std::max(left, 0.0) + 1;
  const double height = std::min<double>(bottom, state.height) - std::max(top, 0.0) + 1;
  return width > 0 && height > 0 ? width * height : 0;
}

/// Where the units begin, and the end. At least `least` units where there are as many quads.
std::vector<std::size_t> units_of(std::span<const WindowQuad> quads, const DrawState& state, std::size_t least) {
  const std::size_t most = std::clamp<std::size_t>(quads.size() / least, 1, unit_quads);
  std::vector<std::size_t> begin{0};
  double pixels = 0;
  for (std::size_t i = 0; i < quads.size(); ++i) {
    pixels += pixels_around(quads[i], state);
    if (i + 1 - begin.back() < most && pixels < unit_pixels && i + 1 < quads.size()) continue;
    begin.push_back(i + 1);
    pixels = 0;
  }
  return begin;
}

/// Fragments of the quads of a unit, in columns.
struct Columns {
  struct Quad {
    std::size_t index, size;
  };
  std::vector<Quad> quads;
  std::vector<FragmentPlace> place;
  std::vector<FragmentMarks> marks;
  std::vector<std::uint32_t> depth;
  std::array<std::vector<std::int64_t>, 4 + max_attribute_slots> column;

  /// All of a first pass.
  void add(const FragmentArrays& f, const Pass& pass) {
    place.insert(place.end(), f.place, f.place + f.size);
    marks.insert(marks.end(), f.marks, f.marks + f.size);
    depth.insert(depth.end(), f.depth, f.depth + f.size);
    for (std::size_t slot = 0; slot < pass.columns.size(); ++slot) {
      auto& to = column[static_cast<std::size_t>(pass.columns[slot])];
      to.insert(to.end(), f.attribute[slot], f.attribute[slot] + f.size);
    }
  }
  /// One of a further pass, to the n-th fragment.
  void add(const FragmentArrays& f, std::size_t i, const Pass& pass, std::size_t n) {
    marks[n].front = f.marks[i].front;
    marks[n].flags |= f.marks[i].flags;
    for (std::size_t slot = 0; slot < pass.columns.size(); ++slot)
      column[static_cast<std::size_t>(pass.columns[slot])].push_back(f.attribute[slot][i]);
  }
  bool is_at(std::size_t n, FragmentPlace at) const {
    return n < place.size() && place[n].x == at.x && place[n].y == at.y;
  }
};

class ModelEngine final : public Engine {
 public:
  explicit ModelEngine(const EngineSettings& settings) : settings_(settings) {}

  void draw(std::span<const WindowQuad> quads, int attributes, bool weights, const SampleSink& sink) override {
    std::vector<EngineSample> samples;
    const double depth_unit = std::ldexp(1.0, -settings_.config.depth_bits),
                 attribute_unit = std::ldexp(1.0, -settings_.config.attribute_frac());
    draw_quads(quads, attributes, weights, [&](const QuadFragments& fragments) {
      const FragmentArrays& common = fragments.common;
      samples.assign(common.size, {});
      for (std::size_t n = 0; n < common.size; ++n) {
        EngineSample& sample = samples[n];
        sample.index = fragments.index;
        sample.quad = fragments.quad;
        sample.x = common.place[n].x;
        sample.y = common.place[n].y;
        sample.front = common.marks[n].front;
        sample.flags = common.marks[n].flags;
        sample.z = common.depth[n] * depth_unit;
        const auto value = [&](std::size_t column) {
          const std::int64_t* const codes = fragments.column[column];
          return codes == nullptr ? 0.0 : static_cast<double>(codes[n]) * attribute_unit;
        };
        for (std::size_t i = 0; i < sample.lambda.size(); ++i) sample.lambda[i] = value(i);
        for (std::size_t j = 0; j < sample.attribute.size(); ++j) sample.attribute[j] = value(4 + j);
      }
      sink(samples);
    });
  }

  bool draw_quads(std::span<const WindowQuad> quads, int attributes, bool weights, const QuadSink& sink) override {
    check_quad_count(quads.size(), settings_.config);
    const std::vector<Pass> passes = plan_passes(attributes, weights, settings_.config);
    std::vector<DrawState> states;
    for (const Pass& pass : passes) states.push_back(state_of_pass(settings_.state, pass, &pass == &passes.front()));
    std::vector<Models> idle;
    std::mutex mutex;
    // What is hidden depends on all quads before: those units are drawn one after the other by one set of models.
    const unsigned threads = skips_hidden(settings_.config, settings_.state) ? 1 : settings_.threads;
    const std::vector<std::size_t> begin = units_of(quads, settings_.state, std::size_t{16} * threads);
    if (passes.size() == 1 && (threads == 1 || begin.size() == 2)) {
      draw_one_by_one(quads, passes.front(), states.front(), sink);
      return true;
    }
    ordered_parallel(
        begin.size() - 1, threads,
        [&](std::size_t unit) {
          Models models;
          {
            std::lock_guard lock(mutex);
            if (!idle.empty()) {
              models = std::move(idle.back());
              idle.pop_back();
            }
          }
          if (models.empty())
            for (const DrawState& state : states) models.emplace_back(settings_.config, state);
          Columns columns;
          for (std::size_t i = begin[unit]; i < begin[unit + 1]; ++i)
            draw_quad(quads[i], i, passes, states, models, columns);
          std::lock_guard lock(mutex);
          idle.push_back(std::move(models));
          return columns;
        },
        [&](std::size_t, Columns&& columns) { deliver(columns, quads, sink); });
    return true;
  }

 private:
  using Models = std::vector<UntimedModel>;  ///< one per pass

  /// In the snapped form of a pass; its id is its position.
  SnappedQuad snapped_of(const WindowQuad& quad, std::size_t index, const Pass& pass, const DrawState& state) const {
    const auto id = static_cast<std::uint32_t>(index);
    return is_whole(pass, quad) ? snap_as(quad, id, settings_.config, state)
                                : snap_as(pass_quad(quad, pass), id, settings_.config, state);
  }

  /// Without keeping a fragment: one pass, no other thread. The sink gets what the model gives.
  void draw_one_by_one(std::span<const WindowQuad> quads, const Pass& pass, const DrawState& state,
                       const QuadSink& sink) const {
    UntimedModel model(settings_.config, state);
    for (std::size_t i = 0; i < quads.size(); ++i)
      model.draw_arrays(snapped_of(quads[i], i, pass, state), [&](const FragmentArrays& drawn) {
        QuadFragments fragments;
        fragments.index = static_cast<std::uint32_t>(i);
        fragments.quad = quads[i].id;
        fragments.common = drawn;
        fragments.common.attributes = 0;
        for (std::size_t slot = 0; slot < pass.columns.size(); ++slot)
          fragments.column[static_cast<std::size_t>(pass.columns[slot])] = drawn.attribute[slot];
        sink(fragments);
      });
  }

  void draw_quad(const WindowQuad& quad, std::size_t index, const std::vector<Pass>& passes,
                 const std::vector<DrawState>& states, Models& models, Columns& columns) const {
    const std::size_t start = columns.place.size();
    const bool plane = (settings_.state.skip & skip_plane) != 0;
    for (std::size_t p = 0; p < passes.size(); ++p) {
      const SnappedQuad snapped = snapped_of(quad, index, passes[p], states[p]);
      std::size_t next = start;
      models[p].draw_arrays(snapped, [&](const FragmentArrays& fragments) {
        if (p == 0) {
          columns.add(fragments, passes[p]);
          next += fragments.size;
          return;
        }
        for (std::size_t i = 0; i < fragments.size; ++i) {
          if (columns.is_at(next, fragments.place[i]))
            columns.add(fragments, i, passes[p], next++);
          else if (!plane)  // else the first pass has left it out
            throw std::logic_error("model: passes over one quad have different fragments");
        }
      });
      if (next != columns.place.size()) throw std::logic_error("model: passes over one quad have different fragments");
    }
    if (columns.place.size() != start) columns.quads.push_back({index, columns.place.size() - start});
  }

  static void deliver(const Columns& columns, std::span<const WindowQuad> quads, const QuadSink& sink) {
    std::size_t first = 0;
    for (const auto& [index, size] : columns.quads) {
      QuadFragments fragments;
      fragments.index = static_cast<std::uint32_t>(index);
      fragments.quad = quads[index].id;
      fragments.common = {fragments.index,
                          size,
                          columns.place.data() + first,
                          columns.marks.data() + first,
                          columns.depth.data() + first,
                          0,
                          {}};
      for (std::size_t c = 0; c < columns.column.size(); ++c)
        if (!columns.column[c].empty()) fragments.column[c] = columns.column[c].data() + first;
      sink(fragments);
      first += size;
    }
  }

  EngineSettings settings_;
};

}  // namespace

std::unique_ptr<Engine> make_model_engine(const EngineSettings& settings) {
  return std::make_unique<ModelEngine>(settings);
}

}  // namespace quadrille::tb
