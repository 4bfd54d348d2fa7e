// Snapping and the exact front of the machine.
#include "golden/vectors/stage_of.hpp"
#include "golden/vectors/stage_suites.hpp"
#include "model/front/quad_setup.hpp"
#include "model/front/tile_context.hpp"
#include "model/port/latency.hpp"
#include "model/port/snap.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace quadrille::vectors {
namespace {

/// Half-open rectangle of pixels.
template <class D, class F>
void visit_scissor(D& d, const Config& c, F&& f) {
  f(plain("scissor_x0", scissor_bits(c), "first column drawn", "px"), -1, d.state.scissor_x0);
  f(plain("scissor_y0", scissor_bits(c), "first row drawn", "px"), -1, d.state.scissor_y0);
  f(plain("scissor_x1", scissor_bits(c), "column after the last one", "px"), -1, d.state.scissor_x1);
  f(plain("scissor_y1", scissor_bits(c), "row after the last one", "px"), -1, d.state.scissor_y1);
}

void order_scissor(DrawState& s) {
  if (s.scissor_x0 > s.scissor_x1) std::swap(s.scissor_x0, s.scissor_x1);
  if (s.scissor_y0 > s.scissor_y1) std::swap(s.scissor_y0, s.scissor_y1);
}

bool fits(__int128 v, int bits) {
  const __int128 limit = static_cast<__int128>(1) << (bits - 1);
  return v > -limit && v < limit;
}

// ---- snapping ----

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

// ---- setup ----

struct SetupLists {
  template <class D, class F>
  static void stimulus(D& d, const Config& c, F&& f) {
    auto& v = d.quad.vertex;
    visit_array(
        f, fixed("x", t_bits(c), frac_bits(c), "px", "k times window x relative to pixel centres"),
        4, [&](std::size_t i) -> auto& { return v[i].x; });
    visit_array(
        f, fixed("y", t_bits(c), frac_bits(c), "px", "k times window y"),
        4, [&](std::size_t i) -> auto& { return v[i].y; });
    visit_array(
        f, fixed("w", w_bits(c), frac_bits(c), "1", "k w; all 1: an ordinary quad"),
        4, [&](std::size_t i) -> auto& { return v[i].w; });
    visit_scissor(d, c, f);
  }

  template <class D, class F>
  static void response(D& d, const Config& c, F&& f) {
    visit(d.setup, c, [&](const FieldType& type, int index, auto& value) {
      f(std::string_view(type.name) == "slot" ? reworded(type, "slot of the quad: 0") : type, index, value);
    });
  }
};

class Setup : public StageOf<SetupLists> {
 public:
  explicit Setup(const Config& config) : StageOf(config) {}

  Source source() const override { return Source::quads; }
  void run(StageData& d) const override { d.setup = quad_setup(d.quad, config(), d.state); }

  FieldRange range(const RecordField& f) const override {
    const std::int64_t reach = std::int64_t{1} << (config().pos_int() + config().frac());
    const std::int64_t one = std::int64_t{1} << config().frac();
    if (f.name == "w") return {-one, one};
    if (f.name == "x" || f.name == "y") return {-reach, reach};
    return {0, std::int64_t{1} << config().viewport_bits};
  }

  void constrain(StageData& d) const override {
    order_scissor(d.state);
    for (SnappedVertex& v : d.quad.vertex)
      if (v.x == 0 && v.y == 0 && v.w == 0) v.w = 1 << config().frac();
  }

