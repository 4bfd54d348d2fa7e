// The probes' side of model/port/boundaries.hpp in SystemVerilog.
#pragma once

#include <string>

namespace quadrille::tb {

/// What quadrille_probed.sv includes, the same for every configuration: a package with a packed struct for each
/// boundary, and macros with its ports and with the connections of all boundaries but `tile`.
std::string probes_header();

}  // namespace quadrille::tb
