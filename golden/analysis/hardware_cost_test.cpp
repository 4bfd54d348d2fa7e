// The cost estimate against what Yosys counted, against the tables as they are made, and in the direction of every key.
#include "golden/analysis/hardware_cost.hpp"

#include "model/port/tables.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
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

/// A row of synthesised.csv: what Yosys made of a configuration (scripts/size.py).
struct Synthesised {
  std::string target;
  bool fitted = false;  ///< the weights are fitted to it
  double luts = 0;
  double flip_flops = 0;
  std::uint64_t dsps = 0, block_rams = 0;
  std::string keys;
  Config config;

  const CostWeights& weights() const { return target == "ecp5" ? ecp5_weights : ecp5_nodsp_weights; }
  double estimate() const { return lut_cost(hardware_cost(config), weights()); }
};

const std::vector<Synthesised>& synthesised() {
  static const std::vector<Synthesised> list = [] {
    std::ifstream file(QUADRILLE_SOURCE_DIR "/golden/analysis/synthesised.csv");
    std::vector<Synthesised> rows;
    std::string line;
    while (std::getline(file, line)) {
      if (line.starts_with('#') || line.starts_with("target,")) continue;
      std::istringstream cells(line);
      const auto cell = [&] {
        std::string text;
        std::getline(cells, text, ',');
        return text;
      };
      Synthesised row;
      row.target = cell();
      row.fitted = cell() == "fit";
      row.luts = std::stod(cell());
      row.flip_flops = std::stod(cell());
      row.dsps = std::stoul(cell());
      row.block_rams = std::stoul(cell());
      row.keys = cell();
      std::istringstream words(row.keys);
      for (std::string word; words >> word;) {
        const std::size_t equals = word.find('=');
        row.config.set(word.substr(0, equals), std::stoi(word.substr(equals + 1)));
      }
      row.config.validate();
      rows.push_back(row);
    }
    return rows;
  }();
  return list;
}

std::ptrdiff_t rows_of(std::string_view target) {
  return std::ranges::count(synthesised(), target, &Synthesised::target);
}

TEST(HardwareCost, HasWhatSynthesisGave) {
  EXPECT_GE(rows_of("ecp5"), 11);
  EXPECT_GE(rows_of("ecp5-nodsp"), 2);
}

TEST(HardwareCost, CountsTheRegisters) {
  // 0.4 to 1.0 % too many are counted: Yosys merges registers that hold the same bit (of exponents, say).
  for (const Synthesised& row : synthesised()) {
    const HardwareCost cost = hardware_cost(row.config);
    const double counted = static_cast<double>(cost.state_bits - cost.memory_bits);
    EXPECT_GT(counted, row.flip_flops) << row.keys;
    EXPECT_LT(counted, 1.01 * row.flip_flops) << row.keys;
  }
}

TEST(HardwareCost, EstimatesSynthesisedLuts) {
  for (const Synthesised& row : synthesised()) EXPECT_NEAR(row.estimate(), row.luts, 0.02 * row.luts) << row.keys;
}

TEST(HardwareCost, CountsTheBlocks) {
  for (const Synthesised& row : synthesised()) {
    const HardwareCost cost = hardware_cost(row.config);
    EXPECT_EQ(row.target == "ecp5" ? cost.dsps : 0, row.dsps) << row.keys;
    EXPECT_EQ(cost.block_rams, row.block_rams) << row.keys;
  }
}

/// What only some configurations have, each alone (scripts/timing.py): not fitted.
TEST(HardwareCost, EstimatesTheUnitsOfAKey) {
  std::ifstream file(QUADRILLE_SOURCE_DIR "/rtl/units_measured.json");
  const nlohmann::json units = nlohmann::json::parse(file).at("clock");
  int measured = 0;
  for (const auto& [name, unit] : units.items()) {
    if (!unit.contains("keys")) continue;
    Config config;
    const auto cost_of = [&](std::string_view module) {
      HardwareCost sum;
      for (const ModuleCost& m : module_costs(config))
        if (m.module == module) sum += m.cost;
      return sum;
    };
    EXPECT_EQ(cost_of(name), HardwareCost{}) << name << " costs something where it is not";
    for (const auto& [key, value] : unit.at("keys").items()) config.set(key, value.get<int>());
    config.validate();
    const HardwareCost cost = cost_of(name);
    const nlohmann::json& size = unit.at("size");
    const double luts = size.at("lut"), flip_flops = size.at("ff");
    CostWeights weights;
    weights.state = 0;
    EXPECT_NEAR(lut_cost(cost, weights), luts, 0.1 * luts) << name;
    EXPECT_NEAR(static_cast<double>(cost.state_bits - cost.memory_bits), flip_flops, 0.15 * flip_flops) << name;
    EXPECT_EQ(cost.dsps, size.at("dsp").get<std::uint64_t>()) << name;
    EXPECT_EQ(cost.block_rams, size.at("bram").get<std::uint64_t>()) << name;
    ++measured;
  }
  EXPECT_GE(measured, 5);
}

