// Every corner group really holds its case: exact determinants of the snapped integers, and what the pixels of the
// plain pipeline are.
#include "golden/scenes/corner_quads.hpp"

#include "golden/scenes/corner_test_support.hpp"
#include "golden/scenes/random_quads.hpp"
#include "model/front/quad_setup.hpp"
#include "model/front/tile_context.hpp"
#include "model/port/snap.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

namespace quadrille::golden {
namespace {

Config coarse(int quadratic_frac_bits) {
  Config config = narrow_config();
  config.set("quadratic_frac_bits", quadratic_frac_bits);
  return config;
}

int corners(const PixelTrace& p) {
  return static_cast<int>(std::ranges::count_if(p.r2, [](std::int64_t r2) { return r2 <= 0; }));
}

int edges(const PixelTrace& p) {
  int count = 0;
  for (std::size_t i = 0; i < 4; ++i) count += p.a[i] == 0 && p.d[i] < 0;
  return count;
}

using Wide = __int128;

int determinant_sign(const SnappedVertex& a, const SnappedVertex& b, const SnappedVertex& c) {
  const auto minor = [](std::int64_t p, std::int64_t q, std::int64_t r, std::int64_t s) {
    return static_cast<Wide>(p) * s - static_cast<Wide>(q) * r;
  };
  const Wide d = a.x * minor(b.y, b.w, c.y, c.w) - a.y * minor(b.x, b.w, c.x, c.w) + a.w * minor(b.x, b.y, c.x, c.y);
  return (d > 0) - (d < 0);
}

TEST(CornerQuads, GroupsAreListedInOrderAndParse) {
  std::set<std::string_view> names;
  for (const CornerGroupInfo& info : corner_groups()) {
    EXPECT_EQ(static_cast<std::size_t>(info.group), names.size());
    EXPECT_TRUE(names.insert(info.name).second);
    EXPECT_EQ(parse_corner_group(info.name), info.group);
    EXPECT_FALSE(info.holds.empty());
  }
  EXPECT_EQ(corner_draws(Config{}, 1).size(), names.size());
  EXPECT_THROW(parse_corner_group("corner"), std::invalid_argument);
}

TEST(CornerQuads, SeedDecides) {
  const Config config;
  for (const CornerGroupInfo& info : corner_groups()) {
    const DrawState state = tb::small_state(config);
    const auto a = make_corner(info.group, config, state, 3, 2), b = make_corner(info.group, config, state, 3, 2),
               c = make_corner(info.group, config, state, 4, 2);
    ASSERT_EQ(a.size(), b.size());
    bool differs = a.size() != c.size();
    for (std::size_t i = 0; i < a.size(); ++i) {
      for (std::size_t v = 0; v < 4; ++v) {
        EXPECT_EQ(a[i].vertex[v].x, b[i].vertex[v].x);
        EXPECT_EQ(a[i].attribute[v], b[i].attribute[v]);
        differs = differs || a[i].vertex[v].x != c[i].vertex[v].x;
      }
    }
    EXPECT_TRUE(differs) << info.name;
  }
}

TEST(CornerQuads, FacePlaneHasEveryCombinationOfSigns) {
  for (const Config& config : {Config{}, narrow_config()}) {
    std::map<std::array<int, 4>, int> seen;
    std::set<std::array<int, 4>> hull;
    const CornerDraw draw = draw_of(config, CornerGroup::face_plane);
    for (const SnappedQuad& quad : draw.quads) {
      const auto& v = quad.vertex;
      const std::array<int, 4> signs{determinant_sign(v[0], v[1], v[2]), determinant_sign(v[0], v[2], v[3]),
                                     determinant_sign(v[1], v[2], v[3]), determinant_sign(v[0], v[1], v[3])};
      ++seen[signs];
    }
    EXPECT_EQ(seen.size(), 73u);  // 81 but the 8 with one determinant away from 0
    // The eye in the plane of one face, the others of one sign, which makes it an eye in the hull: each face, each
    // sign.
    constexpr std::array<int, 4> outward{-1, -1, 1, 1};  // d_012, d_023, d_123, d_013
    for (std::size_t face = 0; face < 4; ++face) {
      for (const int sign : {-1, 1}) {
        std::array<int, 4> wanted = outward;
        for (int& s : wanted) s *= sign;
        wanted[face] = 0;
        EXPECT_GE(seen[wanted], 2) << "face " << face << ", sign " << sign;
      }
    }
  }
}

TEST(CornerQuads, FlatPixelsAreInSeveralClasses) {
  const Config config;
  std::map<std::pair<int, int>, int> seen;  // corners, edges
  int skipped_second = 0, nowhere = 0;
  for_each_pixel(draw_of(config, CornerGroup::flat), config,
                 [&](const SnappedQuad&, const TileEntry&, const PixelTrace& p) {
                   ++seen[{std::min(corners(p), 2), std::min(edges(p), 2)}];
                   const auto on = [&](std::size_t e) { return p.a[e] == 0 && p.d[e] < 0; };
                   nowhere += p.hull && p.den_w.sig == 0;
                   skipped_second += corners(p) == 0 && edges(p) >= 3 && on(1) && on(2);
                 });
  for (const auto& both : {std::pair{1, 1}, {1, 2}, {2, 1}, {0, 2}})
    EXPECT_GT((seen[both]), 0) << both.first << " corners, " << both.second << " edges";
  EXPECT_GT(nowhere, 5) << "neither in front of the eye nor behind it";
  EXPECT_GT(skipped_second, 0) << "no pixel on edges 1 and 2 and a third";
}

TEST(CornerQuads, DenominatorOfDepthIsZeroWithoutAnEyeInTheHull) {
  const Config config = narrow_config();
  int zero = 0;
  for_each_pixel(draw_of(config, CornerGroup::den_w_zero), config,
                 [&](const SnappedQuad&, const TileEntry&, const PixelTrace& p) {
                   zero += p.den_w.sig == 0 && !p.hull && !p.two_corner && !p.on_vertex;
                 });
  EXPECT_GT(zero, 100);
}

TEST(CornerQuads, SquaredDistancesBecomeNegative) {
  for (const int bits : {0, 3, 6}) {
    const Config config = coarse(bits);
    int ordinary = 0, homogeneous = 0, many = 0;
    for (const std::uint64_t seed : {1, 2, 3})
      for_each_pixel(draw_of(config, CornerGroup::negative_r2, seed), config,
                     [&](const SnappedQuad& quad, const TileEntry&, const PixelTrace& p) {
                       const bool negative = std::ranges::any_of(p.r2, [](std::int64_t r2) { return r2 < 0; });
                       (is_ordinary(quad, config) ? ordinary : homogeneous) += negative;
                       many += corners(p) >= 3;
                     });
    EXPECT_GT(ordinary, 5) << bits;
    EXPECT_GT(homogeneous, 5) << bits;
    if (bits == 0) {
      EXPECT_GT(many, 5);
    }
  }
}

TEST(CornerQuads, TwoCornersOfDifferentFactor) {
  const Config config;
  std::set<std::size_t> pairs;
  for_each_pixel(draw_of(config, CornerGroup::two_corner), config,
                 [&](const SnappedQuad& quad, const TileEntry&, const PixelTrace& p) {
                   if (!p.two_corner) return;
                   for (std::size_t i = 0; i < 4; ++i) {
                     const std::size_t j = (i + 1) % 4;
                     if (p.r2[i] == 0 && p.r2[j] == 0 && quad.vertex[i].k.sig != quad.vertex[j].k.sig) pairs.insert(i);
                   }
                 });
  EXPECT_EQ(pairs.size(), 4u);
}

TEST(CornerQuads, CrossingEdgesHaveEndsOfEitherSign) {
  const Config config;
  std::set<std::pair<std::size_t, std::size_t>> pairs;
  int first = 0, second = 0;
  for_each_pixel(draw_of(config, CornerGroup::two_edge), config,
                 [&](const SnappedQuad& quad, const TileEntry&, const PixelTrace& p) {
                   if (!p.two_edge || !p.drawn) return;
                   const auto on = [&](std::size_t e) { return p.a[e] == 0 && p.d[e] < 0; };
                   const auto behind = [&](std::size_t v) { return quad.vertex[v % 4].w < 0; };
                   std::size_t a = 0;
                   while (!on(a)) ++a;
                   std::size_t b = a + 1;
                   while (!on(b)) ++b;
                   pairs.insert({a, b});
                   first += behind(a) != behind(a + 1);
                   second += behind(b) != behind(b + 1);
                 });
  EXPECT_EQ(pairs.size(), 6u);
  EXPECT_GT(first, 5);
  EXPECT_GT(second, 5);
}

TEST(CornerQuads, TallOnesReachEveryRowOfBlocksAndSeveralColumns) {
  for (const int tile_log2 : {2, 3}) {
    Config config;
    config.set("tile_log2", tile_log2);
    const CornerDraw draw = draw_of(config, CornerGroup::tall);
    std::map<int, std::set<int>> columns;  // of each row of blocks
    for_each_pixel(draw, config, [&](const SnappedQuad& quad, const TileEntry& tile, const PixelTrace&) {
      const SetupResult setup = quad_setup(quad, config, draw.state);
      columns[(tile.tile_y - setup.tile_y0) / Config::block_tiles].insert((tile.tile_x - setup.tile_x0) /
                                                                          Config::block_tiles);
    });
    EXPECT_GE(columns.size(), 10u);
    int wide = 0;
    for (const auto& [row, set] : columns) wide += row >= 4 && set.size() >= 2;
    EXPECT_GE(wide, 3) << "the direction of the walk shows in a row with several blocks alone";
  }
}

TEST(CornerQuads, BurstQuadsCoverOnePixelOrNoneButForFour) {
  const Config config;
  std::map<std::uint32_t, int> pixels;
  const CornerDraw draw = draw_of(config, CornerGroup::burst);
  for_each_pixel(draw, config,
                 [&](const SnappedQuad& quad, const TileEntry&, const PixelTrace&) { ++pixels[quad.id]; });
  EXPECT_EQ(pixels.size(), draw.quads.size() * 7 / 8);
  EXPECT_EQ(std::ranges::count_if(pixels, [](const auto& quad) { return quad.second == 1; }),
            static_cast<std::ptrdiff_t>(pixels.size()) - 4);
  EXPECT_EQ(std::ranges::count_if(pixels, [](const auto& quad) { return quad.second > 64; }), 4);
  EXPECT_GE(draw.stall, 0.95);
}

std::int64_t largest(std::int64_t before, std::int64_t v) { return std::max(before, v < 0 ? -v : v); }

/// Numbers that one bit less would not hold.
TEST(CornerQuads, ExtremesNeedEveryBit) {
  Config wide;
  wide.set("viewport_bits", 9);
  wide.set("guard_bits", 1);
  for (const Config& config : {Config{}, wide}) {
    std::map<std::string, int> widths;
    for (const DerivedWidth& width : config.derived()) widths[width.name] = static_cast<int>(width.value);
    const auto needs = [&](const char* name, std::int64_t value) {
      EXPECT_GE(value, std::int64_t{1} << (widths.at(name) - 2)) << name << ", guard_bits " << config.guard_bits;
    };
    std::int64_t t = 0, w = 0, gradient = 0, slope = 0, curvature = 0;
    std::uint64_t length2 = 0;
    const CornerDraw extreme = draw_of(config, CornerGroup::extreme);
    for (const SnappedQuad& quad : extreme.quads) {
      for (const SnappedVertex& v : quad.vertex) {
        t = largest(t, v.x);
        w = largest(w, v.w);
      }
      const SetupResult setup = quad_setup(quad, config, extreme.state);
      for (const LinearForm& f : setup.linear) gradient = largest(largest(gradient, f.gx), f.gy);
      length2 = std::max(length2, std::ranges::max(setup.length2));
      for (const QuadraticForm& f : tile_context(QuadConstants(setup), 0, 0, config.qdrop())) {
        slope = largest(largest(slope, f.gx), f.gy);
        curvature = largest(curvature, f.q);
      }
    }
    needs("T_BITS", t);
    needs("W_BITS", w);
    needs("GRAD_BITS", gradient);
    needs("QGRAD_BITS", slope);
    needs("QCURV_BITS", curvature);
    EXPECT_GE(length2, std::uint64_t{1} << (config.length2_bits() - 1)) << "LENGTH2_BITS";  // unsigned

    std::int64_t area = 0, dot = 0, square = 0;
    int pixels = 0;
    for_each_pixel(draw_of(config, CornerGroup::far_corner), config,
                   [&](const SnappedQuad&, const TileEntry&, const PixelTrace& p) {
                     ++pixels;
                     for (const std::int64_t a : p.a) area = largest(area, a);
                     for (const std::int64_t d : p.d) dot = largest(dot, d);
                     for (const std::int64_t r2 : p.r2) square = largest(square, r2);
                   });
    needs("VAL_BITS", dot);
    needs("VAL_BITS", square);
    if (config.guard_bits > 1) needs("VAL_BITS", area);  // else 3 (2^(POS_INT + FRAC))², where D has 4.5
    EXPECT_GT(pixels, 200);
  }
}

}  // namespace
}  // namespace quadrille::golden
