// quadrille cosim: the RTL and its model in lockstep on real quads, the fragments compared with the truth as they come.
#include "tb/commands/commands.hpp"
#include "tb/commands/cosim_battery.hpp"
#include "tb/commands/cosim_draws.hpp"
#include "tb/commands/cosim_shrink.hpp"
#include "tb/commands/counters_report.hpp"
#include "tb/options/command_line.hpp"

#include "golden/analysis/error_bound.hpp"
#include "golden/io/exr.hpp"
#include "golden/io/json_report.hpp"
#include "golden/scenes/random_state.hpp"
#include "model/hierarchical_z.hpp"
#include "model/quad_reject.hpp"
#include "model/snap.hpp"
#include "tb/check/check.hpp"
#include "tb/check/error_limits.hpp"
#include "tb/check/model_check.hpp"
#include "tb/check/skip_check.hpp"
#include "tb/device/verilate.hpp"
#include "tb/lockstep/lockstep.hpp"
#include "tb/options/input.hpp"
#include "tb/options/options.hpp"
#include "tb/options/written_file.hpp"
#include "tb/render/frame.hpp"
#include "tb/support/errors.hpp"
#include "tb/support/output.hpp"
#include "tb/support/progress.hpp"
#include "tb/support/stopwatch.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>

namespace quadrille::cli {
namespace {

struct CosimOptions {
  CommonOptions common;
  StateOptions state;
  InputOptions input;
  double stall = 0, gap = 0, shrink_seconds = ShrinkOptions{}.seconds;
  std::uint64_t limit_fragments = 0;
  int attributes = 0;       ///< in use per pass; 0: all slots
  std::uint64_t draws = 0;  ///< each input is cut into so many; 0: it is one
  std::string battery;      ///< groups of the battery, or all
  std::string waits, stall_clocks, gap_beats, draw_state, trace, shrink, out, png, texture, shade, rtl;
  bool no_snapping = false, no_alone = false, no_shrink = false, compare_skips = true;
};

constexpr std::uint64_t alone_fragments = 200'000;  ///< enough to time the RTL alone

/// One input: what ran and what was found.
struct InputResult {
  std::string name, option;
  std::string state;       ///< the options that give the draw state
  std::string attributes;  ///< the option that gives the attributes in use per pass, where they are not all slots
  std::uint64_t quads = 0, triangles = 0, fanned_faces = 0, fan_primitives = 0, skipped_lines = 0;
  std::uint64_t quads_drawn = 0, eye_crossing_quads = 0, homogeneous_quads = 0, antipodal_quads = 0, tiny_quads = 0;
  std::uint64_t passes = 0, fragments = 0, pixels = 0, mismatches = 0, cycles_rtl = 0, cycles_model = 0,
                cycle_mismatches = 0, compared_bits = 0;
  std::uint64_t pass_cycles = 0, pass_fragments = 0;  ///< of all passes
  std::uint64_t draws = 0, clears = 0, resets = 0;    ///< with --draws
  std::uint64_t at_depth_limit = 0;  ///< fragments whose depth is exactly znear or zfar (where not 0 and 1)
  std::uint64_t left_out = 0, left_out_empty = 0, left_out_behind = 0, left_out_depth = 0, left_out_line = 0,
                left_out_culled = 0, left_out_outside = 0;  ///< quads, by QuadReject
  PerformanceCounters counters;
  std::uint64_t alone_cycles = 0;
  double alone_seconds = 0, seconds = 0, loop_seconds = 0;
  bool complete = true;
  std::optional<std::string> first_divergence;
  std::uint64_t fragment_hash = 0;
  CheckResult check;
  SkipResult skips;                        ///< draws with and without the skips
  std::uint64_t limits_checked = 0;        ///< inputs that have regression limits
  std::vector<std::string> beyond_limits;  ///< what is beyond them, in words

  bool lockstep_ok() const { return mismatches == 0 && cycle_mismatches == 0; }
  bool ok() const { return lockstep_ok() && check.ok() && skips.differences == 0 && beyond_limits.empty(); }
};

using Metric = Counter<InputResult>;

/// Counters of an input in the order of the report; the faults that the checker found follow lockstep_metrics.
constexpr Metric draw_metrics[]{{"quads", &InputResult::quads},
                                {"quads_drawn", &InputResult::quads_drawn},
                                {"triangles", &InputResult::triangles},
                                {"fanned_faces", &InputResult::fanned_faces},
                                {"fan_primitives", &InputResult::fan_primitives},
                                {"skipped_lines", &InputResult::skipped_lines},
                                {"passes", &InputResult::passes},
                                {"fragments", &InputResult::fragments},
                                {"mismatches", &InputResult::mismatches}};
constexpr Metric cycle_metrics[]{{"cycles_all_passes", &InputResult::pass_cycles},
                                 {"fragments_all_passes", &InputResult::pass_fragments},
                                 {"cycles_rtl", &InputResult::cycles_rtl},
                                 {"cycles_model", &InputResult::cycles_model},
                                 {"cycle_mismatches", &InputResult::cycle_mismatches},
                                 {"compared_bits", &InputResult::compared_bits},
                                 {"covered_pixels", &InputResult::pixels},
                                 {"draws", &InputResult::draws},
                                 {"clears", &InputResult::clears},
                                 {"resets", &InputResult::resets}};
constexpr Metric count_metrics[]{
    {"eye_crossing_quads", &InputResult::eye_crossing_quads}, {"homogeneous_quads", &InputResult::homogeneous_quads},
    {"antipodal_quads", &InputResult::antipodal_quads},       {"tiny_quads", &InputResult::tiny_quads},
    {"at_depth_limit", &InputResult::at_depth_limit},         {"left_out", &InputResult::left_out},
    {"left_out_empty", &InputResult::left_out_empty},         {"left_out_behind", &InputResult::left_out_behind},
    {"left_out_depth", &InputResult::left_out_depth},         {"left_out_line", &InputResult::left_out_line},
    {"left_out_culled", &InputResult::left_out_culled},       {"left_out_outside", &InputResult::left_out_outside}};

template <class Owner>
void put_counters(nlohmann::ordered_json& json, const Owner& owner,
                  std::span<const Counter<std::type_identity_t<Owner>>> counters) {
  for (const Counter<Owner>& counter : counters) json[counter.key] = owner.*counter.value;
}

void merge(InputResult& sum, const InputResult& part) {
  for (const std::span<const Metric> metrics :
       {std::span<const Metric>(draw_metrics), {cycle_metrics}, {count_metrics}})
    add_counters(sum, part, metrics);
  sum.counters += part.counters;
  sum.alone_cycles += part.alone_cycles;
  sum.alone_seconds += part.alone_seconds;
  sum.seconds += part.seconds;
  sum.loop_seconds += part.loop_seconds;
  sum.complete = sum.complete && part.complete;
  if (!sum.first_divergence && part.first_divergence) sum.first_divergence = part.name + ": " + *part.first_divergence;
  sum.fragment_hash = sum.fragment_hash * 0x100000001b3u ^ part.fragment_hash;
  sum.check.merge(part.check);
  sum.skips.merge(part.skips);
  sum.limits_checked += part.limits_checked;
  for (const std::string& text : part.beyond_limits) sum.beyond_limits.push_back(part.name + ": " + text);
}

/// `form` with {key} replaced by that number of a report.
std::string filled(std::string_view form, const nlohmann::ordered_json& report) {
  std::string text;
  for (std::size_t open; (open = form.find('{')) != form.npos;) {
    const std::size_t close = form.find('}', open);
    text.append(form.substr(0, open)) += report.at(std::string(form.substr(open + 1, close - open - 1))).dump();
    form.remove_prefix(close + 1);
  }
  return text.append(form);
}

double ratio(double a, double b) { return b > 0 ? a / b : 0; }

/// The machine that a draw of several goes on in.
struct DrawPlace {
  const PlannedDraw& draw;
  std::size_t number;  ///< of the draw, from 1
  tb::LockstepSession& session;
  HiddenDepths& depths;
  PerformanceCounters& counters;  ///< since the reset
};

class CosimRun {
 public:
  CosimRun(const CosimOptions& options, std::vector<std::string> arguments)
      : options_(options), arguments_(std::move(arguments)), config_(options.common.config()) {}

