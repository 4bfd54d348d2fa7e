// Throughput and latency of the clocked model without stalls or gaps: covered pixels per clock, clocks of the setup,
// and that setup hides behind drawing.
#include "golden/scenes/scenes.hpp"
#include "model/drive.hpp"
#include "model/port/latency.hpp"
#include "model/port/snap.hpp"
#include "model/support/prng.hpp"
#include "model/untimed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

namespace quadrille::campaign {
namespace {

using golden::Prng;

/// From quad to quad: beats and bounding box, or the steps. The pipeline of the dot units is not in it.
/// A homogeneous quad's depend on skip_walk, whether it is asked whether it misses the scissor.
constexpr double setup_clocks = 7, setup_clocks_homogeneous = 20, setup_clocks_homogeneous_walk = 40;
constexpr double setup_clocks_four_units = 6, setup_clocks_homogeneous_four_units = 12,
                 setup_clocks_homogeneous_walk_four_units = 25;
constexpr std::uint64_t most_small_quad_clocks = 8;
constexpr std::uint64_t most_setup_latency = 17, most_setup_latency_homogeneous = 31,
                        most_setup_latency_homogeneous_walk = 51;
/// What rtl/MEASUREMENTS.md claims to its last digit: clocks are exact, so any loss is one of the
/// machine.
constexpr double turned_squares_per_clock = 0.9985, concave_per_clock = 0.9815;
/// Quads of 6x6 pixels; homogeneous ones of 12x12, whose pixels take three clocks each, with two tiles in flight.
constexpr double small_per_clock = 0.964, small_homogeneous_per_clock = 0.266;
constexpr std::uint64_t most_clocks = 100'000'000;

struct Session {
  std::uint64_t clocks = 0;                    ///< from the first beat until idle
  std::uint64_t fragments = 0;                 ///< accepted at the port
  std::vector<Fragment> stream;                ///< they, in order
  std::vector<std::uint64_t> accepted, taken;  ///< per quad: clock of the fourth beat, clock of the setup probe
};

Session run(const std::vector<SnappedQuad>& quads, const Config& config, const DrawState& state) {
  DrivenModel model(config, state);
  SteadyBeats beats(quads);
  Session r;
  r.clocks = drive(model, beats, [&](std::uint64_t cycle, const ClockedOutputs& o, bool taken) {
    o.for_each_fragment([&](const Fragment& f) { r.stream.push_back(f); });
    if (o.probes.setup != nullptr) r.taken.push_back(cycle);
    if (taken && beats.taken() % 4 == 3) r.accepted.push_back(cycle);
    return (!beats.done() || o.busy) && cycle < most_clocks;
  });
  r.fragments = r.stream.size();
  EXPECT_LT(r.clocks, most_clocks) << "the machine does not become idle";
  return r;
}

DrawState draw_state() {
  DrawState s;
  s.depth = false;  // every covered pixel becomes a fragment
  return s;
}

SnappedQuad snapped(const double (&p)[4][2], std::uint32_t id, const Config& config) {
  WindowQuad q;
  q.id = id;
  for (std::size_t i = 0; i < 4; ++i) q.vertex[i] = {p[i][0], p[i][1], 0.5, 1};
  return snap_quad(q, config, draw_state());
}

std::vector<SnappedQuad> turned_squares(int count, const Config& config, std::uint64_t seed) {
  Prng rng(seed);
  std::vector<SnappedQuad> out;
  for (int n = 0; n < count; ++n) {
    const double angle = rng.uniform(0, 2 * std::acos(-1.0)), cx = rng.uniform(30, 480), cy = rng.uniform(30, 480);
    double p[4][2];
    for (int i = 0; i < 4; ++i) {
      p[i][0] = cx + 16 * std::sqrt(2.0) * std::cos(angle + i * std::acos(0.0));
      p[i][1] = cy + 16 * std::sqrt(2.0) * std::sin(angle + i * std::acos(0.0));
    }
    out.push_back(snapped(p, static_cast<std::uint32_t>(n), config));
  }
  return out;
}

/// Simple quads with one reflex corner, scaled to a bounding box of 32x32 pixels.
std::vector<SnappedQuad> concave_quads(int count, const Config& config, std::uint64_t seed) {
  Prng rng(seed);
  std::vector<SnappedQuad> out;
  while (static_cast<int>(out.size()) < count) {
    double p[4][2];
    for (auto& v : p) v[0] = rng.uniform(), v[1] = rng.uniform();
    int left = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto& a = p[i];
      const auto& b = p[(i + 1) & 3];
      const auto& c = p[(i + 2) & 3];
      left += (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0;
    }
    // One turn against the three others is a simple concave quad; two and two is a bow-tie.
    if (left != 1 && left != 3) continue;
    const double ox = rng.uniform(0, 470), oy = rng.uniform(0, 470);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const auto [low, high] = std::minmax({p[0][axis], p[1][axis], p[2][axis], p[3][axis]});
      for (auto& v : p) v[axis] = (axis == 0 ? ox : oy) + 32 * (v[axis] - low) / (high - low);
    }
    out.push_back(snapped(p, static_cast<std::uint32_t>(out.size()), config));
  }
  return out;
}

/// Convex quads of about `extent` pixels with one vertex that is homogeneous (W < 1) but where the ordinary one would
/// be.
std::vector<SnappedQuad> homogeneous_quads(int count, double extent, const Config& config, std::uint64_t seed) {
  Prng rng(seed);
  std::vector<SnappedQuad> out;
  for (int n = 0; n < count; ++n) {
    const double x = rng.uniform(0, 60), y = rng.uniform(0, 60);
    const double p[4][2] = {{x, y}, {x + extent, y}, {x + extent, y + extent}, {x, y + extent}};
    SnappedQuad q = snapped(p, static_cast<std::uint32_t>(n), config);
    q.vertex[2].x /= 2, q.vertex[2].y /= 2, q.vertex[2].w /= 2;
    q.vertex[2].k.exp -= 1;
    out.push_back(q);
  }
  return out;
}

double pixels_per_clock(const Session& r) { return static_cast<double>(r.fragments) / static_cast<double>(r.clocks); }

TEST(Throughput, TurnedSquares) {
  const Config config;
  const Session r = run(turned_squares(1000, config, 1), config, draw_state());
  std::printf("1000 turned 32x32 quads: %llu pixels in %llu clocks, %.4f per clock\n",
              static_cast<unsigned long long>(r.fragments), static_cast<unsigned long long>(r.clocks),
              pixels_per_clock(r));
  EXPECT_NEAR(static_cast<double>(r.fragments), 1024e3, 2e3);
  EXPECT_GE(pixels_per_clock(r), turned_squares_per_clock);
  EXPECT_LE(pixels_per_clock(r), 1.0);
}

TEST(Throughput, ConcaveQuads) {
  const Config config;
  const Session r = run(concave_quads(1000, config, 2), config, draw_state());
  std::printf("1000 concave quads of 32x32: %llu pixels in %llu clocks, %.4f per clock\n",
              static_cast<unsigned long long>(r.fragments), static_cast<unsigned long long>(r.clocks),
              pixels_per_clock(r));
  EXPECT_GT(r.fragments, 200'000u);
  EXPECT_GE(pixels_per_clock(r), concave_per_clock);
}

/// Squares of `edge` pixels whose corners are on corners of tiles, or nowhere in particular.
std::vector<SnappedQuad> squares(int count, double edge, bool aligned, const Config& config, std::uint64_t seed) {
  Prng rng(seed);
  std::vector<SnappedQuad> out;
  for (int n = 0; n < count; ++n) {
    const double x = aligned ? 8.0 * static_cast<double>(rng.below(50)) : rng.uniform(0, 400);
    const double y = aligned ? 8.0 * static_cast<double>(rng.below(50)) : rng.uniform(0, 400);
    const double p[4][2] = {{x, y}, {x + edge, y}, {x + edge, y + edge}, {x, y + edge}};
    out.push_back(snapped(p, static_cast<std::uint32_t>(n), config));
  }
  return out;
}

/// What the lanes give: pixels of one row of one tile share a clock, so a row that a quad covers in part leaves lanes
/// empty. Fragments and their order are those of one lane.
TEST(Throughput, PixelsPerClock) {
  struct Load {
    const char* name;
    std::vector<SnappedQuad> quads;
    std::array<double, 3> least;  ///< pixels per clock with 1, 2, 4 lanes, as measured: clocks are exact
  };
  Config config;
  const std::vector<Load> loads{
      {"64x64 on tiles", squares(100, 64, true, config, 7), {0.999, 1.998, 3.992}},
      {"8x8 on tiles", squares(1000, 8, true, config, 8), {0.983, 1.933, 3.744}},
      {"64x64 anywhere", squares(100, 64, false, config, 9), {0.999, 1.960, 3.765}},
      {"8x8 anywhere", squares(1000, 8, false, config, 10), {0.982, 1.731, 2.569}},
      {"32x32 turned", turned_squares(300, config, 1), {0.998, 1.917, 3.488}},
      {"32x32 concave", concave_quads(300, config, 2), {0.980, 1.682, 2.417}},
      {"12x12 homogeneous", homogeneous_quads(100, 12, config, 5), {0.269, 0.397, 0.4955}},
  };
  for (const Load& load : loads) {
    std::vector<Fragment> stream;
    for (std::size_t i = 0; i < 3; ++i) {
      config.pixels_per_clock = 1 << i;
      DrawState state = draw_state();
      if (load.quads.front().vertex[2].w != load.quads.front().vertex[0].w) state.scissor_x1 = state.scissor_y1 = 80;
      const Session r = run(load.quads, config, state);
      std::printf("%-18s %d lanes: %7zu pixels, %.4f per clock\n", load.name, config.pixels_per_clock, r.stream.size(),
                  pixels_per_clock(r));
      EXPECT_GE(pixels_per_clock(r), load.least[i]) << load.name;
      if (i == 0)
        stream = r.stream;
      else
        EXPECT_TRUE(r.stream == stream) << load.name << ": other fragments or another order";
    }
    config.pixels_per_clock = 1;
  }
}

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

/// Quads of about 2x2 pixels within `tiles` x `tiles` tiles: one has them inside a tile, of two the corner that four
/// tiles share is inside.
std::vector<SnappedQuad> small_quads(int count, int tiles, const Config& config, std::uint64_t seed) {
  Prng rng(seed);
  std::vector<SnappedQuad> out;
  for (int n = 0; n < count; ++n) {
    const auto low = [&](double extent) {
      const double tile = config.tile() * std::floor(rng.uniform(1, 60));
      return tiles == 1 ? tile + rng.uniform(0.5, config.tile() - 0.5 - extent) : tile - rng.uniform(0.6, extent - 0.6);
    };
    const double width = rng.uniform(1.5, 2.5), height = rng.uniform(1.5, 2.5), x = low(width), y = low(height);
    const double p[4][2] = {{x, y}, {x + width, y + 0.1}, {x + width - 0.1, y + height}, {x + 0.1, y + height}};
    out.push_back(snapped(p, static_cast<std::uint32_t>(n), config));
  }
  return out;
}

/// A stream of quads whose pixels take less time than all else, with quads enough in flight. One tile each: two dot
/// units take six clocks for the setup and two for the tile; with four, vertex_assembly's beats and bounding box bound
/// it. Four tiles each: coverage bounds it, a row a clock down to the quad's last
/// one, and waits for less than a clock a quad.
TEST(Throughput, SmallQuads) {
  constexpr int count = 10'000;
  for (const int tiles : {1, 2}) {
    for (const int units : {2, 4}) {
      Config config;
      config.dot_units = units;
      config.quad_slots_log2 = 4;
      const std::vector<SnappedQuad> quads = small_quads(count, tiles, config, 7);
      std::uint64_t rows = 0;
      for (const SnappedQuad& q : quads) {
        std::int64_t low = q.vertex[0].y;
        for (const SnappedVertex& v : q.vertex) low = std::max<std::int64_t>(low, v.y);
        const auto below = static_cast<std::uint64_t>(low >> config.frac()) % static_cast<std::uint64_t>(config.tile());
        rows += tiles == 1 ? below + 1 : 2 * (static_cast<std::uint64_t>(config.tile()) + below + 1);
        rows += 1;  // the end entry
      }
      const Session r = run(quads, config, draw_state());
      ASSERT_EQ(r.taken.size(), quads.size());
      const std::uint64_t clocks = r.taken.back() - r.taken.front();
      std::printf("%d quads of %.2f pixels and %d tiles, %d dot units: %.4f clocks a quad, %.4f rows\n", count,
                  static_cast<double>(r.fragments) / count, tiles * tiles, units,
                  static_cast<double>(clocks) / (count - 1), static_cast<double>(rows) / count);
      EXPECT_LE(clocks, tiles == 1 ? most_small_quad_clocks * count : rows + count);
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

/// What is left when every tile that is known to be hidden is skipped: fragments of the tiles of each quad of which
/// something is seen. And every pixel: fragments that are seen when they are drawn.
struct Possible {
  std::uint64_t by_tiles = 0, by_pixels = 0;
};
Possible possible_fragments(const std::vector<SnappedQuad>& quads, const Config& config, DrawState state) {
  state.skip &= ~std::uint32_t{skip_hidden};
  UntimedModel model(config, state);
  std::vector<std::uint32_t> depth(static_cast<std::size_t>(state.width * state.height), 1u << config.depth_bits);
  Possible left;
  for (const SnappedQuad& quad : quads) {
    std::map<std::pair<int, int>, std::pair<std::uint64_t, bool>> tiles;  // fragments, one is seen
    model.draw(quad, [&](std::span<const Fragment> fragments) {
      for (const Fragment& f : fragments) {
        std::uint32_t& nearest = depth[static_cast<std::size_t>(f.y * state.width + f.x)];
        auto& [count, seen] = tiles[{f.x >> config.tile_log2, f.y >> config.tile_log2}];
        ++count;
        seen |= f.depth < nearest;
        left.by_pixels += f.depth < nearest;
        nearest = std::min(nearest, f.depth);
      }
    });
    for (const auto& [place, tile] : tiles) left.by_tiles += tile.second ? tile.first : 0;
  }
  return left;
}

TEST(Throughput, HiddenLayers) {
  Config config;
  config.set("hierarchical_z_bits", 12);
  const std::uint64_t wiping = 1u << config.hierarchical_z_tiles_log2;  // after reset, before the first beat
  struct Load {
    const char* scene;
    std::size_t front;  ///< quads of the front layer; 0: they are not the first ones
    double most;        ///< clocks beside those of the front layer alone; 0: stated only
  };
  for (const Load& load : {Load{"layers_large", 1, 1.02}, Load{"layers_small", 14 * 14, 1.6},
                           Load{"layers_small_back", 0, 0}, Load{"layers_small_random", 0, 0}}) {
    DrawState state;
    state.attributes = 0;
    state.skip |= skip_hidden;
    std::vector<SnappedQuad> quads;
    for (const WindowQuad& quad :
         golden::scene_quads(golden::make_scene(load.scene), 512, 512, golden::AttributeSet::none)) {
      quads.push_back(snap_quad(quad, config, state));
      quads.back().id = static_cast<std::uint32_t>(quads.size() - 1);
    }
    const Session all = run(quads, config, state);
    DrawState everything = state;
    everything.skip &= ~std::uint32_t{skip_hidden};
    const Session without = run(quads, config, everything);
    const Possible possible = possible_fragments(quads, config, state);
    const double clocks = static_cast<double>(all.clocks - wiping);
    std::printf(
        "%s: %.0f clocks, %.3f of those without the skip; %llu fragments, %.3f of the %llu without it; %llu in tiles "
        "of which something is seen, %llu seen",
        load.scene, clocks, clocks / static_cast<double>(without.clocks - wiping),
        static_cast<unsigned long long>(all.fragments),
        static_cast<double>(all.fragments) / static_cast<double>(without.fragments),
        static_cast<unsigned long long>(without.fragments), static_cast<unsigned long long>(possible.by_tiles),
        static_cast<unsigned long long>(possible.by_pixels));
    EXPECT_LE(possible.by_pixels, all.fragments);
    EXPECT_LE(all.clocks, without.clocks);
    if (load.front != 0) {
      const Session front =
          run({quads.begin(), quads.begin() + static_cast<std::ptrdiff_t>(load.front)}, config, state);
      const double part = clocks / static_cast<double>(front.clocks - wiping);
      std::printf("; %.3f of the front layer's clocks", part);
      if (load.most != 0) {
        EXPECT_LE(part, load.most) << load.scene;
      }
    }
    std::printf("\n");
  }
}

}  // namespace
}  // namespace quadrille::campaign
