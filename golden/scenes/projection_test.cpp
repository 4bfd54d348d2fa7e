// Projection of points whose window position was worked out by hand, framing, decomposition of faces, attribute
// layouts.
#include "golden/scenes/projection.hpp"

#include "model/support/prng.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace quadrille::golden {
namespace {

Mesh polygon(int corners) {
  Mesh mesh;
  Face face;
  for (int i = 0; i < corners; ++i) {
    mesh.positions.push_back({static_cast<double>(i), static_cast<double>(i * i), 0});
    face.push_back({i, -1, -1});
  }
  mesh.faces.push_back(face);
  return mesh;
}

Camera identity_camera() {
  Camera camera;
  camera.matrix = Matrix4{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  return camera;
}

TEST(Projection, MatrixByHand) {
  // clip = (3, 0.5, 1, 2): x̃ = (3 + 2)/2 · 100, ỹ = (2 − 0.5)/2 · 40, z̃ = (1 + 2)/2.
  const Matrix4 m{1, 0, 0, 2, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 2, 0};
  const WindowVertex v = project_point(m, {1, 0.5, 1}, 100, 40);
  EXPECT_EQ(v.x, 250);
  EXPECT_EQ(v.y, 30);
  EXPECT_EQ(v.z, 1.5);
  EXPECT_EQ(v.w, 2);
}

TEST(Projection, LookAtByHand) {
  // Eye 4 above the plane z = 1, field of view 90 degrees: the frustum is 8 units high there; 200 × 100 pixels.
  Camera camera;
  camera.eye = {0, 0, 5};
  camera.target = {0, 0, 0};
  camera.fovy = 90;
  camera.near = 1;
  camera.far = 9;
  const Matrix4 m = camera_matrix(camera, 200, 100);
  const auto window = [&](const Vec3& p) {
    const WindowVertex v = project_point(m, p, 200, 100);
    return Vec3{v.x / v.w, v.y / v.w, v.z / v.w};
  };
  EXPECT_NEAR(project_point(m, {0, 0, 1}, 200, 100).w, 4, 1e-12);
  EXPECT_NEAR(window({0, 0, 1})[0], 100, 1e-9);
  EXPECT_NEAR(window({0, 0, 1})[1], 50, 1e-9);
  EXPECT_NEAR(window({8, 0, 1})[0], 200, 1e-9);  // right edge: aspect 2
  EXPECT_NEAR(window({0, 4, 1})[1], 0, 1e-9);    // up is up: row 0
  EXPECT_NEAR(window({0, -4, 1})[1], 100, 1e-9);
  EXPECT_NEAR(window({0, 0, 4})[2], 0, 1e-12);   // near plane
  EXPECT_NEAR(window({0, 0, -4})[2], 1, 1e-12);  // far plane
  EXPECT_LT(project_point(m, {0, 0, 6}, 200, 100).w, 0);
}

TEST(Projection, CounterClockwiseTowardsTheEyeIsFront) {
  Mesh mesh;
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  mesh.faces = {{{0, -1, -1}, {1, -1, -1}, {2, -1, -1}, {3, -1, -1}}};
  Camera camera;
  camera.eye = {0, 0, 3};
  const WindowQuad quad = project_mesh(mesh, camera, 64, 64).quads.at(0);
  double area = 0;  // y down: counter-clockwise on the screen is negative
  for (std::size_t i = 0; i < 4; ++i) {
    const WindowVertex &a = quad.vertex[i], &b = quad.vertex[(i + 1) & 3];
    area += (a.x / a.w) * (b.y / b.w) - (a.y / a.w) * (b.x / b.w);
  }
  EXPECT_LT(area, 0);
}

TEST(Projection, AutomaticFramingHoldsEveryVertex) {
  Prng rng(7);
  for (int n = 0; n < 200; ++n) {
    Mesh mesh = polygon(4);
    for (Vec3& p : mesh.positions) {
      for (double& c : p) c = rng.uniform(-1, 1) * std::ldexp(1.0, n % 40 - 20) + (n % 3 == 0 ? 50.0 : 0.0);
    }
    const int width = n % 2 == 0 ? 512 : 200, height = n % 5 == 0 ? 1000 : 300;
    const auto quads = project_mesh(mesh, frame_mesh(mesh, width, height), width, height).quads;
    for (const WindowVertex& v : quads.at(0).vertex) {
      ASSERT_GT(v.w, 0);
      ASSERT_GE(v.x / v.w, 0);
      ASSERT_LE(v.x / v.w, width);
      ASSERT_GE(v.y / v.w, 0);
      ASSERT_LE(v.y / v.w, height);
      ASSERT_GE(v.z / v.w, 0);
      ASSERT_LE(v.z / v.w, 1);
    }
  }
}

TEST(Projection, FramingLooksAlongTheStatedDirection) {
  const Mesh mesh = polygon(4);
  const Camera camera = frame_mesh(mesh, 100, 100);
  const Vec3 d{camera.eye[0] - camera.target[0], camera.eye[1] - camera.target[1], camera.eye[2] - camera.target[2]};
  EXPECT_NEAR(d[0] / d[2], 0.5, 1e-12);
  EXPECT_NEAR(d[1] / d[2], 0.4, 1e-12);
  EXPECT_EQ(camera.fovy, 35);
}

TEST(Projection, SidesOfEveryUp) {
  const auto expect = [](const Vec3& up, const Vec3& right, const Vec3& front) {
    const Sides sides = sides_of(up);
    EXPECT_EQ(sides.right, right);
    EXPECT_EQ(sides.front, front);
  };
  expect({0, 1, 0}, {1, 0, 0}, {0, 0, 1});
  expect({0, -2, 0}, {-1, 0, 0}, {0, 0, 1});
  expect({0, 0, 3}, {1, 0, 0}, {0, -1, 0});
  expect({0, 0, -1}, {-1, 0, 0}, {0, -1, 0});
  expect({1, 0, 0}, {0, -1, 0}, {0, 0, 1});
  const Sides leaning = sides_of({0.2, 0.9, 0.7});
  for (const auto& [a, b] :
       {std::pair{leaning.right, leaning.up}, {leaning.up, leaning.front}, {leaning.front, leaning.right}})
    EXPECT_NEAR(a[0] * b[0] + a[1] * b[1] + a[2] * b[2], 0, 1e-15);
  EXPECT_GT(leaning.front[2], 0);
  EXPECT_THROW(sides_of({0, 0, 0}), std::invalid_argument);
  EXPECT_THROW(frame_mesh(polygon(4), 8, 8, {{0, 1, 0}, Vec3{0, 0, 0}}), std::invalid_argument);
}

/// Where a point of the mesh's space lies in a picture of 100 x 100 pixels.
Vec2 pixel_of(const Camera& camera, const Vec3& point) {
  const WindowVertex v = project_point(camera_matrix(camera, 100, 100), point, 100, 100);
  return {v.x / v.w, v.y / v.w};
}

TEST(Projection, UpPointsUpInThePicture) {
  Mesh mesh = polygon(4);
  for (Vec3& p : mesh.positions) p = {p[0] - 1.5, p[1] - 4.5, p[2]};  // centred
  for (const Vec3& up : {Vec3{0, 1, 0}, Vec3{0, 0, 1}, Vec3{1, 0, 0}, Vec3{0, 0, -1}}) {
    const Sides sides = sides_of(up);
    const Camera camera = frame_mesh(mesh, 100, 100, {up, {}});
    EXPECT_NEAR(pixel_of(camera, sides.up)[0], 50, 1e-9);
    EXPECT_LT(pixel_of(camera, sides.up)[1], 49);
    EXPECT_GT(pixel_of(camera, sides.right)[0], 51);
    EXPECT_GT(pixel_of(camera, sides.front)[1], 51) << "seen from above";
  }
  // Straight from above the front is at the bottom edge, straight from below at the top edge.
  for (const double above : {1.0, -1.0}) {
    const Camera camera = frame_mesh(mesh, 100, 100, {{0, 0, 1}, Vec3{0, 0, above}});
    EXPECT_NEAR(pixel_of(camera, {0, -1, 0})[0], 50, 1e-9);
    EXPECT_GT((pixel_of(camera, {0, -1, 0})[1] - 50) * above, 1);
    EXPECT_GT(pixel_of(camera, {1, 0, 0})[0], 51);
  }
}

TEST(Projection, DirectionToEyeOfEveryKindOfCamera) {
  Camera camera;
  camera.eye = {3, -1, 2}, camera.target = {1, 1, 1};
  const Vec3 direction = direction_to_eye(camera);
  EXPECT_EQ(direction, (Vec3{2.0 / 3, -2.0 / 3, 1.0 / 3}));
  Camera matrix;
  matrix.matrix = camera_matrix(camera, 64, 48);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(direction_to_eye(matrix)[i], direction[i], 1e-15);
  // Without perspective depth alone says where the eye is: NDC z grows away from it.
  matrix.matrix = Matrix4{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1};
  EXPECT_EQ(direction_to_eye(matrix), (Vec3{0, 0, 1}));
  matrix.matrix = Matrix4{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  EXPECT_EQ(direction_to_eye(matrix), (Vec3{0, 0, -1}));
}

TEST(Projection, FramingOfNothingAndOfOnePointIsUsable) {
  const Mesh empty;
  EXPECT_TRUE(project_mesh(empty, frame_mesh(empty, 64, 64), 64, 64).quads.empty());
  Mesh point = polygon(4);
  for (Vec3& p : point.positions) p = {3, 4, 5};
  const auto quads = project_mesh(point, frame_mesh(point, 64, 64), 64, 64).quads;
  EXPECT_NEAR(quads.at(0).vertex[0].x / quads[0].vertex[0].w, 32, 1e-6);
}

TEST(Projection, AFaceThatCrossesItselfIsAFan) {
  Mesh mesh = polygon(4);
  mesh.positions = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, -1, 0}, {0, 4, 0}};
  mesh.faces.push_back({{0}, {1}, {2}, {3}, {4}});
  const Projection projection = project_mesh(mesh, identity_camera(), 2, 2);
  EXPECT_EQ(projection.crossed_faces, 1u);
  EXPECT_EQ(projection.fan_primitives, 2u);
  EXPECT_EQ(projection.quads.size(), 3u);
}

/// Twice the area of what a mesh in a plane of constant z is drawn as, fragments that overlap counted twice.
double drawn_area(const Mesh& mesh) {
  double sum = 0;
  for (const WindowQuad& quad : project_mesh(mesh, identity_camera(), 2, 2).quads) {
    double area = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const WindowVertex &a = quad.vertex[i], &b = quad.vertex[(i + 1) % 4];
      area += a.x * b.y - a.y * b.x;
    }
    sum += std::fabs(area);
  }
  return sum;
}

