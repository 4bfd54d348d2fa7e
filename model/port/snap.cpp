#include "model/port/snap.hpp"

#include "model/port/quick_snap.hpp"
#include "model/support/exact_quotient.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <locale>
#include <optional>
#include <sstream>

namespace quadrille {
namespace {

constexpr double largest_magnitude = 0x1p80;

std::string digits(double value) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(17);
  out << value;
  return out.str();
}

std::string describe(const WindowVertex& v) {
  return "(" + digits(v.x) + ", " + digits(v.y) + ", " + digits(v.z) + ", " + digits(v.w) + ")";
}

/// What is wrong with a vertex, without knowing which one it is; snap_quad adds the place.
struct Rejected {
  std::string what;
};

bool finite(const WindowVertex& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
}

void check_vertex(const WindowVertex& v) {
  if (!finite(v)) throw Rejected{"a coordinate is NaN or infinite"};
  if (v.x == 0 && v.y == 0 && v.w == 0) throw Rejected{"(x, y, w) is (0, 0, 0), which is no point"};
  const double extent = std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.w)});
  if (extent > largest_magnitude || std::fabs(v.z) > largest_magnitude)
    throw Rejected{"a coordinate is larger than 2^80"};
  if (extent < 1 / largest_magnitude) throw Rejected{"x, y and w are all smaller than 2^-80"};
}

void check_attribute(double value, std::size_t slot, const Config& config) {
  if (!std::isfinite(value)) throw Rejected{"attribute " + std::to_string(slot) + " is NaN or infinite"};
  if (!(std::fabs(value) < std::ldexp(1.0, config.attribute_int_bits)))
    throw Rejected{"attribute " + std::to_string(slot) + " = " + digits(value) +
                   " does not fit attribute_int_bits = " + std::to_string(config.attribute_int_bits) + "; " +
                   std::to_string(std::ilogb(value) + 1) + " would hold it"};
}

/// n/d to nearest, ties to even, S significant bits. Exponents below the port's range become zero.
template <class Integer>
PortNumber port_quotient(const Exact<Integer>& n, const Exact<Integer>& d, const Config& config) {
  if (n.zero()) return {};
  const int s = config.significand_bits;
  const int bits = s + 1 - (n.top() - d.top());
  Floor floor = quotient_floor(n, d, bits);  // S + 1 or S + 2 bits
  const int extra = static_cast<int>(std::bit_width(floor.whole)) - s;
  if (extra == 2) floor = {floor.whole >> 1, floor.rest || (floor.whole & 1) != 0};
  auto sig = static_cast<std::uint64_t>(round_half_even(floor));
  int exp = s - 1 + extra - bits;
  if (sig >> s != 0) {
    sig >>= 1;
    ++exp;
  }
  if (exp < -(1 << (Config::port_exp_bits - 1))) return {};
  if (exp >= 1 << (Config::port_exp_bits - 1)) throw Rejected{"a product with k is too large for the port"};
  return {n.neg != d.neg, exp, static_cast<std::uint32_t>(sig)};
}

template <class Integer>
class VertexSnapper {
 public:
  using Number = Exact<Integer>;

  VertexSnapper(const WindowVertex& v, const Config& config)
      : config_(config), w_(exact<Integer>(v.w)), z_(exact<Integer>(v.z)) {
    // Half a pixel first: pixel centres become integers.
    const Number half = w_.scaled(-1), x = exact<Integer>(v.x) - half, y = exact<Integer>(v.y) - half;
    if (positive(v.w) && snap_ordinary(x, y)) return;
    snap_homogeneous(x, y);
  }

  const SnappedVertex& position() const { return out_; }

