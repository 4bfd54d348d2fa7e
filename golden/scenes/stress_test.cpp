// Every stress family really contains its condition; sequences are deterministic and inside the stated ranges.
#include "golden/scenes/stress.hpp"
#include "golden/scenes/stress_test_support.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <set>
#include <stdexcept>
#include <utility>

namespace quadrille::golden {
namespace {

TEST(Stress, ListMatchesTheEnumerationAndNamesParse) {
  const char* expected[] = {"general",     "perspective", "any_w",       "near_edge",      "on_edge",
                            "near_vertex", "on_vertex",   "sliver",      "collapsed_edge", "straight_corner",
                            "reflex",      "bowtie",      "tiny",        "huge",           "eye_crossing",
                            "eye_in_hull", "w_zero",      "shared_edge", "shared_vertex",  "coplanar",
                            "long_span",   "coincident"};
  const auto families = stress_families();
  ASSERT_EQ(families.size(), std::size(expected));
  for (std::size_t i = 0; i < families.size(); ++i) {
    EXPECT_EQ(families[i].name, expected[i]);
    EXPECT_EQ(static_cast<std::size_t>(families[i].family), i);
    EXPECT_EQ(parse_stress_family(expected[i]), families[i].family);
    EXPECT_EQ(stress_family_name(families[i].family), expected[i]);
    EXPECT_FALSE(families[i].stresses.empty());
    EXPECT_FALSE(families[i].knob.empty());
  }
  EXPECT_THROW(parse_stress_family("slivers"), std::invalid_argument);
}

TEST(Stress, SameArgumentsSameBits) {
  std::set<std::uint64_t> hashes;
  for (const auto& info : stress_families()) {
    const std::uint64_t h = hash_quads(make_stress(info.family, 50, 9));
    EXPECT_EQ(h, hash_quads(make_stress(info.family, 50, 9))) << info.name;
    EXPECT_TRUE(hashes.insert(h).second) << info.name;
    EXPECT_TRUE(hashes.insert(hash_quads(make_stress(info.family, 50, 10))).second) << info.name;
    // A longer batch starts with the shorter one, and the attribute count does not change the geometry.
    const auto longer = make_stress(info.family, 70, 9, 1.0, 512, 512, 8);
    const auto shorter = make_stress(info.family, 50, 9, 1.0, 512, 512, 0);
    for (std::size_t i = 0; i < shorter.size(); ++i) {
      for (std::size_t k = 0; k < 4; ++k) ASSERT_TRUE(equal(longer[i].vertex[k], shorter[i].vertex[k])) << info.name;
    }
  }
}

/// The words of a drawing make the same quad again, alone or of a group, and are no more than it takes.
TEST(Stress, ADrawingIsItsWords) {
  for (const auto& info : stress_families()) {
    std::set<std::uint64_t> hashes;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
      StressDrawing drawing{0.5, seed, {}, seed % 5};
      const WindowQuad quad = draw_stress(info.family, drawing, 96, 64);
      ASSERT_FALSE(drawing.words.empty()) << info.name;
      StressDrawing again = drawing;
      again.seed = seed + 1000;  // is not asked for words
      EXPECT_EQ(hash_quads({quad}), hash_quads({draw_stress(info.family, again, 96, 64)})) << info.name;
      EXPECT_EQ(again.words, drawing.words) << info.name;
      hashes.insert(hash_quads({quad}));
      // Attempts that show nothing are left out: one takes about 24 numbers.
      const bool many_attempts = info.family == StressFamily::any_w || info.family == StressFamily::w_zero;
      EXPECT_LE(drawing.words.size(), many_attempts ? 30u : 2000u) << info.name;
      again.words.pop_back();
      const std::size_t taken = drawing.words.size();
      draw_stress(info.family, again, 96, 64);
      EXPECT_GE(again.words.size(), taken) << info.name;
    }
    EXPECT_GE(hashes.size(), 39u) << info.name;
  }
}

/// Whatever the words are, the condition of the family holds.
TEST(Stress, OtherWordsAreOfTheSameFamily) {
  Prng rng(3);
  const auto changed = [&](StressFamily family, const std::function<bool(const WindowQuad&)>& condition) {
    std::size_t moved = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      StressDrawing drawing{1, seed};
      const std::uint64_t before = hash_quads({draw_stress(family, drawing, 512, 512)});
      for (int n = 0; n < 3; ++n) drawing.words[rng.below(drawing.words.size())] = rng.next();
      const WindowQuad quad = draw_stress(family, drawing, 512, 512);
      EXPECT_TRUE(condition(quad)) << stress_family_name(family);
      moved += hash_quads({quad}) != before;
    }
    EXPECT_GT(moved, 150u) << stress_family_name(family);
  };
  const auto all = [](bool (*condition)(const WindowQuad&, std::size_t)) {
    return [condition](const WindowQuad& q) {
      return condition(q, 0) && condition(q, 1) && condition(q, 2) && condition(q, 3);
    };
  };
  changed(StressFamily::on_vertex, all([](const WindowQuad& q, std::size_t i) { return at_centre(at(q, i)); }));
  changed(StressFamily::general, all([](const WindowQuad& q, std::size_t i) { return q.vertex[i].w == 1; }));
  changed(StressFamily::w_zero, [](const WindowQuad& q) {
    return std::ranges::any_of(q.vertex, [](const WindowVertex& v) { return v.w == 0; });
  });
  changed(StressFamily::sliver, [](const WindowQuad& q) { return thickness(q) <= 2; });
}

