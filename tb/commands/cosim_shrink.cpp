#include "tb/commands/cosim_shrink.hpp"

#include "golden/io/json_report.hpp"
#include "golden/io/quads_file.hpp"
#include "model/port/snap.hpp"
#include "tb/lockstep/driven_device.hpp"
#include "tb/lockstep/shrink.hpp"
#include "tb/support/output.hpp"
#include "tb/support/progress.hpp"
#include "tb/support/stopwatch.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

namespace quadrille::tb {

namespace {

constexpr std::uint64_t clocks_shown = 200;

/// Thrown out of a run that has become pointless.
struct OutOfTime {};

/// Draws of a failed pass, run again and again on one simulator.
class FailedPassRuns {
 public:
  FailedPassRuns(const FailedPass& failed, const ShrinkOptions& options, bool show)
      : failed_(failed),
        seconds_(options.seconds),
        simulator_(simulator_in_lockstep(failed.lockstep)),
        progress_(failed.input + ", minimizing", 0, show) {}

  /// As shrink() wants it. The first run, of the whole, does not count in the time.
  std::optional<Failure> operator()(const FailingDraw& draw) {
    progress_.set(++runs_, std::to_string(draw.quads.size()) + " quads");
    const bool failed = fails_in_time(draw);
    if (!clock_) clock_.emplace();
    if (!failed) return std::nullopt;
    Failure failure{report_.quads, {}};
    failure.waits =
        draw.waits ? *draw.waits : recorded_waits(snapped_, options_of(draw), clocks() + 1, 4 * report_.quads + 4);
    return failure;
  }
  bool out_of_time() const { return clock_ && clock_->seconds() > seconds_; }

  /// Without a limit of time.
  bool fails(const FailingDraw& draw) { return fails(draw, simulator_, options_of(draw), false); }
  std::uint64_t clocks() const { return std::max(report_.cycles_rtl, report_.cycles_model); }  ///< of the last run

  /// Of the last run.
  std::optional<DivergentPixel> pixel() const { return faulty_pixel(report_, check_); }

  /// Writes the last clocks of a draw that failed just now; false when the machine with waveforms does not fail.
  bool trace(const FailingDraw& draw, const std::string& file) {
    LockstepOptions options = options_of(draw);
    options.trace = file;
    options.trace_from = clocks() > clocks_shown ? clocks() - clocks_shown : 0;
    options.optimise = 0;  // a few hundred clocks are nothing beside what compiling them well takes
    return fails(draw, simulator_in_lockstep(options), options, false);
  }

  std::uint64_t runs() const { return runs_; }
  void finish() { progress_.finish(); }

 private:
  LockstepOptions options_of(const FailingDraw& draw) const {
    LockstepOptions o = failed_.lockstep;
    const int attributes = o.state.attributes;
    o.state = draw.state;
    o.state.attributes = attributes;
    o.seed = draw.seed;
    o.stall = draw.waits ? 0 : draw.stall;
    o.gap = draw.waits ? 0 : draw.gap;
    o.waits = draw.waits.value_or(PortWaits{});
    if (draw.waits || draw.stall > 0 || draw.gap > 0) o.pattern = WaitKind::chance;  // else: the run that failed
    return o;
  }

  bool fails_in_time(const FailingDraw& draw) {
    try {
      return fails(draw, simulator_, options_of(draw), true);
    } catch (const WatchdogError&) {  // both sides hang: not what is looked for
      return false;
    } catch (const OutOfTime&) {
      return false;
    }
  }

  bool fails(const FailingDraw& draw, const Simulator& simulator, LockstepOptions options, bool in_time) {
    options.progress = nullptr;
    if (in_time)
      options.progress = [this](double) {
        if (out_of_time()) throw OutOfTime{};
      };
    snapped_ = snap_pass(draw.quads, failed_.check.pass, options.config, options.state);
    if (!failed_.lockstep_ok) {
      report_ = run_lockstep(simulator, snapped_, options);
      return !report_.agreed();
    }
    FragmentChecker::Settings settings = failed_.check;
    settings.state = options.state;
    settings.snapping = false;
    check_ = check_here(settings, draw.quads, snapped_, [&](const auto& sink) {
      report_ = run_lockstep(simulator, snapped_, options, sink);
      return report_.complete;
    });
    return report_.agreed() && check_.faults() != 0;
  }

