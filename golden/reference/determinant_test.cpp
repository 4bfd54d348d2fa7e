// The truth's weights against the determinant form (determinant_test_support.hpp), both in 113 bits: every scene,
// stress family and group of corner quads, snapped, at every covered pixel, visible or not.
//
// Both sides' error is stated, and their sum is the tolerance: of the truth 2^-107 times its condition, of the
// determinant form the bound that it computes. Where the equations do not determine the weights (two corners, two
// edges, a corner on another edge), the truth's weights must solve them.
#include "golden/reference/determinant_test_support.hpp"
#include "golden/reference/truth.hpp"
#include "golden/scenes/corner_quads.hpp"
#include "golden/scenes/scenes.hpp"
#include "golden/scenes/stress.hpp"
#include "model/port/snap.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace quadrille::golden {
namespace {

const Config config;
/// Of M_i 2^-108 of its terms (truth.hpp); twice that of M_i / ΣM in units of ReferenceSample::condition.
constexpr double truth_error = 2 * 0x1p-108;

struct Seen {
  std::uint64_t compared = 0, undetermined = 0;                                          ///< pixels
  std::uint64_t edge = 0, vertex = 0, notch = 0, homogeneous = 0, behind = 0, flat = 0;  ///< of `compared`
  double difference = 0, tolerance = 0;                                                  ///< the largest
};

/// Corners at the pixel and edges with it between their ends, in exact integers: two or more leave the weights
/// undetermined.
int corners_and_edges(const SnappedQuad& quad, int px, int py) {
  int count = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const test::PixelOffset s(quad.vertex[i], px, py), next(quad.vertex[(i + 1) & 3], px, py);
    const bool corner = s.x == 0 && s.y == 0, edge = s.x * next.y == s.y * next.x && s.x * next.x + s.y * next.y < 0;
    count += corner || edge ? 1 : 0;
  }
  return count;
}

/// The three sums of the equations vanish, beside the sum of the magnitudes.
void expect_null_vector(const SnappedQuad& quad, const std::array<Float113, 4>& m, int px, int py) {
  Float113 sum_x = 0, sum_y = 0, sum_r = 0, size = 0;
  for (int i = 0; i < 4; ++i) {
    const test::PixelOffset s(quad.vertex[i], px, py);
    const Float113 along = m[i] * s.length();
    sum_x += m[i] * static_cast<Float113>(s.x);
    sum_y += m[i] * static_cast<Float113>(s.y);
    sum_r += i % 2 == 0 ? along : -along;
    size += fabsq(along);
  }
  for (const Float113 sum : {sum_x, sum_y, sum_r}) {
    ASSERT_LE(static_cast<double>(fabsq(sum)), static_cast<double>(truth_error * size));
  }
}

void compare(const SnappedQuad& quad, const TruthQuad& truth, const test::DeterminantQuad& oracle, int px, int py,
             Seen& seen) {
  const ReferenceSample sample = truth.sample(px, py);
  if (!sample.covered) return;
  const std::array<Float113, 4> m = truth.homogeneous_weights(px, py);
  const test::DeterminantWeights exact = oracle.at(px, py);
  ASSERT_EQ(exact.determined, corners_and_edges(quad, px, py) < 2);
  if (!exact.determined) {
    ++seen.undetermined;
    expect_null_vector(quad, m, px, py);
    return;
  }
  std::array<Float113, 4> part;
  for (std::size_t i = 0; i < 4; ++i) part[i] = m[i] * port_value(quad.vertex[i].k, config.significand_bits);
  const Float113 sum = part[0] + part[1] + part[2] + part[3];
  const double tolerance = truth_error * sample.condition + exact.error;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto difference = static_cast<double>(fabsq(part[i] / sum - exact.lambda[i]));
    ASSERT_LE(difference, tolerance) << "vertex " << i;  // false of a NaN, too
    // Half a unit of the last place for the filter's difference, and for either rounding to double.
    ASSERT_NEAR(sample.lambda[i], static_cast<double>(exact.lambda[i]), 0x1p-52 + tolerance) << "vertex " << i;
    seen.difference = std::max(seen.difference, difference);
  }
  ++seen.compared;
  seen.tolerance = std::max(seen.tolerance, tolerance);
  seen.edge += (sample.flags & flag_on_edge) != 0;
  seen.vertex += (sample.flags & flag_on_vertex) != 0;
  seen.notch += sample.notch;
  seen.homogeneous += (sample.flags & flag_homogeneous) != 0;
  seen.behind += !sample.visible;
  seen.flat += exact.flat;
}