TEST(Stress, EverySettingStaysInsideTheInputRange) {
  const auto good = [](double v) { return v == 0 || (std::abs(v) >= 0x1p-80 && std::abs(v) <= 0x1p80); };
  for (const auto& info : stress_families()) {
    for (const double knob : {0x1p-6, 1.0, 0x1p6}) {
      for (const auto& [width, height] : {std::pair{1, 1}, {7, 300}, {512, 512}, {16384, 16384}}) {
        const auto quads = make_stress(info.family, 23, 4, knob, width, height, 6);
        ASSERT_EQ(quads.size(), 23u) << info.name;
        for (std::size_t i = 0; i < quads.size(); ++i) {
          ASSERT_EQ(quads[i].id, i);
          for (std::size_t k = 0; k < 4; ++k) {
            const WindowVertex& v = quads[i].vertex[k];
            ASSERT_TRUE(good(v.x) && good(v.y) && good(v.w) && good(v.z))
                << info.name << " knob " << knob << " quad " << i;
            ASSERT_TRUE(v.x != 0 || v.y != 0 || v.w != 0) << info.name;
            ASSERT_EQ(quads[i].attribute[k].size(), 6u);
            for (std::size_t a = 0; a < 4; ++a) ASSERT_EQ(quads[i].attribute[k][a], a == k ? 1 : 0);
            for (std::size_t a = 4; a < 6; ++a) ASSERT_LE(std::abs(quads[i].attribute[k][a]), 1);
          }
        }
      }
    }
  }
  EXPECT_TRUE(make_stress(StressFamily::general, 0, 1).empty());
  EXPECT_THROW(make_stress(StressFamily::general, 1, 1, 0.0), std::invalid_argument);
  EXPECT_THROW(make_stress(StressFamily::general, 1, 1, NAN), std::invalid_argument);
  EXPECT_THROW(make_stress(StressFamily::general, 1, 1, 1, 0, 5), std::invalid_argument);
  EXPECT_THROW(make_stress(StressFamily::general, 1, 1, 1, 5, 5, 9), std::invalid_argument);
}

