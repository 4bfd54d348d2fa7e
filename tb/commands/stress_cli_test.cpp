// `quadrille stress` as a program: bad input, the report and table, reproducers that run, results that do not depend on
// threads.
#include "tb/commands/cli_fixture.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <sstream>
#include <string>

namespace quadrille::cli_test {
namespace {

using nlohmann::json;

TEST_F(Cli, StressRefuses) {
  refuses(2, "stress --families slivers", {"unknown family", "did you mean \"sliver\""});
  refuses(2, "stress --families sliver,,bowtie", {"unknown family"});
  refuses(2, "stress --engines fp64", {"unknown engine", "fp32"});
  refuses(2, "stress --count 0", {"--count"});
  refuses(2, "stress --size 99999x2", {"--size"});
  refuses(2, "stress --families bowtie --json nowhere/s.json", {"nowhere"});
  refuses(2, "stress --families bowtie --csv - --json -", {"two outputs"});
  refuses(2, "stress --families long_edge --set viewport_bits=9", {"long_edge", "viewport_bits"});
  refuses(2, "stress --families bowtie --set quadratic_frac_bits=10", {"quadratic_frac_bits"});
  refuses(2, "stress --stress bowtie", {"--stress"});
}

TEST_F(Cli, StressReports) {
  const std::string arguments = "stress --families reflex,on_edge,edge_distance --count 3 --json ";
  const Outcome outcome = run(arguments + "- --csv table.csv --threads 1");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json report = json::parse(outcome.out);
  EXPECT_TRUE(report["ok"]);
  EXPECT_EQ(report["weight_bound"], std::ldexp(1.0, -15));
  ASSERT_EQ(report["families"].size(), 3u);
  std::set<std::string> kinds;
  for (const json& family : report["families"]) {
    kinds.insert(family["kind"]);
    EXPECT_EQ(family["jump"].is_null(), family["kind"] == "family");
    const json& worst = family["worst"]["model"];
    EXPECT_GT(worst["weight"], 0);
    EXPECT_LT(worst["weight"], 1);
    // The reproducer's pixel: the weights of the model are as far from the truth's as the report says.
    std::string line = worst["reproduce"];
    const std::size_t at = line.find("quadrille fragments");
    ASSERT_NE(at, std::string::npos);
    const std::string quad = line.substr(6, line.find('\'', 6) - 6);
    write("worst.quads", quad + "\n");
    line = line.substr(at + std::string("quadrille ").size());
    line.replace(line.find("/dev/stdin"), 10, "worst.quads");
    double largest = 0;
    const auto weights = [&](const std::string& engine) {
      const Outcome drawn = run(line + " --engine " + engine);
      EXPECT_EQ(drawn.status, 0) << drawn.err;
      std::vector<double> out;
      const std::string row = drawn.out.substr(drawn.out.find('\n') + 1);
      std::size_t from = 0;
      for (int column = 0; column < 9; ++column) {
        if (column >= 5) out.push_back(std::strtod(row.c_str() + from, nullptr));
        from = row.find(',', from) + 1;
      }
      return out;
    };
    const std::vector<double> model = weights("model"), truth = weights("truth");
    for (std::size_t i = 0; i < 4; ++i) largest = std::max(largest, std::fabs(model[i] - truth[i]));
    EXPECT_DOUBLE_EQ(largest, worst["weight"].get<double>() * report["weight_bound"].get<double>());
  }
  EXPECT_EQ(kinds, (std::set<std::string>{"family", "approach"}));

  // 13 knobs of reflex, one of on_edge; 25 knobs on either side and the edge itself; three bodies.
  EXPECT_EQ(report["errors"].size(), (13 + 1 + 2 * 25 + 1) * 3u);
  const std::string table = read(file("table.csv"));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 1 + (13 + 1 + 2 * 25 + 1) * 3);
  EXPECT_EQ(table.rfind("family,kind,knob,side,engine,fragments,undefined,missing,weight,attribute,depth\n", 0), 0u);
  bool single_fails = false;
  for (const json& entry : report["errors"]) {
    if (entry["engine"] == "model") {
      EXPECT_EQ(entry["undefined"], 0);
      EXPECT_EQ(entry["missing"], 0);
    }
    if (entry["family"] == "edge_distance" && entry["engine"] == "fp32")
      single_fails = single_fails || entry["undefined"] != 0 || (entry["weight"].is_number() && entry["weight"] > 1);
  }
  EXPECT_TRUE(single_fails);

