// The stages behind the front, normalise to fragment_output, each on what the stage before gave: every bit by
// rtl/SPEC.md in exact numbers. The tables' own values are taken as they come (arithmetic_check.cpp judges
// them).
#include "model/pixel_pipeline.hpp"
#include "model/support/prng.hpp"
#include "tb/check/exact_number.hpp"
#include "tb/check/function_tally.hpp"
#include "tb/check/judged_quad.hpp"

#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

namespace quadrille::cli {
namespace {

using exact::Number;
using exact::sign_of;
using exact::Term;
using exact::value_of;
using exact::Wide;
using golden::Prng;

constexpr int pixels_per_state = 300, slots = 500;

/// A pixel as the front hands it over, and what the truth of its class is.
struct Pixel {
  std::array<std::int64_t, 4> x{}, y{};  ///< S_i in units of 2^-FRAC px
  PixelTrace trace;
  QuadData quad;
  int corners = 0, edges = 0;
  std::array<bool, 4> corner{}, edge{}, differ{};

  bool two_corner() const { return corners > 1; }
  bool on_vertex() const { return corners == 1; }
  bool two_edge() const { return corners == 0 && edges > 1; }
  bool singular() const { return corners > 0 || two_edge(); }
};

class StageCheck {
 public:
  StageCheck(const Config& config, const DrawState& state, Prng& rng)
      : config_(config), state_(state), context_(config, state), rng_(rng), s_(config.significand_bits) {}

  void run(std::array<FunctionTally*, 5> tallies) {
    for (int n = 0; n < pixels_per_state; ++n) {
      Pixel p = random_pixel(n);
      PixelTrace& t = p.trace;
      normalise(t, context_);
      tally(*tallies[0], p, normalised(p));
      sqrt_stage(t, context_);
      mean_value_ratios(t, context_);
      tally(*tallies[1], p, ratios(p));
      mean_value_weights(t, p.quad, context_);
      tally(*tallies[2], p, weights(p));
      interpolate(t, p.quad, context_);
      tally(*tallies[3], p, sums(p));
      fragment_output(t, p.quad, context_);
      tally(*tallies[4], p, output(p));
    }
  }

 private:
  static void tally(FunctionTally& into, const Pixel& p, const std::string& wrong) {
    into.expect(wrong.empty(), [&] {
      std::string text = wrong + " at S =";
      for (std::size_t i = 0; i < 4; ++i) text += " (" + std::to_string(p.x[i]) + ", " + std::to_string(p.y[i]) + ")";
      return text;
    });
  }

  // ---- Input ----

  PipelineFloat float_of(const Number& v) const {
    const Number r = exact::cut(v, s_);
    if (r.zero()) return {};
    const int exponent = r.exponent(), shift = exponent - (s_ - 1) - r.e;
    const Wide m = exact::magnitude(r.m);
    return {r.m < 0, exponent, static_cast<std::uint32_t>(shift >= 0 ? m >> shift : m << -shift)};
  }

  PipelineFloat random_float(int exponents) {
    const std::uint32_t half = 1u << (s_ - 1);
    return {rng_.chance(0.5), static_cast<int>(rng_.integer(-exponents, exponents)),
            rng_.chance(0.25) ? half : half + static_cast<std::uint32_t>(rng_.below(half))};
  }

  std::int64_t coordinate(int kind) {
    const std::int64_t reach = kind % 3 == 0 ? 3 : std::int64_t{1} << rng_.below(config_.pos_int() + config_.frac());
    return rng_.integer(-reach, reach);
  }

