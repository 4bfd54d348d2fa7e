// The commands of the program; each adds its options and, when chosen, sets Invocation::run.
#pragma once

#include "tb/options/options.hpp"

namespace quadrille::tb {

void add_cosim_command(CLI::App& app, Invocation& invocation);
void add_render_command(CLI::App& app, Invocation& invocation);
void add_fragments_command(CLI::App& app, Invocation& invocation);
void add_explain_command(CLI::App& app, Invocation& invocation);
void add_config_command(CLI::App& app, Invocation& invocation);
void add_export_command(CLI::App& app, Invocation& invocation);
void add_scenes_command(CLI::App& app, Invocation& invocation);
void add_sweep_command(CLI::App& app, Invocation& invocation);
void add_golden_command(CLI::App& app, Invocation& invocation);
void add_cache_command(CLI::App& app, Invocation& invocation);
void add_golden_diff_command(CLI::App& golden, Invocation& invocation);  ///< below the command golden

/// Adds the commands of the studies and sets what else they bring; null in the core (no_studies.cpp). The program
/// quadrille-studies has the same main().
extern void (*const add_studies)(CLI::App& app, Invocation& invocation);
inline constexpr const char *bench_description = "Measure the speed of the engines; with --error also their errors",
                            *compare_description = "Compare the papers' methods: pictures, errors, creases",
                            *stress_description = "Measure errors of the engines towards special cases";

}  // namespace quadrille::tb
