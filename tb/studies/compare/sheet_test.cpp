// The layout of a contact sheet, by looking for the colours of the pictures in it: text depends on the fonts installed.
#include "tb/studies/compare/sheet.hpp"

#include "golden/io/image_diff.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

namespace quadrille::compare {
namespace {

using golden::Image8;
using Colour = std::array<std::uint8_t, 3>;

constexpr Colour red{250, 10, 20}, green{20, 200, 30}, blue{30, 40, 240};

Image8 filled(int width, int height, const Colour& colour) {
  Image8 image{width, height, {}};
  for (int i = 0; i < width * height; ++i) image.rgba.insert(image.rgba.end(), {colour[0], colour[1], colour[2], 255});
  return image;
}

void set(Image8& image, int x, int y, const Colour& colour) {
  std::copy(colour.begin(), colour.end(), image.rgba.begin() + 4 * (y * image.width + x));
}

/// Where a colour stands in a picture, and how often.
struct Found {
  int x0 = 1 << 20, y0 = 1 << 20, x1 = -1, y1 = -1, count = 0;
  int width() const { return x1 - x0 + 1; }
  int height() const { return y1 - y0 + 1; }
};

Found find(const Image8& image, const Colour& colour) {
  Found found;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (std::equal(colour.begin(), colour.end(), image.rgba.begin() + 4 * (y * image.width + x))) {
        found = {std::min(found.x0, x), std::min(found.y0, y), std::max(found.x1, x), std::max(found.y1, y),
                 found.count + 1};
      }
  return found;
}

Sheet two_by_two() {
  Sheet sheet;
  sheet.title = "title";
  sheet.columns = {"one", "two"};
  sheet.rows = {{"upper", {SheetCell{filled(100, 50, red), "caption"}, std::nullopt}},
                {"lower", {SheetCell{filled(100, 50, blue), ""}, SheetCell{filled(100, 50, green), ""}}}};
  return sheet;
}

TEST(Sheet, PicturesStandInTheirRowsAndColumns) {
  const Image8 image = draw_sheet(two_by_two(), 100);
  ASSERT_EQ(image.rgba.size(), 4u * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  const Found r = find(image, red), g = find(image, green), b = find(image, blue);
  for (const Found& found : {r, g, b}) {
    EXPECT_EQ(found.width(), 100);
    EXPECT_EQ(found.height(), 50);
    EXPECT_EQ(found.count, 100 * 50);
  }
  EXPECT_EQ(r.x0, b.x0);
  EXPECT_EQ(g.y0, b.y0);
  EXPECT_GT(g.x0, b.x1);
  EXPECT_GT(b.y0, r.y1);
}

TEST(Sheet, SmallPicturesGrowWithSharpEdgesAndHighOnesShrink) {
  Sheet sheet = two_by_two();
  Image8 halves = filled(2, 1, red);
  set(halves, 1, 0, green);
  sheet.rows = {{"", {SheetCell{halves, ""}, SheetCell{filled(50, 300, blue), ""}}}};
  const Image8 image = draw_sheet(sheet, 100);
  const Found r = find(image, red), g = find(image, green), b = find(image, blue);
  EXPECT_EQ(r.count, 50 * 50);  // 2 × 1 enlarged 50 times, nothing between the two colours
  EXPECT_EQ(g.count, 50 * 50);
  EXPECT_EQ(g.x0, r.x1 + 1);
  EXPECT_EQ(b.height(), 200) << "twice the cell's width at most";
  EXPECT_NEAR(b.width(), 33, 1);
}

TEST(Sheet, LegendNamesItsColours) {
  Sheet sheet = two_by_two();
  const Image8 plain = draw_sheet(sheet, 100);
  constexpr Colour key{201, 102, 53};
  sheet.keys = {{key, "a key"}};
  const Image8 image = draw_sheet(sheet, 100);
  EXPECT_GT(image.height, plain.height);
  EXPECT_EQ(find(plain, key).count, 0);
  EXPECT_GT(find(image, key).count, 100);
  EXPECT_GT(find(image, key).y0, find(image, green).y1);
}

TEST(Sheet, RefusesWhatTheDrawingLibraryCannotHold) {
  const int most = most_columns(2048);
  Sheet sheet;
  sheet.columns.assign(static_cast<std::size_t>(most) + 1, "");
  EXPECT_THROW(draw_sheet(sheet, 2048), std::runtime_error);
  sheet.columns.pop_back();
  EXPECT_LE(draw_sheet(sheet, 2048).width, 32767);
}

TEST(Sheet, EveryScaleHasItsBar) {
  Sheet sheet = two_by_two();
  const int none = draw_sheet(sheet, 100).height;
  sheet.scales = {{"difference", 1, 14}};
  const Image8 one = draw_sheet(sheet, 100);
  sheet.scales.push_back({"slope", 4, 12});
  const Image8 two = draw_sheet(sheet, 100);
  EXPECT_GT(one.height, none);
  EXPECT_GT(two.height, one.height);
  // The colour in the middle of each bar, which nothing else has.
  const Colour middle = golden::heat_colour(std::exp2(-7), 1, 14);
  const auto near = [&](const Image8& image) {
    int count = 0;
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
      bool same = true;
      for (std::size_t c = 0; c < 3; ++c) same = same && std::abs(image.rgba[i + c] - middle[c]) <= 6;
      count += same;
    }
    return count;
  };
  EXPECT_EQ(near(draw_sheet(two_by_two(), 100)), 0);
  EXPECT_GT(near(one), 20);
  EXPECT_EQ(near(two), 2 * near(one));
}

}  // namespace
}  // namespace quadrille::compare
