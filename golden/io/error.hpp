// What goes wrong outside the program: an input error is exit status 2 of the command line.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace quadrille::golden {

/// A usage or input error (exit status 2). The message names the place, what is wrong and what would be right:
/// "file:line: what is wrong; what would be right".
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// InputError for a place in a text file; line is 1-based, 0 means the file as a whole.
inline InputError input_error(const std::string& file, std::size_t line, const std::string& what) {
  std::string message = file;
  if (line > 0) message.append(":").append(std::to_string(line));
  return InputError(message.append(": ").append(what));
}

}  // namespace quadrille::golden
