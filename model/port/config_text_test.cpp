// Configurations from text.
#include "model/port/config_text.hpp"

#include <gtest/gtest.h>

#include <string>

namespace quadrille {
namespace {

Config of(std::string_view text) {
  Config config;
  apply_config_text(text, config);
  return config;
}

std::string refusal(std::string_view text) {
  Config config;
  config.significand_bits = 20;
  const Config before = config;
  try {
    apply_config_text(text, config);
  } catch (const ConfigError& error) {
    EXPECT_EQ(config, before) << text;
    return error.what();
  }
  return "accepted";
}

TEST(ConfigText, LinesBlanksCommasAndComments) {
  Config expected;
  expected.significand_bits = 24;
  expected.attribute_slots = 2;
  expected.quadratic_frac_bits = -1;
  expected.notch_exact = 0;
  EXPECT_EQ(of("significand_bits = 24  # wide\n\n# nothing\nattribute_slots=2\r\nnotch_exact = false"), expected);
  EXPECT_EQ(of("significand_bits=24 attribute_slots=2,notch_exact=0 , quadratic_frac_bits=\"auto\""), expected);
  EXPECT_EQ(of("quadratic_frac_bits=auto significand_bits=24 attribute_slots=2 notch_exact=0"), expected);
  EXPECT_EQ(of(""), Config());
}

TEST(ConfigText, TheTableOfCostsIsPassedOver) {
  Config expected;
  expected.depth_bits = 16;
  EXPECT_EQ(of("depth_bits = 16\n[cost]\nstate = 1.5\nsignificand_bits = 8\n"), expected);
}

TEST(ConfigText, ARemovedKeyIsPassedOverWhereItWasOff) {
  Config expected;
  expected.depth_bits = 16;
  EXPECT_EQ(of("plane_tolerance_bits = 0\ndepth_bits = 16"), expected);
}

TEST(ConfigText, IntegersAreThoseOfToml) {
  // The grammar of TOML 1.0, "Integer".
  EXPECT_EQ(of("significand_bits = 0x0c").significand_bits, 12);
  EXPECT_EQ(of("significand_bits = 0o14").significand_bits, 12);
  EXPECT_EQ(of("significand_bits = 0b1100").significand_bits, 12);
  EXPECT_EQ(of("significand_bits = +1_2").significand_bits, 12);
  EXPECT_EQ(toml_integer("0xFf"), 255);
  EXPECT_EQ(toml_integer("-17"), -17);
  EXPECT_EQ(toml_integer("0"), 0);
  EXPECT_EQ(toml_integer("+0"), 0);
  EXPECT_EQ(toml_integer("2_147_483_647"), 2147483647);
  for (const char* wrong :
       {"",     "+",    "-",   "0x",  "0X0c", "-0x0c", "+0b1", "0x-1", "012", "-012",       "_1", "1_",
        "1__2", "0x_1", "0xg", "0b2", "0o8",  "1.0",   "1e3",  "+-1",  "--1", "2147483648", "1 2"})
    EXPECT_EQ(toml_integer(wrong), std::nullopt) << wrong;
}

TEST(ConfigText, EveryKeyIsReadBack) {
  Config expected;
  std::string text;
  for (const ConfigKey& key : Config::keys()) {
    const int value = key.name == "dot_units" ? 4 : key.name == "pixels_per_clock" ? 2 : expected.get(key.name);
    expected.set(key.name, value);
    text += std::string(key.name) + " = " + std::to_string(value) + "\n";
  }
  EXPECT_EQ(of(text), expected);
}

TEST(ConfigText, WhatIsWrongIsNamedWithItsLine) {
  const auto names = [](std::string_view text, std::string_view words) {
    const std::string message = refusal(text);
    EXPECT_NE(message.find(words), std::string::npos) << text << "\n" << message;
  };
  names("depth_bits = 16\nsignificant_bits = 24", "line 2: unknown configuration key");
  names("significant_bits = 24", "did you mean \"significand_bits\"");
  names("\nsignificand_bits = 99", "line 2: ");
  names("significand_bits = 1x", "\"1x\" is not an integer");
  names("significand_bits = 99999999999", "is not an integer");
  names("significand_bits =", "\"\" is not an integer");
  names("significand_bits = true", "\"true\" is not an integer");
  names("significand_bits", "expected key=value");
  names("= 3", "expected key=value");
  names("significand_bits=12=13", "two `=`");
  names("[costs]", "[cost] is the only one");
  names("guard_bits=4 viewport_bits=14", "VAL_BITS");
  names("SIGNIFICAND_BITS = 12", "did you mean \"significand_bits\"");
  // TOML knows each key once.
  names("significand_bits = 12\nguard_bits = 2\nsignificand_bits = 12",
        "line 3: key \"significand_bits\" was set before");
  names("significand_bits=12 significand_bits=12", "was set before");
  names("sqrt_degree = 2\nrsqrt_degree = 2", "line 2: key \"rsqrt_degree\" was set before, as \"sqrt_degree\"");
  names("[cost]\n[cost]", "line 2: a second table [cost]");
}

TEST(ConfigText, NumbersByName) {
  const Config config = of("significand_bits=12");
  EXPECT_EQ(config_number(config, "significand_bits"), 12);
  EXPECT_EQ(config_number(config, "attribute_frac_bits"), 24) << "auto is at least 24";
  EXPECT_EQ(config_number(config, "ATTR_PORT_BITS"), 1 + 9 + 12);
  EXPECT_EQ(config_number(config, "ATTR_PORT"), std::nullopt);
}

}  // namespace
}  // namespace quadrille
