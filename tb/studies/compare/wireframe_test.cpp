#include "tb/studies/compare/sheet.hpp"

#include <gtest/gtest.h>

namespace quadrille::compare {
namespace {

golden::Image8 white(int side) {
  golden::Image8 picture{side, side, {}};
  picture.rgba.assign(4 * static_cast<std::size_t>(side) * static_cast<std::size_t>(side), 255);
  return picture;
}

/// The outlines of square cells over a white picture, in a cell of the sheet that wide.
golden::Image8 grid(int side, int cell, int cell_width) {
  std::vector<Polyline> lines;
  for (double y = 0; y < side; y += cell)
    for (double x = 0; x < side; x += cell)
      lines.push_back(
          {{{x, y}, {x + cell, y}, {x + cell, y + cell}, {x, y + cell}, {x, y}}, static_cast<double>(cell)});
  return draw_mesh(white(side), lines, cell_width);
}

double darkness(const golden::Image8& picture) {
  double sum = 0;
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4) sum += 1 - picture.rgba[i] / 255.0;
  return sum / (static_cast<double>(picture.rgba.size()) / 4);
}

// Opaque lines of 1 px would cover all of 2-px cells; enlarged, lines stay one pixel wide.
TEST(Wireframe, LinesNeverFillTheirPicture) {
  for (const int width : {64, 128, 512})
    for (const int cell : {2, 4, 5, 8, 16, 64}) {
      EXPECT_LT(darkness(grid(128, cell, width)), 0.2) << cell << ", " << width;
      EXPECT_GT(darkness(grid(128, cell, width)), 0.002) << cell << ", " << width;
    }
}

TEST(Wireframe, CoarseMeshesHaveDarkLines) {
  const golden::Image8 picture = grid(128, 32, 128);
  const auto at = [&](std::size_t x, std::size_t y) { return picture.rgba[4 * (y * 128 + x)]; };
  EXPECT_LT(at(32, 50), 120);  // two pixels share the line
  EXPECT_LT(at(31, 50), 120);
  EXPECT_EQ(at(40, 50), 255);
}

TEST(Wireframe, IsAsLargeAsItsCell) {
  const golden::Image8 picture = grid(32, 8, 256);
  EXPECT_EQ(picture.width, 256);
  EXPECT_EQ(picture.height, 256);
  const auto at = [&](std::size_t x, std::size_t y) { return picture.rgba[4 * (y * 256 + x)]; };
  EXPECT_LT(at(64, 100), 120);  // the line at 8, eight times enlarged
  EXPECT_EQ(at(68, 100), 255);
}

TEST(Wireframe, ThePictureBelowIsPale) {
  golden::Image8 black = white(16);
  for (std::size_t i = 0; i < black.rgba.size(); ++i) black.rgba[i] = i % 4 == 3 ? 255 : 0;
  const golden::Image8 picture = draw_mesh(black, {}, 16);
  EXPECT_GT(picture.rgba[0], 150);
  EXPECT_LT(picture.rgba[0], 220);
}

}  // namespace
}  // namespace quadrille::compare
