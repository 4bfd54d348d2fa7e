// Skips that must not change a fragment, against draws that skip nothing.
#pragma once

#include "model/port/config.hpp"
#include "model/port/records.hpp"
#include "tb/support/work_queue.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace quadrille::tb {

struct SkipResult {
  std::uint64_t compared = 0;     ///< fragments of the draw that skips nothing, once for each draw compared with it
  std::uint64_t differences = 0;  ///< quads with other fragments, in all draws compared
  std::string first;              ///< the first of them in words; empty: none

  void merge(const SkipResult& other);
};

/// Draws quads in the model without any of the skips that keep the list of fragments (skip_default), with each of them
/// alone, and with those of the draw state; and holds all of them, and what the machine drew, against the first.
class SkipCheck {
 public:
  SkipCheck(const Config& config, const DrawState& state, std::size_t quads);

  /// A fragment that the machine drew; its quad is a position in the draw.
  void fragment(const Fragment& fragment);
  /// Draws the first `quads` of `snapped` on the queue's threads; `complete`: the machine drew all of them to their
  /// end.
  SkipResult compare(std::span<const SnappedQuad> snapped, std::size_t quads, bool complete, WorkQueue& queue) const;

 private:
  Config config_;
  DrawState state_;
  bool hides_;                        ///< the machine leaves out what is hidden: its list is another
  std::vector<std::uint64_t> drawn_;  ///< a hash for each quad
  std::size_t last_ = 0;
};

}  // namespace quadrille::tb
