// quadrille config: every key, derived width and error bound of a configuration.
#include "tb/commands/commands.hpp"
#include "tb/options/command_line.hpp"
#include "tb/options/named_config.hpp"
#include "tb/options/written_file.hpp"

#include "golden/analysis/error_bound.hpp"
#include "golden/analysis/judged_quad.hpp"
#include "golden/io/atomic_file.hpp"
#include "golden/io/config_file.hpp"
#include "golden/io/json_report.hpp"
#include "model/port/boundaries.hpp"
#include "model/port/tables.hpp"
#include "tb/device/probes.hpp"
#include "tb/support/errors.hpp"
#include "tb/support/output.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace quadrille::tb {
namespace {

struct ConfigOptions {
  CommonOptions common;
  std::string emit_tables, boundaries;
  bool list = false, markdown = false, toml = false;
};

std::string value_text(int value) { return value == -1 ? "auto" : std::to_string(value); }

/// Bytes of UTF-8 text that are not continuation bytes: its width in a terminal.
int columns(std::string_view text) {
  return static_cast<int>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

std::string padded(std::string text, int width) {
  text.append(static_cast<std::size_t>(std::max(0, width - columns(text))), ' ');
  return text;
}

std::string number(double value) {
  char text[16];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

struct NamedBound {
  std::string name;
  double value;
  std::string meaning;
};

/// How far a result may be from exact arithmetic on the same snapped quad, and what snapping takes of the given values.
std::vector<NamedBound> bounds(const Config& config) {
  const double s_bits = std::ldexp(1.0, -config.significand_bits);
  const ErrorBound weight = bound_lambda(config);
  return {
      {"lambda", weight_bound(config),
       "weights 1 to 3: the rule 2^-(s-3); " +
           (weight.proved ? "proved is " + number(weight.value) : "not proved: " + weight.reason)},
      {"c", value_bound_factor(config), "attributes, depth, weight 0: c 2^-(s-3) spread + half a code"},
      {"c_of_cut_w", value_bound_factor(config, true), "the same where some W of more than S bits is divided by"},
      {"attribute_code", std::ldexp(0.5, -config.attribute_frac()),
       "half a code of an attribute; snapping of its base"},
      {"depth_code", std::ldexp(0.5, -config.depth_bits), "half a code of depth; snapping of its base"},
      {"snapped_difference", s_bits, "snapping of a difference to the base, relative"},
      {"snapped_k", s_bits, "snapping of k, relative"},
      {"snapped_position", std::ldexp(0.5, -config.subpixel_bits), "snapping of an ordinary vertex, pixels"},
  };
}

std::string text_listing(const Config& config) {
  std::string text = padded("key", 27) + padded("value", 7) + padded("default", 9) + padded("range", 9) +
                     padded("unit", 9) + "meaning\n";
  for (const ConfigKey& key : Config::keys()) {
    const int value = config.get(key.name);
    text += padded(std::string(key.name), 27) + padded(value_text(value), 7) + padded(value_text(key.standard), 9) +
            padded(std::to_string(key.minimum) + "-" + std::to_string(key.maximum), 9) +
            padded(std::string(key.unit), 9) + std::string(key.meaning) + (value != key.standard ? " *" : "") + "\n";
  }
  text += "\n" + padded("derived", 27) + padded("value", 7) + "reason\n";
  for (const DerivedWidth& width : config.derived())
    text += padded(width.name, 27) + padded(std::to_string(width.value), 7) + width.reason + "\n";
  text += "\n" + padded("bound", 23) + padded("value", 11) + "of\n";
  for (const auto& [name, value, meaning] : bounds(config)) {
    text += padded(name, 23) + padded(number(value), 11) + meaning + "\n";
  }
  return text;
}

/// '|' would end a cell.
std::string cell(std::string_view text) {
  std::string result;
  for (const char c : text) result += c == '|' ? std::string("\\|") : std::string(1, c);
  return result;
}

std::string markdown_listing(const Config& config) {
  std::string text = "| key | default | range | unit | meaning |\n|---|---|---|---|---|\n";
  for (const ConfigKey& key : Config::keys())
    text += "| `" + std::string(key.name) + "` | " + value_text(key.standard) + " | " + std::to_string(key.minimum) +
            "–" + std::to_string(key.maximum) + " | " + cell(key.unit) + " | " + cell(key.meaning) + " |\n";
  text += "\n| derived | value | reason |\n|---|---|---|\n";
  for (const DerivedWidth& width : config.derived())
    text += "| `" + width.name + "` | " + std::to_string(width.value) + " | " + cell(width.reason) + " |\n";
  return text;
}

std::string symbol(const Bits& bits, bool symbols) {
  return symbols && bits.symbol != nullptr ? bits.symbol : std::to_string(bits.value);
}

/// The fields of ports or probes: of this configuration, or as Markdown by the names of rtl/SPEC.md, Widths.
std::string boundary_listing(const std::string& which, const Config& given, bool markdown) {
  Config config = given;
  if (markdown) config.attribute_slots = slots_of_tables;
  if (which == "sv") return probes_header();
  std::string text;
  for (const auto& [name, bits, fields] : which == "ports" ? describe_ports(config) : describe_probes(config)) {
    text += text.empty() ? "" : "\n";
    text += markdown ? "| `" + name + "` | bits | fraction bits | unit | meaning |\n|---|---|---|---|---|\n"
                     : padded(name, 13) + padded("bits", 18) + padded("fraction", 10) + padded("unit", 8) +
                           "meaning (" + std::to_string(bits) + " bits)\n";
    for (const auto& [type, count] : fields) {
      const std::string width =
          (count == 0 ? "" : (markdown && count == slots_of_tables ? "N" : std::to_string(count)) + " × ") +
          symbol(type.width, markdown) + (type.is_signed ? ", signed" : "");
      const std::string fraction = type.fraction_bits ? symbol(*type.fraction_bits, markdown) : "";
      if (markdown)
        text += "| `" + std::string(type.name) + "` | " + width + " | " + fraction + " | " + type.unit + " | " +
                cell(type.meaning) + " |\n";
      else
        text += padded(type.name, 13) + padded(width, 18) + padded(fraction, 10) + padded(type.unit, 8) + type.meaning +
                "\n";
    }
  }
  return text;
}

std::string named_listing() {
  std::string text;
  for (const auto& [name, path, aim] : named_configs()) text += padded(name, 10) + aim + "\n";
  return text;
}

int list_config(const ConfigOptions& options, const std::vector<std::string>& arguments) {
  if (options.list) {
    std::fputs(named_listing().c_str(), stdout);
    return exit_ok;
  }
  const Config config = options.common.config();
  if (!options.emit_tables.empty()) {
    check_outputs({options.emit_tables, options.common.json}, {options.common.config_file});
    golden::write_file(options.emit_tables, tables_package(config), golden::AtomicFile::Dash::standard_output);
  }
  if (!options.common.json.empty()) {
    nlohmann::ordered_json json = golden::begin_report(config, options.common.seed, arguments);
    json["keys"] = nlohmann::ordered_json::array();
    for (const ConfigKey& key : Config::keys())
      json["keys"].push_back({{"name", key.name},
                              {"value", config.get(key.name)},
                              {"default", key.standard},
                              {"minimum", key.minimum},
                              {"maximum", key.maximum},
                              {"unit", key.unit},
                              {"meaning", key.meaning}});
    json["derived"] = nlohmann::ordered_json::array();
    for (const DerivedWidth& width : config.derived())
      json["derived"].push_back({{"name", width.name}, {"value", width.value}, {"reason", width.reason}});
    for (const auto& [name, value, meaning] : bounds(config))
      json["bounds"].push_back({{"name", name}, {"value", value}, {"meaning", meaning}});
    golden::save_json(options.common.json, json);
  }
  CostWeights weights;
  if (!options.common.config_file.empty()) golden::load_cost_weights(options.common.config_file, weights);
  std::FILE* text = options.common.text();
  if (text && options.emit_tables != "-" && (options.emit_tables.empty() || options.markdown || options.toml) &&
      options.common.json != "-")
    std::fputs((!options.boundaries.empty() ? boundary_listing(options.boundaries, config, options.markdown)
                : options.markdown          ? markdown_listing(config)
                : options.toml              ? golden::config_text(config, weights)
                                            : text_listing(config))
                   .c_str(),
               text);
  return exit_ok;
}

}  // namespace

void add_config_command(CLI::App& app, Invocation& invocation) {
  CLI::App* command = app.add_subcommand("config", "List configuration keys, derived widths and error bounds");
  end_help(*command, "* marks keys with another value than their default. \"auto\" is also written as -1.",
           "0 done; 2 usage or input error",
           {"config --set significand_bits=24", "config --set significand_bits=24 --toml >wide.toml",
            "config --config wide.toml --emit-tables quadrille_tables_pkg.sv"});
  const auto options = std::make_shared<ConfigOptions>();
  options->common.add_to(*command, false);
  writes_file(*command,
              command->add_option("--emit-tables", options->emit_tables,
                                  "Package of sqrt and reciprocal tables; - is standard output"),
              "sv")
      ->group(output_group);
  auto* boundaries = command
                         ->add_option("--boundaries", options->boundaries,
                                      "List bit fields instead, most significant first\n"
                                      "  ports   of the machine's ports\n"
                                      "  probes  of the boundaries between stages\n"
                                      "  sv      SystemVerilog of the probes, for quadrille_probed.sv")
                         ->type_name("WHICH")
                         ->check(CLI::IsMember({"ports", "probes", "sv"}))
                         ->group(output_group);
  auto* markdown = command->add_flag("--markdown", options->markdown, "Print Markdown tables")->group(output_group);
  command->add_flag("--toml", options->toml, "Print a file for --config")
      ->excludes(markdown)
      ->excludes(boundaries)
      ->group(output_group);
  auto* list = command->add_flag("--list", options->list, "List the named configurations")->group(output_group);
  for (CLI::Option* other : command->get_options())
    if (other != list && other->get_name() != "--help") list->excludes(other);
  command->callback([options, &invocation] {
    invocation.run = [options, &invocation] { return list_config(*options, invocation.arguments); };
  });
}

}  // namespace quadrille::tb
