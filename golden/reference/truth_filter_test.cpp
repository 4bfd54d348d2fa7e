// The truth's two filters, in long double and in lanes of double-double numbers, against its 113 bits: every stress
// family, snapped and as given, with perspective and without, the corner draws, and quads at the limits of what the
// filters take.
#include "golden/reference/truth.hpp"

#include "golden/reference/port_number.hpp"
#include "golden/reference/test_quads.hpp"
#include "golden/scenes/corner_quads.hpp"
#include "golden/scenes/stress.hpp"
#include "model/port/snap.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

namespace quadrille::golden {
namespace {

constexpr int size = 40;

struct Seen {
  std::uint64_t covered = 0, undecided = 0, depths = 0;
  std::uint64_t pixels = 0, undecided_by_lanes = 0;
};

/// Two numbers rounded to double, of which one was first rounded to 64 bits, and what truth_lanes.hpp leaves between
/// them beside the largest term.
constexpr double rounded = 1.01 * 0x1p-52, beside = 0x1p-59;

void expect_near(double value, double exact, double largest) {
  ASSERT_NEAR(value, exact, rounded * std::fabs(exact) + beside * largest);
}

/// What samples() says of a pixel against all bits.
void compare_lanes(const ReferenceSample& lane, const ReferenceSample& exact, int attributes, double largest_b,
                   double largest_z) {
  ASSERT_EQ(lane.covered, exact.covered);
  ASSERT_EQ(lane.front, exact.front);
  ASSERT_EQ(lane.visible, exact.visible);
  ASSERT_EQ(lane.eye_in_hull, exact.eye_in_hull);
  ASSERT_EQ(lane.flags, exact.flags);
  ASSERT_EQ(lane.notch, exact.notch);
  expect_near(lane.visible_margin, exact.visible_margin, 1);
  expect_near(lane.condition, exact.condition, 0);
  expect_near(lane.z_condition, exact.z_condition, 0);
  if (std::isfinite(largest_z)) expect_near(lane.z_above, exact.z_above, largest_z);
  for (int i = 0; i < 4; ++i) expect_near(lane.lambda[i], exact.lambda[i], 1);
  for (int a = 0; a < attributes; ++a) expect_near(lane.attribute_above[a], exact.attribute_above[a], largest_b);
}

std::vector<PixelPlace> all_pixels(int width, int height) {
  std::vector<PixelPlace> pixels;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) pixels.push_back({x, y});
  return pixels;
}

/// All of these pixels, with every instruction set: the same bits, near those of all bits where the lanes decide and
/// those of sample() elsewhere.
void compare_lanes(const TruthQuad& truth, const std::vector<PixelPlace>& pixels,
                   const std::vector<ReferenceSample>& exact, int attributes, double largest_b, double largest_z,
                   Seen& seen) {
  std::vector<ReferenceSample> first(pixels.size());
  std::vector<bool> decided;
  truth.samples(pixels, first, LaneTarget::baseline, &decided);
  for (const LaneTarget lanes : lane_targets()) {
    if (!can_run(lanes)) continue;
    std::vector<ReferenceSample> samples(pixels.size());
    truth.samples(pixels, samples, lanes);
    for (std::size_t i = 0; i < pixels.size(); ++i) ASSERT_EQ(samples[i], first[i]) << "lanes " << int(lanes);
  }
  seen.pixels += pixels.size();
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    seen.undecided_by_lanes += decided[i] ? 0 : 1;
    if (decided[i])
      compare_lanes(first[i], exact[i], attributes, largest_b, largest_z);
    else
      ASSERT_EQ(first[i], truth.sample(pixels[i].x, pixels[i].y));
    if (testing::Test::HasFatalFailure()) {
      ADD_FAILURE() << "pixel " << pixels[i].x << ", " << pixels[i].y;
      return;
    }
  }
}

