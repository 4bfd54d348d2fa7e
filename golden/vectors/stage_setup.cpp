// Setup of a quad and coverage of its tiles.
#include "golden/vectors/stage_numbers.hpp"
#include "golden/vectors/stage_of.hpp"
#include "golden/vectors/stage_suites.hpp"
#include "model/front/quad_setup.hpp"

#include <algorithm>

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

}  // namespace

Stage make_setup(const Config& config) { return std::make_unique<Setup>(config); }
Stage make_coverage(const Config& config) { return std::make_unique<Coverage>(config); }

}  // namespace quadrille::vectors
