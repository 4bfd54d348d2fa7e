#include "tb/device/cache.hpp"

#include "golden/io/interrupt.hpp"
#include "golden/io/temporary.hpp"
#include "tb/device/build_notice.hpp"
#include "tb/support/environment_error.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <system_error>
#include <thread>
#include <utility>

namespace quadrille::tb {

namespace fs = std::filesystem;

namespace {

constexpr const char* description_file = "description.txt";
constexpr const char* checksum_file = "checksums.txt";

std::string variable(const char* name) {
  const char* text = std::getenv(name);
  return text == nullptr ? "" : text;
}

/// A file or directory with a lock on it, held for the scope. Locks of threads of one process exclude one another too.
class Locked {
 public:
  /// nullopt with errno when it cannot be opened or locked: EWOULDBLOCK when `operation` has LOCK_NB and another holds
  /// it, ESTALE when it was removed meanwhile. To read, a file system without locks will do.
  static std::optional<Locked> open(const fs::path& path, int flags, int operation) {
    const int descriptor = ::open(path.c_str(), flags | O_CLOEXEC, 0644);
    if (descriptor < 0) return std::nullopt;
    Locked locked(descriptor);
    if (!locked.lock(operation) && operation != LOCK_SH) return std::nullopt;
    if (locked.is(path)) return locked;
    errno = ESTALE;
    return std::nullopt;
  }
  Locked(Locked&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  Locked& operator=(Locked&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  ~Locked() {
    if (descriptor_ >= 0) close(descriptor_);
  }

  bool lock(int operation) const {
    int result = 0;
    do result = flock(descriptor_, operation);
    while (result != 0 && errno == EINTR);
    return result == 0;
  }
  /// The path still leads to this file.
  bool is(const fs::path& path) const {
    struct stat here {
    }, there{};
    return fstat(descriptor_, &here) == 0 && stat(path.c_str(), &there) == 0 && here.st_ino == there.st_ino &&
           here.st_dev == there.st_dev;
  }
  int descriptor() const { return descriptor_; }

 private:
  explicit Locked(int descriptor) : descriptor_(descriptor) {}
  int descriptor_;
};

/// The entry in use, or nothing when there is none.
std::optional<Locked> use(const fs::path& place) {
  for (;;) {
    std::optional<Locked> entry = Locked::open(place, O_RDONLY | O_DIRECTORY, LOCK_SH);
    if (!entry && errno == ESTALE) continue;
    if (entry && access(place.c_str(), W_OK) == 0) futimens(entry->descriptor(), nullptr);  // used now
    return entry;
  }
}

/// The lock under which an entry is built; its file holds the builder's process id.
Locked lock_for_building(const fs::path& file, const std::function<void(long)>& waiting) {
  for (;;) {
    if (std::optional<Locked> lock = Locked::open(file, O_RDWR | O_CREAT, LOCK_EX | LOCK_NB)) {
      const std::string pid = std::to_string(getpid());
      if (ftruncate(lock->descriptor(), 0) != 0 || pwrite(lock->descriptor(), pid.data(), pid.size(), 0) < 0)
        throw SystemError("cannot write " + file.string() + ": " + std::strerror(errno));
      return std::move(*lock);
    }
    if (errno == ESTALE) continue;  // its holder has finished
    if (errno != EWOULDBLOCK) throw SystemError("cannot write " + file.string() + ": " + std::strerror(errno));
    long pid = 0;
    std::ifstream(file) >> pid;
    if (waiting) waiting(pid);
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
}

std::uintmax_t size_of(const fs::path& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) return fs::file_size(path, error);
  std::uintmax_t bytes = 0;
  for (auto entry = fs::recursive_directory_iterator(path, error);
       !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    std::error_code vanished;
    if (const std::uintmax_t size = entry->file_size(vanished); !vanished && entry->is_regular_file(vanished))
      bytes += size;
  }
  return bytes;
}

/// Locks and unfinished work (golden::Temporary) are no entries; logs of failed builds are files.
bool is_item(const fs::path& path) {
  const std::string name = path.filename().string();
  return !name.starts_with(".") && !name.ends_with(".lock") && name.find('-') != std::string::npos;
}

/// Removes an entry unless somebody uses it.
bool remove_unused(const fs::path& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) return fs::remove(path, error);
  const std::optional<Locked> lock = Locked::open(path, O_RDONLY | O_DIRECTORY, LOCK_EX | LOCK_NB);
  if (!lock) return false;
  // First out of sight, so that nobody meets half an entry, under a name that is swept if this process is killed.
  const fs::path away = path.parent_path() / (".quadrille-" + path.filename().string() + ".tmp");
  fs::rename(path, away, error);
  if (error) return false;
  fs::remove_all(away, error);
  return !error;
}

/// Locks of builds whose process is gone.
void sweep_locks(const fs::path& cache) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(cache, error)) {
    if (entry.path().extension() == ".lock" && Locked::open(entry.path(), O_RDONLY, LOCK_EX | LOCK_NB))
      fs::remove(entry.path(), error);
  }
}

/// The file of a lock that this process holds: gone at the end of the scope, and when the process is interrupted. Who
/// waits for the lock looks again.
class LockFile {
 public:
  explicit LockFile(fs::path path) : path_(std::move(path)) {
    golden::without_interrupt([&] { golden::remember_temporary(path_); });
  }
  ~LockFile() {
    golden::without_interrupt([&] {
      std::error_code ignored;
      fs::remove(path_, ignored);
      golden::forget_temporary(path_);
    });
  }
  LockFile(const LockFile&) = delete;
  LockFile& operator=(const LockFile&) = delete;

