// `quadrille stress` as a program: bad input, the report and table, reproducers that run, results that do not depend on
// threads.
#include "tb/commands/cli_fixture.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace quadrille::cli_test {
namespace {

using nlohmann::json;

TEST_F(Cli, StressRefuses) {
  refuses(2, "stress --families slivers", {"unknown family", "did you mean \"sliver\""});
  refuses(2, "stress --families sliver,,bowtie", {"unknown family"});
  refuses(2, "stress --families crossing,bowtie,crossing", {"--families", "crossing", "twice"});
  refuses(2, "stress --engines fp64", {"unknown engine", "fp32"});
  refuses(2, "stress --count 0", {"--count"});
  refuses(2, "stress --size 99999x2", {"--size"});
  refuses(2, "stress --families bowtie --json nowhere/s.json", {"nowhere"});
  refuses(2, "stress --families bowtie --csv - --json -", {"two outputs"});
  refuses(2, "stress --families long_edge --set viewport_bits=9", {"long_edge", "viewport_bits"});
  refuses(2, "stress --families bowtie --set quadratic_frac_bits=10", {"quadratic_frac_bits"});
  refuses(2, "stress --stress bowtie", {"--stress"});
}

/// Of a report of `quadrille stress`: the commands that it has.
class CliStress : public Cli {
 protected:
  struct Row {
    std::string value, drawn, truth, of_bound;
  };

  /// What a command of the report prints, a row for each value.
  std::vector<Row> rows_of(std::string line) const {
    const std::size_t at = line.find("quadrille fragments");
    if (line.rfind("echo '", 0) != 0 || at == line.npos) throw std::runtime_error("no command: " + line);
    write("pixel.quads", line.substr(6, line.find('\'', 6) - 6) + "\n");
    line = line.substr(at + std::string("quadrille ").size());
    line.replace(line.find("/dev/stdin"), 10, "pixel.quads");
    const Outcome drawn = run(line);
    EXPECT_EQ(drawn.status, 0) << drawn.err;
    std::istringstream text(drawn.out);
    std::string row_text, cell;
    std::getline(text, row_text);
    EXPECT_EQ(row_text, "quad,x,y,value,drawn,truth,error,of_bound");
    std::vector<Row> rows;
    while (std::getline(text, row_text)) {
      std::istringstream cells(row_text + ",");
      std::vector<std::string> row;
      while (std::getline(cells, cell, ',')) row.push_back(cell);
      if (row.size() != 8) throw std::runtime_error("no row: " + row_text);
      rows.push_back({row[3], row[4], row[5], row[7]});
    }
    return rows;
  }

  /// Every command of every body shows what the report says of its pixel. Returns how many were run of each body.
  std::map<std::string, int> check_commands(const json& report) const {
    std::map<std::string, int> commands;
    for (const json& family : report["families"])
      for (const auto& [body, outputs] : family["worst"].items())
        for (const auto& [output, worst] : outputs.items()) {
          SCOPED_TRACE(family["family"].get<std::string>() + " " + body + " " + output + ": " + worst.dump());
          if (worst["reproduce"].is_null()) {
            EXPECT_EQ(worst["error"], 0);
            continue;
          }
          ++commands[body];
          const std::string line = worst["reproduce"];
          EXPECT_NE(line.find(" --engine " + body + " "), line.npos);
          const std::vector<Row> rows = rows_of(line);
          EXPECT_GE(rows.size(), 5u);
          double largest = 0;
          for (const Row& row : rows) {
            EXPECT_NE(row.truth, "missing");
            if (output == "lost") {
              EXPECT_TRUE(row.drawn == "undefined" || row.drawn == "missing") << row.drawn;
            }
            const char* kind = row.value[0] == 'l' ? "weight" : row.value[0] == 'a' ? "attribute" : "depth";
            if (kind == output) largest = std::max(largest, std::strtod(row.of_bound.c_str(), nullptr));
          }
          if (output != "lost") {
            EXPECT_EQ(largest, worst["error"].get<double>());
          }
        }
    return commands;
  }

