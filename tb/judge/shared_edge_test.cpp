// Two quads at a shared edge: both are within their bounds there, and how far apart their depths and attributes are.
#include "golden/analysis/judged_quad.hpp"
#include "golden/reference/port_number.hpp"
#include "golden/scenes/random_mesh.hpp"
#include "model/one_pixel.hpp"
#include "model/support/float113.hpp"
#include "model/support/prng.hpp"
#include "tb/judge/judge.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace quadrille::tb {
namespace {

constexpr int extent = 96;

DrawState mesh_state() {
  DrawState state;
  state.width = state.height = state.scissor_x1 = state.scissor_y1 = extent;
  state.attributes = 1;
  return state;
}

/// A mesh with corners at pixel centres, of which depth and attribute are those of its vertices: around 0.998 and 100,
/// off by up to `spread`.
golden::RandomMesh mesh_of(std::uint64_t seed, double spread) {
  golden::RandomMeshOptions options;
  options.width = options.height = extent;
  options.columns = options.rows = 6;
  options.tie_share = 1;
  options.vary_w = seed % 2 == 0;
  golden::RandomMesh mesh = golden::make_random_mesh(seed, options);
  golden::Prng rng(seed);
  std::vector<std::array<double, 2>> values(mesh.vertices.size());
  for (auto& [z, a] : values) {
    z = 0.998 + rng.uniform(-1, 1) * spread * 0.002;
    a = 100 + rng.uniform(-1, 1) * spread;
  }
  for (std::size_t n = 0; n < mesh.quads.size(); ++n)
    for (std::size_t i = 0; i < 4; ++i) {
      const auto& [z, a] = values[static_cast<std::size_t>(mesh.cells[n][i])];
      WindowVertex& v = mesh.quads[n].vertex[i];
      v.z = z * v.w;
      mesh.quads[n].attribute[i] = {a};
    }
  return mesh;
}

/// Pixels whose centres lie inside an edge, by the mesh's integers.
std::vector<golden::PixelPlace> pixels_on(const std::array<std::int64_t, 2>& a, const std::array<std::int64_t, 2>& b) {
  std::vector<golden::PixelPlace> out;
  for (int y = 0; y < extent; ++y)
    for (int x = 0; x < extent; ++x) {
      const std::int64_t dx = 256 * x + 128 - a[0], dy = 256 * y + 128 - a[1], ex = b[0] - a[0], ey = b[1] - a[1];
      const std::int64_t along = dx * ex + dy * ey;
      if (dx * ey == dy * ex && along > 0 && along < ex * ex + ey * ey) out.push_back({x, y});
    }
  return out;
}

struct Jumps {
  std::size_t pixels = 0;
  std::int64_t depth = 0, attribute = 0;      ///< the largest, in codes
  double depth_part = 0, attribute_part = 0;  ///< of the sum of both quads' bounds
};

/// At a pixel on the edge of two quads one of them is drawn. What the other one would write there is what an observer
/// sees beside it.
void measure_edge(const std::array<const SnappedQuad*, 2>& quads, const Config& config, const DrawState& state,
                  const PipelineContext& context, const Bounds& bounds, const golden::PixelPlace& at, Jumps& jumps) {
  std::array<Fragment, 2> fragment;
  double depth_allowed = 0, attribute_allowed = 0;
  const FixedPoint depth = depth_format(config), attribute = attribute_format(config);
  for (std::size_t side = 0; side < 2; ++side) {
    const SnappedQuad& quad = *quads[side];
    const OnePixel pixel = one_pixel(quad, context, at.x, at.y);
    // A concave quad's other edge may meet the pixel too.
    if (!pixel.trace.on_edge) return;
    fragment[side] = pixel.trace.fragment;
    const auto m = golden::TruthQuad(quad, config, state).homogeneous_weights(at.x, at.y);
    Float113 k = 0, w = 0, b = 0, z = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto port = [&](const PortNumber& v) { return golden::port_value(v, config.significand_bits); };
      k += m[i] * port(quad.vertex[i].k);
      w += m[i] * quad.vertex[i].w / (1 << config.frac());
      z += m[i] * port(quad.vertex[i].z);
      if (i > 0) b += m[i] * port(quad.vertex[i].attribute[0]);
    }
    const double z_bound = bounds.value * depth_spread(quad, config),
                 a_bound = bounds.value * attribute_spread(quad, 0, config, true);
    EXPECT_TRUE(
        depth.may_stand_for(std::int64_t{fragment[side].depth} - quad.base.depth, static_cast<double>(z / w), z_bound));
    EXPECT_TRUE(attribute.may_stand_for(fragment[side].attribute[0] - quad.base.attribute[0],
                                        static_cast<double>(b / k), a_bound));
    depth_allowed += z_bound + depth.unit() / 2;
    attribute_allowed += a_bound + attribute.unit() / 2;
  }
  const std::int64_t z = std::abs(std::int64_t{fragment[0].depth} - fragment[1].depth),
                     a = std::abs(fragment[0].attribute[0] - fragment[1].attribute[0]);
  ++jumps.pixels;
  jumps.depth = std::max(jumps.depth, z);
  jumps.attribute = std::max(jumps.attribute, a);
  jumps.depth_part = std::max(jumps.depth_part, static_cast<double>(z) * depth.unit() / depth_allowed);
  jumps.attribute_part = std::max(jumps.attribute_part, static_cast<double>(a) * attribute.unit() / attribute_allowed);
}

TEST(SharedEdges, BothQuadsAreWithinTheirBounds) {
  const DrawState state = mesh_state();
  for (const int s : {12, 18})
    for (const double spread : {1.0, 0x1p-6, 0x1p-12}) {
      Config config;
      config.set("significand_bits", s);
      const PipelineContext context(config, state);
      const Bounds bounds(config);
      Jumps jumps;
      for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        const golden::RandomMesh mesh = mesh_of(seed, spread);
        const CheckResult result = judge_untimed(mesh.quads, 1, config, state);
        EXPECT_TRUE(result.ok()) << result.first.text;
        std::vector<SnappedQuad> snapped;
        std::map<std::pair<int, int>, std::vector<std::size_t>> edges;
        for (std::size_t n = 0; n < mesh.quads.size(); ++n) {
          snapped.push_back(snap_as(mesh.quads[n], static_cast<std::uint32_t>(n), config, state));
          for (std::size_t i = 0; i < 4; ++i) {
            const int a = mesh.cells[n][i], b = mesh.cells[n][(i + 1) % 4];
            if (a != b) edges[std::minmax(a, b)].push_back(n);
          }
        }
        for (const auto& [ends, cells] : edges)
          if (cells.size() == 2)
            for (const golden::PixelPlace& at : pixels_on(mesh.vertices[static_cast<std::size_t>(ends.first)],
                                                          mesh.vertices[static_cast<std::size_t>(ends.second)]))
              measure_edge({&snapped[cells[0]], &snapped[cells[1]]}, config, state, context, bounds, at, jumps);
      }
      EXPECT_GT(jumps.pixels, 200u);
      // Snapping adds what differences are rounded by on either side, 2^-s of the spread.
      EXPECT_LE(jumps.depth_part, 1);
      EXPECT_LE(jumps.attribute_part, 1);
    }
}

}  // namespace
}  // namespace quadrille::tb
