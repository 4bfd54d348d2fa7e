// Which rule covers a pixel, or rejects it. Not for use outside this folder.
#pragma once

#include "golden/explain/stages.hpp"

namespace quadrille::explain {

/// Sets outcome, reject, why, edges, clause, front and homogeneous.
void explain_coverage(const Subject& subject, Explanation& out);
/// Of a covered pixel: what is special about it, and where the truth has something else.
void explain_place(const Subject& subject, Explanation& out);

}  // namespace quadrille::explain
