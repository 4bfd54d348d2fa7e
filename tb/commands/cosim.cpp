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
#include <optional>

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

  // Of RTL that is judged by the truth alone the model says nothing.
  std::optional<ModelCheck> model;
  if (!options.by_truth()) model = check_model(config);
  const bool ok = (!model || model->ok()) && std::ranges::all_of(results, [](const InputResult& r) { return r.ok(); });
  if (std::FILE* text = options.common.text()) report.print_summary(text, total, model ? &*model : nullptr, ok);
  if (!options.common.json.empty())
    golden::save_json(options.common.json, report.all(total, results, model ? &*model : nullptr, ok, arguments));
  for (const InputResult& result : results) {
    complain(result);
    // A minimized failure has a command of its own.
    if (const std::string command = report.explain(result); options.no_shrink && !command.empty())
      std::fprintf(stderr, "quadrille: %s: the pixel explained: %s\n", result.name.c_str(), command.c_str());
  }
  const bool model_ok = !model || model->ok();
  if (!model_ok) std::fprintf(stderr, "quadrille: model check: %s\n", model->fault().c_str());
  if (!ok && !options.no_shrink) run.shrink_failure(results, model_ok);
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
    if (!options.no_shrink)
      std::fprintf(stderr, "quadrille: not minimized: %s\n",
                   options.by_truth() ? "the RTL hangs" : "RTL and model hang alike");
    throw;
  }
}

}  // namespace

void add_cosim_command(CLI::App& app, Invocation& invocation) {
  CLI::App* command = app.add_subcommand("cosim", "Compare RTL and model in lockstep, and fragments with the truth");
  end_help(
      *command,
      "Without an input all built-in scenes run. A failure is minimized to the fewest quads, pixels, stalls and "
      "gaps that still fail. The command that repeats it is printed.",
      "0 fragments compared, no mismatch, errors within bounds; 1 mismatch, bound exceeded or no fragments "
      "compared; 2 usage or input error; 3 missing tool",
      {"cosim --scene fig7_floor --png floor.png", "cosim --mesh pawn.obj --stall 0.5 --gap 0.1 --json report.json",
       "cosim --quads fails.quads --stall-clocks 80-83 --gap-beats 5:2,9"});
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
                   "Clocks after reset without a ready output, such as 17,40-43")
      ->type_name("LIST")
      ->excludes("--stall");
  command->add_option("--gap-beats", options->gap_beats, "BEAT:CLOCKS to wait before a vertex (from 0), such as 5:2,9")
      ->type_name("LIST")
      ->excludes("--gap");
  command
      ->add_option("--waits", options->waits,
                   "Pattern of stalls and gaps\n"
                   "  bursts  long waits and long runs\n"
                   "  sparse  waits in nearly every clock\n"
                   "  locked  waits of a fixed length for a while\n"
                   "  mixed   all of these in turn")
      ->type_name("PATTERN")
      ->excludes("--stall", "--gap", "--stall-clocks", "--gap-beats");
  CLI::Option* const battery =
      command
          ->add_option("--battery", options->battery, "Regression of 3 minutes, or one GROUP, MACHINE or INPUT of it")
          ->expected(0, 1)
          ->type_name("[GROUP]");
  command->add_option("--draws", options->draws, "Cut each input into N draws, with clears and resets between")
      ->check(whole_number())
      ->type_name("N")
      ->excludes("--stall-clocks", "--gap-beats");
  command->add_option("--attributes", options->attributes, "Attributes per pass")
      ->check(CLI::Range(1, max_attribute_slots))
      ->type_name("N")
      ->default_str("attribute_slots")
      ->group(state_group);
  command
      ->add_option("--draw-state", options->draw_state, "Random draw state, printed as options (default seed: --seed)")
      ->type_name("random[:SEED]")
      ->group(state_group);
  command->add_option("--limit-fragments", options->limit_fragments, "Fragments per input; 0: no limit (default: 0)")
      ->check(whole_number())
      ->type_name("N");
  command->add_option("--rtl", options->rtl, "Your RTL: a directory, or one file (only its ports are compared)")
      ->type_name("PATH");
  command
      ->add_option("--judge", options->judge,
                   "What the RTL is held to\n"
                   "  lockstep  every bit and clock of the model, and the truth\n"
                   "  truth     exact coverage and the bounds of errors alone, for RTL with bits of its own")
      ->type_name("JUDGE")
      ->capture_default_str();
  command->add_flag("--compare-skips,!--no-compare-skips", options->compare_skips,
                    "Do not compare draws with and without each skip");
  command->add_flag("--no-snapping-error", options->no_snapping, "Do not measure the snapping error");
  command->add_flag("--no-alone", options->no_alone, "Do not time the RTL alone");
  writes_file(*command,
              command->add_option("--shrink", options->shrink,
                                  "Minimized failing quads, F.fst beside them (default: cosim_failure.quads)"),
              "quads");
  command->add_option("--shrink-time", options->shrink_seconds, "Minimization time limit in seconds")
      ->check(CLI::NonNegativeNumber)
      ->type_name("S")
      ->capture_default_str();
  command->add_flag("--no-shrink", options->no_shrink, "Do not minimize a failure")->excludes("--shrink");
  options->input.add_picture_options(*command, options->shade, options->texture);
  writes_file(*command, command->add_option("--out", options->out, "Picture of the RTL with weights and errors"), "exr")
      ->group(output_group);
  writes_file(*command, command->add_option("--png", options->png, "Picture of the RTL"), "png")->group(output_group);
  writes_file(*command, command->add_option("--trace", options->trace, "Waveform of the RTL"), "fst")
      ->group(output_group);
  command->add_flag("--list-metrics", options->list_metrics, "Only list the fields of --json, as Markdown")
      ->group(output_group);
  command->callback([options, battery, &invocation] {
    if (battery->count() > 0 && options->battery.empty()) options->battery = "all";
    invocation.run = [options, &invocation] { return run_cosim(*options, invocation.arguments); };
  });
}

}  // namespace quadrille::tb