  void shape(golden::Prng& prng, StageData& d) const override {
    const int frac = config().frac();
    const bool ordinary = prng.chance(0.5), on_pixels = prng.chance(0.3), near = prng.chance(0.7);
    const std::int64_t extent = std::int64_t{1} << (frac + (near ? 6 : config().viewport_bits));
    for (SnappedVertex& v : d.quad.vertex) {
      if (ordinary) v.w = 1 << frac;
      if (ordinary || prng.chance(0.5)) {
        v.x = static_cast<std::int32_t>(prng.integer(-extent / 8, extent));
        v.y = static_cast<std::int32_t>(prng.integer(-extent / 8, extent));
      }
      if (on_pixels) {
        v.x &= -(1 << frac);
        v.y &= -(1 << frac);
      }
    }
    // Equal corners, opposite corners, a vertex in the plane of others: determinants of 0.
    const std::size_t i = prng.below(4), j = prng.below(4);
    if (prng.chance(0.2)) d.quad.vertex[i] = d.quad.vertex[j];
    if (!ordinary && prng.chance(0.2)) {
      d.quad.vertex[i].x = -d.quad.vertex[j].x;
      d.quad.vertex[i].y = -d.quad.vertex[j].y;
      d.quad.vertex[i].w = -d.quad.vertex[j].w;
    }
    if (prng.chance(0.7)) {
      d.state.scissor_x0 = d.state.scissor_y0 = 0;
      d.state.scissor_x1 = d.state.scissor_y1 = 1 << config().viewport_bits;
    }
  }

  void corners(const Sink& sink) const override {
    // Squares of a few pixels around tile boundaries and the ends of the viewport and guard band, each way round.
    StageData d;
    const int frac = config().frac(), one = 1 << frac, view = 1 << config().viewport_bits, tile = config().tile();
    d.state.scissor_x1 = d.state.scissor_y1 = view;
    for (const int at : {0, tile - 1, tile, 8 * tile, view - 1, view, -1, (1 << config().pos_int()) - 4})
      for (const int size : {0, 1, 3})
        for (const int offset : {0, 1, -1, one / 2})
          for (const bool mirrored : {false, true})
            for (const int w : {one, one / 2, -one, 0, 1}) {
              const std::int32_t lo = at * one + offset, hi = lo + size * one;
              d.quad.vertex = {{{lo, lo, one, {}, {}, {}},
                                {hi, lo, one, {}, {}, {}},
                                {hi, hi, w, {}, {}, {}},
                                {lo, hi, one, {}, {}, {}}}};
              if (mirrored) std::swap(d.quad.vertex[1], d.quad.vertex[3]);
              sink(d);
            }
    // The eye inside the hull: V0 to V3 around the origin of (x, y, w), and with one determinant 0.
    for (const int s : {1, -1})
      for (const int flip : {1, -1})
        for (const int w : {one, one / 2, 0}) {
          const int a = s * one, b = flip * one;
          d.quad.vertex = {
              {{a, b, w, {}, {}, {}}, {-a, b, -w, {}, {}, {}}, {a, -b, -w, {}, {}, {}}, {-a, -b, w, {}, {}, {}}}};
          sink(d);
        }
    // Empty scissor rectangles.
    d.quad.vertex = {{{0, 0, one, {}, {}, {}},
                      {one, 0, one, {}, {}, {}},
                      {one, one, one / 2, {}, {}, {}},
                      {0, one, one, {}, {}, {}}}};
    for (const int w : {one, one / 2})
      for (const int x : {0, 1, view})
        for (const int y : {0, 1, view}) {
          d.quad.vertex[2].w = w;
          d.state.scissor_x0 = d.state.scissor_x1 = x;
          d.state.scissor_y0 = 0, d.state.scissor_y1 = y;
          sink(d);
          std::swap(d.state.scissor_x0, d.state.scissor_y0);
          std::swap(d.state.scissor_x1, d.state.scissor_y1);
          sink(d);
        }
  }
};

// ---- tile contexts ----

/// The ten functions as the `tile` boundary has them.
template <class D, class F>
void visit_quadratic(D& d, const Config& c, F&& f) {
  visit_array(
      f, quadratic_value(c), quadratic_count, [&](std::size_t i) -> auto& { return d.tile.quadratic[i].value; });
  visit_array(
      f, quadratic_gx(c), quadratic_count, [&](std::size_t i) -> auto& { return d.tile.quadratic[i].gx; });
  visit_array(
      f, quadratic_gy(c), quadratic_count, [&](std::size_t i) -> auto& { return d.tile.quadratic[i].gy; });
  visit_array(
      f, quadratic_q(c), quadratic_count, [&](std::size_t i) -> auto& { return d.tile.quadratic[i].q; });
}

struct TileContextLists {
  template <class D, class F>
  static void stimulus(D& d, const Config& c, F&& f) {
    auto& v = d.constants.vertex;
    f(plain("homogeneous", 1, "some w is not 1: ten functions; else the four squared distances"), -1,
      d.constants.homogeneous);
    visit_array(
        f, fixed("x", t_bits(c), frac_bits(c), "px", "X - W x0 of the vertices; x0: the quad's first tile"),
        4, [&](std::size_t i) -> auto& { return v[i].x; });
    visit_array(
        f, fixed("y", t_bits(c), frac_bits(c), "px", "Y - W y0"), 4, [&](std::size_t i) -> auto& { return v[i].y; });
    visit_array(
        f, fixed("w", w_bits(c), frac_bits(c), "1", "W; all 1: an ordinary quad"),
        4, [&](std::size_t i) -> auto& { return v[i].w; });
    f(plain("column", tc_bits(c), "column of the tile, from the quad's first one", "tiles"), -1, d.tile_column);
    f(plain("row", tc_bits(c), "row of the tile, from the quad's first one", "tiles"), -1, d.tile_row);
  }

