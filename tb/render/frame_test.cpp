// The depth test of a frame.
#include "tb/render/frame.hpp"

#include <gtest/gtest.h>

namespace quadrille::cli {
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

}  // namespace
}  // namespace quadrille::cli
