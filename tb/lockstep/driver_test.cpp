#include "tb/lockstep/driver.hpp"

#include "golden/scenes/random_quads.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace quadrille::tb {
namespace {

TEST(VertexDriver, OffersEveryBeatOnceAndHoldsItUntilTaken) {
  const Config config;
  const DrawState state = small_state(config);
  const std::vector<SnappedQuad> quads = random_quads(config, state, 1, 50);
  for (const double gap : {0.0, 0.5, 0.9}) {
    VertexDriver driver(quads, config, 7, gap);
    golden::Prng random(3);
    std::size_t beats = 0, low = 0;
    while (!driver.done()) {
      if (driver.valid()) {
        EXPECT_EQ(driver.id(), quads[beats / 4].id);
        const std::vector<std::uint32_t> offered(driver.words().begin(), driver.words().end());
        if (random.chance(0.5)) {
          driver.advance(false);
          EXPECT_TRUE(driver.valid());
          EXPECT_FALSE(driver.changed());
          EXPECT_TRUE(std::equal(offered.begin(), offered.end(), driver.words().begin()));
        }
        driver.advance(true);
        ++beats;
      } else {
        ++low;
        driver.advance(false);
      }
    }
    EXPECT_EQ(beats, 200u);
    EXPECT_FALSE(driver.valid());
    // 200 geometric waits with mean gap / (1 - gap); three standard deviations.
    EXPECT_NEAR(static_cast<double>(low), 200 * gap / (1 - gap), 3 * std::sqrt(200 * gap) / (1 - gap) + 1e-9)
        << "gap " << gap;
  }
}

TEST(VertexDriver, SameSeedSameGaps) {
  const Config config;
  const std::vector<SnappedQuad> quads = random_quads(config, small_state(config), 1, 20);
  VertexDriver a(quads, config, 5, 0.5), b(quads, config, 5, 0.5), c(quads, config, 6, 0.5);
  bool differs = false;
  for (int i = 0; i < 200; ++i) {
    ASSERT_EQ(a.valid(), b.valid());
    differs |= a.valid() != c.valid();
    a.advance(a.valid());
    b.advance(b.valid());
    c.advance(c.valid());
  }
  EXPECT_TRUE(differs);
}

TEST(Drivers, RefuseImpossibleProbabilitiesAndIds) {
  Config config;
  const DrawState state = small_state(config);
  std::vector<SnappedQuad> quads = random_quads(config, state, 1, 1);
  EXPECT_THROW(VertexDriver(quads, config, 1, 1.0), std::invalid_argument);
  EXPECT_THROW(VertexDriver(quads, config, 1, -0.1), std::invalid_argument);
  EXPECT_THROW(ReadyDriver(1, 1.0), std::invalid_argument);
  EXPECT_THROW(ReadyDriver(1, std::nan("")), std::invalid_argument);
  quads[0].id = 1u << config.quad_id_bits;
  EXPECT_THROW(VertexDriver(quads, config, 1, 0), std::invalid_argument);
}

}  // namespace
}  // namespace quadrille::tb
