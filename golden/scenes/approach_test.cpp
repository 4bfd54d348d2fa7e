// Every approach comes as near to its special case as its knob says, from both sides, and reaches it exactly; pixels
// are drawn there; nothing else about a quad changes on the way.
#include "golden/scenes/approach_test_support.hpp"
#include "model/front/quad_setup.hpp"
#include "model/port/config.hpp"
#include "model/port/snap.hpp"
#include "model/untimed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

namespace quadrille::golden {
namespace {

TEST(Approach, NearIsACircleOfPixelCentres) {
  ApproachPlace place;
  EXPECT_TRUE(place.is_near(0, 0));
  EXPECT_TRUE(place.is_near(4095, 4095));
  place.near_x = 8.5;
  place.near_y = 3.5;
  place.near_radius = 0;
  EXPECT_TRUE(place.is_near(8, 3));
  EXPECT_FALSE(place.is_near(8, 4));
  EXPECT_FALSE(place.is_near(3, 8));
  place.near_radius = 1;
  EXPECT_TRUE(place.is_near(8, 4));
  EXPECT_FALSE(place.is_near(9, 4));
}

DrawState draw_state(const Approach& approach) {
  DrawState state;
  state.width = state.scissor_x1 = approach.width;
  state.height = state.scissor_y1 = approach.height;
  state.attributes = 1;
  return state;
}

/// What was drawn of a quad near its special case.
struct Near {
  std::size_t pixels = 0, singular = 0;
};

std::vector<Near> draw_near(const Approach& approach, int knob, int side, DrawStats* stats = nullptr) {
  constexpr unsigned singular = flag_on_edge | flag_on_vertex | flag_two_corner | flag_two_edge;
  const Config config;
  const DrawState state = draw_state(approach);
  UntimedModel model(config, state);
  const auto places = approach_places(approach, knob, side, count, seed);
  std::vector<Near> near(count);
  for (const WindowQuad& quad : make_approach(approach, knob, side, count, seed, 1))
    model.draw(snap_quad(quad, config, state), [&](std::span<const Fragment> fragments) {
      for (const Fragment& f : fragments) {
        if (!places[f.quad].is_near(f.x, f.y)) continue;
        ++near[f.quad].pixels;
        near[f.quad].singular += (f.flags & singular) != 0;
      }
    });
  if (stats != nullptr) *stats = model.stats();
  return near;
}

/// Of every step at least half of the quads have a pixel near the special case that is drawn and no case of its own.
/// The pixel of edge_distance is inside on one side only, so that a third is asked for.
TEST(Approach, PixelsNearTheCaseAreDrawn) {
  each_step([](const Approach& approach, int knob, int side) {
    const auto near = draw_near(approach, knob, side);
    const auto shown = std::ranges::count_if(near, [](const Near& n) { return n.pixels > n.singular; });
    EXPECT_GE(shown, static_cast<long>(approach.name == "edge_distance" ? count / 3 : count / 2))
        << text(approach, knob, side);
  });
}

/// S of a snapped vertex at a pixel: X - W x and Y - W y.
std::array<std::int64_t, 2> seen_from(const SnappedVertex& v, const ApproachPlace& place) {
  const auto x = static_cast<std::int64_t>(std::floor(place.near_x)),
             y = static_cast<std::int64_t>(std::floor(place.near_y));
  return {v.x - v.w * x, v.y - v.w * y};
}

/// Snapping with the standard configuration keeps the special case exactly, and on the way to it what is 0 there is not
/// yet: A, D, a distance of corners, of homogeneous vectors.
TEST(Approach, TheSpecialCaseIsExactAtThePort) {
  const Config config;
  /// 0 at the special case; of the corners in the approach's order. Given as a function of what the machine sees.
  using Port = std::function<std::int64_t(const std::array<SnappedVertex, 4>&, const ApproachPlace&)>;
  const auto area = [](std::size_t i, std::size_t j) -> Port {
    return [i, j](const auto& v, const ApproachPlace& place) {
      const auto a = seen_from(v[i], place), b = seen_from(v[j], place);
      return a[0] * b[1] - a[1] * b[0];
    };
  };
  const auto dot = [](std::size_t i, std::size_t j) -> Port {
    return [i, j](const auto& v, const ApproachPlace& place) {
      const auto a = seen_from(v[i], place), b = seen_from(v[j], place);
      return a[0] * b[0] + a[1] * b[1];
    };
  };
  const auto apart = [](std::size_t i, std::size_t j) -> Port {
    return [i, j](const auto& v, const ApproachPlace&) -> std::int64_t {
      return std::abs(v[i].x - v[j].x) + std::abs(v[i].y - v[j].y);
    };
  };
  const auto line = [](std::size_t i, std::size_t j) -> Port {
    return [i, j](const auto& v, const ApproachPlace&) {
      const std::int64_t a = std::int64_t{v[i].y} * v[j].w - std::int64_t{v[j].y} * v[i].w,
                         b = std::int64_t{v[i].x} * v[j].w - std::int64_t{v[j].x} * v[i].w;
      return std::abs(a) + std::abs(b);
    };
  };
  const std::map<std::string_view, Port> ports{
      {"edge_distance", area(0, 1)},
      {"edge_line", area(0, 1)},
      {"right_angle_edge", dot(0, 1)},
      {"right_angle_diagonal", dot(0, 2)},
      {"edge_length", apart(0, 1)},
      {"opposite_distance", apart(0, 2)},
      {"eye_edge", line(0, 1)},
      {"eye_diagonal", line(0, 2)},
      {"vertex_distance",
       [](const auto& v, const ApproachPlace& place) {
         const auto s = seen_from(v[0], place);
         return std::abs(s[0]) + std::abs(s[1]);
       }},
      {"eye_plane", [](const auto& v, const ApproachPlace&) -> std::int64_t { return v[1].w; }},
  };
  for (const auto& entry : ports) {
    const std::string_view name = entry.first;
    const Port& port = entry.second;
    const Approach& approach = *find_approach(name);
    const DrawState state = draw_state(approach);
    const auto values = [&](int knob, int side) {
      std::vector<std::int64_t> out;
      const auto places = approach_places(approach, knob, side, count, seed);
      for (const WindowQuad& quad : make_approach(approach, knob, side, count, seed, 1)) {
        const SnappedQuad snapped = snap_quad(quad, config, state);
        const ApproachPlace& place = places[quad.id];
        std::array<SnappedVertex, 4> v;
        for (std::size_t i = 0; i < 4; ++i) v[i] = snapped.vertex[place.corner[i]];
        out.push_back(port(v, place));
        if (name == "edge_line") {
          EXPECT_GT(dot(0, 1)(v, place), 0) << text(approach, knob, side);
        }
        if (name == "edge_distance") {
          EXPECT_LT(dot(0, 1)(v, place), 0) << text(approach, knob, side);
        }
      }
      return out;
    };
    for (const std::int64_t value : values(approach.last, 0)) EXPECT_EQ(value, 0) << name;
    for (int knob = approach.first; knob <= approach.last; ++knob)
      for (const int side : sides_of(approach))
        for (const std::int64_t value : values(knob, side)) {
          EXPECT_NE(value, 0) << text(approach, knob, side);
        }
  }
}

/// What the machine says of the special cases that it knows.
TEST(Approach, TheMachineSeesTheSpecialCase) {
  const auto drawn = [](std::string_view name) {
    const Approach& approach = *find_approach(name);
    DrawStats stats;
    draw_near(approach, approach.last, 0, &stats);
    return stats;
  };
  EXPECT_GT(drawn("edge_distance").on_edge, 10u);
  EXPECT_GT(drawn("vertex_distance").on_vertex, 5u);
  EXPECT_GT(drawn("crossing").two_edge, 2u);
  EXPECT_GT(drawn("coincident_w").two_corner, 2u);
  EXPECT_EQ(drawn("sliver_thickness").fragments, 0u);
}

TEST(Approach, TheEyeIsInTheHullOnOneSideOfAFace) {
  const Config config;
  const DrawState state;
  const Approach& approach = *find_approach("eye_face");
  const auto hulls = [&](int knob, int side) {
    std::size_t sum = 0;
    for (const WindowQuad& quad : make_approach(approach, knob, side, count, seed, 0))
      sum += quad_setup(snap_quad(quad, config, state), config, state).hull;
    return sum;
  };
  for (int knob = approach.first; knob <= approach.last; ++knob)
    for (const int side : {-1, 1}) EXPECT_EQ(hulls(knob, side), side > 0 ? count : 0u) << text(approach, knob, side);
  EXPECT_EQ(hulls(approach.last, 0), count);
}

/// Within the guard band a corner is ordinary, at its limit and beyond it is scaled to the limit.
TEST(Approach, TheGuardBandEndsAtItsLimit) {
  const Config config;
  const DrawState state;
  const Approach& approach = *find_approach("guard_band");
  for (int knob = approach.first; knob <= approach.last; ++knob)
    for (const int side : {-1, 0, 1}) {
      const auto places = approach_places(approach, knob, side, count, seed);
      for (const WindowQuad& quad : make_approach(approach, knob, side, count, seed, 0)) {
        const SnappedQuad snapped = snap_quad(quad, config, state);
        const SnappedVertex& v = snapped.vertex[places[quad.id].corner[0]];
        EXPECT_EQ(std::max(std::abs(v.x), std::abs(v.y)) == 1 << (config.pos_int() + config.frac()), side >= 0)
            << text(approach, knob, side);
        if (side < 0) {
          EXPECT_TRUE(has_ordinary_vertices(snapped, config)) << text(approach, knob, side);
        } else if (side > 0 && knob < 0) {
          EXPECT_FALSE(has_ordinary_vertices(snapped, config)) << text(approach, knob, side);
        }
      }
    }
}

/// Attributes are spread as depths are, from the whole range to nothing, and far from 0 at the base or its opposite.
TEST(Approach, AttributesAreSpreadFarFromZero) {
  const Approach& approach = *find_approach("value_spread");
  int negative = 0;
  for (int knob = approach.first; knob <= approach.last; ++knob)
    for (const int side : {0, 1}) {
      const auto places = approach_places(approach, knob, side, count, seed);
      for (const WindowQuad& quad : make_approach(approach, knob, side, count, seed, 2)) {
        const auto value = [&](std::size_t corner, std::size_t slot) {
          return quad.attribute[places[quad.id].corner[corner]][slot];
        };
        const double base = value(0, 0);
        double spread = 0;
        for (std::size_t i = 0; i < 4; ++i) {
          EXPECT_EQ(value(i, 1), -value(i, 0));
          EXPECT_LE(std::fabs(value(i, 0)), std::fabs(base));
          spread = std::max(spread, std::fabs(value(i, 0) - base));
        }
        EXPECT_GE(std::fabs(base), 100);
        EXPECT_LE(std::fabs(base), approach.attribute);
        EXPECT_NEAR(spread, side == 0 ? 0 : 2 * std::fabs(base) * std::ldexp(1.0, -knob), 1e-13);
        negative += base < 0;
      }
    }
  EXPECT_GT(negative, 500);
}

/// No pixel is lost of a quad of one depth, however far beyond the guard band a corner is.
TEST(Approach, OneDepthIsOneDepthFarAway) {
  const Config config;
  const Approach& approach = *find_approach("guard_band_flat");
  DrawState state = draw_state(approach);
  const auto drawn = [&](const WindowQuad& quad, double depth) {
    const double code = std::floor(std::ldexp(depth, config.depth_bits) + 0.5);
    state.znear = state.zfar = std::ldexp(code, -config.depth_bits);
    std::size_t pixels = 0;
    UntimedModel model(config, state);
    model.draw(snap_quad(quad, config, state), [&](std::span<const Fragment> f) { pixels += f.size(); });
    return pixels;
  };
  std::size_t all = 0;
  for (int knob = approach.first; knob <= approach.last; knob += 4)
    for (const WindowQuad& quad : make_approach(approach, knob, 1, count, seed, 1)) {
      const double depth = quad.vertex[0].z / quad.vertex[0].w;
      const std::size_t within = drawn(quad, depth);
      state.depth = false;
      EXPECT_EQ(within, drawn(quad, depth)) << "knob " << knob << " quad " << quad.id;
      state.depth = true;
      all += within;
    }
  EXPECT_GT(all, 10'000u);
}

/// The special corners are any of the quad, in either order, and the window is turned and mirrored.
TEST(Approach, EveryCornerIsApproached) {
  for (const Approach& approach : approaches()) {
    std::set<std::size_t> corners;
    std::set<std::pair<std::size_t, std::size_t>> edges;
    for (const ApproachPlace& place : approach_places(approach, approach.first, 1, count, seed)) {
      EXPECT_EQ(std::set(place.corner.begin(), place.corner.end()).size(), 4u) << approach.name;
      corners.insert(place.corner[0]);
      edges.insert({place.corner[0], place.corner[1]});
    }
    EXPECT_EQ(corners.size(), 4u) << approach.name;
    EXPECT_GE(edges.size(), 8u) << approach.name;
  }
  const Approach& approach = *find_approach("edge_distance");
  std::set<std::pair<double, double>> directions;
  const auto quads = make_approach(approach, approach.first, 1, count, seed, 1);
  const auto places = approach_places(approach, approach.first, 1, count, seed);
  for (std::size_t i = 0; i < count; ++i) {
    const Approaching a{quads[i], places[i]};
    const double x = a.at(1).x - a.at(0).x, y = a.at(1).y - a.at(0).y;
    directions.insert({(x > 0) - (x < 0), (y > 0) - (y < 0)});
  }
  EXPECT_EQ(directions.size(), 8u);
}

TEST(Approach, OneQuadAllTheWay) {
  std::set<std::string> names;
  for (const Approach& approach : approaches()) {
    EXPECT_TRUE(names.insert(std::string(approach.name)).second);
    EXPECT_EQ(find_approach(approach.name), &approach);
    const auto first = make_approach(approach, approach.first, 1, count, seed, 2);
    const auto again = make_approach(approach, approach.first, 1, count / 2, seed, 2);
    const auto last = make_approach(approach, approach.last, 1, count, seed, 2);
    const auto place = approach_places(approach, approach.first, 1, count, seed);
    for (const int side : sides_of(approach)) {
      const auto other = approach_places(approach, approach.last, side, count, seed);
      for (std::size_t i = 0; i < count; ++i) {
        EXPECT_EQ(place[i].near_x, other[i].near_x) << approach.name;
        EXPECT_EQ(place[i].near_y, other[i].near_y) << approach.name;
        EXPECT_EQ(place[i].corner, other[i].corner) << approach.name;
      }
    }
    for (std::size_t i = 0; i < count; ++i) {
      ASSERT_EQ(first[i].id, i);
      for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_EQ(first[i].attribute[k] == last[i].attribute[k], approach.attribute == 1 || k == place[i].corner[0])
            << approach.name;
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
