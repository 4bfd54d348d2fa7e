// Synthesis of points: with a stand-in for Yosys that counts its calls, and once with Yosys itself.
#include "tb/sweep/synthesis.hpp"

#include "tb/device/verilate.hpp"
#include "tb/support/environment_error.hpp"
#include "tb/sweep/point_table.hpp"
#include "tb/yosys/yosys.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

namespace quadrille::sweep {
namespace {

namespace fs = std::filesystem;

/// An environment variable set for a scope.
class Environment {
 public:
  Environment(std::string name, const std::string& value) : name_(std::move(name)) {
    if (const char* old = std::getenv(name_.c_str()); old != nullptr) before_ = old;
    setenv(name_.c_str(), value.c_str(), 1);
  }
  ~Environment() {
    if (before_) {
      setenv(name_.c_str(), before_->c_str(), 1);
    } else {
      unsetenv(name_.c_str());
    }
  }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  std::string name_;
  std::optional<std::string> before_;
};

// Writes what the script asks Yosys for, from the significand bits alone: 13 fails, 14 gives statistics of another
// layout. The smaller s, the longer it takes, so that points end in another order than they start.
constexpr const char* stand_in = R"sh(#!/bin/sh
if [ "$1" = -V ]; then echo "stand-in 1"; exit 0; fi
s=$(sed -n 's/.*QUADRILLE_SIGNIFICAND_BITS=\([0-9]*\).*/\1/p' "$2")
echo "$s" >> "$STAND_IN_CALLS"
if [ "$s" = 13 ]; then echo "ERROR: bad luck"; exit 1; fi
sleep 0.$((26 - s))
{
  echo "=== first ==="
  echo "     LUT4     1"
  echo "     MULT18X18D   2"
  [ "$s" = 14 ] || echo "=== quadrille ==="
  echo "     LUT4     $((100 * s))"
  echo "     CCU2C     10"
  echo "     TRELLIS_DPR16X4   3"
  echo "     TRELLIS_FF   7"
  echo "     DP16KD   4"
  echo "     first   1"
  grep -q nodsp "$2" || echo "     MULT18X18D   3"
  echo "=== design hierarchy ==="
  echo "     LUT4     99"
} > cells.txt
echo "Longest topological path in quadrille (length=86):" > path.txt
)sh";

constexpr auto ecp5 = tb::SynthesisTarget::ecp5;

constexpr std::uint64_t luts_of(int s) { return static_cast<std::uint64_t>(100 * s) + 2 * 10 + 6 * 3 + 1; }

class Synthesis : public ::testing::Test {
 protected:
  Synthesis()
      : directory_(fs::path(testing::TempDir()) / ("quadrille_synthesis_" + std::to_string(getpid()))),
        cache_("QUADRILLE_CACHE", (directory_ / "cache").string()),
        calls_("STAND_IN_CALLS", (directory_ / "calls").string()),
        path_("PATH", (directory_ / "bin").string() + ":" + std::getenv("PATH")) {
    fs::remove_all(directory_);
    fs::create_directories(directory_ / "bin");
    const fs::path program = directory_ / "bin" / "yosys";
    std::ofstream(program) << stand_in;
    fs::permissions(program, fs::perms::owner_all);
  }
  ~Synthesis() override { fs::remove_all(directory_); }

  static SynthesisPoint point(std::size_t row, int s) {
    SynthesisPoint result{row, {}};
    result.config.set("significand_bits", s);
    return result;
  }
  std::size_t calls() const {
    std::ifstream in(directory_ / "calls");
    return static_cast<std::size_t>(std::distance(std::istream_iterator<int>(in), {}));
  }
  std::vector<fs::path> cache_entries() const {
    std::vector<fs::path> entries;
    for (const fs::directory_entry& entry : fs::directory_iterator(directory_ / "cache"))
      entries.push_back(entry.path());
    return entries;
  }

  fs::path directory_;
  CostWeights weights_{.state = 1, .multiplier = 2, .adder = 3, .table = 4, .dsp = 5};

