#include "golden/vectors/stage_suite.hpp"

#include "golden/io/error.hpp"
#include "golden/vectors/pipeline_tap.hpp"
#include "model/support/parallel.hpp"

#include <algorithm>
#include <unordered_set>

namespace quadrille::vectors {
namespace {

constexpr std::size_t random_a_unit = 500;

struct Plan {
  std::size_t corner, random_units, random_per_unit, tap_units, taps_per_unit;
};

/// Numbers of a level; a limit is shared by the three kinds.
Plan plan_of(const GenerateOptions& options) {
  const std::size_t scale = options.level == 2 ? 100 : 1;
  Plan plan{options.level == 2 ? std::size_t{200000} : std::size_t{4000}, 6 * scale, random_a_unit,
            6 * scale * tap_families(), SIZE_MAX};
  if (options.limit > 0) {
    const std::size_t share = std::max<std::size_t>(1, options.limit / 3);
    plan.corner = share;
    plan.random_units = 1;
    plan.random_per_unit = share;
    plan.tap_units = std::min(share, 6 * tap_families());
    plan.taps_per_unit = share / plan.tap_units;
  }
  return plan;
}

/// A suite's own random numbers, so that the selection of suites does not matter.
std::uint64_t suite_seed(const std::string& name, std::uint64_t seed) {
  std::uint64_t hash = 0xcbf29ce484222325u ^ seed;  // FNV-1a
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return hash;
}

/// Field values drawn alone, then made to fit together; neighbours in an array are sometimes equal.
Record random_record(const StageUnderTest& stage, const std::vector<FieldRange>& ranges, golden::Prng& prng) {
  const std::vector<RecordField>& fields = stage.stimulus_layout().fields();
  Record record(stage.stimulus_layout().bits());
  const bool alike = prng.chance(0.25);
  std::int64_t last = 0;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const bool repeat =
        i > 0 && fields[i].index >= 0 && fields[i].name == fields[i - 1].name && alike && prng.chance(0.7);
    if (!repeat) last = weighted(prng, ranges[i]);
    record.set(fields[i], static_cast<std::uint64_t>(last));
  }
  StageData data;
  stage.unpack_stimulus(record, data);
  if (prng.chance(stage.shaped())) stage.shape(prng, data);
  stage.constrain(data);
  return stage.pack_stimulus(data);
}

std::vector<FieldRange> ranges_of(const StageUnderTest& stage) {
  std::vector<FieldRange> ranges;
  for (const RecordField& f : stage.stimulus_layout().fields()) ranges.push_back(stage.range(f));
  return ranges;
}

/// Every corner value of every field over a few backgrounds, and the stage's own cases.
std::vector<Record> corner_records(const StageUnderTest& stage, std::uint64_t seed, std::size_t limit) {
  const std::vector<RecordField>& fields = stage.stimulus_layout().fields();
  const std::vector<FieldRange> ranges = ranges_of(stage);
  golden::Prng prng(seed, 1);
  std::vector<Record> special, single;
  std::unordered_set<std::string> seen;
  const auto keep = [&](std::vector<Record>& list, StageData& data) {
    stage.constrain(data);
    Record record = stage.pack_stimulus(data);
    if (seen.insert(record.to_hex()).second) list.push_back(std::move(record));
  };
  const auto keep_record = [&](std::vector<Record>& list, const Record& record) {
    StageData data;
    stage.unpack_stimulus(record, data);
    keep(list, data);
  };

  Record zero(stage.stimulus_layout().bits()), low = zero, high = zero;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (!ranges[i].contains(0)) zero.set(fields[i], static_cast<std::uint64_t>(ranges[i].lo));
    low.set(fields[i], static_cast<std::uint64_t>(ranges[i].lo));
    high.set(fields[i], static_cast<std::uint64_t>(ranges[i].hi));
  }
  for (const Record& record : {zero, low, high}) keep_record(special, record);
  stage.corners([&](const StageData& data) {
    StageData copy = data;
    keep(special, copy);
  });

  std::vector<Record> backgrounds{zero, high};
  for (int i = 0; i < 6; ++i) backgrounds.push_back(random_record(stage, ranges, prng));
  std::size_t next = 0;
  for (std::size_t i = 0; i < fields.size(); ++i)
    for (const std::int64_t value : corner_values(ranges[i]))
      for (const std::size_t background : {std::size_t{0}, 1 + next++ % (backgrounds.size() - 1)}) {
        Record record = backgrounds[background];
        record.set(fields[i], static_cast<std::uint64_t>(value));
        keep_record(single, record);
      }

