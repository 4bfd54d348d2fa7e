#include "tb/judge/function_check.hpp"

#include "tb/judge/function_tally.hpp"

#include <algorithm>
#include <numeric>

namespace quadrille::tb {

std::uint64_t FunctionReport::arguments() const {
  return std::accumulate(functions.begin(), functions.end(), std::uint64_t{0},
                         [](std::uint64_t sum, const FunctionResult& f) { return sum + f.arguments; });
}

std::uint64_t FunctionReport::beyond() const {
  return std::accumulate(functions.begin(), functions.end(), std::uint64_t{0},
                         [](std::uint64_t sum, const FunctionResult& f) { return sum + f.beyond; });
}

std::string FunctionReport::first() const {
  const auto fault = std::ranges::find_if(functions, [](const FunctionResult& f) { return f.beyond > 0; });
  return fault == functions.end() ? std::string{} : std::string(fault->name) + ": " + fault->first;
}

FunctionReport check_functions(const Config& config) {
  FunctionReport report;
  check_arithmetic(config, report.functions);
  check_pixel_stages(config, report.functions);
  check_front(config, report.functions);
  return report;
}

}  // namespace quadrille::tb
