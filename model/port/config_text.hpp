// A configuration from a text in memory, without any library: for the interfaces to other languages. Files with all of
// TOML, and with the place of an error in a file, are golden/io/config_file.hpp's.
#pragma once

#include "model/port/config.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace quadrille {

/// The integer of a text as TOML writes it: decimal with or without a sign, 0x, 0o and 0b without one, `_` between
/// digits, no leading zeros. Nothing for any other text and for what an int does not hold.
std::optional<int> toml_integer(std::string_view text);

/// Sets the keys that `text` names: `key = value` a line, as in a configuration file, or several a line with blanks or
/// commas between. A value is an integer as in TOML, auto or "auto" (-1); of notch_exact also true or false. `#` begins
/// a comment. A table [cost] is passed over, and a removed key at the value at which it was off. Throws ConfigError
/// "line N: …" for anything else, an unknown key, one that was set before (by a former name too) and a value out of its
/// range, and without a line for a combination that cannot be built; `config` is then unchanged.
void apply_config_text(std::string_view text, Config& config);

/// A number of a configuration by name: a key (auto resolved) or, in upper case, a derived width; nothing if there is
/// no such name.
std::optional<int> config_number(const Config& config, std::string_view name);

/// The keys that differ from their defaults, `before` + "key=value" each.
std::string changed_keys(const Config& config, std::string_view before);

}  // namespace quadrille
