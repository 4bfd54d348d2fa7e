// For the files that add options: the library, what it lacks, and the form of --help.
#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>

namespace quadrille::tb {

/// A whole number from 0 to `most`, or refused: the library would wrap a negative one and clamp a huge one.
CLI::Validator whole_number(std::uint64_t most = UINT64_MAX);

/// Groups that every command has in the same order: Input, the command's own, then these.
constexpr const char *state_group = "Draw state", *config_group = "Configuration", *output_group = "Output",
                     *general_group = "General";

/// Help wrapped to the terminal: $COLUMNS, else the width of the terminal, else 80; at most 120. Subcommands inherit
/// it. After the first line of a description each line is a value and its meaning, with two spaces between.
std::shared_ptr<CLI::FormatterBase> help_formatter();

/// The end of a command's help. `status`: "0 done; 1 mismatch"; `examples` without the program's name.
void end_help(CLI::App& command, const std::string& notes, std::string_view status,
              std::initializer_list<std::string_view> examples);

}  // namespace quadrille::tb
