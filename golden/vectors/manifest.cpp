#include "golden/vectors/manifest_parts.hpp"

#include "golden/io/json_report.hpp"
#include "golden/io/text_input.hpp"

#include <algorithm>
#include <charconv>
#include <sstream>

namespace quadrille::vectors {

std::string manifest_text(const Json& manifest) {
  return manifest.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

bool plain_name(std::string_view name) {
  return !name.empty() && name.size() < 200 && name[0] != '.' &&
         name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.-") ==
             std::string_view::npos;
}

// ---- Reading JSON that may be anything ----

Json parse_manifest(const std::string& file, const std::string& text) {
  Json json;
  try {
    // Values this deep do not occur, and writing back is recursive.
    json = Json::parse(text, [&](int depth, Json::parse_event_t, Json&) {
      if (depth > 16) throw input_error(file, 0, "is nested too deeply; expected a manifest");
      return true;
    });
  } catch (const nlohmann::json::parse_error& error) {
    const std::size_t at = std::min(error.byte == 0 ? 0 : error.byte - 1, text.size());
    throw input_error(file, golden::line_at(text, at), "is not JSON: " + golden::printable(error.what()));
  } catch (const nlohmann::json::exception& error) {
    throw input_error(file, 0, "is not JSON: " + golden::printable(error.what()));
  }
  if (!json.is_object()) throw input_error(file, 1, "is not a JSON object; expected a manifest");
  return json;
}

void require_canonical(const std::string& file, const std::string& text, const Json& json) {
  const std::string canonical = manifest_text(json);
  if (canonical == text) return;
  const auto [a, b] = std::mismatch(canonical.begin(), canonical.end(), text.begin(), text.end());
  throw input_error(file, golden::line_at(text, static_cast<std::size_t>(b - text.begin())),
                    "has another form than a manifest (indented by 2, each key once, a newline at the end)");
}

const Json& member(const std::string& file, const Json& object, std::string_view key) {
  const auto found = object.find(std::string(key));
  if (found == object.end()) throw input_error(file, 0, "has no \"" + std::string(key) + "\"");
  return *found;
}

std::string text_member(const std::string& file, const Json& object, const std::string& key) {
  const Json& value = member(file, object, key);
  if (!value.is_string()) throw input_error(file, 0, "\"" + key + "\" is not a string");
  return value.get<std::string>();
}

std::uint64_t count_member(const std::string& file, const Json& object, const std::string& key) {
  const Json& value = member(file, object, key);
  if (!value.is_number_unsigned()) throw input_error(file, 0, "\"" + key + "\" is not a whole number from 0");
  return value.get<std::uint64_t>();
}

int small_member(const std::string& file, const Json& object, const std::string& key, int lowest, int highest) {
  const Json& value = member(file, object, key);
  if (!value.is_number_integer() || value < lowest || value > highest)
    throw input_error(
        file, 0,
        "\"" + key + "\" is not a whole number from " + std::to_string(lowest) + " to " + std::to_string(highest));
  return value.get<int>();
}

const Json& object_member(const std::string& file, const Json& object, std::string_view key) {
  const Json& value = member(file, object, key);
  if (!value.is_object()) throw input_error(file, 0, "\"" + std::string(key) + "\" is not an object");
  return value;
}

void only_keys(const std::string& file, const Json& object, std::initializer_list<std::string_view> keys) {
  for (const auto& [key, value] : object.items())
    if (std::find(keys.begin(), keys.end(), key) == keys.end())
      throw input_error(
          file, 0, "has " + golden::in_quotes(key) + ", which is unknown in format " + std::to_string(format_version));
}

std::string generator() { return "quadrille " + std::string(golden::program_version()); }

namespace {

/// Limit, configuration and input that a command names. Throws golden::InputError unless it is a command of this
/// program.
SetInfo read_command(const std::string& file, const std::string& command) {
  SetInfo info;
  std::istringstream words(command);
  const auto refuse = [&](const std::string& what) -> void { throw input_error(file, 0, "\"command\" " + what); };
  for (const char* expected : {"quadrille", "golden", "generate"})
    if (std::string word; !(words >> word) || word != expected) refuse("is not \"quadrille golden generate\"");
  for (std::string option, value; words >> option;) {
    if (option == "--scene" || option == "--mesh" || option == "--quads" || option == "--stress") {
      info.input = command.substr(command.find(" " + option) + 1);
      break;
    }
    words >> value;
    if (option == "--limit") {
      const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), info.limit);
      if (error != std::errc{} || end != value.data() + value.size()) refuse("has no number as --limit");
    } else if (option == "--set") {
      const std::size_t equals = value.find('=');
      int number = 0;
      const char *first = value.data() + std::min(equals, value.size() - 1) + 1, *last = value.data() + value.size();
      if (equals == std::string::npos || std::from_chars(first, last, number).ptr != last)
        refuse("has no KEY=VALUE after --set");
      info.config.set(value.substr(0, equals), number);
    }
  }
  return info;
}

}  // namespace