  /// k·value, k as it is before rounding.
  PortNumber times_k(const Number& value) const { return port_quotient(value, extent_, config_); }
  /// (W/ONE)·value.
  PortNumber times_w(const Number& value) const {
    return port_quotient((value * out_.w).scaled(-config_.frac()), exact_integer<Integer>(1), config_);
  }
  /// z~ − base w~, base a depth code.
  Number depth_above(std::uint32_t base) const { return z_ - (w_ * std::int64_t{base}).scaled(-config_.depth_bits); }
  /// Window z of a vertex before the eye as a code, clamped to [0, 1]; ties to even.
  std::uint32_t base_depth() const {
    if (z_.neg || z_.zero()) return 0;
    const std::uint32_t one = std::uint32_t{1} << config_.depth_bits;
    if (z_.top() > w_.top() + 1) return one;
    return static_cast<std::uint32_t>(
        std::min<std::int64_t>(round_half_even(quotient_floor(z_, w_, config_.depth_bits + 1)), one));
  }
  /// The same, halves up, from -1 (below 0) to depth_above() (above 1).
  std::int32_t corner_depth() const {
    const std::int32_t above = config_.depth_above();
    if (z_.zero()) return 0;
    if (z_.top() > w_.top() + 1) return z_.neg ? -1 : above;
    const Floor twice = quotient_floor(z_, w_, config_.depth_bits + 1);
    const auto whole = static_cast<std::int64_t>(twice.whole >> 1), odd = static_cast<std::int64_t>(twice.whole & 1);
    const std::int64_t code = z_.neg ? -(whole + (odd != 0 && twice.rest)) : whole + odd;
    return static_cast<std::int32_t>(std::clamp<std::int64_t>(code, -1, above));
  }

 private:
  bool snap_ordinary(const Number& x, const Number& y) {
    const int bits = config_.subpixel_bits, limit_log2 = config_.pos_int() + bits;
    const auto grid = [&](const Number& value) {
      if (!value.zero() && value.top() - w_.top() + bits > limit_log2 + 1) return std::int64_t{1} << limit_log2;
      const std::int64_t size = round_half_even(quotient_floor(value, w_, bits + 1));
      return value.neg ? -size : size;
    };
    const std::int64_t gx = grid(x), gy = grid(y), limit = std::int64_t{1} << limit_log2;
    if (std::max(std::abs(gx), std::abs(gy)) >= limit) return false;
    out_.x = static_cast<std::int32_t>(gx * (1 << config_.homogeneous_frac_bits));
    out_.y = static_cast<std::int32_t>(gy * (1 << config_.homogeneous_frac_bits));
    out_.w = std::int32_t{1} << config_.frac();
    extent_ = w_;
    out_.k = times_k(exact_integer<Integer>(1));
    return true;
  }

  void snap_homogeneous(const Number& x, const Number& y) {
    extent_ = w_;
    for (const Number& at : {x.scaled(-config_.pos_int()), y.scaled(-config_.pos_int())})
      if (smaller(extent_, at)) extent_ = at;
    extent_.neg = false;
    if (extent_.zero()) throw Rejected{"(x, y, w) is (0, 0, 0) after the half-pixel shift, which is no point"};
    const auto grid = [&](const Number& value) {
      const std::int64_t size = round_half_even(quotient_floor(value, extent_, config_.frac() + 1));
      return static_cast<std::int32_t>(value.neg ? -size : size);
    };
    out_.x = grid(x);
    out_.y = grid(y);
    out_.w = grid(w_);
    out_.k = times_k(exact_integer<Integer>(1));
  }

  const Config& config_;
  Number w_, z_, extent_;  ///< k = 1/extent
  SnappedVertex out_;
};

/// The binary places of vertices and attributes lie so close together that so many bits hold what is made of them.
bool all_fit(int bits, const WindowQuad& quad, const Config& config) {
  for (std::size_t i = 0; i < 4; ++i) {
    const WindowVertex& v = quad.vertex[i];
    NumberSpan position, depth, values;
    for (const double at : {v.x, v.y, v.w}) position.add(at, config.pos_int());
    depth.add(v.z);
    depth.add(v.w, config.depth_bits);
    values.add(1.0, config.attribute_frac());
    for (const double a : quad.attribute[i]) values.add(a);
    if (!position.fits(bits) || !depth.fits(bits) || !values.fits(bits)) return false;
  }
  return true;
}

double attribute_of(const WindowQuad& quad, std::size_t vertex, std::size_t slot) {
  return slot < quad.attribute[vertex].size() ? quad.attribute[vertex][slot] : 0.0;
}

/// Calls f and says of which vertex a rejection is.
template <class F>
void naming_vertex(const WindowQuad& quad, std::size_t vertex, F&& f) {
  try {
    f();
  } catch (const Rejected& r) {
    throw SnapError(quad.id, static_cast<int>(vertex), describe(quad.vertex[vertex]) + ": " + r.what);
  }
}

