#include "tb/verify/faults/checks.hpp"

#include "golden/io/temporary.hpp"
#include "golden/vectors/machine_run.hpp"
#include "golden/vectors/suite.hpp"
#include "model/port/config_text.hpp"
#include "model/untimed.hpp"
#include "tb/device/verilated_device.hpp"
#include "tb/judge/error_limits.hpp"
#include "tb/judge/function_check.hpp"
#include "tb/judge/judge.hpp"
#include "tb/judge/verify_exact.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <stdexcept>
#include <utility>

namespace quadrille::tb {
namespace {

using Found = std::optional<std::string>;

// ---- RTL against model, clock by clock ----

Found lockstep(const Scenario* s) {
  VerilatedDevice device(simulator_of(s->options.config), s->options.config, s->options.seed);
  try {
    for (int run = 0; run < (s->again ? 2 : 1); ++run) {
      const LockstepReport report = run_lockstep(device, s->quads, s->options);
      if (!report.agreed()) return report.first_divergence;
      if (!anything_selected() && (!report.complete || (report.fragments == 0) != s->invisible))
        return std::to_string(report.fragments) + " fragments were compared";
    }
    return {};
  } catch (const WatchdogError& hang) {
    return hang.what();
  }
}

// ---- the RTL alone: its own assertions, and what it draws ----

/// A run of one scenario, which two checks look at: it is made once for a fault.
struct RtlRun {
  std::vector<Fragment> fragments;
  Found assertion, hang;
};
std::map<const Scenario*, RtlRun> rtl_runs;

RtlRun& rtl_alone(const Scenario& s) {
  static int fault = 0;
  if (const int selected = selected_in_rtl(); std::exchange(fault, selected) != selected) rtl_runs.clear();
  const auto [place, made] = rtl_runs.try_emplace(&s);
  RtlRun& run = place->second;
  if (!made) return run;
  try {
    run_rtl_alone(simulator_of(s.options.config), s.quads, s.options,
                  [&](const Fragment& f) { run.fragments.push_back(f); });
  } catch (const DeviceError& stop) {
    run.assertion = stop.what();
  } catch (const WatchdogError& hang) {
    run.hang = hang.what();
  }
  return run;
}

Found assertions(const Scenario* s) { return rtl_alone(*s).assertion; }

// ---- fragments against the truth ----

Found said(const CheckResult& result, bool invisible) {
  if (result.ok()) return {};
  if (result.first.any) return result.first.text;
  for (const auto& counter : fault_counters)
    if (result.*counter.value != 0) return std::to_string(result.*counter.value) + " " + counter.key;
  if (invisible) return {};
  return "nothing was compared";
}

/// The truth drops no bits of D and r²: neither classes nor weights are then its own.
bool truth_speaks_of(const Scenario& s) { return s.options.config.qdrop() == 0; }

Found truth(const Scenario* s) {
  if (!truth_speaks_of(*s)) return {};
  return said(judge_untimed(s->quads, s->options.config, s->options.state, PixelEngine::plain), s->invisible);
}

Found truth_of_rtl(const Scenario* s) {
  if (!truth_speaks_of(*s)) return {};
  std::vector<WindowQuad> names(s->quads.size());
  for (std::size_t i = 0; i < names.size(); ++i) names[i].id = s->quads[i].id;
  FragmentChecker::Settings settings;
  settings.config = s->options.config;
  settings.state = s->options.state;
  for (int j = 0; j < settings.state.attributes; ++j) settings.pass.columns.push_back(4 + j);
  settings.snapping = false;
  const RtlRun run = std::move(rtl_alone(*s));
  rtl_runs.erase(s);             // it is the last to look
  if (run.assertion) return {};  // that is the assertions' finding
  if (run.hang) return run.hang;
  return said(check_here(settings, names, s->quads,
                         [&](const FragmentSink& sink) {
                           std::ranges::for_each(run.fragments, sink);
                           return true;
                         }),
              s->invisible);
}

// ---- the model's functions against exact arithmetic ----

Found functions(const Scenario*) {
  std::vector<Config> configs{Config{}};
  for (const std::span<const Scenario> list : {scenarios(), further_scenarios()})
    for (const Scenario& s : list)
      if (std::ranges::find(configs, s.options.config) == configs.end()) configs.push_back(s.options.config);
  for (const Config& config : configs)
    if (const FunctionReport report = check_functions(config); !report.ok())
      return summary(config) + ": " + report.first();
  return {};
}

// ---- errors against their regression limits ----

Found limits(const Scenario*) {
  for (const int significand_bits : {12, 18})
    for (const golden::StressFamily family : {golden::StressFamily::general, golden::StressFamily::perspective,
                                              golden::StressFamily::near_vertex, golden::StressFamily::reflex}) {
      const std::string_view name = golden::stress_family_name(family);
      const ErrorLimits::Family* recorded = ErrorLimits::recorded().find(name, significand_bits);
      if (recorded == nullptr) return "no limits of " + std::string(name);
      const CheckResult result = judge_limit_draw(family, significand_bits, 1, PixelEngine::plain);
      if (const std::vector<std::string> beyond = beyond_limits(*recorded, result); !beyond.empty())
        return std::string(name) + ", s = " + std::to_string(significand_bits) + ": " + beyond.front();
    }
  return {};
}

// ---- the model's two pixel pipelines against each other ----

Found lanes(const Scenario* s) {
  const auto draw = [&](PixelEngine engine) {
    std::vector<Fragment> fragments;
    UntimedModel model(s->options.config, s->options.state, engine);
    for (const SnappedQuad& quad : s->quads)
      model.draw(quad, [&](std::span<const Fragment> f) { fragments.insert(fragments.end(), f.begin(), f.end()); });
    return fragments;
  };
  const std::vector<Fragment> plain = draw(PixelEngine::plain), eight = draw(PixelEngine::lanes);
  if (plain == eight) return {};
  const auto [a, b] = std::mismatch(plain.begin(), plain.end(), eight.begin(), eight.end());
  if (a == plain.end() || b == eight.end())
    return std::to_string(plain.size()) + " fragments, lanes " + std::to_string(eight.size());
  return "quad " + std::to_string(a->quad) + ", pixel (" + std::to_string(a->x) + ", " + std::to_string(a->y) +
         "): the lanes differ";
}

// ---- golden vectors ----

/// What a set says, suite by suite, of the machine as it is.
Found verified(const std::filesystem::path& directory,
               vectors::VerifyResult (*verify)(const vectors::Suite&, const vectors::SuiteReader&)) {
  const vectors::SetReader set(directory);
  for (const std::string& name : set.suites()) {
    const vectors::SuiteReader reader = set.suite(name);
    const vectors::VerifyResult result = verify(vectors::find_suite(name), reader);
    if (result.mismatches != 0) return result.first_difference;
  }
  return {};
}

/// A set written by the machine as it is.
Found float_vectors(const Scenario*) {
  const golden::Temporary temporary(std::filesystem::temp_directory_path(), golden::Temporary::Kind::folder);
  vectors::GenerateOptions generation;
  generation.limit = 300;
  const vectors::SetInfo info{generation.level, generation.seed, generation.config, generation.limit, {}};
  const std::filesystem::path directory = temporary.path() / "set";
  vectors::SetWriter writer(directory, info, false);
  for (const auto& suite : vectors::suites())
    writer.add(suite->info(), [&](vectors::SuiteWriter& out) { suite->write(out, generation); });
  writer.commit(true);
  return verified(directory, [](const vectors::Suite& suite, const vectors::SuiteReader& reader) {
    return verify_exact(suite, reader, 1);
  });
}

Found kept_vectors(const Scenario*) {
  return verified(
      std::filesystem::path(QUADRILLE_SOURCE_DIR) / "golden/vectors/kept",
      [](const vectors::Suite& suite, const vectors::SuiteReader& reader) { return suite.verify(reader, 1); });
}

std::optional<Finding> run(const CheckInfo& check, const Mutant& mutant, bool rtl, bool model) {
  std::vector<const Scenario*> order;
  for (const Scenario& s : scenarios()) {
    order.push_back(&s);
    if (check.sees_rtl) simulator_of(s.options.config);  // with no fault selected: the tables are the model's
  }
  std::stable_partition(order.begin(), order.end(), [&](const Scenario* s) { return mutant.scenario == s->name; });
  const Selected selected(mutant, rtl, model);
  if (!check.by_scenario) {
    try {
      if (Found what = check.find(nullptr)) return Finding{check.name, *what};
    } catch (const vectors::MachineError& broken) {
      return Finding{check.name, broken.what()};
    }
    return {};
  }
  for (const Scenario* s : order)
    if (Found what = check.find(s)) return Finding{s->name, *what};
  return {};
}

}  // namespace

std::span<const CheckInfo> all_checks() {
  static const std::vector<CheckInfo> list{
      {"lockstep", true, true, lockstep},
      {"assertions", true, true, assertions},
      {"truth of RTL", true, true, truth_of_rtl},
      {"truth", false, true, truth},
      {"limits", false, false, limits},
      {"functions", false, false, functions},
      {"lanes", false, true, lanes},
      {"float", false, false, float_vectors},
      {"kept", false, false, kept_vectors},
  };
  return list;
}

const CheckInfo& check_named(std::string_view name) {
  const auto checks = all_checks();
  const auto found = std::ranges::find(checks, name, &CheckInfo::name);
  if (found == checks.end()) throw std::runtime_error("no check \"" + std::string(name) + "\"");
  return *found;
}

bool applies(const CheckInfo& check, const Mutant& mutant) {
  switch (mutant.side) {
    case Mutant::Side::rtl:
      return check.sees_rtl;
    case Mutant::Side::model:
      return check.name == "lockstep" || !check.sees_rtl;
    case Mutant::Side::common:
      return !check.sees_rtl;
  }
  return false;
}

std::optional<Finding> run_check(const CheckInfo& check, const Mutant& mutant) {
  const bool rtl = mutant.side == Mutant::Side::rtl;
  return run(check, mutant, rtl, !rtl);
}

std::optional<Finding> run_on_both(const CheckInfo& check, const Mutant& mutant) {
  return run(check, mutant, true, true);
}

const Simulator& simulator_of(const Config& config) {
  static std::map<std::string, Simulator> simulators;
  const std::string key = changed_keys(config, " ");
  const auto found = simulators.find(key);
  if (found != simulators.end()) return found->second;
  VerilateOptions build;
  build.source = QUADRILLE_MUTANT_RTL;
  build.optimise = 1;
  return simulators.emplace(key, verilate(config, build)).first->second;
}

}  // namespace quadrille::tb
