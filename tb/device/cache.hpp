// The cache of what is built on demand: simulators, Verilator's run time, syntheses.
//
// It is $QUADRILLE_CACHE, else $XDG_CACHE_HOME/quadrille, else $HOME/.cache/quadrille, else the build directory. An
// entry is a directory whose name is a hash over everything that decides its contents. It is built beside its place
// under a lock and renamed into it, so several programs may ask for one at the same time. Who builds or uses an entry
// holds a lock on its directory, so nobody removes it meanwhile. A cache that cannot be written serves what it has.
// A file of checksums lies in each entry. They are checked before the entry is used: a damaged entry is built again.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::tb {

/// FNV-1a, 128 bits, over length-prefixed pieces.
class Fingerprint {
 public:
  void add(std::string_view piece);
  void add_file(const std::filesystem::path& file);  ///< name and contents; throws SystemError when it cannot be read
  std::string hex() const;

 private:
  void byte(unsigned char b);
  unsigned __int128 hash_ = (static_cast<unsigned __int128>(0x6c62272e07bb0142u) << 64) | 0x62b821756295c58du;
};

/// Contents of a file; throws SystemError when it cannot be read.
std::string read_text(const std::filesystem::path& file);
/// Writes a file; throws SystemError when it cannot be written.
void write_text(const std::filesystem::path& file, std::string_view text);

/// The cache's directory; whether it exists is another question.
std::filesystem::path cache_directory();
/// The same, created if need be; throws SystemError when nothing can be written to it.
std::filesystem::path writable_cache_directory();

/// An entry that is in use as long as this or a copy of it lives.
class CacheEntry {
 public:
  const std::filesystem::path& path() const { return path_; }

 private:
  friend CacheEntry cached(const std::string&, const std::string&,
                           const std::function<void(const std::filesystem::path&)>&, const std::function<void(long)>&);
  std::filesystem::path path_;
  std::shared_ptr<const void> lock_;
};

/// Entry `name`. When the cache has none, `build(directory)` fills an empty directory; afterwards the entries that were
/// not used for longest go until the cache is within its limit. `description`, a line, says what it is. `waiting(pid)`
/// is called every second while another process (or thread) builds it. An entry whose files are not those that were
/// built is reported on standard error and built again. Throws what `build` throws, and SystemError when the cache
/// cannot be written, or a damaged entry cannot be replaced.
CacheEntry cached(const std::string& name, const std::string& description,
                  const std::function<void(const std::filesystem::path&)>& build,
                  const std::function<void(long)>& waiting = {});

struct CacheItem {
  std::string name, description;
  std::uintmax_t bytes = 0;
  std::chrono::system_clock::time_point used;  ///< last time
  bool in_use = false;
};

/// What the cache has, longest unused first; nothing when there is no cache.
std::vector<CacheItem> cache_items();

/// Removes every entry that is not in use, logs of failed builds and what stopped builds left; returns what was
/// removed.
std::vector<CacheItem> clear_cache();

/// Removes an entry, such as a damaged one, unless it is in use; whether it did.
bool remove_cached(const std::string& name);

/// $QUADRILLE_CACHE_SIZE: a number of bytes, with K, M or G of 1024, 1024² or 1024³ (default 1G); 0: no limit. Throws
/// SystemError for anything else.
std::uintmax_t cache_limit();

}  // namespace quadrille::tb
