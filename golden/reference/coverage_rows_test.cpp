// Rows against a scan of everything: no pixel is lost, and how many are looked at.
#include "golden/reference/coverage_rows.hpp"

#include "golden/reference/exact_coverage.hpp"
#include "golden/reference/paper_float.hpp"
#include "golden/reference/test_quads.hpp"
#include "golden/reference/truth.hpp"
#include "golden/scenes/projection.hpp"
#include "golden/scenes/random_quads.hpp"
#include "golden/scenes/stress.hpp"
#include "golden/scenes/terrain.hpp"
#include "model/port/snap.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace quadrille::golden {
namespace {

const Config config;

DrawState viewport(int side) {
  DrawState state;
  state.width = state.height = state.scissor_x1 = state.scissor_y1 = side;
  state.attributes = 0;
  return state;
}

/// Neither side nor corner of the scissor is one of the viewport.
DrawState scissored(int side) {
  DrawState state = viewport(side);
  state.scissor_x0 = 5, state.scissor_y0 = 3, state.scissor_x1 = side - 7, state.scissor_y1 = side - 2;
  return state;
}

struct Scan {
  std::uint64_t drawn = 0, lost = 0;
  std::string first;
};

/// Every pixel of the scissor by `draws`, and whether the rows hold it.
template <class Draws>
void scan(const CoverageRows& rows, const DrawState& state, const std::string& name, Scan& out, const Draws& draws) {
  const PixelRect &all = scissor_of(state), &box = rows.bounds();
  for (int y = all.y0; y < all.y1; ++y) {
    PixelSpan row;
    if (y >= box.y0 && y < box.y1) {
      row = rows.row(y);
      ASSERT_TRUE(row.size() == 0 || (row.x0 >= box.x0 && row.x1 <= box.x1)) << name;
    }
    for (int x = all.x0; x < all.x1; ++x) {
      if (!draws(x, y)) continue;
      ++out.drawn;
      if (x >= row.x0 && x < row.x1) continue;
      if (out.lost++ == 0) out.first = name + " at (" + std::to_string(x) + ", " + std::to_string(y) + ")";
    }
  }
}

/// What the bodies draw of a quad, and the second opinion on coverage.
template <class... Source>
void scan_bodies(const std::string& name, const DrawState& state, Scan& out, const Source&... source) {
  const TruthQuad truth(source..., state);
  scan(truth.rows(), state, name + ", truth", out, [&](int x, int y) {
    const Coverage c = truth.cover(x, y);
    return c.covered && c.visible;
  });
  const PaperFp64Quad fp64(source..., state);
  scan(fp64.rows(), state, name + ", float", out, [&](int x, int y) { return fp64.sample(x, y).covered; });
  const PaperFp32Quad fp32(source..., state);
  scan(fp32.rows(), state, name + ", fp32", out, [&](int x, int y) { return fp32.sample(x, y).covered; });
}

/// A quad as a whole changed: mirrored through the eye, moved far away, scaled.
std::vector<WindowQuad> relatives(const WindowQuad& quad) {
  std::vector<WindowQuad> out{quad};
  const auto add = [&](auto&& change) {
    out.push_back(quad);
    for (WindowVertex& v : out.back().vertex) change(v);
  };
  add([](WindowVertex& v) { v.x = -v.x, v.y = -v.y, v.w = -v.w; });                   // behind the eye, same place
  add([](WindowVertex& v) { v.x += 3e5 * std::fabs(v.w); });                          // beyond the guard band
  add([](WindowVertex& v) { v.x = 40 * v.w + 9e3 * (v.x - 40 * v.w), v.y *= 1.1; });  // wider than the guard band
  add([](WindowVertex& v) { v.x *= 0x1p-70, v.y *= 0x1p-70, v.w *= 0x1p-70; });
  return out;
}

/// Random, crossed, thin, homogeneous, behind the eye, beyond the guard band, the eye in the hull.
TEST(CoverageRows, HoldEveryPixelOfTheFamilies) {
  constexpr int side = 48;
  const DrawState state = scissored(side);
  for (const StressFamilyInfo& family : stress_families()) {
    Scan found;
    for (const WindowQuad& made : make_stress(family.family, 4, 3, 1, side, side, 0)) {
      for (const WindowQuad& quad : relatives(made)) {
        const std::string name = std::string(family.name) + " " + std::to_string(quad.id);
        scan_bodies(name + " as given", state, found, quad);
        scan_bodies(name + " snapped", state, found, snap_quad(quad, config, state), config);
      }
    }
    EXPECT_EQ(found.lost, 0u) << "of " << found.drawn << "; the first: " << found.first;
    EXPECT_GT(found.drawn, 10u) << family.name;
  }
}

/// Corners of the port: exact ties, collapsed and all-zero edges, w = 0.
TEST(CoverageRows, HoldEveryPixelOfRandomQuads) {
  Scan found, other;
  for (const int side : {48, 33}) {
    const DrawState state = scissored(side);
    for (const SnappedQuad& quad : tb::random_quads(config, state, 7, 600)) {
      scan_bodies("quad " + std::to_string(quad.id), state, found, quad, config);
      const TruthQuad truth(quad, config, state);
      scan(truth.rows(), state, "exact coverage", other, [&](int x, int y) {
        const ExactCoverage c = exact_coverage(quad, x, y);
        return c.covered && c.visible && truth.cover(x, y).covered;
      });
    }
  }
  EXPECT_EQ(found.lost, 0u) << found.first;
  EXPECT_EQ(other.lost, 0u) << other.first;
  EXPECT_GT(found.drawn, 100'000u);
}

/// Integer corners in a small grid: every edge runs through pixel centres, and most triangles of (12) are flat.
TEST(CoverageRows, HoldEveryPixelOfASmallGrid) {
  test::Random random(11);
  const DrawState state = viewport(12);
  Scan found;
  for (int n = 0; n < 4'000; ++n) {
    std::array<test::Point, 4> corner;
    for (test::Point& p : corner) {
      p.w = n % 2 == 0 ? 1 : random.integer(-1, 2);
      p.x = random.integer(-2, 4), p.y = random.integer(-2, 4);
      if (p.x == 0 && p.y == 0 && p.w == 0) p.x = 1;
    }
    scan_bodies("quad " + std::to_string(n), state, found, test::make_quad(corner), config);
  }
  EXPECT_EQ(found.lost, 0u) << found.first;
  EXPECT_GT(found.drawn, 50'000u);
}

TEST(CoverageRows, NumbersAtTheEndsOfDouble) {
  const DrawState state = viewport(16);
  Scan found;
  for (const double scale : {1e-300, 1e-160, 1e-100, 1e100, 1e160, 1e300}) {
    WindowQuad quad;
    quad.vertex = {{{2, 3, 0.5, 1}, {13, 2, 0.5, 1}, {12, 11, 0.5, 1}, {1, 14, 0.5, 1}}};
    for (WindowVertex& v : quad.vertex) v.x *= scale, v.y *= scale, v.w *= scale;
    scan_bodies("scale " + std::to_string(scale), state, found, quad);
  }
  EXPECT_EQ(found.lost, 0u) << found.first;
  EXPECT_GT(found.drawn, 1'000u);
}

/// What is to be seen of boxes: by hand.
TEST(CoverageRows, AreTight) {
  using Vertices = std::array<CoverageRows::Vertex, 4>;
  const PixelRect all{0, 0, 1000, 1000};
  const auto bounds = [&](const Vertices& v, CoverageRows::Eye eye) { return CoverageRows(v, 0, all, eye).bounds(); };
  constexpr auto in_front = CoverageRows::Eye::in_front, anywhere = CoverageRows::Eye::anywhere;
  const Vertices plain{{{10, 7, 1}, {20, 7, 1}, {20, 9, 1}, {10, 9, 1}}};
  EXPECT_EQ(bounds(plain, in_front), (PixelRect{10, 7, 21, 10}));
  // The same place through other w, and behind the eye.
  EXPECT_EQ(bounds({{{20, 14, 2}, {60, 21, 3}, {10, 4.5, 0.5}, {10, 9, 1}}}, in_front), (PixelRect{10, 7, 21, 10}));
  const Vertices behind{{{-10, -7, -1}, {-20, -7, -1}, {-20, -9, -1}, {-10, -9, -1}}};
  EXPECT_TRUE(bounds(behind, in_front).empty());
  EXPECT_EQ(bounds(behind, anywhere), (PixelRect{10, 7, 21, 10}));
  // Out of the picture.
  EXPECT_TRUE(bounds({{{-10, 7, 1}, {-1, 7, 1}, {-1, 9, 1}, {-10, 9, 1}}}, anywhere).empty());
  EXPECT_TRUE(bounds({{{10, 1007, 1}, {20, 1007, 1}, {20, 1009, 1}, {10, 1009, 1}}}, anywhere).empty());
  // A floor with its near edge behind the eye, which is above it: from y = 300 down, to both sides.
  const Vertices floor{{{-100, 600, 2}, {1400, 600, 2}, {900, 400, -1}, {-200, 400, -1}}};
  EXPECT_EQ(bounds(floor, in_front), (PixelRect{0, 300, 1000, 1000}));
  EXPECT_EQ(CoverageRows(floor, 0, all, in_front).row(300).x1, 701);  // its corner (1400, 600) / 2
  // A diagonal as thin as a pixel: rows of a few pixels, not of the box.
  const CoverageRows thin({{{0, 0, 1}, {1, 0, 1}, {1000, 999, 1}, {999, 999, 1}}}, 0, all, in_front);
  EXPECT_EQ(thin.bounds(), (PixelRect{0, 0, 1000, 1000}));
  for (const int y : {0, 1, 500, 998}) EXPECT_LE(thin.row(y).size(), 3) << y;
}

/// A row of a triangle has at most a pixel more on either side than is covered, and none where none is.
TEST(CoverageRows, OfATriangleAreItsOwn) {
  test::Random random(12);
  const DrawState state = viewport(64);
  int rows = 0;
  for (int n = 0; n < 300; ++n) {
    SnappedQuad quad = n % 3 == 0 ? test::random_any_w(random, 60) : test::random_ordinary(random, 60);
    quad.vertex[3] = quad.vertex[2];
    const TruthQuad truth(quad, config, state);
    if (truth.cover(0, 0).eye_in_hull) continue;
    for (int y = truth.bounds().y0; y < truth.bounds().y1; ++y) {
      int covered = 0;
      for (int x = 0; x < state.width; ++x) covered += truth.cover(x, y).visible ? 1 : 0;
      if (truth.bounds().x1 - truth.bounds().x0 <= 8) continue;  // all of a narrow box is looked at
      ++rows;
      ASSERT_LE(truth.rows().row(y).size(), covered + 2) << "triangle " << n << ", row " << y;
    }
  }
  EXPECT_GT(rows, 2'000);
}

/// Pixels that are looked at for a fragment, from within a mesh and from outside.
TEST(CoverageRows, AMeshTakesNoMoreLooksFromWithin) {
  constexpr int side = 40, size = 128;
  const DrawState state = viewport(size);
  struct Work {
    double truth, paper;
  };
  const auto work_of = [&](bool inside) {
    std::uint64_t fragments = 0, truth_looks = 0, paper_looks = 0, behind = 0;
    const auto looks = [](const CoverageRows& rows) {
      // A row costs about as much as ten pixels of it.
      std::uint64_t sum = 0;
      for (int y = rows.bounds().y0; y < rows.bounds().y1; ++y)
        sum += 10 + static_cast<std::uint64_t>(rows.row(y).size());
      return sum;
    };
    for (const WindowQuad& quad :
         project_mesh(terrain_mesh(side), terrain_camera(side, inside), size, size, {AttributeSet::none}).quads) {
      const SnappedQuad snapped = snap_quad(quad, config, state);
      const TruthQuad truth(snapped, config, state);
      behind += std::ranges::any_of(quad.vertex, [](const WindowVertex& v) { return v.w <= 0; }) ? 1 : 0;
      truth_looks += looks(truth.rows());
      paper_looks += looks(PaperFp64Quad(snapped, config, state).rows());
      const PixelRect& box = truth.bounds();
      for (int y = box.y0; y < box.y1; ++y) {
        const PixelSpan row = truth.rows().row(y);
        for (int x = row.x0; x < row.x1; ++x) fragments += truth.cover(x, y).visible ? 1 : 0;
      }
    }
    EXPECT_GT(fragments, 4'000u) << inside;
    EXPECT_EQ(behind > 500, inside);
    const auto per_fragment = [&](std::uint64_t n) { return static_cast<double>(n) / static_cast<double>(fragments); };
    return Work{per_fragment(truth_looks), per_fragment(paper_looks)};
  };
  const Work within = work_of(true), outside = work_of(false);
  EXPECT_LT(within.truth, 1.5 * outside.truth);
  EXPECT_LT(within.paper, 3 * outside.paper);
}

}  // namespace
}  // namespace quadrille::golden
