#include "golden/io/texture.hpp"

#include "golden/io/test_support.hpp"

#include <limits>

namespace quadrille::golden {
namespace {

/// 2×2: top row 10, 20; bottom row 30, 40 in red; green 255; blue 0; alpha 51.
Texture small() { return Texture(Image8{2, 2, {10, 255, 0, 51, 20, 255, 0, 51, 30, 255, 0, 51, 40, 255, 0, 51}}); }

TEST(Texture, TexelCentresGiveTheStoredValues) {
  const Texture texture = small();
  EXPECT_DOUBLE_EQ(texture.sample(0.25, 0.75)[0], 10 / 255.0);
  EXPECT_DOUBLE_EQ(texture.sample(0.75, 0.75)[0], 20 / 255.0);
  EXPECT_DOUBLE_EQ(texture.sample(0.25, 0.25)[0], 30 / 255.0);
  EXPECT_DOUBLE_EQ(texture.sample(0.75, 0.25)[0], 40 / 255.0);
  EXPECT_EQ(texture.sample(0.1, 0.9)[1], 1);
  EXPECT_EQ(texture.sample(0.1, 0.9)[2], 0);
  EXPECT_DOUBLE_EQ(texture.sample(0.1, 0.9)[3], 0.2);
}

TEST(Texture, InterpolatesAndRepeats) {
  const Texture texture = small();
  EXPECT_DOUBLE_EQ(texture.sample(0.5, 0.5)[0], 25 / 255.0);
  EXPECT_DOUBLE_EQ(texture.sample(0.375, 0.75)[0], 12.5 / 255);
  EXPECT_DOUBLE_EQ(texture.sample(0.25, 0.625)[0], 15 / 255.0);
  EXPECT_DOUBLE_EQ(texture.sample(0, 0.75)[0], 15 / 255.0);  // between the last column and the first
  EXPECT_DOUBLE_EQ(texture.sample(0.25, 0)[0], 20 / 255.0);
  for (const double shift : {-3.0, -1.0, 1.0, 1000.0}) {
    EXPECT_NEAR(texture.sample(0.3 + shift, 0.6 - shift)[0], texture.sample(0.3, 0.6)[0], 1e-12);
  }
}

TEST(Texture, AnyNumberIsSafe) {
  const Texture texture = small();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(texture.sample(infinity, 0.5), (std::array<double, 4>{}));
  EXPECT_EQ(texture.sample(0.5, std::numeric_limits<double>::quiet_NaN()), (std::array<double, 4>{}));
  for (const double u : {-1e-300, -1e-17, 1e300, -1e300, 0.99999999999999989, -0.0}) {
    const auto sample = texture.sample(u, u);
    EXPECT_GE(sample[0], 10 / 255.0 - 1e-12) << u;
    EXPECT_LE(sample[0], 40 / 255.0 + 1e-12) << u;
  }
  const Texture single(Image8{1, 1, {1, 2, 3, 4}});
  EXPECT_DOUBLE_EQ(single.sample(0.3, -7.7)[2], 3 / 255.0);
}

}  // namespace
}  // namespace quadrille::golden
