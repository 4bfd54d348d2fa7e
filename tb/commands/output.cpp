#include "tb/commands/output.hpp"

#include "tb/commands/errors.hpp"

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