  // Evenly thinned to the limit, the stage's own cases last.
  const auto thin = [](std::vector<Record>& list, std::size_t size) {
    if (list.size() <= size) return;
    std::vector<Record> kept;
    for (std::size_t i = 0; i < size; ++i) kept.push_back(std::move(list[i * list.size() / size]));
    list = std::move(kept);
  };
  thin(special, std::max(limit / 2, limit - std::min(limit, single.size())));
  thin(single, limit - special.size());
  std::move(single.begin(), single.end(), std::back_inserter(special));
  return special;
}

std::vector<Record> random_unit(const StageUnderTest& stage, const std::vector<FieldRange>& ranges, std::uint64_t seed,
                                std::size_t unit, std::size_t count) {
  golden::Prng prng(seed, 0x1000 + unit);
  std::vector<Record> records;
  for (std::size_t i = 0; i < count; ++i) records.push_back(random_record(stage, ranges, prng));
  return records;
}

std::vector<Record> realistic_unit(const StageUnderTest& stage, std::uint64_t seed, std::size_t unit,
                                   std::size_t most) {
  std::vector<Record> records;
  tap_pipeline(unit, seed, stage.source(), stage.config(), [&](const StageData& data) {
    if (records.size() < most) records.push_back(stage.pack_stimulus(data));
  });
  return records;
}

/// The stimuli in units that are independent of each other: corner, random, realistic.
class Units {
 public:
  Units(const StageUnderTest& stage, const std::string& name, const GenerateOptions& options)
      : stage_(stage),
        seed_(suite_seed(name, options.seed)),
        plan_(plan_of(options)),
        ranges_(ranges_of(stage)),
        corner_(corner_records(stage, seed_, plan_.corner)),
        corner_units_((corner_.size() + random_a_unit - 1) / random_a_unit) {}

  std::size_t corners() const { return corner_.size(); }
  std::size_t randoms() const { return plan_.random_units * plan_.random_per_unit; }
  std::size_t count() const { return corner_units_ + plan_.random_units + plan_.tap_units; }
  enum class Kind { corner, random, realistic };
  Kind kind(std::size_t unit) const {
    return unit < corner_units_                        ? Kind::corner
           : unit < corner_units_ + plan_.random_units ? Kind::random
                                                       : Kind::realistic;
  }
  std::vector<Record> make(std::size_t unit) const {
    if (unit < corner_units_) {
      const auto first = corner_.begin() + static_cast<std::ptrdiff_t>(unit * random_a_unit);
      return {first,
              first + static_cast<std::ptrdiff_t>(std::min(random_a_unit, corner_.size() - unit * random_a_unit))};
    }
    unit -= corner_units_;
    if (unit < plan_.random_units) return random_unit(stage_, ranges_, seed_, unit, plan_.random_per_unit);
    return realistic_unit(stage_, seed_, unit - plan_.random_units, plan_.taps_per_unit);
  }

 private:
  const StageUnderTest& stage_;
  std::uint64_t seed_;
  Plan plan_;
  std::vector<FieldRange> ranges_;
  std::vector<Record> corner_;
  std::size_t corner_units_;
};

}  // namespace

Record StageUnderTest::respond(const Record& stimulus) const {
  StageData data;
  unpack_stimulus(stimulus, data);
  run(data);
  return pack_response(data);
}

FieldRange StageUnderTest::range(const RecordField& f) const {
  // A significand has its top bit set, or the number is zero.
  if (f.name.ends_with("sig")) return {std::int64_t{1} << (f.width - 1), (std::int64_t{1} << f.width) - 1, true};
  if (f.width == 64) return {INT64_MIN, INT64_MAX};
  return f.is_signed ? FieldRange{-(std::int64_t{1} << (f.width - 1)), (std::int64_t{1} << (f.width - 1)) - 1}
                     : FieldRange{0, (std::int64_t{1} << f.width) - 1};
}

StimulusCheck::StimulusCheck(const StageUnderTest& stage) {
  for (const RecordField& field : stage.stimulus_layout().fields()) fields_.push_back({field, stage.range(field)});
}

