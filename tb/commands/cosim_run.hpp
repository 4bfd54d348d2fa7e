// Inputs of `quadrille cosim` drawn in lockstep and judged, one after the other.
#pragma once

#include "tb/commands/cosim_draws.hpp"
#include "tb/commands/cosim_options.hpp"
#include "tb/commands/cosim_picture.hpp"
#include "tb/commands/cosim_result.hpp"
#include "tb/commands/cosim_shrink.hpp"

#include <optional>
#include <vector>

namespace quadrille::tb {

class CosimRun {
 public:
  /// Both must outlive it.
  CosimRun(const CosimOptions& options, const Config& config) : options_(options), config_(config) {}

  InputResult run_input(const InputOptions& input_options);
  /// Several draws of one machine, each in one of its passes.
  void run_draws(const DrawInput& input, const std::vector<PlannedDraw>& draws, InputResult& result);
  /// Whether a pass of an input failed.
  bool failed() const { return failed_.has_value(); }
  /// The first of them is made less, after all that the run has to say.
  void shrink_failure(const std::vector<InputResult>& results, bool model_ok) const;

 private:
  /// The machine that a draw of several goes on in.
  struct DrawPlace {
    const PlannedDraw& draw;
    std::size_t number;  ///< of the draw, from 1
    LockstepSession& session;
    HiddenDepths& depths;
    PerformanceCounters& counters;  ///< since the reset
  };

  /// A pass of an input.
  struct PassPlace {
    const Pass& pass;
    std::size_t number = 0;
    const DrawPlace* draw = nullptr;  ///< nullptr: in a machine of its own
  };

  void set_place(const DrawPlace& place, LockstepOptions& lockstep) const;
  FragmentChecker::Settings checker_settings(const DrawState& state, const PassPlace& place) const;
  FailedPass failed_pass(const DrawInput& input, const DrawState& draw_state, int slots, const PassPlace& place,
                         bool lockstep_ok) const;
  void compare_with_limits(const std::string& stress, const DrawState& state, InputResult& result) const;
  void run_pass(const DrawInput& input, const DrawState& draw_state, const PassPlace& place, CosimPicture* picture,
                InputResult& result);

  const CosimOptions& options_;
  const Config& config_;
  std::optional<FailedPass> failed_;  ///< the first of all inputs
};

}  // namespace quadrille::tb
