#include "golden/scenes/stress.hpp"
#include "golden/scenes/stress_test_support.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <map>

namespace quadrille::golden {
namespace {

constexpr std::size_t batch = 400;

std::vector<WindowQuad> make(StressFamily family, double knob = 1) { return make_stress(family, batch, 1, knob); }

std::size_t count_if(const std::vector<WindowQuad>& quads, const std::function<bool(const WindowQuad&)>& condition) {
  return static_cast<std::size_t>(std::count_if(quads.begin(), quads.end(), condition));
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

}  // namespace
}  // namespace quadrille::golden
