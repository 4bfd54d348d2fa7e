// The machine that the program runs on lacks something (a tool, a library, a place to write); exit status 3.
#pragma once

#include <stdexcept>

namespace quadrille::tb {

/// The text says what is missing and which Debian package brings it.
struct EnvironmentError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace quadrille::tb
