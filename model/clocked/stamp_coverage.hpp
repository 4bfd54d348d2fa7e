#pragma once

#include "model/clocked/hierarchical_z.hpp"
#include "model/clocked/quad_slots.hpp"
#include "model/clocked/tile_ring.hpp"
#include "model/front/stamp_coverage.hpp"

#include <algorithm>
#include <array>

namespace quadrille::clocked {

/// An entry comes through three registers, then its rows through three.
struct StampCoverage {
  struct Row {
    bool valid = false;
    std::uint32_t pointer = 0;  ///< no row before this entry is still to come
    StampEntry stamp;

    bool push() const { return valid && (stamp.end || stamp.mask != 0); }
  };

  std::uint32_t fetch = 0, load = 0, rows = 0;  ///< next entry of each register; the rows' own while rows_valid
  bool tag_valid = false, context_valid = false, rows_valid = false;
  int row = 0;
  bool hidden = false;                 ///< nothing of the tile whose row was issued last can be seen
  static constexpr int wait_bits = 3;  ///< of a tile's x and y: those that are looked at to wait for one before it
  std::array<Row, 3> way{};            ///< rows on their way to the FIFO, the last one pushes
  int room = 0;                        ///< places of the FIFO that neither a stamp has nor a row on its way
  bool freed = false;                  ///< a stamp left the FIFO in the clock before

  /// The row that it is at.
  StampEntry work(const TileRing& ring, const QuadSlots& slots, HierarchicalZ& z, const PipelineContext& c) {
    const TileEntry& tile = ring.at(rows);
    StampEntry s;
    s.tile_ptr = rows;
    hidden = false;
    if (tile.end) {
      s.end = true;
      return s;
    }
    s.row = row;
    // The RTL writes what is held of the tile some clocks later; no tile reads it before that (waits).
    const bool hides = skips_hidden(c.config, c.state);
    if (hides && row == 0) z.masked.begin(tile.tile_x, tile.tile_y, slots[tile.slot].depth);
    hidden = hides && z.masked.hidden();
    if (hidden) return s;
    const StampMasks masks = stamp_coverage(tile, slots[tile.slot].constants, row, c.config, c.state);
    s.mask = hides ? z.masked.row(row, masks.mask) : masks.mask;
    s.front = masks.front & s.mask;
    s.tie = masks.tie & s.mask;
    if (hides && row == tile.last_row) z.masked.end();
    return s;
  }

  /// The tile in the tag register stays there: one before it that may lower what is held of the same place, or of one
  /// that has the same low bits, has not written yet.
  bool waits(const TileRing& ring, const QuadSlots& slots, const PipelineContext& c) const {
    if (!skips_hidden(c.config, c.state)) return false;
    const TileEntry& tile = ring.at(load);
    if (tile.end) return false;
    constexpr int low = (1 << wait_bits) - 1;
    const auto holds_up = [&](std::uint32_t pointer) {
      const TileEntry& before = ring.at(pointer);
      return !before.end && slots[before.slot].depth.lowers && ((before.tile_x ^ tile.tile_x) & low) == 0 &&
             ((before.tile_y ^ tile.tile_y) & low) == 0;
    };
    if (context_valid && holds_up(rows_valid ? ring.behind(rows) : rows)) return true;
    if (rows_valid && holds_up(rows)) return true;
    return std::ranges::any_of(way, [&](const Row& r) { return r.valid && holds_up(r.pointer); });
  }

  /// The edge; `pop`: emission takes the FIFO's head.
  void clock(bool pop, const TileRing& ring, const QuadSlots& slots, HierarchicalZ& z, const PipelineContext& c,
             PerformanceCounters& counters) {
    const bool left = way.back().valid, pushed = way.back().push();
    counters[PerformanceCounter::stamps] += pushed && !way.back().stamp.end;
    const bool stays = tag_valid && waits(ring, slots, c);
    const bool issue = rows_valid && room != 0;
    for (std::size_t n = way.size() - 1; n > 0; --n) way[n] = way[n - 1];
    way[0].valid = issue;
    way[0].pointer = rows;
    if (issue) way[0].stamp = work(ring, slots, z, c);
    if (issue && !way[0].stamp.end)
      ++counters[hidden ? PerformanceCounter::tiles_masked : PerformanceCounter::rows_tested];

    const bool rows_done = issue && (way[0].stamp.end || hidden || row == ring.at(rows).last_row);
    const bool rows_load = context_valid && (!rows_valid || rows_done);
    const bool loads = tag_valid && (!context_valid || rows_load) && !stays;
    const bool fetches = fetch != ring.complete && (!tag_valid || loads);
    if (rows_done) rows = ring.behind(rows);
    if (loads) load = ring.behind(load);
    if (fetches) fetch = ring.behind(fetch);
    row = rows_load ? 0 : row + (issue ? 1 : 0);
    rows_valid = rows_load || (rows_valid && !rows_done);
    context_valid = loads || (context_valid && !rows_load);
    tag_valid = fetches || (tag_valid && !loads);
    room += (freed ? 1 : 0) + (left && !pushed ? 1 : 0) - (issue ? 1 : 0);
    freed = pop;
  }
};

}  // namespace quadrille::clocked