  template <class D, class F>
  static void response(D& d, const Config& c, F&& f) {
    visit_quadratic(d, c, f);
  }
};

class TileContext : public StageOf<TileContextLists> {
 public:
  explicit TileContext(const Config& config) : StageOf(config) {}

  Source source() const override { return Source::tiles; }

  void run(StageData& d) const override {
    d.tile.quadratic = tile_context(d.constants, d.tile_column << config().tile_log2, d.tile_row << config().tile_log2,
                                    config().qdrop());
  }

  FieldRange range(const RecordField& f) const override {
    if (f.name == "homogeneous") return {0, 1};
    if (f.name == "w") return {-one(), one()};
    if (f.name == "column" || f.name == "row") return {0, last_tile()};
    return {-reach() - last_tile() * tile_step(), reach()};
  }

  void constrain(StageData& d) const override {
    auto& v = d.constants.vertex;
    if (d.constants.homogeneous) {
      // Its first tile is the viewport's.
      for (RelativeVertex& s : v) {
        s.x = std::max(s.x, -reach());
        s.y = std::max(s.y, -reach());
      }
      return;
    }
    for (RelativeVertex& s : v) s.w = one();
    keep_inside(v, &RelativeVertex::x, d.tile_column);
    keep_inside(v, &RelativeVertex::y, d.tile_row);
  }

  void shape(golden::Prng& prng, StageData& d) const override {
    // Vertices about the tile, on pixels often, and equal or opposite ones.
    auto& v = d.constants.vertex;
    const bool on_pixels = prng.chance(0.3), near = prng.chance(0.7);
    const std::int64_t extent = one() << (near ? 6 : config().viewport_bits - 1);
    for (RelativeVertex& s : v) {
      if (!d.constants.homogeneous) s.w = one();
      if (prng.chance(0.8)) {
        s.x =
            std::clamp(s.w * (d.tile_column << config().tile_log2) + prng.integer(-extent, extent), -reach(), reach());
        s.y = std::clamp(s.w * (d.tile_row << config().tile_log2) + prng.integer(-extent, extent), -reach(), reach());
      }
      if (on_pixels) {
        s.x &= -one();
        s.y &= -one();
      }
    }
    const std::size_t i = prng.below(4), j = prng.below(4);
    if (prng.chance(0.2)) v[i] = v[j];
    if (prng.chance(0.2)) v[i] = {-std::max(v[j].x, -reach()), -std::max(v[j].y, -reach()), -v[j].w};
  }

