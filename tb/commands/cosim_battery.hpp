// cosim --battery: groups of draws that between them reach every part of the machine, for whoever has changed the RTL.
#pragma once

#include "tb/commands/cosim_draws.hpp"
#include "tb/commands/cosim_options.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace quadrille::tb {

/// Draws of one machine. Every group is complete: no limit of fragments cuts off what its last draws are about.
struct BatteryGroup {
  std::string name;                   ///< CONFIGURATION.INPUT
  std::vector<std::string> settings;  ///< of the configuration, "key=value"
  std::function<std::vector<PlannedDraw>(const Config&, std::uint64_t seed)> draws;
};

/// In the order in which they run: those that see most come first.
std::vector<BatteryGroup> battery_groups();

/// Runs them, or those that --battery names; the exit status.
int run_battery(const CosimOptions& options, const Config& config, const std::vector<std::string>& arguments);

}  // namespace quadrille::tb
