#include "golden/io/obj.hpp"

#include "golden/io/test_support.hpp"
#include "golden/io/text_input.hpp"

#include <algorithm>
#include <string>

namespace quadrille::golden {
namespace {

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n";  // 9 lines

TEST(Obj, ReadsEveryIndexForm) {
  const Mesh mesh = parse_obj(
      square + "f 1 2 3 4\nf 1/1 2/2 3/3\nf 1//1 2//1 3//1 4//-1\nf -4/-4/1 -3/-3/1 3/3/1 4/4/1 1/1/1\n", "m");
  ASSERT_EQ(mesh.faces.size(), 4u);
  EXPECT_EQ(mesh.faces[0].size(), 4u);
  EXPECT_EQ(mesh.faces[0][3].position, 3);
  EXPECT_EQ(mesh.faces[0][3].texcoord, -1);
  EXPECT_EQ(mesh.faces[0][3].normal, -1);
  EXPECT_EQ(mesh.faces[1].size(), 3u);
  EXPECT_EQ(mesh.faces[1][2].texcoord, 2);
  EXPECT_EQ(mesh.faces[2][3].texcoord, -1);
  EXPECT_EQ(mesh.faces[2][3].normal, 0);
  ASSERT_EQ(mesh.faces[3].size(), 5u);
  EXPECT_EQ(mesh.faces[3][0].position, 0);
  EXPECT_EQ(mesh.faces[3][1].texcoord, 1);
  EXPECT_EQ(mesh.faces[3][1].normal, 0);
  EXPECT_EQ(mesh.positions[2], (Vec3{1, 1, 0}));
  EXPECT_EQ(mesh.texcoords[3], (Vec2{0, 1}));
  EXPECT_EQ(mesh.normals[0], (Vec3{0, 0, 1}));
  EXPECT_EQ(mesh.skipped_lines, 0u);
}

TEST(Obj, IndicesMayHaveAPlus) {
  const Mesh mesh = parse_obj(square + "f +1/+2/+1 2/+3/1 +4/1/+1\n", "m");
  EXPECT_EQ(mesh.faces[0][0].position, 0);
  EXPECT_EQ(mesh.faces[0][0].texcoord, 1);
  EXPECT_EQ(mesh.faces[0][1].texcoord, 2);
  EXPECT_EQ(mesh.faces[0][2].position, 3);
}

TEST(Obj, WhatABackslashSwallowsIsNoted) {
  const Mesh mesh =
      parse_obj(square + "usemtl dir\\sub\\\nf 1 2 3 4\nf 4 3 2 1\no x\\\r\nvt 0 0\nmtllib a \\\n b.mtl\n", "m");
  EXPECT_EQ(mesh.faces.size(), 1u);
  EXPECT_EQ(mesh.texcoords.size(), 4u);
  ASSERT_EQ(mesh.notes.size(), 2u);  // none of mtllib, which goes on as it should
  EXPECT_EQ(mesh.notes[0], "line 11, 'f', is not read: the backslash that ends line 10 joins it to 'usemtl'");
  EXPECT_EQ(mesh.notes[1], "line 14, 'vt', is not read: the backslash that ends line 13 joins it to 'o'");
  EXPECT_TRUE(parse_obj(square + "f 1 2 3 \\\n 4\n", "m").notes.empty());
}

/// What comes of a text: all of its mesh, or the error.
std::string outcome(const std::string& text) {
  std::string out;
  const auto add = [&](const auto& values) {
    for (const double value : values) out += number_text(value) + " ";
    out += "; ";
  };
  try {
    const Mesh mesh = parse_obj(text, "m");
    for (const Vec3& v : mesh.positions) add(v);
    for (const Vec2& v : mesh.texcoords) add(v);
    for (const Vec3& v : mesh.normals) add(v);
    for (const Face& face : mesh.faces)
      for (const Corner& c : face)
        out += std::to_string(c.position) + "/" + std::to_string(c.texcoord) + "/" + std::to_string(c.normal) + " ";
    out += std::to_string(mesh.skipped_lines);
  } catch (const InputError& error) {
    out = error.what();
  }
  return out;
}

/// Blanks are quick to read and tabs are not: nothing else differs.
TEST(Obj, ReadsLinesWithBlanksAsThoseWithTabs) {
  for (const std::string line : {"v 1 2 3",
                                 "v  -1.5e-3   2 .5  ",
                                 "v 1 2",
                                 "v 1 2 3 4",
                                 "v 1 2 3 4 5 6",
                                 "v 1 2 x",
                                 "v 1 2 3x",
                                 "v 1.5.5 2",
                                 "v 1-2 3",
                                 "v 1 2 3 4 5",
                                 "v nan 0 0",
                                 "v inf 0 0",
                                 "v 1e400 0 0",
                                 "v 2e24 0 0",
                                 "v 0x1 0 0",
                                 "v +1 +2 -3",
                                 "v -0 1e-320 5",
                                 "v 1 2 3 # four",
                                 "v 1 2 3\\\n4",
                                 "v 1 2 \\\n3",
                                 "v",
                                 "v ",
                                 "vt 1 2",
                                 "vt 1",
                                 "vt 1 2 3",
                                 "vt 1 2 3 4",
                                 "vn 1 2 3",
                                 "vn 1 2",
                                 "vn 1 2 3 4",
                                 "f 1 2 3",
                                 "f 1 2 3 4  ",
                                 "f 1 2",
                                 "f 1",
                                 "f",
                                 "f 0 1 2",
                                 "f 5 1 2",
                                 "f 1/1 2/2 3/4",
                                 "f 1/1 2/5 3/3",
                                 "f 1//1 2//1 3//1",
                                 "f 1//1 2//2 3//1",
                                 "f 1/1/1 2/2/1 3/3/1",
                                 "f 1/ 2/ 3/",
                                 "f 1// 2// 3//",
                                 "f 1/2/ 2/2/ 3/2/",
                                 "f 1/1/1/1 2 3",
                                 "f 1/1 2 3",
                                 "f 1 2/2 3",
                                 "f 1//1 2 3",
                                 "f -1 -2 -3",
                                 "f +1 +2 +3",
                                 "f 1.5 2 3",
                                 "f 1 2 3x",
                                 "f 1 2 3/",
                                 "f 1 2 3//",
                                 "f 1/1/ 2/2/ 3/3/",
                                 "f 1-2 3",
                                 "f 1 2 3 4 3 2 1 4",
                                 "f 1 2 3 4 3 2 1 4 3 2",
                                 "f 99999999999999999999 1 2",
                                 "f 4294967297 1 2",
                                 "f 1 2 3 \\\n4",
                                 "f 1 2\r f 1 2 3",
                                 "fx 1 2 3",
                                 "g 1 2 3",
                                 "# f 1 2 3",
                                 "v 1 2 3\rv 4 5 6"})
    for (const std::string end : {"\n", "\r\n", "\r", "\n\n", ""}) {
      const std::string text = square + line + end, rest = end.empty() ? "" : "f 4 3 2" + end;
      std::string tabs = text;
      std::ranges::replace(tabs, ' ', '\t');
      EXPECT_EQ(outcome(text + rest), outcome(tabs + rest)) << line;
    }
}

TEST(Obj, NegativeIndicesCountFromTheFace) {
  const Mesh mesh = parse_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nf -3 -2 -1\nv 5 5 5\nf -3 -2 -1\n", "m");
  EXPECT_EQ(mesh.faces[0][0].position, 0);
  EXPECT_EQ(mesh.faces[1][0].position, 1);
}

TEST(Obj, SkipsAndCountsOtherStatements) {
  const Mesh mesh = parse_obj(
      "# x\n\no part\nusemtl a # b\nmtllib \\\n c.mtl\n" + square + "t crease 2/1/0 68\nl 1 2\nf 1 2 3 4 # end", "m");
  EXPECT_EQ(mesh.skipped_lines, 5u);
  EXPECT_EQ(mesh.faces.size(), 1u);
}

TEST(Obj, AcceptsWeightsColoursLineEndsAndContinuation) {
  const Mesh mesh =
      parse_obj("v 1 2 3 1\r\nv +1 2 3 .1 .2 .3\rv 1 2 \\\r\n 3 1 0 0 0\n\tvt 0.25\nvt 1 2 3\nf 1 \\\n2 3", "m");
  EXPECT_EQ(mesh.positions.size(), 3u);
  EXPECT_EQ(mesh.positions[2], (Vec3{1, 2, 3}));
  EXPECT_EQ(mesh.texcoords[0], (Vec2{0.25, 0}));
  EXPECT_EQ(mesh.texcoords[1], (Vec2{1, 2}));
}

struct BadObj {
  const char* statement;
  std::initializer_list<std::string_view> fragments;
};

TEST(Obj, NamesThePlaceOfEachError) {
  const BadObj cases[] = {
      {"v 1 2", {"'v' has 2 numbers", "3 coordinates"}},
      {"v 1 2 3 4 5", {"'v' has 5 numbers"}},
      {"v 1 abc 3", {"'v' number 2 is \"abc\"", "is not a number"}},
      {"v 1 2 3x", {"number 3 is \"3x\"", "is not a number"}},
      {"v 1 2,5 3", {"\"2,5\""}},
      {"v nan 0 0", {"number 1 is \"nan\"", "is not finite"}},
      {"v 0 0 -inf", {"number 3 is \"-inf\"", "is not finite"}},
      {"v 0 1e999 0", {"number 2 is \"1e999\"", "outside the range"}},
      {"v 0 1e30 0", {"number 2 is \"1e30\"", "2^80"}},
      {"v 0 0 0 nan", {"number 4 is \"nan\""}},
      {"vt", {"'vt' has 0 numbers"}},
      {"vt 0 inf", {"'vt' number 2 is \"inf\""}},
      {"vn 0 1", {"'vn' has 2 numbers"}},
      {"vn 0 1 two", {"'vn' number 3 is \"two\""}},
      {"f", {"face has 0 corners", "at least 3"}},
      {"f 1", {"face has 1 corners", "at least 3"}},
      {"f 1 2", {"face has 2 corners", "at least 3"}},
      {"f 1 2 0", {"face corner 3 is \"0\"", "position index \"0\"", "start at 1"}},
      {"f 1 2 5", {"face corner 3", "position index \"5\" is out of range", "1 to 4"}},
      {"f 1 -5 3", {"face corner 2", "position index \"-5\" is out of range"}},
      {"f 1 2 99999999999999999999", {"position index", "is out of range"}},
      {"f 1 2 2147483649", {"is out of range"}},
      {"f 1 2.0 3", {"face corner 2", "\"2.0\" is not an integer"}},
      {"f 1 +-2 3", {"\"+-2\" is not an integer"}},
      {"f 1 ++2 3", {"\"++2\" is not an integer"}},
      {"f 1 + 3", {"\"+\" is not an integer"}},
      {"f 1 +0 3", {"position index \"+0\" is 0"}},
      {"f 1 b 3", {"\"b\" is not an integer"}},
      {"f 1/ 2/ 3/", {"face corner 1 is \"1/\"", "a/b/c"}},
      {"f /1 /2 /3", {"face corner 1 is \"/1\""}},
      {"f 1// 2// 3//", {"face corner 1 is \"1//\""}},
      {"f 1/1/1/1 2 3", {"face corner 1 is \"1/1/1/1\""}},
      {"f 1/0 2/1 3/1", {"texture coordinate index \"0\""}},
      {"f 1/5 2/1 3/1", {"texture coordinate index \"5\" is out of range"}},
      {"f 1//2 2//1 3//1", {"normal index \"2\" is out of range"}},
      {"f 1/1/x 2/1/1 3/1/1", {"normal index \"x\" is not an integer"}},
      {"f 1/1 2 3/1", {"face corner 2 is \"2\"", "another form"}},
      {"f 1//1 2/1/1 3//1", {"face corner 2", "another form"}},
  };
  for (const BadObj& bad : cases) {
    SCOPED_TRACE(bad.statement);
    expect_input_error([&] { parse_obj(square + bad.statement + "\nf 1 2 3\n", "dir/m.obj"); }, "dir/m.obj:10",
                       bad.fragments);
  }
}

TEST(Obj, ForwardReferencesAreErrors) {
  expect_input_error([] { parse_obj("v 0 0 0\nv 1 0 0\nf 1 2 3\nv 1 1 0\n", "m.obj"); }, "m.obj:3",
                     {"\"3\" is out of range"});
  expect_input_error([] { parse_obj("f 1 2 3\n", "m.obj"); }, "m.obj:1", {"none is defined"});
}

TEST(Obj, ContinuedLinesKeepTheirOwnNumber) {
  expect_input_error([] { parse_obj("v 0 0 \\\n x\n", "m.obj"); }, "m.obj:2", {"number 3 is \"x\""});
}

TEST_F(InDirectory, ObjFileErrors) {
  expect_input_error([&] { load_obj(path("absent.obj")); }, path("absent.obj"), {"No such file", "OBJ"});
  expect_input_error([&] { load_obj(path("")); }, path(""), {"Is a directory"});
  const std::string empty = write("empty.obj", "");
  expect_input_error([&] { load_obj(empty); }, empty, {"no face"});
  const std::string points = write("points.obj", square);
  expect_input_error([&] { load_obj(points); }, points, {"no face"});
  EXPECT_EQ(load_obj(write("good.obj", square + "f 1 2 3 4")).faces.size(), 1u);
}

/// Larger than any buffer that a reader may have: the last lines are read as the first ones.
TEST_F(InDirectory, ObjFilesMayBeLarge) {
  std::string text;
  for (int i = 1; i <= 20'000; ++i) text += "v " + std::to_string(i) + " 0 0.25\nf 1 -1 " + std::to_string(i) + "\n";
  const Mesh mesh = load_obj(write("large.obj", text));
  ASSERT_EQ(mesh.faces.size(), 20'000u);
  EXPECT_EQ(mesh.positions.back(), (Vec3{20'000, 0, 0.25}));
  EXPECT_EQ(mesh.faces.back()[2].position, 19'999);
}

}  // namespace
}  // namespace quadrille::golden
