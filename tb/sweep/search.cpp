#include "tb/sweep/search.hpp"

#include "golden/analysis/range_proof.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <numeric>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

namespace quadrille::sweep {
namespace {

using Errors = ConfigKey::Errors;

/// What a machine can do, such that it is nowhere better than another if no element is larger. An unordered key has two
/// elements, its value and the negative: only equal values are then nowhere better. All values fit: they are below 127.
/// By position of the key in Config::keys(); whole 16-byte words, which compilers compare at once.
struct alignas(16) Abilities {
  std::array<std::int8_t, 2 * Config::most_keys> of{};
  friend auto operator<=>(const Abilities&, const Abilities&) = default;
};

constexpr std::int8_t exact = 127;  ///< as good as every value

/// `ordinary`: of inputs whose vertices are all ordinary.
Abilities abilities(const Config& config, bool ordinary, std::span<const std::string_view> idle_keys) {
  const bool exact_quadratics = config.qdrop() == 0 || (ordinary && keeps_ordinary_products(config));
  const bool takes_quads = config.plane_quads != 0 && std::ranges::find(idle_keys, "plane_quads") == idle_keys.end();
  Abilities result;
  for (std::size_t i = 0; i < Config::keys().size(); ++i) {
    const ConfigKey& key = Config::keys()[i];
    if (key.errors == Errors::none || std::ranges::find(idle_keys, key.name) != idle_keys.end()) continue;
    const auto value = static_cast<std::int8_t>(config.resolved(key.name));
    result.of[2 * i] = value;
    if (key.errors == Errors::unordered) result.of[2 * i + 1] = static_cast<std::int8_t>(-value);
    // Exact D and r² are the same from every origin.
    if (key.name == "tile_log2" && exact_quadratics) result.of[2 * i] = result.of[2 * i + 1] = exact;
    if (key.name == "quadratic_frac_bits" && exact_quadratics && ordinary) result.of[2 * i] = exact;
    // Which quads are plane depends on the port's numbers.
    if (takes_quads && (key.stage == ConfigKey::Stage::normalise || key.stage == ConfigKey::Stage::interpolate))
      result.of[2 * i + 1] = static_cast<std::int8_t>(-value);
  }
  return result;
}

bool nowhere_better(const Abilities& a, const Abilities& b) {
  std::int8_t better = 0;
  for (std::size_t i = 0; i < a.of.size(); ++i)  // without an early end, so that it is vectorised
    better = static_cast<std::int8_t>(better | (a.of[i] > b.of[i] ? -1 : 0));
  return better == 0;
}

/// A point that may still win.
struct Candidate {
  std::size_t point;
  Abilities abilities;
};

/// By rising cost, of equal cost in the order given; of points with equal errors the first.
std::vector<Candidate> all_candidates(std::span<const SearchPoint> points,
                                      std::span<const std::string_view> idle_keys) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return points[i].cost; });
  std::vector<Candidate> candidates;
  std::set<Abilities> seen;
  for (const std::size_t i : order) {
    const Abilities can = abilities(points[i].config, points[i].ordinary, idle_keys);
    if (seen.insert(can).second) candidates.push_back({i, can});
  }
  return candidates;
}

/// The candidate that rules out most in the worse of its outcomes "met" and "clearly missed", of equal ones the
/// cheapest. Of very many candidates an even sample stands for all.
std::size_t most_telling(const std::vector<Candidate>& candidates) {
  constexpr std::size_t most = 1024;
  const std::size_t count = std::min(candidates.size(), most);
  const auto sample = [&](std::size_t i) { return i * candidates.size() / count; };
  std::size_t best = 0, best_ruled_out = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t if_met = count - i;
    if (if_met <= best_ruled_out) break;  // and fewer from here on
    std::size_t if_missed = 0;
    for (std::size_t j = 0; j < count; ++j)
      if_missed += nowhere_better(candidates[sample(j)].abilities, candidates[sample(i)].abilities);
    if (std::min(if_met, if_missed) > best_ruled_out) {
      best_ruled_out = std::min(if_met, if_missed);
      best = sample(i);
    }
  }
  return best;
}

}  // namespace

std::vector<std::string_view> idle_keys(std::span<const Output> measured) {
  const auto depths = static_cast<std::size_t>(std::ranges::count(measured, Output::depth));
  std::vector<std::string_view> keys;
  if (depths == 0) keys.emplace_back("depth_bits");
  if (depths == measured.size()) keys.emplace_back("attribute_frac_bits");
  const auto attributes = static_cast<std::size_t>(std::ranges::count(measured, Output::attribute));
  if (depths + attributes == 0) keys.emplace_back("plane_quads");  // weights and colours keep mean values
  return keys;
}

bool nowhere_better(const Config& a, const Config& b) {
  return nowhere_better(abilities(a, false, {}), abilities(b, false, {}));
}

SearchResult cheapest_meeting(std::span<const SearchPoint> points, const std::function<double(std::size_t)>& miss,
                              double slack, std::span<const std::string_view> idle_keys) {
  SearchResult result;
  result.closest = std::numeric_limits<double>::infinity();
  std::vector<Candidate> candidates = all_candidates(points, idle_keys);
  while (!candidates.empty()) {
    const std::size_t position = most_telling(candidates);
    const Candidate tried = candidates[position];
    const double ratio = miss(tried.point);
    result.evaluated.push_back(tried.point);
    if (ratio < result.closest) {
      result.closest = ratio;
      result.closest_point = tried.point;
    }
    if (ratio <= 1) {
      result.winner = tried.point;  // cheaper than every winner before: those that cost more are gone
      candidates.resize(position);
    } else {
      const bool clearly = !(ratio <= slack);  // negated, so that NaN misses clearly
      std::erase_if(candidates, [&](const Candidate& c) {
        return c.point == tried.point || (clearly && nowhere_better(c.abilities, tried.abilities));
      });
    }
  }
  result.evaluations = result.evaluated.size();
  return result;
}

}  // namespace quadrille::sweep