  std::vector<std::string> approaches() const {
    std::vector<std::string> names;
    for (const json& entry : json::parse(run("scenes --stress --json").out))
      if (entry["kind"] == "approach") names.push_back(entry["name"]);
    return names;
  }

  /// No rule on the widths fails on the way to a special case, nor is a step without a pixel that shows it.
  void check_approaches(const std::vector<std::string>& names, int bits, int count) const {
    SCOPED_TRACE(bits);
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ",") + name;
    const Outcome outcome = run("stress --engines model --json - --families " + list + " --count " +
                                std::to_string(count) + " --set significand_bits=" + std::to_string(bits));
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const json report = json::parse(outcome.out);
    EXPECT_EQ(report["weight_bound"], std::ldexp(1.0, 3 - bits));
    ASSERT_EQ(report["families"].size(), names.size());
    for (const json& family : report["families"])
      for (const char* output : {"weight", "attribute", "depth"}) {
        // A constant depth is exact.
        if (family["family"] == "guard_band_flat" && output == std::string_view("depth"))
          EXPECT_EQ(family["worst"]["model"][output]["error"], 0);
        else
          EXPECT_GT(family["worst"]["model"][output]["error"], 0) << family["family"] << output;
        EXPECT_LT(family["worst"]["model"][output]["error"], 1) << family["family"] << output;
      }
  }
};

/// Simulators, or minutes.
class CliStressRtl : public CliStress {};
class CliStressWidths : public CliStress {};
class CliStressWhole : public CliStress {};

const std::string paper_bodies = QUADRILLE_OPENGL_FOUND ? "float,fp32,shader" : "float,fp32";

TEST_F(CliStress, Reports) {
  const std::string arguments = "stress --families reflex,on_edge,edge_distance,edge_length --count 6 --json ";
  const Outcome outcome = run(arguments + "- --csv table.csv --threads 1");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json report = json::parse(outcome.out);
  EXPECT_TRUE(report["ok"]);
  EXPECT_EQ(report["weight_bound"], std::ldexp(1.0, -15));
  ASSERT_EQ(report["families"].size(), 4u);
  std::set<std::string> kinds;
  for (const json& family : report["families"]) {
    kinds.insert(family["kind"]);
    EXPECT_EQ(family["jump"].is_null(), family["kind"] == "family");
    const json& worst = family["worst"]["model"]["weight"];
    EXPECT_GT(worst["error"], 0);
    EXPECT_LT(worst["error"], 1);
  }
  EXPECT_EQ(kinds, (std::set<std::string>{"family", "approach"}));

  // 13 knobs of reflex, one of on_edge; 25 knobs on either side and the edge itself, 9 and its length of 0; three
  // bodies.
  constexpr int steps = 13 + 1 + (2 * 25 + 1) + (2 * 9 + 1);
  EXPECT_EQ(report["errors"].size(), steps * 3u);
  const std::string table = read(file("table.csv"));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 1 + steps * 3);
  EXPECT_EQ(
      table.rfind("family,kind,knob,side,engine,fragments,beyond,undefined,missing,weight,attribute,depth,"
                  "near_fragments,near_beyond,near_undefined,near_missing,near_weight,near_attribute,near_depth\n",
                  0),
      0u);
  bool single_fails = false;
  for (const json& entry : report["errors"]) {
    if (entry["engine"] == "model") {
      EXPECT_EQ(entry["undefined"], 0);
      EXPECT_EQ(entry["missing"], 0);
      EXPECT_EQ(entry["beyond"], 0);
    }
    const json& near = entry["near"];
    EXPECT_EQ(near.is_null(), entry["family"] == "reflex" || entry["family"] == "on_edge");
    // A body is beyond the bound where an error is, and only there.
    const auto beyond = [](const json& value) { return value.is_number() && value > 1; };
    EXPECT_EQ(entry["beyond"] != 0, beyond(entry["weight"]) || beyond(entry["attribute"]) || beyond(entry["depth"]));
    single_fails = single_fails || (entry["engine"] == "fp32" && entry["beyond"] != 0);
    if (entry["family"] != "edge_distance") continue;
    // One pixel of each quad, which the edge passes by.
    EXPECT_LE(near["fragments"].get<int>() + near["undefined"].get<int>() + near["missing"].get<int>(), 6);
    EXPECT_LE(near["fragments"], entry["fragments"]);
    if (!near["weight"].is_null()) {
      EXPECT_LE(near["weight"], entry["weight"]);
    }
  }
  EXPECT_TRUE(single_fails);

  const json again = json::parse(run(arguments + "- --threads 2").out);
  EXPECT_EQ(again["errors"], report["errors"]);
  EXPECT_EQ(again["families"], report["families"]);
  EXPECT_NE(json::parse(run(arguments + "- --seed 2").out)["errors"], report["errors"]);
}

