// Quadratic functions of a tile, and its functions at a pixel.
#include "golden/vectors/stage_numbers.hpp"
#include "golden/vectors/stage_of.hpp"
#include "golden/vectors/stage_suites.hpp"
#include "model/front/tile_context.hpp"

#include <algorithm>

namespace quadrille::vectors {
namespace {

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

Stage make_tile_context(const Config& config) { return std::make_unique<TileContext>(config); }
Stage make_forward_difference(const Config& config) { return std::make_unique<ForwardDifference>(config); }

}  // namespace quadrille::vectors
