#pragma once

#include "model/clocked.hpp"
#include "model/port/latency.hpp"

#include <cstdint>
#include <vector>

namespace quadrille::clocked {

/// Entries of tiles between the walk and the pixels. A tile of a homogeneous quad takes one for each part of its
/// functions. Pointers have a bit more than there are entries.
struct TileRing {
  struct Entry : TileEntry {
    bool homogeneous = false;
  };

  std::vector<Entry> entries;
  std::uint32_t mask;          ///< of a pointer
  std::uint32_t write = 0;     ///< the next entry to write
  std::uint32_t complete = 0;  ///< the first one that coverage must not see yet
  std::uint32_t tail = 0;      ///< the first one in use
  bool completed = false;      ///< an entry became visible at the last edge: the one at last_completed
  std::uint32_t last_completed = 0;

  explicit TileRing(const Config& config)
      : entries(static_cast<std::size_t>(ring_entries(config))),
        mask(static_cast<std::uint32_t>(2 * ring_entries(config) - 1)) {}
  void reset() {
    write = complete = tail = 0;
    completed = false;
  }

  static std::uint32_t parts(bool homogeneous) { return homogeneous ? latency::homogeneous_parts : 1; }
  Entry& at(std::uint32_t pointer) { return entries[pointer & (entries.size() - 1)]; }
  const Entry& at(std::uint32_t pointer) const { return entries[pointer & (entries.size() - 1)]; }
  /// The pointer of the entry behind this one.
  std::uint32_t behind(std::uint32_t pointer) const { return (pointer + parts(at(pointer).homogeneous)) & mask; }
  bool room(bool homogeneous) const { return ((write - tail) & mask) + parts(homogeneous) <= entries.size(); }

  /// The edge; `completes`: tile_context has written all of an entry. An entry (or nullptr) comes in.
  void clock(bool completes, const TileEntry* push, bool homogeneous) {
    completed = completes;
    if (completed) {
      last_completed = complete;
      complete = behind(complete);
    }
    if (push != nullptr) {
      static_cast<TileEntry&>(at(write)) = *push;
      at(write).homogeneous = homogeneous;
      write = behind(write);
    }
  }
};

}  // namespace quadrille::clocked