  Pixel random_pixel(int kind) {
    Pixel p;
    for (std::size_t i = 0; i < 4; ++i) p.x[i] = coordinate(kind), p.y[i] = coordinate(kind);
    const auto set = [&](std::size_t to, std::size_t from, std::int64_t cosine, std::int64_t sine) {
      const std::int64_t x = p.x[from], y = p.y[from];
      p.x[to] = cosine * x - sine * y;
      p.y[to] = sine * x + cosine * y;
    };
    const std::size_t first = rng_.below(4), next = (first + 1) % 4, third = (first + 2) % 4, last = (first + 3) % 4;
    switch (kind % 8) {
      case 2:  // one corner at the pixel
        p.x[first] = p.y[first] = 0;
        break;
      case 3:  // two, and then perhaps more edges
        set(first, first, 0, 0);
        set(rng_.chance(0.5) ? next : third, first, 0, 0);
        break;
      case 4:  // an edge through the pixel
        set(next, first, -rng_.integer(1, 2), 0);
        break;
      case 5:  // two edges: neighbours, or opposite ones
        set(next, first, -1, 0);
        if (rng_.chance(0.5))
          set(third, next, -1, 0);
        else
          set(last, third, -1, 0);
        break;
      case 6:  // D = 0 on an edge, or on a diagonal
        set(rng_.chance(0.5) ? next : third, first, 0, rng_.chance(0.5) ? 1 : -1);
        break;
      default:
        break;
    }
    derive(p);
    random_quad(p);
    return p;
  }

  /// A, D, r² and the class, as rtl/SPEC.md defines them.
  void derive(Pixel& p) const {
    PixelTrace& t = p.trace;
    const int drop = config_.qdrop();
    for (std::size_t k = 0; k < 6; ++k) {
      const auto [i, j] = vertex_pair[k];
      t.a[k] = static_cast<std::int64_t>(Wide{p.x[i]} * p.y[j] - Wide{p.y[i]} * p.x[j]);
      t.d[k] = static_cast<std::int64_t>((Wide{p.x[i]} * p.x[j] + Wide{p.y[i]} * p.y[j]) >> drop);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      t.r2[i] = static_cast<std::int64_t>((Wide{p.x[i]} * p.x[i] + Wide{p.y[i]} * p.y[i]) >> drop);
      p.corners += p.corner[i] = t.r2[i] <= 0;
      p.edges += p.edge[i] = t.a[i] == 0 && t.d[i] < 0;
      p.differ[i] = sign_of(t.a[(i + 3) % 4]) * sign_of(t.a[i]) < 0;
    }
  }

  void random_quad(Pixel& p) {
    PixelTrace& t = p.trace;
    t.valid = true;
    t.x = static_cast<int>(rng_.below(64));
    t.y = static_cast<int>(rng_.below(64));
    t.front = rng_.chance(0.5);
    t.tie = rng_.chance(0.5);
    t.hull = p.quad.hull = rng_.chance(0.25);
    t.homogeneous = p.quad.homogeneous = rng_.chance(0.5);
    const bool at_infinity = rng_.chance(0.05);
    const Number steps[] = {{1, -config_.depth_bits}, {1, -config_.depth_bits - 1}, {1, -s_ - 2}};
    // Bases anywhere or at their ends; corner codes anywhere, often all of the range.
    QuadBase& base = p.quad.base;
    const std::int64_t largest = attribute_format(config_).largest_code();
    for (std::int64_t& a : base.attribute)
      a = rng_.chance(0.2) ? (rng_.chance(0.5) ? largest : -largest) : rng_.integer(-largest, largest);
    const std::int64_t whole = std::int64_t{1} << config_.depth_bits;
    base.depth = static_cast<std::uint32_t>(rng_.chance(0.2) ? (rng_.chance(0.5) ? whole : 0) : rng_.integer(0, whole));
    base.depth_low = -1;
    base.depth_high = static_cast<std::int32_t>(whole + 1);
    if (rng_.chance(0.5)) {
      const auto a = static_cast<std::int32_t>(rng_.integer(-1, whole + 1)),
                 b = static_cast<std::int32_t>(rng_.integer(-1, whole + 1));
      base.depth_low = std::min(a, b);
      base.depth_high = std::max(a, b);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      const std::int64_t one = std::int64_t{1} << config_.frac();
      const std::int64_t w = at_infinity ? 0 : rng_.chance(0.5) ? one : rng_.integer(-one, one);
      p.quad.w[i] = float_of({w, -config_.frac()});
      p.quad.k[i] = state_.perspective ? random_float(6) : p.quad.w[i];
      p.quad.k[i].neg = p.quad.k[i].neg && !state_.perspective;
      p.quad.z[i] = random_float(2);
      // On a limit of z, or next to it; with w = 1 and at a corner the machine is exact.
      if (rng_.chance(0.5)) {
        const double limit = rng_.chance(0.5) ? state_.znear : state_.zfar;
        Number z{static_cast<Wide>(std::ldexp(limit, 40)), -40};
        z.m -= Wide{p.quad.base.depth} << (40 - config_.depth_bits);
        const Number& step = steps[rng_.below(3)];
        z.m += rng_.integer(-1, 1) * (Wide{1} << (40 + step.e));
        p.quad.z[i] = float_of(z);
      }
      for (std::size_t j = 0; i > 0 && j < max_attribute_slots; ++j) {
        p.quad.b[i][j] = random_float(config_.attribute_int_bits + 1);
        if (rng_.chance(0.1)) p.quad.b[i][j] = {};
      }
    }
    p.quad.id = 5;
  }