TEST_F(CliStress, EveryCommandShowsItsError) {
  const Outcome outcome =
      run("stress --families eye_in_hull,edge_distance --count 2 --json - --engines " + paper_bodies);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json report = json::parse(outcome.out);
  const std::map<std::string, int> commands = check_commands(report);
  EXPECT_EQ(commands.size(), QUADRILLE_OPENGL_FOUND ? 4u : 3u);
  for (const auto& [body, count] : commands) EXPECT_GE(count, 6) << body;
}

TEST_F(CliStressRtl, EveryCommandShowsItsError) {
  const Outcome outcome = run("stress --families crossing --count 2 --json - --engines rtl");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(check_commands(json::parse(outcome.out)), (std::map<std::string, int>{{"model", 3}, {"rtl", 3}}));
}

/// A quarter of the approaches at every width, the next at the next. Two quads a step: the edge of one has its pixel
/// inside on one side alone.
TEST_F(CliStressWidths, ApproachesInTurn) {
  const std::vector<std::string> all = approaches();
  for (int bits = 8; bits <= 26; ++bits) {
    std::vector<std::string> names;
    for (std::size_t i = static_cast<std::size_t>(bits) % 4; i < all.size(); i += 4) names.push_back(all[i]);
    check_approaches(names, bits, 2);
  }
}

TEST_F(CliStressWhole, ApproachesAtEveryWidth) {
  for (int bits = 8; bits <= 26; ++bits) check_approaches(approaches(), bits, 6);
}

