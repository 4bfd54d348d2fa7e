#include "tb/commands/explain_rtl.hpp"

#include "golden/explain/compare.hpp"
#include "model/port/snap.hpp"
#include "tb/device/verilated_device.hpp"
#include "tb/lockstep/pixel_watch.hpp"
#include "tb/passes/pass.hpp"

#include <algorithm>
#include <optional>
#include <span>

namespace quadrille::tb {
namespace {

using explain::Explanation;
using explain::Number;
using explain::Stage;

std::optional<Boundary> boundary_of(const Stage& stage) {
  for (int i = 0; i <= static_cast<int>(Boundary::fragment); ++i)
    if (stage.boundary == boundary_name(static_cast<Boundary>(i))) return static_cast<Boundary>(i);
  return std::nullopt;
}

/// A weight is the attribute of a slot.
void compare_weight(Number& number, const RecordLayout& layout, const Record& record, int slot) {
  number.other = number.stored;
  number.other.front().value = static_cast<std::uint64_t>(record.get_signed(layout.field("attr", slot)));
  number.differs = number.other.front().value != number.stored.front().value;
}

}  // namespace

ExplainByRtl::ExplainByRtl(const LockstepOptions& options) : options_(options) {
  options_.stop_at_first = false;  // the pixel may come later
  options_.limit_differences = 0;
  options_.threads = 1;
  simulator_ = simulator_in_lockstep(options_);
}

bool ExplainByRtl::compare(Explanation& e, const WindowQuad& quad) const {
  const Config& config = options_.config;
  bool said = false;
  const auto run = [&](const WindowQuad& drawn, const DrawState& state, auto&& look) {
    LockstepOptions options = options_;
    options.state = state;
    VerilatedDevice device(simulator_, config, options.seed);
    PixelWatch watch(device, config, e.x, e.y);
    const SnappedQuad snapped = snap_quad(drawn, config, state);
    const LockstepReport report = run_lockstep(watch, std::span(&snapped, 1), options);
    if (report.first_divergence && !said)
      e.remarks.push_back("the first difference of the quad: " + *report.first_divergence);
    said = said || report.first_divergence;
    look(watch);
    return report.agreed();
  };

  bool same = run(quad, options_.state, [&](const PixelWatch& watch) {
    for (Stage& stage : e.stages) {
      const std::optional<Boundary> boundary = boundary_of(stage);
      if (!boundary || (!options_.probes && *boundary != Boundary::fragment)) continue;
      if (*boundary == Boundary::fragment && e.outcome != explain::Outcome::drawn) continue;
      const std::optional<Record>& record = watch.at(*boundary);
      // Of a pixel that is not covered the machine stops somewhere in front.
      if (!record && !e.covered()) continue;
      explain::compare(stage, boundary_layout(*boundary, config), record ? &*record : nullptr);
    }
    if (!e.covered() && watch.at(Boundary::diff)) e.remarks.emplace_back("the RTL covers this pixel");
  });

  const auto lambda = std::ranges::find(e.stages, "lambda", &Stage::name);
  if (lambda == e.stages.end() || e.outcome != explain::Outcome::drawn) return same;
  const RecordLayout layout = boundary_layout(Boundary::fragment, config);
  lambda->compared = Stage::Compared::same;
  for (const Pass& pass : plan_passes(0, true, config)) {
    same &= run(pass_quad(quad, pass), state_of_pass(options_.state, pass, true), [&](const PixelWatch& watch) {
      const std::optional<Record>& record = watch.at(Boundary::fragment);
      for (std::size_t slot = 0; record && slot < pass.columns.size(); ++slot)
        compare_weight(lambda->numbers[static_cast<std::size_t>(pass.columns[slot])], layout, *record,
                       static_cast<int>(slot));
      if (!record || std::ranges::any_of(lambda->numbers, &Number::differs))
        lambda->compared = Stage::Compared::differs;
    });
  }
  return same;
}

}  // namespace quadrille::tb
