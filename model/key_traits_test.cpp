// What a key's entry says that it moves (config_keys.h) is what it moves: no less on any input here, no more than some
// value shows.
#include "golden/analysis/error_bound.hpp"
#include "golden/analysis/hardware_cost.hpp"
#include "golden/analysis/range_proof.hpp"
#include "model/clocked.hpp"
#include "model/every_key_test_support.hpp"
#include "model/port/draw_state.hpp"
#include "model/port/snap.hpp"
#include "model/untimed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

namespace quadrille {
namespace {

/// What a configuration makes of the quads.
struct Drawn {
  std::string refused;
  std::vector<std::tuple<std::uint32_t, int, int, bool, int, std::uint32_t, std::vector<std::int64_t>>> fragments;
  std::uint64_t clocks = 0, clocks_hiding = 0;
};

std::uint64_t clocks(const std::vector<SnappedQuad>& quads, const Config& config, const DrawState& state) {
  ClockedModel model(config, state);
  ClockedInputs in;
  in.reset = true;
  model.clock(in);
  in.reset = false;
  in.fragment_ready = true;
  std::size_t beat = 0;
  for (std::uint64_t clock = 0; clock < 1'000'000; ++clock) {
    in.vertex_valid = beat < 4 * quads.size();
    in.vertex = in.vertex_valid ? beat_of(quads[beat / 4], beat % 4) : VertexBeat{};
    const ClockedOutputs out = model.comb();
    if (!in.vertex_valid && !out.busy) return clock;
    beat += in.vertex_valid && out.vertex_ready;
    model.clock(in);
  }
  ADD_FAILURE() << "the machine does not become idle";
  return 0;
}

Drawn draw(const Config& config, bool perspective, int attributes) {
  Drawn drawn;
  DrawState state = state_for_every_key();
  state.perspective = perspective;
  state.attributes = attributes;
  DrawState hiding = state;
  hiding.skip |= skip_hidden;
  state = with_possible_skips(state, config);
  hiding = with_possible_skips(hiding, config);
  std::vector<WindowQuad> quads = quads_for_every_key();
  quads.back().id = 300;
  std::vector<SnappedQuad> snapped;
  try {
    for (WindowQuad& quad : quads) {
      for (auto& values : quad.attribute) values.resize(static_cast<std::size_t>(attributes));
      snapped.push_back(snap_quad(quad, config, state));
    }
    UntimedModel model(config, state);
    for (const SnappedQuad& quad : snapped)
      model.draw(quad, [&](std::span<const Fragment> list) {
        for (const Fragment& f : list)
          drawn.fragments.emplace_back(
              f.quad, f.x, f.y, f.front, f.flags & ~flag_notch, f.depth,
              std::vector<std::int64_t>(f.attribute.begin(), f.attribute.begin() + attributes));
      });
  } catch (const SnapError& error) {
    drawn.refused = error.what();
    return drawn;
  }
  std::ranges::sort(drawn.fragments);
  drawn.clocks = clocks(snapped, config, state);
  drawn.clocks_hiding = clocks(snapped, config, hiding);
  return drawn;
}

class KeyTraits : public testing::TestWithParam<ConfigKey> {};

TEST_P(KeyTraits, ErrorsAndClocks) {
  const ConfigKey& key = GetParam();
  const bool errors = key.errors != ConfigKey::Errors::none, clocks = key.has(ConfigKey::clocks);
  const int attributes = key.name == "attribute_slots" ? 1 : every_key_attributes;
  bool moved_errors = false, moved_clocks = false;
  for (const Config& base : bases_for_every_key())
    for (const bool perspective : {false, true}) {
      const Drawn expected = draw(base, perspective, attributes);
      ASSERT_EQ(expected.refused, "");
      ASSERT_GT(expected.fragments.size(), 1000u);
      for (const Config& config : configs_around(base, key)) {
        const Drawn drawn = draw(config, perspective, attributes);
        const bool same = drawn.refused.empty() && drawn.fragments == expected.fragments;
        moved_errors = moved_errors || !same;
        EXPECT_TRUE(errors || same) << "at " << config.get(key.name) << ", base " << &base - &bases_for_every_key()[0];
        if (!drawn.refused.empty()) continue;
        moved_clocks = moved_clocks || drawn.clocks != expected.clocks || drawn.clocks_hiding != expected.clocks_hiding;
        EXPECT_TRUE(clocks || drawn.clocks == expected.clocks)
            << "at " << config.get(key.name) << ", base " << &base - &bases_for_every_key()[0];
      }
    }
  EXPECT_TRUE(moved_errors || !errors) << "moves no error of this input";
  EXPECT_TRUE(moved_clocks || !clocks) << "moves no clock of this input";
  // What moves numbers enters at a stage; what only decides which quads are refused at none.
  EXPECT_EQ(key.stage != ConfigKey::Stage::none, errors && key.name != "quad_id_bits");
}

/// Tiles are where D and r² begin, which shows only when these are truncated.
TEST(KeyTraitsOfTiles, MoveNothingWhereDAndR2AreExact) {
  const auto drawn = [](int tile_log2, int quadratic_frac_bits) {
    Config config;
    config.tile_log2 = tile_log2, config.quadratic_frac_bits = quadratic_frac_bits;
    return draw(config, true, 1).fragments;
  };
  const auto expected = drawn(3, 30);
  for (const int tile_log2 : {2, 4}) {
    EXPECT_EQ(drawn(tile_log2, 30), expected);
    EXPECT_NE(drawn(tile_log2, 6), drawn(3, 6));
  }
}

TEST_P(KeyTraits, AreaAndProofs) {
  const ConfigKey& key = GetParam();
  const auto proofs = [](const Config& config) {
    std::ostringstream text;  // infinity and no number too
    text.precision(17);
    for (const ErrorBound& bound : {bound_lambda(config), bound_attribute(config, 0), bound_attribute(config, 1),
                                    bound_depth(config, 0), bound_depth(config, 1)})
      text << bound.value << bound.proved << bound.reason << '\n';
    for (const bool cut : {false, true}) text << value_bound_factor(config, cut) << '\n';
    for (const SignalRange& s : prove_ranges(config).signals) text << s.low << ' ' << s.high << ' ' << s.bits << '\n';
    return text.str();
  };
  bool moved_area = false, moved_proofs = false;
  for (const Config& base : bases_for_every_key())
    for (const Config& config : configs_around(base, key)) {
      moved_area = moved_area || hardware_cost(config) != hardware_cost(base);
      moved_proofs = moved_proofs || proofs(config) != proofs(base);
    }
  EXPECT_EQ(moved_area, key.has(ConfigKey::area));
  EXPECT_EQ(moved_proofs, key.has(ConfigKey::proofs));
}

INSTANTIATE_TEST_SUITE_P(Keys, KeyTraits, testing::ValuesIn(Config::keys().begin(), Config::keys().end()),
                         [](const auto& p) { return std::string(p.param.name); });

}  // namespace
}  // namespace quadrille
