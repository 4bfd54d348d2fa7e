// What ends a command early, and the exit statuses.
#pragma once

#include <stdexcept>

namespace quadrille::tb {

enum ExitStatus : int {
  exit_ok = 0,           ///< done and within bounds
  exit_mismatch = 1,     ///< two bodies differ or a bound is exceeded
  exit_usage = 2,        ///< wrong usage or input, or the system refuses a file or memory
  exit_environment = 3,  ///< a missing tool, and nothing else
};

/// The command line asks for something that does not exist or does not fit together.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What was asked for belongs to the studies, and this program is the core.
struct StudyNeeded : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace quadrille::tb
