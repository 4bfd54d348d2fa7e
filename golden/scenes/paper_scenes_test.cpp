// What the scenes of Bloomenthal's and Oliveira's figures and of Hormann and Tarini's figures 6 and 11 claim.
#include "golden/scenes/scenes.hpp"

#include "golden/scenes/test_support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

namespace quadrille::golden {
namespace {

constexpr int size = 512;

/// The projection of a scene, every attribute but the given one left out.
Projection projected(const std::string& name, AttributeSet set = AttributeSet::none) {
  const Scene scene = make_scene(name);
  return project_mesh(scene.mesh, scene.camera, size, size, {set, false});
}

std::array<Vec2, 4> outline(const WindowQuad& quad) {
  std::array<Vec2, 4> points{};
  for (std::size_t i = 0; i < 4; ++i)
    points[i] = {quad.vertex[i].x / quad.vertex[i].w, quad.vertex[i].y / quad.vertex[i].w};
  return points;
}

/// Shoelace formula.
double area(const std::array<Vec2, 4>& p) {
  double twice = 0;
  for (std::size_t i = 0; i < 4; ++i) twice += p[i][0] * p[(i + 1) % 4][1] - p[i][1] * p[(i + 1) % 4][0];
  return std::fabs(twice) / 2;
}

double det3(const Vec3& a, const Vec3& b, const Vec3& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/// The one affine dependency Σ c_i (x_i, y_i, 1) = 0 of four points in a plane, by Cramer's rule; largest |c_i| 1.
std::array<double, 4> dependency(const std::array<Vec2, 4>& points) {
  const auto row = [&](std::size_t i) { return Vec3{points[i][0], points[i][1], 1}; };
  std::array<double, 4> c{det3(row(1), row(2), row(3)), -det3(row(0), row(2), row(3)), det3(row(0), row(1), row(3)),
                          -det3(row(0), row(1), row(2))};
  double largest = 0;
  for (const double value : c) largest = std::max(largest, std::fabs(value));
  for (double& value : c) value /= largest;
  return c;
}

/// How far the values at the corners are from an affine image of the points: 0 for one.
template <std::size_t N>
double disaffinity(const std::array<Vec2, 4>& points, const std::array<std::array<double, N>, 4>& values) {
  const std::array<double, 4> c = dependency(points);
  double worst = 0;
  for (std::size_t n = 0; n < N; ++n) {
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) sum += c[i] * values[i][n];
    worst = std::max(worst, std::fabs(sum));
  }
  return worst;
}

/// The corners without their coordinate `dropped`.
std::array<Vec2, 4> dropping(const std::array<Vec3, 4>& corners, std::size_t dropped) {
  std::array<Vec2, 4> points{};
  for (std::size_t i = 0; i < 4; ++i) points[i] = {corners[i][dropped == 0 ? 1 : 0], corners[i][dropped == 2 ? 1 : 2]};
  return points;
}

/// Six times the volume of the corners' tetrahedron.
double volume(const std::array<Vec3, 4>& corners) {
  std::array<Vec3, 3> edge{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t a = 0; a < 3; ++a) edge[i][a] = corners[i + 1][a] - corners[0][a];
  return det3(edge[0], edge[1], edge[2]);
}

/// Of the texture, for quads in the plane z = 0.
double texture_disaffinity(const std::string& name) {
  const Projection p = projected(name);
  EXPECT_EQ(p.corners.size(), 1u) << name;
  for (const Vec3& corner : p.corners[0]) EXPECT_EQ(corner[2], 0) << name;
  return disaffinity(dropping(p.corners[0], 2), p.textures[0]);
}

bool crossed(const std::array<Vec2, 4>& p) {
  const auto turn = [&](std::size_t a, std::size_t b, std::size_t c) {
    return (p[b][0] - p[a][0]) * (p[c][1] - p[a][1]) - (p[b][1] - p[a][1]) * (p[c][0] - p[a][0]) > 0;
  };
  const auto cross = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
    return turn(a, b, c) != turn(a, b, d) && turn(c, d, a) != turn(c, d, b);
  };
  return cross(0, 1, 2, 3) || cross(1, 2, 3, 0);
}

TEST(PaperScenes, EveryFigureHasOne) {
  std::set<std::string> papers;
  for (const SceneInfo& info : list_scenes()) papers.insert(info.paper);
  for (const int figure : {1, 6, 7, 8, 9, 10, 11})
    EXPECT_TRUE(papers.contains("Hormann & Tarini 2004, fig. " + std::to_string(figure))) << figure;
  for (const int figure : {1, 2, 3, 5, 6, 7, 10, 11, 12, 13, 14, 15})
    EXPECT_TRUE(papers.contains("Bloomenthal 2022, fig. " + std::to_string(figure))) << figure;
  for (const int figure : {12, 13, 14, 15, 16})
    EXPECT_TRUE(papers.contains("Oliveira, fig. " + std::to_string(figure))) << figure;
}

TEST(PaperScenes, VerticesInFrontLieInTheFrame) {
  for (const SceneInfo& info : list_scenes()) {
    const bool close_up = info.name.starts_with("bloomenthal13");
    if (info.paper.starts_with("Hormann") && info.name != "fig6_cuts") continue;
    const Projection p = projected(info.name);
    if (close_up || std::any_of(p.quads.begin(), p.quads.end(), [](const WindowQuad& quad) {
          return std::any_of(quad.vertex.begin(), quad.vertex.end(), [](const WindowVertex& v) { return v.w <= 0; });
        }))
      continue;
    for (const WindowQuad& quad : p.quads) {
      for (const Vec2& point : outline(quad)) {
        EXPECT_TRUE(point[0] > 2 && point[0] < size - 2 && point[1] > 2 && point[1] < size - 2)
            << info.name << ' ' << point[0] << ' ' << point[1];
      }
    }
  }
}

TEST(PaperScenes, ShadingsHaveWhatTheyNeed) {
  for (const SceneInfo& info : list_scenes()) {
    const Scene scene = make_scene(info.name);
    EXPECT_NO_THROW(scene_quads(scene, 64, 64, attributes_for_shade(scene.shade))) << info.name;
    EXPECT_EQ(scene.planes.has_value(), scene.shade == "planes") << info.name;
  }
}

// Hormann & Tarini

TEST(PaperScenes, CutsAreOfANonPlanarQuadAndSeveral) {
  const Scene scene = make_scene("fig6_cuts");
  const auto corners = projected("fig6_cuts").corners.at(0);
  EXPECT_GT(std::fabs(volume(corners)), 0.5);
  const CuttingPlanes planes = scene.planes.value();
  double low = INFINITY, high = -INFINITY;
  for (const Vec3& p : corners) {
    const double h = p[0] * planes.normal[0] + p[1] * planes.normal[1] + p[2] * planes.normal[2];
    low = std::min(low, h), high = std::max(high, h);
  }
  EXPECT_GE((high - low) / planes.spacing, 8);
}

TEST(PaperScenes, SmoothMeshIsThePhongMeshWithoutNormals) {
  const Scene given = make_scene("phong_mesh"), smooth = make_scene("phong_mesh_smooth");
  EXPECT_EQ(given.mesh.positions, smooth.mesh.positions);
  EXPECT_TRUE(smooth.mesh.normals.empty());
  const auto a = scene_quads(given, size, size, AttributeSet::normal);
  const auto b = scene_quads(smooth, size, size, AttributeSet::normal);
  ASSERT_EQ(a.size(), b.size());
  std::size_t different = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_EQ(a[i].vertex[k].x, b[i].vertex[k].x);
      different += a[i].attribute[k] != b[i].attribute[k] ? 1 : 0;
    }
  }
  EXPECT_GT(different, 2 * a.size());
}