TEST(Projection, AConcaveFacePaintsTheSameFromEveryFirstCorner) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}};
  mesh.faces.push_back({{0}, {1}, {2}, {3}, {4}, {5}});
  for (int first = 0; first < 6; ++first) {
    EXPECT_EQ(drawn_area(mesh), 10) << first;  // an L of 5 squares
    EXPECT_EQ(project_mesh(mesh, identity_camera(), 2, 2).fan_primitives, 2u);
    std::rotate(mesh.faces[0].begin(), mesh.faces[0].begin() + 1, mesh.faces[0].end());
  }
}

TEST(Projection, FacesBecomeQuadsThenATriangle) {
  struct Case {
    int corners;
    std::size_t primitives, triangles, fans;
  };
  for (const Case& c : {Case{3, 1, 1, 0}, Case{4, 1, 0, 0}, Case{5, 2, 1, 1}, Case{6, 2, 0, 1}, Case{7, 3, 1, 1}}) {
    Mesh mesh = polygon(c.corners);
    mesh.faces.push_back(mesh.faces[0]);
    const Projection p = project_mesh(mesh, identity_camera(), 2, 2);
    ASSERT_EQ(p.quads.size(), 2 * c.primitives) << c.corners;
    EXPECT_EQ(p.triangles, 2 * c.triangles) << c.corners;
    EXPECT_EQ(p.fanned_faces, 2 * c.fans) << c.corners;
    EXPECT_EQ(p.fan_primitives, c.fans == 0 ? 0 : 2 * c.primitives) << c.corners;
    for (std::size_t q = 0; q < c.primitives; ++q) {
      EXPECT_EQ(p.quads[q].id, 0u);
      EXPECT_EQ(p.quads[q + c.primitives].id, 1u);
      // x̃ = (i + 1)/2 · 2 = i + 1: corner 0, then 2q + 1, 2q + 2, 2q + 3 (or 2q + 2 again).
      EXPECT_EQ(p.quads[q].vertex[0].x, 1);
      EXPECT_EQ(p.quads[q].vertex[1].x, 2 * static_cast<double>(q) + 2);
      EXPECT_EQ(p.quads[q].vertex[2].x, 2 * static_cast<double>(q) + 3);
      EXPECT_EQ(p.quads[q].vertex[3].x, std::min<double>(2 * static_cast<double>(q) + 4, c.corners));
    }
  }
}

