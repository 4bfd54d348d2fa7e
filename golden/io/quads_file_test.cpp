#include "golden/io/quads_file.hpp"

#include "golden/io/test_support.hpp"

#include <cmath>
#include <limits>
#include <random>

namespace quadrille::golden {
namespace {

const std::string good = "0 0 0 1  8 0 0 1  8 8 0 1  0 8 0 1  0 1 2 3";

std::vector<WindowQuad> random_quads(std::size_t count, std::size_t attributes) {
  std::mt19937_64 random(7);
  const auto number = [&] {
    const int exponent = static_cast<int>(random() % 70) - 63;
    return std::ldexp(static_cast<double>(static_cast<std::int64_t>(random())), exponent);
  };
  std::vector<WindowQuad> quads(count);
  for (std::size_t i = 0; i < count; ++i) {
    quads[i].id = static_cast<std::uint32_t>(i);
    for (std::size_t v = 0; v < 4; ++v) {
      quads[i].vertex[v] = {number(), number(), number(), number()};
      for (std::size_t j = 0; j < attributes; ++j) quads[i].attribute[v].push_back(number());
    }
  }
  quads[0].vertex[0] = {0, 0, 0, -0x1p-1074};
  return quads;
}

void expect_equal(const std::vector<WindowQuad>& a, const std::vector<WindowQuad>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].id, b[i].id);
    EXPECT_EQ(a[i].attribute, b[i].attribute);
    for (std::size_t v = 0; v < 4; ++v) {
      EXPECT_EQ(a[i].vertex[v].x, b[i].vertex[v].x);
      EXPECT_EQ(a[i].vertex[v].y, b[i].vertex[v].y);
      EXPECT_EQ(a[i].vertex[v].z, b[i].vertex[v].z);
      EXPECT_EQ(a[i].vertex[v].w, b[i].vertex[v].w);
    }
  }
}

TEST_F(InDirectory, QuadsRoundTripExactly) {
  for (const std::size_t attributes : {0u, 1u, 4u, 8u}) {
    const std::vector<WindowQuad> quads = random_quads(200, attributes);
    const std::string file = path("q" + std::to_string(attributes));
    save_quads(file, quads);
    expect_equal(load_quads(file), quads);
    const std::string bytes = read(file);
    save_quads(file, quads);
    EXPECT_EQ(read(file), bytes);
  }
}

TEST_F(InDirectory, NamesOfAttributesRoundTrip) {
  std::vector<std::string> names{"old"};
  parse_quads(good + "\n# attributes: u\n", "q", &names);  // after the first quad it is a comment
  EXPECT_TRUE(names.empty());
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    parse_quads("# head" + end + end + " #  attributes:  height_m # metres" + end + good, "q", &names);
    EXPECT_EQ(names, std::vector<std::string>{"height_m"});
  }
  const std::vector<WindowQuad> quads = random_quads(3, 5);
  const std::vector<std::string> given{"u", "v", "nx", "ny", "nz"};
  save_quads(path("n.quads"), quads, given);
  expect_equal(load_quads(path("n.quads"), &names), quads);
  EXPECT_EQ(names, given);
  const std::string kept = read(path("n.quads"));
  expect_input_error([&] { save_quads(path("n.quads"), quads, std::span(given).first(4)); }, path("n.quads"),
                     {"4 names for 5 attributes"});
  EXPECT_EQ(read(path("n.quads")), kept);
}

TEST(Quads, BadNamesOfAttributes) {
  for (const auto& [given, problem] : {std::pair{"u v", "2 names for 1 attributes"},
                                       {"", "0 names for 1 attributes"},
                                       {"l0", "the name \"l0\""},
                                       {"2u", "the name \"2u\""},
                                       {"u,v", "the name \"u,v\""},
                                       {"u_code", "the name \"u_code\""}})
    expect_input_error([&, names = given] { parse_quads("\n# attributes: " + std::string(names) + "\n" + good, "q"); },
                       "q:2", {problem});
  expect_input_error([&] { parse_quads("# attributes: u u\n" + good + " 4 5 6 7\n", "q"); }, "q:1",
                     {"the name \"u\"", "no name twice"});
}