/// Every pixel of the viewport. No difference of an attribute is larger than `largest_b`, no Z/W than `largest_z`
/// (infinite where some W is not positive).
void compare(const TruthQuad& truth, bool perspective, int attributes, double largest_b, double largest_z, Seen& seen) {
  const std::vector<PixelPlace> pixels = all_pixels(size, size);
  std::vector<ReferenceSample> all_bits;
  for (const auto [x, y] : pixels) {
    const ReferenceSample& exact = all_bits.emplace_back(truth.sample(x, y, TruthQuad::Effort::all_bits));
    if (!exact.covered) continue;
    ++seen.covered;
    seen.undecided += truth.needs_113_bits(x, y) ? 1 : 0;
    const ReferenceSample quick = truth.sample(x, y);
    ASSERT_TRUE(quick.covered);
    ASSERT_EQ(quick.front, exact.front);
    ASSERT_EQ(quick.visible, exact.visible);
    ASSERT_EQ(quick.eye_in_hull, exact.eye_in_hull);
    ASSERT_EQ(quick.flags, exact.flags);
    ASSERT_EQ(quick.notch, exact.notch);
    // What truth.hpp promises.
    constexpr double weight = 0x1p-51, by_w = 0x1p-47;
    ASSERT_NEAR(quick.visible_margin, exact.visible_margin, by_w);
    ASSERT_NEAR(quick.condition, exact.condition, weight * exact.condition);
    if (std::isfinite(exact.z_condition)) {
      ASSERT_NEAR(quick.z_condition, exact.z_condition, by_w * exact.z_condition);
    } else {
      ASSERT_EQ(quick.z_condition, exact.z_condition);
    }
    if (std::isfinite(largest_z)) {
      ++seen.depths;
      ASSERT_NEAR(quick.z_above, exact.z_above, by_w * largest_z * exact.z_condition);
    }
    const double quotient = perspective ? weight : by_w;
    const double terms = perspective ? 1 : std::max(1.0, exact.z_condition);
    for (int i = 0; i < 4; ++i) ASSERT_NEAR(quick.lambda[i], exact.lambda[i], quotient * terms) << "vertex " << i;
    for (int a = 0; a < attributes; ++a)
      ASSERT_NEAR(quick.attribute_above[a], exact.attribute_above[a], quotient * terms * largest_b)
          << "attribute " << a;
  }
  compare_lanes(truth, pixels, all_bits, attributes, largest_b, largest_z, seen);
}

