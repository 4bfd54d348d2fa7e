// The regression limits of tb/judge/error_limits.json: measures the stress families with several seeds (untimed model
// against the truth), climbs out of each for the worst weight, and writes limits around what it found, or tells which
// seeds are beyond those that are recorded.
//
//   error_limits                           one seed against the recorded limits; status 1 when an error is beyond them
//   error_limits --seeds 24 --record F     sets the limits; those of other widths stay
//
// Headroom: the interval of means over the seeds is widened by --headroom percent of its width at either end, that of
// the largest errors, which scatter with a longer tail, by twice as much; that of the climbs' worst upward by its
// width.
#include "tb/verify/campaign/campaign_options.hpp"

#include "golden/io/atomic_file.hpp"
#include "golden/io/text_input.hpp"
#include "model/support/parallel.hpp"
#include "tb/judge/error_limits.hpp"

#include <algorithm>
#include <cstdio>

namespace quadrille::campaign {
namespace {

using tb::CheckResult;
using tb::ErrorLimits;
using tb::MeasuredErrors;

int run(int argc, char** argv) {
  const Options options(argc, argv,
                        {{"seeds", "1"},
                         {"first-seed", "1001"},
                         {"significand-bits", "12,18,24"},
                         {"headroom", "100"},
                         {"record", ""},
                         {"threads", "0"}});
  const std::uint64_t seeds = options.number("seeds"), first = options.number("first-seed");
  const std::string file = options.text("record");
  const auto headroom = static_cast<double>(options.number("headroom")) / 100;
  ErrorLimits limits =
      file.empty() ? ErrorLimits::recorded() : ErrorLimits::parse(golden::read_file(file, "error limits"));
  const auto families = golden::stress_families();
  std::size_t draws = 0, beyond = 0, without = 0;
  for (const std::uint64_t bits : options.numbers("significand-bits")) {
    const int s = static_cast<int>(bits);
    std::vector<CheckResult> results(families.size() * seeds);
    parallel_for(results.size(), options.threads(), [&](std::size_t i) {
      results[i] = tb::judge_limit_draw(families[i / seeds].family, s, first + i % seeds, PixelEngine::lanes);
    });
    for (std::size_t f = 0; f < families.size(); ++f) {
      std::vector<MeasuredErrors> measured;
      std::uint64_t fragments = 0;
      for (std::size_t i = f * seeds; i < (f + 1) * seeds; ++i) {
        if (!results[i].ok()) {
          std::printf("s %2d %s: %s\n", s, std::string(families[f].name).c_str(), results[i].first.text.c_str());
          return 1;
        }
        measured.emplace_back(results[i]);
        fragments += results[i].compared;
      }
      std::printf("s %2d %-16s %8llu fragments;", s, std::string(families[f].name).c_str(),
                  static_cast<unsigned long long>(fragments));
      for (std::size_t o = 0; o < tb::output_names.size(); ++o) {
        std::vector<double> max, mean;
        for (const MeasuredErrors& m : measured) max.push_back(m.max[o]), mean.push_back(m.mean[o]);
        const auto [low_max, high_max] = std::ranges::minmax(max);
        const auto [low_mean, high_mean] = std::ranges::minmax(mean);
        std::printf(" %s max %.3f-%.3f mean %+.4f..%+.4f", std::string(tb::output_names[o]).c_str(), low_max, high_max,
                    low_mean, high_mean);
      }
      std::printf("\n");
      if (!file.empty()) {
        limits.set(families[f].family, s, measured, headroom);
        continue;
      }
      const ErrorLimits::Family* recorded = limits.find(families[f].name, s);
      if (recorded == nullptr) {
        ++without;
        continue;
      }
      for (std::size_t i = f * seeds; i < (f + 1) * seeds; ++i) {
        ++draws;
        const std::vector<std::string> faults = beyond_limits(*recorded, results[i]);
        beyond += !faults.empty();
        for (const std::string& fault : faults)
          std::printf("  seed %llu: %s\n", static_cast<unsigned long long>(first + (i - f * seeds)), fault.c_str());
      }
    }
    std::vector<double> climbs(families.size() * seeds);
    parallel_for(climbs.size(), options.threads(),
                 [&](std::size_t i) { climbs[i] = tb::limit_climb(families[i / seeds].family, s, first + i % seeds); });
    std::vector<double> worst(seeds, -1);
    for (std::size_t i = 0; i < climbs.size(); ++i) {
      if (climbs[i] < 0) {
        std::printf("s %2d %s: no climb met a drawn pixel\n", s, std::string(families[i / seeds].name).c_str());
        return 1;
      }
      worst[i % seeds] = std::max(worst[i % seeds], climbs[i]);
    }
    const auto [lowest, highest] = std::ranges::minmax(worst);
    std::printf("s %2d climbs: worst weight %.3f-%.3f of 2^-s\n", s, lowest, highest);
    if (!file.empty())
      limits.set_climb(s, tb::LimitRange::around(worst, headroom).high());
    else if (highest > limits.climb(s))
      ++beyond, std::printf("  beyond the limit of %.4g\n", limits.climb(s));
    std::fflush(stdout);
  }
  if (!file.empty()) {
    golden::write_file(file, limits.text(), golden::AtomicFile::Dash::refused);
    return 0;
  }
  std::printf("%zu draws, %zu beyond their limits; %zu without limits\n", draws, beyond, without);
  return beyond > 0 ? 1 : draws == 0 ? 2 : 0;
}

}  // namespace
}  // namespace quadrille::campaign

int main(int argc, char** argv) {
  return quadrille::campaign::guarded("error_limits", quadrille::campaign::run, argc, argv);
}
