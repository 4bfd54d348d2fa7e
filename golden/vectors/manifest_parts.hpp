// What sets are read and written with: members of manifests that may hold anything, and directories. Not for use
// outside this folder.
#pragma once

#include "golden/io/error.hpp"
#include "golden/vectors/manifest.hpp"

#include <filesystem>
#include <initializer_list>
#include <set>
#include <string>
#include <string_view>
#include <system_error>

namespace quadrille::vectors {

namespace fs = std::filesystem;
using golden::input_error;
using golden::InputError;
using Json = nlohmann::ordered_json;

inline constexpr const char* manifest_name = "manifest.json";

std::string manifest_text(const Json& manifest);
/// A name that is a file in its own directory and nothing else.
bool plain_name(std::string_view name);

/// The manifest in `text`. Only the bytes that this program writes are accepted: whatever reads back as the same
/// values but was written otherwise has been changed.
Json parse_manifest(const std::string& file, const std::string& text);

void require_canonical(const std::string& file, const std::string& text, const Json& json);
// `key` is no reference: GCC 14 takes what is returned for a part of a temporary there.
const Json& member(const std::string& file, const Json& object, std::string_view key);
std::string text_member(const std::string& file, const Json& object, const std::string& key);
std::uint64_t count_member(const std::string& file, const Json& object, const std::string& key);
int small_member(const std::string& file, const Json& object, const std::string& key, int lowest, int highest);
const Json& object_member(const std::string& file, const Json& object, std::string_view key);
void only_keys(const std::string& file, const Json& object, std::initializer_list<std::string_view> keys);
std::string generator();
void require_format(const std::string& file, const Json& manifest);
Json resolved_values(const Config& config);
/// Level, seed, configuration: what set and suites share. `suites`: what the command has behind them.
SetInfo read_set_info(const std::string& file, const Json& manifest, std::string& suites);

RecordLayout read_layout(const std::string& file, const std::string& role, const Json& record);
[[noreturn]] void fail(const fs::path& path, const std::string& action, const std::error_code& error);
/// The names in a directory, sorted. Throws when something else than regular files (`directories` false) or
/// directories is there, a link too; `manifest.json` is left out.
std::set<std::string> entries(const fs::path& directory, bool directories);

void require_names(const fs::path& directory, const std::set<std::string>& found,
                   const std::set<std::string>& expected);
/// The text of a manifest, which must be a regular file: others might never end.
std::string read_manifest(const fs::path& path, std::string_view what);

/// "… --suite NAME".
std::string with_suite(const std::string& command, const std::string& suite);

/// Reads a file of records; returns how many.
std::uint64_t count_records(const std::string& path, int bits);

}  // namespace quadrille::vectors
