// Draw states that no machine can have: every field, refused by both models at construction and in between, and what
// the models do afterwards.
#include "model/port/draw_state.hpp"

#include "model/clocked.hpp"
#include "model/port/snap.hpp"
#include "model/untimed.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace quadrille {
namespace {

struct Refused {
  const char* field;
  std::string rule;  ///< a part of it
  std::function<void(DrawState&)> change;
};

DrawState small_state() { return draw_state_for(Config{}, 32, 24); }

std::vector<Refused> refused_states() {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  return {
      {"viewport", "from 1x1 to 4096x4096", [](DrawState& s) { s.width = 0; }},
      {"viewport", "viewport_bits", [](DrawState& s) { s.height = -1; }},
      {"viewport", "viewport_bits", [](DrawState& s) { s.width = 4097; }},
      {"viewport", "viewport_bits", [](DrawState& s) { s.height = 4097; }},
      {"scissor", "inside the viewport 32x24", [](DrawState& s) { s.scissor_x0 = -1; }},
      {"scissor", "inside the viewport 32x24", [](DrawState& s) { s.scissor_y0 = -1; }},
      {"scissor", "inside the viewport 32x24", [](DrawState& s) { s.scissor_x1 = 33; }},
      {"scissor", "inside the viewport 32x24", [](DrawState& s) { s.scissor_y1 = 25; }},
      {"scissor", "X0 must not exceed X1", [](DrawState& s) { s.scissor_x0 = 9, s.scissor_x1 = 8; }},
      {"scissor", "Y0 exceed Y1", [](DrawState& s) { s.scissor_y0 = 9, s.scissor_y1 = 8; }},
      {"cull", "0 (none), 1 (front) or 2 (back)", [](DrawState& s) { s.cull = static_cast<Cull>(3); }},
      {"znear..zfar", "0 <= znear", [](DrawState& s) { s.znear = -0.5; }},
      {"znear..zfar", "zfar <= 1", [](DrawState& s) { s.zfar = 1.5; }},
      {"znear..zfar", "znear <= zfar", [](DrawState& s) { s.znear = 0.75, s.zfar = 0.5; }},
      {"znear..zfar", "znear <= zfar", [nan](DrawState& s) { s.znear = nan; }},
      {"znear..zfar", "znear <= zfar", [nan](DrawState& s) { s.zfar = nan; }},
      {"attributes", "from 0 to 4 (attribute_slots)", [](DrawState& s) { s.attributes = 5; }},
      {"attributes", "attribute_slots", [](DrawState& s) { s.attributes = 9; }},
      {"attributes", "attribute_slots", [](DrawState& s) { s.attributes = -1; }},
      {"skip", "63", [](DrawState& s) { s.skip = 64; }},
      {"skip", "hierarchical_z_bits", [](DrawState& s) { s.skip |= skip_hidden; }},
      {"skip", "plane_quads", [](DrawState& s) { s.skip |= skip_plane; }},
  };
}

/// The draw state's error names field and rule.
template <class F>
void expect_refused(const Refused& refused, F&& f) {
  try {
    f();
    ADD_FAILURE() << refused.field << ", " << refused.rule << ": accepted";
  } catch (const DrawStateError& error) {
    EXPECT_EQ(error.field, refused.field);
    EXPECT_NE(error.rule.find(refused.rule), std::string::npos) << error.rule;
    EXPECT_EQ(std::string(error.what()).find("draw state: " + error.field), 0u) << error.what();
  }
}

SnappedQuad square(const DrawState& state) {
  WindowQuad quad;
  quad.vertex = {{{4, 4, 0.5, 1}, {4, 12, 0.5, 1}, {12, 12, 0.5, 1}, {12, 4, 0.5, 1}}};
  for (std::size_t i = 0; i < 4; ++i) quad.attribute[i] = {0.25 * static_cast<double>(i), 1, 0, -1};
  return snap_quad(quad, Config{}, state);
}

std::vector<Fragment> drawn(UntimedModel& model, const SnappedQuad& quad) {
  std::vector<Fragment> all;
  model.draw(quad, [&](std::span<const Fragment> some) { all.insert(all.end(), some.begin(), some.end()); });
  return all;
}

TEST(DrawStates, EveryFieldIsCheckedByBothModels) {
  const DrawState good = small_state();
  UntimedModel untimed(Config{}, good);
  ClockedModel clocked(Config{}, good);
  const SnappedQuad quad = square(good);
  const std::vector<Fragment> before = drawn(untimed, quad);
  ASSERT_EQ(before.size(), 64u);
  for (const Refused& refused : refused_states()) {
    DrawState bad = good;
    refused.change(bad);
    expect_refused(refused, [&] { check_draw_state(bad, Config{}); });
    expect_refused(refused, [&] { UntimedModel{Config{}, bad}; });
    expect_refused(refused, [&] { UntimedModel(Config{}, bad, PixelEngine::plain); });
    expect_refused(refused, [&] { ClockedModel{Config{}, bad}; });
    expect_refused(refused, [&] { untimed.set_state(bad); });
    expect_refused(refused, [&] { clocked.set_state(bad); });
    EXPECT_EQ(drawn(untimed, quad), before) << "after " << refused.field << " was refused";
  }
}

TEST(DrawStates, TheEndsOfEachRangeAreAccepted) {
  Config config;
  config.attribute_slots = 8;
  config.hierarchical_z_bits = 8;
  config.plane_quads = 1;
  DrawState state = draw_state_for(config, 1, 1);
  const auto accepted = [&] {
    EXPECT_NO_THROW(UntimedModel(config, state));
    EXPECT_NO_THROW(ClockedModel(config, state));
  };
  EXPECT_EQ(state.attributes, 4);
  accepted();
  state = draw_state_for(config, 4096, 4096);
  state.attributes = 8;
  state.skip = 63;
  state.znear = state.zfar = 1;
  state.cull = Cull::back;
  accepted();
  state.scissor_x0 = state.scissor_x1;  // empty
  state.attributes = 0;
  state.znear = state.zfar = 0;
  accepted();
  state.depth = false;
  EXPECT_THROW(UntimedModel(config, state), DrawStateError) << "nothing is hidden without depth";
  EXPECT_EQ(with_possible_skips(state, config).skip, 63 & ~skip_hidden);
  state.depth = true;
  EXPECT_EQ(with_possible_skips(state, config).skip, 63u);
  EXPECT_EQ(with_possible_skips(state, Config{}).skip, +skip_default);
}

TEST(DrawStates, TheConfigurationIsCheckedFirst) {
  Config config;
  config.attribute_slots = 9;
  DrawState state = small_state();
  state.attributes = 9;
  EXPECT_THROW(UntimedModel(config, state), ConfigError);
  EXPECT_THROW(ClockedModel(config, state), ConfigError);
  WindowQuad quad;
  quad.vertex = {{{4, 4, 0.5, 1}, {4, 12, 0.5, 1}, {12, 12, 0.5, 1}, {12, 4, 0.5, 1}}};
  for (auto& values : quad.attribute) values.assign(9, 0.5);
  EXPECT_THROW(snap_quad(quad, config, state), ConfigError);
  EXPECT_THROW(snap_quad(quad, config, state), ConfigError) << "also the second time";
  EXPECT_NO_THROW(snap_quad(quad, Config{}, small_state()));
  config.attribute_slots = 4;
  config.viewport_bits = 40;
  EXPECT_THROW(UntimedModel(config, state), ConfigError);
  EXPECT_THROW(ClockedModel(config, state), ConfigError);
}

}  // namespace
}  // namespace quadrille
