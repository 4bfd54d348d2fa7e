// The stages of a pixel behind the front: every bit by rtl/SPEC.md, Pixel pipeline, in exact
// numbers.
#include "golden/analysis/judged_quad.hpp"
#include "tb/judge/drawn_depths.hpp"
#include "tb/judge/stage_judge.hpp"

namespace quadrille::tb {

using exact::Number;
using exact::sign_of;
using exact::Term;
using exact::Wide;

namespace {

/// Both times one power of two: then the numerator's exponent is half of their difference, rounded down. Beside a
/// zero the other's is 0.
std::array<Number, 2> balanced(Number num, Number den) {
  if (num.zero()) {
    if (!den.zero()) den.e -= den.exponent();
    return {num, den};
  }
  if (den.zero()) {
    num.e -= num.exponent();
    return {num, den};
  }
  const int n = num.exponent(), twice = n - den.exponent();
  const int half = (twice - (twice % 2 != 0 && twice < 0 ? 1 : 0)) / 2;
  num.e += half - n;
  den.e += half - n;
  return {num, den};
}

}  // namespace

PixelJudge::Class::Class(const PixelTrace& t) {
  for (std::size_t i = 0; i < 4; ++i) {
    corners += corner[i] = t.r2[i] <= 0;
    edges += edge[i] = t.a[i] == 0 && t.d[i] < 0;
  }
}

bool PixelJudge::notch(const PixelTrace& t) const {
  bool differ = false;
  for (std::size_t i = 0; i < 4; ++i) differ = differ || sign_of(t.a[(i + 3) % 4]) * sign_of(t.a[i]) < 0;
  return context_.config.notch_exact && differ && !Class(t).singular();
}

std::string PixelJudge::normalised(const PixelTrace& t) const {
  const Class is(t);
  for (std::size_t k = 0; k < 6; ++k) {
    if (!same(t.a_fp[k], exact::cut({t.a[k], -context_.config.qdrop()}, s_))) return "A[" + std::to_string(k) + "]";
    if (!same(t.d_fp[k], exact::cut({t.d[k], 0}, s_))) return "D[" + std::to_string(k) + "]";
  }
  for (std::size_t i = 0; i < 4; ++i)
    if (!same(t.r2_fp[i], exact::cut({std::max<std::int64_t>(t.r2[i], 0), 0}, s_)))
      return "r2[" + std::to_string(i) + "]";
  const bool right = t.two_corner == is.two_corner() && t.on_vertex == is.on_vertex() && t.two_edge == is.two_edge() &&
                     t.on_edge == is.on_edge();
  return right ? "" : "the class";
}

std::string PixelJudge::ratios(const PixelTrace& t) const {
  for (std::size_t k = 0; k < 6; ++k) {
    const auto [i, j] = vertex_pair[k];
    const Number u = sum(std::array{Term{real(t.root[i]), real(t.root[j])}, Term{size(t.d_fp[k])}});
    if (!same(t.u[k], u)) return "u[" + std::to_string(k) + "]";
    if (!same(t.v[k], size(t.a_fp[k]))) return "v[" + std::to_string(k) + "]";
  }
  return "";
}

std::string PixelJudge::weights(const PixelTrace& t, const QuadData& quad) const {
  const Class is(t);
  const std::array<Number, 4> m = is.singular() ? singular_weights(t, is, quad) : regular_weights(t);
  for (std::size_t i = 0; i < 4; ++i)
    if (!same(t.m[i], m[i])) return "M[" + std::to_string(i) + "]";
  return "";
}

/// sqrt(q_b / q_a) as {numerator, denominator}; q = r r' + D of an edge, r r' - D of a diagonal.
std::array<Number, 2> PixelJudge::root_ratio(const PixelTrace& t, std::size_t a, std::size_t b) const {
  const auto u = [&](std::size_t k) { return real(t.u[k]); };
  const auto v = [&](std::size_t k) { return real(t.v[k]); };
  const auto adds = [&](std::size_t k) { return k < 4 ? t.d[k] >= 0 : t.d[k] < 0; };
  const Number root = real(fp_sqrt(exact::float_of(multiply(u(a), u(b)), s_), context_.sqrt_table, context_.format));
  if (adds(a) && adds(b)) return balanced(u(b), root);
  if (adds(a)) return balanced(v(b), root);
  if (adds(b)) return balanced(root, v(a));
  return balanced(multiply(v(b), u(a)), multiply(v(a), root));
}

/// M_0 : M_1 : M_2 : M_3 = abc : a : c : b with a² = q23/q01, b² = q12/q30, c² = q13/q20.
std::array<Number, 4> PixelJudge::regular_weights(const PixelTrace& t) const {
  const auto [an, ad] = root_ratio(t, 0, 2);
  const auto [bn, bd] = root_ratio(t, 3, 1);
  const auto [cn, cd] = root_ratio(t, 4, 5);
  return {multiply(multiply(an, bn), cn), multiply(multiply(an, bd), cd), multiply(multiply(ad, bd), cn),
          multiply(multiply(ad, bn), cd)};
}

std::array<Number, 4> PixelJudge::singular_weights(const PixelTrace& t, const Class& is, const QuadData& quad) const {
  std::array<Number, 4> out{};
  const auto lowest_two = [](const std::array<bool, 4>& set) {
    std::array<std::size_t, 2> at{};
    std::size_t found = 0;
    for (std::size_t i = 0; i < 4; ++i)
      if (set[i] && found < 2) at[found++] = i;
    return at;
  };
  if (is.corners > 0) {
    const auto [i, j] = lowest_two(is.corner);
    if (is.on_vertex()) {
      out[i] = {1, 0};
    } else {
      out[i] = positive(real(quad.k[j]));
      out[j] = positive(real(quad.k[i]));
    }
    return out;
  }
  const auto edges = lowest_two(is.edge);
  const auto denominator = [&](std::size_t e) {
    const std::size_t f = (e + 1) % 4;
    return positive(sum(std::array{Term{real(t.root[f]), real(quad.k[e])}, Term{real(t.root[e]), real(quad.k[f])}}));
  };
  for (std::size_t n = 0; n < 2; ++n) {
    const std::size_t e = edges[n], f = (e + 1) % 4;
    const Number other = denominator(edges[1 - n]);
    const auto add = [&](std::size_t at, const Number& term) {
      out[at] = out[at].zero() ? term : sum(std::array{Term{out[at]}, Term{term}});
    };
    add(e, multiply(real(t.root[f]), other));
    add(f, multiply(real(t.root[e]), other));
  }
  return out;
}

std::string PixelJudge::sums(const PixelTrace& t, const QuadData& quad) const {
  const auto term = [&](std::size_t i, const PipelineFloat& v) { return Term{real(t.m[i]), real(v)}; };
  const auto of = [&](auto&& v) { return sum(std::array{term(0, v(0)), term(1, v(1)), term(2, v(2)), term(3, v(3))}); };
  if (!same(t.den_k, of([&](std::size_t i) { return quad.k[i]; }))) return "sum of M k";
  if (!same(t.den_w, of([&](std::size_t i) { return quad.w[i]; }))) return "sum of M W";
  if (!same(t.num_z, of([&](std::size_t i) { return quad.z[i]; }))) return "sum of M Z";
  for (std::size_t j = 0; j < static_cast<std::size_t>(context_.config.attribute_slots); ++j)
    if (!same(t.num_a[j], sum(std::array{term(1, quad.b[1][j]), term(2, quad.b[2][j]), term(3, quad.b[3][j])})))
      return "sum of M b[" + std::to_string(j) + "]";
  return "";
}

/// num / den in codes by the machine's reciprocal, its magnitude to nearest and halves up; nothing where that is
/// 2^int_bits or more. `size`: of the product, exactly.
std::optional<Wide> PixelJudge::quotient(const PipelineFloat& num, const PipelineFloat& den, int int_bits,
                                         int fraction) const {
  const Number q = exact::product(size(num), size(reciprocal(den, context_.recip_table, context_.format)));
  if (q.zero()) return 0;
  if (q.exponent() >= int_bits) return std::nullopt;
  // floor(2 q + 1 in half codes), halved.
  const Number twice = exact::truncated(q, -fraction - 1);
  const int up = std::min(twice.e + fraction + 1, 100);
  const Wide code = ((twice.m << up) + 1) >> 1;
  return num.neg != den.neg ? -code : code;
}

PixelJudge::Output PixelJudge::output(const PixelTrace& t, const QuadData& quad, const DrawState& state) const {
  const Config& config = context_.config;
  const QuadBase& base = quad.base;
  Output out;
  const Wide limit = attribute_format(config).largest_code();
  for (std::size_t j = 0; j < static_cast<std::size_t>(state.attributes); ++j) {
    const auto above = quotient(t.num_a[j], t.den_k, config.attribute_int_bits + 1, config.attribute_frac());
    const bool neg = t.num_a[j].neg != t.den_k.neg;
    const Wide value = above ? base.attribute[j] + *above : neg ? -limit - 1 : limit + 1;
    out.attribute[j] = static_cast<std::int64_t>(std::clamp(value, -limit, limit));
    out.saturated = out.saturated || out.attribute[j] != value;
  }
  out.drawn = !quad.hull || (!t.den_w.neg && t.den_w.sig != 0);
  if (!state.depth) return out;
  const bool nothing = t.den_w.sig == 0;  // counts as too large a quotient
  const auto above = nothing ? std::optional<Wide>() : quotient(t.num_z, t.den_w, 1, config.depth_bits);
  const bool neg = !nothing && t.num_z.neg != t.den_w.neg;
  Wide z = above ? Wide{base.depth} + *above : neg ? base.depth_low : base.depth_high;
  z = std::clamp<Wide>(z, base.depth_low, base.depth_high);
  out.drawn = out.drawn && DepthLimits(config, state).holds(static_cast<std::int64_t>(z));
  out.depth = std::max<std::int64_t>(static_cast<std::int64_t>(z), 0);
  return out;
}

std::string PixelJudge::values_fault(const Fragment& g, const Output& expected) {
  const auto differs = [](const std::string& what, std::int64_t actual, std::int64_t wanted) {
    return what + " " + std::to_string(actual) + ", expected " + std::to_string(wanted);
  };
  for (std::size_t j = 0; j < max_attribute_slots; ++j)
    if (g.attribute[j] != expected.attribute[j])
      return differs("attr[" + std::to_string(j) + "]", g.attribute[j], expected.attribute[j]);
  return g.depth == expected.depth ? "" : differs("depth", g.depth, expected.depth);
}

}  // namespace quadrille::tb
