// points.csv: its columns, and a point as one row of it.
#pragma once

#include "golden/analysis/error_bound.hpp"
#include "golden/analysis/hardware_cost.hpp"
#include "model/port/config.hpp"
#include "tb/sweep/point_result.hpp"
#include "tb/yosys/yosys.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::sweep {

/// What a target takes, estimated: blocks that it does not have are 0, their bits in LUTs and flip-flops instead.
struct Resources {
  double luts = 0;
  std::uint64_t flip_flops = 0, dsps = 0, block_rams = 0;
};
Resources resources_of(const HardwareCost& cost, const CostWeights& weights, tb::SynthesisTarget target);

/// A point with everything that is known of it. Where `result.refused` is set only row and config count.
struct PointRow {
  std::size_t row = 0;
  Config config;
  PointResult result;
  HardwareCost cost;
  double scalar_cost = 0;
  Resources resources;
  ErrorBound bound_lambda, bound_attribute, bound_depth;
  std::string ranges;  ///< "proved", or the signal that may overflow
  bool pareto = false;
  std::string worst;  ///< a command that prints the worst fragment
};

/// Fills what follows from the configuration and, of the result, from the spreads: cost, bounds, ranges. `ordinary`:
/// every snapped vertex of the input is ordinary. Otherwise, without perspective, weights and attributes have no bound;
/// depth has none where the result's depth_spread is infinite. Those cells stay empty. Safe to call from several
/// threads.
void complete_row(PointRow& row, const CostWeights& weights, bool ordinary, bool perspective,
                  tb::SynthesisTarget target = tb::SynthesisTarget::ecp5);

struct PointColumn {
  std::string name, unit, meaning;
};

/// The columns in order.
const std::vector<PointColumn>& point_columns();

/// Which part of an error. total is snapping + arithmetic, statistic by statistic. By the triangle inequality its max,
/// mean and rms bound those of the machine against exact arithmetic on the given quads, over the fragments that both
/// parts measure; the sum of two p999 bounds the 99.8 % quantile.
enum class ErrorKind { snapping, arithmetic, total };
inline constexpr std::array<std::string_view, 3> error_kind_names{"snapping", "arithmetic", "total"};

/// An error of a result by the name of its column, such as "arithmetic_lambda_max".
struct ErrorColumn {
  ErrorKind kind = ErrorKind::arithmetic;
  Output output = Output::weight;
  double ErrorSummary::*statistic = &ErrorSummary::max;

  std::string name() const;
  /// NaN where the point was refused or the output (of a total: either part) was not measured.
  double value(const PointResult& result) const;
};
/// Fragments of a clock over the whole draw without stalls; NaN where clocks were not counted.
double fragments_per_clock(const PointResult& result);
/// plane_quads of quads; NaN without any.
double plane_share(const PointResult& result);

/// A column, an output ("depth": its largest arithmetic error) or a kind ("total": the largest of the weights). Throws
/// ConfigError naming the nearest of these.
ErrorColumn parse_error_column(std::string_view name);

/// The table as text, header line first; the same rows give the same bytes.
std::string point_table(std::span<const PointRow> rows);

/// 17 significant digits, independent of the locale; empty for NaN.
std::string csv_number(double value);

}  // namespace quadrille::sweep
