// What is fuzzed: readers of every format, and the machine with any four vertices. The same functions run under
// libFuzzer (fuzz_main.cpp, built by Clang: scripts/fuzz.sh) and over the kept corpus in the tests (corpus_test.cpp).
#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string_view>

namespace quadrille::fuzz {

/// What a target found wrong, beside exceptions that are no InputError, crashes, and reports of sanitizers.
struct Fault : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Whether the input was good or was refused by a clear error. Anything else is thrown.
enum class Outcome { accepted, refused };

struct Target {
  std::string_view name;
  std::string_view what;
  Outcome (*run)(std::span<const std::uint8_t> input);
  std::string_view corpus;  ///< folder below the project's, with those inside it
  int damaged;              ///< inputs of the test with damage: more where none goes through a file
  std::string_view file{};  ///< name of its files; empty: all
};

/// Of reader_targets.cpp, or of any_quad_target.cpp: a program links one of them.
std::span<const Target> targets();

}  // namespace quadrille::fuzz
