#include "tb/verify/dpi/quadrille_dpi_test_support.hpp"

#include <cstring>
#include <fstream>
#include <regex>
#include <set>
#include <string>
#include <utility>

namespace quadrille::dpi {
namespace {

TEST_F(Dpi, ARecordIsLaidOutFromTheMostSignificantFieldDown) {
  int in = 0, out = 0;
  ASSERT_EQ(quadrille_record_bits(model_, "reciprocal", &in, &out), ok);
  EXPECT_EQ(in, 1 + 12 + 18);
  EXPECT_EQ(out, 31);
  ASSERT_EQ(quadrille_record_bits(model_, "sqrt", &in, &out), ok);
  EXPECT_EQ(in, 4 * (12 + 18));
  int position = 0, width = 0;
  ASSERT_EQ(quadrille_stimulus_field(model_, "sqrt", "exp", 1, &position, &width), ok);
  EXPECT_EQ(position, 4 * 18 + 12);
  EXPECT_EQ(width, 12);
  ASSERT_EQ(quadrille_response_field(model_, "reciprocal", "neg", -1, &position, &width), ok);
  EXPECT_EQ(position, 30);
  EXPECT_EQ(width, 1);
}

TEST_F(Dpi, EveryStageFunctionIsTheSuiteThatItNames) {
  const std::array<std::pair<StageCall*, std::string>, 12> stages{{{quadrille_snap, "snapping"},
                                                                   {quadrille_quad_setup, "setup"},
                                                                   {quadrille_tile_context, "tile_context"},
                                                                   {quadrille_stamp_coverage, "coverage"},
                                                                   {quadrille_forward_difference, "forward_difference"},
                                                                   {quadrille_normalise, "normalise"},
                                                                   {quadrille_sqrt, "sqrt"},
                                                                   {quadrille_reciprocal, "reciprocal"},
                                                                   {quadrille_mean_value_ratios, "ratios"},
                                                                   {quadrille_mean_value_weights, "weights"},
                                                                   {quadrille_interpolate, "interpolation"},
                                                                   {quadrille_fragment_output, "depth"}}};
  for (const auto& [call, suite] : stages) {
    int in = 0, out = 0;
    ASSERT_EQ(quadrille_record_bits(model_, suite.c_str(), &in, &out), ok) << quadrille_error();
    // A bit just above the record is refused with the suite's name; the record itself is not.
    Words words{};
    set_bits(words, in, 1, 1);
    response_.fill(1);
    EXPECT_EQ(call(model_, words.data(), response_.data()), bad_stimulus) << suite;
    EXPECT_NE(std::string(quadrille_error()).find("\"" + suite + "\""), std::string::npos) << quadrille_error();
    EXPECT_EQ(response_, Words{}) << suite;
    words.fill(0);
    Words by_name{};
    EXPECT_EQ(call(model_, words.data(), response_.data()), ok) << suite << ": " << quadrille_error();
    EXPECT_EQ(quadrille_respond(model_, suite.c_str(), words.data(), by_name.data()), ok) << suite;
    EXPECT_EQ(response_, by_name) << suite;
  }
}

TEST_F(Dpi, TheConfigurationSetsTheWidths) {
  reopen(" significand_bits=12\tattribute_slots=1 tile_log2=2 ");
  int value = 0;
  ASSERT_EQ(quadrille_value(model_, "significand_bits", &value), ok);
  EXPECT_EQ(value, 12);
  ASSERT_EQ(quadrille_value(model_, "sqrt_segments_log2", &value), ok);
  EXPECT_EQ(value, 3) << "auto is resolved: ceil((12 - 4) / 3)";
  ASSERT_EQ(quadrille_value(model_, "TILE", &value), ok);
  EXPECT_EQ(value, 4);
  int in = 0, out = 0;
  ASSERT_EQ(quadrille_record_bits(model_, "coverage", &in, &out), ok);
  EXPECT_EQ(out, 3 * 4 * 4);
}

TEST_F(Dpi, TheLongestRecordFits) {
  reopen("viewport_bits=14 guard_bits=1 subpixel_bits=8 homogeneous_frac_bits=6 significand_bits=26 attribute_slots=8");
  for (const char* suite : {"snapping", "setup", "tile_context", "coverage", "forward_difference", "normalise", "sqrt",
                            "reciprocal", "ratios", "weights", "interpolation", "depth"}) {
    int in = 0, out = 0;
    ASSERT_EQ(quadrille_record_bits(model_, suite, &in, &out), ok) << quadrille_error();
    EXPECT_LT(in, 4096) << suite;
    EXPECT_LT(out, 4096) << suite;
  }
}

TEST_F(Dpi, RefusesWhatItCannotDo) {
  void* other = &other;
  EXPECT_EQ(quadrille_open("significand_bits=99", &other), bad_config);
  EXPECT_EQ(other, nullptr);
  EXPECT_NE(std::string(quadrille_error()).find("significand_bits"), std::string::npos) << quadrille_error();
  EXPECT_EQ(quadrille_open("significand_bit=18", &other), bad_config);
  EXPECT_EQ(quadrille_open("significand_bits", &other), bad_config);
  EXPECT_EQ(quadrille_open("significand_bits=1e1", &other), bad_config);
  EXPECT_EQ(quadrille_open("viewport_bits=14 guard_bits=4", &other), bad_config) << "A, D, r² need more than 64 bits";
  EXPECT_EQ(quadrille_respond(nullptr, "sqrt", stimulus_.data(), response_.data()), bad_model);
  EXPECT_EQ(quadrille_sqrt(nullptr, stimulus_.data(), response_.data()), bad_model);
  EXPECT_EQ(quadrille_respond(model_, "rsqr", stimulus_.data(), response_.data()), bad_name);
  EXPECT_EQ(quadrille_respond(model_, "machine", stimulus_.data(), response_.data()), bad_name);
  int position = 0, width = 0;
  EXPECT_EQ(quadrille_stimulus_field(model_, "sqrt", "sig", 4, &position, &width), bad_name);
  EXPECT_EQ(quadrille_response_field(model_, "sqrt", "neg", 0, &position, &width), bad_name);
  EXPECT_EQ(quadrille_value(model_, "EXP_BIT", &width), bad_name);
}

TEST_F(Dpi, ANumberThatTheStageCannotBeGivenIsRefusedWithItsRange) {
  set("sqrt", "sig", 1, one / 2);  // no top bit
  response_.fill(1);
  EXPECT_EQ(quadrille_sqrt(model_, stimulus_.data(), response_.data()), bad_stimulus);
  EXPECT_EQ(response_, Words{});
  const std::string text = quadrille_error();
  EXPECT_NE(text.find("sig[1]"), std::string::npos) << text;
  EXPECT_NE(text.find("131072..262143 or 0"), std::string::npos) << text;
}

TEST(DpiPackage, ImportsWhatTheLibraryExports) {
  // The names of this file's declarations, which the linker has resolved.
  const std::set<std::string> exported{"quadrille_open",
                                       "quadrille_close",
                                       "quadrille_error",
                                       "quadrille_value",
                                       "quadrille_record_bits",
                                       "quadrille_stimulus_field",
                                       "quadrille_response_field",
                                       "quadrille_respond",
                                       "quadrille_snap",
                                       "quadrille_quad_setup",
                                       "quadrille_tile_context",
                                       "quadrille_stamp_coverage",
                                       "quadrille_forward_difference",
                                       "quadrille_normalise",
                                       "quadrille_sqrt",
                                       "quadrille_reciprocal",
                                       "quadrille_mean_value_ratios",
                                       "quadrille_mean_value_weights",
                                       "quadrille_interpolate",
                                       "quadrille_fragment_output"};
  std::ifstream in(QUADRILLE_DPI_PACKAGE);
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  const std::regex import("import \"DPI-C\" function \\w+ (\\w+)");
  std::set<std::string> imported;
  for (std::sregex_iterator it(text.begin(), text.end(), import), end; it != end; ++it) imported.insert((*it)[1]);
  EXPECT_EQ(imported, exported);
}

}  // namespace
}  // namespace quadrille::dpi
