// `quadrille cosim` as its users run it: report, waveforms, cache, and what fails a run.
#include "tb/commands/cli_fixture.hpp"

#include <nlohmann/json.hpp>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace {

using namespace quadrille::cli_test;
using nlohmann::json;

// These build the default configuration's simulators, or find them in the cache.
using CliCosim = Cli;

TEST_F(CliCosim, ReportHasEveryField) {
  const Outcome outcome = run("cosim --scene bowtie --size 64x64 --json a.json --png a.png --out a.exr");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("\nOK\n"), std::string::npos);
  const json report = json::parse(read(file("a.json")));
  for (const char* name : {"schema_version", "version", "config", "seed", "command", "quads", "fragments", "mismatches",
                           "cycles_rtl", "cycles_model", "cycle_mismatches", "covered_pixels_per_clock", "wall_seconds",
                           "rtl_cycles_per_second", "rtl_alone_cycles_per_second", "error", "bound", "worst", "counts"})
    EXPECT_TRUE(report.contains(name)) << name;
  for (const char* part : {"snapping", "arithmetic"})
    for (const char* name : {"lambda_max", "lambda_p999", "lambda_rms", "attribute_max", "depth_max"})
      EXPECT_TRUE(report["error"][part].contains(name)) << part << name;
  for (const char* name : {"eye_crossing_quads", "on_edge", "on_vertex", "two_edge", "tie"})
    EXPECT_TRUE(report["counts"].contains(name)) << name;
  EXPECT_EQ(report["mismatches"], 0);
  EXPECT_EQ(report["cycle_mismatches"], 0);
  EXPECT_EQ(report["cycles_rtl"], report["cycles_model"]);
  EXPECT_GT(report["fragments"], 100);
  EXPECT_GT(report["passes"], 1);
  EXPECT_EQ(report["fragments_all_passes"], report["passes"].get<int>() * report["fragments"].get<int>());
  EXPECT_TRUE(report["model_alone"]["ok"]);
  EXPECT_GT(report["model_alone"]["function_arguments"], 100'000);
  EXPECT_EQ(report["model_alone"]["function_beyond"], 0);
  EXPECT_GT(report["model_alone"]["functions"]["sqrt"]["arguments"], 1000);
  EXPECT_GT(report["model_alone"]["directed_compared"], 1000);
  EXPECT_EQ(report["regression"]["inputs_with_limits"], 0);
  EXPECT_LE(report["error"]["arithmetic"]["lambda_max"], report["bound"]["lambda_max"]);
  // The printed command line gives the worst fragment back.
  const std::string reproduce = report["worst"]["reproduce"];
  const Outcome again = run(reproduce.substr(std::string("quadrille ").size()));
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(std::count(again.out.begin(), again.out.end(), '\n'), 2) << again.out;
}

TEST_F(CliCosim, StressDrawsOfTheRecordedSizeAreHeldToRegressionLimits) {
  const std::string draw = "cosim --stress bowtie --size 64x64 --no-alone --seed 77 --count ";
  const Outcome held = run(draw + "300 --json a.json");
  EXPECT_EQ(held.status, 0) << held.err;
  EXPECT_NE(held.out.find("regression limits  held"), std::string::npos) << held.out;
  const json regression = json::parse(read(file("a.json")))["regression"];
  EXPECT_EQ(regression["inputs_with_limits"], 1);
  EXPECT_TRUE(regression["beyond"].empty());
  EXPECT_EQ(run(draw + "299").out.find("regression limits"), std::string::npos) << "of another draw nothing is known";
}

TEST_F(CliCosim, FragmentsDoNotDependOnStallsOrThreads) {
  std::string hash;
  json error;
  for (const char* options : {"--threads 1", "--threads 4", "--stall 0.5 --gap 0.5", "--stall 0.9 --threads 2"}) {
    const Outcome outcome =
        run(std::string("cosim --stress any_w --count 4 --size 48x48 --no-alone --json - ") + options);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const json report = json::parse(outcome.out);
    if (hash.empty()) hash = report["fragment_hash"], error = report["error"];
    EXPECT_EQ(report["fragment_hash"], hash) << options;
    EXPECT_EQ(report["error"], error) << options;
  }
}

TEST_F(CliCosim, RtlDrawsWhatTheModelDraws) {
  ASSERT_EQ(run("fragments --scene fig9_a --size 48x48 --engine rtl --stall 0.3 --gap 0.3 --out a.csv --quiet").status,
            0);
  ASSERT_EQ(run("fragments --scene fig9_a --size 48x48 --engine model --out b.csv --quiet").status, 0);
  EXPECT_FALSE(read(file("a.csv")).empty());
  EXPECT_EQ(read(file("a.csv")), read(file("b.csv")));
}

