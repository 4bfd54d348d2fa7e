// The checker checked: every mutant of mutants.toml is caught by a short co-simulation, and the design as it is passes
// it.
#include "model/support/prng.hpp"
#include "tb/lockstep/lockstep.hpp"
#include "tb/mutants/scenario.hpp"
#include "tb/support/process.hpp"
#include "tb/support/source_paths.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <toml++/toml.h>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>
#include <sstream>

namespace quadrille::tb {
namespace {

namespace fs = std::filesystem;

struct Mutant {
  std::string name, kind, file, search, replace;
  bool in_rtl() const { return file.starts_with("rtl/"); }
  friend std::ostream& operator<<(std::ostream& out, const Mutant& m) { return out << m.kind << " in " << m.file; }
};

const fs::path source_root = QUADRILLE_SOURCE_DIR;

std::vector<Mutant> mutants(bool in_rtl) {
  const toml::table file = toml::parse_file((source_root / "tb/mutants/mutants.toml").string());
  std::vector<Mutant> list;
  for (const toml::node& node : *file["mutant"].as_array()) {
    const toml::table& entry = *node.as_table();
    const auto text = [&](const char* key) { return entry[key].value<std::string>().value(); };
    const Mutant mutant{text("name"), text("kind"), text("file"), text("search"), text("replace")};
    if (mutant.in_rtl() == in_rtl) list.push_back(mutant);
  }
  return list;
}

/// The value of an environment variable that is a number.
std::uint64_t number_from(const char* variable, std::uint64_t otherwise) {
  const char* text = std::getenv(variable);
  return text == nullptr ? otherwise : std::stoull(text);
}

/// All of them; with $QUADRILLE_MUTANTS = n a sample of n, which $QUADRILLE_TEST_SEED draws (1 unless given).
std::vector<Mutant> chosen(bool in_rtl) {
  std::vector<Mutant> list = mutants(in_rtl);
  const std::size_t count = std::min<std::size_t>(number_from("QUADRILLE_MUTANTS", list.size()), list.size());
  golden::Prng rng(number_from("QUADRILLE_TEST_SEED", 1));
  for (std::size_t i = 0; i < count; ++i) std::swap(list[i], list[i + rng.below(list.size() - i)]);
  list.resize(count);
  return list;
}

/// The file with the fault in it. Throws unless the text to replace occurs exactly once.
std::string mutated(const Mutant& mutant) {
  std::ifstream in(source_root / mutant.file, std::ios::binary);
  if (!in) throw std::runtime_error(mutant.name + ": cannot read " + mutant.file);
  std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  const std::size_t at = text.find(mutant.search);
  if (at == std::string::npos || text.find(mutant.search, at + 1) != std::string::npos) {
    throw std::runtime_error(mutant.name + ": the text to replace does not occur exactly once in " + mutant.file);
  }
  return text.replace(at, mutant.search.size(), mutant.replace);
}

/// A directory for one mutant, removed at the end.
struct Workshop {
  explicit Workshop(const Mutant& mutant)
      : path(fs::path(testing::TempDir()) / ("quadrille_" + mutant.name + "_" + std::to_string(getpid()))) {
    fs::create_directories(path);
  }
  ~Workshop() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  Workshop(const Workshop&) = delete;
  Workshop& operator=(const Workshop&) = delete;
  const fs::path path;
};

std::string test_name(const testing::TestParamInfo<Mutant>& info) { return info.param.name; }

class RtlMutant : public testing::TestWithParam<Mutant> {};
class ModelMutant : public testing::TestWithParam<Mutant> {};
INSTANTIATE_TEST_SUITE_P(Mutants, RtlMutant, testing::ValuesIn(chosen(true)), test_name);
INSTANTIATE_TEST_SUITE_P(Mutants, ModelMutant, testing::ValuesIn(chosen(false)), test_name);

TEST(Mutants, EnoughOfThem) {
  EXPECT_GE(mutants(true).size(), 10u);
  EXPECT_GE(mutants(false).size(), 5u);
  for (const char* kind : {"wrong bit", "sign", "tie", "table entry", "dropped beat", "width"}) {
    const auto is_kind = [&](const Mutant& m) { return m.kind == kind; };
    const auto rtl = mutants(true), model = mutants(false);
    EXPECT_TRUE(std::any_of(rtl.begin(), rtl.end(), is_kind) || std::any_of(model.begin(), model.end(), is_kind))
        << kind;
  }
}

TEST(Mutants, ASampleIsDrawnBySeed) {
  const auto names = [](const char* count, const char* seed) {
    const auto set = [](const char* variable, const char* value) {
      const char* before = std::getenv(variable);
      const std::optional<std::string> old = before ? std::optional<std::string>(before) : std::nullopt;
      setenv(variable, value, 1);
      return old;
    };
    const auto restore = [](const char* variable, const std::optional<std::string>& old) {
      old ? setenv(variable, old->c_str(), 1) : unsetenv(variable);
    };
    const auto old_count = set("QUADRILLE_MUTANTS", count), old_seed = set("QUADRILLE_TEST_SEED", seed);
    std::vector<std::string> list;
    for (const Mutant& mutant : chosen(true)) list.push_back(mutant.name);
    restore("QUADRILLE_MUTANTS", old_count);
    restore("QUADRILLE_TEST_SEED", old_seed);
    return list;
  };
  EXPECT_EQ(names("2", "1").size(), 2u);
  EXPECT_EQ(names("2", "1"), names("2", "1"));
  EXPECT_EQ(names("1000", "1").size(), mutants(true).size());
  std::set<std::string> drawn;
  for (int seed = 1; seed <= 100; ++seed) drawn.insert(names("1", std::to_string(seed).c_str()).at(0));
  EXPECT_EQ(drawn.size(), mutants(true).size()) << "a mutant that no sample ever holds";
}

TEST(Mutants, DesignWithoutFaultPasses) {
  const LockstepOptions options = mutant_options();
  const LockstepReport report = run_lockstep(mutant_quads(options), options);
  EXPECT_TRUE(report.agreed()) << report.first_divergence.value_or("");
  EXPECT_TRUE(report.complete);
  EXPECT_GT(report.fragments, 10000u);
}

TEST(Mutants, ModelWithoutFaultPasses) {
  const Workshop workshop(Mutant{"model_as_it_is", "", "", "", ""});
  const fs::path log = workshop.path / "run.log";
  EXPECT_EQ(run_logged(std::vector<std::string>{QUADRILLE_MODEL_LOCKSTEP}, workshop.path, log), 0) << tail_of(log, 10);
}

TEST_P(RtlMutant, IsCaught) {
  const Workshop workshop(GetParam());
  const fs::path rtl = workshop.path / "rtl";
  fs::copy(source_root / "rtl", rtl);
  std::ofstream(workshop.path / GetParam().file) << mutated(GetParam());
  LockstepOptions options = mutant_options();
  options.source = rtl;
  const LockstepReport report = run_lockstep(mutant_quads(options), options);
  EXPECT_FALSE(report.agreed()) << GetParam() << " was not noticed in " << report.fragments << " fragments";
  if (report.first_divergence) std::printf("caught: %s\n", report.first_divergence->c_str());
}

TEST_P(ModelMutant, IsCaught) {
  const Workshop workshop(GetParam());
  const fs::path source = workshop.path / "mutant.cpp", object = workshop.path / "mutant.o",
                 program = workshop.path / "lockstep";
  const fs::path log = workshop.path / "log";
  std::ofstream(source) << mutated(GetParam());
  const auto words = [](const char* text) {
    std::istringstream in(text);
    return std::vector<std::string>(std::istream_iterator<std::string>(in), {});
  };
  // The changed file comes before the model's library, whose own version of it is then not taken.
  std::vector<std::string> compile = words(QUADRILLE_MUTANT_COMPILER " " QUADRILLE_MUTANT_FLAGS);
  std::vector<std::string> link = compile;
  for (const std::string& word : {std::string("-I") + source_root.string(), std::string("-c"), source.string(),
                                  std::string("-o"), object.string()}) {
    compile.push_back(word);
  }
  for (const std::string& word : words(QUADRILLE_MUTANT_OBJECTS)) link.push_back(word);
  link.push_back(object.string());
  for (const std::string& word : words(QUADRILLE_MUTANT_LIBRARIES)) link.push_back(word);
  for (const std::string& word : {std::string("-ldl"), std::string("-lpthread"), std::string("-o"), program.string()}) {
    link.push_back(word);
  }
  compile.front() = link.front() = find_program(compile.front(), "g++").string();
  ASSERT_EQ(run_logged(compile, workshop.path, log), 0) << tail_of(log, 20);
  ASSERT_EQ(run_logged(link, workshop.path, log), 0) << tail_of(log, 20);
  EXPECT_EQ(run_logged(std::vector<std::string>{program.string()}, workshop.path, log), 1)
      << GetParam() << " was not noticed\n"
      << tail_of(log, 20);
  std::printf("caught: %s", tail_of(log, 1).c_str());
}

}  // namespace
}  // namespace quadrille::tb
