// Fronts, knees and rank correlations: by hand, and against the definitions on random lists full of ties.
#include "tb/sweep/pareto.hpp"

#include "model/support/prng.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace quadrille::sweep {
namespace {

using Positions = std::vector<std::size_t>;

constexpr double infinity = std::numeric_limits<double>::infinity();
const double nan = std::numeric_limits<double>::quiet_NaN();

TEST(ParetoFront, ByHand) {
  EXPECT_EQ(pareto_front({}), Positions{});
  const std::vector<CostError> points{{5, 1}, {1, 9}, {3, 4}, {3, 5}, {4, 4}, {2, 9}, {9, 1}, {6, 0.5}};
  EXPECT_EQ(pareto_front(points), (Positions{1, 2, 0, 7}));
}

TEST(ParetoFront, OfEqualPointsTheFirstAndNeverNaN) {
  EXPECT_EQ(pareto_front(std::vector<CostError>{{2, 2}, {1, 3}, {2, 2}, {1, 3}}), (Positions{1, 0}));
  EXPECT_EQ(pareto_front(std::vector<CostError>{{nan, 0}, {1, nan}, {nan, nan}, {2, 5}}), Positions{3});
  EXPECT_EQ(pareto_front(std::vector<CostError>{{nan, 0}}), Positions{});
  // Infinity is a number like others: nothing is cheaper than 0, and 2 is on the front for its error.
  EXPECT_EQ(pareto_front(std::vector<CostError>{{2, 5}, {1, infinity}, {0, infinity}, {infinity, 1}}),
            (Positions{2, 0, 3}));
}

TEST(ParetoFront, AsTheDefinitionSays) {
  golden::Prng random(1);
  for (int round = 0; round < 300; ++round) {
    const std::int64_t values = random.integer(1, 30);  // few values: many ties
    std::vector<CostError> points(static_cast<std::size_t>(random.integer(0, 60)));
    const auto value = [&] { return random.chance(0.05) ? nan : static_cast<double>(random.integer(0, values)); };
    for (CostError& p : points) p = {value(), value()};
    Positions expected;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const CostError& p = points[i];
      if (std::isnan(p.cost) || std::isnan(p.error)) continue;
      bool beaten = false;
      for (std::size_t j = 0; j < points.size(); ++j) {
        const CostError& q = points[j];
        const bool not_worse = q.cost <= p.cost && q.error <= p.error;
        beaten |= not_worse && (q.cost < p.cost || q.error < p.error || j < i);
      }
      if (!beaten) expected.push_back(i);
    }
    std::ranges::sort(expected, {}, [&](std::size_t i) { return points[i].cost; });
    ASSERT_EQ(pareto_front(points), expected) << round;
  }
}

/// Points whose logarithms to base 2 are the given ones; each is on the front.
std::vector<CostError> from_logarithms(std::initializer_list<std::pair<double, double>> list) {
  std::vector<CostError> points;
  for (const auto& [cost, error] : list) points.push_back({std::exp2(cost), std::exp2(error)});
  return points;
}

Positions knees_of(const std::vector<CostError>& points, std::size_t count) {
  const Knees found = knees(points, pareto_front(points), count);
  EXPECT_EQ(found.none.empty(), count == 0 || !found.points.empty()) << "why there is none is said";
  return found.points;
}

std::string why_none(const std::vector<CostError>& points) { return knees(points, pareto_front(points), 3).none; }

TEST(Knees, ByHand) {
  // Scaled to the unit square: (0, 1) (0.1, 0.3) (0.5, 0.2) (0.6, 0.05) (1, 0). Distances from the chord x + y = 1,
  // times √2: 0.6, 0.3, 0.35. (0.5, 0.2) is above the line from (0.1, 0.3) to (0.6, 0.05), so no vertex of the hull.
  const auto points = from_logarithms({{0, 0}, {1, -14}, {5, -16}, {6, -19}, {10, -20}});
  EXPECT_EQ(knees_of(points, 0), Positions{});
  EXPECT_EQ(knees_of(points, 1), Positions{1});
  EXPECT_EQ(knees_of(points, 2), (Positions{1, 3}));
  EXPECT_EQ(knees_of(points, 9), (Positions{1, 3}));
}

