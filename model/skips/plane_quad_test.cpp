// Quads whose values are plane (skip_plane): which quads are taken; what is drawn of them, against the truth, and by
// both engines of the model; and that a neighbour with mean value weights agrees along the edge.
#include "model/skips/plane_quad.hpp"
#include "golden/reference/truth.hpp"
#include "model/front/quad_setup.hpp"
#include "model/port/snap.hpp"
#include "model/support/prng.hpp"
#include "model/untimed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace quadrille {
namespace {

using golden::Prng;

constexpr int size = 64;

Config machine(int significand_bits) {
  Config c;
  c.set("viewport_bits", 8);
  c.set("significand_bits", significand_bits);
  c.set("plane_quads", 1);
  c.validate();
  return c;
}

DrawState draw_state(bool perspective) {
  DrawState s;
  s.width = s.height = s.scissor_x1 = s.scissor_y1 = size;
  s.attributes = 2;
  s.perspective = perspective;
  s.skip = skip_default | skip_plane;
  return s;
}

/// A rectangle, its second corner below the first; u grows along x and v along y, depth along y.
WindowQuad sprite(std::uint32_t id, double x, double y, double w, double h, double u = 0.75, double v = 0.625) {
  WindowQuad q;
  q.id = id;
  q.vertex = {{{x, y, 0.25, 1}, {x, y + h, 0.5, 1}, {x + w, y + h, 0.5, 1}, {x + w, y, 0.25, 1}}};
  q.attribute = {{{0.125, 0.0625}, {0.125, v}, {u, v}, {u, 0.0625}}};
  return q;
}

std::vector<Fragment> draw(const Config& c, const DrawState& s, const SnappedQuad& quad,
                           PixelEngine engine = PixelEngine::plain) {
  UntimedModel model(c, s, engine);
  std::vector<Fragment> all;
  model.draw(quad, [&](std::span<const Fragment> f) { all.insert(all.end(), f.begin(), f.end()); });
  return all;
}

TEST(PlaneQuad, IsTakenWhereEveryValueInUseIsConstantAlongSides) {
  const Config c = machine(18);
  const DrawState s = draw_state(true);
  const auto taken = [&](const WindowQuad& q, const DrawState& state) {
    return plane_quad(snap_quad(q, c, state), c, state);
  };
  const WindowQuad good = sprite(1, 3.25, 4.5, 20, 30);
  EXPECT_TRUE(taken(good, s));
  WindowQuad sheared = good;  // a parallelogram is as good
  sheared.vertex[1].x += 7;
  sheared.vertex[2].x += 7;
  EXPECT_TRUE(taken(sheared, s));

  // Each with one thing that is not plane.
  for (std::size_t i = 0; i < 4; ++i) {
    WindowQuad q = good;
    q.vertex[i].x += 1.0 / 256;
    EXPECT_FALSE(taken(q, s)) << "x of " << i;
    q = good;
    q.vertex[i].y -= 1.0 / 256;
    EXPECT_FALSE(taken(q, s)) << "y of " << i;
    q = good;
    q.vertex[i].z += 1.0 / 1024;
    EXPECT_FALSE(taken(q, s)) << "z of " << i;
    DrawState other = s;
    other.depth = false;
    EXPECT_TRUE(taken(q, other)) << "z of " << i << " is not in use";
    for (std::size_t j = 0; j < 2; ++j) {
      q = good;
      q.attribute[i][j] += 1.0 / 1024;
      EXPECT_FALSE(taken(q, s)) << "attribute " << j << " of " << i;
    }
    other = s;
    other.attributes = 1;
    EXPECT_TRUE(taken(q, other)) << "attribute 1 of " << i << " is not in use";
    q = good;  // the same place, another k, and the same depth and attributes over it
    WindowVertex& v = q.vertex[i];
    v = {v.x * 2, v.y * 2, v.z * 2, 2};
    EXPECT_FALSE(taken(q, s)) << "k of " << i;
    q = good;
    q.vertex[i].w = -1;
    EXPECT_FALSE(taken(q, s)) << "w of " << i;
  }
  DrawState off = s;
  off.skip &= ~std::uint32_t{skip_plane};
  EXPECT_FALSE(taken(good, off));
  Config without = c;
  without.set("plane_quads", 0);
  EXPECT_FALSE(plane_quad(snap_quad(good, without, s), without, s));
}

/// Parallelograms at random, both windings, with k, depth and attributes that each are constant along one pair of
/// sides.
WindowQuad random_parallelogram(Prng& rng, std::uint32_t id) {
  const auto grid = [&](double from, double to) { return std::round(rng.uniform(from, to) * 256) / 256; };
  WindowQuad q;
  q.id = id;
  const double x = grid(10, 50), y = grid(10, 50), ax = grid(-25, 25), ay = grid(-25, 25), bx = grid(-25, 25),
               by = grid(-25, 25);
  const double px[4] = {x, x + ax, x + ax + bx, x + bx}, py[4] = {y, y + ay, y + ay + by, y + by};
  const auto pairs = [&](double from, double to) {
    const double a = rng.uniform(from, to), b = rng.uniform(from, to);
    return rng.chance(0.5) ? std::array{a, a, b, b} : std::array{a, b, b, a};
  };
  const bool level = rng.chance(0.5);
  const auto w = level ? std::array{1.0, 1.0, 1.0, 1.0} : std::array{2.0, 2.0, 2.0, 2.0};
  const auto z = pairs(0.05, 0.95), u = pairs(-4, 4), v = pairs(-4, 4);
  for (std::size_t i = 0; i < 4; ++i) {
    q.vertex[i] = {px[i] * w[i], py[i] * w[i], z[i] * w[i], w[i]};
    q.attribute[i] = {u[i], v[i]};
  }
  return q;
}

/// Pixels, facing and flags of the other way; attributes and depth within the machine's bound of the truth.
TEST(PlaneQuad, IsDrawnWithinTheBound) {
  for (const int bits : {12, 18, 26})
    for (const bool perspective : {false, true}) {
      const Config c = machine(bits);
      const DrawState s = draw_state(perspective);
      DrawState without = s;
      without.skip &= ~std::uint32_t{skip_plane};
      Prng rng(static_cast<std::uint64_t>(bits));
      std::uint64_t pixels = 0, taken = 0, corners = 0;
      double worst = 0, worst_z = 0;
      for (std::uint32_t id = 0; id < 300; ++id) {
        const WindowQuad given = id % 5 == 0
                                     ? sprite(id, 5.5 + id % 7, 6.5, 1 + id % 40, 1 + id % 31)  // corners at centres
                                     : random_parallelogram(rng, id);
        const SnappedQuad quad = snap_quad(given, c, s);
        taken += plane_quad(quad, c, s);
        const std::vector<Fragment> on = draw(c, s, quad), off = draw(c, without, quad);
        EXPECT_EQ(on, draw(c, s, quad, PixelEngine::lanes)) << "quad " << id;
        ASSERT_EQ(on.size(), off.size()) << "quad " << id;
        const golden::TruthQuad truth(quad, c, s);
        for (std::size_t i = 0; i < on.size(); ++i) {
          const Fragment &f = on[i], &g = off[i];
          ASSERT_TRUE(f.x == g.x && f.y == g.y && f.front == g.front && f.flags == g.flags)
              << "quad " << id << " pixel " << f.x << ", " << f.y;
          const golden::ReferenceSample exact = truth.sample(f.x, f.y);
          for (std::size_t j = 0; j < 2; ++j) {
            const double range = std::max({std::fabs(given.attribute[0][j]), std::fabs(given.attribute[1][j]),
                                           std::fabs(given.attribute[2][j]), std::fabs(given.attribute[3][j])});
            const double error =
                std::fabs(std::ldexp(static_cast<double>(f.attribute[j]), -c.attribute_frac()) - exact.attribute[j]);
            worst = std::max(worst, (error - std::ldexp(1, -c.attribute_frac())) / range);
          }
          worst_z =
              std::max(worst_z, std::fabs(std::ldexp(f.depth, -c.depth_bits) - exact.z) - std::ldexp(1, -c.depth_bits));
          corners += (f.flags & flag_on_vertex) != 0;
        }
        pixels += on.size();
      }
      // The bound of a weight, 2^-(S-3), on the range of a value.
      const double unit = std::ldexp(1, -bits);
      EXPECT_EQ(taken, 300u);
      EXPECT_GT(pixels, 20'000u);
      EXPECT_GT(corners, 0u);
      EXPECT_LE(worst, 8 * unit);
      EXPECT_LE(worst_z, 8 * unit);
    }
}

/// Two rectangles side by side, one of which has an attribute that is not plane: along the edge that they share, whose
/// pixel centres one of the two has, both give the interpolation between its ends.
TEST(PlaneQuad, AgreesWithItsNeighbourAlongTheEdge) {
  const Config c = machine(18);
  const DrawState s = draw_state(true);
  for (const bool swapped : {false, true}) {
    WindowQuad left = sprite(0, 4.5, 6.5, 16, 40), right = sprite(1, 20.5, 6.5, 16, 40);
    // Along x = 20.5 the same values from both sides.
    for (std::size_t j = 0; j < 2; ++j) {
      right.attribute[0][j] = left.attribute[3][j];
      right.attribute[1][j] = left.attribute[2][j];
    }
    (swapped ? left.attribute[0] : right.attribute[3])[1] = -2.5;
    if (swapped) right.attribute[2][0] = right.attribute[3][0] = 1.5;
    const SnappedQuad quads[2] = {snap_quad(left, c, s), snap_quad(right, c, s)};
    EXPECT_NE(plane_quad(quads[0], c, s), plane_quad(quads[1], c, s));
    int on_edge = 0;
    for (const SnappedQuad& quad : quads)
      for (const Fragment& f : draw(c, s, quad)) {
        if (f.x != 20) continue;
        ++on_edge;
        const double t = (f.y - 6) / 40.0;
        for (std::size_t j = 0; j < 2; ++j) {
          const double exact = (1 - t) * left.attribute[3][j] + t * left.attribute[2][j];
          EXPECT_NEAR(std::ldexp(static_cast<double>(f.attribute[j]), -c.attribute_frac()), exact,
                      std::ldexp(1, -15) + std::ldexp(1, -c.attribute_frac()));
        }
      }
    EXPECT_EQ(on_edge, 40);
  }
}

}  // namespace
}  // namespace quadrille
