// Where the untimed model's time goes: its stages in single-precision lanes, each measured by leaving out what follows.
#pragma once

#include "model/port/config.hpp"
#include "model/port/records.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace quadrille::tb {

/// Setup with what it leaves out; the walk over blocks and tiles; coverage with the list of pixels; the arithmetic of a
/// pixel with its fragment.
inline constexpr std::array<std::string_view, 4> stage_names{"setup", "walk", "coverage", "pixels"};

struct StageTimes {
  std::array<double, stage_names.size()> seconds{};  ///< CPU time, medians of `repeat` runs, taken from one another
  std::array<double, stage_names.size()> cycles{};   ///< the same of the time stamp counter; 0 where there is none
  std::uint64_t fragments = 0;
  std::uint64_t other_quads = 0;  ///< in none of these: not for lanes of single precision
};

/// Of quads drawn without hidden tiles.
StageTimes time_stages(std::span<const SnappedQuad> quads, const Config& config, const DrawState& state, int repeat);

}  // namespace quadrille::tb
