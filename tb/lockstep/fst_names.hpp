// The names in a waveform, for the test of quadrille.gtkw.
#pragma once

#include <set>
#include <string>

namespace quadrille::tb {

/// Full names of the signals of an FST file as gtkwave writes them, "quadrille.busy_o" or
/// "quadrille.quadrille.tile_x[9:0]". Empty when the file cannot be read.
std::set<std::string> fst_signal_names(const std::string& file);

}  // namespace quadrille::tb
