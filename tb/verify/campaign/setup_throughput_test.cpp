#include "model/port/latency.hpp"
#include "tb/verify/campaign/throughput_test_support.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace quadrille::campaign {
namespace {

/// One quad in an idle machine: clocks from the accepted fourth beat to the setup probe.
std::uint64_t setup_latency(const SnappedQuad& quad, const Config& config, std::uint32_t skip = skip_default) {
  DrawState state = draw_state();
  state.skip = skip;
  const Session r = run({quad}, config, state);
  EXPECT_EQ(r.taken.size(), 1u);
  EXPECT_EQ(r.accepted.size(), 1u);
  return r.taken.empty() || r.accepted.empty() ? 0 : r.taken[0] - r.accepted[0];
}

TEST(Throughput, SetupLatency) {
  const Config config;
  std::uint64_t ordinary = 0, homogeneous = 0, homogeneous_walk = 0;
  for (const SnappedQuad& q : turned_squares(20, config, 3)) ordinary = std::max(ordinary, setup_latency(q, config));
  for (const SnappedQuad& q : homogeneous_quads(20, 8, config, 3)) {
    homogeneous = std::max(homogeneous, setup_latency(q, config, skip_default & ~std::uint32_t{skip_walk}));
    homogeneous_walk = std::max(homogeneous_walk, setup_latency(q, config));
  }
  std::printf("fourth beat to taken: %llu clocks ordinary, %llu homogeneous, with the scissor's test %llu\n",
              static_cast<unsigned long long>(ordinary), static_cast<unsigned long long>(homogeneous),
              static_cast<unsigned long long>(homogeneous_walk));
  EXPECT_GT(ordinary, 0u);
  EXPECT_LE(ordinary, most_setup_latency);
  EXPECT_GT(homogeneous, ordinary);
  EXPECT_LE(homogeneous, most_setup_latency_homogeneous);
  EXPECT_GT(homogeneous_walk, homogeneous);
  EXPECT_LE(homogeneous_walk, most_setup_latency_homogeneous_walk);
}

/// Quads without a pixel, back to back, with quads enough in flight: the interval between two of them is the setup's
/// own.
TEST(Throughput, SetupInitiationInterval) {
  for (const int units : {2, 4}) {
    for (const bool homogeneous : {false, true}) {
      Config config;
      config.dot_units = units;
      config.quad_slots_log2 = 4;
      auto quads = homogeneous ? homogeneous_quads(200, 8, config, 4) : turned_squares(200, config, 4);
      DrawState state = draw_state();
      state.scissor_x1 = state.scissor_x0 = 100;  // empty
      state.skip = skip_tiles;
      const Session r = run(quads, config, state);
      ASSERT_EQ(r.taken.size(), quads.size());
      const double interval = static_cast<double>(r.taken[199] - r.taken[9]) / 190;  // the first ones find it empty
      std::printf("setup interval, %s, %d dot units: %.2f clocks\n", homogeneous ? "homogeneous" : "ordinary", units,
                  interval);
      if (units == 2)
        EXPECT_LE(interval, homogeneous ? setup_clocks_homogeneous : setup_clocks);
      else
        EXPECT_LE(interval, homogeneous ? setup_clocks_homogeneous_four_units : setup_clocks_four_units);
      EXPECT_EQ(r.fragments, 0u);
      if (!homogeneous) continue;
      state.skip = skip_tiles | skip_walk;
      const Session left_out = run(quads, config, state);
      EXPECT_TRUE(left_out.taken.empty()) << "they miss the scissor";
      const double left_out_interval = static_cast<double>(left_out.accepted[199] - left_out.accepted[9]) / 190;
      std::printf("that miss the scissor, %d dot units: %.2f clocks\n", units, left_out_interval);
      EXPECT_LE(left_out_interval,
                units == 2 ? setup_clocks_homogeneous_walk : setup_clocks_homogeneous_walk_four_units);
    }
  }
}

/// Runs of quads that are left out: clocks a quad, over 200 of them. Those that their vertices show take the clocks of
/// their beats.
TEST(Throughput, QuadsLeftOut) {
  struct Run {
    const char* what;
    bool by_vertices;
    std::array<std::array<double, 3>, 4> vertex;  ///< x, y, z
    double w;
    Cull cull;
  };
  const Run runs[] = {
      {"beside the scissor", true, {{{600, 10, .5}, {640, 10, .5}, {640, 40, .5}, {600, 40, .5}}}, 1, Cull::none},
      {"between pixel centres", true, {{{9.6, 9, .5}, {10.4, 9, .5}, {10.4, 30, .5}, {9.6, 30, .5}}}, 1, Cull::none},
      {"behind the eye", true, {{{1, 1, .5}, {9, 1, .5}, {9, 9, .5}, {1, 9, .5}}}, -2, Cull::none},
      {"too far", true, {{{1, 1, .8}, {9, 1, .9}, {9, 9, .8}, {1, 9, .8}}}, 1, Cull::none},
      {"on one line", false, {{{1, 1, .5}, {9, 9, .5}, {4, 4, .5}, {7, 7, .5}}}, 1, Cull::none},
      {"culled", false, {{{1, 1, .5}, {90, 1, .5}, {90, 90, .5}, {1, 90, .5}}}, 1, Cull::back},
  };
  for (const Run& kind : runs)
    for (const int dot_units : {2, 4}) {
      Config config;
      config.set("dot_units", dot_units);
      DrawState state = draw_state();
      state.depth = true;
      state.zfar = 0.75;
      state.cull = kind.cull;
      std::vector<SnappedQuad> quads;
      for (std::uint32_t id = 0; id < 210; ++id) {
        WindowQuad q;
        q.id = id;
        for (std::size_t i = 0; i < 4; ++i) {
          const auto& [x, y, z] = kind.vertex[i];
          q.vertex[i] = {x * kind.w, y * kind.w, z * kind.w, kind.w};
        }
        quads.push_back(snap_quad(q, config, state));
      }
      const auto clocks_a_quad = [&](const Session& r) {
        EXPECT_EQ(r.fragments, 0u);
        if (r.accepted.size() != quads.size()) return 0.0;
        return static_cast<double>(r.accepted[209] - r.accepted[9]) / 200;
      };
      const Session with = run(quads, config, state);
      state.skip = skip_tiles;
      const Session without = run(quads, config, state);
      const double clocks = clocks_a_quad(with);
      std::printf("%s, %d dot units: %.2f clocks a quad, %.2f without the skip\n", kind.what, dot_units, clocks,
                  clocks_a_quad(without));
      EXPECT_TRUE(with.taken.empty());
      EXPECT_EQ(without.taken.size(), quads.size());
      EXPECT_GT(clocks, 0);
      EXPECT_LE(clocks, kind.by_vertices ? 4 : 6);
      EXPECT_GT(clocks_a_quad(without), clocks);
    }
}

/// Setup of the next quad runs while this one is drawn: quads whose drawing takes longer than their setup cost their
/// drawing alone; a machine without overlap would need the sum of the single runs.
TEST(Throughput, SetupHidesBehindDrawing) {
  const Config config;
  for (const bool homogeneous : {false, true}) {
    std::vector<SnappedQuad> quads = homogeneous ? homogeneous_quads(300, 12, config, 5) : std::vector<SnappedQuad>();
    if (!homogeneous) {
      Prng rng(6);
      for (std::uint32_t n = 0; n < 300; ++n) {
        const double x = rng.uniform(0, 400), y = rng.uniform(0, 400);
        const double p[4][2] = {{x, y}, {x + 6, y}, {x + 6, y + 6}, {x, y + 6}};
        quads.push_back(snapped(p, n, config));
      }
    }
    DrawState state = draw_state();
    if (homogeneous) {
      // Such quads walk all tiles up to the scissor's far corner; a small one keeps the walk below the drawing.
      state.scissor_x1 = state.scissor_y1 = 80;
    }
    std::uint64_t alone = 0, setup = 0;
    for (const SnappedQuad& q : quads) {
      const Session single = run({q}, config, state);
      alone += single.clocks;
      setup += single.taken.at(0) - single.accepted.at(0);
    }
    const Session r = run(quads, config, state);
    std::printf("%s: %llu pixels, %llu clocks overlapped, %llu one by one, of these %llu setup\n",
                homogeneous ? "homogeneous 12x12" : "ordinary 6x6", static_cast<unsigned long long>(r.fragments),
                static_cast<unsigned long long>(r.clocks), static_cast<unsigned long long>(alone),
                static_cast<unsigned long long>(setup));
    // Pixels alone bound it from below; all of the setup and pipeline latency must have gone.
    EXPECT_LE(r.clocks,
              alone - setup - quads.size() * static_cast<std::uint64_t>(latency::emission + latency::pipeline - 4));
    // What is left over the pixels is the walk over empty tiles.
    EXPECT_GE(pixels_per_clock(r), homogeneous ? small_homogeneous_per_clock : small_per_clock);
  }
}

}  // namespace
}  // namespace quadrille::campaign
