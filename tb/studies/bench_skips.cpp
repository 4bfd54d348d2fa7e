#include "tb/studies/bench_skips.hpp"

#include "golden/io/exr.hpp"
#include "golden/io/json_report.hpp"
#include "model/port/draw_state.hpp"
#include "model/support/parallel.hpp"
#include "model/untimed.hpp"
#include "tb/commands/counters_report.hpp"
#include "tb/engines/engine.hpp"
#include "tb/lockstep/lockstep.hpp"
#include "tb/render/frame.hpp"
#include "tb/studies/bench_timing.hpp"
#include "tb/studies/skip_picture.hpp"
#include "tb/studies/snapped_input.hpp"
#include "tb/support/errors.hpp"
#include "tb/support/output.hpp"
#include "tb/support/progress.hpp"
#include "tb/support/staged_directory.hpp"

#include <cstdio>
#include <memory>

namespace quadrille::tb {
namespace {

/// One scene with one set of skips.
struct Run {
  PerformanceCounters counters;
  std::uint64_t cycles = 0;   ///< without those that wipe the places of hidden tiles behind reset
  std::uint64_t hash = 0;     ///< of the list of fragments
  std::uint64_t places = 0;   ///< of which pixels are drawn in which order, with facing and flags
  std::uint64_t picture = 0;  ///< of what a depth test LESS leaves of the list
  double model_seconds = 0;
};

struct SkipScene : SnappedInput {
  std::vector<Run> runs;  ///< by set of skips
};

/// A column of the table.
struct SkipSet {
  std::string name;  ///< as --skip takes it, but for all and none
  std::uint32_t skips;
  Config config;
};

std::uint64_t quads_of(const Run& run) { return run.counters[PerformanceCounter::quads]; }

double pixels_per_clock(const Run& run) {
  return run.cycles == 0 ? 0 : static_cast<double>(run.counters.pixels()) / static_cast<double>(run.cycles);
}

/// Adds a word to a hash.
void add_word(std::uint64_t& hash, std::uint64_t word) { hash = (hash ^ word) * 0x9e3779b97f4a7c15u ^ hash >> 29; }
constexpr std::uint64_t hash_of_nothing = 0xcbf29ce484222325u;

/// A frame buffer with depth test LESS.
class NearestFragments {
 public:
  NearestFragments(const Config& config, const DrawState& state)
      : width_(state.width), beyond_(1u << config.depth_bits), depth_(state.depth) {
    place_.assign(static_cast<std::size_t>(state.width) * static_cast<std::size_t>(state.height), {.depth = beyond_});
  }

  void draw(const Fragment& fragment) {
    Fragment& place = place_[static_cast<std::size_t>(fragment.y * width_ + fragment.x)];
    if (!depth_ || fragment.depth < place.depth) place = fragment;
  }

  /// Of every bit of the picture.
  std::uint64_t hash() const {
    std::uint64_t hash = hash_of_nothing;
    const auto add = [&hash](std::uint64_t value) { add_word(hash, value); };
    for (const Fragment& f : place_) {
      if (f.depth == beyond_) {
        add(0);
        continue;
      }
      add(std::uint64_t{f.quad} << 32 | f.depth);
      add(std::uint64_t{f.flags} << 1 | (f.front ? 1 : 0));
      for (const std::int64_t attribute : f.attribute) add(static_cast<std::uint64_t>(attribute));
    }
    return hash;
  }