TEST(Projection, StrictRefusesLargeFacesByNumber) {
  Mesh mesh = polygon(6);
  mesh.faces.insert(mesh.faces.begin(), Face(mesh.faces[0].begin(), mesh.faces[0].begin() + 4));
  EXPECT_NO_THROW(project_mesh(mesh, identity_camera(), 8, 8));
  try {
    project_mesh(mesh, identity_camera(), 8, 8, {AttributeSet::uv, true});
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_NE(std::string(e.what()).find("face 1: 6 corners"), std::string::npos) << e.what();
  }
}

TEST(Projection, BadFacesCamerasAndSizesAreRefused) {
  EXPECT_THROW(project_mesh(polygon(2), identity_camera(), 8, 8), std::invalid_argument);
  Mesh mesh = polygon(4);
  mesh.faces[0][2].position = 4;
  EXPECT_THROW(project_mesh(mesh, identity_camera(), 8, 8), std::invalid_argument);
  EXPECT_THROW(frame_mesh(mesh, 8, 8), std::invalid_argument);
  mesh = polygon(4);
  mesh.faces[0][1].texcoord = 0;
  EXPECT_THROW(project_mesh(mesh, identity_camera(), 8, 8), std::invalid_argument);
  EXPECT_THROW(camera_matrix(identity_camera(), 0, 8), std::invalid_argument);
  const auto broken = [](auto change) {
    Camera camera;
    camera.eye = {0, 0, 3};
    change(camera);
    EXPECT_THROW(camera_matrix(camera, 8, 8), std::invalid_argument);
  };
  broken([](Camera& c) { c.target = c.eye; });
  broken([](Camera& c) { c.up = {0, 0, 2}; });
  broken([](Camera& c) { c.fovy = 180; });
  broken([](Camera& c) { c.near = 0; });
  broken([](Camera& c) { c.far = c.near; });
  broken([](Camera& c) { c.eye[1] = NAN; });
  broken([](Camera& c) {
    c.matrix = Matrix4{};
    (*c.matrix)[5] = INFINITY;
  });
}

