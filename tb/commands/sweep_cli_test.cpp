// quadrille sweep as a user runs it: files, determinism, going on after an interruption, targets, bad input.
#include "tb/commands/sweep_fixture.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

namespace {

using namespace quadrille::cli_test;

TEST_F(SweepCli, FullGridInOrder) {
  const Outcome outcome = run("sweep" + std::string(small) +
                              "--axis significand_bits=10:18:4 --axis align_guard_bits=0,2 --out a --json -");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const Table rows = table(file("a") / "points.csv");
  ASSERT_EQ(rows.size(), 6u);
  const int s[] = {10, 10, 14, 14, 18, 18}, g[] = {0, 2, 0, 2, 0, 2};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(rows[i].at("row"), std::to_string(i));
    EXPECT_EQ(rows[i].at("significand_bits"), std::to_string(s[i]));
    EXPECT_EQ(rows[i].at("align_guard_bits"), std::to_string(g[i]));
    EXPECT_EQ(rows[i].at("status"), "ok");
    EXPECT_GT(std::stoi(rows[i].at("fragments")), 100);
    EXPECT_GT(std::stoi(rows[i].at("cycles")), std::stoi(rows[i].at("fragments")));
    const double error = std::stod(rows[i].at("arithmetic_lambda_max"));
    EXPECT_LE(error, std::ldexp(1.0, 3 - s[i]));
    EXPECT_LE(error, std::stod(rows[i].at("bound_lambda")));
    EXPECT_EQ(rows[i].at("ranges"), "proved");
  }
  EXPECT_LT(std::stod(rows[0].at("cost")), std::stod(rows[5].at("cost")));
  const json m = json::parse(outcome.out);
  EXPECT_EQ(m, manifest("a"));
  EXPECT_EQ(m.at("points"), 6);
  EXPECT_EQ(m.at("kind"), "full");
  const auto stages = settings("a");
  EXPECT_EQ(stages.at("given_truth"), 1);
  EXPECT_EQ(stages.at("snap_truth"), 1);
  EXPECT_EQ(stages.at("draw"), 6);
  EXPECT_EQ(m.at("error_map_row"), 5);
  // The base is the last point: its counters are of the draw that its row is of.
  EXPECT_EQ(m.at("performance_counters").at("fragments").get<int>(), std::stoi(rows[5].at("fragments")));
  EXPECT_EQ(m.at("performance_counters").at("clocks").get<int>(), std::stoi(rows[5].at("cycles")));
  ASSERT_EQ(run("sweep" + std::string(small) + "--axis significand_bits=10 --no-cycles --out n").status, 0);
  EXPECT_FALSE(manifest("n").contains("performance_counters"));
  // 128 bytes of header, 48 x 48 floats.
  EXPECT_EQ(fs::file_size(file("a") / "error_map.npy"), 128u + 48 * 48 * 4);
}

TEST_F(SweepCli, TheSameBytesWithAnyNumberOfThreads) {
  const std::string sweep = "sweep" + std::string(small) + "--axis significand_bits=10,18 --axis subpixel_bits=4,8 ";
  ASSERT_EQ(run(sweep + "--threads 1 --out one").status, 0);
  ASSERT_EQ(run(sweep + "--threads 3 --out three").status, 0);
  EXPECT_EQ(read(file("one") / "points.csv"), read(file("three") / "points.csv"));
  EXPECT_EQ(read(file("one") / "error_map.npy"), read(file("three") / "error_map.npy"));
}

