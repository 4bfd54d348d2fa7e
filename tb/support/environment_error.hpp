// What the machine that the program runs on lacks or refuses.
#pragma once

#include <stdexcept>

namespace quadrille::tb {

/// A tool or library is missing; exit status 3. The text says what is missing and which Debian package brings it.
struct EnvironmentError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Anything else that the system refuses (a file, a folder, a process, the memory of a graphics card); exit status 2.
struct SystemError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace quadrille::tb
