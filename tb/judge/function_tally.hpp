// How the parts of check_functions() write down what they find.
#pragma once

#include "tb/judge/function_check.hpp"

#include <functional>

namespace quadrille::tb {

/// One function's results as they come.
class FunctionTally {
 public:
  explicit FunctionTally(std::string_view name) { result_.name = name; }

  /// `describe` is called for the first result that is wrong.
  template <class Describe>
  void expect(bool right, Describe&& describe) {
    ++result_.arguments;
    if (right) return;
    if (result_.beyond++ == 0) result_.first = describe();
  }
  const FunctionResult& result() const { return result_; }

 private:
  FunctionResult result_;
};

// The parts, each in a file of its own; they add a result for each function.
void check_arithmetic(const Config& config, std::vector<FunctionResult>& results);    ///< significands, sums, tables
void check_pixel_stages(const Config& config, std::vector<FunctionResult>& results);  ///< normalise to fragment_output
void check_front(const Config& config, std::vector<FunctionResult>& results);         ///< snapping, setup, limits

}  // namespace quadrille::tb
