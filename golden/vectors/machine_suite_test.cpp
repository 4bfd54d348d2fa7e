// The machine's suites: clocks against the test bench's own runs, responses against the untimed model, damage found.
#include "golden/vectors/machine_suite.hpp"

#include "golden/io/error.hpp"
#include "golden/io/test_support.hpp"
#include "golden/scenes/random_quads.hpp"
#include "golden/vectors/machine_run.hpp"
#include "model/untimed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>

namespace quadrille::vectors {
namespace {

TEST(MachineRun, FragmentsAreThoseOfTheUntimedModel) {
  const Config config;
  const DrawState state = tb::small_state(config);
  const std::vector<SnappedQuad> quads = tb::random_quads(config, state, 5, 60);
  std::vector<Fragment> expected;
  UntimedModel model(config, state, PixelEngine::plain);
  for (const SnappedQuad& quad : quads)
    model.draw(quad,
               [&](std::span<const Fragment> drawn) { expected.insert(expected.end(), drawn.begin(), drawn.end()); });
  ASSERT_GT(expected.size(), 1000u);
  const std::vector<StallClock> stalls = make_stalls(3, 257);
  for (const std::span<const StallClock> pattern :
       {std::span<const StallClock>(), std::span<const StallClock>(stalls)}) {
    const std::vector<TimedFragment> run = run_machine(quads, config, state, pattern).fragments;
    ASSERT_EQ(run.size(), expected.size());
    std::uint32_t before = 0;
    for (std::size_t i = 0; i < run.size(); ++i) {
      ASSERT_EQ(run[i].fragment, expected[i]) << i;
      if (i > 0) {
        ASSERT_GT(run[i].clock, before);
      }
      before = run[i].clock;
      if (!pattern.empty()) {
        ASSERT_TRUE(pattern[run[i].clock % pattern.size()].ready) << "handed over in a stalled clock";
      }
    }
  }
}

TEST(MachineRun, ClocksOfTheBeats) {
  // An idle machine takes the four beats of a quad as they come: in clocks 0 to 3, or in the first four that offer.
  const Config config;
  const DrawState state = tb::small_state(config);
  const std::vector<SnappedQuad> quads = tb::random_quads(config, state, 7, 40);
  const std::vector<StallClock> stalls{{true, true},  {false, true}, {false, false}, {true, true},
                                       {true, false}, {false, true}, {true, true}};
  const std::vector<std::uint32_t> free = run_machine(quads, config, state, {}).taken;
  const std::vector<std::uint32_t> stalled = run_machine(quads, config, state, stalls).taken;
  ASSERT_EQ(free.size(), 4 * quads.size());
  ASSERT_EQ(stalled.size(), 4 * quads.size());
  EXPECT_EQ(std::vector(free.begin(), free.begin() + 4), (std::vector<std::uint32_t>{0, 1, 2, 3}));
  EXPECT_EQ(std::vector(stalled.begin(), stalled.begin() + 4), (std::vector<std::uint32_t>{0, 3, 4, 6}));
  for (std::size_t i = 1; i < free.size(); ++i) {
    ASSERT_GT(free[i], free[i - 1]);
    ASSERT_GT(stalled[i], stalled[i - 1]);
    // Between two beats there is a clock that offered the second.
    bool offered = false;
    for (std::uint32_t clock = stalled[i - 1] + 1; clock <= stalled[i]; ++clock)
      offered = offered || stalls[clock % stalls.size()].offer;
    ASSERT_TRUE(offered) << i;
  }
  // The machine holds few quads, so a later beat waits for an earlier quad.
  EXPECT_GT(free.back(), free.size());
}

TEST(MachineRun, StallsStallBothSides) {
  const std::vector<StallClock> stalls = make_stalls(1, 1024);
  const auto offers = std::ranges::count(stalls, true, &StallClock::offer);
  const auto takes = std::ranges::count(stalls, true, &StallClock::ready);
  EXPECT_TRUE(stalls.front().offer);
  EXPECT_GT(offers, 300);
  EXPECT_LT(offers, 1000);
  EXPECT_GT(takes, 300);
  EXPECT_LT(takes, 1000);
}

TEST(MachineSuites, OneForTheMachineAndOneForEachFamily) {
  std::vector<std::unique_ptr<Suite>> suites;
  add_machine_suites(suites);
  ASSERT_EQ(suites.size(), 23u);
  std::set<std::string> names;
  for (const auto& suite : suites) {
    names.insert(suite->info().name);
    EXPECT_EQ(suite->info().kind, "machine");
  }
  EXPECT_EQ(names.size(), 23u);
  EXPECT_TRUE(names.contains("machine"));
  EXPECT_TRUE(names.contains("stress_bowtie"));
}

class MachineSet : public golden::InDirectory {
 protected:
  /// A set of one suite; its reader.
  SuiteReader generate(const std::string& name, const GenerateOptions& options) const {
    SetWriter writer(path(name), {options.level, options.seed, options.config, options.limit}, false);
    writer.add(find_suite(name).info(), [&](SuiteWriter& out) { find_suite(name).write(out, options); });
    writer.commit(false);
    return SetReader(path(name)).suite(name);
  }
};

TEST_F(MachineSet, NoMoreQuadsThanIds) {
  GenerateOptions options;
  options.config.set("quad_id_bits", 8);
  for (const char* name : {"machine", "stress_tiny"}) {
    const SuiteReader reader = generate(name, options);
    EXPECT_TRUE(find_suite(name).verify(reader, 2).ok());
    std::size_t most = 0;
    for (const MachineDraw& draw : read_draws(reader)) most = std::max(most, draw.quads.size());
    EXPECT_LE(most, 256u);
    if (name == std::string("stress_tiny")) {
      EXPECT_EQ(most, 256u) << "3000 fragments take more quads than that";
    }
  }
}

// With the depths of tiles a draw more; every draw begins when their places are wiped, with nothing hidden.
TEST_F(MachineSet, HiddenTiles) {
  GenerateOptions options;
  options.config.set("hierarchical_z_bits", 12);
  options.config.set("hierarchical_z_tiles_log2", 6);
  const SuiteReader reader = generate("machine", options);
  EXPECT_TRUE(find_suite("machine").verify(reader, 2).ok());
  const std::vector<MachineDraw> draws = read_draws(reader);
  ASSERT_EQ(draws.size(), 12u);
  EXPECT_EQ(draws.back().state.skip, skip_default | skip_hidden);
  UntimedModel model(options.config, draws.back().state);
  for (const SnappedQuad& quad : draws.back().quads) model.draw(quad, [](std::span<const Fragment>) {});
  EXPECT_GT(model.stats().tiles_hidden, 0u);
  EXPECT_EQ(run_machine(draws.back().quads, options.config, draws.back().state, {}).taken.front(), 0u);
}

TEST_F(MachineSet, EvenTheSmallestHasAFragment) {
  GenerateOptions options;
  options.limit = 1;
  for (const auto& suite : suites()) {
    if (suite->info().kind != "machine") continue;
    const SuiteReader reader = generate(suite->info().name, options);
    EXPECT_GT(reader.lines("response"), 0u) << suite->info().name;
    EXPECT_TRUE(suite->verify(reader, 2).ok()) << suite->info().name;
  }
}

/// A copy of a suite in which a record of a role, by its line, is changed, under right hashes.
SuiteReader with_record(const SuiteReader& whole, const std::string& directory, const GenerateOptions& options,
                        const std::string& changed, std::uint64_t changed_line,
                        const std::function<void(Record&, const RecordLayout&)>& change) {
  {
    SetWriter writer(directory, {1, 1, options.config, options.limit}, false);
    writer.add(whole.info(), [&](SuiteWriter& out) {
      out.set_count("vectors", whole.lines("response"));
      for (const std::string& role : whole.roles()) {
        out.add_record(role, whole.layout(role));
        std::uint64_t line = 0;
        for (Record record : whole.read(role, 0, whole.lines(role))) {
          if (role == changed && ++line == changed_line) change(record, whole.layout(role));
          out.write(role, record);
        }
      }
    });
    writer.commit(false);
  }
  return SetReader(directory).suite(whole.info().name);
}

TEST_F(MachineSet, WrongBeatsAreFound) {
  GenerateOptions options;
  options.limit = 40;
  const SuiteReader whole = generate("stress_bowtie", options);
  for (const char* field : {"draw", "clock", "clock_stalled"}) {
    SCOPED_TRACE(field);
    const SuiteReader wrong =
        with_record(whole, path(field), options, "beats", 3, [&](Record& record, const RecordLayout& layout) {
          record.set(layout.field(field), record.get(layout.field(field)) ^ 1);
        });
    const VerifyResult result = find_suite("stress_bowtie").verify(wrong, 1);
    EXPECT_EQ(result.mismatches, 1u);
    EXPECT_NE(result.first_difference.find(std::string("beats.hex:3: ") + field), std::string::npos)
        << result.first_difference;
  }
}

// States of somebody else's set are those of the model's check, and a stage is given nothing out of range.
TEST_F(MachineSet, StatesAndStimuliThatNoMachineHasAreNamed) {
  GenerateOptions options;
  options.limit = 40;
  const SuiteReader machine = generate("machine", options), depth = generate("depth", options);
  const auto with_field = [&](const SuiteReader& whole, const char* role, const char* field, std::uint64_t value) {
    return with_record(whole, path(std::string(role) + field), options, role, 1,
                       [&](Record& record, const RecordLayout& layout) { record.set(layout.field(field), value); });
  };
  const auto states = [&](const char* field, std::uint64_t value) {
    try {
      read_draws(with_field(machine, "states", field, value));
    } catch (const golden::InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  for (const auto& [field, value, words] : {std::tuple{"attributes", 9u, "attributes 9: from 0 to 4 (attribute_slots)"},
                                            {"cull", 3u, "cull 3: 0 (none), 1 (front) or 2 (back)"},
                                            {"scissor_x0", 4000u, "X0 must not exceed X1"},
                                            {"scissor_y1", 5000u, "from 1x1 to 4096x4096 (viewport_bits)"},
                                            {"zfar", (1u << 24) + 1, "0 <= znear <= zfar <= 1"},
                                            {"skip", 64u, "63"}}) {
    const std::string error = states(field, value);
    EXPECT_NE(error.find("states.hex:1: draw state: "), std::string::npos) << field << ": " << error;
    EXPECT_NE(error.find(words), std::string::npos) << error;
  }
  const SuiteReader wrong = with_field(depth, "stimulus", "attributes", 15);
  const VerifyResult result = find_suite("depth").verify(wrong, 1);
  EXPECT_EQ(result.mismatches, 1u);
  EXPECT_NE(result.first_difference.find("attributes = 0xf (15); the stage can be given 0..4"), std::string::npos)
      << result.first_difference;
}

}  // namespace
}  // namespace quadrille::vectors
