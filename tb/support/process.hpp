// Running other programs: looked up in PATH, no shell in between, output to a log file or a string. An
// interruption of this program (golden/io/interrupt.hpp) ends them with all that they started.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::tb {

/// Full path of `program` (a name to look up in PATH, or a path); throws EnvironmentError naming `package` when there
/// is none.
std::filesystem::path find_program(std::string_view program, std::string_view package);

/// Runs argv[0] with arguments in `directory`, standard output and error appended to `log`. Returns the exit status
/// (128 + signal).
int run_logged(std::span<const std::string> argv, const std::filesystem::path& directory,
               const std::filesystem::path& log);

/// Runs a program and returns what it wrote to standard output; throws EnvironmentError when it fails.
std::string run_captured(std::span<const std::string> argv);

/// As run_logged(), but standard output is handed on line by line as well, and `tick` is called about every second.
int run_watched(std::span<const std::string> argv, const std::filesystem::path& directory,
                const std::filesystem::path& log, const std::function<void(std::string_view)>& line,
                const std::function<void()>& tick);

/// The last `lines` lines of a text file, for error messages.
std::string tail_of(const std::filesystem::path& file, std::size_t lines);

}  // namespace quadrille::tb
