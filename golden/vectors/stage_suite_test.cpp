// The stage suites: where their bits are, what their stimuli hold, and responses against independent evaluation.
#include "golden/vectors/patterns.hpp"
#include "golden/vectors/stage_suite_test_support.hpp"

#include <limits>
#include <map>
#include <set>

namespace {

std::vector<std::string> stage_names() {
  std::vector<std::string> names;
  for (const auto& suite : suites())
    if (dynamic_cast<const StageSuite*>(suite.get()) != nullptr) names.push_back(suite->info().name);
  return names;
}

// ---- Places of the bits ----

// Widths of golden/vectors/README.md for the default configuration, added up by hand: T = 32, W = 17, V = 12, TC = 10,
// VAL = QVAL = 63, GRAD = QGRAD = 48, QCURV = 32, LENGTH2 = 64, S = 18, E = 12, PE = 9, N = 4, DB = 24, TL = 3,
// AO = 32.
TEST(StageSuites, WidthsByHand) {
  const std::map<std::string, std::pair<int, int>> bits{
      {"snapping", {1 + 16 * 64 + 16 * 64, 1 + 4 * (2 * 32 + 17 + 9 + 18 + 28) + 12 * 28 + 4 * 32 + 25 + 26 + 26}},
      {"setup", {8 * 32 + 4 * 17 + 4 * 13, 3 + 4 * 10 + 2 + 4 + 6 * (63 + 48 + 48) + 6 * 64}},
      {"tile_context", {1 + 8 * 32 + 4 * 17 + 20, 10 * (63 + 48 + 48 + 32)}},
      {"coverage", {2 + 4 * 13 + 20 + 5 * (63 + 48 + 48) + 4, 3 * 64}},
      {"forward_difference", {3 + 3 + 1 + 6 * (63 + 48 + 48) + 10 * (63 + 48 + 48 + 32) + 6 * 64, 16 * 63}},
      {"normalise", {16 * 63, 4 + 12 * 31 + 4 * 30}},
      {"sqrt", {4 * 30, 4 * 30}},
      {"reciprocal", {31, 31}},
      {"ratios", {6 * 30 + 6 * 31 + 4 * 30, 12 * 30}},
      {"weights", {8 + 6 + 4 + 4 * 28 + 4 * 30 + 12 * 30, 4 * 30}},
      {"interpolation", {4 * 30 + 24 * 28, 7 * 31}},
      {"depth", {1 + 25 + 25 + 4 + 1 + 4 * 32 + 25 + 26 + 26 + 7 * 31, 1 + 1 + 25 + 4 * 32}},
  };
  ASSERT_EQ(stage_names().size(), bits.size());
  for (const auto& [name, widths] : bits) {
    const auto stage = stage_suite(name).stage(Config{});
    EXPECT_EQ(stage->stimulus_layout().bits(), widths.first) << name;
    EXPECT_EQ(stage->response_layout().bits(), widths.second) << name;
  }
}

TEST(StageSuites, StimulusFieldsInTheStatedOrder) {
  const auto order = [](const std::string& name) {
    const auto stage = stage_suite(name).stage(Config{});
    std::string text;
    for (const RecordField& f : stage->stimulus_layout().fields())
      if (f.index <= 0) text += (text.empty() ? "" : " ") + f.name;
    return text;
  };
  EXPECT_EQ(order("snapping"), "perspective x y z w attr");
  EXPECT_EQ(order("setup"), "x y w scissor_x0 scissor_y0 scissor_x1 scissor_y1");
  EXPECT_EQ(order("tile_context"), "homogeneous x y w column row");
  EXPECT_EQ(order("coverage"),
            "cull scissor_x0 scissor_y0 scissor_x1 scissor_y1 tile_x tile_y lin_value lin_gx lin_gy visible");
  EXPECT_EQ(order("forward_difference"),
            "row dx homogeneous lin_value lin_gx lin_gy quad_value quad_gx quad_gy quad_q length2");
  EXPECT_EQ(order("normalise"), "a d r2");
  EXPECT_EQ(order("reciprocal"), "neg exp sig");
  EXPECT_EQ(order("ratios"), "a_exp a_sig d_neg d_exp d_sig root_exp root_sig");
  EXPECT_EQ(order("weights"), "a_sign d_negative corner k_neg k_exp k_sig root_exp root_sig u_exp u_sig v_exp v_sig");
  EXPECT_EQ(order("interpolation"),
            "m_exp m_sig k_neg k_exp k_sig w_neg w_exp w_sig z_neg z_exp z_sig b_neg b_exp b_sig");
  EXPECT_EQ(order("depth"),
            "depth_on znear zfar attributes hull base_attr base_depth depth_low depth_high attr_neg attr_exp attr_sig "
            "z_neg z_exp z_sig den_k_neg den_k_exp den_k_sig den_w_neg den_w_exp den_w_sig");
}

// ---- Stimuli ----

// constrain() is the contract: what it would change is not legal.
TEST(StageSuites, StimuliKeepTheirContract) {
  for (const Config& config : {Config{}, small_config()})
    for (const std::string& name : stage_names()) {
      SCOPED_TRACE(name);
      const auto stage = stage_suite(name).stage(config);
      GenerateOptions options;
      options.config = config;
      options.limit = 900;
      const StageSuite::Stimuli stimuli = stage_suite(name).stimuli(options);
      for (const auto* list : {&stimuli.corner, &stimuli.random, &stimuli.realistic})
        for (const Record& stimulus : *list) {
          for (const RecordField& f : stage->stimulus_layout().fields()) {
            const std::int64_t v =
                f.is_signed || f.width == 64 ? stimulus.get_signed(f) : static_cast<std::int64_t>(stimulus.get(f));
            const FieldRange range = stage->range(f);
            const bool zero = f.name.ends_with("exp") && v == 0;                  // of a zero
            const bool one = (f.name == "n_exp" || f.name == "d_exp") && v == 1;  // 1 + |cos| = 2
            ASSERT_TRUE(range.contains(v) || zero || one) << f.label() << " = " << v << " in " << stimulus.to_hex();
          }
          if (list == &stimuli.realistic && config.qdrop() > 0) continue;  // r² and A are rounded apart there
          StageData data;
          stage->unpack_stimulus(stimulus, data);
          ASSERT_EQ(stage->pack_stimulus(data), stimulus);
          stage->constrain(data);
          ASSERT_EQ(stage->pack_stimulus(data).to_hex(), stimulus.to_hex());
        }
    }
}

/// A stimulus from elsewhere with one field out of its range is named, not computed: 15 attributes would index past an
/// array of eight.
TEST(StageSuites, StimuliOutOfRangeAreNamed) {
  std::size_t refused = 0;
  for (const std::string& name : stage_names()) {
    SCOPED_TRACE(name);
    const auto stage = stage_suite(name).stage(Config{});
    const StimulusCheck check(*stage);
    GenerateOptions options;
    options.limit = 300;
    const StageSuite::Stimuli stimuli = stage_suite(name).stimuli(options);
    for (const auto* list : {&stimuli.corner, &stimuli.random, &stimuli.realistic})
      for (const Record& stimulus : *list) ASSERT_EQ(check.fault(stimulus), "") << stimulus.to_hex();
    for (const RecordField& f : stage->stimulus_layout().fields()) {
      const FieldRange range = stage->range(f);
      const int bits = f.is_signed ? f.width - 1 : f.width;
      if (bits >= 63 || range.hi >= (std::int64_t{1} << bits) - 1) continue;  // the field holds nothing larger
      if (f.name.ends_with("exp") && range.hi < 1) continue;                  // 0 and 1 are always accepted
      Record stimulus = stimuli.corner.front();
      stimulus.set(f, static_cast<std::uint64_t>(range.hi + 1));
      EXPECT_EQ(check.fault(stimulus).find(f.label() + " = "), 0u) << f.label() << ": " << check.fault(stimulus);
      ++refused;
    }
  }
  EXPECT_GT(refused, 20u);
  const auto depth = stage_suite("depth").stage(Config{});
  Record stimulus = stage_suite("depth").stimuli({}).corner.front();
  stimulus.set(depth->stimulus_layout().field("attributes", -1), 15);
  EXPECT_EQ(StimulusCheck(*depth).fault(stimulus), "attributes = 0xf (15); the stage can be given 0..4");
}

TEST(StageSuites, CornersOfEveryFieldOccur) {
  for (const std::string& name : stage_names()) {
    SCOPED_TRACE(name);
    if (name == "ratios" || name == "coverage" || name == "forward_difference") continue;  // ends do not fit together
    const auto stage = stage_suite(name).stage(Config{});
    const StageSuite::Stimuli stimuli = stage_suite(name).stimuli({});
    std::map<std::string, std::set<std::int64_t>> seen;
    for (const auto* list : {&stimuli.corner, &stimuli.random, &stimuli.realistic})
      for (const Record& stimulus : *list)
        for (const RecordField& f : stage->stimulus_layout().fields())
          seen[f.label()].insert(f.is_signed || f.width == 64 ? stimulus.get_signed(f)
                                                              : static_cast<std::int64_t>(stimulus.get(f)));
    for (const RecordField& f : stage->stimulus_layout().fields()) {
      const FieldRange range = stage->range(f);
      EXPECT_TRUE(seen[f.label()].contains(range.lo)) << f.label() << " never is " << range.lo;
      EXPECT_TRUE(seen[f.label()].contains(range.hi)) << f.label() << " never is " << range.hi;
    }
  }
}

class StageSets : public golden::InDirectory {
 protected:
  std::string generate(const std::string& name, std::uint64_t seed, unsigned threads) const {
    GenerateOptions options;
    options.seed = seed;
    options.threads = threads;
    options.limit = 200;
    SetWriter writer(path(name), {1, seed, options.config, options.limit}, false);
    for (const std::string& suite : stage_names())
      writer.add(find_suite(suite).info(), [&](SuiteWriter& out) { find_suite(suite).write(out, options); });
    writer.commit(true);
    return read(path(name + "/manifest.json"));  // holds the hashes of everything
  }
};

TEST_F(StageSets, BytesDependOnTheSeedAndNotOnThreads) {
  const std::string one = generate("one", 1, 1);
  EXPECT_EQ(generate("three", 1, 3), one);
  EXPECT_NE(generate("two", 2, 1), one);
  for (const std::string& name : stage_names()) {
    const SuiteReader a = SetReader(path("one")).suite(name), b = SetReader(path("two")).suite(name);
    EXPECT_NE(a.manifest()["files"]["stimulus.hex"]["sha256"], b.manifest()["files"]["stimulus.hex"]["sha256"]) << name;
    EXPECT_TRUE(find_suite(name).verify(a, 2).ok());
    EXPECT_EQ(a.manifest()["counts"]["vectors"], a.lines("stimulus"));
  }
}

// ---- Responses against evaluation of another kind ----

// The widest range whose size fits 64 bits: every one of 256 equal parts of it is reached, and its ends stay rare.
TEST(StageSuites, WeightedNumbersReachTheWholeOfAWideRange) {
  const std::int64_t lo = std::numeric_limits<std::int64_t>::min() + 1, hi = -lo;
  golden::Prng prng(1);
  std::set<std::int64_t> parts;
  int at_the_low_end = 0;
  const int draws = 20000;
  for (int i = 0; i < draws; ++i) {
    const std::int64_t v = weighted(prng, {lo, hi});
    ASSERT_GE(v, lo);
    parts.insert(v >> 56);
    at_the_low_end += v <= lo + 1;
  }
  EXPECT_EQ(parts.size(), 256u);
  EXPECT_LT(at_the_low_end, draws / 20);
}

}  // namespace
