// cosim --judge truth: RTL with bits of its own passes within the bounds of the truth, and not beyond them.
#include "tb/commands/cli_fixture.hpp"

#include <nlohmann/json.hpp>

#include <string>

namespace {

using namespace quadrille::cli_test;
using nlohmann::json;

class CliJudge : public Cli {};
constexpr const char* judged = "cosim --scene bowtie --size 48x48 --no-alone --no-snapping-error --rtl rtl ";

/// A last bit of each root: within the bound, and not the model's.
TEST_F(CliJudge, OwnRoundingPassesTheTruthAndNoLockstep) {
  spoil("quadrille_sqrt.sv", ": poly;", ": {poly[S-1:1], 1'b0};");
  const Outcome lockstep = run(std::string(judged) + "--no-shrink --quiet");
  EXPECT_EQ(lockstep.status, 1) << lockstep.err;
  EXPECT_NE(lockstep.err.find("stage sqrt, field sig"), std::string::npos) << lockstep.err;

  const Outcome outcome = run(std::string(judged) + "--judge truth --stall 0.3 --gap 0.2 --json r.json");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_NE(outcome.out.find("RTL within the bounds of the truth"), std::string::npos) << outcome.out;
  for (const char* word : {"lockstep", "model checks", "mismatches"})
    EXPECT_EQ(outcome.out.find(word), std::string::npos) << word << " in\n" << outcome.out;
  const json report = json::parse(read(file("r.json")));
  EXPECT_EQ(report["judge"], "truth");
  EXPECT_EQ(report["ok"], true);
  EXPECT_EQ(report["complete"], true);
  EXPECT_GT(report["fragments"], 500);
  EXPECT_EQ(report["error"]["arithmetic"]["fragments"], report["fragments"]);
  EXPECT_EQ(report["bound"]["held"], true);
  EXPECT_FALSE(report.contains("model_alone"));
}

/// Six bits of each root: beyond the bound. What is left of the draw still fails, by the truth.
TEST_F(CliJudge, BeyondTheBoundFailsBoth) {
  spoil("quadrille_sqrt.sv", ": poly;", ": {poly[S-1:6], 6'b0};");
  EXPECT_EQ(run(std::string(judged) + "--no-shrink --quiet").status, 1);
  const Outcome outcome = run(std::string(judged) + "--judge truth --shrink less.quads --quiet");
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_NE(outcome.err.find(" weights beyond the bound; the worst: quad "), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("lockstep"), std::string::npos) << outcome.err;
  const std::size_t begin = outcome.err.find("cosim --quads less.quads ");
  ASSERT_NE(begin, std::string::npos) << outcome.err;
  const std::string command = outcome.err.substr(begin, outcome.err.find('\n', begin) - begin);
  EXPECT_NE(command.find(" --judge truth"), std::string::npos) << command;
  EXPECT_EQ(run(command + " --quiet").status, 1) << command;
  EXPECT_EQ(run(command.substr(0, command.find(" --rtl")) + " --judge truth --no-alone --quiet").status, 0) << command;
}

/// What the truth decides exactly has no bound to hide in.
TEST_F(CliJudge, CoverageIsExact) {
  spoil("quadrille_inside_expression.sv", "front1 = neg4 & neg0 & neg1", "front1 = neg4 & neg1");
  const Outcome outcome = run(std::string(judged) + "--judge truth --no-shrink --quiet");
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_NE(outcome.err.find(" differences from the truth; the first: "), std::string::npos) << outcome.err;
}

TEST_F(Cli, TheJudgeAndItsRtl) {
  refuses(2, "cosim --scene bowtie --judge model", {"--judge model: expected lockstep or truth"});
  refuses(2, "cosim --stress general --draws 3 --judge truth", {"--judge truth conflicts with --draws"});
  refuses(2, "cosim --battery --judge truth", {"--judge truth conflicts with --battery"});
  fs::create_directory(file("units"));
  write("units/quadrille_sqrt.sv", "module quadrille_sqrt; endmodule\n");
  for (const char* command : {"cosim --scene bowtie --judge truth", "cosim --scene bowtie",
                              "explain --scene bowtie --pixel 3,3 --engine rtl"})
    refuses(2, std::string(command) + " --rtl units", {"--rtl units: no quadrille.sv in this directory"});
}

}  // namespace
