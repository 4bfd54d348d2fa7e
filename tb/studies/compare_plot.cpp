#include "tb/studies/compare_plot.hpp"

#include "golden/io/json_report.hpp"
#include "golden/methods/method.hpp"
#include "tb/studies/compare/frame_error.hpp"
#include "tb/studies/method_frame.hpp"
#include "tb/studies/method_input.hpp"
#include "tb/studies/method_timing.hpp"
#include "tb/support/environment_error.hpp"
#include "tb/support/process.hpp"
#include "tb/support/progress.hpp"
#include "tb/support/source_paths.hpp"

#include <filesystem>

namespace quadrille::tb {
namespace {

namespace fs = std::filesystem;
namespace methods = golden::methods;

constexpr const char* plot_reference = "refine:200";

/// A curve: one method, and the knobs that it is drawn with.
struct Curve {
  std::string method;
  std::vector<std::string> knobs;
};

const std::vector<Curve>& curves() {
  static const std::vector<Curve> list{
      {"mvc", {""}},
      {"split02", {""}},
      {"split13", {""}},
      {"triangle", {"6", "8", "10", "12", "16", "20"}},
      {"twofold", {""}},
      {"projective", {""}},
      {"bilinear", {""}},
      {"refine", {"1", "2", "3", "5", "10", "20", "50", "100"}},
      {"adaptive", {"0.1", "0.03", "0.01", "0.003", "0.001", "0.0003", "0.0001"}},
      {"hybrid", {"pixels", "ndc", "tarini", "bloomenthal"}},
      {"affine", {"0", "0.01", "0.1", "1"}},
  };
  return list;
}

}  // namespace

void write_plot(const DrawInput& input, const EngineSettings& settings, const std::string& directory,
                const CommonOptions& common, const std::vector<std::string>& arguments, int repeats) {
  const bool object_space = input.corners.size() == input.quads.size();
  std::vector<Curve> drawn;
  std::size_t total = 1;
  for (const Curve& curve : curves()) {
    if (!object_space && methods::make_method(curve.method)->needs_object_space()) continue;
    total += curve.knobs.size();
    drawn.push_back(curve);
  }
  Progress progress("plot " + input.name, total, common.show_progress());
  const compare::AttributeImage reference = attribute_image(draw_method(plot_reference, input, settings), input);
  std::uint64_t done = 0;
  nlohmann::ordered_json json = golden::begin_report(settings.config, common.seed, arguments);
  json["input"] = input.name;
  json["title"] = input.title;
  json["size"] = std::to_string(settings.state.width) + "x" + std::to_string(settings.state.height);
  json["reference"] = plot_reference;
  json["curves"] = nlohmann::ordered_json::array();
  for (const Curve& curve : drawn) {
    nlohmann::ordered_json points = nlohmann::ordered_json::array();
    for (const std::string& knob : curve.knobs) {
      progress.set(++done, curve.method);
      const std::string spec = knob.empty() ? curve.method : curve.method + ":" + knob;
      const compare::FrameError error =
          compare::compare_frames(attribute_image(draw_method(spec, input, settings), input), reference);
      const methods::Census census =
          methods::make_method(spec)->census(method_quads(input, spec), method_view(settings.state));
      const MethodTime time = time_method(spec, input, settings.state, repeats);
      nlohmann::ordered_json point;
      point["method"] = spec;
      point["knob"] = knob;
      // Without a pixel to compare there is no error, rather than none.
      const bool compared = error.error.count() > 0;
      point["error_max"] = compared ? nlohmann::ordered_json(error.error.max()) : nlohmann::ordered_json(nullptr);
      point["error_rms"] = compared ? nlohmann::ordered_json(error.rms) : nlohmann::ordered_json(nullptr);
      point["compared"] = error.error.count();
      point["missing"] = error.missing;
      point["undefined"] = error.method_undefined;
      point["triangles"] = census.triangles;
      point["emitted_quads"] = census.emitted_quads;
      point["seconds"] = time.seconds;
      points.push_back(std::move(point));
    }
    json["curves"].push_back({{"method", curve.method}, {"points", std::move(points)}});
  }
  progress.finish();
  golden::save_json((fs::path(directory) / "plot.json").string(), json);
  // Debian's interpreter is the one that Debian's matplotlib belongs to.
  const fs::path script = scripts_directory() / "compare_plot.py";
  run_captured(std::vector<std::string>{find_program("/usr/bin/python3", "python3").string(), script.string(),
                                        (fs::path(directory) / "plot.json").string()});
}

}  // namespace quadrille::tb
