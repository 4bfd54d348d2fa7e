#include "tb/studies/bench_peers.hpp"

#include "golden/io/json_report.hpp"
#include "golden/reference/truth.hpp"
#include "model/port/lane_target.hpp"
#include "model/port/snap.hpp"
#include "model/untimed.hpp"
#include "tb/lockstep/lockstep.hpp"
#include "tb/options/input.hpp"
#include "tb/studies/bench_error.hpp"
#include "tb/studies/bench_stages.hpp"
#include "tb/studies/bench_timing.hpp"
#include "tb/studies/peer_loads.hpp"
#include "tb/studies/shader/quad_shader.hpp"
#include "tb/support/errors.hpp"
#include "tb/support/memory.hpp"
#include "tb/support/output.hpp"
#include "tb/support/progress.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>

namespace quadrille::tb {
namespace {

constexpr std::array<int, 2> sphere_sides{100, 300};
constexpr std::size_t batch_quads = 10'000;  ///< held at a time: the series need no more memory for more quads
constexpr std::uint64_t most_quads_of_a_size = 20'000;
constexpr std::uint64_t largest_number = 1'000'000;
constexpr double number_side = 8;            ///< of the quads of the series of numbers
constexpr std::uint64_t clocked_share = 10;  ///< of the fragments, what the clocked model draws
constexpr int series_repeat = 3;
constexpr int error_side = 128;
constexpr std::uint64_t error_fragments = 16'000;
constexpr int narrowest = 12, widest = 26;  ///< significand_bits

/// Inputs of the errors: where the formulas do well, and where they do not.
struct ErrorInput {
  const char *kind, *name;
};
constexpr std::array<ErrorInput, 9> error_inputs{{{"scene", "fig7_floor"},
                                                  {"scene", "fig8_behind"},
                                                  {"scene", "fig10_concave"},
                                                  {"scene", "sphere"},
                                                  {"stress", "general"},
                                                  {"stress", "perspective"},
                                                  {"stress", "near_edge"},
                                                  {"stress", "near_vertex"},
                                                  {"stress", "sliver"}}};

struct Seconds {
  double cpu = 0, wall = 0;
};

template <class Work>
Seconds measure(Work&& work) {
  const CpuStopwatch cpu;
  const Stopwatch wall;
  work();
  return {cpu.seconds(), wall.seconds()};
}

double median_cpu(const std::vector<Seconds>& runs) {
  std::vector<double> values;
  for (const Seconds& run : runs) values.push_back(run.cpu);
  return median(std::move(values));
}

nlohmann::ordered_json list(const std::vector<Seconds>& runs, double Seconds::*member) {
  nlohmann::ordered_json values = nlohmann::ordered_json::array();
  for (const Seconds& run : runs) values.push_back(run.*member);
  return values;
}

/// The slope of log y over log x by least squares; 0 of fewer than two points.
double slope(const std::vector<std::pair<double, double>>& points) {
  double x = 0, y = 0, xx = 0, xy = 0;
  const auto n = static_cast<double>(points.size());
  for (const auto& [px, py] : points) {
    const double lx = std::log(px), ly = std::log(py);
    x += lx;
    y += ly;
    xx += lx * lx;
    xy += lx * ly;
  }
  const double spread = n * xx - x * x;
  return points.size() < 2 || spread <= 0 ? 0 : (n * xy - x * y) / spread;
}

/// A whole picture, drawn by both in turn.
struct Picture {
  const char* name;
  std::vector<WindowQuad> quads;
  std::uint64_t model_fragments = 0, shader_fragments = 0;
  std::vector<Seconds> model{}, shader{}, readback{};
  StageTimes stages{};  ///< of the model

  double ratio() const { return median_cpu(model) / median_cpu(shader); }
};

/// A point of a series.
struct Point {
  double side = 0;
  std::uint64_t quads = 0, fragments = 0;
  std::uint64_t shader_fragments = 0;   ///< of the quads that the first batch holds, as counted_fragments
  std::uint64_t counted_fragments = 0;  ///< the model's of the same
  double model = 0, shader = 0;         ///< CPU seconds of all quads
  std::uint64_t clocked_fragments = 0, clocks = 0;
  std::uint64_t resident = 0;  ///< bytes of the whole process, behind the runs

