#include "tb/studies/compare/table.hpp"

#include <gtest/gtest.h>

namespace quadrille::compare {
namespace {

TEST(Table, CsvHasAFieldAKeyAndQuotesWhatNeedsIt) {
  EXPECT_EQ(table_csv({}), "");
  const std::vector<Row> rows{{{"method", "mvc"}, {"pixels", 12}, {"error", 1.0 / 3}, {"gap", nullptr}},
                              {{"method", "a,\"b\""}, {"pixels", -1}, {"error", 1e-20}, {"gap", 0.0}}};
  EXPECT_EQ(table_csv(rows),
            "method,pixels,error,gap\n"
            "mvc,12,0.333333333,\n"
            "\"a,\"\"b\"\"\",-1,1e-20,0\n");
}

TEST(Table, MarkdownJoinsWhatIsMeasuredAndDashesTheRest) {
  const Row row{
      {"method", "mvc"},          {"covered", 2048},         {"missing", 0},           {"extra", 3},
      {"undefined", 0},           {"truth_wrong", 7},        {"reference_max", 0.012}, {"reference_p999", 0.0},
      {"reference_rms", nullptr}, {"truth_max", nullptr},    {"truth_p999", nullptr},  {"truth_rms", nullptr},
      {"crease02_64", 0.5},       {"crease02_128", nullptr}, {"ns_per_pixel", 12.3456}};
  const std::string text = table_markdown({row, row}, {64, 128}, "refine:20");
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size(); at = text.find('\n', at) + 1)
    lines.push_back(text.substr(at, text.find('\n', at) - at));
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_NE(lines[0].find("| from refine:20: max / p99.9 / RMS |"), std::string::npos);
  EXPECT_NE(lines[0].find("| crease on 0–2 at 64 / 128 px |"), std::string::npos);
  EXPECT_EQ(lines[2], "| mvc | 2048 | 0 / 3 / 0 / 7 | 1.2e-02 / 0 / — | — | 5.0e-01 / — | — | — | — | — | — | 12.3 |");
  EXPECT_EQ(lines[3], lines[2]);
  // As many columns in every line.
  for (const std::string& line : lines)
    EXPECT_EQ(std::ranges::count(line, '|'), std::ranges::count(lines[0], '|')) << line;
}

}  // namespace
}  // namespace quadrille::compare