  int run() {
    check_options();
    try {
      return options_.battery.empty() ? run_inputs() : run_battery();
    } catch (const tb::VerilateError& error) {
      if (options_.rtl.empty()) throw;
      throw UsageError("--rtl " + options_.rtl + ": " + error.what());  // the user's sources
    } catch (const tb::WatchdogError&) {
      // Both sides hang alike (the RTL alone would have differed), each time for as long as it takes to be sure of it.
      if (!options_.no_shrink) std::fputs("quadrille: not shrunk: a hang of RTL and model is not searched\n", stderr);
      throw;
    }
  }

 private:
  /// A group of the battery and what came of it.
  struct GroupRun {
    BatteryGroup group;
    std::unique_ptr<CosimRun> run;
    InputResult result;
    std::optional<ModelCheck> model;  ///< of the first group of a configuration
    bool done = false;
    std::string error;

    bool ok() const { return error.empty() && result.ok() && (!model || model->ok()); }
  };

  static std::unique_ptr<CosimRun> run_of(const BatteryGroup& group, CosimOptions options) {
    options.common.settings = group.settings;
    options.common.threads = 1;
    options.common.quiet = true;
    options.no_snapping = true;
    return std::make_unique<CosimRun>(options, std::vector<std::string>{});
  }

  std::vector<GroupRun> chosen_groups() const {
    std::vector<GroupRun> runs;
    std::string names;
    for (BatteryGroup& group : battery_groups()) {
      names += " " + group.name;
      const std::string& wanted = options_.battery;
      if (wanted != "all" && group.name != wanted && !group.name.starts_with(wanted + ".") &&
          !group.name.ends_with("." + wanted))
        continue;
      runs.push_back({});
      runs.back().run = run_of(group, options_);
      runs.back().group = std::move(group);
    }
    if (runs.empty()) throw UsageError("--battery " + options_.battery + ": no such group; the groups are" + names);
    return runs;
  }

  /// One group, its functions of the model with the first of its configuration.
  void run_group(GroupRun& group, bool with_functions) const {
    CosimRun& run = *group.run;
    group.result.name = group.group.name;
    try {
      DrawInput input;
      input.name = group.group.name;
      input.attributes = run.config_.attribute_slots;
      const tb::Stopwatch start;
      run.run_draws(input, group.group.draws(run.config_, options_.common.seed), group.result);
      group.result.seconds = start.seconds();
      if (with_functions) group.model = check_model(run.config_);
    } catch (const tb::WatchdogError& error) {
      group.error = error.what();
    }
  }

  int run_battery() {
    const tb::Stopwatch start;
    std::vector<GroupRun> groups = chosen_groups();
    std::vector<std::vector<std::string>> built;
    for (const GroupRun& group : groups) {  // one after the other: each build takes all processors
      if (std::ranges::find(built, group.group.settings) != built.end()) continue;
      built.push_back(group.group.settings);
      tb::simulator_in_lockstep(group.run->lockstep_options({}));
    }
    const double building = start.seconds();

    std::FILE* const text = options_.common.text();
    if (text) std::fprintf(text, "%-20s %6s %7s %10s %10s  %s\n", "group", "draws", "quads", "fragments", "cycles", "");
    std::mutex mutex;
    std::size_t printed = 0;
    bool ok = true;
    WorkQueue queue(options_.common.thread_count() - 1, groups.size());
    built.clear();
    for (GroupRun& group : groups) {
      const bool first = std::ranges::find(built, group.group.settings) == built.end();
      if (first) built.push_back(group.group.settings);
      queue.push([&, first] {
        run_group(group, first);
        const std::lock_guard lock(mutex);
        group.done = true;
        for (; printed < groups.size() && groups[printed].done; ++printed) {  // in order, whoever was faster
          ok = ok && groups[printed].ok();
          if (text) print_group(text, groups[printed]);
        }
      });
    }
    queue.drain();
    if (text)
      std::fprintf(text, "\n%s: %zu groups, seed %llu, %.1f s (%.1f s for building)\n", ok ? "OK" : "FAILED",
                   groups.size(), static_cast<unsigned long long>(options_.common.seed), start.seconds(), building);
    if (!options_.common.json.empty()) golden::save_json(options_.common.json, battery_report(groups, ok));
    std::fflush(stdout);
    const GroupRun* failed = nullptr;
    for (const GroupRun& group : groups) {
      if (group.ok()) continue;
      if (failed == nullptr) failed = &group;
      complain(group.result);
      if (!group.error.empty())
        std::fprintf(stderr, "quadrille: %s: %s\n", group.group.name.c_str(), group.error.c_str());
      if (group.model && !group.model->ok())
        std::fprintf(stderr, "quadrille: %s: the model alone: %s\n", group.group.name.c_str(),
                     group.model->fault().c_str());
    }
    if (failed != nullptr) {
      std::string command =
          "quadrille cosim --battery " + failed->group.name + " --seed " + std::to_string(options_.common.seed);
      if (!options_.rtl.empty()) command += " --rtl " + one(options_.rtl);
      std::fprintf(stderr, "quadrille: the first group that fails, alone:\n  %s\n", command.c_str());
      if (!options_.no_shrink && failed->run->failed_)
        failed->run->shrink_first_failure({failed->result}, failed->model.value_or(ModelCheck{}));
    }
    return ok ? exit_ok : exit_mismatch;
  }

  static void print_group(std::FILE* text, const GroupRun& group) {
    const InputResult& r = group.result;
    std::fprintf(text, "%-20s %6llu %7llu %10llu %10llu  %s\n", group.group.name.c_str(),
                 static_cast<unsigned long long>(r.draws), static_cast<unsigned long long>(r.quads_drawn),
                 static_cast<unsigned long long>(r.fragments), static_cast<unsigned long long>(r.cycles_rtl),
                 group.ok() ? "ok" : "FAILED");
    std::fflush(text);
  }

  nlohmann::ordered_json battery_report(const std::vector<GroupRun>& groups, bool ok) const {
    nlohmann::ordered_json json = golden::begin_report(config_, options_.common.seed, arguments_);
    json["ok"] = ok;
    for (const GroupRun& group : groups) {
      nlohmann::ordered_json one = group.run->result_json(group.result);
      one["settings"] = group.group.settings;
      one["ok"] = group.ok();
      if (!group.error.empty()) one["error"] = group.error;
      json["groups"].push_back(std::move(one));
    }
    return json;
  }

