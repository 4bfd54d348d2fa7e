// Errors of many configurations on one input. Each is drawn by the untimed model and compared with exact arithmetic,
// which configurations share: on the quads as given, on snapped positions, on numbers at the port.
#pragma once

#include "model/port/config.hpp"
#include "model/port/records.hpp"
#include "tb/sweep/point_result.hpp"
#include "tb/sweep/stage_keys.hpp"
#include "tb/sweep/work_units.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::sweep {

/// What is drawn. The evaluator keeps a reference.
struct SweepInput {
  std::vector<WindowQuad> quads;
  int attributes = 0;  ///< of the quads, at most max_attribute_slots; measured whatever attribute_slots is
  DrawState state;     ///< `attributes` in it is ignored; skip_plane: plane_quads counts; never skip_hidden
};

/// Whether every vertex of an input is ordinary (model/port/snap.hpp, has_ordinary_vertices) once snapped. False too
/// where one cannot be snapped. Asks once for each placement of vertices; safe to call from several threads. Keeps a
/// reference to the input.
class OrdinaryInput {
 public:
  explicit OrdinaryInput(const SweepInput& input) : input_(input) {}
  bool operator()(const Config& config);

 private:
  const SweepInput& input_;
  std::mutex mutex_;
  std::map<LevelKey, bool> known_;
};

/// What is executed.
enum class Stage {
  given_truth,  ///< truth on the quads as given: once per input
  snap_truth,   ///< truth (unnormalised weights, coverage) on snapped positions
  draw,         ///< the machine, of what points draw differently
  cycles,       ///< the clocked model alone: positions, and cycles_key()
};
inline constexpr std::size_t stage_count = 4;
inline constexpr std::array<std::string_view, stage_count> stage_names{"given_truth", "snap_truth", "draw", "cycles"};

/// How often each stage was executed.
struct StageCounters {
  std::array<std::uint64_t, stage_count> settings{};   ///< distinct settings, each over the whole input
  std::array<std::uint64_t, stage_count> fragments{};  ///< fragments (cycles: clocks)

  StageCounters& operator+=(const StageCounters& other) {
    for (std::size_t i = 0; i < stage_count; ++i) {
      settings[i] += other.settings[i];
      fragments[i] += other.fragments[i];
    }
    return *this;
  }
};

/// Results of some points that became ready together.
struct Batch {
  std::vector<std::size_t> points;   ///< positions in the list given to evaluate()
  std::vector<PointResult> results;  ///< the same order
  StageCounters executed;            ///< by this batch
  double seconds = 0;
};

class Evaluator {
 public:
  struct Settings {
    unsigned threads = 1;
    bool cycles = true;              ///< also run the clocked model
    std::size_t batch_points = 256;  ///< points that are carried at once, about; bounds memory and loss by interruption
    std::size_t memory_bytes = std::size_t{2} << 30;  ///< of truth kept; what is in use may need more
    Stop stop = {};                                   ///< ends evaluate() and error_map() with Stopped
  };

  Evaluator(const SweepInput& input, const Settings& settings);
  ~Evaluator();

  /// Evaluates every configuration (each must pass Config::validate()); hands results over in batches, refused points
  /// first, in an order that depends on the list and batch_points alone, on the calling thread. Truth stays in memory
  /// for further calls. Results do not depend on the number of threads, on the batches, or on what was
  /// evaluated before. `progress` (may be empty) is called on the calling thread now and then with the part done, 0
  /// to 1. An exception thrown by a callback ends the call and passes through; the evaluator stays usable.
  void evaluate(std::span<const Config> points, const std::function<void(const Batch&)>& done,
                const std::function<void(double)>& progress = {});

  /// One point.
  PointResult evaluate(const Config& point);

  /// Of all evaluate() calls so far.
  const StageCounters& counters() const;

  /// Largest arithmetic |Δλ'| of any fragment at each pixel, row-major width × height; −1 where nothing is drawn (a
  /// refused point draws nothing), 0 where only what is not measured is. Counts as an evaluate() call.
  std::vector<float> error_map(const Config& point);

  /// Why a configuration cannot draw the input; empty if it can.
  std::string refusal(const Config& point);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace quadrille::sweep
