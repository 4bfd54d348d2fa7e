#include "tb/commands/counters_report.hpp"

#include <string>

namespace quadrille::cli {

nlohmann::ordered_json counters_json(const PerformanceCounters& counters) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < counter_count; ++i) json[std::string(counter_info[i].name)] = counters.value[i];
  return json;
}

void print_counters(std::FILE* out, const PerformanceCounters& counters, bool compared) {
  using enum PerformanceCounter;
  const auto number = [&](PerformanceCounter counter) { return static_cast<unsigned long long>(counters[counter]); };
  std::fprintf(
      out,
      "  counters       blocks %llu of %llu, tiles %llu of %llu (%llu hidden), rows %llu of %llu, pixels %llu; %s\n",
      number(blocks_entered), number(blocks_tested), number(tiles_entered), number(tiles_tested), number(tiles_hidden),
      number(stamps), number(rows_tested), static_cast<unsigned long long>(counters.pixels()),
      compared ? "the RTL's are the same" : "of the model (performance_counters=0)");
  const auto all = static_cast<double>(counters[clocks]);
  std::fputs("                 clocks bound by", out);
  for (auto i = static_cast<std::size_t>(bound_pixels); i < counter_count; ++i)
    std::fprintf(out, "%s %s %.1f %%", i == static_cast<std::size_t>(bound_pixels) ? "" : ",",
                 std::string(counter_info[i].name.substr(6)).c_str(),
                 all > 0 ? 100 * static_cast<double>(counters.value[i]) / all : 0);
  std::fprintf(out, "\n                 %llu products\n", static_cast<unsigned long long>(counters.products()));
}

}  // namespace quadrille::cli
