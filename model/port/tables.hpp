// The sqrt and reciprocal tables: coefficients (shared with the RTL as constants) and the generated package text.
#pragma once

#include "model/port/config.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace quadrille {

/// One segment: y = c0 - (c1 - c2·dx)·dx, of the root c0 + (c1 - c2·dx)·dx, in units 2^-(S + table_guard); see
/// rtl/SPEC.md, Numbers.
struct TableEntry {
  std::uint32_t c0 = 0, c1 = 0, c2 = 0;
};

struct Table {
  int segments_log2 = 0;  ///< K: segments per octave
  int rest_bits = 0;      ///< R = S − 1 − K, width of dx
  std::vector<TableEntry> entries;
};

Table make_sqrt_table(const Config& config);   ///< 2·2^K entries: sqrt(x) / 2, x in [1, 4)
Table make_recip_table(const Config& config);  ///< 2^K entries: 1 / x, x in [1, 2)

/// `quadrille_tables_pkg.sv` for this configuration.
std::string tables_package(const Config& config);

}  // namespace quadrille