TEST_F(SweepCli, GoesOnAfterBeingKilled) {
  const std::string sweep =
      "sweep --scene sphere --size 128x128 --cosim none --no-cycles --threads 1 --axis significand_bits=8:26 --axis "
      "align_guard_bits=0:4 --axis subpixel_bits=7,8";
  ASSERT_EQ(run(sweep + " --out whole").status, 0);
  // Killed as soon as the journal holds a batch; whether it was in the middle of one does not matter.
  const std::string line =
      "cd '" + file(".").string() + "' && '" QUADRILLE_PROGRAM "' " + sweep +
      " --out cut >/dev/null 2>&1 & pid=$!; for i in $(seq 2000); do [ \"$(cat '" +
      (file("cut") / "journal.jsonl").string() +
      "' 2>/dev/null | wc -l)\" -ge 2 ] && break; sleep 0.005; done; kill -9 $pid; wait $pid 2>/dev/null";
  ASSERT_NE(std::system(line.c_str()), -1);
  ASSERT_TRUE(fs::exists(file("cut") / "journal.jsonl")) << "it ended before it could be killed";
  const Outcome outcome = run(sweep + " --out cut");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("resumed: "), std::string::npos) << outcome.out;
  EXPECT_EQ(read(file("cut") / "points.csv"), read(file("whole") / "points.csv"));
  // Once more, with the table damaged: written again, nothing evaluated.
  const std::string stages = read(file("cut") / "stages.csv");
  write("cut/points.csv", "half a table");
  EXPECT_EQ(run(sweep + " --out cut").status, 0);
  EXPECT_EQ(read(file("cut") / "points.csv"), read(file("whole") / "points.csv"));
  EXPECT_EQ(read(file("cut") / "stages.csv"), stages);
}

TEST_F(SweepCli, ShardsPutTogetherAreOneRun) {
  const std::string sweep =
      "sweep" + std::string(small) + "--axis significand_bits=10:14 --axis guard_bits=1,3 --axis viewport_bits=6,14 ";
  ASSERT_EQ(run(sweep + "--out whole").status, 0);
  for (const std::string shard : {"0", "1", "2"}) {
    const Outcome part = run(sweep + "--threads 1 --shard " + shard + "/3 --out part" + shard);
    ASSERT_EQ(part.status, 0) << part.err;
    EXPECT_NE(part.out.find("--merge"), std::string::npos) << part.out;
    EXPECT_FALSE(fs::exists(file("part" + shard) / "points.csv"));
  }
  // The same command again: what is there is not done again.
  EXPECT_NE(run(sweep + "--shard 1/3 --out part1").out.find("resumed: "), std::string::npos);
  const Outcome merged = run(sweep + "--merge part2 part0 part1 part0 --out merged");
  ASSERT_EQ(merged.status, 0) << merged.err;
  for (const char* name : {"points.csv", "manifest.json", "error_map.npy", "cosim.csv", "synth.csv"})
    EXPECT_EQ(read(file("merged") / name), read(file("whole") / name)) << name;
  EXPECT_EQ(settings("merged").at("draw"), settings("whole").at("draw"));

  refuses(2, sweep + "--merge part0 part2 --out lacking", {"--merge: row ", "no shard", "lacking"});
  refuses(2, sweep + "--merge part0 nowhere --out nothing", {"nowhere", "journal.jsonl"});
  EXPECT_FALSE(fs::exists(file("nowhere")));
  refuses(2, sweep + "--seed 2 --merge part0 part1 part2 --out other", {"part0", "another sweep", "seed"});
  refuses(2, sweep + "--shard 0/3 --merge part0 --out x", {"--shard", "--merge"});
  refuses(2, sweep + "--shard 3/3 --out x", {"0 <= I < N"});
  refuses(2, sweep + "--shard 0/21 --out x", {"points (20)"});
  refuses(2, "sweep --target-error lambda=2^-8 --shard 0/2 --out x", {"--shard", "search"});
}

TEST_F(SweepCli, RefusedPointsAreRows) {
  ASSERT_EQ(run("sweep" + std::string(small) + "--axis guard_bits=1,3 --axis viewport_bits=6,12,14 --out r").status, 0);
  const Table rows = table(file("r") / "points.csv");
  ASSERT_EQ(rows.size(), 6u);
  EXPECT_EQ(rows[5].at("status"), "refused");  // guard 3, viewport 14: beyond 64 bits
  EXPECT_NE(rows[5].at("reason").find("VAL_BITS"), std::string::npos) << rows[5].at("reason");
  EXPECT_EQ(rows[4].at("status"), "ok");
  EXPECT_EQ(manifest("r").at("refused"),
            std::count_if(rows.begin(), rows.end(), [](const auto& row) { return row.at("status") == "refused"; }));
}

