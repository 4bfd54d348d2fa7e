#include "tb/studies/bench_cliffs.hpp"

#include "golden/io/json_report.hpp"
#include "golden/scenes/projection.hpp"
#include "golden/scenes/terrain.hpp"
#include "model/port/draw_state.hpp"
#include "model/untimed.hpp"
#include "tb/judge/check.hpp"
#include "tb/lockstep/lockstep.hpp"
#include "tb/options/input.hpp"
#include "tb/options/written_file.hpp"
#include "tb/studies/bench_timing.hpp"
#include "tb/studies/bench_widths.hpp"
#include "tb/studies/method_input.hpp"
#include "tb/studies/shader/quad_shader.hpp"
#include "tb/support/environment_error.hpp"
#include "tb/support/errors.hpp"
#include "tb/support/output.hpp"
#include "tb/support/progress.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <optional>

namespace quadrille::tb {
namespace {

constexpr int plain_side = 128, view_side = 256;
constexpr std::array<int, 4> viewports{64, 256, 1024, 4096};
constexpr std::array<const char*, 6> viewport_families{"general", "sliver",       "tiny",
                                                       "reflex",  "eye_crossing", "long_span"};
constexpr int terrain_side = 60;
constexpr std::uint64_t family_quads = 800;
constexpr int scissor_side = 128;                     ///< of quads that cover most of any viewport
constexpr const char* setup_scene = "subpixel_mesh";  ///< 75 quads a fragment: what setting up a quad takes
constexpr double shortest_run = 2e-3;                 ///< seconds of a measurement; quicker draws are repeated
constexpr double most_seconds = 0.2;                  ///< of all runs of an engine on a load
constexpr std::uint64_t every_one = std::numeric_limits<std::uint64_t>::max();
constexpr double cliff = 8;                   ///< ratios above are marked
constexpr std::uint64_t least_samples = 500;  ///< of a draw that may be an engine's best

/// What is drawn: a row of the table.
struct Load {
  std::string series, name;
  DrawInput input;
  DrawState state;
  Config config;
  std::uint64_t fragments = 0;  ///< of the model
};

/// Of one engine on one load.
struct Cost {
  std::uint64_t samples = 0;
  double seconds = 0;
  std::size_t quads = 0;

  double ns() const { return samples == 0 ? NAN : 1e9 * seconds / static_cast<double>(samples); }
};

/// Draws a load once, or nothing of it, and says how many fragments came out.
using Draw = std::function<std::uint64_t(bool)>;

constexpr std::size_t every_quad = std::numeric_limits<std::size_t>::max();

/// A column. No draw: the engine cannot draw this load.
struct Subject {
  std::string name, what;
  std::function<Draw(const Load&)> prepare;
  std::size_t most_quads = every_quad;  ///< of a load, the first ones
};

std::uint64_t draw_by(Engine& engine, std::span<const WindowQuad> quads) {
  std::uint64_t samples = 0;
  engine.draw(quads, 0, true, [&](std::span<const EngineSample> some) { samples += some.size(); });
  return samples;
}

Subject engine_subject(EngineKind kind, std::size_t most_quads = every_quad) {
  const EngineInfo& engine = engine_info(kind);
  return {std::string(engine.name), std::string(engine.help),
          [kind, most_quads](const Load& load) {
            EngineSettings settings;
            settings.kind = kind;
            settings.config = load.config;
            settings.state = load.state;
            return [settings, most_quads, &load](bool all) {
              const std::span<const WindowQuad> quads(load.input.quads);
              return draw_by(*make_engine(settings), quads.first(all ? std::min(most_quads, quads.size()) : 0));
            };
          },
          most_quads};
}

Subject method_subject(const char* name) {
  return {name, "method of the papers", [name](const Load& load) -> Draw {
            const std::shared_ptr<const golden::methods::Method> method = golden::methods::make_method(name);
            // They draw all of the view.
            if (load.state.scissor_x0 > 0 || load.state.scissor_x1 < load.state.width) return nullptr;
            if (method->needs_object_space() && load.input.corners.size() != load.input.quads.size()) return nullptr;
            return [method, &load, quads = method_quads(load.input, name), view = method_view(load.state)](bool all) {
              std::uint64_t samples = 0;
              if (!all) return samples;
              std::vector<golden::methods::MethodSample> drawn;
              for (const golden::methods::Quad& quad : quads) {
                drawn.clear();
                method->draw(quad, view, drawn);
                samples += drawn.size();
              }
              return samples;
            };
          }};
}

/// The load's quads for a pass of weights.
struct Snapped {
  Pass pass;
  DrawState state;
  std::vector<SnappedQuad> quads;

