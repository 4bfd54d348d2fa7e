// A set on its way to the disk.
#include "golden/io/atomic_file.hpp"
#include "golden/io/interrupt.hpp"
#include "golden/vectors/manifest_parts.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <cstring>

namespace quadrille::vectors {
namespace {

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

}  // namespace quadrille::vectors
