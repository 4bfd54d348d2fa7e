#include "golden/scenes/approach.hpp"

#include "golden/scenes/approach_step.hpp"
#include "golden/scenes/generators.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

namespace quadrille::golden::approach {
namespace {

/// What make_approach may do to the quads of a maker beside turning and mirroring the order of their corners.
enum class Window {
  keep,    ///< the case is at a place of the window
  mirror,  ///< left and right, top and bottom
  turn,    ///< x and y too: of a square viewport
};

struct Generator {
  Approach info;
  Vertices (*make)(Step&);
  Window window = Window::turn;
};

constexpr int extent = 64, long_extent = 4096, short_extent = 16;
constexpr std::array<Generator, 23> generators{{
    {{"edge_distance", "an edge through a pixel centre", "distance in px", 0, 24, true, true, extent, extent},
     edge_distance},
    {{"edge_line", "a pixel centre on an edge's line outside the edge", "distance in px", 0, 24, true, true, extent,
      extent},
     edge_line},
    {{"right_angle_edge", "neighbouring corners at a right angle as seen from a pixel, D = 0",
      "cosine of the angle, times up to 2", 0, 22, true, true, extent, extent},
     right_angle_edge},
    {{"right_angle_diagonal", "opposite corners at a right angle as seen from a pixel, D = 0",
      "cosine of the angle, times up to 2", 0, 22, true, true, extent, extent},
     right_angle_diagonal},
    {{"vertex_distance", "a corner at a pixel centre", "distance in px, times up to 2.3", 0, 8, true, true, extent,
      extent},
     vertex_distance},
    {{"crossing", "a bow-tie that crosses at a pixel centre", "distance of either edge in px, times up to 4.5", 0, 8,
      true, true, extent, extent},
     crossing},
    {{"sliver_thickness", "no area", "thickness in px", 0, 8, true, true, extent, extent}, sliver_thickness},
    {{"edge_length", "two neighbouring corners equal", "length of their edge in px, times up to 2.3", 0, 8, true, true,
      extent, extent},
     edge_length},
    {{"opposite_distance", "two opposite corners equal, at a pixel centre", "their distance in px, times up to 5", 0, 8,
      true, true, extent, extent},
     opposite_distance},
    {{"diagonal_distance", "a corner of 180 degrees, on the diagonal",
      "distance of the corner from the diagonal in px, times up to 2.3", 0, 8, true, true, extent, extent},
     diagonal_distance},
    {{"eye_plane", "a corner in the eye plane, w = 0", "|w| of the corner", 0, 23, true, true, extent, extent},
     eye_plane},
    {{"eye_face", "the eye in a face of the corners' hull", "share of the fourth corner in the eye", 0, 14, true, true,
      extent, extent},
     eye_face},
    {{"eye_edge", "the eye on an edge", "share of another vertex in the corner opposite the eye", 0, 16, true, true,
      extent, extent},
     eye_edge},
    {{"eye_diagonal", "the eye on a diagonal", "share of another vertex in the corner opposite the eye", 0, 16, true,
      true, extent, extent},
     eye_diagonal},
    {{"guard_band", "a corner at the limit of the guard band", "distance from the limit in px", -12, 8, true, true,
      extent, extent},
     guard_band,
     Window::keep},
    {{"guard_band_flat", "the same of a quad of one depth", "distance from the limit in px", -24, 8, false, true,
      extent, extent},
     guard_band_flat,
     Window::keep},
    {{"value_spread", "one depth, and attributes of one value far from 0", "spread of the whole range", 0, 32, false,
      true, extent, extent, 127},
     value_spread},
    {{"depth_limit", "the depth of a corner at the end of its range, at znear or zfar", "distance in depth", 2, 27,
      true, true, extent, extent},
     depth_limit},
    {{"coincident_w", "two neighbouring corners equal, w too", "|w1/w0 - 1| of corners at one place", 1, 24, true, true,
      extent, extent},
     coincident_w},
    {{"w_ratio", "", "smallest w / largest w", 0, 40, true, false, extent, extent}, w_ratio},
    {{"long_edge", "", "2^knob is the length in px", 4, 12, false, false, long_extent, short_extent},
     long_edge,
     Window::mirror},
    {{"long_edge_down", "", "2^knob is the length in px", 4, 12, false, false, short_extent, long_extent},
     long_edge_down,
     Window::mirror},
    {{"long_edge_behind", "", "2^knob is the length in px, one corner behind the eye", 4, 12, false, false, long_extent,
      short_extent},
     long_edge_behind,
     Window::mirror},
}};

constexpr auto infos = infos_of(generators);

/// The window mirrored and turned, all numbers exact: a pixel centre becomes another one.
void turn_window(Step& s, Vertices& v, Window window) {
  const bool left_right = s.rng.chance(0.5), top_bottom = s.rng.chance(0.5), turned = s.rng.chance(0.5);
  if (window == Window::keep) return;
  const auto turn = [&](double& x, double& y, double w) {
    if (left_right) x = s.width * w - x;
    if (top_bottom) y = s.height * w - y;
    if (turned && window == Window::turn) std::swap(x, y);
  };
  for (WindowVertex& q : v) turn(q.x, q.y, q.w);
  turn(s.place.near_x, s.place.near_y, 1);
}

/// The order of the corners turned and mirrored: the same quad, its special corner another one.
Vertices turn_corners(Step& s, const Vertices& v) {
  const std::size_t first = s.rng.below(4);
  const bool mirrored = s.rng.chance(0.5);
  const auto turned = [&](std::size_t i) { return (first + (mirrored ? 4 - i : i)) & 3; };
  Vertices out;
  for (std::size_t i = 0; i < 4; ++i) out[turned(i)] = v[i];
  for (std::size_t& corner : s.place.corner) corner = turned(corner);
  return out;
}

/// The step of every quad, its vertices made.
template <class Take>
void each_step(const Approach& approach, int knob, int side, std::size_t count, std::uint64_t seed, const Take& take) {
  if (knob < approach.first || knob > approach.last || (side == 0 && !approach.limit) ||
      (side < 0 && !approach.both_sides) || side < -1 || side > 1)
    throw std::invalid_argument(std::string(approach.name) + ": no knob " + std::to_string(knob) + ", side " +
                                std::to_string(side));
  const auto index = static_cast<std::size_t>(find_approach(approach.name) - infos.data());
  for (std::size_t q = 0; q < count; ++q) {
    // A sequence of its own for each quad: every step draws as many numbers.
    Step step{Prng(seed * 1'000'003 + q, index + 1), side == 0 ? approach.last : knob, side, approach.width,
              approach.height};
    Vertices vertices = generators[index].make(step);
    step.width = approach.width;
    step.height = approach.height;
    turn_window(step, vertices, generators[index].window);
    take(q, step, turn_corners(step, vertices));
  }
}

}  // namespace
}  // namespace quadrille::golden::approach

