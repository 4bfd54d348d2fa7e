#include "golden/scenes/corner_quads.hpp"
#include "golden/scenes/random_quads.hpp"
#include "model/front/quad_reject.hpp"
#include "model/port/snap.hpp"
#include "model/skips/plane_quad.hpp"
#include "model/support/prng.hpp"
#include "tb/device/verilated_device.hpp"
#include "tb/lockstep/cosim_test_support.hpp"
#include "tb/lockstep/lockstep.hpp"

#include <gtest/gtest.h>

namespace quadrille::tb {
namespace {

// Layers in front of much: tiles are hidden, and the counters say how many.
TEST(Cosim, HiddenTilesAndTheirCounters) {
  LockstepOptions options;
  options.config = odd.config();
  options.state = small_state(options.config);
  options.state.skip |= skip_hidden;
  std::vector<SnappedQuad> quads = random_quads(options.config, options.state, 2025, 300);
  for (std::size_t i = 0; i < 6; ++i) {
    const double left = 3.0 * static_cast<double>(i) - 9, z = 0.4 - 0.05 * static_cast<double>(i);
    WindowQuad layer;
    layer.id = static_cast<std::uint32_t>(1000 + i);
    layer.vertex = {{{left, -4, z, 1}, {left, 70, z, 1}, {left + 50, 70, z, 1}, {left + 50, -4, z, 1}}};
    for (auto& attribute : layer.attribute) attribute.assign(static_cast<std::size_t>(options.state.attributes), 0.5);
    quads.insert(quads.begin() + static_cast<std::ptrdiff_t>(40 * i), snap_quad(layer, options.config, options.state));
  }
  UntimedModel model(options.config, options.state);
  for (const SnappedQuad& quad : quads) model.draw(quad, [](std::span<const Fragment>) {});
  VerilatedDevice device(options.config, VerilateOptions{}, options.seed);
  for (const double stall : {0.0, 0.6}) {
    options.stall = stall;
    const LockstepReport report = run_lockstep(device, quads, options);
    ASSERT_TRUE(report.agreed() && report.complete) << report.first_divergence.value_or("");
    EXPECT_EQ(report.fragments, model.stats().fragments);
    EXPECT_EQ(report.counters[PerformanceCounter::tiles_hidden], model.stats().tiles_hidden);
    EXPECT_EQ(report.counters[PerformanceCounter::blocks_hidden], model.stats().blocks_hidden);
    EXPECT_EQ(report.counters[PerformanceCounter::tiles_entered], model.stats().tiles_entered);
    EXPECT_EQ(report.counters[PerformanceCounter::bound_wipe], 128u) << "behind reset: every place, once";
  }
  EXPECT_GT(model.stats().tiles_hidden, 200u);
}

// Every third quad a rectangle, some turned until a corner is off the parallelogram: those that are plane are counted,
// alone and among the others, and drawn as the model draws them.
TEST(Cosim, PlaneQuadsAndTheirCounters) {
  LockstepOptions options;
  options.config = odd.config();
  options.state = small_state(options.config);
  std::vector<SnappedQuad> quads = random_quads(options.config, options.state, 2026, 200);
  golden::Prng rng(7);
  for (std::uint32_t i = 0; i < 100; ++i) {
    const double x = rng.uniform(-4, 50), y = rng.uniform(-4, 50), w = rng.uniform(1, 30), h = rng.uniform(1, 30);
    WindowQuad sprite;
    sprite.id = 1000 + i;
    sprite.vertex = {{{x, y, 0.25, 1}, {x, y + h, 0.5, 1}, {x + w, y + h, 0.5, 1}, {x + w, y, 0.25, 1}}};
    if (rng.chance(0.3)) sprite.vertex[2].y += 0.25;
    const double low = rng.uniform(-2, 2), high = rng.uniform(-2, 2);
    for (std::size_t v = 0; v < 4; ++v)
      sprite.attribute[v].assign(static_cast<std::size_t>(options.state.attributes), v == 0 || v == 3 ? low : high);
    quads.insert(quads.begin() + 3 * static_cast<std::ptrdiff_t>(i), snap_quad(sprite, options.config, options.state));
  }
  VerilatedDevice device(options.config, VerilateOptions{}, options.seed);
  for (const bool on : {true, false}) {
    options.state.skip = on ? skip_default | skip_plane : skip_default;
    UntimedModel model(options.config, options.state);
    std::uint64_t drawn = 0, of_plane = 0, plane = 0;
    for (const SnappedQuad& quad : quads) {
      const bool takes = plane_quad(quad, options.config, options.state);
      plane += takes && reject_by_vertices(quad, options.config, options.state) == QuadReject::none;
      model.draw(quad, [&](std::span<const Fragment> f) {
        drawn += f.size();
        if (takes) of_plane += f.size();
      });
    }
    if (on) {
      EXPECT_GT(plane, 40u);
      EXPECT_LT(plane, 90u);
    } else {
      EXPECT_EQ(plane, 0u);
    }
    for (const double stall : {0.0, 0.6}) {
      options.stall = stall;
      const LockstepReport report = run_lockstep(device, quads, options);
      ASSERT_TRUE(report.agreed() && report.complete) << report.first_divergence.value_or("");
      EXPECT_EQ(report.fragments, drawn);
      EXPECT_EQ(report.counters[PerformanceCounter::quads_plane], plane);
      EXPECT_EQ(report.counters[PerformanceCounter::pixels_plane], of_plane) << "none is discarded";
    }
  }
}

/// What `burst` is for: while a fragment in twenty clocks is taken, vertices wait for a quad slot; with more slots more
/// of them are taken.
TEST(Cosim, BurstWaitsForQuadSlots) {
  Config config;
  const golden::CornerDraw draw =
      golden::corner_draws(config, 11).at(static_cast<std::size_t>(golden::CornerGroup::burst));
  EXPECT_GE(draw.stall, 0.95);
  const auto beats_taken = [&] {
    ClockedModel machine(config, draw.state);
    ClockedInputs in;
    in.reset = true;
    machine.clock(in);
    in.reset = false;
    std::size_t taken = 0;
    for (int clock = 0; clock < 2000; ++clock) {
      in.vertex_valid = taken < 4 * draw.quads.size();
      if (in.vertex_valid) in.vertex = beat_of(draw.quads[taken / 4], taken % 4);
      in.fragment_ready = clock % 20 == 0;
      taken += in.vertex_valid && machine.comb().vertex_ready;
      machine.clock(in);
    }
    return taken;
  };
  const std::size_t taken = beats_taken();
  EXPECT_LT(taken, 4 * draw.quads.size());
  ++config.quad_slots_log2;
  EXPECT_GT(beats_taken(), taken);
}

TEST(Cosim, RtlAloneAndModelAloneGiveTheSameStream) {
  LockstepOptions options;
  options.config = s12.config();
  options.state = small_state(options.config);
  options.stall = options.gap = 0.3;
  const std::vector<SnappedQuad> quads = random_quads(options.config, options.state, 9, 200);
  std::vector<Fragment> stream, rtl, model;
  const LockstepReport both = run_lockstep(quads, options, [&](const Fragment& f) { stream.push_back(f); });
  ASSERT_TRUE(both.agreed()) << both.first_divergence.value_or("");
  ASSERT_TRUE(both.complete);
  const AloneRun r = run_rtl_alone(quads, options, [&](const Fragment& f) { rtl.push_back(f); });
  const AloneRun m = run_clocked_model_alone(quads, options, [&](const Fragment& f) { model.push_back(f); });
  EXPECT_GT(stream.size(), 1000u);
  EXPECT_EQ(stream, rtl);
  EXPECT_EQ(stream, model);
  EXPECT_EQ(both.fragment_hash, r.fragment_hash);
  EXPECT_EQ(both.fragment_hash, m.fragment_hash);
  EXPECT_EQ(both.cycles_rtl, r.cycles);
  EXPECT_EQ(both.cycles_model, m.cycles);
  EXPECT_EQ(r.quads, quads.size());
}

TEST(Cosim, TwoDevicesAtOnce) {
  LockstepOptions options;
  options.config = s12.config();
  options.state = small_state(options.config);
  const std::vector<SnappedQuad> quads = random_quads(options.config, options.state, 4, 20);
  VerilatedDevice a(options.config, VerilateOptions{}, 1), b(options.config, VerilateOptions{}, 2);
  const LockstepReport first = run_lockstep(a, quads, options), second = run_lockstep(b, quads, options);
  EXPECT_TRUE(first.agreed()) << first.first_divergence.value_or("");
  EXPECT_TRUE(second.agreed()) << second.first_divergence.value_or("");
  EXPECT_EQ(first.fragment_hash, second.fragment_hash);
}

}  // namespace
}  // namespace quadrille::tb
