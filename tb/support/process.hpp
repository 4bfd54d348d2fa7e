// Running other programs: looked up in PATH, no shell in between, output to a log file or a string.
#pragma once

#include <filesystem>
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

/// Runs independent commands, at most `jobs` at a time, each into a log of its own ("<index>.log" in `directory`), and
/// appends those to `log` in order. Returns the first status that is not zero, else 0; after a failure no further
/// command is started.
int run_parallel(std::span<const std::vector<std::string>> commands, const std::filesystem::path& directory,
                 const std::filesystem::path& log, unsigned jobs);

/// The last `lines` lines of a text file, for error messages.
std::string tail_of(const std::filesystem::path& file, std::size_t lines);

}  // namespace quadrille::tb
