// Every stress family really contains its condition; sequences are deterministic and inside the stated ranges.
#include "golden/scenes/stress.hpp"

#include "golden/scenes/test_support.hpp"
#include "model/support/prng.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

namespace quadrille::golden {
namespace {

constexpr std::size_t batch = 400;

struct Point {
  double x, y;
};

Point at(const WindowQuad& quad, std::size_t i) {
  const WindowVertex& v = quad.vertex[i & 3];
  return {v.x / v.w, v.y / v.w};
}

double cross(Point a, Point b, Point c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }
double distance(Point a, Point b) { return std::hypot(a.x - b.x, a.y - b.y); }
bool at_centre(Point p) { return p.x - std::floor(p.x) == 0.5 && p.y - std::floor(p.y) == 0.5; }
double from_centre(Point p) { return distance(p, {std::floor(p.x) + 0.5, std::floor(p.y) + 0.5}); }
bool equal(const WindowVertex& a, const WindowVertex& b) { return a.x == b.x && a.y == b.y && a.w == b.w; }
bool all_in_front(const WindowQuad& q) {
  return std::all_of(q.vertex.begin(), q.vertex.end(), [](const WindowVertex& v) { return v.w > 0; });
}

std::vector<WindowQuad> make(StressFamily family, double knob = 1) { return make_stress(family, batch, 1, knob); }

std::size_t count_if(const std::vector<WindowQuad>& quads, const std::function<bool(const WindowQuad&)>& condition) {
  return static_cast<std::size_t>(std::count_if(quads.begin(), quads.end(), condition));
}

double thickness(const WindowQuad& q) {  // area over longest side or diagonal
  double longest = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < i; ++j) longest = std::max(longest, distance(at(q, i), at(q, j)));
  }
  return (std::abs(cross(at(q, 0), at(q, 1), at(q, 2))) + std::abs(cross(at(q, 0), at(q, 2), at(q, 3)))) / 2 / longest;
}

/// Distances of the pixel centres in the viewport from the quad's edges, between their ends: at most one per column or
/// row.
template <typename Visit>
void along_edges(const WindowQuad& q, Visit visit) {
  for (std::size_t i = 0; i < 4; ++i) {
    const Point a = at(q, i), b = at(q, i + 1);
    const double length = distance(a, b);
    if (length == 0) continue;
    const bool flat = std::abs(b.x - a.x) >= std::abs(b.y - a.y);
    const double lo = flat ? std::min(a.x, b.x) : std::min(a.y, b.y),
                 hi = flat ? std::max(a.x, b.x) : std::max(a.y, b.y);
    for (double s = std::ceil(std::max(lo, 0.0) - 0.5) + 0.5; s <= std::min(hi, 512.0); ++s) {
      const double f = flat ? (s - a.x) / (b.x - a.x) : (s - a.y) / (b.y - a.y);
      const double other = flat ? a.y + f * (b.y - a.y) : a.x + f * (b.x - a.x);
      const double nearest = std::floor(other) + 0.5;
      const Point centre = flat ? Point{s, nearest} : Point{nearest, s};
      visit(cross(a, b, centre) == 0 ? 0.0 : std::abs(cross(a, b, centre)) / length);
    }
  }
}

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

TEST(Stress, GeneralHasAllShapes) {
  std::map<int, int> turns;
  for (const WindowQuad& q : make(StressFamily::general)) {
    int positive = 0;
    for (std::size_t i = 0; i < 4; ++i) positive += cross(at(q, i), at(q, i + 1), at(q, i + 2)) > 0 ? 1 : 0;
    ++turns[positive];
  }
  EXPECT_EQ(turns.size(), 5u);
  for (const auto& [positive, count] : turns) EXPECT_GT(count, 20) << positive;
}

TEST(Stress, PerspectiveReachesTheRatio) {
  for (const double knob : {0.5, 1.0, 2.0}) {
    for (const WindowQuad& q : make(StressFamily::perspective, knob)) {
      double low = q.vertex[0].w, high = low;
      for (const WindowVertex& v : q.vertex) low = std::min(low, v.w), high = std::max(high, v.w);
      EXPECT_GT(low, 0);
      EXPECT_GT(high / low, std::pow(90, knob));
      EXPECT_LT(high / low, std::pow(115, knob));
    }
  }
}

TEST(Stress, AnyWHasEverySign) {
  std::size_t positive = 0, negative = 0, zero = 0;
  for (const WindowQuad& q : make(StressFamily::any_w)) {
    for (const WindowVertex& v : q.vertex) (v.w > 0 ? positive : v.w < 0 ? negative : zero)++;
  }
  EXPECT_GT(positive, batch);
  EXPECT_GT(negative, batch / 2);
  EXPECT_GT(zero, batch / 10);
}

TEST(Stress, NearEdgesPassCloseToPixelCentres) {
  std::size_t near = 0, exact = 0;
  for (const WindowQuad& q : make(StressFamily::near_edge)) {
    along_edges(q, [&](double d) { near += d <= 0x1p-4 ? 1 : 0, exact += d == 0 ? 1 : 0; });
  }
  EXPECT_GT(near, 20 * batch);
  EXPECT_LT(exact, near / 100);
}

