// The stages of a pixel from the normalisation to the fragment.
#include "golden/vectors/stage_of.hpp"
#include "golden/vectors/stage_suites.hpp"
#include "model/port/latency.hpp"

#include <algorithm>
#include <cmath>

namespace quadrille::vectors {
namespace {

// ---- Exponents that occur (rtl/SPEC.md, Numbers) ----

struct Exponents {
  int a_lo, a_hi;      ///< A: its bit 0 is 2^-QDROP beside D's
  int d_hi;            ///< D and r², from 0
  int root_hi;         ///< of r, from 0
  int u_hi;            ///< r r' + |D|, from 0
  int m_lo, m_hi;      ///< weights: within 2^±120, or of two edges a number of the port and two of r
  int sum_lo, sum_hi;  ///< sums: a weight times a number of the port, with cancellation

  explicit Exponents(const Config& c) {
    const int port = 1 << (Config::port_exp_bits - 1), cancelled = c.prec_bits() + 1;
    a_lo = -c.qdrop();
    a_hi = c.val_bits() - 2 - c.qdrop();
    d_hi = c.qval_bits() - 2;
    root_hi = c.qval_bits() / 2;
    u_hi = 2 * root_hi + 2;
    m_lo = -port - cancelled;
    m_hi = port + 2 * root_hi + 4;
    sum_lo = m_lo - port - cancelled;
    sum_hi = m_hi + port + 2;
  }
};

/// Zero has no sign and no exponent.
template <class Number>
void clear_zero(Number& v) {
  if (v.sig == 0) v = {};
}

double value_of(const PipelineFloat& v, int s) { return std::ldexp(static_cast<double>(v.sig), v.exp - (s - 1)); }

bool greater(const PipelineFloat& a, const PipelineFloat& b) {
  if (a.sig == 0 || b.sig == 0) return a.sig != 0;
  return a.exp != b.exp ? a.exp > b.exp : a.sig > b.sig;
}

/// Four vectors from the pixel to the corners, with A, D and r² exactly as the machine has them: parallel, opposite,
/// right-angled, equal and vanishing ones among random ones of any length.
void random_geometry(golden::Prng& prng, PixelTrace& p, const Config& c) {
  struct Vector {
    std::int64_t x, y;
  };
  std::array<Vector, 4> v{};
  const auto bits = static_cast<std::uint64_t>(c.pos_int() + c.frac());
  const std::uint64_t typical = prng.below(bits);
  for (std::size_t i = 0; i < 4; ++i) {
    const std::int64_t size = std::int64_t{1} << (prng.chance(0.8) ? typical : prng.below(bits + 1));
    v[i] = {prng.integer(-size, size), prng.integer(-size, size)};
    const Vector before = v[(i + 3) % 4];
    switch (prng.below(10)) {
      case 0:
        v[i] = {-before.x, -before.y};  // the pixel is the middle of the edge
        break;
      case 1:
        v[i] = {-before.y, before.x};
        break;
      case 2:
        v[i] = before;
        break;
      case 3:
        v[i] = {-before.x / 2, -before.y / 2};
        break;
      case 4:
        if (prng.chance(0.3)) v[i] = {0, 0};
        break;
      default:
        break;
    }
  }
  const auto dot = [&](std::size_t i, std::size_t j) { return (v[i].x * v[j].x + v[i].y * v[j].y) >> c.qdrop(); };
  for (std::size_t k = 0; k < 6; ++k) {
    const auto [i, j] = vertex_pair[k];
    p.a[k] = v[i].x * v[j].y - v[i].y * v[j].x;
    p.d[k] = dot(i, j);
  }
  for (std::size_t i = 0; i < 4; ++i) p.r2[i] = dot(i, i);
}

/// The same through the stages up to the ratios.
void random_ratios(golden::Prng& prng, StageData& d, const PipelineContext& c) {
  random_geometry(prng, d.pixel, c.config);
  normalise(d.pixel, c);
  sqrt_stage(d.pixel, c);
  mean_value_ratios(d.pixel, c);
  for (std::size_t i = 0; i < 4; ++i) {
    d.a_sign[i] = static_cast<std::int8_t>((d.pixel.a[i] > 0) - (d.pixel.a[i] < 0));
    d.corner[i] = d.pixel.r2[i] <= 0;
  }
  for (std::size_t k = 0; k < 6; ++k) d.d_negative[k] = d.pixel.d[k] < 0;
}

// ---- normalise ----

struct NormaliseLists {
  template <class D, class F>
  static void stimulus(D& d, const Config& c, F&& f) {
    auto& p = d.pixel;
    visit_array(
        f, reworded(exact_a(c), "A: edge functions, pairs 01 12 23 30 20 13"),
        6, [&](std::size_t i) -> auto& { return p.a[i]; });
    visit_array(
        f, exact_d(c), 6, [&](std::size_t i) -> auto& { return p.d[i]; });
    visit_array(
        f, reworded(exact_r2(c), "squared distances of the corners; below 0 counts as 0"),
        4, [&](std::size_t i) -> auto& { return p.r2[i]; });
  }

