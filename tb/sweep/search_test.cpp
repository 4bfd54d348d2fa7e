// The search against full evaluation, on error landscapes made up for the purpose.
#include "tb/sweep/search.hpp"

#include "golden/scenes/stress.hpp"
#include "model/port/snap.hpp"
#include "model/support/prng.hpp"
#include "model/untimed.hpp"
#include "tb/device/verilate.hpp"
#include "tb/sweep/evaluator.hpp"
#include "tb/sweep/grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace quadrille::sweep {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Config configured(std::initializer_list<std::pair<const char*, int>> values) {
  Config c;
  for (const auto& [key, value] : values) c.set(key, value);
  c.validate();
  return c;
}

std::vector<SearchPoint> points_of(const Grid& grid, const std::function<double(const Config&)>& cost) {
  std::vector<SearchPoint> points;
  for (std::uint64_t row = 0; row < grid.size(); ++row) {
    const GridPoint point = grid.point(row);
    if (point.refused.empty()) points.push_back({point.config, cost(point.config)});
  }
  return points;
}

/// A number in [0, 1) from a list of integers.
double hashed(std::uint64_t seed, const std::vector<int>& values) {
  for (const int v : values) seed = golden::Prng(seed, static_cast<std::uint64_t>(v + 1000)).next();
  return golden::Prng(seed).uniform();
}

/// The values that errors may depend on, "auto" replaced.
std::vector<int> error_values(const Config& c) {
  std::vector<int> values;
  for (const ConfigKey& key : Config::keys())
    if (key.errors != ConfigKey::Errors::none) values.push_back(resolved(c).get(key.name));
  return values;
}

/// What a sampled maximum may look like: truncation in units of 2^-s, tables, dropped bits of D and r². Falls in every
/// key; `noise` times a factor in [1, noise).
double plausible_error(const Config& c, double noise, std::uint64_t seed) {
  const auto table = [&](int degree, int segments) {
    return degree == 2 ? std::exp2(-3 * segments - 7) : std::exp2(-2 * segments - 3);
  };
  const double s = std::exp2(-c.significand_bits);
  const double e = s * (2.5 + 2 * std::exp2(-c.align_guard_bits)) + table(c.sqrt_degree, c.sqrt_segments()) +
                   0.5 * table(c.recip_degree, c.recip_segments()) +
                   (c.quadratic_frac() == 2 * c.frac() ? 0 : std::exp2(2 - c.quadratic_frac()));
  return e * (1 + (noise - 1) * hashed(seed, error_values(c)));
}

/// Multipliers, sums, the exact front, tables.
double plausible_cost(const Config& c) {
  const double s = c.significand_bits;
  return 60 * s * s + 30 * c.prec_bits() + 900.0 * c.frac() + 250.0 * c.quadratic_frac() +
         std::ldexp(s * (1 + c.sqrt_degree), c.sqrt_segments() - 1) +
         std::ldexp(s * (1 + c.recip_degree), c.recip_segments() - 2) + 8.0 * c.depth_bits + 40.0 * c.attribute_frac();
}

std::optional<std::size_t> brute_force(const std::vector<SearchPoint>& points, const std::vector<double>& errors,
                                       double target) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (errors[i] <= target && (!best || points[i].cost < points[*best].cost)) best = i;
  }
  return best;
}

