// The functions of quadrille_dpi_pkg.sv as a simulator calls them: layout, errors, and one value a stage that follows
// from its definition.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <utility>

extern "C" {
int quadrille_open(const char* settings, void** model);
void quadrille_close(void* model);
const char* quadrille_error();
int quadrille_value(void* model, const char* name, int* value);
int quadrille_record_bits(void* model, const char* suite, int* stimulus_bits, int* response_bits);
int quadrille_stimulus_field(void* model, const char* suite, const char* name, int index, int* position, int* width);
int quadrille_response_field(void* model, const char* suite, const char* name, int index, int* position, int* width);
int quadrille_respond(void* model, const char* suite, const std::uint32_t* stimulus, std::uint32_t* response);
using StageCall = int(void* model, const std::uint32_t* stimulus, std::uint32_t* response);
StageCall quadrille_snap, quadrille_quad_setup, quadrille_tile_context, quadrille_stamp_coverage,
    quadrille_forward_difference, quadrille_normalise, quadrille_sqrt, quadrille_reciprocal,
    quadrille_mean_value_ratios, quadrille_mean_value_weights, quadrille_interpolate, quadrille_fragment_output;
}

namespace {

enum Status { ok, bad_config, bad_name, bad_stimulus, bad_model };
constexpr std::uint64_t one = std::uint64_t{1} << 17;  ///< significand of a power of two, S = 18

using Words = std::array<std::uint32_t, 128>;

std::uint64_t bits(const Words& words, int position, int width) {
  std::uint64_t value = 0;
  for (int i = width; i-- > 0;)
    value = value << 1 | (words[static_cast<std::size_t>((position + i) / 32)] >> (position + i) % 32 & 1);
  return value;
}

void set_bits(Words& words, int position, int width, std::uint64_t value) {
  for (int i = 0; i < width; ++i) {
    std::uint32_t& word = words[static_cast<std::size_t>((position + i) / 32)];
    const std::uint32_t bit = std::uint32_t{1} << (position + i) % 32;
    word = value >> i & 1 ? word | bit : word & ~bit;
  }
}

class Dpi : public testing::Test {
 protected:
  void SetUp() override { reopen(""); }
  void TearDown() override { quadrille_close(model_); }

  void reopen(const char* settings) {
    quadrille_close(model_);
    ASSERT_EQ(quadrille_open(settings, &model_), ok) << quadrille_error();
  }

  /// Fields by name: stimulus fields are set, then the response is read.
  void set(const char* suite, const char* name, int index, std::int64_t value) {
    int position = 0, width = 0;
    ASSERT_EQ(quadrille_stimulus_field(model_, suite, name, index, &position, &width), ok) << quadrille_error();
    set_bits(stimulus_, position, width, static_cast<std::uint64_t>(value));
  }
  std::int64_t get(const char* suite, const char* name, int index = -1) {
    int position = 0, width = 0;
    EXPECT_EQ(quadrille_response_field(model_, suite, name, index, &position, &width), ok) << quadrille_error();
    return static_cast<std::int64_t>(bits(response_, position, width));
  }
  std::int64_t get_signed(const char* suite, const char* name, int index = -1) {
    int position = 0, width = 0;
    EXPECT_EQ(quadrille_response_field(model_, suite, name, index, &position, &width), ok) << quadrille_error();
    return static_cast<std::int64_t>(bits(response_, position, width) << (64 - width)) >> (64 - width);
  }

  void* model_ = nullptr;
  Words stimulus_{}, response_{};
};

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

TEST_F(Dpi, ReciprocalOfMinusThree) {
  // -3 = -1.5·2^1; the bits are placed by hand.
  set_bits(stimulus_, 0, 18, one + one / 2);
  set_bits(stimulus_, 18, 12, 1);
  set_bits(stimulus_, 30, 1, 1);
  response_.fill(~std::uint32_t{0});
  ASSERT_EQ(quadrille_reciprocal(model_, stimulus_.data(), response_.data()), ok) << quadrille_error();
  EXPECT_EQ(bits(response_, 30, 1), 1u);
  EXPECT_EQ(bits(response_, 18, 12), 0xffeu) << "1/3 lies in [2^-2, 2^-1)";
  EXPECT_NEAR(static_cast<double>(bits(response_, 0, 18)), 4.0 / 3 * static_cast<double>(one), 1);
  for (std::size_t i = 1; i < response_.size(); ++i) EXPECT_EQ(response_[i], 0u) << "word " << i;
}

TEST_F(Dpi, SqrtOfFourPowersKeepsTheirOrder) {
  const std::array<int, 4> exponents{0, 2, 4, 40};  // 1, 4, 16, 2^40
  for (int i = 0; i < 4; ++i) {
    set("sqrt", "sig", i, one);
    set("sqrt", "exp", i, exponents[static_cast<std::size_t>(i)]);
  }
  ASSERT_EQ(quadrille_sqrt(model_, stimulus_.data(), response_.data()), ok) << quadrille_error();
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(get("sqrt", "sig", i), one) << i;
    EXPECT_EQ(get_signed("sqrt", "exp", i), exponents[static_cast<std::size_t>(i)] / 2) << i;
  }
}