TEST(HardwareCost, RanksAsSynthesisDoes) {
  // Spearman's correlation; the LUTs are all different, so are the costs.
  for (const char* target : {"ecp5", "ecp5-nodsp"}) {
    std::vector<Synthesised> rows;
    std::ranges::copy_if(synthesised(), std::back_inserter(rows),
                         [&](const auto& row) { return row.target == target; });
    const auto rank = [&](const auto& value_of, const Synthesised& row) {
      return std::ranges::count_if(rows, [&](const Synthesised& r) { return value_of(r) < value_of(row); });
    };
    double squares = 0;
    for (const Synthesised& row : rows) {
      const auto difference = rank([](const Synthesised& r) { return r.luts; }, row) -
                              rank([](const Synthesised& r) { return r.estimate(); }, row);
      squares += static_cast<double>(difference * difference);
    }
    const double n = static_cast<double>(rows.size());
    EXPECT_GE(1 - 6 * squares / (n * (n * n - 1)), 0.95) << target;
  }
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
  const HardwareCost cost{.state_bits = 10,
                          .multiplier_bits = 200,
                          .adder_bits = 3000,
                          .table_bits = 40000,
                          .dsps = 7,
                          .join_bits = 8,
                          .memory_bits = 9,
                          .block_rams = 3};
  const CostWeights weights{
      .state = 2, .multiplier = 0.5, .adder = 3, .table = 0.25, .dsp = 100, .join = 0.125, .block_ram = 1000};
  EXPECT_EQ(lut_cost(cost, weights), 20 + 100 + 9000 + 10000 + 1);
  EXPECT_EQ(scalar_cost(cost, weights), 20 + 100 + 9000 + 10000 + 1 + 700 + 3000);
}

TEST(HardwareCost, AWiderKeyNeverCostsLess) {
  for (const ConfigKey& key : Config::keys()) {
    // Segments and degree of the tables trade multipliers for words; hidden tiles are held where there are any.
    if (key.stage == ConfigKey::Stage::sqrt || key.stage == ConfigKey::Stage::reciprocal || !key.has(ConfigKey::area) ||
        key.name == "hierarchical_z_tiles_log2")
      continue;
    int steps = 0;
    for (const Config& base : bases()) {
      double before = 0;
      for (int value = key.minimum; value <= key.maximum; ++value) {
        Config config = base;
        config.set(key.name, value);
        try {
          config.validate();
        } catch (const ConfigError&) {
          continue;
        }
        const double cost = scalar(config);
        EXPECT_GT(cost, before) << key.name << " = " << value;
        before = cost;
        ++steps;
      }
    }
    EXPECT_GE(steps, 8) << key.name;
  }
}

TEST(HardwareCost, LanesHaveWhatIsAPixelsOwn) {
  const auto module = [](const Config& config, std::string_view name) {
    const std::vector<ModuleCost> costs = module_costs(config);
    return std::ranges::find(costs, name, &ModuleCost::module)->cost;
  };
  for (Config config : bases()) {
    const Config one = config;
    for (const int lanes : {2, 4}) {
      config.pixels_per_clock = lanes;
      config.validate();
      const std::uint64_t n = static_cast<std::uint64_t>(lanes);
      // The multipliers are the pixels' but for the twelve blocks of the setup.
      EXPECT_EQ(hardware_cost(config).dsps - 12, n * (hardware_cost(one).dsps - 12));
      for (const char* name : {"pixel_lane", "forward_difference_column", "normalise", "sqrt", "mean_value_weights",
                               "interpolate", "fragment_output"})
        EXPECT_EQ(module(config, name).state_bits, n * module(one, name).state_bits) << name;
      for (const char* name : {"quad_setup", "vertex_products", "tile_walk", "quad_slots", "tile_ring",
                               "stamp_coverage", "pixel_pipeline", "row_functions"})
        EXPECT_EQ(module(config, name), module(one, name)) << name;
      EXPECT_GT(module(config, "fragment_fifo").block_rams, module(one, "fragment_fifo").block_rams);
    }
  }
}

