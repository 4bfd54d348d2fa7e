// A set of golden vectors as a directory: written so that it is complete or not there, read so that no damage goes
// unseen. The files are described in golden/vectors/README.md.
#pragma once

#include "golden/io/temporary.hpp"
#include "golden/vectors/sha256.hpp"
#include "model/port/config.hpp"
#include "model/port/record.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::vectors {

/// Version of the format; grows when a reader of the old one would misread a set.
inline constexpr int format_version = 2;

/// What a suite is, for listings and its manifest.
struct SuiteInfo {
  std::string name;
  std::string kind;  ///< stage, handshake, snapping, table, machine
  std::string title;
  std::string module;    ///< of rtl/, or "none"
  int latency = 0;       ///< clocks from the last input to the response; 0 where a handshake decides
  std::string contract;  ///< what stimuli never contain
};

/// What all suites of a set share.
struct SetInfo {
  int level = 1;
  std::uint64_t seed = 1;
  Config config;
  std::uint64_t limit = 0;  ///< GenerateOptions::limit
  std::string input{};      ///< one's own: the options that name it, as a command line gives them; empty: the suites'
  std::vector<std::string> notes{};  ///< of a manifest's keys that were removed (Config::note)
};

/// The command that generates a set of every suite, without --out. Each --suite NAME follows it in the order of the
/// set; of an input of one's own the options of the input stand there instead.
std::string set_command(const SetInfo& info);

nlohmann::ordered_json to_json(const RecordLayout& layout);

/// The values of a configuration, resolved (ConfigKey::added says which are left out), and its derived widths.
nlohmann::ordered_json config_json(const Config& config);
nlohmann::ordered_json derived_json(const Config& config);

/// Writes one suite into a directory of its own. Records go to named roles ("stimulus", "response", …), a file each.
class SuiteWriter {
 public:
  SuiteWriter(std::filesystem::path directory, SuiteInfo info, const SetInfo& set);

  /// Announces ROLE.hex with records of this layout.
  void add_record(const std::string& role, const RecordLayout& layout);
  /// One line of ROLE.hex. The record must have the layout's bits.
  void write(const std::string& role, const Record& record);
  /// Where to put another file (a picture) before finish().
  std::filesystem::path add_file(const std::string& name);
  /// An entry of "counts". "vectors" must be set.
  void set_count(const std::string& what, std::uint64_t count);
  std::uint64_t count(const std::string& what) const;  ///< as set; 0 when it was not
  const SetInfo& set() const { return set_; }

  /// Writes manifest.json; returns its SHA-256.
  std::string finish();

 private:
  struct HexFile {
    RecordLayout layout;
    std::ofstream out;
    Sha256 hash;
    std::uint64_t bytes = 0, lines = 0;
  };

  std::filesystem::path directory_;
  SuiteInfo info_;
  SetInfo set_;
  std::vector<std::string> roles_;  ///< in the order in which they were announced
  std::map<std::string, HexFile> hex_;
  std::vector<std::string> files_;
  nlohmann::ordered_json counts_ = nlohmann::ordered_json::object();
};

class SuiteReader;

/// Writes a set: everything goes to a temporary directory beside `directory`, which commit() puts in its place: all of
/// the set appears, or nothing. A symbolic link is followed.
class SetWriter {
 public:
  /// Throws golden::InputError when `directory` exists and is not empty, unless `replace` is set and it holds a set and
  /// nothing else; when it cannot be replaced by another directory (the current one, a mount point); and when it is a
  /// link to nothing.
  SetWriter(std::filesystem::path directory, SetInfo info, bool replace);

  /// `write` fills the suite; its manifest follows.
  void add(const SuiteInfo& suite, const std::function<void(SuiteWriter&)>& write);

  /// A suite of another set, as it is; set_command() of both must be the same.
  void copy(const SuiteReader& suite);

  /// `complete`: the set has every suite there is, so its command needs no --suite. Throws golden::InputError for a set
  /// without suites.
  void commit(bool complete);

 private:
  std::filesystem::path directory_;  ///< as given, for messages
  std::filesystem::path target_;     ///< where it goes, links resolved
  std::optional<golden::Temporary> temporary_;
  bool replace_;
  SetInfo info_;
  std::vector<std::string> names_;
  nlohmann::ordered_json suites_ = nlohmann::ordered_json::object();
};

/// One suite of a set on the disk. The constructor checks everything that can be checked without knowing the machine:
/// hashes, sizes, line counts, record widths, digits. Every difference throws golden::InputError with file and line.
class SuiteReader {
 public:
  SuiteReader(std::filesystem::path directory, const std::string& name, const std::string& manifest_sha256);

  const nlohmann::ordered_json& manifest() const { return manifest_; }
  const SuiteInfo& info() const { return info_; }
  const SetInfo& set() const { return set_; }
  const std::filesystem::path& directory() const { return directory_; }
  std::string manifest_file() const { return (directory_ / "manifest.json").string(); }  ///< for messages

  bool has(const std::string& role) const { return roles_.contains(role); }
  std::vector<std::string> roles() const;  ///< in the order of names
  /// Throws golden::InputError when the manifest has no such record.
  const RecordLayout& layout(const std::string& role) const { return role_of(role).layout; }
  std::uint64_t lines(const std::string& role) const { return role_of(role).lines; }
  /// Records [first, first + count); may be called on several threads.
  std::vector<Record> read(const std::string& role, std::uint64_t first, std::uint64_t count) const;
  /// "file:line" of a record, for messages.
  std::string place(const std::string& role, std::uint64_t record) const;

 private:
  struct Role {
    std::string file;
    RecordLayout layout;
    std::uint64_t lines = 0;
  };
  const Role& role_of(const std::string& role) const;
  void check_files();
  void check_hex(const Role& role) const;

  std::filesystem::path directory_;
  nlohmann::ordered_json manifest_;
  SuiteInfo info_;
  SetInfo set_;
  std::map<std::string, Role> roles_;
};

/// Makes a set of one's own responses one that SetReader takes: hashes, sizes and numbers of lines of response.hex, of
/// beats.hex and of pictures are those of the files as they are. Records may stand as $writememh writes them
/// (memory_file.hpp); they are then written as this project does. Throws golden::InputError, with the line, for records
/// that are malformed, too few or too many, and for any other file that is not the generated one.
void seal_set(const std::filesystem::path& directory);

/// A set on the disk. The constructor checks the set's manifest and that the directory holds its suites and nothing
/// else; suite() checks a suite. Symbolic links inside a set are refused.
class SetReader {
 public:
  explicit SetReader(std::filesystem::path directory);

  const SetInfo& info() const { return info_; }
  const std::vector<std::string>& suites() const { return names_; }
  /// The command names no suite, so the set must have every suite there is.
  bool says_complete() const { return says_complete_; }
  std::string manifest_file() const { return (directory_ / "manifest.json").string(); }  ///< for messages
  /// Throws golden::InputError for a name that the set does not have, and for every damage of the suite.
  SuiteReader suite(const std::string& name) const;

 private:
  std::filesystem::path directory_;
  SetInfo info_;
  nlohmann::ordered_json manifest_;
  std::vector<std::string> names_;
  bool says_complete_ = false;
};

}  // namespace quadrille::vectors
