// quadrille render: a depth-tested picture by any engine.
#include "tb/commands/commands.hpp"
#include "tb/commands/counters_report.hpp"
#include "tb/options/command_line.hpp"

#include "golden/io/exr.hpp"
#include "golden/io/json_report.hpp"
#include "model/port/snap.hpp"
#include "tb/options/input.hpp"
#include "tb/options/written_file.hpp"
#include "tb/render/frame.hpp"
#include "tb/support/choices.hpp"
#include "tb/support/errors.hpp"
#include "tb/support/output.hpp"
#include "tb/support/progress.hpp"
#include "tb/support/stopwatch.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

namespace quadrille::tb {
namespace {

struct RenderOptions {
  CommonOptions common;
  StateOptions state;
  InputOptions input;
  EngineOptions engine;
  std::string method, texture, shade, out, png;
  bool no_error = false;
};

int render(const RenderOptions& options, const Invocation& invocation) {
  const Stopwatch start;
  EngineSettings settings = options.engine.settings(options.common, options.state);
  MethodEngineMaker make_method_engine;
  if (!options.method.empty()) {
    make_method_engine = invocation.method(options.method);
    settings.snap = false;
  }
  if (options.out.empty() && options.png.empty())
    throw UsageError("--out F.exr or F.npz and --png F.png are missing; give one or both");
  std::vector<std::string> read = options.input.files();
  read.insert(read.end(), {options.common.config_file, options.texture});
  check_outputs({options.out, options.png, options.input.save_camera, options.common.json}, read);

  const DrawInput input = load_input(options.input, shade_of(options.shade, options.texture), settings.state,
                                     settings.config, options.common.seed, settings.threads);
  print_remark(input, options.common);
  adjust_state(input, settings.state);
  ShadeSettings shading;
  shading.shade = input.shade;
  shading.slots = shade_slots(input.shade, input);
  shading.texture = make_texture(options.texture, input);
  shading.lighting = input.lighting;
  shading.depth = settings.state.depth;
  shading.threads = settings.threads;

  const std::string& drawn_by = options.method.empty() ? options.engine.engine : options.method;
  const bool errors = drawn_by != engine_info(EngineKind::truth).name && !options.no_error &&
                      (!options.out.empty() || !options.common.json.empty());
  // Of plane quads depth depends on what the first pass carries.
  const bool weights =
      errors || !options.out.empty() || shades_weights(shading) || (settings.state.skip & skip_plane) != 0;
  FrameBuffer frame(settings.state.width, settings.state.height, settings.state.depth, settings.config,
                    input.attributes, weights);
  try {
    Progress progress("render " + input.name, input.quads.size(), options.common.show_progress());
    const std::unique_ptr<Engine> engine =
        options.method.empty() ? make_engine(settings) : make_method_engine(input, settings);
    const bool drawn = engine->draw_quads(input.quads, input.attributes, weights, [&](const QuadFragments& quad) {
      frame.add(quad);
      if (quad.index % 64 == 0) progress.set(quad.index);
    });
    if (!drawn)
      engine->draw(input.quads, input.attributes, weights, [&](std::span<const EngineSample> samples) {
        frame.add(samples);
        progress.set(samples.back().index + 1);
      });
  } catch (const SnapError& error) {
    throw UsageError(describe(error, input));
  }

  golden::FrameImage image = shade_frame(frame, shading);
  if (errors)
    add_error_layers(frame, input.quads, settings.config, settings.state, settings.snap, settings.threads, image);
  if (has_ending(options.out, "npz"))
    golden::save_frame_npz(options.out, image);
  else if (!options.out.empty())
    golden::save_exr(options.out, image);
  if (!options.png.empty()) save_frame_png(options.png, image);

  const double seconds = start.seconds();
  std::optional<PerformanceCounters> counters;
  if (options.method.empty() && reports_counters(options.common))
    counters = count_draw(settings, input.quads, input.attributes);
  double error_max = 0;
  std::uint64_t error_nans = 0;  // std::max would pass over them
  for (const auto& [name, layer] : image.error) {
    for (const float error : layer) {
      if (std::isnan(error)) ++error_nans;
      error_max = std::max(error_max, std::fabs(static_cast<double>(error)));
    }
  }

  if (!options.common.json.empty()) {
    nlohmann::ordered_json json = golden::begin_report(settings.config, options.common.seed, invocation.arguments);
    json["input"] = input.name;
    json[options.method.empty() ? "engine" : "method"] = drawn_by;
    json["shade"] = input.shade;
    json["size"] = options.common.size;
    json["quads"] = input.quads.size();
    json["triangles"] = input.triangles;
    json["fanned_faces"] = input.fanned_faces;
    json["fan_primitives"] = input.fan_primitives;
    json["skipped_lines"] = input.skipped_lines;
    json["fragments"] = frame.fragments();
    json["undefined"] = frame.undefined();
    json["pixels_drawn"] = frame.pixels_drawn();
    if (!image.error.empty()) json["error_max"] = error_max;
    if (error_nans > 0) json["error_nans"] = error_nans;
    json["wall_seconds"] = seconds;
    if (counters) json["counters"] = counters_json(*counters);
    golden::save_json(options.common.json, json);
  }
  if (std::FILE* text = options.common.text()) {
    std::fprintf(text, "%s by %s: %zu quads, %llu fragments, %llu pixels drawn", input.name.c_str(), drawn_by.c_str(),
                 input.quads.size(), static_cast<unsigned long long>(frame.fragments()),
                 static_cast<unsigned long long>(frame.pixels_drawn()));
    if (frame.undefined()) std::fprintf(text, ", %llu undefined", static_cast<unsigned long long>(frame.undefined()));
    if (!image.error.empty()) std::fprintf(text, ", largest weight error %.2e", error_max);
    if (error_nans > 0) std::fprintf(text, " and %llu that are NaN", static_cast<unsigned long long>(error_nans));
    std::fprintf(text, ", %.2f s\n", seconds);
    for (const std::string& file : {options.out, options.png, options.input.save_camera, options.common.json})
      if (!file.empty() && file != "-") std::fprintf(text, "wrote %s\n", file.c_str());
    if (counters) print_counters(text, *counters, "of the clocked model");
    if (input.fanned_faces)
      std::fprintf(text, "%zu faces with more than four corners were cut into %zu primitives\n", input.fanned_faces,
                   input.fan_primitives);
    if (input.crossed_faces)
      std::fprintf(text, "%zu of these faces cross themselves; their pictures may be wrong\n", input.crossed_faces);
    if (input.skipped_lines && options.common.verbose)
      std::fprintf(text, "%zu lines of the mesh were skipped\n", input.skipped_lines);
  }
  if (frame.fragments() == 0)
    std::fprintf(stderr, "quadrille: %s: no fragments drawn, the picture is empty\n", input.name.c_str());
  return exit_ok;
}

}  // namespace

void add_render_command(CLI::App& app, Invocation& invocation) {
  CLI::App* command = app.add_subcommand("render", "Draw a depth-tested picture with any engine");
  end_help(
      *command,
      "The EXR holds R G B A, Z, the weights L0 to L3, the quad id, and error.L0 to error.L3 (weights minus the "
      "truth's). With --json or --verbose the engines rtl and model also report performance counters.",
      "0 done; 2 usage or input error; 3 missing tool",
      {"render --scene sphere --png sphere.png", "render --engine rtl --mesh spot.obj --texture t.png --png spot.png",
       "render --method refine:20 --scene fig10_convex --png refined.png"});
  const auto options = std::make_shared<RenderOptions>();
  options->input.add_to(*command);
  options->common.add_to(*command);
  options->state.add_to(*command);
  options->engine.add_to(*command, options->method);
  options->input.add_picture_options(*command, options->shade, options->texture);
  writes_one_of(*command, command->add_option("--out", options->out, "Picture with depth, weights, ids and errors"),
                {"exr", "npz"})
      ->group(output_group);
  writes_file(*command, command->add_option("--png", options->png, "Picture"), "png")->group(output_group);
  command->add_flag("--no-error", options->no_error, "No error layers in --out")->group(output_group);
  command->callback(
      [options, &invocation] { invocation.run = [options, &invocation] { return render(*options, invocation); }; });
}

}  // namespace quadrille::tb
