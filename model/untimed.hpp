// The untimed model: quads in, fragments out, the RTL's bits and order without its clocks.
#pragma once

#include "model/port/config.hpp"
#include "model/port/fragment_arrays.hpp"
#include "model/port/records.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>

namespace quadrille {

/// What a draw did; every counter is exact and deterministic.
struct DrawStats {
  std::uint64_t quads = 0;
  std::array<std::uint64_t, quad_reject_count> rejected{};  ///< of these, by reason; [0] those that are none of them
  std::uint64_t homogeneous_quads = 0, hull_quads = 0;      ///< of those that were not rejected
  std::uint64_t blocks_tested = 0, tiles_tested = 0, tiles_entered = 0, stamps_covered = 0;
  std::uint64_t blocks_hidden = 0;  ///< of those tested, left out by hidden_blocks
  std::uint64_t tiles_hidden = 0;   ///< of those tested, left out by hierarchical_z
  std::uint64_t tiles_masked = 0;   ///< of those entered, left out by masked_depth before their rows
  std::uint64_t pixels = 0;         ///< covered pixels that entered the pipeline
  std::uint64_t fragments = 0;      ///< of these, not discarded
  std::uint64_t on_edge = 0, on_vertex = 0, two_corner = 0, two_edge = 0, tie = 0, notch = 0, saturated = 0;

  DrawStats& operator+=(const DrawStats& other);
};

/// Pixels by what computed them: depends on the instruction set, as no DrawStats do.
struct LanePixels {
  std::uint64_t single = 0;  ///< lanes in single precision
  std::uint64_t wide = 0;    ///< lanes in double precision
  std::uint64_t plain = 0;   ///< one at a time: on corners and on two edges
};

/// Two forms of the pixel pipeline with the same bits: plain integers, one pixel at a time (the oracle), or a vector of
/// pixels at once, in single precision where that is enough (float_lanes.hpp), else in double (wide_lanes.hpp).
enum class PixelEngine { plain, lanes };

class UntimedModel {
 public:
  /// Throws ConfigError, or DrawStateError for a state that the configuration cannot have (draw_state.hpp).
  UntimedModel(const Config& config, const DrawState& state, PixelEngine engine = PixelEngine::lanes);
  ~UntimedModel();
  UntimedModel(UntimedModel&&) noexcept;
  UntimedModel& operator=(UntimedModel&&) noexcept;

  /// Draws one quad; `sink` gets its fragments in traversal order, in batches that live for the call only.
  void draw_arrays(const SnappedQuad& quad, const std::function<void(const FragmentArrays&)>& sink);
  /// The same, each fragment a record: takes longer by what writing records takes.
  void draw(const SnappedQuad& quad, const std::function<void(std::span<const Fragment>)>& sink);
  const DrawStats& stats() const;
  const LanePixels& lane_pixels() const;

  /// From here on another draw state: what is hidden stays so. Throws DrawStateError, and nothing has changed.
  void set_state(const DrawState& state);
  /// Forgets what is hidden, with a clear of the depth buffer.
  void clear_hidden();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace quadrille
