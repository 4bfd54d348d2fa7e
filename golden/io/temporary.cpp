#include "golden/io/temporary.hpp"

#include "golden/io/interrupt.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>
#include <vector>

namespace quadrille::golden {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view prefix = ".quadrille-", suffix = ".tmp";

[[noreturn]] void fail(int error, const std::string& what) {
  throw std::system_error(error, std::generic_category(), what);
}

bool same_file(int fd, const fs::path& path) {
  struct stat open {
  }, named{};
  return ::fstat(fd, &open) == 0 && ::lstat(path.c_str(), &named) == 0 && open.st_dev == named.st_dev &&
         open.st_ino == named.st_ino;
}

enum class Lock { taken, held_elsewhere, unknown };

Lock lock(int fd) {
  if (::flock(fd, LOCK_EX | LOCK_NB) == 0) return Lock::taken;
  return errno == EWOULDBLOCK ? Lock::held_elsewhere : Lock::unknown;  // some file systems have no locks
}

void remove_stale(const fs::path& parent) {
  std::error_code error;
  std::vector<fs::path> named;
  for (fs::directory_iterator entry(parent, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.starts_with(prefix) && name.ends_with(suffix)) named.push_back(entry->path());
  }
  for (const fs::path& path : named) {
    const int fd = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0) continue;
    // Its owner may have published it between the two.
    if (lock(fd) == Lock::taken && same_file(fd, path)) fs::remove_all(path, error);
    ::close(fd);
  }
}

}  // namespace

Temporary::Temporary(const fs::path& parent, Kind kind) {
  const fs::path place = fs::absolute(parent);  // an interruption may come from another directory
  remove_stale(place);
  static std::atomic<unsigned> counter{0};
  const std::string start = std::string(prefix) + std::to_string(::getpid()) + "-";
  for (;;) {
    path_ = place / (start + std::to_string(counter++) + std::string(suffix));
    int error = 0;
    bool made = false;
    without_interrupt([&] {
      if (kind == Kind::folder && ::mkdir(path_.c_str(), 0777) != 0) {
        error = errno;
        return;
      }
      made = kind == Kind::folder;
      fd_ = kind == Kind::folder ? ::open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)
                                 : ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (fd_ >= 0)
        remember_temporary(path_);
      else
        error = errno;
    });
    const bool swept = made && error == ENOENT;  // taken for a stale one before it was open
    if (fd_ >= 0 && lock(fd_) != Lock::held_elsewhere && same_file(fd_, path_)) return;
    if (fd_ >= 0) {  // taken for a stale one before the lock was there
      close();
      without_interrupt([&] { forget_temporary(path_); });
    } else if (error != EEXIST && !swept) {
      fail(error, "create a " + std::string(kind == Kind::file ? "file" : "folder") + " in " + parent.string());
    }
  }
}

Temporary::~Temporary() {
  if (!published_) {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
    without_interrupt([&] { forget_temporary(path_); });
  }
  close();
}

void Temporary::publish(const fs::path& target) {
  int error = 0;
  without_interrupt([&] {
    if (::rename(path_.c_str(), target.c_str()) != 0) {
      error = errno;
      return;
    }
    forget_temporary(path_);
    published_ = true;
  });
  if (error != 0) fail(error, "rename into place");
  close();
}

void Temporary::replace(const fs::path& target) {
  int error = 0;
  without_interrupt([&] {
    if (::renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, target.c_str(), RENAME_EXCHANGE) == 0) return;
    const fs::path old = path_.string() + ".old";
    if (::rename(target.c_str(), old.c_str()) != 0) {
      error = errno;
    } else if (::rename(path_.c_str(), target.c_str()) != 0) {
      error = errno;
      if (::rename(old.c_str(), target.c_str()) != 0) error = errno;
    } else if (::rename(old.c_str(), path_.c_str()) != 0) {
      error = errno;
    }
  });
  if (error != 0) fail(error, "replace");
  // Its name is the older folder's now, which goes with this object.
}

void Temporary::close() noexcept {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
}

}  // namespace quadrille::golden
