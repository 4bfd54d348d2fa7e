#include "golden/io/atomic_file.hpp"

#include "golden/io/error.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iostream>

namespace quadrille::golden {
namespace {

constexpr std::size_t buffer_bytes = std::size_t{1} << 18;

std::string directory_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? "." : slash == 0 ? "/" : path.substr(0, slash);
}

}  // namespace

AtomicFile::AtomicFile(std::string path, Dash dash) : path_(std::move(path)), target_(path_) {
  buffer_.reserve(buffer_bytes);
  if (path_ == "-") {
    if (dash == Dash::refused)
      throw InputError("-: this format cannot go to standard output; the name of a file is expected");
    // Text that went through the C and C++ streams must come before ours.
    std::cout.flush();
    std::fflush(stdout);
    path_ = "standard output";
    fd_ = STDOUT_FILENO;
    owns_fd_ = false;
    return;
  }
  if (path_.empty()) throw InputError("output path is empty; the name of a file is expected");

  std::error_code ignored;
  if (std::filesystem::is_symlink(target_, ignored)) {
    std::error_code error;
    target_ = std::filesystem::weakly_canonical(target_, error).string();
    if (error) fail("follow the link", error.value());
  }
  struct stat old {};
  const bool exists = ::stat(target_.c_str(), &old) == 0;
  if (exists && S_ISDIR(old.st_mode)) fail("write", EISDIR);
  if (exists && !S_ISREG(old.st_mode)) {
    fd_ = ::open(target_.c_str(), O_WRONLY | O_CLOEXEC);
    if (fd_ < 0) fail("open", errno);
    return;
  }

  // Short and independent of the target's name, which may already have the greatest length.
  static std::atomic<unsigned> counter{0};
  for (;;) {
    const std::string candidate =
        directory_of(target_) + "/.quadrille-" + std::to_string(::getpid()) + "-" + std::to_string(counter++) + ".tmp";
    fd_ = ::open(candidate.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd_ >= 0) {
      temporary_ = candidate;
      break;
    }
    if (errno != EEXIST) fail("create a file beside it", errno);
  }
  if (exists && ::fchmod(fd_, old.st_mode & 07777) != 0) fail("keep its permissions", errno);
}

AtomicFile::~AtomicFile() { discard(); }

void AtomicFile::write(std::string_view bytes) {
  if (fd_ < 0) throw std::logic_error("AtomicFile::write after the end");
  if (buffer_.size() + bytes.size() > buffer_bytes) flush();
  if (bytes.size() < buffer_bytes) {
    buffer_.append(bytes);
  } else {
    write_through(bytes);  // large blocks go out without a copy
  }
  position_ += bytes.size();
}

void AtomicFile::flush() {
  write_through(buffer_);
  buffer_.clear();
}

void AtomicFile::write_through(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("write", errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void AtomicFile::seek(std::uint64_t position) {
  if (fd_ < 0) throw std::logic_error("AtomicFile::seek after the end");
  flush();
  if (::lseek(fd_, static_cast<off_t>(position), SEEK_SET) < 0) fail("seek", errno);
  position_ = position;
}

void AtomicFile::commit() {
  if (fd_ < 0) throw std::logic_error("AtomicFile::commit after the end");
  flush();
  if (!owns_fd_) {
    fd_ = -1;
    return;
  }
  // Without fsync a crash after the rename could leave an empty file in place of the older good one.
  if (!temporary_.empty() && ::fsync(fd_) != 0) fail("flush", errno);
  const int fd = fd_;
  fd_ = -1;
  if (::close(fd) != 0) fail("close", errno);
  if (temporary_.empty()) return;
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail("rename into place", errno);
  temporary_.clear();
}

void AtomicFile::discard() noexcept {
  if (fd_ >= 0 && owns_fd_) ::close(fd_);
  fd_ = -1;
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  temporary_.clear();
}

void AtomicFile::fail(const std::string& action, int error) {
  discard();
  throw InputError(path_ + ": cannot " + action + ": " + std::strerror(error) +
                   "; a path that can be written is expected");
}

void write_file(const std::string& path, std::string_view bytes, AtomicFile::Dash dash) {
  AtomicFile file(path, dash);
  file.write(bytes);
  file.commit();
}

}  // namespace quadrille::golden
