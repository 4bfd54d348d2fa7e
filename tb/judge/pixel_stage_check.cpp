// The model's stages behind the front, normalise to fragment_output, each on what the stage before gave, before the
// judge. The tables' own values are taken as they come (arithmetic_check.cpp judges them).
#include "golden/analysis/judged_quad.hpp"
#include "model/support/prng.hpp"
#include "tb/judge/function_tally.hpp"
#include "tb/judge/stage_judge.hpp"

#include <cmath>

namespace quadrille::tb {
namespace {

using exact::Number;
using exact::value_of;
using exact::Wide;
using golden::Prng;

constexpr int pixels_per_state = 300, slots = 500;

/// A pixel as the front hands it over.
struct Pixel {
  std::array<std::int64_t, 4> x{}, y{};  ///< S_i in units of 2^-FRAC px
  PixelTrace trace;
  QuadData quad;
};

class StageCheck {
 public:
  StageCheck(const Config& config, const DrawState& state, const PixelJudge& judge, Prng& rng)
      : config_(config),
        state_(state),
        judge_(judge),
        context_(config, state),
        rng_(rng),
        s_(config.significand_bits) {}

  void run(std::array<FunctionTally*, 5> tallies) {
    for (int n = 0; n < pixels_per_state; ++n) {
      Pixel p = random_pixel(n);
      PixelTrace& t = p.trace;
      normalise(t, context_);
      const std::string wrong = judge_.normalised(t);
      const bool notch = judge_.notch(t);
      tally(*tallies[0], p, !wrong.empty() || t.notch == notch ? wrong : notch ? "no notch" : "a notch");
      sqrt_stage(t, context_);
      mean_value_ratios(t, context_);
      tally(*tallies[1], p, judge_.ratios(t));
      mean_value_weights(t, p.quad, context_);
      tally(*tallies[2], p, judge_.weights(t, p.quad));
      interpolate(t, p.quad, context_);
      tally(*tallies[3], p, judge_.sums(t, p.quad));
      fragment_output(t, p.quad, context_);
      tally(*tallies[4], p, output_fault(p));
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

  PipelineFloat float_of(const Number& v) const { return exact::float_of(v, s_); }

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
      case 6: {  // D = 0 on an edge, or on a diagonal
        const int turn = rng_.chance(0.5) ? 1 : -1;
        set(rng_.chance(0.5) ? next : third, first, 0, turn);
        break;
      }
      default:
        break;
    }
    derive(p);
    random_quad(p);
    return p;
  }

  /// A, D and r², as rtl/SPEC.md defines them.
  void derive(Pixel& p) const {
    PixelTrace& t = p.trace;
    const int drop = config_.qdrop();
    for (std::size_t k = 0; k < 6; ++k) {
      const auto [i, j] = vertex_pair[k];
      t.a[k] = static_cast<std::int64_t>(Wide{p.x[i]} * p.y[j] - Wide{p.y[i]} * p.x[j]);
      t.d[k] = static_cast<std::int64_t>((Wide{p.x[i]} * p.x[j] + Wide{p.y[i]} * p.y[j]) >> drop);
    }
    for (std::size_t i = 0; i < 4; ++i)
      t.r2[i] = static_cast<std::int64_t>((Wide{p.x[i]} * p.x[i] + Wide{p.y[i]} * p.y[i]) >> drop);
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

  /// What a fragment says of its pixel and quad, and its values.
  std::string output_fault(const Pixel& p) const {
    const PixelTrace& t = p.trace;
    const Fragment& g = t.fragment;
    const PixelJudge::Output expected = judge_.output(t, p.quad, state_);
    if (g.quad != p.quad.id || g.x != t.x || g.y != t.y || g.front != t.front) return "quad, x, y or front";
    if (std::string wrong = PixelJudge::values_fault(g, expected); !wrong.empty()) return wrong;
    const PixelJudge::Class is(t);
    unsigned flags = 0;
    const auto expect = [&](FragmentFlag flag, bool set) { flags |= set ? static_cast<unsigned>(flag) : 0u; };
    expect(flag_on_edge, is.on_edge());
    expect(flag_on_vertex, is.on_vertex());
    expect(flag_two_corner, is.two_corner());
    expect(flag_two_edge, is.two_edge());
    expect(flag_tie, t.tie);
    expect(flag_homogeneous, t.homogeneous);
    expect(flag_notch, t.notch);
    expect(flag_saturated, expected.saturated);
    if (g.flags != flags) return "flags " + std::to_string(g.flags) + ", expected " + std::to_string(flags);
    return t.drawn == expected.drawn ? "" : expected.drawn ? "discarded" : "not discarded";
  }

  const Config& config_;
  const DrawState& state_;
  const PixelJudge& judge_;
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
  const PixelJudge judge(config);
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
      StageCheck(config, state, judge, rng).run({&normal, &ratio, &weight, &sums, &output});
    }
  for (const FunctionTally* tally : {&data, &normal, &ratio, &weight, &sums, &output})
    results.push_back(tally->result());
}

}  // namespace quadrille::tb