TEST(HardwareCost, APairOfDotUnitsTakesTwelveBlocks) {
  for (Config config : bases()) {
    const HardwareCost two = hardware_cost(config);
    config.dot_units = 4;
    EXPECT_EQ(hardware_cost(config).dsps, two.dsps + 12);
    EXPECT_GT(hardware_cost(config).adder_bits, two.adder_bits);
    EXPECT_GT(hardware_cost(config).state_bits, two.state_bits);
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
    // Three products with the weights and one with the reciprocal.
    const int s = std::min(config.significand_bits, 18);
    EXPECT_EQ(costs[1].multiplier_bits - costs[0].multiplier_bits, static_cast<std::uint64_t>(4 * s * s));
    EXPECT_EQ(costs[1].dsps - costs[0].dsps, 4);
    // The output register's clearing is shared out in whole bits, so adders are linear too.
    for (std::size_t i = 2; i < costs.size(); ++i)
      EXPECT_EQ(costs[i].adder_bits - costs[i - 1].adder_bits, costs[1].adder_bits - costs[0].adder_bits);
  }
}

/// Bits of a table's words that are not the same in all of them.
std::uint64_t varying_bits(const Table& table) {
  std::uint64_t bits = 0;
  for (const auto field : {&TableEntry::c0, &TableEntry::c1, &TableEntry::c2}) {
    std::uint32_t some = 0, all = ~std::uint32_t{0};
    for (const TableEntry& entry : table.entries) {
      some |= entry.*field;
      all &= entry.*field;
    }
    bits += static_cast<std::uint64_t>(std::popcount(some & ~all));
  }
  return bits;
}

TEST(HardwareCost, TablesAreCountedPerCopy) {
  // Seven roots, of four corners and three ratios, and two reciprocals. Larger tables are in block RAM, those of up to
  // 512 words with 36 bits each.
  for (const int s : {8, 10, 12, 15, 18, 19}) {
    const Config config = with({{"significand_bits", s}});
    const Table sqrt = make_sqrt_table(config), reciprocal = make_recip_table(config);
    EXPECT_EQ(hardware_cost(config).table_bits,
              7 * sqrt.entries.size() * varying_bits(sqrt) + 2 * reciprocal.entries.size() * varying_bits(reciprocal))
        << s;
  }
  for (const int s : {22, 24, 26}) {
    const Config config = with({{"significand_bits", s}});
    const auto blocks = [](const Table& table) { return (varying_bits(table) + 35) / 36; };
    const std::uint64_t fifo =
        static_cast<std::uint64_t>(config.quad_id_bits + 2 * config.viewport_bits + 1 + 8 + config.depth_bits + 1 +
                                   config.attribute_slots * config.attr_out_bits() + 35) /
        36;
    // Of a slot the terms of W and Z at four vertices and of the attributes at three; the bases, and what quad_reject
    // says of depths: three bits and two codes; six squared lengths.
    const auto words = [](int bits) { return static_cast<std::uint64_t>((bits + 35) / 36); };
    const int n = config.attribute_slots;
    const std::uint64_t slots =
        words((2 * 4 + 3 * n) * config.attr_port_bits()) +
        words(n * config.attr_out_bits() + config.depth_bits + 1 + 3 + 2 * (config.depth_bits + 1)) +
        words(6 * config.length2_bits());
    EXPECT_EQ(hardware_cost(config).table_bits, 0) << s;
    EXPECT_EQ(hardware_cost(config).block_rams,
              7 * blocks(make_sqrt_table(config)) + 2 * blocks(make_recip_table(config)) + fifo + slots)
        << s;
  }
}

TEST(HardwareCost, DegreeOneSavesTheInnerMultipliers) {
  for (const int s : {14, 18, 19}) {
    Config config = with({{"significand_bits", s}, {"sqrt_segments_log2", 5}, {"recip_segments_log2", 6}});
    const HardwareCost quadratic = hardware_cost(config);
    const auto bend = [](const Table& table) {
      std::uint32_t some = 0;
      for (const TableEntry& entry : table.entries) some |= entry.c2;
      return static_cast<std::uint64_t>(std::bit_width(some));
    };
    const std::uint64_t sqrt = bend(make_sqrt_table(config)), reciprocal = bend(make_recip_table(config));
    config.sqrt_degree = config.recip_degree = 1;
    const HardwareCost linear = hardware_cost(config);
    // C2 times the rest of the argument below the segment, S - 1 - K bits. Blocks are made before C2 is seen to be 0.
    EXPECT_EQ(quadratic.multiplier_bits - linear.multiplier_bits,
              7 * sqrt * static_cast<std::uint64_t>(s - 6) + 2 * reciprocal * static_cast<std::uint64_t>(s - 7));
    EXPECT_LT(linear.adder_bits, quadratic.adder_bits);
    EXPECT_EQ(linear.dsps, quadratic.dsps);
  }
}

}  // namespace
}  // namespace quadrille