TEST(Projection, AttributeLayouts) {
  Mesh mesh = polygon(4);
  mesh.faces.push_back(Face(mesh.faces[0].begin(), mesh.faces[0].begin() + 3));
  mesh.texcoords = {{0.25, 0.5}, {2, -1}};
  mesh.normals = {{0, 3, 4}};
  mesh.faces.push_back({{0, 0, 0}, {1, 1, 0}, {2, 0, 0}, {3, 1, -1}});
  using Values = std::vector<double>;

  for (const auto& [shade, set] : {std::pair{"uv", AttributeSet::uv},
                                   {"texture", AttributeSet::uv},
                                   {"normal", AttributeSet::normal},
                                   {"planes", AttributeSet::position},
                                   {"lambda", AttributeSet::weights},
                                   {"depth", AttributeSet::none},
                                   {"quad", AttributeSet::none}}) {
    EXPECT_EQ(attributes_for_shade(shade), set);
    for (const WindowQuad& quad : project_mesh(mesh, identity_camera(), 8, 8, {set, false}).quads) {
      for (const Values& a : quad.attribute) EXPECT_EQ(a.size(), static_cast<std::size_t>(attribute_count(set)));
    }
  }
  EXPECT_THROW(attributes_for_shade("phong"), std::invalid_argument);

  const auto weights = project_mesh(mesh, identity_camera(), 8, 8).quads;
  EXPECT_EQ(weights[1].attribute[2], (Values{0, 0, 1, 0}));
  const auto uv = project_mesh(mesh, identity_camera(), 8, 8, {AttributeSet::uv, false}).quads;
  EXPECT_EQ(uv[0].attribute[0], (Values{0, 0}));
  EXPECT_EQ(uv[0].attribute[1], (Values{1, 0}));
  EXPECT_EQ(uv[0].attribute[2], (Values{1, 1}));
  EXPECT_EQ(uv[0].attribute[3], (Values{0, 1}));
  EXPECT_EQ(uv[1].attribute[3], (Values{1, 1}));  // a triangle's fourth corner repeats its third
  EXPECT_EQ(uv[2].attribute[1], (Values{2, -1}));
  const auto normal = project_mesh(mesh, identity_camera(), 8, 8, {AttributeSet::uv_normal, false}).quads;
  ASSERT_EQ(normal[2].attribute[0].size(), 5u);
  EXPECT_NEAR(normal[2].attribute[0][3], 0.6, 1e-15);
  EXPECT_NEAR(normal[2].attribute[0][4], 0.8, 1e-15);
  EXPECT_EQ(normal[2].attribute[3][4], 1);  // flat in z = 0: the computed normal
}

