// A short co-simulation for the model's mutants: mutants_test.cpp links this program again with one source file of the
// model changed. Exit status 0: RTL and model agreed and fragments were compared; 1: they differed; anything else: it
// did not run.
#include "tb/lockstep/lockstep.hpp"
#include "tb/mutants/scenario.hpp"

#include <cstdio>
#include <exception>

int main() {
  using namespace quadrille::tb;
  try {
    const LockstepOptions options = mutant_options();
    const LockstepReport report = run_lockstep(mutant_quads(options), options);
    std::printf("%llu fragments, %llu mismatches, %llu cycle mismatches\n%s\n",
                static_cast<unsigned long long>(report.fragments), static_cast<unsigned long long>(report.mismatches),
                static_cast<unsigned long long>(report.cycle_mismatches),
                report.first_divergence.value_or("agreed").c_str());
    if (!report.agreed()) return 1;
    return report.complete && report.fragments > 0 ? 0 : 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
}
