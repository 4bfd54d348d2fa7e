// The faults of the registry (faults.py) and the switch that selects one of them.
#pragma once

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
  bool generated = false;
  int number = 0;  ///< of the switch; never 0
  std::vector<std::string>
      checks;            ///< that see it, in the order of all_checks(); of a generated one the first of model_checks()
  std::string scenario;  ///< in which it is found soonest
  std::string equivalent;  ///< why no input shows it; else empty

  friend std::ostream& operator<<(std::ostream& out, const Mutant& m) { return out << m.name; }
};

/// All that are built into the copies, in the order of the registry; select_mutants.py wrote the list.
std::vector<Mutant> read_mutants();

/// A fault that is on while this lives, in the RTL made meanwhile, in the model, or in both. One at a time, and no
/// other thread may use the machine.
class Selected {
 public:
  Selected(const Mutant& mutant, bool rtl, bool model);
  ~Selected();
  Selected(const Selected&) = delete;
  Selected& operator=(const Selected&) = delete;
};

/// The number of the fault that is on in the RTL, 0: none.
int selected_in_rtl();
/// Whether a fault is on.
bool anything_selected();

}  // namespace quadrille::tb