template <class Integer>
SnappedQuad snap_exactly(const WindowQuad& quad, std::size_t attributes, const Config& config, const DrawState& state) {
  SnappedQuad out;
  out.id = quad.id;
  QuadBase& base = out.base;
  for (std::size_t j = 0; j < attributes; ++j) {
    const auto first = exact<Integer>(attribute_of(quad, 0, j));
    const std::int64_t size =
        round_half_even(quotient_floor(first, exact_integer<Integer>(1), config.attribute_frac() + 1));
    base.attribute[j] = (first.neg ? -1 : 1) * std::min(size, config.attribute_limit());
  }
  // Depths of vertices behind the eye are on no side of a pixel's.
  const auto in_front = [](const WindowVertex& v) { return positive(v.w); };
  const bool bounded = std::ranges::all_of(quad.vertex, in_front);
  base.depth_high = bounded ? -1 : config.depth_above();
  base.depth_low = bounded ? config.depth_above() : -1;
  std::array<std::optional<VertexSnapper<Integer>>, 4> snappers;
  for (std::size_t i = 0; i < 4; ++i) naming_vertex(quad, i, [&] { snappers[i].emplace(quad.vertex[i], config); });
  const auto anchor = static_cast<std::size_t>(std::ranges::find_if(quad.vertex, in_front) - quad.vertex.begin());
  if (anchor < 4) base.depth = snappers[anchor]->base_depth();

  for (std::size_t i = 0; i < 4; ++i)
    naming_vertex(quad, i, [&] {
      const VertexSnapper<Integer>& snapper = *snappers[i];
      SnappedVertex& v = out.vertex[i];
      v = snapper.position();
      v.z = snapper.times_k(snapper.depth_above(base.depth));
      if (bounded) {
        const std::int32_t code = snapper.corner_depth();
        base.depth_low = std::min(base.depth_low, code);
        base.depth_high = std::max(base.depth_high, code);
      }
      if (i == 0) return;
      for (std::size_t j = 0; j < attributes; ++j) {
        const double value = attribute_of(quad, i, j);
        if (value == attribute_of(quad, 0, j)) continue;  // a constant stays one, whatever its base was rounded to
        const Exact<Integer> above =
            exact<Integer>(value) - exact_integer<Integer>(base.attribute[j]).scaled(-config.attribute_frac());
        v.attribute[j] = state.perspective ? snapper.times_k(above) : snapper.times_w(above);
      }
    });
  return out;
}

SnappedQuad snap_any(const WindowQuad& quad, const Config& config, const DrawState& state) {
  std::size_t attributes = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t count = std::min(quad.attribute[i].size(), static_cast<std::size_t>(config.attribute_slots));
    attributes = std::max(attributes, count);
    naming_vertex(quad, i, [&] {
      check_vertex(quad.vertex[i]);
      for (std::size_t j = 0; j < count; ++j) check_attribute(quad.attribute[i][j], j, config);
    });
  }
  if (all_fit(128, quad, config)) return snap_exactly<NarrowInteger>(quad, attributes, config, state);
  if (all_fit(256, quad, config)) return snap_exactly<MiddleInteger>(quad, attributes, config, state);
  return snap_exactly<WideInteger>(quad, attributes, config, state);
}

}  // namespace

SnapError::SnapError(std::uint32_t quad_id, int vertex_index, const std::string& what)
    : std::runtime_error("quad " + std::to_string(quad_id) + ", vertex " + std::to_string(vertex_index) + ": " + what),
      quad(quad_id),
      vertex(vertex_index) {}

SnappedQuad snap_quad(const WindowQuad& quad, const Config& config, const DrawState& state) {
  // A configuration is checked with its first quad, not with each.
  thread_local std::optional<Config> checked;
  if (checked != config) {
    checked.reset();
    config.validate();
    checked = config;
  }
  if (config.quad_id_bits < 32 && quad.id >> config.quad_id_bits)
    throw SnapError(quad.id, 0, "the quad id does not fit quad_id_bits = " + std::to_string(config.quad_id_bits));
  const std::size_t attributes = std::min(quad.attribute[0].size(), static_cast<std::size_t>(config.attribute_slots));
  const auto as_many = [&](const std::vector<double>& a) { return a.size() == quad.attribute[0].size(); };
  SnappedQuad out;
  out.id = quad.id;
  if (!std::ranges::all_of(quad.attribute, as_many) || !quick_snap(quad, attributes, config, state, out))
    out = snap_any(quad, config, state);
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
