// Snapping: quads as given to the integers of the port.
#include "golden/vectors/stage_of.hpp"
#include "golden/vectors/stage_suites.hpp"
#include "model/port/snap.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace quadrille::vectors {
namespace {

struct SnappingLists {
  template <class D, class F>
  static void stimulus(D& d, const Config& c, F&& f) {
    const auto real = [](const char* name, const char* unit, const char* meaning) {
      return FieldType{name, 64, false, {}, unit, meaning};
    };
    const auto slots = static_cast<std::size_t>(c.attribute_slots);
    f(plain("perspective", 1, "attributes are perspective-correct"), -1, d.state.perspective);
    visit_array(
        f, real("x", "px", "IEEE-754 doubles: w times window x, pixel centres at + 0.5"),
        4, [&](std::size_t i) -> auto& { return d.vertex[i].x; });
    visit_array(
        f, real("y", "px", "IEEE-754 doubles: w times window y, downwards"),
        4, [&](std::size_t i) -> auto& { return d.vertex[i].y; });
    visit_array(
        f, real("z", "1", "IEEE-754 doubles: w times window z"),
        4, [&](std::size_t i) -> auto& { return d.vertex[i].z; });
    visit_array(
        f, real("w", "1", "IEEE-754 doubles: the homogeneous coordinate as given"),
        4, [&](std::size_t i) -> auto& { return d.vertex[i].w; });
    visit_array(
        f, real("attr", "1", "IEEE-754 doubles: attribute j of vertex i as given is element i ATTRIBUTE_SLOTS + j"),
        4 * c.attribute_slots, [&](std::size_t n) -> auto& { return d.attribute[n / slots][n % slots]; });
  }

  template <class D, class F>
  static void response(D& d, const Config& c, F&& f) {
    auto& v = d.snapped.vertex;
    auto& base = d.snapped.base;
    const auto slots = static_cast<std::size_t>(c.attribute_slots);
    f(plain("refused", 1, "a vertex is no point of the input space, or an attribute does not fit; all else is 0"), -1,
      d.refused);
    visit_array(
        f, fixed("x", t_bits(c), frac_bits(c), "px", "X, relative to pixel centres"),
        4, [&](std::size_t i) -> auto& { return v[i].x; });
    visit_array(
        f, fixed("y", t_bits(c), frac_bits(c), "px", "Y, down"), 4, [&](std::size_t i) -> auto& { return v[i].y; });
    visit_array(
        f, fixed("w", w_bits(c), frac_bits(c), "1", "W"), 4, [&](std::size_t i) -> auto& { return v[i].w; });
    visit_numbers(
        f, port_numbers(nullptr, "k_exp", "k_sig", c, "k > 0, the factor of the vertex, rounded to nearest"),
        4, [&](std::size_t i) -> auto& { return v[i].k; });
    visit_numbers(
        f, port_numbers("z_neg", "z_exp", "z_sig", c, "k times (z minus base)"),
        4, [&](std::size_t i) -> auto& { return v[i].z; });
    visit_numbers(
        f,
        port_numbers("attr_neg", "attr_exp", "attr_sig", c,
                     "k times (attribute minus base), without perspective W times; of vertices 1 to 3, element "
                     "(i - 1) ATTRIBUTE_SLOTS + j"),
        3 * c.attribute_slots, [&](std::size_t n) -> auto& { return v[1 + n / slots].attribute[n % slots]; });
    visit_array(
        f, fixed("base_attr", attr_out_bits(c), attr_out_frac(c), "1", "bases of the attributes: those of vertex 0"),
        c.attribute_slots, [&](std::size_t j) -> auto& { return base.attribute[j]; });
    f(depth_type(c, "base_depth", "base of window z: that of the first vertex with w > 0"), -1, base.depth);
    f(fixed("depth_low", corner_depth_bits(c), depth_frac(c), "1", "least corner's z, -2^-DEPTH_BITS: below 0"), -1,
      base.depth_low);
    f(fixed("depth_high", corner_depth_bits(c), depth_frac(c), "1", "greatest corner's z, 1 + 2^-DEPTH_BITS: above 1"),
      -1, base.depth_high);
  }
};

/// Any bits as a double: NaN and infinities too.
double any_double(golden::Prng& prng) { return std::bit_cast<double>(prng.next()); }

class Snapping : public StageOf<SnappingLists> {
 public:
  explicit Snapping(const Config& config) : StageOf(config) {}

  Source source() const override { return Source::given; }
  /// Of 32 doubles at random one is nearly always refused.
  double shaped() const override { return 1; }

