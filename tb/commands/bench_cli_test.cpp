// `quadrille bench --error` as a program: bad input, the report, results that do not depend on threads.
#include "tb/commands/cli_fixture.hpp"

#include <nlohmann/json.hpp>

#include <set>

namespace quadrille::cli_test {
namespace {

using nlohmann::json;

constexpr const char* good_quad = "10 10 0.5 1  40 12 0.5 1  42 44 0.5 1  8 40 0.5 1\n";

TEST_F(Cli, BenchErrorRefuses) {
  refuses(2, "bench --scene sphere", {"--scene", "--error"});
  refuses(2, "bench --count 5", {"--count", "--error"});
  refuses(2, "bench --limit-fragments 5", {"--limit-fragments", "--error"});
  refuses(2, "bench --error --quad-size 8", {"--quad-size", "--error"});
  refuses(2, "bench --error --fragments 5000", {"--fragments", "--error"});
  refuses(2, "bench --error --limit-fragments -5", {"--limit-fragments", "whole number"});
  refuses(2, "bench --error --limit-fragments 0", {"--limit-fragments"});
  refuses(2, "bench --error --repeat 0", {"--repeat"});
  refuses(2, "bench --error --no-rtl --lanes v5", {"no lanes \"v5\"", "baseline, v3, v4"});
  refuses(2, "bench --error --no-rtl --scene shpere", {"unknown scene", "did you mean \"sphere\""});
  refuses(2, "bench --error --no-rtl --stress slivers", {"unknown stress family", "did you mean \"sliver\""});
  refuses(2, "bench --error --no-rtl --scene sphere --stress sliver", {"one input is needed"});
  refuses(2, "bench --error --no-rtl --camera c.json", {"--camera goes with --mesh"});
  refuses(2, "bench --error --no-rtl --mesh nothing.obj", {"nothing.obj"});
  refuses(2, "bench --error --no-rtl --scene sphere --size 9999x2", {"--size"});
  refuses(2, "bench --error --no-rtl --scene sphere --json nowhere/e.json", {"nowhere"});
  write("bad.quads", std::string(good_quad) + "10 10 0.5 1  40 12 nan 1  42 44 0.5 1  8 40 0.5 1\n");
  refuses(2, "bench --error --no-rtl --quads bad.quads", {"bad.quads:2"});
  write("same.quads", good_quad);
  refuses(2, "bench --error --no-rtl --quads same.quads --json same.quads", {"same.quads"});
  EXPECT_EQ(read(file("same.quads")), good_quad);
}

TEST_F(Cli, BenchErrorReports) {
  const auto errors = [&](const std::string& arguments) {
    const Outcome outcome = run("bench --error --no-rtl --repeat 1 --json - " + arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    json report = json::parse(outcome.out);
    EXPECT_TRUE(report["ok"]);
    for (json& entry : report["error"]) {
      EXPECT_GT(entry["seconds_per_fragment"], 0);
      entry.erase("seconds_per_fragment");
    }
    return report["error"];
  };
  const json entries = errors("--stress general --count 30 --threads 1");
  std::set<std::string> engines;
  for (const json& entry : entries) {
    engines.insert(entry["engine"]);
    EXPECT_EQ(entry["input"], "general");
    EXPECT_EQ(entry["kind"], "stress");
    EXPECT_GT(entry["fragments"], 1000);
    EXPECT_EQ(entry["fragments"], entries[0]["fragments"]);
    EXPECT_EQ(entry["missing"], 0);
    for (const char* key : {"lambda_max", "lambda_p999", "lambda_rms", "attribute_max", "depth_max"})
      EXPECT_TRUE(entry["engine"] == "truth" ? entry[key] == 0 : entry[key] > 0) << entry;
  }
  EXPECT_EQ(engines, (std::set<std::string>{"fp32", "fp64", "truth", "model-plain", "model", "model-clocked"}));
  EXPECT_EQ(entries.size(), engines.size());
  EXPECT_EQ(errors("--stress general --count 30 --threads 3"), entries);
  // Three more bits are an eighth of the error, or less than a half in any case.
  const json finer = errors("--stress general --count 30 --set significand_bits=21");
  EXPECT_LT(finer[4]["lambda_max"].get<double>(), 0.5 * entries[4]["lambda_max"].get<double>());
  EXPECT_EQ(finer[4]["engine"], "model");
}

TEST_F(Cli, BenchErrorWithNothingDefinedOrNothingDrawn) {
  // A collapsed edge has A = 0 everywhere: the paper's formulas are undefined, their errors null. No attributes.
  write("triangle.quads", "10 10 0.5 1  40 12 0.5 1  42 44 0.5 1  42 44 0.5 1\n");
  const Outcome triangle = run("bench --error --no-rtl --repeat 1 --quads triangle.quads --json -");
  ASSERT_EQ(triangle.status, 0) << triangle.err;
  const json report = json::parse(triangle.out);
  for (const json& entry : report.at("error")) {
    const bool paper = entry["engine"] == "fp32" || entry["engine"] == "fp64";
    EXPECT_EQ(entry["lambda_max"].is_null(), paper) << entry;
    EXPECT_EQ(entry["undefined"], paper ? entry["fragments"] : json(0)) << entry;
    EXPECT_TRUE(entry["attribute_max"].is_null());
  }
  write("outside.quads", "910 10 0.5 1  940 12 0.5 1  942 44 0.5 1  908 40 0.5 1\n");
  const Outcome outside = run("bench --error --no-rtl --repeat 1 --quads outside.quads --json out.json");
  EXPECT_EQ(outside.status, 1);
  EXPECT_NE(outside.err.find("quads outside.quads: model: no fragments"), std::string::npos) << outside.err;
  EXPECT_FALSE(json::parse(read(file("out.json")))["ok"]);
}

}  // namespace
}  // namespace quadrille::cli_test
