#include "tb/commands/cosim_run.hpp"

#include "golden/scenes/random_state.hpp"
#include "model/front/quad_reject.hpp"
#include "model/port/snap.hpp"
#include "model/skips/hierarchical_z.hpp"
#include "tb/judge/error_limits.hpp"
#include "tb/support/errors.hpp"
#include "tb/support/output.hpp"
#include "tb/support/progress.hpp"
#include "tb/support/stopwatch.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <utility>

namespace quadrille::tb {
namespace {

constexpr std::uint64_t alone_fragments = 200'000;  ///< enough to time the RTL alone

/// What the attributes of a draw are: those that the port gets, or one of the input's passes.
Pass pass_of(const DrawInput& input, const PlannedDraw& draw, std::size_t number) {
  if (!draw.at_port.empty()) {
    Pass pass;
    for (int j = 0; j < draw.state.attributes; ++j) pass.columns.push_back(4 + j);
    return pass;
  }
  const std::vector<Pass> passes = plan_judged_passes(input.attributes, draw.state.attributes);
  return passes[number % passes.size()];
}

/// The RTL without probes and comparison, on the same quads; its fragments must be the same ones.
void time_alone(const Simulator& simulator, std::span<const SnappedQuad> snapped, LockstepOptions options,
                const LockstepReport& lockstep, InputResult& result) {
  options.trace.reset();
  options.progress = nullptr;
  const bool whole = options.limit_fragments == 0 && lockstep.fragments <= alone_fragments;
  if (!whole) options.limit_fragments = std::min(alone_fragments, std::max<std::uint64_t>(1, lockstep.fragments));
  const AloneRun alone = run_rtl_alone(simulator, snapped, options);
  result["alone_cycles"] = alone.cycles;
  result.alone_seconds = alone.seconds;
  if (whole && alone.fragment_hash != lockstep.fragment_hash) {
    ++result["mismatches"];
    result.first_divergence = "the RTL alone gives other fragments than in lockstep";
  }
}

/// --shrink, or a name of its own that is none of the files read.
std::string shrunk_file(const CosimOptions& options) {
  if (!options.shrink.empty()) return options.shrink;
  std::string name = "cosim_failure";
  const std::vector<std::string> read = options.input.files();
  const auto is_read = [&](const std::string& file) {
    return std::ranges::any_of(read, [&](const std::string& other) {
      std::error_code none;
      return !other.empty() && std::filesystem::equivalent(file, other, none);
    });
  };
  while (is_read(name + ".quads")) name += "_less";
  return name + ".quads";
}

/// By QuadReject.
constexpr MetricKey left_out[quad_reject_count]{"left_out",      "left_out_empty",  "left_out_behind", "left_out_depth",
                                                "left_out_line", "left_out_culled", "left_out_outside"};

/// What is counted of the quads that a draw's first pass has drawn.
void count_quads(std::span<const SnappedQuad> drawn, const Config& config, const DrawState& state,
                 InputResult& result) {
  for (const SnappedQuad& quad : drawn) {
    result["eye_crossing_quads"] += is_eye_crossing(quad);
    result["homogeneous_quads"] += !is_ordinary(quad, config);
    result["antipodal_quads"] += has_antipodal_edge(quad);
    result["tiny_quads"] += is_tiny(quad, config);
    if (const QuadReject reject = quad_reject(quad, config, state); reject != QuadReject::none) {
      ++result["left_out"];
      ++result[left_out[static_cast<std::size_t>(reject)]];
    }
  }
}

}  // namespace

InputResult CosimRun::run_input(const InputOptions& input_options) {
  const Stopwatch start;
  DrawState state = options_.state.state(options_.common, config_);
  int slots = options_.attributes > 0 ? options_.attributes : config_.attribute_slots;
  const auto load = [&] {
    return load_input(input_options, shade_of(options_.shade, options_.texture), state, config_, options_.common.seed);
  };
  DrawInput input = load();
  print_remark(input, options_.common);
  if (!options_.draw_state.empty()) {
    state = golden::random_draw_state(config_, state.width, state.height, input.quads, options_.drawn_state_seed());
    slots = state.attributes;
    if (!input_options.corner.empty()) input = load();  // corner quads may depend on the state
  }
  adjust_state(input, state);
  check_quad_count(input.quads.size(), config_);

  InputResult result;
  result.name = input.name;
  result.option = input.option;
  result.state = StateOptions::of(state).spelled();
  if (slots < config_.attribute_slots) result.attributes = " --attributes " + std::to_string(slots);
  result["quads"] = input.quads.size();
  result["triangles"] = input.triangles;
  result["fanned_faces"] = input.fanned_faces;
  result["fan_primitives"] = input.fan_primitives;
  result["skipped_lines"] = input.skipped_lines;

  if (options_.draws > 0) {
    run_draws(input, plan_draws(input.quads, options_.draws, config_, state.width, state.height, options_.common.seed),
              result);
    result.seconds = start.seconds();
    return result;
  }
  std::optional<CosimPicture> picture;
  if (!options_.out.empty() || !options_.png.empty()) picture.emplace(options_, config_, input, state);

  std::size_t weight_passes = 0;
  const std::vector<Pass> passes = plan_judged_passes(input.attributes, slots, &weight_passes);

  for (std::size_t p = 0; p < passes.size(); ++p) {
    const PassPlace place{passes[p], p};
    if (picture) picture->begin_pass(passes[p], p, weight_passes);
    run_pass(input, state, place, picture ? &*picture : nullptr, result);
    if (!failed_ && !(result.lockstep_ok() && result.check.faults() == 0))
      failed_ = failed_pass(input, state, slots, place, result.lockstep_ok());
    if (!result.lockstep_ok()) break;  // more of the same is of no use
  }
  result["passes"] = passes.size();
  if (!input_options.stress.empty() && result.complete && !options_.by_truth())
    compare_with_limits(input_options.stress, state, result);

  if (picture && result["fragments"] > 0) picture->save();
  result.seconds = start.seconds();
  return result;
}

void CosimRun::run_draws(const DrawInput& input, const std::vector<PlannedDraw>& draws, InputResult& result) {
  if (draws.empty()) return;
  int width = 0, height = 0;  // of the depth buffer, where there is one
  for (const PlannedDraw& draw : draws)
    if (skips_hidden(config_, draw.state)) {
      width = std::max(width, draw.state.width);
      height = std::max(height, draw.state.height);
    }
  LockstepOptions lockstep = options_.lockstep(config_, draws.front().state);
  PartialFile trace(options_.trace);
  if (trace.active()) lockstep.trace = trace.path();
  const Simulator simulator = simulator_in_lockstep(lockstep);
  std::optional<LockstepSession> session;
  HiddenDepths depths(width, height);
  PerformanceCounters counters;
  bool fresh = true;  // a power-on or reset comes before the draw
  for (std::size_t d = 0; d < draws.size(); ++d) {
    const PlannedDraw& draw = draws[d];
    if (d == 0 || draw.power_on) {
      if (d > 0) lockstep.seed = draw.seed;
      session.emplace(simulator, lockstep);
      fresh = true;
    } else if (draw.reset || draws[d - 1].limit > 0) {
      session->reset();
      fresh = true;
      ++result["resets"];
    }
    if (fresh) counters = {};
    if (fresh || draw.clears > 0) depths.clear();
    ++result["draws"];
    result["clears"] += fresh ? 0 : draw.clears;
    fresh = false;
    DrawInput part;
    part.name = input.name;
    part.quads_file = input.quads_file;
    part.quads = draw.quads;
    const DrawPlace place{draw, d + 1, *session, depths, counters};
    const Pass pass = pass_of(input, draw, d);
    const PassPlace only{pass, 0, &place};
    run_pass(part, draw.state, only, nullptr, result);
    if (!failed_ && !(result.lockstep_ok() && result.check.faults() == 0)) {
      failed_ = failed_pass(part, draw.state, draw.state.attributes, only, result.lockstep_ok());
      failed_->input += ", draw " + std::to_string(d + 1);
      failed_->at_port = !draw.at_port.empty();
      set_place(place, failed_->lockstep);
    }
    if (!result.lockstep_ok()) break;  // both sides are apart
  }
  result["passes"] = 1;
  if (trace.active()) trace.commit();
}

/// What a draw of several has of its own.
void CosimRun::set_place(const DrawPlace& place, LockstepOptions& lockstep) const {
  lockstep.seed = place.draw.seed;
  lockstep.flush = place.draw.flush;
  if (place.draw.limit > 0) lockstep.limit_fragments = place.draw.limit;
  if (!options_.waits.empty() || lockstep.stall > 0 || lockstep.gap > 0 || !lockstep.waits.empty()) return;
  lockstep.pattern = place.draw.waits;
  lockstep.stall = place.draw.stall;
  lockstep.gap = place.draw.gap;
}

FragmentChecker::Settings CosimRun::checker_settings(const DrawState& state, const PassPlace& place) const {
  FragmentChecker::Settings settings;
  settings.config = config_;
  settings.state = state;
  settings.pass = place.pass;
  settings.first_pass = place.number == 0;
  settings.snapping = !options_.no_snapping;
  settings.exact = !options_.by_truth();
  return settings;
}

FailedPass CosimRun::failed_pass(const DrawInput& input, const DrawState& draw_state, int slots, const PassPlace& place,
                                 bool lockstep_ok) const {
  DrawState state = draw_state;
  state.attributes = static_cast<int>(place.pass.columns.size());
  return {input.name, input.quads, options_.lockstep(config_, state), checker_settings(state, place),
          slots,      lockstep_ok};
}

/// Regression limits, where some are recorded for such a draw.
void CosimRun::compare_with_limits(const std::string& stress, const DrawState& state, InputResult& result) const {
  const golden::StressFamily family = golden::parse_stress_family(stress);
  if (!limits_apply(config_, state, family, result["quads"])) return;
  const ErrorLimits::Family* limits = ErrorLimits::recorded().find(stress, config_.significand_bits);
  if (limits == nullptr) return;
  result["limits_checked"] = 1;
  result.beyond_limits = beyond_limits(*limits, result.check);
}

void CosimRun::run_pass(const DrawInput& input, const DrawState& draw_state, const PassPlace& place,
                        CosimPicture* picture, InputResult& result) {
  const Pass& pass = place.pass;
  const DrawPlace* const draw = place.draw;
  const bool first = place.number == 0;
  DrawState state = draw_state;
  state.attributes = static_cast<int>(pass.columns.size());
  std::vector<SnappedQuad> snapped;
  snapped.reserve(input.quads.size());
  try {
    if (draw != nullptr) snapped = draw->draw.at_port;
    for (std::size_t i = snapped.size(); i < input.quads.size(); ++i)
      snapped.push_back(snap_as(pass_quad(input.quads[i], pass), static_cast<std::uint32_t>(i), config_, state));
  } catch (const SnapError& error) {
    throw UsageError(describe(error, input));
  }

  LockstepOptions lockstep = options_.lockstep(config_, state);
  PartialFile trace(first && draw == nullptr ? options_.trace : std::string{});
  if (trace.active()) lockstep.trace = trace.path();
  if (draw != nullptr) set_place(*draw, lockstep);
  if (draw != nullptr && !options_.trace.empty()) lockstep.threads = 1;  // the session has the waveform
  Progress progress(input.name + (first ? "" : ", attributes"), 1000, options_.common.show_progress());
  lockstep.progress = [&](double part) { progress.set(static_cast<std::uint64_t>(part * 1000)); };

  const unsigned threads = options_.common.thread_count();
  WorkQueue queue(judging_threads(threads), std::size_t{16} * threads);
  FragmentChecker::Settings check_settings = checker_settings(state, place);
  if (draw != nullptr) {
    check_settings.depths = &draw->depths;
    check_settings.snapping = check_settings.snapping && draw->draw.at_port.empty();
  }
  FragmentChecker checker(check_settings, input.quads, snapped, queue);

  const std::uint32_t znear = depth_code(state.znear, config_), zfar = depth_code(state.zfar, config_);
  const bool compare_skips = options_.compare_skips && first && !options_.by_truth();
  SkipCheck skip_check(config_, state, compare_skips ? snapped.size() : 0);
  const std::uint32_t id_bits = draw != nullptr ? draw->draw.id_bits : 0;
  std::vector<SnappedQuad> sent;  // under other ids, where the draw has some
  if (id_bits != 0) {
    sent = snapped;
    for (SnappedQuad& quad : sent) quad.id ^= id_bits;
  }
  const FragmentSink sink = [&](const Fragment& given) {
    Fragment fragment = given;
    fragment.quad ^= id_bits;
    checker.fragment(fragment);
    if (compare_skips) skip_check.fragment(fragment);
    if (first && state.depth)
      result["at_depth_limit"] +=
          (state.znear > 0 && fragment.depth == znear) || (state.zfar < 1 && fragment.depth == zfar);
    if (picture != nullptr) picture->fragment(fragment);
  };
  std::optional<Simulators> simulators;
  if (first && draw == nullptr && !options_.no_alone && !options_.by_truth()) simulators = build_simulators(lockstep);
  LockstepReport report = simulators ? run_lockstep(simulators->in_lockstep, snapped, lockstep, sink)
                          : draw == nullptr
                              ? run_lockstep(snapped, lockstep, sink)
                              : draw->session.draw(id_bits != 0 ? sent : snapped, lockstep, draw->draw.clears, sink);
  const Stopwatch drawn;
  checker.finish(report.complete);
  queue.drain();
  SkipResult skips;
  if (compare_skips && report.agreed())
    skips = skip_check.compare(snapped, static_cast<std::size_t>(report.quads), report.complete, queue);
  const double seconds = report.wall_seconds + drawn.seconds();  // without building the RTL
  progress.finish();
  if (trace.active()) trace.commit();
  if (picture != nullptr) picture->end_pass();

  result["mismatches"] += report.mismatches;
  result["cycle_mismatches"] += report.cycle_mismatches;
  result["compared_bits"] += report.compared_bits;
  result["cycles_all_passes"] += report.cycles_rtl;
  result["fragments_all_passes"] += report.fragments;
  result.loop_seconds += seconds;
  CheckResult check = checker.result();
  if (draw != nullptr) {
    const std::string name = "draw " + std::to_string(draw->number) + ": ";
    if (report.first_divergence) report.first_divergence = name + *report.first_divergence;
    if (check.first.any) check.first.text = name + check.first.text;
    if (!skips.first.empty()) skips.first = name + skips.first;
    const PerformanceCounters all = std::exchange(draw->counters, report.counters);
    for (std::size_t i = 0; i < counter_count; ++i) report.counters.value[i] -= all.value[i];
  }
  if (!result.first_divergence) result.first_divergence = report.first_divergence;
  if (!result.first_pixel && draw == nullptr) result.first_pixel = faulty_pixel(report, check);
  if (!first) check.compared = 0;  // the same fragments again
  result.check.merge(check);
  result.skips.merge(skips);
  if (!first) return;

  result["quads_drawn"] += report.quads;
  result["fragments"] += report.fragments;
  result["covered_pixels"] += report.pixels;
  result["cycles_rtl"] += report.cycles_rtl;
  result["cycles_model"] += report.cycles_model;
  result.counters += report.counters;
  result.add_hash(report.fragment_hash);
  result.complete = result.complete && (report.complete || (draw != nullptr && draw->draw.limit > 0));
  count_quads(std::span(snapped).first(static_cast<std::size_t>(report.quads)), config_, state, result);
  if (simulators && report.agreed()) time_alone(simulators->alone, snapped, lockstep, report, result);
}

void CosimRun::shrink_failure(const std::vector<InputResult>& results, bool model_ok) const {
  std::fflush(stdout);
  if (!failed_) {  // the draw itself is right
    const bool limits = std::ranges::any_of(results, [](const InputResult& r) { return !r.beyond_limits.empty(); });
    const bool skips = std::ranges::any_of(results, [](const InputResult& r) { return r.skips.differences > 0; });
    const char* const why = skips       ? "only draws with other skips differ"
                            : limits    ? "only regression limits are exceeded"
                            : !model_ok ? "only input-independent model checks failed"
                                        : "no fragments compared";
    std::fprintf(stderr, "quadrille: not minimized: %s\n", why);
    return;
  }
  if (failed_->at_port) return;
  try {
    shrink_failed_pass(*failed_, {shrunk_file(options_), options_.shrink_seconds}, options_.common);
  } catch (const std::exception& error) {  // the run has failed and is reported, whatever becomes of this
    std::fprintf(stderr, "quadrille: %s not minimized: %s\n", failed_->input.c_str(), error.what());
  }
}

}  // namespace quadrille::tb