  const json again = json::parse(run(arguments + "- --threads 2").out);
  EXPECT_EQ(again["errors"], report["errors"]);
  EXPECT_EQ(again["families"], report["families"]);
  EXPECT_NE(json::parse(run(arguments + "- --seed 2").out)["errors"], report["errors"]);
}

TEST_F(Cli, StressShardsPutTogetherAreOneRun) {
  const std::string arguments = "stress --families reflex,on_edge,edge_distance,sliver,bowtie --count 2 ";
  const Outcome whole = run(arguments + "--json whole.json --csv whole.csv");
  ASSERT_EQ(whole.status, 0) << whole.err;
  for (const std::string shard : {"0", "1", "2"})
    ASSERT_EQ(run(arguments + "--quiet --threads 1 --shard " + shard + "/3 --json part" + shard + ".json").status, 0);
  EXPECT_EQ(json::parse(read(file("part1.json")))["families"].size(), 2u);
  const Outcome merged = run("stress --merge part1.json part2.json part0.json --json merged.json --csv merged.csv");
  ASSERT_EQ(merged.status, 0) << merged.err;
  EXPECT_EQ(merged.out, whole.out);
  EXPECT_EQ(read(file("merged.json")), read(file("whole.json")));
  EXPECT_EQ(read(file("merged.csv")), read(file("whole.csv")));

  refuses(2, "stress --merge part0.json part2.json", {"shard 1/3 is missing"});
  refuses(2, "stress --merge part0.json part1.json part0.json", {"the same shard"});
  refuses(2, "stress --merge part0.json whole.json", {"whole.json", "--shard"});
  refuses(2, "stress --merge part0.json whole.csv", {"whole.csv"});
  refuses(2, "stress --merge part0.json nowhere.json", {"nowhere.json"});
  refuses(2, "stress --merge part0.json part1.json part2.json --json part1.json", {"part1.json"});
  refuses(2, "stress --shard 0/3 --merge part0.json", {"--shard", "--merge"});
  refuses(2, "stress --families bowtie --shard 0/2", {"--shard 0/2", "1 families"});
  refuses(2, "stress --shard 2/2", {"0 <= I < N"});
  ASSERT_EQ(run(arguments + "--seed 2 --shard 1/3 --json other.json").status, 0);
  refuses(2, "stress --merge part0.json other.json part2.json", {"other.json", "seed"});
  // A fault of a part is one of the whole.
  std::string part = read(file("part1.json"));
  const std::size_t at = part.find("\"faults\": []");
  ASSERT_NE(at, std::string::npos);
  write("part1.json", part.replace(at, 12, "\"faults\": [\"a fault\"]"));
  const Outcome faulty = run("stress --merge part0.json part1.json part2.json --json -");
  EXPECT_EQ(faulty.status, 1);
  EXPECT_NE(faulty.err.find("a fault"), std::string::npos);
  EXPECT_FALSE(json::parse(faulty.out)["ok"].get<bool>());
}

TEST_F(Cli, StressSummary) {
  const Outcome outcome = run("stress --families on_vertex,vertex_distance --count 2 --engines fp32");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  for (const char* piece :
       {"on_vertex", "vertex_distance", "jump", "fp32 is beyond the bound", "worst weight of the model", "echo '"})
    EXPECT_NE(outcome.out.find(piece), std::string::npos) << piece << " in: " << outcome.out;
  EXPECT_EQ(outcome.out.find("float"), outcome.out.npos);
}

TEST_F(Cli, StressSearchRefuses) {
  refuses(2, "stress --search --families slivers", {"unknown family", "did you mean \"sliver\""});
  refuses(2, "stress --search --families edge_distance", {"edge_distance is an approach"});
  refuses(2, "stress --search --evaluations 0", {"--evaluations"});
  refuses(2, "stress --search --evaluations -5", {"--evaluations"});
  refuses(2, "stress --evaluations 5", {"--search"});
  refuses(2, "stress --keep found.quads", {"--keep", "--search"});
  refuses(2, "stress --search --csv t.csv", {"--csv"});
  refuses(2, "stress --search --shard 0/2", {"--shard"});
  refuses(2, "stress --search --families bowtie --keep nowhere/w.quads", {"nowhere"});
  refuses(2, "stress --search --families bowtie --keep w --json w", {"w"});
  refuses(2, "stress --search --set quadratic_frac_bits=10", {"quadratic_frac_bits"});
  refuses(2, "stress --search --kept w.quads", {"--kept"});
  refuses(2, "stress --kept w.quads --set significand_bits=12", {"--kept", "--set"});
  refuses(2, "stress --kept nowhere.quads", {"nowhere.quads"});
  write("plain.quads", "4 4 0.5 1 40 6 0.5 1 50 44 0.5 1 6 50 0.5 1\n");
  refuses(2, "stress --kept plain.quads", {"plain.quads:1", "record"});
  // One pixel of each output: nothing is drawn there, which is no success.
  const Outcome nothing = run("stress --search --families tiny --evaluations 1 --keep none.quads");
  EXPECT_EQ(nothing.status, 1);
  EXPECT_NE(nothing.err.find("nothing was drawn, so nothing was shown; give more --evaluations than 1"),
            std::string::npos)
      << nothing.err;
  EXPECT_FALSE(fs::exists(file("none.quads")));
}

TEST_F(Cli, StressSearchKeepsWhatItFinds) {
  const std::string arguments =
      "stress --search --families reflex,w_zero --evaluations 1500 --set significand_bits=12 ";
  const Outcome outcome = run(arguments + "--threads 1 --keep one.quads --json one.json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const Outcome again = run(arguments + "--threads 3 --keep three.quads --json three.json");
  EXPECT_EQ(again.out, outcome.out);
  EXPECT_EQ(read(file("three.quads")), read(file("one.quads")));
  EXPECT_EQ(read(file("three.json")), read(file("one.json")));
  ASSERT_EQ(run(arguments + "--seed 2 --keep other.quads").status, 0);
  EXPECT_NE(read(file("other.quads")), read(file("one.quads")));

  const json report = json::parse(read(file("one.json")));
  EXPECT_TRUE(report["ok"]);
  ASSERT_EQ(report["worst"].size(), 6u);
  EXPECT_EQ(report["worst"][0]["family"], "reflex");
  EXPECT_EQ(report["worst"][5]["output"], "depth");
  // The reproducer's pixel: the weights of the model are as far from the truth's as the report says.
  std::string line = report["worst"][0]["reproduce"];
  EXPECT_NE(outcome.out.find(line), std::string::npos);
  write("worst.quads", line.substr(6, line.find('\'', 6) - 6) + "\n");
  line = line.substr(line.find("fragments"));
  line.replace(line.find("/dev/stdin"), 10, "worst.quads");
  const auto weights = [&](const std::string& engine) {
    const Outcome drawn = run(line + " --engine " + engine);
    EXPECT_EQ(drawn.status, 0) << drawn.err;
    std::istringstream cells(drawn.out.substr(drawn.out.find('\n') + 1));
    std::vector<double> out;
    std::string cell;
    for (int column = 0; column < 9 && std::getline(cells, cell, ','); ++column)
      if (column >= 5) out.push_back(std::strtod(cell.c_str(), nullptr));
    return out;
  };
  const std::vector<double> model = weights("model"), truth = weights("truth");
  ASSERT_EQ(model.size(), 4u);
  double largest = 0;
  for (std::size_t i = 0; i < 4; ++i) largest = std::max(largest, std::fabs(model[i] - truth[i]));
  EXPECT_DOUBLE_EQ(std::ldexp(largest, 12), report["worst"][0]["units"].get<double>());

  // What is kept passes, and with another error in the record does not, until it is recorded anew.
  const Outcome kept = run("stress --kept one.quads");
  EXPECT_EQ(kept.status, 0) << kept.err;
  EXPECT_NE(kept.out.find("worst: "), std::string::npos);
  const std::string good = read(file("one.quads"));
  std::string bad = good;
  const std::size_t at = bad.find("# reflex depth ");
  ASSERT_NE(at, std::string::npos);
  const std::size_t digit = bad.find(' ', at + 15) - 1;
  bad[digit] = bad[digit] == '5' ? '6' : '5';
  write("bad.quads", bad);
  const Outcome fault = run("stress --kept bad.quads --json bad.json");
  EXPECT_EQ(fault.status, 1);
  EXPECT_NE(fault.err.find("reflex depth"), std::string::npos) << fault.err;
  EXPECT_NE(fault.err.find("the error is now"), std::string::npos) << fault.err;
  EXPECT_FALSE(json::parse(read(file("bad.json")))["ok"].get<bool>());
  EXPECT_EQ(run("stress --kept bad.quads --keep bad.quads").status, 0);
  EXPECT_EQ(read(file("bad.quads")), good);
}

}  // namespace
}  // namespace quadrille::cli_test
