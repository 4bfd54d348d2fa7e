#include "tb/studies/bench_peers.hpp"

#include "golden/io/json_report.hpp"
#include "model/depth_image.hpp"
#include "model/port/snap.hpp"
#include "model/support/lane_target.hpp"
#include "model/untimed.hpp"
#include "tb/options/input.hpp"
#include "tb/studies/bench_timing.hpp"
#include "tb/studies/peer_errors.hpp"
#include "tb/studies/peer_loads.hpp"
#include "tb/support/errors.hpp"
#include "tb/support/output.hpp"
#include "tb/support/progress.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>

namespace quadrille::tb {
namespace {

constexpr int error_side = 128;
constexpr std::uint64_t error_pixels = 8'000;

/// The model's speed in the fastest mean value form's, picture by picture.
struct Goal {
  std::string_view target, instructions;
  std::array<double, 3> speed;
};
constexpr std::array<Goal, 2> goals{{{"v3", "AVX2", {1.0, 1.5, 2.5}}, {"v4", "AVX-512", {1.5, 2.5, 4.0}}}};

struct ShaderRuns {
  ShaderForm form;
  Triangles triangles;
  std::vector<double> seconds{};
  double difference = 0;           ///< largest of u, v and depth from the model's, where both draw
  std::uint64_t other_pixels = 0;  ///< that one of the two draws

  std::string_view name() const { return shader_forms[static_cast<std::size_t>(form)].name; }
  bool mean_value() const { return shader_forms[static_cast<std::size_t>(form)].mean_value; }
  const char* split() const { return triangles == Triangles::split_013_123 ? "013+123" : "012+023"; }
};

struct TargetRuns {
  std::string name;
  const Goal* goal = nullptr;
  std::string label() const { return goal == nullptr ? name : name + " " + std::string(goal->instructions); }
  bool measured = false;  ///< or the machine, or this build, lacks it
  std::vector<double> seconds{};
  std::vector<double> snapping_seconds{};  ///< of the same with snapping: vertices in, picture out

  double snapping_over_drawing() const { return median(snapping_seconds) / median(seconds); }
};

struct Picture {
  const char* name;
  std::vector<WindowQuad> quads;
  std::vector<ShaderRuns> shaders{};
  std::vector<TargetRuns> targets{};
  std::uint64_t pixels = 0;  ///< of the model

  const ShaderRuns& fastest() const {
    const auto time = [](const ShaderRuns& runs) { return runs.mean_value() ? median(runs.seconds) : INFINITY; };
    return *std::ranges::min_element(shaders, {}, time);
  }
  /// The model's speed in the shader's: of the medians, and the least and the most of a round.
  std::array<double, 3> speed(const TargetRuns& target) const {
    const std::vector<double>& shader = fastest().seconds;
    std::array<double, 3> speed{median(shader) / median(target.seconds), INFINITY, 0};
    for (std::size_t i = 0; i < shader.size(); ++i) {
      speed[1] = std::min(speed[1], shader[i] / target.seconds[i]);
      speed[2] = std::max(speed[2], shader[i] / target.seconds[i]);
    }
    return speed;
  }
};

struct ErrorRow {
  const char* kind;
  std::string name;
  PeerErrors errors;
};

template <class Work>
double cpu_seconds(Work&& work) {
  const CpuStopwatch cpu;
  work();
  return cpu.seconds();
}

#ifdef __clang__
constexpr const char* compiler = __VERSION__;
#else
constexpr const char* compiler = "GCC " __VERSION__;
#endif

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name")) return line.substr(std::min(line.size(), line.find(": ") + 2));
  return "unknown";
}

/// What the shader's whole picture is for the model: cleared, drawn, depth-tested.
/// `snapped(i)` gives quad i.
template <class Snapped>
void draw_into_image(UntimedModel& model, std::size_t quads, Snapped&& snapped, DepthImage<float>& image) {
  image.clear();
  model.clear_hidden();
  for (std::size_t i = 0; i < quads; ++i)
    model.draw_arrays(snapped(i), [&](const FragmentArrays& some) { image.write(some); });
  image.depth();  // settles what waits
}

class PeerBench {
 public:
  PeerBench(const PeerBenchOptions& options, const std::vector<std::string>& arguments)
      : options_(options), arguments_(arguments), config_(options.common.config()) {
    if (config_.attribute_slots < peer_attributes)
      throw UsageError("bench --peers needs two attributes; attribute_slots = " +
                       std::to_string(config_.attribute_slots));
    state_ = StateOptions().state(options.common, config_);
    state_.attributes = peer_attributes;
  }

