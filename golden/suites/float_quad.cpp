#include "golden/suites/float_quad.hpp"

#include "golden/reference/port_number.hpp"
#include "golden/suites/float_cover.hpp"

#include <algorithm>
#include <cmath>

namespace quadrille::vectors {

using namespace floating;

namespace {

VectorOutcome undefined() { return {VectorOutcome::Kind::undefined, {}, false}; }

}  // namespace

FloatQuad::FloatQuad(const SnappedQuad& quad, const Config& config, const DrawState& state)
    : quad_(quad), config_(config), state_(state), paper_(quad, config, state) {
  const Visibility seen = visibility(quad, config);
  visible_ = seen.visible;
  visible_decided_ = seen.decided;
  hull_ = seen.hull;
  const int s = config.significand_bits;
  for (std::size_t i = 0; i < 4; ++i) {
    const SnappedVertex& v = quad.vertex[i];
    const double w = std::ldexp(static_cast<double>(v.w), -config.frac());
    homogeneous_ = homogeneous_ || w != 1;
    behind_ = behind_ || w <= 0;
    place_[i] = (std::fabs(static_cast<double>(v.x)) + std::fabs(static_cast<double>(v.y))) /
                std::fabs(static_cast<double>(v.w));
    k_over_w_[i] = golden::port_value(v.k, s) / w;
    z_over_w_[i] = golden::port_value(v.z, s) / w;
    for (std::size_t j = 0; i > 0 && j < max_attribute_slots; ++j)
      b_over_w_[j][i] = golden::port_value(v.attribute[j], s) / w;
  }
}

bool FloatQuad::must_draw(int x, int y) const {
  if (hull_ || !visible_decided_) return false;
  // No depth is beyond the corners'.
  if (state_.depth && (quad_.base.depth_low < std::int64_t{depth_code(state_.znear, config_)} ||
                       quad_.base.depth_high > std::int64_t{depth_code(state_.zfar, config_)}))
    return false;
  const PixelEdges at(quad_, x, y);
  const PixelCover pixel = cover(at.e, at.gx, at.gy, visible_, state_.cull);
  return pixel.decided && pixel.covered;
}

VectorOutcome FloatQuad::check(const Fragment& g) const {
  Judge judge;
  const int x = g.x, y = g.y;
  judge.within("x", -1, x, state_.scissor_x0, state_.scissor_x1 - 1);
  judge.within("y", -1, y, state_.scissor_y0, state_.scissor_y1 - 1);

  // Coverage, facing and the singular class: integers.
  const PixelEdges at(quad_, x, y);
  const auto &sx = at.sx, &sy = at.sy;
  const auto& e = at.e;
  std::array<IntegerSum, 4> d{};
  bool decided = true;
  for (std::size_t n = 0; n < 4; ++n) {
    const auto [i, j] = vertex_pair[n];
    d[n].add(sx[i] * sx[j]);
    d[n].add(sy[i] * sy[j]);
    decided = decided && d[n].decided();
  }
  const PixelCover pixel = cover(e, at.gx, at.gy, visible_, state_.cull);
  if (pixel.decided && visible_decided_) {
    if (!pixel.covered)
      judge.differs("x: the quad does not cover pixel (" + std::to_string(x) + ", " + std::to_string(y) + ")");
    judge.same("front", -1, g.front, pixel.front);
  } else {
    judge.undecided();
  }
  const SingularClass is = singular_class([&](std::size_t i) { return sx[i] == 0 && sy[i] == 0; },
                                          [&](std::size_t i) { return e[i].sign() == 0 && d[i].sign() < 0; });
  bool notch = false;
  for (std::size_t i = 0; i < 4; ++i) notch = notch || e[(i + 3) % 4].sign() * e[i].sign() < 0;
  if (pixel.decided && decided) {
    unsigned expected = 0, known = 0;
    const auto expect = [&](FragmentFlag flag, bool set) {
      known |= flag;
      if (set) expected |= flag;
    };
    expect(flag_tie, pixel.tie);
    expect(flag_homogeneous, homogeneous_);
    if (config_.qdrop() == 0) {  // else the machine sees D and r² with bits missing
      expect(flag_on_edge, is.on_edge());
      expect(flag_on_vertex, is.on_vertex());
      expect(flag_two_corner, is.two_corner());
      expect(flag_two_edge, is.two_edge());
      expect(flag_notch, config_.notch_exact && notch && is.corners == 0 && is.edges < 2);
    }
    judge.same("flags", -1, g.flags & known, expected);
  }
  for (std::size_t j = 0; j < static_cast<std::size_t>(config_.attribute_slots); ++j)
    if (j >= static_cast<std::size_t>(state_.attributes))
      judge.same("attr", static_cast<int>(j), static_cast<Real>(g.attribute[j]), 0);
  if (state_.depth)
    judge.within("depth", -1, g.depth, depth_code(state_.znear, config_), depth_code(state_.zfar, config_));
  else
    judge.same("depth", -1, g.depth, 0);

  const VectorOutcome shape = judge.outcome();
  if (shape.kind == VectorOutcome::Kind::mismatch) return shape;
  VectorOutcome values = is.corners + is.edges > 0 ? undefined() : check_values(g);
  if (values.kind == VectorOutcome::Kind::match) return shape;
  values.compared = true;  // the shape was
  return values;
}

/// The machine's weights lambda' err by at most 2^-(s-3), so an attribute by that times the sum of |a_i - base|, and
/// each M by at most twice that, relatively; where weights may cancel (z, and attributes without perspective behind the
/// eye) this multiplies the terms. Half an output code is lost on top.
///
/// The paper's formulas in double: with e = 2^-52 a corner's s = v - p is off by ds = e (|v| + |p|), r and A, D by ds
/// times lengths, t = (r r' - D)/A by 3 dA (1 + |t|)/|A|, mu by the sum of its dt over r; quotients of sums of mu
/// follow. Where that is above the machine's own tolerance double has no answer.
VectorOutcome FloatQuad::check_values(const Fragment& g) const {
  // Dropped bits of D and r² that ordinary vertices have leave the machine without a bound.
  if (config_.quadratic_frac() < 2 * config_.subpixel_bits) return undefined();
  const golden::PaperFp64Quad::Pixel p = paper_.interpolate(g.x, g.y);
  if (!p.defined) return undefined();

  constexpr double epsilon = 0x1p-52;
  std::array<double, 4> ds{}, dt{}, dmu{};
  for (std::size_t i = 0; i < 4; ++i) ds[i] = epsilon * (place_[i] + g.x + g.y);
  double sum_mu = 0, size_mu = 0, error_mu = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = (i + 1) % 4;
    const double ri = std::fabs(p.r[i]), rj = std::fabs(p.r[j]), area = std::fabs(p.area[i]);
    const double da = ds[i] * rj + ds[j] * ri + 2 * epsilon * ri * rj;
    if (ds[i] > ri / 16 || da > area / 16) return undefined();
    dt[i] = 3 * da * (1 + std::fabs(p.t[i])) / area;
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t before = (i + 3) % 4;
    const double r = std::fabs(p.r[i]);
    dmu[i] = (dt[before] + dt[i]) / r + std::fabs(p.mu[i]) * 2 * (ds[i] / r + epsilon);
    sum_mu += p.mu[i];
    size_mu += std::fabs(p.mu[i]);
    error_mu += dmu[i];
  }
  const double bound = std::ldexp(1.0, 3 - config_.significand_bits);

