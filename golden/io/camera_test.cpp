#include "golden/io/camera.hpp"

#include "golden/io/test_support.hpp"

#include <tuple>

namespace quadrille::golden {
namespace {

/// A good look-at camera, a field per line from line 2, with one field replaced (or dropped when `value` is empty).
std::string look_at(std::string_view changed = {}, std::string_view value = {}, std::string_view extra = {}) {
  const std::pair<std::string_view, std::string_view> fields[] = {{"eye", "[0, 0, 5]"}, {"target", "[0, 0, 0]"},
                                                                  {"up", "[0, 1, 0]"},  {"fovy", "45"},
                                                                  {"near", "0.1"},      {"far", "100"}};
  std::string text = "{\n";
  bool first = true;
  for (const auto& [key, standard] : fields) {
    if (key == changed && value.empty()) continue;
    text += (first ? "" : ",\n") + ("\"" + std::string(key) + "\": ") + std::string(key == changed ? value : standard);
    first = false;
  }
  return text + std::string(extra) + "\n}\n";
}

TEST(Camera, ReadsBothForms) {
  const Camera camera = parse_camera(look_at("fovy", "60.5"), "c");
  EXPECT_FALSE(camera.matrix);
  EXPECT_EQ(camera.eye, (Vec3{0, 0, 5}));
  EXPECT_EQ(camera.up, (Vec3{0, 1, 0}));
  EXPECT_EQ(camera.fovy, 60.5);
  EXPECT_EQ(camera.near, 0.1);
  EXPECT_EQ(camera.far, 100);
  const Camera matrix = parse_camera(R"({"matrix": [1,2,3,4, 5,6,7,8, 9,10,11,12, 13,14,15,-1.6e1]})", "c");
  ASSERT_TRUE(matrix.matrix);
  EXPECT_EQ((*matrix.matrix)[3], 4);
  EXPECT_EQ((*matrix.matrix)[15], -16);
}

TEST(Camera, NamesFileLineAndField) {
  struct Bad {
    const char* field;
    const char* value;
    int line;
    std::initializer_list<std::string_view> fragments;
  };
  const Bad cases[] = {
      {"eye", "5", 2, {"\"eye\"", "a JSON number", "array of 3"}},
      {"eye", "[1, 2]", 2, {"\"eye\"", "2 elements"}},
      {"target", "[1, \"x\", 2]", 3, {"\"target\"", "a JSON string"}},
      {"target", "[0, 0, 5]", 3, {"\"target\" equals \"eye\""}},
      {"up", "[0, 0, 0]", 4, {"\"up\" is zero"}},
      {"up", "[0, 0, -3]", 4, {"\"up\" is parallel"}},
      {"up", "[0, 1e-12, 1]", 4, {"\"up\" is parallel"}},
      {"up", "[null, 0, 1]", 4, {"\"up\"", "a JSON null"}},
      {"fovy", "0", 5, {"\"fovy\" is 0", "between 0 and 180"}},
      {"fovy", "180", 5, {"\"fovy\" is 180"}},
      {"fovy", "-45", 5, {"\"fovy\" is -45"}},
      {"fovy", "true", 5, {"\"fovy\"", "a JSON boolean"}},
      {"fovy", "1e999", 5, {"1e999", "outside the range"}},
      {"near", "0", 6, {"\"near\" is 0", "above 0"}},
      {"near", "-1", 6, {"\"near\" is -1"}},
      {"far", "0.1", 7, {"\"far\" is 0.1", "\"near\""}},
      {"far", "1e30", 7, {"\"far\"", "2^80"}},
      {"far", "NaN", 7, {"JSON", "syntax error"}},
      {"far", "", 0, {"\"far\" is missing"}},
      {"eye", "", 0, {"\"eye\" is missing"}},
  };
  for (const Bad& bad : cases) {
    SCOPED_TRACE(std::string(bad.field) + " " + bad.value);
    const std::string place = bad.line == 0 ? "c.json" : "c.json:" + std::to_string(bad.line);
    expect_input_error([&] { parse_camera(look_at(bad.field, bad.value), "c.json"); }, place, bad.fragments);
  }
}

TEST(Camera, RefusesUnknownRepeatedAndConflictingFields) {
  expect_input_error([] { parse_camera(look_at("", "", ",\n\"zoom\": 2"), "c.json"); }, "c.json:8",
                     {"\"zoom\" is unknown", "\"fovy\""});
  expect_input_error([] { parse_camera(look_at("", "", ",\n\"far\": 2"), "c.json"); }, "c.json:7",
                     {"\"far\" is given twice"});
  expect_input_error([] { parse_camera(look_at("", "", ",\n\"matrix\": [1]"), "c.json"); }, "c.json:2",
                     {"conflicts with \"matrix\""});
  expect_input_error([] { parse_camera(R"({"matrix": [1,2,3]})", "c.json"); }, "c.json:1",
                     {"\"matrix\" has 3 elements", "16 numbers"});
  expect_input_error([] { parse_camera("{}", "c.json"); }, "c.json", {"\"eye\" is missing", "\"matrix\""});
  expect_input_error([] { parse_camera("[1]", "c.json"); }, "c.json:1", {"JSON array", "an object"});
}

TEST(Camera, NamesTheLineOfSyntaxErrors) {
  expect_input_error([] { parse_camera("{\n\"eye\": [1 2]}", "c.json"); }, "c.json:2", {"JSON", "syntax error"});
  expect_input_error([] { parse_camera("", "c.json"); }, "c.json:1", {"JSON"});
  expect_input_error([] { parse_camera("{\n\n", "c.json"); }, "c.json:3", {"JSON"});
  expect_input_error([] { parse_camera("{\"eye\": \"\xff\"}", "c.json"); }, "c.json:1", {"JSON"});
}

TEST(Camera, TextGivesTheSameCameraBack) {
  Camera camera;
  camera.eye = {1.0 / 3, -5e-324, 1e23};
  camera.target = {0.1, -0.0, 7};
  camera.up = {0, -1, 0x1.fffffffffffffp-3};
  camera.fovy = 35.000000000000007, camera.near = 1e-9, camera.far = 0x1p79;
  const Camera back = parse_camera(camera_text(camera), "c");
  EXPECT_FALSE(back.matrix);
  EXPECT_EQ(back.eye, camera.eye);
  EXPECT_EQ(back.target, camera.target);
  EXPECT_EQ(back.up, camera.up);
  EXPECT_EQ(std::tuple(back.fovy, back.near, back.far), std::tuple(camera.fovy, camera.near, camera.far));
  camera.matrix = Matrix4{1.0 / 3, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, -1e-20};
  EXPECT_EQ(parse_camera(camera_text(camera), "c").matrix, camera.matrix);
}

TEST(Camera, DeepNestingIsRefused) {
  const std::string deep = "{\"eye\": " + std::string(1'000'000, '[');
  for (const std::string& text : {deep, deep + std::string(1'000'000, ']') + "}"})
    expect_input_error([&] { parse_camera(text, "file"); }, "file:1", {});
}

TEST_F(InDirectory, CameraFileErrors) {
  expect_input_error([&] { load_camera(path("absent.json")); }, path("absent.json"), {"No such file", "camera"});
  EXPECT_EQ(load_camera(write("good.json", look_at())).fovy, 45);
}

}  // namespace
}  // namespace quadrille::golden
