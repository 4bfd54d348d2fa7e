// What part of a frame a sheet shows.
#include "tb/studies/compare/crop.hpp"

#include <gtest/gtest.h>

namespace quadrille::compare {
namespace {

void cover(AttributeImage& image, int x, int y) { image.set(x, y, 0, std::array{0.0}); }

TEST(Crop, ASmallThingIsShownWithItsMargin) {
  AttributeImage a(100, 80, 1), b(100, 80, 1);
  cover(a, 40, 30);
  cover(b, 59, 34);
  const Crop crop(a, b);  // 20 × 5 pixels, a margin of 4 + 2
  EXPECT_EQ(crop.x0, 34);
  EXPECT_EQ(crop.y0, 24);
  EXPECT_EQ(crop.x1, 66);
  EXPECT_EQ(crop.y1, 41);
  golden::Image8 picture;
  picture.width = 100;
  picture.height = 80;
  for (int i = 0; i < 100 * 80; ++i)
    for (int c = 0; c < 4; ++c) picture.rgba.push_back(static_cast<std::uint8_t>(c == 0 ? i % 100 : i / 100));
  const golden::Image8 part = crop.of(picture);
  ASSERT_EQ(part.rgba.size(), 32u * 17u * 4u);
  EXPECT_EQ(part.rgba[0], 34);
  EXPECT_EQ(part.rgba[1], 24);
  EXPECT_EQ(part.rgba[part.rgba.size() - 4], 65);
  EXPECT_EQ(part.rgba[part.rgba.size() - 3], 40);
}

TEST(Crop, NothingAndMuchAreShownWhole) {
  const AttributeImage empty(10, 10, 1);
  AttributeImage wide(100, 80, 1);
  cover(wide, 10, 40);
  cover(wide, 70, 41);
  for (const AttributeImage* image : {&empty, static_cast<const AttributeImage*>(&wide)}) {
    const Crop crop(*image, *image);
    EXPECT_EQ(crop.x0, 0);
    EXPECT_EQ(crop.y0, 0);
    EXPECT_EQ(crop.x1, image->width);
    EXPECT_EQ(crop.y1, image->height);
  }
}

}  // namespace
}  // namespace quadrille::compare
