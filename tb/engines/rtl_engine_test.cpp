// The RTL as an engine: drawing through it does less than co-simulating, so it must not take longer.
#include "golden/scenes/random_mesh.hpp"
#include "tb/engines/engine.hpp"
#include "tb/lockstep/lockstep.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <vector>

namespace quadrille::tb {
namespace {

/// Of this thread: what others do on the machine is not in it.
double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

template <class Work>
double shortest(Work&& work) {
  double best = 1e9;
  for (int i = 0; i < 3; ++i) {
    const double start = cpu_seconds();
    work();
    best = std::min(best, cpu_seconds() - start);
  }
  return best;
}

TEST(RtlEngine, TakesLessTimeThanLockstep) {
  EngineSettings settings;
  settings.kind = EngineKind::rtl;
  settings.state.width = settings.state.scissor_x1 = 256;
  settings.state.height = settings.state.scissor_y1 = 256;
  golden::RandomMeshOptions mesh;
  mesh.width = mesh.height = 256;
  mesh.columns = mesh.rows = 32;  // 1024 quads: several runs of a machine
  mesh.triangle_share = 0;
  const std::vector<WindowQuad> quads = golden::make_random_mesh(1, mesh).quads;
  const int attributes = settings.config.attribute_slots;
  settings.state.attributes = attributes;

  LockstepOptions options;
  options.config = settings.config;
  options.state = settings.state;
  std::vector<SnappedQuad> snapped;
  for (std::size_t i = 0; i < quads.size(); ++i)
    snapped.push_back(snap_as(quads[i], static_cast<std::uint32_t>(i), options.config, options.state));

  const std::unique_ptr<Engine> engine = make_engine(settings);
  std::uint64_t drawn = 0, compared = 0;
  const double engine_seconds = shortest([&] {
    drawn = 0;
    engine->draw(quads, attributes, false, [&](std::span<const EngineSample> samples) { drawn += samples.size(); });
  });
  const double lockstep_seconds = shortest([&] { compared = run_lockstep(snapped, options).fragments; });
  EXPECT_GT(drawn, 10'000u);
  EXPECT_EQ(drawn, compared);
  EXPECT_LT(engine_seconds, lockstep_seconds);
  RecordProperty("engine_over_lockstep", std::to_string(engine_seconds / lockstep_seconds));
}

}  // namespace
}  // namespace quadrille::tb
