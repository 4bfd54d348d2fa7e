#include "model/config_text.hpp"

#include <algorithm>
#include <charconv>
#include <string>

namespace quadrille {
namespace {

constexpr std::string_view blanks = " \t\r,";

std::string quoted(std::string_view text) { return "\"" + std::string(text) + "\""; }

void skip_blanks(std::string_view& line) { line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size())); }

/// Takes what stands before the next blank or `=`.
std::string_view take_word(std::string_view& line) {
  const std::string_view word = line.substr(0, line.find_first_of(" \t\r,="));
  line.remove_prefix(word.size());
  return word;
}

int value_of(std::string_view key, std::string_view word) {
  if (word == "auto" || word == "\"auto\"") return -1;
  if (key == "notch_exact" && (word == "true" || word == "false")) return word == "true" ? 1 : 0;
  int value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size())
    throw ConfigError("key " + quoted(key) + ": " + quoted(word) + " is not an integer");
  return value;
}

/// Every setting of a line; `passed_over`: the line is in a table that is none of the configuration's.
void apply_line(std::string_view line, Config& config, bool& passed_over) {
  line = line.substr(0, line.find('#'));
  skip_blanks(line);
  if (line.starts_with('[')) {
    const std::string_view table = line.substr(0, line.find_last_not_of(blanks) + 1);
    if (table != "[cost]") throw ConfigError("unknown table " + quoted(table) + "; [cost] is the only one");
    passed_over = true;
  }
  while (!passed_over && !line.empty()) {
    const std::string_view key = take_word(line);
    skip_blanks(line);
    if (key.empty() || !line.starts_with('='))
      throw ConfigError(quoted(key.empty() ? line : key) + ": expected key=value, such as significand_bits=24");
    line.remove_prefix(1);
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    static_cast<void>(config.get(key));  // an unknown key is the better complaint than its value
    config.set(key, value_of(key, take_word(line)));
    if (line.starts_with('=')) throw ConfigError("key " + quoted(key) + " has two `=`");
    skip_blanks(line);
  }
}

}  // namespace

void apply_config_text(std::string_view text, Config& config) {
  Config changed = config;
  bool passed_over = false;
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    try {
      apply_line(text.substr(0, end), changed, passed_over);
    } catch (const ConfigError& error) {
      throw ConfigError("line " + std::to_string(number) + ": " + error.what());
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  changed.validate();
  config = changed;
}

std::optional<int> config_number(const Config& config, std::string_view name) {
  for (const ConfigKey& key : Config::keys())
    if (key.name == name) return config.resolved(name);
  for (const DerivedWidth& derived : config.derived())
    if (derived.name == name) return derived.value;
  return {};
}

}  // namespace quadrille