SearchResult search(const std::vector<SearchPoint>& points, const std::vector<double>& errors, double target,
                    double slack) {
  return cheapest_meeting(
      points, [&](std::size_t i) { return errors[i] / target; }, slack);
}
std::string refusal(const auto& action) {
  try {
    action();
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

TEST(NowhereBetter, ComparesResolvedValues) {
  const auto worse = [](std::initializer_list<std::pair<const char*, int>> a,
                        std::initializer_list<std::pair<const char*, int>> b) {
    return nowhere_better(configured(a), configured(b));
  };
  EXPECT_TRUE(worse({}, {}));
  EXPECT_TRUE(worse({{"significand_bits", 17}}, {}));
  EXPECT_FALSE(worse({{"significand_bits", 19}}, {}));
  EXPECT_FALSE(worse({{"significand_bits", 17}, {"align_guard_bits", 3}}, {}));
  // auto is 30 for the default 8 + 7 fraction bits.
  EXPECT_TRUE(worse({{"quadratic_frac_bits", 30}}, {}));
  EXPECT_TRUE(worse({}, {{"quadratic_frac_bits", 30}}));
  EXPECT_TRUE(worse({{"quadratic_frac_bits", 0}}, {}));
  EXPECT_FALSE(worse({}, {{"quadratic_frac_bits", 29}}));
  // auto is 5 segments for degree 2 and 9 for degree 1: neither is worse, until the segments are the same.
  EXPECT_FALSE(worse({{"sqrt_degree", 1}}, {}));
  EXPECT_FALSE(worse({}, {{"sqrt_degree", 1}}));
  EXPECT_TRUE(worse({{"sqrt_degree", 1}, {"sqrt_segments_log2", 5}}, {}));
  EXPECT_TRUE(worse({{"sqrt_degree", 1}}, {{"sqrt_segments_log2", 9}}));
  // auto is s + 2 from s = 22 on: 25 bits are fewer than the auto of 24, 27 are more.
  EXPECT_TRUE(worse({{"attribute_frac_bits", 25}}, {{"significand_bits", 24}}));
  EXPECT_FALSE(worse({{"attribute_frac_bits", 27}}, {{"significand_bits", 24}}));
  // Other positions are another input, either way.
  EXPECT_FALSE(worse({{"subpixel_bits", 7}, {"quadratic_frac_bits", 8}}, {{"quadratic_frac_bits", 8}}));
  EXPECT_FALSE(worse({{"quadratic_frac_bits", 8}}, {{"subpixel_bits", 7}, {"quadratic_frac_bits", 8}}));
  // So is what decides which quads are homogeneous, and how these are rounded.
  for (const auto& [key, value] : {std::pair("viewport_bits", 11), {"guard_bits", 1}, {"homogeneous_frac_bits", 6}}) {
    EXPECT_FALSE(worse({{key, value}}, {})) << key;
    EXPECT_FALSE(worse({}, {{key, value}})) << key;
  }
  // No effect at all.
  EXPECT_TRUE(worse({{"stamp_fifo_log2", 5}, {"attribute_slots", 8}}, {}));
  // Exact D and r² are as good as any tile size, truncated ones only as their own.
  EXPECT_TRUE(worse({{"tile_log2", 4}}, {{"tile_log2", 2}}));
  EXPECT_TRUE(worse({{"tile_log2", 2}}, {{"tile_log2", 4}}));
  EXPECT_TRUE(worse({{"tile_log2", 4}, {"quadratic_frac_bits", 9}}, {{"tile_log2", 2}}));
  EXPECT_FALSE(worse({{"tile_log2", 4}, {"quadratic_frac_bits", 9}}, {{"quadratic_frac_bits", 9}}));
  EXPECT_FALSE(worse({{"quadratic_frac_bits", 9}}, {{"tile_log2", 4}, {"quadratic_frac_bits", 9}}));
}

/// Measured: of each key its least and its largest value.
TEST(NowhereBetter, ErrorsAreNoSmaller) {
  SweepInput input;
  input.state.width = input.state.height = input.state.scissor_x1 = input.state.scissor_y1 = 96;
  input.attributes = 1;
  input.quads = golden::make_stress(golden::StressFamily::perspective, 60, 1, 1, 96, 96, 1);
  std::vector<Config> machines{Config()};
  for (const ConfigKey& key : Config::keys())
    for (const int value : {key.minimum, key.maximum}) {
      Config c;
      c.set(key.name, value);
      if (refusal([&] { c.validate(); }).empty()) machines.push_back(c);
    }
  Evaluator::Settings settings;
  settings.cycles = false;
  std::vector<PointResult> results(machines.size());
  Evaluator(input, settings).evaluate(machines, [&](const Batch& batch) {
    for (std::size_t i = 0; i < batch.points.size(); ++i) results[batch.points[i]] = batch.results[i];
  });
  std::size_t ordered = 0;
  for (std::size_t a = 0; a < machines.size(); ++a)
    for (std::size_t b = 0; b < machines.size(); ++b) {
      if (!nowhere_better(machines[a], machines[b]) || !results[a].refused.empty()) continue;
      const std::string names = tb::summary(machines[a]) + " and " + tb::summary(machines[b]);
      EXPECT_EQ(results[b].refused, "") << names;
      for (std::size_t q = 0; q < results[a].arithmetic.size(); ++q)
        EXPECT_LE(results[b].arithmetic[q].max, sampled_slack * results[a].arithmetic[q].max) << names << ", " << q;
      ordered += !nowhere_better(machines[b], machines[a]);
    }
  EXPECT_GT(ordered, 300u);
}

std::vector<SearchPoint> significands(std::initializer_list<std::pair<int, double>> bits_and_cost) {
  std::vector<SearchPoint> points;
  for (const auto& [bits, cost] : bits_and_cost) points.push_back({configured({{"significand_bits", bits}}), cost});
  return points;
}

TEST(CheapestMeeting, BisectsAChain) {
  const Grid grid(Config(), {parse_axis("significand_bits=8:26")}, Grid::Kind::full);
  const auto points = points_of(grid, [](const Config& c) { return c.significand_bits; });
  std::vector<double> errors;
  for (int s = 8; s <= 26; ++s) errors.push_back(std::exp2(-s));
  for (int s = 8; s <= 26; ++s) {
    const SearchResult r = search(points, errors, std::exp2(-s), 1);
    EXPECT_EQ(r.winner, static_cast<std::size_t>(s - 8));
    EXPECT_LE(r.evaluations, 5u) << "19 points and \"none\": 20 outcomes";
    EXPECT_EQ(r.evaluations, r.evaluated.size());
  }
  const SearchResult none = search(points, errors, std::exp2(-27), 1);
  EXPECT_FALSE(none.winner);
  EXPECT_EQ(none.closest, 2);
  EXPECT_EQ(none.closest_point, 18u);
  EXPECT_LE(none.evaluations, 5u);
}

TEST(CheapestMeeting, KeysWithoutEffectAreNotSearched) {
  const Grid grid(Config(), {parse_axis("quad_slots_log2=4:1:-1"), parse_axis("significand_bits=8:26")},
                  Grid::Kind::full);
  const auto points = points_of(grid, [](const Config& c) { return 10 * c.significand_bits + c.quad_slots_log2; });
  std::vector<double> errors;
  for (const SearchPoint& p : points) errors.push_back(std::exp2(-p.config.significand_bits));
  const SearchResult r = search(points, errors, std::exp2(-20), 1.5);
  EXPECT_EQ(r.winner, 3u * 19 + 12) << "20 bits and one log2 slot";
  EXPECT_LE(r.evaluations, 5u);

  const std::vector<double> within_the_slack(points.size(), 1.2);
  EXPECT_EQ(search(points, within_the_slack, 1, 1.5).evaluations, 19u) << "one for each of the 19 machines that differ";
}

TEST(CheapestMeeting, OfEqualCostTheFirst) {
  const auto met = [](std::size_t) { return 0.5; };
  EXPECT_EQ(cheapest_meeting(significands({{10, 7}, {12, 5}, {11, 5}, {13, 5}}), met, 1).winner, 1u);
  EXPECT_EQ(cheapest_meeting(significands({{10, 5}, {10, 5}}), met, 1).winner, 0u);
  const auto last = [](std::size_t i) { return i == 3 ? 1.0 : 2.0; };
  EXPECT_EQ(cheapest_meeting(significands({{10, 5}, {11, 5}, {12, 5}, {13, 5}}), last, 1).winner, 3u);
}

TEST(CheapestMeeting, AMissWithinTheSlackRulesOutItselfAlone) {
  // Noise: 11 bits miss by a factor of 1.2 though 10 bits, which cost more here, meet.
  const auto points = significands({{11, 1}, {10, 2}});
  const std::vector<double> errors{1.2, 0.9};
  EXPECT_EQ(search(points, errors, 1, 1.2).winner, 1u);
  EXPECT_FALSE(search(points, errors, 1, 1.1).winner) << "11 bits rule out 10";
}

TEST(CheapestMeeting, OnOrdinaryInputProductsAreExactFromTwiceTheirFactors) {
  const Grid grid(Config(), {parse_axis("quadratic_frac_bits=14:30:2"), parse_axis("tile_log2=2:4")}, Grid::Kind::full);
  auto points = points_of(grid, [](const Config& c) { return c.quadratic_frac() + 100 * c.tile_log2; });
  const auto within_the_slack = [](std::size_t) { return 1.2; };
  // All bits are exact on any input, hence one machine for every tile; 14 to 28 are eight.
  EXPECT_EQ(cheapest_meeting(points, within_the_slack, 1.5).evaluations, 8u * 3 + 1);
  for (SearchPoint& point : points) point.ordinary = true;
  EXPECT_EQ(cheapest_meeting(points, within_the_slack, 1.5).evaluations, 3u + 1) << "14 bits, and from 2 * 8 on";
}

TEST(CheapestMeeting, NothingToFind) {
  const auto points = significands({{9, 1}, {10, 2}, {11, 3}, {12, 4}});
  for (const double bad : {infinity, std::numeric_limits<double>::quiet_NaN()}) {
    const SearchResult r = cheapest_meeting(
        points, [&](std::size_t) { return bad; }, 2);
    EXPECT_FALSE(r.winner);
    EXPECT_EQ(r.closest, infinity);
    EXPECT_EQ(r.closest_point, 0u);
    EXPECT_LT(r.evaluations, points.size()) << "clear misses rule out more than themselves";
  }
  const SearchResult r = cheapest_meeting(
      {}, [](std::size_t) { return 0.0; }, 1);
  EXPECT_FALSE(r.winner);
  EXPECT_EQ(r.evaluations, 0u);
}

TEST(CheapestMeeting, AsFullEvaluationOnAThousandPoints) {
  const auto points = points_of(Grid(Config(), thousand_point_axes(), Grid::Kind::full), plausible_cost);
  ASSERT_EQ(points.size(), 1000u);
  for (const double slack : {1.0, 1.25, 2.0}) {
    std::size_t searches = 0, sum = 0, most = 0;
    for (std::uint64_t landscape = 0; landscape < 2; ++landscape) {
      std::vector<double> errors;
      for (const SearchPoint& p : points) errors.push_back(plausible_error(p.config, slack, landscape));
      const auto [least, largest] = std::ranges::minmax(errors);
      golden::Prng random(landscape);
      for (int i = 0; i < 25; ++i) {
        const double target = i == 0   ? 0.9 * least
                              : i == 1 ? 1.1 * largest
                              : i == 2 ? 0.01 * least
                              : i == 3 ? least
                                       : random.log2_spread(std::log2(least), std::log2(largest));
        const SearchResult r = search(points, errors, target, slack);
        ASSERT_EQ(r.winner, brute_force(points, errors, target)) << "target " << target << ", slack " << slack;
        EXPECT_EQ(std::set(r.evaluated.begin(), r.evaluated.end()).size(), r.evaluations) << "a point twice";
        ++searches;
        sum += r.evaluations;
        most = std::max(most, r.evaluations);
      }
    }
    EXPECT_LE(most, 100u);
    std::printf("slack %.2f: %zu searches of 1,000 points, %.1f evaluations on average, at most %zu\n", slack, searches,
                static_cast<double>(sum) / static_cast<double>(searches), most);
  }
}

/// Errors that fall in every ordered key, each at its own rate, differ without order between values of unordered keys,
/// and carry noise.
class Landscape {
 public:
  Landscape(golden::Prng& random, double noise) : seed_(random.next()), noise_(noise) {
    for (const ConfigKey& key : Config::keys())
      terms_.push_back({&key, random.log2_spread(-4, 4), random.uniform(0, 1)});
  }

  double error(const Config& given) const {
    const Config c = resolved(given);
    const bool exact = c.qdrop() == 0;  // then D and r² are the same for every tile
    double sum = 0;
    std::vector<int> values, place;
    for (const Term& t : terms_) {
      if (t.key->errors == ConfigKey::Errors::none) continue;
      const int v = c.get(t.key->name);
      const bool tile = t.key->name == "tile_log2";
      values.push_back(tile && exact ? 0 : v);
      if (t.key->errors == ConfigKey::Errors::ordered) sum += t.weight * std::exp2(-t.rate * v);
      if (t.key->errors == ConfigKey::Errors::unordered && !tile) place.push_back(v);
    }
    if (!exact) sum *= 1 + hashed(seed_, {c.tile_log2});
    return sum * (1 + 9 * hashed(seed_ + 1, place)) * (1 + (noise_ - 1) * hashed(seed_ + 2, values));
  }

 private:
  struct Term {
    const ConfigKey* key;
    double weight, rate;
  };
  std::uint64_t seed_;
  double noise_;
  std::vector<Term> terms_;
};

TEST(CheapestMeeting, AsFullEvaluationOnRandomLandscapes) {
  const std::vector<std::string> choices{"viewport_bits=9:11",
                                         "guard_bits=2:3",
                                         "subpixel_bits=6:8",
                                         "homogeneous_frac_bits=6,7",
                                         "quadratic_frac_bits=8,16,24,26,28,auto",
                                         "significand_bits=8:20:3",
                                         "notch_exact=0,1",
                                         "sqrt_degree=1,2",
                                         "recip_degree=2,1",
                                         "align_guard_bits=0:4:2",
                                         "sqrt_segments_log2=auto,4:6",
                                         "attribute_slots=1,3",
                                         "attribute_int_bits=2,3",
                                         "attribute_frac_bits=auto,22",
                                         "depth_bits=20,24",
                                         "tile_log2=2:4",
                                         "quad_slots_log2=1:4",
                                         "stamp_fifo_log2=5:1:-2",
                                         "quad_id_bits=16,24"};
  golden::Prng random(3);
  std::size_t searched = 0, evaluated = 0;
  for (int round = 0; round < 60; ++round) {
    std::vector<Axis> axes;
    std::vector<std::string> order = choices;
    random.shuffle(order);
    std::size_t size = 1;
    for (const std::string& text : order) {
      const Axis axis = parse_axis(text);
      if (size * axis.values.size() > 250) continue;
      size *= axis.values.size();
      axes.push_back(axis);
    }
    const double noise = round % 3 == 0 ? 1 : random.uniform(1, 3);
    const Landscape landscape(random, noise);
    const std::uint64_t cost_seed = random.next();
    const auto points = points_of(Grid(Config(), axes, Grid::Kind::full), [&](const Config& c) -> double {
      if (round % 4 == 0) return 1 + std::floor(5 * hashed(cost_seed, {resolved(c).significand_bits, c.tile_log2}));
      return std::floor(plausible_cost(c) / 500) + c.quad_slots_log2;
    });
    std::vector<double> errors;
    for (const SearchPoint& p : points) errors.push_back(landscape.error(p.config));
    std::vector<double> sorted = errors;
    std::ranges::sort(sorted);
    for (int i = 0; i < 4; ++i) {
      const double target = i == 0 ? sorted.front() / 1.1 : sorted[random.below(sorted.size())];
      const SearchResult r = search(points, errors, target, noise);
      ASSERT_EQ(r.winner, brute_force(points, errors, target)) << "round " << round << ", target " << target;
      double closest = infinity;
      for (const std::size_t p : r.evaluated) closest = std::min(closest, errors[p] / target);
      EXPECT_EQ(r.closest, closest);
      EXPECT_EQ(errors[r.closest_point] / target, closest);
      searched += points.size();
      evaluated += r.evaluations;
    }
  }
  EXPECT_LT(evaluated, searched / 3);
}

TEST(CheapestMeeting, MorePointsThanAreWeighedAtOnce) {
  const Grid grid(Config(),
                  {parse_axis("significand_bits=8:26"), parse_axis("quadratic_frac_bits=0:30"),
                   parse_axis("align_guard_bits=0:6"), parse_axis("depth_bits=24,26")},
                  Grid::Kind::full);
  const auto points = points_of(grid, plausible_cost);
  ASSERT_EQ(points.size(), 19u * 31 * 7 * 2);
  std::vector<double> errors;
  for (const SearchPoint& p : points) errors.push_back(plausible_error(p.config, 1.2, 5));
  for (const double target : {1e-3, 1e-5, 1e-9}) {
    const SearchResult r = search(points, errors, target, 1.2);
    EXPECT_EQ(r.winner, brute_force(points, errors, target));
    EXPECT_LE(r.evaluations, 200u);
  }
}

}  // namespace
}  // namespace quadrille::sweep