  int run_inputs() {
    std::vector<InputOptions> inputs = list_inputs();
    std::vector<InputResult> results;
    for (const InputOptions& input : inputs) {
      results.push_back(run_input(input));
      if (std::FILE* text = options_.common.text(); text && inputs.size() > 1)
        print_row(text, results.back(), results.size() == 1);
    }
    InputResult total;
    for (const InputResult& result : results) merge(total, result);
    total.name = results.size() == 1 ? results.front().name : "all";
    total.option = results.size() == 1 ? results.front().option : "--scene all";
    if (results.size() == 1) {
      total.state = results.front().state;
      total.attributes = results.front().attributes;
    }

    const ModelCheck model = check_model(config_);
    const bool ok = model.ok() && std::ranges::all_of(results, [](const InputResult& r) { return r.ok(); });
    if (std::FILE* text = options_.common.text()) print_summary(text, total, model, ok);
    if (!options_.common.json.empty()) golden::save_json(options_.common.json, report(total, results, model, ok));
    for (const InputResult& result : results) complain(result);
    if (!model.ok()) std::fprintf(stderr, "quadrille: the model alone: %s\n", model.fault().c_str());
    if (!ok && !options_.no_shrink) shrink_first_failure(results, model);
    return ok ? exit_ok : exit_mismatch;
  }

  /// What failed first is made less, after all that the run has to say.
  void shrink_first_failure(const std::vector<InputResult>& results, const ModelCheck& model) const {
    std::fflush(stdout);
    if (!failed_) {  // the draw itself is right
      const bool limits = std::ranges::any_of(results, [](const InputResult& r) { return !r.beyond_limits.empty(); });
      const bool skips = std::ranges::any_of(results, [](const InputResult& r) { return r.skips.differences > 0; });
      const char* const why = skips         ? "the machine draws this input right; with other skips it does not"
                              : limits      ? "errors are beyond their regression limits, which are of the whole draw"
                              : !model.ok() ? "the model alone failed, which draws nothing of this input"
                                            : "there is no fragment";
      std::fprintf(stderr, "quadrille: nothing to shrink: %s\n", why);
      return;
    }
    if (failed_->at_port) return;
    try {
      shrink_failed_pass(*failed_, {shrunk_file(), options_.shrink_seconds}, options_.common);
    } catch (const std::exception& error) {  // the run has failed and is reported, whatever becomes of this
      std::fprintf(stderr, "quadrille: %s was not shrunk: %s\n", failed_->input.c_str(), error.what());
    }
  }

  /// --shrink, or a name of its own that is none of the files read.
  std::string shrunk_file() const {
    if (!options_.shrink.empty()) return options_.shrink;
    std::string name = "cosim_failure";
    const std::vector<std::string> read = options_.input.files();
    const auto is_read = [&](const std::string& file) {
      return std::ranges::any_of(read, [&](const std::string& other) {
        std::error_code none;
        return !other.empty() && std::filesystem::equivalent(file, other, none);
      });
    };
    while (is_read(name + ".quads")) name += "_less";
    return name + ".quads";
  }

  void check_options() {
    try {
      if (!options_.stall_clocks.empty()) waits_.stall_clocks = tb::parse_stall_clocks(options_.stall_clocks);
    } catch (const std::invalid_argument& error) {
      throw UsageError(std::string("--stall-clocks ") + error.what());
    }
    try {
      if (!options_.gap_beats.empty()) waits_.gap_beats = tb::parse_gap_beats(options_.gap_beats);
    } catch (const std::invalid_argument& error) {
      throw UsageError(std::string("--gap-beats ") + error.what());
    }
    try {
      if (!options_.waits.empty()) pattern_ = tb::parse_wait_kind(options_.waits);
    } catch (const std::invalid_argument& error) {
      throw UsageError(std::string("--waits ") + error.what());
    }
    probability("--stall", options_.stall);
    probability("--gap", options_.gap);
    if (options_.attributes > config_.attribute_slots)
      throw UsageError("--attributes " + std::to_string(options_.attributes) + ": attribute_slots is " +
                       std::to_string(config_.attribute_slots));
    if (!options_.draw_state.empty()) {
      drawn_state_seed();
      const std::string given = options_.state.spelled() +
                                (options_.attributes > 0 ? " --attributes " + std::to_string(options_.attributes) : "");
      if (!given.empty())
        throw UsageError("--draw-state " + options_.draw_state + " draws what" + given + " sets; give one of them");
    }
    if (!options_.battery.empty()) {
      const CommonOptions& common = options_.common;
      if (inputs_given(options_.input) > 0 || options_.draws > 0 || options_.limit_fragments > 0 ||
          !common.settings.empty() || !common.config_file.empty() || !options_.state.spelled().empty() ||
          !options_.draw_state.empty() || options_.attributes > 0 || !options_.out.empty() || !options_.png.empty() ||
          !options_.trace.empty())
        throw UsageError(
            "--battery has inputs, configurations and draw states of its own; it takes --rtl, --seed, "
            "--threads, --json, --shrink and --quiet");
    }
    if (options_.draws > 0) {
      const std::string given = options_.state.spelled() + (options_.attributes > 0 ? " --attributes" : "") +
                                (options_.draw_state.empty() ? "" : " --draw-state") +
                                (options_.out.empty() ? "" : " --out") + (options_.png.empty() ? "" : " --png");
      if (!given.empty()) throw UsageError("--draws draws the state of each draw and no picture; leave out" + given);
    }
    std::vector<std::string> read = options_.input.files();
    read.insert(read.end(), {options_.common.config_file, options_.texture});
    check_outputs(
        {options_.trace, options_.shrink, options_.out, options_.png, options_.input.save_camera, options_.common.json},
        read);
    if (!options_.rtl.empty() && !std::filesystem::exists(options_.rtl))
      throw UsageError("--rtl " + options_.rtl + ": no such file or directory");
    if (std::filesystem::is_directory(options_.rtl) && !holds_verilog(options_.rtl))
      throw UsageError("--rtl " + options_.rtl + ": no SystemVerilog file (*.sv) is in this directory");
    if (all_scenes() && (!options_.out.empty() || !options_.png.empty() || !options_.trace.empty()))
      throw UsageError("--out, --png and --trace are for one input, not for all scenes");
  }

  static bool holds_verilog(const std::string& directory) {
    return std::ranges::any_of(std::filesystem::directory_iterator(directory),
                               [](const auto& entry) { return entry.path().extension() == ".sv"; });
  }

  /// The seed of --draw-state: after the colon, or the command's.
  std::uint64_t drawn_state_seed() const {
    const std::string& text = options_.draw_state;
    const std::size_t colon = std::min(text.find(':'), text.size());
    std::uint64_t seed = options_.common.seed;
    const char *first = text.data() + colon + 1, *last = text.data() + text.size();
    const bool good = colon == text.size() || (first != last && std::from_chars(first, last, seed).ptr == last);
    if (text.substr(0, colon) != "random" || !good)
      throw UsageError("--draw-state " + text + ": expected random or random:SEED");
    return seed;
  }

  bool all_scenes() const { return inputs_given(options_.input) == 0 || options_.input.scene == "all"; }

  std::vector<InputOptions> list_inputs() const {
    if (!all_scenes()) return {options_.input};
    if (inputs_given(options_.input) > 1) throw UsageError("--scene all goes with no other input");
    std::vector<InputOptions> inputs;
    for (const std::string& name : scene_names()) {
      inputs.push_back(options_.input);
      inputs.back().scene = name;
    }
    return inputs;
  }

