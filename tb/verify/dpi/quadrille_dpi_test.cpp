// The functions of quadrille_dpi_pkg.sv as a simulator calls them: layout, errors, and one value a stage that follows
// from its definition.
#include "tb/verify/dpi/quadrille_dpi_test_support.hpp"

#include <cstring>

namespace quadrille::dpi {
namespace {

TEST_F(Dpi, ReciprocalOfMinusThree) {
  // -3 = -1.5·2^1; the bits are placed by hand.
  set_bits(stimulus_, 0, 18, one + one / 2);
  set_bits(stimulus_, 18, 12, 1);
  set_bits(stimulus_, 30, 1, 1);
  response_.fill(~std::uint32_t{0});
  ASSERT_EQ(quadrille_reciprocal(model_, stimulus_.data(), response_.data()), ok) << quadrille_error();
  EXPECT_EQ(bits(response_, 30, 1), 1u);
  EXPECT_EQ(bits(response_, 18, 12), 0xffeu) << "1/3 lies in [2^-2, 2^-1)";
  EXPECT_NEAR(static_cast<double>(bits(response_, 0, 18)), 4.0 / 3 * static_cast<double>(one), 1);
  for (std::size_t i = 1; i < response_.size(); ++i) EXPECT_EQ(response_[i], 0u) << "word " << i;
}

TEST_F(Dpi, SqrtOfFourPowersKeepsTheirOrder) {
  const std::array<int, 4> exponents{0, 2, 4, 40};  // 1, 4, 16, 2^40
  for (int i = 0; i < 4; ++i) {
    set("sqrt", "sig", i, one);
    set("sqrt", "exp", i, exponents[static_cast<std::size_t>(i)]);
  }
  ASSERT_EQ(quadrille_sqrt(model_, stimulus_.data(), response_.data()), ok) << quadrille_error();
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(get("sqrt", "sig", i), one) << i;
    EXPECT_EQ(get_signed("sqrt", "exp", i), exponents[static_cast<std::size_t>(i)] / 2) << i;
  }
}

TEST_F(Dpi, SnapPutsAPixelCentreAtAnInteger) {
  const auto real = [&](const char* name, int index, double value) {
    std::int64_t raw = 0;
    static_assert(sizeof raw == sizeof value);
    std::memcpy(&raw, &value, sizeof raw);
    set("snapping", name, index, raw);
  };
  // Vertex i at (3.5 + i, 0.75), z = 1/4 + i/8; attribute 2 is 3 at vertex 0, 3.5 at vertex 3, else 0.
  for (int i = 0; i < 4; ++i) {
    real("x", i, 3.5 + i);
    real("y", i, 0.75);
    real("z", i, 0.25 + i / 8.0);
    real("w", i, 1);
  }
  real("attr", 4 * 0 + 2, 3);
  real("attr", 4 * 3 + 2, 3.5);
  set("snapping", "perspective", -1, 1);
  ASSERT_EQ(quadrille_snap(model_, stimulus_.data(), response_.data()), ok) << quadrille_error();
  EXPECT_EQ(get("snapping", "refused"), 0);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(get_signed("snapping", "x", i), (3 + i) << 15);
    EXPECT_EQ(get_signed("snapping", "y", i), 1 << 13);
    EXPECT_EQ(get_signed("snapping", "w", i), 1 << 15);
  }
  EXPECT_EQ(get_signed("snapping", "base_attr", 2), 3 << 24);
  EXPECT_EQ(get("snapping", "base_depth"), 1 << 22);
  EXPECT_EQ(get_signed("snapping", "depth_low"), 1 << 22);
  EXPECT_EQ(get_signed("snapping", "depth_high"), 5 << 21);
  EXPECT_EQ(get("snapping", "z_sig", 0), 0);
  EXPECT_EQ(get_signed("snapping", "z_exp", 2), -2) << "1/2 - 1/4";
  EXPECT_EQ(get("snapping", "z_sig", 2), one);
  // Attribute 2 of vertices 1 and 3: -3 and 1/2.
  EXPECT_EQ(get("snapping", "attr_neg", 2), 1);
  EXPECT_EQ(get_signed("snapping", "attr_exp", 2), 1);
  EXPECT_EQ(get("snapping", "attr_sig", 2), 3 * one / 2);
  EXPECT_EQ(get("snapping", "attr_neg", 4 * 2 + 2), 0);
  EXPECT_EQ(get_signed("snapping", "attr_exp", 4 * 2 + 2), -1);
  EXPECT_EQ(get("snapping", "attr_sig", 4 * 2 + 2), one);
}

