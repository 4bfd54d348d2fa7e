// The waits of both ports one by one, where they are not drawn at random: of a run that fails they can be left out one
// after the other without moving those that stay.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::tb {

struct PortWaits {
  std::vector<std::uint64_t> stall_clocks;  ///< clocks from the end of reset in which fragment_ready is low, ascending
  std::vector<std::uint64_t> gap_beats;     ///< beats before which vertex_valid is low, one entry a clock, ascending

  bool empty() const { return stall_clocks.empty() && gap_beats.empty(); }
  bool operator==(const PortWaits&) const = default;
};

/// "17,40-43": clocks and ranges of them, ascending. Throws std::invalid_argument.
std::vector<std::uint64_t> parse_stall_clocks(std::string_view text);
std::string spell_stall_clocks(const std::vector<std::uint64_t>& clocks);

/// "5:2,9": two clocks before beat 5 (of all vertices, from 0), one before beat 9; ascending. Throws
/// std::invalid_argument.
std::vector<std::uint64_t> parse_gap_beats(std::string_view text);
std::string spell_gap_beats(const std::vector<std::uint64_t>& beats);

}  // namespace quadrille::tb
