// Throughput and latency of the clocked model without stalls or gaps: covered pixels per clock, clocks of the setup,
// and that setup hides behind drawing.
#include "golden/scenes/scenes.hpp"
#include "model/untimed.hpp"
#include "tb/verify/campaign/throughput_test_support.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>

namespace quadrille::campaign {
namespace {

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
      {"8x8 on tiles", squares(1000, 8, true, config, 8), {0.983, 1.933, 3.743}},
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

/// A stream of quads whose pixels take less time than all else. One tile each: eight slots bound it, each in use for a
/// quad's whole way; of sixteen, two dot units take six clocks for the setup and two for the tile, with four the slots
/// bound it. Four tiles each: coverage bounds it, a row a clock down to the quad's last one, and waits for less than a
/// clock a quad.
TEST(Throughput, SmallQuads) {
  constexpr int count = 10'000;
  struct Load {
    int tiles, slots_log2;
  };
  for (const auto [tiles, slots_log2] : {Load{1, 3}, {1, 4}, {2, 4}}) {
    for (const int units : {2, 4}) {
      Config config;
      config.dot_units = units;
      config.quad_slots_log2 = slots_log2;
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
      std::printf("%d quads of %.2f pixels and %d tiles, %d slots, %d dot units: %.4f clocks a quad, %.4f rows\n",
                  count, static_cast<double>(r.fragments) / count, tiles * tiles, 1 << slots_log2, units,
                  static_cast<double>(clocks) / (count - 1), static_cast<double>(rows) / count);
      if (slots_log2 == 3)
        EXPECT_LE(clocks, most_slot_clocks * count / 8);
      else
        EXPECT_LE(clocks, tiles == 1 ? most_small_quad_clocks * count : rows + count);
    }
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
