#include "tb/studies/bench_stages.hpp"

#include "model/fast/float_lanes.hpp"
#include "model/front/quad_setup.hpp"
#include "model/untimed.hpp"
#include "tb/studies/bench_timing.hpp"

#include <vector>

#ifdef __x86_64__
#include <x86intrin.h>
#endif

namespace quadrille::tb {
namespace {

std::uint64_t time_stamp() {
#ifdef __x86_64__
  return __rdtsc();
#else
  return 0;
#endif
}

/// The first stages of a quad as UntimedModel has them. Nothing of them is left out by the compiler: their functions
/// are the library's.
class Stages {
 public:
  Stages(const Config& config, const DrawState& state)
      : config_(config), state_(state), context_(config, state), lanes_(context_), walk_(config, state) {}

  bool usable() const { return lanes_.usable(); }

  /// False: the quad is not for these lanes.
  bool run(const SnappedQuad& quad, std::size_t stages) {
    if (lanes_.small())
      if (const auto taken = lanes_.take_small(quad, quad_, small_)) {
        if (*taken == QuadReject::none && stages > 1) run_small(stages);
        return true;
      }
    if (reject_by_vertices(quad, config_, state_) != QuadReject::none) return true;
    const SetupResult setup = quad_setup(quad, config_, state_);
    if (reject_by_areas(setup, state_) != QuadReject::none) return true;
    const QuadData data = quad_data(quad, setup, config_, state_);
    if (!lanes_.take(setup, data, QuadLanes(data, context_), quad_)) return false;
    if (stages > 1)
      walk_quad(walk_, setup, [&] {
        if (stages > 2) {
          list_.count = 0;
          lanes_.cover(quad_, walk_.corner(), walk_.constants(), nullptr, list_);
        }
      });
    return true;
  }

 private:
  void run_small(std::size_t stages) {
    lanes_.walk_small(small_, small_walk_);
    for (int i = 0; stages > 2 && i < small_walk_.hits; ++i) {
      list_.count = 0;
      lanes_.cover_small(quad_, small_, small_walk_.hit[static_cast<std::size_t>(i)], nullptr, list_);
    }
  }

  Config config_;
  DrawState state_;
  PipelineContext context_;
  FloatLanes lanes_;
  TileWalk walk_;
  FloatQuad quad_;
  SmallQuad small_;
  SmallWalk small_walk_;
  PixelList list_;
};

}  // namespace

StageTimes time_stages(std::span<const SnappedQuad> quads, const Config& config, const DrawState& state, int repeat) {
  StageTimes times;
  Stages stages(config, state);
  std::vector<SnappedQuad> taken;
  if (stages.usable())
    for (const SnappedQuad& quad : quads)
      if (stages.run(quad, 1)) taken.push_back(quad);
  times.other_quads = quads.size() - taken.size();
  UntimedModel model(config, state);
  constexpr std::size_t count = stage_names.size();
  std::array<std::vector<double>, count> seconds, cycles;
  for (int round = -1; round < repeat; ++round)  // the first one warms up
    for (std::size_t stage = 0; stage < count; ++stage) {
      const CpuStopwatch stopwatch;
      const std::uint64_t start = time_stamp();
      times.fragments = 0;
      for (const SnappedQuad& quad : taken) {
        if (stage + 1 < count)
          stages.run(quad, stage + 1);
        else
          model.draw_arrays(quad, [&](const FragmentArrays& fragments) { times.fragments += fragments.size; });
      }
      const auto passed = static_cast<double>(time_stamp() - start);
      if (round < 0) continue;
      seconds[stage].push_back(stopwatch.seconds());
      cycles[stage].push_back(passed);
    }
  for (std::size_t stage = count; stage-- > 0;) {
    times.seconds[stage] = median(seconds[stage]) - (stage == 0 ? 0 : median(seconds[stage - 1]));
    times.cycles[stage] = median(cycles[stage]) - (stage == 0 ? 0 : median(cycles[stage - 1]));
  }
  return times;
}

}  // namespace quadrille::tb
