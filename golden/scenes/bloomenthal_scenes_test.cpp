#include "golden/scenes/paper_scenes_test_support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <tuple>

namespace quadrille::golden {
namespace {

bool crossed(const std::array<Vec2, 4>& p) {
  const auto turn = [&](std::size_t a, std::size_t b, std::size_t c) {
    return (p[b][0] - p[a][0]) * (p[c][1] - p[a][1]) - (p[b][1] - p[a][1]) * (p[c][0] - p[a][0]) > 0;
  };
  const auto cross = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
    return turn(a, b, c) != turn(a, b, d) && turn(c, d, a) != turn(c, d, b);
  };
  return cross(0, 1, 2, 3) || cross(1, 2, 3, 0);
}

TEST(PaperScenes, GoreBecomesTrapezoidalTowardsThePole) {
  const Projection p = projected("bloomenthal6_sphere_octant");
  ASSERT_EQ(p.quads.size(), 6u);
  double ratio = 1;
  for (std::size_t j = 0; j < 6; ++j) {
    const auto& q = p.corners[j];
    const auto length = [](const Vec3& a, const Vec3& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); };
    const double next = length(q[2], q[3]) / length(q[0], q[1]);
    EXPECT_LT(next, ratio) << j;
    ratio = next;
    for (const Vec3& corner : q) EXPECT_NEAR(std::hypot(corner[0], corner[1], corner[2]), 1, 1e-15);
    const auto& t = p.textures[j];
    for (std::size_t k = 0; k < 4; ++k)  // the texture is regular in latitude
      EXPECT_NEAR(std::asin(q[k][1]), t[k][1] * 3.14159265358979323846 / 2, 1e-7) << j;
    EXPECT_NEAR(area(t), 1.0 / 6, 1e-15);
    EXPECT_EQ(t[1][0] - t[0][0], t[2][0] - t[3][0]);
    if (j > 0) {
      EXPECT_EQ(q[0], p.corners[j - 1][3]);
      EXPECT_EQ(t[0], p.textures[j - 1][3]);
    }
  }
  EXPECT_EQ(ratio, 0);  // the last one's upper edge is the pole
}

TEST(PaperScenes, SpheresHaveTheQuadsOfTheirTitles) {
  for (const auto& [name, around, bands, repeat_u, repeat_v] : {std::tuple{"bloomenthal12_600", 30, 20, 1, 1},
                                                                {"bloomenthal12_4000", 100, 40, 1, 1},
                                                                {"bloomenthal13_uniform", 100, 40, 2, 4},
                                                                {"bloomenthal13_dense", 100, 40, 2, 4}}) {
    const Projection p = projected(name);
    EXPECT_EQ(p.quads.size(), static_cast<std::size_t>(around * bands)) << name;
    std::set<double> us, vs;
    double total = 0;
    for (std::size_t i = 0; i < p.quads.size(); ++i) {
      total += area(p.textures[i]);
      for (std::size_t k = 0; k < 4; ++k) {
        const Vec3& corner = p.corners[i][k];
        us.insert(p.textures[i][k][0]), vs.insert(p.textures[i][k][1]);
        EXPECT_NEAR(std::hypot(corner[0], corner[1], corner[2]), 1, 1e-15) << name;
        EXPECT_NEAR(std::asin(corner[1]), (p.textures[i][k][1] / repeat_v - 0.5) * 3.14159265358979323846, 1e-7)
            << name;
      }
    }
    EXPECT_EQ(us.size(), static_cast<std::size_t>(around) + 1) << name;
    EXPECT_EQ(vs.size(), static_cast<std::size_t>(bands) + 1) << name;
    EXPECT_NEAR(total, repeat_u * repeat_v, 1e-12) << name;  // every point of the texture is used as often
  }
}

