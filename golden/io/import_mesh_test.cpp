#include "golden/io/import_mesh.hpp"

#include "golden/io/test_support.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

namespace quadrille::golden {
namespace {

static_assert(std::endian::native == std::endian::little);  // as the binary formats here

using Indices = std::vector<std::vector<int>>;

Indices faces_of(const Mesh& mesh) {
  Indices faces;
  for (const Face& face : mesh.faces) {
    faces.emplace_back();
    for (const Corner& corner : face) faces.back().push_back(corner.position);
  }
  return faces;
}

bool has_note(const Mesh& mesh, std::string_view text) {
  for (const std::string& note : mesh.notes)
    if (note.find(text) != std::string::npos) return true;
  return false;
}

/// A cube without its top, with a concave quad and a pentagon over it.
const std::string off_text =
    "OFF\n# by hand\n10 7 0\n-1 -1 -1\n1 -1 -1\n1 1 -1\n-1 1 -1\n-1 -1 1\n1 -1 1\n1 1 1\n-1 1 1\n0 0 1\n0 2 1\n"
    "4 3 2 1 0\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n4 4 5 8 7\n5 8 5 6 9 7\n";

TEST_F(InDirectory, OffKeepsPolygons) {
  const Mesh mesh = import_mesh(write("cube.off", off_text), false);
  EXPECT_EQ(
      faces_of(mesh),
      (Indices{{3, 2, 1, 0}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}, {4, 5, 8, 7}, {8, 5, 6, 9, 7}}));
  EXPECT_EQ(mesh.positions[9], (Vec3{0, 2, 1}));
  EXPECT_TRUE(mesh.texcoords.empty() && mesh.normals.empty() && mesh.colours.empty() && mesh.notes.empty());
  EXPECT_EQ(mesh.faces[0][0].texcoord, -1);
  EXPECT_EQ(mesh.faces[0][0].normal, -1);
}

std::string ply_text(const std::string& u, const std::string& v) {
  return "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 5\nproperty float x\nproperty float y\n"
         "property float z\nproperty float nx\nproperty float ny\nproperty float nz\nproperty float " +
         u + "\nproperty float " + v +
         "\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face 2\n"
         "property list uchar uint vertex_indices\nend_header\n"
         "0 0 0 0 0 1 0 0.25 255 0 0\n1 0 0 0 0 1 1 0 0 255 0\n1 1 0 0 1 0 1 1 0 0 255\n0 1 0 0 0 1 0 1 51 51 51\n"
         "2 0 0.5 0 0 1 0.5 0.5 0 0 0\n4 0 1 2 3\n3 1 4 2\n";
}

TEST_F(InDirectory, PlyKeepsPolygonsAndTakesWhatVerticesHave) {
  for (const auto& [u, v] : {std::pair{"u", "v"}, std::pair{"s", "t"}}) {
    const Mesh mesh = import_mesh(write("a.PLY", ply_text(u, v)), false);
    EXPECT_EQ(faces_of(mesh), (Indices{{0, 1, 2, 3}, {1, 4, 2}}));
    const Corner& corner = mesh.faces[0][2];
    EXPECT_EQ(mesh.positions[4], (Vec3{2, 0, 0.5}));
    EXPECT_EQ(mesh.normals[static_cast<std::size_t>(corner.normal)], (Vec3{0, 1, 0}));
    EXPECT_EQ(mesh.texcoords[static_cast<std::size_t>(mesh.faces[0][0].texcoord)], (Vec2{0, 0.25}));  // v stays up
    EXPECT_EQ(mesh.colours[2], (Vec3{0, 0, 1}));
    EXPECT_NEAR(mesh.colours[3][1], 0.2, 1e-6);
  }
}

std::string bytes(const auto& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof values[0]};
}

TEST_F(InDirectory, BinaryPly) {
  const std::array<float, 12> points{0, 0, 0, 1, 0, 0, 0.25, 0.25, 0, 0, 1, 0};  // concave at the third
  const std::array<std::int32_t, 4> corners{0, 1, 2, 3};
  const Mesh mesh =
      import_mesh(write("b.ply",
                        "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n" +
                            bytes(points) + "\x04" + bytes(corners)),
                  false);
  EXPECT_EQ(faces_of(mesh), (Indices{{0, 1, 2, 3}}));
  EXPECT_EQ(mesh.positions[2], (Vec3{0.25, 0.25, 0}));
}

