// The cost estimate against flip-flops and LUTs counted by Yosys, against tallies of multipliers and tables, and in the
// direction of every key.
#include "golden/analysis/hardware_cost.hpp"

#include "model/tables.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace quadrille {
namespace {

using Keys = std::initializer_list<std::pair<const char*, int>>;

Config with(Keys keys) {
  Config config;
  for (const auto& [key, value] : keys) config.set(key, value);
  config.validate();
  return config;
}

double scalar(const Config& config) { return scalar_cost(hardware_cost(config), CostWeights{}); }

const std::vector<Config>& bases() {
  static const std::vector<Config> list{
      with({}),
      with({{"significand_bits", 8}, {"attribute_slots", 1}, {"tile_log2", 2}, {"quadratic_frac_bits", 8}}),
      with({{"significand_bits", 24}, {"sqrt_degree", 1}, {"recip_degree", 1}, {"subpixel_bits", 4}}),
      with({{"notch_exact", 0}, {"attribute_slots", 7}, {"viewport_bits", 10}, {"quad_slots_log2", 1}}),
  };
  return list;
}

/// Flip-flops counted by Yosys 0.23: `synth` up to memories as flip-flops, modules not flattened (tb/yosys/yosys.cpp,
/// yosys_synthesise()). Without the cure that keeps registers whose values are constant, hence the wider tolerance.
TEST(HardwareCost, StateIsWhatYosysCounts) {
  struct Measured {
    Config config;
    std::uint64_t flip_flops;
    double tolerance;
  };
  const Measured all[] = {
      {with({{"significand_bits", 8}}), 43'376, 0.001},
      {with({{"significand_bits", 12}}), 45'874, 0.001},
      {with({{"significand_bits", 18}}), 49'612, 0.001},
      {with({{"significand_bits", 26}}), 54'602, 0.001},
      {with({{"significand_bits", 16},
             {"viewport_bits", 10},
             {"subpixel_bits", 4},
             {"homogeneous_frac_bits", 5},
             {"quadratic_frac_bits", 8}}),
       36'507, 0.003},
      {with({{"significand_bits", 20},
             {"align_guard_bits", 6},
             {"sqrt_degree", 1},
             {"recip_degree", 1},
             {"attribute_slots", 8},
             {"depth_bits", 16},
             {"tile_log2", 4},
             {"quad_slots_log2", 4},
             {"quad_id_bits", 32}}),
       75'560, 0.001},
      {with({{"significand_bits", 10},
             {"notch_exact", 0},
             {"attribute_slots", 1},
             {"tile_log2", 2},
             {"quad_slots_log2", 1},
             {"tile_slots_log2", 1},
             {"stamp_fifo_log2", 1}}),
       29'706, 0.013},
  };
  for (const Measured& m : all) {
    const double measured = static_cast<double>(m.flip_flops);
    EXPECT_NEAR(static_cast<double>(hardware_cost(m.config).state_bits), measured, m.tolerance * measured);
  }
}

struct Synthesised {
  Config config;
  double luts;         ///< with multipliers in logic
  std::uint64_t dsps;  ///< that the multipliers take otherwise
};

/// As counted by Yosys 0.23 (scripts/size.py). The weights are fitted to all but the last.
const std::vector<Synthesised>& synthesised() {
  static const std::vector<Synthesised> list{
      {with({{"significand_bits", 8}}), 76'885, 106},
      {with({{"significand_bits", 12}}), 98'227, 106},
      {with({{"significand_bits", 18}}), 144'616, 106},
      {with({{"significand_bits", 26}}), 242'891, 352},
      {with({{"significand_bits", 18}, {"attribute_slots", 8}}), 167'609, 126},
      {with({{"significand_bits", 16}, {"quadratic_frac_bits", 8}, {"align_guard_bits", 0}, {"attribute_slots", 2}}),
       110'607, 96},
      {with({{"significand_bits", 12},
             {"viewport_bits", 10},
             {"subpixel_bits", 4},
             {"homogeneous_frac_bits", 5},
             {"depth_bits", 16}}),
       84'205, 106},
      {with({{"significand_bits", 14},
             {"attribute_slots", 1},
             {"tile_log2", 2},
             {"notch_exact", 0},
             {"quad_slots_log2", 1},
             {"tile_slots_log2", 1}}),
       93'011, 88},
      {with({{"significand_bits", 10},
             {"align_guard_bits", 6},
             {"tile_log2", 4},
             {"quad_slots_log2", 4},
             {"stamp_fifo_log2", 5}}),
       94'077, 106},
      {with({{"significand_bits", 15}}), 119'443, 106},
      {with({{"significand_bits", 22}}), 186'853, 352},
      {with({{"significand_bits", 18}, {"sqrt_degree", 1}, {"recip_degree", 1}}), 151'445, 106},
      {with({{"significand_bits", 8},
             {"viewport_bits", 6},
             {"guard_bits", 2},
             {"subpixel_bits", 2},
             {"homogeneous_frac_bits", 4},
             {"attribute_slots", 1},
             {"tile_log2", 2}}),
       43'084, 91},
  };
  return list;
}

TEST(HardwareCost, EstimatesSynthesisedLuts) {
  const auto estimate = [](const Config& config, const CostWeights& weights) {
    return lut_cost(hardware_cost(config), weights);
  };
  for (const Synthesised& point : synthesised())
    EXPECT_NEAR(estimate(point.config, ecp5_nodsp_weights), point.luts, 0.04 * point.luts);
  // With DSP blocks, to which nothing is fitted: the weights are those of the rest of the machine.
  EXPECT_NEAR(estimate(with({}), ecp5_weights), 61'091, 0.02 * 61'091);
  EXPECT_NEAR(estimate(synthesised().back().config, ecp5_weights), 27'964, 0.02 * 27'964);
}

TEST(HardwareCost, JoinsTheBlocksOfWideMultipliers) {
  // The LUTs of fp_multiply alone by Yosys: 54, 116, 143 for 18, 22, 26 bits. What they have beside the sums of blocks
  // grows with the bits: 54 of 18 bits, so 66 and 78. It drops the lower half of the product, at most S bits of the
  // sums.
  const auto join = [](int s) { return static_cast<double>(hardware_cost(with({{"significand_bits", s}})).join_bits); };
  const double setup = join(18);  // of operands wider than a block, whatever s
  EXPECT_EQ(join(8), setup);
  const double multipliers = 78;  // S × S: 18 ratios, 27 weights, 4 in each of 7 sums, 5 quotients
  const double tables = 12;       // S × rest, of one block in the other direction: S more bits each at most
  for (const auto& [s, measured] : {std::pair{22, 116.0 - 66}, {26, 143.0 - 78}}) {
    EXPECT_GT(join(s) - setup, multipliers * measured);
    EXPECT_LT(join(s) - setup, multipliers * (measured + s) + tables * s);
  }
}

TEST(HardwareCost, CountsDspBlocks) {
  for (const Synthesised& point : synthesised()) {
    const std::uint64_t dsps = hardware_cost(point.config).dsps;
    // Yosys makes blocks of multipliers before it sees that a factor is constant: four of the cure's seven where that
    // is off, and one in each table of degree 1.
    const Config& c = point.config;
    const std::uint64_t constant =
        (c.notch_exact == 0 ? 4 : 0) + (c.sqrt_degree == 1 ? 4 : 0) + (c.recip_degree == 1 ? 2 : 0);
    EXPECT_EQ(dsps + constant, point.dsps) << point.luts;
  }
}

TEST(HardwareCost, RanksAsSynthesisDoes) {
  // Spearman's correlation; the LUTs are all different, so are the costs.
  const auto rank = [](const auto& value_of, const Synthesised& point) {
    return std::ranges::count_if(synthesised(), [&](const Synthesised& p) { return value_of(p) < value_of(point); });
  };
  double squares = 0;
  for (const Synthesised& point : synthesised()) {
    const auto difference =
        rank([](const Synthesised& p) { return p.luts; }, point) -
        rank([](const Synthesised& p) { return scalar_cost(hardware_cost(p.config), ecp5_nodsp_weights); }, point);
    squares += static_cast<double>(difference * difference);
  }
  const double n = static_cast<double>(synthesised().size());
  EXPECT_GE(1 - 6 * squares / (n * (n * n - 1)), 0.95);
}

TEST(HardwareCost, TotalIsTheSumOfTheModules) {
  for (const Config& config : bases()) {
    HardwareCost sum;
    std::set<std::string> names;
    for (const ModuleCost& module : module_costs(config)) {
      names.insert(module.module);
      sum += module.cost;
    }
    EXPECT_EQ(names.size(), module_costs(config).size());
    EXPECT_EQ(sum, hardware_cost(config));
  }
}

TEST(HardwareCost, ScalarCostWeighsEachResource) {
  const HardwareCost cost{
      .state_bits = 10, .multiplier_bits = 200, .adder_bits = 3000, .table_bits = 40000, .dsps = 7, .join_bits = 8};
  const CostWeights weights{.state = 2, .multiplier = 0.5, .adder = 3, .table = 0.25, .dsp = 100, .join = 0.125};
  EXPECT_EQ(lut_cost(cost, weights), 20 + 100 + 9000 + 10000 + 1);
  EXPECT_EQ(scalar_cost(cost, weights), 20 + 100 + 9000 + 10000 + 1 + 700);
}

TEST(HardwareCost, AWiderKeyNeverCostsLess) {
  // Not here: segments and degree of the tables, which trade multipliers for words; pixels_per_clock, which is 1.
  for (const char* key : {"viewport_bits", "guard_bits", "subpixel_bits", "homogeneous_frac_bits",
                          "quadratic_frac_bits", "significand_bits", "notch_exact", "align_guard_bits",
                          "attribute_slots", "attribute_int_bits", "attribute_frac_bits", "depth_bits", "tile_log2",
                          "quad_slots_log2", "tile_slots_log2", "stamp_fifo_log2", "quad_id_bits"}) {
    int steps = 0;
    for (const Config& base : bases()) {
      const auto range = std::ranges::find(Config::keys(), std::string_view(key), &ConfigKey::name);
      double before = 0;
      for (int value = range->minimum; value <= range->maximum; ++value) {
        Config config = base;
        config.set(key, value);
        try {
          config.validate();
        } catch (const ConfigError&) {
          continue;
        }
        const double cost = scalar(config);
        // Exact D and r² bound c, so that 1 + |c| needs no general sum: all bits cost less than all but one.
        if (std::string_view(key) == "quadratic_frac_bits" && config.qdrop() == 0) {
          EXPECT_LT(cost, before) << key << " = " << value;
        } else {
          EXPECT_GT(cost, before) << key << " = " << value;
        }
        before = cost;
        ++steps;
      }
    }
    EXPECT_GE(steps, 8) << key;
  }
}

TEST(HardwareCost, AttributeSlotsCostTheSameEach) {
  for (Config config : bases()) {
    std::vector<HardwareCost> costs;
    for (int slots = 1; slots <= 8; ++slots) {
      config.attribute_slots = slots;
      costs.push_back(hardware_cost(config));
    }
    for (std::size_t i = 2; i < costs.size(); ++i) {
      EXPECT_EQ(costs[i].state_bits - costs[i - 1].state_bits, costs[1].state_bits - costs[0].state_bits);
      EXPECT_EQ(costs[i].multiplier_bits - costs[i - 1].multiplier_bits,
                costs[1].multiplier_bits - costs[0].multiplier_bits);
      EXPECT_EQ(costs[i].table_bits, costs[0].table_bits);
    }
    // Four products with the weights and one with the reciprocal.
    const int s = config.significand_bits;
    EXPECT_EQ(costs[1].multiplier_bits - costs[0].multiplier_bits, static_cast<std::uint64_t>(5 * s * s));
    // The output register's clearing is shared out in whole bits, so adders are linear too.
    for (std::size_t i = 2; i < costs.size(); ++i)
      EXPECT_EQ(costs[i].adder_bits - costs[i - 1].adder_bits, costs[1].adder_bits - costs[0].adder_bits);
  }
}

TEST(HardwareCost, TheCureTakesSevenMultipliers) {
  // Specification, stages 11 and 16: f_a, f_b, f_c; without the cure f' is 1 and g_i = ρ' needs none of its four.
  for (Config config : bases()) {
    const std::uint64_t s = static_cast<std::uint64_t>(config.significand_bits);
    config.notch_exact = 1;
    const HardwareCost cured = hardware_cost(config);
    config.notch_exact = 0;
    const HardwareCost plain = hardware_cost(config);
    EXPECT_EQ(cured.multiplier_bits - plain.multiplier_bits, 7 * s * s);
    EXPECT_LT(plain.adder_bits, cured.adder_bits);
    EXPECT_LT(plain.state_bits, cured.state_bits);
    EXPECT_EQ(plain.table_bits, cured.table_bits);
  }
}

TEST(HardwareCost, TablesAreCountedPerCopy) {
  for (const Config& config : bases()) {
    // Four sqrt units and two reciprocals. A word has C0 with S + 4 bits, C1 and (degree 2) C2 with S.
    const std::uint64_t s = static_cast<std::uint64_t>(config.significand_bits);
    const auto word = [&](int degree) { return degree == 2 ? 3 * s + 4 : 2 * s + 4; };
    EXPECT_EQ(hardware_cost(config).table_bits,
              4 * make_sqrt_table(config).entries.size() * word(config.sqrt_degree) +
                  2 * make_recip_table(config).entries.size() * word(config.recip_degree));
  }
}

TEST(HardwareCost, DegreeOneSavesTheInnerMultipliers) {
  for (const int s : {10, 18, 24}) {
    Config config = with({{"significand_bits", s}, {"sqrt_segments_log2", 6}, {"recip_segments_log2", 7}});
    const HardwareCost quadratic = hardware_cost(config);
    config.sqrt_degree = config.recip_degree = 1;
    const HardwareCost linear = hardware_cost(config);
    // An S × R multiplier in each of the four sqrt (R = S - 1 - 6) and two reciprocals (R = S - 1 - 7).
    EXPECT_EQ(quadratic.multiplier_bits - linear.multiplier_bits,
              static_cast<std::uint64_t>(4 * s * (s - 7) + 2 * s * (s - 8)));
    EXPECT_LT(linear.adder_bits, quadratic.adder_bits);
  }
}

}  // namespace
}  // namespace quadrille
