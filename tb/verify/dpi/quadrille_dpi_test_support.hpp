// What the tests of quadrille dpi share.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>

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

namespace quadrille::dpi {

using Words = std::array<std::uint32_t, 128>;

enum Status { ok, bad_config, bad_name, bad_stimulus, bad_model };
constexpr std::uint64_t one = std::uint64_t{1} << 17;  ///< significand of a power of two, S = 18

inline std::uint64_t bits(const Words& words, int position, int width) {
  std::uint64_t value = 0;
  for (int i = width; i-- > 0;)
    value = value << 1 | (words[static_cast<std::size_t>((position + i) / 32)] >> (position + i) % 32 & 1);
  return value;
}

inline void set_bits(Words& words, int position, int width, std::uint64_t value) {
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

}  // namespace quadrille::dpi