TEST_F(SweepCli, OneAtATimeAndTheWorstFragmentCanBePasted) {
  ASSERT_EQ(
      run("sweep" + std::string(small) + "--one-at-a-time --axis significand_bits=12,18 --axis notch_exact=0,1 --out o")
          .status,
      0);
  const Table rows = table(file("o") / "points.csv");
  ASSERT_EQ(rows.size(), 3u);  // the base, s = 12, the flag of notches off
  EXPECT_EQ(rows[1].at("significand_bits"), "12");
  EXPECT_EQ(rows[2].at("notch_exact"), "0");
  const std::string command = rows[1].at("worst");
  ASSERT_EQ(command.rfind("quadrille fragments ", 0), 0u) << command;
  const Outcome model = run(command.substr(10));
  ASSERT_EQ(model.status, 0) << model.err;
  std::string truth_command = command.substr(10);
  truth_command.replace(truth_command.find("--engine model"), 14, "--engine truth");
  const Outcome truth = run(truth_command);
  ASSERT_EQ(truth.status, 0) << truth.err;
  const auto weights = [](const std::string& csv) {
    std::istringstream lines(csv);
    std::string line, cell;
    std::getline(lines, line);
    EXPECT_TRUE(std::getline(lines, line)) << "no fragment there";
    std::istringstream cells(line);
    std::vector<double> values;
    for (int i = 0; i < 9 && std::getline(cells, cell, ','); ++i)
      if (i >= 5) values.push_back(std::stod(cell));
    return values;
  };
  const std::vector<double> a = weights(model.out), b = weights(truth.out);
  ASSERT_EQ(a.size(), 4u);
  double error = 0;
  for (std::size_t i = 0; i < 4; ++i) error = std::max(error, std::fabs(a[i] - b[i]));
  EXPECT_NEAR(error, std::stod(rows[1].at("worst_error")), 1e-12);
  EXPECT_EQ(rows[1].at("worst_error"), rows[1].at("arithmetic_lambda_max"));
}

/// A point of an axis is the machine that --set makes, in every column: of each key the last value of the default axes.
TEST_F(SweepCli, AKeyOnAnAxisIsTheKeyBySet) {
  const std::string sweep = "sweep --stress any_w --count 4 --size 48x48 --cosim none ";
  ASSERT_EQ(run(sweep + "--out axes").status, 0);
  const Table rows = table(file("axes") / "points.csv");
  ASSERT_GT(rows.size(), 80u);
  std::map<std::string, std::map<std::string, std::string>> last;
  const json axes = manifest("axes").at("axes");
  const std::set<std::string> automatic{"quadratic_frac_bits", "sqrt_segments_log2", "recip_segments_log2",
                                        "attribute_frac_bits"};  // follow other keys
  for (const auto& row : rows) {
    std::vector<std::string> moved, followed;
    for (const json& axis : axes) {
      const std::string key = axis.at("key");
      if (row.at(key) != rows[0].at(key)) (automatic.contains(key) ? followed : moved).push_back(key);
    }
    if (moved.empty()) moved = followed;
    if (!moved.empty()) last[moved.front()] = row;
  }
  EXPECT_GE(last.size(), 25u);
  last.erase("plane_quads");  // its axis asks for plane quads, --set alone does not
  for (const auto& [key, row] : last) {
    ASSERT_EQ(row.at("status"), "ok") << key;
    const std::string other = key == "significand_bits" ? "depth_bits" : "significand_bits";
    const Outcome alone =
        run(sweep + "--set " + key + "=" + row.at(key) + " --axis " + other + "=" + row.at(other) + " --out by_" + key);
    ASSERT_EQ(alone.status, 0) << key << alone.err;
    auto wanted = table(file("by_" + key) / "points.csv").at(0);
    for (const char* of_the_table : {"row", "pareto"}) wanted[of_the_table] = row.at(of_the_table);
    EXPECT_EQ(row, wanted) << key;
  }
}

TEST_F(SweepCli, AFinishedSweepCanBeAskedForMore) {
  const std::string sweep = "sweep" + std::string(small) + "--axis significand_bits=10:18:4 --out m ";
  ASSERT_EQ(run(sweep).status, 0);
  const std::string stages = read(file("m") / "stages.csv");
  write("w.toml", "[cost]\nmultiplier = 1000\n");
  ASSERT_EQ(run(sweep + "--objective colour --config w.toml --json j.json").status, 0);
  const json after = manifest("m");
  EXPECT_EQ(after.at("objective"), "arithmetic_colour_max");
  EXPECT_EQ(after.at("cost_weights").at("multiplier"), 1000);
  EXPECT_EQ(read(file("m") / "stages.csv"), stages);
  EXPECT_EQ(json::parse(read(file("j.json"))), after);
  // A failure fails again.
  const std::string missed =
      "sweep --target-error lambda=2^-40 --no-confirm" + std::string(small) + "--axis significand_bits=10,12 --out f";
  EXPECT_EQ(run(missed).status, 1);
  EXPECT_EQ(run(missed).status, 1);
}