  double per_fragment(double seconds) const { return seconds / static_cast<double>(fragments); }
  double clocks_per_fragment() const {
    return clocked_fragments == 0 ? 0 : static_cast<double>(clocks) / static_cast<double>(clocked_fragments);
  }
};

/// One engine on one input.
struct ErrorPoint {
  const char *kind, *name;
  std::string engine;
  int significand_bits = 0;  ///< of the machine; else 0
  BodyResult result{};
  std::uint64_t extra = 0;  ///< pixels that the shader draws and the truth does not
};

class PeerBench {
 public:
  PeerBench(const PeerBenchOptions& options, const std::vector<std::string>& arguments)
      : options_(options), arguments_(arguments), config_(options.common.config()) {
    StateOptions state_options;
    picture_state_ = state_options.state(options.common, config_);
    picture_state_.attributes = peer_attributes;
    if (config_.attribute_slots < peer_attributes)
      throw UsageError("bench --peers needs two attributes; attribute_slots = " +
                       std::to_string(config_.attribute_slots));
    const auto longest = static_cast<unsigned>(std::max(picture_state_.width, picture_state_.height));
    square_ = static_cast<int>(std::min(std::bit_ceil(longest), 1u << config_.viewport_bits));
    series_state_ = picture_state_;
    series_state_.width = series_state_.height = series_state_.scissor_x1 = series_state_.scissor_y1 = square_;
  }

  int run() {
    check_outputs({options_.common.json}, {options_.common.config_file});
    {
      QuadShader shader({.state = picture_state_});
      renderer_ = shader.renderer();
      version_ = shader.version();
      draw_pictures(shader);
    }
    {
      QuadShader shader({.state = series_state_});
      draw_sizes(shader);
      draw_numbers(shader);
    }
    compare_errors();
    if (std::FILE* text = options_.common.text()) print(text);
    if (!options_.common.json.empty()) golden::save_json(options_.common.json, report());
    return exit_ok;
  }

 private:
  std::vector<SnappedQuad> snap(std::span<const WindowQuad> quads, const Config& config, const DrawState& state) const {
    std::vector<SnappedQuad> snapped;
    for (const WindowQuad& quad : quads) snapped.push_back(snap_as(quad, 0, config, state));
    return snapped;
  }

  static std::uint64_t draw_model(UntimedModel& model, std::span<const SnappedQuad> quads) {
    std::uint64_t fragments = 0;
    for (const SnappedQuad& quad : quads)
      model.draw_arrays(quad, [&](const FragmentArrays& some) { fragments += some.size; });
    return fragments;
  }

  static ShaderRect all_of(const DrawState& state) { return {0, 0, state.width, state.height}; }

  /// The goal's three pictures. The quads lie ready, snapped for the one, in a vertex buffer for the other.
  void draw_pictures(QuadShader& shader) {
    const int width = picture_state_.width, height = picture_state_.height;
    pictures_.push_back({"one large quad", large_quad(width, height)});
    pictures_.push_back({"sphere of 100x100", sphere_quads(sphere_sides[0], width, height)});
    pictures_.push_back({"sphere of 300x300", sphere_quads(sphere_sides[1], width, height)});
    Progress progress("bench --peers: pictures", pictures_.size() * static_cast<std::uint64_t>(options_.repeat + 1),
                      options_.common.show_progress());
    std::uint64_t done = 0;
    for (Picture& picture : pictures_) {
      const std::vector<SnappedQuad> snapped = snap(picture.quads, config_, picture_state_);
      ShaderQuads vertices(peer_attributes);
      for (const SnappedQuad& quad : snapped) vertices.add(quad, config_);
      shader.load(vertices);
      UntimedModel model(config_, picture_state_);
      for (int round = -1; round < options_.repeat; ++round) {  // the first one warms up
        shader.clear(all_of(picture_state_));
        const Seconds of_shader = measure([&] { shader.draw(0, snapped.size()); });
        model.clear_hidden();
        const Seconds of_model = measure([&] { picture.model_fragments = draw_model(model, snapped); });
        progress.set(++done, picture.name);
        if (round < 0) continue;
        picture.shader.push_back(of_shader);
        picture.model.push_back(of_model);
        picture.readback.push_back(measure([&] { shader.fetch(all_of(picture_state_)); }));
      }
      picture.shader_fragments = shader.count(0, snapped.size());
      picture.stages = time_stages(snapped, config_, picture_state_, options_.repeat);
    }
  }

