// Frames against frames: every kind of pixel, statistics by hand, numbers that are none.
#include "tb/studies/compare/frame_error.hpp"

#include "model/support/prng.hpp"
#include "tb/studies/compare/test_support.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace quadrille::compare {
namespace {

using Values = std::vector<double>;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

AttributeImage constant(int width, int height, const Values& values) {
  return test::paint(width, height, static_cast<int>(values.size()), [&](double, double) { return values; });
}

TEST(FrameError, EqualFrames) {
  const auto image = constant(5, 4, {0.5, -3});
  const FrameError e = compare_frames(image, image);
  EXPECT_EQ(e.method_covered, 20u);
  EXPECT_EQ(e.reference_covered, 20u);
  EXPECT_EQ(e.missing + e.extra + e.other_quad + e.method_undefined + e.reference_undefined + e.wrong, 0u);
  EXPECT_EQ(e.error.count(), 20u);
  EXPECT_EQ(e.error.max(), 0);
  EXPECT_EQ(e.x, 0);
  EXPECT_EQ(e.y, 0);
  EXPECT_EQ(e.image, std::vector<float>(20, 0.0f));
}

TEST(FrameError, EveryKindOfPixel) {
  // One row: equal, missing, extra, other quad, undefined in the method, in the reference, in both, undefined and
  // missing in the reference, undefined of another quad, nothing, off by 0.25.
  AttributeImage method(11, 1, 2), reference(11, 1, 2);
  const auto set = [](AttributeImage& image, int x, std::uint32_t quad) { image.set(x, 0, quad, Values{1, 2}); };
  set(method, 0, 7), set(reference, 0, 7);
  set(reference, 1, 7);
  set(method, 2, 7);
  set(method, 3, 7), set(reference, 3, 8);
  method.set_undefined(4, 0, 7), set(reference, 4, 7);
  set(method, 5, 7), reference.set_undefined(5, 0, 7);
  method.set_undefined(6, 0, 7), reference.set_undefined(6, 0, 7);
  method.set_undefined(7, 0, 7);
  method.set_undefined(8, 0, 7), set(reference, 8, 8);
  method.set(10, 0, 7, Values{0.75, 2.125}), set(reference, 10, 7);

  const FrameError e = compare_frames(method, reference);
  EXPECT_EQ(e.method_covered, 9u);
  EXPECT_EQ(e.reference_covered, 8u);
  EXPECT_EQ(e.missing, 1u);
  EXPECT_EQ(e.extra, 2u);
  EXPECT_EQ(e.other_quad, 2u);
  EXPECT_EQ(e.method_undefined, 4u);
  EXPECT_EQ(e.reference_undefined, 2u);
  EXPECT_EQ(e.error.count(), 2u);
  EXPECT_EQ(e.error.max(), 0.25);
  EXPECT_EQ(e.error.mean(), 0.125);
  EXPECT_DOUBLE_EQ(e.error.rms(), 0.25 / std::sqrt(2));
  EXPECT_DOUBLE_EQ(e.rms, 0.25 / std::sqrt(2));
  EXPECT_EQ(e.wrong, 1u);
  EXPECT_EQ(e.x, 10);
  EXPECT_EQ(e.y, 0);
  for (std::size_t x = 0; x < 11; ++x) {
    if (x == 0 || x == 9 || x == 10)
      EXPECT_EQ(e.image[x], x == 9 ? -1.0f : x == 10 ? 0.25f : 0.0f) << x;
    else
      EXPECT_TRUE(std::isnan(e.image[x])) << x;
  }
}

TEST(FrameError, NumbersThatAreNone) {
  for (const double bad : {nan, -nan, infinity, -infinity}) {
    for (const std::size_t channel : {0, 1}) {
      const auto good = constant(4, 4, {1, 1});
      auto broken = good;
      broken.values(6)[channel] = bad;
      const FrameError method = compare_frames(broken, good), reference = compare_frames(good, broken),
                       both = compare_frames(broken, broken);
      EXPECT_EQ(method.method_undefined, 1u);
      EXPECT_EQ(method.reference_undefined, 0u);
      EXPECT_EQ(reference.method_undefined, 0u);
      EXPECT_EQ(reference.reference_undefined, 1u);
      EXPECT_EQ(both.method_undefined, 1u);
      EXPECT_EQ(both.reference_undefined, 1u);
      for (const FrameError& e : {method, reference, both}) {
        EXPECT_EQ(e.error.count(), 15u);
        EXPECT_EQ(e.error.max(), 0);
        EXPECT_EQ(e.wrong, 0u);
        EXPECT_TRUE(std::isnan(e.image[6]));
      }
    }
  }
  // What is in an empty or undefined pixel does not matter.
  auto method = constant(4, 4, {1});
  test::erase(method, 1, 1);
  method.set_undefined(2, 2, 0);
  const auto before = compare_frames(method, constant(4, 4, {1}));
  method.values(5)[0] = nan, method.values(10)[0] = 77;
  const auto after = compare_frames(method, constant(4, 4, {1}));
  EXPECT_EQ(before.missing, 1u);
  EXPECT_EQ(after.missing, 1u);
  EXPECT_EQ(after.method_undefined, 1u);
  EXPECT_EQ(after.error.count(), 14u);
  EXPECT_EQ(after.error.max(), 0);
}

TEST(FrameError, ADifferenceMayBeInfinite) {
  const FrameError e = compare_frames(constant(2, 1, {1.7e308}), constant(2, 1, {-1.7e308}));
  EXPECT_EQ(e.error.max(), infinity);
  EXPECT_EQ(e.rms, infinity);
  EXPECT_EQ(e.wrong, 2u);
  EXPECT_EQ(e.x, 0);
}

TEST(FrameError, WrongIsAboveTheLimit) {
  const auto zero = constant(3, 1, {0});
  auto method = zero;
  method.values(0)[0] = 1e-3;
  method.values(1)[0] = -std::nextafter(1e-3, 1);
  method.values(2)[0] = 1e-4;
  EXPECT_EQ(compare_frames(method, zero).wrong, 1u);
  EXPECT_EQ(compare_frames(method, zero, 1e-4).wrong, 2u);
  EXPECT_EQ(compare_frames(method, zero, 0).wrong, 3u);
  EXPECT_EQ(compare_frames(method, zero, infinity).wrong, 0u);
}

TEST(FrameError, ThePixelOfTheMaximumIsTheFirst) {
  const auto zero = constant(6, 5, {0, 0});
  auto method = zero;
  method.values(method.pixel(4, 1))[0] = 0.5;
  method.values(method.pixel(2, 3))[1] = -2;
  method.values(method.pixel(5, 3))[0] = 2;
  const FrameError e = compare_frames(method, zero);
  EXPECT_EQ(e.error.max(), 2);
  EXPECT_EQ(e.x, 2);
  EXPECT_EQ(e.y, 3);
  EXPECT_EQ(e.image[static_cast<std::size_t>(3 * 6 + 2)], 2.0f);
  const FrameError none = compare_frames(AttributeImage(6, 5, 2), zero);
  EXPECT_EQ(none.missing, 30u);
  EXPECT_EQ(none.error.count(), 0u);
  EXPECT_EQ(none.rms, 0);
  EXPECT_EQ(none.x, -1);
  EXPECT_EQ(none.y, -1);
}

TEST(FrameError, TheNearestRankOfTheQuantile) {
  // Of 1000 errors the 999th smallest. 0.25 lies in the bin from 16/16 to 17/16 of 0.25.
  const auto zero = constant(100, 10, {0});
  auto method = constant(100, 10, {0.25});
  method.values(500)[0] = 8;
  EXPECT_EQ(compare_frames(method, zero).error.p999(), 0.25 * 17 / 16);
  method.values(77)[0] = -8;
  const FrameError e = compare_frames(method, zero);
  EXPECT_EQ(e.error.p999(), 8) << "never above the maximum";
  EXPECT_DOUBLE_EQ(e.error.mean(), (998 * 0.25 + 16) / 1000);
  EXPECT_DOUBLE_EQ(e.error.rms(), std::sqrt((998 * 0.0625 + 128) / 1000));
  EXPECT_DOUBLE_EQ(e.rms, std::sqrt((998 * 0.0625 + 128) / 1000));
}

TEST(FrameError, TheRootMeanSquareOfSmallErrors) {
  for (const double size : {1e-150, 0x1p-60, 0x1p-52, 1.0, 1e150}) {
    const auto zero = constant(10, 4, {0, 0});
    auto method = zero;
    for (std::size_t p = 0; p < 10; ++p) method.values(p)[p % 2] = p < 5 ? size : -size;
    test::erase(method, 9, 3);                   // of the 39 that remain
    method.set(8, 3, 1, Values{1, 1});           // 38
    method.values(method.pixel(7, 3))[0] = nan;  // 37
    const FrameError e = compare_frames(method, zero);
    EXPECT_EQ(e.error.count(), 37u);
    EXPECT_DOUBLE_EQ(e.rms, size * std::sqrt(10.0 / 37));
  }
}

TEST(FrameError, EveryPixelIsOneKind) {
  golden::Prng random(3);
  for (int round = 0; round < 50; ++round) {
    const int width = static_cast<int>(random.integer(1, 20)), height = static_cast<int>(random.integer(1, 20));
    const auto make = [&] {
      AttributeImage image(width, height, 1);
      for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
          if (random.chance(0.3)) continue;
          const auto quad = static_cast<std::uint32_t>(random.below(2));
          if (random.chance(0.1))
            image.set_undefined(x, y, quad);
          else
            image.set(x, y, quad, Values{random.chance(0.1) ? nan : random.uniform()});
        }
      }
      return image;
    };
    const AttributeImage method = make(), reference = make();
    const FrameError e = compare_frames(method, reference), turned = compare_frames(reference, method);
    std::uint64_t numbers = 0, unnumbered = 0;
    double largest = 0;
    for (std::size_t p = 0; p < method.quad.size(); ++p) {
      if (method.quad[p] != reference.quad[p] || method.quad[p] == AttributeImage::no_quad) continue;
      const double difference = method.value[p] - reference.value[p];  // NaN where either is
      const bool number =
          method.state[p] == PixelState::drawn && reference.state[p] == PixelState::drawn && difference == difference;
      ++(number ? numbers : unnumbered);
      if (number) largest = std::max(largest, std::fabs(difference));
    }
    EXPECT_EQ(e.error.count(), numbers);
    EXPECT_EQ(e.error.max(), largest);
    EXPECT_EQ(e.method_covered + e.missing, e.missing + e.extra + e.other_quad + numbers + unnumbered);
    EXPECT_EQ(e.reference_covered + e.extra, e.method_covered + e.missing);
    EXPECT_EQ(e.missing, turned.extra);
    EXPECT_EQ(e.extra, turned.missing);
    EXPECT_EQ(e.method_undefined, turned.reference_undefined);
    EXPECT_EQ(e.other_quad, turned.other_quad);
    EXPECT_EQ(e.error.max(), turned.error.max());
  }
}

TEST(FrameError, FramesMustMatch) {
  EXPECT_THROW(compare_frames(AttributeImage(3, 4, 1), AttributeImage(4, 3, 1)), std::invalid_argument);
  EXPECT_THROW(compare_frames(AttributeImage(4, 4, 1), AttributeImage(4, 3, 1)), std::invalid_argument);
  EXPECT_THROW(compare_frames(AttributeImage(4, 4, 1), AttributeImage(3, 4, 1)), std::invalid_argument);
  EXPECT_THROW(compare_frames(AttributeImage(4, 4, 1), AttributeImage(4, 4, 2)), std::invalid_argument);
}

}  // namespace
}  // namespace quadrille::compare