  template <class D, class F>
  static void response(D& d, const Config& c, F&& f) {
    visit(d.pixel, Boundary::norm, c, f);
  }
};

class Normalise : public StageOf<NormaliseLists> {
 public:
  explicit Normalise(const Config& config) : StageOf(config) {}
  void run(StageData& d) const override { normalise(d.pixel, context_); }

  FieldRange range(const RecordField& f) const override {
    const std::int64_t most = std::int64_t((std::uint64_t{1} << (f.width - 1)) - 1);
    return {f.name == "r2" ? -256 : -most, most};
  }

  void shape(golden::Prng& prng, StageData& d) const override { random_geometry(prng, d.pixel, config()); }

  void corners(const Sink& sink) const override {
    // Every combination of corners at the pixel, of edges through it, and of signs of A.
    StageData d;
    for (int corners = 0; corners < 16; ++corners)
      for (int edges = 0; edges < 16; ++edges)
        for (int signs = 0; signs < 16; signs += corners == 0 ? 1 : 5) {
          for (std::size_t i = 0; i < 4; ++i) {
            const bool edge = edges >> i & 1;
            d.pixel.a[i] = edge ? 0 : signs >> i & 1 ? 3 : -3;
            d.pixel.d[i] = edge || signs >> i & 1 ? -5 : 5;
            d.pixel.r2[i] = corners >> i & 1 ? 0 : 7;
          }
          sink(d);
        }
  }
};

// ---- sqrt ----

struct SqrtLists {
  template <class D, class F>
  static void stimulus(D& d, const Config& c, F&& f) {
    visit_numbers(
        f, magnitudes("exp", "sig", c, "r2 in units of 2^-QUADRATIC_FRAC px^2"),
        4, [&](std::size_t i) -> auto& { return d.pixel.r2_fp[i]; });
  }
  template <class D, class F>
  static void response(D& d, const Config& c, F&& f) {
    visit(d.pixel, Boundary::sqrt, c, f);
  }
};

class Sqrt : public StageOf<SqrtLists> {
 public:
  explicit Sqrt(const Config& config) : StageOf(config) {}
  void run(StageData& d) const override { sqrt_stage(d.pixel, context_); }

  FieldRange range(const RecordField& f) const override {
    return f.name == "exp" ? FieldRange{0, Exponents(config()).d_hi} : StageUnderTest::range(f);
  }
  void constrain(StageData& d) const override {
    for (PipelineFloat& v : d.pixel.r2_fp) clear_zero(v);
  }

  void corners(const Sink& sink) const override {
    // Both sides of every segment boundary in both octaves.
    const std::uint32_t lowest = std::uint32_t{1} << (config().significand_bits - 1);
    const std::uint32_t step = std::uint32_t{1} << context_.sqrt_table.rest_bits;
    for (std::uint32_t sig = lowest; sig < 2 * lowest; sig += step)
      for (const int exp : {20, 21}) {
        StageData d;
        d.pixel.r2_fp = {
            {{false, exp, sig}, {false, exp, sig + 1}, {false, exp, sig + step - 1}, {false, exp, sig + step / 2}}};
        sink(d);
      }
  }
};

// ---- reciprocal ----

struct ReciprocalLists {
  template <class D, class F>
  static void stimulus(D& d, const Config& c, F&& f) {
    visit_number(f, signed_numbers("neg", "exp", "sig", c, "the number"), d.number);
  }
  template <class D, class F>
  static void response(D& d, const Config& c, F&& f) {
    visit_number(f, signed_numbers("neg", "exp", "sig", c, "its reciprocal; of 0: 0"), d.inverse);
  }
};

class Reciprocal : public StageOf<ReciprocalLists> {
 public:
  explicit Reciprocal(const Config& config) : StageOf(config) {}
  void run(StageData& d) const override { d.inverse = reciprocal(d.number, context_.recip_table, context_.format); }

  FieldRange range(const RecordField& f) const override {
    const Exponents e(config());
    return f.name == "exp" ? FieldRange{e.sum_lo, e.sum_hi} : StageUnderTest::range(f);
  }
  void constrain(StageData& d) const override { clear_zero(d.number); }

