// quadrille bench: speeds of all bodies; with --error the error of each against its run time.
#include "golden/io/json_report.hpp"
#include "model/port/snap.hpp"
#include "model/support/lane_target.hpp"
#include "model/support/parallel.hpp"
#include "tb/commands/commands.hpp"
#include "tb/commands/counters_report.hpp"
#include "tb/judge/check.hpp"
#include "tb/options/command_line.hpp"
#include "tb/options/input.hpp"
#include "tb/options/written_file.hpp"
#include "tb/studies/bench_cliffs.hpp"
#include "tb/studies/bench_error.hpp"
#include "tb/studies/bench_meshes.hpp"
#include "tb/studies/bench_peers.hpp"
#include "tb/studies/bench_skips.hpp"
#include "tb/studies/bench_speed.hpp"
#include "tb/studies/studies.hpp"
#include "tb/support/errors.hpp"
#include "tb/support/output.hpp"
#include "tb/support/progress.hpp"

#include <cmath>
#include <memory>
#include <optional>

namespace quadrille::tb {
namespace {

struct BenchOptions {
  SpeedOptions speed;  ///< what both halves need, and the rest of the speeds
  InputOptions input;
  std::optional<int> repeat;
  std::uint64_t limit_fragments = 16'000;
  std::string pictures, meshes;
  bool error = false, skips = false, peers = false, cliffs = false;
};

constexpr int speed_repeat = 5, error_repeat = 3;
constexpr int skips_repeat = 3, peers_repeat = 9;
constexpr const char *error_size = "128x128", *skips_size = "256x256", *peers_size = "1920x1080",
                     *meshes_size = "640x480";

/// A magnitude as a power of two.
std::string power(double value) {
  if (value == 0) return "0";
  if (!std::isfinite(value)) return std::isnan(value) ? "nan" : "inf";
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", std::log2(value));
  return text;
}

/// The largest error; "-" of nothing.
std::string power(const ErrorStats& errors) { return errors.count() == 0 ? "-" : power(errors.max()); }

/// null of nothing.
nlohmann::ordered_json or_null(const ErrorStats& errors, double value) {
  if (errors.count() == 0) return nullptr;
  return value;
}

class ErrorCommand {
 public:
  ErrorCommand(const BenchOptions& options, const std::vector<std::string>& arguments)
      : options_(options),
        common_(options.speed.common),
        arguments_(arguments),
        config_(common_.config()),
        repeat_(options.repeat.value_or(error_repeat)) {
    StateOptions state;
    state_ = state.state(common_, config_);
  }

  int run() {
    std::vector<std::string> read = options_.input.files();
    read.push_back(common_.config_file);
    check_outputs({options_.input.save_camera, common_.json}, read);
    load();
    measure();
    if (std::FILE* text = common_.text()) {
      print_errors(text);
      if (common_.verbose) print_all(text);
      print_summary(text);
    }
    if (!common_.json.empty()) golden::save_json(common_.json, report());
    bool ok = true;
    for (const Input& input : inputs_) {
      for (const std::string& failure : input.bench->failures()) {
        std::fprintf(stderr, "quadrille: %s %s: %s\n", input.kind, input.name.c_str(), failure.c_str());
        ok = false;
      }
    }
    return ok ? exit_ok : exit_mismatch;
  }

 private:
  struct Input {
    const char* kind;
    std::string name;
    std::unique_ptr<ErrorBench> bench;

    const BodyResult& result(EngineKind body) const { return bench->result(body); }
  };

  std::vector<EngineKind> bodies() const {
    std::vector<EngineKind> list(error_engines.begin(), error_engines.end());
    if (options_.speed.no_rtl) list.pop_back();
    return list;
  }

