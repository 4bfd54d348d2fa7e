#include "tb/studies/bench_error.hpp"

#include "golden/reference/paper_float.hpp"
#include "golden/reference/truth.hpp"
#include "model/port/snap.hpp"
#include "model/untimed.hpp"
#include "tb/judge/check.hpp"
#include "tb/lockstep/lockstep.hpp"
#include "tb/studies/bench_timing.hpp"
#include "tb/support/stopwatch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <stdexcept>

namespace quadrille::tb {
namespace {

using golden::PaperFp32Quad;
using golden::PaperFp64Quad;
using golden::ReferenceSample;
using golden::TruthQuad;

constexpr std::size_t truth_samples = 2000;  ///< per timed run, about
constexpr std::size_t truth_stretch = 250;   ///< that follow one another, so that set-up has its share
constexpr double shortest_run = 2e-3;        ///< seconds; quicker draws are repeated within a run

LockstepOptions alone(const Config& config, const DrawState& state) {
  LockstepOptions options;
  options.config = config;
  options.state = state;
  return options;
}

/// What the others must equal first.
constexpr std::array machines{EngineKind::model, EngineKind::model_plain, EngineKind::model_clocked, EngineKind::rtl};

PixelEngine pixel_engine(EngineKind body) {
  return body == EngineKind::model_plain ? PixelEngine::plain : PixelEngine::lanes;
}

std::string text_of(const Fragment& fragment) {
  char text[96];
  std::snprintf(text, sizeof text, "quad %u, pixel (%d, %d)", fragment.quad, fragment.x, fragment.y);
  return text;
}

void add_errors(const ReferenceSample& sample, const ReferenceSample& truth, const DrawState& state, bool exempt,
                BodyResult& result) {
  if (!exempt) {
    double lambda = 0, attribute = 0;
    for (std::size_t i = 0; i < 4; ++i) lambda = std::max(lambda, std::fabs(sample.lambda[i] - truth.lambda[i]));
    for (std::size_t a = 0; a < static_cast<std::size_t>(state.attributes); ++a)
      attribute = std::max(attribute, std::fabs(sample.attribute[a] - truth.attribute[a]));
    result.lambda.add(lambda);
    if (state.attributes > 0) result.attribute.add(attribute);
  }
  if (state.depth) result.depth.add(sample.z - truth.z);
}

bool in_depth(const ReferenceSample& sample, const DrawState& state) {
  return !state.depth || (sample.z >= state.znear && sample.z <= state.zfar);
}

/// A reference's answer for a pixel that the truth draws.
void add_sample(const ReferenceSample& sample, const ReferenceSample& truth, const DrawState& state, bool exempt,
                BodyResult& result) {
  ++result.fragments;
  if (sample.covered && sample.undefined)
    ++result.undefined;
  else if (!sample.covered || !sample.visible || !in_depth(sample, state))
    ++result.missing;
  else
    add_errors(sample, truth, state, exempt, result);
}

/// What `result` holds against a machine, in words; empty for nothing.
std::string complaint(const CheckResult& result) {
  if (result.compared == 0) return "no fragments";
  std::string text;
  const auto add = [&](std::uint64_t n, const std::string& what) {
    if (n != 0) text += (text.empty() ? "" : ", ") + std::to_string(n) + " " + what;
  };
  add(result.mismatches, "pixels that differ from the truth (" + result.first.text + ")");
  add(result.beyond_bound, "weights beyond the bound");
  add(result.beyond_attribute, "attributes beyond what the bound allows");
  add(result.beyond_depth, "depths beyond what the bound allows");
  return text;
}

}  // namespace

std::vector<Fragment> draw_body(EngineKind body, std::span<const SnappedQuad> quads, const Config& config,
                                const DrawState& state) {
  std::vector<Fragment> fragments;
  const FragmentSink sink = [&](const Fragment& fragment) { fragments.push_back(fragment); };
  switch (body) {
    case EngineKind::model:
    case EngineKind::model_plain: {
      UntimedModel model(config, state, pixel_engine(body));
      for (const SnappedQuad& quad : quads)
        model.draw(quad, [&](std::span<const Fragment> f) { fragments.insert(fragments.end(), f.begin(), f.end()); });
      return fragments;
    }
    case EngineKind::model_clocked:
      run_clocked_model_alone(quads, alone(config, state), sink);
      return fragments;
    case EngineKind::rtl:
      run_rtl_alone(quads, alone(config, state), sink);
      return fragments;
    default:
      throw std::logic_error("draw_body: not a machine");
  }
}

std::string first_difference(std::span<const Fragment> expected, std::span<const Fragment> actual) {
  const auto [e, a] = std::mismatch(expected.begin(), expected.end(), actual.begin(), actual.end());
  if (e == expected.end() && a == actual.end()) return {};
  const std::string where = "fragment " + std::to_string(e - expected.begin());
  if (e == expected.end()) return where + " (" + text_of(*a) + ") is one too many";
  if (a == actual.end()) return where + " (" + text_of(*e) + ") is missing";
  return where + " (" + text_of(*e) + ") differs";
}

ErrorBench::ErrorBench(const Settings& settings, std::span<const WindowQuad> quads, int attributes)
    : settings_(settings), attributes_(attributes), first_pass_(plan_passes(0, true, settings.config).front()) {
  check_quad_count(quads.size(), settings_.config);
  choose_quads(quads);
}

DrawState ErrorBench::pass_state(const Pass& pass) const {
  DrawState state = settings_.state;
  state.attributes = static_cast<int>(pass.columns.size());
  return state;
}

std::vector<SnappedQuad> ErrorBench::snap(const Pass& pass) const {
  return snap_pass(quads_, pass, settings_.config, pass_state(pass));
}

void ErrorBench::choose_quads(std::span<const WindowQuad> quads) {
  const DrawState state = pass_state(first_pass_);
  UntimedModel model(settings_.config, state);
  const auto enough = [&] { return pixels_.size() >= settings_.limit_fragments; };
  for (const WindowQuad& quad : quads) {
    if (enough() && quads_.size() >= least_quads) break;
    const auto index = static_cast<std::uint32_t>(quads_.size());
    const SnappedQuad snapped = snap_as(pass_quad(quad, first_pass_), index, settings_.config, state);
    const bool timed = !enough();
    model.draw(snapped, [&](std::span<const Fragment> fragments) {
      for (const Fragment& fragment : fragments) pixels_.push_back({fragment.quad, fragment.x, fragment.y});
    });
    quads_.push_back(quad);
    if (!timed) continue;
    timed_.push_back(snapped);
    timed_pixels_ = pixels_.size();
  }
}

void ErrorBench::compare() {
  results_ = {};
  failures_.clear();
  compare_machine();
  compare_paper();
}

/// Weights first, then attributes; every machine against the model bit for bit, the model against the truth.
void ErrorBench::compare_machine() {
  std::size_t weight_passes = 0;
  const std::vector<Pass> passes = plan_judged_passes(attributes_, settings_.config.attribute_slots, &weight_passes);

  PerEngine<CheckResult> checks;
  PerEngine<bool> told{};
  for (std::size_t p = 0; p < passes.size(); ++p) {
    const std::vector<SnappedQuad> snapped = snap(passes[p]);
    FragmentChecker::Settings check_settings;
    check_settings.config = settings_.config;
    check_settings.state = pass_state(passes[p]);
    check_settings.pass = passes[p];
    check_settings.first_pass = p == 0;
    check_settings.snapping = false;
    const auto check = [&](std::span<const Fragment> fragments) {
      return check_here(check_settings, quads_, snapped, [&](const auto& sink) {
        std::ranges::for_each(fragments, sink);
        return true;
      });
    };

    std::vector<Fragment> expected;
    CheckResult of_model;
    for (const EngineKind body : machines) {
      if (!has(body)) continue;
      const std::vector<Fragment> actual = settings_.draw(body, snapped, settings_.config, pass_state(passes[p]));
      if (body == EngineKind::model) {
        expected = actual;
        of_model = check(expected);
      }
      const std::string difference = first_difference(expected, actual);
      if (!difference.empty() && !told[body]) {
        told[body] = true;
        failures_.push_back(std::string(engine_info(body).name) + " differs from model: " + difference +
                            (p < weight_passes ? " (weights)" : " (attributes)"));
      }
      checks[body].merge(difference.empty() ? of_model : check(actual));
    }
  }

  for (const EngineKind body : machines) {
    if (!has(body)) continue;
    const CheckResult& found = checks[body];
    BodyResult& r = results_[body];
    r.fragments = found.compared;
    r.missing = found.mismatches;
    r.lambda = found.arithmetic.lambda;
    r.attribute = found.arithmetic.attribute;
    r.depth = found.arithmetic.depth;
    if (const std::string text = complaint(found); !text.empty())
      failures_.push_back(std::string(engine_info(body).name) + ": " + text);
  }
}

/// On the pixels of the model, which the checker compares with the truth's.
void ErrorBench::compare_paper() {
  DrawState state = settings_.state;
  state.attributes = attributes_;
  Pass pass;
  for (int a = 0; a < attributes_; ++a) pass.columns.push_back(4 + a);
  const Config config = snapping_config(settings_.config, attributes_);

  struct Bodies {
    TruthQuad truth;
    PaperFp32Quad fp32;
    PaperFp64Quad fp64;
    bool exempt;
  };
  std::optional<Bodies> quad;
  std::uint32_t current = 0;
  for (const Pixel& pixel : pixels_) {
    if (!quad || pixel.quad != current) {
      current = pixel.quad;
      const SnappedQuad snapped = snap_as(pass_quad(quads_[current], pass), current, config, state);
      const bool behind = std::any_of(snapped.vertex.begin(), snapped.vertex.end(),
                                      [](const SnappedVertex& vertex) { return vertex.w <= 0; });
      quad.emplace(Bodies{TruthQuad(snapped, config, state), PaperFp32Quad(snapped, config, state),
                          PaperFp64Quad(snapped, config, state), !state.perspective && behind});
    }
    const ReferenceSample truth = quad->truth.sample(pixel.x, pixel.y);
    // Drawn by the model all the same: tolerated where sum(M w) is near 0, or z near the ends of its interval.
    if (!truth.covered || !truth.visible || !in_depth(truth, state)) continue;
    ++results_[EngineKind::truth].fragments;
    add_errors(truth, truth, state, quad->exempt, results_[EngineKind::truth]);
    add_sample(quad->fp32.sample(pixel.x, pixel.y), truth, state, quad->exempt, results_[EngineKind::paper_single]);
    add_sample(quad->fp64.sample(pixel.x, pixel.y), truth, state, quad->exempt, results_[EngineKind::paper_float]);
  }
}

void ErrorBench::time(int repeat) {
  PerEngine<std::vector<double>> seconds;
  for (int round = 0; round < repeat; ++round) {
    for (const EngineKind body : error_engines) {
      if (!has(body) || timed_pixels_ == 0) continue;
      Run sum;
      while (sum.seconds < shortest_run) {
        const Run run = run_once(body);
        sum.fragments += run.fragments;
        sum.seconds += run.seconds;
        results_[body].counters = run.counters;
        results_[body].lanes = run.lanes;
      }
      seconds[body].push_back(sum.seconds / static_cast<double>(sum.fragments));
    }
  }
  for (const EngineKind body : error_engines)
    if (!seconds[body].empty()) results_[body].seconds_per_fragment = median(std::move(seconds[body]));
}

ErrorBench::Run ErrorBench::run_once(EngineKind body) const {
  // The functions are not inlined, so that nothing of their results is left out.
  switch (body) {
    case EngineKind::paper_single:
      return run_reference<PaperFp32Quad>(1, [](const auto& quad, int x, int y) { quad.interpolate(x, y); });
    case EngineKind::paper_float:
      return run_reference<PaperFp64Quad>(1, [](const auto& quad, int x, int y) { quad.interpolate(x, y); });
    case EngineKind::truth:
      return run_reference<TruthQuad>(std::max<std::size_t>(1, timed_pixels_ / truth_samples),
                                      [](const auto& quad, int x, int y) { quad.sample(x, y); });
    default:
      return run_machine(body);
  }
}

ErrorBench::Run ErrorBench::run_machine(EngineKind body) const {
  const DrawState state = pass_state(first_pass_);
  if (body == EngineKind::model_clocked || body == EngineKind::rtl) {
    const AloneRun run = body == EngineKind::rtl ? run_rtl_alone(timed_, alone(settings_.config, state))
                                                 : run_clocked_model_alone(timed_, alone(settings_.config, state));
    return {run.fragments, run.seconds, run.counters, {}};
  }
  UntimedModel model(settings_.config, state, pixel_engine(body));
  Run run;
  const CpuStopwatch stopwatch;
  for (const SnappedQuad& quad : timed_)
    model.draw_arrays(quad, [&](const FragmentArrays& fragments) { run.fragments += fragments.size; });
  run.seconds = stopwatch.seconds();
  run.lanes = model.lane_pixels();
  return run;
}

/// Every stride-th stretch of the timed quads' pixels.
template <class Quad, class Visit>
ErrorBench::Run ErrorBench::run_reference(std::size_t stride, Visit&& visit) const {
  const DrawState state = pass_state(first_pass_);
  Run run;
  std::optional<Quad> quad;
  std::uint32_t current = 0;
  const CpuStopwatch stopwatch;
  for (std::size_t i = 0; i < timed_pixels_; ++i) {
    if (i / truth_stretch % stride != 0) continue;
    const Pixel& pixel = pixels_[i];
    if (!quad || pixel.quad != current) {
      current = pixel.quad;
      quad.emplace(timed_[current], settings_.config, state);
    }
    visit(*quad, pixel.x, pixel.y);
    ++run.fragments;
  }
  run.seconds = stopwatch.seconds();
  return run;
}

}  // namespace quadrille::tb