void require_format(const std::string& file, const Json& manifest) {
  const Json& format = member(file, manifest, "format");
  if (!format.is_number_integer() || format != format_version)
    throw input_error(file, 0,
                      "has format " + golden::printable(format.dump().substr(0, 40)) + "; this program reads format " +
                          std::to_string(format_version) + " (golden/CONVERTING.md)");
}

Json resolved_values(const Config& config) {
  Json values = Json::object();
  for (const ConfigKey& key : Config::keys()) values[std::string(key.name)] = config.resolved(key.name);
  return values;
}

SetInfo read_set_info(const std::string& file, const Json& manifest, std::string& suites) {
  SetInfo info;
  if (const std::string given = text_member(file, manifest, "generator"); given != generator())
    throw input_error(file, 0,
                      "\"generator\" is " + golden::in_quotes(given) + "; this program checks sets of " + generator());
  info.level = small_member(file, manifest, "level", 1, 2);
  info.seed = count_member(file, manifest, "seed");
  const std::string command = text_member(file, manifest, "command");
  const Json& config = object_member(file, manifest, "config");
  try {
    for (const auto& [key, value] : config.items()) {
      if (!value.is_number_integer() || value < -1 || value > 1000)
        throw input_error(file, 0, "config: " + golden::in_quotes(key) + " is not a configuration value");
      info.config.set(key, value.get<int>());
      if (const std::string note = Config::note(key); !note.empty()) info.notes.push_back("config: " + note);
    }
    info.config.validate();
  } catch (const ConfigError& error) {
    throw input_error(file, 0, "config: " + golden::printable(error.what()));
  }
  // A key that the set does not name came later: it has its default.
  Json stated = resolved_values(info.config);
  for (const ConfigKey& key : Config::keys())
    if (!config.contains(key.name)) stated.erase(key.name);
  Json known = config;
  for (const auto& [key, value] : config.items())
    if (Config::removed(key) != nullptr) known.erase(key);
  if (known != stated) throw input_error(file, 0, "config does not hold its keys in order");
  if (object_member(file, manifest, "derived") != derived_json(info.config))
    throw input_error(file, 0, "\"derived\" does not follow from \"config\"");

  // The command is spelled in one way, from the values as they were given: those of `config` are resolved.
  SetInfo named;
  try {
    named = read_command(file, command);
  } catch (const ConfigError& error) {
    throw input_error(file, 0, "\"command\": " + golden::printable(error.what()));
  }
  named.level = info.level;
  named.seed = info.seed;
  named.notes = std::move(info.notes);
  const std::string spelled = set_command(named);
  if (!command.starts_with(spelled) || resolved_values(named.config) != resolved_values(info.config))
    throw input_error(file, 0, "\"command\" does not generate this level, seed and configuration");
  suites = command.substr(spelled.size());
  return named;
}

RecordLayout read_layout(const std::string& file, const std::string& role, const Json& record) {
  RecordLayout layout;
  const Json& fields = member(file, record, "fields");
  if (!fields.is_array() || fields.empty()) throw input_error(file, 0, "record " + role + " has no fields");
  for (const Json& f : fields) {
    if (!f.is_object()) throw input_error(file, 0, "a field of record " + role + " is no object");
    only_keys(file, f,
              {"name", "index", "width", "position", "signed", "encoding", "fraction_bits", "unit", "meaning"});
    RecordField field;
    field.name = text_member(file, f, "name");
    if (f.contains("index")) field.index = small_member(file, f, "index", 0, 1 << 20);
    field.width = small_member(file, f, "width", 1, 64);
    const Json& is_signed = member(file, f, "signed");
    if (!is_signed.is_boolean()) throw input_error(file, 0, "\"signed\" is not true or false");
    field.is_signed = is_signed.get<bool>();
    if (f.contains("encoding")) field.encoding = text_member(file, f, "encoding");
    if (f.contains("fraction_bits")) field.fraction_bits = small_member(file, f, "fraction_bits", -4096, 4096);
    field.unit = text_member(file, f, "unit");
    field.meaning = text_member(file, f, "meaning");
    small_member(file, f, "position", 0, 1 << 24);
    layout.add(std::move(field));
  }
  if (to_json(layout) != fields)
    throw input_error(file, 0,
                      "the fields of record " + role + " do not lie from the most significant bit down without gaps");
  if (layout.bits() != small_member(file, record, "bits", 1, 1 << 24))
    throw input_error(
        file, 0,
        "record " + role + " has " + std::to_string(layout.bits()) + " bits of fields, \"bits\" says otherwise");
  return layout;
}