  void corners(const Sink& sink) const override {
    // Positions at both ends, W of either sign and 0, the tile at each corner of the viewport.
    StageData d;
    auto& v = d.constants.vertex;
    const int far = static_cast<int>(last_tile());
    for (const int column : {0, 1, far})
      for (const int row : {0, 1, far}) {
        d.tile_column = column;
        d.tile_row = row;
        d.constants.homogeneous = true;
        for (const std::int64_t w : {one(), -one(), std::int64_t{1}, std::int64_t{-1}, std::int64_t{0}})
          for (const std::int64_t x : {reach(), -reach(), std::int64_t{1}})
            for (const std::int64_t y : {reach(), -reach(), std::int64_t{-1}}) {
              v = {{{x, y, w}, {-x, y, -w}, {x, -y, w / 2}, {y, x, one()}}};
              sink(d);
            }
        // First tile as far to the right and below as the tile lets it be, or the viewport's.
        d.constants.homogeneous = false;
        for (const std::int64_t first_x : {std::int64_t{0}, last_tile() - column})
          for (const std::int64_t first_y : {std::int64_t{0}, last_tile() - row}) {
            const std::int64_t x = first_x * tile_step(), y = first_y * tile_step();
            v = {{{-reach() - x, -reach() - y, one()},
                  {reach() - x, -reach() - y, one()},
                  {reach() - x, reach() - y, one()},
                  {-reach() - x, reach() - y, one()}}};
            sink(d);
          }
      }
  }

 private:
  std::int64_t one() const { return std::int64_t{1} << config().frac(); }
  std::int64_t reach() const { return std::int64_t{1} << (config().pos_int() + config().frac()); }
  std::int64_t last_tile() const { return (std::int64_t{1} << (config().viewport_bits - config().tile_log2)) - 1; }
  /// A tile's edge in units of a position.
  std::int64_t tile_step() const { return one() << config().tile_log2; }

  /// Of an ordinary quad: there is a first tile that leaves the tile in the viewport and every vertex in the guard
  /// band.
  void keep_inside(std::array<RelativeVertex, 4>& v, std::int64_t RelativeVertex::*coordinate, int& tile) const {
    const std::int64_t least = std::ranges::min(v, {}, coordinate).*coordinate;
    const std::int64_t first = std::max<std::int64_t>(0, (-reach() - least + tile_step() - 1) / tile_step());
    tile = static_cast<int>(std::min<std::int64_t>(tile, last_tile() - first));
    for (RelativeVertex& s : v) s.*coordinate = std::min(s.*coordinate, reach() - first * tile_step());
  }
};

// ---- coverage ----

struct CoverageLists {
  template <class D, class F>
  static void stimulus(D& d, const Config& c, F&& f) {
    f(plain("cull", 2, "0 none, 1 front, 2 back"), -1, d.state.cull);
    visit_scissor(d, c, f);
    f(plain("tile_x", tc_bits(c), "column of the tile", "tiles"), -1, d.tile.tile_x);
    f(plain("tile_y", tc_bits(c), "row of the tile", "tiles"), -1, d.tile.tile_y);
    visit_array(
        f, linear_value(c), 5, [&](std::size_t i) -> auto& { return d.tile.linear[i]; });
    visit_array(
        f, linear_gx(c), 5, [&](std::size_t i) -> auto& { return d.constants.gx[i]; });
    visit_array(
        f, linear_gy(c), 5, [&](std::size_t i) -> auto& { return d.constants.gy[i]; });
    f(plain("visible", 4, "clauses that may be drawn, as in the setup suite"), -1, d.constants.visible);
  }

  template <class D, class F>
  static void response(D& d, const Config& c, F&& f) {
    const Bits tile = tile_bits(c);
    visit_array(
        f, plain("mask", tile, "covered pixels of row `index`, bit dx"),
        tile, [&](std::size_t i) -> auto& { return d.row_masks[i].mask; });
    visit_array(
        f, plain("front", tile, "of these, front faces (anticlockwise with y down)"),
        tile, [&](std::size_t i) -> auto& { return d.row_masks[i].front; });
    visit_array(
        f, plain("tie", tile, "of these, decided by the tie rule"),
        tile, [&](std::size_t i) -> auto& { return d.row_masks[i].tie; });
  }
};

class Coverage : public StageOf<CoverageLists> {
 public:
  explicit Coverage(const Config& config) : StageOf(config) {}

