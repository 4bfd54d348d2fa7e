// Random quads at the port hold what their header lists of depth and attributes.
#include "golden/scenes/random_quads.hpp"

#include "model/untimed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace quadrille::tb {
namespace {

/// Valid at the port: the codes of the specification's port, whatever the vertices are.
TEST(RandomQuads, AreLegalAtThePort) {
  for (const int attribute_int_bits : {1, 7, 15}) {
    Config config;
    config.set("attribute_int_bits", attribute_int_bits);
    const std::int64_t last = (std::int64_t{1} << (attribute_int_bits + config.attribute_frac())) - 1;
    const std::int32_t one = std::int32_t{1} << config.depth_bits;
    for (const SnappedQuad& quad : random_quads(config, small_state(config), 5, 400)) {
      for (const std::int64_t code : quad.base.attribute) EXPECT_LE(std::llabs(code), last);
      EXPECT_LE(quad.base.depth, static_cast<std::uint32_t>(one));
      EXPECT_LE(-1, quad.base.depth_low);
      EXPECT_LE(quad.base.depth_low, quad.base.depth_high);
      EXPECT_LE(quad.base.depth_high, one + 1);
      for (const PortNumber& b : quad.vertex[0].attribute) EXPECT_EQ(b.sig, 0u);
    }
  }
}

TEST(RandomQuads, ValuesAreCloseTogetherOrNot) {
  const Config config;
  constexpr int count = 1000;
  int full_range = 0, one_code = 0, wide = 0, constant = 0, close = 0, far = 0;
  for (const SnappedQuad& quad : random_quads(config, small_state(config), 6, count)) {
    const QuadBase& base = quad.base;
    const std::int32_t codes = base.depth_high - base.depth_low, one = std::int32_t{1} << config.depth_bits;
    full_range += codes == one + 2;
    one_code += codes <= 1;
    wide += codes > one / 4 && codes <= one;
    const double size = std::ldexp(static_cast<double>(std::llabs(base.attribute[0])), -config.attribute_frac());
    const auto difference = [&](std::size_t i) {
      const SnappedVertex& v = quad.vertex[i];
      if (v.attribute[0].sig == 0) return 0.0;
      return std::ldexp(static_cast<double>(v.attribute[0].sig) / v.k.sig, v.attribute[0].exp - v.k.exp);
    };
    const double spread = std::max({difference(1), difference(2), difference(3)});
    constant += spread == 0 && size > 0;
    close += spread > 0 && spread < size * 0x1p-10;
    far += size > 64 && spread < 0x1p-6;
  }
  EXPECT_GT(full_range, count / 8);
  EXPECT_GT(one_code, count / 50);
  EXPECT_GT(wide, count / 4);
  EXPECT_GT(constant, count / 50);
  EXPECT_GT(close, count / 20);
  EXPECT_GT(far, count / 200);
}

/// Attributes saturate, and depths are clamped to either corner code and drawn.
TEST(RandomQuads, TheMachineClamps) {
  const Config config;
  const DrawState state = small_state(config);
  UntimedModel model(config, state, PixelEngine::plain);
  int saturated = 0, low = 0, high = 0;
  for (const SnappedQuad& quad : random_quads(config, state, 7, 1000)) {
    const QuadBase& base = quad.base;
    const auto distance = static_cast<std::int64_t>(base.depth) - base.depth_low;
    model.draw(quad, [&](std::span<const Fragment> fragments) {
      for (const Fragment& f : fragments) {
        saturated += (f.flags & flag_saturated) != 0;
        low += distance > 0 && f.depth == static_cast<std::uint32_t>(std::max(base.depth_low, 0)) && base.depth_low > 0;
        high += f.depth == static_cast<std::uint32_t>(base.depth_high);
      }
    });
  }
  EXPECT_GT(saturated, 1000);
  EXPECT_GT(low, 500);
  EXPECT_GT(high, 500);
}

}  // namespace
}  // namespace quadrille::tb