namespace quadrille::golden {

std::span<const Approach> approaches() { return approach::infos; }

const Approach* find_approach(std::string_view name) {
  for (const Approach& info : approach::infos)
    if (info.name == name) return &info;
  return nullptr;
}

std::vector<WindowQuad> make_approach(const Approach& approach, int knob, int side, std::size_t count,
                                      std::uint64_t seed, int attributes) {
  std::vector<WindowQuad> quads(count);
  approach::each_step(
      approach, knob, side, count, seed, [&](std::size_t q, approach::Step& step, const approach::Vertices& vertices) {
        quads[q].id = static_cast<std::uint32_t>(q);
        quads[q].vertex = vertices;
        for (std::size_t i = 0; i < 4; ++i)
          for (int a = 0; a < attributes; ++a)
            quads[q].attribute[step.place.corner[i]].push_back(step.value ? (a % 2 == 0 ? 1 : -1) * (*step.value)[i]
                                                                          : step.rng.uniform(-1, 1));
      });
  return quads;
}

bool ApproachPlace::is_near(int x, int y) const {
  return std::hypot(x + 0.5 - near_x, y + 0.5 - near_y) <= near_radius;
}

std::vector<ApproachPlace> approach_places(const Approach& approach, int knob, int side, std::size_t count,
                                           std::uint64_t seed) {
  std::vector<ApproachPlace> places(count);
  approach::each_step(
      approach, knob, side, count, seed,
      [&](std::size_t q, const approach::Step& step, const approach::Vertices&) { places[q] = step.place; });
  return places;
}

}  // namespace quadrille::golden
