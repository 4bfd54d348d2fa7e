// quadrille cosim: the RTL and its model in lockstep on real quads, the fragments compared with the truth as they come.
#include "tb/commands/commands.hpp"
#include "tb/commands/cosim_battery.hpp"
#include "tb/commands/cosim_options.hpp"
#include "tb/commands/cosim_report.hpp"
#include "tb/commands/cosim_run.hpp"
#include "tb/options/command_line.hpp"
#include "tb/options/written_file.hpp"

#include "golden/io/json_report.hpp"
#include "tb/device/verilate.hpp"
#include "tb/judge/model_check.hpp"
#include "tb/lockstep/lockstep.hpp"
#include "tb/support/errors.hpp"
#include "tb/support/output.hpp"

#include <algorithm>
#include <memory>

namespace quadrille::tb {
namespace {

int run_inputs(const CosimOptions& options, const Config& config, const std::vector<std::string>& arguments) {
  CosimRun run(options, config);
  const CosimReport report(options, config);
  const std::vector<InputOptions> inputs = options.inputs();
  std::vector<InputResult> results;
  for (const InputOptions& input : inputs) {
    results.push_back(run.run_input(input));
    if (std::FILE* text = options.common.text(); text && inputs.size() > 1)
      print_row(text, results.back(), results.size() == 1);
  }
  InputResult total;
  for (const InputResult& result : results) total.merge(result);
  total.name = results.size() == 1 ? results.front().name : "all";
  total.option = results.size() == 1 ? results.front().option : "--scene all";
  if (results.size() == 1) {
    total.state = results.front().state;
    total.attributes = results.front().attributes;
  }

  const ModelCheck model = check_model(config);
  const bool ok = model.ok() && std::ranges::all_of(results, [](const InputResult& r) { return r.ok(); });
  if (std::FILE* text = options.common.text()) report.print_summary(text, total, model, ok);
  if (!options.common.json.empty())
    golden::save_json(options.common.json, report.all(total, results, model, ok, arguments));
  for (const InputResult& result : results) complain(result);
  if (!model.ok()) std::fprintf(stderr, "quadrille: the model alone: %s\n", model.fault().c_str());
  if (!ok && !options.no_shrink) run.shrink_failure(results, model);
  return ok ? exit_ok : exit_mismatch;
}

int run_cosim(const CosimOptions& options, const std::vector<std::string>& arguments) {
  if (options.list_metrics) {
    std::fputs(list_metrics().c_str(), stdout);
    return exit_ok;
  }
  const Config config = options.common.config();
  options.check(config);
  try {
    return options.battery.empty() ? run_inputs(options, config, arguments) : run_battery(options, config, arguments);
  } catch (const VerilateError& error) {
    if (options.rtl.empty()) throw;
    throw UsageError("--rtl " + options.rtl + ": " + error.what());  // the user's sources
  } catch (const WatchdogError&) {
    // Both sides hang alike (the RTL alone would have differed), each time for as long as it takes to be sure of it.
    if (!options.no_shrink) std::fputs("quadrille: not shrunk: a hang of RTL and model is not searched\n", stderr);
    throw;
  }
}

}  // namespace

void add_cosim_command(CLI::App& app, Invocation& invocation) {
  CLI::App* command = app.add_subcommand("cosim", "RTL and model in lockstep, their fragments against the truth");
  command->footer(
      "Without an input all built-in scenes run. Exit status 0 only if at least one fragment was compared, nothing\n"
      "differed and the error bound held. A run that fails in lockstep or before the truth shrinks itself: the fewest\n"
      "quads, pixels, stalls and gaps that still fail are written, with a waveform of their last 200 clocks, and the "
      "one\n"
      "command that repeats it is printed.\n\n"
      "Examples:\n"
      "  quadrille cosim --scene fig7_floor --png floor.png\n"
      "  quadrille cosim --mesh pawn.obj --stall 0.5 --gap 0.1 --json report.json\n"
      "  quadrille cosim --stress eye_crossing --count 200 --set significand_bits=24\n"
      "  quadrille cosim --corner z_limits --znear 0.25 --zfar 0.75 --size 64x64\n"
      "  quadrille cosim --stress general --draw-state random:7\n"
      "  quadrille cosim --scene sphere --limit-fragments 2000 --trace sphere.fst\n"
      "  quadrille cosim --scene sphere --size 64x64 --stall 0.3 --gap 0.2 --rtl changed_rtl --shrink fails.quads\n"
      "  quadrille cosim --quads fails.quads --size 34x56 --stall-clocks 80-83 --gap-beats 5:2,9");
  const auto options = std::make_shared<CosimOptions>();
  options->input.add_to(*command);
  options->common.add_to(*command);
  options->state.add_to(*command);
  command->add_option("--stall", options->stall, "Probability per clock that the output is not ready")
      ->type_name("P")
      ->capture_default_str();
  command->add_option("--gap", options->gap, "Probability per clock that no vertex is offered")
      ->type_name("P")
      ->capture_default_str();
  command
      ->add_option("--stall-clocks", options->stall_clocks,
                   "The clocks in which the output is not ready, one by one: 17,40-43, counted from the end of reset")
      ->type_name("LIST")
      ->excludes("--stall");
  command
      ->add_option("--gap-beats", options->gap_beats,
                   "The beats (vertices, from 0) before which none is offered, and for how many clocks: 5:2,9")
      ->type_name("LIST")
      ->excludes("--gap");
  command
      ->add_option("--waits", options->waits,
                   "Pattern of stalls and gaps: bursts, sparse (nearly always), locked (a fixed number of clocks for a "
                   "while) or mixed (all in turn)")
      ->type_name("PATTERN")
      ->excludes("--stall", "--gap", "--stall-clocks", "--gap-beats");
  CLI::Option* const battery =
      command
          ->add_option(
              "--battery", options->battery,
              "Run the groups of draws that a developer of the RTL runs after a change (3 minutes), all of them "
              "or GROUP, MACHINE or INPUT of MACHINE.INPUT")
          ->expected(0, 1)
          ->type_name("[GROUP]");
  command
      ->add_option("--draws", options->draws,
                   "Cut each input into N draws of one machine. Draw states, stalls and gaps are drawn from the seed, "
                   "and clears and resets between draws")
      ->check(whole_number())
      ->type_name("N")
      ->excludes("--stall-clocks", "--gap-beats");
  command
      ->add_option("--attributes", options->attributes,
                   "Attributes in use in one pass; fewer of them make more passes. Default: attribute_slots")
      ->check(CLI::Range(1, max_attribute_slots))
      ->type_name("N");
  command
      ->add_option("--draw-state", options->draw_state,
                   "random or random:SEED: draws scissor, culling, perspective, depth, znear, zfar, attributes in use "
                   "and the skips, and says which (default seed: --seed)")
      ->type_name("random[:SEED]");
  command
      ->add_option("--limit-fragments", options->limit_fragments, "End each input after so many fragments; 0: no limit")
      ->check(whole_number())
      ->type_name("N");
  writes_file(*command, command->add_option("--trace", options->trace, "Waveform of the RTL"), "fst");
  writes_file(*command,
              command->add_option(
                  "--shrink", options->shrink,
                  "Where a run that fails writes the fewest quads that still do, beside them the waveform (F.fst) of "
                  "their last 200 clocks. Default: cosim_failure.quads"),
              "quads");
  command
      ->add_option("--shrink-time", options->shrink_seconds,
                   "Seconds after which the search for less ends with what it has")
      ->check(CLI::NonNegativeNumber)
      ->type_name("S")
      ->capture_default_str();
  command->add_flag("--no-shrink", options->no_shrink, "Do not shrink a run that fails")->excludes("--shrink");
  writes_file(*command,
              command->add_option("--out", options->out, "Picture of the RTL's fragments, with weights and errors"),
              "exr");
  writes_file(*command, command->add_option("--png", options->png, "The same to look at"), "png");
  command->add_option("--texture", options->texture, "Picture instead of the scene's own pattern")->type_name("F.png");
  command
      ->add_option("--shade", options->shade,
                   "uv, texture, normal, lambda, depth, quad, planes or colour; default: what suits the input")
      ->type_name("MODE");
  options->input.add_light_to(*command);
  command
      ->add_option("--rtl", options->rtl,
                   "Verilog instead of the project's: a directory, or one file, of which the ports alone are compared")
      ->type_name("PATH");
  command->add_flag("--compare-skips,!--no-compare-skips", options->compare_skips,
                    "Compare draws with and without each skip that must not change a fragment. Default: yes");
  command->add_flag("--no-snapping-error", options->no_snapping, "Do not measure the error of snapping (quicker)");
  command->add_flag("--list-metrics", options->list_metrics, "Instead list what the report counts, as Markdown");
  command->add_flag("--no-alone", options->no_alone, "Do not time the RTL alone");
  command->callback([options, battery, &invocation] {
    if (battery->count() > 0 && options->battery.empty()) options->battery = "all";
    invocation.run = [options, &invocation] { return run_cosim(*options, invocation.arguments); };
  });
}

}  // namespace quadrille::tb