  /// `quads` quads of a side, by all three. Only the drawing counts.
  Point draw_series(QuadShader& shader, double side, std::uint64_t quads) {
    const ScatteredQuads scattered(options_.common.seed, side, square_);
    Point point;
    point.side = side;
    point.quads = quads;
    std::vector<double> model_seconds, shader_seconds;
    UntimedModel model(config_, series_state_);
    // Several rounds where they are short.
    const int rounds =
        static_cast<double>(quads) * side * side > 2.0 * static_cast<double>(options_.fragments) ? 1 : series_repeat;
    for (int round = 0; round < rounds; ++round) {
      double of_model = 0, of_shader = 0;
      point.fragments = 0;
      for (std::uint64_t first = 0; first < quads; first += batch_quads) {
        const std::uint64_t last = std::min<std::uint64_t>(quads, first + batch_quads);
        std::vector<SnappedQuad> snapped;
        ShaderQuads vertices(peer_attributes);
        for (std::uint64_t i = first; i < last; ++i) {
          snapped.push_back(snap_as(scattered.quad(static_cast<std::uint32_t>(i)), 0, config_, series_state_));
          vertices.add(snapped.back(), config_);
        }
        shader.load(vertices);
        if (round == 0 && first == 0) {  // warm up: caches, compiled shaders
          point.shader_fragments = shader.count(0, snapped.size());
          point.counted_fragments = draw_model(model, snapped);
          draw_clocked(snapped, point);
        }
        of_shader += measure([&] { shader.draw(0, snapped.size()); }).cpu;
        of_model += measure([&] { point.fragments += draw_model(model, snapped); }).cpu;
      }
      model_seconds.push_back(of_model);
      shader_seconds.push_back(of_shader);
    }
    point.model = median(std::move(model_seconds));
    point.shader = median(std::move(shader_seconds));
    return point;
  }

  void draw_clocked(std::span<const SnappedQuad> quads, Point& point) const {
    LockstepOptions options;
    options.config = config_;
    options.state = series_state_;
    // A quad at least, none cut off.
    const auto area = static_cast<std::uint64_t>(std::max(1.0, point.side * point.side));
    const std::uint64_t enough = std::max<std::uint64_t>(1, options_.fragments / clocked_share / area);
    const AloneRun run = run_clocked_model_alone(quads.first(std::min<std::size_t>(quads.size(), enough)), options);
    point.clocked_fragments = run.fragments;
    point.clocks = run.cycles;
  }

  void draw_sizes(QuadShader& shader) {
    Progress progress("bench --peers: sizes",
                      static_cast<std::uint64_t>(std::bit_width(static_cast<unsigned>(square_))) - 1,
                      options_.common.show_progress());
    for (int side = 1; side <= square_ / 2; side *= 2) {
      const auto area = static_cast<std::uint64_t>(side) * static_cast<std::uint64_t>(side);
      sizes_.push_back(
          draw_series(shader, side, std::clamp<std::uint64_t>(options_.fragments / area, 1, most_quads_of_a_size)));
      progress.set(sizes_.size(), std::to_string(side));
    }
  }

  void draw_numbers(QuadShader& shader) {
    const auto fitting =
        static_cast<std::uint64_t>(32.0 * static_cast<double>(options_.fragments) / (number_side * number_side));
    Progress progress("bench --peers: numbers", 6, options_.common.show_progress());
    for (std::uint64_t quads = 10; quads <= std::min(largest_number, fitting); quads *= 10) {
      numbers_.push_back(draw_series(shader, number_side, quads));
      numbers_.back().resident = resident_bytes();
      progress.set(numbers_.size(), std::to_string(quads));
    }
  }