  /// The one that is given, or all scenes and stress families.
  void load() {
    if (inputs_given(options_.input) != 0) {
      const char* kind = !options_.input.scene.empty()   ? "scene"
                         : !options_.input.mesh.empty()  ? "mesh"
                         : !options_.input.quads.empty() ? "quads"
                                                         : "stress";
      add(kind, options_.input);
      return;
    }
    for (const std::string& name : scene_names()) {
      InputOptions input = options_.input;
      input.scene = name;
      add("scene", input);
    }
    for (const std::string& name : stress_names()) {
      InputOptions input = options_.input;
      input.stress = name;
      add("stress", input);
    }
  }

  void add(const char* kind, const InputOptions& input_options) {
    const DrawInput input = load_input(input_options, "", state_, config_, common_.seed);
    print_remark(input, common_);
    ErrorBench::Settings settings;
    settings.config = config_;
    settings.state = state_;
    adjust_state(input, settings.state);
    settings.limit_fragments = options_.limit_fragments;
    settings.rtl = !options_.speed.no_rtl;
    try {
      inputs_.push_back({kind, input.name, std::make_unique<ErrorBench>(settings, input.quads, input.attributes)});
    } catch (const SnapError& error) {
      throw UsageError(describe(error, input));
    }
  }

  /// Errors on all threads, then times with nothing beside them.
  void measure() {
    Progress progress("bench --error", 2 * inputs_.size(), common_.show_progress());
    std::uint64_t done = 0;
    ordered_parallel(
        inputs_.size(), common_.thread_count(),
        [&](std::size_t i) {
          inputs_[i].bench->compare();
          return i;
        },
        [&](std::size_t i, std::size_t) { progress.set(++done, inputs_[i].name); });
    for (Input& input : inputs_) {
      input.bench->time(repeat_);
      progress.set(++done, input.name);
    }
  }

  void print_errors(std::FILE* text) const {
    std::fprintf(text,
                 "%s\n%zu input%s, %s, snapped quads against exact arithmetic on the same; configuration %s\n\n"
                 "Largest error of a weight as a power of two (bound of the machine: %s), fragments where the paper's "
                 "formulas\nare undefined, and fragments that they miss; of the model's pixels per cent in lanes of "
                 "single and of double\nprecision and one at a time (%s)\n\n",
                 golden::command_line(arguments_).c_str(), inputs_.size(), inputs_.size() == 1 ? "" : "s",
                 common_.size.c_str(), summary(config_).c_str(), power(weight_bound(config_)).c_str(),
                 std::string(quadrille::name(lane_target())).c_str());
    std::fprintf(text, "%-24s %9s %8s %9s %8s %8s %9s %8s %8s %6s %6s %6s\n", "", "fragments", "fp32", "undefined",
                 "missed", "fp64", "undefined", "missed", "machine", "single", "double", "one");
    for (const Input& input : inputs_) {
      const BodyResult &fp32 = input.result(EngineKind::paper_single), &fp64 = input.result(EngineKind::paper_float),
                       &model = input.result(EngineKind::model);
      const LanePixels& lanes = model.lanes;
      const double pixels = std::max(1.0, static_cast<double>(lanes.single + lanes.wide + lanes.plain));
      const auto share = [pixels](std::uint64_t of) { return 100 * static_cast<double>(of) / pixels; };
      std::fprintf(text, "%-24s %9llu %8s %9llu %8llu %8s %9llu %8llu %8s %6.1f %6.1f %6.2f%s\n",
                   (std::string(input.kind) + " " + input.name).c_str(), count(model.fragments),
                   power(fp32.lambda).c_str(), count(fp32.undefined), count(fp32.missing), power(fp64.lambda).c_str(),
                   count(fp64.undefined), count(fp64.missing), power(model.lambda).c_str(), share(lanes.single),
                   share(lanes.wide), share(lanes.plain), input.bench->failures().empty() ? "" : "  FAILED");
    }
  }