std::string StimulusCheck::fault(const Record& stimulus) const {
  for (const auto& [field, range] : fields_) {
    const std::int64_t value = field.is_signed || field.width == 64 ? stimulus.get_signed(field)
                                                                    : static_cast<std::int64_t>(stimulus.get(field));
    // The exponent of a zero is 0, that of 1 + |cos| may be 1, whatever the others are.
    if (range.contains(value) || (field.name.ends_with("exp") && (value == 0 || value == 1))) continue;
    return field.label() + " = " + describe(stimulus, field) + "; the stage can be given " + std::to_string(range.lo) +
           ".." + std::to_string(range.hi) + (range.or_zero ? " or 0" : "");
  }
  return {};
}

void StageSuite::write(SuiteWriter& writer, const GenerateOptions& options) const {
  const auto stage = make_(options.config);
  writer.add_record("stimulus", stage->stimulus_layout());
  writer.add_record("response", stage->response_layout());
  const Units units(*stage, info_.name, options);
  struct Lines {
    std::vector<Record> stimulus, response;
  };
  std::uint64_t corner = 0, random = 0, realistic = 0;
  ordered_parallel(
      units.count(), options.threads,
      [&](std::size_t unit) {
        Lines lines{units.make(unit), {}};
        for (const Record& stimulus : lines.stimulus) lines.response.push_back(stage->respond(stimulus));
        return lines;
      },
      [&](std::size_t unit, const Lines& lines) {
        for (const Record& record : lines.stimulus) writer.write("stimulus", record);
        for (const Record& record : lines.response) writer.write("response", record);
        const Units::Kind kind = units.kind(unit);
        (kind == Units::Kind::corner   ? corner
         : kind == Units::Kind::random ? random
                                       : realistic) += lines.stimulus.size();
      });
  writer.set_count("vectors", corner + random + realistic);
  writer.set_count("corner", corner);
  writer.set_count("random", random);
  writer.set_count("realistic", realistic);
}

void StageSuite::require(const SuiteReader& reader) const {
  require_files(reader, {"stimulus", "response"}, {});
  GenerateOptions options;
  options.level = reader.set().level;
  options.seed = reader.set().seed;
  options.config = reader.set().config;
  options.limit = reader.set().limit;
  const auto stage = make_(options.config);
  const Units units(*stage, info_.name, options);
  // What the pipeline makes is the rest.
  const std::uint64_t lines = reader.lines("stimulus"), made = units.corners() + units.randoms();
  if (lines < made)
    throw golden::input_error(reader.manifest_file(), 0,
                              "the command makes at least " + std::to_string(made) + " vectors");
  require_counts(
      reader,
      {{"vectors", lines}, {"corner", units.corners()}, {"random", units.randoms()}, {"realistic", lines - made}});
}

VerifyResult StageSuite::check(const SuiteReader& reader, unsigned threads, const Check& check) const {
  const auto stage = make_(reader.set().config);
  require_layout(reader, "stimulus", stage->stimulus_layout());
  require_layout(reader, "response", stage->response_layout());
  const StimulusCheck legal(*stage);
  return check_vectors(reader, threads, [&](const Record& stimulus, const Record& response) {
    if (const std::string fault = legal.fault(stimulus); !fault.empty())
      return VectorOutcome{VectorOutcome::Kind::mismatch, "no stimulus of this stage: " + fault};
    return check(*stage, stimulus, response);
  });
}

VerifyResult StageSuite::verify(const SuiteReader& reader, unsigned threads) const {
  return check(reader, threads, [](const StageUnderTest& stage, const Record& stimulus, const Record& expected) {
    const Record actual = stage.respond(stimulus);
    if (actual == expected) return VectorOutcome{};
    return VectorOutcome{VectorOutcome::Kind::mismatch, first_difference(stage.response_layout(), expected, actual)};
  });
}

StageSuite::Stimuli StageSuite::stimuli(const GenerateOptions& options) const {
  const auto stage = make_(options.config);
  const Units units(*stage, info_.name, options);
  Stimuli all;
  for (std::size_t unit = 0; unit < units.count(); ++unit) {
    std::vector<Record> records = units.make(unit);
    std::vector<Record>& list = units.kind(unit) == Units::Kind::corner   ? all.corner
                                : units.kind(unit) == Units::Kind::random ? all.random
                                                                          : all.realistic;
    std::move(records.begin(), records.end(), std::back_inserter(list));
  }
  return all;
}

}  // namespace quadrille::vectors