TEST(Stress, FamiliesShowPixels) {
  for (const auto& info : stress_families()) {
    std::size_t visible = 0;
    for (const WindowQuad& quad : make_stress(info.family, 100, 2)) {
      bool any = false;
      for (int y = 0; y < 64 && !any; ++y) {
        for (int x = 0; x < 64 && !any; ++x) any = probe_visible(quad, 8 * x + 4.5, 8 * y + 4.5);
      }
      visible += any ? 1 : 0;
    }
    std::size_t least = 5;  // small and thin quads slip between the probes
    switch (info.family) {
      case StressFamily::any_w:
      case StressFamily::eye_crossing:
      case StressFamily::eye_in_hull:
      case StressFamily::w_zero:
      case StressFamily::huge:
        least = 95;
        break;
      case StressFamily::general:
      case StressFamily::perspective:
      case StressFamily::bowtie:
      case StressFamily::near_edge:
      case StressFamily::on_edge:
      case StressFamily::long_span:
        least = 60;
        break;
      case StressFamily::tiny:
      case StressFamily::coplanar:
        least = 0;
        break;
      default:
        break;
    }
    EXPECT_GE(visible, least) << info.name;
  }
}

/// Spread of the numbers in one attribute slot, and the least of their sizes.
std::pair<double, double> spread_and_size(const WindowQuad& quad, std::size_t slot) {
  double low = 2, high = -2, size = 2;
  for (const std::vector<double>& attribute : quad.attribute) {
    low = std::min(low, attribute[slot]);
    high = std::max(high, attribute[slot]);
    size = std::min(size, std::fabs(attribute[slot]));
  }
  return {high - low, size};
}

TEST(Stress, AttributesOfOddSlotsAreCloseTogetherAndFarFromZero) {
  for (const StressFamilyInfo& info : stress_families()) {
    int tiny = 0, large = 0;
    for (const WindowQuad& quad : make_stress(info.family, 200, 1, 1, 512, 512, 8)) {
      for (const std::size_t slot : {5, 7}) {
        const auto [spread, size] = spread_and_size(quad, slot);
        EXPECT_LE(spread, 0.5);
        EXPECT_GE(size, 0.375);
        tiny += spread < 0x1p-18;
        large += spread > 0x1p-4;
      }
      EXPECT_GT(spread_and_size(quad, 4).first, 0.01);
    }
    EXPECT_GT(tiny, 50) << info.name;
    EXPECT_GT(large, 20) << info.name;
  }
}

/// z/w of every fourth quad in a small part of what others have; nothing else of them is different.
TEST(Stress, DepthsOfEveryFourthQuadAreCloseTogether) {
  const auto close = [](const WindowQuad& quad) {
    double low = 1, high = 0;
    for (const WindowVertex& v : quad.vertex) {
      low = std::min(low, v.z / v.w);
      high = std::max(high, v.z / v.w);
    }
    return high - low < 0x1p-8;
  };
  for (const StressFamily family : {StressFamily::general, StressFamily::perspective, StressFamily::shared_edge}) {
    int fourth = 0, others = 0;
    for (const WindowQuad& quad : make_stress(family, 400, 1)) {
      (quad.id % 4 == 3 ? fourth : others) += close(quad);
      for (const WindowVertex& v : quad.vertex) {
        EXPECT_GE(v.z, 0.0999999 * v.w);
        EXPECT_LE(v.z, 0.9000001 * v.w);
      }
    }
    EXPECT_EQ(fourth > 60, family != StressFamily::shared_edge);
    EXPECT_LT(others, 5);
  }
}

TEST(Prng, KnownSequenceAndRanges) {
  Prng a(1), b(1);
  for (int i = 0; i < 1000; ++i) {
    EXPECT_EQ(a.next(), b.next());
    const double u = a.uniform();
    EXPECT_EQ(u, b.uniform());
    EXPECT_TRUE(u >= 0 && u < 1);
    EXPECT_LT(a.below(7), 7u);
    const double s = a.log2_spread(-3, 2);
    EXPECT_TRUE(s >= 0.125 && s < 4);
    b = a;
  }
  // splitmix64 of 0 gives e220a8397b1dcdaf 6e789e6aa1b965f4 …; xoshiro256** returns rotl(5 · second, 7) · 9.
  EXPECT_EQ(Prng(0).next(), 0x99ec5f36cb75f2b4u);
  EXPECT_EQ(a.integer(5, 5), 5);
  EXPECT_EQ(a.integer(5, 2), 5);
}

}  // namespace
}  // namespace quadrille::golden
