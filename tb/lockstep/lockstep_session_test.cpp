// Draws one after the other in one machine: what is kept between them, clears, resets in the middle of a draw.
#include "golden/scenes/random_quads.hpp"
#include "golden/scenes/random_state.hpp"
#include "model/port/snap.hpp"
#include "model/untimed.hpp"
#include "tb/lockstep/lockstep.hpp"
#include "tb/lockstep/model_device.hpp"

#include <gtest/gtest.h>

namespace quadrille::tb {
namespace {

/// With the device in the loop's thread and in one of its own.
class Session : public testing::TestWithParam<unsigned> {
 protected:
  Session() {
    for (const auto& [key, value] : {std::pair{"significand_bits", 12},
                                     {"viewport_bits", 7},
                                     {"attribute_slots", 1},
                                     {"hierarchical_z_bits", 10},
                                     {"hierarchical_z_tiles_log2", 6}})
      options.config.set(key, value);
    options.state = small_state(options.config);
    options.state.skip |= skip_hidden;
    options.stall = 0.2;
    options.threads = GetParam();
    for (std::uint64_t d = 0; d < 8; ++d) {
      DrawState state = d % 2 == 0 ? options.state : golden::random_draw_state(options.config, 48, 48, {}, d);
      state.skip |= state.depth ? skip_hidden : 0u;
      states.push_back(state);
      quads.push_back(random_quads(options.config, state, d / 3, 25));  // some come again
      WindowQuad wall;                                                  // before many of them
      wall.id = 100;
      wall.vertex = {{{-6, -6, 0.3, 1}, {-6, 60, 0.3, 1}, {60, 60, 0.3, 1}, {60, -6, 0.3, 1}}};
      for (auto& attribute : wall.attribute) attribute = {0.5};
      quads.back().insert(quads.back().begin() + 5, snap_quad(wall, options.config, state));
    }
  }
  /// Before draw d.
  static unsigned clears(std::size_t d) { return d == 0 ? 0 : static_cast<unsigned>(d % 4); }

  LockstepOptions options;
  std::vector<DrawState> states;
  std::vector<std::vector<SnappedQuad>> quads;
};

INSTANTIATE_TEST_SUITE_P(Threads, Session, testing::Values(1u, 2u),
                         [](const auto& threads) { return threads.param == 1 ? "one" : "two"; });

TEST_P(Session, DrawsWhatTheUntimedModelDraws) {
  ModelDevice device(options.config, options.state);
  device.states = states;
  LockstepSession session(device, options);
  UntimedModel model(options.config, options.state);
  std::uint64_t fragments = 0;
  for (std::size_t d = 0; d < states.size(); ++d) {
    std::vector<Fragment> drawn, expected;
    options.state = states[d];
    const LockstepReport report =
        session.draw(quads[d], options, clears(d), [&](const Fragment& f) { drawn.push_back(f); });
    ASSERT_TRUE(report.agreed()) << "draw " << d << ": " << *report.first_divergence;
    EXPECT_TRUE(report.complete);
    EXPECT_EQ(report.quads, quads[d].size());
    model.set_state(states[d]);
    if (clears(d) > 0) model.clear_hidden();
    for (const SnappedQuad& quad : quads[d])
      model.draw(quad, [&](std::span<const Fragment> f) { expected.insert(expected.end(), f.begin(), f.end()); });
    EXPECT_TRUE(drawn == expected) << "draw " << d << ": " << drawn.size() << " of " << expected.size();
    fragments += report.fragments;
  }
  EXPECT_GT(fragments, 2000u);
  EXPECT_GT(model.stats().tiles_hidden + model.stats().tiles_masked, 20u) << "what is hidden is held from draw to draw";
}

TEST_P(Session, AClearThatIsIgnoredShows) {
  ModelDevice device(options.config, options.state);
  device.takes_clears = false;
  LockstepSession session(device, options);
  EXPECT_TRUE(session.draw(quads[0], options, 0).agreed());
  EXPECT_TRUE(session.draw(quads[0], options, 0).agreed());
  const LockstepReport report = session.draw(quads[0], options, 1);
  EXPECT_GT(report.cycle_mismatches, 0u);
}

TEST_P(Session, AResetInTheMiddleOfADraw) {
  ModelDevice device(options.config, options.state);
  LockstepSession session(device, options);
  LockstepOptions cut = options;
  cut.limit_fragments = 100;
  const LockstepReport part = session.draw(quads[0], cut, 0);
  EXPECT_TRUE(part.agreed());
  EXPECT_FALSE(part.complete);
  session.reset();
  std::vector<Fragment> drawn, expected;
  const LockstepReport whole = session.draw(quads[0], options, 3, [&](const Fragment& f) { drawn.push_back(f); });
  EXPECT_TRUE(whole.agreed() && whole.complete) << whole.first_divergence.value_or("");
  UntimedModel model(options.config, options.state);
  for (const SnappedQuad& quad : quads[0])
    model.draw(quad, [&](std::span<const Fragment> f) { expected.insert(expected.end(), f.begin(), f.end()); });
  EXPECT_TRUE(drawn == expected);
}

/// A state that the device does not get is a difference of the draw that has it.
TEST_P(Session, AnotherStateIsHandedOver) {
  ModelDevice device(options.config, options.state);
  LockstepSession session(device, options);
  EXPECT_TRUE(session.draw(quads[0], options, 0).agreed());
  options.state.cull = Cull::back;
  EXPECT_FALSE(session.draw(quads[0], options, 0).agreed()) << "the device has kept the state before";
}

}  // namespace
}  // namespace quadrille::tb
