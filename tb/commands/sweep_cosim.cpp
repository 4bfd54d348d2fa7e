#include "tb/commands/sweep_cosim.hpp"

#include "model/skips/plane_quad.hpp"
#include "model/support/parallel.hpp"
#include "tb/engines/engine.hpp"
#include "tb/judge/check.hpp"
#include "tb/lockstep/lockstep.hpp"

namespace quadrille::tb {
namespace {

CosimRow cosimulate_point(const CosimPoint& point, std::span<const WindowQuad> quads, int attributes, DrawState state,
                          std::uint64_t limit, std::uint64_t seed) {
  const bool planes = takes_plane_quads(point.config, state);
  if (!planes) state.skip &= ~std::uint32_t{skip_plane};
  const Pass pass =
      (planes ? plan_passes(attributes, false, point.config) : plan_passes(0, true, point.config)).front();
  state.attributes = static_cast<int>(pass.columns.size());
  const std::vector<SnappedQuad> snapped = snap_pass(quads, pass, point.config, state);

  LockstepOptions options;
  options.config = point.config;
  options.state = state;
  options.seed = seed;
  options.limit_fragments = limit;
  FragmentChecker::Settings settings;
  settings.config = point.config;
  settings.state = state;
  settings.pass = pass;
  settings.snapping = false;
  LockstepReport report;
  const CheckResult check = check_here(settings, quads, snapped, [&](const auto& sink) {
    report = run_lockstep(snapped, options, sink);
    return report.complete;
  });
  CosimRow row;
  row.row = point.row;
  row.why = point.why;
  row.fragments = report.fragments;
  row.cycles = report.cycles_rtl;
  row.mismatches = report.mismatches;
  row.cycle_mismatches = report.cycle_mismatches;
  row.seconds = report.wall_seconds;
  row.complete = report.complete;
  if (report.first_divergence) row.first_difference = *report.first_divergence;
  // With truncated D and r² singular pixels are decided approximately, and their flags may differ from the truth's.
  if (point.config.qdrop() == 0) {
    row.mismatches += check.mismatches + check.beyond_bound;
    if (row.first_difference.empty() && check.first.any) row.first_difference = check.first.text;
    if (row.first_difference.empty() && check.beyond_bound > 0) row.first_difference = "weights beyond the error bound";
  }
  if (report.complete && point.cycles != 0 && point.cycles != report.cycles_rtl) {
    ++row.mismatches;
    if (row.first_difference.empty())
      row.first_difference = "the sweep states " + std::to_string(point.cycles) + " clocks, the RTL took " +
                             std::to_string(report.cycles_rtl);
  }
  return row;
}

}  // namespace

std::vector<CosimRow> cosimulate(std::span<const CosimPoint> points, std::span<const WindowQuad> quads, int attributes,
                                 const DrawState& state, std::uint64_t limit, std::uint64_t seed, unsigned threads,
                                 const std::function<void(std::size_t)>& done) {
  std::vector<CosimRow> rows;
  ordered_parallel(
      points.size(), threads,
      [&](std::size_t i) { return cosimulate_point(points[i], quads, attributes, state, limit, seed); },
      [&](std::size_t, CosimRow row) {
        rows.push_back(std::move(row));
        if (done) done(rows.size());
      });
  return rows;
}

}  // namespace quadrille::tb
