// The RTL and the clocked model in lockstep, and the RTL's configuration against the C++ side's.
#include "golden/scenes/corner_quads.hpp"
#include "golden/scenes/random_quads.hpp"
#include "golden/scenes/random_state.hpp"
#include "golden/scenes/stress.hpp"
#include "model/port/snap.hpp"
#include "model/support/prng.hpp"
#include "tb/device/verilated_device.hpp"
#include "tb/lockstep/cosim_test_support.hpp"
#include "tb/lockstep/lockstep.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace quadrille::tb {
namespace {

std::string test_name(const testing::TestParamInfo<Named>& info) { return info.param.name; }

class Configuration : public testing::TestWithParam<Named> {};
INSTANTIATE_TEST_SUITE_P(Cosim, Configuration, testing::Values(standard, s12, s24, coarse, odd, lanes), test_name);

TEST_P(Configuration, RtlSeesTheSameNumbers) {
  const Config config = GetParam().config();
  const VerilatedDevice device(config, VerilateOptions{}, 1);
  std::map<std::string, std::int64_t> rtl;
  for (const auto& [name, value] : device.constants()) rtl[name] = value;

  // Keys with an automatic value are compared as resolved.
  const std::map<std::string, int> resolved{{"quadratic_frac_bits", config.quadratic_frac()},
                                            {"sqrt_segments_log2", config.sqrt_segments()},
                                            {"recip_segments_log2", config.recip_segments()},
                                            {"attribute_frac_bits", config.attribute_frac()}};
  const std::map<std::string, std::string> resolved_names{{"QUADRATIC_FRAC", "QUADRATIC_FRAC_BITS"},
                                                          {"SQRT_SEGMENTS", "SQRT_SEGMENTS_LOG2"},
                                                          {"RECIP_SEGMENTS", "RECIP_SEGMENTS_LOG2"},
                                                          {"ATTRIBUTE_FRAC", "ATTRIBUTE_FRAC_BITS"}};
  std::size_t compared = 0;
  const auto same = [&](const std::string& name, std::int64_t value) {
    const auto found = rtl.find(name);
    ASSERT_NE(found, rtl.end()) << name << " is not public in quadrille_pkg";
    EXPECT_EQ(found->second, value) << name;
    ++compared;
  };
  for (const ConfigKey& key : Config::keys()) {
    std::string name(key.name);
    const auto automatic = resolved.find(name);
    const int value = automatic == resolved.end() ? config.get(name) : automatic->second;
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::toupper(c); });
    same(name, value);
  }
  for (const DerivedWidth& width : config.derived()) {
    const auto other = resolved_names.find(width.name);
    same(other == resolved_names.end() ? width.name : other->second, width.value);
  }
  EXPECT_EQ(compared, Config::keys().size() + config.derived().size());
}

TEST_P(Configuration, LockstepUnderEveryStallPattern) {
  LockstepOptions options;
  options.config = GetParam().config();
  options.state = small_state(options.config);
  std::vector<SnappedQuad> quads = random_quads(options.config, options.state, 2024, 400);
  // Of random quads hardly any has two corners of different w at a pixel centre.
  for (const WindowQuad& quad : golden::make_corner(golden::CornerGroup::two_corner, options.config, options.state,
                                                    2024, options.config.attribute_slots))
    quads.push_back(snap_quad(quad, options.config, options.state));
  VerilatedDevice device(options.config, VerilateOptions{}, options.seed);  // one device for all: reset is tested too
  std::uint64_t fragments = 0, total = 0, hash = 0;
  unsigned flags = 0;
  for (const double stall : {0.0, 0.1, 0.5, 0.9}) {
    for (const double gap : {0.0, 0.1, 0.5, 0.9}) {
      options.stall = stall;
      options.gap = gap;
      ++options.seed;
      const LockstepReport report = run_lockstep(device, quads, options, [&](const Fragment& f) { flags |= f.flags; });
      ASSERT_TRUE(report.agreed()) << "stall " << stall << ", gap " << gap << ": "
                                   << report.first_divergence.value_or("");
      ASSERT_TRUE(report.complete);
      EXPECT_EQ(report.cycles_rtl, report.cycles_model);
      for (const BoundaryCount& count : report.boundaries) EXPECT_GT(count.beats, 0u) << count.name;
      if (total == 0) {
        fragments = report.fragments;
        hash = report.fragment_hash;
      }
      EXPECT_EQ(report.fragments, fragments);
      EXPECT_EQ(report.fragment_hash, hash) << "the fragments depend on stall " << stall << ", gap " << gap;
      total += report.fragments;
    }
  }
  EXPECT_GT(fragments, 10000u);
  EXPECT_EQ(flags, options.config.notch_exact != 0 ? 0xffu : 0xffu & ~flag_notch)
      << "a flag that never occurs is not tested";
  RecordProperty("fragments", std::to_string(total));
}

