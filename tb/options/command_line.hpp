// For the files that add options: the library, and checks of values that it lacks.
#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace quadrille::cli {

/// Refuses a minus sign: the library would wrap a negative number into a huge one.
inline const CLI::Validator not_negative(
    [](std::string& text) {
      return text.find('-') == std::string::npos ? std::string() : "must not be negative: " + text;
    },
    "", "not negative");

}  // namespace quadrille::cli
