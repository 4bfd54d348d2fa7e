// Where on the screen a draw had no work, and why: tiles by reason.
#pragma once

#include "golden/io/frame_image.hpp"
#include "golden/io/png.hpp"
#include "model/port/config.hpp"
#include "model/port/records.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::tb {

/// What became of a tile of a quad's bounding box.
enum class TileFate : std::uint8_t {
  entered,  ///< pushed: its rows were tested
  hidden,   ///< nothing of it, or of a block that holds it, can be seen: not tested, not pushed, or its rows left out
  tile,     ///< its own test was not hit
  block,    ///< it was not tested: something larger that holds it was not hit
  depth,    ///< its quad was left out: outside [znear, zfar]
  line,     ///< on a line
  culled,   ///< no wanted face possible
};
inline constexpr std::size_t tile_fate_count = 7;
inline constexpr std::array<std::string_view, tile_fate_count> tile_fate_names{"entered", "hidden", "tile",  "block",
                                                                               "depth",   "line",   "culled"};

/// How many quads gave a tile each fate; tiles in rows from the top. The box of a quad with some w that is not 1 is all
/// that the walk has to look at; left out, it has none, nor has one behind the eye or without a pixel centre.
struct TileFates {
  int columns = 0, rows = 0;
  std::array<std::vector<std::uint32_t>, tile_fate_count> count;

  std::uint64_t total(TileFate fate) const;
};
/// In the order of the quads: what is hidden depends on those before, and nothing is at the first.
TileFates tile_fates(std::span<const SnappedQuad> quads, const Config& config, const DrawState& state);

/// Each tile in the mean of its fates' colours, weighted by how many quads had them, the darker the fewer; layers
/// `skip.<fate>` with the numbers. Pixels of the viewport, a tile's alike.
golden::FrameImage skip_picture(const TileFates& fates, const Config& config, const DrawState& state);

/// That picture and beside it each fate that some tile had, alone in its colour, the darker the fewer; a legend with
/// the totals.
golden::Image8 skip_sheet(const TileFates& fates, const Config& config, const DrawState& state,
                          const std::string& title);

}  // namespace quadrille::tb