  Source source() const override { return Source::tiles; }

  void run(StageData& d) const override {
    for (std::size_t k = 0; k < 5; ++k) {
      const LinearForm form{0, d.constants.gx[k], d.constants.gy[k]};
      d.constants.tie_pos[k] = tie_positive(form);
      d.constants.tie_neg[k] = tie_negative(form);
    }
    for (int r = 0; r < config().tile(); ++r)
      d.row_masks[static_cast<std::size_t>(r)] = stamp_coverage(d.tile, d.constants, r, config(), d.state);
  }

  FieldRange range(const RecordField& f) const override {
    if (f.name == "cull") return {0, 2};
    if (f.name.starts_with("scissor")) return {0, std::int64_t{1} << config().viewport_bits};
    if (f.name.starts_with("tile_")) return {0, (std::int64_t{1} << (config().viewport_bits - config().tile_log2)) - 1};
    return StageUnderTest::range(f);
  }

  void constrain(StageData& d) const override {
    order_scissor(d.state);
    for (std::size_t k = 0; k < 5; ++k)
      while (!inside(d.tile.linear[k], d.constants.gx[k], d.constants.gy[k])) {
        d.tile.linear[k] >>= 1;
        d.constants.gx[k] >>= 1;
        d.constants.gy[k] >>= 1;
      }
    // Either sign of a clause, or neither, or all.
    unsigned& v = d.constants.visible;
    if (v != 15) v &= ~(v << 2 & 12);
  }

  void shape(golden::Prng& prng, StageData& d) const override {
    // Edges that cross the tile, many of them through pixels; small steps make several zeros.
    const int tile = config().tile();
    for (std::size_t k = 0; k < 5; ++k) {
      const std::int64_t size = std::int64_t{1} << prng.below(static_cast<std::uint64_t>(config().grad_bits() - 6));
      const std::int64_t gx = prng.integer(-3, 3) * size, gy = prng.integer(-3, 3) * size;
      d.constants.gx[k] = gx;
      d.constants.gy[k] = gy;
      d.tile.linear[k] =
          -gx * prng.integer(0, tile - 1) - gy * prng.integer(0, tile - 1) + prng.integer(-1, 1) * (size / 2);
    }
    if (prng.chance(0.7)) d.constants.visible = 15;
    // A scissor rectangle about the tile, or all of the viewport.
    const int x = d.tile.tile_x << config().tile_log2, y = d.tile.tile_y << config().tile_log2;
    const int view = 1 << config().viewport_bits;
    const auto around = [&](int v, std::int64_t lo, std::int64_t hi) {
      return std::clamp(v + static_cast<int>(prng.integer(lo, hi)), 0, view);
    };
    const bool whole = prng.chance(0.5);
    d.state.scissor_x0 = whole ? 0 : around(x, -2, tile);
    d.state.scissor_y0 = whole ? 0 : around(y, -2, tile);
    d.state.scissor_x1 = whole ? view : around(x, 0, tile + 2);
    d.state.scissor_y1 = whole ? view : around(y, 0, tile + 2);
  }

