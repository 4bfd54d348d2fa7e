// The studies: what examines the machine beside what co-simulates, sweeps and makes golden vectors.
#pragma once

#include "tb/options/options.hpp"

namespace quadrille::tb {

void add_bench_command(CLI::App& app, Invocation& invocation);
void add_compare_command(CLI::App& app, Invocation& invocation);
void add_stress_command(CLI::App& app, Invocation& invocation);

}  // namespace quadrille::tb
