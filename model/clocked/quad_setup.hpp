#pragma once

#include "model/front/quad_reject.hpp"
#include "model/front/quad_setup.hpp"
#include "model/port/latency.hpp"
#include "model/port/performance_counters.hpp"

#include <algorithm>
#include <array>

namespace quadrille::clocked {

/// The control half of quad_setup; the bits come from the function of that name at start. Four quads may be there: one
/// does its steps (front), one whose results are still to come waits (middle), of one they come (sum), one waits
/// complete for the walk (done).
struct QuadSetup {
  struct Quad {
    SetupResult setup;
    bool left_out = false;  ///< by its areas
  };

  int pairs = 1;        ///< of dot units
  int box = 0;          ///< clocks of the bounding box, of the quad that waits: 2 when it is there
  int all_steps = 0;    ///< of the quad that does them
  int steps = 0;        ///< left to do
  bool front = false;   ///< `next` has started; then it goes to the middle, which is free
  bool middle = false;  ///< `waiting` has not moved on
  bool sum = false;     ///< `summed` has not
  std::array<bool, quad_setup_result_clocks(2)> ends{};  ///< last steps whose results are on their way
  bool complete = false;                                 ///< all of `summed` is there
  bool done = false;                                     ///< `result` is there, neither taken nor dropped yet
  Quad next, waiting, summed, result;

  bool busy() const { return front || middle || sum || done; }
  /// The step of this clock has jobs for the dot units, should they be free.
  bool has_jobs() const {
    const int step = all_steps - steps;
    return steps > 0 && !(pairs == 2 && next.setup.homogeneous && (step == 6 || (step >= 15 && step <= 17)));
  }
  /// The last step is done in this clock; the steps wait while the dot units work for a tile.
  bool ends_run(bool units_taken) const { return steps == 1 && !units_taken; }

  bool drops_result() const { return done && result.left_out; }
  /// An ordinary quad's areas are known a clock before all of it; then it goes no further.
  bool drops_summed() const {
    const bool areas_known = complete || ends[static_cast<std::size_t>(quad_setup_result_clocks(pairs) - 1)];
    return sum && areas_known && !summed.setup.homogeneous && summed.left_out && !drops_result();
  }
  bool drops() const { return drops_result() || drops_summed(); }
  /// The quad that is left out in this clock, where drops().
  const SetupResult& dropped() const { return drops_result() ? result.setup : summed.setup; }
  /// `result` waits for the walk.
  bool ready_for_walk() const { return done && !result.left_out; }

  /// A quad may start: those before it will have moved on when its first result comes. `taken`: the walk takes
  /// `result`.
  bool ready(bool taken, bool units_taken) const {
    const bool run_over = steps == 0 || (pairs == 1 && ends_run(units_taken));
    const bool gone = taken || drops_result();
    const bool alone = !(sum && middle) || drops_summed();
    return box == 2 && run_over && alone && (!(sum || middle) || !done || gone);
  }

  /// The edge; start() comes after it. `held`: a quad waits.
  void clock(bool held, bool taken, bool units_taken) {
    const bool left_out = drops_summed();
    const bool gone = taken || drops_result();
    const bool hand_over = complete && !left_out && (!done || gone);
    const bool advance = middle && (!sum || hand_over || left_out);
    if (gone) done = false;
    if (hand_over) {
      result = summed;
      done = true;
    }
    if (hand_over || left_out) sum = false;
    if (advance) {
      summed = waiting;
      middle = false;
      sum = true;
    }
    if (front) {
      waiting = next;
      front = false;
      middle = true;
    }
    complete =
        (ends[static_cast<std::size_t>(quad_setup_result_clocks(pairs) - 1)] || (complete && !hand_over)) && !left_out;
    for (std::size_t n = ends.size() - 1; n > 0; --n) ends[n] = ends[n - 1];
    ends[0] = ends_run(units_taken);
    if (steps > 0 && !units_taken) --steps;
    if (box != 0 || held) box = std::min(box + 1, 2);
  }

  void start(const SetupResult& quad, const DrawState& state) {
    next = {quad, reject_by_areas(quad, state) != QuadReject::none};
    front = true;
    steps = all_steps = quad_setup_steps(quad.homogeneous, pairs, state);
    box = 0;
  }

  void count(PerformanceCounters& to, bool taking, const DrawState& state) const {
    using enum PerformanceCounter;
    if (drops()) ++to[reject_by_areas(dropped(), state) == QuadReject::line ? quads_line : quads_culled];
    if (taking) ++to[result.setup.homogeneous ? quads_homogeneous : quads_ordinary];
  }
};

}  // namespace quadrille::clocked
