#include "golden/io/config_file.hpp"

#include "golden/io/error.hpp"
#include "golden/io/text_input.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace quadrille::golden {
namespace {

const char* type_name(toml::node_type type) {
  switch (type) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "an array";
    case toml::node_type::string:
      return "a string";
    case toml::node_type::integer:
      return "an integer";
    case toml::node_type::floating_point:
      return "a floating-point number";
    case toml::node_type::boolean:
      return "a boolean";
    default:
      return "a date or time";
  }
}

}  // namespace

void load_config(const std::string& path, Config& config) {
  parse_config(read_file(path, "a configuration in TOML"), path, config);
}

void parse_config(std::string_view text, const std::string& name, Config& config) {
  toml::table table;
  try {
    table = toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    throw input_error(name, error.source().begin.line,
                      "TOML: " + printable(error.description()) + "; lines such as significand_bits = 18 are expected");
  }

  // The table is sorted by name; the first error of the file is the one to report.
  std::vector<std::pair<const toml::key*, const toml::node*>> entries;
  for (const auto& [key, node] : table) entries.emplace_back(&key, &node);
  const auto line_of = [](const auto& entry) { return entry.first->source().begin.line; };
  std::stable_sort(entries.begin(), entries.end(),
                   [&](const auto& a, const auto& b) { return line_of(a) < line_of(b); });

  Config result = config;
  for (const auto& entry : entries) {
    const std::string key(entry.first->str());
    const toml::node& node = *entry.second;
    const auto failure = [&](const std::string& what) { return input_error(name, line_of(entry), what); };
    try {
      result.get(key);  // an unknown key is the better complaint than its type
      if (const auto* boolean = node.as_boolean(); boolean != nullptr && key == "notch_exact") {
        result.set(key, boolean->get() ? 1 : 0);
        continue;
      }
      const auto* integer = node.as_integer();
      if (integer == nullptr)
        throw failure("key " + in_quotes(key) + " holds " + type_name(node.type()) + "; an integer is expected");
      const std::int64_t value = integer->get();
      if (value < std::numeric_limits<int>::min() || value > std::numeric_limits<int>::max()) {
        throw failure("key " + in_quotes(key) + " is " + std::to_string(value) +
                      ", far out of range; see 'quadrille config'");
      }
      result.set(key, static_cast<int>(value));
    } catch (const ConfigError& error) {
      throw failure(printable(error.what()));
    }
  }
  config = result;
}

}  // namespace quadrille::golden