TEST_F(Dpi, SnapPutsAPixelCentreAtAnInteger) {
  const auto real = [&](const char* name, int index, double value) {
    std::int64_t raw = 0;
    static_assert(sizeof raw == sizeof value);
    std::memcpy(&raw, &value, sizeof raw);
    set("snapping", name, index, raw);
  };
  // Vertex i at (3.5 + i, 0.75), z = 1/4 + i/8; attribute 2 is 3 at vertex 0, 3.5 at vertex 3, else 0.
  for (int i = 0; i < 4; ++i) {
    real("x", i, 3.5 + i);
    real("y", i, 0.75);
    real("z", i, 0.25 + i / 8.0);
    real("w", i, 1);
  }
  real("attr", 4 * 0 + 2, 3);
  real("attr", 4 * 3 + 2, 3.5);
  set("snapping", "perspective", -1, 1);
  ASSERT_EQ(quadrille_snap(model_, stimulus_.data(), response_.data()), ok) << quadrille_error();
  EXPECT_EQ(get("snapping", "refused"), 0);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(get_signed("snapping", "x", i), (3 + i) << 15);
    EXPECT_EQ(get_signed("snapping", "y", i), 1 << 13);
    EXPECT_EQ(get_signed("snapping", "w", i), 1 << 15);
  }
  EXPECT_EQ(get_signed("snapping", "base_attr", 2), 3 << 24);
  EXPECT_EQ(get("snapping", "base_depth"), 1 << 22);
  EXPECT_EQ(get_signed("snapping", "depth_low"), 1 << 22);
  EXPECT_EQ(get_signed("snapping", "depth_high"), 5 << 21);
  EXPECT_EQ(get("snapping", "z_sig", 0), 0);
  EXPECT_EQ(get_signed("snapping", "z_exp", 2), -2) << "1/2 - 1/4";
  EXPECT_EQ(get("snapping", "z_sig", 2), one);
  // Attribute 2 of vertices 1 and 3: -3 and 1/2.
  EXPECT_EQ(get("snapping", "attr_neg", 2), 1);
  EXPECT_EQ(get_signed("snapping", "attr_exp", 2), 1);
  EXPECT_EQ(get("snapping", "attr_sig", 2), 3 * one / 2);
  EXPECT_EQ(get("snapping", "attr_neg", 4 * 2 + 2), 0);
  EXPECT_EQ(get_signed("snapping", "attr_exp", 4 * 2 + 2), -1);
  EXPECT_EQ(get("snapping", "attr_sig", 4 * 2 + 2), one);
}

TEST_F(Dpi, SetupOfASquare) {
  // Corners (0, 0), (16, 0), (16, 16), (0, 16) with w = 1: E01 = S0 × S1 grows with y only.
  const std::array<int, 4> x{0, 16, 16, 0}, y{0, 0, 16, 16};
  for (int i = 0; i < 4; ++i) {
    set("setup", "x", i, x[static_cast<std::size_t>(i)] << 15);
    set("setup", "y", i, y[static_cast<std::size_t>(i)] << 15);
    set("setup", "w", i, 1 << 15);
  }
  set("setup", "scissor_x1", -1, 64);
  set("setup", "scissor_y1", -1, 64);
  ASSERT_EQ(quadrille_quad_setup(model_, stimulus_.data(), response_.data()), ok) << quadrille_error();
  EXPECT_EQ(get("setup", "homogeneous"), 0);
  EXPECT_EQ(get("setup", "tiles_x"), 3) << "pixels 0 to 16";
  EXPECT_EQ(get("setup", "visible"), 15);
  EXPECT_EQ(get_signed("setup", "lin_value", 0), 0);
  EXPECT_EQ(get_signed("setup", "lin_gx", 0), 0);
  EXPECT_EQ(get_signed("setup", "lin_gy", 0), std::int64_t{16} << 30) << "S0 × S1 at (0, y) = 16 y";
  EXPECT_EQ(get("setup", "length2", 0), std::int64_t{16 * 16} << 30) << "side 01";
  EXPECT_EQ(get("setup", "length2", 4), std::int64_t{2 * 16 * 16} << 30) << "diagonal 20";
}