 private:
  Environment cache_, calls_, path_;
};

TEST_F(Synthesis, RowsComeInTheOrderOfThePoints) {
  const std::vector<SynthesisPoint> points{point(7, 20), point(3, 17), point(9, 18), point(1, 25), point(2, 19)};
  std::vector<std::pair<std::size_t, std::size_t>> told;
  const auto rows = synthesise(points, ecp5, weights_, 3,
                               [&](std::size_t done, std::size_t total) { told.emplace_back(done, total); });
  ASSERT_EQ(rows.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const SynthesisRow expected{.row = points[i].row,
                                .target = tb::SynthesisTarget::ecp5,
                                .size = {.flip_flops = 7,
                                         .luts = luts_of(points[i].config.significand_bits),
                                         .dsps = 5,
                                         .block_rams = 4,
                                         .longest_path = 86,
                                         .area_um2 = {},
                                         .nand2 = {},
                                         .mhz = {},
                                         .critical_path = {}},
                                .cost = scalar_cost(hardware_cost(points[i].config), weights_),
                                .cost_luts = lut_cost(hardware_cost(points[i].config), weights_),
                                .cost_dsps = hardware_cost(points[i].config).dsps};
    EXPECT_EQ(rows[i], expected) << i;
  }
  ASSERT_FALSE(told.empty());
  for (std::size_t i = 0; i < told.size(); ++i) {
    EXPECT_EQ(told[i].second, points.size());
    if (i > 0) {
      EXPECT_LT(told[i - 1].first, told[i].first);
    }
  }
  EXPECT_EQ(told.back().first, points.size());
  EXPECT_EQ(synthesise(points, ecp5, weights_, 1), rows);
  EXPECT_TRUE(synthesise({}, ecp5, weights_, 4).empty());
}

TEST_F(Synthesis, ASecondRequestComesFromTheCache) {
  synthesise(std::vector{point(0, 20), point(1, 22)}, ecp5, weights_, 2);
  EXPECT_EQ(calls(), 2u);
  EXPECT_EQ(cache_entries().size(), 2u);  // results only, no work directory, no log
  synthesise(std::vector{point(5, 22), point(6, 20)}, ecp5, weights_, 1);
  EXPECT_EQ(calls(), 2u);

  // Auto and the value that it stands for are one machine; another value is another.
  SynthesisPoint same = point(0, 20);
  same.config.attribute_frac_bits = 24;
  synthesise(std::vector{same}, ecp5, weights_, 1);
  EXPECT_EQ(calls(), 2u);
  same.config.attribute_frac_bits = 25;
  synthesise(std::vector{same}, ecp5, weights_, 1);
  EXPECT_EQ(calls(), 3u);

  // An entry that cannot be read is made again.
  for (const fs::path& entry : cache_entries()) std::ofstream(entry / "report.json") << "12\n";
  EXPECT_EQ(synthesise(std::vector{point(0, 20)}, ecp5, weights_, 1).front().size.luts, luts_of(20));
  EXPECT_EQ(calls(), 4u);
}

TEST_F(Synthesis, EachTargetIsASynthesisOfItsOwn) {
  const std::vector points{point(0, 20)};
  const SynthesisRow with = synthesise(points, ecp5, weights_, 1).front();
  const SynthesisRow without = synthesise(points, tb::SynthesisTarget::ecp5_nodsp, weights_, 1).front();
  EXPECT_EQ(calls(), 2u);
  EXPECT_EQ(with.size.dsps, 5u);
  EXPECT_EQ(without.size.dsps, 2u);
  // Estimated: 52 products of 20 × 20 bits in a block and adders each, eighteen of the tables in two blocks, and twelve
  // blocks of the setup.
  EXPECT_EQ(synthesis_table(std::vector{with, without}),
            "row,target,luts,flip_flops,dsps,block_rams,longest_path,area_um2,nand2,mhz,critical_path,cost,cost_luts,"
            "cost_dsps\n"
            "0,ecp5,2039,7,5,4,86,,,,," +
                csv_number(with.cost) + "," + csv_number(with.cost_luts) + ",100\n0,ecp5-nodsp,2039,7,2,4,86,,,,," +
                csv_number(without.cost) + "," + csv_number(without.cost_luts) + ",0\n");
  EXPECT_EQ(weights_of(ecp5).multiplier, 0);
  EXPECT_EQ(weights_of(tb::SynthesisTarget::ecp5_nodsp).dsp, 0);
  EXPECT_GT(weights_of(tb::SynthesisTarget::cells).multiplier, 0);
  for (const std::string_view name : tb::synthesis_target_names)
    EXPECT_EQ(tb::synthesis_target_names[static_cast<std::size_t>(tb::parse_synthesis_target(name))], name);
  try {
    tb::parse_synthesis_target("ice40");
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("ecp5-nodsp"), std::string::npos) << error.what();
  }
}

