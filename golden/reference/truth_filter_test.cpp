// The truth's filter in long double against its 113 bits: every stress family, snapped and as given, with perspective
// and without, and quads at the limits of what the filter takes.
#include "golden/reference/truth.hpp"

#include "golden/reference/test_quads.hpp"
#include "golden/scenes/stress.hpp"
#include "model/snap.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

namespace quadrille::golden {
namespace {

constexpr int size = 40;

struct Seen {
  std::uint64_t covered = 0, undecided = 0, depths = 0;
};

/// Every pixel of the viewport. No attribute of a vertex is larger than `largest_b`, no Z/W than `largest_z` (infinite
/// where some W is not positive).
void compare(const TruthQuad& truth, bool perspective, int attributes, double largest_b, double largest_z, Seen& seen) {
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const ReferenceSample exact = truth.sample(x, y, TruthQuad::Effort::all_bits);
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
        ASSERT_NEAR(quick.z, exact.z, by_w * largest_z * exact.z_condition);
      }
      const double quotient = perspective ? weight : by_w;
      const double terms = perspective ? 1 : std::max(1.0, exact.z_condition);
      for (int i = 0; i < 4; ++i) ASSERT_NEAR(quick.lambda[i], exact.lambda[i], quotient * terms) << "vertex " << i;
      for (int a = 0; a < attributes; ++a)
        ASSERT_NEAR(quick.attribute[a], exact.attribute[a], quotient * terms * largest_b) << "attribute " << a;
    }
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
          for (const double b : quad.attribute[i]) largest = std::max(largest, std::abs(b));
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
    std::printf(
        "%-16s %8llu pixels, %6.3f %% need 113 bits\n", std::string(info.name).c_str(),
        static_cast<unsigned long long>(seen.covered),
        100.0 * static_cast<double>(seen.undecided) / static_cast<double>(std::max<std::uint64_t>(1, seen.covered)));
    all.covered += seen.covered;
    all.undecided += seen.undecided;
    all.depths += seen.depths;
    families += seen.covered > 0 ? 1 : 0;
  }
  EXPECT_EQ(families, stress_families().size());
  EXPECT_GT(all.covered, 100'000u);
  EXPECT_GT(all.undecided, 100u);
  EXPECT_GT(all.depths, 10'000u);
  EXPECT_LT(static_cast<double>(all.undecided), 0.1 * static_cast<double>(all.covered));
}

}  // namespace
}  // namespace quadrille::golden