TEST(Quads, ReadsCommentsAndNumbersDataLines) {
  const auto quads = parse_quads("# head\n\n" + good + " # tail\r\n  # between\n" + good + "#\n", "q");
  ASSERT_EQ(quads.size(), 2u);
  EXPECT_EQ(quads[0].id, 0u);
  EXPECT_EQ(quads[1].id, 1u);
  EXPECT_EQ(quads[1].vertex[2].x, 8);
  EXPECT_EQ(quads[1].attribute[3], std::vector<double>{3});
}

TEST(Quads, NamesThePlaceOfEachError) {
  struct Bad {
    std::string line;
    std::initializer_list<std::string_view> fragments;
  };
  const Bad cases[] = {
      {"1 2 3", {"3 fields", "column 5", "16 numbers"}},
      {good + " 4", {"21 fields", "16 numbers"}},
      {good + " 4 5 6 7", {"24 fields", "line 2 has 20"}},
      {"0 0 0 1  8 0 0 1  8 8 0 1  0 8 0 1", {"16 fields", "line 2 has 20"}},
      {"0 0 0 1  8 x 0 1  8 8 0 1  0 8 0 1  0 1 2 3", {"field 6 (v1.y) in column 12 is \"x\"", "not a number"}},
      {"0 0 0 1  8 0 0 1  8 8 nan 1  0 8 0 1  0 1 2 3", {"field 11 (v2.z)", "\"nan\"", "not finite"}},
      {"0 0 0 1  8 0 0 1  8 8 0 inf  0 8 0 1  0 1 2 3", {"field 12 (v2.w)", "\"inf\"", "not finite"}},
      {"0 0 0 1  8 0 0 1  8 8 0 1  0 8 0 1  0 1 -nan 3", {"field 19 (v2.a0)", "\"-nan\""}},
      {"0 0 0 1  1e25 0 0 1  8 8 0 1  0 8 0 1  0 1 2 3", {"field 5 (v1.x)", "\"1e25\"", "2^80"}},
      {"0 0 0 1  8 0 0 1  8 8 0 1  0 8 0 1  0 1 2 1e400", {"field 20 (v3.a0)", "\"1e400\"", "range of a double"}},
      {"0 0 0 1  8 0 0 1  8 8 0 1  0 -0 5 0  0 1 2 3", {"field 13 (v3.x)", "vertex v3", "all 0"}},
      {"0,0,0,1  8 0 0 1  8 8 0 1  0 8 0 1  0 1 2 3 4 5 6", {"field 1 (v0.x)", "\"0,0,0,1\""}},
  };
  for (const Bad& bad : cases) {
    SCOPED_TRACE(bad.line);
    expect_input_error([&] { parse_quads("# head\n" + good + "\n" + bad.line + "\n", "d/q.quads"); }, "d/q.quads:3",
                       bad.fragments);
  }
  std::string many = good;
  for (int i = 0; i < 32; ++i) many += " 1";
  expect_input_error([&] { parse_quads(many, "q"); }, "q:1", {"9 attributes", "at most 8"});
}

TEST_F(InDirectory, QuadsFileErrors) {
  expect_input_error([&] { load_quads(path("absent")); }, path("absent"), {"No such file", ".quads"});
  const std::string empty = write("empty", "# nothing\n\n");
  expect_input_error([&] { load_quads(empty); }, empty, {"no quad"});
}

TEST_F(InDirectory, SaveRefusesWhatLoadWould) {
  const std::string file = write("old", "old");
  std::vector<WindowQuad> quads = random_quads(3, 1);
  expect_input_error([&] { save_quads(file, {}); }, file, {"no quad"});
  quads[1].vertex[2].y = std::numeric_limits<double>::quiet_NaN();
  expect_input_error([&] { save_quads(file, quads); }, file, {"quad 1", "nan"});
  quads[1].vertex[2] = {0, 0, 1, 0};
  expect_input_error([&] { save_quads(file, quads); }, file, {"quad 1", "v2", "no point"});
  quads[1].vertex[2] = {0, 0, 1, 1};
  quads[2].attribute[3].push_back(1);
  expect_input_error([&] { save_quads(file, quads); }, file, {"quad 2", "2 attributes", "v3"});
  EXPECT_EQ(read(file), "old");
}

}  // namespace
}  // namespace quadrille::golden