  void corners(const Sink& sink) const override {
    const std::uint32_t lowest = std::uint32_t{1} << (config().significand_bits - 1);
    const std::uint32_t step = std::uint32_t{1} << context_.recip_table.rest_bits;
    StageData d;
    for (std::uint32_t sig = lowest; sig < 2 * lowest; sig += step)
      for (const std::uint32_t offset : {std::uint32_t{0}, std::uint32_t{1}, step / 2, step - 1}) {
        d.number = {offset % 2 == 1, static_cast<int>(offset) - 3, sig + offset};
        d.number.exp %= 64;
        sink(d);
      }
  }
};

// ---- ratios ----

template <class D, class F>
void visit_root(D& d, const Config& c, F&& f) {
  visit_numbers(
      f, magnitudes("root_exp", "root_sig", c, "r of the corners; 0: the pixel is at the corner"),
      4, [&](std::size_t i) -> auto& { return d.pixel.root[i]; });
}

struct RatiosLists {
  template <class D, class F>
  static void stimulus(D& d, const Config& c, F&& f) {
    auto& p = d.pixel;
    visit_numbers(
        f, magnitudes("a_exp", "a_sig", c, "|A|, pairs 01 12 23 30 20 13"),
        6, [&](std::size_t i) -> auto& { return p.a_fp[i]; });
    visit_numbers(
        f, signed_numbers("d_neg", "d_exp", "d_sig", c, "D, the same pairs"),
        6, [&](std::size_t i) -> auto& { return p.d_fp[i]; });
    visit_root(d, c, f);
  }
  template <class D, class F>
  static void response(D& d, const Config& c, F&& f) {
    visit(d.pixel, Boundary::ratio, c, f);
  }
};

class Ratios : public StageOf<RatiosLists> {
 public:
  explicit Ratios(const Config& config) : StageOf(config) {}
  void run(StageData& d) const override { mean_value_ratios(d.pixel, context_); }

  FieldRange range(const RecordField& f) const override {
    const Exponents e(config());
    if (f.name == "a_exp") return {e.a_lo, e.a_hi};
    if (f.name == "d_exp") return {0, e.d_hi};
    if (f.name == "root_exp") return {0, e.root_hi};
    return StageUnderTest::range(f);
  }

  void constrain(StageData& d) const override {
    PixelTrace& p = d.pixel;
    const int s = config().significand_bits;
    for (PipelineFloat& v : p.root) clear_zero(v);
    for (std::size_t k = 0; k < 6; ++k) {
      const double scale = value_of(p.root[vertex_pair[k][0]], s) * value_of(p.root[vertex_pair[k][1]], s);
      bound(p.a_fp[k], scale, Exponents(config()).a_lo);
      bound(p.d_fp[k], scale, 0);
    }
  }

  void shape(golden::Prng& prng, StageData& d) const override { random_ratios(prng, d, context_); }

 private:
  /// |A| and |D| are at most r r', but for rounding.
  void bound(PipelineFloat& v, double scale, int lowest) const {
    clear_zero(v);
    const double most = scale * (1 + std::ldexp(1.0, 2 - config().significand_bits));
    while (v.sig != 0 && value_of(v, config().significand_bits) > most) {
      --v.exp;
      if (v.exp < lowest) v = {};
    }
  }
};

// ---- weights ----

struct WeightsLists {
  template <class D, class F>
  static void stimulus(D& d, const Config& c, F&& f) {
    visit_array(
        f, FieldType{"a_sign", 2, true, {}, "", "sign of A of edges 01 12 23 30: -1, 0, 1"},
        4, [&](std::size_t i) -> auto& { return d.a_sign[i]; });
    visit_array(
        f, plain("d_negative", 1, "D < 0, pairs 01 12 23 30 20 13"),
        6, [&](std::size_t i) -> auto& { return d.d_negative[i]; });
    visit_array(
        f, plain("corner", 1, "r2 is at most 0: the pixel is at the corner"),
        4, [&](std::size_t i) -> auto& { return d.corner[i]; });
    visit_numbers(
        f, port_numbers("k_neg", "k_exp", "k_sig", c, "k of the corners; without perspective w"),
        4, [&](std::size_t i) -> auto& { return d.data.k[i]; });
    visit_root(d, c, f);
    visit(d.pixel, Boundary::ratio, c, f);
  }
  template <class D, class F>
  static void response(D& d, const Config& c, F&& f) {
    visit(d.pixel, Boundary::weight, c, f);
  }
};

class Weights : public StageOf<WeightsLists> {
 public:
  explicit Weights(const Config& config) : StageOf(config) {}

