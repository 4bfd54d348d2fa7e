#include "model/snap.hpp"

#include <cmath>
#include <sstream>

namespace quadrille {
namespace {

constexpr double largest_magnitude = 0x1p80;

std::string describe(const WindowVertex& v) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(17);
  out << "(" << v.x << ", " << v.y << ", " << v.z << ", " << v.w << ")";
  return out.str();
}

/// What is wrong with a vertex, without knowing which one it is; snap_quad adds the place.
struct Rejected {
  std::string what;
};

/// To nearest, ties to even, S significant bits. Exponents below the port's range become zero.
PortNumber round_to_port(long double value, const Config& config) {
  if (value == 0) return {};
  const int s = config.significand_bits;
  int exponent = 0;
  const long double fraction = frexpl(fabsl(value), &exponent);  // in [1/2, 1)
  auto sig = static_cast<std::uint64_t>(llrintl(ldexpl(fraction, s)));
  if (sig == std::uint64_t{1} << s) {
    sig >>= 1;
    ++exponent;
  }
  const int exp = exponent - 1;
  if (exp < -(1 << (Config::port_exp_bits - 1))) return {};
  if (exp >= 1 << (Config::port_exp_bits - 1)) throw Rejected{"a product with k is too large for the port"};
  return {value < 0, exp, static_cast<std::uint32_t>(sig)};
}

bool finite(const WindowVertex& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
}

struct Position {
  std::int32_t x, y, w;
  long double k;
};

Position snap_position(const WindowVertex& v, const Config& config) {
  // Half a pixel first: pixel centres become integers. long double holds x − w/2 of two doubles to 2^-64 relative, far
  // below the grid wherever the result is in the guard band.
  const long double x = static_cast<long double>(v.x) - static_cast<long double>(v.w) / 2;
  const long double y = static_cast<long double>(v.y) - static_cast<long double>(v.w) / 2;
  const long double w = v.w;
  const int lift = config.homogeneous_frac_bits;
  if (w > 0) {
    const long double limit = ldexpl(1.0L, config.pos_int() + config.subpixel_bits);
    const long double gx = rintl(ldexpl(x / w, config.subpixel_bits));
    const long double gy = rintl(ldexpl(y / w, config.subpixel_bits));
    if (fabsl(gx) < limit && fabsl(gy) < limit)
      return {static_cast<std::int32_t>(gx) * (1 << lift), static_cast<std::int32_t>(gy) * (1 << lift),
              1 << config.frac(), 1 / w};
  }
  const long double extent =
      fmaxl(fmaxl(ldexpl(fabsl(x), -config.pos_int()), ldexpl(fabsl(y), -config.pos_int())), fabsl(w));
  if (extent == 0) throw Rejected{"(x, y, w) is (0, 0, 0) after the half-pixel shift, which is no point"};
  const long double k = 1 / extent;
  const auto grid = [&](long double value) {
    return static_cast<std::int32_t>(rintl(ldexpl(value / extent, config.frac())));
  };
  return {grid(x), grid(y), grid(w), k};
}

SnappedVertex snap_or_reject(const WindowVertex& v, const double* attributes, int attribute_count, const Config& config,
                             const DrawState& state) {
  if (!finite(v)) throw Rejected{"a coordinate is NaN or infinite"};
  if (v.x == 0 && v.y == 0 && v.w == 0) throw Rejected{"(x, y, w) is (0, 0, 0), which is no point"};
  const double extent = std::fmax(std::fmax(std::fabs(v.x), std::fabs(v.y)), std::fabs(v.w));
  if (extent > largest_magnitude || std::fabs(v.z) > largest_magnitude)
    throw Rejected{"a coordinate is larger than 2^80"};
  if (extent < 1 / largest_magnitude) throw Rejected{"x, y and w are all smaller than 2^-80"};

  const Position p = snap_position(v, config);
  SnappedVertex out;
  out.x = p.x;
  out.y = p.y;
  out.w = p.w;
  out.k = round_to_port(p.k, config);
  out.z = round_to_port(p.k * static_cast<long double>(v.z), config);
  const long double scale = state.perspective ? p.k : ldexpl(static_cast<long double>(p.w), -config.frac());
  const double limit = std::ldexp(1.0, config.attribute_int_bits);
  for (int j = 0; j < attribute_count; ++j) {
    if (!std::isfinite(attributes[j])) throw Rejected{"attribute " + std::to_string(j) + " is NaN or infinite"};
    if (std::fabs(attributes[j]) >= limit)
      throw Rejected{"attribute " + std::to_string(j) + " = " + std::to_string(attributes[j]) +
                     " does not fit attribute_int_bits = " + std::to_string(config.attribute_int_bits)};
    out.attribute[static_cast<std::size_t>(j)] = round_to_port(scale * static_cast<long double>(attributes[j]), config);
  }
  return out;
}

}  // namespace

SnapError::SnapError(std::uint32_t quad_id, int vertex_index, const std::string& what)
    : std::runtime_error("quad " + std::to_string(quad_id) + ", vertex " + std::to_string(vertex_index) + ": " + what),
      quad(quad_id),
      vertex(vertex_index) {}

SnappedVertex snap_vertex(const WindowVertex& v, const double* attributes, int attribute_count, const Config& config,
                          const DrawState& state) {
  try {
    return snap_or_reject(v, attributes, attribute_count, config, state);
  } catch (const Rejected& r) {
    throw SnapError(0, 0, describe(v) + ": " + r.what);
  }
}

SnappedQuad snap_quad(const WindowQuad& quad, const Config& config, const DrawState& state) {
  if (config.quad_id_bits < 32 && quad.id >> config.quad_id_bits)
    throw SnapError(quad.id, 0, "the quad id does not fit quad_id_bits = " + std::to_string(config.quad_id_bits));
  SnappedQuad out;
  out.id = quad.id;
  for (int i = 0; i < 4; ++i) {
    const std::vector<double>& a = quad.attribute[static_cast<std::size_t>(i)];
    const int count = std::min<int>(static_cast<int>(a.size()), config.attribute_slots);
    try {
      out.vertex[static_cast<std::size_t>(i)] =
          snap_or_reject(quad.vertex[static_cast<std::size_t>(i)], a.data(), count, config, state);
    } catch (const Rejected& r) {
      throw SnapError(quad.id, i, describe(quad.vertex[static_cast<std::size_t>(i)]) + ": " + r.what);
    }
  }
  return out;
}

bool is_ordinary(const SnappedQuad& quad, const Config& config) {
  for (const SnappedVertex& v : quad.vertex)
    if (v.w != 1 << config.frac()) return false;
  return true;
}

bool has_ordinary_vertices(const SnappedQuad& quad, const Config& config) {
  const std::int32_t between = (1 << config.homogeneous_frac_bits) - 1;
  for (const SnappedVertex& v : quad.vertex)
    if (((v.x | v.y) & between) != 0) return false;
  return is_ordinary(quad, config);
}

}  // namespace quadrille
