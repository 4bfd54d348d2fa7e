// quadrille stress: errors against a knob, towards every special case.
#include "golden/scenes/stress.hpp"
#include "golden/io/atomic_file.hpp"
#include "golden/io/json_report.hpp"
#include "golden/io/text_input.hpp"
#include "golden/scenes/approach.hpp"
#include "model/support/parallel.hpp"
#include "tb/commands/commands.hpp"
#include "tb/judge/knob_errors.hpp"
#include "tb/options/command_line.hpp"
#include "tb/options/input.hpp"
#include "tb/options/shard.hpp"
#include "tb/options/written_file.hpp"
#include "tb/studies/stress_report.hpp"
#include "tb/studies/stress_search.hpp"
#include "tb/studies/studies.hpp"
#include "tb/support/choices.hpp"
#include "tb/support/errors.hpp"
#include "tb/support/output.hpp"
#include "tb/support/progress.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>

namespace quadrille::tb {
namespace {

struct StressOptions {
  CommonOptions common;
  std::string families, engines = "model,float,fp32", csv;
  std::uint64_t count = 24;
  ShardOptions shards;
  StressSearchOptions search;
};

constexpr const char* stress_size = "64x64";
constexpr int drawn_attributes = 2;
constexpr int knob_octaves = 6;  ///< of a family's knob, to either side of 1

/// A name of --families: a stress family or an approach.
struct KnobSeries {
  std::string name, kind, special, knob;
  int exponent = 1;  ///< knob k is 2^(exponent k) of what `knob` says
  std::optional<golden::StressFamily> family;
  const golden::Approach* approach = nullptr;
  DrawState state;
};

struct KnobStep {
  std::size_t series = 0;
  int knob = 0;  ///< family: log2 of the knob; approach: the knob
  int side = 1;  ///< approach: 0 is the special case
};

/// Files, text, faults and the exit status.
int write_report(const StressOptions& options, const nlohmann::ordered_json& report) {
  const CommonOptions& common = options.common;
  if (!options.csv.empty())
    golden::write_file(options.csv, stress_csv(report), golden::AtomicFile::Dash::standard_output);
  if (!common.json.empty()) golden::save_json(common.json, report);
  if (std::FILE* text = common.text(); text && options.csv != "-") print_stress(text, report);
  for (const nlohmann::ordered_json& fault : report["faults"])
    std::fprintf(stderr, "quadrille: %s\n", fault.get<std::string>().c_str());
  return report["ok"].get<bool>() ? exit_ok : exit_mismatch;
}

int merge_reports(const StressOptions& options) {
  check_outputs({options.csv, options.common.json}, options.shards.merge);
  return write_report(options, merge_stress(options.shards.merge));
}

class StressCommand {
 public:
  StressCommand(const StressOptions& options, const std::vector<std::string>& arguments)
      : options_(options),
        common_(options.common),
        arguments_(without_outputs(arguments)),
        config_(common_.config()),
        shard_(Shard::parse(options.shards.shard)) {
    if (config_.qdrop() != 0) throw UsageError("stress: no bound with quadratic_frac_bits that drops bits of D and R²");
    choose_bodies();
    choose_series();
  }

  int run() {
    check_outputs({options_.csv, common_.json}, {common_.config_file});
    measure();
    return write_report(options_, report());
  }

 private:
  void choose_bodies() {
    std::vector<std::string> all;
    for (const EngineKind body : knob_engines) all.emplace_back(engine_info(body).name);
    bodies_ = 1u << static_cast<unsigned>(EngineKind::model);
    for (const std::string& name : names_in_list(options_.engines))
      bodies_ |= 1u << static_cast<unsigned>(knob_engines[choose("engine", name, all)]);
  }

  bool has(EngineKind body) const { return (bodies_ >> static_cast<unsigned>(body) & 1) != 0; }

