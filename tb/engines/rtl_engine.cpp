#include "model/port/snap.hpp"
#include "model/skips/hierarchical_z.hpp"
#include "model/support/parallel.hpp"
#include "tb/engines/machine_engine.hpp"
#include "tb/lockstep/lockstep.hpp"

#include <algorithm>
#include <stdexcept>

namespace quadrille::tb {
namespace {

constexpr std::size_t quads_per_run = 256;

class RtlEngine final : public Engine {
 public:
  explicit RtlEngine(const EngineSettings& settings) : settings_(settings) {
    LockstepOptions options;
    options.config = settings.config;
    simulator_ = simulator_alone(options);
  }

  void draw(std::span<const WindowQuad> quads, int attributes, bool weights, const SampleSink& sink) override {
    check_quad_count(quads.size(), settings_.config);
    const std::vector<Pass> passes = plan_passes(attributes, weights, settings_.config);
    // What is hidden depends on all quads before: they are drawn in one run.
    const std::size_t per_run =
        skips_hidden(settings_.config, settings_.state) ? std::max<std::size_t>(quads.size(), 1) : quads_per_run;
    ordered_parallel((quads.size() + per_run - 1) / per_run, settings_.threads,
                     [&](std::size_t unit) {
                       const std::size_t first = unit * per_run;
                       return run(quads, first, std::min(quads.size(), first + per_run), passes);
                     },
                     [&](std::size_t, std::vector<EngineSample>&& samples) {
                       if (!samples.empty()) sink(samples);
                     });
  }

 private:
  /// A machine of its own for each pass over a range of the quads.
  std::vector<EngineSample> run(std::span<const WindowQuad> quads, std::size_t first, std::size_t last,
                                const std::vector<Pass>& passes) const {
    std::vector<EngineSample> samples;
    for (const Pass& pass : passes) {
      LockstepOptions options;
      options.config = settings_.config;
      const bool first_pass = &pass == &passes.front(), plane = (settings_.state.skip & skip_plane) != 0;
      options.state = state_of_pass(settings_.state, pass, first_pass);
      options.seed = settings_.seed;
      options.stall = settings_.stall;
      options.gap = settings_.gap;
      std::vector<SnappedQuad> snapped;
      for (std::size_t i = first; i < last; ++i)
        snapped.push_back(
            snap_as(pass_quad(quads[i], pass), static_cast<std::uint32_t>(i), options.config, options.state));
      std::size_t next = 0;
      run_rtl_alone(simulator_, snapped, options, [&](const Fragment& fragment) {
        if (first_pass) {
          EngineSample& sample = samples.emplace_back();
          sample.index = fragment.quad;
          sample.quad = quads[fragment.quad].id;
        } else if (next >= samples.size() || samples[next].index != fragment.quad || samples[next].x != fragment.x ||
                   samples[next].y != fragment.y) {
          if (plane) return;  // the first pass has left it out
          throw std::logic_error("rtl: passes over the same quads have different fragments");
        }
        read_columns(fragment, pass, settings_.config, samples[next++], first_pass);
      });
      if (next != samples.size()) throw std::logic_error("rtl: passes over the same quads have different fragments");
    }
    return samples;
  }

  EngineSettings settings_;
  Simulator simulator_;
};

}  // namespace

std::unique_ptr<Engine> make_rtl_engine(const EngineSettings& settings) {
  return std::make_unique<RtlEngine>(settings);
}

}  // namespace quadrille::tb
