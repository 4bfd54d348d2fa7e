// The checker of fragments against the truth is itself checked: each kind of fault, put into good fragments by hand, is
// found.
#include "tb/judge/check.hpp"

#include "golden/analysis/judged_quad.hpp"
#include "model/port/snap.hpp"
#include "model/untimed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace quadrille::tb {
namespace {

class Checker : public testing::Test {
 protected:
  void SetUp() override {
    state_.width = state_.height = state_.scissor_x1 = state_.scissor_y1 = 64;
    WindowQuad quad;
    quad.vertex = {{{10, 8, 0.25, 1}, {100, 24, 1.0, 2}, {44, 50, 0.5, 1}, {12, 40, 0.75, 1}}};
    quad.attribute = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
    given_ = {quad};
    snapped_ = {snap_quad(quad, config_, state_)};
    redraw();
    ASSERT_GT(fragments_.size(), 500u);
  }

  void redraw() {
    fragments_.clear();
    UntimedModel model(config_, state_);
    model.draw(snapped_[0],
               [&](std::span<const Fragment> f) { fragments_.insert(fragments_.end(), f.begin(), f.end()); });
  }

  /// `columns`: what the slots carry, weights (0-3) or attributes (from 4).
  CheckResult check(const std::vector<Fragment>& fragments, std::vector<int> columns = {0, 1, 2, 3}) const {
    WorkQueue queue(0, 4);
    FragmentChecker::Settings settings;
    settings.config = config_;
    settings.state = state_;
    settings.pass.columns = std::move(columns);
    settings.first_pass = settings.pass.columns[0] == 0;
    settings.snapping = false;
    FragmentChecker checker(settings, given_, snapped_, queue);
    for (const Fragment& fragment : fragments) checker.fragment(fragment);
    checker.finish(true);
    queue.drain();
    return checker.result();
  }