  void print_all(std::FILE* text) const {
    for (const Input& input : inputs_) {
      std::fprintf(text, "\n%s %s: %zu quads\n%-14s %9s %9s %9s %12s %9s %9s %9s %11s\n", input.kind,
                   input.name.c_str(), input.bench->quads(), "", "lambda", "p99.9", "rms", "attribute", "depth",
                   "undefined", "missed", "ns/fragment");
      for (const EngineKind body : bodies()) {
        const BodyResult& r = input.result(body);
        std::fprintf(text, "%-14s %9.2e %9.2e %9.2e %12.2e %9.2e %9llu %9llu %11.1f\n", name(body), r.lambda.max(),
                     r.lambda.p999(), r.lambda.rms(), r.attribute.max(), r.depth.max(), count(r.undefined),
                     count(r.missing), r.seconds_per_fragment * 1e9);
      }
    }
  }

  void print_summary(std::FILE* text) const {
    std::fprintf(
        text,
        "\nOver all inputs; times on one core, median of %d interleaved runs\n\n%-14s %11s %12s %12s  %-24s %9s %9s\n",
        repeat_, "", "ns/fragment", "of the model", "worst weight", "", "undefined", "missed");
    const double base = seconds_per_fragment(EngineKind::model);
    for (const EngineKind body : bodies()) {
      const Input* worst = &inputs_.front();
      std::uint64_t undefined = 0, missing = 0;
      for (const Input& input : inputs_) {
        const BodyResult& r = input.result(body);
        undefined += r.undefined;
        missing += r.missing;
        if (r.lambda.count() != 0 && !(r.lambda.max() <= worst->result(body).lambda.max())) worst = &input;
      }
      const ErrorStats& error = worst->result(body).lambda;
      const double seconds = seconds_per_fragment(body);
      std::fprintf(text, "%-14s %11.1f %12.3f %12s  %-24s %9llu %9llu\n", name(body), seconds * 1e9,
                   base > 0 ? seconds / base : 0, power(error).c_str(),
                   error.max() == 0 ? "" : (std::string(worst->kind) + " " + worst->name).c_str(), count(undefined),
                   count(missing));
    }
    PerformanceCounters counters;
    for (const Input& input : inputs_) counters += input.result(EngineKind::model_clocked).counters;
    std::fputc('\n', text);
    print_counters(text, counters, "of the clocked model, over all inputs");
  }

  /// Of all inputs, each with its fragments.
  double seconds_per_fragment(EngineKind body) const {
    double seconds = 0, fragments = 0;
    for (const Input& input : inputs_) {
      const auto n = static_cast<double>(input.result(EngineKind::model).fragments);
      seconds += n * input.result(body).seconds_per_fragment;
      fragments += n;
    }
    return fragments > 0 ? seconds / fragments : 0;
  }

  nlohmann::ordered_json report() const {
    nlohmann::ordered_json json = golden::begin_report(config_, common_.seed, arguments_);
    json["size"] = common_.size;
    json["snap"] = "on";
    json["repeat"] = repeat_;
    json["weight_bound"] = weight_bound(config_);
    json["error"] = nlohmann::ordered_json::array();
    for (const Input& input : inputs_) {
      for (const EngineKind body : bodies()) {
        const BodyResult& r = input.result(body);
        nlohmann::ordered_json entry;
        entry["input"] = input.name;
        entry["kind"] = input.kind;
        entry["engine"] = name(body);
        entry["fragments"] = r.fragments;
        entry["seconds_per_fragment"] = r.seconds_per_fragment;
        entry["lambda_max"] = or_null(r.lambda, r.lambda.max());
        entry["lambda_p999"] = or_null(r.lambda, r.lambda.p999());
        entry["lambda_rms"] = or_null(r.lambda, r.lambda.rms());
        entry["attribute_max"] = or_null(r.attribute, r.attribute.max());
        entry["depth_max"] = or_null(r.depth, r.depth.max());
        entry["undefined"] = r.undefined;
        entry["missing"] = r.missing;
        if (body == EngineKind::model)
          entry["pixels_by_lane"] = {{"single", r.lanes.single}, {"double", r.lanes.wide}, {"one", r.lanes.plain}};
        if (body == EngineKind::model_clocked) entry["counters"] = counters_json(r.counters);
        json["error"].push_back(std::move(entry));
      }
    }
    nlohmann::ordered_json failures = nlohmann::ordered_json::array();
    for (const Input& input : inputs_)
      for (const std::string& failure : input.bench->failures())
        failures.push_back(std::string(input.kind) + " " + input.name + ": " + failure);
    json["ok"] = failures.empty();
    json["failures"] = std::move(failures);
    return json;
  }