  Judge judge;
  if (hull_) {
    // In front of the eye where sum(M W) > 0, that is sum(lambda / w) > 0.
    if (std::fabs(sum_mu) <= 2 * bound * size_mu + 2 * error_mu) return undefined();
    if (!(p.sum_inverse_w > 0)) judge.differs("x: the pixel is behind the eye");
  }

  struct Quotient {
    double value, rounding, by_weights, by_lambda;
  };
  // sum(mu c) / sum(mu f); the errors of double, and of the machine with relative errors of M or errors of lambda'.
  const auto quotient = [&](const std::array<double, 4>& c, const std::array<double, 4>& f) {
    double num = 0, den = 0, error_num = 0, error_den = 0, size_num = 0, size_den = 0, values = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      num += p.mu[i] * c[i];
      den += p.mu[i] * f[i];
      size_num += std::fabs(p.mu[i] * c[i]);
      size_den += std::fabs(p.mu[i] * f[i]);
      error_num += dmu[i] * std::fabs(c[i]);
      error_den += dmu[i] * std::fabs(f[i]);
      values += std::fabs(c[i] / f[i]);
    }
    const double value = num / den, size = (size_num + std::fabs(value) * size_den) / std::fabs(den);
    double rounding_error = 2 * (error_num + std::fabs(value) * error_den) / std::fabs(den) + 8 * epsilon * size;
    if (error_den > std::fabs(den) / 16) rounding_error = HUGE_VAL;
    return Quotient{value, rounding_error, 2 * bound * size, bound * values};
  };
  // The code must be within tolerance of the value, clamped to where it may be.
  const auto compare = [&](const char* name, int index, double actual, double value, double tolerance,
                           double rounding_error, double low, double high) {
    if (!(rounding_error <= tolerance)) return judge.undecided();
    tolerance += rounding_error;
    judge.within(name, index, actual, std::clamp(value - tolerance, low, high),
                 std::clamp(value + tolerance, low, high));
  };

  const std::array<double, 4> ones{1, 1, 1, 1};
  if (state_.depth) {
    const Quotient z = quotient(z_over_w_, ones);
    const double code = std::ldexp(1.0, -config_.depth_bits);
    compare("depth", -1, g.depth * code, quad_.base.depth * code + z.value, z.by_weights + code / 2, z.rounding,
            quad_.base.depth_low * code, quad_.base.depth_high * code);
  }
  const double limit = std::ldexp(1.0, config_.attribute_int_bits), code = std::ldexp(1.0, -config_.attribute_frac());
  bool may_saturate = false, must_saturate = false;
  for (int j = 0; j < state_.attributes; ++j) {
    const auto slot = static_cast<std::size_t>(j);
    const Quotient a = quotient(b_over_w_[slot], state_.perspective ? k_over_w_ : ones);
    const double tolerance = (!state_.perspective && behind_ ? a.by_weights : a.by_lambda) + code / 2;
    const double value = static_cast<double>(quad_.base.attribute[slot]) * code + a.value;
    const double size = std::fabs(value), doubt = tolerance + a.rounding;
    may_saturate = may_saturate || !(size + doubt < limit - code);
    must_saturate = must_saturate || size - doubt >= limit;
    compare("attr", j, static_cast<double>(g.attribute[slot]) * code, value, tolerance, a.rounding, code - limit,
            limit - code);
  }
  if (may_saturate == must_saturate && ((g.flags & flag_saturated) != 0) != must_saturate)
    judge.differs(std::string("flags: ") +
                  (must_saturate ? "not saturated, but an attribute is" : "saturated, but no attribute is"));
  return judge.outcome();
}

}  // namespace quadrille::vectors