  InputResult run_input(const InputOptions& input_options) {
    const tb::Stopwatch start;
    DrawState state = options_.state.state(options_.common, config_);
    int slots = options_.attributes > 0 ? options_.attributes : config_.attribute_slots;
    const auto load = [&] {
      return load_input(input_options, shade_of(options_.shade, options_.texture), state, config_,
                        options_.common.seed);
    };
    DrawInput input = load();
    print_remark(input, options_.common);
    if (!options_.draw_state.empty()) {
      state = golden::random_draw_state(config_, state.width, state.height, input.quads, drawn_state_seed());
      slots = state.attributes;
      if (!input_options.corner.empty()) input = load();  // corner quads may depend on the state
    }
    adjust_state(input, state);
    check_quad_count(input.quads.size(), config_);

    InputResult result;
    result.name = input.name;
    result.option = input.option;
    result.state = StateOptions::of(state).spelled();
    if (slots < config_.attribute_slots) result.attributes = " --attributes " + std::to_string(slots);
    result.quads = input.quads.size();
    result.triangles = input.triangles;
    result.fanned_faces = input.fanned_faces;
    result.fan_primitives = input.fan_primitives;
    result.skipped_lines = input.skipped_lines;

    if (options_.draws > 0) {
      run_draws(input,
                plan_draws(input.quads, options_.draws, config_, state.width, state.height, options_.common.seed),
                result);
      result.seconds = start.seconds();
      return result;
    }
    std::unique_ptr<FrameBuffer> frame;
    ShadeSettings shading;
    if (!options_.out.empty() || !options_.png.empty()) {
      frame = std::make_unique<FrameBuffer>(state.width, state.height, state.depth);
      shading.shade = input.shade;
      shading.slots = shade_slots(input.shade, input);
      shading.texture = make_texture(options_.texture, input);
      shading.lighting = input.lighting;
      shading.depth = state.depth;
      shading.threads = options_.common.thread_count();
    }

    std::size_t weight_passes = 0;
    const std::vector<Pass> passes = plan_judged_passes(input.attributes, slots, &weight_passes);

    // With several weight passes a picture needs whole samples: they are collected in order first.
    std::vector<EngineSample> samples;
    for (std::size_t p = 0; p < passes.size(); ++p) {
      run_pass(input, state, passes[p], p, weight_passes, frame.get(), samples, result);
      if (!failed_ && !(result.lockstep_ok() && result.check.faults() == 0))
        failed_ = failed_pass(input, state, slots, passes[p], p, result.lockstep_ok());
      if (!result.lockstep_ok()) break;  // more of the same is of no use
    }
    result.passes = passes.size();
    if (!input_options.stress.empty() && result.complete) compare_with_limits(input_options.stress, state, result);

    if (frame && result.fragments > 0) {
      golden::FrameImage image = shade_frame(*frame, shading);
      if (!options_.out.empty()) {
        add_error_layers(*frame, input.quads, config_, state, true, options_.common.thread_count(), image);
        golden::save_exr(options_.out, image);
      }
      if (!options_.png.empty()) save_frame_png(options_.png, image);
    }
    result.seconds = start.seconds();
    return result;
  }

  /// Several draws of one machine, each in one of its passes.
  void run_draws(const DrawInput& input, const std::vector<PlannedDraw>& draws, InputResult& result) {
    if (draws.empty()) return;
    int width = 0, height = 0;  // of the depth buffer, where there is one
    for (const PlannedDraw& draw : draws)
      if (skips_hidden(config_, draw.state)) {
        width = std::max(width, draw.state.width);
        height = std::max(height, draw.state.height);
      }
    tb::LockstepOptions lockstep = lockstep_options(draws.front().state);
    PartialFile trace(options_.trace);
    if (trace.active()) lockstep.trace = trace.path();
    const tb::Simulator simulator = tb::simulator_in_lockstep(lockstep);
    std::optional<tb::LockstepSession> session;
    HiddenDepths depths(width, height);
    PerformanceCounters counters;
    bool fresh = true;  // a power-on or reset comes before the draw
    for (std::size_t d = 0; d < draws.size(); ++d) {
      const PlannedDraw& draw = draws[d];
      if (d == 0 || draw.power_on) {
        if (d > 0) lockstep.seed = draw.seed;
        session.emplace(simulator, lockstep);
        fresh = true;
      } else if (draw.reset || draws[d - 1].limit > 0) {
        session->reset();
        fresh = true;
        ++result.resets;
      }
      if (fresh) counters = {};
      if (fresh || draw.clears > 0) depths.clear();
      ++result.draws;
      result.clears += fresh ? 0 : draw.clears;
      fresh = false;
      DrawInput part;
      part.name = input.name;
      part.quads_file = input.quads_file;
      part.quads = draw.quads;
      const DrawPlace place{draw, d + 1, *session, depths, counters};
      std::vector<EngineSample> samples;
      const Pass pass = pass_of(input, draw, d);
      run_pass(part, draw.state, pass, 0, 1, nullptr, samples, result, &place);
      if (!failed_ && !(result.lockstep_ok() && result.check.faults() == 0)) {
        failed_ = failed_pass(part, draw.state, draw.state.attributes, pass, 0, result.lockstep_ok());
        failed_->input += ", draw " + std::to_string(d + 1);
        failed_->at_port = !draw.at_port.empty();
        set_place(place, failed_->lockstep);
      }
      if (!result.lockstep_ok()) break;  // both sides are apart
    }
    result.passes = 1;
    if (trace.active()) trace.commit();
  }

  /// What the attributes of a draw are: those that the port gets, or one of the input's passes.
  static Pass pass_of(const DrawInput& input, const PlannedDraw& draw, std::size_t number) {
    if (!draw.at_port.empty()) {
      Pass pass;
      for (int j = 0; j < draw.state.attributes; ++j) pass.columns.push_back(4 + j);
      return pass;
    }
    const std::vector<Pass> passes = plan_judged_passes(input.attributes, draw.state.attributes);
    return passes[number % passes.size()];
  }

  /// What a draw of several has of its own.
  void set_place(const DrawPlace& place, tb::LockstepOptions& lockstep) const {
    lockstep.seed = place.draw.seed;
    lockstep.flush = place.draw.flush;
    if (place.draw.limit > 0) lockstep.limit_fragments = place.draw.limit;
    if (!options_.waits.empty() || lockstep.stall > 0 || lockstep.gap > 0 || !lockstep.waits.empty()) return;
    lockstep.pattern = place.draw.waits;
    lockstep.stall = place.draw.stall;
    lockstep.gap = place.draw.gap;
  }

  tb::LockstepOptions lockstep_options(const DrawState& state) const {
    tb::LockstepOptions lockstep;
    lockstep.config = config_;
    lockstep.state = state;
    lockstep.seed = options_.common.seed;
    lockstep.stall = options_.stall;
    lockstep.gap = options_.gap;
    lockstep.waits = waits_;
    lockstep.pattern = pattern_;
    lockstep.limit_fragments = options_.limit_fragments;
    lockstep.source = options_.rtl;
    lockstep.probes = !std::filesystem::is_regular_file(options_.rtl);  // one file has none: ports alone are compared
    lockstep.threads = options_.common.thread_count();
    return lockstep;
  }

  FragmentChecker::Settings checker_settings(const DrawState& state, const Pass& pass, bool first) const {
    FragmentChecker::Settings settings;
    settings.config = config_;
    settings.state = state;
    settings.pass = pass;
    settings.first_pass = first;
    settings.snapping = !options_.no_snapping;
    return settings;
  }

  FailedPass failed_pass(const DrawInput& input, const DrawState& draw_state, int slots, const Pass& pass,
                         std::size_t number, bool lockstep_ok) const {
    DrawState state = draw_state;
    state.attributes = static_cast<int>(pass.columns.size());
    return {input.name, input.quads, lockstep_options(state), checker_settings(state, pass, number == 0),
            slots,      lockstep_ok};
  }

