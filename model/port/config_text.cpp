#include "model/port/config_text.hpp"

#include <algorithm>
#include <charconv>
#include <string>
#include <vector>

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
  if (const std::optional<int> value = toml_integer(word)) return *value;
  throw ConfigError("key " + quoted(key) + ": " + quoted(word) + " is not an integer");
}

/// What has been read so far.
struct Reading {
  std::vector<std::string_view> keys;  ///< that were set, by their present names
  bool passed_over = false;            ///< in a table that is none of the configuration's
};

/// Every setting of a line.
void apply_line(std::string_view line, Config& config, Reading& reading) {
  line = line.substr(0, line.find('#'));
  skip_blanks(line);
  if (line.starts_with('[')) {
    const std::string_view table = line.substr(0, line.find_last_not_of(blanks) + 1);
    if (table != "[cost]") throw ConfigError("unknown table " + quoted(table) + "; [cost] is the only one");
    if (reading.passed_over) throw ConfigError("a second table [cost]");
    reading.passed_over = true;
  }
  while (!reading.passed_over && !line.empty()) {
    const std::string_view key = take_word(line);
    skip_blanks(line);
    if (key.empty() || !line.starts_with('='))
      throw ConfigError(quoted(key.empty() ? line : key) + ": expected key=value, such as significand_bits=24");
    line.remove_prefix(1);
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    static_cast<void>(config.get(key));  // an unknown key is the better complaint than its value
    const std::string_view name = Config::present_name(key);
    if (std::ranges::find(reading.keys, name) != reading.keys.end())
      throw ConfigError("key " + quoted(key) + " was set before" + (key == name ? "" : ", as " + quoted(name)));
    reading.keys.push_back(name);
    config.set(key, value_of(key, take_word(line)));
    if (line.starts_with('=')) throw ConfigError("key " + quoted(key) + " has two `=`");
    skip_blanks(line);
  }
}

}  // namespace

std::optional<int> toml_integer(std::string_view text) {
  int base = 10;
  std::string digits;  // with a minus sign
  if (text.starts_with("0x") || text.starts_with("0o") || text.starts_with("0b")) {
    base = text[1] == 'x' ? 16 : text[1] == 'o' ? 8 : 2;
    text.remove_prefix(2);
  } else if (text.starts_with('+') || text.starts_with('-')) {
    if (text.front() == '-') digits = "-";
    text.remove_prefix(1);
  }
  if (text.empty() || text.front() == '-' || text.front() == '_' || text.back() == '_') return {};
  if (base == 10 && text.size() > 1 && text.front() == '0') return {};
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '_')
      digits += text[i];
    else if (text[i - 1] == '_')
      return {};
  }
  int value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, base);
  if (error != std::errc{} || end != digits.data() + digits.size()) return {};
  return value;
}

void apply_config_text(std::string_view text, Config& config) {
  Config changed = config;
  Reading reading;
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    try {
      apply_line(text.substr(0, end), changed, reading);
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

std::string changed_keys(const Config& config, std::string_view before) {
  std::string text;
  for (const ConfigKey& key : Config::keys())
    if (const int value = config.get(key.name); value != key.standard)
      text += std::string(before) + std::string(key.name) + "=" + std::to_string(value);
  return text;
}

}  // namespace quadrille