TEST(Stress, OnEdgesPassThroughPixelCentres) {
  std::size_t exact = 0, corners = 0;
  for (const WindowQuad& q : make(StressFamily::on_edge)) {
    std::size_t own = 0;
    along_edges(q, [&](double d) { own += d == 0 ? 1 : 0; });
    EXPECT_GT(own, 0u);
    exact += own;
    for (std::size_t i = 0; i < 4; ++i) corners += at_centre(at(q, i)) ? 1 : 0;
  }
  EXPECT_GT(exact, 20 * batch);
  EXPECT_GT(corners, batch);
  EXPECT_LT(corners, 3 * batch);
}

TEST(Stress, NearVertexCornersAreNearPixelCentres) {
  std::size_t close = 0;
  for (const WindowQuad& q : make(StressFamily::near_vertex)) {
    for (std::size_t i = 0; i < 4; ++i) {
      const double d = from_centre(at(q, i));
      EXPECT_LT(d, 0.72);
      EXPECT_GT(d, 0);
      close += d < 0x1p-4 ? 1 : 0;
    }
  }
  EXPECT_GT(close, 2 * batch);
}

TEST(Stress, OnVertexCornersAreAtPixelCentres) {
  for (const WindowQuad& q : make(StressFamily::on_vertex)) {
    for (std::size_t i = 0; i < 4; ++i) EXPECT_TRUE(at_centre(at(q, i)));
  }
}

TEST(Stress, SliversAreThin) {
  for (const double knob : {0.25, 1.0}) {
    EXPECT_EQ(count_if(make(StressFamily::sliver, knob), [&](const WindowQuad& q) { return thickness(q) <= 2 * knob; }),
              batch);
  }
}

TEST(Stress, CollapsedEdges) {
  const auto quads = make(StressFamily::collapsed_edge);
  const auto shortest = [](const WindowQuad& q) {
    double s = 1e9;
    for (std::size_t i = 0; i < 4; ++i) s = std::min(s, distance(at(q, i), at(q, i + 1)));
    return s;
  };
  const std::size_t exact = count_if(quads, [&](const WindowQuad& q) { return shortest(q) == 0; });
  EXPECT_EQ(count_if(quads, [&](const WindowQuad& q) { return shortest(q) <= 1 + 1e-9; }), batch);
  EXPECT_GT(exact, batch * 6 / 10);
  EXPECT_LT(exact, batch * 9 / 10);
}

TEST(Stress, StraightCorners) {
  std::size_t straight = 0, nearly = 0;
  for (const WindowQuad& q : make(StressFamily::straight_corner)) {
    bool exact = false, close = false;
    for (std::size_t i = 0; i < 4; ++i) {
      const double c = cross(at(q, i), at(q, i + 1), at(q, i + 2));
      exact = exact || c == 0;
      close = close || std::abs(c) <= 0.03 * distance(at(q, i), at(q, i + 2));
    }
    straight += exact ? 1 : 0;
    nearly += close ? 1 : 0;
  }
  EXPECT_EQ(nearly, batch);
  EXPECT_GT(straight, batch * 4 / 10);
  EXPECT_LT(straight, batch * 6 / 10);
}

TEST(Stress, ReflexCorners) {
  for (const WindowQuad& q : make(StressFamily::reflex)) {
    int positive = 0;
    for (std::size_t i = 0; i < 4; ++i) positive += cross(at(q, i), at(q, i + 1), at(q, i + 2)) > 0 ? 1 : 0;
    EXPECT_TRUE(positive == 1 || positive == 3) << positive;
  }
}

TEST(Stress, BowtiesCross) {
  std::size_t exact = 0;
  for (const WindowQuad& q : make(StressFamily::bowtie)) {
    bool crossed = false;
    for (std::size_t i = 0; i < 2; ++i) {
      const Point a = at(q, i), b = at(q, i + 1), c = at(q, i + 2), d = at(q, i + 3);
      if (cross(a, b, c) * cross(a, b, d) >= 0 || cross(c, d, a) * cross(c, d, b) >= 0) continue;
      crossed = true;
      const double s = cross(c, d, a) / (cross(c, d, a) - cross(c, d, b));
      const Point p{a.x + s * (b.x - a.x), a.y + s * (b.y - a.y)};
      const Point centre{std::floor(p.x) + 0.5, std::floor(p.y) + 0.5};
      exact += cross(a, b, centre) == 0 && cross(c, d, centre) == 0 ? 1 : 0;
    }
    EXPECT_TRUE(crossed);
  }
  EXPECT_GT(exact, batch * 4 / 10);
  EXPECT_LT(exact, batch * 6 / 10);
}

TEST(Stress, TinyQuads) {
  for (const WindowQuad& q : make(StressFamily::tiny)) {
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_LE(std::abs(at(q, i).x - at(q, 0).x), 4);
      EXPECT_LE(std::abs(at(q, i).y - at(q, 0).y), 4);
    }
  }
}

