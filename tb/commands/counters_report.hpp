// Performance counters as reports have them.
#pragma once

#include "model/performance_counters.hpp"

#include <nlohmann/json.hpp>

#include <cstdio>

namespace quadrille::cli {

/// An object with a number for each counter, by name and in their order.
nlohmann::ordered_json counters_json(const PerformanceCounters& counters);

/// Some lines of a summary. `compared`: the RTL has counters too, and they were the same.
void print_counters(std::FILE* out, const PerformanceCounters& counters, bool compared);

}  // namespace quadrille::cli