// ---- Directories ----

[[noreturn]] void fail(const fs::path& path, const std::string& action, const std::error_code& error) {
  throw input_error(path.string(), 0, action + ": " + error.message());
}

std::set<std::string> entries(const fs::path& directory, bool directories) {
  std::set<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(directory, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    std::error_code unused;
    const bool is_manifest = name == manifest_name;
    const fs::file_status status = entry->symlink_status(unused);
    if (is_manifest || !directories ? !fs::is_regular_file(status) : !fs::is_directory(status))
      throw input_error((directory / golden::printable(name)).string(), 0, "does not belong to the set");
    if (!is_manifest) names.insert(name);
  }
  if (error) fail(directory, "cannot be listed", error);
  return names;
}

void require_names(const fs::path& directory, const std::set<std::string>& found,
                   const std::set<std::string>& expected) {
  for (const std::string& name : expected)
    if (!found.contains(name)) throw input_error((directory / name).string(), 0, "is missing");
  for (const std::string& name : found)
    if (!expected.contains(name))
      throw input_error((directory / golden::printable(name)).string(), 0, "does not belong to the set");
}

std::string read_manifest(const fs::path& path, std::string_view what) {
  std::error_code error;
  const fs::file_status status = fs::symlink_status(path, error);
  if (fs::exists(status) && !fs::is_regular_file(status))
    throw input_error(path.string(), 0, "is no regular file; expected " + std::string(what));
  return golden::read_file(path.string(), what);
}

std::string with_suite(const std::string& command, const std::string& suite) { return command + " --suite " + suite; }

std::uint64_t count_records(const std::string& path, int bits) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw input_error(path, 0, "cannot be read");
  std::string line;
  std::uint64_t lines = 0;
  while (std::getline(in, line)) {
    ++lines;
    try {
      Record::from_hex(line, bits);
    } catch (const HexError& error) {
      throw input_error(path, lines, error.what());
    }
    if (in.eof()) throw input_error(path, lines, "has no newline at its end");
  }
  return lines;
}

// ---- What set, suites and other programs say alike ----

std::string set_command(const SetInfo& info) {
  std::string command =
      "quadrille golden generate --level " + std::to_string(info.level) + " --seed " + std::to_string(info.seed);
  if (info.limit > 0) command += " --limit " + std::to_string(info.limit);
  for (const ConfigKey& key : Config::keys())
    if (const int value = info.config.get(key.name); value != key.standard)
      command += " --set " + std::string(key.name) + "=" + std::to_string(value);
  if (!info.input.empty()) command += " " + info.input;
  return command;
}

Json to_json(const RecordLayout& layout) {
  Json fields = Json::array();
  for (const RecordField& f : layout.fields()) {
    Json& field = fields.emplace_back();
    field["name"] = f.name;
    if (f.index >= 0) field["index"] = f.index;
    field["width"] = f.width;
    field["position"] = f.position;
    field["signed"] = f.is_signed;
    if (!f.encoding.empty()) field["encoding"] = f.encoding;
    if (f.fraction_bits) field["fraction_bits"] = *f.fraction_bits;
    field["unit"] = f.unit;
    field["meaning"] = f.meaning;
  }
  return fields;
}

Json config_json(const Config& config) {
  Json values = resolved_values(config);
  for (const ConfigKey& key : Config::keys()) {
    Config standard = config;
    standard.set(key.name, key.standard);
    if (key.has(ConfigKey::added) && resolved_values(standard) == resolved_values(config)) values.erase(key.name);
  }
  return values;
}

Json derived_json(const Config& config) {
  Json values = Json::object();
  for (const DerivedWidth& width : config.derived()) values[width.name] = width.value;
  return values;
}

}  // namespace quadrille::vectors
