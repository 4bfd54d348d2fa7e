// A contact sheet: pictures in labelled columns and rows, for looking at several methods side by side.
#pragma once

#include "golden/io/png.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace quadrille::compare {

struct SheetCell {
  golden::Image8 picture;
  std::string caption;  ///< a line below the picture; may be empty
};

struct SheetRow {
  std::string label;
  std::vector<std::optional<SheetCell>> cells;  ///< one per column; an empty one stays blank
};

/// A colour and what it stands for, for the legend.
struct SheetKey {
  std::array<std::uint8_t, 3> colour{};
  std::string text;
};

/// Colours of golden::heat_colour from most·2^-octaves to `most`.
struct SheetScale {
  std::string text;  ///< what is coloured, and its unit
  double most = 1;
  int octaves = 0;
};

struct Sheet {
  std::string title, subtitle;
  std::vector<std::string> columns;
  std::vector<SheetRow> rows;
  std::vector<SheetScale> scales;
  std::vector<SheetKey> keys;
};

/// Columns of this width that fit a sheet; the drawing library takes pictures of 32767 pixels at most.
int most_columns(int cell_width);

/// Lays the sheet out with pictures `cell_width` pixels wide, less where they would be more than twice as high (larger
/// ones are reduced, smaller ones enlarged without smoothing). Text that does not fit is cut with an ellipsis. Throws
/// std::runtime_error for more than most_columns().
golden::Image8 draw_sheet(const Sheet& sheet, int cell_width);

/// Sheet pixels a pixel of a picture of this size.
double sheet_scale(int width, int height, int cell_width);

/// Points in pixels of a picture.
struct Polyline {
  std::vector<std::array<double, 2>> points;
  double edge = 0;  ///< mean length of an edge, in the same pixels
};

/// A picture as large as draw_sheet() shows it, pale, with lines of one sheet pixel over it. Lines of fine meshes fade,
/// so that together they cover about a tenth however small the cells are.
golden::Image8 draw_mesh(const golden::Image8& picture, const std::vector<Polyline>& lines, int cell_width);

}  // namespace quadrille::compare