/// Two quads, a pentagon and a triangle on seven vertices, each polygon a fan from its first corner.
const std::array<float, 21> points{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, 0, 2, 1, 0, 1.5, 1.5, 0};
const std::array<float, 14> texture{0, 1, 1, 1, 1, 0, 0, 0, 0.5, 0.5, 0.25, 0.25, 0, 0};
const std::array<std::uint16_t, 24> triangles{0, 1, 2, 0, 2, 3,            // quad
                                              4, 5, 2, 4, 2, 1,            // quad
                                              2, 5, 6,                     // triangle
                                              3, 0, 1, 3, 1, 4, 3, 4, 5};  // pentagon

/// The buffer of the two lists of numbers, as m.bin.
std::string buffer() { return bytes(points) + bytes(texture) + bytes(triangles); }

std::string gltf(const std::string& primitive, const std::string& node = "\"mesh\":0", const std::string& more = "",
                 const std::string& place = R"("uri":"m.bin",)") {
  return R"({"asset":{"version":"2.0"},)" + more + R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[{)" + node +
         R"(}],"meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2)" + primitive +
         R"(}]}],"materials":[{"pbrMetallicRoughness":{"baseColorFactor":[0.5,1,0.25,1]}}],"buffers":[{)" + place +
         R"("byteLength":188}],"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":84},)"
         R"({"buffer":0,"byteOffset":84,"byteLength":56},{"buffer":0,"byteOffset":140,"byteLength":48}],"accessors":[)"
         R"({"bufferView":0,"componentType":5126,"count":7,"type":"VEC3","min":[0,0,0],"max":[2,1.5,0]},)"
         R"({"bufferView":1,"componentType":5126,"count":7,"type":"VEC2"},)"
         R"({"bufferView":2,"componentType":5123,"count":24,"type":"SCALAR"}]})";
}
const std::string ngon = R"(,"extensions":{"FB_ngon_encoding":{}})";
const Indices polygons{{0, 1, 2, 3}, {4, 5, 2, 1}, {2, 5, 6}, {3, 0, 1, 4, 5}};

TEST_F(InDirectory, GltfWithNgonEncodingHasItsPolygons) {
  write("m.bin", buffer());
  const Mesh mesh = import_mesh(write("m.gltf", gltf(ngon)), false);
  EXPECT_EQ(faces_of(mesh), polygons);
  EXPECT_TRUE(has_note(mesh, "8 triangles became 3 polygons, 1 stayed triangles"));
  // glTF counts v from the top.
  EXPECT_EQ(mesh.texcoords[static_cast<std::size_t>(mesh.faces[0][0].texcoord)], (Vec2{0, 0}));
  EXPECT_EQ(mesh.texcoords[static_cast<std::size_t>(mesh.faces[0][2].texcoord)], (Vec2{1, 1}));
  EXPECT_TRUE(mesh.colours.empty());
}

/// Triangles of one first vertex that do not go on from each other are two faces.
TEST_F(InDirectory, NgonsGoOnWhereTheyEnd) {
  auto others = triangles;
  others[4] = 4, others[5] = 5;
  write("m.bin", bytes(points) + bytes(texture) + bytes(others));
  const Mesh mesh = import_mesh(write("m.gltf", gltf(ngon)), false);
  const Indices faces = faces_of(mesh);
  ASSERT_EQ(faces.size(), 5u);
  EXPECT_EQ(faces[0], (std::vector<int>{0, 1, 2}));
  ASSERT_EQ(faces[1].size(), 3u);
  // By place: newer assimp numbers vertices in the order of the faces.
  const auto place = [&](std::size_t corner) { return mesh.positions[static_cast<std::size_t>(faces[1][corner])]; };
  EXPECT_EQ(faces[1][0], 0);
  EXPECT_EQ(place(1), (Vec3{2, 0, 0}));
  EXPECT_EQ(place(2), (Vec3{2, 1, 0}));
}

TEST_F(InDirectory, GltfWithoutItHasTrianglesThatMayMerge) {
  write("m.bin", buffer());
  const std::string file = write("m.gltf", gltf(""));
  const Mesh triangle_mesh = import_mesh(file, false);
  EXPECT_EQ(triangle_mesh.faces.size(), 8u);
  EXPECT_TRUE(has_note(triangle_mesh, "all 8 faces are triangles; --merge-pairs"));
  const Mesh merged = import_mesh(file, true);
  EXPECT_TRUE(has_note(merged, "8 triangles became 3 quads, 2 stayed triangles"));
  EXPECT_FALSE(has_note(merged, "all 8 faces"));
  EXPECT_EQ(merged.faces[0].size(), 4u);
  EXPECT_EQ(merged.faces[1].size(), 4u);
}

