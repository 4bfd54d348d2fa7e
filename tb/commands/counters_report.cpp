#include "tb/commands/counters_report.hpp"

#include "tb/lockstep/lockstep.hpp"

#include <string>

namespace quadrille::tb {

nlohmann::ordered_json counters_json(const PerformanceCounters& counters) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < counter_count; ++i) json[std::string(counter_info[i].name)] = counters.value[i];
  return json;
}

void print_counters(std::FILE* out, const PerformanceCounters& counters, std::string_view whose) {
  using enum PerformanceCounter;
  const auto number = [&](PerformanceCounter counter) { return static_cast<unsigned long long>(counters[counter]); };
  std::fprintf(out,
               "  counters       %s\n"
               "                 blocks %llu of %llu (%llu hidden)\n"
               "                 tiles %llu of %llu (%llu hidden, %llu masked)\n"
               "                 rows %llu of %llu, pixels %llu (%llu of plane quads), %llu products\n",
               std::string(whose).c_str(), number(blocks_entered), number(blocks_tested), number(blocks_hidden),
               number(tiles_entered), number(tiles_tested), number(tiles_hidden), number(tiles_masked), number(stamps),
               number(rows_tested), static_cast<unsigned long long>(counters.pixels()), number(pixels_plane),
               static_cast<unsigned long long>(counters.products()));
  const auto all = static_cast<double>(counters[clocks]);
  std::string bounds;
  for (auto i = static_cast<std::size_t>(bound_pixels); i < counter_count; ++i) {
    if (counters.value[i] == 0) continue;
    char percent[32];
    std::snprintf(percent, sizeof percent, " %.1f %%", 100 * static_cast<double>(counters.value[i]) / all);
    bounds += (bounds.empty() ? " " : ", ") + bound_name(static_cast<PerformanceCounter>(i)) + percent;
  }
  if (!bounds.empty()) std::fprintf(out, "                 clocks bound by%s\n", bounds.c_str());
}

PerformanceCounter most_bound(const PerformanceCounters& counters) {
  using enum PerformanceCounter;
  auto most = static_cast<std::size_t>(bound_pixels);
  for (std::size_t i = most; i < static_cast<std::size_t>(bound_idle); ++i)
    if (i != static_cast<std::size_t>(bound_wipe) && counters.value[i] > counters.value[most]) most = i;
  return static_cast<PerformanceCounter>(most);
}

std::string bound_name(PerformanceCounter bound) {
  return std::string(counter_info[static_cast<std::size_t>(bound)].name.substr(sizeof "bound_" - 1));
}

std::optional<PerformanceCounters> count_draw(const EngineSettings& settings, std::span<const WindowQuad> quads,
                                              int attributes) {
  if (!engine_info(settings.kind).machine) return std::nullopt;
  const Pass pass = plan_passes(attributes, true, settings.config).front();
  LockstepOptions options;
  options.config = settings.config;
  options.state = settings.state;
  options.state.attributes = static_cast<int>(pass.columns.size());
  options.seed = settings.seed;
  options.stall = settings.stall;
  options.gap = settings.gap;
  return run_clocked_model_alone(snap_pass(quads, pass, options.config, options.state), options).counters;
}

}  // namespace quadrille::tb
