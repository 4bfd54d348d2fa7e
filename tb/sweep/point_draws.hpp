// The machine's own draw of configurations, compared with exact arithmetic on the same numbers at the port.
#pragma once

#include "tb/sweep/port_quads.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace quadrille::sweep {

/// What a configuration adds up over quads; merging does not depend on the order.
struct DrawTotals {
  std::uint64_t fragments = 0, colour_codes = 0, saturated = 0;
  std::uint64_t drawn_as_given = 0, drawn_as_snapped = 0;  ///< of these, by exact arithmetic too
  std::uint64_t plane_quads = 0, plane_fragments = 0;      ///< drawn with areas for weights
  OutputStats arithmetic;
  WorstPixel worst;

  void merge(const DrawTotals& other);
};

/// A configuration that draws, and where it adds up.
struct PointDraw {
  Config config;
  DrawTotals* totals;
};

/// Quads from `first` to before `last`, the rows from y0 to before y1 of them.
struct DrawPart {
  std::size_t first, last;
  int y0, y1;
};
/// All pixels in parts of about one size: several quads, or a band of one.
std::vector<DrawPart> draw_parts(const PositionData& positions, const DrawState& state);

/// Draws a part by each configuration; all have the numbers of `port`. `map` (may be empty) gets the |Δλ'| of each lane
/// of the input, and keeps what it has where nothing is drawn; for one configuration.
void draw_points(const SweepInput& input, const PositionData& positions, const PortQuads& port,
                 std::span<const PointDraw> points, const DrawPart& part, std::span<float> map = {});

}  // namespace quadrille::sweep
