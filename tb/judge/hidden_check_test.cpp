// The check of what a machine leaves out as hidden is itself checked.
#include "tb/judge/hidden_check.hpp"

#include "model/port/snap.hpp"
#include "tb/judge/check.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace quadrille::tb {
namespace {

/// One square in front of another, the nearer one first.
class Hidden : public testing::Test {
 protected:
  void SetUp() override {
    config_.set("hierarchical_z_bits", 12);
    state_.width = state_.height = state_.scissor_x1 = state_.scissor_y1 = 32;
    state_.attributes = 4;
    state_.skip |= skip_hidden;
    for (const double z : {0.25, 0.5}) {
      WindowQuad quad;
      quad.id = static_cast<std::uint32_t>(given_.size());
      quad.vertex = {{{4, 4, z, 1}, {4, 28, z, 1}, {28, 28, z, 1}, {28, 4, z, 1}}};
      quad.attribute = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
      given_.push_back(quad);
      snapped_.push_back(snap_quad(quad, config_, state_));
    }
    DrawState everything = state_;
    everything.skip &= ~std::uint32_t{skip_hidden};
    UntimedModel all(config_, everything), some(config_, state_);
    for (const SnappedQuad& quad : snapped_) {
      all.draw(quad, [&](std::span<const Fragment> f) { all_.insert(all_.end(), f.begin(), f.end()); });
      some.draw(quad, [&](std::span<const Fragment> f) { some_.insert(some_.end(), f.begin(), f.end()); });
    }
    ASSERT_EQ(all_.size(), 2u * 24 * 24);
    ASSERT_EQ(some_.size(), 24u * 24)
        << "the second square is hidden, its inner tiles whole and the others by their masks";
  }

  CheckResult check(const std::vector<Fragment>& fragments) const {
    FragmentChecker::Settings settings;
    settings.config = config_;
    settings.state = state_;
    settings.pass.columns = {0, 1, 2, 3};
    settings.snapping = false;
    return check_here(settings, given_, snapped_, [&](const auto& sink) {
      for (const Fragment& f : fragments) sink(f);
      return true;
    });
  }

  Config config_;
  DrawState state_;
  std::vector<WindowQuad> given_;
  std::vector<SnappedQuad> snapped_;
  std::vector<Fragment> all_, some_;
};

TEST_F(Hidden, PassesWhatTheModelDraws) {
  EXPECT_TRUE(check(all_).ok()) << "nothing need be left out";
  const CheckResult result = check(some_);
  EXPECT_TRUE(result.ok()) << result.first.text;
  EXPECT_EQ(result.hidden, all_.size() - some_.size());
}

TEST_F(Hidden, FindsAVisibleFragmentLeftOut) {
  some_.erase(some_.begin() + 100);  // of the first square; then nothing is before that pixel of the second one either
  EXPECT_EQ(check(some_).mismatches, 2u * 2) << "by the machine with nothing hidden, and by the truth";
}

TEST_F(Hidden, FindsWhatIsLeftOutBesideTheOther) {
  // The second square a pixel to the right: what stands out is visible.
  for (WindowVertex& v : given_[1].vertex) v.x += 1;
  snapped_[1] = snap_quad(given_[1], config_, state_);
  std::erase_if(all_, [](const Fragment& f) { return f.quad == 1; });
  const CheckResult result = check(all_);
  EXPECT_EQ(result.mismatches, 24u + 1) << result.first.text;
  EXPECT_EQ(result.hidden, 23u * 24);
}

TEST_F(Hidden, MayRefuseWhatIsNotInFront) {
  HiddenCheck exact(config_, state_);
  Fragment front = all_.front();
  EXPECT_TRUE(exact.quad_done(snapped_[0]).has_value()) << "the buffer is clear: nothing may be left out";
  HiddenCheck again(config_, state_);
  for (const Fragment& f : all_)
    if (f.quad == 0) again.fragment(f);
  EXPECT_FALSE(again.quad_done(snapped_[0]).has_value());
  EXPECT_FALSE(again.quad_done(snapped_[0]).has_value()) << "equal depths: the earlier quad wins";
  EXPECT_EQ(again.left_out(), 24u * 24);
  EXPECT_TRUE(again.may_refuse(front.x, front.y, 0.25, 0));
  EXPECT_FALSE(again.may_refuse(front.x, front.y, 0.2499, 0));
}

TEST_F(Hidden, FindsOtherFragmentsThanWithNothingHidden) {
  std::swap(some_[100], some_[101]);
  EXPECT_GT(check(some_).mismatches, 0u);
  std::swap(some_[100], some_[101]);
  some_[100].attribute[0] += 1;
  EXPECT_EQ(check(some_).mismatches, 1u) << "within every bound, but not the same";
}

}  // namespace
}  // namespace quadrille::tb