TEST_F(Dpi, SetupOfASquare) {
  // Corners (0, 0), (16, 0), (16, 16), (0, 16) with w = 1: E01 = S0 × S1 grows with y only.
  const std::array<int, 4> x{0, 16, 16, 0}, y{0, 0, 16, 16};
  for (int i = 0; i < 4; ++i) {
    set("setup", "x", i, x[static_cast<std::size_t>(i)] << 15);
    set("setup", "y", i, y[static_cast<std::size_t>(i)] << 15);
    set("setup", "w", i, 1 << 15);
  }
  set("setup", "scissor_x1", -1, 64);
  set("setup", "scissor_y1", -1, 64);
  ASSERT_EQ(quadrille_quad_setup(model_, stimulus_.data(), response_.data()), ok) << quadrille_error();
  EXPECT_EQ(get("setup", "homogeneous"), 0);
  EXPECT_EQ(get("setup", "tiles_x"), 3) << "pixels 0 to 16";
  EXPECT_EQ(get("setup", "visible"), 15);
  EXPECT_EQ(get_signed("setup", "lin_value", 0), 0);
  EXPECT_EQ(get_signed("setup", "lin_gx", 0), 0);
  EXPECT_EQ(get_signed("setup", "lin_gy", 0), std::int64_t{16} << 30) << "S0 × S1 at (0, y) = 16 y";
  EXPECT_EQ(get("setup", "length2", 0), std::int64_t{16 * 16} << 30) << "side 01";
  EXPECT_EQ(get("setup", "length2", 4), std::int64_t{2 * 16 * 16} << 30) << "diagonal 20";
}

TEST_F(Dpi, TileContextOfVerticesOnPixels) {
  // Vertex i at (10 + i, -i) of the quad's first tile, seen from the tile 2 columns and 1 row further, that is (16, 8).
  for (int i = 0; i < 4; ++i) {
    set("tile_context", "x", i, (10 + i) * (1 << 15));
    set("tile_context", "y", i, -i * (1 << 15));
    set("tile_context", "w", i, 1 << 15);
  }
  set("tile_context", "column", -1, 2);
  set("tile_context", "row", -1, 1);
  const std::int64_t unit = std::int64_t{1} << 30;
  for (const bool homogeneous : {false, true}) {
    set("tile_context", "homogeneous", -1, homogeneous);
    ASSERT_EQ(quadrille_tile_context(model_, stimulus_.data(), response_.data()), ok) << quadrille_error();
    // Squared distance of vertex 3, which is at (-3, -11) from there: (-3 - dx)^2 + (-11 - dy)^2.
    EXPECT_EQ(get_signed("tile_context", "quad_value", 9), (3 * 3 + 11 * 11) * unit);
    EXPECT_EQ(get_signed("tile_context", "quad_gx", 9), 6 * unit);
    EXPECT_EQ(get_signed("tile_context", "quad_gy", 9), 22 * unit);
    EXPECT_EQ(get_signed("tile_context", "quad_q", 9), unit);
    // Vertex 0 is at (-6, -8) from there, vertex 2 at (-4, -10): D20 is for a homogeneous quad.
    EXPECT_EQ(get_signed("tile_context", "quad_value", 4), homogeneous ? (24 + 80) * unit : 0);
    EXPECT_EQ(get_signed("tile_context", "quad_gx", 4), homogeneous ? 10 * unit : 0);
    EXPECT_EQ(get_signed("tile_context", "quad_gy", 4), homogeneous ? 18 * unit : 0);
    EXPECT_EQ(get_signed("tile_context", "quad_q", 4), homogeneous ? unit : 0);
  }
}

