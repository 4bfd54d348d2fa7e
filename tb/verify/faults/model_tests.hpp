// The model's own tests on the model as it is selected: those of what it leaves out, which hold by how much.
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace quadrille::tb {

struct FailedTest {
  std::string name, what;
};

/// Runs the tests of model/ that are linked in (CMakeLists.txt) until one fails;
/// `begins` hears of each. A GoogleTest program cannot be begun anew: once in a process.
std::optional<FailedTest> failing_test(const std::function<void(const std::string&)>& begins);

}  // namespace quadrille::tb
