#include "tb/verify/faults/model_tests.hpp"

#include <gtest/gtest.h>

namespace quadrille::tb {
namespace {

class Listener : public testing::EmptyTestEventListener {
 public:
  explicit Listener(const std::function<void(const std::string&)>& begins) : begins_(begins) {}
  const std::optional<FailedTest>& first() const { return first_; }

 private:
  void OnTestStart(const testing::TestInfo& test) override {
    name_ = std::string(test.test_suite_name()) + "." + test.name();
    begins_(name_);
  }
  void OnTestPartResult(const testing::TestPartResult& result) override {
    if (first_ || !result.failed()) return;
    first_ = FailedTest{name_, "line " + std::to_string(result.line_number()) + ": " + result.message()};
    for (char& c : first_->what)
      if (c == '\n') c = ' ';
  }

  const std::function<void(const std::string&)>& begins_;
  std::string name_;
  std::optional<FailedTest> first_;
};

}  // namespace

std::optional<FailedTest> failing_test(const std::function<void(const std::string&)>& begins) {
  int arguments = 1;
  char name[] = "model_tests", *words[]{name, nullptr};
  testing::InitGoogleTest(&arguments, words);
  testing::FLAGS_gtest_fail_fast = true;
  // Of these another test has the same predicates on fewer quads.
  testing::FLAGS_gtest_filter = "-*.AllOfASmallGrid:*.TenThousandThatMiss";
  testing::TestEventListeners& listeners = testing::UnitTest::GetInstance()->listeners();
  delete listeners.Release(listeners.default_result_printer());
  Listener listener(begins);
  listeners.Append(&listener);
  const int status = RUN_ALL_TESTS();
  listeners.Release(&listener);
  if (listener.first()) return listener.first();
  if (status != 0) return FailedTest{"", "the program of the tests failed"};
  return {};
}

}  // namespace quadrille::tb
