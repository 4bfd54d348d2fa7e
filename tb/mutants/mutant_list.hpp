// The faults of mutants.toml and the switch that selects one of them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

namespace quadrille::tb {

struct Mutant {
  /// What has the fault. common: model and RTL alike, so that comparing them shows nothing.
  enum class Side { rtl, model, common };

  std::string name, fault_class;
  Side side = Side::rtl;
  bool in_rtl = false, in_model = false;  ///< where it has an edit; a common one may leave the RTL's to the imagination
  int number = 0;                         ///< of the switch; never 0
  std::vector<std::string> caught_by;     ///< the checks that see it, in the order of all_checks(); recorded
  std::optional<std::string> scenario;    ///< in which it is found soonest
  std::optional<std::string> equivalent;  ///< why no input shows it

  friend std::ostream& operator<<(std::ostream& out, const Mutant& m) { return out << m.name; }
};

/// All entries in the order of the file. Throws std::runtime_error for an entry that is not as README.md says.
std::vector<Mutant> read_mutants();
/// An entry of the list that generate_mutants.py writes.
Mutant generated_mutant(const nlohmann::ordered_json& entry);

/// A fault that is on while this lives, in the RTL made meanwhile, in the model, or in both. One at a time, and no
/// other thread may use the machine.
class Selected {
 public:
  Selected(const Mutant& mutant, bool rtl, bool model);
  ~Selected();
  Selected(const Selected&) = delete;
  Selected& operator=(const Selected&) = delete;
};

/// Whether a fault is on.
bool anything_selected();

}  // namespace quadrille::tb
