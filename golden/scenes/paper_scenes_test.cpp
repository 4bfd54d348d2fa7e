// What the scenes of Bloomenthal's and Oliveira's figures and of Hormann and Tarini's figures 6 and 11 claim.
#include "golden/scenes/paper_scenes_test_support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace quadrille::golden {
namespace {

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

/// Of the texture, for quads in the plane z = 0.
double texture_disaffinity(const std::string& name) {
  const Projection p = projected(name);
  EXPECT_EQ(p.corners.size(), 1u) << name;
  for (const Vec3& corner : p.corners[0]) EXPECT_EQ(corner[2], 0) << name;
  return disaffinity(dropping(p.corners[0], 2), p.textures[0]);
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