TEST_F(SweepCli, TheObjectiveIsTheArithmeticErrorUnlessAsked) {
  const std::string sweep =
      "sweep --scene phong_mesh --size 96x96 --cosim none --no-cycles --axis subpixel_bits=2,4,8 "
      "--axis significand_bits=10:22:4 --out k ";
  const auto coarse_knees = [&](const std::string& options, const std::string& objective) {
    EXPECT_EQ(run(sweep + options).status, 0);
    const json m = manifest("k");
    EXPECT_EQ(m.at("objective"), objective);
    EXPECT_GE(m.at("knees").size(), 1u);
    EXPECT_TRUE(m.at("no_knee").is_null());
    const Table rows = table(file("k") / "points.csv");
    std::size_t coarse = 0;
    for (const std::size_t row : m.at("knees")) coarse += rows.at(row).at("subpixel_bits") == "2" ? 1 : 0;
    for (const auto& row : rows)
      EXPECT_EQ(std::stod(row.at("total_lambda_max")),
                std::stod(row.at("snapping_lambda_max")) + std::stod(row.at("arithmetic_lambda_max")));
    return coarse;
  };
  EXPECT_EQ(coarse_knees("--objective total", "total_lambda_max"), 0u);
  EXPECT_GE(coarse_knees("", "arithmetic_lambda_max"), 1u) << "a quarter of a pixel costs least";
  // The front says the total beside the arithmetic error, which does not see the coarse grid.
  const Outcome printed = run(sweep);
  EXPECT_NE(printed.out.find(" total "), std::string::npos) << printed.out;
  // A target without a kind is one of arithmetic error, which the grid meets; the total it does not.
  const std::string target =
      "sweep --scene phong_mesh --size 96x96 --cosim none --no-cycles --no-confirm --axis "
      "significand_bits=10:22:4 --target-error ";
  EXPECT_EQ(run(target + "lambda=2^-14 --out a").status, 0);
  EXPECT_EQ(manifest("a").at("objective"), "arithmetic_lambda_max");
  EXPECT_EQ(run(target + "total_lambda_max=2^-14 --out t").status, 1);
}

/// Snapping is the same with every width of the arithmetic, so the total hardly falls: a knee there would be of noise.
TEST_F(SweepCli, AFlatFrontHasNoKnee) {
  const std::string sweep =
      "sweep --scene sphere --size 64x64 --cosim none --no-cycles --axis significand_bits=16:26:2 --out f ";
  const Outcome flat = run(sweep + "--objective total");
  ASSERT_EQ(flat.status, 0) << flat.err;
  const json m = manifest("f");
  ASSERT_GE(m.at("front").size(), 3u);
  EXPECT_EQ(m.at("knees").size(), 0u);
  EXPECT_NE(m.at("no_knee").get<std::string>().find("flat"), std::string::npos);
  EXPECT_NE(flat.out.find("No knee: " + m.at("no_knee").get<std::string>()), std::string::npos) << flat.out;
  EXPECT_EQ(flat.out.find("\n* "), std::string::npos) << flat.out;
  // The arithmetic error halves with every bit.
  EXPECT_EQ(run(sweep).out.find("flat"), std::string::npos);
  EXPECT_EQ(manifest("f").at("objective"), "arithmetic_lambda_max");
}