  explicit Snapped(const Load& load) : pass(plan_passes(0, true, load.config).front()), state(load.state) {
    state.attributes = static_cast<int>(pass.columns.size());
    quads = snap_pass(load.input.quads, pass, load.config, state);
  }
};

/// The clocked model, whose clocks are the RTL's.
Draw clocked(const Load& load) {
  const auto snapped = std::make_shared<const Snapped>(load);
  LockstepOptions options;
  options.config = load.config;
  options.state = snapped->state;
  return [snapped, options](bool all) {
    return run_clocked_model_alone(std::span(snapped->quads).first(all ? snapped->quads.size() : 0), options).fragments;
  };
}

/// The model's fragments, judged as `cosim` judges the RTL's.
Draw judged(const Load& load) {
  const auto snapped = std::make_shared<const Snapped>(load);
  auto fragments = std::make_shared<std::vector<Fragment>>();
  UntimedModel model(load.config, snapped->state);
  for (const SnappedQuad& quad : snapped->quads)
    model.draw(quad, [&](std::span<const Fragment> f) { fragments->insert(fragments->end(), f.begin(), f.end()); });
  FragmentChecker::Settings settings;
  settings.config = load.config;
  settings.state = snapped->state;
  settings.pass = snapped->pass;
  return [settings, snapped, fragments, &load](bool all) {
    if (!all) return std::uint64_t{0};
    return check_here(settings, load.input.quads, snapped->quads,
                      [&](const auto& sink) {
                        std::ranges::for_each(*fragments, sink);
                        return true;
                      })
        .compared;
  };
}

bool has_shader() {
  try {
    QuadShader::require();
    return true;
  } catch (const EnvironmentError&) {
    return false;
  }
}

std::vector<Subject> subjects() {
  std::vector<Subject> list{engine_subject(EngineKind::model),
                            {"clocked", "clocked model", clocked},
                            {"judge", "the model's fragments judged as cosim does", judged},
                            engine_subject(EngineKind::truth),
                            engine_subject(EngineKind::paper_float),
                            engine_subject(EngineKind::paper_single)};
  if (has_shader()) list.push_back(engine_subject(EngineKind::shader, 40));
  for (const char* method : {"mvc", "split02", "twofold", "bilinear", "hybrid", "refine:20", "adaptive"})
    list.push_back(method_subject(method));
  return list;
}

class CliffBench {
 public:
  CliffBench(const CliffBenchOptions& options, const std::vector<std::string>& arguments)
      : options_(options), arguments_(arguments), config_(options.common.config()), subjects_(subjects()) {}

  int run() {
    check_outputs({options_.common.json}, {options_.common.config_file});
    make_loads();
    measure();
    widths_ = measure_widths(config_, options_.common.seed, options_.repeat, 5 * options_.fragments);
    if (std::FILE* text = options_.common.text()) {
      print(text);
      print_widths(text, widths_);
    }
    if (!options_.common.json.empty()) golden::save_json(options_.common.json, report());
    for (std::size_t s = 0; s < subjects_.size(); ++s)
      if (!std::isfinite(best(s))) {
        std::fprintf(stderr, "quadrille: %s: no fragments\n", subjects_[s].name.c_str());
        return exit_mismatch;
      }
    return exit_ok;
  }

 private:
  Load load_of(const char* series, const std::string& name, const InputOptions& input, int side,
               const Config& config) const {
    Load load{series, name, {}, draw_state_for(config, side, side), config};
    load.input = load_input(input, "", load.state, config, options_.common.seed);
    adjust_state(load.input, load.state);
    return load;
  }

  Load family(const char* series, const std::string& name, const std::string& family, int side,
              const Config& config) const {
    InputOptions input;
    input.stress = family;
    input.count = family_quads;
    return load_of(series, name, input, side, config);
  }

