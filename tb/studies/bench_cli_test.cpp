// `quadrille bench --error` and `--skips` as a program: bad input, the report, results that do not depend on threads.
#include "tb/commands/cli_fixture.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace quadrille::cli_test {
namespace {

using nlohmann::json;

/// All loads by all engines: half a minute.
class CliBenchWhole : public Cli {};

TEST_F(Cli, BenchErrorRefuses) {
  refuses(2, "bench --scene sphere", {"--scene", "--error"});
  refuses(2, "bench --count 5", {"--count", "--error"});
  refuses(2, "bench --limit-fragments 5", {"--limit-fragments", "--error"});
  refuses(2, "bench --error --quad-size 8", {"--quad-size", "--error"});
  refuses(2, "bench --error --fragments 5000", {"--fragments", "--error"});
  refuses(2, "bench --error --limit-fragments -5", {"--limit-fragments", "whole number"});
  refuses(2, "bench --error --limit-fragments 0", {"--limit-fragments"});
  refuses(2, "bench --error --repeat 0", {"--repeat"});
  refuses(2, "bench --error --no-rtl --lanes v5", {"\"v5\"", "baseline, v2, v3, v4"});
  refuses(2, "bench --error --no-rtl --scene shpere", {"unknown scene", "did you mean \"sphere\""});
  refuses(2, "bench --error --no-rtl --stress slivers", {"unknown stress family", "did you mean \"sliver\""});
  refuses(2, "bench --error --no-rtl --scene sphere --stress sliver", {"one input is needed"});
  refuses(2, "bench --error --no-rtl --camera c.json", {"--camera needs --mesh"});
  refuses(2, "bench --error --no-rtl --mesh nothing.obj", {"nothing.obj"});
  refuses(2, "bench --error --no-rtl --scene sphere --size 9999x2", {"--size"});
  refuses(2, "bench --error --no-rtl --scene sphere --json nowhere/e.json", {"nowhere"});
  write("bad.quads", std::string(good_quad) + "10 10 0.5 1  40 12 nan 1  42 44 0.5 1  8 40 0.5 1\n");
  refuses(2, "bench --error --no-rtl --quads bad.quads", {"bad.quads:2"});
  write("same.quads", good_quad);
  refuses(2, "bench --error --no-rtl --quads same.quads --json same.quads", {"same.quads"});
  EXPECT_EQ(read(file("same.quads")), good_quad);
}

TEST_F(Cli, BenchSkipsRefuses) {
  refuses(2, "bench --skips --error", {"--skips", "--error"});
  refuses(2, "bench --skips --quad-size 8", {"--quad-size", "--skips"});
  refuses(2, "bench --pictures here", {"--pictures", "--skips"});
  refuses(2, "bench --skips --scene ciy_front", {"unknown scene", "did you mean \"city_front\""});
  refuses(2, "bench --skips --scene room --json nowhere/s.json", {"nowhere"});
}

/// Eight quads over the whole picture, of which nothing can be skipped but what the first one hides: every number
/// follows from that.
TEST_F(Cli, BenchSkipsReports) {
  const auto skips = [&](const std::string& arguments) {
    const Outcome outcome = run("bench --skips --scene layers_large --size 64x64 --repeat 1 --json - " + arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    json report = json::parse(outcome.out);
    EXPECT_TRUE(report["ok"]);
    for (json& entry : report["skips"]) entry.erase("model_seconds");
    return report;
  };
  const json report = skips("--threads 1 --pictures pictures");
  std::vector<std::string> columns;
  for (const json& entry : report["skips"]) {
    columns.push_back(entry["skip"]);
    const bool hides = columns.back() == "hidden" || columns.back() == "all";
    const int drawn = hides ? 1 : 8;
    EXPECT_EQ(entry["hierarchical_z_bits"], hides ? 12 : 0);
    EXPECT_EQ(entry["pixels"], drawn * 64 * 64);
    EXPECT_EQ(entry["tiles_hidden"], 0);
    EXPECT_EQ(entry["tiles_masked"], entry["counters"]["tiles_masked"]);
    EXPECT_EQ(entry["quads"], 8);
    EXPECT_DOUBLE_EQ(entry["pixels_per_clock"], entry["pixels"].get<double>() / entry["cycles"].get<double>());
    EXPECT_EQ(entry["blocks_hidden"], 8 - drawn);
    EXPECT_EQ(entry["counters"]["quads_ordinary"], 8);
    const bool plane = columns.back() == "plane" || columns.back() == "all";  // rectangles, parallel to the screen
    EXPECT_EQ(entry["plane_quads"], plane ? 1 : 0);
    EXPECT_EQ(entry["counters"]["quads_plane"], plane ? 8 : 0);
    EXPECT_EQ(entry["pixels_plane"], plane ? entry["pixels"] : json(0));
    EXPECT_EQ(entry["counters"]["products_sqrt"] == 0, plane);
    EXPECT_EQ(entry["counters"]["tiles_entered"], drawn * 64);
    EXPECT_EQ(entry["counters"]["stamps"], drawn * 64 * 8);
    EXPECT_EQ(entry["counters"]["bound_pixels"], drawn * 64 * 64 + 8);
    EXPECT_EQ(entry["counters"]["bound_wipe"], hides ? 4096 : 0);
    EXPECT_LT(entry["cycles"], hides ? 1.2 * 64 * 64 : 1.01 * 8 * 64 * 64);
  }
  ASSERT_GE(columns.size(), 4u);
  EXPECT_EQ(columns.front(), "none");
  EXPECT_EQ(columns[1], "tiles");
  EXPECT_EQ(columns[2], "quads");
  EXPECT_EQ(columns[3], "hidden");
  EXPECT_EQ(columns.back(), "all");
  EXPECT_EQ(report["tiles"]["layers_large"]["entered"], 64);
  EXPECT_EQ(report["tiles"]["layers_large"]["hidden"], 7 * 64);
  EXPECT_EQ(report["tiles"]["layers_large"]["block"], 0);
  const std::string png = read(file("pictures/layers_large.png")), exr = read(file("pictures/layers_large.exr"));
  EXPECT_GT(png.size(), 50u);
  EXPECT_NE(exr.find("skip.entered"), std::string::npos);
  EXPECT_EQ(skips("--threads 2")["skips"], report["skips"]);
  const std::string text = run("bench --skips --scene layers_large --size 64x64 --repeat 1").out;
  for (const char* row :
       {" quads ", " pixels ", " pixels/clock ", " hidden tiles ", " masked tiles ", " hidden blocks "})
    EXPECT_NE(text.find(row), std::string::npos) << row << text;
}

TEST_F(Cli, BenchMeshesRefuses) {
  refuses(2, "bench --meshes nowhere", {"--meshes nowhere"});
  refuses(2, "bench --meshes . --skips", {"--meshes", "--skips"});
  refuses(2, "bench --meshes . --repeat 3", {"--meshes", "--repeat"});
  write("readme.txt", "no mesh\n");
  refuses(2, "bench --meshes .", {"--meshes .", "no *.obj"});
  write("bad.obj", "v 0 0 0\nf 1 2 3 4\n");
  refuses(2, "bench --meshes .", {"bad.obj:2"});
}

/// Two squares before the camera and one of them alone: the pixels are those of `fragments`, and no clock draws more of
/// them than the rate.
TEST_F(Cli, BenchMeshesReports) {
  const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
  write("one.obj", square);
  write("two.obj", square + "v 2 0 1\nv 2 1 1\nf 2 5 6 3\n");
  const Outcome outcome = run("bench --meshes . --size 64x48 --json -");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const json meshes = json::parse(outcome.out)["meshes"];
  ASSERT_EQ(meshes.size(), 6u);
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const json& mesh = meshes[i];
    const std::string name = i < 3 ? "one" : "two";
    const int rate = 1 << i % 3;
    EXPECT_EQ(mesh["mesh"], name);
    EXPECT_EQ(mesh["pixels_per_clock"], rate);
    EXPECT_EQ(mesh["quads"], i < 3 ? 1 : 2);
    const Outcome drawn = run("fragments --mesh " + name + ".obj --size 64x48 --out -");
    EXPECT_EQ(mesh["pixels"].get<long>(), std::count(drawn.out.begin(), drawn.out.end(), '\n') - 1) << drawn.err;
    EXPECT_GT(mesh["pixels"].get<double>(), 100);
    EXPECT_GE(mesh["cycles"].get<double>() * rate, mesh["pixels"].get<double>());
    if (rate > 1) {
      EXPECT_LT(mesh["cycles"].get<double>(), meshes[i - 1]["cycles"].get<double>());
    }
    EXPECT_EQ(mesh["bound"], "pixels");
  }
}

TEST_F(Cli, BenchPeersRefuses) {
  refuses(2, "bench --peers --error", {"--peers", "--error"});
  refuses(2, "bench --peers --skips", {"--peers", "--skips"});
  for (const std::string option : {"--quad-size 8", "--fragments 2000", "--lanes baseline", "--no-rtl"})
    refuses(2, "bench --peers " + option, {"--peers", option.substr(0, option.find(' '))});
  refuses(2, "bench --peers --scene sphere", {"--scene", "--error"});
  const Outcome without = run("bench --peers --json peers.json", "__EGL_VENDOR_LIBRARY_DIRS=/nonexistent");
  EXPECT_EQ(without.status, 3);
  EXPECT_NE(without.err.find("the engine shader"), std::string::npos) << without.err;
  EXPECT_FALSE(fs::exists(file("peers.json")));
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

TEST_F(Cli, BenchPeersReports) {
  if (!QUADRILLE_OPENGL_FOUND) GTEST_SKIP() << "no OpenGL in this build; BenchPeersRefuses has what it says then";
  const Outcome outcome = run("bench --peers --size 96x64 --repeat 3 --json -");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json report = json::parse(outcome.out);
  ASSERT_EQ(report["pictures"].size(), 3u);
  EXPECT_EQ(report["pictures"][0]["quads"], 1);
  EXPECT_EQ(report["pictures"][1]["quads"], 100 * 100);
  EXPECT_EQ(report["pictures"][2]["quads"], 300 * 300);
  for (const json& picture : report["pictures"]) {
    const double pixels = picture["pixels"];
    EXPECT_GT(pixels, 2000);
    ASSERT_EQ(picture["shaders"].size(), 8u);
    double fastest = INFINITY;
    for (const json& shader : picture["shaders"]) {
      ASSERT_EQ(shader["cpu_seconds"].size(), 3u);
      EXPECT_LT(shader["other_pixels"], 0.01 * pixels) << shader;
      if (shader["form"] == "determinant") {
        EXPECT_LT(shader["difference"], 1e-3) << shader;
      }
      if (shader["form"] != "bilinear") fastest = std::min(fastest, median(shader["cpu_seconds"]));
    }
    std::map<std::string, json> targets;
    for (const json& target : picture["targets"]) targets[target["lanes"]] = target;
    EXPECT_TRUE(targets.contains("v3") && targets["v3"].contains("goal"));
    EXPECT_TRUE(targets.contains("v4") && targets["v4"].contains("goal"));
    int measured = 0;
    for (const auto& [name, target] : targets) {
      EXPECT_EQ(target.contains("speed"), target["measured"]) << name;
      if (!target["measured"]) continue;
      ++measured;
      EXPECT_DOUBLE_EQ(target["speed"], fastest / median(target["cpu_seconds"])) << name;
      EXPECT_GT(target["snapping_over_drawing"], 0.5) << name;
      EXPECT_LE(target["speed_of_a_round"][0], target["speed_of_a_round"][1]) << name;
    }
    EXPECT_GE(measured, 1);
  }

  std::map<std::string, json> errors;
  for (const json& entry : report["errors"]) {
    errors[entry["input"]] = entry;
    EXPECT_GT(entry["pixels"], 0) << entry;
    EXPECT_EQ(entry["forms"].size(), 3u) << entry;
  }
  EXPECT_GT(errors.size(), 50u);
  for (const char* form : {"no small A", "determinant"}) {
    const json& concave = errors["fig10_concave"]["forms"][form];
    EXPECT_GT(concave["weight"], 0x1p-25) << form;
    EXPECT_LT(concave["weight"], 0x1p-18) << form;
    EXPECT_EQ(concave["undefined"], 0) << form;
  }
  EXPECT_GT(errors["on_edge"]["forms"]["printed"]["undefined"], 0);
  EXPECT_EQ(errors["on_edge"]["forms"]["determinant"]["undefined"], 0);
  EXPECT_GT(errors["reflex"]["condition"], 100 * errors["shared_edge"]["condition"].get<double>());
}

TEST_F(Cli, BenchCliffsRefuses) {
  refuses(2, "bench --cliffs --error", {"--cliffs", "--error"});
  refuses(2, "bench --cliffs --skips", {"--cliffs", "--skips"});
  refuses(2, "bench --cliffs --peers", {"--cliffs", "--peers"});
  refuses(2, "bench --cliffs --size 64x64", {"--size", "--cliffs"});
  refuses(2, "bench --cliffs --scene sphere", {"--scene", "--error"});
  refuses(2, "bench --cliffs --json nowhere/c.json", {"nowhere"});
}

/// Every load and engine is there, each engine has a best, and all draw the same numbers of fragments. Not the times.
TEST_F(CliBenchWhole, CliffsOfEveryLoadAndEngine) {
  // Without the shader, whose start takes longer than all else.
  const Outcome outcome =
      run("bench --cliffs --fragments 1000 --repeat 1 --json -", "__EGL_VENDOR_LIBRARY_DIRS=/nonexistent");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json report = json::parse(outcome.out);
  std::map<std::string, int> rows, best;
  std::set<int> sides;
  for (const json& row : report["cliffs"]) {
    const std::string series = row["series"];
    ++rows[series];
    if (series == "viewport") sides.insert(row["side"].get<int>());
    EXPECT_EQ(row["engines"].size(), report["engines"].size()) << row;
    const double fragments = row["fragments"];
    EXPECT_GT(fragments, 0) << row;
    for (const auto& [engine, cost] : row["engines"].items()) {
      if (cost.is_null()) continue;
      EXPECT_GT(cost["cpu_seconds"], 0) << row;
      const double drawn = cost["fragments"], ratio = cost["of_best"];
      if (engine == "model" || engine == "clocked" || engine == "judge") {
        EXPECT_EQ(drawn, fragments) << engine << row;
      }
      if (engine == "truth") {
        EXPECT_NEAR(drawn / fragments, 1, 0.05) << engine << row;
      }
      EXPECT_GT(cost["of_expected"], 0) << row;
      if (drawn >= 500) {
        EXPECT_GE(ratio, 1) << engine << row;
        best[engine] += ratio == 1;
      }
    }
  }
  EXPECT_EQ(rows["family"], 22);
  EXPECT_GT(rows["scene"], 60);
  EXPECT_EQ(rows["view"], 2);
  EXPECT_EQ(rows["viewport"], 4 * 6);
  EXPECT_EQ(sides, (std::set<int>{64, 256, 1024, 4096}));
  for (const char* engine : {"model", "clocked", "judge", "truth", "float", "fp32", "mvc", "split02", "refine:20"})
    EXPECT_EQ(best[engine], 1) << engine;

  // By family, widths and each instruction set of the processor; one case is the quickest.
  std::map<std::string, int> widths;
  std::map<std::string, int> quickest;
  for (const json& row : report["widths"]) {
    ++widths[row["family"]];
    EXPECT_GE(row["pixels"], row["fragments"]) << row;
    EXPECT_GT(row["fragments"], 64 * row["quads"].get<int>() - 1) << row;
    EXPECT_TRUE(row["targets"].contains("baseline")) << row;
    for (const auto& [target, cost] : row["targets"].items()) {
      EXPECT_GT(cost["ns"], 0) << row;
      EXPECT_GE(cost["of_quickest"], 1) << row;
      quickest[target] += cost["of_quickest"] == 1;
    }
  }
  EXPECT_EQ(widths.size(), 14u);
  for (const auto& [family, count] : widths) EXPECT_EQ(count, 6) << family;
  for (const auto& [target, count] : quickest) EXPECT_EQ(count, 1) << target;
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
  for (const json& entry : entries) {
    if (entry["engine"] == "model-clocked")
      EXPECT_EQ(entry.at("counters").at("quads"), 30);
    else
      EXPECT_FALSE(entry.contains("counters")) << entry;
  }
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
  EXPECT_EQ(report.at("error").size(), 6u);  // engines
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
