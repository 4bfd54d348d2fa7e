#include "tb/studies/snapped_input.hpp"

#include "model/port/snap.hpp"
#include "tb/commands/counters_report.hpp"
#include "tb/support/errors.hpp"

namespace quadrille::tb {

SnappedInput::SnappedInput(const InputOptions& options, const CommonOptions& common, const Config& config)
    : state(StateOptions().state(common, config)) {
  input = load_input(options, "", state, config, common.seed);
  print_remark(input, common);
  adjust_state(input, state);
  check_quad_count(input.quads.size(), config);
  const Pass pass = plan_passes(input.attributes, false, config).front();
  state.attributes = static_cast<int>(pass.columns.size());
  try {
    quads = snap_pass(input.quads, pass, config, state);
  } catch (const SnapError& error) {
    throw UsageError(describe(error, input));
  }
}

}  // namespace quadrille::tb