  int run() {
    check_outputs({options_.common.json}, {options_.common.config_file});
    draw_pictures();
    compare_errors();
    if (std::FILE* text = options_.common.text()) print(text);
    if (!options_.common.json.empty()) golden::save_json(options_.common.json, report());
    return exit_ok;
  }

 private:
  static std::vector<TargetRuns> targets() {
    std::vector<TargetRuns> list;
    for (const LaneTarget target : lane_targets())
      list.push_back({std::string(name(target)), nullptr, can_run(target)});
    for (const Goal& goal : goals) {
      auto place = std::ranges::find(list, goal.target, &TargetRuns::name);
      if (place == list.end()) place = list.insert(list.end(), {std::string(goal.target)});
      place->goal = &goal;
    }
    return list;
  }

  /// The quads lie ready, snapped for the one, in a buffer for the other.
  void draw_pictures() {
    const int width = state_.width, height = state_.height;
    pictures_.push_back({"one large quad", large_quad(width, height)});
    pictures_.push_back({"sphere of 100x100", sphere_quads(100, width, height)});
    pictures_.push_back({"sphere of 300x300", sphere_quads(300, width, height)});
    QuadShader shader({.state = state_, .picture = true});
    renderer_ = shader.renderer();
    version_ = shader.version();
    Progress progress("bench --peers", pictures_.size() * static_cast<std::uint64_t>(options_.repeat + 1),
                      options_.common.show_progress());
    std::uint64_t done = 0;
    const LaneTarget before = lane_target();
    for (Picture& picture : pictures_) {
      picture.targets = targets();
      for (const ShaderFormInfo& info : shader_forms)
        for (const Triangles triangles : {Triangles::split_013_123, Triangles::split_012_023})
          picture.shaders.push_back({info.form, triangles});
      std::vector<SnappedQuad> snapped;
      ShaderQuads vertices(peer_attributes);
      for (const WindowQuad& quad : picture.quads) {
        snapped.push_back(snap_as(quad, 0, config_, state_));
        vertices.add(snapped.back(), config_);
      }
      shader.load(vertices);
      DepthImage<float> image(width, height, peer_attributes, config_, true);
      for (int round = -1; round < options_.repeat; ++round) {  // the first one warms up
        for (ShaderRuns& runs : picture.shaders) {
          shader.choose(runs.form, runs.triangles);
          const double seconds = cpu_seconds([&] { shader.draw_picture(); });
          if (round >= 0) runs.seconds.push_back(seconds);
        }
        for (TargetRuns& runs : picture.targets) {
          if (!runs.measured) continue;
          set_lane_target(runs.name);
          UntimedModel model(config_, state_);
          const double seconds = cpu_seconds([&] {
            draw_into_image(
                model, snapped.size(), [&](std::size_t i) -> const SnappedQuad& { return snapped[i]; }, image);
          });
          const double with_snapping = cpu_seconds([&] {
            draw_into_image(
                model, snapped.size(), [&](std::size_t i) { return snap_quad(picture.quads[i], config_, state_); },
                image);
          });
          if (round < 0) continue;
          runs.seconds.push_back(seconds);
          runs.snapping_seconds.push_back(with_snapping);
        }
        progress.set(++done, picture.name);
      }
      picture.pixels = static_cast<std::uint64_t>(std::ranges::count_if(image.depth(), [](float z) { return z < 1; }));
      for (ShaderRuns& runs : picture.shaders) {
        shader.choose(runs.form, runs.triangles);
        shader.draw_picture();
        compare(shader.read({0, 0, width, height}), image, runs);
      }
    }
    set_lane_target(before);
  }

