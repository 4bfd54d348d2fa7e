// Puts generated mutants through the checks, each in a process of its own, until one sees it. Prints a line of JSON for
// each mutant, in the order of the list; report_mutants.py makes the table of it.
//
//   mutate [--name NAME]… [--jobs J] [--limit SECONDS] [--afresh]
//
// A mutant of the RTL is compared with the model in lockstep. One of the model is too, and then goes through the checks
// that see the model alone. One of both alike goes through these only: that the RTL errs alike hides it from lockstep,
// which is proved where the list has an edit of the RTL too, by a lockstep with both faults on that shows nothing. A
// check that takes longer than --limit seconds in one scenario is ended: the fault is found, as hung. What the record
// says is looked at first, unless --afresh.
#include "tb/support/environment_error.hpp"
#include "tb/verify/faults/checks.hpp"
#include "tb/verify/faults/model_tests.hpp"

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

namespace quadrille::tb {
namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

/// Cheapest first: what each takes of a machine without a fault grows down the list. Then the model's own tests.
constexpr std::string_view model_checks[]{"truth", "lanes", "functions", "kept", "float", "limits"};
constexpr const char* own_tests = "tests";

/// One line of a child to its parent.
void say(int to, const Json& what) {
  const std::string line = what.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  if (write(to, line.data(), line.size()) != static_cast<ssize_t>(line.size())) _exit(3);
}

std::string kind_of(const std::string& what) {
  if (what.find("the RTL stopped") != std::string::npos) return "assertion";
  return "difference";
}

/// What a check says of one scenario (none: null) with the mutant selected; a progress line first.
bool finds(int to, const CheckInfo& check, const Scenario* scenario) {
  const std::string where = scenario == nullptr ? check.name : scenario->name;
  say(to, {{"check", check.name}, {"where", where}});
  try {
    const std::optional<std::string> what = check.find(scenario);
    if (!what) return false;
    say(to, {{"killed", check.name}, {"where", where}, {"how", kind_of(*what)}, {"what", *what}});
  } catch (const std::exception& error) {
    say(to, {{"killed", check.name}, {"where", where}, {"how", "error"}, {"what", error.what()}});
  }
  return true;
}

/// In the order in which a mutant goes through them.
const std::vector<const Scenario*>& every_scenario() {
  static const std::vector<const Scenario*> list = [] {
    std::vector<const Scenario*> all;
    for (const Scenario& s : scenarios()) all.push_back(&s);
    for (const Scenario& s : further_scenarios()) all.push_back(&s);
    return all;
  }();
  return list;
}

bool finds_anywhere(int to, const CheckInfo& check) {
  if (!check.by_scenario) return finds(to, check, nullptr);
  return std::ranges::any_of(every_scenario(), [&](const Scenario* s) { return finds(to, check, s); });
}

bool finds_with_tests(int to) {
  const auto begins = [&](const std::string& test) { say(to, {{"check", own_tests}, {"where", test}}); };
  const auto failed = failing_test(begins);
  if (failed) say(to, {{"killed", own_tests}, {"where", failed->name}, {"how", "difference"}, {"what", failed->what}});
  return failed.has_value();
}

/// The check that the record names, in the scenario that it names.
bool finds_as_recorded(int to, const Mutant& mutant) {
  if (mutant.checks.empty()) return false;
  if (mutant.checks.front() == own_tests) return finds_with_tests(to);
  const auto check = std::ranges::find(all_checks(), mutant.checks.front(), &CheckInfo::name);
  if (check == all_checks().end()) return false;  // a lockstep of both, which has crashed before
  if (!check->by_scenario) return finds(to, *check, nullptr);
  return std::ranges::any_of(every_scenario(),
                             [&](const Scenario* s) { return s->name == mutant.scenario && finds(to, *check, s); });
}

/// The checks on one mutant, in the child.
void look(int to, const Mutant& mutant, bool afresh) {
  const CheckInfo& lockstep = check_named("lockstep");
  if (mutant.side == Mutant::Side::common && mutant.in_rtl) {
    const Selected both(mutant, true, true);
    bool seen = false;
    for (const Scenario* s : every_scenario()) {
      say(to, {{"check", "lockstep of both"}, {"where", s->name}});
      try {
        seen = lockstep.find(s).has_value();
      } catch (const std::exception&) {
        seen = true;
      }
      if (seen) break;
    }
    say(to, {{"twin", !seen}});
  }
  const bool rtl = mutant.side == Mutant::Side::rtl;
  const Selected selected(mutant, rtl, !rtl);
  if (!afresh && finds_as_recorded(to, mutant)) return;
  if (mutant.side != Mutant::Side::common && finds_anywhere(to, lockstep)) return;
  if (rtl) return;  // what agrees with the model in every clock is as good as that
  for (const std::string_view name : model_checks)
    if (finds_anywhere(to, check_named(name))) return;
  finds_with_tests(to);
}

/// A child that looks at a mutant.
struct Run {
  std::size_t index = 0;
  pid_t pid = 0;
  int from = -1;
  std::string text;                ///< what it said and is not a whole line yet
  Json last, result;               ///< the last progress; the finding
  Clock::time_point begin, since;  ///< since: of the last progress
  bool twin_undecided = false;
};

Run start(std::size_t index, const Mutant& mutant, bool afresh) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe");
  std::fflush(nullptr);
  const pid_t pid = fork();
  if (pid < 0) throw std::runtime_error("no process");
  if (pid == 0) {
    close(ends[0]);
    std::freopen("/dev/null", "w", stderr);
    std::freopen("/dev/null", "w", stdout);
    look(ends[1], mutant, afresh);
    say(ends[1], {{"done", true}});
    _exit(0);
  }
  close(ends[1]);
  Run run;
  run.index = index;
  run.pid = pid;
  run.from = ends[0];
  run.begin = run.since = Clock::now();
  return run;
}

