// quadrille fragments: every fragment of every quad as a table, without depth test.
#include "tb/commands/commands.hpp"
#include "tb/commands/counters_report.hpp"
#include "tb/commands/fragments_errors.hpp"
#include "tb/options/command_line.hpp"

#include "golden/io/atomic_file.hpp"
#include "golden/io/fragment_csv.hpp"
#include "golden/io/json_report.hpp"
#include "golden/io/text_input.hpp"
#include "model/port/snap.hpp"
#include "tb/engines/engine.hpp"
#include "tb/options/input.hpp"
#include "tb/options/pixel.hpp"
#include "tb/options/written_file.hpp"
#include "tb/support/choices.hpp"
#include "tb/support/errors.hpp"
#include "tb/support/output.hpp"
#include "tb/support/progress.hpp"
#include "tb/support/stopwatch.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>

namespace quadrille::tb {
namespace {

struct FragmentsOptions {
  CommonOptions common;
  StateOptions state;
  InputOptions input;
  EngineOptions engine;
  std::string out, pixel, shade, method;
  std::int64_t quad = -1;
  bool errors = false;
};

int fragments(const FragmentsOptions& options, const Invocation& invocation) {
  const Stopwatch start;
  EngineSettings settings = options.engine.settings(options.common, options.state);
  if (options.out.empty()) throw UsageError("--out F.csv or F.npz is missing (- is CSV on standard output)");
  MethodEngineMaker make_method_engine;
  if (!options.method.empty()) {
    make_method_engine = invocation.method(options.method);
    if (options.errors) throw UsageError("--errors and --method conflict: the bound is the machine's");
    settings.snap = false;
  }
  if (options.errors && has_ending(options.out, "npz"))
    throw UsageError("--errors writes CSV; expected a name such as " +
                     std::filesystem::path(options.out).replace_extension("csv").string());
  if (options.errors && !settings.snap) throw UsageError("--errors needs --snap on: the bound is for snapped quads");
  if (options.errors && settings.config.qdrop() != 0)
    throw UsageError("--errors: no bound with quadratic_frac_bits that drops bits of D and R²");
  std::vector<std::string> read = options.input.files();
  read.push_back(options.common.config_file);
  check_outputs({options.out, options.input.save_camera, options.common.json}, read);

  DrawInput input =
      load_input(options.input, options.shade, settings.state, settings.config, options.common.seed, settings.threads);
  print_remark(input, options.common);
  adjust_state(input, settings.state);
  if (options.quad >= 0) {
    if (static_cast<std::uint64_t>(options.quad) >= input.quads.size())
      throw UsageError("--quad " + std::to_string(options.quad) + ": " + input.name + " has " +
                       std::to_string(input.quads.size()) + " quads, counted from 0");
    const auto only = static_cast<std::size_t>(options.quad);
    if (input.corners.size() == input.quads.size()) {
      input.corners = {input.corners[only]};
      input.textures = {input.textures[only]};
    }
    input.quads = {input.quads[only]};
  }
  PixelOption pixel;
  if (!options.pixel.empty()) pixel = parse_pixel(options.pixel, settings.state);

  const auto wanted = [&](const EngineSample& sample) {
    return pixel.x < 0 || (sample.x == pixel.x && sample.y == pixel.y);
  };
  std::vector<golden::FragmentRow> rows;
  std::vector<EngineSample> kept, truth;  // --errors
  std::uint64_t undefined = 0;
  try {
    Progress progress("fragments of " + input.name, input.quads.size(), options.common.show_progress());
    const std::unique_ptr<Engine> engine =
        options.method.empty() ? make_engine(settings) : make_method_engine(input, settings);
    engine->draw(input.quads, input.attributes, true, [&](std::span<const EngineSample> samples) {
      for (const EngineSample& sample : samples) {
        if (!wanted(sample)) continue;
        if (options.errors) kept.push_back(sample);
        rows.push_back(
            {sample.quad, sample.x, sample.y, sample.front, sample.flags, sample.lambda, sample.z, sample.attribute});
        if (sample.undefined) rows.back().flags |= flag_undefined, ++undefined;
      }
      progress.set(samples.back().index + 1);
    });
    if (options.errors) {
      EngineSettings true_settings = settings;
      true_settings.kind = EngineKind::truth;
      make_engine(true_settings)->draw(input.quads, input.attributes, true, [&](std::span<const EngineSample> samples) {
        std::ranges::copy_if(samples, std::back_inserter(truth), wanted);
      });
    }
  } catch (const SnapError& error) {
    throw UsageError(describe(error, input));
  }
  if (options.errors)
    golden::write_file(options.out, fragment_errors_csv(input.quads, input.attribute_names, settings, kept, truth),
                       golden::AtomicFile::Dash::standard_output);
  else if (has_ending(options.out, "npz"))
    golden::save_fragment_npz(options.out, rows, {input.attribute_names, settings.state.depth});
  else
    golden::save_fragment_csv(options.out, rows, {input.attribute_names, settings.state.depth});

  if (rows.empty() && !options.common.quiet)
    std::fprintf(stderr, "note: no fragments%s\n", pixel.x < 0 ? "" : (" at pixel " + options.pixel).c_str());

  const std::string& drawn_by = options.method.empty() ? options.engine.engine : options.method;
  const double seconds = start.seconds();
  std::optional<PerformanceCounters> counters;
  if (options.method.empty() && reports_counters(options.common))
    counters = count_draw(settings, input.quads, input.attributes);
  if (!options.common.json.empty()) {
    nlohmann::ordered_json json = golden::begin_report(settings.config, options.common.seed, invocation.arguments);
    json["input"] = input.name;
    json[options.method.empty() ? "engine" : "method"] = drawn_by;
    json["snap"] = settings.snap;
    json["quads"] = input.quads.size();
    json["fragments"] = rows.size();
    json["undefined"] = undefined;
    json["wall_seconds"] = seconds;
    if (counters) json["counters"] = counters_json(*counters);
    golden::save_json(options.common.json, json);
  }
  if (std::FILE* text = options.common.text(); text && options.out != "-") {
    std::fprintf(text, "%s by %s: %zu quads, %zu fragments", input.name.c_str(), drawn_by.c_str(), input.quads.size(),
                 rows.size());
    if (undefined) std::fprintf(text, ", %llu undefined", static_cast<unsigned long long>(undefined));
    std::fprintf(text, ", %.2f s\n", seconds);
    if (counters) print_counters(text, *counters, "of the clocked model");
  }
  return exit_ok;
}

}  // namespace

void add_fragments_command(CLI::App& app, Invocation& invocation) {
  CLI::App* command = app.add_subcommand("fragments", "Write every fragment as a table, without depth test");
  end_help(*command,
           "Columns: quad,x,y,front,flags,l0,l1,l2,l3,z,... sorted by quad, y, x. Attributes have their names: u,v, "
           "nx,ny,nz, px,py,pz, red,green,blue; without names a0,a1,...\n"
           "F.npz has an array of each column: numpy.load(\"F.npz\")[\"u\"].\n"
           "Columns with --errors, a row per value: quad,x,y,value,drawn,truth,error,of_bound. A value is l0 to l3, z "
           "or an attribute; of_bound is |error| / bound.\n"
           "With --json or --verbose the engines rtl and model also report performance counters.\n\n"
           "Flags (their sum):\n"
           "    1  on an edge\n"
           "    2  on a vertex\n"
           "    4  on two corners\n"
           "    8  on two edges\n"
           "   16  decided by the tie rule\n"
           "   32  of a homogeneous quad\n"
           "   64  notch: neighbouring areas differ in sign (rtl, model with notch_exact)\n"
           "  128  saturated\n"
           "  256  undefined: the numbers are invalid (float, fp32, shader)",
           "0 done; 2 usage or input error; 3 missing tool",
           {"fragments --quads some.quads --out some.csv", "fragments --engine rtl --mesh pawn.obj --quad 17 --out -",
            "fragments --scene bowtie --pixel 160,160 --errors --out -"});
  const auto options = std::make_shared<FragmentsOptions>();
  options->input.add_to(*command);
  add_attributes_option(*command, options->shade);
  options->common.add_to(*command);
  options->state.add_to(*command);
  options->engine.add_to(*command, options->method, true);
  command->add_option("--quad", options->quad, "Only the quad with this id (from 0)")
      ->type_name("N")
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{1} << 40));
  command->add_option("--pixel", options->pixel, "Only this pixel")->type_name("X,Y");
  writes_one_of(*command, command->add_option("--out", options->out, "The table; - is standard output"), {"csv", "npz"})
      ->group(output_group);
  command->add_flag("--errors", options->errors, "Truth and error of each value, in units of its bound")
      ->group(output_group);
  command->callback(
      [options, &invocation] { invocation.run = [options, &invocation] { return fragments(*options, invocation); }; });
}

}  // namespace quadrille::tb