/// Two primitives: the extension is one's own.
TEST_F(InDirectory, NgonEncodingBelongsToAPrimitive) {
  write("m.bin", buffer());
  const std::string plain = R"(},{"attributes":{"POSITION":0},"indices":2)";
  for (const std::string& primitives : {ngon + plain, plain + ngon}) {
    const Mesh mesh = import_mesh(write("m.gltf", gltf(primitives)), false);
    ASSERT_EQ(mesh.faces.size(), 12u);
    const bool first = primitives.starts_with(ngon);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(mesh.faces[first ? i : 8 + i].size(), polygons[i].size());
    EXPECT_EQ(mesh.faces[first ? 4 : 0].size(), 3u);
    EXPECT_EQ(mesh.faces[first ? 4 : 0][0].texcoord, first ? -1 : 0);
  }
}

TEST_F(InDirectory, BinaryGltf) {
  std::string json = gltf(ngon, "\"mesh\":0", "", "");
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::string data = buffer();
  const auto word = [](std::size_t value) {
    return bytes(std::array<std::uint32_t, 1>{static_cast<std::uint32_t>(value)});
  };
  const std::string file = "glTF" + word(2) + word(12 + 8 + json.size() + 8 + data.size()) + word(json.size()) +
                           "JSON" + json + word(data.size()) + std::string("BIN\0", 4) + data;
  EXPECT_EQ(faces_of(import_mesh(write("m.glb", file), false)), polygons);
  expect_input_error([&] { import_mesh(write("cut.glb", file.substr(0, 100)), false); }, path("cut.glb"),
                     {"cut off", "complete"});
}

TEST_F(InDirectory, NodesPlaceMeshes) {
  write("m.bin", buffer());
  // A quarter turn about z, doubled, moved; its child mirrors x.
  const std::string turned =
      R"("mesh":0,"translation":[10,0,0],"rotation":[0,0,0.70710678,0.70710678],"scale":[2,2,2])";
  const Mesh mesh = import_mesh(write("m.gltf", gltf(ngon, turned)), false);
  EXPECT_EQ(faces_of(mesh), polygons);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(mesh.positions[2][i], (Vec3{8, 2, 0})[i], 1e-5) << i;
  const Mesh mirrored = import_mesh(write("m.gltf", gltf(ngon, R"("mesh":0,"scale":[-1,1,1])")), false);
  EXPECT_EQ(faces_of(mirrored)[0], (std::vector<int>{0, 3, 2, 1}));  // still counter-clockwise from +z
  EXPECT_EQ(mirrored.positions[2], (Vec3{-1, 1, 0}));
  const Mesh twice =
      import_mesh(write("m.gltf", gltf(ngon, R"("mesh":0,"children":[1]},{"mesh":0,"scale":[1,1,3])")), false);
  EXPECT_EQ(twice.faces.size(), 8u);
}

