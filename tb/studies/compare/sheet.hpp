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

struct Sheet {
  std::string title, subtitle;
  std::vector<std::string> columns;
  std::vector<SheetRow> rows;
  /// Differences are coloured logarithmically from heat_most·2^-heat_octaves to heat_most; 0: no scale in the legend.
  double heat_most = 0;
  int heat_octaves = 0;
  std::vector<SheetKey> keys;
};

/// Columns of this width that fit a sheet; the drawing library takes pictures of 32767 pixels at most.
int most_columns(int cell_width);

/// Lays the sheet out with pictures `cell_width` pixels wide, less where they would be more than twice as high (larger
/// ones are reduced, smaller ones enlarged without smoothing). Text that does not fit is cut with an ellipsis. Throws
/// std::runtime_error for more than most_columns().
golden::Image8 draw_sheet(const Sheet& sheet, int cell_width);

/// Points in pixels of a picture.
struct Polyline {
  std::vector<std::array<double, 2>> points;
  double opacity = 1;
};
/// Of a line of this width round a cell whose edges have this mean length, both in pixels: fine meshes fade, so that
/// their lines together cover at most about a sixth of the picture however small the cells are.
double wireframe_opacity(double edge, double width);

/// Lines over a picture: for the mesh that a method emits.
void draw_lines(golden::Image8& picture, const std::vector<Polyline>& lines, std::array<std::uint8_t, 3> colour,
                double width);

}  // namespace quadrille::compare
