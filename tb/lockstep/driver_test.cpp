#include "tb/lockstep/driver.hpp"

#include "golden/scenes/random_quads.hpp"
#include "model/port/boundaries.hpp"
#include "model/port/record.hpp"

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
    VertexDriver driver(quads, config, state.attributes, 7, gap);
    golden::Prng random(3);
    std::size_t beats = 0, low = 0;
    while (!driver.done()) {
      if (driver.valid()) {
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

TEST(VertexDriver, WhatTheMachineMustNotLookAtIsRubbish) {
  Config config;
  config.set("significand_bits", 12);
  config.set("quad_id_bits", 8);
  const RecordLayout layout = vertex_layout(config);
  for (int attributes = 0; attributes <= config.attribute_slots; ++attributes) {
    DrawState state = small_state(config);
    state.attributes = attributes;
    const std::vector<SnappedQuad> quads = random_quads(config, state, 1, 100);
    VertexDriver driver(quads, config, attributes, 7, 0);
    int negative = 0, large = 0, small = 0, unused = 0;
    int other_bases = 0, other_depths = 0, other_limits = 0;
    for (std::size_t beat = 0; !driver.done(); driver.advance(true), ++beat) {
      const SnappedQuad &quad = quads[beat / 4];
      const bool first = beat % 4 == 0;
      EXPECT_EQ(driver.beat().id == quad.id, first) << "beat " << beat;
      const Record words = Record::from_words(driver.words().data(), layout.bits());
      EXPECT_EQ(words.get(layout.field("id")), driver.beat().id);
      const SnappedVertex &sent = driver.beat().vertex, &given = quad.vertex[beat % 4];
      EXPECT_EQ(sent.x, given.x);
      EXPECT_EQ(sent.k.sig, given.k.sig);
      EXPECT_EQ(sent.z.sig, given.z.sig);
      const QuadBase &base = driver.beat().base;
      EXPECT_EQ(words.get(layout.field("base_depth")), base.depth);
      EXPECT_EQ(words.get_signed(layout.field("depth_low")), base.depth_low);
      EXPECT_EQ(words.get_signed(layout.field("depth_high")), base.depth_high);
      if (first) {
        EXPECT_EQ(base.depth, quad.base.depth);
        EXPECT_EQ(base.depth_low, quad.base.depth_low);
        EXPECT_EQ(base.depth_high, quad.base.depth_high);
      }
      other_depths += base.depth != quad.base.depth;
      other_limits += base.depth_low > base.depth_high;
      for (int j = 0; j < config.attribute_slots; ++j) {
        const auto slot = static_cast<std::size_t>(j);
        const PortNumber &a = sent.attribute[slot], &b = given.attribute[slot];
        EXPECT_EQ(words.get(layout.field("attr_sig", j)), a.sig);
        EXPECT_EQ(words.get_signed(layout.field("attr_exp", j)), a.exp);
        EXPECT_EQ(words.get_signed(layout.field("base_attr", j)), base.attribute[slot]);
        if (first && j < attributes)
          EXPECT_EQ(base.attribute[slot], quad.base.attribute[slot]);
        else
          other_bases += base.attribute[slot] != quad.base.attribute[slot];
        if (j < attributes && !first) {
          EXPECT_EQ(a.sig, b.sig);
          EXPECT_EQ(a.exp, b.exp);
        } else {
          EXPECT_EQ(a.sig >> 11, 1u) << "no significand";
          ++unused;
          negative += a.neg;
          large += a.exp > 8;  // beyond every format: must not be reported as saturated
          small += a.exp < -30;
        }
      }
    }
    // 400 beats, of which 100 are the first of their quads.
    EXPECT_GT(other_bases, 400 * config.attribute_slots - 100 * attributes - 10);
    EXPECT_GT(other_depths, 290);
    EXPECT_GT(other_limits, 100);
    EXPECT_GE(unused, 100 * config.attribute_slots);
    EXPECT_GT(negative, unused / 4);
    EXPECT_GT(large, unused / 4);
    EXPECT_GT(small, unused / 4);
  }
}

TEST(VertexDriver, SameSeedSameGaps) {
  const Config config;
  const std::vector<SnappedQuad> quads = random_quads(config, small_state(config), 1, 20);
  VertexDriver a(quads, config, 4, 5, 0.5), b(quads, config, 4, 5, 0.5), c(quads, config, 4, 6, 0.5);
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
  EXPECT_THROW(VertexDriver(quads, config, 4, 1, 1.0), std::invalid_argument);
  EXPECT_THROW(VertexDriver(quads, config, 4, 1, -0.1), std::invalid_argument);
  EXPECT_THROW(ReadyDriver(1, 1.0), std::invalid_argument);
  EXPECT_THROW(ReadyDriver(1, std::nan("")), std::invalid_argument);
  quads[0].id = 1u << config.quad_id_bits;
  EXPECT_THROW(VertexDriver(quads, config, 4, 1, 0), std::invalid_argument);
}

}  // namespace
}  // namespace quadrille::tb