/// The command as it is meant to be run, every family and approach by every body.
TEST_F(CliStressWhole, EveryFamilyByEveryBody) {
  const Outcome outcome = run("stress --count 3 --json - --engines rtl," + paper_bodies);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json report = json::parse(outcome.out);
  EXPECT_EQ(report["families"].size(), json::parse(run("scenes --stress --json").out).size());
  std::map<std::string, json> model;
  std::uint64_t fragments = 0, equal = 0;
  for (const json& entry : report["errors"]) {
    json rest = entry;
    rest.erase("engine");
    const std::string step = entry["family"].get<std::string>() + rest["knob"].dump() + " " + rest["side"].dump();
    if (entry["engine"] == "model") {
      model[step] = rest;
      EXPECT_EQ(entry["beyond"], 0) << step;
      fragments += entry["fragments"].get<std::uint64_t>();
    } else if (entry["engine"] == "rtl") {
      EXPECT_EQ(rest, model[step]) << step;
      ++equal;
    } else {
      // Each pixel of the model is one of the body, or is counted as lost.
      EXPECT_EQ(entry["fragments"].get<std::uint64_t>() + entry["undefined"].get<std::uint64_t>() +
                    entry["missing"].get<std::uint64_t>(),
                model[step]["fragments"].get<std::uint64_t>())
          << step;
    }
  }
  EXPECT_EQ(equal, model.size());
  EXPECT_GT(fragments, 0u);
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
  refuses(2, "stress --families bowtie --shard 0/2", {"--shard 0/2", "families (1)"});
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

TEST_F(CliStress, Summary) {
  const Outcome outcome = run("stress --families on_vertex,vertex_distance --count 2 --engines fp32 --json r.json");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  for (const char* piece :
       {"on_vertex", "vertex_distance", "jump", "\nfp32: of 2 families, ",
        "\nmodel: of 2 families, 0 beyond the bound, 0 with undefined pixels, 0 with missing pixels\n",
        "largest errors: weight "})
    EXPECT_NE(outcome.out.find(piece), std::string::npos) << piece << " in: " << outcome.out;
  EXPECT_EQ(outcome.out.find("float"), outcome.out.npos);
  // The worst weight of each body, with its command.
  const json report = json::parse(read(file("r.json")));
  for (const std::string body : {"model", "fp32"}) {
    const json* worst = nullptr;
    for (const json& family : report["families"])
      if (const json& weight = family["worst"][body]["weight"]; !worst || weight["error"] > (*worst)["error"])
        worst = &weight;
    ASSERT_NE(worst, nullptr);
    EXPECT_NE(outcome.out.find("\n  " + (*worst)["reproduce"].get<std::string>() + "\n"), outcome.out.npos) << body;
  }
}

/// Errors that are not 0 are not printed as if they were.
TEST_F(CliStress, SmallErrorsAreSeen) {
  const Outcome outcome = run("stress --families perspective --count 2 --engines float");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::size_t row = outcome.out.find("\nperspective ");
  ASSERT_NE(row, outcome.out.npos);
  const std::string line = outcome.out.substr(row + 1, outcome.out.find('\n', row + 1) - row - 1);
  EXPECT_NE(line.find("e-"), line.npos) << line;
  EXPECT_EQ(line.find("0.000"), line.npos) << line;
}

TEST_F(CliStress, StepsWithoutFragmentsAreNamed) {
  // No pixel is in a quad without an area.
  const Outcome outcome = run("stress --families sliver_thickness --count 1 --engines model");
  EXPECT_NE(outcome.out.find("no fragments: sliver_thickness at "), outcome.out.npos) << outcome.out;
  EXPECT_NE(outcome.out.find("special case"), outcome.out.npos) << outcome.out;
}

TEST_F(CliStress, FragmentsWithErrors) {
  write("q.quads", "4 4 0.2 1 40 6 0.4 1 50 44 0.8 1 6 50 0.6 1 0.1 0.2 0.3 0.4\n");
  const std::string line = "fragments --quads q.quads --size 64x64 --errors --out - --engine ";
  const Outcome truth = run(line + "truth"), model = run(line + "model"), single = run(line + "fp32");
  ASSERT_EQ(truth.status, 0) << truth.err;
  ASSERT_EQ(single.status, 0) << single.err;
  const auto largest = [](const Outcome& outcome) {
    std::istringstream text(outcome.out);
    std::string row;
    double most = -1;
    while (std::getline(text, row))
      if (row.rfind("quad,", 0) != 0) most = std::max(most, std::strtod(row.c_str() + row.rfind(',') + 1, nullptr));
    return most;
  };
  EXPECT_LT(largest(truth), 1e-10);            // rounding of the truth alone
  EXPECT_GT(largest(model), largest(single));  // far from any case single precision is the better one
  EXPECT_LT(largest(model), 1);
  EXPECT_GT(largest(single), 0);
  const std::string rows = run("fragments --quads q.quads --size 64x64 --out -").out;
  EXPECT_EQ(std::count(model.out.begin(), model.out.end(), '\n') - 1,
            6 * (std::count(rows.begin(), rows.end(), '\n') - 1));
  refuses(2, line + "float --snap off", {"--errors", "--snap on"});
  refuses(2, line + "model --set quadratic_frac_bits=10", {"--errors", "quadratic_frac_bits"});
  refuses(2, line + "fp64", {"unknown engine", "fp32"});
  refuses(2, "render --engine fp32 --quads q.quads --png p.png", {"unknown engine"});
}

TEST_F(Cli, StressSearchRefuses) {
  refuses(2, "stress --search --families slivers", {"unknown family", "did you mean \"sliver\""});
  refuses(2, "stress --search --families edge_distance", {"edge_distance is an approach"});
  refuses(2, "stress --search --evaluations 0", {"--evaluations"});
  refuses(2, "stress --search --evaluations -5", {"--evaluations"});
  refuses(2, "stress --evaluations 5", {"--search"});
  refuses(2, "stress --leave", {"--search"});
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
