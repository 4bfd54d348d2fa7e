// Files and folders on their way to their final place: gone unless published, also when the process is interrupted;
// those of a process that was killed go when the next temporary is made beside them.
#pragma once

#include <filesystem>

namespace quadrille::golden {

/// A new file or folder `.quadrille-PID-N.tmp` in the folder of its final place, locked for as long as it is being
/// written: what has such a name and no lock was left by a killed process.
class Temporary {
 public:
  enum class Kind { file, folder };

  /// Removes what killed processes left in `parent`, then makes a new one there, with the permissions of the umask. A
  /// relative `parent` is meant from the current directory. Throws std::system_error.
  Temporary(const std::filesystem::path& parent, Kind kind);
  ~Temporary();
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;

  const std::filesystem::path& path() const { return path_; }
  int descriptor() const { return fd_; }  ///< of a file, for writing; closed by this object

  /// Gives it its final name on the same file system, in one step: over an older file, or where there is no folder or
  /// an empty one. Throws std::system_error and leaves both as they are when that fails.
  void publish(const std::filesystem::path& target);

  /// The same for a folder over an older one, which is removed. Where the file system cannot exchange two names, the
  /// older one is set aside as PATH.old for a moment.
  void replace(const std::filesystem::path& target);

 private:
  void close() noexcept;

  std::filesystem::path path_;
  int fd_ = -1;
  bool published_ = false;
};

}  // namespace quadrille::golden
