#include "model/port/quick_snap.hpp"

#include "model/support/power_of_two.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace quadrille {
namespace {

using Four = std::array<double, 4>;  ///< of the vertices

/// An integer next to the value, which is below 2^51.
double integer_at(double value) {
  constexpr double last_place_one = 0x1.8p52;
  return (value + last_place_one) - last_place_one;
}

/// Doubles to numbers of the port; remembers whether one was not proved.
class PortRounding {
 public:
  explicit PortRounding(const Config& config) : s_(config.significand_bits), drop_(53 - s_) {}

  PortNumber operator()(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    const std::uint64_t magnitude = bits & ~(std::uint64_t{1} << 63);
    if (magnitude == 0) return {};
    constexpr std::uint64_t near = 64, least = std::uint64_t{1023 - 250} << 52, most = std::uint64_t{1023 + 250} << 52;
    const std::uint64_t half = std::uint64_t{1} << (drop_ - 1), dropped = magnitude & (2 * half - 1);
    unproved_ |= dropped - (half - near) <= 2 * near || magnitude - least > most - least;
    const std::uint64_t rounded = magnitude + half;
    const std::uint32_t top = std::uint32_t{1} << (s_ - 1);
    return {bits != magnitude, static_cast<std::int32_t>(rounded >> 52) - 1023,
            (static_cast<std::uint32_t>(rounded >> drop_) & (top - 1)) | top};
  }
  bool unproved() const { return unproved_; }

 private:
  int s_, drop_;
  bool unproved_ = false;
};

/// z - w b with an error of two roundings, b = code 2^-bits. The product's two halves are exact: of w 26 bits by 16 of
/// the code and so on.
double less_product(double z, double w, std::uint32_t code, double unit) {
  const double b = code * unit, b_high = (code & ~0x7fffu) * unit, b_low = (code & 0x7fffu) * unit;
  const double w_high = std::bit_cast<double>(std::bit_cast<std::uint64_t>(w) & ~std::uint64_t{0x7ffffff});
  const double w_low = w - w_high, high = w * b;
  const double low = (((w_high * b_high - high) + w_high * b_low) + w_low * b_high) + w_low * b_low;
  return (z - high) - low;
}

}  // namespace

bool quick_snap(const WindowQuad& quad, std::size_t attributes, const Config& config, const DrawState& state,
                SnappedQuad& out) {
  Four x, y, z, w, k;
  bool fits = true;
  for (std::size_t i = 0; i < 4; ++i) {
    const WindowVertex& v = quad.vertex[i];
    x[i] = v.x, y[i] = v.y, z[i] = v.z, w[i] = v.w;
    constexpr double most = 0x1p80;
    fits &= w[i] >= 1 / most && w[i] <= most && std::fabs(x[i]) <= most && std::fabs(y[i]) <= most &&
            std::fabs(z[i]) <= most;
  }
  if (!fits) return false;
  for (std::size_t i = 0; i < 4; ++i) k[i] = 1 / w[i];

  const double grid = power_of_two(config.subpixel_bits), limit = power_of_two(config.pos_int() + config.subpixel_bits);
  constexpr double sure = 0.5 - 0x1p-20;
  for (std::size_t i = 0; i < 4; ++i) {
    const double half = 0.5 * w[i], gx = (x[i] - half) * k[i] * grid, gy = (y[i] - half) * k[i] * grid;
    fits &= std::fabs(gx) < limit && std::fabs(gy) < limit;
    const double nx = integer_at(gx), ny = integer_at(gy);
    fits &= std::fabs(gx - nx) < sure && std::fabs(gy - ny) < sure && std::fabs(nx) < limit && std::fabs(ny) < limit;
    x[i] = nx, y[i] = ny;
  }
  if (!fits) return false;

  const double one = power_of_two(config.depth_bits), depth_unit = power_of_two(-config.depth_bits);
  const double sure_of_depth = 0.5 - power_of_two(config.depth_bits - 44);
  std::array<std::int32_t, 4> code;
  for (std::size_t i = 0; i < 4; ++i) {
    const double depth = std::clamp(z[i] * k[i] * one, -2.0, one + 2), n = integer_at(depth);
    fits &= std::fabs(depth - n) < sure_of_depth;
    code[i] = std::clamp(static_cast<std::int32_t>(n), -1, config.depth_above());
  }
  QuadBase& base = out.base;
  base.depth = static_cast<std::uint32_t>(std::clamp(code[0], 0, config.depth_above() - 1));
  base.depth_low = std::min({code[0], code[1], code[2], code[3]});
  base.depth_high = std::max({code[0], code[1], code[2], code[3]});

  PortRounding to_port(config);
  for (std::size_t i = 0; i < 4; ++i) {
    SnappedVertex& v = out.vertex[i];
    v.x = static_cast<std::int32_t>(x[i]) * (1 << config.homogeneous_frac_bits);
    v.y = static_cast<std::int32_t>(y[i]) * (1 << config.homogeneous_frac_bits);
    v.w = std::int32_t{1} << config.frac();
    v.k = to_port(k[i]);
    v.z = to_port(less_product(z[i], w[i], base.depth, depth_unit) * k[i]);
  }

  const int frac = config.attribute_frac();
  const double attribute_end = power_of_two(config.attribute_int_bits), codes = power_of_two(frac),
               attribute_unit = power_of_two(-frac);
  for (std::size_t j = 0; j < attributes; ++j) {
    const double first = quad.attribute[0][j], scaled = first * codes, n = integer_at(scaled);
    fits &= std::fabs(first) < attribute_end && std::fabs(scaled - n) < 0.5;
    if (!fits) return false;
    base.attribute[j] = std::clamp(static_cast<std::int64_t>(n), -config.attribute_limit(), config.attribute_limit());
    const double based = static_cast<double>(base.attribute[j]) * attribute_unit;
    for (std::size_t i = 1; i < 4; ++i) {
      const double value = quad.attribute[i][j];
      fits &= std::fabs(value) < attribute_end;
      if (value != first) out.vertex[i].attribute[j] = to_port((value - based) * (state.perspective ? k[i] : 1));
    }
  }
  return fits && !to_port.unproved();
}

}  // namespace quadrille
