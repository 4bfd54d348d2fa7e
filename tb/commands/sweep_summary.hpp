// What `quadrille sweep` prints of its results for people.
#pragma once

#include "tb/commands/sweep_parts.hpp"
#include "tb/sweep/grid.hpp"
#include "tb/sweep/point_table.hpp"

#include <cstdio>
#include <span>
#include <string>
#include <vector>

namespace quadrille::tb {

struct SweepSummary {
  const sweep::Grid& grid;
  std::span<const sweep::PointRow> rows;  ///< rising
  std::span<const std::size_t> front, knees;
  const std::string& no_knee;  ///< why there is none
  sweep::ErrorColumn objective;
  const CostWeights& weights;

  const sweep::PointRow& row_of(std::size_t row) const;
};

/// The values of the keys that the sweep varies.
std::string varied(const sweep::Grid& grid, const Config& config);

/// What "cost" adds up, as a clause: "LUTs + 536 a DSP block + 402 a block RAM".
std::string cost_words(const CostWeights& weights);

/// The front with its errors, costs and what the target takes; its knees or why there is none.
void print_front(std::FILE* out, const SweepSummary& summary);

/// A line a point: the share of quads with areas for weights and their errors. `skipped`: --skip refuses them.
void print_planes(std::FILE* out, const SweepSummary& summary, bool skipped, const char* scene_with_such);

/// The points that meet the targets, what confirmed them, and the parts of the error beside each target.
void print_target(std::FILE* out, const SweepSummary& summary, const TargetResult& result,
                  std::span<const TargetParts> parts, const std::string& input, bool confirms);

}  // namespace quadrille::tb
