// points.csv: its columns, and a point as one row of it.
#pragma once

#include "golden/analysis/error_bound.hpp"
#include "golden/analysis/hardware_cost.hpp"
#include "model/config.hpp"
#include "tb/sweep/point_result.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::sweep {

/// A point with everything that is known of it. Where `result.refused` is set only row and config count.
struct PointRow {
  std::size_t row = 0;
  Config config;
  PointResult result;
  HardwareCost cost;
  double scalar_cost = 0;
  ErrorBound bound_lambda, bound_attribute, bound_depth;
  std::string ranges;  ///< "proved", or the signal that may overflow
  bool pareto = false;
  std::string worst;  ///< a command that prints the worst fragment
};

/// Fills what follows from the configuration: cost, bounds, ranges. `ordinary`: every snapped vertex of the input has
/// W = 1. Otherwise the depth has no bound, and without perspective the others have none: those cells stay empty.
/// Safe to call from several threads.
void complete_row(PointRow& row, const CostWeights& weights, bool ordinary, bool perspective);

struct PointColumn {
  std::string name, unit, meaning;
};

/// The columns in order.
const std::vector<PointColumn>& point_columns();

/// An error of a result by the name of its column, such as "arithmetic_lambda_max"; a bare quantity ("depth") is its
/// arithmetic maximum.
struct ErrorColumn {
  bool snapping = false;
  Quantity quantity = Quantity::lambda;
  double ErrorSummary::*statistic = &ErrorSummary::max;

  std::string name() const;
  /// NaN where the point was refused or the quantity was not measured.
  double value(const PointResult& result) const;
};
/// Throws ConfigError naming the nearest column.
ErrorColumn parse_error_column(std::string_view name);
/// All of their names.
std::vector<std::string> error_column_names();

/// The table as text, header line first; the same rows give the same bytes.
std::string point_table(std::span<const PointRow> rows);

/// Text that a CSV cell can hold: quoted where necessary.
std::string csv_cell(std::string_view text);
/// 17 significant digits, independent of the locale; empty for NaN.
std::string csv_number(double value);

}  // namespace quadrille::sweep