  void run(StageData& d) const override {
    PixelTrace& p = d.pixel;
    // Integers with the signs that the stage looks at; normalise() finds the singular class from them.
    for (std::size_t i = 0; i < 4; ++i) {
      p.a[i] = d.a_sign[i];
      p.r2[i] = d.corner[i] ? 0 : 1;
    }
    for (std::size_t k = 0; k < 6; ++k) p.d[k] = d.d_negative[k] ? -1 : 1;
    normalise(p, context_);
    mean_value_weights(p, d.data, context_);
  }

  FieldRange range(const RecordField& f) const override {
    const Exponents e(config());
    if (f.name == "a_sign") return {-1, 1};
    if (f.name == "root_exp") return {0, e.root_hi};
    if (f.name == "u_exp") return {0, e.u_hi};
    if (f.name == "v_exp") return {e.a_lo, e.a_hi};
    return StageUnderTest::range(f);
  }

  void constrain(StageData& d) const override {
    PixelTrace& p = d.pixel;
    const PipelineFloat one = context_.format.one();
    for (std::size_t i = 0; i < 4; ++i) {
      clear_zero(d.data.k[i]);
      if (d.corner[i]) p.root[i] = {};
      if (!d.corner[i] && p.root[i].sig == 0) p.root[i] = one;
      clear_zero(p.root[i]);
    }
    for (std::size_t k = 0; k < 6; ++k) {
      const auto [i, j] = vertex_pair[k];
      const bool at_corner = d.corner[i] || d.corner[j];
      const bool edge = k < 4;
      if (at_corner) d.d_negative[k] = false;
      if (edge && at_corner) d.a_sign[k] = 0;
      // u = r r' + |D| is 0 at a corner, and at least 1 elsewhere; v = |A| is no larger.
      PipelineFloat &u = p.u[k], &v = p.v[k];
      clear_zero(u);
      clear_zero(v);
      if (at_corner) u = v = {};
      if (!at_corner && u.sig == 0) u = one;
      if (greater(v, u)) u = v;
      if (edge && d.a_sign[k] == 0) v = {};
      if (edge && d.a_sign[k] != 0 && v.sig == 0) v = one;
    }
  }

  void shape(golden::Prng& prng, StageData& d) const override { random_ratios(prng, d, context_); }

  void corners(const Sink& sink) const override {
    // Every class: signs of A and D of the four edges, then corners; with different ratios and k everywhere.
    StageData d;
    const std::uint32_t one = context_.format.one().sig;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto n = static_cast<std::uint32_t>(i);
      d.data.k[i] = {false, 3 - static_cast<int>(i), one + 5 * n};
      d.pixel.root[i] = {false, 4 + static_cast<int>(i), one + 9 * n};
    }
    for (std::size_t k = 0; k < 6; ++k) {
      const auto n = static_cast<std::uint32_t>(k);
      d.pixel.v[k] = {false, 9 - static_cast<int>(k), one + 3 * n};
      d.pixel.u[k] = {false, 11, one + 7 * n};
    }
    for (int code = 0; code < 81 * 64; ++code) {
      int rest = code / 64;
      StageData each = d;
      for (std::size_t k = 4; k < 6; ++k) each.d_negative[k] = code >> k & 1;
      for (std::size_t i = 0; i < 4; ++i, rest /= 3) {
        each.a_sign[i] = static_cast<std::int8_t>(rest % 3 - 1);
        each.d_negative[i] = code >> i & 1;
      }
      sink(each);
    }
    for (int corners = 1; corners < 16; ++corners)
      for (int signs = 0; signs < 16; ++signs) {
        StageData each = d;
        for (std::size_t i = 0; i < 4; ++i) {
          each.corner[i] = corners >> i & 1;
          each.data.k[i].neg = signs >> i & 1;
          each.a_sign[i] = 1;
        }
        sink(each);
      }
    // k that cancel in the sums of a pixel on two edges, and vanishing ones.
    for (const std::array<int, 4> signs : {std::array{1, 1, 1, 1}, std::array{1, -1, 1, -1}, std::array{1, 1, -1, -1},
                                           std::array{0, 1, 0, 1}, std::array{0, 0, 1, 1}, std::array{0, 0, 0, 0}})
      for (int edges = 0; edges < 16; ++edges) {
        StageData each = d;
        for (std::size_t i = 0; i < 4; ++i) {
          each.data.k[i] = {signs[i] < 0, 0, signs[i] == 0 ? 0 : one};
          each.pixel.root[i] = {false, 3, one};
          each.a_sign[i] = edges >> i & 1 ? 0 : 1;
          each.d_negative[i] = edges >> i & 1;
        }
        sink(each);
      }
  }
};

// ---- interpolation ----

struct InterpolationLists {
  template <class D, class F>
  static void stimulus(D& d, const Config& c, F&& f) {
    visit_numbers(
        f, magnitudes("m_exp", "m_sig", c, "M: weights of the corners"),
        4, [&](std::size_t i) -> auto& { return d.pixel.m[i]; });
    visit_numbers(
        f, port_numbers("k_neg", "k_exp", "k_sig", c, "k of the corners; without perspective W"),
        4, [&](std::size_t i) -> auto& { return d.data.k[i]; });
    visit_numbers(
        f, port_numbers("w_neg", "w_exp", "w_sig", c, "W of the corners"),
        4, [&](std::size_t i) -> auto& { return d.data.w[i]; });
    visit_numbers(
        f, port_numbers("z_neg", "z_exp", "z_sig", c, "Z of the corners: k times (z minus base)"),
        4, [&](std::size_t i) -> auto& { return d.data.z[i]; });
    visit_numbers(
        f,
        port_numbers("b_neg", "b_exp", "b_sig", c,
                     "k times (attribute minus base): element 3 j + i - 1 is attribute j of corner i, 1 to 3"),
        3 * c.attribute_slots, [&](std::size_t n) -> auto& { return d.data.b[1 + n % 3][n / 3]; });
  }
  template <class D, class F>
  static void response(D& d, const Config& c, F&& f) {
    visit(d.pixel, Boundary::sum, c, f);
  }
};

class Interpolation : public StageOf<InterpolationLists> {
 public:
  explicit Interpolation(const Config& config) : StageOf(config) {}
  void run(StageData& d) const override { interpolate(d.pixel, d.data, context_); }