 private:
  int width_;
  std::uint32_t beyond_;  ///< no depth
  bool depth_;
  std::vector<Fragment> place_;
};

constexpr int depth_bits_of_tiles = 12;
constexpr double enough_seconds = 0.02;  ///< of a time of the model, which takes one draw of the scene or several
constexpr int most_timed_draws = 100;

/// The configuration with what a skip needs, where it has nothing of that.
Config able(Config config, std::uint32_t skip) {
  if (skip == skip_hidden && config.hierarchical_z_bits == 0)
    config.set("hierarchical_z_bits", std::min(depth_bits_of_tiles, config.depth_bits));
  if (skip == skip_plane && config.plane_quads == 0) config.set("plane_quads", 1);
  config.validate();
  return config;
}

/// None, each that the program knows, and all together, each on a machine that can.
std::vector<SkipSet> skip_sets(const Config& config) {
  std::vector<SkipSet> sets{{"none", 0, config}};
  Config machine = config;
  std::uint32_t all = 0;
  for (std::size_t i = 0; i < skip_names.size(); ++i) {
    const std::uint32_t skip = 1u << i;
    sets.push_back({std::string(skip_names[i]), skip, able(config, skip)});
    machine = able(machine, skip);
    all |= skip;
  }
  sets.push_back({"all", all, machine});
  return sets;
}

class SkipBench {
 public:
  SkipBench(const SkipBenchOptions& options, const std::vector<std::string>& arguments)
      : options_(options), arguments_(arguments), config_(options.common.config()), sets_(skip_sets(config_)) {}

  int run() {
    std::vector<std::string> read = options_.input.files();
    read.push_back(options_.common.config_file);
    check_outputs({options_.common.json}, read);
    std::optional<StagedDirectory> pictures;
    if (!options_.pictures.empty()) pictures.emplace(options_.pictures);
    load();
    measure();
    if (pictures) {
      for (const SkipScene& scene : scenes_) save_picture(scene, *pictures);
      pictures->commit({});
    }
    if (std::FILE* text = options_.common.text()) print(text);
    if (!options_.common.json.empty()) golden::save_json(options_.common.json, report());
    bool ok = true;
    for (const SkipScene& scene : scenes_) {
      if (const std::string fault = fault_of(scene); !fault.empty()) {
        std::fprintf(stderr, "quadrille: %s: %s\n", scene.input.name.c_str(), fault.c_str());
        ok = false;
      }
    }
    return ok ? exit_ok : exit_mismatch;
  }

 private:
  void load() {
    if (inputs_given(options_.input) != 0) {
      add(options_.input);
      return;
    }
    for (const std::string& name : workload_names()) {
      InputOptions input = options_.input;
      input.scene = name;
      add(input);
    }
  }

  void add(const InputOptions& input_options) {
    SkipScene scene{SnappedInput(input_options, options_.common, config_), {}};
    scene.runs.resize(sets_.size());
    scenes_.push_back(std::move(scene));
  }

  DrawState state_of(const SkipScene& scene, std::size_t set) const {
    DrawState state = scene.state;
    state.skip = sets_[set].skips;
    return with_possible_skips(state, sets_[set].config);  // a scene may have no depth
  }

  /// Clocks on all threads, then times with nothing beside them.
  void measure() {
    const std::size_t runs = scenes_.size() * sets_.size();
    Progress progress("bench --skips", 2 * runs, options_.common.show_progress());
    std::uint64_t done = 0;
    ordered_parallel(
        runs, options_.common.thread_count(),
        [&](std::size_t i) {
          const SkipScene& scene = scenes_[i / sets_.size()];
          LockstepOptions lockstep;
          lockstep.config = sets_[i % sets_.size()].config;
          lockstep.state = state_of(scene, i % sets_.size());
          NearestFragments nearest(lockstep.config, lockstep.state);
          std::uint64_t places = hash_of_nothing;
          const AloneRun alone = run_clocked_model_alone(scene.quads, lockstep, [&](const Fragment& f) {
            nearest.draw(f);
            add_word(places, std::uint64_t{f.quad} << 32 | static_cast<std::uint64_t>(f.y) << 16 |
                                 static_cast<std::uint64_t>(f.x));
            add_word(places, std::uint64_t{f.flags} << 1 | (f.front ? 1 : 0));
          });
          return Run{alone.counters,      alone.cycles - alone.counters[PerformanceCounter::bound_wipe],
                     alone.fragment_hash, places,
                     nearest.hash(),      0};
        },
        [&](std::size_t i, const Run& run) {
          scenes_[i / sets_.size()].runs[i % sets_.size()] = run;
          progress.set(++done, scenes_[i / sets_.size()].input.name);
        });
    for (SkipScene& scene : scenes_) {
      std::vector<std::vector<double>> seconds(sets_.size());
      for (int n = 0; n < options_.repeat; ++n)
        for (std::size_t set = 0; set < sets_.size(); ++set) seconds[set].push_back(time(scene, set));
      for (std::size_t set = 0; set < sets_.size(); ++set) scene.runs[set].model_seconds = median(seconds[set]);
      progress.set(done += sets_.size(), scene.input.name);
    }
  }

