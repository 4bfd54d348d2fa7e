#include "golden/io/config_file.hpp"

#include "golden/io/error.hpp"
#include "golden/io/text_input.hpp"
#include "model/support/edit_distance.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <limits>
#include <sstream>
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

using Entry = std::pair<const toml::key*, const toml::node*>;

std::size_t line_of(const Entry& entry) { return entry.first->source().begin.line; }

/// toml++ sorts a table by name; the first error of the file is the one to report.
std::vector<Entry> in_file_order(const toml::table& table) {
  std::vector<Entry> entries;
  for (const auto& [key, node] : table) entries.emplace_back(&key, &node);
  std::stable_sort(entries.begin(), entries.end(),
                   [](const Entry& a, const Entry& b) { return line_of(a) < line_of(b); });
  return entries;
}

void set_key(const Entry& entry, const std::string& name, Config& config) {
  const std::string key(entry.first->str());
  const toml::node& node = *entry.second;
  const auto failure = [&](const std::string& what) { return input_error(name, line_of(entry), what); };
  try {
    config.get(key);  // an unknown key is the better complaint than its type
    if (const auto* boolean = node.as_boolean(); boolean != nullptr && key == "notch_exact") {
      config.set(key, boolean->get() ? 1 : 0);
      return;
    }
    if (const auto* text = node.as_string(); text != nullptr && text->get() == "auto") {
      config.set(key, -1);
      return;
    }
    const auto* integer = node.as_integer();
    if (integer == nullptr)
      throw failure("key " + in_quotes(key) + " holds " + type_name(node.type()) + "; an integer is expected");
    const std::int64_t value = integer->get();
    if (value < std::numeric_limits<int>::min() || value > std::numeric_limits<int>::max()) {
      throw failure("key " + in_quotes(key) + " is " + std::to_string(value) +
                    ", far out of range; see 'quadrille config'");
    }
    config.set(key, static_cast<int>(value));
  } catch (const ConfigError& error) {
    throw failure(printable(error.what()));
  }
}

struct WeightKey {
  std::string_view key;
  double CostWeights::*member;
};

constexpr std::array weight_keys{
    WeightKey{"state", &CostWeights::state},
    WeightKey{"multiplier", &CostWeights::multiplier},
    WeightKey{"adder", &CostWeights::adder},
    WeightKey{"table", &CostWeights::table},
    WeightKey{"dsp", &CostWeights::dsp},
    WeightKey{"join", &CostWeights::join},
    WeightKey{"block_ram", &CostWeights::block_ram},
};

std::string weight_names() {
  std::string names;
  for (const WeightKey& weight : weight_keys) names.append(names.empty() ? "" : ", ").append(weight.key);
  return names;
}

void set_weight(const Entry& entry, const std::string& name, CostWeights& weights) {
  const std::string key(entry.first->str());
  const toml::node& node = *entry.second;
  const auto failure = [&](const std::string& what) { return input_error(name, line_of(entry), what); };
  const auto* found = std::find_if(weight_keys.begin(), weight_keys.end(), [&](const auto& w) { return w.key == key; });
  if (found == weight_keys.end()) {
    throw failure("unknown key " + in_quotes(key) + " in the table [cost]" +
                  did_you_mean(key, weight_keys, &WeightKey::key) + " (" + weight_names() + ")");
  }
  const std::string wanted =
      "; a number from 0 to " + std::to_string(static_cast<long>(max_cost_weight)) + " is expected, LUTs a bit";
  if (!node.is_number())
    throw failure("key " + in_quotes(key) + " in the table [cost] holds " + type_name(node.type()) + wanted);
  const double value = node.value<double>().value();
  if (!(value >= 0 && value <= max_cost_weight)) {  // also not a number
    std::ostringstream text;
    text << value;
    throw failure("key " + in_quotes(key) + " in the table [cost] is " + text.str() + wanted);
  }
  weights.*found->member = value;
}

/// Both kinds of content, so that a file has the same errors whoever reads it. Returns the notes of load_config().
std::vector<std::string> parse(std::string_view text, const std::string& name, Config& config, CostWeights& weights) {
  refuse_wide_text(text, name);
  toml::table table;
  try {
    table = toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    throw input_error(name, error.source().begin.line,
                      "TOML: " + printable(error.description()) + "; lines such as significand_bits = 18 are expected");
  }
  Config new_config = config;
  CostWeights new_weights = weights;
  std::vector<std::string> notes;
  std::vector<std::string_view> keys_set;  // by their present names: TOML sees to the ones that the file has
  for (const Entry& entry : in_file_order(table)) {
    if (entry.first->str() != "cost") {
      set_key(entry, name, new_config);
      const std::string_view given = entry.first->str();
      const std::string_view key = Config::present_name(given);
      if (std::ranges::find(keys_set, key) != keys_set.end())
        throw input_error(name, line_of(entry), "key " + in_quotes(given) + " was set before, as " + in_quotes(key));
      keys_set.push_back(key);
      if (const std::string note = Config::note(entry.first->str()); !note.empty())
        notes.push_back(name + ":" + std::to_string(line_of(entry)) + ": " + note);
    } else if (const toml::table* cost = entry.second->as_table(); cost != nullptr) {
      for (const Entry& weight : in_file_order(*cost)) set_weight(weight, name, new_weights);
    } else {
      throw input_error(name, line_of(entry),
                        "key \"cost\" holds " + std::string(type_name(entry.second->type())) +
                            "; a table [cost] with " + weight_names() + " is expected");
    }
  }
  config = new_config;
  weights = new_weights;
  return notes;
}

/// `line` with a comment at column 30.
std::string commented(std::string line, std::string_view comment) {
  line.resize(std::max<std::size_t>(line.size() + 1, 30), ' ');
  return line + "# " + std::string(comment) + "\n";
}

std::string text_of(const std::string& path) { return read_file(path, "a configuration in TOML"); }

}  // namespace

std::vector<std::string> load_config(const std::string& path, Config& config) {
  return parse_config(text_of(path), path, config);
}

void load_cost_weights(const std::string& path, CostWeights& weights) {
  parse_cost_weights(text_of(path), path, weights);
}

std::string config_text(const Config& config, const CostWeights& weights) {
  std::string text =
      "# A configuration of Quadrille, for --config. A key that is left out has its default; auto is -1.\n";
  for (const ConfigKey& key : Config::keys()) {
    const auto value = [](int v) { return v == -1 ? std::string("-1 (auto)") : std::to_string(v); };
    text += commented(std::string(key.name) + " = " + std::to_string(config.get(key.name)),
                      std::string(key.unit) + (key.unit.empty() ? "" : ", ") + std::to_string(key.minimum) + " to " +
                          std::to_string(key.maximum) + ", default " + value(key.standard) + ": " +
                          std::string(key.meaning));
  }
  text +=
      "\n# Weights of the scalar hardware cost: LUTs for a bit of each resource, a DSP block and a block RAM, 0 to " +
      number_text(max_cost_weight) + "\n[cost]\n";
  for (const WeightKey& weight : weight_keys)
    text += std::string(weight.key) + " = " + number_text(weights.*weight.member) + "\n";
  return text;
}

std::vector<std::string> parse_config(std::string_view text, const std::string& name, Config& config) {
  CostWeights ignored;
  return parse(text, name, config, ignored);
}

void parse_cost_weights(std::string_view text, const std::string& name, CostWeights& weights) {
  Config ignored;
  parse(text, name, ignored, weights);
}

}  // namespace quadrille::golden
