// Names given on the command line: resolved against a list, or refused with the list and the nearest name.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::tb {

/// The position of `name` in `choices`; throws UsageError "unknown <what> "<name>"; did you mean …? (choices: …)".
std::size_t choose(std::string_view what, std::string_view name, std::span<const std::string> choices);
std::size_t choose(std::string_view what, std::string_view name, std::initializer_list<std::string_view> choices);

}  // namespace quadrille::tb
