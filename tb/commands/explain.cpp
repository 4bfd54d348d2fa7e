// quadrille explain: one pixel taken apart, number by number.
#include "tb/commands/commands.hpp"
#include "tb/commands/cosim_options.hpp"
#include "tb/commands/explain_rtl.hpp"
#include "tb/options/command_line.hpp"

#include "golden/explain/explain.hpp"
#include "golden/io/atomic_file.hpp"
#include "golden/io/json_report.hpp"
#include "model/port/snap.hpp"
#include "tb/options/input.hpp"
#include "tb/options/pixel.hpp"
#include "tb/options/written_file.hpp"
#include "tb/support/errors.hpp"
#include "tb/support/output.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

namespace quadrille::tb {
namespace {

using explain::Explanation;

struct ExplainOptions {
  CommonOptions common;
  StateOptions state;
  InputOptions input;
  std::string pixel, shade, engine = "model", rtl, html;
  std::int64_t quad = -1;
};

/// A number that is beyond its bound.
bool exceeds(const Explanation& e) {
  return std::ranges::any_of(e.stages, [](const explain::Stage& stage) {
    return std::ranges::any_of(stage.numbers, [](const explain::Number& n) { return n.of_bound && *n.of_bound > 1; });
  });
}

int explain_pixel(const ExplainOptions& options, const Invocation& invocation) {
  const Config config = options.common.config();
  DrawState state = options.state.state(options.common, config);
  if (options.pixel.empty()) throw UsageError("--pixel X,Y is missing");
  if (options.engine != "model" && options.engine != "rtl")
    throw UsageError("--engine " + options.engine + ": expected model or rtl");
  if (!options.rtl.empty() && options.engine != "rtl") throw UsageError("--rtl needs --engine rtl");
  check_rtl(options.rtl);
  std::vector<std::string> read = options.input.files();
  read.push_back(options.common.config_file);
  check_outputs({options.html, options.input.save_camera, options.common.json}, read);

  DrawInput input =
      load_input(options.input, options.shade, state, config, options.common.seed, options.common.thread_count());
  print_remark(input, options.common);
  adjust_state(input, state);
  const PixelOption pixel = parse_pixel(options.pixel, state);
  state.attributes = std::min(input.attributes, config.attribute_slots);
  check_quad_count(input.quads.size(), config);
  // Ids may repeat; the machine gets positions, as in every draw.
  for (std::size_t i = 0; i < input.quads.size(); ++i) input.quads[i].id = static_cast<std::uint32_t>(i);
  try {
    for (const WindowQuad& quad : input.quads) snap_quad(quad, config, state);
  } catch (const SnapError& error) {
    throw UsageError(describe(error, input));
  }
  std::span<const WindowQuad> quads(input.quads);
  if (options.quad >= 0) {
    if (static_cast<std::uint64_t>(options.quad) >= quads.size())
      throw UsageError("--quad " + std::to_string(options.quad) + ": " + input.name + " has " +
                       std::to_string(quads.size()) + " quads, counted from 0");
    quads = quads.subspan(static_cast<std::size_t>(options.quad), 1);
  }

  std::vector<Explanation> all = explain::explain(config, state, quads, pixel.x, pixel.y);
  const auto shown = [&](const Explanation& e) { return e.covered() || all.size() == 1; };
  bool same = true;
  if (options.engine == "rtl") {
    LockstepOptions lockstep;
    lockstep.config = config;
    lockstep.state = state;
    lockstep.seed = options.common.seed;
    lockstep.source = options.rtl;
    lockstep.probes = !std::filesystem::is_regular_file(options.rtl);
    const ExplainByRtl rtl(lockstep);
    for (std::size_t i = 0; i < all.size(); ++i)
      if (shown(all[i])) same &= rtl.compare(all[i], quads[i]);
  }
  const bool bounded = std::ranges::none_of(all, exceeds);

  const std::string place = "Pixel (" + std::to_string(pixel.x) + ", " + std::to_string(pixel.y) + ") of " + input.name;
  const std::string command = golden::command_line(invocation.arguments);
  if (!options.html.empty())
    golden::write_file(options.html, explain::to_html(all, place, command), golden::AtomicFile::Dash::standard_output);
  if (!options.common.json.empty()) {
    nlohmann::ordered_json json = golden::begin_report(config, options.common.seed, invocation.arguments);
    json["input"] = input.name;
    json["x"] = pixel.x;
    json["y"] = pixel.y;
    json["engine"] = options.engine;
    json["ok"] = same && bounded;
    json["quads"] = quads.size();
    json["explanations"] = nlohmann::ordered_json::array();
    const Explanation* const nearest = explain::nearest_outside(all);
    for (const Explanation& e : all)
      if (shown(e) || e.outcome != explain::Outcome::outside || &e == nearest)
        json["explanations"].push_back(nlohmann::ordered_json::parse(explain::to_json(e)));
    golden::save_json(options.common.json, json);
  }
  if (std::FILE* text = options.html == "-" ? nullptr : options.common.text()) {
    const auto covering = static_cast<std::size_t>(std::ranges::count_if(all, &Explanation::covered));
    std::fprintf(text, "%s: %zu of %zu quad%s cover%s it\n\n", place.c_str(), covering, quads.size(),
                 quads.size() == 1 ? "" : "s", covering == 1 ? "s" : "");
    if (static_cast<std::size_t>(input.attributes) > static_cast<std::size_t>(state.attributes))
      std::fprintf(text, "The first %d of %d attributes: the machine draws as many at a time (attribute_slots).\n\n",
                   state.attributes, input.attributes);
    for (const bool seen : {true, false})
      for (const Explanation& e : all)
        if (e.seen == seen && shown(e)) std::fprintf(text, "%s\n", explain::to_text(e, options.common.verbose).c_str());
    if (all.size() > 1) {
      if (const std::string others = explain::summary(all); !others.empty())
        std::fprintf(text, "%s:\n%s", covering == 0 ? "No quad covers the pixel" : "The other quads", others.c_str());
    }
  }
  if (!same) std::fprintf(stderr, "quadrille: %s: the RTL differs from the model\n", place.c_str());
  if (!bounded) std::fprintf(stderr, "quadrille: %s: a number is beyond its bound\n", place.c_str());
  return same && bounded ? exit_ok : exit_mismatch;
}

}  // namespace

void add_explain_command(CLI::App& app, Invocation& invocation) {
  CLI::App* command = app.add_subcommand("explain", "Explain one pixel: each stage's numbers beside exact ones");
  end_help(*command,
           "For each quad that covers the pixel: which rule covers it, then each stage's formula and numbers, as "
           "stored, as real values, and beside exact arithmetic. A pixel that no quad covers has the rule that "
           "rejected it. Quads are taken one by one: what an earlier one hides is not looked at. --verbose prints all "
           "coefficients.\n"
           "With --engine rtl the RTL draws each of these quads alone, after a reset; a difference from the model is "
           "shown beside the number.",
           "0 done; 1 RTL and model differ, or a bound exceeded; 2 usage or input error; 3 missing tool",
           {"explain --scene fig10_convex --pixel 256,256",
            "explain --quads some.quads --quad 2 --pixel 10,20 --html pixel.html",
            "explain --mesh pawn.obj --pixel 300,240 --engine rtl"});
  const auto options = std::make_shared<ExplainOptions>();
  options->input.add_to(*command);
  add_attributes_option(*command, options->shade);
  command->add_option("--pixel", options->pixel, "Column and row of the pixel, from the upper left")->type_name("X,Y");
  command->add_option("--quad", options->quad, "Only the quad with this id (from 0)")
      ->type_name("N")
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{1} << 40));
  command->add_option("--engine", options->engine, "Whose numbers: of the model, or also of the RTL under Verilator")
      ->type_name("model|rtl");
  command->add_option("--rtl", options->rtl, "RTL instead of the project's: a directory with *.sv, or one Verilog file")
      ->type_name("DIR");
  options->common.add_to(*command);
  options->state.add_to(*command);
  writes_file(*command, command->add_option("--html", options->html, "The explanation as a page; - is standard output"),
              "html")
      ->group(output_group);
  command->callback([options, &invocation] {
    invocation.run = [options, &invocation] { return explain_pixel(*options, invocation); };
  });
}

}  // namespace quadrille::tb
