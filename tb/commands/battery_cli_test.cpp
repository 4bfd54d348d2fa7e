// cosim with several draws, patterns of waits, comparison of skips and the battery on the command line; a damaged
// simulator.
#include "tb/commands/cli_fixture.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>

namespace {

using namespace quadrille::cli_test;
using json = nlohmann::json;

class CliDraws : public Cli {};

TEST_F(CliDraws, WhatIsRefused) {
  refuses(2, "cosim --scene bowtie --draws 3 --cull back --png a.png", {"--draws", "--cull back", "--png"});
  refuses(2, "cosim --scene bowtie --draws 3 --draw-state random", {"--draws", "--draw-state"});
  refuses(2, "cosim --scene bowtie --draws x", {"--draws"});
  refuses(2, "cosim --scene bowtie --waits often", {"--waits \"often\"", "bursts, sparse, locked, mixed"});
  refuses(2, "cosim --scene bowtie --waits mixed --stall 0.5", {"--waits", "--stall"});
  refuses(2, "cosim --battery none", {"--battery none: no such group", "lanes.corners"});
  refuses(2, "cosim --battery power --scene bowtie", {"--battery", "--rtl"});
  refuses(2, "cosim --battery power --set significand_bits=12", {"--battery", "--rtl"});
}

/// The same for any number of threads; each draw is judged, and the summary says what was between them.
TEST_F(CliDraws, SeveralDrawsInOneMachine) {
  const std::string draw = "cosim --stress general --count 60 --size 48x40 --draws 8 --seed 3 --json - --threads ";
  const Outcome one = run(draw + "1"), two = run(draw + "2");
  ASSERT_EQ(one.status, 0) << one.err;
  ASSERT_EQ(two.status, 0) << two.err;
  const json a = json::parse(one.out), b = json::parse(two.out);
  EXPECT_EQ(a["fragment_hash"], b["fragment_hash"]);
  EXPECT_EQ(a["cycles_rtl"], b["cycles_rtl"]);
  EXPECT_EQ(a["counters"], b["counters"]);
  EXPECT_EQ(a["draws"], 8);
  EXPECT_GT(a["clears"].get<int>() + a["resets"].get<int>(), 0);
  EXPECT_GT(a["fragments"].get<int>(), 500);
  EXPECT_GT(a["skips"]["compared"].get<int>(), 4 * a["fragments"].get<int>());
  const Outcome text = run("cosim --stress general --count 60 --size 48x40 --draws 8 --seed 3");
  EXPECT_NE(text.out.find("draws          8 of one machine"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find(std::to_string(a["fragments"].get<int>()) + " fragments against the truth, 0 differ"),
            std::string::npos)
      << text.out;
  EXPECT_NE(text.out.find(" fragments of draws with other skips, 0 quads differ"), std::string::npos) << text.out;
}

/// A pattern changes the clocks, not the fragments.
TEST_F(CliDraws, PatternsOfWaits) {
  const std::string draw = "cosim --scene bowtie --size 32x32 --no-alone --no-snapping-error --json -";
  const json none = json::parse(run(draw).out), mixed = json::parse(run(draw + " --waits mixed").out);
  EXPECT_EQ(mixed["fragment_hash"], none["fragment_hash"]);
  EXPECT_GT(mixed["cycles_rtl"].get<int>(), none["cycles_rtl"].get<int>());
  const json off = json::parse(run(draw + " --no-compare-skips").out);
  EXPECT_EQ(off["skips"]["compared"], 0);
  EXPECT_EQ(off["fragment_hash"], none["fragment_hash"]);
}

class CliBattery : public Cli {};

/// Every group on the RTL as it is.
TEST_F(CliBattery, AllGroupsPass) {
  const Outcome outcome = run("cosim --battery --json battery.json");
  ASSERT_EQ(outcome.status, 0) << outcome.out << outcome.err;
  const json report = json::parse(read(file("battery.json")));
  EXPECT_TRUE(report["ok"]);
  EXPECT_GE(report["groups"].size(), 39u);
  for (const json& group : report["groups"]) {
    EXPECT_TRUE(group["ok"]) << group["input"];
    EXPECT_GT(group.at("fragments").get<int>(), 100) << group["input"];
    EXPECT_TRUE(group["complete"]) << group["input"];
  }
}

/// What a tile held half of the epochs ago hides again: only draws with many clears between them show it.
TEST_F(CliBattery, TheHighestBitOfAnEpochIgnored) {
  spoil("quadrille_hierarchical_z.sv", "word_epoch == epoch_q", "word_epoch[EPOCH-2:0] == epoch_q[EPOCH-2:0]");
  const Outcome outcome = run("cosim --battery lanes.layers --no-shrink --rtl rtl");
  EXPECT_EQ(outcome.status, 1) << outcome.out << outcome.err;
  EXPECT_NE(outcome.err.find("lanes.layers: lockstep: draw "), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("\n  quadrille cosim --battery lanes.layers --seed 1 --rtl rtl\n"), std::string::npos)
      << outcome.err;
}

/// Only quads at the right distance from one another show it.
TEST_F(CliBattery, SetupGoesOnWhileItsMultipliersAreBusy) {
  spoil("quadrille_quad_setup.sv", "run_q && last && !wait_i", "run_q && last");
  EXPECT_EQ(run("cosim --battery lanes.phases --no-shrink --quiet --rtl rtl").status, 1);
}

/// Truncated, with a bit flipped, without its checksums: said, built again, and the run goes on.
TEST_F(CliBattery, ADamagedSimulatorIsBuiltAgain) {
  const std::string draw =
      "cosim --scene bowtie --size 32x32 --no-alone --set significand_bits=10 --set attribute_slots=1";
  const std::string environment = "QUADRILLE_CACHE='" + file("cache").string() + "'";
  ASSERT_EQ(run(draw, environment).status, 0);
  fs::path entry;
  for (const fs::directory_entry& e : fs::directory_iterator(file("cache")))
    if (e.path().filename().string().starts_with("device-")) entry = e.path();
  ASSERT_FALSE(entry.empty());
  const fs::path object = entry / "device.so";
  const auto damaged = [&](const char* what, const char* why) {
    const Outcome outcome = run(draw, environment);
    EXPECT_EQ(outcome.status, 0) << what << ": " << outcome.err;
    EXPECT_NE(outcome.err.find("built again: "), std::string::npos) << what << ": " << outcome.err;
    EXPECT_NE(outcome.err.find(why), std::string::npos) << what << ": " << outcome.err;
    EXPECT_EQ(run(draw, environment).err.find("damaged"), std::string::npos) << what;
  };
  fs::resize_file(object, fs::file_size(object) / 2);
  damaged("truncated", "device.so has other bytes than were written");
  {
    std::fstream bytes(object, std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekg(static_cast<std::streamoff>(fs::file_size(object) / 3));
    const int byte = bytes.get();
    bytes.seekp(static_cast<std::streamoff>(fs::file_size(object) / 3));
    bytes.put(static_cast<char>(byte ^ 0x10));
  }
  damaged("a bit flipped", "device.so has other bytes than were written");
  fs::remove(entry / "checksums.txt");
  damaged("no checksums", "it has no checksums");
}

}  // namespace
