// Stress families of w: perspective, vertices behind the eye and at infinity, corners far away.
#include "golden/scenes/stress_batch.hpp"

namespace quadrille::golden::stress {
namespace {

double det(const WindowVertex& a, const WindowVertex& b, const WindowVertex& c) {
  return a.x * (b.y * c.w - b.w * c.y) - a.y * (b.x * c.w - b.w * c.x) + a.w * (b.x * c.y - b.y * c.x);
}

/// The origin (the eye) inside the tetrahedron: one sign of d123, −d023, d013, −d012.
bool holds_eye(const Vertices& v) {
  const std::array<double, 4> d{det(v[1], v[2], v[3]), -det(v[0], v[2], v[3]), det(v[0], v[1], v[3]),
                                -det(v[0], v[1], v[2])};
  return std::all_of(d.begin(), d.end(), [](double x) { return x > 0; }) ||
         std::all_of(d.begin(), d.end(), [](double x) { return x < 0; });
}

/// A vertex with the given w that projects near the viewport; with w = 0 a direction of that order.
WindowVertex anywhere(Batch& b, double w, double reach) {
  const WindowPoint p =
      random_point(b.rng, -reach * b.width, -reach * b.height, (1 + reach) * b.width, (1 + reach) * b.height);
  if (w != 0) return {p.x * w, p.y * w, 0, w};
  const double length = b.extent() * b.rng.log2_spread(-2, 2);
  const WindowPoint d = length * random_direction(b.rng);
  return {d.x, d.y, 0, 0};
}

/// |w| within this many octaves of 1, whatever the knob.
constexpr double most_octaves = 30;

double magnitude(Numbers& rng, double octaves) {
  const double limit = std::min(octaves, most_octaves);
  return rng.log2_spread(-limit, limit);
}

double any_sign(Numbers& rng, double octaves) {
  const double s = rng.sign();
  return s * magnitude(rng, octaves);
}

}  // namespace

void perspective(Batch& b) {
  const double size = b.extent() * b.rng.log2_spread(-4, -0.25);
  const WindowPoint centre = place(b, size);
  const Points p = random_corners(b, centre, size);
  const double ratio_log2 = std::min(6.643856 * b.knob, 40.0);  // log2 of 100
  Weights w;
  for (double& v : w) v = b.rng.log2_spread(0, ratio_log2);
  const std::size_t nearest = b.rng.below(4);
  w[nearest] = 1;
  w[(nearest + 1 + b.rng.below(3)) & 3] =
      std::ldexp(1.0 + (ratio_log2 - std::floor(ratio_log2)), static_cast<int>(ratio_log2));
  emit(b, p, w);
}

void any_w(Batch& b) {
  emit_visible(b, 3, [&] {
    Vertices v;
    for (WindowVertex& q : v) {
      const double w = b.rng.chance(0.125) ? 0.0 : any_sign(b.rng, 3 * b.knob);
      q = anywhere(b, w, 0.5);
    }
    return v;
  });
}

void huge(Batch& b) {
  emit_visible(b, 3, [&] {
    const WindowPoint target = place(b, 0);
    Vertices v;
    const std::size_t farthest = b.rng.below(4);
    for (std::size_t i = 0; i < 4; ++i) {
      const WindowPoint direction = random_direction(b.rng);
      const double distance = i == farthest ? b.knob * b.rng.log2_spread(17, 24) : b.rng.log2_spread(6, 20);
      const WindowPoint p = target + distance * direction;
      v[i] = {p.x, p.y, 0, 1};
    }
    return v;
  });
}

void eye_crossing(Batch& b) {
  emit_visible(
      b, 8,
      [&] {
        Vertices v;
        const std::uint64_t behind = 1 + b.rng.below(14);  // some behind, some in front
        for (std::size_t i = 0; i < 4; ++i) {
          const double w = magnitude(b.rng, 2 * b.knob);
          v[i] = anywhere(b, (behind >> i & 1) != 0 ? -w : w, 0.3);
        }
        return v;
      },
      [](const Vertices& v) { return !holds_eye(v); });
}

/// V3 = −(a V0 + b V1 + c V2) with positive a, b, c puts the origin inside the tetrahedron.
void eye_in_hull(Batch& b) {
  emit_visible(
      b, 8,
      [&] {
        Vertices v;
        WindowVertex sum{0, 0, 0, 0};
        for (std::size_t i = 0; i < 3; ++i) {
          v[i] = anywhere(b, any_sign(b.rng, b.knob), 0.5);
          const double share = b.rng.uniform(0.25, 1);
          sum.x += share * v[i].x;
          sum.y += share * v[i].y;
          sum.w += share * v[i].w;
        }
        v[3] = {-sum.x, -sum.y, 0, -sum.w};
        std::swap(v[3], v[b.rng.below(4)]);
        return v;
      },
      holds_eye);
}

void w_zero(Batch& b) {
  emit_visible(b, 3, [&] {
    Vertices v;
    const std::size_t first = b.rng.below(4);
    const std::size_t second = b.rng.chance(0.3) ? b.rng.below(4) : first;
    for (std::size_t i = 0; i < 4; ++i) {
      double w = i == first || i == second ? 0.0 : magnitude(b.rng, 2 * b.knob);
      if (w != 0 && b.rng.chance(0.25)) w = -w;
      v[i] = anywhere(b, w, 0.3);
    }
    return v;
  });
}

}  // namespace quadrille::golden::stress
