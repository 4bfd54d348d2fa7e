// The common frame of all JSON reports.
#pragma once

#include "model/port/config.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace quadrille::golden {

/// Version of the layout of the reports; grows when a field changes its meaning or goes away.
inline constexpr int report_schema_version = 1;

/// The program's version, such as "0.1.0".
std::string_view program_version();

/// The arguments as one line for a shell, quoted where needed.
std::string command_line(std::span<const std::string> arguments);

/// An object with schema_version, version, config (every key with its value as given), seed and command; add the
/// results to it.
nlohmann::ordered_json begin_report(const Config& config, std::uint64_t seed, std::span<const std::string> arguments);

/// Writes the report, indented, to a file or to standard output for "-". Numbers that are not finite become null, bytes
/// that are not UTF-8 the replacement character. Throws InputError when writing fails; an older file then stays as it
/// was.
void save_json(const std::string& path, const nlohmann::ordered_json& report);

}  // namespace quadrille::golden
