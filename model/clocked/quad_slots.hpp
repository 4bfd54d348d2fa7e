#pragma once

#include "model/fast/pixels_ahead.hpp"
#include "model/skips/hierarchical_z.hpp"

#include <cstdint>
#include <vector>

namespace quadrille::clocked {

/// The quads in flight, by slot.
struct QuadSlots {
  /// The back half's data and the front half's constants.
  struct Slot : PixelQuad {
    DepthInterval depth;
    std::size_t quad = 0;  ///< NumberedQuad::number
  };

  std::vector<Slot> slots;
  std::uint32_t alloc = 0;   ///< the slot that the next quad gets, once it is free
  std::uint32_t in_use = 0;  ///< bit i: slot i

  explicit QuadSlots(const Config& config) : slots(static_cast<std::size_t>(config.quad_slots())) {}
  void reset() { alloc = in_use = 0; }

  Slot& operator[](std::uint32_t slot) { return slots[slot]; }
  const Slot& operator[](std::uint32_t slot) const { return slots[slot]; }
  bool available() const { return (in_use >> alloc & 1) == 0; }

  /// The edge: a quad starts in slot `alloc`, those whose bits are set leave theirs. A slot is skipped while it is in
  /// use and another is not: quads that setup drops leave theirs before older ones do.
  void clock(bool start, std::uint32_t leaving) {
    const bool next = start || ((in_use >> alloc & 1) != 0 && in_use != (1u << slots.size()) - 1);
    in_use = (in_use & ~leaving) | (start ? 1u << alloc : 0);
    if (next) alloc = (alloc + 1) % static_cast<std::uint32_t>(slots.size());
  }
};

}  // namespace quadrille::clocked
