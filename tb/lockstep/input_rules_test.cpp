// What a driver may do with the machine's inputs beside its beats, of RTL and model side by side: beats of a quad that
// is not complete, flushes at any time, another draw state while quads are under way, which the RTL asserts not to be.
#include "golden/scenes/random_quads.hpp"
#include "model/clocked.hpp"
#include "model/port/bit_vector.hpp"
#include "model/untimed.hpp"
#include "tb/device/verilated_device.hpp"
#include "tb/lockstep/driver.hpp"
#include "tb/lockstep/lockstep.hpp"
#include "tb/lockstep/scoreboard.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace quadrille::tb {
namespace {

class InputRules : public testing::Test {
 protected:
  static constexpr int quiet_clocks = 3000;  ///< far beyond a small quad's way through the machine

  InputRules() {
    options_.config.set("significand_bits", 12);
    options_.state = small_state(options_.config);
    for (const SnappedQuad& quad : random_quads(options_.config, options_.state, 9, 60))
      if (!drawn({&quad, 1}).empty()) quads_.push_back(quad);
  }

  std::vector<Fragment> drawn(std::span<const SnappedQuad> quads) const {
    std::vector<Fragment> fragments;
    UntimedModel model(options_.config, options_.state);
    for (const SnappedQuad& quad : quads)
      model.draw(quad, [&](std::span<const Fragment> f) { fragments.insert(fragments.end(), f.begin(), f.end()); });
    return fragments;
  }

  LockstepOptions options_;
  std::vector<SnappedQuad> quads_;  ///< that have fragments
};

/// Both sides with the same inputs, compared in every clock.
class Pair {
 public:
  Pair(Device& device, const LockstepOptions& o)
      : device_(device), config_(o.config), model_(o.config, o.state), board_(o.config, {}, false, 1) {
    device.set_state(pack_state(o.state, o.config));
    device.set_clear_hidden(false);
    device.set_flush(false);
    device.set_handshake(false, true);
    device.set_reset(true);
    ClockedInputs in;
    in.reset = true;
    for (int i = 0; i < 4; ++i) {
      device.settle();
      device.clock();
      model_.clock(in);
    }
    device.set_reset(false);
  }

  /// A clock with that beat on offer, or none.
  void clock(const VertexBeat* beat, bool flush = false) {
    ClockedInputs in;
    in.vertex_valid = beat != nullptr;
    in.fragment_ready = true;
    in.flush = flush;
    if (beat != nullptr) {
      in.vertex = *beat;
      const int width = vertex_layout(config_).bits();
      Record record(width);
      BitPacker packer(record.words(), width);
      visit(in.vertex, config_, packer);
      packer.finish();
      std::vector<std::uint32_t> words;
      for (int at = 0; at < width; at += 32)
        words.push_back(static_cast<std::uint32_t>(record.get(at, std::min(32, width - at))));
      device_.set_vertex(words);
    }
    device_.set_handshake(in.vertex_valid, true);
    device_.set_flush(flush);
    device_.settle();
    const ClockedOutputs out = model_.comb();
    board_.compare(clocks, out, device_.sample());
    EXPECT_EQ(board_.mismatches() + board_.cycle_mismatches(), 0u) << board_.first_divergence().value_or("");
    EXPECT_TRUE(beat == nullptr || out.vertex_ready);
    out.for_each_fragment([&](const Fragment& f) { fragments.push_back(f); });
    device_.clock();
    model_.clock(in);
    ++clocks;
  }
  void clock(const SnappedQuad& quad, std::size_t beat, bool flush = false) {
    const VertexBeat one = beat_of(quad, beat);
    clock(&one, flush);
  }
  /// Of both sides, before the next clock.
  bool busy() {
    device_.set_handshake(false, true);
    device_.settle();
    EXPECT_EQ(device_.sample().busy, model_.comb().busy);
    return device_.sample().busy;
  }
  void clock_until_idle() {
    while (busy() && !testing::Test::HasFailure()) clock(nullptr);
  }
  ClockedModel& model() { return model_; }

  std::vector<Fragment> fragments;
  std::uint64_t clocks = 0;

