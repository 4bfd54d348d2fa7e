// Meshes in other formats than OBJ, pairs of triangles, and names of attributes, as a user meets them.
#include "tb/commands/cli_fixture.hpp"

#include <string>

namespace {

using namespace quadrille::cli_test;

/// A concave quad and a triangle beside it, with texture coordinates of few bits: OBJ and single precision agree.
constexpr const char* obj =
    "v -1 -1 0\nv 1 -1 0\nv 0.25 0.25 0.5\nv -1 1 0\nv 2 1 0\nvt 0 0\nvt 1 0\nvt 0.5 0.5\nvt 0 1\nvt 1 0.75\n"
    "f 1/1 2/2 3/3 4/4\nf 2/2 5/5 3/3\n";
constexpr const char* ply =
    "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\nproperty float u\n"
    "property float v\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n-1 -1 0 0 0\n1 -1 0 1 0\n"
    "0.25 0.25 0.5 0.5 0.5\n-1 1 0 0 1\n2 1 0 1 0.75\n4 0 1 2 3\n3 1 4 2\n";
constexpr const char* off = "OFF\n5 2 0\n-1 -1 0\n1 -1 0\n0.25 0.25 0.5\n-1 1 0\n2 1 0\n4 0 1 2 3\n3 1 4 2\n";
/// The same as three triangles in base64: 15 numbers, 9 indices of 16 bits.
constexpr const char* gltf =
    R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[
{"attributes":{"POSITION":0},"indices":1}]}],"buffers":[{"byteLength":78,"uri":"data:application/octet-stream;base64,)"
    "AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAACAPgAAgD4AAAA/AACAvwAAgD8AAAAAAAAAQAAAgD8AAAAAAAABAAIAAAACAAMAAQAEAAIA"
    R"("}],"bufferViews":[{"buffer":0,"byteLength":60},{"buffer":0,"byteOffset":60,"byteLength":18}],"accessors":[
{"bufferView":0,"componentType":5126,"count":5,"type":"VEC3","min":[-1,-1,0],"max":[2,1,0.5]},
{"bufferView":1,"componentType":5123,"count":9,"type":"SCALAR"}]})";

class MeshCli : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    write("m.obj", obj);
    write("m.ply", ply);
    write("m.off", off);
    write("m.gltf", gltf);
  }
  std::string fragments(const std::string& mesh, const std::string& shade) const {
    const Outcome outcome = run("fragments --size 64x64 --view front --out - --mesh " + mesh + " --shade " + shade);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_GT(outcome.out.size(), 10000u);
    return outcome.out;
  }
};

TEST_F(MeshCli, EveryFormatDrawsTheSame) {
  const std::string expected = fragments("m.obj", "uv");
  EXPECT_EQ(expected.substr(0, expected.find('\n')), "quad,x,y,front,flags,l0,l1,l2,l3,z,u,v");
  EXPECT_EQ(fragments("m.ply", "uv"), expected);
  const std::string bare = fragments("m.obj", "normal");
  EXPECT_EQ(fragments("m.off", "normal"), bare);
  EXPECT_EQ(fragments("m.gltf --merge-pairs", "normal"), bare);
  EXPECT_NE(fragments("m.gltf", "normal"), bare);
}

TEST_F(MeshCli, TrianglesAreSaid) {
  const std::string command = "render --size 32x32 --no-error --png a.png --mesh ";
  EXPECT_NE(run(command + "m.gltf").err.find("m.gltf: glTF has no quads, and all 3 faces are triangles; --merge-pairs"),
            std::string::npos);
  EXPECT_NE(run(command + "m.gltf --merge-pairs").err.find("3 triangles became 1 quads, 1 stayed triangles"),
            std::string::npos);
  EXPECT_EQ(run(command + "m.ply").err, "");
  EXPECT_EQ(run(command + "m.gltf --quiet").err, "");
  write("t.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n");
  EXPECT_NE(run(command + "t.obj --merge-pairs").err.find("2 triangles became 1 quads, 0 stayed"), std::string::npos);
  refuses(2, "render --scene bowtie --merge-pairs --png a.png", {"--merge-pairs needs --mesh"});
}

TEST_F(MeshCli, BadMeshes) {
  const std::string command = "render --png a.png --mesh ";
  write("bad.ply", "ply\nformat ascii 1.0\n");
  refuses(2, command + "bad.ply", {"bad.ply: "});
  refuses(2, command + "missing.glb", {"missing.glb", "No such file"});
  write("bad.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n");
  refuses(2, command + "bad.off", {"bad.off: assimp says: ", "OFF is expected"});
  EXPECT_FALSE(fs::exists(file("a.png")));
}