  // ---- Stages: what is wrong, or nothing ----

  bool same(const PipelineFloat& v, const Number& wanted) const { return exact::is(v, wanted, s_); }
  Number real(const PipelineFloat& v) const { return value_of(v, s_); }
  Number size(const PipelineFloat& v) const { return {exact::magnitude(real(v).m), real(v).e}; }
  Number multiply(const Number& a, const Number& b) const { return exact::cut(exact::product(a, b), s_); }
  template <std::size_t Count>
  Number sum(const std::array<Term, Count>& terms) const {
    return exact::sum(terms, s_, config_.align_guard_bits);
  }
  static Number positive(Number v) { return {exact::magnitude(v.m), v.e}; }

  std::string normalised(const Pixel& p) const {
    const PixelTrace& t = p.trace;
    for (std::size_t k = 0; k < 6; ++k) {
      if (!same(t.a_fp[k], exact::cut({t.a[k], -config_.qdrop()}, s_))) return "A[" + std::to_string(k) + "]";
      if (!same(t.d_fp[k], exact::cut({t.d[k], 0}, s_))) return "D[" + std::to_string(k) + "]";
    }
    for (std::size_t i = 0; i < 4; ++i)
      if (!same(t.r2_fp[i], exact::cut({std::max<std::int64_t>(t.r2[i], 0), 0}, s_)))
        return "r2[" + std::to_string(i) + "]";
    const bool right = t.two_corner == p.two_corner() && t.on_vertex == p.on_vertex() && t.two_edge == p.two_edge() &&
                       t.on_edge == (p.corners == 0 && p.edges == 1);
    if (!right) return "the class";
    const bool differ = p.differ[0] || p.differ[1] || p.differ[2] || p.differ[3];
    const bool notch = config_.notch_exact && differ && !p.singular();
    return t.notch == notch ? "" : notch ? "no notch" : "a notch";
  }

  std::string ratios(const Pixel& p) const {
    const PixelTrace& t = p.trace;
    for (std::size_t k = 0; k < 6; ++k) {
      const auto [i, j] = vertex_pair[k];
      const Number u = sum(std::array{Term{real(t.root[i]), real(t.root[j])}, Term{size(t.d_fp[k])}});
      if (!same(t.u[k], u)) return "u[" + std::to_string(k) + "]";
      if (!same(t.v[k], size(t.a_fp[k]))) return "v[" + std::to_string(k) + "]";
    }
    return "";
  }

  std::string weights(const Pixel& p) const {
    const PixelTrace& t = p.trace;
    const std::array<Number, 4> m = p.singular() ? singular_weights(p) : regular_weights(p);
    for (std::size_t i = 0; i < 4; ++i)
      if (!same(t.m[i], m[i])) return "M[" + std::to_string(i) + "]";
    return "";
  }

