// The triangle machine against exact arithmetic: every pixel by the edge rule, attributes and depth within a bound of
// their own and the quad machine's, with stalls and gaps.
#include "golden/analysis/error_bound.hpp"
#include "golden/analysis/judged_quad.hpp"
#include "model/port/snap.hpp"
#include "model/support/prng.hpp"
#include "tb/triangles/exact_triangle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace quadrille::tb {
namespace {

constexpr int extent = 48;
constexpr std::size_t triangles_per_draw = 300;

enum class Kind { ordinary, outside, behind };  ///< all W = 1; some outside the guard band, with w > 0; some w <= 0

struct Case {
  const char* name;
  std::vector<std::pair<const char*, int>> keys;
  Kind kind;
  bool perspective;
  Cull cull = Cull::none;
  bool waits = false, all_skips = true;
};

std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

WindowQuad random_triangle(golden::Prng& random, std::uint32_t id, Kind kind, std::size_t slots) {
  WindowQuad triangle;
  triangle.id = id;
  const double reach = random.chance(0.3) ? 6 : extent;
  const bool ties = random.chance(0.5);  // pixel centres and their halves; else areas have more than S bits
  const double x = random.uniform() * extent, y = random.uniform() * extent;
  for (std::size_t i = 0; i < 3; ++i) {
    WindowVertex& v = triangle.vertex[i];
    v.w = kind == Kind::ordinary || random.chance(0.5) ? 0.25 + random.uniform() : random.uniform() * 2 - 1;
    if (kind == Kind::outside) v.w = std::fabs(v.w) + 0.001;
    const double far = kind == Kind::outside && random.chance(0.3) ? 3000 : 1;
    const auto place = [&](double middle) {
      const double at = middle + far * (random.uniform() - 0.5) * reach;
      return (ties ? std::round(2 * at) / 2 : at) * v.w;
    };
    v.x = place(x);
    v.y = place(y);
    v.z = (0.1 + 0.8 * random.uniform()) * v.w;
    for (std::size_t slot = 0; slot < slots; ++slot) triangle.attribute[i].push_back(random.uniform() * 20 - 10);
  }
  triangle.vertex[3] = triangle.vertex[2];
  triangle.attribute[3] = triangle.attribute[2];
  return triangle;
}

DrawState state_of(const Case& c, const Config& config) {
  DrawState state;
  state.width = state.height = state.scissor_x1 = extent;
  state.scissor_x0 = 3, state.scissor_y0 = 5, state.scissor_y1 = extent - 2;
  state.perspective = c.perspective;
  state.cull = c.cull;
  state.depth = c.kind != Kind::behind;  // no bound relative to the corners there
  state.attributes = config.attribute_slots;
  if (!c.all_skips) state.skip = 0;
  return state;
}

/// Every step truncates: areas to S bits (W too where it has more), the terms of a sum by a unit below the largest, the
/// sums to S bits; of the reciprocal the table's error.
double tolerance(const ExactTriangle::Mean& mean, int terms, bool cut, const Config& config) {
  const double unit = std::ldexp(1.0, 1 - config.significand_bits), term = std::ldexp(unit, -config.align_guard_bits);
  const TableError table = reciprocal_error(config);
  const double quotient = unit + 3 * term + std::max(-table.low, table.high);
  return (1 + 8 * unit) *
         ((cut ? 2 : 1) * unit * mean.moved + quotient * std::fabs(mean.value) + terms * term * mean.largest);
}

class TriangleMachineTest : public testing::TestWithParam<Case> {};

TEST_P(TriangleMachineTest, EqualsExactArithmetic) {
  const Case& c = GetParam();
  Config config;
  for (const auto& [key, value] : c.keys) config.set(key, value);
  config.validate();
  const DrawState state = state_of(c, config);
  const auto slots = static_cast<std::size_t>(config.attribute_slots);
  golden::Prng random(20);
  std::vector<SnappedTriangle> triangles;
  for (std::uint32_t id = 0; id < triangles_per_draw; ++id)
    triangles.push_back(snap_quad(random_triangle(random, id, c.kind, slots), config, state));

  std::vector<std::map<std::pair<int, int>, Fragment>> drawn(triangles.size());
  std::uint32_t last = 0;
  const TriangleMachine machine(config, QUADRILLE_TRIANGLES);
  machine.draw(triangles, state,
               [&](const Fragment& fragment) {
                 ASSERT_GE(fragment.quad, last) << "triangles in their order";
                 last = fragment.quad;
                 ASSERT_TRUE(drawn.at(last).try_emplace({fragment.y, fragment.x}, fragment).second) << "drawn twice";
               },
               {c.waits ? 7u : 1u, c.waits ? 0.3 : 0, c.waits ? 0.4 : 0});

  const Bounds bounds(config);
  const FixedPoint attributes = attribute_format(config), depths = depth_format(config);
  std::size_t pixels = 0, edges = 0, fronts = 0, homogeneous = 0;
  double worst = 0;  // part of the bound
  const auto near = [&](const FixedPoint& format, std::int64_t code, const ExactTriangle::Mean& mean, double own,
                        double quads) {
    const double allowed = std::min(own, quads);
    EXPECT_TRUE(format.may_stand_for(code, mean.value, allowed)) << code << " for " << mean.value << " +- " << allowed;
    if (allowed > 0) worst = std::max(worst, format.distance(code, mean.value) / allowed);
  };
  for (const SnappedTriangle& triangle : triangles) {
    SCOPED_TRACE(triangle.id);
    const ExactTriangle exact(triangle, config, state);
    const bool one_w = is_ordinary(triangle, config), cut = cuts_w(triangle, config);
    std::size_t covered = 0;
    for (int y = 0; y < extent; ++y) {
      for (int x = 0; x < extent; ++x) {
        const auto pixel = exact.at(x, y);
        const auto found = drawn[triangle.id].find({y, x});
        ASSERT_EQ(found != drawn[triangle.id].end(), pixel.has_value()) << x << " " << y;
        if (!pixel) continue;
        const Fragment& fragment = found->second;
        ++covered, edges += pixel->on_edge, fronts += pixel->front, homogeneous += !one_w;
        ASSERT_EQ(fragment.front, pixel->front);
        ASSERT_EQ(fragment.flags, (pixel->on_edge ? flag_on_edge | flag_tie : 0) | (one_w ? 0 : flag_homogeneous));
        const double by_w = cut ? bounds.value_of_cut_w : bounds.value;
        const double by_k = state.perspective ? bounds.value : by_w;
        for (std::size_t slot = 0; slot < slots; ++slot)
          near(attributes, fragment.attribute[slot] - triangle.base.attribute[slot], pixel->attribute[slot],
               tolerance(pixel->attribute[slot], 2, cut && !state.perspective, config),
               by_k * attribute_spread(triangle, slot, config, state.perspective));
        if (state.depth)
          near(depths, std::int64_t{fragment.depth} - triangle.base.depth, pixel->depth,
               tolerance(pixel->depth, 3, cut, config), by_w * depth_spread(triangle, config));
      }
    }
    ASSERT_EQ(drawn[triangle.id].size(), covered);
    pixels += covered;
  }
  std::printf("%zu pixels, %zu on an edge, %zu front, %zu homogeneous; worst value %.3f of the bound\n", pixels, edges,
              fronts, homogeneous, worst);
  EXPECT_GT(pixels, 2000u);
  EXPECT_GT(edges, 10u);
  EXPECT_EQ(homogeneous > 0, c.kind != Kind::ordinary);
  EXPECT_GT(worst, 0.02);
}

const Case cases[] = {
    {"ordinary", {}, Kind::ordinary, true, Cull::none, true},
    {"flat", {}, Kind::outside, false, Cull::back},
    {"outside", {}, Kind::outside, true, Cull::none, true},
    {"behind", {}, Kind::behind, true, Cull::front, true},
    {"no_skips", {}, Kind::behind, true, Cull::front, false, false},
    {"colour8",
     {{"viewport_bits", 11}, {"significand_bits", 11}, {"align_guard_bits", 1}, {"depth_bits", 16}},
     Kind::ordinary,
     true},
    {"wide",
     {{"significand_bits", 24}, {"pixels_per_clock", 4}, {"tile_log2", 4}},
     Kind::outside,
     true,
     Cull::none,
     true},
};
INSTANTIATE_TEST_SUITE_P(Triangles, TriangleMachineTest, testing::ValuesIn(cases),
                         [](const auto& of) { return std::string(of.param.name); });

}  // namespace
}  // namespace quadrille::tb
