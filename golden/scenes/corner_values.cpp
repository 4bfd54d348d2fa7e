// Corner groups about depth and attributes: what a base, differences and corner codes have as special cases.
#include "golden/scenes/corner_batch.hpp"
#include "model/port/stages.hpp"

#include <algorithm>
#include <cmath>

namespace quadrille::golden {
namespace {

/// A depth given in codes.
double depth_of(const Batch& b, double code) { return std::ldexp(code, -b.config.depth_bits); }
double deepest_code(const Batch& b) { return std::ldexp(1.0, b.config.depth_bits); }

/// An attribute given in codes.
double value_of(const Batch& b, double code) { return std::ldexp(code, -b.config.attribute_frac()); }
double largest_code(const Batch& b) { return static_cast<double>(b.config.attribute_limit()); }

/// The code of znear or zfar.
double limit_code(Batch& b) { return depth_code(b.rng.chance(0.5) ? b.state.znear : b.state.zfar, b.config); }

/// One code or the whole range away from `code`, which lies from `first` to `last`.
double other_code(Batch& b, double code, double first, double last) {
  const double inward = code == last ? -1 : code == first ? 1 : b.rng.sign();
  return b.rng.chance(0.5) ? code + inward : inward > 0 ? last : first;
}

double end_or_middle(Batch& b, double first, double last) {
  constexpr double ends = 0.75;
  if (b.rng.chance(ends)) return b.rng.chance(0.5) ? first : last;
  return std::floor((first + last) / 2 + (last - first) * b.rng.uniform(-0.25, 0.25));
}

}  // namespace

void z_limits(Batch& b) {
  for (int count = 0; count < 160; ++count) {
    std::array<WindowVertex, 4> quad = lattice_polygon(b);
    // Codes 1 beside the limit at most, and what lies half-way to the next.
    for (WindowVertex& v : quad) {
      const double limit = limit_code(b);
      v.z = depth_of(b, limit + b.integer(-2, 2) / 2.0);
    }
    if (count % 4 == 0)  // one z everywhere
      for (WindowVertex& v : quad) v.z = quad[0].z;
    b.quads.push_back(quad);
  }
}

void minus_zero(Batch& b) {
  for (int count = 0; count < 30; ++count) {
    std::array<WindowVertex, 4> quad = lattice_polygon(b);
    for (WindowVertex& v : quad) v.z = -depth_of(b, b.rng.uniform(0, count % 2 == 0 ? 0.49 : 1.5));
    b.quads.push_back(quad);
  }
}

void constant_depth(Batch& b) {
  for (int count = 0; count < 96; ++count) {
    const double limit = limit_code(b), z = depth_of(b, limit + b.integer(-1, 1));
    std::array<WindowVertex, 4> quad = lattice_polygon(b);
    const auto give_w = [](WindowVertex& v, double w) { v = {v.x * w, v.y * w, 0, w}; };
    constexpr double w_unit = 0x1p-8;  // few enough bits of w for an exact product with z
    if (count % 4 == 1)
      for (WindowVertex& v : quad) give_w(v, w_unit * b.integer(64, 1024));
    const auto corner = static_cast<std::size_t>(b.integer(0, 3));
    if (count % 4 == 2) {  // beyond the guard band
      const double x = b.rng.sign() * std::ldexp(1.0, b.config.pos_int() + b.integer(1, 6));
      const double y = b.rng.uniform(-0.5, 0.5) * x, w = w_unit * b.integer(64, 1024);
      quad[corner] = {x * w, y * w, 0, w};
    }
    if (count % 4 == 3) give_w(quad[corner], -w_unit * b.integer(64, 1024));
    for (WindowVertex& v : quad) v.z = z * v.w;
    b.quads.push_back(quad);
  }
}

void one_corner(Batch& b) {
  for (int count = 0; count < 80; ++count) {
    std::array<WindowVertex, 4> quad = lattice_polygon(b);
    const double code = end_or_middle(b, 0, deepest_code(b)), other = other_code(b, code, 0, deepest_code(b));
    const bool perspective = b.rng.chance(0.5);
    for (std::size_t i = 0; i < 4; ++i) {
      const double w = perspective ? std::ldexp(1.0, b.integer(-2, 2)) : 1;
      WindowVertex& v = quad[i];
      v = {v.x * w, v.y * w, depth_of(b, i == static_cast<std::size_t>(count % 4) ? other : code) * w, w};
    }
    b.quads.push_back(quad);
  }
}

void far_base(Batch& b) {
  for (int count = 0; count < 60; ++count) {
    std::array<WindowVertex, 4> quad = lattice_polygon(b);
    const double last = deepest_code(b) - b.integer(0, 3);
    for (WindowVertex& v : quad) v.z = depth_of(b, last - b.integer(0, 2));
    b.quads.push_back(quad);
  }
}

void ties(Batch& b) {
  for (int count = 0; count < 80; ++count) {
    std::array<WindowVertex, 4> quad = lattice_polygon(b);
    const double base = std::floor(deepest_code(b) * b.rng.uniform(0.1, 0.9));
    for (WindowVertex& v : quad) v.z = depth_of(b, base + b.integer(-3, 2) + 0.5);
    quad[0].z = depth_of(b, base);
    b.quads.push_back(quad);
  }
}

void saturation(Batch& b) {
  for (int count = 0; count < 80; ++count) {
    std::array<WindowVertex, 4> quad = lattice_polygon(b);
    for (WindowVertex& v : quad) v.z = b.rng.uniform(0, 1);
    b.quads.push_back(quad);
  }
}

std::array<double, 4> corner_values(CornerGroup group, Batch& b, std::size_t quad) {
  std::array<double, 4> values{};
  const double last = largest_code(b);
  switch (group) {
    case CornerGroup::one_corner: {
      const double code = end_or_middle(b, -last, last);
      values.fill(value_of(b, code));
      values[quad % 4] = value_of(b, other_code(b, code, -last, last));
      break;
    }
    case CornerGroup::far_base: {
      const double sign = b.rng.sign();
      for (double& v : values) v = value_of(b, sign * (last - b.integer(0, 3)));
      break;
    }
    case CornerGroup::ties: {
      const double base = std::floor(last * b.rng.uniform(-0.9, 0.9));
      for (double& v : values) v = value_of(b, base + b.integer(-3, 2) + 0.5);
      values[0] = value_of(b, base);
      break;
    }
    case CornerGroup::plane:
      return plane_values(b);
    default:
      for (double& v : values) v = std::ldexp(b.rng.uniform(-0.99, 0.99), b.config.attribute_int_bits);
  }
  return values;
}

void change_at_port(CornerGroup group, Batch& b, SnappedQuad& quad) {
  QuadBase& base = quad.base;
  const auto depth_one = static_cast<std::int32_t>(deepest_code(b));
  const auto any_corner_codes = [&] {
    base.depth_low = b.integer(0, depth_one);
    base.depth_high = b.integer(base.depth_low, depth_one);
  };
  if (group == CornerGroup::den_w_zero && b.rng.chance(0.5)) any_corner_codes();
  if (group != CornerGroup::saturation) return;

  const auto beyond = [](PortNumber& number) { number.exp += number.sig != 0 ? 3 : 0; };
  for (std::size_t j = 0; j < static_cast<std::size_t>(b.config.attribute_slots); ++j) {
    const std::uint64_t kind = b.rng.below(3);
    if (kind == 0)  // the quotient
      for (SnappedVertex& v : quad.vertex) beyond(v.attribute[j]);
    if (kind == 1)  // the sum
      base.attribute[j] = (b.rng.chance(0.5) ? 1 : -1) * b.config.attribute_limit();
    if (kind == 2) {  // the sum by a code or two, or not: one difference for all corners
      base.attribute[j] = ((quad.id & 4) != 0 ? 1 : -1) * b.config.attribute_limit();
      PortNumber difference;
      difference.neg = (quad.id & 1) != 0;
      difference.exp = static_cast<std::int32_t>(quad.id >> 1 & 1) - b.config.attribute_frac();
      difference.sig = std::uint32_t{1} << (b.config.significand_bits - 1);
      for (std::size_t i = 1; i < 4; ++i) quad.vertex[i].attribute[j] = difference;
    }
  }
  const std::uint64_t kind = b.rng.below(3);
  if (kind == 0)
    for (SnappedVertex& v : quad.vertex) beyond(v.z);
  if (kind == 1) base.depth = b.rng.chance(0.5) ? 0 : static_cast<std::uint32_t>(depth_one);
  any_corner_codes();
}

}  // namespace quadrille::golden
