// Output files: refused early where they cannot be written, and never half-written in place of an older one.
#pragma once

#include "golden/io/temporary.hpp"

#include <optional>
#include <string>
#include <vector>

namespace quadrille::tb {

/// Every output of a command: must be writable (golden::require_writable; done before long work, the writing itself
/// checks again), and is named as missing should the command be interrupted. Throws UsageError when two outputs, or an
/// output and an input, are one file, or when two outputs want standard output. Empty names are not given.
void check_outputs(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs);

/// A name to write to that becomes `path` on commit() and disappears otherwise, for writers that want a name.
class PartialFile {
 public:
  explicit PartialFile(std::string path);

  bool active() const { return !path_.empty(); }
  const std::string& path() const { return partial_; }
  void commit();

 private:
  std::string path_, target_, partial_;
  std::optional<golden::Temporary> folder_;
};

}  // namespace quadrille::tb
