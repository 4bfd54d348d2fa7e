// The commands of the program; each adds its options and, when chosen, sets Invocation::run.
#pragma once

#include "tb/options/options.hpp"

namespace quadrille::cli {

void add_cosim_command(CLI::App& app, Invocation& invocation);
void add_render_command(CLI::App& app, Invocation& invocation);
void add_fragments_command(CLI::App& app, Invocation& invocation);
void add_config_command(CLI::App& app, Invocation& invocation);
void add_scenes_command(CLI::App& app, Invocation& invocation);
void add_bench_command(CLI::App& app, Invocation& invocation);
void add_sweep_command(CLI::App& app, Invocation& invocation);
void add_compare_command(CLI::App& app, Invocation& invocation);
void add_golden_command(CLI::App& app, Invocation& invocation);
void add_stress_command(CLI::App& app, Invocation& invocation);
void add_cache_command(CLI::App& app, Invocation& invocation);
void add_golden_diff_command(CLI::App& golden, Invocation& invocation);  ///< below the command golden

}  // namespace quadrille::cli
