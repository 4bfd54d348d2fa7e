#include "tb/sweep/point_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>

namespace quadrille::sweep {
namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells{""};
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    if (c == ',' && !quoted)
      cells.emplace_back();
    else
      cells.back() += c;
  }
  return cells;
}

PointRow example() {
  PointRow row;
  row.row = 3;
  row.config.significand_bits = 12;
  row.result.fragments = 10;
  row.result.cycles = 40;
  for (std::size_t q = 0; q < 4; ++q) row.result.arithmetic[q] = {1, 0.5 + static_cast<double>(q), 0.25, 0.125, 0.0625};
  row.result.snapping[0] = {1, 2, 3, 4, 5};
  row.result.coverage_lost = 17;
  row.result.quads = 8, row.result.plane_quads = 2, row.result.plane_fragments = 3;
  row.worst = "quadrille fragments --pixel 1,2";
  complete_row(row, CostWeights{}, true, true);
  return row;
}

TEST(PointTable, EveryRowHasEveryColumn) {
  PointRow refused;
  refused.row = 4;
  refused.result.refused = "a, \"b\"";
  std::istringstream text(point_table(std::vector{example(), refused}));
  std::vector<std::vector<std::string>> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(split(line));
  ASSERT_EQ(lines.size(), 3u);
  for (const auto& line : lines) EXPECT_EQ(line.size(), point_columns().size());
  const auto cell = [&](std::size_t line, std::string_view name) {
    for (std::size_t i = 0; i < lines[0].size(); ++i)
      if (lines[0][i] == name) return lines[line][i];
    return std::string("no such column");
  };
  EXPECT_EQ(cell(1, "row"), "3");
  EXPECT_EQ(cell(1, "status"), "ok");
  EXPECT_EQ(cell(1, "significand_bits"), "12");
  EXPECT_EQ(cell(1, "attribute_frac_bits"), "24");  // auto
  EXPECT_EQ(cell(1, "arithmetic_lambda_max"), "0.5");
  EXPECT_EQ(cell(1, "arithmetic_colour_max"), "3.5");
  EXPECT_EQ(cell(1, "arithmetic_depth_mean"), "0.0625");
  EXPECT_EQ(cell(1, "snapping_lambda_p999"), "3");
  EXPECT_EQ(cell(1, "snapping_depth_max"), "");  // not measured
  EXPECT_EQ(cell(1, "total_lambda_max"), "2.5");
  EXPECT_EQ(cell(1, "total_depth_max"), "");
  EXPECT_EQ(cell(1, "coverage_lost"), "17");
  EXPECT_EQ(cell(1, "quads"), "8");
  EXPECT_EQ(cell(1, "quads_plane"), "2");
  EXPECT_EQ(cell(1, "plane_share"), "0.25");
  EXPECT_EQ(cell(1, "plane_fragments"), "3");
  EXPECT_EQ(cell(1, "cycles"), "40");
  EXPECT_EQ(cell(1, "fragments_per_clock"), "0.25");
  EXPECT_EQ(cell(1, "worst"), "\"quadrille fragments --pixel 1,2\"");
  EXPECT_EQ(cell(2, "status"), "refused");
  EXPECT_EQ(cell(2, "reason"), "\"a, \"\"b\"\"\"");
  EXPECT_EQ(cell(2, "fragments"), "");
}

/// What is no block is LUTs and flip-flops; the parts add up to the cost.
TEST(PointTable, WhatATargetTakes) {
  const HardwareCost cost{.state_bits = 1000,
                          .multiplier_bits = 500,
                          .adder_bits = 300,
                          .table_bits = 200,
                          .dsps = 7,
                          .join_bits = 60,
                          .memory_bits = 400,
                          .block_rams = 3};
  const CostWeights blocks{
      .state = 0, .multiplier = 0, .adder = 1, .table = 0.5, .dsp = 100, .join = 2, .block_ram = 10};
  const CostWeights logic{.state = 0, .multiplier = 3, .adder = 1, .table = 0.5, .dsp = 0, .join = 0, .block_ram = 10};
  const Resources ecp5 = resources_of(cost, blocks, tb::SynthesisTarget::ecp5),
                  nodsp = resources_of(cost, logic, tb::SynthesisTarget::ecp5_nodsp),
                  cells = resources_of(cost, logic, tb::SynthesisTarget::cells);
  EXPECT_EQ(ecp5.luts, 300 + 100 + 120);
  EXPECT_EQ(ecp5.flip_flops, 600u);
  EXPECT_EQ(ecp5.dsps, 7u);
  EXPECT_EQ(ecp5.block_rams, 3u);
  EXPECT_EQ(scalar_cost(cost, blocks), ecp5.luts + 700 + 30);
  EXPECT_EQ(nodsp.luts, 300 + 100 + 1500);
  EXPECT_EQ(nodsp.dsps, 0u);
  EXPECT_EQ(nodsp.block_rams, 3u);
  EXPECT_EQ(cells.flip_flops, 1000u) << "memories are flip-flops";
  EXPECT_EQ(cells.block_rams, 0u);
}

