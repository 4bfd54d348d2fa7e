// The lanes' code as compiled for each instruction set that this processor has: every stage of lane_stages.hpp against
// the plain pipeline. (pixel_engines_test.cpp does the same with the other lanes.)
#include "model/support/lane_target.hpp"
#include "model/fast/each_lane_target.hpp"
#include "model/fast/lane_stages.hpp"

#include "model/support/prng.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace quadrille {
namespace {

using golden::Prng;

TEST(LaneTarget, WhatRunsHere) {
  std::size_t run = 0;
  for (const LaneTarget target : lane_targets()) {
    std::printf("lanes %s: %s\n", std::string(name(target)).c_str(),
                can_run(target) ? "run" : "NOT run, this processor lacks them");
    run += can_run(target);
    if (!can_run(target)) {
      EXPECT_THROW(set_lane_target(target), std::invalid_argument);
    }
  }
  EXPECT_TRUE(can_run(LaneTarget::baseline));
  EXPECT_GE(run, 1u);
  std::size_t visited = 0;
  const LaneTarget before = lane_target();
  on_each_lane_target([&] { ++visited; });
  EXPECT_EQ(visited, run);
  EXPECT_EQ(lane_target(), before);
  EXPECT_FALSE(before < LaneTarget::v4 && can_run(LaneTarget::v4)) << "the best is in use unless another is chosen";
}

TEST(LaneTarget, ByName) {
  const LaneTarget before = lane_target();
  set_lane_target("baseline");
  EXPECT_EQ(lane_target(), LaneTarget::baseline);
  set_lane_target(before);
  try {
    set_lane_target("v5");
    FAIL() << "there is no v5";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("\"v5\"; expected one of baseline"), std::string::npos) << error.what();
  }
}

/// Up to 2^top: long runs of ones, single bits and random bits, either sign.
std::int64_t pattern(Prng& rng, int top) {
  const auto n = static_cast<int>(rng.integer(0, top));
  const std::int64_t ones = (std::int64_t{1} << n) - 1;
  const std::int64_t value = rng.chance(0.3)   ? ones
                             : rng.chance(0.3) ? ones + 1
                                               : static_cast<std::int64_t>(rng.next() >> (63 - n) >> 1);
  return rng.chance(0.5) ? -value : value;
}

PipelineFloat port_number(Prng& rng, int s, bool sign) {
  const std::uint32_t low = 1u << (s - 1);
  const auto sig = static_cast<std::uint32_t>(rng.chance(0.3) ? 2 * low - 1 : low + rng.below(low));
  return {sign && rng.chance(0.5), static_cast<int>(rng.integer(-20, 20)), sig};
}

