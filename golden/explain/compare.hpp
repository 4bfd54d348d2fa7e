// Another machine's record beside the model's: the RTL's probes, or a line of golden vectors.
#pragma once

#include "golden/explain/explain.hpp"
#include "model/port/record.hpp"

namespace quadrille::explain {

/// Sets `other`, `differs` and `compared` from the record of the stage's boundary; nullptr: the other machine has none
/// for this pixel, which differs.
void compare(Stage& stage, const RecordLayout& layout, const Record* record);

}  // namespace quadrille::explain
