#include "golden/io/merge_pairs.hpp"

#include "golden/io/obj.hpp"
#include "golden/scenes/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace quadrille::golden {
namespace {

using Indices = std::vector<std::vector<int>>;

/// Positions of the corners of every face, 1-based as in an OBJ file.
Indices faces_of(const Mesh& mesh) {
  Indices faces;
  for (const Face& face : mesh.faces) {
    faces.emplace_back();
    for (const Corner& corner : face) faces.back().push_back(corner.position + 1);
  }
  return faces;
}

Indices merged(const std::string& text) {
  Mesh mesh = parse_obj(text, "m");
  merge_pairs(mesh);
  return faces_of(mesh);
}

const std::string grid = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\n";  // 1 2 3 4, and 2 5 6 3 beside it

TEST(MergePairs, EveryOrderOfCornersOfASplit) {
  const Indices along13{{1, 2, 3, 4}};
  EXPECT_EQ(merged(grid + "f 1 2 3\nf 1 3 4\n"), along13);
  EXPECT_EQ(merged(grid + "f 1 2 3\nf 3 4 1\n"), along13);
  EXPECT_EQ(merged(grid + "f 1 2 3\nf 4 1 3\n"), along13);
  EXPECT_EQ(merged(grid + "f 2 3 1\nf 4 1 3\n"), (Indices{{3, 4, 1, 2}}));  // 3 comes before 1 in the first triangle
  EXPECT_EQ(merged(grid + "f 3 1 2\nf 3 4 1\n"), (Indices{{3, 4, 1, 2}}));
  EXPECT_EQ(merged(grid + "f 1 2 4\nf 2 3 4\n"), (Indices{{2, 3, 4, 1}}));  // the diagonal is 2-4
}

TEST(MergePairs, TheSharedEdgeIsTheDiagonal02) {
  for (const std::string triangles : {"f 1 2 3\nf 1 3 4\n", "f 1 2 4\nf 4 2 3\n"}) {
    const Mesh before = parse_obj(grid + triangles, "m");
    Mesh mesh = before;
    merge_pairs(mesh);
    ASSERT_EQ(mesh.faces.size(), 1u);
    const Face& quad = mesh.faces[0];
    for (const Face& triangle : before.faces) {
      const auto has = [&](const Corner& c) {
        return std::ranges::any_of(triangle, [&](const Corner& own) { return own.position == c.position; });
      };
      EXPECT_TRUE(has(quad[0]) && has(quad[2])) << triangles;
    }
  }
}

/// Two triangles on the edge from (0, 0, 0) to (0, 1, 0), the second one's corner at (x, 0, z).
std::string bent(double x, double z) {
  return "v 0 0 0\nv 1 0 0\nv 0 1 0\nv " + std::to_string(-x) + " 0 " + std::to_string(z) + "\nf 1 2 3\nf 1 3 4\n";
}

TEST(MergePairs, BentQuads) {
  EXPECT_EQ(merged(bent(1, 0)).size(), 1u);
  EXPECT_EQ(merged(bent(-0.4, 1)).size(), 1u);  // by 112 degrees
}

TEST(MergePairs, OnlyTrianglesOfOneQuad) {
  const auto stay = [](const std::string& text, std::size_t faces) { EXPECT_EQ(merged(text).size(), faces) << text; };
  stay(grid + "f 1 2 3\nf 1 4 3\n", 2);             // the other one is turned
  stay(grid + "f 1 2 4\nf 5 6 3\n", 2);             // a corner alone is shared
  stay(grid + "f 1 2 3\nf 2 5 6 3\nf 1 3 4\n", 3);  // a quad is between them
  stay(bent(-0.8, 1), 2);                           // by 129 degrees
  const std::string seam = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
  stay(grid + seam + "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n", 1);
  stay(grid + seam + "f 1/1 2/2 3/3\nf 1/1 3/2 4/4\n", 2);  // other texture coordinates at one end
  stay(grid + "vn 0 0 1\nvn 0 1 0\nf 1//1 2//1 3//1\nf 1//2 3//2 4//2\n", 2);
  stay(grid + seam + "f 1/1 2/2 3/3\nf 1 3 4\n", 2);
}

/// Writers without indices repeat vertices: values count.
TEST(MergePairs, CornersAreComparedByValue) {
  const std::string apart = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 0\nv 1 1 0\nv 0 1 0\n";
  EXPECT_EQ(merged(apart + "f 1 2 3\nf 4 5 6\n"), (Indices{{1, 2, 3, 6}}));
  Mesh coloured = parse_obj(apart + "f 1 2 3\nf 4 5 6\n", "m");
  coloured.colours.assign(6, Vec3{1, 1, 1});
  coloured.colours[4] = {0, 1, 1};
  merge_pairs(coloured);
  EXPECT_EQ(coloured.faces.size(), 2u);
}

/// A lone triangle shares an edge with the first half of the quad after it: the squarer quad is taken.
TEST(MergePairs, ATriangleBetweenQuadsStaysOne) {
  const std::string text = grid + "v 0.5 -1 0\nf 1 7 2\nf 1 2 3\nf 1 3 4\nf 2 5 6\nf 2 6 3\n";
  EXPECT_EQ(merged(text), (Indices{{1, 7, 2}, {1, 2, 3, 4}, {2, 5, 6, 3}}));
  Mesh mesh = parse_obj(text, "m");
  merge_pairs(mesh);
  ASSERT_EQ(mesh.notes.size(), 1u);
  EXPECT_EQ(mesh.notes[0], "--merge-pairs: 5 triangles became 2 quads, 1 stayed triangles");
}

TEST(MergePairs, ConcaveQuads) {
  const std::string arrow = "v 0 0 0\nv 2 -1 0\nv 0.5 0 0\nv 2 1 0\n";
  EXPECT_EQ(merged(arrow + "f 1 2 3\nf 1 3 4\n"), (Indices{{1, 2, 3, 4}}));
}

/// Meshes of quads split along either diagonal come back, corner by corner up to where they begin.
TEST(MergePairs, ScenesComeBack) {
  for (const char* name : {"sphere", "phong_mesh", "bloomenthal12_4000"}) {
    const Mesh whole = make_scene(name).mesh;
    Mesh split = whole;
    split.faces.clear();
    std::size_t quads = 0;
    for (const Face& f : whole.faces) {
      if (f.size() != 4) {
        split.faces.push_back(f);
      } else if (++quads % 3 == 0) {
        split.faces.push_back({f[0], f[1], f[3]});
        split.faces.push_back({f[1], f[2], f[3]});
      } else {
        split.faces.push_back({f[0], f[1], f[2]});
        split.faces.push_back({f[0], f[2], f[3]});
      }
    }
    ASSERT_GT(quads, 20u) << name;
    merge_pairs(split);
    ASSERT_EQ(split.faces.size(), whole.faces.size()) << name;
    for (std::size_t i = 0; i < whole.faces.size(); ++i) {
      Face face = split.faces[i];
      ASSERT_EQ(face.size(), whole.faces[i].size());
      const auto differs = [&] {
        for (std::size_t k = 0; k < face.size(); ++k)
          if (face[k].position != whole.faces[i][k].position || face[k].texcoord != whole.faces[i][k].texcoord ||
              face[k].normal != whole.faces[i][k].normal)
            return true;
        return false;
      };
      for (std::size_t turn = 0; turn < face.size() && differs(); ++turn)
        std::rotate(face.begin(), face.begin() + 1, face.end());
      EXPECT_FALSE(differs()) << name << " face " << i;
    }
  }
}

}  // namespace
}  // namespace quadrille::golden