// Bloomenthal

TEST(PaperScenes, SquareIsAffineAndTrapezoidIsNot) {
  EXPECT_NEAR(texture_disaffinity("bloomenthal2_square"), 0, 1e-15);
  EXPECT_NEAR(texture_disaffinity("bloomenthal2_oblique"), 0, 1e-15);
  EXPECT_GT(texture_disaffinity("bloomenthal1"), 0.1);
  EXPECT_GT(texture_disaffinity("bloomenthal3_trapezoid"), 0.1);
  EXPECT_EQ(make_scene("bloomenthal2_square").mesh.positions, make_scene("bloomenthal2_oblique").mesh.positions);
}

TEST(PaperScenes, ObliqueSquareAndTrapezoidHaveOneOutline) {
  const auto oblique = outline(projected("bloomenthal2_oblique").quads.at(0));
  const auto shape = outline(projected("bloomenthal3_trapezoid").quads.at(0));
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t a = 0; a < 2; ++a) EXPECT_NEAR(oblique[i][a], shape[i][a], 1e-9);
  EXPECT_EQ(oblique[0][1], oblique[1][1]);  // a trapezoid: two edges parallel, of different lengths
  EXPECT_NEAR(oblique[2][1], oblique[3][1], 1e-9);
  EXPECT_GT(oblique[1][0] - oblique[0][0], 1.5 * (oblique[2][0] - oblique[3][0]));
}

