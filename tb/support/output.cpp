#include "tb/support/output.hpp"

#include "tb/support/errors.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace quadrille::cli {

void check_writable(const std::string& path) {
  if (path.empty() || path == "-") return;
  namespace fs = std::filesystem;
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) throw UsageError(path + ": is a directory; a file name is expected");
  if (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored)) return;  // a device or a pipe
  fs::path directory = fs::path(path).parent_path();
  if (directory.empty()) directory = ".";
  if (access(directory.c_str(), W_OK | X_OK) != 0)
    throw UsageError(path + ": cannot be written: " + directory.string() + ": " + std::strerror(errno));
}

void check_outputs(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs) {
  namespace fs = std::filesystem;
  // Devices take any number of writers.
  const auto same = [](const std::string& a, const std::string& b) {
    if (a.empty() || b.empty() || (a == "-") != (b == "-")) return false;
    if (a == "-") return true;
    std::error_code ignored;
    if (fs::exists(a, ignored) && !fs::is_regular_file(a, ignored)) return false;
    // Absolute first: the canonical form of a name that does not exist yet would stay relative.
    return fs::weakly_canonical(fs::absolute(a, ignored), ignored) ==
           fs::weakly_canonical(fs::absolute(b, ignored), ignored);
  };
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    check_writable(outputs[i]);
    for (std::size_t j = 0; j < i; ++j)
      if (same(outputs[i], outputs[j]))
        throw UsageError(outputs[i] + ": two outputs want this file; give each its own");
    for (const std::string& input : inputs)
      if (same(outputs[i], input))
        throw UsageError(outputs[i] + ": is an input of this command; write to another file");
  }
}

PartialFile::PartialFile(std::string path) : path_(std::move(path)) {
  if (active()) partial_ = path_ + ".partial-" + std::to_string(getpid());
}

PartialFile::~PartialFile() {
  if (active() && !committed_) std::remove(partial_.c_str());
}

void PartialFile::commit() {
  if (std::rename(partial_.c_str(), path_.c_str()) != 0)
    throw UsageError(path_ + ": cannot be written: " + std::strerror(errno));
  committed_ = true;
}

}  // namespace quadrille::cli