  void make_loads() {
    for (const std::string& name : stress_names()) add(family("family", name, name, plain_side, config_));
    for (const auto& names : {scene_names(), workload_names()})
      for (const std::string& name : names) {
        InputOptions input;
        input.scene = name;
        add(load_of("scene", name, input, plain_side, config_));
      }
    for (const bool inside : {false, true}) {
      Load load{"view",
                inside ? "terrain, from within" : "terrain, from outside",
                {},
                draw_state_for(config_, view_side, view_side),
                config_};
      golden::Projection p =
          golden::project_mesh(golden::terrain_mesh(terrain_side), golden::terrain_camera(terrain_side, inside),
                               view_side, view_side, {golden::AttributeSet::none});
      load.input.quads = std::move(p.quads);
      load.input.corners = std::move(p.corners);
      load.input.textures = std::move(p.textures);
      count(load, every_one, every_one);
      loads_.push_back(std::move(load));
    }
    for (const int side : viewports)
      for (const char* name : viewport_families) {
        Load load = family("viewport", std::string(name) + ", " + std::to_string(side), name, side, config_);
        if (side > scissor_side && load.name.starts_with("eye")) {
          DrawState& state = load.state;
          state.scissor_x0 = state.scissor_y0 = (side - scissor_side) / 2;
          state.scissor_x1 = state.scissor_y1 = (side + scissor_side) / 2;
        }
        add(load);
      }
  }

  /// Without quads that have more than their share of fragments, until there are enough. What has few is drawn several
  /// times, so that what a draw takes as a whole does not count.
  void add(const Load& given) {
    Load load = given;
    count(load, options_.fragments / 5, options_.fragments);
    if (load.fragments == 0) count(load = given, every_one, options_.fragments);
    DrawInput& input = load.input;
    const std::size_t quads = input.quads.size();
    const bool meshes = input.corners.size() == quads;
    const std::uint64_t fragments = load.fragments;
    while (load.fragments < options_.fragments / 4 && input.quads.size() + quads <= family_quads) {
      for (std::size_t i = 0; i < quads; ++i) {
        input.quads.push_back(input.quads[i]);
        if (meshes) input.corners.push_back(input.corners[i]), input.textures.push_back(input.textures[i]);
      }
      load.fragments += fragments;
    }
    loads_.push_back(std::move(load));
  }

  /// Keeps quads of at most `most` fragments until there are `enough`.
  void count(Load& load, std::uint64_t most, std::uint64_t enough) const {
    check_quad_count(load.input.quads.size(), load.config);
    const Snapped snapped(load);
    UntimedModel model(load.config, snapped.state);
    DrawInput& input = load.input;
    const bool meshes = input.corners.size() == input.quads.size();
    std::size_t kept = 0;
    std::uint64_t looked_at = 0;
    for (std::size_t i = 0; i < snapped.quads.size(); ++i) {
      if (load.fragments >= enough || looked_at / 20 >= enough) break;
      std::uint64_t fragments = 0;
      model.draw_arrays(snapped.quads[i], [&](const FragmentArrays& some) { fragments += some.size; });
      looked_at += fragments;
      if (fragments > most) continue;
      load.fragments += fragments;
      std::swap(input.quads[kept], input.quads[i]);
      if (meshes) std::swap(input.corners[kept], input.corners[i]), std::swap(input.textures[kept], input.textures[i]);
      ++kept;
    }
    input.quads.resize(kept);
    if (meshes) input.corners.resize(kept), input.textures.resize(kept);
  }

  void measure() {
    Progress progress("bench --cliffs", loads_.size(), options_.common.show_progress());
    costs_.resize(loads_.size());
    for (std::size_t l = 0; l < loads_.size(); ++l) {
      for (const Subject& subject : subjects_) costs_[l].push_back(cost_of(subject, loads_[l]));
      progress.set(l + 1, loads_[l].name);
    }
  }

  Cost cost_of(const Subject& subject, const Load& load) const {
    const Draw draw = subject.prepare(load);
    if (!draw) return {};
    const auto quickest = [&](bool all) {
      Cost cost{0, std::numeric_limits<double>::infinity(), 0};
      const CpuStopwatch whole;
      for (int n = 0; n < options_.repeat && (n == 0 || whole.seconds() < most_seconds); ++n) {
        const CpuStopwatch stopwatch;
        int draws = 0;
        do cost.samples = draw(all);
        while (++draws, stopwatch.seconds() < shortest_run);
        cost.seconds = std::min(cost.seconds, stopwatch.seconds() / draws);
      }
      return cost;
    };
    Cost cost = quickest(true);
    cost.seconds = std::max(cost.seconds - quickest(false).seconds, 0.0);
    cost.quads = std::min(subject.most_quads, load.input.quads.size());
    return cost;
  }