  /// sqrt(q_b / q_a) as {numerator, denominator}; q = r r' + D of an edge, r r' - D of a diagonal.
  std::array<Number, 2> root_ratio(const Pixel& p, std::size_t a, std::size_t b) const {
    const PixelTrace& t = p.trace;
    const auto u = [&](std::size_t k) { return real(t.u[k]); };
    const auto v = [&](std::size_t k) { return real(t.v[k]); };
    const auto adds = [&](std::size_t k) { return k < 4 ? t.d[k] >= 0 : t.d[k] < 0; };
    const Number root = real(fp_sqrt(float_of(multiply(u(a), u(b))), context_.sqrt_table, context_.format));
    if (adds(a) && adds(b)) return balanced(u(b), root);
    if (adds(a)) return balanced(v(b), root);
    if (adds(b)) return balanced(root, v(a));
    return balanced(multiply(v(b), u(a)), multiply(v(a), root));
  }

  /// Both times one power of two: then the numerator's exponent is half of their difference, rounded down. Beside a
  /// zero the other's is 0.
  static std::array<Number, 2> balanced(Number num, Number den) {
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

  /// M_0 : M_1 : M_2 : M_3 = abc : a : c : b with a² = q23/q01, b² = q12/q30, c² = q13/q20.
  std::array<Number, 4> regular_weights(const Pixel& p) const {
    const auto [an, ad] = root_ratio(p, 0, 2);
    const auto [bn, bd] = root_ratio(p, 3, 1);
    const auto [cn, cd] = root_ratio(p, 4, 5);
    return {multiply(multiply(an, bn), cn), multiply(multiply(an, bd), cd), multiply(multiply(ad, bd), cn),
            multiply(multiply(ad, bn), cd)};
  }

  std::array<Number, 4> singular_weights(const Pixel& p) const {
    std::array<Number, 4> out{};
    const auto lowest_two = [](const std::array<bool, 4>& is) {
      std::array<std::size_t, 2> at{};
      std::size_t found = 0;
      for (std::size_t i = 0; i < 4; ++i)
        if (is[i] && found < 2) at[found++] = i;
      return at;
    };
    if (p.corners > 0) {
      const auto [i, j] = lowest_two(p.corner);
      if (p.on_vertex()) {
        out[i] = {1, 0};
      } else {
        out[i] = positive(real(p.quad.k[j]));
        out[j] = positive(real(p.quad.k[i]));
      }
      return out;
    }
    const auto edges = lowest_two(p.edge);
    const auto denominator = [&](std::size_t e) {
      const std::size_t f = (e + 1) % 4;
      return positive(sum(
          std::array{Term{real(p.trace.root[f]), real(p.quad.k[e])}, Term{real(p.trace.root[e]), real(p.quad.k[f])}}));
    };
    for (std::size_t n = 0; n < 2; ++n) {
      const std::size_t e = edges[n], f = (e + 1) % 4;
      const Number other = denominator(edges[1 - n]);
      const auto add = [&](std::size_t at, const Number& term) {
        out[at] = out[at].zero() ? term : sum(std::array{Term{out[at]}, Term{term}});
      };
      add(e, multiply(real(p.trace.root[f]), other));
      add(f, multiply(real(p.trace.root[e]), other));
    }
    return out;
  }

  std::string sums(const Pixel& p) const {
    const PixelTrace& t = p.trace;
    const auto term = [&](std::size_t i, const PipelineFloat& v) { return Term{real(t.m[i]), real(v)}; };
    const auto of = [&](auto&& v) {
      return sum(std::array{term(0, v(0)), term(1, v(1)), term(2, v(2)), term(3, v(3))});
    };
    if (!same(t.den_k, of([&](std::size_t i) { return p.quad.k[i]; }))) return "sum of M k";
    if (!same(t.den_w, of([&](std::size_t i) { return p.quad.w[i]; }))) return "sum of M W";
    if (!same(t.num_z, of([&](std::size_t i) { return p.quad.z[i]; }))) return "sum of M Z";
    for (std::size_t j = 0; j < static_cast<std::size_t>(config_.attribute_slots); ++j)
      if (!same(t.num_a[j], sum(std::array{term(1, p.quad.b[1][j]), term(2, p.quad.b[2][j]), term(3, p.quad.b[3][j])})))
        return "sum of M b[" + std::to_string(j) + "]";
    return "";
  }

  /// num / den in codes by the machine's reciprocal, its magnitude to nearest and halves up; nothing where that is
  /// 2^int_bits or more. `size`: of the product, exactly.
  std::optional<Wide> quotient(const PipelineFloat& num, const PipelineFloat& den, int int_bits, int fraction) const {
    const Number q = exact::product(size(num), size(reciprocal(den, context_.recip_table, context_.format)));
    if (q.zero()) return 0;
    if (q.exponent() >= int_bits) return std::nullopt;
    // floor(2 q + 1 in half codes), halved.
    const Number twice = exact::truncated(q, -fraction - 1);
    const int up = std::min(twice.e + fraction + 1, 100);
    const Wide code = ((twice.m << up) + 1) >> 1;
    return num.neg != den.neg ? -code : code;
  }

  std::string output(const Pixel& p) const {
    const PixelTrace& t = p.trace;
    const Fragment& g = t.fragment;
    if (g.quad != p.quad.id || g.x != t.x || g.y != t.y || g.front != t.front) return "quad, x, y or front";
    bool saturated = false;
    const Wide limit = (Wide{1} << (config_.attribute_int_bits + config_.attribute_frac())) - 1;
    for (std::size_t j = 0; j < max_attribute_slots; ++j) {
      Wide wanted = 0;
      if (static_cast<int>(j) < state_.attributes) {
        const auto above = quotient(t.num_a[j], t.den_k, config_.attribute_int_bits + 1, config_.attribute_frac());
        const bool neg = t.num_a[j].neg != t.den_k.neg;
        const Wide value = above ? p.quad.base.attribute[j] + *above : neg ? -limit - 1 : limit + 1;
        wanted = std::clamp(value, -limit, limit);
        saturated = saturated || wanted != value;
      }
      if (g.attribute[j] != wanted)
        return "attribute " + std::to_string(j) + " " + std::to_string(g.attribute[j]) + ", expected " +
               std::to_string(static_cast<std::int64_t>(wanted));
    }
    unsigned flags = 0;
    const auto expect = [&](FragmentFlag flag, bool set) { flags |= set ? static_cast<unsigned>(flag) : 0u; };
    expect(flag_on_edge, p.corners == 0 && p.edges == 1);
    expect(flag_on_vertex, p.on_vertex());
    expect(flag_two_corner, p.two_corner());
    expect(flag_two_edge, p.two_edge());
    expect(flag_tie, t.tie);
    expect(flag_homogeneous, t.homogeneous);
    expect(flag_notch, t.notch);
    expect(flag_saturated, saturated);
    if (g.flags != flags) return "flags " + std::to_string(g.flags) + ", expected " + std::to_string(flags);

    bool drawn = !p.quad.hull || (!t.den_w.neg && t.den_w.sig != 0);
    std::int64_t depth = 0;
    if (state_.depth) {
      const QuadBase& base = p.quad.base;
      const bool nothing = t.den_w.sig == 0;  // counts as too large a quotient
      const auto above = nothing ? std::optional<Wide>() : quotient(t.num_z, t.den_w, 1, config_.depth_bits);
      const bool neg = !nothing && t.num_z.neg != t.den_w.neg;
      Wide z = above ? Wide{base.depth} + *above : neg ? base.depth_low : base.depth_high;
      z = std::clamp<Wide>(z, base.depth_low, base.depth_high);
      drawn = drawn && DepthLimits(config_, state_).holds(static_cast<std::int64_t>(z));
      depth = std::max<std::int64_t>(static_cast<std::int64_t>(z), 0);
    }
    if (g.depth != depth) return "depth " + std::to_string(g.depth) + ", expected " + std::to_string(depth);
    return t.drawn == drawn ? "" : drawn ? "discarded" : "not discarded";
  }

  const Config& config_;
  const DrawState& state_;
  const PipelineContext context_;
  Prng& rng_;
  const int s_;
};

/// What the slots hold of a quad: the port's numbers (no attribute of vertex 0) and bases, and W truncated to S bits,
/// which is k too without perspective; zeros for what skip_operands holds.
void check_quad_data(const Config& config, Prng& rng, FunctionTally& tally) {
  const int s = config.significand_bits;
  const auto number = [&] {
    const std::uint32_t half = 1u << (s - 1);
    return PortNumber{rng.chance(0.5), static_cast<int>(rng.integer(-200, 200)),
                      half + static_cast<std::uint32_t>(rng.below(half))};
  };
  const std::int64_t one = std::int64_t{1} << config.frac();
  for (int n = 0; n < slots; ++n) {
    SnappedQuad quad;
    quad.id = static_cast<std::uint32_t>(n);
    SetupResult setup;
    setup.homogeneous = rng.chance(0.5);
    setup.hull = rng.chance(0.5);
    for (std::int64_t& base : quad.base.attribute) base = rng.integer(-one, one);
    quad.base.depth = static_cast<std::uint32_t>(rng.below(1 << 20));
    quad.base.depth_low = static_cast<std::int32_t>(rng.integer(-1, 10));
    quad.base.depth_high = static_cast<std::int32_t>(rng.integer(10, 1 << 20));
    for (SnappedVertex& v : quad.vertex) {
      v.w = static_cast<std::int32_t>(rng.chance(0.2) ? one : rng.integer(-one, one));
      v.k = number();
      v.k.neg = false;
      v.z = number();
      for (PortNumber& b : v.attribute) b = number();
    }
    DrawState state;
    state.perspective = rng.chance(0.5);
    state.depth = rng.chance(0.5);
    state.attributes = static_cast<int>(rng.integer(0, config.attribute_slots));
    state.skip = rng.chance(0.5) ? std::uint32_t{skip_operands} : 0u;
    // Numbers that no fragment depends on are held at zero: W says, where the hull holds the eye, what is behind it.
    const bool held = (state.skip & skip_operands) != 0;
    const bool needs_z = !held || state.depth, needs_w = needs_z || setup.hull;
    const auto needs_b = [&](std::size_t j) { return !held || j < static_cast<std::size_t>(state.attributes); };
    const QuadData d = quad_data(quad, setup, config, state);
    bool right = d.id == quad.id && d.homogeneous == setup.homogeneous && d.hull == setup.hull && d.base == quad.base;
    for (std::size_t i = 0; i < 4; ++i) {
      const SnappedVertex& v = quad.vertex[i];
      const Number w = exact::cut({v.w, -config.frac()}, s);
      right = right && exact::is(d.w[i], needs_w ? w : Number{}, s) &&
              exact::is(d.k[i], state.perspective ? value_of(v.k, s) : w, s) &&
              exact::is(d.z[i], needs_z ? value_of(v.z, s) : Number{}, s);
      for (std::size_t j = 0; j < static_cast<std::size_t>(config.attribute_slots); ++j)
        right = right && exact::is(d.b[i][j], i > 0 && needs_b(j) ? value_of(v.attribute[j], s) : Number{}, s);
    }
    tally.expect(right, [&] { return "of quad " + std::to_string(n) + " differs from what was sent"; });
  }
}

}  // namespace

void check_pixel_stages(const Config& config, std::vector<FunctionResult>& results) {
  FunctionTally data("quad_data"), normal("normalise"), ratio("mean_value_ratios"), weight("mean_value_weights"),
      sums("interpolate"), output("fragment_output");
  Prng rng(2);
  check_quad_data(config, rng, data);
  struct Limits {
    double znear, zfar;
  };
  for (const Limits& limits : {Limits{0, 1}, Limits{0.25, 0.75}, Limits{0.5, 0.5}})
    for (const bool perspective : {true, false}) {
      DrawState state;
      state.znear = limits.znear;
      state.zfar = limits.zfar;
      state.perspective = perspective;
      state.depth = perspective || limits.znear > 0;
      state.attributes = perspective ? config.attribute_slots : config.attribute_slots - 1;
      StageCheck(config, state, rng).run({&normal, &ratio, &weight, &sums, &output});
    }
  for (const FunctionTally* tally : {&data, &normal, &ratio, &weight, &sums, &output})
    results.push_back(tally->result());
}

}  // namespace quadrille::cli
