// For the files that add options: the library, and checks of values that it lacks.
#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>

namespace quadrille::tb {

/// A whole number from 0 to `most`, or refused: the library would wrap a negative one and clamp a huge one.
CLI::Validator whole_number(std::uint64_t most = UINT64_MAX);

}  // namespace quadrille::tb