TEST(TruthFilter, DecidesAsAllBitsDo) {
  const Config config;
  Seen all;
  std::uint64_t families = 0;
  for (const StressFamilyInfo& info : stress_families()) {
    Seen seen;
    for (const bool perspective : {true, false}) {
      DrawState draw;
      draw.width = draw.scissor_x1 = draw.height = draw.scissor_y1 = size;
      draw.perspective = perspective;
      for (const WindowQuad& quad : make_stress(info.family, 12, 5, 1.0, size, size, draw.attributes)) {
        double largest = 0;
        for (int i = 0; i < 4; ++i)
          for (const double b : quad.attribute[i]) largest = std::max(largest, 2 * std::abs(b));  // of differences
        double depth = 0;  // twice what is given: snapped Z and W are near it
        for (const WindowVertex& v : quad.vertex)
          depth = v.w > 0 ? std::max(depth, 2 * std::abs(v.z / v.w)) : std::numeric_limits<double>::infinity();
        compare(TruthQuad(snap_quad(quad, config, draw), config, draw), perspective, draw.attributes, largest, depth,
                seen);
        compare(TruthQuad(quad, draw), perspective, draw.attributes, largest, depth, seen);
        if (HasFatalFailure()) {
          ADD_FAILURE() << "family " << info.name << (perspective ? "" : " without perspective");
          return;
        }
      }
    }
    const auto share = [](std::uint64_t part, std::uint64_t all_of_them) {
      return 100.0 * static_cast<double>(part) / static_cast<double>(std::max<std::uint64_t>(1, all_of_them));
    };
    std::printf("%-16s %8llu pixels, %6.3f %% need 113 bits; lanes leave %6.3f %% of all\n",
                std::string(info.name).c_str(), static_cast<unsigned long long>(seen.covered),
                share(seen.undecided, seen.covered), share(seen.undecided_by_lanes, seen.pixels));
    all.covered += seen.covered;
    all.undecided += seen.undecided;
    all.depths += seen.depths;
    all.pixels += seen.pixels;
    all.undecided_by_lanes += seen.undecided_by_lanes;
    families += seen.covered > 0 ? 1 : 0;
  }
  EXPECT_EQ(families, stress_families().size());
  EXPECT_GT(all.covered, 100'000u);
  EXPECT_GT(all.undecided, 100u);
  EXPECT_GT(all.depths, 10'000u);
  EXPECT_LT(static_cast<double>(all.undecided), 0.1 * static_cast<double>(all.covered));
  EXPECT_GT(all.undecided_by_lanes, 100u);
  // Some families are made of what the lanes leave: the eye in the hull, collapsed edges.
  EXPECT_LT(static_cast<double>(all.undecided_by_lanes), 0.3 * static_cast<double>(all.pixels));
}

TEST(TruthFilter, LanesDecideCornerDrawsAsAllBitsDo) {
  constexpr int most = 32;  // pixels of a side; what matters lies in the upper left
  const Config config;
  Seen seen;
  for (const CornerDraw& draw : corner_draws(config, 3)) {
    SCOPED_TRACE("corner draw " + std::string(draw.group));
    const std::vector<PixelPlace> pixels =
        all_pixels(std::min(draw.state.width, most), std::min(draw.state.height, most));
    for (std::size_t n = 0; n < draw.quads.size(); n += 1 + draw.quads.size() / 40) {
      const SnappedQuad& quad = draw.quads[n];
      const TruthQuad truth(quad, config, draw.state);
      std::vector<ReferenceSample> all_bits;
      for (const auto [x, y] : pixels) all_bits.push_back(truth.sample(x, y, TruthQuad::Effort::all_bits));
      double largest_b = 0;
      for (const SnappedVertex& v : quad.vertex)
        for (int a = 0; a < draw.state.attributes; ++a) {
          const double by = draw.state.perspective ? port_value(v.k, config.significand_bits)
                                                   : std::ldexp(static_cast<double>(v.w), -config.frac());
          largest_b = std::max(largest_b, std::fabs(port_value(v.attribute[a], config.significand_bits) / by));
        }
      constexpr double any = std::numeric_limits<double>::infinity();
      compare_lanes(truth, pixels, all_bits, std::isfinite(largest_b) ? draw.state.attributes : 0, largest_b, any,
                    seen);
      if (HasFatalFailure()) {
        ADD_FAILURE() << "quad " << quad.id;
        return;
      }
    }
  }
  EXPECT_GT(seen.pixels, 100'000u);
  EXPECT_LT(seen.undecided_by_lanes, seen.pixels / 2);
}

/// The eye a few units of the last bit beside the plane of the vertices: sum(M w) cancels nearly all of its terms.
TEST(TruthFilter, LanesLeaveSumsThatCancel) {
  DrawState draw;
  draw.width = draw.scissor_x1 = draw.height = draw.scissor_y1 = size;
  draw.attributes = 0;
  std::vector<PixelPlace> pixels = all_pixels(size, size);
  std::erase_if(pixels, [](const PixelPlace& p) { return p.x % 2 != 0 || p.y % 2 != 0; });
  Seen seen;
  std::uint64_t cancelled = 0;
  for (const WindowQuad& quad : make_stress(StressFamily::coplanar, 60, 2, 1.0, size, size, 0)) {
    for (const double bit : {-0x1p-50, 0x1p-50, -0x1p-44, 0x1p-44}) {
      WindowQuad moved = quad;
      moved.vertex[1].w *= 1 + bit;
      const TruthQuad truth(moved, draw);
      std::vector<ReferenceSample> all_bits;
      for (const auto [x, y] : pixels) {
        const ReferenceSample& s = all_bits.emplace_back(truth.sample(x, y, TruthQuad::Effort::all_bits));
        cancelled += s.covered && !s.eye_in_hull && s.z_condition > 0x1p30 ? 1 : 0;
      }
      compare_lanes(truth, pixels, all_bits, 0, 1, std::numeric_limits<double>::infinity(), seen);
      if (HasFatalFailure()) return;
    }
  }
  EXPECT_GT(cancelled, 250u);
}

/// Vertices as large and as small as doubles are, far beyond the range of the lanes, which must leave them.
TEST(TruthFilter, LanesLeaveWhatMayOverflow) {
  DrawState draw;
  draw.width = draw.scissor_x1 = draw.height = draw.scissor_y1 = size;
  draw.attributes = 1;
  const std::vector<PixelPlace> pixels = all_pixels(size, size);
  Seen seen;
  for (const double scale : {1e-300, 1e-200, 0x1p-101, 0x1p-60, 1.0, 0x1p60, 0x1p101, 1e200, 1e300}) {
    SCOPED_TRACE(scale);
    WindowQuad quad;
    constexpr std::array<std::array<double, 2>, 4> corners{{{3.3, 2.1}, {35.7, 4.9}, {30.2, 33.3}, {5.5, 28.1}}};
    for (std::size_t i = 0; i < 4; ++i) {
      quad.vertex[i] = {corners[i][0] * scale, corners[i][1] * scale, 0.5 * scale, scale};
      quad.attribute[i] = {1};
    }
    const TruthQuad truth(quad, draw);
    std::vector<ReferenceSample> all_bits;
    for (const auto [x, y] : pixels) all_bits.push_back(truth.sample(x, y, TruthQuad::Effort::all_bits));
    EXPECT_TRUE(all_bits[std::size_t{20 * size + 20}].covered);
    const std::uint64_t before = seen.undecided_by_lanes;
    compare_lanes(truth, pixels, all_bits, 1, 1, 1, seen);
    if (HasFatalFailure()) return;
    const std::uint64_t left = seen.undecided_by_lanes - before;
    if (scale == 1) {
      EXPECT_LT(left, pixels.size() / 100);
    } else {
      EXPECT_EQ(left, pixels.size());
    }
  }
}

}  // namespace
}  // namespace quadrille::golden
