#include "tb/lockstep/port_waits.hpp"

#include <charconv>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <utility>

namespace quadrille::tb {

namespace {

constexpr std::uint64_t most_entries = 10'000'000;  // a slip of the hand must not take all memory

/// A number and, behind `mark`, a second one, of each piece between commas, for `add`, which says whether it is good.
template <class Add>
void parse_pieces(std::string_view text, char mark, const char* expected, Add&& add) {
  const auto refuse = [&] {
    throw std::invalid_argument("\"" + std::string(text) + "\": expected " + expected + ", ascending");
  };
  const char *at = text.data(), *const end = at + text.size();
  for (;;) {
    std::uint64_t first = 0, second = 0;
    auto [behind, error] = std::from_chars(at, end, first);
    if (error != std::errc{}) refuse();
    bool has_second = false;
    if (behind != end && *behind == mark) {
      const auto [last, bad] = std::from_chars(behind + 1, end, second);
      if (bad != std::errc{}) refuse();
      behind = last;
      has_second = true;
    }
    if (!add(first, has_second ? std::optional(second) : std::nullopt)) refuse();
    if (behind == end) return;
    if (*behind != ',') refuse();
    at = behind + 1;
  }
}

/// Pieces of equal or, with `step` 1, consecutive entries: f(first, how many).
template <class F>
void for_each_run(const std::vector<std::uint64_t>& entries, std::uint64_t step, F&& f) {
  for (std::size_t at = 0, end = 0; at < entries.size(); at = end) {
    for (end = at + 1; end < entries.size() && entries[end] == entries[end - 1] + step;) ++end;
    f(entries[at], end - at);
  }
}

}  // namespace

std::vector<std::uint64_t> parse_stall_clocks(std::string_view text) {
  std::vector<std::uint64_t> clocks;
  parse_pieces(text, '-', "clocks as in 17,40-43", [&](std::uint64_t first, std::optional<std::uint64_t> second) {
    const std::uint64_t last = second.value_or(first);
    if (last < first || last - first >= most_entries - clocks.size()) return false;
    if (!clocks.empty() && first <= clocks.back()) return false;
    for (std::uint64_t count = last - first + 1; count-- > 0;) clocks.push_back(first++);
    return true;
  });
  return clocks;
}

std::string spell_stall_clocks(const std::vector<std::uint64_t>& clocks) {
  std::string text;
  for_each_run(clocks, 1, [&](std::uint64_t first, std::size_t count) {
    text += (text.empty() ? "" : ",") + std::to_string(first);
    if (count > 1) text += "-" + std::to_string(first + count - 1);
  });
  return text;
}

std::vector<std::uint64_t> parse_gap_beats(std::string_view text) {
  std::vector<std::uint64_t> beats;
  parse_pieces(text, ':', "beats as in 5:2,9", [&](std::uint64_t beat, std::optional<std::uint64_t> clocks) {
    const std::uint64_t count = clocks.value_or(1);
    if (count == 0 || count > most_entries - beats.size()) return false;
    if (!beats.empty() && beat <= beats.back()) return false;
    beats.insert(beats.end(), count, beat);
    return true;
  });
  return beats;
}

std::string spell_gap_beats(const std::vector<std::uint64_t>& beats) {
  std::string text;
  for_each_run(beats, 0, [&](std::uint64_t beat, std::size_t clocks) {
    text += (text.empty() ? "" : ",") + std::to_string(beat);
    if (clocks > 1) text += ":" + std::to_string(clocks);
  });
  return text;
}

}  // namespace quadrille::tb