TEST(PaperScenes, BandsAreDenserAtThePoleInOneCloseUp) {
  const auto bands = [](const char* name) {
    std::set<double> v;
    for (const Vec2& t : make_scene(name).mesh.texcoords) v.insert(t[1] / 4);
    return std::vector<double>(v.begin(), v.end());
  };
  const auto uniform = bands("bloomenthal13_uniform"), dense = bands("bloomenthal13_dense");
  ASSERT_EQ(uniform.size(), 41u);
  ASSERT_EQ(dense.size(), 41u);
  const auto in_cap = [](const std::vector<double>& v) {
    return std::count_if(v.begin(), v.end(), [](double x) { return x > 1 - 10.0 / 180; });
  };
  EXPECT_EQ(in_cap(uniform), 3);  // 90, 85.5, 81 degrees
  EXPECT_GT(in_cap(dense), 5);
  for (std::size_t j = 1; j < 41; ++j) EXPECT_NEAR(uniform[j] - uniform[j - 1], 1.0 / 40, 1e-15);
  for (std::size_t j = 22; j < 41; ++j) EXPECT_LT(dense[j] - dense[j - 1], dense[j - 1] - dense[j - 2]) << j;
  EXPECT_EQ(make_scene("bloomenthal13_uniform").camera.eye, make_scene("bloomenthal13_dense").camera.eye);
}

/// Whether a point of the screen has an inverse bilinear answer with respect to the projected corners: (1 − s)(1 − t) a
/// + s (1 − t) b + s t c + (1 − s) t d = p is a quadratic equation in t.
bool inverse_bilinear_exists(const std::array<Vec2, 4>& v, double x, double y) {
  const auto cross = [](const Vec2& p, const Vec2& q) { return p[0] * q[1] - p[1] * q[0]; };
  const auto minus = [](const Vec2& p, const Vec2& q) { return Vec2{p[0] - q[0], p[1] - q[1]}; };
  const Vec2 e = minus(v[1], v[0]), f = minus(v[3], v[0]), h = minus({x, y}, v[0]);
  const Vec2 g = minus(minus(v[2], v[3]), e);
  const double k2 = cross(g, f), k1 = cross(e, f) + cross(h, g), k0 = cross(h, e);
  return k1 * k1 - 4 * k0 * k2 >= 0;
}

TEST(PaperScenes, InverseBilinearFailsOnMoreAndMoreAsTheQuadMovesToTheRear) {
  int failing_before = 0, behind_before = 1;
  double hindmost_before = 0;
  for (const char* name : {"bloomenthal14_a", "bloomenthal14_b", "bloomenthal14_c"}) {
    const Projection p = projected(name);
    const WindowQuad& quad = p.quads.at(0);
    EXPECT_EQ(volume(p.corners[0]), 0) << name;
    int behind = 0;
    double hindmost = 0;
    for (const WindowVertex& v : quad.vertex) {
      behind += v.w < 0 ? 1 : 0;
      hindmost = std::min(hindmost, v.w);
    }
    EXPECT_GE(behind, behind_before) << name;
    EXPECT_LT(hindmost, hindmost_before) << name;
    int failing = 0, visible = 0;
    const auto corners = outline(quad);
    for (int y = 4; y < size; y += 8) {
      for (int x = 4; x < size; x += 8) {
        if (!probe_visible(quad, x + 0.5, y + 0.5)) continue;
        ++visible;
        failing += inverse_bilinear_exists(corners, x + 0.5, y + 0.5) ? 0 : 1;
      }
    }
    EXPECT_GT(visible, 64 * 64 * 4 / 10) << name;
    EXPECT_GT(failing, failing_before + visible / 10) << name;
    EXPECT_LT(failing, visible) << name;
    failing_before = failing, behind_before = behind, hindmost_before = hindmost;
  }
}

TEST(PaperScenes, BowTieIsOneQuadCrossedInBothOrientations) {
  EXPECT_EQ(make_scene("bloomenthal15_a").mesh.positions, make_scene("bloomenthal15_b").mesh.positions);
  for (const char* name : {"bloomenthal15_a", "bloomenthal15_b"})
    EXPECT_TRUE(crossed(outline(projected(name).quads.at(0)))) << name;
}

}  // namespace
}  // namespace quadrille::golden
