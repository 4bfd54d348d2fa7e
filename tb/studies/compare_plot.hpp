// Run time against quality of every method, for `quadrille compare --plot`.
#pragma once

#include "tb/options/input.hpp"
#include "tb/options/options.hpp"

#include <string>
#include <vector>

namespace quadrille::tb {

/// Draws the input with every method, those with a knob at several settings, and writes into `directory` plot.json
/// (error from refine:200, null where no pixel can be compared; seconds and primitives set up) and, through
/// scripts/compare_plot.py, plot_time.png and plot_setup.png. Throws EnvironmentError when Python or its plot library
/// is missing; plot.json stays then.
void write_plot(const DrawInput& input, const EngineSettings& settings, const std::string& directory,
                const CommonOptions& common, const std::vector<std::string>& arguments, int repeats);

}  // namespace quadrille::tb
