// Hidden tiles in lockstep: draws one after the other in one machine, the depths held from draw to draw or cleared,
// more often than there are epochs, and not by clears while the machine is busy; and the stream of fragments the same
// under every pattern of stalls, and the untimed model's.
#include "golden/scenes/random_state.hpp"
#include "golden/scenes/stress.hpp"
#include "model/clocked.hpp"
#include "model/port/bit_vector.hpp"
#include "model/port/snap.hpp"
#include "model/skips/hierarchical_z.hpp"
#include "model/support/prng.hpp"
#include "model/untimed.hpp"
#include "tb/device/verilated_device.hpp"
#include "tb/lockstep/driver.hpp"
#include "tb/lockstep/lockstep.hpp"
#include "tb/lockstep/scoreboard.hpp"

#include <gtest/gtest.h>

#include <array>

namespace quadrille::tb {
namespace {

struct Named {
  const char* name;
  int width, height;
  std::vector<std::pair<const char*, int>> keys;

  Config config() const {
    Config c;
    for (const auto& [key, value] : keys) c.set(key, value);
    c.validate();
    return c;
  }
  friend std::ostream& operator<<(std::ostream& out, const Named& n) { return out << n.name; }
};

/// Four epochs, and fewer places than tiles; of six columns of blocks of tiles, five of them whole, four have places.
const Named few_places{"few_places",
                       168,
                       36,
                       {{"viewport_bits", 8},
                        {"significand_bits", 10},
                        {"attribute_slots", 1},
                        {"tile_log2", 2},
                        {"hierarchical_z_bits", 10},
                        {"performance_counters", 1},
                        {"hierarchical_z_tiles_log2", 6}}};
/// More places than tiles, one block of them, codes wider than significands.
const Named many_places{"many_places",
                        64,
                        64,
                        {{"viewport_bits", 6},
                         {"significand_bits", 9},
                         {"attribute_slots", 1},
                         {"pixels_per_clock", 4},
                         {"dot_units", 4},
                         {"hierarchical_z_bits", 14},
                         {"performance_counters", 1},
                         {"hierarchical_z_tiles_log2", 9}}};

struct Draw {
  DrawState state;
  std::vector<SnappedQuad> quads;
  bool clear = false;  ///< before it
};

/// Layers of all kinds of quads, a few in front of much.
std::vector<Draw> make_draws(const Config& config, int width, int height, std::size_t count) {
  std::vector<Draw> draws;
  golden::Prng rng(77);
  const auto families = golden::stress_families();
  for (std::size_t d = 0; d < count; ++d) {
    const golden::StressFamilyInfo& family = families[rng.below(families.size())];
    std::vector<WindowQuad> given = golden::make_stress(family.family, 6, 400 + d, 1, width, height, 1);
    for (std::uint32_t i = 0; i < 8; ++i) {
      WindowQuad quad;
      double x = rng.uniform() * width * 0.7 - 6, y = rng.uniform() * height * 0.7 - 6;
      double w = 8 + rng.uniform() * width, h = 8 + rng.uniform() * height;
      const double z = 0.02 + 0.9 * rng.uniform();
      if (rng.chance(0.5)) x = -6, w = width + 12;  // from side to side, or down
      if (rng.chance(0.5)) y = -6, h = height + 12;
      quad.id = 20 + i;
      quad.vertex = {{{x, y, z, 1}, {x, y + h, z + 0.01, 1}, {x + w, y + h, z + 0.02, 1}, {x + w, y, z, 1}}};
      for (auto& attribute : quad.attribute) attribute = {0.5};
      given.insert(given.begin() + static_cast<std::ptrdiff_t>(rng.below(given.size() + 1)), quad);
    }
    Draw draw;
    draw.state = golden::random_draw_state(config, width, height, given, 500 + d);
    if (d % 3 != 2) {  // mostly nothing in the way
      draw.state = {};
      draw.state.width = draw.state.scissor_x1 = width;
      draw.state.height = draw.state.scissor_y1 = height;
      draw.state.attributes = 1;
    }
    if (d % 5 != 4) draw.state.skip |= skip_hidden;
    draw.clear = d % 4 == 3 || d % 7 == 0;
    for (std::size_t i = 0; i < given.size(); ++i) {
      draw.quads.push_back(snap_quad(given[i], config, draw.state));
      draw.quads.back().id = static_cast<std::uint32_t>(i);
    }
    draws.push_back(std::move(draw));
  }
  // Depths of code 0, which hide any quad, and then draws in which none is to be hidden.
  for (int d = 0; d < 3; ++d) {
    WindowQuad quad;
    const double w = width, h = height, z = d == 0 ? 0 : 0.5;
    quad.vertex = {{{0, 0, z, 1}, {0, h, z, 1}, {w, h, z, 1}, {w, 0, z, 1}}};
    for (auto& attribute : quad.attribute) attribute = {0.5};
    Draw draw;
    draw.state.width = draw.state.scissor_x1 = width;
    draw.state.height = draw.state.scissor_y1 = height;
    draw.state.attributes = 1;
    draw.state.depth = d != 2;
    if (d == 0) draw.state.skip |= skip_hidden;
    draw.clear = d == 0;
    draw.quads.push_back(snap_quad(quad, config, draw.state));
    draws.push_back(std::move(draw));
  }
  return draws;
}

std::vector<Fragment> untimed(const Config& config, const std::vector<Draw>& draws, DrawStats& stats) {
  UntimedModel model(config, draws.front().state);
  std::vector<Fragment> all;
  for (const Draw& draw : draws) {
    model.set_state(draw.state);
    if (draw.clear) model.clear_hidden();
    for (const SnappedQuad& quad : draw.quads)
      model.draw(quad, [&](std::span<const Fragment> f) { all.insert(all.end(), f.begin(), f.end()); });
  }
  stats = model.stats();
  return all;
}

/// One machine through all draws; both sides compared in every clock. Returns the model's fragments.
std::vector<Fragment> lockstep(Device& device, const Config& config, const std::vector<Draw>& draws, double stall,
                               double gap, const DrawStats& stats) {
  constexpr std::uint64_t seed = 5;
  golden::Prng pulses(seed, 9);
  int ignored_clears = 0;
  ClockedModel model(config, draws.front().state);
  std::vector<Fragment> all;
  ClockedInputs in;
  device.set_clear_hidden(false);
  device.set_flush(false);
  device.set_state(pack_state(draws.front().state, config));
  device.set_handshake(false, false);
  device.set_reset(true);
  in.reset = true;
  for (int i = 0; i < 4; ++i) {
    device.settle();
    device.clock();
    model.clock(in);
  }
  device.set_reset(false);
  in.reset = false;
  const auto compare_counters = [&] {
    const PerformanceCounters counters = model.counters();
    for (std::size_t i = 0; i < counter_count; ++i)
      EXPECT_EQ(device.counter(i), static_cast<std::uint32_t>(counters.value[i])) << counter_info[i].name;
  };
  std::uint64_t cycle = 0;
  for (std::size_t d = 0; d < draws.size(); ++d) {
    const Draw& draw = draws[d];
    // Between draws nothing is in the machine.
    Scoreboard board(config, draw.quads, false, seed);
    device.set_state(pack_state(draw.state, config));
    model.set_state(draw.state);
    VertexDriver vertices(draw.quads, config, draw.state.attributes, seed + d, gap);
    ReadyDriver stalls(seed + d, stall);
    bool first = true;
    for (int idle = 0; idle < 2; ++cycle) {
      // A clear while the machine is busy is ignored, among them the first draw's, while reset wipes.
      const bool busy = model.comb().busy;
      in.clear_hidden = (first && draw.clear) || (busy && pulses.chance(0.05));
      ignored_clears += in.clear_hidden && busy ? 1 : 0;
      first = false;
      in.vertex_valid = vertices.valid();
      in.vertex = vertices.beat();
      in.fragment_ready = stalls.ready();
      device.set_clear_hidden(in.clear_hidden);
      device.set_vertex(vertices.words());
      device.set_handshake(in.vertex_valid, in.fragment_ready);
      device.settle();
      const ClockedOutputs out = model.comb();
      board.compare(cycle, out, device.sample());
      if (board.mismatches() + board.cycle_mismatches() != 0) {
        ADD_FAILURE() << "draw " << d << ": " << board.first_divergence().value_or("");
        return all;
      }
      if (out.fragment_valid && in.fragment_ready) out.for_each_fragment([&](const Fragment& f) { all.push_back(f); });
      if (cycle % 64 == 0) compare_counters();  // with pixels on their way
      const bool taken = in.vertex_valid && out.vertex_ready;
      idle = vertices.done() && !out.busy ? idle + 1 : 0;
      device.clock();
      model.clock(in);
      vertices.advance(taken);
      stalls.advance();
    }
  }
  compare_counters();
  EXPECT_GT(ignored_clears, 500);
  EXPECT_EQ(model.counters()[PerformanceCounter::tiles_hidden], stats.tiles_hidden);
  EXPECT_EQ(model.counters()[PerformanceCounter::blocks_hidden], stats.blocks_hidden);
  return all;
}

std::string test_name(const testing::TestParamInfo<Named>& named) { return named.param.name; }

class HiddenTiles : public testing::TestWithParam<Named> {};
INSTANTIATE_TEST_SUITE_P(Cosim, HiddenTiles, testing::Values(few_places, many_places), test_name);

TEST_P(HiddenTiles, LockstepThroughDrawsAndClears) {
  const Config config = GetParam().config();
  const std::vector<Draw> draws = make_draws(config, GetParam().width, GetParam().height, 24);
  DrawStats stats;
  const std::vector<Fragment> expected = untimed(config, draws, stats);
  EXPECT_GT(stats.tiles_hidden, 400u);
  EXPECT_GT(stats.blocks_hidden, 40u);
  VerilatedDevice device(config, VerilateOptions{}, 3);
  for (const auto& [stall, gap] : {std::pair{0.0, 0.0}, {0.5, 0.1}, {0.0, 0.7}, {0.9, 0.0}}) {
    const std::vector<Fragment> drawn = lockstep(device, config, draws, stall, gap, stats);
    ASSERT_TRUE(drawn == expected) << drawn.size() << " fragments of " << expected.size() << ", stall " << stall;
  }
}

/// Clears and flushes at any time. Most clears come while the machine is busy; some wipe. Flushes change no fragment.
TEST_P(HiddenTiles, LockstepWithClearsAndFlushesAtAnyTime) {
  LockstepOptions options;
  options.config = GetParam().config();
  std::uint64_t wiping = 0, wiping_with_clears = 0;
  for (const Draw& draw : make_draws(options.config, GetParam().width, GetParam().height, 5)) {
    options.state = draw.state;
    options.stall = 0.2;
    options.gap = 0.7;
    options.clear = options.flush = 0;
    VerilatedDevice device(options.config, VerilateOptions{}, 3);
    const LockstepReport alone = run_lockstep(device, draw.quads, options);
    options.flush = 0.1;
    const LockstepReport flushed = run_lockstep(device, draw.quads, options);
    options.clear = 0.3;
    const LockstepReport cleared = run_lockstep(device, draw.quads, options);
    for (const LockstepReport& report : {alone, flushed, cleared}) {
      ASSERT_TRUE(report.agreed()) << report.first_divergence.value_or("");
      EXPECT_TRUE(report.complete);
    }
    EXPECT_EQ(flushed.fragment_hash, alone.fragment_hash);
    wiping += flushed.counters[PerformanceCounter::bound_wipe];
    wiping_with_clears += cleared.counters[PerformanceCounter::bound_wipe];
  }
  EXPECT_GT(wiping_with_clears, wiping);
}

}  // namespace
}  // namespace quadrille::tb
