#include "golden/io/fragment_csv.hpp"

#include "golden/io/test_support.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>
#include <sstream>
#include <vector>

namespace quadrille::golden {
namespace {

class FragmentCsvTest : public InDirectory {};

TEST_F(FragmentCsvTest, WritesSortedRowsWithStatedColumns) {
  FragmentRow row;
  row.quad = 7;
  row.x = 3;
  row.y = 2;
  row.front = true;
  row.flags = 17;
  row.lambda = {0.1, -0.0, 0.5, 1e-20};
  row.z = 0.25;
  row.attribute = {1, 2.5};
  FragmentRow above = row;
  above.y = 1;
  above.x = 900;
  above.front = false;
  FragmentRow earlier = row;
  earlier.quad = 6;
  earlier.y = 9;
  FragmentRow left = row;
  left.x = 2;
  const std::vector<FragmentRow> rows{row, above, earlier, left};

  save_fragment_csv(path("a"), rows, {.attributes = {"u", "v"}, .depth = true});
  const std::string reals = "0.10000000000000001,-0,0.5,9.9999999999999995e-21,0.25,1,2.5\n";
  EXPECT_EQ(read(path("a")), "quad,x,y,front,flags,l0,l1,l2,l3,z,u,v\n6,3,9,1,17," + reals + "7,900,1,0,17," + reals +
                                 "7,2,2,1,17," + reals + "7,3,2,1,17," + reals);
  save_fragment_csv(path("b"), std::span(rows).first(1), {.attributes = {}, .depth = false});
  EXPECT_EQ(read(path("b")),
            "quad,x,y,front,flags,l0,l1,l2,l3,z\n7,3,2,1,17,0.10000000000000001,-0,0.5,9.9999999999999995e-21,\n");
  save_fragment_csv(path("c"), {}, {.attributes = {"a0"}, .depth = true});
  EXPECT_EQ(read(path("c")), "quad,x,y,front,flags,l0,l1,l2,l3,z,a0\n");
}

TEST_F(FragmentCsvTest, RealsAreThoseOfPrintfAndReadBack) {
  std::mt19937_64 random(2);
  std::vector<FragmentRow> rows(2000);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].quad = static_cast<std::uint32_t>(i);
    rows[i].flags = 0xffffffff;
    rows[i].x = rows[i].y = 0xffff;
    const auto number = [&] {
      const int exponent = static_cast<int>(random() % 2000) - 1063;
      return std::ldexp(static_cast<double>(static_cast<std::int64_t>(random())), exponent);
    };
    for (double& value : rows[i].lambda) value = number();
    rows[i].z = number();
    for (double& value : rows[i].attribute) value = number();
  }
  rows[0].attribute[0] = std::numeric_limits<double>::max();
  rows[0].attribute[1] = -0x1p-1074;
  save_fragment_csv(path("a"), rows, {.attributes = std::vector<std::string>(max_attribute_slots, "a"), .depth = true});
  std::istringstream in(read(path("a")));
  std::string line, field;
  std::getline(in, line);
  for (const FragmentRow& row : rows) {
    ASSERT_TRUE(std::getline(in, line));
    std::istringstream fields(line);
    for (int skip = 0; skip < 5; ++skip) std::getline(fields, field, ',');
    std::vector<double> expected(row.lambda.begin(), row.lambda.end());
    expected.push_back(row.z);
    expected.insert(expected.end(), row.attribute.begin(), row.attribute.end());
    for (const double value : expected) {
      ASSERT_TRUE(std::getline(fields, field, ','));
      char text[40];
      std::snprintf(text, sizeof text, "%.17g", value);
      EXPECT_EQ(field, text);
      EXPECT_EQ(std::strtod(field.c_str(), nullptr), value);
    }
  }
}

TEST_F(FragmentCsvTest, NotANumberHasOneSpelling) {
  FragmentRow row;
  row.lambda = {std::nan(""), -std::nan(""), std::numeric_limits<double>::infinity(), 0};
  save_fragment_csv(path("a"), {&row, 1}, {.attributes = {}, .depth = true});
  EXPECT_NE(read(path("a")).find(",,inf,0,0\n"), std::string::npos);
}

TEST_F(FragmentCsvTest, TheSameAsArrays) {
  std::vector<FragmentRow> rows(3);
  rows[0] = {7, 3, 2, true, 257, {1, 2, 3, 4}, 0.5, {0.25, -1}};
  rows[1] = {7, 2, 2, false, 0, {5, 6, 7, 8}, 1, {0.75, 2}};
  rows[2].quad = 6;
  save_fragment_npz(path("a.npz"), rows, {.attributes = {"u", "v"}, .depth = true});
  const std::string bytes = read(path("a.npz"));
  // Each array as .npy has it: type, shape, then values in the order of quad, y, x.
  const auto holds = [&](const std::string& name, const std::string& type, const auto& values) {
    const std::size_t at = bytes.find(name + ".npy\x93NUMPY");
    ASSERT_NE(at, std::string::npos) << name;
    const std::size_t header = at + name.size() + 4 + 10;
    EXPECT_EQ(bytes.substr(header, 80).find("{'descr': '" + type + "', 'fortran_order': False, 'shape': (3,), }"), 0u);
    const std::size_t data = bytes.find('\n', header) + 1;
    EXPECT_EQ(bytes.substr(data, sizeof values), std::string(reinterpret_cast<const char*>(&values), sizeof values))
        << name;
  };
  holds("quad", "<u4", std::array<std::uint32_t, 3>{6, 7, 7});
  holds("x", "<u2", std::array<std::uint16_t, 3>{0, 2, 3});
  holds("front", "|b1", std::array<char, 3>{0, 0, 1});
  holds("flags", "<u4", std::array<std::uint32_t, 3>{0, 0, 257});
  holds("l3", "<f8", std::array<double, 3>{0, 8, 4});
  holds("z", "<f8", std::array<double, 3>{0, 1, 0.5});
  holds("v", "<f8", std::array<double, 3>{0, 2, -1});
  save_fragment_npz(path("b.npz"), rows, {.attributes = {}, .depth = false});
  EXPECT_EQ(read(path("b.npz")).find("z.npy"), std::string::npos);
  expect_input_error([&] { save_fragment_npz(path("no/a"), rows, {}); }, path("no/a"), {"No such file"});
}

TEST_F(FragmentCsvTest, FailedWritesLeaveTheOldFile) {
  const std::vector<FragmentRow> rows(10000);
  const FragmentColumns columns{.attributes = {"a", "b", "c", "d"}, .depth = true};
  expect_input_error([&] { save_fragment_csv(path("no/a"), rows, columns); }, path("no/a"), {"No such file"});
  if (std::filesystem::is_character_file("/dev/full")) {
    expect_input_error([&] { save_fragment_csv("/dev/full", rows, columns); }, "/dev/full", {"No space left"});
  }
  ::testing::internal::CaptureStdout();
  save_fragment_csv("-", std::span(rows).first(1), {.attributes = {}, .depth = false});
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "quad,x,y,front,flags,l0,l1,l2,l3,z\n0,0,0,0,0,0,0,0,0,\n");
  EXPECT_EQ(entries(), 0u);
}

}  // namespace
}  // namespace quadrille::golden