  /// ns of a fragment, of the load on which there are enough of them and each takes least.
  double best(std::size_t subject) const {
    double least = std::numeric_limits<double>::infinity();
    for (const std::vector<Cost>& row : costs_)
      if (row[subject].samples >= least_samples) least = std::min(least, row[subject].ns());
    return least;
  }

  /// Seconds of a quad with hardly a fragment.
  double setup(std::size_t subject) const {
    for (std::size_t l = 0; l < loads_.size(); ++l)
      if (loads_[l].name == setup_scene)
        return costs_[l][subject].seconds / static_cast<double>(costs_[l][subject].quads);
    return 0;
  }

  /// Time over what setting up the quads and the fragments at their best take together.
  double of_expected(std::size_t load, std::size_t subject) const {
    const Cost& cost = costs_[load][subject];
    return cost.seconds / (1e-9 * best(subject) * static_cast<double>(cost.samples) +
                           setup(subject) * static_cast<double>(cost.quads));
  }

  void print(std::FILE* text) const {
    std::fprintf(text,
                 "%s\nCPU time of one thread for a fragment, set-up of quads included, divided by the engine's least; "
                 "configuration %s.\n-: draws nothing of it. *: more than %.0f times what its quads (set-up, of %s) "
                 "and fragments would take at their least\n\n",
                 golden::command_line(arguments_).c_str(), summary(config_).c_str(), cliff, setup_scene);
    std::fprintf(text, "%-32s %6s %9s", "", "quads", "fragments");
    for (const Subject& subject : subjects_) std::fprintf(text, " %10s", subject.name.c_str());
    std::fprintf(text, "\n%-49s", "least, ns a fragment");
    for (std::size_t s = 0; s < subjects_.size(); ++s) std::fprintf(text, " %10.3g", best(s));
    std::fprintf(text, "\n%-49s", "set-up, ns a quad");
    for (std::size_t s = 0; s < subjects_.size(); ++s) std::fprintf(text, " %10.3g", 1e9 * setup(s));
    std::fputs("\n", text);
    for (std::size_t l = 0; l < loads_.size(); ++l) {
      const Load& load = loads_[l];
      std::fprintf(text, "%-32s %6zu %9llu", (load.series + " " + load.name).c_str(), load.input.quads.size(),
                   static_cast<unsigned long long>(load.fragments));
      for (std::size_t s = 0; s < subjects_.size(); ++s) {
        const double ratio = costs_[l][s].ns() / best(s);
        if (std::isfinite(ratio))
          std::fprintf(text, " %9.1f%c", ratio, of_expected(l, s) > cliff ? '*' : ' ');
        else
          std::fprintf(text, " %9s ", "-");
      }
      std::fputs("\n", text);
    }
  }

  nlohmann::ordered_json report() const {
    nlohmann::ordered_json json = golden::begin_report(config_, options_.common.seed, arguments_);
    json["repeat"] = options_.repeat;
    for (const Subject& subject : subjects_) json["engines"][subject.name] = subject.what;
    for (std::size_t l = 0; l < loads_.size(); ++l) {
      const Load& load = loads_[l];
      nlohmann::ordered_json row;
      row["series"] = load.series;
      row["load"] = load.name;
      row["side"] = load.state.width;
      row["significand_bits"] = load.config.significand_bits;
      row["quads"] = load.input.quads.size();
      row["fragments"] = load.fragments;
      for (std::size_t s = 0; s < subjects_.size(); ++s) {
        const Cost& cost = costs_[l][s];
        nlohmann::ordered_json& entry = row["engines"][subjects_[s].name];
        if (cost.samples == 0) continue;
        entry["quads"] = cost.quads;
        entry["fragments"] = cost.samples;
        entry["cpu_seconds"] = cost.seconds;
        entry["of_best"] = cost.ns() / best(s);
        entry["of_expected"] = of_expected(l, s);
      }
      json["cliffs"].push_back(std::move(row));
    }
    json["widths"] = widths_report(widths_);
    return json;
  }

  const CliffBenchOptions& options_;
  const std::vector<std::string>& arguments_;
  const Config config_;
  const std::vector<Subject> subjects_;
  std::vector<WidthCost> widths_;
  std::vector<Load> loads_;
  std::vector<std::vector<Cost>> costs_;  ///< by load and subject
};

}  // namespace

int run_cliff_bench(const CliffBenchOptions& options, const std::vector<std::string>& arguments) {
  return CliffBench(options, arguments).run();
}

}  // namespace quadrille::tb
