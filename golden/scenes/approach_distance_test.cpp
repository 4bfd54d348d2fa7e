#include "golden/scenes/approach_test_support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace quadrille::golden {
namespace {

double cross(Point a, Point b, Point c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }
double length(Point a, Point b) { return std::hypot(a.x - b.x, a.y - b.y); }
double from_line(Point p, Point a, Point b) { return cross(a, b, p) / length(a, b); }
/// Of the angle between a and b as seen from p.
double cosine(Point p, Point a, Point b) {
  return ((a.x - p.x) * (b.x - p.x) + (a.y - p.y) * (b.y - p.y)) / (length(a, p) * length(b, p));
}

/// How far a quad is from the special case, and what that is at the knob k: between least and most, times 2^-k.
struct Distance {
  double (*of)(const Approaching&);
  double least, most;
  bool is_signed;  ///< the sides are those of 0
};

double lines_apart(const Approaching& a) {
  return std::max(std::fabs(from_line(a.pixel(), a.at(0), a.at(1))), std::fabs(from_line(a.pixel(), a.at(2), a.at(3))));
}

/// Homogeneous: of two vertices that are one point of the picture or opposite ones, 0.
double line_through(const WindowVertex& a, const WindowVertex& b) {
  return std::hypot(a.y * b.w - b.y * a.w, a.x * b.w - b.x * a.w);
}

double largest_w_ratio(const Approaching& a) {
  const auto [low, high] = std::ranges::minmax(a.quad.vertex, {}, [](const WindowVertex& v) { return v.w; });
  return low.w / high.w;
}

double beyond_guard_band(const Approaching& a) {
  const Point p = a.at(0);
  return std::max(std::fabs(p.x - 0.5), std::fabs(p.y - 0.5)) - 0x1p15;
}

double depth_spread(const Approaching& a) {
  const auto depth = [](const WindowVertex& v) { return v.z / v.w; };
  const auto [low, high] = std::ranges::minmax_element(a.quad.vertex, {}, depth);
  return depth(*high) - depth(*low);
}

const std::map<std::string_view, Distance> distances{
    // Below the grid J / (N - 1), where the knob says N >= 2^12.
    {"edge_distance", {[](const Approaching& a) { return from_line(a.pixel(), a.at(0), a.at(1)); }, 0.7, 1.0003, true}},
    {"edge_line", {[](const Approaching& a) { return from_line(a.pixel(), a.at(0), a.at(1)); }, 0.7, 1.0003, true}},
    {"right_angle_edge", {[](const Approaching& a) { return cosine(a.pixel(), a.at(0), a.at(1)); }, 0.66, 2, true}},
    {"right_angle_diagonal", {[](const Approaching& a) { return cosine(a.pixel(), a.at(0), a.at(2)); }, 0.66, 2, true}},
    {"vertex_distance", {[](const Approaching& a) { return length(a.pixel(), a.at(0)); }, 1, 2.24, false}},
    {"crossing", {lines_apart, 1, 4.48, false}},
    {"sliver_thickness", {[](const Approaching& a) { return length(a.at(1), a.at(2)); }, 1, 1, false}},
    {"edge_length", {[](const Approaching& a) { return length(a.at(0), a.at(1)); }, 1, 2.24, false}},
    {"opposite_distance", {[](const Approaching& a) { return length(a.at(0), a.at(2)); }, 2.23, 5, false}},
    {"diagonal_distance", {[](const Approaching& a) { return from_line(a.at(1), a.at(0), a.at(2)); }, 1, 2.24, true}},
    {"eye_plane", {[](const Approaching& a) { return a.vertex(1).w; }, 1, 1, true}},
    {"eye_face", {[](const Approaching& a) { return -a.vertex(3).w - 1; }, 1, 1, true}},
    {"eye_edge", {[](const Approaching& a) { return line_through(a.vertex(0), a.vertex(1)); }, 11.3, 34, false}},
    {"eye_diagonal", {[](const Approaching& a) { return line_through(a.vertex(0), a.vertex(2)); }, 11.3, 34, false}},
    {"guard_band", {beyond_guard_band, 1, 1, true}},
    {"guard_band_flat", {beyond_guard_band, 1, 1, false}},
    {"value_spread", {depth_spread, 1, 1, false}},
    {"depth_limit",
     {[](const Approaching& a) {
        const double z = a.vertex(0).z / a.vertex(0).w;
        return z < 0.5 ? z : 1 - z;
      },
      1, 1, true}},
    {"coincident_w", {[](const Approaching& a) { return a.vertex(1).w / a.vertex(0).w - 1; }, 1, 1, true}},
    {"w_ratio", {largest_w_ratio, 1, 1, false}},
    {"long_edge", {[](const Approaching& a) { return 1 / std::fabs(a.at(0).x - a.at(1).x); }, 1, 1, false}},
    {"long_edge_down", {[](const Approaching& a) { return 1 / std::fabs(a.at(0).y - a.at(1).y); }, 1, 1, false}},
    {"long_edge_behind", {[](const Approaching& a) { return 1 / std::fabs(a.at(0).x - a.at(2).x); }, 1, 1, false}},
};

TEST(Approach, ComesAsNearAsItsKnobSays) {
  for (const auto& [name, distance] : distances) EXPECT_NE(find_approach(name), nullptr) << name;
  each_step([](const Approach& approach, int knob, int side) {
    ASSERT_TRUE(distances.contains(approach.name)) << approach.name;
    const Distance& distance = distances.at(approach.name);
    const auto quads = make_approach(approach, knob, side, count, seed, 1);
    const auto places = approach_places(approach, knob, side, count, seed);
    const auto others = approach.both_sides ? make_approach(approach, knob, -side, count, seed, 1) : quads;
    constexpr double rounding = 1e-9;  // of the distances here
    for (std::size_t i = 0; i < count; ++i) {
      const double d = distance.of({quads[i], places[i]}), unit = std::ldexp(1.0, -knob);
      EXPECT_LE(std::fabs(d), (distance.most + rounding) * unit) << text(approach, knob, side) << " quad " << i;
      EXPECT_GE(std::fabs(d), (distance.least - rounding) * unit) << text(approach, knob, side) << " quad " << i;
      if (distance.is_signed) {
        EXPECT_LT(d * distance.of({others[i], places[i]}), 0) << text(approach, knob, side) << " quad " << i;
      }
    }
  });
  for (const Approach& approach : approaches()) {
    if (!approach.limit) continue;
    const auto quads = make_approach(approach, approach.last, 0, count, seed, 1);
    const auto same = make_approach(approach, approach.first, 0, count, seed, 1);
    const auto places = approach_places(approach, approach.last, 0, count, seed);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(distances.at(approach.name).of({quads[i], places[i]}), 0) << approach.name << " quad " << i;
      for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_EQ(quads[i].vertex[k].x, same[i].vertex[k].x) << approach.name << " quad " << i;
        EXPECT_EQ(quads[i].vertex[k].y, same[i].vertex[k].y) << approach.name << " quad " << i;
      }
    }
  }
}

}  // namespace
}  // namespace quadrille::golden
