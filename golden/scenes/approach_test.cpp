// Every approach comes as near to its special case as its knob says, from both sides, and reaches it exactly; nothing
// else about a quad changes on the way.
#include "golden/scenes/approach.hpp"

#include "model/config.hpp"
#include "model/quad_setup.hpp"
#include "model/snap.hpp"
#include "model/untimed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>

namespace quadrille::golden {
namespace {

constexpr std::size_t count = 40;
constexpr std::uint64_t seed = 3;

struct Point {
  double x, y;
};

Point at(const WindowQuad& quad, std::size_t i) {
  const WindowVertex& v = quad.vertex[i & 3];
  return {v.x / v.w, v.y / v.w};
}
double cross(Point a, Point b, Point c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }
double length(Point a, Point b) { return std::hypot(a.x - b.x, a.y - b.y); }

/// Of the pixel centre of the viewport that is nearest to the line ab, from it.
double nearest_centre(Point a, Point b, const Approach& approach) {
  double nearest = 1e9;
  for (int y = 0; y < approach.height; ++y)
    for (int x = 0; x < approach.width; ++x)
      nearest = std::min(nearest, std::fabs(cross(a, b, {x + 0.5, y + 0.5})) / length(a, b));
  return nearest;
}

/// How far the quad is from the special case.
double distance(const Approach& approach, const WindowQuad& q) {
  const auto centre_of = [](Point p) { return Point{std::floor(p.x) + 0.5, std::floor(p.y) + 0.5}; };
  if (approach.name == "edge_distance") return nearest_centre(at(q, 0), at(q, 1), approach);
  if (approach.name == "vertex_distance") {  // of half a pixel either centre is one
    const Point p = at(q, 0);
    double nearest = 1e9;
    for (const double dx : {-1.0, 0.0, 1.0})
      for (const double dy : {-1.0, 0.0, 1.0})
        nearest = std::min(nearest, length(p, {centre_of(p).x + dx, centre_of(p).y + dy}));
    return nearest;
  }
  if (approach.name == "crossing")
    return std::max(nearest_centre(at(q, 0), at(q, 1), approach), nearest_centre(at(q, 2), at(q, 3), approach));
  if (approach.name == "sliver_thickness") return length(at(q, 1), at(q, 2));
  if (approach.name == "edge_length") return length(at(q, 0), at(q, 1));
  if (approach.name == "diagonal_distance")
    return std::fabs(cross(at(q, 0), at(q, 2), at(q, 1))) / length(at(q, 0), at(q, 2));
  if (approach.name == "eye_plane") return std::fabs(q.vertex[1].w);
  if (approach.name == "coincident_w") return std::fabs(q.vertex[1].w / q.vertex[0].w - 1);
  return -1;
}

TEST(Approach, ComesAsNearAsItsKnobSays) {
  for (const Approach& approach : approaches()) {
    for (int knob = approach.first; knob <= approach.last; ++knob)
      for (const int side : {-1, 1}) {
        if (side < 0 && !approach.both_sides) continue;
        for (const WindowQuad& quad : make_approach(approach, knob, side, count, seed, 1)) {
          const double d = distance(approach, quad);
          if (d < 0) continue;
          EXPECT_LE(d, (approach.name == "crossing" ? 4.48 : 2.24) * std::ldexp(1.0, -knob))
              << approach.name << " knob " << knob << " quad " << quad.id;
          // A line meets other centres too, and a pixel aside is another centre.
          if (approach.name != "edge_distance" && approach.name != "crossing" && knob > 0) {
            EXPECT_GE(d, std::min(0.25, 0.9 * std::ldexp(1.0, -knob)))
                << approach.name << " knob " << knob << " quad " << quad.id;
          }
        }
      }
    if (!approach.limit) continue;
    for (const WindowQuad& quad : make_approach(approach, approach.last, 0, count, seed, 1))
      EXPECT_LE(distance(approach, quad), 0) << approach.name << " quad " << quad.id;
  }
}

/// Snapping keeps the special case exactly: edges through centres have A = 0 there, the eye is in the hull's face.
TEST(Approach, TheSpecialCaseIsExactAtThePort) {
  const Config config;
  for (const Approach& approach : approaches()) {
    if (!approach.limit) continue;
    DrawState state;
    state.width = state.scissor_x1 = approach.width;
    state.height = state.scissor_y1 = approach.height;
    state.attributes = 1;
    UntimedModel model(config, state);
    std::size_t hulls = 0;
    for (const WindowQuad& quad : make_approach(approach, approach.last, 0, count, seed, 1)) {
      const SnappedQuad snapped = snap_quad(quad, config, state);
      model.draw(snapped, [](std::span<const Fragment>) {});
      hulls += quad_setup(snapped, config, state).hull;
    }
    const DrawStats& drawn = model.stats();
    if (approach.name == "edge_distance") {
      EXPECT_GT(drawn.on_edge, 10u);
    }
    if (approach.name == "vertex_distance") {
      EXPECT_GT(drawn.on_vertex, 5u);
    }
    if (approach.name == "crossing") {
      EXPECT_GT(drawn.two_edge, 2u);
    }
    if (approach.name == "coincident_w") {
      EXPECT_GT(drawn.two_corner, 2u);
    }
    if (approach.name == "eye_face") {
      EXPECT_EQ(hulls, count);
    }
    if (approach.name == "sliver_thickness") {
      EXPECT_EQ(drawn.fragments, 0u);
    }
  }
}

TEST(Approach, TheEyeIsInTheHullOnOneSideOfAFace) {
  const Config config;
  const DrawState state;
  const Approach& approach = *find_approach("eye_face");
  for (int knob = approach.first; knob <= approach.last; ++knob)
    for (const int side : {-1, 1}) {
      std::size_t hulls = 0;
      for (const WindowQuad& quad : make_approach(approach, knob, side, count, seed, 0))
        hulls += quad_setup(snap_quad(quad, config, state), config, state).hull;
      EXPECT_EQ(hulls, side > 0 ? count : 0u) << "knob " << knob << " side " << side;
    }
}

TEST(Approach, OneQuadAllTheWay) {
  std::set<std::string> names;
  for (const Approach& approach : approaches()) {
    EXPECT_TRUE(names.insert(std::string(approach.name)).second);
    EXPECT_EQ(find_approach(approach.name), &approach);
    const auto first = make_approach(approach, approach.first, 1, count, seed, 2);
    const auto again = make_approach(approach, approach.first, 1, count / 2, seed, 2);
    const auto last = make_approach(approach, approach.last, 1, count, seed, 2);
    for (std::size_t i = 0; i < count; ++i) {
      ASSERT_EQ(first[i].id, i);
      for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_EQ(first[i].attribute[k], last[i].attribute[k]) << approach.name;
        if (i < count / 2) {
          EXPECT_EQ(first[i].vertex[k].x, again[i].vertex[k].x) << approach.name;
        }
      }
    }
    EXPECT_THROW(make_approach(approach, approach.last + 1, 1, 1, 1, 0), std::invalid_argument);
    EXPECT_THROW(make_approach(approach, approach.first, 2, 1, 1, 0), std::invalid_argument);
  }
  EXPECT_EQ(find_approach("edge"), nullptr);
}

}  // namespace
}  // namespace quadrille::golden