  FieldRange range(const RecordField& f) const override {
    const Exponents e(config());
    if (f.name == "m_exp") return {e.m_lo, e.m_hi};
    if (f.name == "w_exp") return {-config().frac(), 0};
    return StageUnderTest::range(f);
  }

  void constrain(StageData& d) const override {
    for (PipelineFloat& m : d.pixel.m) clear_zero(m);
    for (std::size_t i = 0; i < 4; ++i) {
      clear_zero(d.data.k[i]);
      clear_zero(d.data.w[i]);
      clear_zero(d.data.z[i]);
      for (PipelineFloat& b : d.data.b[i]) clear_zero(b);
      if (d.data.w[i].exp == 0 && d.data.w[i].sig != 0)
        d.data.w[i].sig = context_.format.one().sig;  // |W| is at most 1
    }
  }

  void shape(golden::Prng& prng, StageData& d) const override {
    // Terms of like size: alignment by few places, cancellation.
    const int s = config().significand_bits;
    const std::uint32_t one = context_.format.one().sig;
    const int spread = static_cast<int>(prng.below(static_cast<std::uint64_t>(2 * s)));
    const auto near = [&](int exp) {
      const auto sig = static_cast<std::uint32_t>(weighted(prng, {one, 2 * std::int64_t{one} - 1, true}));
      return PipelineFloat{prng.chance(0.5), exp - static_cast<int>(prng.integer(0, spread)), sig};
    };
    const bool equal = prng.chance(0.3);
    for (std::size_t i = 0; i < 4; ++i) {
      d.pixel.m[i] = near(-20);
      d.pixel.m[i].neg = false;
      d.data.k[i] = near(0);
      d.data.z[i] = near(0);
      for (std::size_t j = 0; j < max_attribute_slots; ++j) d.data.b[i][j] = near(1);
      if (equal && i % 2 == 1) {  // pairs that cancel to the last bits
        d.pixel.m[i] = d.pixel.m[i - 1];
        d.data.b[i] = d.data.b[i - 1];
        for (PipelineFloat& b : d.data.b[i]) {
          b.neg = !b.neg;
          if (b.sig > one && prng.chance(0.5)) --b.sig;
        }
      }
    }
  }

  void corners(const Sink& sink) const override {
    // Distances of two terms around the width of the sum, with either sign.
    const int s = config().significand_bits, window = config().prec_bits();
    const std::uint32_t one = context_.format.one().sig, most = 2 * one - 1;
    for (int distance = 0; distance <= 2 * s + config().align_guard_bits + 3; ++distance)
      for (const bool neg : {false, true})
        for (const std::uint32_t sig : {one, most, one + 1}) {
          StageData d;
          d.pixel.m.fill({false, 0, one});
          d.data.k = {{{false, 0, sig}, {neg, -distance, most}, {}, {}}};
          d.data.z = {{{false, 0, sig}, {neg, -distance, one}, {!neg, -distance, one}, {}}};
          d.data.w = {{{false, 0, one},
                       {neg, std::max(-distance, -config().frac()), sig},
                       {},
                       {false, -window % (config().frac() + 1), sig}}};
          for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t j = 0; j < max_attribute_slots; ++j)
              d.data.b[i][j] = {neg != (i % 2 == 1), -distance * static_cast<int>(i == 3 - j % 4), i == j ? most : sig};
          sink(d);
        }
  }
};

