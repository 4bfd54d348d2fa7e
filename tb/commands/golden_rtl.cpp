#include "tb/commands/golden_rtl.hpp"

#include "golden/io/error.hpp"
#include "tb/support/environment_error.hpp"
#include "tb/support/process.hpp"
#include "tb/support/source_paths.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace quadrille::tb {
namespace {

namespace fs = std::filesystem;

constexpr int bad_input = 2, missing_tool = 3;  // exit statuses of the script

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

}  // namespace

std::map<std::string, vectors::VerifyResult> replay_rtl(const std::string& directory,
                                                        const std::vector<std::string>& suites) {
  const fs::path script = rtl_directory().parent_path() / "scripts" / "replay.sh";
  if (!fs::exists(script))
    throw EnvironmentError("cannot find " + script.string() + "; the engine rtl needs the source tree");
  std::vector<std::string> command{script.string(), fs::absolute(directory).string(), "verilator"};
  for (const std::string& suite : suites) {
    command.emplace_back("--suite");
    command.push_back(suite);
  }
  const fs::path log = fs::temp_directory_path() / ("quadrille_replay_" + std::to_string(::getpid()) + ".log");
  ::setenv("QUADRILLE", fs::read_symlink("/proc/self/exe").c_str(), 1);
  const int status = run_logged(command, fs::current_path(), log);
  std::string output = text_of(log);
  output.erase(0, output.find('\n') + 1);  // the command
  fs::remove(log);
  if (status == bad_input) throw golden::InputError(output);
  if (status == missing_tool) throw EnvironmentError(output);

  // "SUITE: N vectors, M mismatches …", or what stopped the run or the build; after it what differs.
  std::map<std::string, vectors::VerifyResult> results;
  std::istringstream lines(output);
  vectors::VerifyResult* last = nullptr;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t colon = std::min(line.find(": "), line.size());
    const std::string name = line.substr(0, colon), text = line.substr(colon);
    unsigned long long vectors = 0, mismatches = 0;
    const bool counted = std::sscanf(text.c_str(), ": %llu vectors, %llu mismatches", &vectors, &mismatches) == 2;
    const bool stopped = text.starts_with(": FAILED") || text.starts_with(": the RTL does not build");
    if ((counted || stopped) && std::ranges::count(suites, name) > 0) {
      last = &results[name];
      last->vectors = counted ? vectors : 1;
      last->mismatches = counted ? mismatches : 1;
      if (last->mismatches > 0) last->first_difference = line;
    } else if (last != nullptr && last->mismatches > 0 && last->first_difference.size() < 2000) {
      last->first_difference += "\n" + line;
    }
  }
  if (status != 0) {
    bool explained = false;
    for (const auto& [name, result] : results) explained = explained || result.mismatches > 0;
    if (!explained) throw golden::InputError("replay failed:\n" + output);
  }
  return results;
}

}  // namespace quadrille::tb
