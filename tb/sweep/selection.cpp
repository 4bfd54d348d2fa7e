#include "tb/sweep/selection.hpp"

#include <algorithm>
#include <charconv>
#include <map>
#include <set>

namespace quadrille::sweep {
namespace {

constexpr std::size_t default_count = 8;

/// Collects rows once each.
class Collector {
 public:
  explicit Collector(const Candidates& candidates) : candidates_(candidates) {}

  bool available(std::size_t row) const { return std::ranges::binary_search(candidates_.rows, row); }
  void add(std::size_t row, const char* why) {
    if (available(row) && taken_.insert(row).second) selected_.push_back({row, why});
  }
  void add(std::span<const std::size_t> rows, const char* why) {
    for (const std::size_t row : rows) add(row, why);
  }
  std::size_t size() const { return selected_.size(); }
  std::vector<Selected> take() {
    std::ranges::sort(selected_, {}, &Selected::row);
    return std::move(selected_);
  }

 private:
  const Candidates& candidates_;
  std::set<std::size_t> taken_;
  std::vector<Selected> selected_;
};

std::size_t row_number(std::string_view text, const Candidates& candidates) {
  std::size_t row = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), row);
  if (error != std::errc{} || end != text.data() + text.size())
    throw ConfigError(
        "\"" + std::string(text) +
        "\" selects nothing; expected all, none, pareto, corners, default, knees, or row numbers such as 3,7,10-12");
  if (row >= candidates.grid.size())
    throw ConfigError("row " + std::to_string(row) + " is not in the grid, whose rows are 0 to " +
                      std::to_string(candidates.grid.size() - 1));
  return row;
}

void add_rows(std::string_view word, const Candidates& candidates, Collector& into) {
  const std::size_t dash = word.find('-');
  const std::size_t first = row_number(word.substr(0, dash), candidates);
  const std::size_t last = dash == std::string_view::npos ? first : row_number(word.substr(dash + 1), candidates);
  if (first > last) throw ConfigError("\"" + std::string(word) + "\": an empty range of rows");
  for (std::size_t row = first; row <= last; ++row) {
    if (!into.available(row)) throw ConfigError("row " + std::to_string(row) + " was refused or not evaluated");
    into.add(row, "row");
  }
}

}  // namespace

std::vector<std::size_t> corners(const Grid& grid) {
  const std::vector<Axis>& axes = grid.axes();
  std::vector<std::size_t> rows;
  if (grid.kind() == Grid::Kind::one_at_a_time) {
    for (const Axis& axis : axes) {
      std::map<int, std::size_t> row_of;  // by the value that "auto" stands for
      for (std::uint64_t row = 0; row < grid.size(); ++row) {
        const int value = grid.point(row).config.resolved(axis.key);
        if (value != grid.base().resolved(axis.key)) row_of.emplace(value, row);
      }
      row_of.emplace(grid.base().resolved(axis.key), grid.size());
      for (const std::size_t row : {row_of.begin()->second, row_of.rbegin()->second})
        if (row < grid.size()) rows.push_back(row);
    }
    std::ranges::sort(rows);
    return rows;
  }
  // Mixed radix, last axis fastest; an axis of one value has one end.
  rows.push_back(0);
  for (const Axis& axis : axes) {
    std::vector<std::size_t> next;
    for (const std::size_t row : rows) {
      next.push_back(row * axis.values.size());
      if (axis.values.size() > 1) next.push_back(row * axis.values.size() + axis.values.size() - 1);
    }
    rows = std::move(next);
  }
  return rows;
}

std::size_t base_row(const Grid& grid) {
  const Config base = resolved(grid.base());
  for (std::uint64_t row = 0; row < grid.size(); ++row)
    if (resolved(grid.point(row).config) == base) return row;
  return grid.size();
}

std::vector<Selected> default_selection(const Candidates& candidates) {
  Collector into(candidates);
  into.add(base_row(candidates.grid), "default");
  into.add(candidates.knees.first(std::min<std::size_t>(3, candidates.knees.size())), "knee");
  std::vector<std::size_t> ends = corners(candidates.grid);
  std::erase_if(ends, [&](std::size_t row) { return !into.available(row); });
  if (!ends.empty()) {
    into.add(ends.front(), "corner");
    into.add(ends.back(), "corner");
    const std::size_t room = default_count - into.size();
    for (std::size_t i = 1; i <= room; ++i) into.add(ends[i * (ends.size() - 1) / (room + 1)], "corner");
  }
  return into.take();
}

std::vector<Selected> select_points(std::string_view text, const Candidates& candidates) {
  Collector into(candidates);
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    const std::string_view word = text.substr(begin, comma - begin);
    begin = comma + 1;
    if (word == "none") continue;
    if (word == "all")
      into.add(candidates.rows, "all");
    else if (word == "pareto")
      into.add(candidates.front, "pareto");
    else if (word == "knees")
      into.add(candidates.knees, "knee");
    else if (word == "corners")
      into.add(corners(candidates.grid), "corner");
    else if (word == "default")
      into.add(base_row(candidates.grid), "default");
    else
      add_rows(word, candidates, into);
  }
  return into.take();
}

}  // namespace quadrille::sweep
