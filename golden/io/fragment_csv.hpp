// Fragments as a table.
#pragma once

#include "model/port/records.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace quadrille::golden {

/// A fragment in real numbers, whichever engine it comes from.
struct FragmentRow {
  std::uint32_t quad = 0;
  std::uint16_t x = 0, y = 0;  ///< pixel
  bool front = false;
  std::uint32_t flags = 0;         ///< FragmentFlag bits
  std::array<double, 4> lambda{};  ///< weights, with perspective as in the draw state
  double z = 0;                    ///< window z
  std::array<double, max_attribute_slots> attribute{};
};

/// Columns that depend on the draw state.
struct FragmentColumns {
  std::vector<std::string> attributes;  ///< their names, at most max_attribute_slots
  bool depth = true;                    ///< off: z is left empty
};

/// Writes the line `quad,x,y,front,flags,l0,l1,l2,l3,z,…` with the attributes' names and a row per fragment, sorted by
/// quad, y, x (equal ones stay in the given order); front is 0 or 1; reals with 17 significant digits as %.17g writes
/// them. "-" is standard output. Throws InputError when writing fails; an older file then stays as it was.
void save_fragment_csv(const std::string& path, std::span<const FragmentRow> rows, const FragmentColumns& columns);

/// The same columns and rows as arrays for numpy.load(): quad and flags <u4, x and y <u2, front bool, reals <f8; z only
/// where there is depth. Throws as save_npz() does.
void save_fragment_npz(const std::string& path, std::span<const FragmentRow> rows, const FragmentColumns& columns);

}  // namespace quadrille::golden
