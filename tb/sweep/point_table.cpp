#include "tb/sweep/point_table.hpp"

#include "golden/analysis/range_proof.hpp"
#include "model/support/edit_distance.hpp"
#include "tb/support/csv.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

namespace quadrille::sweep {
namespace {

constexpr const auto& kinds = error_kind_names;

struct Statistic {
  std::string_view name, meaning;
  double ErrorSummary::*member;
};
constexpr std::array<Statistic, 4> statistics{{{"max", "largest", &ErrorSummary::max},
                                               {"p999", "99.9 % quantile of the", &ErrorSummary::p999},
                                               {"rms", "root mean square of the", &ErrorSummary::rms},
                                               {"mean", "mean of the", &ErrorSummary::mean}}};

std::string error_name(std::size_t kind, std::size_t output, std::size_t statistic) {
  return std::string(kinds[kind]) + "_" + std::string(outputs[output].column) + "_" +
         std::string(statistics[statistic].name);
}

/// A bound of values at their corners' spread: proportional to it, but for half a code.
struct SpreadBound {
  double per_spread = 0, half_code = 0;
  bool proved = false;

  ErrorBound at(double spread) const { return {half_code + per_spread * spread, proved, {}}; }
};

SpreadBound between(const ErrorBound& none, const ErrorBound& one) {
  // Both are rounded up; so is what is left.
  return {(one.value - none.value) * (1 + 0x1p-48), none.value * (1 + 0x1p-48), one.proved};
}

struct Proofs {
  ErrorBound lambda;
  SpreadBound attribute, ordinary_depth, depth;
  std::string ranges;
};

/// Proofs take a millisecond, and most points of a grid differ from others in keys that no proof reads.
Proofs proofs_of(const Config& config) {
  static std::mutex mutex;
  static std::map<std::vector<int>, Proofs> known;
  std::vector<int> values;
  for (const ConfigKey& key : Config::keys())
    if (key.has(ConfigKey::proofs)) values.push_back(config.resolved(key.name));
  {
    const std::lock_guard lock(mutex);
    if (const auto found = known.find(values); found != known.end()) return found->second;
  }
  const auto attribute = between(bound_attribute(config, 0), bound_attribute(config, 1));
  const auto ordinary_depth = between(bound_depth(config, 0), bound_depth(config, 1));
  // The same argument, of denominators with W of more than S bits.
  const SpreadBound depth{std::ldexp(value_bound_factor(config, true), 3 - config.significand_bits),
                          std::ldexp(0.5, -config.depth_bits), attribute.proved};
  Proofs proofs{bound_lambda(config), attribute, ordinary_depth, depth, "proved"};
  // The first weight is what the others leave of its base: a value of spread 1.
  const ErrorBound first = attribute.at(1);
  proofs.lambda.value = std::max(proofs.lambda.value, first.value);
  proofs.lambda.proved = proofs.lambda.proved && first.proved;
  for (const SignalRange& signal : prove_ranges(config).signals)
    if (!signal.fits) {
      proofs.ranges = signal.signal;
      break;
    }
  const std::lock_guard lock(mutex);
  return known.emplace(std::move(values), std::move(proofs)).first->second;
}

std::vector<PointColumn> make_columns() {
  std::vector<PointColumn> columns{{"row", "", "position in the grid, from 0"},
                                   {"status", "", "ok or refused"},
                                   {"reason", "", "the rule that a refused configuration breaks"}};
  for (const ConfigKey& key : Config::keys())
    columns.push_back({std::string(key.name), std::string(key.unit), std::string(key.meaning)});
  columns.push_back({"fragments", "", "drawn by the machine"});
  for (std::size_t kind = 0; kind < kinds.size(); ++kind)
    for (std::size_t q = 0; q < outputs.size(); ++q)
      for (std::size_t s = 0; s < statistics.size(); ++s)
        columns.push_back({error_name(kind, q, s), std::string(outputs[q].unit),
                           std::string(statistics[s].meaning) + " absolute " + std::string(kinds[kind]) + " error of " +
                               std::string(outputs[q].meaning) + (kind == 2 ? ": snapping + arithmetic" : "")});
  for (std::size_t q = 0; q < tb::output_names.size(); ++q) {
    const std::string name = "bound_" + std::string(outputs[q].column);
    columns.push_back({name, "1", "bound of the arithmetic error by analysis"});
    columns.push_back({name + "_kind", "", "proved, estimated, or none: no bound holds for this input"});
  }
  columns.push_back({"attribute_spread", "the attributes'", "largest difference of an attribute between corners"});
  columns.push_back({"depth_spread", "1", "the same of window z; empty where a vertex is not before the eye"});
  columns.insert(columns.end(),
                 {{"ranges", "", "proved: no signal can overflow; else the one that may"},
                  {"coverage_gained", "pixels", "drawn, though the given quad does not cover them"},
                  {"coverage_lost", "pixels", "covered by the given quad, but not drawn"},
                  {"discard_differs", "pixels", "visibility or z interval decided otherwise than by exact arithmetic"},
                  {"colour_codes", "channels", "8-bit channels that differ from the truth's"},
                  {"saturated", "fragments", "with an attribute clamped to its format"},
                  {"quads", "quads", "that cover a pixel in front of the eye"},
                  {"quads_plane", "quads", "of these, whose attributes and depth are drawn with areas for weights"},
                  {"plane_share", "1", "quads_plane of quads"},
                  {"plane_fragments", "fragments", "of quads_plane"},
                  {"cost", "LUTs", "scalar cost"},
                  {"luts", "LUTs", "of the cost those that are no block, estimated"},
                  {"flip_flops", "", "estimated"},
                  {"dsps", "blocks", "multipliers of 18 x 18 bits; 0 where the target has none"},
                  {"block_rams", "blocks", "memories of 18 Kbit; 0 where the target has none"},
                  {"state_bits", "bits", "registers and memories"},
                  {"multiplier_bits", "bits^2", "sum over multipliers of operand widths' products"},
                  {"adder_bits", "bits", "adders, comparators, shifter stages, small memories"},
                  {"table_bits", "bits", "sqrt and reciprocal tables in logic"},
                  {"join_bits", "bits", "adders that join those of one multiplier"},
                  {"memory_bits", "bits", "of state_bits those in memories, where the target has them"},
                  {"cycles", "clocks", "the whole draw without stalls"},
                  {"fragments_per_clock", "1", "fragments of cycles"},
                  {"pareto", "", "1 on the front of cost against the objective"},
                  {"worst_error", "1", "largest arithmetic error of a weight"},
                  {"worst", "", "a command that prints that fragment"}});
  return columns;
}

}  // namespace

Resources resources_of(const HardwareCost& cost, const CostWeights& weights, tb::SynthesisTarget target) {
  const bool memories = target != tb::SynthesisTarget::cells;
  return {.luts = lut_cost(cost, weights),
          .flip_flops = cost.state_bits - (memories ? cost.memory_bits : 0),
          .dsps = target == tb::SynthesisTarget::ecp5 ? cost.dsps : 0,
          .block_rams = memories ? cost.block_rams : 0};
}

void complete_row(PointRow& row, const CostWeights& weights, bool ordinary, bool perspective,
                  tb::SynthesisTarget target) {
  const ErrorBound none{std::numeric_limits<double>::infinity(), false, {}};
  row.cost = hardware_cost(row.config);
  row.scalar_cost = scalar_cost(row.cost, weights);
  row.resources = resources_of(row.cost, weights, target);
  const Proofs proofs = proofs_of(row.config);
  row.bound_lambda = ordinary || perspective ? proofs.lambda : none;
  row.bound_attribute = ordinary || perspective ? proofs.attribute.at(row.result.attribute_spread) : none;
  const bool bounded = std::isfinite(row.result.depth_spread);
  row.bound_depth = bounded ? (ordinary ? proofs.ordinary_depth : proofs.depth).at(row.result.depth_spread) : none;
  row.ranges = proofs.ranges;
}

const std::vector<PointColumn>& point_columns() {
  static const std::vector<PointColumn> columns = make_columns();
  return columns;
}

std::string ErrorColumn::name() const {
  std::size_t s = 0;
  while (statistics[s].member != statistic) ++s;
  return error_name(static_cast<std::size_t>(kind), static_cast<std::size_t>(output), s);
}

double ErrorColumn::value(const PointResult& result) const {
  double sum = 0;
  for (const auto& [part, errors] :
       {std::pair{ErrorKind::snapping, &result.snapping}, std::pair{ErrorKind::arithmetic, &result.arithmetic}}) {
    if (kind != part && kind != ErrorKind::total) continue;
    const ErrorSummary& summary = (*errors)[static_cast<std::size_t>(output)];
    if (!result.refused.empty() || summary.count == 0) return std::numeric_limits<double>::quiet_NaN();
    sum += summary.*statistic;
  }
  return sum;
}

double fragments_per_clock(const PointResult& result) {
  return result.cycles == 0 ? std::numeric_limits<double>::quiet_NaN()
                            : static_cast<double>(result.fragments) / static_cast<double>(result.cycles);
}

double plane_share(const PointResult& result) {
  return result.quads == 0 ? std::numeric_limits<double>::quiet_NaN()
                           : static_cast<double>(result.plane_quads) / static_cast<double>(result.quads);
}

ErrorColumn parse_error_column(std::string_view name) {
  std::optional<ErrorColumn> found;
  std::vector<std::string> known;
  const auto offer = [&](const std::string& candidate, const ErrorColumn& column) {
    if (name == candidate) found = column;
    known.push_back(candidate);
  };
  for (std::size_t q = 0; q < outputs.size(); ++q)
    offer(std::string(outputs[q].column), {ErrorKind::arithmetic, static_cast<Output>(q), &ErrorSummary::max});
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    const auto kind = static_cast<ErrorKind>(k);
    offer(std::string(kinds[k]), {kind, Output::weight, &ErrorSummary::max});
    for (std::size_t q = 0; q < outputs.size(); ++q)
      for (std::size_t s = 0; s < statistics.size(); ++s)
        offer(error_name(k, q, s), {kind, static_cast<Output>(q), statistics[s].member});
  }
  if (found) return *found;
  throw ConfigError("unknown error \"" + std::string(name) + "\"" + did_you_mean(name, known) +
                    " (total, arithmetic or snapping, lambda, attribute, depth or colour, or both and _max, _p999, "
                    "_rms or _mean, such as total_lambda_rms)");
}