 private:
  const fs::path path_;
};

/// 64 bits over a file's bytes, and their number: quick, for it is looked at before every use.
std::string checksum(const fs::path& file) {
  std::string text(fs::file_size(file), '\0');
  std::ifstream in(file, std::ios::binary);
  if (!in.read(text.data(), static_cast<std::streamsize>(text.size())))
    throw SystemError("cannot read " + file.string());
  constexpr std::uint64_t prime = 0x9e3779b97f4a7c15u;
  std::uint64_t hash = text.size();
  for (std::size_t at = 0; at < text.size(); at += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, text.data() + at, std::min(sizeof word, text.size() - at));
    hash = (hash ^ word) * prime;
    hash ^= hash >> 32;
  }
  char line[64];
  std::snprintf(line, sizeof line, "%016llx %zu", static_cast<unsigned long long>(hash), text.size());
  return line;
}

/// A line for each file of an entry: checksum, bytes, name.
std::string checksums(const fs::path& entry) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& file : fs::recursive_directory_iterator(entry))
    if (file.is_regular_file() && file.path().filename() != checksum_file) files.push_back(file.path());
  std::sort(files.begin(), files.end());
  std::string text;
  for (const fs::path& file : files) text += checksum(file) + " " + file.lexically_relative(entry).string() + "\n";
  return text;
}

/// Why an entry is not what was built; empty: it is.
std::string damage(const fs::path& entry) {
  try {
    if (!fs::exists(entry / checksum_file)) return "it has no checksums";
    const std::string kept = read_text(entry / checksum_file), found = checksums(entry);
    if (kept == found) return {};
    std::istringstream lines(found);
    for (std::string line; std::getline(lines, line);)
      if (kept.find(line + "\n") == kept.npos)
        return line.substr(line.find(' ', line.find(' ') + 1) + 1) + " has other bytes than were written";
    return "a file is missing";
  } catch (const std::exception& error) {
    return error.what();
  }
}

void trim(const fs::path& cache) {
  const std::uintmax_t limit = cache_limit();
  if (limit == 0) return;
  const std::vector<CacheItem> items = cache_items();
  std::uintmax_t total = 0;
  for (const CacheItem& item : items) total += item.bytes;
  for (const CacheItem& item : items) {
    if (total <= limit) return;
    if (!item.in_use && remove_unused(cache / item.name)) total -= item.bytes;
  }
}

}  // namespace

void Fingerprint::byte(unsigned char b) {
  constexpr unsigned __int128 prime = (static_cast<unsigned __int128>(1) << 88) | 0x13bu;
  hash_ = (hash_ ^ b) * prime;
}

void Fingerprint::add(std::string_view piece) {
  for (std::uint64_t length = piece.size(), i = 0; i < 8; ++i) byte(static_cast<unsigned char>(length >> (8 * i)));
  for (const char c : piece) byte(static_cast<unsigned char>(c));
}

void Fingerprint::add_file(const fs::path& file) {
  add(file.filename().string());
  add(read_text(file));
}

std::string Fingerprint::hex() const {
  std::string text;
  for (int shift = 124; shift >= 0; shift -= 4) text += "0123456789abcdef"[static_cast<unsigned>(hash_ >> shift) & 15u];
  return text;
}

