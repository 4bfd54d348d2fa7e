// Window depth where people meet it: on a depth limit, close together, and far from the eye. No pixel is lost of a quad
// whose corners lie within the limits, and the nearer of two planes shows.
#include "golden/scenes/plane_pair.hpp"
#include "golden/scenes/projection.hpp"
#include "golden/scenes/scenes.hpp"
#include "golden/scenes/stress.hpp"
#include "model/port/snap.hpp"
#include "model/untimed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <vector>

namespace quadrille {
namespace {

constexpr int size = 128;

DrawState picture() {
  DrawState state;
  state.width = state.height = state.scissor_x1 = state.scissor_y1 = size;
  return state;
}

Config of_bits(int significand_bits) {
  Config config;
  config.set("significand_bits", significand_bits);
  return config;
}

/// The fragments of the plain engine, which are those of the lanes.
void draw(const WindowQuad& quad, const Config& config, const DrawState& state,
          const std::function<void(const Fragment&)>& take) {
  std::array<std::vector<Fragment>, 2> drawn;
  for (const PixelEngine engine : {PixelEngine::plain, PixelEngine::lanes})
    UntimedModel(config, state, engine).draw(snap_quad(quad, config, state), [&](std::span<const Fragment> fragments) {
      std::vector<Fragment>& all = drawn[engine == PixelEngine::plain ? 0 : 1];
      all.insert(all.end(), fragments.begin(), fragments.end());
    });
  EXPECT_TRUE(drawn[0] == drawn[1]);
  for (const Fragment& f : drawn[0]) take(f);
}

std::size_t count(const WindowQuad& quad, const Config& config, const DrawState& state) {
  std::size_t fragments = 0;
  draw(quad, config, state, [&](const Fragment&) { ++fragments; });
  return fragments;
}

/// 100 × 100 pixels, u along x and v up.
WindowQuad square(const std::array<double, 4>& z) {
  WindowQuad quad;
  quad.vertex = {{{14, 114, z[0], 1}, {114, 114, z[1], 1}, {114, 14, z[2], 1}, {14, 14, z[3], 1}}};
  quad.attribute = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  return quad;
}

/// The same square, its corners at these distances.
WindowQuad in_perspective(WindowQuad quad, const std::array<double, 4>& w) {
  for (std::size_t i = 0; i < 4; ++i) {
    WindowVertex& v = quad.vertex[i];
    v = {v.x * w[i], v.y * w[i], v.z * w[i], w[i]};
  }
  return quad;
}

constexpr std::array<double, 4> distances{1, 2.3, 5.7, 3.1};
constexpr std::size_t whole = 10'000;
constexpr std::array<int, 3> some_bits{12, 18, 24};

/// A sky at the far plane.
TEST(DepthAtLimits, ASkyOnTheFarPlaneIsWhole) {
  const WindowQuad sky = square({1, 1, 1, 1});
  for (const int s : some_bits) {
    EXPECT_EQ(count(sky, of_bits(s), picture()), whole) << s;
    EXPECT_EQ(count(in_perspective(sky, distances), of_bits(s), picture()), whole) << s;
    draw(in_perspective(sky, distances), of_bits(s), picture(),
         [](const Fragment& f) { EXPECT_EQ(f.depth, 1u << 24); });
  }
}

TEST(DepthAtLimits, AQuadOnTheNearPlaneIsWhole) {
  for (const int s : some_bits)
    EXPECT_EQ(count(in_perspective(square({0, 0, 0, 0}), distances), of_bits(s), picture()), whole) << s;
}

TEST(DepthAtLimits, BothLimitsMayBeTheQuadsDepth) {
  DrawState state = picture();
  for (const double z : {0.5, 0.3, 1.0 / 3, 0.9999}) {
    state.znear = state.zfar = z;
    for (const int s : some_bits) {
      EXPECT_EQ(count(square({z, z, z, z}), of_bits(s), state), whole) << z << ", " << s;
      EXPECT_EQ(count(in_perspective(square({z, z, z, z}), distances), of_bits(s), state), whole) << z << ", " << s;
    }
  }
}

/// Depth from 0.25 to 0.75 along x, the limit in the middle: what is nearer is drawn. Depth falls on the limit itself
/// nowhere, but half a column beside it.
TEST(DepthAtLimits, ARampEndsAtTheLimit) {
  DrawState state = picture();
  for (const int s : some_bits)
    for (const bool near : {false, true}) {
      state.znear = near ? 0.5 : 0;
      state.zfar = near ? 1 : 0.5;
      std::map<int, int> columns;
      draw(square({0.25, 0.75, 0.75, 0.25}), of_bits(s), state, [&](const Fragment& f) { ++columns[f.x]; });
      for (int x = 14; x < 114; ++x) EXPECT_EQ(columns[x], (x < 64) != near ? 100 : 0) << "column " << x << ", " << s;
    }
}

/// Corners at a limit's code and the quad within: nothing is lost, whatever the corners are.
TEST(DepthAtLimits, CornersOnBothLimits) {
  DrawState state = picture();
  state.znear = 0.998;
  state.zfar = 0.9984;
  for (const int s : some_bits)
    for (int corner = 0; corner < 4; ++corner) {
      std::array<double, 4> z;
      z.fill(state.znear);
      z[static_cast<std::size_t>(corner)] = state.zfar;
      EXPECT_EQ(count(square(z), of_bits(s), state), whole) << s;
      EXPECT_EQ(count(in_perspective(square(z), distances), of_bits(s), state), whole) << s;
    }
}

/// The limits are the least and the greatest code of each quad's corners. What a quad's arithmetic adds to that at some
/// pixel must not cost the pixel.
TEST(DepthAtLimits, NoPixelIsLostBetweenTheCorners) {
  std::size_t pixels = 0;
  for (const golden::StressFamily family :
       {golden::StressFamily::general, golden::StressFamily::perspective, golden::StressFamily::near_edge,
        golden::StressFamily::on_vertex, golden::StressFamily::sliver})
    for (const WindowQuad& quad : golden::make_stress(family, 150, 7, 1, size, size, 1)) {
      DrawState state = picture();
      state.znear = 2;
      state.zfar = -1;
      for (const WindowVertex& v : quad.vertex) {
        const double code = std::floor(std::ldexp(v.z / v.w, 24) + 0.5);
        state.znear = std::min(state.znear, std::ldexp(code, -24));
        state.zfar = std::max(state.zfar, std::ldexp(code, -24));
      }
      const std::size_t within = count(quad, of_bits(12), state);
      state.depth = false;
      EXPECT_EQ(within, count(quad, of_bits(12), state)) << golden::stress_family_name(family) << " " << quad.id;
      pixels += within;
    }
  EXPECT_GT(pixels, 80'000u);
}

/// A cube far away from an eye that sees from 0.001 to a million: its depths are sixteen codes below 1. Every pixel in
/// its outline has one face before and one behind.
TEST(DepthAtLimits, ACubeIsClosedWithFarLimitsFarApart) {
  golden::Mesh mesh;
  for (int i = 0; i < 8; ++i) mesh.positions.push_back({i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0});
  for (const std::array<int, 4>& face : std::array<std::array<int, 4>, 6>{
           {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}}) {
    golden::Face corners;
    for (const int i : face) corners.push_back({i, -1, -1});
    mesh.faces.push_back(corners);
  }
  golden::Camera camera;
  camera.eye = {300, 200, 900};
  camera.target = {0, 0, 0};
  camera.fovy = 0.25;
  camera.near = 0.001;
  camera.far = 1e6;
  for (const int s : some_bits) {
    std::map<std::array<int, 2>, std::array<int, 2>> faces;  // before and behind
    for (const WindowQuad& quad : golden::project_mesh(mesh, camera, size, size).quads)
      draw(quad, of_bits(s), picture(), [&](const Fragment& f) { ++faces[{f.x, f.y}][f.front ? 0 : 1]; });
    EXPECT_GT(faces.size(), 5'000u);
    for (const auto& [pixel, found] : faces) {
      EXPECT_EQ(found[0], 1) << pixel[0] << ", " << pixel[1] << ", " << s;
      EXPECT_EQ(found[1], 1) << pixel[0] << ", " << pixel[1] << ", " << s;
    }
    // No row of the outline is interrupted.
    std::map<int, std::array<int, 3>> rows;  // first, last, count
    for (const auto& [pixel, found] : faces) {
      auto& row = rows.try_emplace(pixel[1], std::array{pixel[0], pixel[0], 0}).first->second;
      row = {std::min(row[0], pixel[0]), std::max(row[1], pixel[0]), row[2] + 1};
    }
    for (const auto& [y, row] : rows) EXPECT_EQ(row[1] - row[0] + 1, row[2]) << "row " << y;
  }
}

/// Planes 0.05 apart at distance 50, near 0.1 and far 100: the nearer one shows in every pixel, in either order.
TEST(DepthAtLimits, TheNearerOfTwoPlanesShows) {
  for (const int s : some_bits)
    for (const bool reversed : {false, true}) {
      const auto quads = golden::plane_pair({golden::PlaneView::turned, 0.05, reversed}, size, size);
      std::map<std::array<int, 2>, std::array<std::int64_t, 2>> depth;
      for (const WindowQuad& quad : quads)
        draw(quad, of_bits(s), picture(), [&](const Fragment& f) { depth[{f.x, f.y}][quad.id] = f.depth; });
      int both = 0, wrong = 0;
      for (const auto& [pixel, z] : depth) {
        if (z[0] == 0 || z[1] == 0) continue;
        ++both;
        wrong += reversed ? z[0] <= z[1] : z[0] >= z[1];
      }
      EXPECT_GT(both, 10'000);
      EXPECT_EQ(wrong, 0) << s;
    }
}

}  // namespace
}  // namespace quadrille
