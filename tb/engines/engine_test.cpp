// The passes of the machine over one input: which columns each carries, and how they merge again.
#include "tb/engines/engine.hpp"

#include "golden/scenes/stress.hpp"
#include "model/port/snap.hpp"
#include "tb/support/errors.hpp"

#include <gtest/gtest.h>

#include <set>

namespace quadrille::tb {
namespace {

TEST(Passes, CarryEveryColumnOnceInAsFewDrawsAsTheSlotsAllow) {
  Config config;
  for (int slots = 1; slots <= 8; ++slots)
    for (int attributes = 0; attributes <= 8; ++attributes)
      for (const bool weights : {false, true}) {
        config.attribute_slots = slots;
        const std::vector<Pass> passes = plan_passes(attributes, weights, config);
        std::vector<int> columns, expected;
        for (int column = 0; column < 4 + attributes; ++column)
          if (weights || column >= 4) expected.push_back(column);
        for (const Pass& pass : passes) {
          EXPECT_LE(pass.columns.size(), static_cast<std::size_t>(slots));
          columns.insert(columns.end(), pass.columns.begin(), pass.columns.end());
        }
        EXPECT_EQ(columns, expected);
        EXPECT_EQ(passes.size(), std::max<std::size_t>(1, (expected.size() + static_cast<std::size_t>(slots) - 1) /
                                                              static_cast<std::size_t>(slots)));
      }
}

TEST(Passes, AColumnIsAWeightOrAnAttributeAndZeroWhereThereIsNone) {
  WindowQuad quad;
  quad.id = 9;
  for (std::size_t v = 0; v < 4; ++v) quad.attribute[v] = {10.0 + static_cast<double>(v)};
  const WindowQuad drawn = pass_quad(quad, {{2, 4, 5}});
  EXPECT_EQ(drawn.id, 9u);
  for (std::size_t v = 0; v < 4; ++v)
    EXPECT_EQ(drawn.attribute[v], (std::vector<double>{v == 2 ? 1.0 : 0.0, 10.0 + static_cast<double>(v), 0.0}));
}

TEST(Passes, NumberAQuadByItsPlaceButNameItByItsId) {
  const Config config;
  WindowQuad quad;
  quad.id = 70;
  for (std::size_t v = 0; v < 4; ++v) quad.vertex[v] = {v % 3 == 0 ? 0.0 : 8.0, v < 2 ? 0.0 : 8.0, 0.5, 1};
  EXPECT_EQ(snap_as(quad, 3, config, {}).id, 3u);
  quad.vertex[2] = {0, 0, 0, 0};
  try {
    snap_as(quad, 3, config, {});
    FAIL() << "no point, but snapped";
  } catch (const SnapError& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("quad 70, vertex 2: ")) << error.what();
  }
  Config few;
  few.quad_id_bits = 4;
  EXPECT_NO_THROW(check_quad_count(16, few));
  EXPECT_THROW(check_quad_count(17, few), UsageError);
}

/// One slot or eight, one thread or three: the same samples in the same order.
TEST(Passes, TheModelMergesThemIntoTheSameSamples) {
  const std::vector<WindowQuad> quads = golden::make_stress(golden::StressFamily::general, 40, 5, 1.0, 64, 64, 3);
  const auto draw = [&](int slots, unsigned threads) {
    EngineSettings settings;
    settings.config.attribute_slots = slots;
    settings.state.width = settings.state.height = settings.state.scissor_x1 = settings.state.scissor_y1 = 64;
    settings.threads = threads;
    std::vector<EngineSample> all;
    make_engine(settings)->draw(quads, 3, true, [&](std::span<const EngineSample> samples) {
      all.insert(all.end(), samples.begin(), samples.end());
    });
    return all;
  };
  const std::vector<EngineSample> once = draw(8, 1);
  std::set<std::uint32_t> drawn;
  for (const EngineSample& s : once) {
    drawn.insert(s.index);
    EXPECT_NEAR(s.lambda[0] + s.lambda[1] + s.lambda[2] + s.lambda[3], 1, 1e-3);
  }
  EXPECT_GT(drawn.size(), 20u);
  for (const auto& [slots, threads] : {std::pair{1, 1u}, {3, 3u}, {8, 3u}}) {
    const std::vector<EngineSample> several = draw(slots, threads);
    ASSERT_EQ(several.size(), once.size());
    for (std::size_t i = 0; i < once.size(); ++i) {
      const EngineSample &a = once[i], &b = several[i];
      ASSERT_TRUE(a.index == b.index && a.x == b.x && a.y == b.y && a.z == b.z && a.flags == b.flags &&
                  a.front == b.front && a.lambda == b.lambda && a.attribute == b.attribute)
          << "sample " << i << ", " << slots << " slots";
    }
  }
}

/// A ramp of depth through a limit that lies exactly at a column of pixels. The attributes are plane and the weights
/// are not, so their passes have other last bits of depth there.
TEST(Passes, TheFirstDecidesByDepthOfPlaneQuads) {
  WindowQuad quad;
  quad.vertex = {{{10, 111, 0.25, 1}, {111, 111, 0.75, 1}, {111, 10, 0.75, 1}, {10, 10, 0.25, 1}}};
  quad.attribute = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  for (const bool hidden : {false, true}) {
    EngineSettings settings;
    settings.config.set("plane_quads", 1);
    settings.config.set("hierarchical_z_bits", 12);
    settings.state.width = settings.state.height = settings.state.scissor_x1 = settings.state.scissor_y1 = 128;
    settings.state.zfar = 0.5;
    settings.state.skip = skip_default | skip_plane | (hidden ? std::uint32_t{skip_hidden} : 0);
    std::size_t drawn = 0;
    make_engine(settings)->draw({&quad, 1}, 2, true, [&](std::span<const EngineSample> samples) {
      for (const EngineSample& s : samples) {
        EXPECT_LE(s.z, 0.5);
        EXPECT_GE(s.z, 0.25);
        EXPECT_NEAR(s.lambda[1] + s.lambda[2], s.attribute[0], 1e-4);
        EXPECT_NEAR(s.z, 0.25 + 0.5 * s.attribute[0], 1e-4);
      }
      drawn += samples.size();
    });
    EXPECT_GE(drawn, 50 * 101u);
    EXPECT_LE(drawn, 51 * 101u);
  }
}

/// Layers from front to back in several units of work: what is hidden is the same with any number of threads.
TEST(Passes, ThreadsHideTheSame) {
  std::vector<WindowQuad> quads;
  for (std::uint32_t i = 0; i < 120; ++i) {
    const double x = i * 7 % 40, y = i * 11 % 40, z = 0.1 + 0.005 * i;
    WindowQuad quad;
    quad.id = i;
    quad.vertex = {{{x, y, z, 1}, {x, y + 24, z, 1}, {x + 24, y + 24, z, 1}, {x + 24, y, z, 1}}};
    for (auto& attribute : quad.attribute) attribute = {0.5};
    quads.push_back(quad);
  }
  const auto draw = [&](unsigned threads, std::uint32_t skip) {
    EngineSettings settings;
    settings.config.set("hierarchical_z_bits", 12);
    settings.state.width = settings.state.height = settings.state.scissor_x1 = settings.state.scissor_y1 = 64;
    settings.state.skip = skip;
    settings.threads = threads;
    std::vector<std::array<std::uint32_t, 3>> all;
    make_engine(settings)->draw(quads, 1, false, [&](std::span<const EngineSample> samples) {
      for (const EngineSample& s : samples)
        all.push_back({s.index, static_cast<std::uint32_t>(s.x), static_cast<std::uint32_t>(s.y)});
    });
    return all;
  };
  const auto once = draw(1, skip_default | skip_hidden);
  EXPECT_LT(once.size(), draw(1, skip_default).size() / 2);
  EXPECT_EQ(draw(4, skip_default | skip_hidden), once);
}

}  // namespace
}  // namespace quadrille::tb
