#include "golden/vectors/manifest.hpp"

#include "golden/io/atomic_file.hpp"
#include "golden/io/error.hpp"
#include "golden/io/interrupt.hpp"
#include "golden/io/json_report.hpp"
#include "golden/io/text_input.hpp"
#include "golden/vectors/memory_file.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <set>
#include <sstream>
#include <system_error>

namespace quadrille::vectors {
namespace {

namespace fs = std::filesystem;
using golden::input_error;
using golden::InputError;
using Json = nlohmann::ordered_json;

constexpr const char* manifest_name = "manifest.json";

std::string manifest_text(const Json& manifest) {
  return manifest.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// A name that is a file in its own directory and nothing else.
bool plain_name(std::string_view name) {
  return !name.empty() && name.size() < 200 && name[0] != '.' &&
         name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.-") ==
             std::string_view::npos;
}

// ---- Reading JSON that may be anything ----

/// The manifest in `text`. Only the bytes that this program writes are accepted: whatever reads back as the same
/// values but was written otherwise has been changed.
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

const Json& member(const std::string& file, const Json& object, const std::string& key) {
  const auto found = object.find(key);
  if (found == object.end()) throw input_error(file, 0, "has no \"" + key + "\"");
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

const Json& object_member(const std::string& file, const Json& object, const std::string& key) {
  const Json& value = member(file, object, key);
  if (!value.is_object()) throw input_error(file, 0, "\"" + key + "\" is not an object");
  return value;
}

void only_keys(const std::string& file, const Json& object, std::initializer_list<std::string_view> keys) {
  for (const auto& [key, value] : object.items())
    if (std::find(keys.begin(), keys.end(), key) == keys.end())
      throw input_error(
          file, 0, "has " + golden::in_quotes(key) + ", which is unknown in format " + std::to_string(format_version));
}

std::string generator() { return "quadrille " + std::string(golden::program_version()); }

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

/// Level, seed, configuration: what set and suites share. `suites`: what the command has behind them.
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
    }
    info.config.validate();
  } catch (const ConfigError& error) {
    throw input_error(file, 0, "config: " + golden::printable(error.what()));
  }
  // A key that the set does not name came later: it has its default.
  Json stated = resolved_values(info.config);
  for (const ConfigKey& key : Config::keys())
    if (!config.contains(key.name)) stated.erase(key.name);
  if (config != stated) throw input_error(file, 0, "config does not hold its keys in order");
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

/// The names in a directory, sorted. Throws when something else than regular files (`directories` false) or
/// directories is there, a link too; `manifest.json` is left out.
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

/// The text of a manifest, which must be a regular file: others might never end.
std::string read_manifest(const fs::path& path, std::string_view what) {
  std::error_code error;
  const fs::file_status status = fs::symlink_status(path, error);
  if (fs::exists(status) && !fs::is_regular_file(status))
    throw input_error(path.string(), 0, "is no regular file; expected " + std::string(what));
  return golden::read_file(path.string(), what);
}

/// "… --suite NAME".
std::string with_suite(const std::string& command, const std::string& suite) { return command + " --suite " + suite; }

/// The command of one suite of a set.
std::string suite_command(const SetInfo& info, const std::string& suite) {
  return info.input.empty() ? with_suite(set_command(info), suite) : set_command(info);
}

Json common_entries(const SetInfo& set, const std::string& command) {
  return {{"seed", set.seed},
          {"level", set.level},
          {"command", command},
          {"config", config_json(set.config)},
          {"derived", derived_json(set.config)}};
}

/// Where a set named `directory` goes, links resolved. Throws for what cannot become a set.
fs::path resolve_target(const fs::path& directory) {
  std::error_code error;
  if (fs::is_symlink(directory, error) && !fs::exists(directory, error))
    throw input_error(directory.string(), 0, "is a symbolic link to nothing");
  const fs::path target = fs::weakly_canonical(fs::absolute(directory), error);
  if (error) fail(directory, "cannot be found", error);
  if (!fs::exists(target, error)) return target;
  if (!fs::is_directory(target, error)) throw input_error(directory.string(), 0, "is no directory");
  // Both would be found out by the renaming at the end only.
  const fs::path current = fs::current_path(error);
  if (std::mismatch(target.begin(), target.end(), current.begin(), current.end()).first == target.end())
    throw input_error(directory.string(), 0,
                      "is or holds the current directory, which cannot be replaced; name another one");
  struct stat own {
  }, above{};
  if (::stat(target.c_str(), &own) == 0 && ::stat(target.parent_path().c_str(), &above) == 0 &&
      own.st_dev != above.st_dev)
    throw input_error(directory.string(), 0, "is a mount point, which cannot be replaced; name a directory in it");
  return target;
}

}  // namespace

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

// ---- SuiteWriter ----

SuiteWriter::SuiteWriter(fs::path directory, SuiteInfo info, const SetInfo& set)
    : directory_(std::move(directory)), info_(std::move(info)), set_(set) {
  std::error_code error;
  fs::create_directory(directory_, error);
  if (error) fail(directory_, "cannot be made", error);
}

void SuiteWriter::add_record(const std::string& role, const RecordLayout& layout) {
  const fs::path path = directory_ / (role + ".hex");
  HexFile& file = hex_[role];
  file.layout = layout;
  file.out.open(path, std::ios::binary);
  if (!file.out) throw input_error(path.string(), 0, std::string("cannot be written: ") + std::strerror(errno));
  roles_.push_back(role);
}

void SuiteWriter::write(const std::string& role, const Record& record) {
  HexFile& file = hex_.at(role);
  if (record.bits() != file.layout.bits()) throw std::logic_error("a record of another layout in " + role);
  const std::string line = record.to_hex() + "\n";
  file.out.write(line.data(), static_cast<std::streamsize>(line.size()));
  file.hash.update(line);
  file.bytes += line.size();
  ++file.lines;
}

fs::path SuiteWriter::add_file(const std::string& name) {
  if (!plain_name(name) || name == manifest_name) throw std::logic_error("no name of a suite's file: " + name);
  files_.push_back(name);
  return directory_ / name;
}

void SuiteWriter::set_count(const std::string& what, std::uint64_t count) { counts_[what] = count; }

std::uint64_t SuiteWriter::count(const std::string& what) const { return counts_.value(what, std::uint64_t{0}); }

std::string SuiteWriter::finish() {
  Json files = Json::object(), records = Json::object();
  for (const std::string& role : roles_) {
    HexFile& file = hex_.at(role);
    const std::string name = role + ".hex";
    file.out.close();
    if (!file.out) throw input_error((directory_ / name).string(), 0, "cannot be written completely");
    files[name] = {{"sha256", file.hash.finish()}, {"bytes", file.bytes}, {"lines", file.lines}};
    records[role] = {{"file", name}, {"bits", file.layout.bits()}, {"fields", to_json(file.layout)}};
  }
  for (const std::string& name : files_) {
    const FileDigest digest = digest_file(directory_ / name);
    files[name] = {{"sha256", digest.sha256}, {"bytes", digest.bytes}};
  }
  Json manifest = {{"format", format_version}, {"generator", generator()},  {"suite", info_.name},
                   {"kind", info_.kind},       {"title", info_.title},      {"module", info_.module},
                   {"latency", info_.latency}, {"contract", info_.contract}};
  manifest.update(common_entries(set_, suite_command(set_, info_.name)));
  manifest["files"] = std::move(files);
  manifest["records"] = std::move(records);
  manifest["counts"] = counts_;
  const std::string text = manifest_text(manifest);
  golden::write_file((directory_ / manifest_name).string(), text, golden::AtomicFile::Dash::refused);
  return sha256(text);
}

// ---- SetWriter ----

SetWriter::SetWriter(fs::path directory, SetInfo info, bool replace)
    : directory_(std::move(directory)), replace_(replace), info_(std::move(info)) {
  if (directory_.empty()) throw InputError("a set of vectors needs a directory name");
  if (directory_.filename().empty()) directory_ = directory_.parent_path();  // a slash at the end
  target_ = resolve_target(directory_);
  std::error_code error;
  if (fs::exists(target_, error)) {
    const bool empty = fs::is_empty(target_, error);
    if (error) fail(directory_, "cannot be listed", error);
    if (!empty && !replace)
      throw input_error(directory_.string(), 0,
                        "is not empty; use --force to replace a set of vectors, or another directory");
    if (!empty) {
      // Only what a set consists of is ever removed.
      const SetReader old(directory_);
      for (const std::string& suite : old.suites()) {
        const std::string file = (directory_ / suite / manifest_name).string();
        const Json manifest = parse_manifest(file, read_manifest(file, "the manifest of a suite"));
        const Json& files = object_member(file, manifest, "files");
        for (const std::string& name : entries(directory_ / suite, false))
          if (!files.contains(name))
            throw input_error((directory_ / suite / name).string(), 0, "does not belong to the set");
      }
    }
  }
  const fs::path parent = target_.parent_path();
  fs::create_directories(parent, error);
  if (error) fail(parent, "cannot be made", error);
  golden::announce_output(directory_.string());
  try {
    temporary_.emplace(parent, golden::Temporary::Kind::folder);
  } catch (const std::system_error& failure) {
    fail(parent, "cannot be written to", failure.code());
  }
}

void SetWriter::add(const SuiteInfo& suite, const std::function<void(SuiteWriter&)>& write) {
  SuiteWriter writer(temporary_->path() / suite.name, suite, info_);
  write(writer);
  suites_[suite.name] = {{"sha256", writer.finish()}};
  names_.push_back(suite.name);
}

void SetWriter::copy(const SuiteReader& suite) {
  const std::string& name = suite.info().name;
  const std::string text = read_manifest(suite.manifest_file(), "the manifest of a suite");
  std::error_code error;
  fs::copy(suite.directory(), temporary_->path() / name, fs::copy_options::recursive, error);
  if (error) fail(suite.directory(), "cannot be copied", error);
  suites_[name] = {{"sha256", sha256(text)}};
  names_.push_back(name);
}

void SetWriter::commit(bool complete) {
  if (names_.empty()) throw InputError("no suite selected; expected at least one");
  std::string command = set_command(info_);
  if (!complete)
    for (const std::string& name : names_) command = with_suite(command, name);
  Json manifest = {{"format", format_version}, {"generator", generator()}};
  manifest.update(common_entries(info_, command));
  manifest["suites"] = suites_;
  golden::write_file((temporary_->path() / manifest_name).string(), manifest_text(manifest),
                     golden::AtomicFile::Dash::refused);
  std::error_code error;
  try {
    if (replace_ && fs::exists(target_, error))
      temporary_->replace(target_);
    else
      temporary_->publish(target_);
  } catch (const std::system_error& failure) {
    if (failure.code() == std::errc::directory_not_empty || failure.code() == std::errc::file_exists)
      throw input_error(directory_.string(), 0,
                        "was written by another run meanwhile; use --force or another directory");
    fail(directory_, "cannot be made", failure.code());
  }
  temporary_.reset();
  golden::output_written(directory_.string());
}

// ---- SuiteReader ----

SuiteReader::SuiteReader(fs::path directory, const std::string& name, const std::string& manifest_sha256)
    : directory_(std::move(directory)) {
  const std::string file = (directory_ / manifest_name).string();
  const std::string text = read_manifest(file, "the manifest of a suite");
  if (sha256(text) != manifest_sha256)
    throw input_error(file, 0, "is not the one that the set's manifest names (SHA-256)");
  manifest_ = parse_manifest(file, text);
  require_format(file, manifest_);
  require_canonical(file, text, manifest_);
  only_keys(file, manifest_,
            {"format", "generator", "suite", "kind", "title", "module", "latency", "contract", "seed", "level",
             "command", "config", "derived", "files", "records", "counts"});
  info_ = {text_member(file, manifest_, "suite"),
           text_member(file, manifest_, "kind"),
           text_member(file, manifest_, "title"),
           text_member(file, manifest_, "module"),
           small_member(file, manifest_, "latency", 0, 1 << 20),
           text_member(file, manifest_, "contract")};
  if (info_.name != name)
    throw input_error(file, 0, "is the manifest of " + golden::in_quotes(info_.name) + ", not of " + name);
  std::string suites;
  set_ = read_set_info(file, manifest_, suites);
  if (suites != (set_.input.empty() ? with_suite("", name) : ""))
    throw input_error(file, 0, "\"command\" is not that of suite " + name);
  for (const auto& [role, record] : object_member(file, manifest_, "records").items()) {
    if (!record.is_object()) throw input_error(file, 0, "record " + golden::in_quotes(role) + " is no object");
    only_keys(file, record, {"file", "bits", "fields"});
    roles_[role] = {text_member(file, record, "file"), read_layout(file, role, record), 0};
  }
  const Json& counts = object_member(file, manifest_, "counts");
  for (const auto& [key, value] : counts.items()) count_member(file, counts, key);
  check_files();
  if (count_member(file, counts, "vectors") == 0) throw input_error(file, 0, "the suite has no vectors");
}

void SuiteReader::check_files() {
  const std::string manifest = (directory_ / manifest_name).string();
  const Json& files = object_member(manifest, manifest_, "files");
  std::set<std::string> expected;
  for (const auto& [name, description] : files.items()) {
    if (!plain_name(name)) throw input_error(manifest, 0, golden::in_quotes(name) + " is no name of a suite's file");
    expected.insert(name);
  }
  require_names(directory_, entries(directory_, false), expected);
  for (const auto& [name, description] : files.items()) {
    if (!description.is_object()) throw input_error(manifest, 0, "files: " + name + " is no object");
    only_keys(manifest, description, {"sha256", "bytes", "lines"});
    const fs::path path = directory_ / name;
    const std::uint64_t bytes = count_member(manifest, description, "bytes");
    std::error_code error;
    const std::uint64_t size = fs::file_size(path, error);
    if (error) fail(path, "cannot be read", error);
    if (size != bytes)
      throw input_error(path.string(), 0,
                        "has " + std::to_string(size) + " bytes; the manifest says " + std::to_string(bytes));
  }
  // Lines first: they say where a file is damaged, a hash does not.
  for (auto& [name, role] : roles_) {
    if (!files.contains(role.file))
      throw input_error(manifest, 0, "record " + golden::in_quotes(name) + " has no file among \"files\"");
    role.lines = count_member(manifest, files[role.file], "lines");
    check_hex(role);
  }
  for (const auto& [name, description] : files.items()) {
    const fs::path path = directory_ / name;
    if (digest_file(path).sha256 != text_member(manifest, description, "sha256"))
      throw input_error(path.string(), 0, "is not the file that the manifest names (SHA-256)");
  }
}

namespace {

/// Reads a file of records; returns how many.
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

}  // namespace

void SuiteReader::check_hex(const Role& role) const {
  const std::string path = (directory_ / role.file).string();
  const std::uint64_t lines = count_records(path, role.layout.bits());
  if (lines != role.lines)
    throw input_error(path, 0,
                      "has " + std::to_string(lines) + " lines; the manifest says " + std::to_string(role.lines));
}

std::vector<std::string> SuiteReader::roles() const {
  std::vector<std::string> names;
  for (const auto& [name, role] : roles_) names.push_back(name);
  return names;
}

const SuiteReader::Role& SuiteReader::role_of(const std::string& role) const {
  const auto found = roles_.find(role);
  if (found == roles_.end())
    throw input_error((directory_ / manifest_name).string(), 0, "has no record \"" + role + "\"");
  return found->second;
}

std::vector<Record> SuiteReader::read(const std::string& name, std::uint64_t first, std::uint64_t count) const {
  const Role& role = role_of(name);
  const std::string path = (directory_ / role.file).string();
  std::ifstream in(path, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(first * (role.layout.digits() + 1)));
  std::vector<Record> records;
  records.reserve(count);
  std::string line;
  for (std::uint64_t i = 0; i < count; ++i) {
    if (!std::getline(in, line)) throw input_error(path, first + i + 1, "cannot be read");
    try {
      records.push_back(Record::from_hex(line, role.layout.bits()));
    } catch (const HexError& error) {
      throw input_error(path, first + i + 1, error.what());
    }
  }
  return records;
}

std::string SuiteReader::place(const std::string& role, std::uint64_t record) const {
  return (directory_ / role_of(role).file).string() + ":" + std::to_string(record + 1);
}

// ---- SetReader ----

SetReader::SetReader(fs::path directory) : directory_(std::move(directory)) {
  const std::string file = (directory_ / manifest_name).string();
  std::error_code error;
  if (!fs::is_directory(directory_, error))
    throw input_error(directory_.string(), 0, "is no directory; expected a set of vectors");
  const std::string text = read_manifest(file, "the manifest of a set of vectors");
  manifest_ = parse_manifest(file, text);
  require_format(file, manifest_);
  require_canonical(file, text, manifest_);
  if (manifest_.contains("suite"))
    throw input_error(file, 0, "is the manifest of one suite; expected its set, the directory above");
  only_keys(file, manifest_, {"format", "generator", "seed", "level", "command", "config", "derived", "suites"});
  std::string suites, selected;
  info_ = read_set_info(file, manifest_, suites);
  std::set<std::string> expected;
  for (const auto& [name, entry] : object_member(file, manifest_, "suites").items()) {
    if (!plain_name(name)) throw input_error(file, 0, golden::in_quotes(name) + " is no name of a suite");
    if (!entry.is_object()) throw input_error(file, 0, "suites: " + name + " is no object");
    only_keys(file, entry, {"sha256"});
    text_member(file, entry, "sha256");
    expected.insert(name);
    names_.push_back(name);
    selected = with_suite(selected, name);
  }
  if (names_.empty()) throw input_error(file, 0, "names no suite; expected at least one");
  says_complete_ = suites.empty() && info_.input.empty();
  if (!says_complete_ && suites != (info_.input.empty() ? selected : ""))
    throw input_error(file, 0, "\"command\" generates other suites than the set has");
  require_names(directory_, entries(directory_, true), expected);
}

SuiteReader SetReader::suite(const std::string& name) const {
  const std::string file = (directory_ / manifest_name).string();
  if (std::find(names_.begin(), names_.end(), name) == names_.end())
    throw input_error(file, 0, "names no suite " + golden::in_quotes(name));
  SuiteReader reader(directory_ / name, name, text_member(file, manifest_["suites"][name], "sha256"));
  // A set's manifest repeats what its suites say, so that a change of either shows.
  const Json& own = reader.manifest();
  for (const char* key : {"generator", "seed", "level", "config", "derived"})
    if (own[key] != manifest_[key])
      throw input_error(file, 0, std::string("\"") + key + "\" differs from that of suite " + name);
  std::string command = own["command"].get<std::string>(), of_set = manifest_["command"].get<std::string>();
  if (info_.input.empty()) command.resize(command.size() - with_suite("", name).size());
  of_set.resize(std::min(of_set.size(), command.size()));
  if (command != of_set || reader.set().limit != info_.limit || reader.set().input != info_.input)
    throw input_error(file, 0, "\"command\" differs from that of suite " + name);
  return reader;
}

// ---- Sealing ----

namespace {

/// What someone else's device fills in.
bool is_response(const std::string& name) {
  return name == "response.hex" || name == "beats.hex" || name.ends_with(".exr");
}

/// New contents of files.
using Contents = std::map<fs::path, std::string>;

/// Adds the suite's manifest for the files as they are, and responses that a simulator wrote as this project would
/// have. Returns the manifest.
std::string sealed_manifest(const fs::path& directory, Contents& contents) {
  const std::string file = (directory / manifest_name).string();
  Json manifest = parse_manifest(file, read_manifest(file, "the manifest of a suite"));
  require_format(file, manifest);
  std::map<std::string, int> bits;
  for (const auto& [role, record] : object_member(file, manifest, "records").items()) {
    if (!record.is_object()) throw input_error(file, 0, "record " + golden::in_quotes(role) + " is no object");
    bits[text_member(file, record, "file")] = read_layout(file, role, record).bits();
  }
  std::map<std::string, std::uint64_t> lines;
  object_member(file, manifest, "files");
  for (auto& [name, entry] : manifest["files"].items()) {
    if (!plain_name(name)) throw input_error(file, 0, golden::in_quotes(name) + " is no name of a suite's file");
    if (!entry.is_object()) throw input_error(file, 0, "files: " + name + " is no object");
    const fs::path path = directory / name;
    std::error_code error;
    if (!fs::is_regular_file(fs::symlink_status(path, error)))
      throw input_error(path.string(), 0, "is no regular file");
    FileDigest digest = digest_file(path);
    if (bits.contains(name) && is_response(name)) {
      MemoryFile memory =
          read_memory_file(golden::read_file(path.string(), "a file of records"), path.string(), bits[name]);
      lines[name] = memory.lines;
      if (const std::string hash = sha256(memory.records); hash != digest.sha256) {
        digest.sha256 = hash, digest.bytes = memory.records.size();
        contents[path] = std::move(memory.records);
      }
    } else if (bits.contains(name)) {
      lines[name] = count_records(path.string(), bits[name]);
    }
    if (!is_response(name) && digest.sha256 != text_member(file, entry, "sha256"))
      throw input_error(path.string(), 0,
                        "differs from the generated file; only response.hex and beats.hex may change");
    entry["sha256"] = digest.sha256;
    entry["bytes"] = digest.bytes;
    if (lines.contains(name)) entry["lines"] = lines[name];
  }
  const bool machine = text_member(file, manifest, "kind") == "machine";
  const std::string response = machine ? "beats.hex" : "response.hex";
  if (lines[response] != lines["stimulus.hex"])
    throw input_error((directory / response).string(), std::min(lines[response], lines["stimulus.hex"]) + 1,
                      "the file has " + std::to_string(lines[response]) + " lines; stimulus.hex has " +
                          std::to_string(lines["stimulus.hex"]) + ", and each needs one");
  object_member(file, manifest, "counts");
  manifest["counts"]["vectors"] = lines["response.hex"];
  return contents[directory / manifest_name] = manifest_text(manifest);
}

}  // namespace

void seal_set(const fs::path& directory) {
  const std::string file = (directory / manifest_name).string();
  Json manifest = parse_manifest(file, read_manifest(file, "the manifest of a set of vectors"));
  require_format(file, manifest);
  object_member(file, manifest, "suites");
  // Nothing is written before every suite is right.
  Contents contents;
  for (auto& [name, entry] : manifest["suites"].items()) {
    if (!plain_name(name) || !entry.is_object()) throw input_error(file, 0, golden::in_quotes(name) + " is no suite");
    entry["sha256"] = sha256(sealed_manifest(directory / name, contents));
  }
  for (const auto& [path, text] : contents) golden::write_file(path.string(), text, golden::AtomicFile::Dash::refused);
  golden::write_file(file, manifest_text(manifest), golden::AtomicFile::Dash::refused);
}

}  // namespace quadrille::vectors
