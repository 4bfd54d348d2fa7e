// The RTL of one configuration as one text for any tool: what rtl/quadrille.f lists, in its order, with includes
// inlined, keys fixed, and names of your own in place of the project's.
#pragma once

#include "model/port/config.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace quadrille::tb {

/// Why a name cannot be the prefix; empty when it can. A prefix is a module's name in lower case: its macros are in
/// upper case, and two prefixes must not share them.
std::string prefix_fault(std::string_view prefix);

/// Every `quadrille_` at the beginning of a name becomes `prefix`_, in comments and strings too, of macros in upper
/// case; in code the name `quadrille` becomes `prefix`.
std::string with_prefix(std::string_view text, std::string_view prefix);

/// The sources that `rtl`/quadrille.f lists, without macros of keys (and the comment before them) and SPDX lines, with
/// the tables of the configuration. Conditions on QUADRILLE_… are decided; those of tools stay. What is `define'd is
/// undefined at the end. Names are still the project's. Throws SystemError, with file and line, for what it cannot read
/// or for a declared name without the project's prefix.
std::string one_file(const std::filesystem::path& rtl, const Config& config);

}  // namespace quadrille::tb