  /// Regression limits, where some are recorded for such a draw.
  void compare_with_limits(const std::string& stress, const DrawState& state, InputResult& result) const {
    const golden::StressFamily family = golden::parse_stress_family(stress);
    if (!limits_apply(config_, state, family, result.quads)) return;
    const ErrorLimits::Family* limits = ErrorLimits::recorded().find(stress, config_.significand_bits);
    if (limits == nullptr) return;
    result.limits_checked = 1;
    result.beyond_limits = beyond_limits(*limits, result.check);
  }

  void run_pass(const DrawInput& input, const DrawState& draw_state, const Pass& pass, std::size_t number,
                std::size_t weight_passes, FrameBuffer* frame, std::vector<EngineSample>& samples, InputResult& result,
                const DrawPlace* place = nullptr) {
    const bool first = number == 0;
    DrawState state = draw_state;
    state.attributes = static_cast<int>(pass.columns.size());
    std::vector<SnappedQuad> snapped;
    snapped.reserve(input.quads.size());
    try {
      if (place != nullptr) snapped = place->draw.at_port;
      for (std::size_t i = snapped.size(); i < input.quads.size(); ++i)
        snapped.push_back(snap_as(pass_quad(input.quads[i], pass), static_cast<std::uint32_t>(i), config_, state));
    } catch (const SnapError& error) {
      throw UsageError(describe(error, input));
    }

    tb::LockstepOptions lockstep = lockstep_options(state);
    PartialFile trace(first && place == nullptr ? options_.trace : std::string{});
    if (trace.active()) lockstep.trace = trace.path();
    if (place != nullptr) set_place(*place, lockstep);
    if (place != nullptr && !options_.trace.empty()) lockstep.threads = 1;  // the session has the waveform
    Progress progress(input.name + (first ? "" : ", attributes"), 1000, options_.common.show_progress());
    lockstep.progress = [&](double part) { progress.set(static_cast<std::uint64_t>(part * 1000)); };

    const unsigned threads = options_.common.thread_count();
    WorkQueue queue(judging_threads(threads), std::size_t{16} * threads);
    FragmentChecker::Settings check_settings = checker_settings(state, pass, first);
    if (place != nullptr) {
      check_settings.depths = &place->depths;
      check_settings.snapping = check_settings.snapping && place->draw.at_port.empty();
    }
    FragmentChecker checker(check_settings, input.quads, snapped, queue);

    std::size_t position = 0;
    const std::uint32_t znear = depth_code(state.znear, config_), zfar = depth_code(state.zfar, config_);
    const bool compare_skips = options_.compare_skips && first;
    SkipCheck skip_check(config_, state, compare_skips ? snapped.size() : 0);
    const std::uint32_t id_bits = place != nullptr ? place->draw.id_bits : 0;
    std::vector<SnappedQuad> sent;  // under other ids, where the draw has some
    if (id_bits != 0) {
      sent = snapped;
      for (SnappedQuad& quad : sent) quad.id ^= id_bits;
    }
    const tb::FragmentSink sink = [&](const Fragment& given) {
      Fragment fragment = given;
      fragment.quad ^= id_bits;
      checker.fragment(fragment);
      if (compare_skips) skip_check.fragment(fragment);
      if (first && state.depth)
        result.at_depth_limit +=
            (state.znear > 0 && fragment.depth == znear) || (state.zfar < 1 && fragment.depth == zfar);
      if (frame && fragment.quad < input.quads.size() && fragment.x < state.width && fragment.y < state.height)
        picture(fragment, pass, number, weight_passes, input, *frame, samples, position);
    };
    std::optional<tb::Simulators> simulators;
    if (first && place == nullptr && !options_.no_alone) simulators = tb::build_simulators(lockstep);
    tb::LockstepReport report =
        simulators         ? tb::run_lockstep(simulators->in_lockstep, snapped, lockstep, sink)
        : place == nullptr ? tb::run_lockstep(snapped, lockstep, sink)
                           : place->session.draw(id_bits != 0 ? sent : snapped, lockstep, place->draw.clears, sink);
    const tb::Stopwatch drawn;
    checker.finish(report.complete);
    queue.drain();
    SkipResult skips;
    if (compare_skips && report.agreed())
      skips = skip_check.compare(snapped, static_cast<std::size_t>(report.quads), report.complete, queue);
    const double seconds = report.wall_seconds + drawn.seconds();  // without building the RTL
    progress.finish();
    if (trace.active()) trace.commit();
    if (frame && number + 1 == weight_passes) {
      frame->add(samples);
      samples.clear();
    }

    result.mismatches += report.mismatches;
    result.cycle_mismatches += report.cycle_mismatches;
    result.compared_bits += report.compared_bits;
    result.pass_cycles += report.cycles_rtl;
    result.pass_fragments += report.fragments;
    result.loop_seconds += seconds;
    CheckResult check = checker.result();
    if (place != nullptr) {
      const std::string name = "draw " + std::to_string(place->number) + ": ";
      if (report.first_divergence) report.first_divergence = name + *report.first_divergence;
      if (check.first.any) check.first.text = name + check.first.text;
      if (!skips.first.empty()) skips.first = name + skips.first;
      const PerformanceCounters all = std::exchange(place->counters, report.counters);
      for (std::size_t i = 0; i < counter_count; ++i) report.counters.value[i] -= all.value[i];
    }
    if (!result.first_divergence) result.first_divergence = report.first_divergence;
    if (!first) check.compared = 0;  // the same fragments again
    result.check.merge(check);
    result.skips.merge(skips);
    if (!first) return;

    result.quads_drawn += report.quads;
    result.fragments += report.fragments;
    result.pixels += report.pixels;
    result.cycles_rtl += report.cycles_rtl;
    result.cycles_model += report.cycles_model;
    result.counters += report.counters;
    result.fragment_hash = result.fragment_hash * 0x100000001b3u ^ report.fragment_hash;
    result.complete = result.complete && (report.complete || (place != nullptr && place->draw.limit > 0));
    for (std::size_t i = 0; i < report.quads; ++i) {
      result.eye_crossing_quads += is_eye_crossing(snapped[i]) ? 1 : 0;
      result.homogeneous_quads += is_ordinary(snapped[i], config_) ? 0 : 1;
      result.antipodal_quads += has_antipodal_edge(snapped[i]) ? 1 : 0;
      result.tiny_quads += is_tiny(snapped[i], config_) ? 1 : 0;
      const QuadReject reject = quad_reject(snapped[i], config_, state);
      result.left_out += reject != QuadReject::none;
      result.left_out_empty += reject == QuadReject::empty;
      result.left_out_behind += reject == QuadReject::behind;
      result.left_out_depth += reject == QuadReject::depth;
      result.left_out_line += reject == QuadReject::line;
      result.left_out_culled += reject == QuadReject::culled;
      result.left_out_outside += reject == QuadReject::outside;
    }
    if (simulators && report.agreed()) time_alone(simulators->alone, snapped, lockstep, report, result);
  }

  /// The RTL without probes and comparison, on the same quads; its fragments must be the same ones.
  static void time_alone(const tb::Simulator& simulator, std::span<const SnappedQuad> snapped,
                         tb::LockstepOptions options, const tb::LockstepReport& lockstep, InputResult& result) {
    options.trace.reset();
    options.progress = nullptr;
    const bool whole = options.limit_fragments == 0 && lockstep.fragments <= alone_fragments;
    if (!whole) options.limit_fragments = std::min(alone_fragments, std::max<std::uint64_t>(1, lockstep.fragments));
    const tb::AloneRun alone = tb::run_rtl_alone(simulator, snapped, options);
    result.alone_cycles = alone.cycles;
    result.alone_seconds = alone.seconds;
    if (whole && alone.fragment_hash != lockstep.fragment_hash) {
      ++result.mismatches;
      result.first_divergence = "the RTL alone gives other fragments than in lockstep";
    }
  }

