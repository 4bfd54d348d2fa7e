// Names and knobs: what make_method takes, and what it says of the rest.
#include "golden/methods/method.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace quadrille::golden::methods {
namespace {

/// What make_method says of a spec that it refuses.
std::string refusal(std::string_view spec) {
  try {
    return make_method(spec)->name() + " is taken";
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

TEST(MakeMethod, TakesEveryListedName) {
  for (const MethodInfo& info : list_methods()) {
    const std::string name = make_method(info.name)->name();
    EXPECT_EQ(name.substr(0, name.find(':')), info.name);
    EXPECT_EQ(name.find(':') == std::string::npos, info.knob.empty()) << name;
    EXPECT_EQ(make_method(name)->name(), name);
  }
}

TEST(MakeMethod, AMissingNameIsNoUnknownOne) {
  for (const char* spec : {"", ":20"}) {
    EXPECT_TRUE(refusal(spec).starts_with("method '" + std::string(spec) + "': the name is missing (mvc, split02, "));
    EXPECT_TRUE(refusal(spec).ends_with(", affine)"));
  }
  EXPECT_TRUE(refusal("splt02").starts_with("unknown method 'splt02'; did you mean \"split02\"? (mvc, split02, "));
}

TEST(MakeMethod, RefusesKnobsWithTheirRange) {
  EXPECT_EQ(refusal("refine:"), "method 'refine:': nothing follows the colon");
  EXPECT_EQ(refusal("mvc:3"), "method 'mvc:3': mvc has no knob");
  for (const char* spec : {"refine:0", "refine:1001", "refine:2x"})
    EXPECT_EQ(refusal(spec), "method '" + std::string(spec) + "': N is a number from 1 to 1000");
}

}  // namespace
}  // namespace quadrille::golden::methods
