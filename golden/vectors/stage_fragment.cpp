// From weights to the fragment.
#include "golden/vectors/stage_numbers.hpp"
#include "golden/vectors/stage_of.hpp"
#include "golden/vectors/stage_suites.hpp"

#include <algorithm>

namespace quadrille::vectors {
namespace {

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

Stage make_interpolation(const Config& config) { return std::make_unique<Interpolation>(config); }
Stage make_depth(const Config& config) { return std::make_unique<Depth>(config); }

}  // namespace quadrille::vectors