/// Takes in what the child says; false when it is at its end.
bool listen(Run& run) {
  char buffer[4096];
  const ssize_t size = read(run.from, buffer, sizeof buffer);
  if (size <= 0) return false;
  run.text.append(buffer, static_cast<std::size_t>(size));
  for (std::size_t end; (end = run.text.find('\n')) != std::string::npos; run.text.erase(0, end + 1)) {
    const Json line = Json::parse(run.text.substr(0, end));
    if (line.contains("check")) run.last = line;
    for (const char* key : {"killed", "where", "how", "what", "twin", "done"})
      if (line.contains(key) && (key != std::string_view("where") || line.contains("killed")))
        run.result[key] = line[key];
    run.since = Clock::now();
  }
  return true;
}

/// The child is over, or ended for taking too long.
Json finish(Run& run, const Mutant& mutant, bool too_long) {
  if (too_long) kill(run.pid, SIGKILL);
  int status = 0;
  waitpid(run.pid, &status, 0);
  close(run.from);
  Json result{{"name", mutant.name}};
  if (!run.result.is_null()) result.update(run.result);  // null: the child was over before it had said anything
  const bool whole = result.contains("done") || result.contains("killed");
  if (!whole) {
    result["killed"] = run.last.value("check", "lockstep");
    result["where"] = run.last.value("where", "");
    result["how"] = too_long ? "hang" : "crash";
    if (result["killed"] == "lockstep of both") result["twin"] = false;
  }
  result.erase("done");
  result["seconds"] = std::chrono::duration<double>(Clock::now() - run.begin).count();
  return result;
}

int run(int argc, char** argv) {
  CLI::App app("Puts generated mutants through the checks");
  std::vector<std::string> names;
  unsigned jobs = 1;
  double limit = 60;
  bool afresh = false;
  app.add_option("--name", names, "only these (default: all)");
  app.add_option("--jobs", jobs, "parallel mutants")->check(CLI::Range(1, 64));
  app.add_option("--limit", limit, "time limit in seconds per check of a scenario");
  app.add_flag("--afresh", afresh, "try all checks, not first the recorded one");
  CLI11_PARSE(app, argc, argv);

  std::vector<Mutant> mutants = read_mutants();
  std::erase_if(mutants, [&](const Mutant& m) {
    return names.empty() ? !m.generated : std::ranges::find(names, m.name) == names.end();
  });
  if (mutants.empty()) {
    std::fprintf(stderr, "mutate: no mutant has these properties\n");
    return 2;
  }

  for (const Scenario* s : every_scenario())
    simulator_of(s->options.config);  // built and loaded with no fault selected
  std::map<std::size_t, Json> results;
  std::vector<Run> runs;
  std::size_t next = 0, printed = 0;
  while (printed < mutants.size()) {
    while (runs.size() < jobs && next < mutants.size()) {
      runs.push_back(start(next, mutants[next], afresh));
      ++next;
    }
    std::vector<pollfd> ready;
    for (const Run& r : runs) ready.push_back({r.from, POLLIN, 0});
    poll(ready.data(), ready.size(), 500);
    for (std::size_t i = runs.size(); i-- > 0;) {
      const bool over = ready[i].revents != 0 && !listen(runs[i]);
      const bool too_long = !over && std::chrono::duration<double>(Clock::now() - runs[i].since).count() > limit;
      if (!over && !too_long) continue;
      results[runs[i].index] = finish(runs[i], mutants[runs[i].index], too_long);
      runs.erase(runs.begin() + static_cast<std::ptrdiff_t>(i));
    }
    for (; results.contains(printed); ++printed) {
      std::printf("%s\n", results[printed].dump().c_str());
      std::fflush(stdout);
    }
  }
  return 0;
}

}  // namespace
}  // namespace quadrille::tb

int main(int argc, char** argv) {
  try {
    return quadrille::tb::run(argc, argv);
  } catch (const quadrille::tb::EnvironmentError& error) {
    std::fprintf(stderr, "mutate: %s\n", error.what());
    return 3;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "mutate: %s\n", error.what());
    return 2;
  }
}
