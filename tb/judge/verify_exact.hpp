// Golden vectors judged without the functions of the model: the engine `float` of `quadrille golden verify`.
//   stages, tables            exact integers (stage_judge.hpp); roots and reciprocals within table_limit() of the exact
//                             value; those that other stages take are the program's own
//   the machine, `input`      the truth, as cosim judges (check.hpp); clocks, stall patterns and what snapping made of
//                             an input's quads are not looked at
#pragma once

#include "golden/vectors/suite.hpp"

namespace quadrille::tb {

/// Every response of a suite. Undefined are vectors of which some field has no exact answer in 127 bits (snapping), or
/// about whose values no bound speaks (fragments); the others are compared. Throws golden::InputError for a suite that
/// neither judge knows, and when the records are not those of the suite.
vectors::VerifyResult verify_exact(const vectors::Suite& suite, const vectors::SuiteReader& reader, unsigned threads);

}  // namespace quadrille::tb
