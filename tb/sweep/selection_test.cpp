#include "tb/sweep/selection.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace quadrille::sweep {
namespace {

std::vector<std::size_t> rows_of(const std::vector<Selected>& selected) {
  std::vector<std::size_t> rows;
  for (const Selected& s : selected) rows.push_back(s.row);
  return rows;
}

class SelectionTest : public testing::Test {
 protected:
  SelectionTest() : rows(12) { std::iota(rows.begin(), rows.end(), std::size_t{0}); }

  Candidates candidates() const { return {grid, rows, front, knees}; }
  std::vector<std::size_t> select(std::string_view text) const { return rows_of(select_points(text, candidates())); }

  // 4 x 3 points, the last axis fastest; the base (18, 2) is row 2 * 3 + 1.
  const Grid grid{
      Config{}, {{"significand_bits", {10, 14, 18, 22}}, {"align_guard_bits", {0, 2, 4}}}, Grid::Kind::full};
  std::vector<std::size_t> rows;
  const std::vector<std::size_t> front{0, 4, 8, 11}, knees{4};
};

TEST_F(SelectionTest, Words) {
  EXPECT_EQ(select("all"), rows);
  EXPECT_EQ(select("none"), std::vector<std::size_t>{});
  EXPECT_EQ(select("pareto"), front);
  EXPECT_EQ(select("corners"), (std::vector<std::size_t>{0, 2, 9, 11}));
  EXPECT_EQ(select("default"), std::vector<std::size_t>{7});
  EXPECT_EQ(select("knees"), knees);
  EXPECT_EQ(select("5"), std::vector<std::size_t>{5});
  EXPECT_EQ(select("9-11,3,3,default"), (std::vector<std::size_t>{3, 7, 9, 10, 11}));
}

TEST_F(SelectionTest, RefusesWhatIsNotThere) {
  for (const char* text : {"", "some", "3-", "12", "4-2", "1,,2", "-1", "1.5", "99999999999999999999"})
    EXPECT_THROW(select(text), ConfigError) << text;
  std::erase(rows, std::size_t{5});  // refused or not evaluated
  EXPECT_THROW(select("4-6"), ConfigError);
  EXPECT_EQ(select("corners"), (std::vector<std::size_t>{0, 2, 9, 11}));
  std::erase(rows, std::size_t{9});
  EXPECT_EQ(select("corners"), (std::vector<std::size_t>{0, 2, 11}));
}

TEST_F(SelectionTest, DefaultHoldsBaseKneesAndCorners) {
  EXPECT_EQ(rows_of(default_selection(candidates())), (std::vector<std::size_t>{0, 2, 4, 7, 9, 11}));
}

TEST_F(SelectionTest, DefaultIsAtMostEight) {
  const std::vector<Axis> axes{{"significand_bits", {10, 18}},
                               {"subpixel_bits", {2, 3}},
                               {"depth_bits", {16, 24}},
                               {"attribute_slots", {2, 3}},
                               {"guard_bits", {2, 3}}};
  const Grid wide{Config{}, axes, Grid::Kind::full};  // 32 corners
  std::vector<std::size_t> all(wide.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const std::vector<Selected> selected = default_selection({wide, all, {}, {}});
  EXPECT_EQ(selected.size(), 8u);
  EXPECT_EQ(selected.front().row, 0u);
  EXPECT_EQ(selected.back().row, 31u);
  EXPECT_TRUE(std::ranges::all_of(selected, [](const Selected& s) { return s.why == "corner"; }));
}

TEST(Selection, CornersOneAtATime) {
  const Grid grid{
      Config{}, {{"significand_bits", {10, 18, 26}}, {"align_guard_bits", {0, 1, 2}}}, Grid::Kind::one_at_a_time};
  // Base; 10, 26; 0, 1 (2 repeats the base).
  EXPECT_EQ(grid.size(), 5u);
  EXPECT_EQ(base_row(grid), 0u);
  EXPECT_EQ(corners(grid), (std::vector<std::size_t>{1, 2, 3}));
}

TEST(Selection, BaseOutsideTheGrid) {
  const Grid grid{Config{}, {{"significand_bits", {10, 12}}}, Grid::Kind::full};
  EXPECT_EQ(base_row(grid), 2u);
}

TEST(Selection, AutoCountsAsItsValue) {
  const Grid grid{Config{}, {{"quadratic_frac_bits", {12, 30}}}, Grid::Kind::full};
  EXPECT_EQ(base_row(grid), 1u);
}

}  // namespace
}  // namespace quadrille::sweep
