// The stage suites against floating point.
#pragma once

#include "golden/suites/float_judge.hpp"
#include "golden/suites/stage_suite.hpp"

#include <string_view>

namespace quadrille::vectors {

namespace floating {

/// Stimulus and response of one vector.
struct Vector {
  const StageData& in;
  const StageData& out;
  const Config& config;
  const Losses& losses;
};

using StageCheck = void (*)(Judge&, const Vector&);

}  // namespace floating

/// One stage evaluated by its mathematics.
class FloatStage {
 public:
  /// The stage of the suite of that name; it must outlive this. Throws golden::InputError for a name without a check.
  FloatStage(std::string_view suite, const StageUnderTest& stage);

  /// One vector. Of an undefined one, all that has an answer agrees.
  VectorOutcome check(const Record& stimulus, const Record& response) const;

 private:
  const StageUnderTest& stage_;
  floating::Losses losses_;
  floating::StageCheck check_;
};

}  // namespace quadrille::vectors
