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
      {"significand_bits = \"auto\"", {"holds a string"}},
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

TEST(ConfigFile, ReportsTheFirstErrorOfTheFile) {
  Config config;
  expect_input_error([&] { parse_config("zzz = 1\naaa = 1\n", "c", config); }, "c:1", {"zzz"});
}

TEST_F(InDirectory, ConfigFileErrors) {
  Config config;
  expect_input_error([&] { load_config(path("absent"), config); }, path("absent"), {"No such file", "TOML"});
  load_config(write("good", "tile_log2 = 2"), config);
  EXPECT_EQ(config.tile_log2, 2);
}

}  // namespace
}  // namespace quadrille::golden
