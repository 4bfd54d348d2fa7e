// The scene list, what every scene shows, and what the scenes' titles claim about their shapes.
#include "golden/scenes/scenes.hpp"

#include "golden/scenes/test_support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

namespace quadrille::golden {
namespace {

enum class Shape { convex, concave, crossed };

/// Of the four projected points, by the signs of the turns.
Shape shape_of(const WindowQuad& quad) {
  std::array<double, 4> px{}, py{};
  for (std::size_t i = 0; i < 4; ++i)
    px[i] = quad.vertex[i].x / quad.vertex[i].w, py[i] = quad.vertex[i].y / quad.vertex[i].w;
  int positive = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = (i + 1) & 3, k = (i + 2) & 3;
    positive += (px[j] - px[i]) * (py[k] - py[i]) - (py[j] - py[i]) * (px[k] - px[i]) > 0 ? 1 : 0;
  }
  if (positive == 0 || positive == 4) return Shape::convex;
  return positive == 2 ? Shape::crossed : Shape::concave;
}

int behind(const WindowQuad& quad) {
  return static_cast<int>(
      std::count_if(quad.vertex.begin(), quad.vertex.end(), [](const WindowVertex& v) { return v.w < 0; }));
}

WindowQuad only_quad(const char* name) {
  const auto quads = scene_quads(make_scene(name), 512, 512);
  EXPECT_EQ(quads.size(), 1u) << name;
  return quads.at(0);
}

TEST(Scenes, ListIsCompleteAndNamesAreUnique) {
  const auto list = list_scenes();
  std::set<std::string> names;
  for (const SceneInfo& info : list) {
    EXPECT_TRUE(names.insert(info.name).second) << info.name;
    EXPECT_FALSE(info.title.empty()) << info.name;
    EXPECT_FALSE(info.paper.empty()) << info.name;
    EXPECT_EQ(scene_quads(make_scene(info.name), 512, 512).size(), info.quads) << info.name;
  }
  for (const char* name : {"fig1_flat", "fig7_floor", "fig8_behind", "fig9_a", "fig9_m", "fig10_convex",
                           "fig10_concave", "fig10_crossed", "sphere", "phong_mesh", "bowtie", "eye_in_hull",
                           "fig6_cuts", "phong_mesh_smooth", "bloomenthal1", "bloomenthal15_b", "oliveira16_affine"}) {
    EXPECT_TRUE(names.contains(name)) << name;
  }
}

TEST(Scenes, UnknownNameSuggestsTheNearest) {
  try {
    make_scene("fig10_convx");
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_NE(std::string(e.what()).find("did you mean \"fig10_convex\"?"), std::string::npos) << e.what();
  }
}

TEST(Scenes, EverySceneShowsPixels) {
  for (const SceneInfo& info : list_scenes()) {
    const auto quads = scene_quads(make_scene(info.name), 512, 512);
    if (quads.size() > 1000) continue;  // SphereScenes has what these show
    int visible = 0, samples = 0;
    for (int y = 2; y < 512; y += 5) {
      for (int x = 2; x < 512; x += 5, ++samples) {
        visible += std::any_of(quads.begin(), quads.end(),
                               [&](const WindowQuad& q) { return probe_visible(q, x + 0.5, y + 0.5); })
                       ? 1
                       : 0;
      }
    }
    // Figure 13 of Oliveira's paper is about small projections; its areas have a test of their own.
    if (info.name.starts_with("oliveira13")) continue;
    EXPECT_GT(visible, samples / 20) << info.name << " shows " << visible << " of " << samples;
  }
}

TEST(Scenes, SameQuadsEveryTime) {
  for (const SceneInfo& info : list_scenes()) {
    for (const AttributeSet set : {AttributeSet::weights, AttributeSet::uv_normal}) {
      EXPECT_EQ(hash_quads(scene_quads(make_scene(info.name), 640, 360, set)),
                hash_quads(scene_quads(make_scene(info.name), 640, 360, set)))
          << info.name;
    }
  }
}

TEST(Scenes, FlatQuadIsSeenFromAbove) {
  const WindowQuad quad = only_quad("fig1_flat");
  for (const WindowVertex& v : quad.vertex) EXPECT_EQ(v.w, quad.vertex[0].w);
  EXPECT_EQ(shape_of(quad), Shape::convex);
}

TEST(Scenes, Figure10IsOneQuadInThreeShapes) {
  EXPECT_EQ(make_scene("fig10_convex").mesh.positions, make_scene("fig10_concave").mesh.positions);
  EXPECT_EQ(make_scene("fig10_convex").mesh.positions, make_scene("fig10_crossed").mesh.positions);
  EXPECT_EQ(shape_of(only_quad("fig10_convex")), Shape::convex);
  EXPECT_EQ(shape_of(only_quad("fig10_concave")), Shape::concave);
  EXPECT_EQ(shape_of(only_quad("fig10_crossed")), Shape::crossed);
}

TEST(Scenes, ExteriorScenesAreWhatTheirTitlesSay) {
  struct Case {
    const char* name;
    Shape shape;
    int behind;
    bool hull;
  };
  const Case cases[] = {
      {"fig9_a", Shape::convex, 1, false},  {"fig9_b", Shape::concave, 1, false}, {"fig9_c", Shape::concave, 1, false},
      {"fig9_d", Shape::crossed, 1, false}, {"fig9_e", Shape::convex, 2, false},  {"fig9_f", Shape::concave, 2, false},
      {"fig9_g", Shape::crossed, 2, false}, {"fig9_h", Shape::convex, 2, true},   {"fig9_i", Shape::concave, 2, false},
      {"fig9_j", Shape::crossed, 2, false}, {"fig9_k", Shape::convex, 3, false},  {"fig9_l", Shape::concave, 3, false},
      {"fig9_m", Shape::crossed, 3, false}};
  for (const Case& c : cases) {
    const WindowQuad quad = only_quad(c.name);
    EXPECT_EQ(shape_of(quad), c.shape) << c.name;
    EXPECT_EQ(behind(quad), c.behind) << c.name;
    EXPECT_EQ(holds_eye(quad), c.hull) << c.name;
    const bool opposite = (quad.vertex[0].w < 0) == (quad.vertex[2].w < 0);
    if (c.behind == 2) {
      EXPECT_EQ(opposite, make_scene(c.name).title.find("opposite") != std::string::npos) << c.name;
    }
  }
  EXPECT_EQ(behind(only_quad("fig8_behind")), 1);
  EXPECT_TRUE(holds_eye(only_quad("eye_in_hull")));
}

TEST(Scenes, ReflexCornersOfFigure9) {
  // Corner 2 is inside the triangle of the others; fig9_b has its neighbour behind, fig9_c the corner opposite it.
  EXPECT_LT(only_quad("fig9_b").vertex[1].w, 0);
  EXPECT_LT(only_quad("fig9_c").vertex[0].w, 0);
}

TEST(Scenes, BowtieTurnsThroughAllShapes) {
  std::set<Shape> seen;
  const auto quads = scene_quads(make_scene("bowtie"), 512, 512);
  EXPECT_EQ(quads.size(), 6u);
  for (const WindowQuad& quad : quads) {
    seen.insert(shape_of(quad));
    for (const WindowVertex& v : quad.vertex) {
      EXPECT_GT(v.x / v.w, 0);
      EXPECT_LT(v.x / v.w, 512);
      EXPECT_GT(v.y / v.w, 0);
      EXPECT_LT(v.y / v.w, 512);
    }
  }
  EXPECT_TRUE(seen.contains(Shape::crossed));
  EXPECT_EQ(seen.size(), 3u);
}

TEST(Scenes, SphereHasCollapsedPoleEdgesAndUnitNormals) {
  const auto quads = scene_quads(make_scene("sphere"), 512, 512, AttributeSet::uv_normal);
  ASSERT_EQ(quads.size(), 128u);
  int collapsed = 0;
  for (const WindowQuad& quad : quads) {
    for (std::size_t i = 0; i < 4; ++i) {
      const WindowVertex &a = quad.vertex[i], &b = quad.vertex[(i + 1) & 3];
      if (a.x == b.x && a.y == b.y && a.w == b.w) {
        ++collapsed;
        EXPECT_NE(quad.attribute[i][0], quad.attribute[(i + 1) & 3][0]);
      }
      const auto& n = quad.attribute[i];
      EXPECT_NEAR(n[2] * n[2] + n[3] * n[3] + n[4] * n[4], 1, 1e-12);
    }
  }
  EXPECT_EQ(collapsed, 32);
}

TEST(Scenes, PhongMeshNormalsAreThoseOfTheSurface) {
  const Scene scene = make_scene("phong_mesh");
  EXPECT_EQ(scene.shade, "normal");
  EXPECT_GE(scene.mesh.faces.size(), 200u);
  // The facets' own normals lie close to the given ones, but are not the same.
  const auto smooth = smooth_normals(scene.mesh);
  double worst = 1;
  for (std::size_t i = 0; i < smooth.size(); ++i) {
    const Vec3& n = scene.mesh.normals[i];
    const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    worst = std::min(worst, (n[0] * smooth[i][0] + n[1] * smooth[i][1] + n[2] * smooth[i][2]) / length);
  }
  EXPECT_GT(worst, 0.6);
  EXPECT_LT(worst, 0.9999);
}

TEST(ProceduralTexture, RepeatsStaysInRangeAndShowsLines) {
  for (const TextureKind kind : {TextureKind::checker, TextureKind::fine, TextureKind::globe}) {
    for (int i = 0; i < 64; ++i) {
      const double u = i / 64.0, v = (i * 37 % 64) / 64.0;
      const Vec3 c = procedural_texture(kind, u, v);
      EXPECT_EQ(c, procedural_texture(kind, u + 3, v - 2));
      for (const double value : c) {
        EXPECT_GE(value, 0);
        EXPECT_LE(value, 1);
      }
    }
    EXPECT_LT(procedural_texture(kind, 0.5, 0.3)[0], 0.1) << texture_name(kind);  // a grid line
  }
  const auto image = procedural_image(TextureKind::checker, 16, 4);
  ASSERT_EQ(image.size(), 64u);
  EXPECT_EQ(image[1 * 16 + 3], procedural_texture(TextureKind::checker, 3.5 / 16, 2.5 / 4));
  EXPECT_EQ(procedural_image(TextureKind::globe, 33, 17), procedural_image(TextureKind::globe, 33, 17));
}

}  // namespace
}  // namespace quadrille::golden