TEST(PointTable, BoundsWhereTheyHold) {
  const double infinity = std::numeric_limits<double>::infinity();
  const auto finite = [](bool ordinary, bool perspective, double depth_spread) {
    PointRow row;
    row.result.depth_spread = depth_spread;
    complete_row(row, CostWeights{}, ordinary, perspective);
    return std::array{std::isfinite(row.bound_lambda.value), std::isfinite(row.bound_attribute.value),
                      std::isfinite(row.bound_depth.value)};
  };
  EXPECT_EQ(finite(true, true, 0.5), (std::array{true, true, true}));
  EXPECT_EQ(finite(true, false, 0.5), (std::array{true, true, true}));
  EXPECT_EQ(finite(false, true, 0.5), (std::array{true, true, true}));
  EXPECT_EQ(finite(false, true, infinity), (std::array{true, true, false}));
  EXPECT_EQ(finite(false, false, infinity), (std::array{false, false, false}));
}

/// Half a code, and c 2^-(s-3) for each 1 of the spread; proofs round up by 2^-16.
TEST(PointTable, BoundsGrowWithTheSpread) {
  for (const int s : {8, 12, 18, 26}) {
    const auto bounds = [&](double attribute, double depth, bool ordinary = true) {
      PointRow row;
      row.config.significand_bits = s;
      row.result.attribute_spread = attribute;
      row.result.depth_spread = depth;
      complete_row(row, CostWeights{}, ordinary, true);
      EXPECT_TRUE(row.bound_lambda.proved && row.bound_attribute.proved && row.bound_depth.proved);
      return std::array{row.bound_lambda.value, row.bound_attribute.value, row.bound_depth.value};
    };
    const double unit = std::ldexp(1.0, 3 - s), attribute_code = std::ldexp(1.0, -std::max(24, s + 2)),
                 depth_code = 0x1p-24;
    EXPECT_NEAR(bounds(0, 0)[1], attribute_code / 2, attribute_code * 0x1p-16);
    EXPECT_NEAR(bounds(0, 0)[2], depth_code / 2, depth_code * 0x1p-16);
    for (const double spread : {0.25, 3.0}) {
      const auto at = bounds(spread, spread);
      for (const auto& [value, code] : {std::pair{at[1], attribute_code}, {at[2], depth_code}}) {
        const double c = (value - code / 2) / (unit * spread);
        EXPECT_GT(c, 0.5) << s << " " << spread;
        EXPECT_LT(c, 2) << s << " " << spread;
      }
      EXPECT_GT(bounds(spread, spread, false)[2], at[2]) << "W may be cut";
    }
    // The first weight is a value of spread 1.
    EXPECT_GE(bounds(0, 0)[0], bounds(1, 0)[1]);
  }
}

TEST(PointTable, ClocksThatWereNotCounted) {
  PointResult result;
  result.fragments = 10;
  EXPECT_TRUE(std::isnan(fragments_per_clock(result)));
}

TEST(PointTable, QuadsWithAreasForWeights) {
  PointResult result;
  EXPECT_TRUE(std::isnan(plane_share(result)));
  result.quads = 8;
  EXPECT_EQ(plane_share(result), 0);
  result.plane_quads = 5;
  EXPECT_EQ(plane_share(result), 0.625);
}

TEST(PointTable, ErrorColumnsByName) {
  const PointResult result = example().result;
  const auto parse = [](std::string_view name) { return parse_error_column(name); };
  EXPECT_EQ(parse("lambda").name(), "arithmetic_lambda_max");
  EXPECT_EQ(parse("depth").name(), "arithmetic_depth_max");
  EXPECT_EQ(parse("total").name(), "total_lambda_max");
  EXPECT_EQ(parse("snapping").name(), "snapping_lambda_max");
  EXPECT_EQ(ErrorColumn{}.name(), "arithmetic_lambda_max") << "what is judged unless asked";
  EXPECT_EQ(parse("colour").value(result), 3.5);
  EXPECT_EQ(parse("snapping_lambda_rms").value(result), 4);
  EXPECT_EQ(parse("total_lambda_rms").value(result), 4.125);
  EXPECT_TRUE(std::isnan(parse("snapping_colour_max").value(result)));
  EXPECT_TRUE(std::isnan(parse("total_colour_max").value(result))) << "half a total is none";
  std::size_t columns = 0;
  for (const PointColumn& column : point_columns())
    if (column.meaning.find(" absolute ") != std::string::npos) {
      EXPECT_EQ(parse(column.name).name(), column.name);
      ++columns;
    }
  EXPECT_EQ(columns, 48u);
  try {
    parse("arithmetic_lamda_max");
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("\"arithmetic_lambda_max\""), std::string::npos) << error.what();
  }
}

TEST(PointTable, NumbersSurviveTheText) {
  for (const double value : {1.0 / 3, 5e-324, 1e300, 0x1.fffffffffffffp-20})
    EXPECT_EQ(std::strtod(csv_number(value).c_str(), nullptr), value);
  EXPECT_EQ(csv_number(std::nan("")), "");
}

}  // namespace
}  // namespace quadrille::sweep