  void run(StageData& d) const override {
    WindowQuad given;
    given.vertex = d.vertex;
    for (std::size_t i = 0; i < 4; ++i)
      given.attribute[i].assign(d.attribute[i].begin(), d.attribute[i].begin() + config().attribute_slots);
    d.refused = false;
    try {
      d.snapped = snap_quad(given, config(), d.state);
    } catch (const SnapError&) {
      d.refused = true;
      d.snapped = nothing();
    }
  }

  void shape(golden::Prng& prng, StageData& d) const override {
    // Vertices as a camera gives them, near and beyond the guard band, on and beside the grid, with w of either sign.
    const double edge = std::ldexp(1.0, config().pos_int());
    const double grid = std::ldexp(1.0, -config().subpixel_bits);
    const double limit = std::ldexp(1.0, config().attribute_int_bits);
    const double code = std::ldexp(1.0, -config().attribute_frac()), depth_code = std::ldexp(1.0, -config().depth_bits);
    const bool wild = prng.chance(0.15), all_before = prng.chance(0.7), alike = prng.chance(0.4);
    // Window z: anywhere, about a tie of the codes, all of a quad close to one another, beyond its interval.
    const double near_z = (std::floor(prng.uniform() / depth_code) + 0.5) * depth_code;
    const auto depth = [&] {
      switch (prng.below(alike ? 2 : 4)) {
        case 0:
          return near_z + static_cast<double>(prng.integer(-3, 3)) * depth_code / 2;
        case 1:
          return near_z + prng.sign() * prng.log2_spread(-60, -10);
        case 2:
          return prng.sign() * prng.log2_spread(-30, 4);
        default:
          return prng.uniform();
      }
    };
    for (std::size_t i = 0; i < 4; ++i) {
      const double w = prng.chance(0.3) ? 1.0 : (all_before ? 1.0 : prng.sign()) * prng.log2_spread(-8, 8);
      const auto coordinate = [&] {
        switch (prng.below(wild ? 4 : 3)) {
          case 0:
            return prng.uniform(-edge / 8, edge / 4) * w;
          case 1:  // ties of the rounding to the grid
            return (static_cast<double>(prng.integer(-4000, 4000)) + 0.5) * grid * w + w / 2;
          case 2:
            return prng.sign() * (edge + static_cast<double>(prng.integer(-3, 3)) * grid / 2) * w + w / 2;
          default:
            return prng.sign() * prng.log2_spread(-82, 82);
        }
      };
      d.vertex[i] = {coordinate(), coordinate(), depth() * w, !all_before && prng.chance(0.1) ? 0.0 : w};
      // Attributes: of vertex 0 on the grid, on its ties, anywhere; of the others equal to it, close to it, anywhere.
      for (std::size_t j = 0; j < static_cast<std::size_t>(config().attribute_slots); ++j) {
        double& a = d.attribute[i][j];
        const double first = d.attribute[0][j];
        if (i == 0)
          a = prng.chance(0.4) ? static_cast<double>(prng.integer(-1000, 1000)) * code / 2
                               : prng.uniform(-limit, limit);
        else if (prng.chance(0.3))
          a = prng.chance(0.5) ? first : first + prng.sign() * prng.log2_spread(-50, -2);
        else
          a = prng.chance(0.1) ? 0.0 : prng.uniform(-limit, limit);
        if (!(std::fabs(a) < limit)) a = 0;
      }
    }
    if (prng.chance(0.05))
      d.attribute[prng.below(4)][prng.below(slots())] = prng.sign() * limit * prng.uniform(0.99, 1.01);
    if (!wild) return;
    WindowVertex& v = d.vertex[prng.below(4)];
    switch (prng.below(5)) {
      case 0:
        v.x = any_double(prng);
        break;
      case 1:
        v.z = any_double(prng);
        break;
      case 2:
        v.w = any_double(prng);
        break;
      case 3:
        d.attribute[prng.below(4)][prng.below(slots())] = any_double(prng);
        break;
      default:
        break;
    }
  }

