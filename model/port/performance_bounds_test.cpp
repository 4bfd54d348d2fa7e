#include "model/port/performance_counters_test_support.hpp"

#include <algorithm>

namespace quadrille {
namespace {

PerformanceCounter largest_bound(const PerformanceCounters& c) {
  const auto first = c.value.begin() + static_cast<int>(PerformanceCounter::bound_pixels);
  return static_cast<PerformanceCounter>(std::max_element(first, c.value.end()) - c.value.begin());
}

TEST(PerformanceCounters, AQuadOfEveryReason) {
  DrawState state;
  state.cull = Cull::back;
  state.zfar = 0.75;
  WindowQuad behind = square(16, 16, 8), outside = square(16, 16, 8), crossing = square(16, 16, 64);
  for (WindowVertex& v : behind.vertex) v = {-v.x, -v.y, -v.z, -1};
  for (WindowVertex& v : outside.vertex) v.z = 0.9;
  crossing.vertex[0] = {-8, -8, -0.25, -0.5};
  const WindowQuad empty = square(600, 16, 8), tiny = square(16.6, 16.6, 0.5);
  const WindowQuad line = quad_of({{{10, 10}, {20, 20}, {30, 30}, {40, 40}}});
  WindowQuad culled = square(16, 16, 8);
  std::swap(culled.vertex[1], culled.vertex[3]);
  const std::vector<WindowQuad> quads{behind, outside, outside, crossing, empty,
                                      tiny,   empty,   line,    culled,   square(32, 32, 8)};
  const PerformanceCounters c = count(quads, {}, state);
  EXPECT_EQ(c[quads_empty], 3u);
  EXPECT_EQ(c[quads_behind], 1u);
  EXPECT_EQ(c[quads_depth], 2u);
  EXPECT_EQ(c[quads_line], 1u);
  EXPECT_EQ(c[quads_culled], 1u);
  EXPECT_EQ(c[quads_ordinary], 1u);
  EXPECT_EQ(c[quads_homogeneous], 1u);
  state.skip = skip_tiles;
  const PerformanceCounters all = count(quads, {}, state);
  EXPECT_EQ(all.quads_left_out(), 0u);
  EXPECT_EQ(all[quads_homogeneous], 2u);  // that behind the eye too
  EXPECT_EQ(all[fragments], c[fragments]);
  EXPECT_GT(all.pixels(), c.pixels());  // those outside [znear, zfar] are drawn and discarded
}

TEST(PerformanceCounters, AClockIsChargedToWhatBoundsIt) {
  // Lone pixels: setup has no time for more.
  std::vector<WindowQuad> tiny, large;
  for (int i = 0; i < 200; ++i) tiny.push_back(square(3 * (i % 100) + 8, 8, 1));
  for (int i = 0; i < 4; ++i) large.push_back(square(64 * i, 0, 64));
  EXPECT_EQ(largest_bound(count(large)), bound_pixels);
  EXPECT_EQ(largest_bound(count(tiny)), bound_setup);
  EXPECT_EQ(largest_bound(count(large, {}, {}, {.ready = 8})), bound_output);
  EXPECT_EQ(largest_bound(count(tiny, {}, {}, {.every = 256, .burst = 4})), bound_idle);
  EXPECT_EQ(largest_bound(count(tiny, {}, {}, {.every = 16})), bound_vertices);
  // One diagonal strip over the whole viewport: hardly a tile of a block is hit, and few pixels of it.
  DrawState state;
  state.skip = 0;
  const WindowQuad strip = quad_of({{{0, 1}, {511, 512}, {512, 511}, {1, 0}}});
  const PerformanceCounters strip_all = count({strip}, {}, state);
  EXPECT_EQ(strip_all[tiles_entered], 64u * 64);
  EXPECT_EQ(largest_bound(strip_all), bound_stamps);  // eight rows of every tile
}

TEST(PerformanceCounters, OrderOfTheBounds) {
  BoundInputs in;
  EXPECT_EQ(bound_of(in), bound_idle);
  // Each of these is charged in place of those before it.
  const std::array<std::pair<bool BoundInputs::*, PerformanceCounter>, 6> holds{
      {{&BoundInputs::busy, bound_drain},
       {&BoundInputs::wipe, bound_wipe},
       {&BoundInputs::assembly, bound_vertices},
       {&BoundInputs::setup, bound_setup},
       {&BoundInputs::walk, bound_walk},
       {&BoundInputs::rows, bound_stamps}}};
  for (const auto& [member, bound] : holds) {
    in.*member = true;
    EXPECT_EQ(bound_of(in), bound);
  }
  in.setup_behind = true;
  EXPECT_EQ(bound_of(in), bound_setup);
  in.walk_behind = true;
  EXPECT_EQ(bound_of(in), bound_walk);
  in.rows_behind = true;
  EXPECT_EQ(bound_of(in), bound_stamps);
  in.head = true;
  EXPECT_EQ(bound_of(in), bound_pixels);
  in.head_waits = true;
  EXPECT_EQ(bound_of(in), bound_output);
}

}  // namespace
}  // namespace quadrille
