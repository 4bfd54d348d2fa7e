// Axes as text, and the points that they span.
#include "tb/sweep/grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace quadrille::sweep {
namespace {

using Values = std::vector<int>;

std::string refusal(const auto& action) {
  try {
    action();
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

std::string refusal_of(const std::string& text) {
  return refusal([&] { parse_axis(text); });
}

Config with(std::initializer_list<std::pair<const char*, int>> values) {
  Config c;
  for (const auto& [key, value] : values) c.set(key, value);
  return c;
}

TEST(ParseAxis, ListsAndRanges) {
  EXPECT_EQ(parse_axis("significand_bits=18").key, "significand_bits");
  EXPECT_EQ(parse_axis("significand_bits=18").values, Values{18});
  EXPECT_EQ(parse_axis("significand_bits=26,8,12").values, (Values{26, 8, 12}));
  EXPECT_EQ(parse_axis("significand_bits=10:13").values, (Values{10, 11, 12, 13}));
  EXPECT_EQ(parse_axis("significand_bits=10:15:2").values, (Values{10, 12, 14}));
  EXPECT_EQ(parse_axis("significand_bits=10:16:3,26").values, (Values{10, 13, 16, 26}));
  EXPECT_EQ(parse_axis("significand_bits=16:10:-3").values, (Values{16, 13, 10}));
  EXPECT_EQ(parse_axis("significand_bits=9:9,10:10:-1").values, (Values{9, 10}));
  EXPECT_EQ(parse_axis("significand_bits=8:26:99999999999").values, Values{8});
  EXPECT_EQ(parse_axis("significand_bits=26:8:-9223372036854775808").values, Values{26});
  EXPECT_EQ(parse_axis("significand_bits=8:8:-99999999999999999999").values, Values{8});
  EXPECT_EQ(parse_axis("quadratic_frac_bits=auto").values, Values{-1});
  EXPECT_EQ(parse_axis("quadratic_frac_bits=4:0:-2,auto,36").values, (Values{4, 2, 0, -1, 36}));
  EXPECT_EQ(parse_axis("quadratic_frac_bits=-1").values, Values{-1});
  EXPECT_EQ(parse_axis("notch_exact=true,false").values, (Values{1, 0}));
  EXPECT_EQ(parse_axis("notch_exact=0,true").values, (Values{0, 1}));
}

TEST(ParseAxis, EveryKeyCanBeAnAxis) {
  for (const ConfigKey& key : Config::keys()) {
    const std::string name(key.name);
    const Axis axis = parse_axis(name + "=" + std::to_string(key.minimum) + ":" + std::to_string(key.maximum));
    EXPECT_EQ(axis.values.size(), static_cast<std::size_t>(key.maximum - key.minimum + 1)) << name;
    EXPECT_EQ(axis.values.front(), key.minimum);
    EXPECT_EQ(axis.values.back(), key.maximum);
    EXPECT_EQ(refusal_of(name + "=auto").empty(), key.standard == -1) << name;

    const Grid grid(Config(), {axis}, Grid::Kind::full);
    for (std::uint64_t row = 0; row < grid.size(); ++row)
      EXPECT_EQ(grid.point(row).config.get(name), key.minimum + static_cast<int>(row));
  }
}

TEST(ParseAxis, RefusalsNameTheTextAndTheRule) {
  struct Case {
    const char *text, *part;
  };
  for (const auto& [text, part] : {
           Case{"significand_bits", "expected KEY=VALUES"},
           Case{"=8:26", "expected KEY=VALUES"},
           Case{"significant_bits=8:26", "did you mean \"significand_bits\""},
           Case{"significand_bits=", "'' is not a whole number"},
           Case{"significand_bits=8,,9", "'' is not a whole number"},
           Case{"significand_bits=8:", "'' is not a whole number"},
           Case{"significand_bits=ten", "'ten' is not a whole number"},
           Case{"significand_bits=8.5", "'8.5' is not a whole number"},
           Case{"significand_bits=12 ", "'12 ' is not a whole number"},
           Case{"significand_bits=8:12x", "'12x' is not a whole number"},
           Case{"significand_bits=8:12:x", "'x' is not a whole number"},
           Case{"significand_bits=99999999999999999999x", "'99999999999999999999x' is not a whole number"},
           Case{"significand_bits=true", "'true' is not a whole number"},
           Case{"significand_bits=auto", "'auto' is not a whole number"},
           Case{"quadratic_frac_bits=auto:4", "'auto' is not a whole number"},
           Case{"significand_bits=8:12:2:1", "'8:12:2:1' is not FIRST:LAST"},
           Case{"significand_bits=27", "27 is outside 8..26"},
           Case{"significand_bits=-1", "-1 is outside 8..26"},
           Case{"significand_bits=8:27:2", "27 is outside 8..26"},
           Case{"significand_bits=7:20", "7 is outside 8..26"},
           Case{"significand_bits=8:4000000000000000000", "4000000000000000000 is outside 8..26"},
           Case{"significand_bits=-99999999999999999999:26", "-99999999999999999999 is outside 8..26"},
           Case{"quadratic_frac_bits=37", "37 is outside 0..36 (or auto)"},
           Case{"quadratic_frac_bits=-1:4", "-1 is outside 0..36 (or auto)"},
           Case{"significand_bits=12:10", "the range '12:10' is empty"},
           Case{"significand_bits=10:12:-1", "the range '10:12:-1' is empty"},
           Case{"significand_bits=10:12:0", "the step of '10:12:0' is 0"},
           Case{"significand_bits=10:10:0", "the step of '10:10:0' is 0"},
           Case{"significand_bits=10:20:2,14", "14 is given twice"},
           Case{"quadratic_frac_bits=auto,-1", "auto is given twice"},
           Case{"notch_exact=1,true", "1 is given twice"},
       }) {
    const std::string message = refusal_of(text);
    EXPECT_TRUE(message.starts_with("axis '" + std::string(text) + "': ")) << text << ": " << message;
    EXPECT_NE(message.find(part), std::string::npos) << text << ": " << message;
  }
}

TEST(Resolved, ReplacesAuto) {
  const Config c = resolved(Config());
  EXPECT_EQ(c.quadratic_frac_bits, 30);  // 2·(8 + 7)
  EXPECT_EQ(c.sqrt_segments_log2, 5);    // ceil(14 / 3)
  EXPECT_EQ(c.recip_segments_log2, 6);   // ceil(16 / 3)
  EXPECT_EQ(c.attribute_frac_bits, 24);  // from S = 23 on S + 2
  EXPECT_EQ(resolved(with({{"significand_bits", 23}})).attribute_frac_bits, 25);
  EXPECT_EQ(c.significand_bits, 18);
  EXPECT_EQ(resolved(c), c);
  EXPECT_EQ(resolved(with({{"quadratic_frac_bits", 30}})), c);
  EXPECT_NE(resolved(with({{"quadratic_frac_bits", 29}})), c);
  EXPECT_NE(resolved(with({{"quad_id_bits", 23}})), c);
}

TEST(Grid, FullHasEveryCombinationWithTheLastAxisFastest) {
  const Config base = with({{"depth_bits", 16}});
  const Grid grid(base, {{"significand_bits", {10, 12}}, {"notch_exact", {1, 0}}, {"align_guard_bits", {0, 3, 6}}},
                  Grid::Kind::full);
  EXPECT_EQ(grid.kind(), Grid::Kind::full);
  EXPECT_EQ(grid.base(), base);
  EXPECT_EQ(grid.axes().size(), 3u);
  ASSERT_EQ(grid.size(), 12u);
  std::uint64_t row = 0;
  for (const int s : {10, 12}) {
    for (const int notch : {1, 0}) {
      for (const int guard : {0, 3, 6}) {
        const GridPoint p = grid.point(row++);
        EXPECT_EQ(
            p.config,
            with({{"depth_bits", 16}, {"significand_bits", s}, {"notch_exact", notch}, {"align_guard_bits", guard}}));
        EXPECT_EQ(p.refused, "");
      }
    }
  }
  EXPECT_THROW(grid.point(12), std::out_of_range);
  EXPECT_THROW(grid.point(std::numeric_limits<std::uint64_t>::max()), std::out_of_range);
}

TEST(Grid, OneAtATimeLeavesOutWhatBuildsTheSameMachine) {
  const Grid grid(Config(),
                  {{"significand_bits", {17, 18, 19}}, {"quadratic_frac_bits", {-1, 8, 30}}, {"notch_exact", {1}}},
                  Grid::Kind::one_at_a_time);
  const std::vector<Config> expected{Config(), with({{"significand_bits", 17}}), with({{"significand_bits", 19}}),
                                     with({{"quadratic_frac_bits", 8}})};
  ASSERT_EQ(grid.size(), expected.size());
  for (std::size_t row = 0; row < expected.size(); ++row) EXPECT_EQ(grid.point(row).config, expected[row]) << row;
  EXPECT_THROW(grid.point(expected.size()), std::out_of_range);

  // Not the base, but each other.
  const Config base = with({{"quadratic_frac_bits", 12}});
  const Grid twins(base, {{"quadratic_frac_bits", {30, -1, 12}}}, Grid::Kind::one_at_a_time);
  ASSERT_EQ(twins.size(), 2u);
  EXPECT_EQ(twins.point(1).config.quadratic_frac_bits, 30);
}

TEST(Grid, RefusedPointsCarryTheRule) {
  const Grid grid(Config(), {{"viewport_bits", {12, 14}}, {"guard_bits", {1, 3, 4}}}, Grid::Kind::full);
  for (std::uint64_t row = 0; row < grid.size(); ++row) {
    const GridPoint p = grid.point(row);
    EXPECT_EQ(p.refused, refusal([&] { p.config.validate(); }));
    // 2·(viewport + guard + 15) + 3 (or 4) <= 64: 12 + 3 at most, or 14 + 1.
    const bool fits = p.config.viewport_bits + p.config.guard_bits <= 15;
    EXPECT_EQ(p.refused.empty(), fits) << row;
    if (!fits) {
      EXPECT_NE(p.refused.find("VAL_BITS"), std::string::npos) << p.refused;
    }
  }
}

TEST(Grid, SizeSaturates) {
  std::vector<Axis> axes;
  std::uint64_t expected = 1;
  for (const ConfigKey& key : Config::keys()) {
    const int value = key.standard == -1 ? key.maximum : key.standard;
    axes.push_back({std::string(key.name), Values(1000, value)});
    expected = axes.size() <= 6 ? expected * 1000 : std::numeric_limits<std::uint64_t>::max();  // 10^18 < 2^64 < 10^21
    const Grid grid(Config(), axes, Grid::Kind::full);
    EXPECT_EQ(grid.size(), expected) << axes.size();
    EXPECT_NO_THROW(grid.point(grid.size() - 1));
  }
}

TEST(Grid, RefusesWhatIsNoGrid) {
  const auto refused = [](std::vector<Axis> axes) { return refusal([&] { Grid(Config(), axes, Grid::Kind::full); }); };
  EXPECT_NE(refused({}).find("needs an axis"), std::string::npos);
  EXPECT_NE(refused({{"depth_bits", {8}}, {"tile_log2", {2}}, {"depth_bits", {9}}}).find("'depth_bits' is given twice"),
            std::string::npos);
  EXPECT_NE(refused({{"depth_bits", {}}}).find("'depth_bits' has no values"), std::string::npos);
  EXPECT_NE(refused({{"dept_bits", {8}}}).find("did you mean \"depth_bits\""), std::string::npos);
  EXPECT_NE(refused({{"depth_bits", {31}}}).find("outside 8..30"), std::string::npos);
}

TEST(DefaultAxes, ShowEveryKeyThatHasAChoiceInTheOrderOfTheKeys) {
  const std::vector<Axis> axes = default_axes();
  std::vector<std::string> expected;
  for (const ConfigKey& key : Config::keys()) {
    if (key.minimum < key.maximum) expected.emplace_back(key.name);
  }
  std::vector<std::string> keys;
  for (const Axis& axis : axes) keys.push_back(axis.key);
  EXPECT_EQ(keys, expected);

  const Grid grid(Config(), axes, Grid::Kind::one_at_a_time);
  std::set<std::string> moved;
  for (std::uint64_t row = 0; row < grid.size(); ++row) {
    const GridPoint p = grid.point(row);
    EXPECT_EQ(p.refused, "") << row;
    int differences = 0;
    for (const ConfigKey& key : Config::keys()) {
      if (p.config.get(key.name) == Config().get(key.name)) continue;
      ++differences;
      moved.insert(std::string(key.name));
    }
    EXPECT_EQ(differences, row == 0 ? 0 : 1) << row;
  }
  EXPECT_EQ(moved, std::set(expected.begin(), expected.end()));

  const auto values = [&](const char* key) { return std::ranges::find(axes, key, &Axis::key)->values; };
  EXPECT_EQ(values("significand_bits").size(), 19u);
  EXPECT_EQ(values("subpixel_bits"), (Values{2, 3, 4, 5, 6, 7, 8}));
  EXPECT_EQ(values("align_guard_bits"), (Values{0, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(values("notch_exact"), (Values{0, 1}));
}

TEST(ThousandPointAxes, AreAThousandDifferentMachines) {
  const Grid grid(Config(), thousand_point_axes(), Grid::Kind::full);
  ASSERT_EQ(grid.size(), 1000u);
  std::set<std::vector<int>> machines;
  bool exact = false;
  for (std::uint64_t row = 0; row < grid.size(); ++row) {
    const GridPoint p = grid.point(row);
    EXPECT_EQ(p.refused, "") << row;
    std::vector<int> values;
    for (const ConfigKey& key : Config::keys()) values.push_back(resolved(p.config).get(key.name));
    machines.insert(values);
    exact |= p.config.qdrop() == 0;
  }
  EXPECT_EQ(machines.size(), 1000u);
  EXPECT_TRUE(exact) << "D and r² in full are among them";
}

}  // namespace
}  // namespace quadrille::sweep
