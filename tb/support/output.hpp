// Output files: refused early where they cannot be written, and never half-written in place of an older one.
#pragma once

#include <string>
#include <vector>

namespace quadrille::cli {

/// Throws UsageError when `path` (empty and "-" are fine) cannot become a file: its directory is missing or not
/// writable, or it is a directory itself. Done before long work; the writing itself checks again.
void check_writable(const std::string& path);

/// Every output of a command through check_writable(). Throws UsageError when two outputs, or an output and an input,
/// are one file, or when two outputs want standard output. Empty names are not given.
void check_outputs(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs);

/// A name to write to that becomes `path` on commit() and disappears otherwise, for writers that want a name.
class PartialFile {
 public:
  explicit PartialFile(std::string path);
  ~PartialFile();
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;

  bool active() const { return !path_.empty(); }
  const std::string& path() const { return partial_; }
  void commit();

 private:
  std::string path_, partial_;
  bool committed_ = false;
};

}  // namespace quadrille::cli
