// The clocked shell: predicts valid, ready and every payload of the RTL on every clock. It holds control state only;
// every bit of arithmetic comes from the pure functions of the stage files. See rtl/SPEC.md.
//
// Use, once per clock:  comb() -> outputs  (any number of times; changes nothing),  then  clock(inputs).
#pragma once

#include "model/port/config.hpp"
#include "model/port/performance_counters.hpp"
#include "model/port/records.hpp"
#include "model/port/stages.hpp"

#include <array>
#include <memory>

namespace quadrille {

/// Entries of the tile ring.
inline int ring_entries(const Config& config) { return 1 << config.ring_log2(); }
/// Places of the stamp FIFO (quadrille_pkg::STAMP_PLACES): four more than stamps may wait, for the rows on their way.
inline int stamp_places(const Config& config) { return config.stamp_fifo() + 4; }

struct ClockedInputs {
  bool reset = false;  ///< rst_ni = 0
  bool vertex_valid = false;
  bool fragment_ready = false;
  bool clear_hidden = false;  ///< the depth buffer is cleared; ignored while busy
  bool flush = false;         ///< discards the beats of a quad that is not complete, that of this clock among them
  VertexBeat vertex;          ///< the beat, when vertex_valid
};

/// Boundaries of one lane that carry a pixel in this clock, or nullptr.
struct LaneProbes {
  const PixelTrace* diff = nullptr;    ///< in register diff_stage (latency.hpp)
  const PixelTrace* norm = nullptr;    ///< in norm_stage
  const PixelTrace* sqrt = nullptr;    ///< in root_stage
  const PixelTrace* ratio = nullptr;   ///< in ratio_stage
  const PixelTrace* weight = nullptr;  ///< in weight_stage
  const PixelTrace* sum = nullptr;     ///< in sum_stage
};

/// A boundary that carries a beat in this clock, or nullptr.
struct ClockedProbes {
  const SetupResult* setup = nullptr;  ///< taken by the walk in this clock
  std::size_t setup_quad = 0;          ///< its quad: how many were accepted before it since the reset
  const TileEntry* tile = nullptr;     ///< complete in the ring since the last edge
  const StampEntry* stamp = nullptr;   ///< pushed in this clock
  int pixels = 0;                      ///< lanes with a pixel in register diff_stage
  const LaneProbes* lane = nullptr;    ///< one for each lane; Probes::all wanted
};

struct ClockedOutputs {
  bool vertex_ready = false;
  bool fragment_valid = false;
  bool busy = false;
  /// By lane, nullptr where there is none. These and the probes are valid until the next clock().
  std::array<const Fragment*, Config::most_pixels_per_clock> fragment{};
  ClockedProbes probes;

  /// The lanes that have a fragment, bit 0 the first.
  std::uint32_t fragment_mask() const {
    std::uint32_t mask = 0;
    for (std::size_t lane = 0; lane < fragment.size(); ++lane) mask |= (fragment[lane] != nullptr ? 1u : 0u) << lane;
    return mask;
  }
  /// Calls f(const Fragment&) for those of this clock, in their order.
  template <class F>
  void for_each_fragment(F&& f) const {
    for (const Fragment* one : fragment)
      if (one != nullptr) f(*one);
  }
};

/// Which probes a clocked model shows. Those of pixels need every number of the plain integer pipeline; without them a
/// rows that wait for emission are computed together by pixels_ahead, the same fragments several times as fast.
enum class Probes { without_pixels, all };

class ClockedModel {
 public:
  /// Throws ConfigError, or DrawStateError for a state that the configuration cannot have (draw_state.hpp).
  ClockedModel(const Config& config, const DrawState& state, Probes probes = Probes::without_pixels);
  ~ClockedModel();
  ClockedModel(ClockedModel&&) noexcept;
  ClockedModel& operator=(ClockedModel&&) noexcept;

  /// Outputs of this clock, from registered state alone: valid cannot depend on ready, nor ready on valid.
  ClockedOutputs comb() const;
  /// The clock edge.
  void clock(const ClockedInputs& inputs);
  /// What the clocks since reset counted, whether the configuration has counters in hardware or not.
  PerformanceCounters counters() const;

  /// From a quad's first beat to its last fragment; busy() of the outputs is also while hidden tiles are wiped.
  bool quads_under_way() const;
  /// From this clock on another draw state; what is hidden stays so. Throws std::logic_error while quads are under way,
  /// DrawStateError for one that is refused, and nothing has changed.
  void set_state(const DrawState& state);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace quadrille