  /// Beside fp32, float is fp64 here.
  static const char* name(EngineKind body) {
    return body == EngineKind::paper_float ? "fp64" : engine_info(body).name.data();
  }
  static unsigned long long count(std::uint64_t n) { return n; }

  const BenchOptions& options_;
  const CommonOptions& common_;
  const std::vector<std::string>& arguments_;
  const Config config_;
  const int repeat_;
  DrawState state_;
  std::vector<Input> inputs_;
};

int bench(BenchOptions& options, bool size_given, bool fragments_given, const std::vector<std::string>& arguments) {
  if (options.cliffs) {
    CliffBenchOptions cliffs{options.speed.common};
    cliffs.repeat = options.repeat.value_or(cliffs.repeat);
    if (fragments_given) cliffs.fragments = options.speed.fragments;
    return run_cliff_bench(cliffs, arguments);
  }
  if (options.peers) {
    if (!size_given) options.speed.common.size = peers_size;
    return run_peer_bench({options.speed.common, options.repeat.value_or(peers_repeat)}, arguments);
  }
  if (!options.meshes.empty()) {
    if (!size_given) options.speed.common.size = meshes_size;
    return run_mesh_bench({options.speed.common, options.meshes}, arguments);
  }
  if (options.skips) {
    if (!size_given) options.speed.common.size = skips_size;
    return run_skip_bench(
        {options.speed.common, options.input, options.repeat.value_or(skips_repeat), options.pictures}, arguments);
  }
  if (options.error) {
    if (!size_given) options.speed.common.size = error_size;
    return ErrorCommand(options, arguments).run();
  }
  options.speed.repeat = options.repeat.value_or(speed_repeat);
  check_outputs({options.speed.common.json}, {});
  return run_speed_bench(options.speed, arguments);
}

}  // namespace

void add_bench_command(CLI::App& app, Invocation& invocation) {
  CLI::App* command = app.add_subcommand("bench", bench_description);
  end_help(*command,
           "Without a study all engines draw the same mesh in turn, several times. The median counts.\n\n"
           "--error: run time per fragment on one core, and errors against exact arithmetic on the snapped quads.\n"
           "--skips: clocks and counters of the clocked model, time of the untimed model on one core. Colours of "
           "tiles in the pictures:\n"
           "  grey    entered\n"
           "  violet  hidden\n"
           "  green   not hit\n"
           "  blue    in a block that was not hit\n"
           "  orange  of a quad left out by depth\n"
           "  yellow  of a quad left out because it is a line\n"
           "  red     of a culled quad\n"
           "--meshes: clocks of the clocked model, with 1, 2 and 4 pixels a clock, and what bound them.\n"
           "--peers: CPU time of a picture on one thread, for each instruction set; errors of shaders in fp32.\n"
           "--cliffs: CPU time per fragment on one thread, divided by the engine's least (tb/studies/README.md); the "
           "model's ns a pixel by family, significand_bits and instruction set.",
           "0 done; 1 bound exceeded, engines differ, or a skip changed fragments that it must keep; 2 usage or input "
           "error; 3 missing tool",
           {"bench --no-rtl --set significand_bits=24 --json bench.json",
            "bench --error --stress sliver --count 200 --verbose", "bench --skips --json skips.json --pictures skips"});
  const auto options = std::make_shared<BenchOptions>();
  SpeedOptions& speed = options->speed;
  constexpr const char* studies = "Studies";
  CLI::Option* error = command
                           ->add_flag("--error", options->error,
                                      "Errors and run times of all engines (default input: all scenes and families)")
                           ->group(studies);
  CLI::Option* skips =
      command->add_flag("--skips", options->skips, "Clocks and work without skips, with each and with all")
          ->group(studies)
          ->excludes(error);
  CLI::Option* peers = command->add_flag("--peers", options->peers, "The model against shaders on OpenGL")
                           ->group(studies)
                           ->excludes(error)
                           ->excludes(skips);
  CLI::Option* cliffs =
      command->add_flag("--cliffs", options->cliffs, "Inputs and configurations with unusually slow fragments")
          ->group(studies)
          ->excludes(error)
          ->excludes(skips)
          ->excludes(peers);
  CLI::Option* meshes =
      command->add_option("--meshes", options->meshes, "Clocks of the machine for each *.obj of a folder, at each rate")
          ->type_name("DIR")
          ->group(studies)
          ->excludes(error)
          ->excludes(skips)
          ->excludes(peers)
          ->excludes(cliffs);
  writes_folder(command->add_option("--pictures", options->pictures, "PNG and EXR of the tiles of each scene"))
      ->group(output_group)
      ->needs(skips);
  options->input.add_to(*command);
  speed.common.add_to(*command);
  command
      ->add_option("--repeat", options->repeat, "Runs of each (default: 5; --error, --skips, --cliffs: 3; --peers: 9)")
      ->type_name("N")
      ->check(CLI::Range(1, 1000))
      ->excludes(meshes);
  command->add_option("--quad-size", speed.quad_size, "Side of the mesh's quads in pixels")
      ->type_name("PX")
      ->check(CLI::Range(2, 4096))
      ->capture_default_str()
      ->excludes(error)
      ->excludes(skips)
      ->excludes(peers)
      ->excludes(cliffs);
  CLI::Option* fragments =
      command
          ->add_option("--fragments", speed.fragments,
                       "Fragments per run of the model (--cliffs: 10000); fewer for slower engines")
          ->type_name("N")
          ->check(CLI::Range(std::uint64_t{1000}, std::uint64_t{1} << 40))
          ->capture_default_str()
          ->excludes(error)
          ->excludes(skips)
          ->excludes(peers);
  command->add_option("--limit-fragments", options->limit_fragments, "Fragments per input, whole quads, at least 16")
      ->type_name("N")
      ->check(whole_number())
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 40))
      ->capture_default_str()
      ->needs(error);
  command
      ->add_option_function<std::string>(
          "--lanes", [](const std::string& wanted) { set_lane_target(wanted); },
          "Instruction set of the model: baseline, v2, v3 or v4 (default: the processor's best; --peers, last table of "
          "--cliffs: each)")
      ->type_name("NAME")
      ->excludes(peers);
  CLI::Option* no_rtl =
      command->add_flag("--no-rtl", speed.no_rtl, "Without the RTL; needs no Verilator")->excludes(peers);
  command->add_option("--verilator", speed.verilator, "A second Verilator that simulates the RTL alone too")
      ->check(CLI::ExistingFile)
      ->excludes(no_rtl)
      ->excludes(error)
      ->excludes(skips)
      ->excludes(peers)
      ->excludes(cliffs)
      ->excludes(meshes);
  CLI::Option* size = command->get_option("--size");
  size->excludes(cliffs);
  size->default_str("512x512; --error: 128x128; --skips: 256x256; --meshes: 640x480; --peers: 1920x1080");
  std::vector<const CLI::Option*> of_input;
  for (const char* input : {"--scene", "--mesh", "--camera", "--view", "--up", "--save-camera", "--quads", "--stress",
                            "--count", "--corner", "--strict"})
    of_input.push_back(command->get_option(input));
  command->callback([options, size, fragments, of_input, &invocation] {
    if (!options->error && !options->skips)
      for (const CLI::Option* input : of_input)
        if (input->count() != 0) throw UsageError(input->get_name() + " needs --error or --skips");
    invocation.run = [options, size, fragments, &invocation] {
      return bench(*options, size->count() != 0, fragments->count() != 0, invocation.arguments);
    };
  });
}

}  // namespace quadrille::tb
