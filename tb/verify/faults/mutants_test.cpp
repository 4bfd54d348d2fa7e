// The checker checked: every mutant of faults.toml is seen by exactly the checks that the record names, an equivalent
// one by none, and the machine without a fault passes every check.
#include "model/support/prng.hpp"
#include "tb/verify/faults/checks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <set>
#include <utility>

namespace quadrille::tb {
namespace {

/// The value of an environment variable that is a number.
std::uint64_t number_from(const char* variable, std::uint64_t otherwise) {
  const char* text = std::getenv(variable);
  return text == nullptr ? otherwise : std::stoull(text);
}

/// $QUADRILLE_MUTANTS = n: a sample of n mutants, and of each only the check that is known to see it soonest.
bool is_sample() { return std::getenv("QUADRILLE_MUTANTS") != nullptr; }

/// Those that every check looks at.
const std::vector<Mutant>& recorded() {
  static const std::vector<Mutant> all = [] {
    std::vector<Mutant> list = read_mutants();
    std::erase_if(list, [](const Mutant& m) { return m.generated; });
    return list;
  }();
  return all;
}

/// `count` of the mutants, which `seed` draws, at most one of them equivalent: that one runs every check to its end,
/// for most of a minute, where another is seen in milliseconds.
std::vector<Mutant> sample(std::uint64_t count, std::uint64_t seed) {
  std::vector<Mutant> list = recorded();
  golden::Prng random(seed);
  for (std::size_t i = 0; i < list.size(); ++i) std::swap(list[i], list[i + random.below(list.size() - i)]);
  bool equivalent = false;
  if (count < list.size())
    std::erase_if(list, [&](const Mutant& m) { return !m.equivalent.empty() && std::exchange(equivalent, true); });
  list.resize(std::min<std::uint64_t>(count, list.size()));
  return list;
}

std::vector<Mutant> chosen() {
  if (!is_sample()) return recorded();
  return sample(number_from("QUADRILLE_MUTANTS", 0), number_from("QUADRILLE_TEST_SEED", 1));
}

std::string test_name(const testing::TestParamInfo<Mutant>& info) { return info.param.name; }

class MutantTest : public testing::TestWithParam<Mutant> {};
INSTANTIATE_TEST_SUITE_P(Mutants, MutantTest, testing::ValuesIn(chosen()), test_name);

/// Those with an edit in RTL and model both; of a sample the first, if there is one.
std::vector<Mutant> in_both() {
  std::vector<Mutant> list = chosen();
  std::erase_if(list, [](const Mutant& m) { return !m.in_rtl || !m.in_model; });
  if (is_sample() && list.size() > 1) list.resize(1);
  return list;
}

class CommonMutant : public testing::TestWithParam<Mutant> {};
INSTANTIATE_TEST_SUITE_P(Mutants, CommonMutant, testing::ValuesIn(in_both()), test_name);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(CommonMutant);

TEST(MutantList, ChecksApply) {
  for (const Mutant& mutant : recorded())
    for (const std::string& name : mutant.checks)
      EXPECT_TRUE(applies(check_named(name), mutant)) << mutant << ", " << name;
}

TEST(MutantList, ASampleIsDrawnBySeed) {
  const auto names = [](std::uint64_t count, std::uint64_t seed) {
    std::vector<std::string> list;
    for (const Mutant& mutant : sample(count, seed)) list.push_back(mutant.name);
    return list;
  };
  EXPECT_EQ(names(2, 1).size(), 2u);
  EXPECT_EQ(names(2, 1), names(2, 1));
  EXPECT_EQ(names(100000, 1).size(), recorded().size());
  std::set<std::string> drawn;
  for (std::uint64_t seed = 1; seed <= 150; ++seed)
    for (const std::string& name : names(50, seed)) drawn.insert(name);
  EXPECT_EQ(drawn.size(), recorded().size()) << "a mutant that no sample ever holds";
}

TEST(MutantList, SomeAreRun) { EXPECT_GT(chosen().size(), 0u); }

TEST(Machine, WithoutFaultPassesEveryCheck) {
  const std::span<const Scenario> draws = scenarios();
  ASSERT_GE(draws.size(), 10u);
  for (const CheckInfo& check : all_checks()) {
    for (const Scenario& scenario : draws) {
      const std::optional<std::string> found = check.find(check.by_scenario ? &scenario : nullptr);
      EXPECT_FALSE(found) << check.name << ": " << scenario.name << ": " << *found;
      if (!check.by_scenario) break;
    }
  }
}

TEST_P(MutantTest, IsSeen) {
  const Mutant& mutant = GetParam();
  std::vector<std::string> seen;
  for (const CheckInfo& check : all_checks()) {
    if (!applies(check, mutant)) continue;
    if (is_sample() && mutant.equivalent.empty() && mutant.checks.at(0) != check.name) continue;
    const std::optional<Finding> finding = run_check(check, mutant);
    if (!finding) continue;
    seen.push_back(check.name);
    RecordProperty(check.name, finding->where + ": " + finding->what);
    std::printf("%s: %s: %s\n", check.name.c_str(), finding->where.c_str(), finding->what.c_str());
  }
  if (!mutant.equivalent.empty())
    EXPECT_TRUE(seen.empty()) << "called equivalent: " << mutant.equivalent;
  else if (is_sample())
    EXPECT_EQ(seen.size(), 1u) << mutant << " was not noticed by " << mutant.checks.at(0);
  else
    EXPECT_EQ(seen, mutant.checks);
}

TEST_P(CommonMutant, IsInvisibleToLockstep) {
  const std::optional<Finding> finding = run_on_both(check_named("lockstep"), GetParam());
  EXPECT_FALSE(finding) << finding->where << ": " << finding->what;
}

}  // namespace
}  // namespace quadrille::tb