TEST_P(Configuration, LockstepInEveryDrawState) {
  LockstepOptions options;
  options.config = GetParam().config();
  VerilatedDevice device(options.config, VerilateOptions{}, options.seed);
  std::uint64_t total = 0;
  for (int i = 0; i < 12; ++i) {
    DrawState& state = options.state = small_state(options.config, 40 + i);
    state.cull = static_cast<Cull>(i % 3);
    state.perspective = i % 2 == 0;
    state.depth = i % 4 != 1;
    state.attributes = i % (options.config.attribute_slots + 1);
    state.skip = i % 5 == 0   ? 0u
                 : i % 5 == 1 ? skip_tiles
                 : i % 5 == 2 ? skip_quads
                 : i % 5 == 3 ? skip_walk
                              : skip_default;
    state.znear = i % 3 == 0 ? 0.25 : 0;
    state.zfar = i % 3 == 1 ? 0.75 : 1;
    if (i >= 6) {
      state.scissor_x0 = i;
      state.scissor_y0 = i / 2;
      state.scissor_x1 = 40 - i;
      state.scissor_y1 = 39;
    }
    if (i == 11) state.scissor_x1 = state.scissor_x0;  // nothing at all
    options.stall = options.gap = 0.1 * (i % 3);
    options.seed = static_cast<std::uint64_t>(100 + i);
    const std::vector<SnappedQuad> quads = random_quads(options.config, state, options.seed, 60);
    const LockstepReport report = run_lockstep(device, quads, options);
    ASSERT_TRUE(report.agreed()) << "state " << i << ": " << report.first_divergence.value_or("");
    ASSERT_TRUE(report.complete);
    if (i == 11) {
      EXPECT_EQ(report.fragments, 0u);
    }
    total += report.fragments;
  }
  EXPECT_GT(total, 5000u);
}

TEST_P(Configuration, LockstepOnCornerQuads) {
  LockstepOptions options;
  options.config = GetParam().config();
  VerilatedDevice device(options.config, VerilateOptions{}, options.seed);
  std::uint64_t total = 0;
  // Another seed than that of the mutants' scenarios (tb/verify/faults), which the machine without a fault draws too.
  for (const golden::CornerDraw& draw : golden::corner_draws(options.config, 12)) {
    options.state = draw.state;
    options.stall = draw.stall;
    options.gap = 0;
    const LockstepReport report = run_lockstep(device, draw.quads, options);
    ASSERT_TRUE(report.agreed()) << draw.group << ": " << report.first_divergence.value_or("");
    ASSERT_TRUE(report.complete);
    total += report.fragments;
  }
  EXPECT_GT(total, 5000u);
}

