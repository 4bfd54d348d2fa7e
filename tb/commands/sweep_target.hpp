// --target-error of `quadrille sweep`: the cheapest configuration that meets it, confirmed on every stress family.
#pragma once

#include "golden/analysis/hardware_cost.hpp"
#include "tb/sweep/evaluator.hpp"
#include "tb/sweep/point_table.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace quadrille::tb {

/// An error column and the largest value that it may have.
struct ErrorTarget {
  std::string text;  ///< as given
  sweep::ErrorColumn column;
  double limit = 0;
};

/// "COLUMN=VALUE", VALUE a number, a power "2^-12" or a quotient "0.5/255". Throws UsageError.
ErrorTarget parse_target(const std::string& text);

/// Largest error / limit over the targets; NaN where one was not measured.
double target_miss(const sweep::PointResult& result, std::span<const ErrorTarget> targets);

struct TargetSearch {
  std::vector<std::size_t> rows;  ///< of the grid, valid ones
  std::vector<Config> configs;    ///< the same order
  std::vector<double> costs;
  std::vector<bool> ordinary;  ///< every vertex of the input is, with that configuration
  std::vector<ErrorTarget> targets;
  /// Evaluates the configuration at a position of `rows` on the input of the sweep.
  std::function<sweep::PointResult(std::size_t)> evaluate;
  DrawState state;            ///< of the draw; the families are drawn with it on a viewport of at most 256x256
  std::string state_options;  ///< that draw with `state`, for the commands that are printed
  std::uint64_t seed = 1;
  unsigned threads = 1;
  bool confirm = true;
  bool exhaustive = false;  ///< evaluate every point of the grid instead of searching: the search's oracle
  std::function<void(const std::string&)> progress;
};

/// How a configuration does on one stress family.
struct FamilyCheck {
  std::string family;
  double miss = 0;   ///< error / limit; NaN: not measured there
  double total = 0;  ///< the same of the total error, whatever the target judges
  std::string target;
  std::string worst;  ///< a command that prints the fragment with the worst weights
  std::uint64_t fragments = 0;
  bool measured = true;  ///< every target's output is there
};

struct TargetResult {
  std::optional<std::size_t> winner;     ///< row of the cheapest point that meets the targets on the input
  std::optional<std::size_t> confirmed;  ///< row of the cheapest that meets them on the families that measure them too
  std::size_t evaluations = 0;           ///< on the input, until the winner was known
  std::size_t confirm_evaluations = 0;   ///< further points, because a family refuted a winner
  double closest = 0;                    ///< of the points evaluated on the input, the miss nearest to 1, as a ratio
  std::size_t closest_row = 0;
  std::vector<FamilyCheck> families;  ///< of the confirmed point, or of the winner when none was confirmed
  double confirm_closest = 0;         ///< when none was confirmed: the point nearest to it, its miss over all families
  std::size_t confirm_closest_row = 0;
};

/// Families that say nothing of some target: depth is off, no such fragment, or the configuration cannot draw them.
std::vector<std::string> unmeasured(const TargetResult& result);

/// The row that answers the search: confirmed, else the winner, else the closest.
inline std::size_t answer_row(const TargetResult& result) {
  return result.confirmed ? *result.confirmed : result.winner ? *result.winner : result.closest_row;
}

TargetResult search_target(const TargetSearch& search);

nlohmann::ordered_json to_json(const TargetResult& result);

}  // namespace quadrille::tb
