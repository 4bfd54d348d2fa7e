// The files of one run that belong together: all of them appear in a directory, or none.
#pragma once

#include "golden/io/temporary.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace quadrille::tb {

/// Collects files in a hidden folder of the directory, which is made if it is not there; the folder goes when the
/// object does, and when the process is interrupted.
class StagedDirectory {
 public:
  /// Throws UsageError (of --out) when the directory cannot be made or written to.
  explicit StagedDirectory(const std::string& directory);

  const std::filesystem::path& folder() const { return folder_->path(); }
  std::string path(const std::string& name) const { return (folder() / name).string(); }

  /// Moves everything into the directory and removes files of the names in `stale` that this run did not write. Throws
  /// UsageError, with nothing moved, when a directory stands where a file is to go.
  void commit(const std::vector<std::string>& stale) const;

 private:
  std::filesystem::path directory_;
  std::optional<golden::Temporary> folder_;
};

}  // namespace quadrille::tb