TEST(Knees, SpreadOverTheCurveInsteadOfNeighboursOfTheFirst) {
  // In the unit square (0, 1) (0.1, 0.3) (0.12, 0.29) (0.7, 0.02) (1, 0), all on the hull. Distances from x + y = 1,
  // times √2: 0.6, 0.59, 0.28. Then below the line from (0.1, 0.3) to (1, 0): 0.0033, 0.08.
  const auto points = from_logarithms({{0, 0}, {1, -14}, {1.2, -14.2}, {7, -19.6}, {10, -20}});
  EXPECT_EQ(knees_of(points, 1), Positions{1});
  EXPECT_EQ(knees_of(points, 2), (Positions{1, 3}));
}

TEST(Knees, DistancesAreThoseInTheUnitSquare) {
  // (0, 1) (0.02, 0.7) (0.2, 0.2) (0.6, 0.02) (1, 0). After (0.2, 0.2): 0.22·0.2/0.825 = 0.053 on the left,
  // 0.08·0.8/0.825 = 0.078 on the right. Were cost not scaled, the left one would be 0.2 off.
  const auto points = from_logarithms({{0, 0}, {0.2, -6}, {2, -16}, {6, -19.6}, {10, -20}});
  EXPECT_EQ(knees_of(points, 1), Positions{2});
  EXPECT_EQ(knees_of(points, 2), (Positions{2, 3}));
  EXPECT_EQ(knees_of(points, 3), (Positions{1, 2, 3}));
}

TEST(Knees, NeverTheEndsAndNoneOnAStraightLine) {
  EXPECT_EQ(knees_of({}, 3), Positions{});
  EXPECT_EQ(knees_of(from_logarithms({{0, 0}}), 3), Positions{});
  EXPECT_EQ(knees_of(from_logarithms({{0, 0}, {1, -1}}), 3), Positions{});
  EXPECT_EQ(knees_of(from_logarithms({{0, 0}, {1, -3}, {2, -6}, {3, -9}}), 3), Positions{});
  EXPECT_EQ(knees_of(from_logarithms({{0, 0}, {1, -1}, {2, -5}}), 3), Positions{}) << "bends the other way";
}

TEST(Knees, NoneOnAFlatFront) {
  // One shape, in the unit square (0, 1) (0.1, 0.3) (0.6, 0.05) (1, 0), over a fall of h bits.
  const auto falling = [](double h) { return from_logarithms({{0, 0}, {1, -0.7 * h}, {6, -0.95 * h}, {10, -h}}); };
  EXPECT_EQ(knees_of(falling(1.01), 3), (Positions{1, 2}));
  EXPECT_EQ(knees_of(falling(0.99), 3), Positions{});
  EXPECT_NE(why_none(falling(0.99)).find("flat"), std::string::npos);
  EXPECT_NE(why_none(from_logarithms({{0, 0}, {1, -9}})).find("fewer than three"), std::string::npos);
  EXPECT_NE(why_none(from_logarithms({{0, 0}, {1, -1}, {2, -5}})).find("bends nowhere"), std::string::npos);
  EXPECT_EQ(why_none(falling(20)), "");
  // The default sweep's front of total errors, in which snapping of 3.98e-3 hides all else.
  const std::vector<CostError> hidden{{94492, 3.994e-3},  {107593, 3.9935e-3}, {205829, 3.989e-3}, {210029, 3.987e-3},
                                      {212100, 3.986e-3}, {217049, 3.984e-3},  {218290, 3.9839e-3}};
  EXPECT_EQ(knees_of(hidden, 3), Positions{});
}

TEST(Knees, PositionsAreThoseOfThePoints) {
  auto points = from_logarithms({{10, -20}, {1, -14}, {0, 0}});
  points.insert(points.begin(), {nan, 1});
  EXPECT_EQ(pareto_front(points), (Positions{3, 2, 1}));
  EXPECT_EQ(knees_of(points, 1), Positions{2});
}

