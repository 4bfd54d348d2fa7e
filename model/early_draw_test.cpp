// A draw from the initialisation of another object, which the linker puts before the library's: nothing that the models
// use may wait to be initialised.
#include "model/clocked.hpp"
#include "model/fast/each_lane_target.hpp"
#include "model/port/config_text.hpp"
#include "model/port/snap.hpp"
#include "model/port/tables.hpp"
#include "model/untimed.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace quadrille {
namespace {

struct Drawn {
  LaneTarget target = LaneTarget::baseline;    ///< the one that nobody chose
  std::vector<std::vector<Fragment>> untimed;  ///< by lane target and engine
  std::vector<Fragment> clocked;
  std::string tables, counters;

  friend bool operator==(const Drawn&, const Drawn&) = default;
};

/// A turned quad of some tiles, and one with a vertex behind the eye.
std::vector<SnappedQuad> quads(const Config& config, const DrawState& state) {
  std::vector<SnappedQuad> all;
  for (const double w : {1.0, -0.5}) {
    WindowQuad quad;
    quad.id = static_cast<std::uint32_t>(all.size());
    quad.vertex = {{{30.25, 3.5, 0.25, 1}, {4.5, 31.25, 0.5, 1}, {29.5, 60.75, 0.75, 1}, {60 * w, 30 * w, 0.5 * w, w}}};
    for (std::size_t i = 0; i < 4; ++i) quad.attribute[i] = {i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, 0.5};
    all.push_back(snap_quad(quad, config, state));
  }
  return all;
}

Drawn draw() {
  Drawn out;
  Config config;
  apply_config_text("significand_bits = 17", config);
  DrawState state = draw_state_for(config, 64, 64);
  state.attributes = 3;
  out.target = lane_target();
  for (const LaneTarget target : lane_targets()) {
    if (!can_run(target)) continue;
    set_lane_target(target);
    for (const PixelEngine engine : {PixelEngine::lanes, PixelEngine::plain}) {
      UntimedModel model(config, state, engine);
      std::vector<Fragment>& fragments = out.untimed.emplace_back();
      for (const SnappedQuad& quad : quads(config, state))
        model.draw(
            quad, [&](std::span<const Fragment> some) { fragments.insert(fragments.end(), some.begin(), some.end()); });
    }
  }
  set_lane_target(out.target);
  ClockedModel model(config, state);
  ClockedInputs inputs;
  inputs.reset = true;
  model.clock(inputs);
  inputs = {};
  inputs.fragment_ready = true;
  const std::vector<SnappedQuad> given = quads(config, state);
  for (std::size_t beat = 0; beat < 4 * given.size() || model.comb().busy;) {
    inputs.vertex_valid = beat < 4 * given.size();
    if (inputs.vertex_valid) inputs.vertex = beat_of(given[beat / 4], beat % 4);
    const ClockedOutputs now = model.comb();
    now.for_each_fragment([&](const Fragment& f) { out.clocked.push_back(f); });
    model.clock(inputs);
    beat += inputs.vertex_valid && now.vertex_ready;
  }
  out.tables = tables_package(config);
  for (const CounterInfo& counter : counter_info) out.counters += std::string(counter.name) + " ";
  return out;
}

const Drawn early = draw();

TEST(EarlyDraw, IsTheSameAsLater) {
  const Drawn later = draw();
  ASSERT_GT(later.clocked.size(), 1000u);
  EXPECT_EQ(early.target, later.target) << "the best target is found by the first who asks";
  ASSERT_EQ(early.untimed.size(), later.untimed.size());
  for (std::size_t i = 0; i < later.untimed.size(); ++i) {
    EXPECT_EQ(later.untimed[i], later.clocked);
    EXPECT_EQ(early.untimed[i].size(), later.untimed[i].size());
    EXPECT_EQ(early.untimed[i], later.untimed[i]);
  }
  EXPECT_EQ(early.clocked, later.clocked);
  EXPECT_TRUE(early == later);
}

}  // namespace
}  // namespace quadrille