  void compare_errors() {
    Progress progress("bench --peers: errors", error_inputs.size(), options_.common.show_progress());
    std::uint64_t done = 0;
    for (const ErrorInput& input : error_inputs) {
      compare_input(input);
      progress.set(++done, input.name);
    }
  }

  void compare_input(const ErrorInput& of) {
    StateOptions state_options;
    CommonOptions common = options_.common;
    common.size = std::to_string(error_side) + "x" + std::to_string(error_side);
    DrawState state = state_options.state(common, config_);
    InputOptions which;
    (std::string(of.kind) == "scene" ? which.scene : which.stress) = of.name;
    const DrawInput input = load_input(which, "", state, config_, common.seed);
    adjust_state(input, state);

    // Of the width that is asked for all bodies, of the others the model.
    for (int bits = narrowest - 1; bits <= widest; ++bits) {
      ErrorBench::Settings settings;
      settings.config = config_;
      const bool own = bits < narrowest;
      if (!own && bits == config_.significand_bits) continue;
      if (!own) {
        settings.config.set("significand_bits", bits);
        settings.config.validate();
      }
      settings.state = state;
      settings.limit_fragments = std::min(error_fragments, options_.fragments);
      settings.rtl = own && !options_.no_rtl;
      if (!own)  // the other machines are not asked for
        settings.draw = [](EngineKind, std::span<const SnappedQuad> quads, const Config& config,
                           const DrawState& draw) { return draw_body(EngineKind::model, quads, config, draw); };
      ErrorBench bench(settings, input.quads, 0);
      bench.compare();
      if (!bench.failures().empty()) throw std::runtime_error(std::string(of.name) + ": " + bench.failures().front());
      bench.time(own ? series_repeat : 1);
      for (const EngineKind body : {EngineKind::model, EngineKind::paper_float, EngineKind::truth, EngineKind::rtl}) {
        if (!bench.has(body) || (!own && body != EngineKind::model)) continue;
        const EngineInfo& engine = engine_info(body);
        errors_.push_back({of.kind, of.name, std::string(engine.name),
                           engine.machine ? settings.config.significand_bits : 0, bench.result(body)});
      }
      if (own) compare_shader(of, std::span(input.quads).first(bench.quads()), state);
    }
  }

  /// On the pixels that the truth draws, a quad at a time; then the time of all at once, with the weights as attributes
  /// as the other bodies have them.
  void compare_shader(const ErrorInput& of, std::span<const WindowQuad> given, DrawState state) {
    ErrorPoint point{of.kind, of.name, "shader"};
    BodyResult& result = point.result;
    const Pass weights = plan_passes(0, true, 4).front();
    state.attributes = 4;
    const Config config = snapping_config(config_, state.attributes);
    std::vector<WindowQuad> quads;
    for (const WindowQuad& quad : given) quads.push_back(pass_quad(quad, weights));
    const std::vector<SnappedQuad> snapped = snap(quads, config, state);
    ShaderQuads vertices(state.attributes);
    for (const SnappedQuad& quad : snapped) vertices.add(quad, config);
    QuadShader shader({.state = state});
    shader.load(vertices);
    for (std::size_t q = 0; q < snapped.size(); ++q) {
      const golden::TruthQuad truth(snapped[q], config, state);
      // What the shader draws too much is counted: of vertices that are far or behind the eye it may be anywhere.
      const bool near = std::ranges::all_of(
          snapped[q].vertex, [&](const SnappedVertex& v) { return v.w == std::int32_t{1} << config.frac(); });
      const golden::PixelRect b = near ? truth.bounds() : golden::scissor_of(state);
      if (b.empty()) continue;
      const ShaderRect rect{b.x0, b.y0, b.x1, b.y1};
      shader.clear(rect);
      shader.draw(q, 1);
      const auto pixels = shader.read(rect);
      for (std::size_t i = 0; i < pixels.size(); ++i) {
        const int x = b.x0 + static_cast<int>(i) % (b.x1 - b.x0), y = b.y0 + static_cast<int>(i) / (b.x1 - b.x0);
        const golden::Coverage coverage = truth.cover(x, y);
        bool drawn = coverage.covered && coverage.visible;
        golden::ReferenceSample sample;
        if (drawn) sample = truth.sample(x, y);
        drawn = drawn && (!state.depth || (sample.z >= state.znear && sample.z <= state.zfar));
        if (!drawn) {
          point.extra += pixels[i].drawn ? 1 : 0;
          continue;
        }
        ++result.fragments;
        if (!pixels[i].drawn) {
          ++result.missing;
          continue;
        }
        double error = 0, sum = 0;
        for (std::size_t a = 0; a < 4; ++a) {
          error = std::max(error, std::fabs(pixels[i].attribute[a] - sample.lambda[a]));
          sum += pixels[i].attribute[a];
        }
        if (!std::isfinite(sum) || !std::isfinite(pixels[i].z)) {
          ++result.undefined;
          continue;
        }
        result.lambda.add(error);
        result.depth.add(pixels[i].z - sample.z);
      }
    }
    std::vector<double> runs;
    for (int round = 0; round < series_repeat; ++round)
      runs.push_back(measure([&] { shader.draw(0, snapped.size()); }).cpu);
    result.seconds_per_fragment =
        median(std::move(runs)) / static_cast<double>(std::max<std::uint64_t>(1, result.fragments));
    errors_.push_back(std::move(point));
  }

