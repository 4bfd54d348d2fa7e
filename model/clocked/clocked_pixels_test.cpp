// The clocked model with probes of pixels takes them from the plain pipeline, without them from the lanes, ahead of
// time: the same outputs in every clock, and the same counters, and the untimed model's fragments.
#include "model/clocked.hpp"
#include "model/port/snap.hpp"
#include "model/support/prng.hpp"
#include "model/untimed.hpp"

#include "golden/scenes/random_state.hpp"
#include "golden/scenes/stress.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace quadrille {
namespace {

struct Compared {
  std::uint64_t fragments = 0, singular = 0, homogeneous = 0, discarded = 0;
};

/// Both behind the same gaps and stalls, until all is drawn.
Compared compare(const std::vector<SnappedQuad>& quads, const Config& config, const DrawState& state,
                 std::uint64_t seed) {
  Compared seen;
  golden::Prng rng(seed);
  ClockedModel plain(config, state, Probes::all), lanes(config, state);
  ClockedInputs in;
  in.reset = true;
  plain.clock(in);
  lanes.clock(in);
  in.reset = false;
  std::size_t beat = 0;
  std::vector<Fragment> stream;
  for (std::uint64_t clock = 0; clock < 4'000'000; ++clock) {
    const ClockedOutputs a = plain.comb(), b = lanes.comb();
    EXPECT_EQ(a.vertex_ready, b.vertex_ready);
    EXPECT_EQ(a.fragment_valid, b.fragment_valid);
    EXPECT_EQ(a.fragment_mask(), b.fragment_mask());
    EXPECT_EQ(a.busy, b.busy);
    EXPECT_EQ(a.probes.pixels, b.probes.pixels);
    int shown = 0;
    EXPECT_EQ(b.probes.lane, nullptr);
    for (std::size_t lane = 0; lane < a.fragment.size(); ++lane) {
      shown += a.probes.lane[lane].diff != nullptr ? 1 : 0;
      if (a.fragment[lane] != nullptr && b.fragment[lane] != nullptr) {
        EXPECT_EQ(*a.fragment[lane], *b.fragment[lane]) << "lane " << lane;
      }
    }
    EXPECT_EQ(shown, a.probes.pixels);
    if (testing::Test::HasFailure()) {
      ADD_FAILURE() << "clock " << clock;
      return seen;
    }
    if (beat == 4 * quads.size() && !a.busy) break;
    in.fragment_ready = rng.chance(0.8);
    in.vertex_valid = beat < 4 * quads.size();  // stays on offer until it is taken
    if (in.vertex_valid) in.vertex = beat_of(quads[beat / 4], beat % 4);
    beat += in.vertex_valid && a.vertex_ready ? 1 : 0;
    if (a.fragment_valid && in.fragment_ready)
      a.for_each_fragment([&](const Fragment& f) {
        ++seen.fragments;
        stream.push_back(f);
        seen.singular += (f.flags & (flag_on_vertex | flag_two_corner | flag_two_edge)) != 0;
        seen.homogeneous += (f.flags & flag_homogeneous) != 0;
      });
    plain.clock(in);
    lanes.clock(in);
    if (clock % 16 == 0) {
      EXPECT_EQ(plain.counters().value, lanes.counters().value);
    }
  }
  EXPECT_EQ(beat, 4 * quads.size());
  // Nor is one lost or overwritten on its way.
  UntimedModel untimed(config, state, PixelEngine::plain);
  std::vector<Fragment> expected;
  for (const SnappedQuad& quad : quads)
    untimed.draw(quad,
                 [&](std::span<const Fragment> some) { expected.insert(expected.end(), some.begin(), some.end()); });
  EXPECT_TRUE(stream == expected) << stream.size() << " and " << expected.size() << " fragments";
  EXPECT_EQ(plain.counters().value, lanes.counters().value);
  seen.discarded = lanes.counters().pixels() - lanes.counters()[PerformanceCounter::fragments];
  return seen;
}

/// Families in draw states at random, with 1, 2 and 4 pixels a clock and tiles of each size.
TEST(ClockedPixels, LanesGiveThoseOfThePlainPipeline) {
  Compared all;
  std::uint64_t seed = 1;
  for (const golden::StressFamilyInfo& info : golden::stress_families()) {
    Config config;
    config.set("pixels_per_clock", 1 << seed % 3);
    config.set("tile_log2", 2 + static_cast<int>(seed % 3));
    config.set("significand_bits", 12 + static_cast<int>(seed % 4) * 4);
    config.set("plane_quads", seed % 2 == 0);
    config.validate();
    constexpr int size = 48;
    const std::vector<WindowQuad> quads = golden::make_stress(info.family, 120, seed, 1.0, size, size, 4);
    const DrawState state = golden::random_draw_state(config, size, size, quads, seed);
    std::vector<SnappedQuad> snapped;
    for (const WindowQuad& quad : quads) snapped.push_back(snap_quad(quad, config, state));
    SCOPED_TRACE(std::string(info.name) + ", seed " + std::to_string(seed));
    DrawState without_depth = state;  // where W counts with the eye in the hull alone
    without_depth.depth = false;
    without_depth.skip |= skip_operands;
    for (const DrawState& one : {state, without_depth}) {
      const Compared seen = compare(snapped, config, one, seed);
      if (HasFailure()) return;
      all.fragments += seen.fragments;
      all.singular += seen.singular;
      all.homogeneous += seen.homogeneous;
      all.discarded += seen.discarded;
    }
    ++seed;
  }
  EXPECT_GT(all.fragments, 20'000u);
  EXPECT_GT(all.singular, 100u);
  EXPECT_GT(all.homogeneous, 500u);
  EXPECT_GT(all.discarded, 100u);
}

}  // namespace
}  // namespace quadrille