TEST_F(Dpi, TileContextOfVerticesOnPixels) {
  // Vertex i at (10 + i, -i) of the quad's first tile, seen from the tile 2 columns and 1 row further, that is (16, 8).
  for (int i = 0; i < 4; ++i) {
    set("tile_context", "x", i, (10 + i) * (1 << 15));
    set("tile_context", "y", i, -i * (1 << 15));
    set("tile_context", "w", i, 1 << 15);
  }
  set("tile_context", "column", -1, 2);
  set("tile_context", "row", -1, 1);
  const std::int64_t unit = std::int64_t{1} << 30;
  for (const bool homogeneous : {false, true}) {
    set("tile_context", "homogeneous", -1, homogeneous);
    ASSERT_EQ(quadrille_tile_context(model_, stimulus_.data(), response_.data()), ok) << quadrille_error();
    // Squared distance of vertex 3, which is at (-3, -11) from there: (-3 - dx)^2 + (-11 - dy)^2.
    EXPECT_EQ(get_signed("tile_context", "quad_value", 9), (3 * 3 + 11 * 11) * unit);
    EXPECT_EQ(get_signed("tile_context", "quad_gx", 9), 6 * unit);
    EXPECT_EQ(get_signed("tile_context", "quad_gy", 9), 22 * unit);
    EXPECT_EQ(get_signed("tile_context", "quad_q", 9), unit);
    // Vertex 0 is at (-6, -8) from there, vertex 2 at (-4, -10): D20 is for a homogeneous quad.
    EXPECT_EQ(get_signed("tile_context", "quad_value", 4), homogeneous ? (24 + 80) * unit : 0);
    EXPECT_EQ(get_signed("tile_context", "quad_gx", 4), homogeneous ? 10 * unit : 0);
    EXPECT_EQ(get_signed("tile_context", "quad_gy", 4), homogeneous ? 18 * unit : 0);
    EXPECT_EQ(get_signed("tile_context", "quad_q", 4), homogeneous ? unit : 0);
  }
}

TEST_F(Dpi, CoverageOfATileInsideFourEdges) {
  for (int k = 0; k < 5; ++k) set("coverage", "lin_value", k, 1);
  set("coverage", "visible", -1, 1);
  set("coverage", "tile_x", -1, 2);
  set("coverage", "tile_y", -1, 1);
  set("coverage", "scissor_x0", -1, 18);
  set("coverage", "scissor_x1", -1, 21);
  set("coverage", "scissor_y0", -1, 0);
  set("coverage", "scissor_y1", -1, 9);
  ASSERT_EQ(quadrille_stamp_coverage(model_, stimulus_.data(), response_.data()), ok) << quadrille_error();
  EXPECT_EQ(get("coverage", "mask", 0), 0b00011100);
  EXPECT_EQ(get("coverage", "front", 0), 0);
  for (int row = 1; row < 8; ++row) EXPECT_EQ(get("coverage", "mask", row), 0) << row;
}

TEST_F(Dpi, ForwardDifferenceAtAPixel) {
  set("forward_difference", "row", -1, 3);
  set("forward_difference", "dx", -1, 5);
  for (int k = 0; k < 6; ++k) {
    set("forward_difference", "lin_value", k, -1000 * k);
    set("forward_difference", "lin_gx", k, 7);
    set("forward_difference", "lin_gy", k, -11);
  }
  for (int k = 0; k < 10; ++k) {
    set("forward_difference", "quad_value", k, 500 * k);
    set("forward_difference", "quad_gx", k, k);
    set("forward_difference", "quad_gy", k, -1);
    set("forward_difference", "quad_q", k, 2);
  }
  const auto quadratic = [](int k) { return 500 * k + 5 * k - 3 + 2 * (5 * 5 + 3 * 3); };
  const int first[] = {0, 1, 2, 3, 2, 1}, second[] = {1, 2, 3, 0, 0, 3};
  for (const bool homogeneous : {false, true}) {
    set("forward_difference", "homogeneous", -1, homogeneous);
    for (int k = 0; k < 6; ++k) set("forward_difference", "length2", k, 1000 * k);
    ASSERT_EQ(quadrille_forward_difference(model_, stimulus_.data(), response_.data()), ok) << quadrille_error();
    for (int k = 0; k < 6; ++k) {
      const int twice = quadratic(6 + first[k]) + quadratic(6 + second[k]) - 1000 * k;  // the law of cosines
      EXPECT_EQ(get_signed("forward_difference", "a", k), -1000 * k + 5 * 7 - 3 * 11) << k;
      EXPECT_EQ(get_signed("forward_difference", "d", k), homogeneous ? quadratic(k) : (twice - (twice & 1)) / 2) << k;
    }
    for (int k = 0; k < 4; ++k) EXPECT_EQ(get_signed("forward_difference", "r2", k), quadratic(6 + k)) << k;
  }
}

