// What `quadrille cosim` is asked for.
#pragma once

#include "tb/commands/cosim_shrink.hpp"
#include "tb/lockstep/lockstep.hpp"
#include "tb/options/input.hpp"
#include "tb/options/options.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace quadrille::tb {

/// Throws UsageError unless the argument of --rtl is empty, a file, or a directory with the machine.
void check_rtl(const std::string& rtl);

struct CosimOptions {
  CommonOptions common;
  StateOptions state;
  InputOptions input;
  double stall = 0, gap = 0, shrink_seconds = ShrinkOptions{}.seconds;
  std::uint64_t limit_fragments = 0;
  int attributes = 0;       ///< in use per pass; 0: all slots
  std::uint64_t draws = 0;  ///< each input is cut into so many; 0: it is one
  std::string battery;      ///< groups of the battery, or all
  std::string waits, stall_clocks, gap_beats, draw_state, trace, shrink, out, png, texture, shade, rtl;
  std::string judge = "lockstep";  ///< or truth
  bool no_snapping = false, no_alone = false, no_shrink = false, compare_skips = true, list_metrics = false;

  /// Throws UsageError for options that are wrong or do not go together.
  void check(const Config& config) const;
  /// Without the model: the RTL need not have its bits.
  bool by_truth() const { return judge == "truth"; }
  bool all_scenes() const { return inputs_given(input) == 0 || input.scene == "all"; }
  std::vector<InputOptions> inputs() const;
  /// The seed of --draw-state: after the colon, or the command's.
  std::uint64_t drawn_state_seed() const;
  LockstepOptions lockstep(const Config& config, const DrawState& state) const;
};

}  // namespace quadrille::tb