TEST_F(Dpi, CoverageOfATileInsideFourEdges) {
  for (int k = 0; k < 5; ++k) set("coverage", "lin_value", k, 1);
  set("coverage", "visible", -1, 1);
  set("coverage", "tile_x", -1, 2);
  set("coverage", "tile_y", -1, 1);
  set("coverage", "scissor_x0", -1, 18);
  set("coverage", "scissor_x1", -1, 21);
  set("coverage", "scissor_y0", -1, 0);
  set("coverage", "scissor_y1", -1, 9);
  ASSERT_EQ(quadrille_stamp_coverage(model_, stimulus_.data(), response_.data()), ok) << quadrille_error();
  EXPECT_EQ(get("coverage", "mask", 0), 0b00011100);
  EXPECT_EQ(get("coverage", "front", 0), 0);
  for (int row = 1; row < 8; ++row) EXPECT_EQ(get("coverage", "mask", row), 0) << row;
}

TEST_F(Dpi, ForwardDifferenceAtAPixel) {
  set("forward_difference", "row", -1, 3);
  set("forward_difference", "dx", -1, 5);
  for (int k = 0; k < 6; ++k) {
    set("forward_difference", "lin_value", k, -1000 * k);
    set("forward_difference", "lin_gx", k, 7);
    set("forward_difference", "lin_gy", k, -11);
  }
  for (int k = 0; k < 10; ++k) {
    set("forward_difference", "quad_value", k, 500 * k);
    set("forward_difference", "quad_gx", k, k);
    set("forward_difference", "quad_gy", k, -1);
    set("forward_difference", "quad_q", k, 2);
  }
  const auto quadratic = [](int k) { return 500 * k + 5 * k - 3 + 2 * (5 * 5 + 3 * 3); };
  const int first[] = {0, 1, 2, 3, 2, 1}, second[] = {1, 2, 3, 0, 0, 3};
  for (const bool homogeneous : {false, true}) {
    set("forward_difference", "homogeneous", -1, homogeneous);
    for (int k = 0; k < 6; ++k) set("forward_difference", "length2", k, 1000 * k);
    ASSERT_EQ(quadrille_forward_difference(model_, stimulus_.data(), response_.data()), ok) << quadrille_error();
    for (int k = 0; k < 6; ++k) {
      const int twice = quadratic(6 + first[k]) + quadratic(6 + second[k]) - 1000 * k;  // the law of cosines
      EXPECT_EQ(get_signed("forward_difference", "a", k), -1000 * k + 5 * 7 - 3 * 11) << k;
      EXPECT_EQ(get_signed("forward_difference", "d", k), homogeneous ? quadratic(k) : (twice - (twice & 1)) / 2) << k;
    }
    for (int k = 0; k < 4; ++k) EXPECT_EQ(get_signed("forward_difference", "r2", k), quadratic(6 + k)) << k;
  }
}

TEST_F(Dpi, NormaliseOfSmallIntegers) {
  set("normalise", "a", 2, -5);
  for (int i = 0; i < 4; ++i) set("normalise", "r2", i, i == 3 ? 0 : 1);
  ASSERT_EQ(quadrille_normalise(model_, stimulus_.data(), response_.data()), ok) << quadrille_error();
  EXPECT_EQ(get("normalise", "a_neg", 2), 1);
  EXPECT_EQ(get_signed("normalise", "a_exp", 2), 2);
  EXPECT_EQ(get("normalise", "a_sig", 2), 5 * one / 4);
  EXPECT_EQ(get("normalise", "on_vertex"), 1);
  EXPECT_EQ(get("normalise", "two_corner"), 0);
}

