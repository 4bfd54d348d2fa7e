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

  save_fragment_csv(path("a"), rows, {.attributes = 2, .depth = true});
  const std::string reals = "0.10000000000000001,-0,0.5,9.9999999999999995e-21,0.25,1,2.5\n";
  EXPECT_EQ(read(path("a")), "quad,x,y,front,flags,l0,l1,l2,l3,z,a0,a1\n6,3,9,1,17," + reals + "7,900,1,0,17," + reals +
                                 "7,2,2,1,17," + reals + "7,3,2,1,17," + reals);
  save_fragment_csv(path("b"), std::span(rows).first(1), {.attributes = 0, .depth = false});
  EXPECT_EQ(read(path("b")),
            "quad,x,y,front,flags,l0,l1,l2,l3,z\n7,3,2,1,17,0.10000000000000001,-0,0.5,9.9999999999999995e-21,\n");
  save_fragment_csv(path("c"), {}, {.attributes = 1, .depth = true});
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
      return std::ldexp(static_cast<double>(static_cast<std::int64_t>(random())),
                        static_cast<int>(random() % 2000) - 1063);
    };
    for (double& value : rows[i].lambda) value = number();
    rows[i].z = number();
    for (double& value : rows[i].attribute) value = number();
  }
  rows[0].attribute[0] = std::numeric_limits<double>::max();
  rows[0].attribute[1] = -std::numeric_limits<double>::denorm_min();
  save_fragment_csv(path("a"), rows, {.attributes = max_attribute_slots, .depth = true});
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
  save_fragment_csv(path("a"), {&row, 1}, {.attributes = 0, .depth = true});
  EXPECT_NE(read(path("a")).find(",,inf,0,0\n"), std::string::npos);
}

TEST_F(FragmentCsvTest, FailedWritesLeaveTheOldFile) {
  const std::vector<FragmentRow> rows(10000);
  const FragmentColumns columns{.attributes = 4, .depth = true};
  expect_input_error([&] { save_fragment_csv(path("no/a"), rows, columns); }, path("no/a"), {"No such file"});
  if (std::filesystem::is_character_file("/dev/full")) {
    expect_input_error([&] { save_fragment_csv("/dev/full", rows, columns); }, "/dev/full", {"No space left"});
  }
  ::testing::internal::CaptureStdout();
  save_fragment_csv("-", std::span(rows).first(1), {.attributes = 0, .depth = false});
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "quad,x,y,front,flags,l0,l1,l2,l3,z\n0,0,0,0,0,0,0,0,0,\n");
  EXPECT_EQ(entries(), 0u);
}

}  // namespace
}  // namespace quadrille::golden
