// What base and difference give to people: which of two parallel planes close together a depth buffer shows, and what
// texture coordinates and depths that vary little over a quad are off by. Prints the tables of tb/MEASUREMENTS.md and
// golden/analysis/README.md.
#include "golden/analysis/error_bound.hpp"
#include "golden/scenes/plane_pair.hpp"
#include "model/support/prng.hpp"
#include "tb/engines/engine.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <optional>
#include <string>

namespace quadrille::campaign {
namespace {

using golden::PlanePair;
using golden::PlaneView;
using tb::EngineKind;
using tb::EngineSample;

constexpr int size = 256, small_size = 128;

DrawState picture(int edge = size) {
  DrawState state;
  state.width = state.height = state.scissor_x1 = state.scissor_y1 = edge;
  return state;
}

Config of_bits(int significand_bits) {
  Config config;
  config.set("significand_bits", significand_bits);
  return config;
}

/// Window z at each pixel that both planes cover: of the nearer plane, of the other.
using Depths = std::map<std::array<int, 2>, std::array<double, 2>>;

Depths draw(EngineKind kind, const Config& config, const std::vector<WindowQuad>& quads, bool snap, int edge = size) {
  tb::EngineSettings settings;
  settings.kind = kind;
  settings.config = config;
  settings.state = picture(edge);
  settings.snap = snap;
  std::map<std::array<int, 2>, std::array<std::optional<double>, 2>> found;
  tb::make_engine(settings)->draw(quads, 0, false, [&](std::span<const EngineSample> samples) {
    for (const EngineSample& s : samples)
      if (!s.undefined) found[{s.x, s.y}][s.index] = s.z;
  });
  Depths depths;
  for (const auto& [pixel, z] : found)
    if (z[0] && z[1]) depths[pixel] = {*z[0], *z[1]};
  return depths;
}

/// What a depth buffer of this many bits keeps of window z.
double stored(double z, int bits) { return std::floor(std::ldexp(z, bits) + 0.5); }

/// Pixels that show the farther plane though the nearer one is drawn last: its depth is not the less one. Of a reversed
/// depth buffer, not the greater one.
int wrong_pixels(const Depths& depths, bool reversed, int bits) {
  return static_cast<int>(std::ranges::count_if(depths, [&](const auto& pixel) {
    const double nearer = stored(pixel.second[0], bits), farther = stored(pixel.second[1], bits);
    return reversed ? nearer <= farther : nearer >= farther;
  }));
}

/// Of exact depths: in the wrong order, or none.
int wrong_order(const Depths& depths, bool reversed) {
  return static_cast<int>(std::ranges::count_if(depths, [&](const auto& pixel) {
    return reversed ? pixel.second[0] <= pixel.second[1] : pixel.second[0] >= pixel.second[1];
  }));
}

double spread_of(const WindowQuad& quad) {
  const auto depth = [](const WindowVertex& v) { return v.z / v.w; };
  const auto [low, high] = std::ranges::minmax(quad.vertex, {}, depth);
  return depth(high) - depth(low);
}

/// Pixels in which the model has the planes in the wrong order though the exact depths are far enough apart.
struct Faults {
  int beyond_bounds = 0;  ///< by more than both bounds
  int two_codes = 0;      ///< by two codes at least
  int claimed = 0;        ///< pixels, wrong or not, whose exact depths are apart by more than both bounds
};

Faults faults_of(const Depths& drawn, const Depths& exact, const PlanePair& pair, const std::vector<WindowQuad>& quads,
                 const Config& config) {
  const double both = bound_depth(config, spread_of(quads[0])).value + bound_depth(config, spread_of(quads[1])).value;
  Faults faults;
  for (const auto& [pixel, z] : drawn) {
    const auto at = exact.find(pixel);
    if (at == exact.end()) {
      ADD_FAILURE() << "the truth draws nothing at " << pixel[0] << ", " << pixel[1];
      continue;
    }
    const double apart = at->second[1] - at->second[0];
    const bool wrong = pair.reversed ? z[0] <= z[1] : z[0] >= z[1];
    faults.claimed += std::fabs(apart) > both;
    faults.beyond_bounds += wrong && std::fabs(apart) > both;
    faults.two_codes += wrong && std::fabs(apart) >= std::ldexp(2.0, -config.depth_bits);
  }
  return faults;
}

constexpr std::array<bool, 2> directions{false, true};

std::string title(const PlanePair& pair) {
  return std::string(plane_view_name(pair.view)) + (pair.reversed ? " reversed" : "");
}

/// Planes whose exact depths differ by more than the bounds of both are told apart in every pixel, whatever the number
/// of bits; those that face the camera or are turned away from it, from 18 bits on also where they are two codes apart.
class PlanesOfBits : public testing::TestWithParam<int> {};

TEST_P(PlanesOfBits, AreToldApartWithinTheBounds) {
  const int s = GetParam();
  const Config config = of_bits(s);
  int pixels = 0, claimed = 0, apart = 0;
  for (const PlaneView view : golden::plane_views)
    for (const bool reversed : directions)
      for (const double distance : golden::plane_distances) {
        const PlanePair pair{view, distance, reversed};
        const auto quads = plane_pair(pair, small_size, small_size);
        const Depths drawn = draw(EngineKind::model, config, quads, true, small_size);
        const Depths exact = draw(EngineKind::truth, config, quads, true, small_size);
        const Faults faults = faults_of(drawn, exact, pair, quads, config);
        EXPECT_EQ(faults.beyond_bounds, 0) << title(pair) << ", " << distance << " apart";
        if (view != PlaneView::floor && s >= 18) {
          EXPECT_EQ(faults.two_codes, 0) << title(pair) << ", " << distance << " apart";
        }
        pixels += static_cast<int>(drawn.size());
        claimed += faults.claimed;
        apart += wrong_pixels(drawn, reversed, config.depth_bits) == 0;
      }
  EXPECT_GT(pixels, 400'000);
  EXPECT_GT(claimed, pixels / 3);
  std::printf("%d bits: %d of 48 pairs of planes are told apart in every pixel; the bounds say so of %d of %d pixels\n",
              s, apart, claimed, pixels);
}

INSTANTIATE_TEST_SUITE_P(Campaign, PlanesOfBits, testing::Values(8, 10, 12, 14, 16, 18, 20, 22, 24, 26),
                         testing::PrintToStringParamName());

/// The table: how many pixels show the wrong plane.
TEST(Planes, WrongPixels) {
  const int bits = Config{}.depth_bits;
  std::printf("wrong pixels of %d x %d, depth buffer of %d bits; planes at distance 50, near 0.1, far 100\n", size,
              size, bits);
  std::printf("%-16s %6s %7s %6s | %7s %7s %7s | %7s %7s | %8s %8s\n", "view", "apart", "pixels", "codes", "s = 12",
              "s = 18", "fp32", "snapped", "given", "order 12", "order 18");
  for (const PlaneView view : golden::plane_views)
    for (const bool reversed : directions)
      for (const double distance : golden::plane_distances) {
        const PlanePair pair{view, distance, reversed};
        const auto quads = plane_pair(pair, size, size);
        const auto wrong = [&](const Depths& depths) { return wrong_pixels(depths, reversed, bits); };
        const Depths given = draw(EngineKind::truth, Config{}, quads, false);
        double codes = 1e9;
        for (const auto& [pixel, z] : given) codes = std::min(codes, std::ldexp(std::fabs(z[1] - z[0]), bits));
        const Depths snapped = draw(EngineKind::truth, of_bits(18), quads, true);
        // Snapping alone: exact depths of the snapped quads in another order than those of the given ones.
        const auto order = [&](const Depths& depths) { return wrong_order(depths, reversed); };
        std::printf("%-16s %6g %7zu %6.1f | %7d %7d %7d | %7d %7d | %8d %8d\n", title(pair).c_str(), distance,
                    given.size(), codes, wrong(draw(EngineKind::model, of_bits(12), quads, true)),
                    wrong(draw(EngineKind::model, of_bits(18), quads, true)),
                    wrong(draw(EngineKind::paper_single, Config{}, quads, false)), wrong(snapped), wrong(given),
                    order(draw(EngineKind::truth, of_bits(12), quads, true)), order(snapped));
        EXPECT_EQ(wrong_order(given, reversed), 0) << title(pair);
        EXPECT_GT(given.size(), 10'000u) << title(pair);
      }
}

// ---- Values that vary little ----------------------------------------------------------------------------------------

/// Quads of a mesh as a camera sees them: 12 to 28 px wide, u and v spread over 0.01 somewhere in [0, 1] and [0, 8],
/// window z over 0.0004 around 0.998. Attributes u, v, z.
std::vector<WindowQuad> mesh_like_quads() {
  golden::Prng rng(28);
  std::vector<WindowQuad> quads(300);
  for (std::size_t n = 0; n < quads.size(); ++n) {
    WindowQuad& quad = quads[n];
    quad.id = static_cast<std::uint32_t>(n);
    const double edge = rng.uniform(12, 28), cx = rng.uniform(20, size - 20), cy = rng.uniform(20, size - 20);
    const double turn = rng.uniform(0, 2 * std::acos(-1.0)), u = rng.uniform(0, 0.99), v = rng.uniform(0, 7.99);
    for (std::size_t i = 0; i < 4; ++i) {
      const double angle = turn + static_cast<double>(i) * std::acos(0.0), w = rng.uniform(0.9, 1.1);
      const double reach = edge / std::sqrt(2.0) * rng.uniform(0.95, 1.05);
      const double x = cx + reach * std::cos(angle), y = cy + reach * std::sin(angle);
      const double z = 0.998 + 0.0004 * rng.uniform(-0.5, 0.5);
      quad.vertex[i] = {x * w, y * w, z * w, w};
      quad.attribute[i] = {u + rng.uniform(0, 0.01), v + rng.uniform(0, 0.01), z};
    }
  }
  return quads;
}

struct Values {
  std::array<double, 3> attribute{};
  double z = 0;
};
using Fragments = std::map<std::array<int, 3>, Values>;  ///< quad, x, y

Fragments draw_values(EngineKind kind, const Config& config, const std::vector<WindowQuad>& quads) {
  tb::EngineSettings settings;
  settings.kind = kind;
  settings.config = config;
  settings.state = picture();
  Fragments fragments;
  tb::make_engine(settings)->draw(quads, 3, false, [&](std::span<const EngineSample> samples) {
    for (const EngineSample& s : samples)
      fragments[{static_cast<int>(s.index), s.x, s.y}] = {{s.attribute[0], s.attribute[1], s.attribute[2]}, s.z};
  });
  return fragments;
}

/// The largest errors of u, v, z as an attribute, and window z. With the default formats half a code, 2^-25, is the
/// least that can be; more fraction bits show the arithmetic.
TEST(BaseAndDifference, ErrorsFollowWhatVaries) {
  const auto quads = mesh_like_quads();
  std::printf("largest error against exact arithmetic on the same snapped quads, log2\n");
  std::printf("%3s %9s %9s | %7s %7s %7s %7s\n", "s", "fraction", "fragments", "u", "v", "z", "depth");
  for (const int s : {12, 18, 24})
    for (const int fraction : {of_bits(s).attribute_frac(), 30}) {
      Config config = of_bits(s);
      config.set("attribute_frac_bits", fraction);
      const Fragments drawn = draw_values(EngineKind::model, config, quads);
      const Fragments exact = draw_values(EngineKind::truth, config, quads);
      ASSERT_EQ(drawn.size(), exact.size());
      EXPECT_NEAR(static_cast<double>(drawn.size()), 127'000, 4'000);
      std::array<double, 4> worst{};
      for (const auto& [at, values] : drawn) {
        const auto& truth = exact.at(at);
        for (std::size_t a = 0; a < 3; ++a)
          worst[a] = std::max(worst[a], std::fabs(values.attribute[a] - truth.attribute[a]));
        worst[3] = std::max(worst[3], std::fabs(values.z - truth.z));
      }
      std::printf("%3d %9d %9zu | %7.1f %7.1f %7.1f %7.1f\n", s, fraction, drawn.size(), std::log2(worst[0]),
                  std::log2(worst[1]), std::log2(worst[2]), std::log2(worst[3]));
      // u and v alike, of any size: what varies is the same.
      for (const std::size_t a : {0, 1}) EXPECT_LE(worst[a], bound_attribute(config, 0.01).value) << s << " slot " << a;
      EXPECT_LE(worst[2], bound_attribute(config, 0.0004).value) << s;
      EXPECT_LE(worst[3], bound_depth(config, 0.0004).value) << s;
    }
}

}  // namespace
}  // namespace quadrille::campaign