// ---- depth ----

struct DepthLists {
  template <class D, class F>
  static void stimulus(D& d, const Config& c, F&& f) {
    f(plain("depth_on", 1, "window z is computed and clipped"), -1, d.state.depth);
    f(depth_type(c, "znear", "fragments below are discarded"), -1, d.znear);
    f(depth_type(c, "zfar", "fragments above are discarded"), -1, d.zfar);
    f(plain("attributes", 4, "attributes in use"), -1, d.state.attributes);
    f(plain("hull", 1, "the eye is in the hull: discard unless the sum of M W is positive"), -1, d.data.hull);
    auto& base = d.data.base;
    visit_array(
        f, fixed("base_attr", attr_out_bits(c), attr_out_frac(c), "1", "bases of the attributes"),
        c.attribute_slots, [&](std::size_t i) -> auto& { return base.attribute[i]; });
    f(depth_type(c, "base_depth", "base of window z"), -1, base.depth);
    f(fixed("depth_low", corner_depth_bits(c), depth_frac(c), "1", "least corner's z: window z is not below"), -1,
      base.depth_low);
    f(fixed("depth_high", corner_depth_bits(c), depth_frac(c), "1", "greatest corner's z: window z is not above"), -1,
      base.depth_high);
    visit(d.pixel, Boundary::sum, c, f);
  }
  template <class D, class F>
  static void response(D& d, const Config& c, F&& f) {
    auto& g = d.pixel.fragment;
    f(plain("valid", 1, "not discarded; otherwise all is 0"), -1, d.pixel.drawn);
    f(plain("saturated", 1, "an attribute in use was clamped"), -1, g.flags);
    f(depth_type(c, "depth", "window z"), -1, g.depth);
    visit_array(
        f, reworded(attribute_type(c), "attributes; 0 when not in use"),
        c.attribute_slots, [&](std::size_t i) -> auto& { return g.attribute[i]; });
  }
};

class Depth : public StageOf<DepthLists> {
 public:
  explicit Depth(const Config& config) : StageOf(config) { context_.sqrt_table = {}; }

  void run(StageData& d) const override {
    PipelineContext c = context_;
    c.state.depth = d.state.depth;
    c.state.attributes = d.state.attributes;
    c.znear = d.znear;
    c.zfar = d.zfar;
    d.pixel.valid = true;
    fragment_output(d.pixel, d.data, c);
    // The port shows nothing of a discarded fragment; of the flags one belongs to this stage.
    if (!d.pixel.drawn) d.pixel.fragment = {};
    d.pixel.fragment.flags = (d.pixel.fragment.flags & flag_saturated) != 0;
  }

  FieldRange range(const RecordField& f) const override {
    const Exponents e(config());
    if (f.name == "attributes") return {0, config().attribute_slots};
    if (f.name == "znear" || f.name == "zfar" || f.name == "base_depth") return {0, depth_one()};
    if (f.name == "depth_low" || f.name == "depth_high") return {-1, config().depth_above()};
    if (f.name == "base_attr") return {-config().attribute_limit(), config().attribute_limit()};
    if (f.name.ends_with("exp")) return {e.sum_lo, e.sum_hi};
    return StageUnderTest::range(f);
  }

  void constrain(StageData& d) const override {
    const Exponents e(config());
    const auto fit = [&](PipelineFloat& v) {
      v.exp = std::clamp(v.exp, e.sum_lo, e.sum_hi);
      clear_zero(v);
    };
    for (PipelineFloat& a : d.pixel.num_a) fit(a);
    fit(d.pixel.num_z);
    fit(d.pixel.den_k);
    fit(d.pixel.den_w);
    if (d.data.base.depth_low > d.data.base.depth_high) std::swap(d.data.base.depth_low, d.data.base.depth_high);
  }