  void picture(const Fragment& fragment, const Pass& pass, std::size_t number, std::size_t weight_passes,
               const DrawInput& input, FrameBuffer& frame, std::vector<EngineSample>& samples,
               std::size_t& position) const {
    if (number >= weight_passes) {
      frame.amend(fragment, fragment.quad, pass, config_);
    } else if (number == 0) {
      EngineSample& sample = samples.emplace_back();
      sample.index = fragment.quad;
      sample.quad = input.quads[fragment.quad].id;
      read_columns(fragment, pass, config_, sample);
    } else {
      // Of plane quads a pass may discard pixels by depth that another draws (state_of_pass).
      const auto same = [&](const EngineSample& s) {
        return s.index == fragment.quad && s.x == fragment.x && s.y == fragment.y;
      };
      constexpr std::size_t most_missing = 1024;
      const auto first = samples.begin() + static_cast<std::ptrdiff_t>(position);
      const auto last = first + static_cast<std::ptrdiff_t>(std::min(most_missing, samples.size() - position));
      const auto found = std::find_if(first, last, same);
      if (found == last) return;
      read_columns(fragment, pass, config_, *found, false);
      position = static_cast<std::size_t>(found - samples.begin()) + 1;
    }
  }

  /// The bound is a statement about exact A, D and R².
  bool bound_applies() const { return config_.qdrop() == 0; }

  std::string reproduce(const InputResult& result, const CheckResult::Worst& worst) const {
    std::string text = "quadrille fragments --engine model " + result.option;
    if (!options_.common.config_file.empty()) text += " --config " + one(options_.common.config_file);
    for (const std::string& setting : options_.common.settings) text += " --set " + one(setting);
    text += " --size " + options_.common.size + " --seed " + std::to_string(options_.common.seed) + result.state;
    return text + " --quad " + std::to_string(worst.place.index) + " --pixel " + std::to_string(worst.place.x) + "," +
           std::to_string(worst.place.y) + " --out -";
  }
  static std::string one(const std::string& argument) { return golden::command_line(std::span(&argument, 1)); }

  static nlohmann::ordered_json error_json(const QuantityErrors& e) {
    return {{"lambda_max", e.lambda.max()},         {"lambda_p999", e.lambda.p999()},
            {"lambda_rms", e.lambda.rms()},         {"attribute_max", e.attribute.max()},
            {"attribute_p999", e.attribute.p999()}, {"depth_max", e.depth.max()},
            {"depth_p999", e.depth.p999()},         {"fragments", e.lambda.count()}};
  }

  nlohmann::ordered_json result_json(const InputResult& r) const {
    const CheckResult& c = r.check;
    nlohmann::ordered_json json;
    json["input"] = r.name;
    json["draw_state"] = r.state + r.attributes;
    json["ok"] = r.ok();
    json["complete"] = r.complete;
    put_counters(json, r, draw_metrics);
    put_counters(json, c, fault_counters);
    put_counters(json, r, cycle_metrics);
    json["covered_pixels_per_clock"] = ratio(static_cast<double>(r.pixels), static_cast<double>(r.cycles_rtl));
    char hash[20];
    std::snprintf(hash, sizeof hash, "%016llx", static_cast<unsigned long long>(r.fragment_hash));
    json["fragment_hash"] = hash;
    json["error"] = {{"arithmetic", error_json(c.arithmetic)}, {"snapping", error_json(c.snapping)}};
    json["bound"] = {{"lambda_max", weight_bound(config_)},
                     {"applies", bound_applies()},
                     {"held", bound_applies() && c.compared > 0 && c.within_bound()},
                     {"value_factor", value_bound_factor(config_)},
                     {"attribute_over_bound", c.attribute.max},
                     {"depth_over_bound", c.depth.max},
                     {"exempt_fragments", c.bound_exempt}};
    if (c.worst.ratio >= 0) {
      json["worst"] = {
          {"quad", c.worst.place.quad}, {"position", c.worst.place.index}, {"x", c.worst.place.x},
          {"y", c.worst.place.y},       {"weight", c.worst.weight},        {"lambda_error", c.worst.error},
          {"bound", c.worst.bound},     {"condition", c.worst.condition},  {"error_over_bound", c.worst.ratio}};
      if (r.name != "all") json["worst"]["reproduce"] = reproduce(r, c.worst);
    }
    put_counters(json["counts"], r, count_metrics);
    put_counters(json["counts"], c, fragment_counters);
    json["skips"] = {{"compared", r.skips.compared}, {"quads_that_differ", r.skips.differences}};
    if (r.skips.differences > 0) json["skips"]["first"] = r.skips.first;
    json["counters"] = counters_json(r.counters);
    json["regression"] = {{"inputs_with_limits", r.limits_checked}, {"beyond", r.beyond_limits}};
    if (r.first_divergence) json["first_divergence"] = *r.first_divergence;
    if (c.first.any) json["first_reference_difference"] = c.first.text;
    const double rate = ratio(static_cast<double>(r.pass_cycles), r.loop_seconds);
    const double alone = ratio(static_cast<double>(r.alone_cycles), r.alone_seconds);
    json["wall_seconds"] = r.seconds;
    json["rtl_cycles_per_second"] = rate;
    json["rtl_alone_cycles_per_second"] = alone;
    json["rtl_alone_over_lockstep"] = ratio(alone, rate);
    return json;
  }

  static nlohmann::ordered_json model_json(const ModelCheck& model) {
    nlohmann::ordered_json json;
    json["ok"] = model.ok();
    json["function_arguments"] = model.functions.arguments();
    json["function_beyond"] = model.functions.beyond();
    for (const FunctionResult& f : model.functions.functions)
      json["functions"][std::string(f.name)] = {{"arguments", f.arguments}, {"beyond", f.beyond}};
    json["directed_compared"] = model.directed.compared;
    put_counters(json["directed"], model.directed, fault_counters);
    if (!model.ok()) json["first_fault"] = model.fault();
    return json;
  }

  nlohmann::ordered_json report(const InputResult& total, const std::vector<InputResult>& results,
                                const ModelCheck& model, bool ok) const {
    nlohmann::ordered_json json = golden::begin_report(config_, options_.common.seed, arguments_);
    json.update(result_json(total));
    json["ok"] = ok;
    json["model_alone"] = model_json(model);
    json["stall"] = options_.stall;
    json["gap"] = options_.gap;
    if (!options_.stall_clocks.empty()) json["stall_clocks"] = options_.stall_clocks;
    if (!options_.gap_beats.empty()) json["gap_beats"] = options_.gap_beats;
    json["size"] = options_.common.size;
    if (results.size() > 1) {
      json["inputs"] = nlohmann::ordered_json::array();
      for (const InputResult& result : results) json["inputs"].push_back(result_json(result));
      const auto worst = std::max_element(
          results.begin(), results.end(),
          [](const InputResult& a, const InputResult& b) { return a.check.worst.ratio < b.check.worst.ratio; });
      if (worst->check.worst.ratio >= 0) {
        json["worst"] = result_json(*worst)["worst"];
        json["worst"]["input"] = worst->name;
      }
    }
    return json;
  }