TEST(Stress, HugeQuadsLeaveTheGuardBand) {
  for (const WindowQuad& q : make(StressFamily::huge)) {
    double farthest = 0;
    for (std::size_t i = 0; i < 4; ++i) farthest = std::max({farthest, std::abs(at(q, i).x), std::abs(at(q, i).y)});
    EXPECT_GT(farthest, 32768);
  }
}

TEST(Stress, EyeCrossingQuadsHaveBothSignsAndNoEyeInside) {
  std::array<int, 4> behind{};
  for (const WindowQuad& q : make(StressFamily::eye_crossing)) {
    const auto n = std::count_if(q.vertex.begin(), q.vertex.end(), [](const WindowVertex& v) { return v.w < 0; });
    ASSERT_TRUE(n >= 1 && n <= 3);
    ++behind[static_cast<std::size_t>(n)];
    EXPECT_FALSE(holds_eye(q));
  }
  for (std::size_t n = 1; n <= 3; ++n) EXPECT_GT(behind[n], 20) << n;
}

TEST(Stress, EyeInHull) {
  const auto quads = make(StressFamily::eye_in_hull);
  EXPECT_EQ(count_if(quads, holds_eye), batch);
}

TEST(Stress, WZeroIsExact) {
  std::size_t two = 0;
  for (const WindowQuad& q : make(StressFamily::w_zero)) {
    const auto n = std::count_if(q.vertex.begin(), q.vertex.end(), [](const WindowVertex& v) { return v.w == 0; });
    EXPECT_TRUE(n == 1 || n == 2);
    two += n == 2 ? 1 : 0;
  }
  EXPECT_GT(two, batch / 20);
}

std::size_t shared_corner_pairs(const WindowQuad& a, const WindowQuad& b) {
  std::size_t shared = 0;
  for (const WindowVertex& u : a.vertex) {
    for (const WindowVertex& v : b.vertex) shared += equal(u, v) && u.z == v.z ? 1 : 0;
  }
  return shared;
}

TEST(Stress, SharedEdgesAndVertices) {
  const auto strips = make(StressFamily::shared_edge), fans = make(StressFamily::shared_vertex);
  std::size_t edges = 0, vertices = 0, hubs = 0;
  for (std::size_t i = 0; i + 1 < batch; ++i) {
    edges += shared_corner_pairs(strips[i], strips[i + 1]) >= 2 ? 1 : 0;
    vertices += shared_corner_pairs(fans[i], fans[i + 1]) >= 2 ? 1 : 0;
    if (i + 2 < batch) hubs += shared_corner_pairs(fans[i], fans[i + 2]) >= 1 ? 1 : 0;
  }
  EXPECT_GT(edges, batch * 7 / 10);
  EXPECT_GT(vertices, batch * 6 / 10);
  EXPECT_GT(hubs, batch * 4 / 10);
  EXPECT_EQ(count_if(strips, all_in_front) + count_if(fans, all_in_front), 2 * batch);
}

TEST(Stress, CoplanarWithTheEye) {
  std::size_t exact = 0, mixed = 0;
  for (const WindowQuad& q : make(StressFamily::coplanar)) {
    const bool line = cross(at(q, 0), at(q, 1), at(q, 2)) == 0 && cross(at(q, 0), at(q, 2), at(q, 3)) == 0 &&
                      cross(at(q, 0), at(q, 1), at(q, 3)) == 0;
    exact += line ? 1 : 0;
    mixed += all_in_front(q) ? 0 : 1;
    EXPECT_LT(thickness(q), 0.02);
  }
  EXPECT_GT(exact, batch * 4 / 10);
  EXPECT_LT(exact, batch * 6 / 10);
  EXPECT_GT(mixed, batch / 6);
}

TEST(Stress, LongSpans) {
  EXPECT_EQ(count_if(make(StressFamily::long_span),
                     [](const WindowQuad& q) {
                       double x0 = 1e9, x1 = -1e9, y0 = 1e9, y1 = -1e9;
                       for (std::size_t i = 0; i < 4; ++i) {
                         x0 = std::min(x0, at(q, i).x), x1 = std::max(x1, at(q, i).x);
                         y0 = std::min(y0, at(q, i).y), y1 = std::max(y1, at(q, i).y);
                       }
                       return (x0 <= 1e-9 && x1 >= 512 - 1e-9) || (y0 <= 1e-9 && y1 >= 512 - 1e-9);
                     }),
            batch);
}

TEST(Stress, CoincidentCorners) {
  std::map<int, int> pairs;
  for (const WindowQuad& q : make(StressFamily::coincident)) {
    int equal_pairs = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < i; ++j)
        equal_pairs += equal(q.vertex[i], q.vertex[j]) && q.vertex[i].z == q.vertex[j].z ? 1 : 0;
    }
    ++pairs[equal_pairs];
  }
  EXPECT_EQ(pairs.size(), 4u);  // one pair, two pairs, three equal (3), four equal (6)
  EXPECT_FALSE(pairs.contains(0));
  for (const int n : {1, 2, 3, 6}) EXPECT_GT(pairs[n], 10) << n;
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