  // ---- Results ----

  struct Slopes {
    double model, shader, clocks;
  };
  /// Of the cost of a fragment over the pixels of a quad, of quads from `least` to `most` pixels.
  Slopes size_slopes(double least, double most) const {
    std::vector<std::pair<double, double>> model, shader, clocks;
    for (const Point& p : sizes_) {
      const double area = p.side * p.side;
      if (area < least || area > most || p.fragments == 0) continue;
      model.emplace_back(area, p.per_fragment(p.model));
      shader.emplace_back(area, p.per_fragment(p.shader));
      if (p.clocks != 0 && p.clocked_fragments != 0) clocks.emplace_back(area, p.clocks_per_fragment());
    }
    return {slope(model), slope(shader), slope(clocks)};
  }

  /// Of the time of all quads over their number, from `least` quads on.
  Slopes number_slopes(std::uint64_t least) const {
    std::vector<std::pair<double, double>> model, shader;
    for (const Point& p : numbers_) {
      if (p.quads < least) continue;
      model.emplace_back(p.quads, p.model);
      shader.emplace_back(p.quads, p.shader);
    }
    return {slope(model), slope(shader), 0};
  }

  static constexpr double small_quads = 64, large_quads = 4096;  ///< pixels: up to here, from here on
  static constexpr std::uint64_t many_quads = 1000;

