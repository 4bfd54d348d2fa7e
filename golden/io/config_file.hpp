// The configuration file.
#pragma once

#include "model/config.hpp"

#include <string>
#include <string_view>

namespace quadrille::golden {

/// Sets keys from a TOML file of `key = integer` lines, the keys of Config::keys(); `notch_exact` may also be true or
/// false. Keys that the file does not name keep their value. Config::validate() is left to the caller, who may have
/// more keys to set.
///
/// Throws InputError with file:line for syntax errors, unknown keys, wrong types, values out of range, and for a file
/// that cannot be read; `config` is then unchanged.
void load_config(const std::string& path, Config& config);

/// The same for a text in memory; `name` stands for the file in messages.
void parse_config(std::string_view text, const std::string& name, Config& config);

}  // namespace quadrille::golden
