// The judges of golden vectors pass what the model writes, in every kind of configuration, and see any field damaged.
#include "tb/judge/verify_exact.hpp"

#include "golden/io/error.hpp"
#include "golden/io/test_support.hpp"
#include "golden/vectors/stage_suite.hpp"
#include "golden/vectors/table_suite.hpp"

#include <functional>

namespace quadrille::tb {
namespace {

using namespace vectors;

class VerifyExact : public golden::InDirectory {
 protected:
  SetReader generate(const std::string& name, const GenerateOptions& options) const {
    SetWriter writer(path(name), {1, 1, options.config, options.limit}, false);
    for (const auto& suite : suites()) writer.add(suite->info(), [&](SuiteWriter& out) { suite->write(out, options); });
    writer.commit(true);
    return SetReader(path(name));
  }

  /// A suite whose responses are changed, under right hashes; `change` says how often a line is written.
  SuiteReader with(const SuiteReader& whole, const std::function<int(std::uint64_t line, Record&)>& change) const {
    {
      SetWriter writer(path("damaged"), whole.set(), true);
      writer.add(whole.info(), [&](SuiteWriter& out) {
        out.set_count("vectors", whole.lines("response"));
        for (const std::string& role : whole.roles()) {
          out.add_record(role, whole.layout(role));
          std::uint64_t line = 0;
          for (Record record : whole.read(role, 0, whole.lines(role)))
            for (int n = role == "response" ? change(line++, record) : 1; n > 0; --n) out.write(role, record);
        }
      });
      writer.commit(false);
    }
    return SetReader(path("damaged")).suite(whole.info().name);
  }
};

GenerateOptions options_of(std::initializer_list<std::pair<const char*, int>> values, std::uint64_t limit) {
  GenerateOptions options;
  options.limit = limit;
  for (const auto& [key, value] : values) options.config.set(key, value);
  options.config.validate();
  return options;
}

// Widths at both ends, dropped bits, no guard bits, no flag of notches, short and linear tables, 64-bit integers.
TEST_F(VerifyExact, PassesWhatTheModelWrites) {
  int number = 0;
  for (const GenerateOptions& options :
       {options_of({}, 300),
        options_of({{"significand_bits", 8},
                    {"align_guard_bits", 0},
                    {"attribute_slots", 1},
                    {"sqrt_degree", 1},
                    {"recip_degree", 1}},
                   300),
        options_of({{"significand_bits", 26}, {"align_guard_bits", 6}, {"attribute_slots", 8}}, 300),
        options_of({{"significand_bits", 12},
                    {"quadratic_frac_bits", 16},
                    {"notch_exact", 0},
                    {"tile_log2", 2},
                    {"depth_bits", 8}},
                   300),
        options_of({{"viewport_bits", 14},
                    {"guard_bits", 1},
                    {"tile_log2", 4},
                    {"recip_segments_log2", 3},
                    {"sqrt_segments_log2", 3}},
                   300)}) {
    const SetReader set = generate("set" + std::to_string(number++), options);
    for (const auto& suite : suites()) {
      const std::string& name = suite->info().name;
      SCOPED_TRACE(name + ", s = " + std::to_string(options.config.significand_bits));
      const SuiteReader reader = set.suite(name);
      const VerifyResult result = verify_exact(*suite, reader, 2);
      EXPECT_TRUE(result.ok()) << result.first_difference;
      EXPECT_EQ(result.vectors, reader.lines("response"));
      // Doubles far apart; and without all bits of D and R² no bound speaks of a fragment's values.
      const bool all_bits = options.config.qdrop() == 0;
      if (name == "snapping")
        EXPECT_LT(result.undefined, result.vectors / 5);
      else
        EXPECT_EQ(result.undefined, suite->info().kind == "machine" && !all_bits ? result.vectors : 0) << "undefined";
    }
  }
}

/// A change of a field's least bit that no stage may let pass; of roots and reciprocals three units, which are two more
/// than the tables may err by.
std::uint64_t least_change(const std::string& suite, const RecordField& f) {
  return (suite == "sqrt" || suite == "reciprocal") && f.name == "sig" ? 4 : 1;
}

TEST_F(VerifyExact, SeesEveryFieldOfEveryStage) {
  const SetReader set = generate("set", options_of({{"attribute_slots", 2}}, 30));
  for (const auto& suite : suites()) {
    const std::string& name = suite->info().name;
    if (suite->info().kind == "machine") continue;
    const SuiteReader whole = set.suite(name);
    for (const RecordField& f : whole.layout("response").fields()) {
      SCOPED_TRACE(name + " " + f.label());
      // Of a quad that is rightly refused nothing else is looked at.
      std::uint64_t refused = 0;
      const VerifyResult result = verify_exact(*suite,
                                               with(whole,
                                                    [&](std::uint64_t, Record& record) {
                                                      if (name == "snapping" && f.name != "refused")
                                                        refused +=
                                                            record.get(whole.layout("response").field("refused"));
                                                      record.set(f, record.get(f) ^ least_change(name, f));
                                                      return 1;
                                                    }),
                                               1);
      EXPECT_EQ(result.mismatches + result.undefined + refused, result.vectors) << result.first_difference;
      EXPECT_GT(result.mismatches, result.vectors / 2);
      EXPECT_NE(result.first_difference.find("response.hex:"), std::string::npos) << result.first_difference;
    }
  }
}

TEST_F(VerifyExact, SeesADamagedBitOfAnyMask) {
  const SuiteReader whole = generate("set", options_of({}, 3)).suite("coverage");
  for (int bit = 0; bit < whole.layout("response").bits(); ++bit) {
    const VerifyResult result = verify_exact(find_suite("coverage"),
                                             with(whole,
                                                  [&](std::uint64_t, Record& record) {
                                                    record.set(bit, 1, record.get(bit, 1) ^ 1);
                                                    return 1;
                                                  }),
                                             1);
    ASSERT_EQ(result.mismatches, result.vectors) << bit;
  }
}

TEST_F(VerifyExact, SeesWrongFragments) {
  const SetReader set = generate("set", options_of({}, 600));
  const SuiteReader whole = set.suite("machine");
  const Suite& machine = find_suite("machine");
  const auto damaged = [&](const std::function<int(std::uint64_t, Record&)>& change) {
    return verify_exact(machine, with(whole, change), 1);
  };
  const std::uint64_t chosen = 5, every = 20, lines = whole.lines("response");
  for (const RecordField& f : whole.layout("response").fields()) {
    SCOPED_TRACE(f.label());
    // Values by a sixteenth, which is far beyond their bound.
    const int bit = f.name == "depth" ? 20 : f.name == "attr" ? 20 : 0;
    const auto flip = [&](Record& record) { record.set(f, record.get(f) ^ std::uint64_t{1} << bit); };
    const VerifyResult result = damaged([&](std::uint64_t line, Record& record) {
      if (line % every == chosen) flip(record);
      return 1;
    });
    if (f.name.starts_with("clock")) {
      EXPECT_TRUE(result.ok()) << result.first_difference;
      continue;
    }
    EXPECT_GE(result.mismatches, lines / every - 1);
    if (f.name == "draw") continue;  // the first to miss one
    EXPECT_NE(result.first_difference.find("response.hex:6: "), std::string::npos) << result.first_difference;
  }
  for (const int copies : {0, 2}) {
    const VerifyResult result =
        damaged([&](std::uint64_t line, Record&) { return line % every == chosen ? copies : 1; });
    EXPECT_GE(result.mismatches, lines / every - 1);
    EXPECT_NE(result.first_difference.find(copies == 0 ? "not drawn, but covered" : "drawn twice"), std::string::npos)
        << result.first_difference;
  }
}

TEST_F(VerifyExact, RefusesWhatItCannotJudge) {
  const SetReader set = generate("set", options_of({}, 3));
  const auto& sqrt = dynamic_cast<const StageSuite&>(find_suite("sqrt"));
  EXPECT_THROW(verify_exact(sqrt, set.suite("machine"), 1), golden::InputError);
  EXPECT_THROW(verify_exact(find_suite("sqrt_table"), set.suite("sqrt"), 1), golden::InputError);
  SuiteInfo info = sqrt.info();
  info.name = "cube_root";
  const StageSuite unknown(
      info, [](const Config& config) { return dynamic_cast<const StageSuite&>(find_suite("sqrt")).stage(config); });
  EXPECT_NE(golden::input_error_of([&] { verify_exact(unknown, set.suite("sqrt"), 1); }).find("suite cube_root: "),
            std::string::npos);
}

}  // namespace
}  // namespace quadrille::tb
