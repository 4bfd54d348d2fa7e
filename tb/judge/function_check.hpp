// The model's functions alone against exact integer arithmetic, for one configuration: what a bound on the fragments
// hides, and what RTL and model have wrong alike. Lockstep extends what holds of the model to the RTL.
#pragma once

#include "model/port/config.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::tb {

/// One function and what was found.
struct FunctionResult {
  std::string_view name;
  std::uint64_t arguments = 0, beyond = 0;  ///< results beyond their limit; most limits are 0: every bit is specified
  std::string first;                        ///< the first of them
};

struct FunctionReport {
  std::vector<FunctionResult> functions;

  std::uint64_t arguments() const;
  std::uint64_t beyond() const;
  bool ok() const { return arguments() > 0 && beyond() == 0; }
  /// "sqrt: …" of the first fault; empty without one.
  std::string first() const;
};

/// Evaluates every function of the machine behind the port:
///   sqrt, reciprocal   every argument up to S = 17 bits, else the ends of every segment of the table and random ones;
///                       within table_limit() of the exact value, powers of four (two) and zero exactly
///   multiply, sum       random and extreme operands, cancellation, terms far apart: every bit
///   normalise … output  the stages behind the front, stage by stage, each on what the stage before gave: every bit
///   snapping, setup, limits   roundings of the port, bounding box, edge functions, visibility: every bit
/// A few 10^5 arguments, below 0.3 s. The same arguments for the same configuration.
FunctionReport check_functions(const Config& config);

/// How far a table's result may be from the exact value, in units of 2^-3 of its last bit: what follows from its layout
/// (rtl/SPEC.md, Numbers, and tables.hpp) for any coefficients that are rounded to nearest. Throws nothing.
struct TableLimit {
  double below = 0, above = 0;
};
TableLimit sqrt_limit(const Config& config);
TableLimit reciprocal_limit(const Config& config);

}  // namespace quadrille::tb