  static void compare(std::span<const ShaderPixel> shader, DepthImage<float>& image, ShaderRuns& runs) {
    const auto z = image.depth(), u = image.attribute(0), v = image.attribute(1);
    for (std::size_t i = 0; i < shader.size(); ++i) {
      const bool drawn = z[i] < 1;
      if (drawn != shader[i].drawn) ++runs.other_pixels;
      if (!drawn || !shader[i].drawn) continue;
      for (const float difference : {shader[i].z - z[i], shader[i].attribute[0] - u[i], shader[i].attribute[1] - v[i]})
        runs.difference =
            std::isfinite(difference) ? std::max(runs.difference, std::fabs(double{difference})) : INFINITY;
    }
  }

  void compare_errors() {
    PeerErrorBench bench(config_, error_side, error_side);
    const auto add = [&](const char* kind, const std::string& name, const InputOptions& which) {
      const DrawInput input = load_input(which, "", bench.state(), config_, options_.common.seed);
      errors_.push_back({kind, name, bench.errors(input.quads, error_pixels)});
    };
    const std::vector<std::string> scenes = scene_names(), families = stress_names();
    Progress progress("bench --peers: errors", scenes.size() + families.size(), options_.common.show_progress());
    for (const std::string& name : scenes) {
      InputOptions which;
      which.scene = name;
      add("scene", name, which);
      progress.set(errors_.size(), name);
    }
    for (const std::string& name : families) {
      InputOptions which;
      which.stress = name;
      add("stress", name, which);
      progress.set(errors_.size(), name);
    }
  }

  void print(std::FILE* text) const {
    std::fprintf(
        text,
        "%s\nshader: %s, OpenGL %s; model: %s; processor: %s; configuration %s\n\n"
        "A picture of %dx%d: u, v and depth, depth-tested, clear included. CPU ms on one thread, medians of %d "
        "alternating runs,\nby pair of triangles. difference: the largest of u, v and depth from the model's "
        "(bilinear: another interpolation).\none draws: pixels that only the shader or only the model draws\n\n"
        "%-18s %8s %-12s %11s %11s %10s %9s\n",
        golden::command_line(arguments_).c_str(), renderer_.c_str(), version_.c_str(), compiler, processor().c_str(),
        summary(config_).c_str(), state_.width, state_.height, options_.repeat, "", "quads", "form", "013+123 ms",
        "012+023 ms", "difference", "one draws");
    for (const Picture& p : pictures_)
      for (std::size_t i = 0; i < p.shaders.size(); i += 2) {
        const ShaderRuns &one = p.shaders[i], &other = p.shaders[i + 1];
        std::fprintf(text, "%-18s %8zu %-12s %11.2f %11.2f %10.1e %9llu\n", p.name, p.quads.size(),
                     std::string(one.name()).c_str(), 1e3 * median(one.seconds), 1e3 * median(other.seconds),
                     std::max(one.difference, other.difference),
                     static_cast<unsigned long long>(std::max(one.other_pixels, other.other_pixels)));
      }
    std::fprintf(
        text,
        "\nspeed: ms of the fastest mean value form / ms of the model; of a round: the least and the greatest of "
        "a run of each.\nsnapping: time from vertices to picture / time from snapped quads\n\n%-18s "
        "%-11s %9s %9s %9s %7s %15s %7s\n",
        "", "lanes", "model ms", "snapping", "shader ms", "speed", "of a round", "goal");
    for (const Picture& p : pictures_)
      for (const TargetRuns& t : p.targets) print_target(text, p, t);
    print_errors(text);
  }

  double goal_of(const Picture& p, const TargetRuns& t) const {
    return t.goal == nullptr ? 0 : t.goal->speed[static_cast<std::size_t>(&p - pictures_.data())];
  }

  void print_target(std::FILE* text, const Picture& p, const TargetRuns& t) const {
    const double goal = goal_of(p, t);
    if (!t.measured) {
      std::fprintf(text, "%-18s %-11s %61.1f not measured, open\n", p.name, t.label().c_str(), goal);
      return;
    }
    const auto [speed, least, most] = p.speed(t);
    std::fprintf(text, "%-18s %-11s %9.2f %8.2fx %9.2f %7.2f %7.2f-%7.2f", p.name, t.label().c_str(),
                 1e3 * median(t.seconds), t.snapping_over_drawing(), 1e3 * median(p.fastest().seconds), speed, least,
                 most);
    if (goal > 0) std::fprintf(text, " %7.1f %s", goal, speed >= goal ? "met" : "not met");
    std::fputs("\n", text);
  }

