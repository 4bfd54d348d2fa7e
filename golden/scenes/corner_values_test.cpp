// The groups about depth and attributes hold their cases, by the snapped integers and by the pixels of the plain
// pipeline.
#include "golden/scenes/corner_quads.hpp"
#include "golden/scenes/corner_test_support.hpp"
#include "model/port/snap.hpp"
#include "model/port/stages.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>

namespace quadrille::golden {
namespace {

std::int64_t low_of(const SnappedQuad& quad) { return quad.base.depth_low; }
std::int64_t high_of(const SnappedQuad& quad) { return quad.base.depth_high; }

/// Covered and drawn pixels of each quad.
struct Pixels {
  int covered = 0, drawn = 0;
};

std::map<std::uint32_t, Pixels> pixels_of(const CornerDraw& draw, const Config& config) {
  std::map<std::uint32_t, Pixels> pixels;
  for_each_pixel(draw, config, [&](const SnappedQuad& quad, const TileEntry&, const PixelTrace& p) {
    ++pixels[quad.id].covered;
    pixels[quad.id].drawn += p.drawn;
  });
  return pixels;
}

/// All of a quad between the limits is drawn, nothing of one beyond them, and of one that they cut some.
TEST(CornerValues, DepthLimitsAtTheCornersCodes) {
  for (const Config& config : {Config{}, narrow_config()}) {
    const CornerDraw draw = draw_of(config, CornerGroup::z_limits);
    const std::int64_t znear = depth_code(draw.state.znear, config), zfar = depth_code(draw.state.zfar, config);
    std::map<std::int64_t, int> low_at, high_at;  // least and greatest codes by their distance from a limit
    int inside = 0, outside = 0, cut = 0, both = 0;
    auto pixels = pixels_of(draw, config);
    for (const SnappedQuad& quad : draw.quads) {
      const Pixels& p = pixels[quad.id];
      for (const std::int64_t limit : {znear, zfar}) {
        ++low_at[low_of(quad) - limit];
        ++high_at[high_of(quad) - limit];
      }
      if (p.covered == 0) continue;
      if (low_of(quad) >= znear && high_of(quad) <= zfar) {
        ++inside;
        EXPECT_EQ(p.drawn, p.covered) << "quad " << quad.id;
      } else if (high_of(quad) < znear || low_of(quad) > zfar) {
        ++outside;
        EXPECT_EQ(p.drawn, 0) << "quad " << quad.id;
      } else {
        ++cut;
        both += p.drawn != 0 && p.drawn != p.covered;
      }
    }
    for (const std::int64_t apart : {-1, 0, 1}) {
      EXPECT_GT(low_at[apart], 3) << apart;
      EXPECT_GT(high_at[apart], 3) << apart;
    }
    EXPECT_GT(inside, 20);
    EXPECT_GT(outside, 5);
    EXPECT_GT(cut, 40);
    EXPECT_GT(both, 20);
  }
}

TEST(CornerValues, DepthIsJustBelowZero) {
  const Config config;
  int kept = 0, below = 0;
  for_each_pixel(draw_of(config, CornerGroup::minus_zero), config,
                 [&](const SnappedQuad& quad, const TileEntry&, const PixelTrace& p) {
                   const bool negative = p.num_z.neg != p.den_w.neg && p.num_z.sig != 0;
                   kept += negative && low_of(quad) == 0 && p.drawn && p.fragment.depth == 0;
                   below += negative && low_of(quad) == -1 && !p.drawn;
                 });
  EXPECT_GT(kept, 100);
  EXPECT_GT(below, 100);
}

/// Every pixel of a quad of one depth has that depth: at the limits and beside them, whatever its w.
TEST(CornerValues, ConstantDepthIsConstant) {
  for (const Config& config : {Config{}, narrow_config()}) {
    const CornerDraw draw = draw_of(config, CornerGroup::constant_depth);
    const std::int64_t znear = depth_code(draw.state.znear, config), zfar = depth_code(draw.state.zfar, config);
    std::map<std::int64_t, int> codes;
    int perspective = 0, beyond = 0, mixed = 0;
    std::map<std::uint32_t, std::int64_t> code_of;
    for (const WindowQuad& quad : make_corner(CornerGroup::constant_depth, config, draw.state, 1, 0))
      code_of[quad.id] = static_cast<std::int64_t>(std::ldexp(quad.vertex[0].z / quad.vertex[0].w, config.depth_bits));
    for_each_pixel(draw, config, [&](const SnappedQuad& quad, const TileEntry&, const PixelTrace& p) {
      const std::int64_t code = code_of[quad.id];
      ++codes[code];
      const bool front = std::ranges::all_of(quad.vertex, [](const SnappedVertex& v) { return v.w > 0; });
      if (front) {
        EXPECT_EQ(low_of(quad), code);
        EXPECT_EQ(high_of(quad), code);
        EXPECT_EQ(p.drawn, znear <= code && code <= zfar) << "quad " << quad.id;
      }
      if (p.drawn && code <= zfar) {
        EXPECT_EQ(p.fragment.depth, code) << "quad " << quad.id;
      }
      mixed += !front && p.drawn;
      beyond += front && !is_ordinary(quad, config) && p.drawn;
      perspective += p.drawn && is_ordinary(quad, config) && quad.vertex[0].k.sig != quad.vertex[1].k.sig;
    });
    for (const std::int64_t limit : {znear, zfar})
      for (const std::int64_t apart : {-1, 0, 1}) EXPECT_GT(codes[limit + apart], 20) << limit << " " << apart;
    EXPECT_GT(mixed, 100);
    EXPECT_GT(beyond, 100);
    EXPECT_GT(perspective, 100);
  }
}

/// Differences of one corner alone: each of the four, of one code and of the whole range.
TEST(CornerValues, OneCornerDiffers) {
  const Config config;
  const CornerDraw draw = draw_of(config, CornerGroup::one_corner);
  std::set<std::size_t> of_depth, of_attribute;
  int one_code = 0, whole_range = 0, attribute_code = 0;
  for (const SnappedQuad& quad : draw.quads) {
    std::vector<std::size_t> depth, attribute;
    for (std::size_t i = 0; i < 4; ++i) {
      if (quad.vertex[i].z.sig != 0) depth.push_back(i);
      if (quad.vertex[i].attribute[0].sig != 0) attribute.push_back(i);
    }
    if (depth.size() == 1) of_depth.insert(depth[0]);
    if (depth.size() == 3) of_depth.insert(0);  // the base is of the corner that differs
    if (attribute.size() == 1) of_attribute.insert(attribute[0]);
    if (attribute.size() == 3) of_attribute.insert(0);
    one_code += high_of(quad) - low_of(quad) == 1;
    whole_range += high_of(quad) - low_of(quad) == std::int64_t{1} << config.depth_bits;
    const int k_exp = quad.vertex[1].k.exp, exp = quad.vertex[1].attribute[0].exp;
    attribute_code += attribute.size() == 1 && attribute[0] == 1 && exp - k_exp == -config.attribute_frac();
  }
  EXPECT_EQ(of_depth.size(), 4u);
  EXPECT_EQ(of_attribute.size(), 4u);
  EXPECT_GT(one_code, 20);
  EXPECT_GT(whole_range, 20);
  EXPECT_GT(attribute_code, 2);
}

TEST(CornerValues, BasesAreAtTheEndsOfTheFormats) {
  const Config config;
  const CornerDraw draw = draw_of(config, CornerGroup::far_base);
  const std::int64_t last = (std::int64_t{1} << (config.attribute_int_bits + config.attribute_frac())) - 1;
  int low = 0, high = 0, deep = 0, few_codes = 0;
  for (const SnappedQuad& quad : draw.quads) {
    EXPECT_GE(std::llabs(quad.base.attribute[0]), last - 3);
    low += quad.base.attribute[0] == -last;
    high += quad.base.attribute[0] == last;
    deep += high_of(quad) == std::int64_t{1} << config.depth_bits;
    few_codes += high_of(quad) - low_of(quad) <= 2;
  }
  EXPECT_GT(low, 2);
  EXPECT_GT(high, 2);
  EXPECT_GT(deep, 10);
  EXPECT_EQ(few_codes, static_cast<int>(draw.quads.size()));
}

/// At a corner that has a pixel to itself the quotient is its difference: half a code, rounded away from the base.
TEST(CornerValues, QuotientsAreTies) {
  const Config config;
  const CornerDraw draw = draw_of(config, CornerGroup::ties);
  int up = 0, down = 0, depth_up = 0, depth_down = 0;
  for_each_pixel(draw, config, [&](const SnappedQuad& quad, const TileEntry&, const PixelTrace& p) {
    if (!p.on_vertex || p.two_corner) return;
    const auto at = static_cast<std::size_t>(std::ranges::find(p.r2, 0) - p.r2.begin());
    const auto codes = [](const PortNumber& d, int frac, int s) {
      return (d.neg ? -1 : 1) * std::ldexp(static_cast<double>(d.sig), d.exp - (s - 1) + frac);
    };
    const auto half = [](double v) { return std::floor(v) + 0.5 == v; };
    const auto away = [](double v) { return static_cast<std::int64_t>(std::lround(v)); };  // halves away from zero
    const SnappedVertex& v = quad.vertex[at];
    const double d = codes(v.attribute[0], config.attribute_frac(), config.significand_bits);
    if (half(d)) {
      EXPECT_EQ(p.fragment.attribute[0], quad.base.attribute[0] + away(d));
      (d > 0 ? up : down) += 1;
    }
    const double z = codes(v.z, config.depth_bits, config.significand_bits);
    if (half(z)) {
      EXPECT_EQ(p.fragment.depth, std::clamp(std::int64_t{quad.base.depth} + away(z), low_of(quad), high_of(quad)));
      (z > 0 ? depth_up : depth_down) += 1;
    }
  });
  for (const int count : {up, down, depth_up, depth_down}) EXPECT_GT(count, 10);
}

TEST(CornerValues, QuotientsAndSumsLeaveTheFormats) {
  const Config config;
  const CornerDraw draw = draw_of(config, CornerGroup::saturation);
  const std::int64_t last = (std::int64_t{1} << (config.attribute_int_bits + config.attribute_frac())) - 1;
  // Of the exact quotient, in double: its sign, and whether it or the sum alone is beyond the format.
  std::map<std::pair<bool, bool>, int> attribute, depth;
  int changed_low = 0, changed_high = 0;
  for_each_pixel(draw, config, [&](const SnappedQuad& quad, const TileEntry&, const PixelTrace& p) {
    const auto number = [&](const PipelineFloat& f) {
      return (f.neg ? -1 : 1) * std::ldexp(static_cast<double>(f.sig), f.exp);
    };
    const double a = number(p.num_a[0]) / number(p.den_k) * std::ldexp(1.0, config.attribute_frac());
    const bool far = std::fabs(a) > 2.001 * static_cast<double>(last);
    if (far || std::fabs(static_cast<double>(quad.base.attribute[0]) + a) > 1.001 * static_cast<double>(last)) {
      EXPECT_EQ(p.fragment.attribute[0], a > 0 ? last : -last);
      EXPECT_NE(p.fragment.flags & flag_saturated, 0);
      ++attribute[{a < 0, far}];
    }
    const double z = number(p.num_z) / number(p.den_w) * std::ldexp(1.0, config.depth_bits);
    const bool deep = std::fabs(z) > 2.001 * std::ldexp(1.0, config.depth_bits);
    const double sum = static_cast<double>(quad.base.depth) + z;
    if (deep || sum > static_cast<double>(high_of(quad)) + 1 || sum < static_cast<double>(low_of(quad)) - 1) {
      EXPECT_EQ(p.fragment.depth, sum > static_cast<double>(low_of(quad)) ? high_of(quad) : low_of(quad));
      ++depth[{z < 0, deep}];
      changed_low += p.drawn && p.fragment.depth == low_of(quad);
      changed_high += p.drawn && p.fragment.depth == high_of(quad);
    }
  });
  for (const bool negative : {false, true})
    for (const bool quotient : {false, true}) {
      EXPECT_GT((attribute[{negative, quotient}]), 20) << negative << quotient;
      EXPECT_GT((depth[{negative, quotient}]), 20) << negative << quotient;
    }
  EXPECT_GT(changed_low, 100);
  EXPECT_GT(changed_high, 100);
}

/// Without a denominator depth is the greatest corner's, and so it is drawn where that lies within the limits.
TEST(CornerValues, WithoutADenominatorDepthIsTheGreatest) {
  const Config config = narrow_config();
  int drawn = 0, discarded = 0;
  for_each_pixel(draw_of(config, CornerGroup::den_w_zero), config,
                 [&](const SnappedQuad& quad, const TileEntry&, const PixelTrace& p) {
                   if (p.den_w.sig != 0 || p.hull) return;
                   EXPECT_EQ(p.fragment.depth, high_of(quad));
                   (p.drawn ? drawn : discarded) += 1;
                 });
  EXPECT_GT(drawn, 20);
  EXPECT_GT(discarded, 20);
}

}  // namespace
}  // namespace quadrille::golden
