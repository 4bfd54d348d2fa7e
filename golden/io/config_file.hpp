// The configuration file.
#pragma once

#include "golden/analysis/hardware_cost.hpp"
#include "model/port/config.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace quadrille::golden {

/// Sets keys from a TOML file of `key = integer` lines, the keys of Config::keys(); `notch_exact` may also be true or
/// false. Keys that the file does not name keep their value. Config::validate() is left to the caller, who may have
/// more keys to set. A table [cost] is checked as by load_cost_weights() and otherwise ignored.
///
/// Throws InputError with file:line for syntax errors, unknown keys, wrong types, values out of range, and for a file
/// that cannot be read; `config` is then unchanged.
///
/// Returns notes for the user, "file:line: …" each: of keys that were removed and are set to the value at which they
/// were off, which is ignored.
std::vector<std::string> load_config(const std::string& path, Config& config);

/// Sets weights of the hardware cost (the fields of CostWeights) from the table [cost] of such a file, each a number
/// from 0 to max_cost_weight. Weights that the file does not name keep their value. The rest of the
/// file is checked as by load_config(), with the same errors; `weights` is then unchanged.
void load_cost_weights(const std::string& path, CostWeights& weights);

/// A larger weight is refused: costs stay finite.
inline constexpr double max_cost_weight = 1e6;

/// A file that gives both back: every key (auto as -1) with unit, range, default and meaning as a comment, then [cost].
std::string config_text(const Config& config, const CostWeights& weights);

/// The same for a text in memory; `name` stands for the file in messages.
std::vector<std::string> parse_config(std::string_view text, const std::string& name, Config& config);
void parse_cost_weights(std::string_view text, const std::string& name, CostWeights& weights);

}  // namespace quadrille::golden