  void choose_series() {
    std::vector<std::string> all = stress_names();
    for (const golden::Approach& approach : golden::approaches()) all.emplace_back(approach.name);
    const std::vector<std::string> wanted = options_.families.empty() ? all : names_in_list(options_.families);
    const auto [width, height] = common_.viewport(config_);
    for (const std::string& name : wanted) {
      choose("family", name, all);
      if (std::ranges::count(wanted, name) > 1) throw UsageError("--families: " + name + " is named twice");
    }
    if (shard_.count > wanted.size())
      throw UsageError("--shard " + options_.shards.shard + ": more shards than families (" +
                       std::to_string(wanted.size()) + ")");
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      if (!shard_.holds(i)) continue;
      const std::string& name = wanted[i];
      KnobSeries s;
      s.name = name;
      s.approach = golden::find_approach(name);
      if (s.approach) {
        s.kind = "approach";
        s.special = s.approach->special;
        s.knob = s.approach->knob;
        // As approach.hpp says of the name of the knob: a distance of 2^-k, but where it begins with what it is.
        if (constexpr std::string_view length = "2^knob is the "; s.knob.starts_with(length))
          s.knob.erase(0, length.size());
        else
          s.exponent = -1;
        s.state.width = s.approach->width;
        s.state.height = s.approach->height;
        if (s.state.width > 1 << config_.viewport_bits)
          throw UsageError(name + " is " + std::to_string(s.state.width) +
                           " pixels wide, too many for viewport_bits = " + std::to_string(config_.viewport_bits) +
                           "; leave it out with --families");
        if (s.approach->attribute >= std::ldexp(1.0, config_.attribute_int_bits))
          throw UsageError(name + " has attributes up to " + std::to_string(static_cast<int>(s.approach->attribute)) +
                           ", too large for attribute_int_bits = " + std::to_string(config_.attribute_int_bits) +
                           "; leave it out with --families");
      } else {
        s.family = golden::parse_stress_family(name);
        const golden::StressFamilyInfo& info = golden::stress_families()[static_cast<std::size_t>(*s.family)];
        s.kind = "family";
        s.special = info.stresses;
        s.knob = info.knob;
        s.state.width = width;
        s.state.height = height;
      }
      s.state.scissor_x1 = s.state.width;
      s.state.scissor_y1 = s.state.height;
      series_.push_back(s);
      add_steps(series_.size() - 1);
    }
  }

  void add_steps(std::size_t index) {
    const KnobSeries& s = series_[index];
    if (s.family) {
      const int reach = s.knob == golden::no_stress_knob ? 0 : knob_octaves;
      for (int knob = -reach; knob <= reach; ++knob) steps_.push_back({index, knob, 1});
      return;
    }
    for (const int side : {-1, 1})
      for (int knob = s.approach->first; knob <= s.approach->last; ++knob) {
        if (side < 0 && !s.approach->both_sides) continue;
        steps_.push_back({index, knob, side});
      }
    if (s.approach->limit) steps_.push_back({index, s.approach->last, 0});
  }

  std::vector<golden::ApproachPlace> places_of(const KnobStep& step) const {
    const KnobSeries& s = series_[step.series];
    if (!s.approach) return {};
    return golden::approach_places(*s.approach, step.knob, step.side, options_.count, common_.seed);
  }

  std::vector<WindowQuad> quads_of(const KnobStep& step) const {
    const KnobSeries& s = series_[step.series];
    if (s.approach)
      return golden::make_approach(*s.approach, step.knob, step.side, options_.count, common_.seed, drawn_attributes);
    const bool one_step = s.knob == golden::no_stress_knob;
    return golden::make_stress_without_weights(*s.family, options_.count * (one_step ? 2 * knob_octaves + 1 : 1),
                                               common_.seed, s.state.width, s.state.height, drawn_attributes,
                                               std::ldexp(1.0, step.knob));
  }

  /// Simulators and OpenGL contexts stay in this thread.
  unsigned threads() const {
    const bool alone = has(EngineKind::shader) || has(EngineKind::rtl);
    return alone ? 1 : common_.thread_count();
  }

