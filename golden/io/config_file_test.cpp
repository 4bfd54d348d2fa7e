#include "golden/io/config_file.hpp"

#include "golden/io/test_support.hpp"

namespace quadrille::golden {
namespace {

TEST(ConfigFile, SetsKeysAndLeavesTheRest) {
  Config config;
  config.depth_bits = 20;
  parse_config("# s\nsignificand_bits = 12\nnotch_exact = false\nquadratic_frac_bits = -1\n", "c", config);
  EXPECT_EQ(config.significand_bits, 12);
  EXPECT_EQ(config.notch_exact, 0);
  EXPECT_EQ(config.depth_bits, 20);
  parse_config("notch_exact = 1", "c", config);
  EXPECT_EQ(config.notch_exact, 1);
  parse_config("", "c", config);
  EXPECT_EQ(config.significand_bits, 12);
}

TEST(ConfigFile, RemovedKeys) {
  Config config;
  EXPECT_EQ(parse_config("depth_bits = 20", "c.toml", config), std::vector<std::string>{});
  EXPECT_EQ(
      parse_config("# s\ndepth_bits = 21\nplane_tolerance_bits = 0\n", "c.toml", config),
      std::vector<std::string>{"c.toml:3: plane_tolerance_bits = 0 is no longer needed: quads nearly plane are no "
                               "longer treated apart"});
  EXPECT_EQ(config.depth_bits, 21);
  expect_input_error([&] { parse_config("plane_tolerance_bits = 10\n", "c.toml", config); }, "c.toml:1",
                     {"plane_tolerance_bits = 10: the tolerance was removed", "plane_quads = 1"});
}

TEST(ConfigFile, ReadsBackEveryKey) {
  std::string text;
  for (const ConfigKey& key : Config::keys())
    text += std::string(key.name) + " = " + std::to_string(key.maximum) + "\n";
  Config config;
  parse_config(text, "c", config);
  for (const ConfigKey& key : Config::keys()) EXPECT_EQ(config.get(key.name), key.maximum) << key.name;
}

TEST(ConfigFile, NamesThePlaceAndChangesNothing) {
  struct Bad {
    const char* line;
    std::initializer_list<std::string_view> fragments;
  };
  const Bad cases[] = {
      {"significant_bits = 12", {"significant_bits", "significand_bits"}},
      {"significand_bits = 1000", {"significand_bits", "1000"}},
      {"significand_bits = 12.0", {"\"significand_bits\" holds a floating-point number", "an integer"}},
      {"significand_bits = true", {"\"significand_bits\" holds a boolean"}},
      {"significand_bits = \"auto\"", {"auto", "outside 8..26"}},
      {"significand_bits = \"18\"", {"holds a string"}},
      {"significand_bits = [1]", {"holds an array"}},
      {"significand_bits = 1979-05-27", {"holds a date or time"}},
      {"significand_bits = 4294967308", {"4294967308", "out of range"}},
      {"significand_bits = 9223372036854775808", {"TOML"}},
      {"depth_bits = 20", {"TOML", "depth_bits"}},
      {"significand_bits 12", {"TOML"}},
      {"significand_bits = ", {"TOML"}},
      {"[significand_bits]", {"holds a table"}},
      {"a.b = 1", {"'a'"}},
      {"\"x\xff\" = 1", {"TOML"}},
  };
  for (const Bad& bad : cases) {
    SCOPED_TRACE(bad.line);
    Config config;
    expect_input_error(
        [&] { parse_config("# c\ndepth_bits = 20\n" + std::string(bad.line) + "\n", "d/c.toml", config); },
        "d/c.toml:3", bad.fragments);
    EXPECT_EQ(config, Config{});
  }
}

TEST(ConfigFile, AKeyByTwoNamesIsOneKey) {
  Config config;
  expect_input_error([&] { parse_config("sqrt_degree = 2\nrsqrt_degree = 2\n", "c", config); }, "c:2",
                     {"\"rsqrt_degree\" was set before, as \"sqrt_degree\""});
}

TEST(ConfigFile, ReportsTheFirstErrorOfTheFile) {
  Config config;
  expect_input_error([&] { parse_config("zzz = 1\naaa = 1\n", "c", config); }, "c:1", {"zzz"});
}

TEST(CostWeightsFile, SetsWeightsAndLeavesTheRest) {
  CostWeights weights{.state = 5, .multiplier = 6, .adder = 7, .table = 8};
  parse_cost_weights("significand_bits = 12\n[cost]\nadder = 0.25\ntable = 0\n", "c", weights);
  EXPECT_EQ(weights, (CostWeights{.state = 5, .multiplier = 6, .adder = 0.25, .table = 0}));
  parse_cost_weights("cost = {state = 1e-3, multiplier = 1000000}", "c", weights);
  EXPECT_EQ(weights, (CostWeights{.state = 0.001, .multiplier = 1e6, .adder = 0.25, .table = 0}));
  const CostWeights before = weights;
  for (const char* text : {"", "tile_log2 = 2", "[cost]"}) parse_cost_weights(text, "c", weights);
  EXPECT_EQ(weights, before);
}

TEST(CostWeightsFile, AFileWithTheTableSetsTheSameKeys) {
  Config config;
  parse_config("significand_bits = 12\n[cost]\nstate = 3\n", "c", config);
  Config expected;
  expected.significand_bits = 12;
  EXPECT_EQ(config, expected);
}

TEST(CostWeightsFile, NamesThePlaceAndChangesNothing) {
  struct Bad {
    const char* line;
    std::initializer_list<std::string_view> fragments;
  };
  const Bad cases[] = {
      {"stat = 1", {"\"stat\"", "[cost]", "did you mean \"state\""}},
      {"multipliers = 1", {"did you mean \"multiplier\""}},
      {"significand_bits = 12", {"\"significand_bits\" in the table [cost]"}},
      {"state = \"1\"", {"\"state\" in the table [cost] holds a string", "a number from 0 to 1000000"}},
      {"state = true", {"holds a boolean"}},
      {"state = [1]", {"holds an array"}},
      {"state = {a = 1}", {"holds a table"}},
      {"state = -1", {"\"state\" in the table [cost] is -1", "a number from 0"}},
      {"state = -0.5", {"is -0.5"}},
      {"state = 1000000.5", {"a number from 0 to 1000000"}},
      {"state = nan", {"is nan"}},
      {"state = -nan", {"a number from 0"}},
      {"state = inf", {"is inf"}},
      {"state = -inf", {"is -inf"}},
      {"adder = 2", {"TOML", "adder"}},
      {"state", {"TOML"}},
  };
  for (const Bad& bad : cases) {
    SCOPED_TRACE(bad.line);
    const std::string text = "tile_log2 = 2\n[cost]\nadder = 2\n" + std::string(bad.line) + "\n";
    CostWeights weights;
    expect_input_error([&] { parse_cost_weights(text, "d/c.toml", weights); }, "d/c.toml:4", bad.fragments);
    EXPECT_EQ(weights, CostWeights{});
    Config config;  // the file is refused by those who do not need the weights too
    expect_input_error([&] { parse_config(text, "d/c.toml", config); }, "d/c.toml:4", bad.fragments);
    EXPECT_EQ(config, Config{});
  }
  CostWeights weights;
  expect_input_error([&] { parse_cost_weights("cost = 3", "c", weights); }, "c:1",
                     {"\"cost\" holds an integer", "[cost]"});
  expect_input_error([&] { parse_cost_weights("[cost]\nadder = 2\n[costs]\n", "c", weights); }, "c:3", {"'costs'"});
  expect_input_error([&] { parse_cost_weights("[cost]\nstat = 2\n[costs]\n", "c", weights); }, "c:2", {"\"state\"?"});
  EXPECT_EQ(weights, CostWeights{});
}

TEST(ConfigFile, TextGivesTheSameConfigurationBack) {
  Config config;
  for (const ConfigKey& key : Config::keys())  // a value that is neither the default nor auto, where there is one
    config.set(key.name, key.maximum != key.standard ? key.maximum : key.minimum);
  config.set("recip_segments_log2", -1);
  const CostWeights weights{1.0 / 3, 0, 1e6, 5e-324, 7, 0.1};
  const std::string text = config_text(config, weights);
  Config read;
  CostWeights read_weights;
  parse_config(text, "c", read);
  parse_cost_weights(text, "c", read_weights);
  EXPECT_EQ(read, config);
  EXPECT_EQ(read_weights, weights);
  for (const ConfigKey& key : Config::keys()) {
    const std::size_t line = text.find("\n" + std::string(key.name) + " = ");
    ASSERT_NE(line, std::string::npos) << key.name;
    const std::string range = std::to_string(key.minimum) + " to " + std::to_string(key.maximum);
    EXPECT_LT(text.find(range, line), text.find('\n', line + 1)) << key.name;
  }
}

/// Texts that would use up the stack or the memory of a reader.
TEST(ConfigFile, DeepNestingIsRefused) {
  Config config;
  std::string dotted = "a";
  for (int i = 0; i < 2000; ++i) dotted += ".a";
  for (const std::string& text :
       {"a = " + std::string(1'000'000, '['), "a = 1\n[" + std::string(100'000, 'x') + "]", dotted + " = 1"})
    expect_input_error([&] { parse_config(text, "file", config); }, "file:1", {});
}

TEST_F(InDirectory, CostWeightsFileErrors) {
  CostWeights weights;
  expect_input_error([&] { load_cost_weights(path("absent"), weights); }, path("absent"), {"No such file", "TOML"});
  load_cost_weights(write("good", "[cost]\nstate = 2.5"), weights);
  EXPECT_EQ(weights.state, 2.5);
}

TEST_F(InDirectory, ConfigFileErrors) {
  Config config;
  expect_input_error([&] { load_config(path("absent"), config); }, path("absent"), {"No such file", "TOML"});
  load_config(write("good", "tile_log2 = 2"), config);
  EXPECT_EQ(config.tile_log2, 2);
}

}  // namespace
}  // namespace quadrille::golden
