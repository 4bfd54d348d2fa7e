// Compares the weights of method mvc with CGAL's mean value coordinates on random simple quads, convex and concave, at
// every covered pixel centre, edges and corners among them. CGAL computes with exact numbers, square roots included.
#include "golden/methods/builders.hpp"
#include "model/support/prng.hpp"

#include <CGAL/Barycentric_coordinates_2/Mean_value_coordinates_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel_with_sqrt.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <vector>

namespace {

using quadrille::golden::Prng;
using quadrille::golden::methods::Quad;
using quadrille::golden::methods::Sample;
using Kernel = CGAL::Exact_predicates_exact_constructions_kernel_with_sqrt;
using Number = Kernel::FT;
using Point = Kernel::Point_2;

/// CGAL takes lengths through double unless the traits bring a square root.
struct Traits : Kernel {
  struct Sqrt {
    Number operator()(const Number& v) const { return CGAL::sqrt(v); }
  };
  Sqrt sqrt_object() const { return {}; }
};

constexpr int size = 16;  // of the view in pixels: numbers with roots are slow

/// Corners on the half-pixel grid, so that edges and corners meet pixel centres; strictly simple, no straight corner.
std::vector<std::array<int, 2>> random_simple(Prng& random) {
  const auto turn = [](const auto& a, const auto& b, const auto& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
  };
  for (;;) {
    std::vector<std::array<int, 2>> v(4);
    for (auto& p : v)
      p = {static_cast<int>(random.integer(0, 2 * size)), static_cast<int>(random.integer(0, 2 * size))};
    bool straight = false;
    for (std::size_t i = 0; i < 4; ++i) straight = straight || turn(v[i], v[(i + 1) & 3], v[(i + 2) & 3]) == 0;
    const auto separates = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
      return static_cast<double>(turn(v[a], v[b], v[c])) * turn(v[a], v[b], v[d]) <= 0;
    };
    const bool crossed =
        (separates(0, 1, 2, 3) && separates(2, 3, 0, 1)) || (separates(1, 2, 3, 0) && separates(3, 0, 1, 2));
    if (!straight && !crossed) return v;
  }
}

int run() {
  const auto mvc = quadrille::golden::methods::make_mvc();
  Prng random(1);
  double largest = 0;
  std::size_t quads = 0, concave = 0, pixels = 0;
  for (; quads < 200; ++quads) {
    const auto corner = random_simple(random);
    Quad quad;
    std::vector<Point> polygon;
    int left = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      quad.vertex[i] = {corner[i][0] / 2.0, corner[i][1] / 2.0, 0, 1};
      polygon.emplace_back(Number(corner[i][0]) / 2, Number(corner[i][1]) / 2);
      const auto &a = corner[i], &b = corner[(i + 1) & 3], &c = corner[(i + 2) & 3];
      left += (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0 ? 1 : 0;
    }
    concave += left != 0 && left != 4 ? 1 : 0;
    CGAL::Barycentric_coordinates::Mean_value_coordinates_2<std::vector<Point>, Traits> cgal(
        polygon, CGAL::Barycentric_coordinates::Computation_policy_2::PRECISE_WITH_EDGE_CASES, Traits());
    std::vector<MethodSample> samples;
    mvc->draw(quad, {size, size, false}, samples);
    for (const MethodSample& s : samples) {
      std::vector<Number> expected;
      cgal(Point(Number(2 * s.x + 1) / 2, Number(2 * s.y + 1) / 2), std::back_inserter(expected));
      for (std::size_t i = 0; i < 4; ++i)
        largest = std::max(largest, std::abs(s.lambda[i] - CGAL::to_double(expected[i])));
      ++pixels;
    }
  }
  std::printf("%zu quads, %zu of them concave, %zu pixels: largest difference %.3g\n", quads, concave, pixels, largest);
  return concave > 0 && pixels > 1000 && largest <= 1e-12 ? 0 : 1;
}

}  // namespace

int main() {
  try {
    return run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
