#include "model/port/snap.hpp"
#include "model/skips/hierarchical_z.hpp"
#include "model/support/parallel.hpp"
#include "model/untimed.hpp"
#include "tb/engines/machine_engine.hpp"

#include <algorithm>
#include <mutex>
#include <stdexcept>

namespace quadrille::tb {
namespace {

constexpr std::size_t quads_per_unit = 16;

class ModelEngine final : public Engine {
 public:
  explicit ModelEngine(const EngineSettings& settings) : settings_(settings) {}

  void draw(std::span<const WindowQuad> quads, int attributes, bool weights, const SampleSink& sink) override {
    check_quad_count(quads.size(), settings_.config);
    const std::vector<Pass> passes = plan_passes(attributes, weights, settings_.config);
    std::vector<Models> idle;
    std::mutex mutex;
    // What is hidden depends on all quads before: those units are drawn one after the other by one set of models.
    const unsigned threads = skips_hidden(settings_.config, settings_.state) ? 1 : settings_.threads;
    ordered_parallel((quads.size() + quads_per_unit - 1) / quads_per_unit, threads,
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
                         for (const Pass& pass : passes) models.emplace_back(settings_.config, state_of(pass, passes));
                       const std::size_t first = unit * quads_per_unit,
                                         last = std::min(quads.size(), first + quads_per_unit);
                       std::vector<EngineSample> samples;
                       for (std::size_t i = first; i < last; ++i)
                         draw_quad(quads[i], static_cast<std::uint32_t>(i), passes, models, samples);
                       std::lock_guard lock(mutex);
                       idle.push_back(std::move(models));
                       return samples;
                     },
                     [&](std::size_t, std::vector<EngineSample>&& samples) {
                       if (!samples.empty()) sink(samples);
                     });
  }

 private:
  using Models = std::vector<UntimedModel>;  ///< one per pass

  DrawState state_of(const Pass& pass, const std::vector<Pass>& passes) const {
    return state_of_pass(settings_.state, pass, &pass == &passes.front());
  }

  void draw_quad(const WindowQuad& quad, std::uint32_t index, const std::vector<Pass>& passes, Models& models,
                 std::vector<EngineSample>& samples) const {
    const std::size_t start = samples.size();
    const bool plane = (settings_.state.skip & skip_plane) != 0;
    for (std::size_t p = 0; p < passes.size(); ++p) {
      const SnappedQuad snapped =
          snap_as(pass_quad(quad, passes[p]), index, settings_.config, state_of(passes[p], passes));
      std::size_t next = start;
      models[p].draw_arrays(snapped, [&](const FragmentArrays& fragments) {
        for (std::size_t n = 0; n < fragments.size; ++n) {
          const Fragment fragment = fragments[n];
          if (p == 0) {
            EngineSample& sample = samples.emplace_back();
            sample.index = index;
            sample.quad = quad.id;
          } else if (next >= samples.size() || samples[next].x != fragment.x || samples[next].y != fragment.y) {
            if (plane) continue;  // the first pass has left it out
            throw std::logic_error("model: passes over one quad have different fragments");
          }
          read_columns(fragment, passes[p], settings_.config, samples[next++], p == 0);
        }
      });
      if (next != samples.size()) throw std::logic_error("model: passes over one quad have different fragments");
    }
  }

  EngineSettings settings_;
};

}  // namespace

std::unique_ptr<Engine> make_model_engine(const EngineSettings& settings) {
  return std::make_unique<ModelEngine>(settings);
}

}  // namespace quadrille::tb