TEST_P(Configuration, LockstepInRandomDrawStates) {
  LockstepOptions options;
  options.config = GetParam().config();
  VerilatedDevice device(options.config, VerilateOptions{}, options.seed);
  constexpr std::array<double, 4> stalls{0, 0.1, 0.5, 0.95};
  std::uint64_t total = 0;
  for (std::uint64_t seed = 700; seed < 740; ++seed) {
    golden::Prng rng(seed);
    const auto families = golden::stress_families();
    const golden::StressFamilyInfo& family = families[rng.below(families.size())];
    const bool high = rng.chance(0.25);  // many rows of blocks
    const int width = static_cast<int>(rng.integer(16, 72));
    const int height = static_cast<int>(high ? rng.integer(257, 400) : rng.integer(16, 72));
    const std::vector<WindowQuad> given =
        golden::make_stress(family.family, 8, seed, 1, width, height, options.config.attribute_slots);
    options.state = golden::random_draw_state(options.config, width, height, given, seed);
    options.stall = stalls[rng.below(stalls.size())];
    options.gap = rng.chance(0.5) ? 0 : 0.5;
    options.limit_fragments = options.stall > 0.9 ? 300 : 3000;
    options.seed = seed;
    std::vector<SnappedQuad> quads;
    for (const WindowQuad& quad : given) quads.push_back(snap_quad(quad, options.config, options.state));
    const LockstepReport report = run_lockstep(device, quads, options);
    ASSERT_TRUE(report.agreed()) << family.name << ", seed " << seed << ": " << report.first_divergence.value_or("");
    total += report.fragments;
  }
  EXPECT_GT(total, 10000u);
}

/// Homogeneous quads, ordinary ones between, with scissors whose first tile is far from the screen's in both axes: the
/// walk's approach to them, in rows of blocks that go to the right and to the left, and tiles cut off in a block.
TEST_P(Configuration, LockstepInScissorsFarFromTheFirstTile) {
  LockstepOptions options;
  options.config = GetParam().config();
  VerilatedDevice device(options.config, VerilateOptions{}, options.seed);
  constexpr std::array<double, 4> stalls{0, 0.1, 0.5, 0.95};
  constexpr std::array<golden::StressFamily, 4> families{golden::StressFamily::eye_crossing,
                                                         golden::StressFamily::eye_in_hull,
                                                         golden::StressFamily::w_zero, golden::StressFamily::any_w};
  constexpr int size = 400;
  const int block = options.config.tile() * Config::block_tiles;
  std::uint64_t total = 0, approached = 0, from_the_right = 0;
  for (std::uint64_t seed = 1; seed <= 32; ++seed) {
    golden::Prng rng(seed, 17);
    const std::vector<WindowQuad> given =
        golden::make_stress(families[seed % families.size()], 8, seed, 1, size, size, options.config.attribute_slots);
    DrawState& state = options.state = golden::random_draw_state(options.config, size, size, given, seed);
    const auto part = [&](int& lo, int& hi) {
      const auto length = static_cast<int>(rng.integer(1, 90));
      lo = static_cast<int>(rng.chance(0.2) ? size - length : rng.integer(0, size - length));
      hi = lo + length;
    };
    part(state.scissor_x0, state.scissor_x1);
    part(state.scissor_y0, state.scissor_y1);
    if (seed % 8 == 7)
      state.skip = (state.skip & ~std::uint32_t{skip_walk}) | skip_tiles;  // else 2,500 tiles a quad, or more
    else
      state.skip |= skip_walk;
    options.stall = stalls[rng.below(stalls.size())];
    options.gap = rng.chance(0.5) ? 0 : 0.5;
    options.limit_fragments = options.stall > 0.9 ? 300 : 3000;
    options.seed = seed;
    std::vector<SnappedQuad> quads;
    for (const WindowQuad& quad : given) {
      quads.push_back(snap_quad(quad, options.config, state));
      if (!rng.chance(0.3)) continue;
      const double x = state.scissor_x0 + rng.uniform(-20, 20), y = state.scissor_y0 + rng.uniform(-20, 20);
      WindowQuad ordinary = quad;  // for its attributes
      ordinary.vertex = {{{x, y, 0.5, 1}, {x + 30, y, 0.5, 1}, {x + 30, y + 30, 0.5, 1}, {x, y + 30, 0.5, 1}}};
      quads.push_back(snap_quad(ordinary, options.config, state));
    }
    const LockstepReport report = run_lockstep(device, quads, options);
    ASSERT_TRUE(report.agreed()) << "seed " << seed << ": " << report.first_divergence.value_or("");
    total += report.fragments;
    if ((state.skip & skip_walk) == 0) continue;
    approached += state.scissor_x0 >= block && state.scissor_y0 >= block;
    from_the_right += state.scissor_y0 / block % 2 != 0 && state.scissor_x0 / block != (state.scissor_x1 - 1) / block;
  }
  EXPECT_GT(total, 10000u);
  EXPECT_GT(approached, 8u);
  EXPECT_GT(from_the_right, 3u);
}