TEST(LaneStages, EachIsThePlainOne) {
  constexpr std::size_t blocks = 6, columns = 3;
  Prng rng(7);
  std::uint64_t compared = 0;
  for (int n = 0; n < 500; ++n) {
    Config c;
    c.significand_bits = 8 + n % 19;
    c.align_guard_bits = static_cast<int>(rng.below(7));
    c.notch_exact = static_cast<int>(rng.below(2));
    if (rng.chance(0.3)) c.quadratic_frac_bits = static_cast<int>(rng.integer(8, 30));
    if (rng.chance(0.3)) c.sqrt_degree = c.recip_degree = 1;
    c.attribute_slots = static_cast<int>(columns);
    c.attribute_int_bits = static_cast<int>(rng.integer(1, 15));
    if (rng.chance(0.3)) c.attribute_frac_bits = 30;
    c.depth_bits = static_cast<int>(rng.integer(8, 30));
    c.validate();
    DrawState state;
    state.attributes = static_cast<int>(columns);
    state.depth = rng.chance(0.7);
    if (rng.chance(0.3)) state.zfar = 0.75;
    const PipelineContext context(c, state);
    const LaneTable sqrt_table(context.sqrt_table), recip_table(context.recip_table);
    const int s = c.significand_bits, g = c.align_guard_bits;

    std::vector<DifferenceLanes> difference(blocks);
    std::vector<QuadData> quads(blocks);
    std::vector<QuadColumns> values(blocks);
    std::vector<std::uint32_t> quad(blocks);
    for (std::size_t b = 0; b < blocks; ++b) {
      quad[b] = static_cast<std::uint32_t>(blocks - 1 - b);
      quads[b].hull = values[b].hull = rng.chance(0.3);
      QuadBase& base = quads[b].base;
      for (std::size_t j = 0; j < columns; ++j)
        values[b].attribute_base[j] = base.attribute[j] = rng.chance(0.2)   ? c.attribute_limit()
                                                          : rng.chance(0.2) ? 0
                                                                            : rng.integer(-c.attribute_limit(), 0);
      base.depth = static_cast<std::uint32_t>(rng.integer(0, std::int64_t{1} << c.depth_bits));
      base.depth_low = static_cast<std::int32_t>(rng.chance(0.5) ? -1 : rng.integer(-1, base.depth));
      base.depth_high =
          static_cast<std::int32_t>(rng.chance(0.5) ? c.depth_above() : rng.integer(base.depth, c.depth_above()));
      values[b].base = base;
      for (std::size_t i = 0; i < 4; ++i) {
        values[b].k[i] = to_double(quads[b].k[i] = port_number(rng, s, false), s);
        values[b].w[i] = to_double(quads[b].w[i] = port_number(rng, s, true), s);
        values[b].z[i] = to_double(quads[b].z[i] = port_number(rng, s, true), s);
        for (std::size_t j = 0; j < columns && i != 0; ++j)
          values[b].b[j][i] =
              to_double(quads[b].b[i][j] = rng.chance(0.2) ? PipelineFloat{} : port_number(rng, s, true), s);
      }
      for (std::size_t l = 0; l < lane_count; ++l) {
        for (std::size_t k = 0; k < 6; ++k) {
          difference[b].a[k][l] = pattern(rng, 60);
          difference[b].d[k][l] = pattern(rng, 60);
        }
        for (std::size_t i = 0; i < 4; ++i)
          difference[b].r2[i][l] = (std::int64_t{1} << 60) + std::abs(pattern(rng, 60));
      }
    }

    on_each_lane_target([&] {
      std::vector<NormalisedLanes> normalised(blocks);
      std::vector<SqrtLanes> sqrt(blocks);
      std::vector<RatioLanes> ratio(blocks);
      std::vector<WeightLanes> weight(blocks);
      std::vector<LaneColumn> sums(blocks * sums_per_block(columns)), out(blocks * (1 + columns));
      std::vector<ReciprocalLanes> reciprocals(blocks);
      std::vector<LaneMasks> masks(blocks);
      normalise_blocks(difference, s, context.quadratic_bias, normalised.data());
      sqrt_blocks(normalised, s, sqrt_table, sqrt.data());
      ratio_blocks(normalised, sqrt.data(), s, g, ratio.data());
      weight_blocks(difference, ratio.data(), s, g, sqrt_table, weight.data());
      interpolate_blocks(weight, quad.data(), values.data(), columns, state.depth, s, g, sums.data());
      reciprocal_blocks(blocks, sums.data(), columns, s, recip_table, reciprocals.data());
      const LaneOutputFormat format{c.attribute_int_bits, context.attribute_frac, c.depth_bits,
                                    state.depth,          context.znear,          context.zfar};
      output_blocks(blocks, sums.data(), reciprocals.data(), quad.data(), values.data(), columns, format, out.data(),
                    masks.data());

      for (std::size_t b = 0; b < blocks; ++b) {
        const QuadData& data = quads[quad[b]];
        for (std::size_t l = 0; l < lane_count; ++l) {
          if (singular_lanes(difference[b]) >> l & 1) continue;
          PixelTrace p;
          p.valid = true;
          for (std::size_t k = 0; k < 6; ++k) {
            p.a[k] = difference[b].a[k][l];
            p.d[k] = difference[b].d[k][l];
          }
          for (std::size_t i = 0; i < 4; ++i) p.r2[i] = difference[b].r2[i][l];
          normalise(p, context);
          quadrille::sqrt_stage(p, context);
          mean_value_ratios(p, context);
          mean_value_weights(p, data, context);
          interpolate(p, data, context);
          fragment_output(p, data, context);
          const auto size = [&](const PipelineFloat& v) { return std::abs(to_double(v, s)); };
          for (std::size_t k = 0; k < 6; ++k) {
            ASSERT_EQ(normalised[b].a[k][l], size(p.a_fp[k]));
            ASSERT_EQ(normalised[b].d[k][l], size(p.d_fp[k]));
            ASSERT_EQ(ratio[b].u[k][l], size(p.u[k]));
            ASSERT_EQ(ratio[b].v[k][l], size(p.v[k]));
          }
          for (std::size_t i = 0; i < 4; ++i) {
            ASSERT_EQ(normalised[b].r2[i][l], size(p.r2_fp[i]));
            ASSERT_EQ(sqrt[b].root[i][l], size(p.root[i]));
            ASSERT_EQ(weight[b].m[i][l], size(p.m[i]));
          }
          const LaneColumn* sum = &sums[b * sums_per_block(columns)];
          ASSERT_EQ(sum[0].v[l], to_double(p.den_k, s));
          ASSERT_EQ(sum[1].v[l], to_double(p.den_w, s));
          ASSERT_EQ(sum[2].v[l], state.depth ? to_double(p.num_z, s) : 0);
          ASSERT_EQ(reciprocals[b].k[l], to_double(reciprocal(p.den_k, context.recip_table, context.format), s));
          ASSERT_EQ(reciprocals[b].w[l], to_double(reciprocal(p.den_w, context.recip_table, context.format), s));
          const LaneColumn* number = &out[b * (1 + columns)];
          ASSERT_EQ(number[0].v[l], std::ldexp(p.fragment.depth, -c.depth_bits));
          for (std::size_t j = 0; j < columns; ++j) {
            ASSERT_EQ(sum[3 + j].v[l], to_double(p.num_a[j], s));
            ASSERT_EQ(number[1 + j].v[l],
                      std::ldexp(static_cast<double>(p.fragment.attribute[j]), -context.attribute_frac));
          }
          ASSERT_EQ(masks[b].drawn >> l & 1, p.drawn ? 1 : 0);
          ASSERT_EQ(masks[b].saturated >> l & 1, p.fragment.flags & flag_saturated ? 1 : 0);
          ++compared;
        }
      }
    });
    if (HasFatalFailure()) FAIL() << "round " << n << ", S " << s;
  }
  EXPECT_GT(compared, 20'000u);
}

}  // namespace
}  // namespace quadrille