/// The core program by itself, as scripts/cosim.sh builds it.
TEST_F(MeshCli, TheCoreSaysHowToGetTheReader) {
  fs::copy(QUADRILLE_PROGRAM, file("alone"));
  const std::string alone = file("alone").string();
  for (const char* name : {"m.ply", "m.off", "m.gltf", "M.GLB"}) {
    const Outcome outcome = run(std::string("render --png a.png --mesh ") + name, {}, alone);
    EXPECT_EQ(outcome.status, 3);
    EXPECT_EQ(outcome.err.rfind("quadrille: --mesh " + std::string(name) + ": the reader of ", 0), 0u) << outcome.err;
    EXPECT_NE(outcome.err.find("is not built"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("scripts/setup.sh builds it"), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(run("render --quiet --size 32x32 --png a.png --mesh m.obj", {}, alone).status, 0);
}

TEST_F(MeshCli, QuadsWithNamesAreDrawnByThem) {
  const std::string quad = "4 4 0 1 60 4 0 1 60 60 0 1 4 60 0 1 ";
  // The same texture coordinates: named and first, named and last, without names.
  write("uv.quads", "# attributes: u v\n" + quad + "0 0 1 0 1 1 0 1\n");
  write("last.quads", "# attributes: heat u v\n" + quad + "9 0 0 9 1 0 9 1 1 9 0 1\n");
  write("bare.quads", quad + "0 0 1 0 1 1 0 1\n");
  const auto picture = [&](const std::string& options) {
    const Outcome outcome = run("render --quiet --size 64x64 --png p.png --quads " + options);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return read(file("p.png"));
  };
  const std::string uv = picture("uv.quads --shade uv");
  EXPECT_EQ(picture("uv.quads"), uv);
  EXPECT_EQ(picture("last.quads"), uv);
  EXPECT_EQ(picture("bare.quads --shade uv"), uv);
  EXPECT_NE(picture("bare.quads"), uv);
  const auto head = [&](const std::string& quads) {
    const std::string out = run("fragments --size 64x64 --out - --quads " + quads).out;
    return out.substr(0, out.find('\n'));
  };
  EXPECT_EQ(head("last.quads"), "quad,x,y,front,flags,l0,l1,l2,l3,z,heat,u,v");
  EXPECT_EQ(head("bare.quads"), "quad,x,y,front,flags,l0,l1,l2,l3,z,a0,a1");
  write("bad.quads", "# attributes: u\n" + quad + "0 0 1 0 1 1 0 1\n");
  refuses(2, "render --png a.png --quads bad.quads", {"bad.quads:1", "1 names for 2 attributes"});
  // Colours by their names; others have none.
  write("red.quads", "# attributes: red green blue\n" + quad + "1 0 0 1 0 0 1 0 0 1 0 0\n");
  EXPECT_EQ(picture("red.quads"), picture("red.quads --shade colour"));
  refuses(2, "render --png a.png --shade colour --quads uv.quads", {"no", "colours"});
  refuses(2, "render --png a.png --shade normal --quads uv.quads", {"nx, ny, nz"});
}

TEST_F(MeshCli, WhatWouldHoldAnAttribute) {
  write("far.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 500 0\nf 1/1 2/1 3/1 4/1\n");
  const std::string command = "fragments --mesh far.obj --shade uv --size 16x16 --out -";
  refuses(2, command, {"attribute 0 = 500 does not fit attribute_int_bits = 7; 9 would hold it"});
  EXPECT_EQ(run(command + " --set attribute_int_bits=9").status, 0);
  refuses(2, command + " --set attribute_int_bits=8", {"9 would hold it"});
}

TEST_F(MeshCli, ColoursOfVertices) {
  write("coloured.obj", "v -1 -1 0 1 0 0\nv 1 -1 0 1 0 0\nv 1 1 0 1 0 0\nv -1 1 0 1 0 0\nf 1 2 3 4\n");
  const std::string out = run("fragments --mesh coloured.obj --shade colour --size 16x16 --out -").out;
  EXPECT_EQ(out.substr(0, out.find('\n')), "quad,x,y,front,flags,l0,l1,l2,l3,z,red,green,blue");
  write("a.quads", "0 0 0 1  9 0 0 1  9 9 0 1  0 9 0 1\n");
  refuses(2, "render --quads a.quads --shade colour --png a.png", {"# attributes: red green blue"});
}

}  // namespace
