// The checks that a mutant is put through, each of which finds it or does not.
#pragma once

#include "tb/device/verilate.hpp"
#include "tb/verify/faults/mutant_list.hpp"
#include "tb/verify/faults/scenario.hpp"

#include <optional>
#include <span>
#include <string>

namespace quadrille::tb {

/// What a check saw first.
struct Finding {
  std::string where;  ///< the scenario or suite
  std::string what;
};

/// One check. It runs on the machine as it is selected (mutant_list.hpp); without a fault it finds nothing.
struct CheckInfo {
  std::string name;  ///< as in the record
  bool sees_rtl;     ///< looks at the RTL; the others look at the model alone
  bool by_scenario;  ///< looks at one scenario at a time
  /// The scenario is null for a check that has none.
  std::optional<std::string> (*find)(const Scenario*);
};

/// Every check, in the order of the table in tb/README.md.
std::span<const CheckInfo> all_checks();
const CheckInfo& check_named(std::string_view name);

/// Whether a check can say anything about the mutant: a common fault is invisible to what compares RTL and model.
bool applies(const CheckInfo& check, const Mutant& mutant);

/// The first finding of one check. Selects the mutant; its own scenario goes first.
std::optional<Finding> run_check(const CheckInfo& check, const Mutant& mutant);
/// The same with the fault in RTL and model at once.
std::optional<Finding> run_on_both(const CheckInfo& check, const Mutant& mutant);

/// The simulator with all faults of the RTL built in. Built with none selected.
const Simulator& simulator_of(const Config& config);

}  // namespace quadrille::tb