  static void print_row(std::FILE* out, const InputResult& r, bool head) {
    if (head)
      std::fprintf(out, "%-22s %7s %10s %11s %5s  %-9s %-9s %s\n", "input", "quads", "fragments", "cycles", "px/ck",
                   "max error", "of bound", "");
    if (r.check.compared == 0) {
      std::fprintf(out, "%-22s %7llu %10llu %11llu no fragments compared %11s %s\n", r.name.c_str(),
                   static_cast<unsigned long long>(r.quads), static_cast<unsigned long long>(r.fragments),
                   static_cast<unsigned long long>(r.cycles_rtl), "", r.ok() ? "ok" : "FAILED");
      std::fflush(out);
      return;
    }
    std::fprintf(out, "%-22s %7llu %10llu %11llu %5.2f  %-9.2e %8.1f%% %s\n", r.name.c_str(),
                 static_cast<unsigned long long>(r.quads), static_cast<unsigned long long>(r.fragments),
                 static_cast<unsigned long long>(r.cycles_rtl),
                 ratio(static_cast<double>(r.pixels), static_cast<double>(r.cycles_rtl)),
                 r.check.arithmetic.lambda.max(), 100 * std::max(0.0, r.check.worst.ratio), r.ok() ? "ok" : "FAILED");
    std::fflush(out);
  }

  void print_summary(std::FILE* out, const InputResult& r, const ModelCheck& model, bool ok) const {
    const CheckResult& c = r.check;
    const nlohmann::ordered_json json = result_json(r);
    const auto print = [&](std::string_view form, const nlohmann::ordered_json& values) {
      std::fputs(filled(form, values).c_str(), out);
    };
    std::fprintf(out, "\n%s  (%s; seed %llu, stall %g, gap %g; configuration %s)\n\n", r.name.c_str(),
                 options_.common.size.c_str(), static_cast<unsigned long long>(options_.common.seed), options_.stall,
                 options_.gap, summary(config_).c_str());
    if (const std::string state = r.state + r.attributes; !state.empty())
      std::fprintf(out, "  draw state    %s\n", state.c_str());
    if (r.draws > 0)
      print("  draws          {draws} in one machine, each in a state of its own; {clears} clears, {resets} resets\n",
            json);
    print("  lockstep       {quads_drawn} quads, {fragments} fragments, {cycles_rtl} cycles", json);
    std::fputs(r.complete ? "\n" : " (ended early)\n", out);
    if (r.left_out != 0)
      print(
          "                 {left_out} quads left out: {left_out_empty} without a pixel centre, {left_out_behind} "
          "behind "
          "the eye, {left_out_depth} outside znear and zfar, {left_out_line} on a line, {left_out_culled} culled, "
          "{left_out_outside} homogeneous ones that miss the scissor\n",
          json.at("counts"));
    if (r.fanned_faces)
      print("                 {fanned_faces} faces with more than four corners cut into {fan_primitives} primitives\n",
            json);
    print(
        "                 {mismatches} bit mismatches, {cycle_mismatches} cycle mismatches; {compared_bits} bits "
        "compared\n",
        json);
    if (c.compared == 0)
      std::fputs("  coverage       no fragments compared", out);
    else
      std::fprintf(out, "  coverage       %llu fragments against the truth",
                   static_cast<unsigned long long>(c.compared));
    print(", {reference_mismatches} differ\n", json);
    if (r.skips.compared > 0)
      std::fprintf(out, "  skips          %llu fragments of draws with other skips, %llu quads differ\n",
                   static_cast<unsigned long long>(r.skips.compared),
                   static_cast<unsigned long long>(r.skips.differences));
    if (c.tolerated_depth + c.tolerated_visible > 0)
      print(
          "                 tolerated, either being right: {tolerated_depth} within a depth's bound of a limit that "
          "cuts the quad,\n"
          "                 {tolerated_visible} with the eye in the hull and a sum of M W within its bound of 0\n",
          json.at("counts"));
    print("  functions      {function_arguments} directed arguments, {function_beyond} beyond their limit; ",
          model_json(model));
    std::fprintf(out, "directed draws %llu fragments, %llu faults (of the configuration, whatever the input)\n",
                 static_cast<unsigned long long>(model.directed.compared),
                 static_cast<unsigned long long>(model.directed.faults()));
    if (c.compared > 0)
      std::fprintf(out, "  throughput     %.3f covered pixels per clock\n",
                   ratio(static_cast<double>(r.pixels), static_cast<double>(r.cycles_rtl)));
    print_counters(
        out, r.counters,
        config_.performance_counters != 0 ? "the RTL's are the same" : "of the model (performance_counters=0)");
    if (c.compared > 0) print_errors(out, r, json);
    const double rate = ratio(static_cast<double>(r.pass_cycles), r.loop_seconds);
    const double alone = ratio(static_cast<double>(r.alone_cycles), r.alone_seconds);
    std::fprintf(out, "\n  speed          %.0f cycles/s with all comparisons", rate);
    if (alone > 0) std::fprintf(out, "; RTL alone %.0f (%.1f x)", alone, ratio(alone, rate));
    std::fprintf(out, "; %.1f s in all\n\n%s\n", r.seconds, ok ? "OK" : "FAILED");
  }

  /// The errors of what was compared, and where its fragments lie.
  void print_errors(std::FILE* out, const InputResult& r, const nlohmann::ordered_json& json) const {
    const CheckResult& c = r.check;
    std::fprintf(out, "\n  error                   max        p99.9      rms        attribute  depth\n");
    const auto row = [&](const char* name, const QuantityErrors& e) {
      std::fprintf(out, "    %-18s %9.2e  %9.2e  %9.2e  %9.2e  %9.2e\n", name, e.lambda.max(), e.lambda.p999(),
                   e.lambda.rms(), e.attribute.max(), e.depth.max());
    };
    row("arithmetic", c.arithmetic);
    if (!options_.no_snapping) row("snapping", c.snapping);
    if (!bound_applies())
      std::fprintf(out, "    bound              none: quadratic_frac_bits drops bits of D and R^2\n");
    else
      std::fprintf(
          out,
          "    bound              %9.2e  %s; worst weight %.1f %%, attribute %.1f %%, depth %.1f %% of theirs; "
          "c = %.3f\n",
          weight_bound(config_), c.within_bound() ? "held" : "EXCEEDED", 100 * std::max(0.0, c.worst.ratio),
          100 * c.attribute.max, 100 * c.depth.max, value_bound_factor(config_));
    if (r.limits_checked > 0)
      std::fprintf(out, "    regression limits  %s\n", r.beyond_limits.empty() ? "held" : "EXCEEDED");
    const auto print = [&](std::string_view form) { std::fputs(filled(form, json["counts"]).c_str(), out); };
    print(
        "\n  fragments of   eye-crossing quads {eye_crossing} ({eye_crossing_quads} quads), under-4-px quads {tiny}\n"
        "                 within 1/16 px of an edge {near_edge}, within 1 px of a vertex {near_vertex}\n"
        "                 on an edge {on_edge}, a vertex {on_vertex}, two corners {two_corner}, two edges {two_edge}, "
        "ties {tie}\n");
    if (options_.common.verbose)
      print(
          "                 notches {notch}, saturated {saturated}, discarded by z {discarded}, moved by snapping "
          "{coverage_flips}\n");
  }

