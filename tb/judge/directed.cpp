#include "tb/judge/directed.hpp"

#include "golden/analysis/judged_quad.hpp"
#include "golden/reference/port_number.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace quadrille::tb {
namespace {

/// Draws on a larger viewport are about the walk and its widths, and the truth looks at every pixel.
constexpr int most_extent = 64;

/// Of the quads of a group every how many are judged: where many cover much.
std::size_t stride(std::string_view group) {
  if (group == "two_edge") return 8;
  if (group == "flat") return 6;
  if (group == "den_w_zero" || group == "negative_r2" || group == "extreme") return 4;
  return group == "face_plane" ? 2 : 1;
}

golden::CornerDraw small_draw(std::string_view name) {
  golden::CornerDraw draw;
  draw.group = name;
  draw.state.width = draw.state.height = draw.state.scissor_x1 = draw.state.scissor_y1 = 32;
  return draw;
}

/// Four directions around the whole picture, seen from either side.
golden::CornerDraw at_infinity(const Config& config) {
  golden::CornerDraw draw = small_draw("at_infinity");
  draw.state.depth = false;  // else the depth of no quotient is beyond zfar
  draw.state.attributes = 1;
  const std::int32_t unit = std::int32_t{1} << (config.frac() - 2);
  SnappedQuad quad;
  constexpr std::array<std::array<int, 2>, 4> directions{{{4, 0}, {0, 4}, {-4, -2}, {1, -4}}};
  for (std::size_t i = 0; i < 4; ++i) {
    SnappedVertex& v = quad.vertex[i];
    v.x = directions[i][0] * unit;
    v.y = directions[i][1] * unit;
    v.k = golden::nearest_port_number(1, config.significand_bits);
    if (i > 0) v.attribute[0] = v.k;
  }
  draw.quads.push_back(quad);
  std::ranges::reverse(quad.vertex);
  draw.quads.push_back(quad);
  return draw;
}

/// Squares of ordinary vertices; slot 0 from `low` to 1.5 times the limit, slot 1 beyond it everywhere but at its base.
golden::CornerDraw saturated(const Config& config) {
  golden::CornerDraw draw = small_draw("saturated");
  draw.state.attributes = std::min(2, config.attribute_slots);
  const int s = config.significand_bits;
  const std::int64_t largest = attribute_format(config).largest_code();
  const double unit = attribute_format(config).unit(), limit = std::ldexp(1.0, config.attribute_int_bits);
  for (const double sign : {1.0, -1.0})
    for (const double low : {1.5, 1.0, -0.5, -1.5}) {
      const std::array<double, 4> first{low, 1.5, 1.25, low}, second{1.5, 2.5, 2, 1.25}, w{1, 2, 1, 4};
      SnappedQuad quad;
      const auto base = [&](double value) {
        return std::clamp<std::int64_t>(std::llround(std::ldexp(sign * limit * value, config.attribute_frac())),
                                        -largest, largest);
      };
      quad.base.attribute[0] = base(low);
      quad.base.attribute[1] = base(second[0]);
      quad.base.depth = std::uint32_t{1} << (config.depth_bits - 1);
      quad.base.depth_low = 0;
      quad.base.depth_high = std::int32_t{1} << config.depth_bits;
      for (std::size_t i = 0; i < 4; ++i) {
        SnappedVertex& v = quad.vertex[i];
        const auto place = static_cast<int>(draw.quads.size());
        v.x = (place % 3 * 10 + (i == 1 || i == 2 ? 8 : 0)) << config.frac();
        v.y = (place / 3 * 10 + (i >= 2 ? 8 : 0)) << config.frac();
        v.w = 1 << config.frac();
        v.k = golden::nearest_port_number(1 / w[i], s);
        const auto above = [&](double value, std::size_t slot) {
          const double b = static_cast<double>(quad.base.attribute[slot]) * unit;
          return golden::nearest_port_number((sign * limit * value - b) / w[i], s);
        };
        if (i > 0) v.attribute[0] = above(first[i], 0), v.attribute[1] = above(second[i], 1);
      }
      draw.quads.push_back(quad);
    }
  return draw;
}

}  // namespace

std::vector<golden::CornerDraw> directed_draws(const Config& config) {
  constexpr std::uint64_t seed = 1;
  std::vector<golden::CornerDraw> draws = golden::corner_draws(config, seed);
  std::erase_if(draws, [](const golden::CornerDraw& draw) {
    return std::max(draw.state.width, draw.state.height) > most_extent;
  });
  for (golden::CornerDraw& draw : draws) {
    std::vector<SnappedQuad> kept;
    for (std::size_t i = 0; i < draw.quads.size(); i += stride(draw.group)) kept.push_back(draw.quads[i]);
    draw.quads = std::move(kept);
  }
  draws.push_back(at_infinity(config));
  draws.push_back(saturated(config));
  return draws;
}

CheckResult judge_directed(const Config& config, PixelEngine engine) {
  CheckResult sum;
  for (const golden::CornerDraw& draw : directed_draws(config)) {
    CheckResult result = judge_untimed(draw.quads, config, draw.state, engine);
    if (result.first.any) result.first.text = std::string(draw.group) + ": " + result.first.text;
    sum.merge(result);
  }
  return sum;
}

}  // namespace quadrille::tb