 private:
  Device& device_;
  const Config& config_;
  ClockedModel model_;
  Scoreboard board_;
};

/// One to three beats keep the machine busy; a flush ends that, and the next quad is drawn in the clocks and bits in
/// which a machine fresh from reset draws it.
TEST_F(InputRules, APartialQuadIsFlushed) {
  VerilatedDevice device(options_.config, VerilateOptions{}, 1);
  const SnappedQuad &gone = quads_.at(0), &next = quads_.at(1);
  Pair fresh(device, options_);
  for (std::size_t i = 0; i < 4; ++i) fresh.clock(next, i);
  fresh.clock_until_idle();
  ASSERT_EQ(fresh.fragments, drawn({&next, 1}));
  for (std::size_t beats = 1; beats < 4; ++beats) {
    Pair pair(device, options_);
    for (std::size_t i = 0; i < beats; ++i) pair.clock(gone, i);
    for (int i = 0; i < quiet_clocks; ++i) pair.clock(nullptr);
    EXPECT_TRUE(pair.busy()) << beats;
    pair.clock(nullptr, true);
    EXPECT_FALSE(pair.busy()) << beats;
    pair.clocks = 0;
    for (std::size_t i = 0; i < 4; ++i) pair.clock(next, i);
    pair.clock_until_idle();
    EXPECT_EQ(pair.fragments, fresh.fragments) << beats;
    EXPECT_EQ(pair.clocks, fresh.clocks) << beats;
  }
}

/// A flush in the clock of one of a quad's beats discards that beat and those before it; from the clock after the
/// fourth beat on it discards nothing.
TEST_F(InputRules, AFlushNeverDiscardsACompleteQuad) {
  VerilatedDevice device(options_.config, VerilateOptions{}, 1);
  const SnappedQuad& quad = quads_.at(0);
  for (std::size_t at = 0; at < 80; ++at) {
    Pair pair(device, options_);
    for (std::size_t i = 0; i < 4; ++i) pair.clock(quad, i, i == at);
    for (std::size_t i = 4; i < 80; ++i) pair.clock(nullptr, i == at);
    pair.clock(nullptr, true);  // the beats behind a flush that came early
    pair.clock_until_idle();
    EXPECT_EQ(pair.fragments, at < 4 ? std::vector<Fragment>() : drawn({&quad, 1})) << at;
  }
}

TEST_F(InputRules, FlushesAtRandomChangeNoFragment) {
  VerilatedDevice device(options_.config, VerilateOptions{}, 1);
  for (const unsigned threads : {1u, 2u}) {
    options_.threads = threads;
    options_.flush = 0;
    options_.stall = 0.3;
    const LockstepReport without = run_lockstep(device, quads_, options_);
    ASSERT_TRUE(without.agreed() && without.complete);
    for (const double flush : {0.02, 0.4}) {
      options_.flush = flush;
      options_.gap = 0.2;
      const LockstepReport report = run_lockstep(device, quads_, options_);
      EXPECT_TRUE(report.agreed()) << report.first_divergence.value_or("");
      EXPECT_TRUE(report.complete);
      EXPECT_EQ(report.quads, quads_.size());
      EXPECT_EQ(report.fragment_hash, without.fragment_hash);
      EXPECT_EQ(report.fragments, without.fragments);
      EXPECT_EQ(run_clocked_model_alone(quads_, options_).cycles, report.cycles_model);
    }
  }
}

/// Each bit of the draw state is static from a quad's first beat to its last fragment: the RTL asserts it, the model
/// throws.
TEST_F(InputRules, TheDrawStateIsStaticWhileQuadsAreUnderWay) {
  const std::vector<std::uint32_t> state = pack_state(options_.state, options_.config);
  const std::size_t bits = static_cast<std::size_t>(state_layout(options_.config).bits());
  ASSERT_GT(bits, 100u);
  std::vector<std::uint32_t> other = state;
  for (std::size_t bit = 0; bit < bits; ++bit) {
    VerilatedDevice device(options_.config, VerilateOptions{}, 1);
    other[bit / 32] ^= std::uint32_t{1} << bit % 32;
    Pair pair(device, options_);
    device.set_state(other);  // nothing is under way
    pair.clock(nullptr);
    device.set_state(state);
    const bool whole = bit % 2 == 0;  // or a beat
    for (std::size_t i = 0; i < (whole ? 4u : 1u); ++i) pair.clock(quads_.at(0), i);
    device.set_state(other);
    try {
      pair.clock(nullptr);
      ADD_FAILURE() << "bit " << bit;
    } catch (const DeviceError& stop) {
      EXPECT_NE(std::string(stop.what()).find("quadrille.sv"), std::string::npos) << stop.what();
    }
    EXPECT_THROW(pair.model().set_state(options_.state), std::logic_error);
    other = state;
  }
}

}  // namespace
}  // namespace quadrille::tb
