#include "golden/io/image_diff.hpp"

#include "golden/io/error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace quadrille::golden {
namespace {

ExrImage picture() {
  ExrImage image;
  image.width = 3;
  image.height = 2;
  image.floats["R"] = {0, 1, 2, 3, 4, 5};
  image.floats["L0"] = {0, 0, 0, 0, 0, 0};
  image.uints["quad"] = {1, 1, 2, 2, 3, 3};
  return image;
}

TEST(ImageDiff, SameIsSame) {
  ExrImage a = picture();
  a.floats["L0"][3] = std::numeric_limits<float>::quiet_NaN();
  const ImageDiff diff = diff_images(a, a, "a", "b");
  EXPECT_TRUE(diff.same());
  ASSERT_EQ(diff.channels.size(), 3u);
  EXPECT_EQ(diff.channels[0].name, "L0");
}

TEST(ImageDiff, CountsMaximumAndRms) {
  ExrImage b = picture();
  b.floats["R"] = {0, 1, 2, 3, 1, 5.5f};  // differences 3 at (1, 1) and 0.5 at (2, 1)
  b.uints["quad"][0] = 7;
  const ImageDiff diff = diff_images(picture(), b, "a", "b");
  EXPECT_FALSE(diff.same());
  const ChannelDiff& red = diff.channels[1];
  EXPECT_EQ(red.name, "R");
  EXPECT_EQ(red.count, 2u);
  EXPECT_EQ(red.max, 3);
  EXPECT_EQ(red.x, 1);
  EXPECT_EQ(red.y, 1);
  EXPECT_DOUBLE_EQ(red.rms, std::sqrt(9.25 / 6));
  EXPECT_EQ(diff.channels[2].count, 1u);
  EXPECT_EQ(diff.channels[2].max, 6);
  EXPECT_EQ(diff.largest, (std::vector<float>{0, 0, 0, 0, 3, 0.5f}));
}

TEST(ImageDiff, NanAgainstANumberDiffers) {
  ExrImage b = picture();
  b.floats["L0"][2] = std::numeric_limits<float>::quiet_NaN();
  const ImageDiff diff = diff_images(picture(), b, "a", "b");
  EXPECT_EQ(diff.channels[0].count, 1u);
  EXPECT_EQ(diff.channels[0].max, 0);
  EXPECT_EQ(diff.channels[0].nans, 1u);
  EXPECT_EQ(diff.channels[0].nan_x, 2);
  EXPECT_EQ(diff.channels[0].nan_y, 0);
  EXPECT_FALSE(diff.same());
  const Image8 map = heat_map(diff);
  ASSERT_GT(map.width, 3);  // the scale is wider
  EXPECT_EQ(map.rgba[4 * 2], 255);
  EXPECT_EQ(map.rgba[4 * 2 + 2], 255);
}

TEST(ImageDiff, ChannelsOfOneOnlyAndSizes) {
  ExrImage b = picture();
  b.floats.erase("L0");
  b.uints["id"] = b.uints["quad"];
  const ImageDiff diff = diff_images(picture(), b, "a", "b");
  EXPECT_EQ(diff.only_a, std::vector<std::string>{"L0"});
  EXPECT_EQ(diff.only_b, std::vector<std::string>{"id"});
  EXPECT_FALSE(diff.same());
  b.width = 2;
  b.height = 3;
  EXPECT_THROW(diff_images(picture(), b, "a", "b"), InputError);
}

TEST(ImageDiff, HeatMapRisesWithTheDifference) {
  ExrImage a = picture(), b = picture();
  b.floats["R"] = {0, 1 + 0x1p-10f, 2 + 0x1p-5f, 4, 4, 5};
  const Image8 map = heat_map(diff_images(a, b, "a", "b"));
  const auto light = [&](std::size_t i) { return map.rgba[4 * i] + map.rgba[4 * i + 1] + map.rgba[4 * i + 2]; };
  EXPECT_EQ(light(0), 0);
  EXPECT_GT(light(1), 0);
  EXPECT_GT(light(2), light(1));
  const auto below = static_cast<std::size_t>(map.width);  // the second row, its first pixel
  EXPECT_GT(light(below), light(2));
}

/// The bar has the colours of the map where its numbers say: 1 at the right end, 1/16 = 2^-4 a quarter from there.
TEST(ImageDiff, HeatMapHasItsScale) {
  for (const int width : {3, 900}) {
    ExrImage a;
    a.width = width;
    a.height = 2;
    a.floats["R"].assign(2 * static_cast<std::size_t>(width), 1);
    ExrImage b = a;
    b.floats["R"][0] = 2;
    b.floats["R"][1] = 1.0625f;
    const Image8 map = heat_map(diff_images(a, b, "a", "b"));
    EXPECT_EQ(map.width, std::max(width, 230));
    const auto pixel = [&](int x, int y) {
      const auto at = map.rgba.begin() + (static_cast<std::ptrdiff_t>(y) * map.width + x) * 4;
      return std::array<int, 3>{at[0], at[1], at[2]};
    };
    const std::array<int, 3> most = pixel(0, 0), sixteenth = pixel(1, 0);
    // In some row below the map the largest colour ends the bar, and the other one lies at three quarters of it.
    int rows = 0;
    for (int y = map.height - 1; y >= 2; --y) {
      const int margin = width >= 460 ? 12 : 6, right = map.width - 1 - margin;
      const auto near = [&](const std::array<int, 3>& p, const std::array<int, 3>& q) {
        return std::abs(p[0] - q[0]) + std::abs(p[1] - q[1]) + std::abs(p[2] - q[2]) <= 8;
      };
      const int at = margin + (map.width - 2 * margin) * 3 / 4;
      rows += near(pixel(right, y), most) && near(pixel(at, y), sixteenth) && !near(pixel(right + 1, y), most);
    }
    EXPECT_EQ(rows, width >= 460 ? 20 : 10);
  }
  const ExrImage a = picture();
  const Image8 equal = heat_map(diff_images(a, a, "a", "a"));
  ExrImage b = a;
  b.floats["R"][0] = 1;
  EXPECT_LT(equal.height, heat_map(diff_images(a, b, "a", "b")).height);  // without a bar
}

}  // namespace
}  // namespace quadrille::golden