TEST_F(Synthesis, AFailureNamesTheLog) {
  try {
    synthesise(std::vector{point(0, 20), point(1, 13), point(2, 21)}, ecp5, weights_, 1);
    FAIL();
  } catch (const tb::VerilateError& error) {
    EXPECT_NE(std::string(error.what()).find("bad luck"), std::string::npos) << error.what();
    const std::string text = error.what();
    const std::size_t from = text.find('/'), to = text.find(".log", from);
    ASSERT_NE(to, std::string::npos) << text;
    EXPECT_TRUE(fs::exists(text.substr(from, to + 4 - from))) << text;
  }
  EXPECT_EQ(calls(), 2u);  // nothing was started after the failure
  EXPECT_THROW(synthesise(std::vector{point(0, 14)}, ecp5, weights_, 1), tb::VerilateError);
  SynthesisPoint impossible = point(0, 20);
  impossible.config.viewport_bits = 14;
  EXPECT_THROW(synthesise(std::vector{impossible}, ecp5, weights_, 1), ConfigError);
}

TEST_F(Synthesis, WithoutYosysTheEnvironmentIsToBlame) {
  const Environment nothing("PATH", (directory_ / "absent").string());
  try {
    synthesise(std::vector{point(0, 20)}, ecp5, weights_, 2);
    FAIL();
  } catch (const tb::EnvironmentError& error) {
    EXPECT_NE(std::string(error.what()).find("yosys"), std::string::npos) << error.what();
  }
}

TEST_F(Synthesis, AnExceptionOfTheCallbackPassesThrough) {
  const auto stop = [](std::size_t, std::size_t) { throw std::out_of_range("enough"); };
  EXPECT_THROW(synthesise(std::vector{point(0, 20), point(1, 21), point(2, 22)}, ecp5, weights_, 1, stop),
               std::out_of_range);
  EXPECT_LT(calls(), 3u);
}

// Takes a minute the first time.
TEST(SynthesisByYosys, ASmallMachine) {
  SynthesisPoint point;
  for (const auto& [key, value] : {std::pair{"significand_bits", 8},
                                   {"viewport_bits", 6},
                                   {"guard_bits", 2},
                                   {"subpixel_bits", 2},
                                   {"homogeneous_frac_bits", 4},
                                   {"attribute_slots", 1},
                                   {"tile_log2", 2}})
    point.config.set(key, value);
  const SynthesisRow row = synthesise(std::vector{point}, ecp5, ecp5_weights, 1).front();
  // A DSP for each product of two significands: 6 of u, 6 + 3 of the ratios, 8 of weights, 3 in the attribute's sum and
  // 4 in each of 3 others, 2 quotients; two for each of the tables' nine polynomials; three for each of the setup's
  // four products.
  EXPECT_EQ(row.size.dsps, 6u + 9u + 8u + 3u + 3u * 4u + 2u + 2u * 9u + 3u * 4u);
  EXPECT_EQ(row.cost_dsps, row.size.dsps);
  // A carry chain is no shorter than its 28-bit values (T_BITS, two bits a cell), and a stage holds a few of them.
  EXPECT_GE(row.size.longest_path, 14u);
  EXPECT_LE(row.size.longest_path, 200u);
  // Blocks of 36 bits: the slots' words for interpolation, three sets of four numbers of 18 bits (216), and six squared
  // lengths of 32 (192); bases and limits, 32 + 25 + 2 × 26 bits (109); the fragments' FIFO, of one attribute with
  // fewer than 4 × 36 bits.
  EXPECT_GT(*row.size.block_rams, 6u + 6u + 4u);
  EXPECT_LE(*row.size.block_rams, 6u + 6u + 4u + 4u);
  // The smallest of the configurations that the estimate is fitted to: 2 to 3 % too low.
  EXPECT_NEAR(row.cost_luts, static_cast<double>(*row.size.luts), 0.04 * static_cast<double>(*row.size.luts));
  EXPECT_FALSE(row.size.mhz);
  std::printf("%s", synthesis_table(std::vector{row}).c_str());
}

}  // namespace
}  // namespace quadrille::sweep
