// Points of the window for the generators of quads.
#pragma once

#include <cmath>

namespace quadrille::golden {

/// In pixels, y down.
struct WindowPoint {
  double x = 0, y = 0;
};

inline WindowPoint operator+(WindowPoint a, WindowPoint b) { return {a.x + b.x, a.y + b.y}; }
inline WindowPoint operator-(WindowPoint a, WindowPoint b) { return {a.x - b.x, a.y - b.y}; }
inline WindowPoint operator*(double s, WindowPoint p) { return {s * p.x, s * p.y}; }

/// Steps of a pixel that a snapping with the default subpixel_bits keeps.
inline constexpr double window_grid = 256;
/// The nearest of them.
inline double snap256(double x) { return std::floor(x * window_grid + 0.5) / window_grid; }
inline WindowPoint snap256(WindowPoint p) { return {snap256(p.x), snap256(p.y)}; }

}  // namespace quadrille::golden
