// Performance counters as reports have them.
#pragma once

#include "model/port/performance_counters.hpp"
#include "tb/engines/engine.hpp"
#include "tb/options/options.hpp"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace quadrille::tb {

/// An object with a number for each counter, by name and in their order.
nlohmann::ordered_json counters_json(const PerformanceCounters& counters);

/// Some lines of a summary. `whose`: what they are of, a word or two that end the first line.
void print_counters(std::FILE* out, const PerformanceCounters& counters, std::string_view whose);

/// What most clocks are charged to, idle ones and those that wipe apart: a counter bound_*.
PerformanceCounter most_bound(const PerformanceCounters& counters);
/// The rest of its name.
std::string bound_name(PerformanceCounter bound);

/// Whether a draw that does not need the clocked model runs it for its counters: where there is a place for them.
inline bool reports_counters(const CommonOptions& common) { return !common.json.empty() || common.verbose; }

/// What a machine counts that draws the quads as an engine with these settings does, with weights: the clocked model on
/// all of them in one run from reset, of several passes the first. None, and no run, where the engine is no machine.
/// Throws SnapError.
std::optional<PerformanceCounters> count_draw(const EngineSettings& settings, std::span<const WindowQuad> quads,
                                              int attributes);

}  // namespace quadrille::tb
