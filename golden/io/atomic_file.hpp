// Output files that are either complete or not there.
#pragma once

#include "golden/io/temporary.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace quadrille::golden {

/// Throws InputError when `path` cannot become a file: its folder is missing or not writable, it is a folder, it is
/// read-only (no write bit, whoever asks), or it is a symbolic link to nothing.
void require_writable(const std::string& path);

/// A file that appears under its name only when commit() succeeds: bytes go to a temporary file in the same directory,
/// which commit() flushes to the disk and renames. Without commit, on any failure and on an interruption the temporary
/// is removed and an older file of that name stays as it was. Every failure throws InputError with the path and the
/// system's reason.
///
/// An existing device or pipe is written to directly, since it cannot be replaced; so is standard output. A symbolic
/// link is followed.
class AtomicFile {
 public:
  enum class Dash { standard_output, refused };  ///< what the path "-" means

  AtomicFile(std::string path, Dash dash);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::string_view bytes);

  /// Byte offset of the next write, and moving it (files only).
  std::uint64_t tell() const { return position_; }
  void seek(std::uint64_t position);

  /// Makes the file appear; nothing can be written afterwards.
  void commit();

 private:
  void flush();
  void write_through(std::string_view bytes);
  void discard() noexcept;
  [[noreturn]] void fail(const std::string& action, int error);

  std::string path_;                    ///< as given, for messages
  std::string target_;                  ///< where it goes, links resolved
  std::optional<Temporary> temporary_;  ///< none: written directly
  int fd_ = -1;                         ///< the temporary's, a device's or standard output
  std::uint64_t position_ = 0;
  std::string buffer_;
};

/// Writes a whole file at once, as AtomicFile does.
void write_file(const std::string& path, std::string_view bytes, AtomicFile::Dash dash);

}  // namespace quadrille::golden