  void print(std::FILE* text) const {
    const auto count = [](std::uint64_t n) { return static_cast<unsigned long long>(n); };
    std::fprintf(text,
                 "%s\nshader: %s, OpenGL %s; model: lanes %s; configuration %s; CPU time, one thread each\n\n"
                 "Pictures of %dx%d, u, v and depth, every fragment drawn: medians of %d alternating runs\n\n"
                 "%-20s %8s %11s %11s %10s %10s %14s %11s\n",
                 golden::command_line(arguments_).c_str(), renderer_.c_str(), version_.c_str(),
                 std::string(quadrille::name(lane_target())).c_str(), summary(config_).c_str(), picture_state_.width,
                 picture_state_.height, options_.repeat, "", "quads", "fragments", "of shader", "model ms", "shader ms",
                 "model / shader", "readback ms");
    for (const Picture& p : pictures_)
      std::fprintf(text, "%-20s %8zu %11llu %11llu %10.2f %10.2f %14.3f %11.2f\n", p.name, p.quads.size(),
                   count(p.model_fragments), count(p.shader_fragments), 1e3 * median_cpu(p.model),
                   1e3 * median_cpu(p.shader), p.ratio(), 1e3 * median_cpu(p.readback));
    print_stages(text);

    const auto series = [&](const std::vector<Point>& points) {
      const bool resident = std::ranges::any_of(points, [](const Point& p) { return p.resident != 0; });
      std::fprintf(text, "%10s %9s %11s %17s %18s %14s %20s%s\n", "px of quad", "quads", "fragments",
                   "model ns/fragment", "shader ns/fragment", "model / shader", "RTL clocks/fragment",
                   resident ? " resident MB" : "");
      for (const Point& p : points) {
        std::fprintf(text, "%10.0f %9llu %11llu %17.2f %18.2f %14.3f %20.3f", p.side * p.side, count(p.quads),
                     count(p.fragments), 1e9 * p.per_fragment(p.model), 1e9 * p.per_fragment(p.shader),
                     p.model / p.shader, p.clocks_per_fragment());
        if (p.resident != 0) std::fprintf(text, " %11.1f", 1e-6 * static_cast<double>(p.resident));
        std::fprintf(text, "\n");
      }
    };
    std::fprintf(text, "\nOver the size of quads (%dx%d; clocks: the clocked model's, which are the RTL's)\n\n",
                 square_, square_);
    series(sizes_);
    const Slopes small = size_slopes(0, small_quads), large = size_slopes(large_quads, INFINITY);
    std::fprintf(text,
                 "slope of the cost of a fragment up to %.0f px: model %.2f, shader %.2f, clocks %.2f; from %.0f px: "
                 "model %.2f, shader %.2f, clocks %.2f\n",
                 small_quads, small.model, small.shader, small.clocks, large_quads, large.model, large.shader,
                 large.clocks);
    std::fprintf(text, "\nOver the number of quads\n\n");
    series(numbers_);
    const Slopes whole = number_slopes(0), many = number_slopes(many_quads);
    std::fprintf(text, "slope of the time: model %.3f, shader %.3f; from %llu quads on: model %.3f, shader %.3f\n",
                 whole.model, whole.shader, count(many_quads), many.model, many.shader);

    std::fprintf(
        text,
        "\nErrors of weights against the truth, and times, %dx%d; a weight pass of four attributes and depth\n\n"
        "%-20s %-8s %4s %11s %11s %9s %9s %9s %11s\n",
        error_side, error_side, "", "engine", "s", "largest", "RMS", "undefined", "missed", "extra", "ns/fragment");
    for (const ErrorPoint& e : errors_)
      std::fprintf(text, "%-20s %-8s %4s %11.2e %11.2e %9llu %9llu %9llu %11.1f\n", e.name, e.engine.c_str(),
                   e.significand_bits == 0 ? "" : std::to_string(e.significand_bits).c_str(), e.result.lambda.max(),
                   e.result.lambda.rms(), count(e.result.undefined), count(e.result.missing), count(e.extra),
                   1e9 * e.result.seconds_per_fragment);
  }

  void print_stages(std::FILE* text) const {
    std::fprintf(text, "\nThe model's stages, ns and cycles of the time stamp counter a fragment\n\n%-20s", "");
    for (const std::string_view stage : stage_names) std::fprintf(text, " %16s", std::string(stage).c_str());
    std::fputs("\n", text);
    for (const Picture& p : pictures_) {
      std::fprintf(text, "%-20s", p.name);
      const double fragments = std::max(1.0, static_cast<double>(p.stages.fragments));
      for (std::size_t i = 0; i < stage_names.size(); ++i)
        std::fprintf(text, " %8.2f %7.1f", 1e9 * p.stages.seconds[i] / fragments, p.stages.cycles[i] / fragments);
      if (p.stages.other_quads != 0)
        std::fprintf(text, "  without %llu quads", static_cast<unsigned long long>(p.stages.other_quads));
      std::fputs("\n", text);
    }
  }

  static nlohmann::ordered_json json_of(const std::vector<Point>& points) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const Point& p : points) {
      nlohmann::ordered_json entry;
      entry["pixels"] = p.side * p.side;
      entry["quads"] = p.quads;
      entry["fragments"] = p.fragments;
      entry["model_seconds"] = p.model;
      entry["shader_seconds"] = p.shader;
      entry["counted_fragments"] = p.counted_fragments;
      entry["shader_fragments"] = p.shader_fragments;
      entry["clocked_fragments"] = p.clocked_fragments;
      entry["clocks"] = p.clocks;
      if (p.resident != 0) entry["resident_bytes"] = p.resident;
      json.push_back(std::move(entry));
    }
    return json;
  }

