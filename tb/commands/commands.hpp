// The commands of the program; each adds its options and, when chosen, sets Invocation::run.
#pragma once

#include "tb/options/options.hpp"

namespace quadrille::tb {

void add_cosim_command(CLI::App& app, Invocation& invocation);
void add_render_command(CLI::App& app, Invocation& invocation);
void add_fragments_command(CLI::App& app, Invocation& invocation);
void add_config_command(CLI::App& app, Invocation& invocation);
void add_scenes_command(CLI::App& app, Invocation& invocation);
void add_sweep_command(CLI::App& app, Invocation& invocation);
void add_golden_command(CLI::App& app, Invocation& invocation);
void add_cache_command(CLI::App& app, Invocation& invocation);
void add_golden_diff_command(CLI::App& golden, Invocation& invocation);  ///< below the command golden

/// Adds the commands of the studies and sets what else they bring; null in the core (no_studies.cpp). The program
/// quadrille-studies has the same main().
extern void (*const add_studies)(CLI::App& app, Invocation& invocation);
inline constexpr const char* bench_description =
    "Speeds of model, references, RTL and lockstep in one run, as ratios; --error: errors beside them";
inline constexpr const char* compare_description = "The papers' methods side by side: pictures, errors, creases";
inline constexpr const char* stress_description =
    "Errors against a knob, towards every special case, of the model, the paper's formulas and others";

}  // namespace quadrille::tb