TEST_F(Dpi, NormaliseOfSmallIntegers) {
  set("normalise", "a", 2, -5);
  for (int i = 0; i < 4; ++i) set("normalise", "r2", i, i == 3 ? 0 : 1);
  ASSERT_EQ(quadrille_normalise(model_, stimulus_.data(), response_.data()), ok) << quadrille_error();
  EXPECT_EQ(get("normalise", "a_neg", 2), 1);
  EXPECT_EQ(get_signed("normalise", "a_exp", 2), 2);
  EXPECT_EQ(get("normalise", "a_sig", 2), 5 * one / 4);
  EXPECT_EQ(get("normalise", "on_vertex"), 1);
  EXPECT_EQ(get("normalise", "two_corner"), 0);
}

TEST_F(Dpi, RatioOfARightAngle) {
  // D = 0: u = r r', here 2^1·2^2, and v = |A| = 2^3.
  for (int i = 0; i < 4; ++i) {
    set("ratios", "root_sig", i, one);
    set("ratios", "root_exp", i, i == 0 ? 1 : i == 1 ? 2 : 0);
  }
  set("ratios", "a_sig", 0, one);
  set("ratios", "a_exp", 0, 3);
  ASSERT_EQ(quadrille_mean_value_ratios(model_, stimulus_.data(), response_.data()), ok) << quadrille_error();
  EXPECT_EQ(get("ratios", "u_sig", 0), one);
  EXPECT_EQ(get_signed("ratios", "u_exp", 0), 3);
  EXPECT_EQ(get("ratios", "v_sig", 0), one);
  EXPECT_EQ(get_signed("ratios", "v_exp", 0), 3);
}

TEST_F(Dpi, WeightAtAVertexIsOneThere) {
  set("weights", "corner", 2, 1);
  ASSERT_EQ(quadrille_mean_value_weights(model_, stimulus_.data(), response_.data()), ok) << quadrille_error();
  for (int i = 0; i < 4; ++i) EXPECT_EQ(get("weights", "sig", i), i == 2 ? one : 0) << i;
}

TEST_F(Dpi, InterpolationAddsUp) {
  // M = 1 at corners 1 and 2, k = 1: the denominator is 2. Attribute 3 differs from its base by 1 and -4 there: -3.
  for (int i = 1; i < 3; ++i) {
    set("interpolation", "m_sig", i, one);
    set("interpolation", "k_sig", i, one);
    set("interpolation", "b_sig", 3 * 3 + i - 1, one);
  }
  set("interpolation", "b_exp", 3 * 3 + 1, 2);
  set("interpolation", "b_neg", 3 * 3 + 1, 1);
  ASSERT_EQ(quadrille_interpolate(model_, stimulus_.data(), response_.data()), ok) << quadrille_error();
  EXPECT_EQ(get("interpolation", "den_k_sig"), one);
  EXPECT_EQ(get_signed("interpolation", "den_k_exp"), 1);
  EXPECT_EQ(get("interpolation", "attr_neg", 3), 1);
  EXPECT_EQ(get("interpolation", "attr_sig", 3), 3 * one / 2);
  EXPECT_EQ(get_signed("interpolation", "attr_exp", 3), 1);
  EXPECT_EQ(get("interpolation", "attr_sig", 2), 0);
}

TEST_F(Dpi, DepthIsAQuotientInFixedPoint) {
  // z = 1/2 / 2 in [0, 1], from 1/16 on; attribute 0 is -1 / 2, from 3 on.
  set("depth", "depth_on", -1, 1);
  set("depth", "zfar", -1, 1 << 24);
  set("depth", "attributes", -1, 1);
  set("depth", "z_sig", -1, one);
  set("depth", "z_exp", -1, -1);
  for (const char* name : {"den_k_sig", "den_w_sig"}) set("depth", name, -1, one);
  for (const char* name : {"den_k_exp", "den_w_exp"}) set("depth", name, -1, 1);
  set("depth", "attr_sig", 0, one);
  set("depth", "attr_neg", 0, 1);
  set("depth", "base_attr", 0, 3 << 24);
  set("depth", "base_depth", -1, 1 << 20);
  set("depth", "depth_high", -1, 1 << 24);
  ASSERT_EQ(quadrille_fragment_output(model_, stimulus_.data(), response_.data()), ok) << quadrille_error();
  EXPECT_EQ(get("depth", "valid"), 1);
  EXPECT_EQ(get("depth", "depth"), 5 << 20);
  EXPECT_EQ(get_signed("depth", "attr", 0), 5 << 23);
  // No depth is above the corners'.
  set("depth", "depth_high", -1, 3 << 20);
  ASSERT_EQ(quadrille_fragment_output(model_, stimulus_.data(), response_.data()), ok) << quadrille_error();
  EXPECT_EQ(get("depth", "depth"), 3 << 20);
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