TEST_F(CliCosim, TheCacheIsListedAndCleared) {
  ASSERT_EQ(run("fragments --scene bowtie --size 16x16 --engine rtl --out a.csv --quiet").status, 0);
  const json report = json::parse(run("cache --json -").out);
  std::uintmax_t bytes = 0;
  for (const json& entry : report["entries"]) bytes += entry["bytes"].get<std::uintmax_t>();
  EXPECT_GT(bytes, 100'000u);
  EXPECT_EQ(report["bytes"], bytes);

  fs::create_directories(file("own/kind-1"));
  write("own/kind-1/data", std::string(2048, 'x'));
  const std::string own = "QUADRILLE_CACHE=own";
  EXPECT_EQ(json::parse(run("cache list --json -", own).out)["entries"].size(), 1u);
  const Outcome listed = run("cache", own);  // the entry and the sum, a line each
  EXPECT_EQ(listed.status, 0) << listed.err;
  EXPECT_EQ(std::count(listed.out.begin(), listed.out.end(), '\n'), 2) << listed.out;
  const json cleared = json::parse(run("cache clear --json -", own).out);
  EXPECT_EQ(cleared["removed"].size(), 1u);
  EXPECT_EQ(cleared["bytes"], 2048);
  EXPECT_TRUE(fs::is_empty(file("own")));
  const Outcome wrong = run("cache", own + " QUADRILLE_CACHE_SIZE=plenty");
  EXPECT_EQ(wrong.status, 2);
  EXPECT_NE(wrong.err.find("not 'plenty'"), std::string::npos) << wrong.err;
}

TEST_F(CliCosim, AntipodalEdgesAreCountedAndCoverNothing) {
  // Vertex 1 is minus vertex 0: the eye lies on that edge. The second quad is an ordinary one.
  write("antipodal.quads", std::string("20 20 0.5 1  -20 -20 -0.5 -1  40 44 0.5 1  8 40 0.5 1\n") + good_quad);
  const Outcome outcome = run("cosim --quads antipodal.quads --size 64x64 --no-alone --json -");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json report = json::parse(outcome.out);
  EXPECT_EQ(report["counts"]["antipodal_quads"], 1);
  EXPECT_EQ(report["counts"]["eye_crossing_quads"], 1);
  EXPECT_EQ(report["counts"]["eye_crossing"], 0) << "no fragment comes from it";
  EXPECT_GT(report["fragments"], 100);
}

TEST_F(CliCosim, WaveformWithoutRoom) {
  const std::string arguments = "cosim --scene bowtie --size 64x64 --no-alone --quiet --trace t.fst";
  ASSERT_EQ(run(arguments).status, 0);  // and the simulator with waveforms is in the cache
  const std::uintmax_t whole = fs::file_size(file("t.fst"));
  ASSERT_GT(whole, 8192u);
  fs::remove(file("t.fst"));
  const auto files = [&](const std::string& directory) {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(file(directory)))
      if (const std::string name = entry.path().filename(); name != "stdout" && name != "stderr") names.push_back(name);
    return names;
  };
  // A limit on the size of files, in blocks of 512 bytes: SIGXFSZ, or a waveform that ends too early.
  for (const char* limit : {"1", "8"}) {
    const Outcome limited = run(arguments, std::string("ulimit -f ") + limit + ";");
    EXPECT_EQ(limited.status, 2) << limited.err;
    EXPECT_EQ(limited.err, "quadrille: the waveform cannot be written: File too large\n");
    EXPECT_TRUE(files("").empty()) << files("").front();
  }
  // A full disk, where a user may mount one.
  fs::create_directory(file("disk"));
  const std::string mount =
      "unshare -rm sh -c 'mount -t tmpfs -o size=4k none disk && \"$@\"; s=$?; ls -A disk; exit $s' sh ";
  if (run("--version", mount).status != 0) GTEST_SKIP() << "no user namespace to mount a small disk in";
  const Outcome full = run(arguments.substr(0, arguments.rfind(' ')) + " disk/t.fst", mount);
  EXPECT_EQ(full.status, 2) << full.err;
  EXPECT_EQ(full.err, "quadrille: the waveform cannot be written: No space left on device\n");
  EXPECT_EQ(full.out, "") << "left on the full disk";
}

TEST_F(CliCosim, NothingComparedIsAFailure) {
  write("off.quads", "-20 10 0.5 1  -10 12 0.5 1  -10 44 0.5 1  -20 40 0.5 1\n");
  const Outcome outcome = run("cosim --quads off.quads --size 64x64");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("off.quads: no fragments compared\n"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.out.find("coverage       no fragments compared, 0 differ\n"), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find("throughput"), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find("held"), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find("max  "), std::string::npos) << outcome.out;
  // What does not depend on the input is said to be so.
  EXPECT_NE(outcome.out.find(" function arguments, 0 beyond"), std::string::npos) << outcome.out;
  const Outcome reported = run("cosim --quads off.quads --size 64x64 --json -");
  EXPECT_EQ(json::parse(reported.out)["bound"]["held"], false);
}

// The eye in the plane of a quad: what the truth cannot decide is named without being asked for.
TEST_F(CliCosim, WhatIsNotDecidedIsNamed) {
  const Outcome outcome = run("cosim --stress coplanar --count 20 --size 64x64 --no-alone --json r.json");
  const json counts = json::parse(read(file("r.json")))["counts"];
  ASSERT_GT(counts["tolerated_visible"], 0);
  EXPECT_NE(outcome.out.find(" " + counts["tolerated_visible"].dump() + " with the eye in the hull"), std::string::npos)
      << outcome.out;
  EXPECT_EQ(run("cosim --scene bowtie --size 32x32 --no-alone").out.find("tolerated"), std::string::npos);
}

}  // namespace
