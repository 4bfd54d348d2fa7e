#include "tb/commands/sweep_target.hpp"

#include "golden/scenes/stress.hpp"
#include "model/port/draw_state.hpp"
#include "model/port/snap.hpp"
#include "model/untimed.hpp"
#include "tb/options/options.hpp"
#include "tb/support/errors.hpp"
#include "tb/sweep/search.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <memory>

namespace quadrille::tb {
namespace {

constexpr int family_size = 256;  // pixels
constexpr std::size_t family_quads = 1000;
constexpr std::uint64_t family_fragments = 60'000;  // full-screen families end here

double number(std::string_view text, const std::string& whole) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
    throw UsageError("--target-error " + whole + ": \"" + std::string(text) +
                     "\" is not a number; expected such as lambda=2^-12, colour=0.5/255 or depth=1e-6");
  return value;
}

double factor(std::string_view text, const std::string& whole) {
  const std::size_t caret = text.find('^');
  if (caret == std::string_view::npos) return number(text, whole);
  return std::pow(number(text.substr(0, caret), whole), number(text.substr(caret + 1), whole));
}

/// A family's quads, as many as give about family_fragments fragments.
struct Family {
  std::string name;
  std::size_t count = 0;
  sweep::SweepInput input;
};

std::vector<Family> make_families(const TargetSearch& search) {
  std::vector<Family> families;
  for (const golden::StressFamilyInfo& info : golden::stress_families()) {
    Family family;
    family.name = info.name;
    DrawState& state = family.input.state = search.state;
    state.width = std::min(family_size, state.width);
    state.height = std::min(family_size, state.height);
    state.scissor_x0 = state.scissor_y0 = 0;
    state.scissor_x1 = state.width;
    state.scissor_y1 = state.height;
    state.attributes = 0;
    family.input.attributes = 4;
    family.input.quads = golden::make_stress(info.family, family_quads, search.seed, 1, state.width, state.height);
    std::uint64_t fragments = 0;
    const Config config;
    UntimedModel model(config, with_possible_skips(state, config));
    while (family.count < family.input.quads.size() && fragments < family_fragments)
      model.draw_arrays(snap_quad(family.input.quads[family.count++], config, state),
                        [&](const FragmentArrays& drawn) { fragments += drawn.size; });
    family.input.quads.resize(family.count);
    families.push_back(std::move(family));
  }
  return families;
}

}  // namespace

ErrorTarget parse_target(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw UsageError("--target-error " + text + ": expected COLUMN=VALUE, such as lambda=2^-12");
  ErrorTarget target;
  target.text = text;
  try {
    target.column = sweep::parse_error_column(text.substr(0, equals));
  } catch (const ConfigError& error) {
    throw UsageError("--target-error " + text + ": " + error.what());
  }
  const std::string_view value = std::string_view(text).substr(equals + 1);
  const std::size_t slash = value.find('/');
  target.limit = factor(value.substr(0, slash), text);
  if (slash != std::string_view::npos) target.limit /= factor(value.substr(slash + 1), text);
  if (!(target.limit > 0) || !std::isfinite(target.limit))
    throw UsageError("--target-error " + text + ": the largest error must be a number above 0");
  return target;
}

double target_miss(const sweep::PointResult& result, std::span<const ErrorTarget> targets) {
  double miss = 0;
  for (const ErrorTarget& target : targets) {
    const double ratio = target.column.value(result) / target.limit;
    if (std::isnan(ratio)) return ratio;
    miss = std::max(miss, ratio);
  }
  return miss;
}

namespace {

/// The search, growing by every family that refutes a winner.
class Search {
 public:
  explicit Search(const TargetSearch& search) : search_(search) {
    for (std::size_t i = 0; i < search.configs.size(); ++i)
      points_.push_back({search.configs[i], search.costs[i], search.ordinary[i]});
    std::vector<sweep::Output> measured;
    for (const ErrorTarget& target : search.targets) measured.push_back(target.column.output);
    idle_keys_ = sweep::idle_keys(measured);
  }

