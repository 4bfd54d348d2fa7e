// The checker of fragments against the truth is itself checked: each kind of fault, put into good fragments by hand, is
// found.
#include "tb/check/check.hpp"

#include "model/snap.hpp"
#include "model/untimed.hpp"

#include <gtest/gtest.h>

namespace quadrille::cli {
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
    UntimedModel model(config_, state_);
    model.draw(snapped_[0],
               [&](std::span<const Fragment> f) { fragments_.insert(fragments_.end(), f.begin(), f.end()); });
    ASSERT_GT(fragments_.size(), 500u);
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

TEST_F(Checker, NothingComparedIsNotAPass) { EXPECT_FALSE(check({}).ok()); }

}  // namespace
}  // namespace quadrille::cli
