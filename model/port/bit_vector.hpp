// Records of the machine's ports as the words that a simulator has: 32 bits each, least significant word first.
#pragma once

#include "model/port/boundaries.hpp"

#include <bit>
#include <cstdint>
#include <vector>

namespace quadrille::tb {

static_assert(std::endian::native == std::endian::little, "64-bit writes are read back as 32-bit words");

constexpr std::size_t words_for(int width) { return static_cast<std::size_t>((width + 31) / 32); }

std::vector<std::uint32_t> pack_state(const DrawState& state, const Config& config);

/// Packs into `words` (see BitPacker for its size).
void pack_fragment(const Fragment& fragment, const Config& config, std::uint64_t* words, int width);
Fragment unpack_fragment(const std::uint32_t* words, int width, const Config& config);

}  // namespace quadrille::tb