  const FailedPass& failed_;
  double seconds_;
  Simulator simulator_;
  Progress progress_;
  std::optional<Stopwatch> clock_;  ///< from the end of the first run on
  std::uint64_t runs_ = 0;
  std::vector<SnappedQuad> snapped_;
  LockstepReport report_;
  CheckResult check_;
};

/// What every command on the minimized draw has.
std::string options_of(const FailingDraw& draw, const ShrinkOptions& options, const CommonOptions& common) {
  std::string text = " --quads " + quoted(options.quads);
  if (!common.config_file.empty()) text += " --config " + quoted(common.config_file);
  for (const std::string& setting : common.settings) text += " --set " + quoted(setting);
  return text + " --size " + std::to_string(draw.state.width) + "x" + std::to_string(draw.state.height) + " --seed " +
         std::to_string(draw.seed) + StateOptions::of(draw.state).spelled();
}

std::string rtl_of(const FailedPass& failed) {
  return failed.lockstep.source.empty() ? "" : " --rtl " + quoted(failed.lockstep.source.string());
}

/// The pixel of the failure, explained; that of a scissor rectangle of one where the difference is about none.
std::string explain_command(const FailingDraw& draw, const FailedPass& failed, const ShrinkOptions& options,
                            const CommonOptions& common, std::optional<DivergentPixel> pixel) {
  const DrawState& state = draw.state;
  const bool one = state.scissor_x1 - state.scissor_x0 == 1 && state.scissor_y1 - state.scissor_y0 == 1;
  if (!pixel && one && draw.quads.size() == 1) pixel = {0, state.scissor_x0, state.scissor_y0};
  if (!pixel) return "";
  return "quadrille explain" + options_of(draw, options, common) + " --quad " + std::to_string(pixel->quad) +
         " --pixel " + std::to_string(pixel->x) + "," + std::to_string(pixel->y) + " --engine rtl" + rtl_of(failed);
}

std::string command_of(const FailingDraw& draw, const FailedPass& failed, const ShrinkOptions& options,
                       const CommonOptions& common) {
  std::string command = "quadrille cosim" + options_of(draw, options, common);
  if (failed.slots < failed.lockstep.config.attribute_slots) command += " --attributes " + std::to_string(failed.slots);
  if (draw.waits) {
    if (!draw.waits->stall_clocks.empty()) command += " --stall-clocks " + spell_stall_clocks(draw.waits->stall_clocks);
    if (!draw.waits->gap_beats.empty()) command += " --gap-beats " + spell_gap_beats(draw.waits->gap_beats);
  } else {
    if (draw.stall > 0) command += " --stall " + nlohmann::json(draw.stall).dump();
    if (draw.gap > 0) command += " --gap " + nlohmann::json(draw.gap).dump();
  }
  if (failed.lockstep.limit_fragments != 0)
    command += " --limit-fragments " + std::to_string(failed.lockstep.limit_fragments);
  return command + rtl_of(failed) + (failed.lockstep.compare ? "" : " --judge truth") +
         " --no-alone --no-shrink";  // nothing is timed, and there is nothing less to be looked for
}

std::string counted(std::size_t count, const char* thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

}  // namespace

std::optional<DivergentPixel> faulty_pixel(const LockstepReport& report, const CheckResult& check) {
  if (report.first_pixel || !report.agreed()) return report.first_pixel;
  if (check.first.any) return DivergentPixel{check.first.place.index, check.first.place.x, check.first.place.y};
  const CheckResult::Worst& worst = check.worst;
  if (check.faults() != 0 && worst.ratio >= 0) return DivergentPixel{worst.place.index, worst.place.x, worst.place.y};
  return std::nullopt;
}

std::string quoted(const std::string& argument) { return golden::command_line(std::span(&argument, 1)); }

void shrink_failed_pass(const FailedPass& failed, const ShrinkOptions& options, const CommonOptions& common) {
  const LockstepOptions& lockstep = failed.lockstep;
  FailedPassRuns runs(failed, options, common.show_progress());
  FailingDraw whole{failed.quads, lockstep.state, lockstep.seed, lockstep.stall, lockstep.gap, std::nullopt};
  if (!lockstep.waits.empty()) whole.waits = lockstep.waits;
  ShrinkLimits limits;
  limits.out_of_time = [&] { return runs.out_of_time(); };
  const Stopwatch start;
  const FailingRun run = [&](const FailingDraw& draw) { return runs(draw); };
  const std::optional<Shrunk> shrunk = shrink(std::move(whole), run, limits);
  if (!shrunk) throw std::runtime_error("the failure did not repeat");

  golden::save_quads(options.quads, shrunk->draw.quads);
  FailingDraw kept = shrunk->draw;
  kept.quads = golden::load_quads(options.quads);
  // Waits of which none could be left out are said in short, where the chances that drew them still do.
  const PortWaits waits = *kept.waits;
  bool fails = false;
  if (kept.stall > 0 || kept.gap > 0) {
    kept.waits.reset();
    fails = runs.fails(kept);
    if (!fails) kept.waits = waits;
  }
  if (!fails && !runs.fails(kept)) throw std::runtime_error("no failure with the minimized quads in " + options.quads);
  const std::uint64_t clocks = runs.clocks();
  const std::string explained = explain_command(kept, failed, options, common, runs.pixel());
  const std::string waveform = std::filesystem::path(options.quads).replace_extension(".fst").string();
  PartialFile trace(waveform);
  const bool traced = runs.trace(kept, trace.path());
  trace.commit();
  runs.finish();

  std::string text = "quadrille: " + failed.input + " minimized to " + std::to_string(kept.quads.size()) + " of " +
                     counted(failed.quads.size(), "quad") + ", " +
                     std::to_string(kept.state.scissor_x1 - kept.state.scissor_x0) + "x" +
                     std::to_string(kept.state.scissor_y1 - kept.state.scissor_y0) + " pixels, " +
                     counted(waits.stall_clocks.size(), "stall") + ", " + counted(waits.gap_beats.size(), "gap") +
                     ", " + counted(clocks, "clock");
  char seconds[32];
  std::snprintf(seconds, sizeof seconds, "%.1f", start.seconds());
  text += " (" + counted(runs.runs(), "run") + ", " + seconds + " s):\n  " + command_of(kept, failed, options, common) +
          "\n  waveform of its last " + counted(std::min(clocks, clocks_shown), "clock") + ": " + waveform + "\n";
  if (!explained.empty()) text += "  its pixel explained: " + explained + "\n";
  if (!traced) text += "  no failure in the waveform: the fault depends on register contents before reset\n";
  if (shrunk->ended) text += "  time limit reached (--shrink-time): fewer may also fail\n";
  std::fputs(text.c_str(), stderr);
}

}  // namespace quadrille::tb