  void shape(golden::Prng& prng, StageData& d) const override {
    // Quotients near the ends of the outputs' formats.
    PixelTrace& p = d.pixel;
    const auto near = [&](PipelineFloat& v, const PipelineFloat& den, int bits_above, int bits_below) {
      if (den.sig == 0) return;
      v.exp = den.exp + static_cast<int>(prng.integer(-bits_below, bits_above));
      if (prng.chance(0.1)) v.sig = den.sig;
    };
    for (PipelineFloat& a : p.num_a)
      near(a, p.den_k, config().attribute_int_bits + 1, prng.chance(0.5) ? 3 : config().attribute_frac() + 2);
    near(p.num_z, p.den_w, 2, prng.chance(0.7) ? 4 : config().depth_bits + 2);
    p.den_w.neg = prng.chance(0.2);
    p.num_z.neg = p.den_w.neg != prng.chance(0.4);
    if (prng.chance(0.6)) {
      d.znear = 0;
      d.zfar = static_cast<std::uint32_t>(depth_one());
    }
    // Corners as quads have them: about the base, or anywhere where one is behind the eye.
    QuadBase& base = d.data.base;
    base.depth_low = -1;
    base.depth_high = config().depth_above();
    if (prng.chance(0.7)) {
      const auto beside = [&](std::int64_t span) {
        return static_cast<std::int32_t>(
            std::clamp<std::int64_t>(base.depth + prng.integer(-span, span), -1, config().depth_above()));
      };
      const std::int64_t span = std::int64_t{1} << prng.below(static_cast<std::uint64_t>(config().depth_bits));
      base.depth_low = beside(span), base.depth_high = beside(span);
      const auto limit = [&](std::int32_t code) {
        return static_cast<std::uint32_t>(std::clamp<std::int64_t>(code, 0, depth_one()));
      };
      if (prng.chance(0.3)) d.znear = limit(base.depth_high);
      if (prng.chance(0.3)) d.zfar = limit(base.depth_low);
    }
    if (prng.chance(0.1)) p.den_w = {};  // z lies beyond depth_high, whatever the numerator's sign
    d.state.attributes = static_cast<int>(prng.integer(0, config().attribute_slots));
    // Bases about 0, and at an end of the format with a quotient of one or two codes.
    for (std::size_t j = 0; j < static_cast<std::size_t>(config().attribute_slots); ++j) {
      if (prng.chance(0.3)) base.attribute[j] = prng.integer(-3, 3);
      if (p.den_k.sig == 0 || !prng.chance(0.3)) continue;
      base.attribute[j] = prng.sign() < 0 ? -config().attribute_limit() : config().attribute_limit();
      p.num_a[j] = {prng.chance(0.5), p.den_k.exp - config().attribute_frac() + static_cast<int>(prng.below(2)),
                    p.den_k.sig};
    }
  }

  void corners(const Sink& sink) const override {
    const std::uint32_t one = context_.format.one().sig, most = 2 * one - 1,
                        depth_one = static_cast<std::uint32_t>(this->depth_one());
    StageData d;
    d.state.attributes = config().attribute_slots;
    d.zfar = depth_one;
    PixelTrace& p = d.pixel;
    QuadBase& base = d.data.base;
    base.depth_low = -1;
    base.depth_high = config().depth_above();
    // Quotients of 0, half a code and beside it, 1/2, just below and at 1, above; every sign; every kind of
    // denominator; limits about them.
    std::uint32_t turn = 0;
    for (const PipelineFloat den :
         {PipelineFloat{}, PipelineFloat{false, 0, one}, PipelineFloat{true, 0, one}, PipelineFloat{false, 3, most}})
      for (const PipelineFloat num :
           {PipelineFloat{}, PipelineFloat{false, -config().depth_bits, one},
            PipelineFloat{false, -config().depth_bits - 1, one}, PipelineFloat{false, -config().depth_bits - 1, most},
            PipelineFloat{false, -config().depth_bits - 2, most}, PipelineFloat{false, -1, one},
            PipelineFloat{false, -1, most}, PipelineFloat{false, 0, one}, PipelineFloat{false, 0, one + 1},
            PipelineFloat{false, 1, one}, PipelineFloat{false, 30, one}})
        for (const bool neg : {false, true})
          for (const bool hull : {false, true})
            for (const bool depth : {false, true}) {
              p.den_w = den;
              p.den_k = {false, 0, one};
              p.num_z = {neg && num.sig != 0, num.exp + den.exp * (num.sig != 0), num.sig};
              p.num_a.fill({neg, 0, most});
              d.data.hull = hull;
              d.state.depth = depth;
              base.depth = turn++ % 2 == 0 ? 0 : depth_one / 2 + turn % 3;
              base.attribute.fill(turn % 5 == 0 ? config().attribute_limit() : 0);
              for (const std::uint32_t lo : {std::uint32_t{0}, std::uint32_t{1}, depth_one / 2, depth_one}) {
                d.znear = lo;
                d.zfar = depth_one;
                sink(d);
                d.znear = 0;
                d.zfar = lo;
                sink(d);
              }
            }
    // Base and corners: a sum beyond either corner and one code beside it, bases at 0 and 1.
    d.znear = 0;
    d.zfar = depth_one;
    d.state.depth = true;
    d.data.hull = false;
    p.den_w = {false, 0, one};
    p.num_a.fill({});
    for (const std::uint32_t at : {std::uint32_t{0}, std::uint32_t{1}, depth_one / 2, depth_one - 1, depth_one})
      for (const int codes_log2 : {-2, -1, 0, 1, config().depth_bits - 1, config().depth_bits, config().depth_bits + 1})
        for (const bool neg : {false, true})
          for (const int low : {-1, 0, 1, 2})
            for (const int high : {0, 1, 2})
              for (const bool wide : {false, true}) {
                p.num_z = {neg, codes_log2 - config().depth_bits, wide ? most : one};
                base.depth = at;
                base.depth_low = std::max(static_cast<std::int32_t>(at) - low, -1);
                base.depth_high = std::min(static_cast<std::int32_t>(at) + high, config().depth_above());
                sink(d);
              }
    // Attributes at and around the ends of their format, one at a time.
    d.znear = 0;
    d.zfar = depth_one;
    d.state.depth = false;
    d.data.hull = false;
    const int top = config().attribute_int_bits, low = -config().attribute_frac();
    const std::int64_t limit = config().attribute_limit();
    for (std::size_t j = 0; j < static_cast<std::size_t>(config().attribute_slots); ++j)
      for (const int exp : {top + 2, top + 1, top, top - 1, 0, low + 1, low, low - 1, low - 2, low - 40, low - 70})
        for (const std::uint32_t sig : {one, one + 1, most})
          for (const bool neg : {false, true})
            for (const std::int64_t from : {std::int64_t{0}, limit, -limit, limit - 1, 1 - limit, std::int64_t{-1}})
              for (int used : {static_cast<int>(j), static_cast<int>(j) + 1}) {
                p.num_a.fill({});
                p.num_a[j] = {neg, exp, sig};
                p.den_k = {false, 0, one};
                base.attribute.fill(0);
                base.attribute[j] = from;
                d.state.attributes = used;
                sink(d);
              }
  }