TEST(Projection, PositionsAndColours) {
  Mesh mesh = polygon(4);
  EXPECT_EQ(attributes_for_shade("colour"), AttributeSet::colour);
  EXPECT_EQ(attribute_count(AttributeSet::colour), 3);
  EXPECT_THROW(project_mesh(mesh, identity_camera(), 8, 8, {AttributeSet::colour, false}), std::invalid_argument);
  mesh.colours = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  EXPECT_THROW(project_mesh(mesh, identity_camera(), 8, 8, {AttributeSet::colour, false}), std::invalid_argument);
  mesh.colours.push_back({0.25, 0.5, 0.75});
  const auto colour = project_mesh(mesh, identity_camera(), 8, 8, {AttributeSet::colour, false}).quads;
  EXPECT_EQ(colour.at(0).attribute[1], (std::vector<double>{0, 1, 0}));
  EXPECT_EQ(colour[0].attribute[3], (std::vector<double>{0.25, 0.5, 0.75}));
  const auto position = project_mesh(mesh, identity_camera(), 8, 8, {AttributeSet::position, false}).quads;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3& p = mesh.positions[i];
    EXPECT_EQ(position.at(0).attribute[i], (std::vector<double>{p[0], p[1], p[2]}));
  }
}

TEST(Projection, CornersAndTexturesOfEveryQuad) {
  Mesh mesh = polygon(7);
  mesh.texcoords = {{0.5, 0.25}, {3, 4}, {5, 6}};
  mesh.faces.push_back({{4, 2, -1}, {2, 1, -1}, {1, 0, -1}});
  for (const AttributeSet set : {AttributeSet::none, AttributeSet::uv, AttributeSet::colour}) {
    mesh.colours.assign(mesh.positions.size(), {1, 1, 1});
    const Projection p = project_mesh(mesh, identity_camera(), 8, 8, {set, false});
    ASSERT_EQ(p.quads.size(), 4u);  // quads 0123, 0345, triangle 056, and the triangle
    ASSERT_EQ(p.corners.size(), 4u);
    ASSERT_EQ(p.textures.size(), 4u);
    const auto& at = mesh.positions;
    EXPECT_EQ(p.corners[1], (std::array<Vec3, 4>{at[0], at[3], at[4], at[5]}));
    EXPECT_EQ(p.corners[2], (std::array<Vec3, 4>{at[0], at[5], at[6], at[6]}));
    EXPECT_EQ(p.corners[3], (std::array<Vec3, 4>{at[4], at[2], at[1], at[1]}));
    EXPECT_EQ(p.textures[1], (std::array<Vec2, 4>{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}}));
    EXPECT_EQ(p.textures[2], (std::array<Vec2, 4>{{{0, 0}, {1, 0}, {1, 1}, {1, 1}}}));
    EXPECT_EQ(p.textures[3], (std::array<Vec2, 4>{{{5, 6}, {3, 4}, {0.5, 0.25}, {0.5, 0.25}}}));
  }
}

TEST(Projection, SmoothNormalsOfACube) {
  Mesh cube;
  for (int i = 0; i < 8; ++i) cube.positions.push_back({i & 1 ? 1. : -1., i & 2 ? 1. : -1., i & 4 ? 1. : -1.});
  for (const auto& f : {std::array{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    Face face;
    for (const int p : f) face.push_back({p, -1, -1});
    cube.faces.push_back(face);
  }
  const auto normals = smooth_normals(cube);
  for (std::size_t i = 0; i < 8; ++i) {
    for (std::size_t a = 0; a < 3; ++a) EXPECT_NEAR(normals[i][a], cube.positions[i][a] / std::sqrt(3.0), 1e-12);
  }
}

}  // namespace
}  // namespace quadrille::golden