  void measure() {
    Progress progress("stress", steps_.size(), common_.show_progress());
    ordered_parallel(
        steps_.size(), threads(),
        [&](std::size_t i) {
          const KnobStep& step = steps_[i];
          KnobErrors errors = measure_knob(quads_of(step), places_of(step), drawn_attributes, config_,
                                           series_[step.series].state, bodies_);
          if (!jumps(step)) errors.model = {};
          return errors;
        },
        [&](std::size_t i, KnobErrors&& errors) {
          results_.push_back(std::move(errors));
          if (i + 1 == steps_.size() || steps_[i + 1].series != steps_[i].series) judge(steps_[i].series);
          progress.set(i + 1, series_[steps_[i].series].name);
        });
  }

  /// On the way to a special case, where the error must not jump.
  bool jumps(const KnobStep& step) const {
    const golden::Approach* approach = series_[step.series].approach;
    return approach && (approach->limit || approach->both_sides);
  }

  struct Summary {
    PerEngine<BodyErrors> body;
    PerEngine<std::array<std::size_t, output_names.size()>> worst{};  ///< the step of each largest error
    PerEngine<std::size_t> lost{};                                    ///< and of the first pixel lost
    std::optional<ErrorJump> jump;                                    ///< of approaches
    bool between_sides = false;  ///< at the same distance: there is no special case, or it draws nothing
    std::vector<std::string> faults;
  };

  /// Of the series whose steps are done; afterwards the errors of their single pixels are not kept.
  void judge(std::size_t index) {
    Summary sum;
    const KnobSeries& s = series_[index];
    const auto fault = [&](const std::string& what) { sum.faults.push_back(s.name + ": " + what); };
    std::size_t first = 0;
    while (steps_[first].series != index) ++first;
    const std::span<KnobErrors> results = std::span(results_).subspan(first);
    for (std::size_t i = first; i < results_.size(); ++i) {
      const KnobErrors& r = results_[i];
      for (const EngineKind b : knob_engines) {
        for (std::size_t o = 0; o < output_names.size(); ++o)
          if (r.body[b].largest[o].part > sum.body[b].largest[o].part) sum.worst[b][o] = i;
        if (sum.body[b].pixels_lost() == 0) sum.lost[b] = i;
        sum.body[b].merge(r.body[b]);
      }
      if (r.verdict.faults() != 0) {
        const std::string what = r.verdict.first.any ? r.verdict.first.text : "beyond the bound";
        fault(place(steps_[i]) + ": " + std::to_string(r.verdict.faults()) + " faults, " + what);
      }
      if (!r.difference.empty()) fault(place(steps_[i]) + ": " + r.difference);
      // Without such a pixel the step says nothing about the case. That the case itself has none may be what it is.
      if (s.approach && steps_[i].side != 0 && r.near_case[EngineKind::model].fragments == 0)
        fault(place(steps_[i]) + ": no fragment near the special case of any quad; give more --count than " +
              std::to_string(options_.count));
    }
    const BodyErrors& model = sum.body[EngineKind::model];
    if (model.fragments == 0) fault("nothing was drawn");
    for (std::size_t o = 0; o < output_names.size(); ++o)
      if (model.largest[o].part > 1)
        fault("largest error of " + std::string(output_names[o]) +
              " beyond the bound: " + reproduce(sum, EngineKind::model, o));
    if (s.approach && jumps(steps_[first])) judge_jump(std::span(steps_).subspan(first), results, sum);
    for (std::size_t o = 0; sum.jump && o < output_names.size(); ++o)
      if (sum.jump->largest[o] > 2)  // two errors within the bound, of either sign
        fault("the error of " + std::string(output_names[o]) + " jumps by more than twice the bound " +
              (sum.between_sides ? "from side to side" : "at the special case"));
    for (KnobErrors& r : results) r.model = {};
    summaries_.push_back(std::move(sum));
  }

  /// From each step to the special case, or where that draws nothing from side to side.
  static void judge_jump(std::span<const KnobStep> steps, std::span<const KnobErrors> results, Summary& sum) {
    sum.jump.emplace();
    const PixelSeries* special = nullptr;
    for (std::size_t i = 0; i < results.size(); ++i)
      if (steps[i].side == 0 && !results[i].model.empty()) special = &results[i].model;
    sum.between_sides = special == nullptr;
    for (std::size_t i = 0; i < results.size(); ++i) {
      if (steps[i].side == 0) continue;
      if (special) {
        sum.jump->merge(error_jump(*special, results[i].model));
      } else if (steps[i].side < 0) {
        for (std::size_t j = 0; j < results.size(); ++j)
          if (steps[j].side > 0 && steps[j].knob == steps[i].knob)
            sum.jump->merge(error_jump(results[i].model, results[j].model));
      }
    }
  }