  void corners(const Sink& sink) const override {
    // Every combination of signs of the five functions, constant over the tile and with a tie in each direction.
    StageData d;
    d.state.scissor_x1 = d.state.scissor_y1 = 1 << config().viewport_bits;
    const auto each_sign = [&](const auto& set) {
      for (int code = 0; code < 243; ++code) {
        int rest = code;
        for (std::size_t k = 0; k < 5; ++k, rest /= 3) set(k, rest % 3 - 1);
        sink(d);
      }
    };
    d.constants.visible = 15;
    each_sign([&](std::size_t k, int sign) { d.tile.linear[k] = sign; });
    for (std::int64_t& v : d.tile.linear) v = 0;
    each_sign([&](std::size_t k, int sign) { d.constants.gx[k] = sign; });
    d.constants.gx.fill(0);
    each_sign([&](std::size_t k, int sign) { d.constants.gy[k] = sign; });
    d.constants.gy.fill(0);
    // Each clause alone, against culling and visibility.
    constexpr int clause[4][5] = {{1, 1, 1, 0, 1}, {1, 0, 1, 1, -1}, {-1, -1, -1, 0, -1}, {-1, 0, -1, -1, 1}};
    for (const auto& signs : clause)
      for (int cull = 0; cull < 3; ++cull)
        for (unsigned visible = 0; visible < 16; ++visible) {
          for (std::size_t k = 0; k < 5; ++k) d.tile.linear[k] = signs[k];
          d.state.cull = static_cast<Cull>(cull);
          d.constants.visible = visible;
          sink(d);
        }
  }

 private:
  /// The function stays inside VAL_BITS on the whole tile.
  bool inside(std::int64_t value, std::int64_t gx, std::int64_t gy) const {
    const int last = config().tile() - 1;
    for (const int dx : {0, last})
      for (const int dy : {0, last})
        if (!fits(static_cast<__int128>(value) + static_cast<__int128>(gx) * dx + static_cast<__int128>(gy) * dy,
                  config().val_bits()))
          return false;
    return true;
  }
};

// ---- forward differences ----

struct ForwardLists {
  template <class D, class F>
  static void stimulus(D& d, const Config& c, F&& f) {
    f(plain("row", tile_log2(c), "row in the tile", "px"), -1, d.row);
    f(plain("dx", tile_log2(c), "column in the tile", "px"), -1, d.dx);
    f(plain("homogeneous", 1, "D as its functions say; else by the law of cosines, from r2 and length2"), -1,
      d.constants.homogeneous);
    visit_array(
        f, linear_value(c), linear_count, [&](std::size_t i) -> auto& { return d.tile.linear[i]; });
    visit_array(
        f, linear_gx(c), linear_count, [&](std::size_t i) -> auto& { return d.constants.gx[i]; });
    visit_array(
        f, linear_gy(c), linear_count, [&](std::size_t i) -> auto& { return d.constants.gy[i]; });
    visit_quadratic(d, c, f);
    visit_array(
        f, squared_length(c), linear_count, [&](std::size_t i) -> auto& { return d.constants.length2[i]; });
  }

  template <class D, class F>
  static void response(D& d, const Config& c, F&& f) {
    visit_exact(d.pixel, c, f);
  }
};

class ForwardDifference : public StageOf<ForwardLists> {
 public:
  explicit ForwardDifference(const Config& config) : StageOf(config) {}

  void run(StageData& d) const override { forward_difference(d.pixel, d.tile, d.constants, d.dx, d.row); }

  FieldRange range(const RecordField& f) const override {
    if (f.name != "quad_q") return StageUnderTest::range(f);
    const std::int64_t one = std::int64_t{1} << std::max(0, config().quadratic_frac());
    return {f.index < 6 ? -one : 0, one};
  }

  void constrain(StageData& d) const override {
    const auto halve_until = [](const auto& fine, auto&... values) {
      while (!fine()) ((values >>= 1), ...);
    };
    for (std::size_t k = 0; k < linear_count; ++k) {
      std::int64_t &v = d.tile.linear[k], &gx = d.constants.gx[k], &gy = d.constants.gy[k];
      halve_until([&] { return fits(v, config().val_bits()) && fits(at(v, gx, gy, 0, d), config().val_bits()); }, v, gx,
                  gy);
    }
    for (std::size_t k = 0; k < quadratic_count; ++k) {
      QuadraticForm& q = d.tile.quadratic[k];
      halve_until(
          [&] {
            return fits(q.value, config().qval_bits()) && fits(at(q.value, q.gx, q.gy, q.q, d), config().qval_bits());
          },
          q.value, q.gx, q.gy, q.q);
    }
    if (d.constants.homogeneous) return;
    for (std::size_t k = 0; k < linear_count; ++k) {
      const __int128 sum = r2(d, vertex_pair[k][0]) + r2(d, vertex_pair[k][1]);
      std::uint64_t& length2 = d.constants.length2[k];
      halve_until([&] { return fits((sum - static_cast<__int128>(length2)) >> 1, config().qval_bits()); }, length2);
    }
  }