std::string read_text(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw SystemError("cannot read " + file.string() + ": " + std::strerror(errno));
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

void write_text(const fs::path& file, std::string_view text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  if (!out) throw SystemError("cannot write " + file.string() + ": " + std::strerror(errno));
}

fs::path cache_directory() {
  fs::path directory = QUADRILLE_FALLBACK_CACHE_DIR;
  if (const std::string cache = variable("QUADRILLE_CACHE"); !cache.empty()) {
    directory = cache;
  } else if (const std::string xdg = variable("XDG_CACHE_HOME"); !xdg.empty()) {
    directory = fs::path(xdg) / "quadrille";
  } else if (const std::string home = variable("HOME"); !home.empty()) {
    directory = fs::path(home) / ".cache" / "quadrille";
  }
  return fs::absolute(directory);
}

fs::path writable_cache_directory() {
  const fs::path directory = cache_directory();
  std::error_code error;
  fs::create_directories(directory, error);
  if (error || access(directory.c_str(), W_OK) != 0) {
    throw SystemError("cannot write to the cache directory " + directory.string() +
                      "; set QUADRILLE_CACHE to a directory that can be written");
  }
  return directory;
}

std::uintmax_t cache_limit() {
  const std::string text = variable("QUADRILLE_CACHE_SIZE");
  if (text.empty()) return std::uintmax_t{1} << 30;
  std::uintmax_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string unit(end, text.data() + text.size());
  const int shift = unit == "K" ? 10 : unit == "M" ? 20 : unit == "G" ? 30 : 0;
  if (error != std::errc{} || (shift == 0 && !unit.empty()) || value > UINTMAX_MAX >> shift)
    throw SystemError("QUADRILLE_CACHE_SIZE: expected bytes, or a number with K, M or G (0: no limit), not '" + text +
                      "'");
  return value << shift;
}

CacheEntry cached(const std::string& name, const std::string& description,
                  const std::function<void(const fs::path&)>& build, const std::function<void(long)>& waiting) {
  CacheEntry found;
  found.path_ = cache_directory() / name;
  const auto in_use = [&] {
    if (std::optional<Locked> lock = use(found.path_)) found.lock_ = std::make_shared<const Locked>(std::move(*lock));
    return found.lock_ != nullptr;
  };
  // What is damaged goes, out of the hands of this process first.
  const auto good = [&] {
    const std::string why = damage(found.path_);
    if (why.empty()) return true;
    found.lock_.reset();
    BuildNotice::say("damaged cache entry of " + description + ", built again: " + (found.path_ / "").string() + ": " +
                     why);
    if (!remove_unused(found.path_) && fs::exists(found.path_))
      throw SystemError("cannot remove the damaged cache entry " + found.path_.string() +
                        ": it is in use or not writable");
    return false;
  };
  if (in_use() && good()) return found;

  const fs::path cache = writable_cache_directory();
  cache_limit();  // refused before the work
  const fs::path lock_file = cache / (name + ".lock");
  const Locked building = lock_for_building(lock_file, waiting);
  const LockFile file(lock_file);
  if (in_use() && good()) return found;  // another process was faster
  sweep_locks(cache);
  try {
    do {  // again, should somebody remove it before it is in use
      golden::Temporary work(cache, golden::Temporary::Kind::folder);
      build(work.path());
      write_text(work.path() / description_file, description + "\n");
      write_text(work.path() / checksum_file, checksums(work.path()));
      work.publish(found.path_);
    } while (!in_use());
  } catch (const std::system_error& error) {
    throw SystemError("cannot write to the cache directory " + cache.string() + ": " + error.code().message());
  }
  trim(cache);
  return found;
}

std::vector<CacheItem> cache_items() {
  std::vector<CacheItem> items;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(cache_directory(), error)) {
    if (!is_item(entry.path())) continue;
    CacheItem item;
    item.name = entry.path().filename().string();
    struct stat status {};
    if (stat(entry.path().c_str(), &status) != 0) continue;  // removed meanwhile
    item.used = std::chrono::system_clock::from_time_t(status.st_mtim.tv_sec) +
                std::chrono::duration_cast<std::chrono::system_clock::duration>(
                    std::chrono::nanoseconds(status.st_mtim.tv_nsec));
    item.bytes = size_of(entry.path());
    if (entry.is_directory(error)) {
      std::ifstream text(entry.path() / description_file);
      std::getline(text, item.description);
      item.in_use = !Locked::open(entry.path(), O_RDONLY | O_DIRECTORY, LOCK_EX | LOCK_NB);
    }
    items.push_back(std::move(item));
  }
  std::sort(items.begin(), items.end(), [](const CacheItem& a, const CacheItem& b) {
    return a.used != b.used ? a.used < b.used : a.name < b.name;
  });
  return items;
}

bool remove_cached(const std::string& name) { return remove_unused(cache_directory() / name); }

std::vector<CacheItem> clear_cache() {
  const fs::path cache = cache_directory();
  if (!fs::exists(cache)) return {};
  writable_cache_directory();
  std::vector<CacheItem> items = cache_items();
  std::erase_if(items, [&](const CacheItem& item) { return item.in_use || !remove_unused(cache / item.name); });
  sweep_locks(cache);
  const golden::Temporary sweeps(cache, golden::Temporary::Kind::folder);  // what killed builds left
  return items;
}

}  // namespace quadrille::tb