  /// Of the scene once, by a model that has drawn it before: what a picture of many takes.
  double time(const SkipScene& scene, std::size_t set) const {
    UntimedModel model(sets_[set].config, state_of(scene, set));
    const auto draw = [&] {
      model.clear_hidden();
      for (const SnappedQuad& quad : scene.quads) model.draw_arrays(quad, [](const FragmentArrays&) {});
    };
    draw();
    const Stopwatch stopwatch;
    int draws = 0;
    do draw();
    while (++draws < most_timed_draws && stopwatch.seconds() < enough_seconds);
    return stopwatch.seconds() / draws;
  }

  /// What a skip that must keep the list of fragments, or the picture, did to it; empty: nothing. Plane quads keep the
  /// list but for the last bits of values: with them hidden tiles are judged by the picture that they alone draw.
  std::string fault_of(const SkipScene& scene) const {
    std::size_t plane = 0;
    while (sets_[plane].skips != skip_plane) ++plane;
    const bool depth_decides = scene.state.depth && (scene.state.znear > 0 || scene.state.zfar < 1);
    for (std::size_t set = 1; set < sets_.size(); ++set) {
      const std::uint32_t skips = sets_[set].skips;
      const std::size_t with = (skips & skip_plane) != 0 ? plane : 0;
      const Run &run = scene.runs[set], &beside = scene.runs[with];
      if ((skips & ~skip_default) == 0 && run.hash != beside.hash)
        return "--skip " + sets_[set].name + " draws other fragments than --skip none";
      if (set == plane && !depth_decides && run.places != scene.runs[0].places)
        return "--skip plane draws other pixels than --skip none, or with other flags";
      if (run.picture != beside.picture)
        return "--skip " + sets_[set].name + " draws another depth-tested picture than --skip " + sets_[with].name;
    }
    return "";
  }

  /// With all skips.
  TileFates fates_of(const SkipScene& scene) const {
    return tile_fates(scene.quads, sets_.back().config, state_of(scene, sets_.size() - 1));
  }

  void save_picture(const SkipScene& scene, const StagedDirectory& folder) const {
    const TileFates fates = fates_of(scene);
    const golden::FrameImage image = skip_picture(fates, config_, scene.state);
    golden::save_png(folder.path(scene.input.name + ".png"), skip_sheet(fates, config_, scene.state, scene.input.name),
                     golden::PngFormat::rgb8);
    golden::save_exr(folder.path(scene.input.name + ".exr"), image);
  }

