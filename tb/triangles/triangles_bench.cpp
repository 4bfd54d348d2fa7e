// triangles_bench: the quad machine and the triangle machine draw the same inputs, each quad as two triangles. Clocks
// of the quad machine are the clocked model's, which are the RTL's; those of the triangle machine its RTL's.
#include "golden/io/json_report.hpp"
#include "golden/reference/truth.hpp"
#include "tb/commands/counters_report.hpp"
#include "tb/lockstep/lockstep.hpp"
#include "tb/options/command_line.hpp"
#include "tb/options/input.hpp"
#include "tb/passes/pass.hpp"
#include "tb/triangles/exact_triangle.hpp"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>

namespace quadrille::tb {
namespace {

/// One machine on one input.
struct Drawn {
  std::uint64_t clocks = 0, primitives = 0;
  PerformanceCounters counters;
  double error = 0;  ///< the largest of an attribute, against exact arithmetic on the same snapped vertices

  nlohmann::ordered_json json(std::size_t quads) const {
    return {{"primitives", primitives},
            {"pixels", counters.pixels()},
            {"clocks", clocks},
            {"pixels_per_clock", static_cast<double>(counters.pixels()) / static_cast<double>(clocks)},
            {"clocks_per_quad", static_cast<double>(clocks) / static_cast<double>(quads)},
            {"bound", bound_name(most_bound(counters))},
            {"attribute_error", error}};
  }
};

class TrianglesBench {
 public:
  explicit TrianglesBench(const CommonOptions& common)
      : common_(common), config_(with_counters(common.config())), machine_(config_, QUADRILLE_TRIANGLES) {}

  nlohmann::ordered_json measure(const std::string& name) const {
    InputOptions options;
    (std::filesystem::path(name).extension() == ".obj" ? options.mesh : options.scene) = name;
    DrawState state = StateOptions().state(common_, config_);
    const DrawInput input = load_input(options, "", state, config_, common_.seed);
    adjust_state(input, state);
    const Pass pass = plan_passes(input.attributes, false, config_).front();
    state.attributes = static_cast<int>(pass.columns.size());
    const std::vector<SnappedQuad> quads = snap_pass(input.quads, pass, config_, state),
                                   triangles = snap_pass(split_quads(input.quads), pass, config_, state);
    return {{"input", input.name},
            {"quads", quads.size()},
            {"quad", draw_quads(quads, state).json(quads.size())},
            {"triangle", draw_triangles(triangles, state).json(quads.size())}};
  }

  const Config& config() const { return config_; }

 private:
  static Config with_counters(Config config) {
    config.set("performance_counters", 1);
    config.validate();
    return config;
  }

  /// `exact`: of a slot, without its base. What the output has clamped does not count.
  template <class Exact>
  void compare(const Fragment& fragment, const QuadBase& base, const DrawState& state, const Exact& exact,
               double& error) const {
    for (std::size_t slot = 0; slot < static_cast<std::size_t>(state.attributes); ++slot) {
      const auto above = static_cast<double>(fragment.attribute[slot] - base.attribute[slot]);
      if ((fragment.flags & flag_saturated) == 0)
        error = std::max(error, std::fabs(std::ldexp(above, -config_.attribute_frac()) - exact(slot)));
    }
  }

  Drawn draw_quads(std::span<const SnappedQuad> quads, const DrawState& state) const {
    LockstepOptions options;
    options.config = config_;
    options.state = state;
    Drawn drawn;
    drawn.primitives = quads.size();
    std::uint32_t last = 0;
    std::optional<golden::TruthQuad> truth;
    const AloneRun run = run_clocked_model_alone(quads, options, [&](const Fragment& fragment) {
      const SnappedQuad& quad = quads[fragment.quad];
      if (!truth || last != fragment.quad) truth.emplace(quad, config_, state);
      last = fragment.quad;
      const golden::ReferenceSample sample = truth->sample(fragment.x, fragment.y);
      compare(
          fragment, quad.base, state, [&](std::size_t slot) { return sample.attribute_above[slot]; }, drawn.error);
    });
    drawn.counters = run.counters;
    drawn.clocks = run.cycles - run.counters[PerformanceCounter::bound_wipe];
    return drawn;
  }

  Drawn draw_triangles(std::span<const SnappedTriangle> triangles, const DrawState& state) const {
    Drawn drawn;
    drawn.primitives = triangles.size();
    const TriangleRun run = machine_.draw(triangles, state, [&](const Fragment& fragment) {
      const SnappedTriangle& triangle = triangles[fragment.quad];
      const auto exact = ExactTriangle(triangle, config_, state).at(fragment.x, fragment.y);
      if (!exact) throw std::logic_error("a fragment of the triangle machine is not covered");
      compare(
          fragment, triangle.base, state, [&](std::size_t slot) { return exact->attribute[slot].value; }, drawn.error);
    });
    drawn.counters = run.counters;
    drawn.clocks = run.clocks;
    return drawn;
  }

  const CommonOptions& common_;
  Config config_;
  TriangleMachine machine_;
};

void print(std::FILE* text, const nlohmann::ordered_json& input) {
  for (const char* machine : {"quad", "triangle"}) {
    const auto& drawn = input[machine];
    std::fprintf(text, "%-22s %-9s %8d %9d %9d %13.3f %12.1f  %-9s 2^%.1f\n", input["input"].get<std::string>().c_str(),
                 machine, drawn["primitives"].get<int>(), drawn["pixels"].get<int>(), drawn["clocks"].get<int>(),
                 drawn["pixels_per_clock"].get<double>(), drawn["clocks_per_quad"].get<double>(),
                 drawn["bound"].get<std::string>().c_str(), std::log2(drawn["attribute_error"].get<double>()));
  }
}

int run(int argc, char** argv) {
  CLI::App app("Draws each input by the quad machine, and as two triangles a quad by the triangle machine.");
  app.formatter(help_formatter());
  CommonOptions common;
  std::vector<std::string> inputs;
  common.add_to(app);
  app.add_option("input", inputs, "Scenes, or meshes *.obj")->required();
  CLI11_PARSE(app, argc, argv);
  const TrianglesBench bench(common);
  nlohmann::ordered_json json =
      golden::begin_report(bench.config(), common.seed, std::vector<std::string>(argv + 1, argv + argc));
  std::FILE* text = common.text();
  if (text != nullptr)
    std::fprintf(text, "%-22s %-9s %8s %9s %9s %13s %12s  %-9s %s\n", "", "machine", "drawn", "pixels", "clocks",
                 "pixels/clock", "clocks/quad", "bound by", "attribute error");
  for (const std::string& name : inputs) {
    json["inputs"].push_back(bench.measure(name));
    if (text != nullptr) print(text, json["inputs"].back());
  }
  if (!common.json.empty()) golden::save_json(common.json, json);
  return 0;
}

}  // namespace
}  // namespace quadrille::tb

int main(int argc, char** argv) try { return quadrille::tb::run(argc, argv); } catch (const std::exception& error) {
  std::fprintf(stderr, "triangles_bench: %s\n", error.what());
  return 1;
}
