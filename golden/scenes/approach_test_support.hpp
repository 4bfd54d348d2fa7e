// What the tests of approach share.
#pragma once

#include "golden/scenes/approach.hpp"

#include <functional>
#include <string>

namespace quadrille::golden {
namespace {

constexpr std::size_t count = 40;
constexpr std::uint64_t seed = 3;

struct Point {
  double x, y;
};

/// A quad, its corners in the order of the approach's definition.
struct Approaching {
  const WindowQuad& quad;
  const ApproachPlace& place;

  const WindowVertex& vertex(std::size_t i) const { return quad.vertex[place.corner[i]]; }
  Point at(std::size_t i) const { return {vertex(i).x / vertex(i).w, vertex(i).y / vertex(i).w}; }
  Point pixel() const { return {place.near_x, place.near_y}; }
};

inline std::vector<int> sides_of(const Approach& approach) {
  return approach.both_sides ? std::vector{-1, 1} : std::vector{1};
}

/// Every quad of every step.
inline void each_step(const std::function<void(const Approach&, int knob, int side)>& take) {
  for (const Approach& approach : approaches())
    for (int knob = approach.first; knob <= approach.last; ++knob)
      for (const int side : sides_of(approach)) take(approach, knob, side);
}

inline std::string text(const Approach& approach, int knob, int side) {
  return std::string(approach.name) + " knob " + std::to_string(knob) + " side " + std::to_string(side);
}

}  // namespace
}  // namespace quadrille::golden
