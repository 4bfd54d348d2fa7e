// The RTL through Yosys: its Verilog in place of the source, and a synthesis without latches.
#include "tb/yosys/yosys.hpp"

#include "golden/scenes/random_quads.hpp"
#include "golden/scenes/scenes.hpp"
#include "model/port/snap.hpp"
#include "tb/lockstep/lockstep.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

namespace quadrille::tb {
namespace {

std::filesystem::path work_directory(const char* name) {
  return std::filesystem::path(testing::TempDir()) /
         (std::string("quadrille_") + name + "_" + std::to_string(getpid()));
}

TEST(Yosys, ItsVerilogPassesCosimulation) {
  LockstepOptions options;
  options.config.set("significand_bits", 12);
  options.config.set("hierarchical_z_bits", 12);
  options.config.set("hierarchical_z_tiles_log2", 6);
  options.config.set("performance_counters", 1);
  options.state = small_state(options.config);
  options.stall = options.gap = 0.1;
  options.optimise = 1;
  const std::filesystem::path directory = work_directory("roundtrip");
  options.source = yosys_verilog(options.config, directory);
  options.probes = false;  // they name what lies inside the sources' modules: ports alone are compared
  const auto agrees = [&](const std::vector<SnappedQuad>& quads) {
    const LockstepReport report = run_lockstep(quads, options);
    EXPECT_TRUE(report.agreed()) << report.first_divergence.value_or("");
    EXPECT_TRUE(report.complete);
    EXPECT_GT(report.fragments, 1000u);
    return report;
  };
  // A built-in scene, then every corner of the machine.
  options.state = small_state(options.config, 128);
  std::vector<SnappedQuad> scene;
  for (const WindowQuad& quad :
       golden::scene_quads(golden::make_scene("bowtie"), options.state.width, options.state.height))
    scene.push_back(snap_quad(quad, options.config, options.state));
  agrees(scene);
  options.state = small_state(options.config);
  agrees(random_quads(options.config, options.state, 77, 200));
  // What is hidden by a quad over everything, and the counter of it.
  options.state.skip |= skip_hidden;
  std::vector<SnappedQuad> quads = random_quads(options.config, options.state, 78, 200);
  WindowQuad front;
  front.vertex = {{{-4, -4, 0.3, 1}, {-4, 70, 0.3, 1}, {70, 70, 0.3, 1}, {70, -4, 0.3, 1}}};
  for (auto& attribute : front.attribute) attribute.assign(static_cast<std::size_t>(options.state.attributes), 0.5);
  quads.insert(quads.begin(), snap_quad(front, options.config, options.state));
  EXPECT_GT(agrees(quads).counters[PerformanceCounter::tiles_hidden], 100u);
  std::filesystem::remove_all(directory);
}

TEST(Yosys, SynthesisWithoutLatches) {
  Config config;
  config.set("significand_bits", 12);
  const std::filesystem::path directory = work_directory("synth");
  const SynthesisReport report = yosys_synthesise(config, directory);
  EXPECT_EQ(report.latches, 0u);
  EXPECT_GT(report.flip_flops, 1000u);
  EXPECT_GT(report.cells, 10000u);
  std::printf("%llu cells, %llu flip-flops, %llu warnings\n", static_cast<unsigned long long>(report.cells),
              static_cast<unsigned long long>(report.flip_flops), static_cast<unsigned long long>(report.warnings));
  std::filesystem::remove_all(directory);
}

}  // namespace
}  // namespace quadrille::tb
