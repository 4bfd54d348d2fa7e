// Which points of a sweep are synthesised or co-simulated.
#pragma once

#include "tb/sweep/grid.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::sweep {

/// What a selection can choose from.
struct Candidates {
  const Grid& grid;
  std::span<const std::size_t> rows;   ///< evaluated and not refused, rising
  std::span<const std::size_t> front;  ///< rows of the Pareto front
  std::span<const std::size_t> knees;  ///< rows
};

struct Selected {
  std::size_t row = 0;
  std::string why;  ///< "corner", "default", "knee", "pareto", "all", "row"
};

/// `text`: "all", "none", "pareto", "corners", "default" (the base), "knees", row numbers and ranges "3,7,10-12", or
/// several of these with commas. Each row once, in rising order; the first reason counts. Throws ConfigError: unknown
/// word, row that is not in the grid, was refused or was not evaluated.
std::vector<Selected> select_points(std::string_view text, const Candidates& candidates);

/// The base, the knees and as many corners as make 8 in all: the lowest and the highest first, the others evenly.
std::vector<Selected> default_selection(const Candidates& candidates);

/// Full grid: every axis at its first or last value. One at a time: one axis at its smallest or largest value.
std::vector<std::size_t> corners(const Grid& grid);

/// The row of the base configuration, or the grid's size where the grid does not contain it.
std::size_t base_row(const Grid& grid);

}  // namespace quadrille::sweep