  TargetResult run() {
    TargetResult result;
    if (search_.exhaustive)
      for (std::size_t i = 0; i < points_.size(); ++i) input_miss(i);
    const sweep::SearchResult first = find();
    result.evaluations = missed_.size();
    find_closest(result);
    if (!first.winner) return result;
    result.winner = search_.rows[*first.winner];
    if (search_.confirm) confirm(*first.winner, result);
    return result;
  }

 private:
  sweep::SearchResult find() {
    return sweep::cheapest_meeting(
        points_, [&](std::size_t i) { return miss(i); }, sweep::sampled_slack, idle_keys_);
  }

  /// By the ratio: half the target is as far from it as twice. An error of 0 or none is as far as can be.
  void find_closest(TargetResult& result) const {
    double least = std::numeric_limits<double>::infinity();
    result.closest = least;
    for (const auto& [point, miss] : missed_) {
      const double distance = std::fabs(std::log2(miss));
      if (!(distance < least) && !(std::isinf(least) && miss < result.closest)) continue;
      least = distance;
      result.closest = miss;
      result.closest_row = search_.rows[point];
    }
  }

  double input_miss(std::size_t point) {
    const auto known = missed_.find(point);
    if (known != missed_.end()) return known->second;
    if (search_.progress) search_.progress("point " + std::to_string(missed_.size() + 1));
    return missed_[point] = target_miss(search_.evaluate(point), search_.targets);
  }

  /// Over the input and the families that have refuted a winner; no more than is needed to know that it is above 1. A
  /// family that does not have an output says nothing.
  double miss(std::size_t point) {
    double worst = input_miss(point);
    if (!(worst <= 1)) return worst;
    for (const std::size_t family : refuting_) worst = std::max(worst, std::max(0.0, family_miss(family, point)));
    if (!refuting_.empty() && worst < closest_) {
      closest_ = worst;
      closest_point_ = point;
    }
    return worst;
  }

  const sweep::PointResult& on_family(std::size_t family, std::size_t point) {
    const auto key = std::pair(family, point);
    const auto known = family_results_.find(key);
    if (known != family_results_.end()) return known->second;
    sweep::Evaluator::Settings settings;
    settings.threads = search_.threads;
    settings.cycles = false;
    if (!evaluators_[family])
      evaluators_[family] = std::make_unique<sweep::Evaluator>(families_[family].input, settings);
    if (search_.progress) search_.progress("stress family " + families_[family].name);
    return family_results_[key] = evaluators_[family]->evaluate(points_[point].config);
  }

  double family_miss(std::size_t family, std::size_t point) {
    double worst = std::numeric_limits<double>::quiet_NaN();
    for (const ErrorTarget& target : search_.targets)
      worst = std::fmax(worst, target.column.value(on_family(family, point)) / target.limit);
    return worst;
  }

  double family_total(std::size_t family, std::size_t point) {
    double worst = std::numeric_limits<double>::quiet_NaN();
    for (const ErrorTarget& target : search_.targets) {
      const sweep::ErrorColumn total{sweep::ErrorKind::total, target.column.output, target.column.statistic};
      worst = std::fmax(worst, total.value(on_family(family, point)) / target.limit);
    }
    return worst;
  }

  std::vector<FamilyCheck> check_families(std::size_t point) {
    std::vector<FamilyCheck> checks;
    for (std::size_t f = 0; f < families_.size(); ++f) {
      const sweep::PointResult& result = on_family(f, point);
      FamilyCheck check{families_[f].name, family_miss(f, point), family_total(f, point), {}, {}, result.fragments};
      for (const ErrorTarget& target : search_.targets) {
        const double miss = target.column.value(result) / target.limit;
        if (miss == check.miss) check.target = target.text;
        check.measured = check.measured && !std::isnan(miss);
      }
      if (result.worst.any)
        check.worst = "quadrille fragments --engine model --stress " + families_[f].name + " --count " +
                      std::to_string(family_quads) + spelled(points_[point].config) + " --size " +
                      std::to_string(families_[f].input.state.width) + "x" +
                      std::to_string(families_[f].input.state.height) + " --seed " + std::to_string(search_.seed) +
                      search_.state_options + " --quad " + std::to_string(result.worst.index) + " --pixel " +
                      std::to_string(result.worst.x) + "," + std::to_string(result.worst.y) + " --out -";
      checks.push_back(std::move(check));
    }
    return checks;
  }

