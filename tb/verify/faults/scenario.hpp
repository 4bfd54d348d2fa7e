// The draws that every mutant is put through: short, and each hard on other parts of the machine.
#pragma once

#include "tb/lockstep/lockstep.hpp"

#include <span>
#include <string>
#include <vector>

namespace quadrille::tb {

struct Scenario {
  std::string name;
  LockstepOptions options;         ///< configuration, state, stalls
  std::vector<SnappedQuad> quads;  ///< ids from 0
  bool invisible = false;          ///< the machine draws nothing of it
  bool again = false;  ///< lockstep draws it twice in one machine, with a reset between: what it keeps shows
};

/// Those that the record names. The same in every process, of few configurations: each takes a simulator.
std::span<const Scenario> scenarios();
/// Those that a generated mutant goes through after them, each made for what none of the others showed.
std::span<const Scenario> further_scenarios();

}  // namespace quadrille::tb