  std::string place(const KnobStep& step) const {
    const KnobSeries& s = series_[step.series];
    if (step.side == 0) return "special case";
    return (s.approach ? (step.side < 0 ? "side -1, knob " : "knob ") : "knob 2^") + std::to_string(step.knob);
  }

  /// The command that draws the pixel of the step by the body, with its errors.
  std::string reproduce(std::size_t step, EngineKind body, const Place& at, bool attributes) const {
    const DrawState& state = series_[steps_[step].series].state;
    WindowQuad quad = quads_of(steps_[step])[at.index];
    if (!attributes) quad.attribute = {};
    return reproduce_pixel(quad, config_, state.width, state.height, at.x, at.y, engine_info(body).name);
  }
  std::string reproduce(const Summary& sum, EngineKind body, std::size_t output) const {
    return reproduce(sum.worst[body][output], body, sum.body[body].largest[output].place,
                     static_cast<Output>(output) == Output::attribute);
  }

  nlohmann::ordered_json place_json(std::size_t step) const {
    return {{"knob", steps_[step].knob}, {"side", steps_[step].side}};
  }

  /// Of each output the largest error, and the first pixel that is undefined or missing.
  nlohmann::ordered_json worst_json(const Summary& sum, EngineKind body) const {
    nlohmann::ordered_json json = nlohmann::ordered_json::object();
    const BodyErrors& errors = sum.body[body];
    for (std::size_t o = 0; errors.fragments != 0 && o < output_names.size(); ++o) {
      nlohmann::ordered_json entry{{"error", errors.largest[o].part}};
      entry.update(place_json(sum.worst[body][o]));
      // All errors are 0: no pixel is the worst.
      entry["reproduce"] = nullptr;
      if (errors.largest[o].part > 0) entry["reproduce"] = reproduce(sum, body, o);
      json[std::string(output_names[o])] = std::move(entry);
    }
    if (errors.pixels_lost() != 0) {
      nlohmann::ordered_json entry = place_json(sum.lost[body]);
      entry["reproduce"] = reproduce(sum.lost[body], body, errors.lost, false);
      json["lost"] = std::move(entry);
    }
    return json;
  }

  static void add_errors(nlohmann::ordered_json& json, const BodyErrors& e) {
    json["fragments"] = e.fragments;
    json["beyond"] = e.beyond;
    json["undefined"] = e.undefined;
    json["missing"] = e.missing;
    for (std::size_t o = 0; o < output_names.size(); ++o) {
      nlohmann::ordered_json& value = json[std::string(output_names[o])];
      if (e.fragments != 0) value = e.largest[o].part;
    }
  }

