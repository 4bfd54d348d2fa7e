#include "tb/lockstep/monitor.hpp"

#include "model/port/bit_vector.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace quadrille::tb {
namespace {

class Monitor : public ::testing::Test {
 protected:
  Monitor() : words_(words_for(width_) + 1) {
    fragment_.quad = 5;
    fragment_.x = 17;
    fragment_.y = 3;
    fragment_.front = true;
    fragment_.depth = 1234;
    fragment_.attribute[1] = -77;
    pack(fragment_);
  }

  void pack(const Fragment& fragment) {
    std::vector<std::uint64_t> packed(words_.size());
    pack_fragment(fragment, config_, packed.data(), width_);
    for (std::size_t i = 0; i < words_for(width_); ++i)
      words_[i] = static_cast<std::uint32_t>(packed[i / 2] >> (i % 2 * 32));
  }

  std::uint64_t hash_of(const std::vector<std::vector<std::uint32_t>>& fragments) const {
    const FragmentSink none;
    FragmentMonitor monitor(config_, width_, none);
    for (const auto& words : fragments) monitor.handed_over(words.data(), nullptr);
    EXPECT_EQ(monitor.fragments(), fragments.size());
    return monitor.hash();
  }

  const Config config_;
  const int width_ = boundary_layout(Boundary::fragment, config_).bits();
  Fragment fragment_;
  std::vector<std::uint32_t> words_;
};

TEST_F(Monitor, PassesOnWhatWasHandedOver) {
  std::vector<Fragment> seen;
  const FragmentSink sink = [&](const Fragment& fragment) { seen.push_back(fragment); };
  FragmentMonitor monitor(config_, width_, sink);
  monitor.handed_over(words_.data(), nullptr);
  Fragment known = fragment_;
  known.quad = 6;
  monitor.handed_over(words_.data(), &known);
  EXPECT_EQ(seen, (std::vector<Fragment>{fragment_, known}));
  EXPECT_EQ(monitor.fragments(), 2u);
}

TEST_F(Monitor, HashDependsOnEveryBitAndOnTheOrder) {
  const std::uint64_t hash = hash_of({words_});
  EXPECT_EQ(hash_of({words_}), hash);
  for (int bit = 0; bit < width_; ++bit) {
    std::vector<std::uint32_t> other = words_;
    other[static_cast<std::size_t>(bit / 32)] ^= 1u << (bit % 32);
    EXPECT_NE(hash_of({other}), hash) << "bit " << bit;
    EXPECT_NE(hash_of({words_, other}), hash_of({other, words_})) << "bit " << bit;
  }
  EXPECT_NE(hash_of({words_, words_}), hash);
  EXPECT_NE(hash_of({}), hash);
}

/// The words hold the fragment alone: what follows in memory is not looked at.
TEST_F(Monitor, HashEndsWithTheFragment) {
  const std::uint64_t hash = hash_of({words_});
  words_.back() ^= 1;
  EXPECT_EQ(hash_of({words_}), hash);
}

}  // namespace
}  // namespace quadrille::tb
