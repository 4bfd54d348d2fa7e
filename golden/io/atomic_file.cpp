#include "golden/io/atomic_file.hpp"

#include "golden/io/error.hpp"
#include "golden/io/interrupt.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace quadrille::golden {
namespace {

constexpr std::size_t buffer_bytes = std::size_t{1} << 18;

std::string directory_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? "." : slash == 0 ? "/" : path.substr(0, slash);
}

}  // namespace

void require_writable(const std::string& path) {
  namespace fs = std::filesystem;
  if (path.empty()) throw InputError("output path is empty; a file name is expected");
  const auto refuse = [&](const std::string& reason) {
    throw InputError(path + ": cannot be written: " + reason + "; a path that can be written is expected");
  };
  struct stat named {};
  if (::stat(path.c_str(), &named) == 0) {
    if (S_ISDIR(named.st_mode)) refuse(std::strerror(EISDIR));
    if (!S_ISREG(named.st_mode)) return;  // a device or a pipe
    if ((named.st_mode & 0222) == 0) refuse("the file is read-only");
    if (::access(path.c_str(), W_OK) != 0) refuse(std::strerror(errno));
  } else if (errno != ENOENT) {
    refuse(std::strerror(errno));
  }
  std::error_code error;
  std::string target = path;
  if (fs::is_symlink(path, error)) {
    target = fs::canonical(path, error).string();
    if (error) refuse("it is a symbolic link to " + fs::read_symlink(path, error).string() + ", which does not exist");
  }
  const std::string directory = directory_of(target);
  if (::access(directory.c_str(), W_OK | X_OK) != 0) refuse(directory + ": " + std::strerror(errno));
}

AtomicFile::AtomicFile(std::string path, Dash dash) : path_(std::move(path)), target_(path_) {
  buffer_.reserve(buffer_bytes);
  if (path_ == "-") {
    if (dash == Dash::refused)
      throw InputError("-: this format cannot go to standard output; the name of a file is expected");
    std::fflush(stdout);  // text that went through the stream, std::cout's too, must come before ours
    path_ = "standard output";
    fd_ = STDOUT_FILENO;
    return;
  }
  require_writable(path_);
  std::error_code error;
  if (std::filesystem::is_symlink(target_, error)) {
    target_ = std::filesystem::canonical(target_, error).string();
    if (error) fail("follow the link", error.value());
  }
  struct stat old {};
  const bool exists = ::stat(target_.c_str(), &old) == 0;
  if (exists && !S_ISREG(old.st_mode)) {
    fd_ = ::open(target_.c_str(), O_WRONLY | O_CLOEXEC);
    if (fd_ < 0) fail("open", errno);
    return;
  }
  try {
    temporary_.emplace(directory_of(target_), Temporary::Kind::file);
  } catch (const std::system_error& failure) {
    fail("create a file beside it", failure.code().value());
  }
  fd_ = temporary_->descriptor();
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
  if (temporary_) {
    // Without fsync a crash after the rename could leave an empty file in place of the older good one.
    if (::fsync(fd_) != 0) fail("flush", errno);
    try {
      temporary_->publish(target_);
    } catch (const std::system_error& failure) {
      fail("rename into place", failure.code().value());
    }
    temporary_.reset();
  } else if (fd_ != STDOUT_FILENO && ::close(fd_) != 0) {
    fd_ = -1;
    fail("close", errno);
  }
  fd_ = -1;
  output_written(path_);
}

void AtomicFile::discard() noexcept {
  if (!temporary_ && fd_ >= 0 && fd_ != STDOUT_FILENO) ::close(fd_);
  fd_ = -1;
  temporary_.reset();
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