  Config config_;
  DrawState state_;
  std::vector<WindowQuad> given_;
  std::vector<SnappedQuad> snapped_;
  std::vector<Fragment> fragments_;
};

TEST_F(Checker, PassesWhatTheModelDraws) {
  EXPECT_TRUE(check(fragments_).ok());
  EXPECT_TRUE(check(fragments_, {4, 5, 6, 7}).ok());
}

TEST_F(Checker, FindsAMissingPixel) {
  fragments_.erase(fragments_.begin() + 100);
  EXPECT_EQ(check(fragments_).mismatches, 1u);
}

TEST_F(Checker, FindsAPixelDrawnTwice) {
  fragments_.insert(fragments_.begin() + 100, fragments_[100]);
  EXPECT_EQ(check(fragments_).mismatches, 1u);
}

TEST_F(Checker, FindsAPixelOutside) {
  fragments_.push_back(fragments_.back());
  fragments_.back().x = fragments_.back().y = 1;
  EXPECT_EQ(check(fragments_).mismatches, 1u);
}

TEST_F(Checker, FindsAWrongFacing) {
  fragments_[100].front = !fragments_[100].front;
  EXPECT_EQ(check(fragments_).mismatches, 1u);
}

TEST_F(Checker, FindsAWrongWeight) {
  // One and a half times the bound of 2^-(s-3).
  fragments_[100].attribute[2] += std::int64_t{3} << (config_.attribute_frac() - config_.significand_bits + 2);
  EXPECT_EQ(check(fragments_).beyond_bound, 1u);
}

TEST_F(Checker, FindsSwappedAttributes) {
  std::swap(fragments_[100].attribute[0], fragments_[100].attribute[1]);
  EXPECT_EQ(check(fragments_, {4, 5, 6, 7}).beyond_attribute, 1u);
}

TEST_F(Checker, FindsAWrongDepth) {
  // 2^-10 is far beyond what 18-bit weights can do to a depth in [0, 1].
  fragments_[100].depth += 1u << (config_.depth_bits - 10);
  EXPECT_EQ(check(fragments_).beyond_depth, 1u);
}

TEST_F(Checker, FindsEveryWrongFlag) {
  for (int bit = 0; bit < 8; ++bit) {
    auto fragments = fragments_;
    fragments[100].flags ^= static_cast<std::uint8_t>(1 << bit);
    EXPECT_EQ(check(fragments).mismatches, 1u) << "bit " << bit;
    EXPECT_EQ(check(fragments, {4, 5, 6, 7}).mismatches, 1u) << "bit " << bit << " in a later pass";
  }
}

TEST_F(Checker, FindsASlotThatIsNotInUse) {
  fragments_[100].attribute[6] = 1;
  EXPECT_EQ(check(fragments_).mismatches, 1u);
}

TEST_F(Checker, FindsADepthThatIsOff) {
  state_.depth = false;
  std::vector<Fragment> fragments = fragments_;
  for (Fragment& fragment : fragments) fragment.depth = 0;
  EXPECT_TRUE(check(fragments).ok());
  fragments[100].depth = 1;
  EXPECT_EQ(check(fragments).mismatches, 1u);
}

TEST_F(Checker, FindsWrongSaturation) {
  const FixedPoint format = attribute_format(config_);
  // Bases at the limit, of either sign, and half of it more at the other corners.
  for (std::size_t slot = 0; slot < 2; ++slot) {
    snapped_[0].base.attribute[slot] = slot == 0 ? format.largest_code() : -format.largest_code();
    for (std::size_t i = 1; i < 4; ++i) {
      SnappedVertex& v = snapped_[0].vertex[i];
      v.attribute[slot] = v.k;
      v.attribute[slot].neg = slot == 1;
      v.attribute[slot].exp += config_.attribute_int_bits - 1;
    }
  }
  redraw();
  const std::vector<int> columns{4, 5, 6, 7};
  EXPECT_TRUE(check(fragments_, columns).ok());
  const auto faulty = [&](auto&& change) {
    std::vector<Fragment> fragments = fragments_;
    change(fragments[100]);
    return check(fragments, columns);
  };
  EXPECT_EQ(faulty([](Fragment& f) { --f.attribute[0]; }).beyond_attribute, 1u) << "not the limit";
  EXPECT_EQ(faulty([](Fragment& f) { ++f.attribute[1]; }).beyond_attribute, 1u) << "not the negative limit";
  EXPECT_EQ(faulty([](Fragment& f) { --f.attribute[1]; }).beyond_attribute, 1u) << "beyond the negative limit";
  EXPECT_EQ(faulty([](Fragment& f) { f.attribute[0] *= -1; }).beyond_attribute, 1u) << "the wrong limit";
  EXPECT_EQ(faulty([](Fragment& f) { f.flags ^= flag_saturated; }).mismatches, 1u) << "not flagged";
  EXPECT_EQ(faulty([&](Fragment& f) { f.attribute[2] = format.largest_code(); }).beyond_attribute, 1u) << "far below";
}

TEST_F(Checker, FindsWhatIsOffByOneAtACorner) {
  // Only the upper left corner of a square at pixel centres is covered.
  given_[0].vertex = {{{10.5, 8.5, 0.3, 1}, {40.5, 8.5, 1, 1}, {40.5, 30.5, 0.5, 1}, {10.5, 30.5, 0.75, 1}}};
  given_[0].attribute = {{{-0.3, 0.1, 0, 1}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
  snapped_ = {snap_quad(given_[0], config_, state_)};
  redraw();
  const std::vector<int> columns{4, 5, 6, 7};
  EXPECT_TRUE(check(fragments_, columns).ok());
  const auto at =
      std::find_if(fragments_.begin(), fragments_.end(), [](const Fragment& f) { return f.x == 10 && f.y == 8; });
  ASSERT_NE(at, fragments_.end());
  --at->attribute[0];
  EXPECT_EQ(check(fragments_, columns).mismatches, 1u) << "not the base";
  ++at->attribute[0];
  ++at->depth;
  EXPECT_EQ(check(fragments_, columns).mismatches, 1u);
}

TEST_F(Checker, FindsPixelsOnTheWrongSideOfTheDepthLimits) {
  given_[0].vertex = {{{10.5, 8.5, 0.25, 1}, {40.5, 8.5, 0.5, 1}, {40.5, 30.5, 0.5, 1}, {10.5, 30.5, 0.5, 1}}};
  snapped_ = {snap_quad(given_[0], config_, state_)};
  const auto missing = [&](double znear, double zfar) {
    state_.znear = znear;
    state_.zfar = zfar;
    redraw();
    EXPECT_TRUE(check(fragments_).ok());
    std::vector<Fragment> fragments = fragments_;
    std::erase_if(fragments, [](const Fragment& f) { return f.x == 10 && f.y == 8; });
    EXPECT_EQ(fragments.size() + 1, fragments_.size());
    return check(fragments).mismatches;
  };
  EXPECT_EQ(missing(0.25, 1), 1u) << "z = znear is drawn";
  EXPECT_EQ(missing(0.25, 0.45), 1u) << "of a quad that is cut too";
  for (WindowVertex& v : given_[0].vertex) v.z = 0.5 - v.z / 2;  // 3/8 at the corner, 1/4 at the others
  snapped_ = {snap_quad(given_[0], config_, state_)};
  EXPECT_EQ(missing(0, 0.375), 1u) << "z = zfar is drawn";

  // The same fragments, but the least code inside is now beyond what they have.
  state_.zfar = 0.375 - std::ldexp(1.0, -config_.depth_bits);
  EXPECT_GE(check(fragments_).mismatches, 1u);
}

/// A quad of nearly one depth, a limit at the least of its corners' codes: no pixel may be missing, however near the
/// limit it is. With the limit one code further in either is right near it, and counted.
TEST_F(Checker, ToleratesDepthsNearALimitOnlyWhereItCutsTheQuad) {
  const double unit = std::ldexp(1.0, -config_.depth_bits), z = 0.998;
  const double least = std::round(z / unit) * unit;
  given_[0].vertex = {
      {{10.2, 8.3, least, 1}, {40.7, 8.9, least, 1}, {40.1, 30.5, least + 3 * unit, 1}, {10.5, 30.5, least, 1}}};
  snapped_ = {snap_quad(given_[0], config_, state_)};
  state_.znear = least;
  redraw();
  const CheckResult all = check(fragments_);
  EXPECT_TRUE(all.ok());
  EXPECT_EQ(all.tolerated_depth, 0u);
  std::size_t lost = 0;
  for (std::size_t n = 0; n < fragments_.size(); n += 37, ++lost) {
    std::vector<Fragment> fragments = fragments_;
    fragments.erase(fragments.begin() + static_cast<std::ptrdiff_t>(n));
    EXPECT_EQ(check(fragments).mismatches, 1u) << "pixel " << n;
  }
  EXPECT_GT(lost, 10u);

  // Half a code above the least one: the codes 1 and higher are drawn, and of the others nothing.
  state_.znear = least + unit;
  const std::size_t before = fragments_.size();
  redraw();
  EXPECT_LT(fragments_.size(), before);
  EXPECT_GT(fragments_.size(), 10u);
  EXPECT_TRUE(check(fragments_).ok());
  std::vector<Fragment> fragments = fragments_;
  const auto far = std::ranges::max_element(fragments, {}, &Fragment::depth);
  fragments.erase(far);
  EXPECT_EQ(check(fragments).mismatches, 1u) << "the farthest one";

  // Of a wide range: what is within its tolerance of the limit.
  given_[0].vertex = {{{10.2, 8.3, 0.1, 1}, {40.7, 8.9, 0.5, 1}, {40.1, 30.5, 0.9, 1}, {10.5, 30.5, 0.4, 1}}};
  snapped_ = {snap_quad(given_[0], config_, state_)};
  state_.znear = 0;
  redraw();
  fragments = fragments_;
  const std::size_t n = fragments.size() / 2;
  state_.znear = std::ldexp(static_cast<double>(fragments[n].depth), -config_.depth_bits);
  std::erase_if(fragments, [&](const Fragment& f) { return f.depth <= fragments_[n].depth; });
  const CheckResult cut = check(fragments);
  EXPECT_TRUE(cut.ok()) << cut.first.text;
  EXPECT_GT(cut.tolerated_depth, 0u);
}

/// An error of two codes far from zero, where the spread allows less than one.
TEST_F(Checker, JudgesByTheSpread) {
  given_[0].vertex = {{{10, 8, 0.998, 1}, {100, 24, 1.9961, 2}, {44, 50, 0.99801, 1}, {12, 40, 0.99803, 1}}};
  given_[0].attribute = {{{100, 7, 5, 0}, {100.25, 7, 5, 0}, {100.125, 7, 5, 0}, {99.75, 7, 5.001, 0}}};
  snapped_ = {snap_quad(given_[0], config_, state_)};
  redraw();
  const std::vector<int> columns{4, 5, 6, 7};
  EXPECT_TRUE(check(fragments_, columns).ok());
  const Bounds bounds(config_);
  const auto codes = [&](double spread, int fraction) {
    return static_cast<std::int64_t>(std::ldexp(2.01 * bounds.value * spread, fraction)) + 2;
  };
  const auto faulty = [&](auto&& change) {
    std::vector<Fragment> fragments = fragments_;
    change(fragments[100]);
    return check(fragments, columns);
  };
  const int f = config_.attribute_frac();
  EXPECT_EQ(faulty([&](Fragment& g) { g.attribute[0] += codes(0.5, f); }).beyond_attribute, 1u);
  EXPECT_EQ(faulty([&](Fragment& g) { g.attribute[1] += 1; }).beyond_attribute, 1u) << "a constant";
  EXPECT_EQ(faulty([&](Fragment& g) { g.attribute[2] -= codes(0.001, f); }).beyond_attribute, 1u);
  EXPECT_LT(codes(0.001, f), 5);
  const CheckResult deep = faulty([&](Fragment& g) { g.depth += static_cast<std::uint32_t>(codes(0.0001, 24)); });
  EXPECT_EQ(deep.beyond_depth, 1u);
}

TEST_F(Checker, FindsASumWithTheWrongSign) {
  // Without perspective and with a vertex behind the eye: sum(M W) = 2.8, |sum|(|M W|) 1.1 times that.
  state_.perspective = false;
  given_[0].vertex = {{{10, 8, 0.25, 1}, {40, 8, 0.25, 1}, {44, 50, 0.25, 1}, {-200, -800, -0.5, -16}}};
  snapped_ = {snap_quad(given_[0], config_, state_)};
  redraw();
  const CheckResult good = check(fragments_);
  EXPECT_TRUE(good.ok());
  ASSERT_GT(good.compared, 100u);
  EXPECT_LT(good.bound_exempt, good.compared / 10);
  fragments_[100].attribute[1] = -fragments_[100].attribute[1];
  EXPECT_EQ(check(fragments_).beyond_bound, 1u);
}

TEST_F(Checker, FindsAPixelOfAQuadAtInfinity) {
  // Every w is 0, so is sum(M w): nothing of it is in front of the eye.
  state_.depth = false;
  const auto at = [&](int x, int y) {
    SnappedVertex v;
    v.x = x, v.y = y, v.w = 0;
    v.k = {false, 0, 1u << (config_.significand_bits - 1)};
    return v;
  };
  snapped_[0].vertex = {at(1000, 0), at(0, 1000), at(-1000, -500), at(300, -1000)};
  redraw();
  EXPECT_TRUE(fragments_.empty());
  Fragment fragment;
  fragment.x = 5, fragment.y = 6;
  fragment.flags = flag_homogeneous;
  EXPECT_EQ(check({fragment}).mismatches, 1u);
}

TEST_F(Checker, NothingComparedIsNotAPass) { EXPECT_FALSE(check({}).ok()); }

}  // namespace
}  // namespace quadrille::tb
