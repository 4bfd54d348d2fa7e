// Hidden tiles: the depth-tested picture is the same with and without, bit by bit, for every scene and stress family in
// several orders, and for quads made so that each rule of hierarchical_z alone decides; and that what can be hidden is.
#include "golden/scenes/random_state.hpp"
#include "golden/scenes/scenes.hpp"
#include "golden/scenes/stress.hpp"
#include "model/port/snap.hpp"
#include "model/skips/hierarchical_z_test_support.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace quadrille {
namespace {

double mean_depth(const WindowQuad& quad) {
  double sum = 0;
  for (const WindowVertex& v : quad.vertex) sum += v.w > 0 ? v.z / v.w : 0;
  return sum;
}

/// Front to back, back to front, and shuffled.
std::vector<std::vector<WindowQuad>> orders(std::vector<WindowQuad> quads, std::uint64_t seed) {
  std::vector<std::vector<WindowQuad>> result;
  std::ranges::stable_sort(quads, {}, mean_depth);
  result.push_back(quads);
  std::ranges::reverse(quads);
  result.push_back(quads);
  Prng rng(seed);
  for (std::size_t i = quads.size(); i > 1; --i) std::swap(quads[i - 1], quads[rng.below(i)]);
  result.push_back(quads);
  return result;
}

void compare(const Config& config, const DrawState& state, const std::vector<WindowQuad>& quads, std::string_view name,
             std::uint64_t& hidden) {
  std::size_t order = 0;
  for (const std::vector<WindowQuad>& given : orders(quads, 5)) {
    BothWays both(config, state);
    for (const WindowQuad& quad : given) both.draw(snap_quad(quad, config, state));
    EXPECT_TRUE(both.same()) << name << ", order " << order;
    hidden += both.hidden();
    ++order;
  }
}

TEST(HierarchicalZ, ScenesLookTheSame) {
  const Config config = configured();
  std::uint64_t hidden = 0;
  for (const golden::SceneInfo& info : golden::list_scenes()) {
    const golden::Scene scene = golden::make_scene(info.name);
    std::vector<WindowQuad> quads = golden::scene_quads(scene, 160, 120, golden::AttributeSet::none);
    if (quads.size() > 2500) continue;
    DrawState state = viewport(160, 120);
    state.perspective = scene.perspective;
    compare(config, state, quads, info.name, hidden);
  }
  EXPECT_GT(hidden, 0u);
}

/// The families, many times over one another, in random draw states.
void families(const Config& config, std::uint64_t seed, int rounds) {
  std::uint64_t hidden = 0;
  for (const golden::StressFamilyInfo& family : golden::stress_families())
    for (int round = 0; round < rounds; ++round) {
      const std::uint64_t at = seed + static_cast<std::uint64_t>(round);
      std::vector<WindowQuad> quads = golden::make_stress(family.family, 12, at, 1, 72, 56, 0);
      // Something for them to be hidden by, and to hide.
      Prng rng(at);
      for (std::uint32_t i = 0; i < 4; ++i) {
        const double x = rng.uniform() * 40 - 8, y = rng.uniform() * 40 - 8, size = 16 + rng.uniform() * 48;
        std::array<double, 4> z{rng.uniform(), rng.uniform(), rng.uniform(), rng.uniform()};
        if (i < 2) z = {0.05, 0.06, 0.07, 0.08};  // in front of most
        quads.push_back(quad_of(
            100 + i,
            {{{x, y, z[0]}, {x + size * 0.1, y + size, z[1]}, {x + size, y + size, z[2]}, {x + size, y, z[3]}}}));
      }
      DrawState state = viewport(72, 56);
      if (round != 0) state = golden::random_draw_state(config, 72, 56, quads, at);
      state.attributes = 0;
      state.depth = true;
      compare(config, state, quads, family.name, hidden);
    }
  EXPECT_GT(hidden, 0u);
}

TEST(HierarchicalZ, FamiliesLookTheSame) { families(configured(), 900, 4); }
TEST(HierarchicalZ, FamiliesLookTheSameWithNarrowWidths) {
  families(configured({{"significand_bits", 8},
                       {"depth_bits", 10},
                       {"hierarchical_z_bits", 10},
                       {"align_guard_bits", 0},
                       {"tile_log2", 2},
                       {"hierarchical_z_tiles_log2", 6}}),
           1900, 4);
}
TEST(HierarchicalZ, FamiliesLookTheSameWithDroppedBits) {
  families(configured({{"significand_bits", 12}, {"quadratic_frac_bits", 16}, {"hierarchical_z_bits", 16}}), 2900, 2);
}

/// Many layers a little apart, so that codes decide: depths of neighbouring layers differ by a few units of the
/// arithmetic.
TEST(HierarchicalZ, LayersALittleApart) {
  for (const int s : {8, 10, 12})
    for (const int guard : {0, 2}) {
      const Config config = configured(
          {{"significand_bits", s}, {"align_guard_bits", guard}, {"hierarchical_z_bits", 16}, {"tile_log2", 2}});
      const DrawState state = viewport(16, 16);
      const double unit = std::ldexp(1, 1 - s);
      Prng rng(static_cast<std::uint64_t>(17 + s));
      std::uint64_t hidden = 0;
      for (int round = 0; round < 1500; ++round) {
        BothWays both(config, state);
        const double base = 0.05 + 0.8 * rng.uniform();
        for (std::uint32_t layer = 0; layer < 4; ++layer) {
          const double above = std::floor(40 * rng.uniform());
          std::array<std::array<double, 3>, 4> corner{{{-3, -2, 0}, {-4, 19, 0}, {21, 18, 0}, {17, -5, 0}}};
          for (auto& c : corner) {
            c[0] += 3 * rng.uniform();
            c[1] += 3 * rng.uniform() - 2;
            c[2] = base * (1 + unit * (above + std::floor(3 * rng.uniform())) / 2);
          }
          corner[0][0] -= 2, corner[2][0] += 2, corner[2][1] += 3, corner[3][1] -= 2;
          both.draw(snap_quad(quad_of(layer, corner), config, state));
        }
        ASSERT_TRUE(both.same()) << "s = " << s << ", guard " << guard << ", round " << round;
        hidden += both.hidden();
      }
      EXPECT_GT(hidden, 100u) << "s = " << s;
    }
}

/// A front quad that the rule forbids to hide, and one behind it that must be seen all the same.
struct Case {
  const char* what;
  DrawState state;
  WindowQuad front;
  bool may_hide = false;  ///< the rule does not apply: the one behind is left out
};

TEST(HierarchicalZ, OnlyWhatIsDrawnHides) {
  const Config config = configured();
  const DrawState plain = viewport(32, 32);
  std::vector<Case> cases;
  const WindowQuad whole = rectangle(0, -8, -8, 40, 40, 0.25);
  cases.push_back({"a plain quad", plain, whole, true});
  {
    Case c{"outside the scissor", plain, whole};
    c.state.scissor_x0 = 1, c.state.scissor_y0 = 1, c.state.scissor_x1 = 31, c.state.scissor_y1 = 31;
    cases.push_back(c);
  }
  for (const bool swap : {false, true}) {
    Case c{"culled", plain, whole};
    if (swap) std::swap(c.front.vertex[1], c.front.vertex[3]);
    c.state.cull = swap ? Cull::back : Cull::front;
    cases.push_back(c);
  }
  {
    Case c{"nearer than znear", plain, whole};
    c.state.znear = 0.5;
    cases.push_back(c);
  }
  {
    Case c{"partly nearer than znear", plain, whole};
    c.state.znear = 0.3;
    for (std::size_t i : {0u, 1u}) c.front.vertex[i].z = 0.4;
    cases.push_back(c);
  }
  {
    Case c{"partly behind zfar", plain, whole};
    c.state.zfar = 0.3;
    for (std::size_t i : {0u, 1u}) c.front.vertex[i].z = 0.35;
    cases.push_back(c);
  }
  {
    Case c{"negative depths", plain, whole};
    for (std::size_t i : {0u, 1u}) c.front.vertex[i].z = -0.5;
    cases.push_back(c);
  }
  {
    Case c{"behind the eye at a corner", plain, whole};
    c.front.vertex[0].w = -1e-3;
    cases.push_back(c);
  }
  {
    Case c{"a hole", plain, whole};
    c.front = rectangle(0, 1.6, 1.6, 40, 40, 0.25);
    c.state.scissor_x1 = c.state.scissor_y1 = 8;
    cases.push_back(c);
  }
  {
    Case c{"no tile wholly covered: a bow-tie", plain, whole};
    c.front = quad_of(0, {{{-8, -8, 0.25}, {40, 40, 0.25}, {40, -8, 0.25}, {-8, 40, 0.25}}});
    cases.push_back(c);
  }
  {
    Case c{"nothing: twice the same corner", plain, whole};
    c.front.vertex[2] = c.front.vertex[0];
    cases.push_back(c);
  }
  for (const Case& c : cases) {
    // Walked whatever it is: nothing but the rule keeps it from hiding.
    DrawState walked = c.state;
    walked.skip = skip_tiles;
    BothWays both(config, walked);
    both.draw(snap_quad(c.front, config, walked));
    // The draw behind has no limits of its own.
    DrawState open = plain;
    if (c.state.scissor_x1 == 8) open = c.state;  // the hole alone
    both.set_state(open);
    both.draw(snap_quad(rectangle(1, -8, -8, 40, 40, 0.75), config, open));
    EXPECT_TRUE(both.same()) << c.what;
    EXPECT_GT(both.covered(), 0u) << c.what;
    if (c.may_hide) {
      EXPECT_EQ(both.hidden(), 16u) << c.what;
    }
  }
}

TEST(HierarchicalZ, EqualDepthsAreHiddenAndTheLeastNearerIsNot) {
  // Of one depth each: nothing is lost but what is rounded to the entries' codes.
  const Config config = configured();
  const DrawState state = viewport(32, 32);
  BothWays both(config, state);
  const double least = std::ldexp(1, -config.depth_bits);
  const auto hidden_at = [&](std::uint32_t id, double z) {
    const std::uint64_t before = both.hidden();
    both.draw(snap_quad(rectangle(id, -8, -8, 40, 40, z), config, state));
    return both.hidden() - before;
  };
  EXPECT_EQ(hidden_at(0, 0.5 + least), 0u);
  EXPECT_EQ(hidden_at(1, 0.5 + least), 0u) << "its entry's code is rounded up";
  EXPECT_EQ(hidden_at(2, 0.5), 0u);
  EXPECT_EQ(hidden_at(3, 0.5), 16u) << "LESS draws nothing of an equal depth";
  EXPECT_EQ(hidden_at(4, 0.5 + 9 * least), 16u);
  EXPECT_EQ(hidden_at(5, 0.5 - least), 0u);
  EXPECT_TRUE(both.same());
}

TEST(HierarchicalZ, TilesThatLieTogetherHavePlacesOfTheirOwn) {
  for (const int log2 : {6, 7, 9}) {
    Config config = configured();
    config.hierarchical_z_tiles_log2 = log2;
    const TilePlaces places(config);
    ASSERT_EQ(places.count(), std::size_t{1} << log2);
    const int columns = 1 << (log2 + 1) / 2, rows = 1 << log2 / 2;
    for (const auto& [x0, y0] :
         {std::pair{0, 0}, std::pair{columns, 0}, std::pair{3, 5}, std::pair{5 * columns - 1, 7}}) {
      std::vector<bool> taken(places.count());
      for (int y = y0; y < y0 + rows; ++y)
        for (int x = x0; x < x0 + columns; ++x) {
          const std::size_t place = places.place(x, y);
          ASSERT_LT(place, places.count());
          EXPECT_FALSE(taken[place]) << x << ", " << y;
          taken[place] = true;
        }
    }
  }
}

TEST(HierarchicalZ, OutlivesADrawUntilTheClear) {
  const Config config = configured();
  DrawState state = viewport(32, 32);
  BothWays both(config, state);
  both.draw(snap_quad(rectangle(0, -8, -8, 40, 40, 0.25), config, state));
  state.cull = Cull::front;
  both.set_state(state);
  WindowQuad behind = rectangle(1, -8, -8, 40, 40, 0.75);
  std::swap(behind.vertex[1], behind.vertex[3]);
  both.draw(snap_quad(behind, config, state));
  EXPECT_EQ(both.hidden(), 16u);
  EXPECT_TRUE(both.same());
  both.clear();
  both.draw(snap_quad(behind, config, state));
  EXPECT_EQ(both.hidden(), 16u);
  EXPECT_TRUE(both.same());
  EXPECT_EQ(both.covered(), 32u * 32u);
}

/// Depths of fragments lie in the interval of their quad, which is no wider than the codes make it.
TEST(HierarchicalZ, IntervalHoldsEveryDepth) {
  for (const int bits : {4, 10, 16})
    for (const int s : {8, 18, 26}) {
      const Config config = configured({{"hierarchical_z_bits", bits}, {"significand_bits", s}});
      const DrawState state = viewport(24, 24);
      UntimedModel model(config, state);
      Prng rng(static_cast<std::uint64_t>(bits * 100 + s));
      std::uint64_t fragments = 0, lowering = 0;
      for (int i = 0; i < 400; ++i) {
        std::array<std::array<double, 3>, 4> corner{};
        const double base = rng.uniform(), spread = std::exp2(-14 * rng.uniform());
        for (auto& c : corner)
          c = {24 * rng.uniform(), 24 * rng.uniform(),
               std::min(1.0, std::max(0.0, base + spread * (rng.uniform() - 0.5)))};
        if (i % 16 == 0) corner[0][2] = 0;
        if (i % 16 == 8)  // down to depths whose codes are 0 by far
          for (auto& c : corner) c[2] = std::ldexp(c[2], -i / 8);
        const SnappedQuad quad = snap_quad(quad_of(0, corner), config, state);
        const DepthInterval depth = depth_interval(quad, config, state);
        const double unit = std::ldexp(1, -bits), unknown = 1 - unit, half = std::ldexp(1, -config.depth_bits - 1);
        double least = 1, greatest = 0;
        for (const auto& c : corner) least = std::min(least, c[2]), greatest = std::max(greatest, c[2]);
        EXPECT_GT(depth.near * unit, std::min(least - half, unknown) - unit - half) << i;
        EXPECT_LE(depth.near * unit, least + half) << i;
        EXPECT_GE(depth.far * unit, std::min(greatest - half, unknown)) << i;
        EXPECT_LT(depth.far * unit, greatest + half + unit) << i;
        lowering += depth.lowers;
        model.draw(quad, [&](std::span<const Fragment> drawn) {
          for (const Fragment& f : drawn) {
            const double z = f.depth * std::ldexp(1, -config.depth_bits);
            ++fragments;
            EXPECT_GE(z, std::floor(depth.near * std::ldexp(1, config.depth_bits - bits)) *
                             std::ldexp(1, -config.depth_bits));
            if (depth.far * unit != unknown) {
              EXPECT_LE(z, depth.far * unit);
            }
          }
        });
        ASSERT_FALSE(HasFailure()) << "quad " << i << ", " << bits << " bits, s = " << s;
      }
      EXPECT_GT(fragments, 5000u);
      EXPECT_GT(lowering, 100u);
    }
}

TEST(HierarchicalZ, NothingIsLoweredWhereWeightsMayBeNone) {
  const DrawState state = viewport(32, 32);
  const Config config = configured({{"quadratic_frac_bits", 15}});
  const DepthInterval depth = depth_interval(snap_quad(rectangle(0, 0, 0, 9, 9, 0.5), config, state), config, state);
  EXPECT_FALSE(depth.lowers) << "the sum of the weights may be 0";
  EXPECT_GT(depth.near, 2000u);
}

/// The coarse code of the farthest corner is rounded up: a code beyond 1 needs one bit more than the widest format.
TEST(HierarchicalZ, WhatLiesBeyondOneTeachesNothingInAnyFormat) {
  const DrawState state = viewport(32, 32);
  for (const int depth_bits : {8, 24, 30})
    for (const int bits : {4, 6, 8}) {
      const Config config = configured({{"depth_bits", depth_bits}, {"hierarchical_z_bits", bits}});
      SnappedQuad quad = snap_quad(rectangle(0, 0, 0, 9, 9, 0.5), config, state);
      const std::uint32_t unknown = (1u << bits) - 1;
      quad.base.depth_low = 0;
      quad.base.depth_high = (1 << depth_bits) + 1;
      EXPECT_EQ(depth_interval(quad, config, state).near, 0u);
      EXPECT_EQ(depth_interval(quad, config, state).far, unknown) << depth_bits << " bits, " << bits << " of them";
      EXPECT_FALSE(depth_interval(quad, config, state).lowers) << depth_bits << " bits, " << bits << " of them";
      quad.base.depth_low = quad.base.depth_high;
      EXPECT_EQ(depth_interval(quad, config, state).near, unknown - 1);
      quad.base.depth_low = quad.base.depth_high = 1;
      EXPECT_EQ(depth_interval(quad, config, state).far, 1u) << "rounded up";
      EXPECT_EQ(depth_interval(quad, config, state).near, depth_bits == bits ? 1u : 0u) << "rounded down";
    }
}

}  // namespace
}  // namespace quadrille