  static nlohmann::ordered_json json_of(const Slopes& slopes, bool clocks) {
    nlohmann::ordered_json json{{"model", slopes.model}, {"shader", slopes.shader}};
    if (clocks) json["clocks"] = slopes.clocks;
    return json;
  }

  nlohmann::ordered_json report() const {
    nlohmann::ordered_json json = golden::begin_report(config_, options_.common.seed, arguments_);
    json["size"] = options_.common.size;
    json["repeat"] = options_.repeat;
    json["renderer"] = renderer_;
    json["opengl"] = version_;
    json["lanes"] = quadrille::name(lane_target());
    for (const Picture& p : pictures_) {
      nlohmann::ordered_json entry;
      entry["name"] = p.name;
      entry["quads"] = p.quads.size();
      entry["model_fragments"] = p.model_fragments;
      entry["shader_fragments"] = p.shader_fragments;
      entry["model_over_shader"] = p.ratio();
      entry["model_cpu_seconds"] = list(p.model, &Seconds::cpu);
      entry["shader_cpu_seconds"] = list(p.shader, &Seconds::cpu);
      entry["model_wall_seconds"] = list(p.model, &Seconds::wall);
      entry["shader_wall_seconds"] = list(p.shader, &Seconds::wall);
      entry["readback_cpu_seconds"] = list(p.readback, &Seconds::cpu);
      for (std::size_t i = 0; i < stage_names.size(); ++i)
        entry["stages"][std::string(stage_names[i])] = {{"cpu_seconds", p.stages.seconds[i]},
                                                        {"cycles", p.stages.cycles[i]}};
      entry["stages"]["fragments"] = p.stages.fragments;
      entry["stages"]["other_quads"] = p.stages.other_quads;
      json["pictures"].push_back(std::move(entry));
    }
    json["sizes"] = json_of(sizes_);
    json["size_slopes"]["small"] = json_of(size_slopes(0, small_quads), true);
    json["size_slopes"]["large"] = json_of(size_slopes(large_quads, INFINITY), true);
    json["numbers"] = json_of(numbers_);
    json["number_slopes"]["all"] = json_of(number_slopes(0), false);
    json["number_slopes"]["many"] = json_of(number_slopes(many_quads), false);
    for (const ErrorPoint& e : errors_) {
      nlohmann::ordered_json entry;
      entry["kind"] = e.kind;
      entry["input"] = e.name;
      entry["engine"] = e.engine;
      entry["significand_bits"] =
          e.significand_bits == 0 ? nlohmann::ordered_json() : nlohmann::ordered_json(e.significand_bits);
      entry["fragments"] = e.result.fragments;
      entry["undefined"] = e.result.undefined;
      entry["missing"] = e.result.missing;
      entry["extra"] = e.extra;
      const bool any = e.result.lambda.count() != 0;
      entry["lambda_max"] = any ? nlohmann::ordered_json(e.result.lambda.max()) : nlohmann::ordered_json();
      entry["lambda_rms"] = any ? nlohmann::ordered_json(e.result.lambda.rms()) : nlohmann::ordered_json();
      entry["seconds_per_fragment"] = e.result.seconds_per_fragment;
      json["errors"].push_back(std::move(entry));
    }
    return json;
  }

  const PeerBenchOptions& options_;
  const std::vector<std::string>& arguments_;
  const Config config_;
  DrawState picture_state_, series_state_;
  int square_ = 0;  ///< side of the viewport of the series
  std::string renderer_, version_;
  std::vector<Picture> pictures_;
  std::vector<Point> sizes_, numbers_;
  std::vector<ErrorPoint> errors_;
};

}  // namespace

int run_peer_bench(const PeerBenchOptions& options, const std::vector<std::string>& arguments) {
  QuadShader::require();
  return PeerBench(options, arguments).run();
}

}  // namespace quadrille::tb