/// Pixels of the upper left `width` × `height`.
void compare(const SnappedQuad& quad, DrawState draw, int width, int height, const std::string& name, Seen& seen) {
  draw.attributes = 0;
  draw.perspective = true;
  const TruthQuad truth(quad, config, draw);
  const test::DeterminantQuad oracle(quad);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      compare(quad, truth, oracle, x, y, seen);
      if (testing::Test::HasFatalFailure()) {
        ADD_FAILURE() << name << ", quad " << quad.id << ", pixel " << x << ", " << y;
        return;
      }
    }
}

DrawState viewport(int size) {
  DrawState draw;
  draw.width = draw.scissor_x1 = draw.height = draw.scissor_y1 = size;
  draw.attributes = 0;
  return draw;
}

void record(const Seen& seen) {
  const auto put = [](const char* name, auto value) { testing::Test::RecordProperty(name, std::to_string(value)); };
  put("compared", seen.compared);
  put("undetermined", seen.undetermined);
  put("on_edge", seen.edge);
  put("on_vertex", seen.vertex);
  put("notch", seen.notch);
  put("homogeneous", seen.homogeneous);
  put("behind_the_eye", seen.behind);
  put("flat", seen.flat);
  put("log2_difference", std::log2(seen.difference));
  put("log2_tolerance", std::log2(seen.tolerance));
  EXPECT_LT(seen.tolerance, 0x1p-53);  // more than double precision would show
}

TEST(Determinant, AgreesOnEveryScene) {
  constexpr int size = 64;
  const DrawState draw = viewport(size);
  Seen all;
  std::vector<SceneInfo> scenes = list_scenes();
  std::ranges::copy(list_workloads(), std::back_inserter(scenes));
  for (const SceneInfo& info : scenes) {
    const std::vector<WindowQuad> quads = scene_quads(make_scene(info.name), size, size, AttributeSet::weights);
    const std::uint64_t before = all.compared;
    for (std::size_t n = 0; n < quads.size(); n += 1 + quads.size() / 200) {
      compare(snap_quad(quads[n], config, draw), draw, size, size, info.name, all);
      if (HasFatalFailure()) return;
    }
    EXPECT_GT(all.compared, before) << info.name;
  }
  EXPECT_GT(all.homogeneous, 0u);
  EXPECT_GT(all.notch, 0u);
  record(all);
}

TEST(Determinant, AgreesOnEveryStressFamily) {
  constexpr int size = 32;
  const DrawState draw = viewport(size);
  Seen all;
  for (const StressFamilyInfo& info : stress_families()) {
    const std::uint64_t before = all.compared;
    for (const WindowQuad& quad : make_stress(info.family, 16, 5, 1.0, size, size, 0)) {
      compare(snap_quad(quad, config, draw), draw, size, size, std::string(info.name), all);
      if (HasFatalFailure()) return;
    }
    EXPECT_GT(all.compared, before) << info.name;
  }
  for (const std::uint64_t count : {all.undetermined, all.edge, all.vertex, all.notch, all.homogeneous, all.behind})
    EXPECT_GT(count, 0u);
  record(all);
}

/// Exact cases in few pixels: the eye in the quad's plane, corners and edges in one pixel, ends of the ranges.
TEST(Determinant, AgreesOnCornerQuads) {
  constexpr int most = 32;
  Seen all;
  for (const CornerDraw& draw : corner_draws(config, 3)) {
    for (std::size_t n = 0; n < draw.quads.size(); n += 1 + draw.quads.size() / 40) {
      compare(draw.quads[n], draw.state, std::min(draw.state.width, most), std::min(draw.state.height, most),
              std::string(draw.group), all);
      if (HasFatalFailure()) return;
    }
  }
  for (const std::uint64_t count :
       {all.compared, all.undetermined, all.edge, all.vertex, all.notch, all.homogeneous, all.behind, all.flat})
    EXPECT_GT(count, 0u);
  record(all);
}

}  // namespace
}  // namespace quadrille::golden