TEST_F(SweepCli, WhatAPointTakes) {
  const Outcome outcome = run("sweep" + std::string(small) + "--axis pixels_per_clock=1,4 --out p");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json weights = manifest("p").at("cost_weights");
  const Table rows = table(file("p") / "points.csv");
  ASSERT_EQ(rows.size(), 2u);
  for (const auto& row : rows) {
    const auto value = [&](const char* name) { return std::stod(row.at(name)); };
    EXPECT_NEAR(value("cost"),
                value("luts") + weights.at("dsp").get<double>() * value("dsps") +
                    weights.at("block_ram").get<double>() * value("block_rams"),
                1e-6);
    EXPECT_EQ(value("flip_flops"), value("state_bits") - value("memory_bits"));
    EXPECT_EQ(value("fragments_per_clock"), value("fragments") / value("cycles"));
    EXPECT_GT(value("fragments_per_clock"), 0.05);
  }
  // What is printed of the cheaper one, which is on the front.
  char wanted[200];
  std::snprintf(wanted, sizeof wanted, " %8.0f %7s %5s %5s %8.3f  pixels_per_clock=1", std::stod(rows[0].at("luts")),
                rows[0].at("flip_flops").c_str(), rows[0].at("dsps").c_str(), rows[0].at("block_rams").c_str(),
                std::stod(rows[0].at("fragments_per_clock")));
  EXPECT_NE(outcome.out.find(wanted), std::string::npos) << wanted << "\n" << outcome.out;
  for (const char* name : {" LUT ", " FF ", " DSP ", " BRAM ", "px/clock", "cost = LUTs + 536 per DSP block"})
    EXPECT_NE(outcome.out.find(name), std::string::npos) << name;
  // Multipliers in logic: no block, and the sentence on cost has none.
  const Outcome logic =
      run("sweep" + std::string(small) + "--axis pixels_per_clock=1 --no-cycles --synth-target ecp5-nodsp --out n");
  EXPECT_NE(logic.out.find("cost = LUTs + 402 per block RAM"), std::string::npos) << logic.out;
  const auto row = table(file("n") / "points.csv").at(0);
  EXPECT_EQ(row.at("dsps"), "0");
  EXPECT_EQ(row.at("fragments_per_clock"), "");
  EXPECT_GT(std::stod(row.at("luts")), std::stod(rows[0].at("luts")) * 1.5);
}

/// Each row's bounds lie above its own errors. Where W may be of any sign there is no bound of depth.
TEST_F(SweepCli, SampledErrorsAreBelowProvedBounds) {
  std::size_t proved = 0;
  for (const std::string family : {"general", "any_w"}) {
    ASSERT_EQ(run("sweep --size 96x96 --count 8 --cosim none --no-cycles --axis significand_bits=8:26:6 --axis "
                  "align_guard_bits=0,2 --axis notch_exact=0,1 --stress " +
                  family + " --out " + family)
                  .status,
              0);
    for (const auto& row : table(file(family) / "points.csv"))
      for (const std::string output : {"lambda", "attribute", "depth"}) {
        const std::string& kind = row.at("bound_" + output + "_kind");
        EXPECT_EQ(kind == "none", row.at("bound_" + output).empty());
        if (kind != "proved") continue;
        ++proved;
        EXPECT_LE(std::stod(row.at("arithmetic_" + output + "_max")), std::stod(row.at("bound_" + output)))
            << family << " " << output << " row " << row.at("row");
      }
  }
  EXPECT_EQ(proved, 16u * (3 + 2));
}

TEST_F(SweepCli, AnAxisOfPlaneQuads) {
  // The scene and the skip come with the axis.
  const std::string command = "sweep --size 64x64 --cosim none --no-cycles --axis plane_quads=0,1 ";
  const Outcome outcome = run(command + "--objective attribute --out a");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(manifest("a").at("input"), "sprites_turned");
  const Table rows = table(file("a") / "points.csv");
  ASSERT_EQ(rows.size(), 2u);
  const auto value = [](const auto& row, const char* name) { return std::stod(row.at(name)); };
  EXPECT_EQ(value(rows[0], "quads_plane"), 0);
  EXPECT_GT(value(rows[1], "plane_share"), 0.1);
  EXPECT_EQ(value(rows[1], "plane_share"), value(rows[1], "quads_plane") / value(rows[1], "quads"));
  EXPECT_NE(outcome.out.find("100.0%"), std::string::npos) << outcome.out;
  for (const auto& row : rows) EXPECT_LE(value(row, "arithmetic_attribute_max"), value(row, "bound_attribute"));

  const Outcome refused = run(command + "--skip none --out b");
  ASSERT_EQ(refused.status, 0) << refused.err;
  const Table without = table(file("b") / "points.csv");
  ASSERT_EQ(without.size(), 2u);
  for (const auto& row : without) EXPECT_EQ(row.at("quads_plane"), "0");
  EXPECT_NE(refused.out.find("--skip"), std::string::npos) << refused.out;
}