TEST(PaperScenes, FourthTexturePointIsIdealOrMovedEitherWay) {
  EXPECT_NEAR(texture_disaffinity("bloomenthal5_a"), 0, 1e-12);
  EXPECT_GT(texture_disaffinity("bloomenthal5_b"), 0.05);
  EXPECT_GT(texture_disaffinity("bloomenthal5_c"), 0.05);
  const auto a = projected("bloomenthal5_a").textures.at(0), b = projected("bloomenthal5_b").textures.at(0),
             c = projected("bloomenthal5_c").textures.at(0);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(a[i] == b[i] && a[i] == c[i]);
  for (std::size_t n = 0; n < 2; ++n) EXPECT_NEAR(b[3][n] - a[3][n], a[3][n] - c[3][n], 1e-12);
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

TEST(PaperScenes, CollapsedUpperEdgeKeepsItsTexture) {
  const Projection p = projected("bloomenthal7_degenerate");
  EXPECT_EQ(p.corners.at(0)[2], p.corners[0][3]);
  EXPECT_NE(p.textures.at(0)[2], p.textures[0][3]);
}

TEST(PaperScenes, ColoursAreAffineInTheThirdOnly) {
  const auto colours = [](const std::string& name) {
    const Projection p = projected(name, AttributeSet::colour);
    std::array<Vec3, 4> values{};
    for (std::size_t i = 0; i < 4; ++i) std::copy_n(p.quads.at(0).attribute[i].begin(), 3, values[i].begin());
    return std::pair(dropping(p.corners[0], 2), values);
  };
  const auto [a, colours_a] = colours("bloomenthal10_a");
  const auto [b, colours_b] = colours("bloomenthal10_b");
  const auto [c, colours_c] = colours("bloomenthal10_c");
  EXPECT_EQ(disaffinity(a, colours_a), 1);  // (0, 0, 1) − (1, 0, 0) + (0, 1, 0) − (0, 0, 0)
  EXPECT_EQ(disaffinity(b, colours_b), 1);
  EXPECT_EQ(disaffinity(c, colours_c), 0);  // blue + yellow = red + cyan
  EXPECT_EQ(colours_a, (std::array<Vec3, 4>{{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}}}));
  EXPECT_EQ(colours_c, (std::array<Vec3, 4>{{{0, 0, 1}, {1, 0, 0}, {1, 1, 0}, {0, 1, 1}}}));
  for (std::size_t i = 0; i < 4; ++i) {  // one picture, corners listed from the next
    EXPECT_EQ(b[i], a[(i + 1) % 4]);
    EXPECT_EQ(colours_b[i], colours_a[(i + 1) % 4]);
  }
}

TEST(PaperScenes, NormalsOfAFlatQuadDifferMuch) {
  const Projection p = projected("bloomenthal11_normals", AttributeSet::normal);
  EXPECT_EQ(volume(p.corners.at(0)), 0);
  std::array<Vec3, 4> n{};
  for (std::size_t i = 0; i < 4; ++i) std::copy_n(p.quads[0].attribute[i].begin(), 3, n[i].begin());
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 &m = n[i], &next = n[(i + 1) % 4];
    EXPECT_LT(m[0] * next[0] + m[1] * next[1] + m[2] * next[2], 0.7) << i;  // more than 45 degrees
    EXPECT_GT(m[2], 0);
  }
  EXPECT_GT(disaffinity(dropping(p.corners[0], 2), n), 0.5);
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