  void corners(const Sink& sink) const override {
    StageData d;
    const double edge = std::ldexp(1.0, config().pos_int()), grid = std::ldexp(1.0, -config().subpixel_bits);
    const double limit = std::ldexp(1.0, config().attribute_int_bits);
    // One vertex of an ordinary quad is another one, each of the four in turn.
    const std::array<WindowVertex, 4> good{
        {{4.5, 4.5, 0.25, 1}, {9.5, 4.5, 0.5, 1}, {24, 18, 1.5, 2}, {4.5, 9.5, 1, 1}}};
    std::size_t turn = 0;
    const auto at = [&](double x, double y, double z, double w) {
      d.vertex = good;
      d.vertex[turn++ % 4] = {x, y, z, w};
      for (const bool perspective : {false, true}) {
        d.state.perspective = perspective;
        sink(d);
      }
    };
    const double inf = HUGE_VAL, nan = std::nan("");
    for (const double bad : {inf, -inf, nan}) {
      at(bad, 1, 0, 1), at(1, bad, 0, 1), at(1, 1, bad, 1), at(1, 1, 0, bad);
    }
    at(0, 0, 0, 0), at(0, 0, 1, 0), at(1, 0, 0, 0), at(0, -1, 0, 0), at(0, 0, 0, -1);
    for (const double size : {0x1p80, 0x1.0000000000001p80, 0x1p-80, 0x1.fffffffffffffp-81, 0x1p-1074})
      for (const double sign : {1.0, -1.0})
        at(sign * size, 0, 0, 0), at(0, sign * size, 0, 0), at(0, 0, 0, sign * size), at(1, 1, sign * size, 1);
    for (const double x :
         {edge, edge - grid, edge - grid / 2, edge - grid / 4, edge + grid, 0.0, grid, grid / 2, 1.5 * grid})
      for (const double sign : {1.0, -1.0})
        at(sign * x + 0.5, 0.5, 0.25, 1), at(0.5, sign * x + 0.5, 0.25, 1), at(2 * sign * x + 1, 7, 0.5, 2),
            at(sign * x, 3, -0.5, -1), at(sign * x + 0.5, sign * x + 0.5, 1, 1);
    // Attributes at the ends of their format, of vertex 0 and of another one; halves of a code, which go to even.
    const double code = std::ldexp(1.0, -config().attribute_frac());
    for (const double a : {limit, -limit, std::nextafter(limit, 0), std::nextafter(-limit, 0), limit - code,
                           limit - code / 2, 1.0, -1.0, code / 2, 3 * code / 2, -code / 2, -3 * code / 2,
                           std::nextafter(code / 2, 1), 0x1p-1074, 0x1p-260, inf, nan, 0.0, -0.0})
      for (const std::size_t i : {0, 1, 3})
        for (const bool all : {false, true}) {
          for (auto& attribute : d.attribute) attribute.fill(0);
          for (std::size_t n = 0; n < 4; ++n)
            if (all || n == i) d.attribute[n][slots() - 1] = a;
          at(10.5, 20.5, 0.5, 1), at(-3, 5, 0.5, -2);
        }
    // k and z at the ends of the port's exponents: a small product becomes zero.
    for (auto& attribute : d.attribute) attribute.fill(1);
    for (const double w : {0x1p80, 0x1p-80, 0x1.8p79, 0x1.fffffffffffffp-80})
      for (const double z : {0x1p80, 0x1p-1022, 0x1p-176, 0x1p-177, -0x1p-200, 0x1.fffffcp-177}) at(w / 4, w / 8, z, w);
    // Significands that round up to the next power of two.
    for (const double a : {0x1.fffffffffffffp-1, 0x1.ffffffp0, 0x1.fffffp1}) {
      for (std::size_t i = 1; i < 4; ++i) d.attribute[i].fill(1 + a / 2);
      at(1.5, 2.5, a, 1), at(2 * a, 3, 1, 2 * a);
    }
    // Depth: codes and halves of codes about 0, 1/2 and 1; which vertex is the first before the eye, and none of them.
    const double depth_code = std::ldexp(1.0, -config().depth_bits);
    for (const double middle : {0.0, 0.5, 1.0})
      for (int half = -4; half <= 4; ++half)
        for (const double beside : {0.0, 0x1p-52, -0x1p-52})
          for (const double w : {1.0, 4.0})
            for (const unsigned behind : {0u, 1u, 3u, 4u, 15u}) {
              const double z = middle + half * depth_code / 2 + beside;
              for (std::size_t i = 0; i < 4; ++i) {
                d.vertex[i] = good[i];
                d.vertex[i].z = (i == 1 ? z : i == 2 ? 0.5 + z / 2 : middle) * d.vertex[i].w;
              }
              d.vertex[0] = {2.5 * w, 3.5 * w, z * w, w};
              for (std::size_t i = 0; i < 4; ++i)
                if (behind >> i & 1) d.vertex[i].w = i % 2 == 0 ? -1.0 : 0.0;
              sink(d);
            }
  }

 private:
  std::size_t slots() const { return static_cast<std::size_t>(config().attribute_slots); }
  /// Every field 0.
  static SnappedQuad nothing() {
    SnappedQuad quad;
    quad.base.depth_low = quad.base.depth_high = 0;
    return quad;
  }
};

}  // namespace

Stage make_snapping(const Config& config) { return std::make_unique<Snapping>(config); }

}  // namespace quadrille::vectors
