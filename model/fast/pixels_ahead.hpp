// Pixels of the clocked model, computed before emission comes to them: those of the rows that wait for it, a batch of
// one quad at a time, by the quickest lanes that the quad fits.
#pragma once

#include "model/fast/lanes.hpp"
#include "model/front/covered_pixels.hpp"
#include "model/pixel/pixel_pipeline.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace quadrille {

/// What the control and the counters need of a pixel; bits.
enum PixelKind : std::uint8_t {
  pixel_drawn = 1,   ///< not discarded
  pixel_plane = 2,   ///< of a plane_quad
  pixel_areas = 4,   ///< which are its weights: no product makes them
  pixel_corner = 8,  ///< its weights are a corner's
  pixel_hull = 16,   ///< the eye is in the quad's hull
};
inline constexpr std::size_t pixel_kinds = 32;

std::uint8_t kind_of(const PixelTrace& pixel);

/// A quad as the pipeline and its lanes take it.
struct PixelQuad {
  QuadConstants constants;
  QuadData data;
  SetupResult setup;
  LanesQuad lanes;
};

class PixelsAhead {
 public:
  /// Pixels from which on no further row joins a batch: a few vectors' worth.
  static constexpr int enough = 64;

  explicit PixelsAhead(const PipelineContext& context);
  /// The context has another draw state; nothing is waiting.
  void set_state();
  /// Of a quad that setup begins with: `constants` are the walk's later.
  void take(const SetupResult& setup, PixelQuad& quad) const;

  bool empty() const { return next_ == kind_.size(); }
  void clear() {
    next_ = 0;
    kind_.clear();
  }

  /// A batch, once the one before is empty: begin(), its rows in the order of emission, compute().
  void begin();
  void add(const TileEntry& tile, const StampEntry& row);
  bool full() const { return pixels_ >= enough; }
  void compute(const PixelQuad& quad);

  /// The next pixel, which is there.
  std::uint8_t kind() const { return kind_[next_]; }
  Fragment fragment() const { return batch_[next_]; }
  void advance() { ++next_; }

 private:
  struct Row {
    const TileEntry* tile;
    const StampEntry* stamp;
  };

  /// Its pixels to the list, from the origin of `bounds`.
  void list_row(const Row& row, const PixelBounds& bounds);
  void compute_lanes(const PixelQuad& quad);
  void compute_by_tile(const PixelQuad& quad);
  /// Of the list, whose rows begin with `first_row`.
  void take_kinds(const LaneResults& results, std::size_t first_row, const PixelQuad& quad);
  void plain(const Row& row, int dx, const PixelQuad& quad, std::size_t place);

  const PipelineContext& context_;
  Lanes lanes_;
  std::vector<Row> rows_;
  int pixels_ = 0;  ///< of the rows
  PixelList list_;
  LaneResults results_;   ///< of all lanes: `fragments`
  LaneResults of_tile_;   ///< where each tile is a list
  FragmentArrays batch_;  ///< of these
  std::vector<std::uint8_t> kind_;
  std::size_t next_ = 0;
};

}  // namespace quadrille
