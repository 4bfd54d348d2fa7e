#include "tb/studies/bench_widths.hpp"

#include "model/port/draw_state.hpp"
#include "model/untimed.hpp"
#include "tb/judge/check.hpp"
#include "tb/options/input.hpp"
#include "tb/support/stopwatch.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <nlohmann/json.hpp>

namespace quadrille::tb {
namespace {

constexpr std::array<const char*, 14> families{"general", "perspective",  "near_edge",   "sliver", "reflex",
                                               "bowtie",  "long_span",    "coplanar",    "huge",   "any_w",
                                               "w_zero",  "eye_crossing", "eye_in_hull", "on_edge"};
struct Widths {
  int significand_bits, align_guard_bits;
};
constexpr std::array<Widths, 6> widths{{{8, 2}, {12, 0}, {18, 2}, {18, 6}, {22, 2}, {26, 6}}};
constexpr int width_side = 256, width_quads = 3000;
constexpr std::uint64_t least_fragments = 64, most_fragments = 20'000;
constexpr double shortest_width_run = 2e-3;

/// Quads that are neither so small that setting them up counts, nor so large that one is all.
std::vector<SnappedQuad> quads_of(const char* family, const Config& config, const DrawState& state, std::uint64_t seed,
                                  std::uint64_t enough) {
  InputOptions options;
  options.stress = family;
  options.count = width_quads;
  std::vector<SnappedQuad> kept;
  UntimedModel model(config, state);
  std::uint64_t total = 0, looked_at = 0;
  const DrawInput input = load_input(options, "", state, config, seed);
  for (const WindowQuad& quad : input.quads) {
    if (total >= enough || looked_at >= 50 * enough) break;
    const SnappedQuad snapped = snap_as(quad, static_cast<std::uint32_t>(kept.size()), config, state);
    std::uint64_t fragments = 0;
    model.draw_arrays(snapped, [&](const FragmentArrays& some) { fragments += some.size; });
    looked_at += fragments;
    if (fragments < least_fragments || fragments > most_fragments) continue;
    kept.push_back(snapped);
    total += fragments;
  }
  return kept;
}

}  // namespace

std::vector<WidthCost> measure_widths(const Config& config, std::uint64_t seed, int repeat, std::uint64_t fragments) {
  std::vector<WidthCost> costs;
  const LaneTarget before = lane_target();
  for (const char* family : families)
    for (const Widths& of : widths) {
      Config c = config;
      c.set("significand_bits", of.significand_bits);
      c.set("align_guard_bits", of.align_guard_bits);
      c.validate();
      const DrawState state = draw_state_for(c, width_side, width_side);
      const std::vector<SnappedQuad> quads = quads_of(family, c, state, seed, fragments);
      WidthCost cost{family, of.significand_bits, of.align_guard_bits, quads.size(), 0, 0, {}};
      for (const LaneTarget target : lane_targets()) {
        cost.ns.push_back(0);
        if (!can_run(target)) continue;
        set_lane_target(target);
        UntimedModel model(c, state);
        double least = std::numeric_limits<double>::infinity();
        for (int n = 0; n < repeat; ++n) {
          const CpuStopwatch stopwatch;
          std::uint64_t drawn = 0;
          do {
            const std::uint64_t before_pixels = model.stats().pixels;
            cost.fragments = 0;
            for (const SnappedQuad& quad : quads)
              model.draw_arrays(quad, [&](const FragmentArrays& some) { cost.fragments += some.size; });
            cost.pixels = model.stats().pixels - before_pixels;
            drawn += cost.pixels;
          } while (stopwatch.seconds() < shortest_width_run);
          least = std::min(least, 1e9 * stopwatch.seconds() / static_cast<double>(std::max<std::uint64_t>(drawn, 1)));
        }
        cost.ns.back() = least;
      }
      costs.push_back(std::move(cost));
    }
  set_lane_target(before);
  return costs;
}

double quickest(const std::vector<WidthCost>& costs, std::size_t target) {
  double least = std::numeric_limits<double>::infinity();
  for (const WidthCost& cost : costs)
    if (cost.ns[target] > 0) least = std::min(least, cost.ns[target]);
  return least;
}

void print_widths(std::FILE* text, const std::vector<WidthCost>& costs) {
  std::fprintf(
      text,
      "\nThe model by family, significand_bits (s), align_guard_bits (guard) and instruction set: ns a covered "
      "pixel, set-up of quads included;\nratio: to the least of the column. Quads of %llu to %llu fragments "
      "each; fragments: the pixels that are drawn\n\n",
      static_cast<unsigned long long>(least_fragments), static_cast<unsigned long long>(most_fragments));
  std::fprintf(text, "%-14s %3s %6s %6s %9s %9s", "", "s", "guard", "quads", "pixels", "fragments");
  for (const LaneTarget target : lane_targets())
    std::fprintf(text, "  %9s ratio", (std::string(name(target)) + (can_run(target) ? "" : " -")).c_str());
  std::fputs("\n", text);
  for (const WidthCost& cost : costs) {
    std::fprintf(text, "%-14s %3d %6d %6zu %9llu %9llu", cost.family.c_str(), cost.significand_bits,
                 cost.align_guard_bits, cost.quads, static_cast<unsigned long long>(cost.pixels),
                 static_cast<unsigned long long>(cost.fragments));
    for (std::size_t t = 0; t < cost.ns.size(); ++t) {
      if (cost.ns[t] > 0)
        std::fprintf(text, "  %9.1f %5.1f", cost.ns[t], cost.ns[t] / quickest(costs, t));
      else
        std::fprintf(text, "  %9s %5s", "-", "-");
    }
    std::fputs("\n", text);
  }
}

nlohmann::ordered_json widths_report(const std::vector<WidthCost>& costs) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const WidthCost& cost : costs) {
    nlohmann::ordered_json row{{"family", cost.family},
                               {"significand_bits", cost.significand_bits},
                               {"align_guard_bits", cost.align_guard_bits},
                               {"quads", cost.quads},
                               {"pixels", cost.pixels},
                               {"fragments", cost.fragments}};
    for (std::size_t t = 0; t < cost.ns.size(); ++t) {
      if (cost.ns[t] <= 0) continue;
      nlohmann::ordered_json& of = row["targets"][std::string(name(lane_targets()[t]))];
      of["ns"] = cost.ns[t];
      of["of_quickest"] = cost.ns[t] / quickest(costs, t);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace quadrille::tb
