// cosim on RTL with a fault shrinks itself: what is left fails by the command that is printed, and is little.
#include "tb/commands/cli_fixture.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>

namespace {

using namespace quadrille::cli_test;

class CliShrink : public Cli {
 protected:
  /// The command that a failed run prints, without the program's name.
  static std::string command_of(const Outcome& outcome) {
    const std::size_t line = outcome.err.find("\n  quadrille cosim --quads ");
    if (line == std::string::npos) return {};
    const std::size_t begin = outcome.err.find("cosim", line);
    return outcome.err.substr(begin, outcome.err.find('\n', begin) - begin);
  }
  /// The argument of an option in a command.
  static std::string argument(const std::string& command, const std::string& option) {
    const std::size_t at = command.find(" " + option + " ");
    if (at == std::string::npos) return {};
    const std::size_t begin = at + option.size() + 2;
    return command.substr(begin, command.find(' ', begin) - begin);
  }
  /// From the first to the last time of a waveform, in clocks: a clock lasts 2 units.
  std::uint64_t clocks_of(const std::string& waveform) const {
    const std::string bytes = read(file(waveform));  // a block's type and length, then both times, big-endian
    std::uint64_t time[2] = {};
    for (std::size_t i = 0; i < 16 && bytes.size() > 25; ++i)
      time[i / 8] = time[i / 8] << 8 | static_cast<unsigned char>(bytes[9 + i]);
    return (time[1] - time[0]) / 2;
  }
};

/// A quad, its pixel and no wait are left of a scene with stalls and gaps; the command fails, as the first run did, and
/// the same quads pass in the project's RTL.
TEST_F(CliShrink, FaultInAFixedPointBit) {
  spoil("fixed_point.sv", "top_q >> distance_q[NEAR-1:0]", "(top_q >> distance_q[NEAR-1:0]) & ~OUT'(4)");
  const std::string input =
      "cosim --scene bowtie --size 96x96 --stall 0.5 --gap 0.3 --seed 5 --no-snapping-error --quiet --rtl rtl";
  const Outcome plain = run(input + " --no-shrink");
  EXPECT_EQ(plain.status, 1) << plain.err;
  EXPECT_EQ(command_of(plain), "");
  EXPECT_FALSE(fs::exists(file("cosim_failure.quads")));

  const Outcome whole = run(input + " --shrink less.quads");
  EXPECT_EQ(whole.status, 1) << whole.err;
  EXPECT_NE(whole.err.find(" 1 of 6 quads, 1x1 pixels, 0 stalls, 0 gaps, "), std::string::npos) << whole.err;
  EXPECT_NE(whole.err.find(": less.fst"), std::string::npos) << whole.err;
  EXPECT_GT(fs::file_size(file("less.fst")), 1000u);

  const std::string less = command_of(whole);
  EXPECT_NE(less.find("--quads less.quads "), std::string::npos) << less;
  EXPECT_EQ(less.find("--stall"), std::string::npos) << less;
  EXPECT_EQ(less.find("--gap"), std::string::npos) << less;
  const Outcome again = run(less + " --quiet");
  EXPECT_EQ(again.status, 1) << less << again.err;
  EXPECT_NE(again.err.find("stage fragment, field"), std::string::npos) << again.err;
  // The pixel that is left, explained: everything is the same but what leaves the machine.
  const std::size_t explain = whole.err.find("  its pixel explained: quadrille explain --quads less.quads ");
  ASSERT_NE(explain, std::string::npos) << whole.err;
  const std::size_t begin = whole.err.find("explain --quads", explain);
  const Outcome explained = run(whole.err.substr(begin, whole.err.find('\n', begin) - begin));
  EXPECT_EQ(explained.status, 1) << explained.err;
  EXPECT_NE(explained.out.find("[sum]  (RTL: the same)"), std::string::npos) << explained.out;
  EXPECT_NE(explained.out.find("(RTL: differs)"), std::string::npos) << explained.out;
  // That of the whole scene, which many differences come before.
  const std::size_t whole_explain = plain.err.find("explain --engine rtl --rtl rtl --scene bowtie ");
  ASSERT_NE(whole_explain, std::string::npos) << plain.err;
  const Outcome of_scene = run(plain.err.substr(whole_explain, plain.err.find('\n', whole_explain) - whole_explain));
  EXPECT_EQ(of_scene.status, 1) << of_scene.err;
  EXPECT_NE(of_scene.out.find("[sum]  (RTL: the same)"), std::string::npos) << of_scene.out;

  const std::string sound = less.substr(0, less.find(" --rtl"));
  EXPECT_EQ(run(sound + " --quiet").status, 0) << sound;
}

/// A fault that only stalls show, and that the stalls of the whole scene show at other quads than the one that is left:
/// it, as many pixels as the place that is overwritten holds, and so many stalls.
TEST_F(CliShrink, FaultUnderStalls) {
  spoil("fragment_fifo.sv", "free = !valid_o || ready_i", "free = !valid_o || ready_i || (count_q == 3)");
  const Outcome whole = run("cosim --scene sphere --size 64x64 --stall 0.3 --gap 0.2 --quiet --no-alone --rtl rtl");
  EXPECT_EQ(whole.status, 1) << whole.err;
  EXPECT_NE(whole.err.find(" 1 of 128 quads, "), std::string::npos) << whole.err;
  EXPECT_NE(whole.err.find(", 3 stalls, 0 gaps, "), std::string::npos) << whole.err;
  const std::string less = command_of(whole);
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  ASSERT_EQ(std::sscanf(argument(less, "--scissor").c_str(), "%d,%d,%d,%d", &x0, &y0, &x1, &y1), 4) << less;
  EXPECT_LE((x1 - x0) * (y1 - y0), 4) << less;
  const std::string stalls = argument(less, "--stall-clocks");
  unsigned long long first = 0, last = 0;
  ASSERT_EQ(std::sscanf(stalls.c_str(), "%llu-%llu", &first, &last), 2) << less;
  EXPECT_EQ(last - first, 2u) << less;
  EXPECT_EQ(less.find("--gap"), std::string::npos) << less;

  // The waveform: the whole run, which is shorter than 200 clocks, to its end.
  EXPECT_NE(whole.err.find(" clocks: cosim_failure.fst"), std::string::npos) << whole.err;
  EXPECT_GT(clocks_of("cosim_failure.fst"), last);
  EXPECT_LE(clocks_of("cosim_failure.fst"), 200u + 5u);  // and reset

  // The same report at one thread and at two, and from the same command twice.
  nlohmann::json report;
  for (const char* threads : {"1", "2", "2"}) {
    const Outcome again = run(less + " --quiet --no-alone --json - --threads " + threads);
    EXPECT_EQ(again.status, 1) << less << again.err;
    EXPECT_EQ(again.err.find("minimized to"), std::string::npos) << again.err;
    nlohmann::json now = nlohmann::json::parse(again.out);
    for (const char* key :
         {"command", "wall_seconds", "rtl_cycles_per_second", "rtl_alone_cycles_per_second", "rtl_alone_over_lockstep"})
      now.erase(key);
    if (report.is_null()) report = now;
    EXPECT_EQ(now, report);
  }
  EXPECT_EQ(report.at("stall_clocks"), stalls);
  EXPECT_GT(report.at("mismatches"), 0);

  // Neither in the project's RTL nor with a stall less, at any place.
  const std::string quads = less.substr(0, less.find(" --stall-clocks ")), rest = " --no-shrink --quiet --no-alone";
  EXPECT_EQ(run(quads + " --stall-clocks " + stalls + rest).status, 0);
  const auto list = [](unsigned long long a, unsigned long long b) {
    return std::to_string(a) + "," + std::to_string(b);
  };
  for (const std::string& fewer : {list(first, first + 1), list(first, last), list(first + 1, last)})
    EXPECT_EQ(run(quads + " --stall-clocks " + fewer + " --rtl rtl" + rest).status, 0) << fewer;

  // What is left, shrunk again, is read from one file and written to another.
  const Outcome twice = run(less.substr(0, less.find(" --no-shrink")) + " --quiet --no-alone");
  EXPECT_NE(twice.err.find("minimized to 1 of 1 quad, "), std::string::npos) << twice.err;
  EXPECT_EQ(argument(command_of(twice), "--stall-clocks"), stalls) << twice.err;
  EXPECT_NE(twice.err.find("cosim_failure_less.fst"), std::string::npos) << twice.err;

  // A late fault: of a draw that is not shrunk at all, the last 200 clocks.
  const Outcome late =
      run("cosim --scene phong_mesh_detail --size 64x64 --stall 0.3 --gap 0.2 --seed 1 --quiet --no-alone --rtl rtl "
          "--shrink-time 0");
  EXPECT_NE(late.err.find(" --stall 0.3 --gap 0.2 "), std::string::npos) << late.err;
  EXPECT_NE(late.err.find("--shrink-time"), std::string::npos) << late.err;
  EXPECT_NE(late.err.find(" 200 clocks: cosim_failure.fst"), std::string::npos) << late.err;
  EXPECT_GE(clocks_of("cosim_failure.fst"), 199u);
  EXPECT_LE(clocks_of("cosim_failure.fst"), 201u);
  EXPECT_EQ(run(command_of(late) + rest.substr(sizeof " --no-shrink" - 1)).status, 1) << late.err;
}

TEST_F(CliShrink, NothingIsWrittenWhereNothingFails) {
  EXPECT_EQ(run("cosim --scene bowtie --size 32x32 --shrink less.quads --quiet").status, 0);
  EXPECT_FALSE(fs::exists(file("less.quads")) || fs::exists(file("less.fst")));
  EXPECT_FALSE(fs::exists(file("cosim_failure.quads")));

  // Nothing was drawn: a failure, but of no quad.
  write("off.quads", "-20 10 0.5 1  -10 12 0.5 1  -10 44 0.5 1  -20 40 0.5 1\n");
  const Outcome nothing = run("cosim --quads off.quads --size 32x32 --quiet --no-alone");
  EXPECT_EQ(nothing.status, 1);
  EXPECT_NE(nothing.err.find("not minimized: no fragments compared"), std::string::npos) << nothing.err;
  EXPECT_FALSE(fs::exists(file("cosim_failure.quads")));
}

using CliShrinkOptions = Cli;

TEST_F(CliShrinkOptions, WhatIsRefused) {
  refuses(2, "cosim --scene bowtie --shrink a.quads --no-shrink", {"--shrink", "--no-shrink"});
  refuses(2, "cosim --scene bowtie --stall 0.5 --stall-clocks 3", {"--stall", "--stall-clocks"});
  refuses(2, "cosim --scene bowtie --gap 0.5 --gap-beats 3", {"--gap", "--gap-beats"});
  refuses(2, "cosim --scene bowtie --stall-clocks 3,2", {"--stall-clocks \"3,2\"", "17,40-43"});
  refuses(2, "cosim --scene bowtie --gap-beats 5:0", {"--gap-beats \"5:0\"", "5:2,9"});
  refuses(2, "cosim --scene bowtie --shrink-time -1", {"--shrink-time"});
}

}  // namespace