  void print_errors(std::FILE* text) const {
    std::fprintf(
        text,
        "\nThe largest error of a weight in fp32 against the truth, %dx%d; undef: pixels with NaN or infinity; "
        "miss: not drawn.\nK: condition of the determinant form, the largest of a pixel (%s)\n\n"
        "%-32s %7s %8s",
        error_side, error_side, "golden/shaders/README.md", "", "pixels", "K");
    for (const ShaderFormInfo& info : shader_forms)
      if (info.mean_value) std::fprintf(text, " %12s %5s %5s", std::string(info.name).c_str(), "undef", "miss");
    for (const ErrorRow& row : errors_) {
      std::fprintf(text, "\n%-32s %7llu %8.1e", (std::string(row.kind) + " " + row.name).c_str(),
                   static_cast<unsigned long long>(row.errors.pixels), row.errors.condition);
      for (const ShaderFormInfo& info : shader_forms) {
        const FormErrors& e = row.errors.forms[static_cast<std::size_t>(info.form)];
        if (info.mean_value)
          std::fprintf(text, " %12.1e %5llu %5llu", e.weight, static_cast<unsigned long long>(e.undefined),
                       static_cast<unsigned long long>(e.missing));
      }
    }
    std::fputs("\n", text);
  }

  nlohmann::ordered_json report() const {
    nlohmann::ordered_json json = golden::begin_report(config_, options_.common.seed, arguments_);
    json["size"] = options_.common.size;
    json["repeat"] = options_.repeat;
    json["renderer"] = renderer_;
    json["opengl"] = version_;
    json["compiler"] = compiler;
    json["processor"] = processor();
    for (const Picture& p : pictures_) {
      nlohmann::ordered_json entry{{"name", p.name},
                                   {"quads", p.quads.size()},
                                   {"pixels", p.pixels},
                                   {"fastest", {{"form", p.fastest().name()}, {"triangles", p.fastest().split()}}}};
      for (const ShaderRuns& s : p.shaders)
        entry["shaders"].push_back({{"form", s.name()},
                                    {"triangles", s.split()},
                                    {"cpu_seconds", s.seconds},
                                    {"difference", s.difference},
                                    {"other_pixels", s.other_pixels}});
      for (const TargetRuns& t : p.targets) {
        nlohmann::ordered_json target{{"lanes", t.name}, {"measured", t.measured}};
        if (t.goal != nullptr) {
          target["instructions"] = t.goal->instructions;
          target["goal"] = goal_of(p, t);
        }
        if (t.measured) {
          const auto [speed, least, most] = p.speed(t);
          target["cpu_seconds"] = t.seconds;
          target["snapping_over_drawing"] = t.snapping_over_drawing();
          target["speed"] = speed;
          target["speed_of_a_round"] = {least, most};
        }
        entry["targets"].push_back(std::move(target));
      }
      json["pictures"].push_back(std::move(entry));
    }
    for (const ErrorRow& row : errors_) {
      nlohmann::ordered_json entry{{"kind", row.kind},
                                   {"input", row.name},
                                   {"quads", row.errors.quads},
                                   {"pixels", row.errors.pixels},
                                   {"condition", row.errors.condition}};
      for (const ShaderFormInfo& info : shader_forms) {
        const FormErrors& e = row.errors.forms[static_cast<std::size_t>(info.form)];
        if (info.mean_value)
          entry["forms"][std::string(info.name)] = {
              {"weight", e.weight}, {"depth", e.depth}, {"undefined", e.undefined}, {"missing", e.missing}};
      }
      json["errors"].push_back(std::move(entry));
    }
    return json;
  }

  const PeerBenchOptions& options_;
  const std::vector<std::string>& arguments_;
  const Config config_;
  DrawState state_;
  std::string renderer_, version_;
  std::vector<Picture> pictures_;
  std::vector<ErrorRow> errors_;
};

}  // namespace

int run_peer_bench(const PeerBenchOptions& options, const std::vector<std::string>& arguments) {
  QuadShader::require();
  return PeerBench(options, arguments).run();
}

}  // namespace quadrille::tb
