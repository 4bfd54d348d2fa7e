#include "tb/studies/compare/sheet.hpp"

#include <gtest/gtest.h>

namespace quadrille::compare {
namespace {

/// A black picture under the outlines of square cells.
golden::Image8 grid(int side, int cell, double width) {
  golden::Image8 picture;
  picture.width = picture.height = side;
  picture.rgba.assign(4 * static_cast<std::size_t>(side) * static_cast<std::size_t>(side), 0);
  for (std::size_t i = 3; i < picture.rgba.size(); i += 4) picture.rgba[i] = 255;
  std::vector<Polyline> lines;
  for (double y = 0; y < side; y += cell)
    for (double x = 0; x < side; x += cell)
      lines.push_back(
          {{{x, y}, {x + cell, y}, {x + cell, y + cell}, {x, y + cell}, {x, y}}, wireframe_opacity(cell, width)});
  draw_lines(picture, lines, {255, 255, 255}, width);
  return picture;
}

double mean(const golden::Image8& picture) {
  double sum = 0;
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4) sum += picture.rgba[i] / 255.0;
  return sum / (static_cast<double>(picture.rgba.size()) / 4);
}

// The picture below stays to be seen: opaque lines of 1 px would cover all of 2-px cells.
TEST(Wireframe, FineMeshesFade) {
  for (const double width : {0.6, 1.0, 2.0})
    for (const int cell : {2, 4, 5, 8, 16, 64}) {
      EXPECT_LT(mean(grid(128, cell, width)), 0.2) << cell << ", " << width;
      EXPECT_GT(mean(grid(128, cell, width)), 0.01) << cell << ", " << width;
    }
}

TEST(Wireframe, CoarseMeshesHaveFullLines) {
  const golden::Image8 picture = grid(128, 32, 1.0);
  const auto at = [&](std::size_t x, std::size_t y) { return picture.rgba[4 * (y * 128 + x)]; };
  EXPECT_GT(at(32, 50), 100);  // two pixels share the line
  EXPECT_GT(at(31, 50), 100);
  EXPECT_EQ(at(40, 50), 0);
}

}  // namespace
}  // namespace quadrille::compare