  nlohmann::ordered_json report() const {
    nlohmann::ordered_json json = golden::begin_report(config_, common_.seed, arguments_);
    json["weight_bound"] = weight_bound(config_);
    json["count"] = options_.count;
    if (shard_.is_part()) json["shard"] = options_.shards.shard;
    std::vector<std::string> faults;
    json["families"] = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < series_.size(); ++i) {
      const Summary& s = summaries_[i];
      nlohmann::ordered_json entry;
      entry["family"] = series_[i].name;
      entry["kind"] = series_[i].kind;
      entry["special"] = series_[i].special;
      entry["knob"] = series_[i].knob;
      entry["exponent"] = series_[i].exponent;
      nlohmann::ordered_json& jump = entry["jump"];
      if (s.jump) {
        jump["between"] = s.between_sides ? "sides" : "special case";
        jump["pixels"] = s.jump->pixels;
        for (std::size_t o = 0; o < output_names.size(); ++o) {
          nlohmann::ordered_json& largest = jump[std::string(output_names[o])];
          if (s.jump->pixels != 0) largest = s.jump->largest[o];
        }
      }
      for (const EngineKind b : knob_engines)
        if (has(b)) entry["worst"][std::string(engine_info(b).name)] = worst_json(s, b);
      entry["faults"] = s.faults;
      faults.insert(faults.end(), s.faults.begin(), s.faults.end());
      json["families"].push_back(std::move(entry));
    }
    json["errors"] = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < steps_.size(); ++i)
      for (const EngineKind b : knob_engines) {
        if (!has(b)) continue;
        nlohmann::ordered_json entry;
        entry["family"] = series_[steps_[i].series].name;
        entry["knob"] = steps_[i].knob;
        entry["side"] = steps_[i].side;
        entry["engine"] = engine_info(b).name;
        add_errors(entry, results_[i].body[b]);
        nlohmann::ordered_json& near_case = entry["near"];
        if (series_[steps_[i].series].approach) add_errors(near_case, results_[i].near_case[b]);
        json["errors"].push_back(std::move(entry));
      }
    json["ok"] = faults.empty();
    json["faults"] = faults;
    return json;
  }

  const StressOptions& options_;
  const CommonOptions& common_;
  const std::vector<std::string> arguments_;
  const Config config_;
  const Shard shard_;
  unsigned bodies_ = 0;
  std::vector<KnobSeries> series_;
  std::vector<KnobStep> steps_;
  std::vector<KnobErrors> results_;  ///< of the steps
  std::vector<Summary> summaries_;   ///< of the series
};

}  // namespace

void add_stress_command(CLI::App& app, Invocation& invocation) {
  CLI::App* command = app.add_subcommand("stress", stress_description);
  end_help(*command,
           "Stress families draw random quads, with the knobs 2^-6 to 2^6 where they have one. Approaches move quads "
           "to a special case: knob k is a distance of 2^-k, on either side (for long edges, a length of 2^k). "
           "`quadrille scenes --stress` lists both.\n\n"
           "Errors are against exact arithmetic on the snapped quads, in units of the bound.\n"
           "  near       largest weight error at pixels near the special case\n"
           "  jump       largest change of an error from a step to the special case\n"
           "  undefined  pixels with a division by zero\n"
           "  missing    pixels not drawn\n"
           "--json adds a command that shows each worst pixel; scripts/stress_plot.py draws the JSON.\n\n"
           "--search takes 1/8 of --evaluations at random and climbs from the worst. Its errors are in units of 2^-s "
           "for a weight; the bound is 8.",
           "0 within bounds; 1 bound exceeded, other pixels drawn, jump above twice the bound, no pixel near the case, "
           "RTL and model differ, or another error than the kept one; 2 usage or input error; 3 missing tool",
           {"stress --families edge_distance,eye_plane --csv stress.csv",
            "stress --search --evaluations 100000 --keep worst.quads",
            "stress --merge part0.json part1.json --json stress.json"});
  const auto options = std::make_shared<StressOptions>();
  options->common.size = stress_size;
  options->common.add_to(*command);
  command->add_option("--families", options->families, "Stress families and approaches, with commas (default: all)")
      ->type_name("LIST");
  command->add_option("--engines", options->engines, "Engines beside the model: float, fp32, shader, rtl")
      ->type_name("LIST")
      ->capture_default_str();
  command->add_option("--count", options->count, "Quads per step")
      ->type_name("N")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{100'000}))
      ->capture_default_str();
  options->shards.add_to(*command, "the families", "their --json files");
  writes_file(*command, command->add_option("--csv", options->csv, "A row per step and engine; - is standard output"),
              "csv")
      ->group(output_group);
  options->search.add_to(*command);
  command->callback([options, &invocation] {
    invocation.run = [options, &invocation] {
      if (!options->shards.merge.empty()) return merge_reports(*options);
      if (options->search.search) return search_stress(options->common, options->families, options->search);
      if (!options->search.kept.empty()) return check_kept_stress(options->common, options->search);
      if (!options->search.keep.empty()) throw UsageError("--keep needs --search or --kept");
      return StressCommand(*options, invocation.arguments).run();
    };
  });
}

}  // namespace quadrille::tb
