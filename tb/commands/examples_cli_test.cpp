// The example files of golden/examples through the program: what the formats' description promises.
#include "tb/commands/cli_fixture.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <map>
#include <sstream>

namespace {

using namespace quadrille::cli_test;
using nlohmann::json;

const std::string examples = QUADRILLE_SOURCE_DIR "/golden/examples/";

using Examples = Cli;

TEST_F(Examples, Cameras) {
  const std::string render = "render --size 128x128 --quiet --json a.json --png a.png --mesh " + examples + "box.obj ";
  ASSERT_EQ(run(render + "--camera " + examples + "camera.json").status, 0);
  json report = json::parse(read(file("a.json")));
  EXPECT_EQ(report["quads"], 7);
  EXPECT_GT(report["pixels_drawn"], 2000);
  // The matrix looks along +y without perspective, 8 units over 128 pixels: the box is 2 wide and 2 high, the flap
  // behind its right edge 2 wide more.
  ASSERT_EQ(run(render + "--camera " + examples + "camera_matrix.json").status, 0);
  report = json::parse(read(file("a.json")));
  EXPECT_EQ(report["pixels_drawn"], 64 * 32);
}

TEST_F(Examples, WhichWindingIsFront) {
  const auto facing = [&](const std::string& options) {
    const Outcome outcome = run("fragments --size 256x256 --out - --quads " + examples + "winding.quads " + options);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    std::istringstream lines(outcome.out);
    std::string line, quad, x, y, front;
    std::getline(lines, line);
    EXPECT_EQ(line, "quad,x,y,front,flags,l0,l1,l2,l3,z,a0,a1");
    std::map<std::string, std::map<std::string, int>> count;
    while (std::getline(lines, line)) {
      std::istringstream cells(line);
      std::getline(cells, quad, ','), std::getline(cells, x, ','), std::getline(cells, y, ','),
          std::getline(cells, front, ',');
      ++count[quad][front];
    }
    return count;
  };
  for (const char* engine : {"", "--engine truth", "--engine float"}) {
    SCOPED_TRACE(engine);
    auto all = facing(engine);
    EXPECT_EQ(all["0"], (std::map<std::string, int>{{"1", 10'000}}));
    EXPECT_EQ(all["1"], (std::map<std::string, int>{{"0", 10'000}}));
    EXPECT_EQ(all["2"].size(), 1u);
    EXPECT_GT(all["2"]["1"], 5000) << "the part before the eye";
  }
  EXPECT_EQ(facing("--cull back").count("1"), 0u);
  EXPECT_EQ(facing("--cull front").count("0"), 0u);
}

TEST_F(Examples, NamedConfigurations) {
  const std::string list = run("config --list").out;
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(QUADRILLE_SOURCE_DIR "/rtl/configurations")) {
    if (entry.path().extension() != ".toml") continue;
    ++count;
    const std::string name = entry.path().stem().string();
    EXPECT_NE(("\n" + list).find("\n" + name + " "), std::string::npos) << name;
    const Outcome named = run("config --toml --config " + name);
    EXPECT_EQ(named.status, 0) << named.err;
    EXPECT_EQ(named.out, run("config --toml --config " + entry.path().string()).out) << name;
    EXPECT_NE(named.out, run("config --toml").out) << name;
  }
  EXPECT_GE(count, 4);
  EXPECT_EQ(std::ranges::count(list, '\n'), count);
  // By name wherever a file is taken; a key after it; a file of that name comes first.
  EXPECT_EQ(run("render --scene bowtie --size 32x32 --quiet --config small --json a.json --png a.png").status, 0);
  EXPECT_EQ(json::parse(read(file("a.json")))["config"]["viewport_bits"], 10);
  EXPECT_NE(run("config --toml --config small --set depth_bits=20").out.find("depth_bits = 20 "), std::string::npos);
  write("small", "depth_bits = 22\n");
  EXPECT_NE(run("config --toml --config small").out.find("depth_bits = 22 "), std::string::npos);
  refuses(2, "config --config colour9", {"named configuration", "did you mean \"colour8\"", "depth24"});
  refuses(2, "config --list --toml", {"--list"});
}

TEST_F(Examples, Configuration) {
  const Outcome outcome = run("config --json - --config " + examples + "narrow.toml");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json config = json::parse(outcome.out)["config"];
  const std::map<std::string, int> given{{"viewport_bits", 8},   {"significand_bits", 12}, {"quadratic_frac_bits", 18},
                                         {"attribute_slots", 3}, {"notch_exact", 1},       {"sqrt_segments_log2", -1}};
  const json standard = json::parse(run("config --json -").out)["config"];
  for (const auto& [key, value] : config.items())
    EXPECT_EQ(value, given.contains(key) ? json(given.at(key)) : standard[key]) << key;
  EXPECT_NE(run("config --toml --config " + examples + "narrow.toml").out.find("multiplier = 3.1\n"),
            std::string::npos);
}

}  // namespace