std::string csv_number(double value) {
  if (std::isnan(value)) return {};
  std::array<char, 40> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::general, 17);
  return {buffer.data(), end.ptr};
}

std::string point_table(std::span<const PointRow> rows) {
  std::string text;
  for (const PointColumn& column : point_columns()) text += (text.empty() ? "" : ",") + column.name;
  text += "\n";
  for (const PointRow& p : rows) {
    const PointResult& r = p.result;
    const bool ok = r.refused.empty();
    std::vector<std::string> cells{std::to_string(p.row), ok ? "ok" : "refused", tb::csv_cell(r.refused)};
    for (const ConfigKey& key : Config::keys()) cells.push_back(std::to_string(p.config.resolved(key.name)));
    if (ok) {
      cells.push_back(std::to_string(r.fragments));
      for (std::size_t kind = 0; kind < kinds.size(); ++kind)
        for (std::size_t q = 0; q < outputs.size(); ++q)
          for (const Statistic& statistic : statistics)
            cells.push_back(csv_number(
                ErrorColumn{static_cast<ErrorKind>(kind), static_cast<Output>(q), statistic.member}.value(r)));
      for (const ErrorBound* bound : {&p.bound_lambda, &p.bound_attribute, &p.bound_depth}) {
        cells.push_back(std::isfinite(bound->value) ? csv_number(bound->value) : std::string());
        cells.push_back(!std::isfinite(bound->value) ? "none" : bound->proved ? "proved" : "estimated");
      }
      cells.push_back(csv_number(r.attribute_spread));
      cells.push_back(std::isfinite(r.depth_spread) ? csv_number(r.depth_spread) : std::string());
      cells.push_back(tb::csv_cell(p.ranges));
      for (const std::uint64_t count :
           {r.coverage_gained, r.coverage_lost, r.discard_differs, r.colour_codes, r.saturated, r.quads, r.plane_quads})
        cells.push_back(std::to_string(count));
      cells.push_back(csv_number(plane_share(r)));
      cells.push_back(std::to_string(r.plane_fragments));
      cells.push_back(csv_number(p.scalar_cost));
      cells.push_back(csv_number(p.resources.luts));
      for (const std::uint64_t count :
           {p.resources.flip_flops, p.resources.dsps, p.resources.block_rams, p.cost.state_bits, p.cost.multiplier_bits,
            p.cost.adder_bits, p.cost.table_bits, p.cost.join_bits, p.cost.memory_bits})
        cells.push_back(std::to_string(count));
      cells.push_back(r.cycles > 0 ? std::to_string(r.cycles) : std::string());
      cells.push_back(csv_number(fragments_per_clock(r)));
      cells.push_back(p.pareto ? "1" : "0");
      cells.push_back(r.worst.any ? csv_number(r.worst.error) : std::string());
      cells.push_back(tb::csv_cell(p.worst));
    }
    cells.resize(point_columns().size());
    for (std::size_t i = 0; i < cells.size(); ++i) text += (i == 0 ? "" : ",") + cells[i];
    text += "\n";
  }
  return text;
}

}  // namespace quadrille::sweep
