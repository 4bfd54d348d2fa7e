// What a fragment takes in the model, by family of quads, widths and instruction set.
#pragma once

#include "model/port/config.hpp"
#include "model/support/lane_target.hpp"

#include <cstdint>
#include <cstdio>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace quadrille::tb {

/// One family with one pair of widths.
struct WidthCost {
  std::string family;
  int significand_bits = 0, align_guard_bits = 0;
  std::size_t quads = 0;
  std::uint64_t pixels = 0, fragments = 0;  ///< covered; not discarded
  std::vector<double> ns;  ///< of a pixel, set-up included; a place for each of lane_targets(), 0 where it cannot run
};

/// Quads of at least 64 fragments, some `fragments` in all, each draw `repeat` times; the quickest counts.
std::vector<WidthCost> measure_widths(const Config& config, std::uint64_t seed, int repeat, std::uint64_t fragments);
/// The quickest case of a target, in ns.
double quickest(const std::vector<WidthCost>& costs, std::size_t target);
void print_widths(std::FILE* text, const std::vector<WidthCost>& costs);
nlohmann::ordered_json widths_report(const std::vector<WidthCost>& costs);

}  // namespace quadrille::tb