  static void complain(const InputResult& r) {
    if (r.first_divergence)
      std::fprintf(stderr, "quadrille: %s: lockstep: %s\n", r.name.c_str(), r.first_divergence->c_str());
    if (r.check.first.any)
      std::fprintf(stderr, "quadrille: %s: %llu differences from the truth; the first: %s\n", r.name.c_str(),
                   static_cast<unsigned long long>(r.check.mismatches), r.check.first.text.c_str());
    if (r.check.beyond_bound)
      std::fprintf(
          stderr,
          "quadrille: %s: %llu weights beyond the bound; the worst: quad %u, pixel (%d, %d), error %.3e, bound %.3e\n",
          r.name.c_str(), static_cast<unsigned long long>(r.check.beyond_bound), r.check.worst.place.quad,
          r.check.worst.place.x, r.check.worst.place.y, r.check.worst.error, r.check.worst.bound);
    if (r.check.beyond_attribute || r.check.beyond_depth)
      std::fprintf(stderr, "quadrille: %s: %llu attributes and %llu depths are further off than their bound allows\n",
                   r.name.c_str(), static_cast<unsigned long long>(r.check.beyond_attribute),
                   static_cast<unsigned long long>(r.check.beyond_depth));
    if (r.skips.differences > 0)
      std::fprintf(stderr, "quadrille: %s: a skip changes the fragments of %llu quads; the first: %s\n", r.name.c_str(),
                   static_cast<unsigned long long>(r.skips.differences), r.skips.first.c_str());
    for (const std::string& text : r.beyond_limits)
      std::fprintf(stderr, "quadrille: %s: beyond its regression limit: %s\n", r.name.c_str(), text.c_str());
    if (r.check.compared == 0) std::fprintf(stderr, "quadrille: %s: no fragments compared\n", r.name.c_str());
  }

  const CosimOptions options_;
  const std::vector<std::string> arguments_;
  const Config config_;
  tb::PortWaits waits_;  ///< listed
  tb::WaitKind pattern_ = tb::WaitKind::chance;
  std::optional<FailedPass> failed_;  ///< the first of all inputs
};

}  // namespace

void add_cosim_command(CLI::App& app, Invocation& invocation) {
  CLI::App* command = app.add_subcommand("cosim", "RTL and model in lockstep, their fragments against the truth");
  command->footer(
      "Without an input all built-in scenes run. Exit status 0 only if at least one fragment was compared, nothing\n"
      "differed and the error bound held. A run that fails in lockstep or before the truth shrinks itself: the fewest\n"
      "quads, pixels, stalls and gaps that still fail are written, with a waveform of their last 200 clocks, and the "
      "one\n"
      "command that repeats it is printed.\n\n"
      "Examples:\n"
      "  quadrille cosim --scene fig7_floor --png floor.png\n"
      "  quadrille cosim --mesh pawn.obj --stall 0.5 --gap 0.1 --json report.json\n"
      "  quadrille cosim --stress eye_crossing --count 200 --set significand_bits=24\n"
      "  quadrille cosim --corner z_limits --znear 0.25 --zfar 0.75 --size 64x64\n"
      "  quadrille cosim --stress general --draw-state random:7\n"
      "  quadrille cosim --scene sphere --limit-fragments 2000 --trace sphere.fst\n"
      "  quadrille cosim --scene sphere --size 64x64 --stall 0.3 --gap 0.2 --rtl changed_rtl --shrink fails.quads\n"
      "  quadrille cosim --quads fails.quads --size 34x56 --stall-clocks 80-83 --gap-beats 5:2,9");
  const auto options = std::make_shared<CosimOptions>();
  options->input.add_to(*command);
  options->common.add_to(*command);
  options->state.add_to(*command);
  command->add_option("--stall", options->stall, "Probability per clock that the output is not ready")
      ->type_name("P")
      ->capture_default_str();
  command->add_option("--gap", options->gap, "Probability per clock that no vertex is offered")
      ->type_name("P")
      ->capture_default_str();
  command
      ->add_option("--stall-clocks", options->stall_clocks,
                   "The clocks in which the output is not ready, one by one: 17,40-43, counted from the end of reset")
      ->type_name("LIST")
      ->excludes("--stall");
  command
      ->add_option("--gap-beats", options->gap_beats,
                   "The beats (vertices, from 0) before which none is offered, and for how many clocks: 5:2,9")
      ->type_name("LIST")
      ->excludes("--gap");
  command
      ->add_option("--waits", options->waits,
                   "Pattern of stalls and gaps: bursts, sparse (nearly always), locked (a fixed number of clocks for a "
                   "while) or mixed (all in turn)")
      ->type_name("PATTERN")
      ->excludes("--stall", "--gap", "--stall-clocks", "--gap-beats");
  CLI::Option* const battery =
      command
          ->add_option(
              "--battery", options->battery,
              "Run the groups of draws that a developer of the RTL runs after a change (3 minutes), all of them "
              "or GROUP, MACHINE or INPUT of MACHINE.INPUT")
          ->expected(0, 1)
          ->type_name("[GROUP]");
  command
      ->add_option("--draws", options->draws,
                   "Cut each input into N draws of one machine. Draw states, stalls and gaps are drawn from the seed, "
                   "and clears and resets between draws")
      ->check(whole_number())
      ->type_name("N")
      ->excludes("--stall-clocks", "--gap-beats");
  command
      ->add_option("--attributes", options->attributes,
                   "Attributes in use in one pass; fewer of them make more passes. Default: attribute_slots")
      ->check(CLI::Range(1, max_attribute_slots))
      ->type_name("N");
  command
      ->add_option("--draw-state", options->draw_state,
                   "random or random:SEED: draws scissor, culling, perspective, depth, znear, zfar, attributes in use "
                   "and the skips, and says which (default seed: --seed)")
      ->type_name("random[:SEED]");
  command
      ->add_option("--limit-fragments", options->limit_fragments, "End each input after so many fragments; 0: no limit")
      ->check(whole_number())
      ->type_name("N");
  writes_file(*command, command->add_option("--trace", options->trace, "Waveform of the RTL"), "fst");
  writes_file(*command,
              command->add_option(
                  "--shrink", options->shrink,
                  "Where a run that fails writes the fewest quads that still do, beside them the waveform (F.fst) of "
                  "their last 200 clocks. Default: cosim_failure.quads"),
              "quads");
  command
      ->add_option("--shrink-time", options->shrink_seconds,
                   "Seconds after which the search for less ends with what it has")
      ->check(CLI::NonNegativeNumber)
      ->type_name("S")
      ->capture_default_str();
  command->add_flag("--no-shrink", options->no_shrink, "Do not shrink a run that fails")->excludes("--shrink");
  writes_file(*command,
              command->add_option("--out", options->out, "Picture of the RTL's fragments, with weights and errors"),
              "exr");
  writes_file(*command, command->add_option("--png", options->png, "The same to look at"), "png");
  command->add_option("--texture", options->texture, "Picture instead of the scene's own pattern")->type_name("F.png");
  command
      ->add_option("--shade", options->shade,
                   "uv, texture, normal, lambda, depth, quad, planes or colour; default: what suits the input")
      ->type_name("MODE");
  options->input.add_light_to(*command);
  command
      ->add_option("--rtl", options->rtl,
                   "Verilog instead of the project's: a directory, or one file, of which the ports alone are compared")
      ->type_name("PATH");
  command->add_flag("--compare-skips,!--no-compare-skips", options->compare_skips,
                    "Compare draws with and without each skip that must not change a fragment. Default: yes");
  command->add_flag("--no-snapping-error", options->no_snapping, "Do not measure the error of snapping (quicker)");
  command->add_flag("--no-alone", options->no_alone, "Do not time the RTL alone");
  command->callback([options, battery, &invocation] {
    if (battery->count() > 0 && options->battery.empty()) options->battery = "all";
    invocation.run = [options, &invocation] { return CosimRun(*options, invocation.arguments).run(); };
  });
}

}  // namespace quadrille::cli
