// The depth test of a frame, and colours that are told apart.
#include "tb/render/frame.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <tuple>

namespace quadrille::tb {
namespace {

EngineSample sample_of(std::uint32_t quad, double z, bool undefined = false) {
  EngineSample s;
  s.index = s.quad = quad;
  s.x = 3, s.y = 2;
  s.z = z;
  s.undefined = undefined;
  return s;
}

/// The quad shown at the pixel after the samples have been added in order, -1 for none.
int shown(bool depth, std::initializer_list<EngineSample> samples) {
  FrameBuffer frame(5, 4, depth);
  for (const EngineSample& s : samples) frame.add(std::span(&s, 1));
  EXPECT_EQ(frame.fragments(), samples.size());
  EXPECT_EQ(frame.pixels_drawn(), frame.drawn(3, 2) ? 1u : 0u);
  return frame.drawn(3, 2) ? static_cast<int>(frame.shown(3, 2).quad) : -1;
}

TEST(FrameBuffer, DepthIsLessAgainstOneAndTheEarlierOfEqualsStays) {
  EXPECT_EQ(shown(true, {sample_of(7, 1)}), -1);
  EXPECT_EQ(shown(true, {sample_of(7, 0.999)}), 7);
  EXPECT_EQ(shown(true, {sample_of(7, 0.5), sample_of(8, 0.5)}), 7);
  EXPECT_EQ(shown(true, {sample_of(7, 0.5), sample_of(8, 0.4)}), 8);
  EXPECT_EQ(shown(true, {sample_of(7, 0.4), sample_of(8, 0.5)}), 7);
  EXPECT_EQ(shown(true, {sample_of(7, -3), sample_of(8, 0)}), 7);
}

TEST(FrameBuffer, WithoutDepthTheLaterQuadStays) {
  EXPECT_EQ(shown(false, {sample_of(7, 0.4), sample_of(8, 0.5)}), 8);
  EXPECT_EQ(shown(false, {sample_of(7, 1)}), 7);
}

TEST(FrameBuffer, AnUndefinedSampleShowsOnlyWhereNothingElseDoes) {
  for (const bool depth : {false, true}) {
    EXPECT_EQ(shown(depth, {sample_of(7, 0, true)}), 7);
    EXPECT_EQ(shown(depth, {sample_of(7, 0, true), sample_of(8, 0, true)}), 7);
    EXPECT_EQ(shown(depth, {sample_of(7, 0.9), sample_of(8, 0, true)}), 7);
    EXPECT_EQ(shown(depth, {sample_of(7, 0, true), sample_of(8, 0.9)}), 8);
  }
}

TEST(FrameBuffer, AmendsTheSampleOfTheSameQuadAlone) {
  const Config config;
  FrameBuffer frame(5, 4, true);
  const EngineSample near = sample_of(7, 0.25);
  frame.add(std::span(&near, 1));
  Fragment fragment;
  fragment.x = 3, fragment.y = 2;
  fragment.attribute[0] = std::int64_t{3} << (config.attribute_frac() - 1);
  const Pass pass{{5}};
  frame.amend(fragment, 8, pass, config);
  EXPECT_EQ(frame.shown(3, 2).attribute[1], 0);
  frame.amend(fragment, 7, pass, config);
  EXPECT_EQ(frame.shown(3, 2).attribute[1], 1.5);
  fragment.x = 4;
  frame.amend(fragment, 7, pass, config);
  EXPECT_FALSE(frame.drawn(4, 2));
}

/// A quad's fragments by columns are what its samples are, with weights and without.
TEST(FrameBuffer, TakesColumnsAsItTakesSamples) {
  const Config config;
  const double attribute_unit = std::ldexp(1.0, -config.attribute_frac());
  for (const bool weights : {false, true})
    for (const bool depth : {false, true}) {
      FrameBuffer by_columns(5, 4, depth, config, 2, weights), by_samples(5, 4, depth);
      for (std::uint32_t quad = 0; quad < 4; ++quad) {
        const std::array<FragmentPlace, 2> place{{{static_cast<std::uint16_t>(quad), 1}, {4, 3}}};
        const std::array<std::uint32_t, 2> codes{100 + quad % 2, 200 - quad % 3};
        std::array<std::array<std::int64_t, 2>, 6> column;
        QuadFragments fragments;
        fragments.index = quad;
        fragments.quad = 70 + quad;
        fragments.common = {quad, 2, place.data(), nullptr, codes.data(), 0, {}};
        std::array<EngineSample, 2> samples;
        for (std::size_t n = 0; n < 2; ++n) {
          samples[n] = sample_of(quad, std::ldexp(codes[n], -config.depth_bits));
          samples[n].quad = 70 + quad;
          samples[n].x = place[n].x, samples[n].y = place[n].y;
          for (std::size_t c = weights ? 0 : 4; c < 6; ++c) {
            column[c][n] = static_cast<std::int64_t>(1000 * quad + 10 * c + n) - 1500;
            fragments.column[c] = column[c].data();
            (c < 4 ? samples[n].lambda[c] : samples[n].attribute[c - 4]) =
                static_cast<double>(column[c][n]) * attribute_unit;
          }
        }
        by_columns.add(fragments);
        by_samples.add(samples);
      }
      EXPECT_EQ(by_columns.fragments(), 8u);
      EXPECT_EQ(by_columns.pixels_drawn(), 5u);
      for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 5; ++x) {
          ASSERT_EQ(by_columns.drawn(x, y), by_samples.drawn(x, y));
          const EngineSample a = by_columns.shown(x, y), b = by_samples.shown(x, y);
          EXPECT_EQ(std::tie(a.index, a.quad, a.z, a.lambda, a.attribute),
                    std::tie(b.index, b.quad, b.z, b.lambda, b.attribute));
        }
    }
}

/// The largest difference of a channel between two pixels of a picture, in steps of 8 bits.
int contrast(const golden::Image8& picture, std::size_t a, std::size_t b) {
  int largest = 0;
  for (std::size_t c = 0; c < 3; ++c)
    largest = std::max(largest, std::abs(picture.rgba[4 * a + c] - picture.rgba[4 * b + c]));
  return largest;
}

/// An attribute may pass its corners' by the machine's bound: beside an end it is that end, else it wraps.
TEST(ShadeFrame, CoordinatesNearAnEndDoNotWrap) {
  ShadeSettings settings;
  settings.shade = "uv";
  settings.slots.uv = 0;
  for (const auto& [u, red] : {std::pair{-0x1p-15, 0.0},
                               {1 + 0x1p-15, 1.0},
                               {0.0, 0.0},
                               {1.0, 1.0},
                               {0.25, 0.25},
                               {1.25, 0.25},
                               {-0.25, 0.75},
                               {2.0, 0.0}}) {
    FrameBuffer frame(5, 4, true);
    EngineSample sample = sample_of(0, 0.5);
    sample.attribute[0] = u;
    frame.add(std::span(&sample, 1));
    const golden::FrameImage image = shade_frame(frame, settings);
    EXPECT_EQ(image.r[image.index(3, 2)], static_cast<float>(red)) << u;
  }
}

TEST(ShadeFrame, EveryQuadStandsOutFromWhatIsNotDrawn) {
  constexpr int side = 300;
  FrameBuffer frame(side, side, false);
  for (std::uint32_t quad = 0; quad + 2 < side * side; ++quad) {  // one pixel each; then an undefined one, then none
    EngineSample s = sample_of(quad, 0, quad + 3 == side * side);
    s.x = static_cast<std::uint16_t>(quad % side), s.y = static_cast<std::uint16_t>(quad / side);
    frame.add(std::span(&s, 1));
  }
  ShadeSettings settings;
  settings.shade = "quad";
  const golden::Image8 picture = frame_picture(shade_frame(frame, settings));
  const std::size_t nothing = side * side - 1, undefined = side * side - 3;
  for (std::size_t pixel = 0; pixel < undefined; ++pixel) {
    ASSERT_GE(contrast(picture, pixel, nothing), 64) << pixel;
    ASSERT_GE(contrast(picture, pixel, undefined), 64) << pixel;
  }
}

TEST(ShadeFrame, DepthStandsOutFromWhatIsNotDrawn) {
  FrameBuffer frame(102, 1, true);
  for (int x = 0; x <= 100; ++x) {
    EngineSample s = sample_of(0, 0.009 * x);
    s.x = static_cast<std::uint16_t>(x), s.y = 0;
    frame.add(std::span(&s, 1));
  }
  ShadeSettings settings;
  settings.shade = "depth";
  const golden::Image8 picture = frame_picture(shade_frame(frame, settings));
  for (std::size_t pixel = 0; pixel <= 100; ++pixel) ASSERT_GE(contrast(picture, pixel, 101), 32) << pixel;
}

}  // namespace
}  // namespace quadrille::tb
