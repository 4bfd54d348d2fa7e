// What `cosim` asks of the model alone, whatever is drawn: its functions against exact arithmetic, and the directed
// draws against the truth. Lockstep shows that the RTL computes the same.
#pragma once

#include "tb/judge/directed.hpp"
#include "tb/judge/function_check.hpp"

#include <string>

namespace quadrille::tb {

struct ModelCheck {
  FunctionReport functions;
  CheckResult directed;

  bool ok() const { return functions.ok() && directed.ok(); }
  /// What is wrong first, in words; empty when nothing is.
  std::string fault() const {
    if (!functions.ok()) return functions.first();
    if (directed.first.any) return directed.first.text;
    return directed.ok() ? "" : "directed draws: values beyond their bound";
  }
};

/// Some 0.2 s. The bound is none of a configuration that drops bits of D and R²; the functions and flags are judged all
/// the same.
inline ModelCheck check_model(const Config& config) { return {check_functions(config), judge_directed(config)}; }

}  // namespace quadrille::tb
