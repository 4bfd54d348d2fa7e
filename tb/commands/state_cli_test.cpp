// Draw states at random and corner groups on the command line.
#include "tb/commands/cli_fixture.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace quadrille::cli_test {
namespace {

using nlohmann::json;

TEST_F(Cli, DrawStatesAtRandomSayWhatIsWrong) {
  refuses(2, "cosim --scene bowtie --draw-state any", {"--draw-state any", "random:SEED"});
  refuses(2, "cosim --scene bowtie --draw-state random:", {"--draw-state random:", "random:SEED"});
  refuses(2, "cosim --scene bowtie --draw-state random:7x", {"--draw-state random:7x", "random:SEED"});
  refuses(2, "cosim --scene bowtie --draw-state random --cull back --attributes 2",
          {"--draw-state random", "--cull back --attributes 2"});
  refuses(2, "cosim --scene bowtie --attributes 5", {"--attributes 5", "attribute_slots = 4"});
  refuses(2, "cosim --scene bowtie --attributes 0", {"--attributes"});
}

TEST_F(Cli, HiddenTilesAskForDepthsAndADepthTest) {
  refuses(2, "fragments --scene bowtie --out a.csv --skip tiles,hidden",
          {"--skip hidden", "--set hierarchical_z_bits=12"});
  refuses(2, "fragments --scene bowtie --out a.csv --set hierarchical_z_bits=12 --no-depth --skip hidden",
          {"--skip hidden", "--no-depth"});
}

TEST_F(Cli, CornerGroupsAreListedAndDrawn) {
  refuses(2, "fragments --corner z_limit --out a.csv", {"unknown corner group", "did you mean \"z_limits\""});
  refuses(2, "fragments --corner tall --stress tiny --out a.csv", {"one input is needed", "--corner GROUP"});
  const std::string list = run("scenes --corner").out;
  const json groups = json::parse(run("scenes --corner --json -").out);
  ASSERT_GE(groups.size(), 10u);
  for (const json& group : groups) {
    const std::string name = group["name"];
    EXPECT_NE(("\n" + list).find("\n" + name + " "), std::string::npos) << name;
    const Outcome drawn = run("fragments --corner " + name + " --size 40x40 --no-depth --out -");
    EXPECT_EQ(drawn.status, 0) << name << ": " << drawn.err;
    EXPECT_GT(std::count(drawn.out.begin(), drawn.out.end(), '\n'), 100) << name;
  }
}

using CliCosim = Cli;

TEST_F(CliCosim, ADrawnStateIsRepeatedByItsOptions) {
  const std::string draw = "cosim --corner z_limits --size 40x48 --no-alone --json -";
  std::string before;
  for (const char* seed : {"1", "2", "3", "4"}) {
    const Outcome outcome = run(draw + " --draw-state random:" + seed);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const json drawn = json::parse(outcome.out);
    const std::string options = drawn["draw_state"];
    EXPECT_NE(options, before);
    before = options;
    const json again = json::parse(run(draw + options).out);
    EXPECT_EQ(again["draw_state"], options);
    EXPECT_EQ(again["passes"], drawn["passes"]);
    EXPECT_EQ(again["fragment_hash"], drawn["fragment_hash"]) << options;
    EXPECT_EQ(again["counts"], drawn["counts"]) << options;
  }
}

}  // namespace
}  // namespace quadrille::cli_test
