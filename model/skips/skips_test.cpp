// Skips that keep the list of fragments: each alone and all together give every fragment of the machine that skips
// nothing, bit by bit and in the same order, from scenes and loads with every culling, and stress families, and
// on the clocked model under gaps and stalls.
#include "model/port/snap.hpp"
#include "model/untimed.hpp"

#include "golden/scenes/random_state.hpp"
#include "golden/scenes/scenes.hpp"
#include "golden/scenes/stress.hpp"
#include "model/clocked/clocked_stream_test_support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace quadrille {
namespace {

constexpr int width = 96, height = 72;

/// Each skip that keeps the list alone, then all of them.
std::vector<std::uint32_t> choices() {
  std::vector<std::uint32_t> result;
  for (std::uint32_t bit = 1; bit <= skip_default; bit <<= 1)
    if (skip_default & bit) result.push_back(bit);
  result.push_back(skip_default);
  return result;
}

DrawState viewport() {
  DrawState state;
  state.width = state.scissor_x1 = width;
  state.height = state.scissor_y1 = height;
  return state;
}

std::vector<SnappedQuad> snapped(const std::vector<WindowQuad>& quads, const Config& config, const DrawState& state) {
  std::vector<SnappedQuad> result;
  for (const WindowQuad& quad : quads) result.push_back(snap_quad(quad, config, state));
  return result;
}

std::vector<Fragment> untimed(const std::vector<SnappedQuad>& quads, const Config& config, DrawState state,
                              std::uint32_t skip) {
  state.skip = skip;
  UntimedModel model(config, state);
  std::vector<Fragment> result;
  for (const SnappedQuad& quad : quads)
    model.draw(quad, [&](std::span<const Fragment> f) { result.insert(result.end(), f.begin(), f.end()); });
  return result;
}

/// Compares every choice with no skip; gives the fragments.
std::size_t compare(const std::vector<SnappedQuad>& quads, const Config& config, const DrawState& state,
                    std::string_view name) {
  const std::vector<Fragment> all = untimed(quads, config, state, 0);
  for (const std::uint32_t skip : choices()) {
    const std::vector<Fragment> kept = untimed(quads, config, state, skip);
    EXPECT_TRUE(kept == all) << name << ", skip " << skip << ": " << kept.size() << " fragments of " << all.size();
  }
  return all.size();
}

TEST(Skips, ScenesKeepTheirFragments) {
  const Config config;
  std::vector<golden::SceneInfo> scenes = golden::list_scenes();
  for (const golden::SceneInfo& load : golden::list_workloads()) scenes.push_back(load);
  for (const golden::SceneInfo& info : scenes) {
    const golden::Scene scene = golden::make_scene(info.name);
    std::size_t fragments = 0;
    for (const Cull cull : {Cull::none, Cull::back, Cull::front}) {
      DrawState state = viewport();
      state.perspective = scene.perspective;
      state.cull = cull;
      fragments +=
          compare(snapped(golden::scene_quads(scene, width, height, golden::AttributeSet::weights), config, state),
                  config, state, info.name);
    }
    EXPECT_GT(fragments, 0u) << info.name;
  }
}

TEST(Skips, FamiliesKeepTheirFragments) {
  for (const golden::StressFamilyInfo& family : golden::stress_families()) {
    std::size_t fragments = 0;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      Config config;
      if (seed % 3 == 0) config.set("significand_bits", 8);
      if (seed % 2 == 0) config.set("pixels_per_clock", 2);
      config.validate();
      const std::vector<WindowQuad> quads = golden::make_stress(family.family, 40, seed, 1.0, width, height, 4);
      const DrawState state = seed == 1 ? viewport() : golden::random_draw_state(config, width, height, quads, seed);
      fragments += compare(snapped(quads, config, state), config, state, family.name);
    }
    EXPECT_GT(fragments, 0u) << family.name;
  }
}

/// The port's stream: every choice of skips under every pattern of gaps and stalls.
TEST(Skips, EveryStallPatternGivesTheSameStream) {
  const Config config;
  constexpr double gap[] = {0, 0.7, 0.1}, stall[] = {0, 0.1, 0.7};
  std::size_t fragments = 0;
  for (const golden::StressFamilyInfo& family : golden::stress_families()) {
    const std::vector<WindowQuad> given = golden::make_stress(family.family, 8, 77, 1.0, 40, 40, 4);
    const DrawState state = golden::random_draw_state(config, 40, 40, given, 3);
    const std::vector<SnappedQuad> quads = snapped(given, config, state);
    const std::vector<Fragment> all = untimed(quads, config, state, 0);
    fragments += all.size();
    for (const std::uint32_t skip : choices())
      for (std::size_t pattern = 0; pattern < 3; ++pattern) {
        DrawState asking = state;
        asking.skip = skip;
        EXPECT_TRUE(clocked_stream(quads, config, asking, pattern + 1, gap[pattern], stall[pattern]) == all)
            << family.name << ", skip " << skip << ", pattern " << pattern;
      }
  }
  EXPECT_GT(fragments, 3'000u);
}

}  // namespace
}  // namespace quadrille
