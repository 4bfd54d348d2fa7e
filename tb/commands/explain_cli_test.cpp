// explain: the numbers of one pixel are those of fragments --errors; rules, errors, files, and the RTL beside the
// model.
#include "tb/commands/cli_fixture.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace {

using namespace quadrille::cli_test;
using nlohmann::json;

class CliExplain : public Cli {
 protected:
  json explained(const std::string& arguments) const {
    const Outcome outcome = run("explain " + arguments + " --quiet --json -");
    EXPECT_EQ(outcome.status, 0) << arguments << outcome.err;
    return json::parse(outcome.out, nullptr, false);
  }
  static const json& number(const json& explanation, const std::string& stage, const std::string& name) {
    for (const json& s : explanation["stages"])
      if (s["name"] == stage)
        for (const json& n : s["numbers"])
          if (n["name"] == name) return n;
    static const json none;
    ADD_FAILURE() << stage << " has no " << name;
    return none;
  }
  void refuses(const std::string& arguments, const std::string& words) const {
    const Outcome outcome = run("explain " + arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << arguments << ": " << outcome.err;
    EXPECT_EQ(outcome.out, "") << arguments;
  }
};
using CliExplainRtl = CliExplain;

/// Each weight, attribute and depth of every quad at a pixel, and its share of the bound.
TEST_F(CliExplain, SameNumbersAsFragments) {
  std::size_t compared = 0;
  for (const std::string input :
       {"--scene fig10_concave --size 96x96 --pixel 40,50", "--scene fig8_behind --size 96x96 --pixel 50,60",
        "--scene sphere --size 96x96 --pixel 40,41 --set significand_bits=12", "--scene bowtie --pixel 160,160",
        "--scene sphere --size 96x96 --pixel 40,41 --no-perspective --set attribute_slots=2",
        "--stress coplanar --count 40 --size 64x64 --pixel 30,31 --set tile_log2=2",
        "--stress on_vertex --count 40 --size 64x64 --pixel 37,33",
        "--stress on_vertex --count 40 --size 64x64 --pixel 41,36",
        "--stress on_edge --count 40 --size 64x64 --pixel 9,51 --cull none",
        "--corner two_edge --no-perspective --size 64x64 --pixel 15,11"}) {
    SCOPED_TRACE(input);
    const Outcome fragments = run("fragments " + input + " --errors --out -");
    ASSERT_EQ(fragments.status, 0) << fragments.err;
    std::map<int, std::map<std::string, std::vector<std::string>>> rows;  // by quad and value
    std::istringstream table(fragments.out);
    std::string line;
    std::getline(table, line);
    ASSERT_EQ(line, "quad,x,y,value,drawn,truth,error,of_bound");
    while (std::getline(table, line)) {
      std::vector<std::string> cells;
      std::istringstream row(line);
      for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
      cells.resize(8);
      auto& of_quad = rows[std::stoi(cells[0])];
      // A scene's attributes have names; the machine's slots are numbered, in their order.
      const bool slot = cells[3] != "z" && !(cells[3][0] == 'l' && std::isdigit(cells[3][1]));
      if (slot) {
        const auto known = [](const auto& value) { return value.first[0] == 'a'; };
        cells[3] = "a" + std::to_string(std::ranges::count_if(of_quad, known));
      }
      of_quad[cells[3]] = {cells[4], cells[5], cells[7]};
    }
    ASSERT_FALSE(rows.empty());
    std::size_t drawn = 0;
    const json report = explained(input);
    for (const json& e : report["explanations"]) {
      if (e["outcome"] != "drawn") continue;
      ++drawn;
      for (const auto& [value, cells] : rows.at(e["quad"])) {
        if (cells[1] == "missing") continue;  // the engine truth has the pixel behind the eye, within its tolerance
        const bool weight = value[0] == 'l';
        const std::string name = weight ? "λ'" + value.substr(1) : value;
        if (value[0] == 'a' && !e["stages"].empty() && value > "a1" && input.find("slots=2") != std::string::npos)
          continue;
        const json& n = number(e, weight ? "lambda" : "fragment", name);
        ASSERT_FALSE(n.is_null());
        EXPECT_EQ(n["value"], std::stod(cells[0])) << value;
        ++compared;
        // Clamped in the explanation alone.
        if (value[0] == 'a' && e["flags"].dump().find("saturated") != std::string::npos) continue;
        EXPECT_NEAR(n["exact"].get<double>(), std::stod(cells[1]), 1e-13) << value;
        // The weights' bound does not hold where sums of M W may cancel.
        const bool may_cancel =
            weight && e["homogeneous"] == true && input.find("--no-perspective") != std::string::npos;
        if (!cells[2].empty() && !may_cancel) {
          EXPECT_NEAR(n["of_bound"].get<double>(), std::stod(cells[2]), 1e-6) << value;
        }
      }
    }
    EXPECT_EQ(drawn, rows.size());
  }
  EXPECT_GT(compared, 80u);
}

TEST_F(CliExplain, SaysWhichRuleRejects) {
  Outcome outcome = run("explain --scene sphere --pixel 2,2");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("0 of 128 quads cover it"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("No quad covers the pixel:\n  128 outside"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("no clause of expression (12) holds"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("px away"), std::string::npos) << outcome.out;

  write("q.quads", good_quad);
  outcome = run("explain --quads q.quads --pixel 20,20 --zfar 0.25");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("not drawn (left out)"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("every depth of the quad is outside [znear, zfar]"), std::string::npos) << outcome.out;
  outcome = run("explain --quads q.quads --pixel 20,20 --quad 0");
  EXPECT_NE(outcome.out.find("Pixel (20, 20), quad 0: drawn\n"), std::string::npos) << outcome.out;
  EXPECT_LT(outcome.out.size(), run("explain --quads q.quads --pixel 20,20 --verbose").out.size());
}

TEST_F(CliExplain, ReadsMeshesAndWritesAPage) {
  write("m.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n");
  write("narrow.toml", "significand_bits = 12\n");
  const Outcome outcome = run("explain --mesh m.obj --config narrow.toml --size 64x64 --pixel 32,32 --html p.html");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("The leading 12 bits"), std::string::npos) << outcome.out;
  const std::string page = read(file("p.html"));
  EXPECT_EQ(page.rfind("<!DOCTYPE html>", 0), 0u);
  EXPECT_NE(page.find("Pixel (32, 32) of m.obj"), std::string::npos);
  EXPECT_NE(page.find("quadrille explain --mesh m.obj"), std::string::npos);
  EXPECT_NE(page.find("</html>\n"), std::string::npos);
  const Outcome alone = run("explain --mesh m.obj --size 64x64 --pixel 32,32 --html -");
  EXPECT_EQ(alone.out.rfind("<!DOCTYPE html>", 0), 0u);
}

TEST_F(CliExplain, RefusesBadInput) {
  write("q.quads", good_quad);
  write("zero.quads", std::string(good_quad) + "0 0 0.5 0  40 12 0.5 1  42 44 0.5 1  8 40 0.5 1\n");
  refuses("--scene bowtie", "--pixel X,Y is missing");
  refuses("--pixel 1,1", "one input is needed");
  refuses("--scene bowtie --pixel 512,0", "expected X,Y inside the viewport");
  refuses("--scene bowtie --pixel 1:1", "expected X,Y");
  refuses("--quads q.quads --pixel 1,1 --quad 1", "has 1 quads, counted from 0");
  refuses("--quads zero.quads --pixel 1,1", "zero.quads:2");
  refuses("--scene bowtie --pixel 1,1 --engine truth", "expected model or rtl");
  refuses("--scene bowtie --pixel 1,1 --rtl .", "--rtl needs --engine rtl");
  refuses("--scene bowtie --pixel 1,1 --engine rtl --rtl nowhere", "--rtl nowhere: no such file or directory");
  refuses("--quads q.quads --pixel 1,1 --html q.quads", "q.quads");
  refuses("--scene bowtie --pixel 1,1 --html p.png", "p.png");
  EXPECT_EQ(read(file("q.quads")), good_quad);
}

TEST_F(CliExplainRtl, AgreesWithTheModelAtEveryBoundary) {
  for (const std::string input :
       {"--scene bowtie --pixel 160,160", "--scene fig8_behind --pixel 256,300",
        "--corner two_corner --size 64x64 --pixel 10,12", "--stress on_vertex --count 40 --size 64x64 --pixel 37,33"}) {
    std::size_t covering = 0;
    const json report = explained(input + " --engine rtl");
    for (const json& e : report["explanations"]) {
      if (e["outcome"] != "drawn") continue;
      ++covering;
      for (const json& stage : e["stages"]) {
        const bool none = stage["boundary"] == "vertex" || stage["name"] == "reciprocal";
        EXPECT_EQ(stage["compared"], none ? "no" : "same") << stage["name"];
        if (none) continue;
        for (const json& n : stage["numbers"]) EXPECT_EQ(n["stored"], n["other"]) << stage["name"] << n["name"];
      }
    }
    EXPECT_GT(covering, 0u) << input;
  }
}

}  // namespace