TEST_F(Dpi, RatioOfARightAngle) {
  // D = 0: u = r r', here 2^1·2^2, and v = |A| = 2^3.
  for (int i = 0; i < 4; ++i) {
    set("ratios", "root_sig", i, one);
    set("ratios", "root_exp", i, i == 0 ? 1 : i == 1 ? 2 : 0);
  }
  set("ratios", "a_sig", 0, one);
  set("ratios", "a_exp", 0, 3);
  ASSERT_EQ(quadrille_mean_value_ratios(model_, stimulus_.data(), response_.data()), ok) << quadrille_error();
  EXPECT_EQ(get("ratios", "u_sig", 0), one);
  EXPECT_EQ(get_signed("ratios", "u_exp", 0), 3);
  EXPECT_EQ(get("ratios", "v_sig", 0), one);
  EXPECT_EQ(get_signed("ratios", "v_exp", 0), 3);
}

TEST_F(Dpi, WeightAtAVertexIsOneThere) {
  set("weights", "corner", 2, 1);
  ASSERT_EQ(quadrille_mean_value_weights(model_, stimulus_.data(), response_.data()), ok) << quadrille_error();
  for (int i = 0; i < 4; ++i) EXPECT_EQ(get("weights", "sig", i), i == 2 ? one : 0) << i;
}

TEST_F(Dpi, InterpolationAddsUp) {
  // M = 1 at corners 1 and 2, k = 1: the denominator is 2. Attribute 3 differs from its base by 1 and -4 there: -3.
  for (int i = 1; i < 3; ++i) {
    set("interpolation", "m_sig", i, one);
    set("interpolation", "k_sig", i, one);
    set("interpolation", "b_sig", 3 * 3 + i - 1, one);
  }
  set("interpolation", "b_exp", 3 * 3 + 1, 2);
  set("interpolation", "b_neg", 3 * 3 + 1, 1);
  ASSERT_EQ(quadrille_interpolate(model_, stimulus_.data(), response_.data()), ok) << quadrille_error();
  EXPECT_EQ(get("interpolation", "den_k_sig"), one);
  EXPECT_EQ(get_signed("interpolation", "den_k_exp"), 1);
  EXPECT_EQ(get("interpolation", "attr_neg", 3), 1);
  EXPECT_EQ(get("interpolation", "attr_sig", 3), 3 * one / 2);
  EXPECT_EQ(get_signed("interpolation", "attr_exp", 3), 1);
  EXPECT_EQ(get("interpolation", "attr_sig", 2), 0);
}

TEST_F(Dpi, DepthIsAQuotientInFixedPoint) {
  // z = 1/2 / 2 in [0, 1], from 1/16 on; attribute 0 is -1 / 2, from 3 on.
  set("depth", "depth_on", -1, 1);
  set("depth", "zfar", -1, 1 << 24);
  set("depth", "attributes", -1, 1);
  set("depth", "z_sig", -1, one);
  set("depth", "z_exp", -1, -1);
  for (const char* name : {"den_k_sig", "den_w_sig"}) set("depth", name, -1, one);
  for (const char* name : {"den_k_exp", "den_w_exp"}) set("depth", name, -1, 1);
  set("depth", "attr_sig", 0, one);
  set("depth", "attr_neg", 0, 1);
  set("depth", "base_attr", 0, 3 << 24);
  set("depth", "base_depth", -1, 1 << 20);
  set("depth", "depth_high", -1, 1 << 24);
  ASSERT_EQ(quadrille_fragment_output(model_, stimulus_.data(), response_.data()), ok) << quadrille_error();
  EXPECT_EQ(get("depth", "valid"), 1);
  EXPECT_EQ(get("depth", "depth"), 5 << 20);
  EXPECT_EQ(get_signed("depth", "attr", 0), 5 << 23);
  // No depth is above the corners'.
  set("depth", "depth_high", -1, 3 << 20);
  ASSERT_EQ(quadrille_fragment_output(model_, stimulus_.data(), response_.data()), ok) << quadrille_error();
  EXPECT_EQ(get("depth", "depth"), 3 << 20);
}

}  // namespace
}  // namespace quadrille::dpi