/// Quads that are left out, for every reason, between others: while slots are free and while they are not.
TEST_P(Configuration, LockstepAcrossQuadsLeftOut) {
  LockstepOptions options;
  options.config = GetParam().config();
  VerilatedDevice device(options.config, VerilateOptions{}, options.seed);
  options.state = small_state(options.config, 48);
  options.state.cull = Cull::front;
  options.state.znear = 0.25;
  options.state.zfar = 0.75;
  golden::Prng rng(31);
  std::vector<SnappedQuad> quads;
  for (std::uint32_t id = 0; id < 400; ++id) {
    WindowQuad q;
    q.id = id;
    const double x = rng.uniform(0, 40), y = rng.uniform(0, 40), dx = rng.uniform(1, 6), dy = rng.uniform(1, 6);
    q.vertex = {{{x, y, 0.5, 1}, {x + dx, y, 0.5, 1}, {x + dx, y + dy, 0.5, 1}, {x, y + dy, 0.5, 1}}};
    switch (rng.below(10)) {
      case 0:  // beside the screen
        for (WindowVertex& v : q.vertex) v.x += 60;
        break;
      case 1:  // between two pixel centres
        for (WindowVertex& v : q.vertex) v.y = 7.625 + v.y / 1024;
        break;
      case 2:  // behind the eye
        for (WindowVertex& v : q.vertex) v.w = -1 - v.x / 64;
        break;
      case 3:  // too near, too far, or with a negative depth
        for (WindowVertex& v : q.vertex) v.z = id % 3 == 0 ? 0.125 : id % 3 == 1 ? 0.875 : -0.5;
        break;
      case 4:  // on one line
        for (WindowVertex& v : q.vertex) v.y = v.x;
        break;
      case 5:  // turned away
        std::swap(q.vertex[1], q.vertex[3]);
        break;
      case 6:  // turned away, seen from behind the eye: homogeneous
        std::swap(q.vertex[1], q.vertex[3]);
        q.vertex[0] = {-x, -y, -0.5, -1};
        break;
      case 7:  // from the right of the screen to infinity on the right
        for (WindowVertex& v : q.vertex) v.x += 60;
        q.vertex[0] = {500, -y, -0.5, -1};
        if (id % 2 == 0) std::swap(q.vertex[1], q.vertex[3]);
        break;
      default:
        break;
    }
    quads.push_back(snap_quad(q, options.config, options.state));
  }
  UntimedModel model(options.config, options.state);
  for (const SnappedQuad& quad : quads) model.draw(quad, [](std::span<const Fragment>) {});
  for (std::size_t reason = 0; reason < quad_reject_count; ++reason)
    EXPECT_GT(model.stats().rejected[reason], 20u) << reason;
  for (const double stall : {0.0, 0.9}) {
    options.stall = stall;
    const LockstepReport report = run_lockstep(device, quads, options);
    ASSERT_TRUE(report.agreed()) << report.first_divergence.value_or("");
    EXPECT_EQ(report.quads, quads.size());
    EXPECT_EQ(report.fragments, model.stats().fragments);
  }
}

}  // namespace
}  // namespace quadrille::tb
