// `quadrille cosim --battery`.
#include "tb/commands/cosim_battery.hpp"
#include "tb/commands/cosim_report.hpp"
#include "tb/commands/cosim_run.hpp"

#include "golden/io/json_report.hpp"
#include "tb/judge/model_check.hpp"
#include "tb/lockstep/lockstep.hpp"
#include "tb/support/errors.hpp"
#include "tb/support/stopwatch.hpp"
#include "tb/support/work_queue.hpp"

#include <algorithm>
#include <deque>
#include <mutex>
#include <optional>

namespace quadrille::tb {
namespace {

/// The command's options for a group.
CosimOptions options_of(const BatteryGroup& group, CosimOptions options) {
  options.common.settings = group.settings;
  options.common.threads = 1;
  options.common.quiet = true;
  options.no_snapping = true;
  return options;
}

/// A group of the battery and what came of it.
struct GroupRun {
  BatteryGroup group;
  CosimOptions options;
  Config config;
  CosimRun run;
  InputResult result;
  std::optional<ModelCheck> model;  ///< of the first group of a configuration
  bool done = false;
  std::string error;

  GroupRun(BatteryGroup one, const CosimOptions& given)
      : group(std::move(one)),
        options(options_of(group, given)),
        config(options.common.config()),
        run(options, config) {}
  GroupRun(const GroupRun&) = delete;
  GroupRun& operator=(const GroupRun&) = delete;

  bool ok() const { return error.empty() && result.ok() && (!model || model->ok()); }
};

std::deque<GroupRun> chosen_groups(const CosimOptions& options) {
  std::deque<GroupRun> runs;
  std::string names;
  for (BatteryGroup& group : battery_groups()) {
    names += " " + group.name;
    const std::string& wanted = options.battery;
    if (wanted == "all" || group.name == wanted || group.name.starts_with(wanted + ".") ||
        group.name.ends_with("." + wanted))
      runs.emplace_back(std::move(group), options);
  }
  if (runs.empty()) throw UsageError("--battery " + options.battery + ": no such group; the groups are" + names);
  return runs;
}

/// One group, its functions of the model with the first of its configuration.
void run_group(GroupRun& group, bool with_functions) {
  group.result.name = group.group.name;
  try {
    DrawInput input;
    input.name = group.group.name;
    input.attributes = group.config.attribute_slots;
    const Stopwatch start;
    group.run.run_draws(input, group.group.draws(group.config, group.options.common.seed), group.result);
    group.result.seconds = start.seconds();
    if (with_functions) group.model = check_model(group.config);
  } catch (const WatchdogError& error) {
    group.error = error.what();
  }
}

void print_group(std::FILE* text, const GroupRun& group) {
  const InputResult& r = group.result;
  std::fprintf(text, "%-20s %6llu %7llu %10llu %10llu  %s\n", group.group.name.c_str(),
               static_cast<unsigned long long>(r["draws"]), static_cast<unsigned long long>(r["quads_drawn"]),
               static_cast<unsigned long long>(r["fragments"]), static_cast<unsigned long long>(r["cycles_rtl"]),
               group.ok() ? "ok" : "FAILED");
  std::fflush(text);
}

nlohmann::ordered_json battery_report(const std::deque<GroupRun>& groups, bool ok, const CosimOptions& options,
                                      const Config& config, const std::vector<std::string>& arguments) {
  nlohmann::ordered_json json = golden::begin_report(config, options.common.seed, arguments);
  json["ok"] = ok;
  for (const GroupRun& group : groups) {
    nlohmann::ordered_json one = CosimReport(group.options, group.config).result(group.result);
    one["settings"] = group.group.settings;
    one["ok"] = group.ok();
    if (!group.error.empty()) one["error"] = group.error;
    json["groups"].push_back(std::move(one));
  }
  return json;
}

}  // namespace

int run_battery(const CosimOptions& options, const Config& config, const std::vector<std::string>& arguments) {
  const Stopwatch start;
  std::deque<GroupRun> groups = chosen_groups(options);
  std::vector<std::vector<std::string>> built;
  for (const GroupRun& group : groups) {  // one after the other: each build takes all processors
    if (std::ranges::find(built, group.group.settings) != built.end()) continue;
    built.push_back(group.group.settings);
    simulator_in_lockstep(group.options.lockstep(group.config, {}));
  }
  const double building = start.seconds();

  std::FILE* const text = options.common.text();
  if (text) std::fprintf(text, "%-20s %6s %7s %10s %10s  %s\n", "group", "draws", "quads", "fragments", "cycles", "");
  std::mutex mutex;
  std::size_t printed = 0;
  bool ok = true;
  WorkQueue queue(options.common.thread_count() - 1, groups.size());
  built.clear();
  for (GroupRun& group : groups) {
    const bool first = std::ranges::find(built, group.group.settings) == built.end();
    if (first) built.push_back(group.group.settings);
    queue.push([&, first] {
      run_group(group, first);
      const std::lock_guard lock(mutex);
      group.done = true;
      for (; printed < groups.size() && groups[printed].done; ++printed) {  // in order, whoever was faster
        ok = ok && groups[printed].ok();
        if (text) print_group(text, groups[printed]);
      }
    });
  }
  queue.drain();
  if (text)
    std::fprintf(text, "\n%s: %zu groups, seed %llu, %.1f s (%.1f s for building)\n", ok ? "OK" : "FAILED",
                 groups.size(), static_cast<unsigned long long>(options.common.seed), start.seconds(), building);
  if (!options.common.json.empty())
    golden::save_json(options.common.json, battery_report(groups, ok, options, config, arguments));
  std::fflush(stdout);
  const GroupRun* failed = nullptr;
  for (const GroupRun& group : groups) {
    if (group.ok()) continue;
    if (failed == nullptr) failed = &group;
    complain(group.result);
    if (!group.error.empty())
      std::fprintf(stderr, "quadrille: %s: %s\n", group.group.name.c_str(), group.error.c_str());
    if (group.model && !group.model->ok())
      std::fprintf(stderr, "quadrille: %s: model check: %s\n", group.group.name.c_str(), group.model->fault().c_str());
  }
  if (failed != nullptr) {
    std::string command =
        "quadrille cosim --battery " + failed->group.name + " --seed " + std::to_string(options.common.seed);
    if (!options.rtl.empty()) command += " --rtl " + quoted(options.rtl);
    std::fprintf(stderr, "quadrille: to repeat the first failing group:\n  %s\n", command.c_str());
    if (!options.no_shrink && failed->run.failed())
      failed->run.shrink_failure({failed->result}, !failed->model || failed->model->ok());
  }
  return ok ? exit_ok : exit_mismatch;
}

}  // namespace quadrille::tb