  void print(std::FILE* text) const {
    std::fprintf(text,
                 "%s\n%zu scene%s, %s; configuration %s; model times of one core, median of %d runs;\nhidden and all "
                 "with hierarchical_z_bits=%d, plane and all with plane_quads=%d; clocks without those that wipe "
                 "behind reset\n\n",
                 golden::command_line(arguments_).c_str(), scenes_.size(), scenes_.size() == 1 ? "" : "s",
                 options_.common.size.c_str(), summary(config_).c_str(), options_.repeat,
                 sets_.back().config.hierarchical_z_bits, sets_.back().config.plane_quads);
    std::fprintf(text, "%-22s %-13s", "", "--skip");
    for (const SkipSet& set : sets_) std::fprintf(text, " %12s", set.name.c_str());
    std::fputs("\n", text);
    for (const SkipScene& scene : scenes_) {
      std::string name = scene.input.name;
      const auto row = [&](const char* what, auto&& value) {
        std::fprintf(text, "%-22s %-13s", name.c_str(), what);
        for (const Run& run : scene.runs) std::fprintf(text, " %12s", value(run).c_str());
        std::fputs("\n", text);
        name.clear();
      };
      row("clocks", [](const Run& run) { return std::to_string(run.cycles); });
      row("quads", [](const Run& run) { return std::to_string(quads_of(run)); });
      row("pixels", [](const Run& run) { return std::to_string(run.counters.pixels()); });
      row("pixels/clock", [](const Run& run) {
        char number[32];
        std::snprintf(number, sizeof number, "%.3f", pixels_per_clock(run));
        return std::string(number);
      });
      row("hidden tiles",
          [](const Run& run) { return std::to_string(run.counters[PerformanceCounter::tiles_hidden]); });
      row("masked tiles",
          [](const Run& run) { return std::to_string(run.counters[PerformanceCounter::tiles_masked]); });
      row("hidden blocks",
          [](const Run& run) { return std::to_string(run.counters[PerformanceCounter::blocks_hidden]); });
      row("plane", [](const Run& run) { return std::to_string(run.counters[PerformanceCounter::pixels_plane]); });
      row("products", [](const Run& run) { return std::to_string(run.counters.products()); });
      row("bound by", [](const Run& run) { return bound_name(most_bound(run.counters)); });
      row("model ms", [](const Run& run) {
        char number[32];
        std::snprintf(number, sizeof number, "%.1f", run.model_seconds * 1e3);
        return std::string(number);
      });
    }
  }

  nlohmann::ordered_json report() const {
    nlohmann::ordered_json json = golden::begin_report(config_, options_.common.seed, arguments_);
    json["size"] = options_.common.size;
    json["repeat"] = options_.repeat;
    json["skips"] = nlohmann::ordered_json::array();
    bool ok = true;
    for (const SkipScene& scene : scenes_) {
      const TileFates fates = fates_of(scene);
      for (std::size_t set = 0; set < sets_.size(); ++set) {
        const Run& run = scene.runs[set];
        nlohmann::ordered_json entry;
        entry["input"] = scene.input.name;
        entry["skip"] = sets_[set].name;
        entry["hierarchical_z_bits"] = sets_[set].config.hierarchical_z_bits;
        entry["plane_quads"] = sets_[set].config.plane_quads;
        entry["cycles"] = run.cycles;
        entry["quads"] = quads_of(run);
        entry["pixels"] = run.counters.pixels();
        entry["pixels_per_clock"] = pixels_per_clock(run);
        entry["blocks_hidden"] = run.counters[PerformanceCounter::blocks_hidden];
        entry["tiles_hidden"] = run.counters[PerformanceCounter::tiles_hidden];
        entry["tiles_masked"] = run.counters[PerformanceCounter::tiles_masked];
        entry["pixels_plane"] = run.counters[PerformanceCounter::pixels_plane];
        entry["products"] = run.counters.products();
        entry["model_seconds"] = run.model_seconds;
        entry["counters"] = counters_json(run.counters);
        json["skips"].push_back(std::move(entry));
      }
      nlohmann::ordered_json& tiles = json["tiles"][scene.input.name];
      for (std::size_t fate = 0; fate < tile_fate_count; ++fate)
        tiles[std::string(tile_fate_names[fate])] = fates.total(static_cast<TileFate>(fate));
      ok = ok && fault_of(scene).empty();
    }
    json["ok"] = ok;
    return json;
  }

  const SkipBenchOptions& options_;
  const std::vector<std::string>& arguments_;
  const Config config_;
  const std::vector<SkipSet> sets_;
  std::vector<SkipScene> scenes_;
};

}  // namespace

int run_skip_bench(const SkipBenchOptions& options, const std::vector<std::string>& arguments) {
  return SkipBench(options, arguments).run();
}

}  // namespace quadrille::tb