TEST_F(SweepCli, NothingMeasuredIsSaid) {
  const Outcome outcome =
      run("sweep --stress eye_crossing --count 5 --no-perspective --no-depth --size 64x64 --cosim none --axis "
          "significand_bits=12 --out nm");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("not measured"), std::string::npos) << outcome.err;
}

TEST_F(SweepCli, BadInput) {
  const std::string sweep = "sweep" + std::string(small);
  refuses(2, sweep + "--axis significand_bits=10:12", {"--out DIR"});
  refuses(2, sweep + "--out d --axis significant_bits=10", {"significant_bits", "significand_bits"});
  refuses(2, sweep + "--out d --axis significand_bits=12:10", {"significand_bits", "empty"});
  refuses(2, sweep + "--out d --axis significand_bits=1x", {"1x"});
  refuses(2, sweep + "--out d --axis significand_bits=10.5", {"10.5"});
  refuses(2, sweep + "--out d --axis significand_bits=", {"significand_bits"});
  refuses(2, sweep + "--out d --axis significand_bits=6:12", {"significand_bits", "8..26"});
  refuses(2, sweep + "--out d --axis significand_bits=10 --axis significand_bits=12", {"significand_bits", "twice"});
  refuses(2,
          sweep +
              "--out d --axis tile_log2=2:4 --axis significand_bits=8:26 --axis subpixel_bits=2:8 --axis "
              "depth_bits=8:30 --axis attribute_slots=1:8 --axis align_guard_bits=0:6 --axis quad_slots_log2=1:4",
          {"more than a million", "--force"});
  refuses(2, sweep + "--out d --axis significand_bits=10 --target-error lamda=1", {"lamda", "\"lambda\""});
  refuses(2, sweep + "--out d --axis significand_bits=10 --target-error lambda=two", {"two", "2^-12"});
  refuses(2, sweep + "--out d --axis significand_bits=10 --target-error lambda=0", {"above 0"});
  refuses(2, sweep + "--out d --no-depth --axis significand_bits=10 --target-error depth=1e-6", {"--no-depth"});
  refuses(2, sweep + "--out d --axis significand_bits=10 --synth some", {"\"some\"", "pareto"});
  refuses(2, sweep + "--out d --axis significand_bits=10 --synth 5", {"row 5"});
  refuses(2, sweep + "--out d --axis significand_bits=10 --synth-target ice40", {"\"ice40\"", "ecp5-nodsp"});
  refuses(2, sweep + "--out d --axis significand_bits=10 --objective error", {"unknown error"});
  write("plain", "a file");
  refuses(2, sweep + "--out plain --axis significand_bits=10", {"plain"});
  refuses(2, sweep + "--out /proc/nothing --axis significand_bits=10", {"/proc/nothing"});
  EXPECT_FALSE(fs::exists(file("d") / "points.csv"));
}

TEST_F(SweepCli, DamagedAndForeignDirectories) {
  const std::string sweep = "sweep" + std::string(small) + "--out d --axis significand_bits=";
  ASSERT_EQ(run(sweep + "10,12").status, 0);
  const std::string points = read(file("d") / "points.csv");
  refuses(2, sweep + "10,14", {"holds another sweep", "axes", "--fresh"});
  EXPECT_EQ(read(file("d") / "points.csv"), points);
  write("d/journal.jsonl", "{\"crc\":\"00000000\",\"content\":{}}\n{");
  refuses(2, sweep + "10,12", {"journal.jsonl:1", "damaged", "--fresh"});
  EXPECT_EQ(run(sweep + "10,14 --fresh").status, 0);
  EXPECT_EQ(table(file("d") / "points.csv").size(), 2u);
}

TEST_F(SweepCli, NothingDrawnIsAFailure) {
  write("far.quads", "5000 10 0.5 1  5040 12 0.5 1  5042 44 0.5 1  5008 40 0.5 1\n");
  const Outcome outcome = run("sweep --quads far.quads --size 48x48 --cosim none --axis significand_bits=10 --out n");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("no fragments drawn"), std::string::npos) << outcome.err;
}

}  // namespace
