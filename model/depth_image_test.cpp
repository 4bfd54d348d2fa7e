// Pictures against a list of what each pixel got, judged by the codes.
#include "model/depth_image.hpp"
#include "model/support/prng.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace quadrille {
namespace {

constexpr int width = 13, height = 9;

/// Fragments anywhere in the picture, pixels more than once, of few depths.
FragmentBuffer random_fragments(std::size_t size, int attributes, const Config& config, golden::Prng& random) {
  FragmentBuffer buffer(size, attributes);
  const std::uint32_t one = std::uint32_t{1} << config.depth_bits;
  for (std::size_t i = 0; i < size; ++i) {
    Fragment f;
    f.x = static_cast<std::uint16_t>(random.below(width));
    f.y = static_cast<std::uint16_t>(random.below(height));
    f.depth = one - static_cast<std::uint32_t>(random.below(4) * random.below(1000));
    for (std::size_t j = 0; j < static_cast<std::size_t>(attributes); ++j)
      f.attribute[j] =
          static_cast<std::int64_t>(random.below(2 * config.attribute_limit() + 1)) - config.attribute_limit();
    buffer.put(i, f);
  }
  return buffer;
}

template <class Real>
void compare(int attributes, bool depth, const Config& config) {
  golden::Prng random(static_cast<std::uint64_t>(attributes));
  const bool ids = attributes % 2 == 0;
  DepthImage<Real> image(width, height, attributes, config, depth, ids);
  Fragment clear;
  clear.quad = DepthImage<Real>::no_quad;
  clear.depth = std::uint32_t{1} << config.depth_bits;
  std::vector<Fragment> shown(width * height, clear);
  const auto check = [&] {
    ASSERT_EQ(image.quads().size(), ids ? shown.size() : 0);
    for (std::size_t p = 0; p < shown.size(); ++p) {
      ASSERT_EQ(ids ? image.quads()[p] : shown[p].quad, shown[p].quad);
      ASSERT_EQ(image.depth()[p], static_cast<Real>(std::ldexp(shown[p].depth, -config.depth_bits)));
      for (int j = 0; j < attributes; ++j)
        ASSERT_EQ(image.attribute(j)[p],
                  static_cast<Real>(std::ldexp(static_cast<double>(shown[p].attribute[static_cast<std::size_t>(j)]),
                                               -config.attribute_frac())));
    }
  };
  for (int call = 0; call < 60; ++call) {
    const std::size_t size = 1 + random.below(call % 10 == 9 ? 1500 : 30);
    const FragmentBuffer buffer = random_fragments(size, attributes, config, random);
    const FragmentArrays fragments = buffer.view(static_cast<std::uint32_t>(call), size);
    image.write(fragments);
    for (std::size_t i = 0; i < size; ++i) {
      const Fragment f = fragments[i];
      Fragment& before = shown[f.y * std::size_t{width} + f.x];
      if (!depth || f.depth < before.depth) before = f;
    }
    if (call % 20 != 13) continue;
    check();
    const std::size_t pixel = random.below(width * height);
    Fragment& other = shown[pixel] = fragments[0];
    other.quad = 77;
    std::vector<Real> numbers;
    for (int j = 0; j < attributes; ++j)
      numbers.push_back(static_cast<Real>(
          std::ldexp(static_cast<double>(other.attribute[static_cast<std::size_t>(j)]), -config.attribute_frac())));
    image.overwrite(pixel, static_cast<Real>(std::ldexp(other.depth, -config.depth_bits)), numbers, 77);
  }
  check();
  image.write(random_fragments(5, attributes, config, random).view(0, 5));
  image.clear();
  shown.assign(shown.size(), clear);
  check();
}

TEST(DepthImage, ShowsTheNearestAndTheEarlierOfEquals) {
  for (int attributes = 0; attributes <= max_attribute_slots; ++attributes) {
    compare<float>(attributes, true, {});
    compare<double>(attributes, true, {});
  }
}

TEST(DepthImage, ShowsTheLastWithoutDepth) {
  compare<float>(2, false, {});
  compare<double>(2, false, {});
}

TEST(DepthImage, DoublesTellTheFinestCodesApart) {
  Config config;
  config.set("depth_bits", 30);
  config.set("attribute_int_bits", 15);
  config.set("attribute_frac_bits", 30);
  compare<double>(3, true, config);
}

TEST(DepthImage, RefusesMoreAttributesThanThereAre) {
  EXPECT_THROW(DepthImage<float>(width, height, max_attribute_slots + 1, Config{}, true), std::invalid_argument);
}

}  // namespace
}  // namespace quadrille
