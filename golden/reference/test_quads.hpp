// Quads for the tests of this folder: built by hand from integers, or drawn at random.
#pragma once

#include "golden/reference/port_number.hpp"
#include "model/port/config.hpp"
#include "model/port/records.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

namespace quadrille::golden::test {

inline constexpr int frac = 15;  ///< of a default Config: subpixel_bits 8 + homogeneous_frac_bits 7
inline constexpr std::int32_t one = 1 << frac;

struct Point {
  int x = 0, y = 0;
  int w = 1;
};

/// Nearest port number; exact for every value with at most `bits` significant bits.
inline PortNumber port(double value, int bits = Config{}.significand_bits) { return nearest_port_number(value, bits); }

/// A value as the base of an attribute (of a default Config), which is nearest to it.
inline std::int64_t base_code(double value) { return std::llround(std::ldexp(value, Config{}.attribute_frac())); }

/// Corner codes that clamp no depth below 128.
inline void leave_depth(QuadBase& base) {
  base.depth_low = std::numeric_limits<std::int32_t>::min();
  base.depth_high = std::numeric_limits<std::int32_t>::max();
}

/// Integer vertices in units of `unit` * 2^-15; k = 1, Z = i, attribute a = 1 at vertex a and 0 elsewhere (a_0 by its
/// base of 1, the others' bases are 0).
inline SnappedQuad make_quad(const std::array<Point, 4>& points, std::int32_t unit = one) {
  SnappedQuad quad;
  for (int i = 0; i < 4; ++i) {
    SnappedVertex& v = quad.vertex[i];
    v.x = points[i].x * unit;
    v.y = points[i].y * unit;
    v.w = points[i].w * unit;
    v.k = port(1);
    v.z = port(i);
    if (i > 0) {
      v.attribute[0] = port(-1);
      v.attribute[i] = port(1);
    }
  }
  quad.base.attribute[0] = base_code(1);
  leave_depth(quad.base);
  return quad;
}

/// Fixed sequence on every platform: the engine is specified by the standard, distributions are not.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  /// Uniform enough integer in [low, high].
  int integer(int low, int high) {
    const auto span = static_cast<std::uint64_t>(static_cast<std::int64_t>(high) - low + 1);
    return static_cast<int>(low + static_cast<std::int64_t>(engine_() % span));
  }
  double real(double low, double high) {
    return low + (high - low) * std::ldexp(static_cast<double>(engine_() >> 11), -53);
  }

 private:
  std::mt19937_64 engine_;
};

/// Ordinary vertices on the 1/256 grid within `radius` pixels of the origin; random k in [1/4, 4], Z = z W, z in [0,
/// 1], bases in [-1, 1] (depth: [0, 1]), numbers that are not looked at where vertex 0 has no differences.
inline SnappedQuad random_ordinary(Random& random, int radius) {
  SnappedQuad quad;
  for (auto& v : quad.vertex) {
    v.x = random.integer(-radius * 256, radius * 256) * 128;
    v.y = random.integer(-radius * 256, radius * 256) * 128;
    v.w = one;
    v.k = port(std::exp2(random.real(-2, 2)));
    v.z = port(random.real(0, 1));
    for (auto& b : v.attribute) b = port(random.real(-1, 1));
  }
  for (auto& base : quad.base.attribute) base = base_code(random.real(-1, 1));
  quad.base.depth = static_cast<std::uint32_t>(random.integer(0, 1 << Config{}.depth_bits));
  leave_depth(quad.base);
  return quad;
}

/// Vertices whose W takes any value in [-1, 1], 0 now and then, and which all lie around the origin's ray.
inline SnappedQuad random_any_w(Random& random, int radius) {
  SnappedQuad quad = random_ordinary(random, radius);
  for (auto& v : quad.vertex) {
    v.w = random.integer(0, 9) == 0 ? 0 : random.integer(-one, one);
    v.z = port(random.real(0, 1) * std::ldexp(v.w, -frac));
  }
  return quad;
}

}  // namespace quadrille::golden::test
