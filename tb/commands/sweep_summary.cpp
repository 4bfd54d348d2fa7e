#include "tb/commands/sweep_summary.hpp"

#include <algorithm>
#include <cmath>

namespace quadrille::tb {
namespace {

std::string format(const char* how, double value) {
  if (std::isnan(value)) return "-";
  char text[32];
  std::snprintf(text, sizeof text, how, value);
  return text;
}

std::string exponent(double error) { return error > 0 ? format("2^%.2f", std::log2(error)) : format("%.0f", error); }

/// "44361 LUT, 36209 FF, 82 DSP, 39 BRAM, 0.974 pixels per clock"
std::string takes(const sweep::PointRow& point) {
  const sweep::Resources& r = point.resources;
  const double rate = sweep::fragments_per_clock(point.result);
  return format("%.0f", r.luts) + " LUT, " + std::to_string(r.flip_flops) + " FF, " + std::to_string(r.dsps) +
         " DSP, " + std::to_string(r.block_rams) + " BRAM, " +
         (std::isnan(rate) ? "clocks not counted" : format("%.3f pixels per clock", rate));
}

std::string describe(const SweepSummary& summary, std::size_t row) {
  const sweep::PointRow& point = summary.row_of(row);
  return "row " + std::to_string(row) + ", cost " + format("%.0f", point.scalar_cost) + ": " +
         varied(summary.grid, point.config) + "\n    " + takes(point);
}

}  // namespace

const sweep::PointRow& SweepSummary::row_of(std::size_t row) const {
  return *std::ranges::lower_bound(rows, row, {}, &sweep::PointRow::row);
}

std::string varied(const sweep::Grid& grid, const Config& config) {
  std::string text;
  for (const sweep::Axis& axis : grid.axes()) {
    const int value = config.resolved(axis.key);
    if (grid.kind() == sweep::Grid::Kind::one_at_a_time && value == grid.base().resolved(axis.key)) continue;
    text += (text.empty() ? "" : " ") + axis.key + "=" + std::to_string(value);
  }
  return text.empty() ? "the base" : text;
}

std::string cost_words(const CostWeights& weights) {
  std::string text = "LUTs";
  if (weights.dsp > 0) text += " + " + format("%g", weights.dsp) + " per DSP block";
  if (weights.block_ram > 0) text += " + " + format("%g", weights.block_ram) + " per block RAM";
  return text;
}

void print_front(std::FILE* out, const SweepSummary& summary) {
  const bool arithmetic = summary.objective.kind == sweep::ErrorKind::arithmetic;
  sweep::ErrorColumn whole = summary.objective;
  whole.kind = sweep::ErrorKind::total;
  std::fprintf(out, "Pareto front of cost and %s (* knee); cost = %s\n", summary.objective.name().c_str(),
               cost_words(summary.weights).c_str());
  std::fprintf(out, "  %6s %10s %11s %9s%s %8s %7s %5s %5s %8s\n", "row", "cost", "error", "=",
               arithmetic ? "     total" : "", "LUT", "FF", "DSP", "BRAM", "px/clock");
  for (const std::size_t row : summary.front) {
    const sweep::PointRow& point = summary.row_of(row);
    const double error = summary.objective.value(point.result);
    std::fprintf(out, "%s %6zu %10.0f %11.3e %9s", std::ranges::count(summary.knees, row) ? "*" : " ", row,
                 point.scalar_cost, error, exponent(error).c_str());
    if (arithmetic) {
      const double total = whole.value(point.result);
      std::fprintf(out, " %9s", std::isnan(total) ? "-" : exponent(total).c_str());
    }
    const sweep::Resources& r = point.resources;
    std::fprintf(out, " %8.0f %7zu %5zu %5zu %8s  %s\n", r.luts, static_cast<std::size_t>(r.flip_flops),
                 static_cast<std::size_t>(r.dsps), static_cast<std::size_t>(r.block_rams),
                 format("%.3f", sweep::fragments_per_clock(point.result)).c_str(),
                 varied(summary.grid, point.config).c_str());
  }
  if (!summary.no_knee.empty()) std::fprintf(out, "No knee: %s.\n", summary.no_knee.c_str());
}

void print_planes(std::FILE* out, const SweepSummary& summary, bool skipped, const char* scene_with_such) {
  constexpr std::size_t most = 40;
  std::fprintf(out, "\nplane quads (plane_quads): share, and errors against mean value coordinates\n");
  std::fprintf(out, "  %6s %7s %12s %12s %10s  %s\n", "row", "share", "attribute", "depth", "cost", "");
  std::size_t lines = 0;
  bool taken = false;
  const auto error = [&](const sweep::PointResult& result, sweep::Output output) {
    const double value = sweep::ErrorColumn{sweep::ErrorKind::arithmetic, output}.value(result);
    return value > 0 ? exponent(value) : std::string("-");
  };
  for (const sweep::PointRow& point : summary.rows) {
    if (!point.result.refused.empty()) continue;
    taken = taken || point.result.plane_quads != 0;
    if (++lines > most) continue;
    std::fprintf(out, "  %6zu %6.1f%% %12s %12s %10.0f  %s\n", point.row, 100 * sweep::plane_share(point.result),
                 error(point.result, sweep::Output::attribute).c_str(),
                 error(point.result, sweep::Output::depth).c_str(), point.scalar_cost,
                 varied(summary.grid, point.config).c_str());
  }
  if (lines > most) std::fprintf(out, "  %zu more in points.csv\n", lines - most);
  if (!taken)
    std::fprintf(out, "  no plane quads in this input%s; %s has some\n", skipped ? " (--skip)" : "", scene_with_such);
}

void print_target(std::FILE* out, const SweepSummary& summary, const TargetResult& t,
                  std::span<const TargetParts> parts, const std::string& input, bool confirms) {
  std::string wanted, judged;
  for (const TargetParts& p : parts) {
    wanted += (wanted.empty() ? "" : ", ") + p.target.text;
    judged += (judged.empty() ? "" : ", ") + p.target.column.name();
  }
  std::fprintf(out, "\ntarget %s (%s): %zu evaluations\n", wanted.c_str(), judged.c_str(), t.evaluations);
  if (t.winner) std::fprintf(out, "  cheapest on %s:  %s\n", input.c_str(), describe(summary, *t.winner).c_str());
  if (t.confirmed) {
    const std::vector<std::string> silent = unmeasured(t);
    std::string where = "all stress families", names;
    for (const std::string& name : silent) names += (names.empty() ? "" : ", ") + name;
    if (!silent.empty())
      where = std::to_string(t.families.size() - silent.size()) + " of " + std::to_string(t.families.size()) +
              " stress families (not measured on " + names + ")";
    std::fprintf(out, "  %s confirmed on %s:  %s\n", judged.c_str(), where.c_str(),
                 t.confirmed == t.winner ? "the same" : describe(summary, *t.confirmed).c_str());
  }
  const auto worst_by = [&](double FamilyCheck::*miss) {
    return std::ranges::max_element(t.families, {}, [&](const FamilyCheck& c) { return std::fmax(c.*miss, 0); });
  };
  if (const auto worst = worst_by(&FamilyCheck::miss); worst != t.families.end())
    std::fprintf(out, "  worst family: %s, %.0f %% of the target; worst weight:\n    %s\n", worst->family.c_str(),
                 100 * worst->miss, worst->worst.c_str());
  if (const auto worst = worst_by(&FamilyCheck::total); worst != t.families.end() && worst->total > 1)
    std::fprintf(out, "  total error on the families (tiny quads): up to %.3g times the target (%s)\n", worst->total,
                 worst->family.c_str());
  if (t.winner && !confirms) std::fprintf(out, "  not checked on the stress families (--no-confirm)\n");
  for (const TargetParts& p : parts) {
    std::fprintf(out, "  row %zu on %s, target %s = %.3e:\n", answer_row(t), input.c_str(), p.target.text.c_str(),
                 p.target.limit);
    for (const auto& [kind, error] : {std::pair{sweep::ErrorKind::arithmetic, p.arithmetic},
                                      {sweep::ErrorKind::snapping, p.snapping},
                                      {sweep::ErrorKind::total, p.total}})
      std::fprintf(out, "    %-11s %11s %10s%s\n",
                   std::string(sweep::error_kind_names[static_cast<std::size_t>(kind)]).c_str(),
                   format("%.3e", error).c_str(), format("%.0f %%", 100 * error / p.target.limit).c_str(),
                   kind == p.target.column.kind ? "  target" : "");
    std::fprintf(out, "    %s\n", verdict(p).c_str());
  }
}

}  // namespace quadrille::tb