TEST(Knees, AnErrorOfZeroIsNoPartOfTheCurve) {
  auto points = from_logarithms({{0, 0}, {1, -14}, {10, -20}});
  points.push_back({4096, 0});
  EXPECT_EQ(pareto_front(points), (Positions{0, 1, 2, 3}));
  EXPECT_EQ(knees_of(points, 3), Positions{1});
}

TEST(RankCorrelation, ByHand) {
  using List = std::vector<double>;
  EXPECT_EQ(rank_correlation(List{1, 2, 3, 10}, List{-5, 0, 1e9, infinity}), 1);
  EXPECT_EQ(rank_correlation(List{1, 2, 3}, List{3, 2, 1}), -1);
  // Ranks 1 2 3 4 5 and 2 1 4 3 5: 1 − 6·Σd² / (n(n² − 1)) = 1 − 6·4 / 120.
  EXPECT_DOUBLE_EQ(rank_correlation(List{1, 2, 3, 4, 5}, List{2, 1, 5, 2.5, 6}), 0.8);
  // Ranks 1, 2.5, 2.5, 4 and 1, 2, 3.5, 3.5 less 2.5: 2.25 + 0 + 0 + 1.5 over √(4.5 · 4.5).
  EXPECT_DOUBLE_EQ(rank_correlation(List{1, 2, 2, 3}, List{1, 2, 3, 3}), 3.75 / 4.5);
  EXPECT_TRUE(std::isnan(rank_correlation(List{}, List{})));
  EXPECT_TRUE(std::isnan(rank_correlation(List{1}, List{1})));
  EXPECT_TRUE(std::isnan(rank_correlation(List{1, 2, 3}, List{4, 4, 4})));
  EXPECT_TRUE(std::isnan(rank_correlation(List{4, 4, 4}, List{1, 2, 3})));
  EXPECT_EQ(rank_correlation(List{1, nan, 2, 7}, List{5, 1, 6, nan}), 1) << "two pairs are left";
  EXPECT_TRUE(std::isnan(rank_correlation(List{1, nan, 2}, List{nan, 5, 6})));
  EXPECT_THROW(rank_correlation(List{1, 2}, List{1, 2, 3}), std::invalid_argument);
}

/// Rank of each element: those smaller, half of those equal, and a half.
std::vector<double> counted_ranks(const std::vector<double>& list) {
  std::vector<double> ranks;
  for (const double v : list) {
    double rank = 0.5;
    for (const double w : list) rank += w < v ? 1 : w == v ? 0.5 : 0;
    ranks.push_back(rank);
  }
  return ranks;
}

TEST(RankCorrelation, AsTheDefinitionSays) {
  golden::Prng random(2);
  for (int round = 0; round < 200; ++round) {
    const std::int64_t values = random.integer(1, 40);
    const auto n = static_cast<std::size_t>(random.integer(2, 50));
    std::vector<double> a(n), b(n);
    for (double& v : a) v = static_cast<double>(random.integer(0, values));
    for (double& v : b) v = static_cast<double>(random.integer(0, values));
    const std::vector<double> x = counted_ranks(a), y = counted_ranks(b);
    // Pearson's coefficient by the sums n·Σxy − Σx·Σy.
    double sx = 0, sy = 0, sxx = 0, syy = 0, sxy = 0;
    for (std::size_t i = 0; i < n; ++i) {
      sx += x[i];
      sy += y[i];
      sxx += x[i] * x[i];
      syy += y[i] * y[i];
      sxy += x[i] * y[i];
    }
    const double count = static_cast<double>(n);
    const double vx = count * sxx - sx * sx, vy = count * syy - sy * sy;
    if (vx == 0 || vy == 0) {
      EXPECT_TRUE(std::isnan(rank_correlation(a, b))) << round;
    } else {
      EXPECT_NEAR(rank_correlation(a, b), (count * sxy - sx * sy) / (std::sqrt(vx) * std::sqrt(vy)), 1e-12) << round;
    }
  }
}

}  // namespace
}  // namespace quadrille::sweep
