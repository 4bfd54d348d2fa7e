// Where a point of `quadrille sweep` stands beside a target: its arithmetic, snapping and total error, and the key that
// would lower what is in the way. A target judges one of the three; the other two are said all the same.
#pragma once

#include "tb/commands/sweep_target.hpp"

#include <nlohmann/json.hpp>

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace quadrille::tb {

/// One key with one more bit (of a table: twice the segments), and the errors with it.
struct Remedy {
  std::string change;  ///< as --set takes it; several where the position format needs room
  double part = 0, total = 0;
};

struct TargetParts {
  ErrorTarget target;
  double arithmetic = 0, snapping = 0, total = 0;  ///< NaN: not measured on this input
  std::optional<sweep::ErrorKind> in_the_way;      ///< the larger part of a total above the limit
  std::optional<Remedy> remedy;                    ///< lowers that part by a tenth or more; of several the best total
  std::vector<std::string> no_remedy;              ///< keys tried, each with what became of it

  double part() const { return *in_the_way == sweep::ErrorKind::snapping ? snapping : arithmetic; }
};

/// Evaluates configurations on the sweep's input, in order.
using EvaluateAll = std::function<std::vector<sweep::PointResult>(std::span<const Config>)>;

/// `result` is of `config`. `ordinary`: all vertices of the input are. Evaluates only where a total is above its limit.
TargetParts target_parts(const ErrorTarget& target, const Config& config, const sweep::PointResult& result,
                         bool ordinary, const DrawState& state, const EvaluateAll& evaluate);

/// What follows, in full sentences: whether the total meets the target, what is in the way, and what lowers it.
std::string verdict(const TargetParts& parts);

nlohmann::ordered_json to_json(const TargetParts& parts);

}  // namespace quadrille::tb