// Oliveira

TEST(PaperScenes, PolygonAndPatchAreArbitraryConvexQuadrilaterals) {
  const Projection p = projected("oliveira12");
  for (const std::array<Vec2, 4>& shape : {dropping(p.corners.at(0), 2), p.textures.at(0)}) {
    const std::array<double, 4> c = dependency(shape);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_LT(c[i] * c[(i + 1) % 4], 0);  // convex: signs take turns
    EXPECT_LT(*std::min_element(c.begin(), c.end(), [](double a, double b) { return std::fabs(a) < std::fabs(b); }),
              0.9);  // a parallelogram has ±1 only
  }
  EXPECT_GT(texture_disaffinity("oliveira12"), 0.05);
  for (const WindowVertex& v : p.quads[0].vertex) EXPECT_EQ(v.w, p.quads[0].vertex[0].w);  // parallel to the image
}

TEST(PaperScenes, TrapezoidsCoverThePixelsOfTheirNames) {
  const std::array<Vec3, 4> shape = projected("oliveira13_33600").corners.at(0);
  for (const double pixels : {33600, 11879, 3051, 795, 197}) {
    const Projection p = projected("oliveira13_" + std::to_string(static_cast<int>(pixels)));
    EXPECT_NEAR(area(outline(p.quads.at(0))), pixels, 0.005 * pixels);
    EXPECT_EQ(p.corners[0], shape);
    EXPECT_EQ(p.textures[0], projected("oliveira12").textures[0]);
  }
  EXPECT_EQ(shape[0][1], shape[1][1]);
  EXPECT_EQ(shape[2][1], shape[3][1]);
  EXPECT_NE(shape[1][0] - shape[0][0], shape[2][0] - shape[3][0]);
}

TEST(PaperScenes, DraggedVertexStaysInThePlane) {
  const auto corners = [](const char* name) { return projected(name).corners.at(0); };
  const auto a = corners("oliveira14_a"), b = corners("oliveira14_b"), c = corners("oliveira14_c");
  EXPECT_EQ(disaffinity(dropping(a, 1), projected("oliveira14_a").textures[0]), 0);
  for (const auto& moved : {b, c}) {
    EXPECT_EQ(volume(moved), 0);
    for (const std::size_t i : {0u, 2u, 3u}) EXPECT_EQ(moved[i], a[i]);
    EXPECT_GT(disaffinity(dropping(moved, 1), projected("oliveira14_a").textures[0]), 0.05);
    EXPECT_LT(moved[1][0], a[1][0]);
    const std::array<double, 4> d = dependency(dropping(moved, 1));
    for (std::size_t i = 0; i < 4; ++i) EXPECT_LT(d[i] * d[(i + 1) % 4], 0);  // convex
  }
  const auto distance = [](const std::array<Vec3, 4>& q, std::size_t i) {
    return std::hypot(q[1][0] - q[i][0], q[1][1] - q[i][1], q[1][2] - q[i][2]);
  };
  for (const std::size_t i : {0u, 2u, 3u}) EXPECT_LT(distance(c, i), distance(a, i)) << i;
  EXPECT_GT(b[1][2], a[1][2]);  // towards the viewer
}

TEST(PaperScenes, NonPlanarAndAffineQuads) {
  const std::array<Vec3, 4> skew = projected("oliveira15_nonplanar").corners.at(0);
  EXPECT_GT(std::fabs(volume(skew)), 1);
  // The criterion of the paper's figure 11 sees it: V1 · V2 differs from V3 · V4.
  const auto product = [&](std::size_t at, std::size_t a, std::size_t b) {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) sum += (skew[a][i] - skew[at][i]) * (skew[b][i] - skew[at][i]);
    return sum;
  };
  EXPECT_GT(std::fabs(product(1, 0, 2) - product(3, 2, 0)), 0.1);
  EXPECT_NEAR(texture_disaffinity("oliveira16_affine"), 0, 1e-15);
  EXPECT_EQ(projected("oliveira16_affine").corners, projected("oliveira13_197").corners);  // the trapezoid of figure 4
}

}  // namespace
}  // namespace quadrille::golden