  void corners(const Sink& sink) const override {
    // D of an ordinary quad at its ends, and the floor of every kind of odd sum.
    const auto most = static_cast<std::int64_t>((std::uint64_t{1} << (config().qval_bits() - 1)) - 1);
    const std::uint64_t longest = std::uint64_t{1} << (config().length2_bits() - 1);
    StageData d;
    for (std::size_t k = 0; k < linear_count; ++k)
      for (const std::int64_t first : {std::int64_t{0}, std::int64_t{1}, most})
        for (const std::int64_t second : {std::int64_t{0}, std::int64_t{1}, most - 1, most})
          for (const std::uint64_t length2 : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{2}, longest}) {
            d = {};
            d.tile.quadratic[linear_count + vertex_pair[k][0]].value = first;
            d.tile.quadratic[linear_count + vertex_pair[k][1]].value = second;
            d.constants.length2[k] = length2;
            sink(d);
          }
  }

 private:
  static __int128 at(__int128 value, __int128 gx, __int128 gy, __int128 q, const StageData& d) {
    return value + d.dx * gx + d.row * gy + (d.dx * d.dx + d.row * d.row) * q;
  }
  static __int128 r2(const StageData& d, std::size_t i) {
    const QuadraticForm& f = d.tile.quadratic[linear_count + i];
    return at(f.value, f.gx, f.gy, f.q, d);
  }
};

}  // namespace

void add_front_stages(std::vector<std::unique_ptr<Suite>>& suites) {
  const auto add = [&](SuiteInfo info, StageSuite::Make make) {
    suites.push_back(std::make_unique<StageSuite>(std::move(info), make));
  };
  add({"snapping", "snapping", "Quads as given to the integers of the port", "none", 0,
       "nothing: any double may occur"},
      make_stage<Snapping>);
  add({"setup", "handshake", "Edge functions, squared lengths, tiles and visibility of a quad", "quad_setup", 0,
       "|x| or |y| above 2^(POS_INT+FRAC); |w| above 2^FRAC; x = y = w = 0; a scissor rectangle beyond 2^VIEWPORT_BITS "
       "or with x0 > x1 or y0 > y1"},
      make_stage<Setup>);
  add({"tile_context", "handshake", "Quadratic functions of a tile from its quad's vertices", "tile_context", 0,
       "a column or row beyond 2^VIEWPORT_BITS pixels; |w| above 2^FRAC; a homogeneous quad's |x| or |y| above "
       "2^(POS_INT+FRAC); an ordinary quad's w other than 2^FRAC, or its vertices beyond 2^(POS_INT+FRAC) from the "
       "viewport's origin wherever the first tile is, as long as the tile is in the viewport"},
      make_stage<TileContext>);
  add({"coverage", "handshake", "Covered pixels of a tile", "stamp_coverage", 0,
       "a function beyond VAL_BITS anywhere on the tile; a tile beyond 2^VIEWPORT_BITS; cull = 3; visible bits 0 and "
       "2, "
       "or 1 and 3, both set, unless all four are"},
      make_stage<Coverage>);
  add({"forward_difference", "stage", "A, D and squared distances at a pixel from those of its tile",
       "forward_difference", latency::forward_difference_stages + latency::law_of_cosines_stages,
       "results beyond VAL_BITS (A) or QVAL_BITS (D, r2), though partial sums may be; a negative q of a squared "
       "distance"},
      make_stage<ForwardDifference>);
}

}  // namespace quadrille::vectors
