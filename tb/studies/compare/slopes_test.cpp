#include "tb/studies/compare/slopes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace quadrille::compare {
namespace {

/// One quad of 16 × 8 pixels, a value from the pixel's place.
template <class Value>
AttributeImage image_of(Value&& value) {
  AttributeImage image(16, 8, 2);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 16; ++x) image.set(x, y, 3, std::array{0.25, value(x, y)});
  return image;
}

TEST(SlopeChanges, ARampHasNone) {
  const AttributeImage image = image_of([](int x, int y) { return 0.5 * x - 0.125 * y; });
  const std::vector<float> changes = slope_changes(image);
  ASSERT_EQ(changes.size(), 128u);
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const bool corner = (i % 16 == 0 || i % 16 == 15) && (i / 16 == 0 || i / 16 == 7);
    EXPECT_EQ(std::isnan(changes[i]), corner) << i;
    if (!corner) {
      EXPECT_EQ(changes[i], 0) << i;
    }
  }
}

/// A kink of 1/8 a pixel is one of 16/8 a side, on the line alone.
TEST(SlopeChanges, AKinkIsSeenOnItsLine) {
  for (const bool upright : {true, false}) {
    const AttributeImage image = image_of([&](int x, int y) { return std::max(0.0, (upright ? x : y) - 4.0) / 8; });
    const std::vector<float> changes = slope_changes(image);
    for (int y = 1; y < 7; ++y)
      for (int x = 1; x < 15; ++x)
        EXPECT_EQ(changes[image.pixel(x, y)], (upright ? x : y) == 4 ? 2 : 0) << x << ", " << y;
  }
}

TEST(SlopeChanges, StayWithinAQuadAndWithinNumbers) {
  AttributeImage image = image_of([](int x, int) { return x < 8 ? 0.0 : 1.0; });
  for (int y = 0; y < 8; ++y)
    for (int x = 8; x < 16; ++x) image.quad[image.pixel(x, y)] = 4;
  image.set_undefined(3, 3, 3);
  image.state[image.pixel(3, 5)] = PixelState::empty;
  const std::vector<float> changes = slope_changes(image);
  for (const float change : changes) EXPECT_TRUE(std::isnan(change) || change == 0) << change;
  EXPECT_TRUE(std::isnan(changes[image.pixel(3, 3)]));
  EXPECT_EQ(changes[image.pixel(3, 4)], 0);  // along its row
}

}  // namespace
}  // namespace quadrille::compare
