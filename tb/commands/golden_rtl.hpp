// The RTL as an engine of `quadrille golden verify`: the replay benches under Verilator.
#pragma once

#include "golden/vectors/suite.hpp"

#include <map>
#include <string>
#include <vector>

namespace quadrille::tb {

/// Replays the suites of a set (scripts/replay.sh); suites without RTL are not in the result. Throws EnvironmentError
/// when the script or a tool is missing, InputError when the replay cannot read the set.
std::map<std::string, vectors::VerifyResult> replay_rtl(const std::string& directory,
                                                        const std::vector<std::string>& suites);

}  // namespace quadrille::tb