 private:
  std::int64_t depth_one() const { return std::int64_t{1} << config().depth_bits; }
};

}  // namespace

void add_pixel_stages(std::vector<std::unique_ptr<Suite>>& suites) {
  const auto add = [&](SuiteInfo info, StageSuite::Make make) {
    suites.push_back(std::make_unique<StageSuite>(std::move(info), make));
  };
  const std::string numbers = "a number whose top bit of sig is 0, but for all fields 0; ";
  add({"normalise", "stage", "Significand numbers of A, D and squared distances; the singular class", "normalise",
       latency::normalise_stages, "the most negative value of a width; r2 below -256"},
      make_stage<Normalise>);
  add({"sqrt", "stage", "Square roots of the squared distances", "sqrt", latency::sqrt_stages,
       numbers + "exponents below 0 or above QVAL_BITS - 2"},
      make_stage<Sqrt>);
  add({"reciprocal", "stage", "Reciprocal of a denominator", "reciprocal", latency::reciprocal_stages,
       numbers + "exponents that no sum has (see interpolation)"},
      make_stage<Reciprocal>);
  add({"ratios", "stage", "Half-angle tangents of the edges and diagonals as v/u or u/v", "mean_value_ratios",
       latency::ratio_stage - latency::root_stage, numbers + "|A| or |D| above r r' by more than the rounding of r"},
      make_stage<Ratios>);
  add({"weights", "stage", "Mean value weights up to a common factor", "mean_value_weights",
       latency::weight_stage - latency::ratio_stage,
       numbers +
           "r = 0 elsewhere than at a corner, and another r there; u = 0 elsewhere than at a corner, and another u "
           "or v there; v above u, or 0 elsewhere than where A is 0, or not 0 there"},
      make_stage<Weights>);
  add({"interpolation", "stage", "Weighted sums over the corners, of attributes over three", "interpolate",
       latency::sum_stage - latency::weight_stage,
       numbers + "exponents of M that neither three factors nor a number of the port have; |W| above 1"},
      make_stage<Interpolation>);
  add({"depth", "stage", "Quotients rounded and added to their bases, clamps and discard", "fragment_output",
       latency::fragment_stage - latency::sum_stage,
       numbers + "exponents that no sum has; attributes above ATTRIBUTE_SLOTS; znear, zfar or base_depth above 1; "
                 "depth_low above depth_high, "
                 "or one of them below -1 or above 2^DEPTH_BITS + 1; the most negative base_attr"},
      make_stage<Depth>);
}

}  // namespace quadrille::vectors