/// Normals, here the positions' numbers, stay at right angles to the surface and keep their side.
TEST_F(InDirectory, NormalsGoWithTheSurface) {
  write("m.bin", buffer());
  const auto normal = [&](const std::string& scale) {
    std::string text = gltf("", "\"mesh\":0,\"scale\":" + scale);
    text.replace(text.find("\"TEXCOORD_0\":1"), 14, "\"NORMAL\":0");
    const Mesh mesh = import_mesh(write("m.gltf", text), false);
    return mesh.normals.at(2);  // of (1, 1, 0)
  };
  EXPECT_EQ(normal("[1,1,1]"), (Vec3{1, 1, 0}));
  const Vec3 stretched = normal("[2,1,1]"), mirrored = normal("[-1,1,1]");
  EXPECT_NEAR(stretched[0], std::sqrt(0.2), 1e-12);
  EXPECT_NEAR(stretched[1], std::sqrt(0.8), 1e-12);
  EXPECT_NEAR(mirrored[0], -std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(mirrored[1], std::sqrt(0.5), 1e-12);
}

TEST_F(InDirectory, ColoursAreTheMaterials) {
  write("m.bin", buffer());
  const Mesh mesh = import_mesh(write("m.gltf", gltf(R"(,"material":0)")), false);
  ASSERT_EQ(mesh.colours.size(), 7u);
  EXPECT_EQ(mesh.colours[3], (Vec3{0.5, 1, 0.25}));
}

TEST_F(InDirectory, PointsAndLinesAreCounted) {
  write("m.bin", buffer());
  const Mesh mesh = import_mesh(write("m.gltf", gltf(R"(},{"attributes":{"POSITION":0},"mode":0)")), false);
  EXPECT_EQ(mesh.faces.size(), 8u);
  EXPECT_TRUE(has_note(mesh, "7 points and lines are not drawn"));
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST_F(InDirectory, BadMeshesAreRefused) {
  write("m.bin", buffer());
  const std::string ply = ply_text("u", "v");
  const std::initializer_list<std::string_view> says{"assimp says: "};  // in its own words
  const auto refused = [&](const std::string& name, const std::string& text,
                           std::initializer_list<std::string_view> fragments) {
    SCOPED_TRACE(name + ": " + std::string(*fragments.begin()));
    const std::string file = write(name, text);
    expect_input_error([&] { import_mesh(file, false); }, file, fragments);
  };
  refused("a.off", "", {"is empty", "OFF"});
  refused("a.off", "OFF\n", says);
  refused("a.off", with(off_text, "4 3 2 1 0", "4 3 2 1 10"), says);
  refused("a.off", with(off_text, "-1 -1 -1", "-1 x -1"), says);
  refused("a.off", with(off_text, "-1 -1 -1", "-1 -1 inf"), {"the position of vertex 0 holds inf", "finite"});
  refused("a.off", with(off_text, "1 -1 -1", "1 1e30 -1"), {"the position of vertex 0", "2^80"});
  refused("a.off", with(off_text, "10 7 0", "10 70 0"), says);
  refused("a.off", with(off_text, "4 3 2 1 0", "2 3 2"), {"face 0 has 2 corners", "at least 3"});
  refused("a.ply", "ply\nformat ascii 1.0\n", {"cut off in its header", "end_header"});
  refused("a.ply", ply.substr(0, ply.find("end_header") + 10), {"cut off in its header"});
  for (const auto& [line, bad] : {std::pair{"PNG", "PNG\n1 2 3\n"}, {"\"\"", "ply\n\nend_header\n"}}) {
    const std::string file = write("b.ply", bad), place = file + (*line == 'P' ? ":1" : ":2");
    expect_input_error([&] { import_mesh(file, false); }, place, {"the header has", line, "end_header"});
  }
  const std::string counted = write("c.ply", with(ply, "vertex 5", "vertex 5000"));
  expect_input_error([&] { import_mesh(counted, false); }, counted + ":4", {"room", "element vertex 8"});
  refused("a.ply", with(ply, "4 0 1 2 3", "4 0 1 2 9"), says);
  refused("a.ply", with(ply, "4 0 1 2 3", "4 0 1 2"), says);
  refused("a.ply", with(ply, "1 0 0 0 0 1", "nan 0 0 0 0 1"), {"the position of vertex 1 holds nan"});
  refused("a.ply", with(ply, "1 1 0 0 1 0 1 1", "1 1 0 0 1 0 1 nan"), {"the texture coordinate of vertex 2"});
  refused("a.ply", with(ply, "1 1 0 0 1 0 1 1", "1 1 0 0 nan 0 1 1"), {"the normal of vertex 2"});
  refused("a.ply", ply.substr(0, ply.find("4 0 1 2 3")), {"face 0 has"});
  refused("a.ply", with(ply, "vertex_indices", "corners"), says);
  refused("a.gltf", "{,}", {"is no glTF", "JSON"});
  refused("a.gltf", "{\"asset\": {}}", {"is no glTF", "version"});
  refused("a.gltf", with(gltf(""), "2.0", "1.0"), {"is glTF \"1.0\"", "version 2"});
  refused("a.gltf", with(gltf(""), "m.bin", "other.bin"), says);
  refused("a.gltf", with(gltf(""), "\"count\":24", "\"count\":2400"), says);
  refused("a.gltf", with(gltf(""), "\"count\":24", "\"count\":23"), says);
  refused("a.gltf", with(gltf(""), "\"POSITION\":0", "\"POSITION\":9"), says);
  refused("a.gltf", gltf("", "\"mesh\":0", R"("extensionsRequired":["KHR_mesh_quantization"],)"),
          {"requires the extension \"KHR_mesh_quantization\"", "export without"});
  refused("a.gltf", gltf(R"(,"mode":1)"), {"no face was found"});
  std::string data = buffer();
  data[140] = 50;  // the first index
  write("m.bin", data);
  refused("a.gltf", gltf(""), says);
  expect_input_error([&] { import_mesh(path("absent.ply"), false); }, path("absent.ply"), {"No such file", "PLY"});
  expect_input_error([&] { import_mesh(path("absent.glb"), false); }, path("absent.glb"), {"No such file", "glTF"});
}

}  // namespace
}  // namespace quadrille::golden
