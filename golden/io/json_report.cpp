#include "golden/io/json_report.hpp"

#include "golden/io/atomic_file.hpp"
#include "golden/io/text_input.hpp"

#include <algorithm>
#include <cctype>

namespace quadrille::golden {
namespace {

std::string shell_word(const std::string& argument) {
  const auto harmless = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           std::string_view("_-+=./:,%@").find(c) != std::string_view::npos;
  };
  if (!argument.empty() && std::all_of(argument.begin(), argument.end(), harmless)) return argument;
  if (!is_utf8(argument)) {  // $'…' of the shell gives any byte, and the line stays text
    std::string word;
    for (const char c : argument) (word += c == '\'' || c == '\\' ? "\\" : "") += c;
    return "$'" + readable(word) + "'";
  }
  std::string word = "'";
  for (const char c : argument) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

}  // namespace

std::string_view program_version() { return QUADRILLE_VERSION; }

std::string command_line(std::span<const std::string> arguments) {
  std::string line;
  for (const std::string& argument : arguments) line += (line.empty() ? "" : " ") + shell_word(argument);
  return line;
}

nlohmann::ordered_json begin_report(const Config& config, std::uint64_t seed, std::span<const std::string> arguments) {
  nlohmann::ordered_json report;
  report["schema_version"] = report_schema_version;
  report["version"] = program_version();
  nlohmann::ordered_json& values = report["config"] = nlohmann::ordered_json::object();
  for (const ConfigKey& key : Config::keys()) values[std::string(key.name)] = config.get(key.name);
  report["seed"] = seed;
  report["command"] = command_line(arguments);
  return report;
}

void save_json(const std::string& path, const nlohmann::ordered_json& report) {
  const std::string text = report.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
  write_file(path, text, AtomicFile::Dash::standard_output);
}

}  // namespace quadrille::golden
