// The float engine agrees with the model on generated vectors and finds what is wrong.
#include "golden/suites/float_engine.hpp"

#include "golden/io/error.hpp"
#include "golden/scenes/random_quads.hpp"
#include "golden/scenes/stress.hpp"
#include "golden/suites/float_quad.hpp"
#include "golden/suites/float_stages.hpp"
#include "golden/suites/machine_suite.hpp"
#include "model/snap.hpp"
#include "model/untimed.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <set>
#include <span>

namespace quadrille::vectors {
namespace {

using Kind = VectorOutcome::Kind;

Config config_of(std::initializer_list<std::pair<const char*, int>> values) {
  Config config;
  for (const auto& [key, value] : values) config.set(key, value);
  config.validate();
  return config;
}

/// Widths at both ends, dropped bits, no guard bits, no flag of notches, short and linear tables, 64-bit integers.
std::vector<Config> configurations() {
  return {Config{},
          config_of({{"significand_bits", 8},
                     {"align_guard_bits", 0},
                     {"attribute_slots", 1},
                     {"sqrt_degree", 1},
                     {"recip_degree", 1}}),
          config_of({{"significand_bits", 26}, {"align_guard_bits", 6}, {"attribute_slots", 8}}),
          config_of({{"significand_bits", 12},
                     {"quadratic_frac_bits", 16},
                     {"notch_exact", 0},
                     {"tile_log2", 2},
                     {"depth_bits", 8}}),
          config_of({{"viewport_bits", 14},
                     {"guard_bits", 1},
                     {"tile_log2", 4},
                     {"recip_segments_log2", 3},
                     {"sqrt_segments_log2", 3}})};
}

std::vector<const StageSuite*> stage_suites() {
  std::vector<const StageSuite*> list;
  for (const auto& suite : suites())
    if (const auto* stage = dynamic_cast<const StageSuite*>(suite.get())) list.push_back(stage);
  return list;
}

std::vector<Record> stimuli(const StageSuite& suite, const Config& config, std::uint64_t limit) {
  GenerateOptions options;
  options.config = config;
  options.limit = limit;
  StageSuite::Stimuli made = suite.stimuli(options);
  for (auto* more : {&made.random, &made.realistic}) std::ranges::move(*more, std::back_inserter(made.corner));
  return std::move(made.corner);
}

/// The largest share of undefined vectors. Snapping refuses most corner values of doubles; determinants of vertices in
/// one plane with the eye round in setup; corner vectors of depth lie at the limits of z and of the outputs.
double undefined_limit(const std::string& suite) {
  return suite == "snapping" ? 0.45 : suite == "setup" || suite == "depth" ? 0.1 : 0;
}

TEST(FloatEngine, AgreesWithTheModelOnEveryStage) {
  for (const Config& config : configurations())
    for (const StageSuite* suite : stage_suites()) {
      SCOPED_TRACE(suite->info().name + ", s = " + std::to_string(config.significand_bits));
      const auto stage = suite->stage(config);
      std::size_t undefined = 0, count = 0;
      for (const Record& stimulus : stimuli(*suite, config, 600)) {
        const VectorOutcome outcome = FloatStage(suite->info().name, *stage).check(stimulus, stage->respond(stimulus));
        ASSERT_NE(outcome.kind, Kind::mismatch) << outcome.difference << "\n" << stimulus.to_hex();
        undefined += outcome.kind == Kind::undefined;
        ++count;
      }
      EXPECT_GT(count, 300u);
      EXPECT_LE(static_cast<double>(undefined), undefined_limit(suite->info().name) * static_cast<double>(count));
    }
}

/// Damage to one field that the bound must show, as responses of which at least one is found.
std::vector<Record> damaged(const Record& response, const RecordField& f, const std::string& suite) {
  std::vector<Record> list;
  const auto add = [&](std::uint64_t value) {
    list.push_back(response);
    list.back().set(f, value);
  };
  const std::uint64_t value = response.get(f), one = std::uint64_t{1} << (f.width - 1);
  if (f.name.ends_with("sig")) {
    // n units are n/2 u to n u. A bound narrower than n u excludes one of both sides, wherever the response is in it.
    // That of a weight has up to 12.5u: three roots times a number, two products.
    const std::uint64_t n = suite == "weights" ? 16 : 8;
    if (value == 0) add(n);
    if (value >= one + n && value + n < 2 * one) add(value - n), add(value + n);
  } else if (suite == "depth" && f.width > 1) {
    add(value ^ one >> 3);  // truncated quotients differ in low bits
  } else {
    add(value ^ 1);
  }
  return list;
}

TEST(FloatEngine, FindsDamagedFields) {
  const Config config;
  for (const StageSuite* suite : stage_suites()) {
    const std::string& name = suite->info().name;
    SCOPED_TRACE(name);
    const auto stage = suite->stage(config);
    std::size_t tried = 0, found = 0;
    for (const Record& stimulus : stimuli(*suite, config, 150)) {
      const Record response = stage->respond(stimulus);
      if (FloatStage(name, *stage).check(stimulus, response).kind == Kind::undefined) continue;
      for (const RecordField& f : stage->response_layout().fields()) {
        const std::vector<Record> wrong = damaged(response, f, name);
        if (wrong.empty()) continue;
        ++tried;
        found += std::ranges::any_of(wrong, [&](const Record& record) {
          return FloatStage(name, *stage).check(stimulus, record).kind == Kind::mismatch;
        });
      }
    }
    EXPECT_GT(tried, 100u);
    // Sums that cancel have a wide bound, for their magnitude; so have differences to a base in the last places of long
    // double.
    const double least = name == "interpolation" ? 0.8 : name == "snapping" ? 0.98 : 1;
    EXPECT_GE(static_cast<double>(found), least * static_cast<double>(tried));
  }
}

TEST(FloatEngine, FindsADamagedBitOfAnyMask) {
  const Config config;
  const auto& suite = dynamic_cast<const StageSuite&>(find_suite("coverage"));
  const auto stage = suite.stage(config);
  std::size_t drawn = 0;
  for (const Record& stimulus : stimuli(suite, config, 60)) {
    const Record response = stage->respond(stimulus);
    for (int bit = 0; bit < response.bits(); ++bit) {
      Record wrong = response;
      drawn += wrong.get(bit, 1);
      wrong.set(bit, 1, wrong.get(bit, 1) ^ 1);
      ASSERT_EQ(FloatStage("coverage", *stage).check(stimulus, wrong).kind, Kind::mismatch) << bit;
    }
  }
  EXPECT_GT(drawn, 100u);
}

// ---- The machine ----

struct Drawn {
  SnappedQuad quad;
  std::vector<Fragment> fragments;
};

std::vector<Drawn> draw(const std::vector<SnappedQuad>& quads, const Config& config, const DrawState& state) {
  UntimedModel model(config, state, PixelEngine::plain);
  std::vector<Drawn> list;
  for (const SnappedQuad& quad : quads) {
    list.push_back({quad, {}});
    model.draw(quad, [&](std::span<const Fragment> drawn) {
      list.back().fragments.insert(list.back().fragments.end(), drawn.begin(), drawn.end());
    });
  }
  return list;
}

struct Count {
  std::size_t fragments = 0, undefined = 0, mismatches = 0;
  std::string first;
};

void check_all(Count& count, const std::vector<Drawn>& list, const Config& config, const DrawState& state) {
  for (const Drawn& drawn : list) {
    const FloatQuad quad(drawn.quad, config, state);
    for (const Fragment& fragment : drawn.fragments) {
      const VectorOutcome outcome = quad.check(fragment);
      ++count.fragments;
      count.undefined += outcome.kind == Kind::undefined;
      if (outcome.kind == Kind::mismatch && count.mismatches++ == 0) count.first = outcome.difference;
    }
  }
}

/// Configurations whose machine has a bound: ordinary vertices lose no bits of D and r².
std::vector<Config> machine_configurations() {
  return {Config{}, config_of({{"significand_bits", 8}, {"align_guard_bits", 0}, {"attribute_slots", 1}}),
          config_of({{"significand_bits", 26}, {"attribute_slots", 8}}),
          config_of({{"significand_bits", 14}, {"notch_exact", 0}}),
          config_of({{"viewport_bits", 14}, {"guard_bits", 1}, {"significand_bits", 12}})};
}

TEST(FloatEngine, AgreesWithTheMachine) {
  for (const Config& config : machine_configurations())
    for (const int variant : {0, 1, 2, 3}) {
      SCOPED_TRACE("s = " + std::to_string(config.significand_bits) + ", variant " + std::to_string(variant));
      DrawState state = tb::small_state(config);
      state.attributes = std::min(4, config.attribute_slots);
      if (variant == 1) state.perspective = false;
      if (variant == 2) state.cull = Cull::front, state.depth = false;
      if (variant == 3) state.znear = 0.375, state.zfar = 0.625, state.attributes = 1;
      Count count;
      check_all(count, draw(tb::random_quads(config, state, 11, 150), config, state), config, state);
      EXPECT_EQ(count.mismatches, 0u) << count.first;
      EXPECT_GT(count.fragments, 1000u);
      EXPECT_LT(count.undefined, count.fragments * 3 / 10);
    }
}

TEST(FloatEngine, AgreesWithTheMachineOnStressFamilies) {
  const Config config;
  const DrawState state = tb::small_state(config, 64);
  Count total;
  for (const golden::StressFamilyInfo& family : golden::stress_families()) {
    SCOPED_TRACE(family.name);
    std::vector<SnappedQuad> quads;
    for (const WindowQuad& quad : golden::make_stress(family.family, 40, 3, 1, 64, 64, 4))
      quads.push_back(snap_quad(quad, config, state));
    Count count;
    check_all(count, draw(quads, config, state), config, state);
    EXPECT_EQ(count.mismatches, 0u) << count.first;
    total.fragments += count.fragments;
    total.undefined += count.undefined;
  }
  EXPECT_GT(total.fragments, 5000u);
  EXPECT_LT(total.undefined, total.fragments * 3 / 10);
}

TEST(FloatEngine, KnowsWhatMustBeDrawn) {
  const Config config;
  DrawState state = tb::small_state(config);
  for (const bool depth : {true, false}) {
    state.depth = depth;
    std::size_t certain = 0, drawn = 0;
    for (const Drawn& each : draw(tb::random_quads(config, state, 23, 150), config, state)) {
      const FloatQuad quad(each.quad, config, state);
      std::set<std::pair<int, int>> pixels;
      for (const Fragment& g : each.fragments) pixels.emplace(g.x, g.y);
      drawn += pixels.size();
      for (int y = 0; y < state.scissor_y1; ++y)
        for (int x = 0; x < state.scissor_x1; ++x)
          if (quad.must_draw(x, y)) {
            ++certain;
            ASSERT_TRUE(pixels.contains({x, y})) << "quad " << each.quad.id << " (" << x << ", " << y << ")";
          }
    }
    EXPECT_GT(certain, drawn / (depth ? 4 : 2));
  }
}

TEST(FloatEngine, FindsDamagedFragments) {
  const Config config;
  DrawState state = tb::small_state(config);
  // One unit of attribute is 1; weights err by at most 2^-15.
  const std::int64_t step = std::int64_t{1} << (config.attribute_frac() - 4);
  std::size_t tried = 0, found_values = 0;
  for (const Drawn& drawn : draw(tb::random_quads(config, state, 17, 60), config, state)) {
    const FloatQuad quad(drawn.quad, config, state);
    for (const Fragment& fragment : drawn.fragments) {
      if (quad.check(fragment).kind != Kind::match) continue;
      const auto finds = [&](auto&& damage) {
        Fragment wrong = fragment;
        damage(wrong);
        return quad.check(wrong).kind == Kind::mismatch;
      };
      ASSERT_TRUE(finds([](Fragment& g) { g.front = !g.front; }));
      ASSERT_TRUE(finds([](Fragment& g) { g.flags ^= flag_homogeneous; }));
      ASSERT_TRUE(finds([](Fragment& g) { g.flags ^= flag_on_vertex; }));
      ASSERT_TRUE(finds([](Fragment& g) { g.flags ^= flag_tie; }));
      ASSERT_TRUE(finds([](Fragment& g) { g.flags ^= flag_notch; }));
      ASSERT_TRUE(finds([](Fragment& g) { g.x = static_cast<std::uint16_t>(g.x + 48); }));
      ++tried;
      found_values += finds([](Fragment& g) { g.depth ^= 1u << 20; });
      found_values += finds([&](Fragment& g) { g.attribute[3] += step; });
      found_values += finds([&](Fragment& g) { g.attribute[0] -= step; });
    }
  }
  EXPECT_GT(tried, 1000u);
  EXPECT_GE(found_values, 3 * tried * 95 / 100);
}

// ---- On the disk ----

// Pixels in a corner have no value in the paper's formulas; what they are and whose is compared all the same.
TEST(FloatEngine, UndefinedFragmentsAreComparedAsFarAsTheyGo) {
  const Config config;
  const DrawState state = tb::small_state(config);
  SnappedQuad quad = tb::random_quads(config, state, 1, 1).front();
  // A square with its corners on the pixel centres (10, 10) to (20, 20), front to the eye.
  const std::int32_t unit = std::int32_t{1} << config.frac(), at[4][2] = {{10, 20}, {20, 20}, {20, 10}, {10, 10}};
  for (std::size_t i = 0; i < 4; ++i) {
    quad.vertex[i].x = at[i][0] * unit;
    quad.vertex[i].y = at[i][1] * unit;
    quad.vertex[i].w = unit;
  }
  std::vector<Fragment> corners;
  UntimedModel(config, state).draw(quad, [&](std::span<const Fragment> drawn) {
    for (const Fragment& g : drawn)
      if ((g.flags & flag_on_vertex) != 0) corners.push_back(g);
  });
  ASSERT_FALSE(corners.empty());
  const FloatQuad real(quad, config, state);
  for (Fragment g : corners) {
    const VectorOutcome outcome = real.check(g);
    EXPECT_EQ(outcome.kind, Kind::undefined);
    EXPECT_TRUE(outcome.compared);
    g.front = !g.front;
    EXPECT_EQ(real.check(g).kind, Kind::mismatch);
  }
}

TEST(FloatEngine, VerifiesSets) {
  const std::filesystem::path directory =
      std::filesystem::path(testing::TempDir()) / ("float_engine_" + std::to_string(getpid()));
  std::vector<std::unique_ptr<Suite>> machine;
  add_machine_suites(machine);
  GenerateOptions options;
  options.limit = 600;
  const std::vector<const Suite*> list{stage_suites()[7], machine.front().get()};
  {
    SetWriter writer(directory, {1, 1, options.config, options.limit}, false);
    for (const Suite* suite : list) writer.add(suite->info(), [&](SuiteWriter& out) { suite->write(out, options); });
    writer.commit(false);
  }
  const SetReader set(directory);
  for (const Suite* suite : list) {
    SCOPED_TRACE(suite->info().name);
    const SuiteReader reader = set.suite(suite->info().name);
    const VerifyResult exact = suite->verify(reader, 1), result = verify_float(*suite, reader, 2);
    EXPECT_TRUE(exact.ok());
    EXPECT_TRUE(result.ok()) << result.first_difference;
    EXPECT_EQ(result.vectors, exact.vectors);
    EXPECT_LT(result.undefined, result.vectors * 6 / 10) << "the first random quads are small and odd";
  }
  EXPECT_THROW(verify_float(*list[0], set.suite(list[1]->info().name), 1), golden::InputError);

  // Fragments left out, then some twice.
  const SuiteReader whole = set.suite("machine");
  for (const bool twice : {false, true}) {
    const std::filesystem::path copy = directory.string() + (twice ? "_twice" : "_without");
    SetWriter writer(copy, set.info(), false);
    writer.add(whole.info(), [&](SuiteWriter& out) {
      out.set_count("vectors", whole.lines("response"));
      for (const char* role : {"states", "stalls", "stimulus", "beats", "response"}) {
        out.add_record(role, whole.layout(role));
        std::uint64_t line = 0;
        for (const Record& record : whole.read(role, 0, whole.lines(role))) {
          const bool chosen = role == std::string("response") && line++ % 50 == 49;
          for (int n = chosen ? (twice ? 2 : 0) : 1; n > 0; --n) out.write(role, record);
        }
      }
    });
    writer.commit(false);
    const VerifyResult result = verify_float(*list[1], SetReader(copy).suite("machine"), 1);
    EXPECT_GT(result.mismatches, 0u);
    EXPECT_LE(result.mismatches, whole.lines("response") / 50);
    EXPECT_NE(result.first_difference.find(twice ? "a second fragment" : "no fragment"), std::string::npos)
        << result.first_difference;
    std::filesystem::remove_all(copy);
  }
  std::filesystem::remove_all(directory);
}

}  // namespace
}  // namespace quadrille::vectors
