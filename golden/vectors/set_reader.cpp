// A set from the disk.
#include "golden/vectors/manifest_parts.hpp"

#include <algorithm>

namespace quadrille::vectors {

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

}  // namespace quadrille::vectors
