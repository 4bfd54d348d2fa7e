#include "model/support/lane_target.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <stdexcept>

namespace quadrille {
namespace {

#ifdef QUADRILLE_LANE_TARGETS
constexpr std::array compiled{LaneTarget::baseline, LaneTarget::v2, LaneTarget::v3, LaneTarget::v4};
#else
constexpr std::array compiled{LaneTarget::baseline};
#endif

LaneTarget best() {
  return *std::find_if(compiled.rbegin(), compiled.rend(), [](LaneTarget target) { return can_run(target); });
}

/// Found by the first one who asks, which may be the initialisation of another object.
constexpr LaneTarget unknown = static_cast<LaneTarget>(-1);
constinit std::atomic<LaneTarget> in_use = unknown;

}  // namespace

std::span<const LaneTarget> lane_targets() { return compiled; }

std::string_view name(LaneTarget target) {
  constexpr std::array<std::string_view, 4> names{"baseline", "v2", "v3", "v4"};
  return names[static_cast<std::size_t>(target)];
}

bool can_run(LaneTarget target) {
#ifdef QUADRILLE_LANE_TARGETS
  // Features by name, as Clang 14 knows no levels; those that are left out come with the others.
  const bool v2 = __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("popcnt");
  const bool v3 = v2 && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                  __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
  if (target == LaneTarget::v2) return v2;
  if (target == LaneTarget::v3) return v3;
  if (target == LaneTarget::v4)
    return v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl");
#endif
  return target == LaneTarget::baseline;
}

LaneTarget lane_target() {
  const LaneTarget chosen = in_use.load(std::memory_order_relaxed);
  if (chosen != unknown) return chosen;
  LaneTarget expected = unknown;
  in_use.compare_exchange_strong(expected, best());  // who chose meanwhile is heard
  return in_use.load(std::memory_order_relaxed);
}

void set_lane_target(LaneTarget target) {
  if (!can_run(target))
    throw std::invalid_argument("lanes " + std::string(name(target)) +
                                ": this processor cannot run them; the best is " + std::string(name(best())));
  in_use = target;
}

void set_lane_target(std::string_view wanted) {
  std::string names;
  for (const LaneTarget target : compiled) {
    if (name(target) == wanted) return set_lane_target(target);
    names += (names.empty() ? "" : ", ") + std::string(name(target));
  }
  throw std::invalid_argument("unknown instruction set \"" + std::string(wanted) + "\"; expected one of " + names);
}

}  // namespace quadrille