  void confirm(std::size_t winner, TargetResult& result) {
    families_ = make_families(search_);
    evaluators_.resize(families_.size());
    const std::size_t before = missed_.size();
    std::size_t candidate = winner;
    for (;;) {
      std::vector<FamilyCheck> checks = check_families(candidate);
      const auto worst = std::max_element(checks.begin(), checks.end(), [](const FamilyCheck& a, const FamilyCheck& b) {
        return std::fmax(a.miss, 0.0) < std::fmax(b.miss, 0.0);
      });
      if (std::ranges::none_of(checks, &FamilyCheck::measured)) {  // nothing speaks against it, and nothing for it
        result.families = checks;
        result.confirm_closest = std::numeric_limits<double>::quiet_NaN();
        result.confirm_closest_row = search_.rows[candidate];
        break;
      }
      const bool met = !(worst->miss > 1);
      if (result.families.empty() || met) result.families = checks;
      if (met) {
        result.confirmed = search_.rows[candidate];
        break;
      }
      refute(static_cast<std::size_t>(worst - checks.begin()));
      closest_ = std::numeric_limits<double>::infinity();  // of what met fewer families nothing is known
      const sweep::SearchResult next = find();
      if (!next.winner) {
        // The search saw only the families that refuted a winner; what is said of the point is of all.
        result.confirm_closest = closest_;
        for (std::size_t f = 0; f < families_.size(); ++f)
          result.confirm_closest = std::fmax(result.confirm_closest, family_miss(f, closest_point_));
        result.confirm_closest_row = search_.rows[closest_point_];
        break;
      }
      candidate = *next.winner;
    }
    result.confirm_evaluations = missed_.size() - before;
  }

  /// From now on miss() is measured on this family too.
  void refute(std::size_t family) {
    refuting_.push_back(family);
    sweep::OrdinaryInput ordinary(families_[family].input);
    for (sweep::SearchPoint& point : points_) point.ordinary = point.ordinary && ordinary(point.config);
  }

  const TargetSearch& search_;
  std::vector<sweep::SearchPoint> points_;
  std::vector<std::string_view> idle_keys_;
  std::map<std::size_t, double> missed_;  ///< input_miss() by point
  std::vector<Family> families_;
  std::vector<std::unique_ptr<sweep::Evaluator>> evaluators_;
  std::map<std::pair<std::size_t, std::size_t>, sweep::PointResult> family_results_;
  std::vector<std::size_t> refuting_;
  double closest_ = std::numeric_limits<double>::infinity();  ///< over input and refuting families
  std::size_t closest_point_ = 0;
};

nlohmann::ordered_json row_or_null(const std::optional<std::size_t>& row) {
  return row ? nlohmann::ordered_json(*row) : nlohmann::ordered_json(nullptr);
}

}  // namespace

std::vector<std::string> unmeasured(const TargetResult& result) {
  std::vector<std::string> names;
  for (const FamilyCheck& check : result.families)
    if (!check.measured) names.push_back(check.family);
  return names;
}

TargetResult search_target(const TargetSearch& search) { return Search(search).run(); }

nlohmann::ordered_json to_json(const TargetResult& result) {
  nlohmann::ordered_json json;
  json["winner"] = row_or_null(result.winner);
  json["confirmed"] = row_or_null(result.confirmed);
  json["evaluations"] = result.evaluations;
  json["confirm_evaluations"] = result.confirm_evaluations;
  json["closest"] = {{"row", result.closest_row}, {"error_over_target", result.closest}};
  if (result.winner && !result.confirmed && !result.families.empty())
    json["confirm_closest"] = {{"row", result.confirm_closest_row}, {"error_over_target", result.confirm_closest}};
  for (const FamilyCheck& check : result.families)
    json["families"].push_back({{"family", check.family},
                                {"error_over_target", check.miss},
                                {"total_over_target", check.total},
                                {"target", check.target},
                                {"fragments", check.fragments},
                                {"measured", check.measured},
                                {"worst", check.worst}});
  return json;
}

}  // namespace quadrille::tb
