// From A, D and squared distances to the weights of the corners.
#include "golden/vectors/stage_numbers.hpp"
#include "golden/vectors/stage_of.hpp"
#include "golden/vectors/stage_suites.hpp"

#include <cmath>

namespace quadrille::vectors {
namespace {

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

}  // namespace

Stage make_normalise(const Config& config) { return std::make_unique<Normalise>(config); }
Stage make_ratios(const Config& config) { return std::make_unique<Ratios>(config); }
Stage make_weights(const Config& config) { return std::make_unique<Weights>(config); }

}  // namespace quadrille::vectors
