// Kept worst quads: the file says what it says, and the kept ones are complete and as bad as they were.
#include "tb/judge/worst_quads.hpp"

#include "golden/io/error.hpp"
#include "golden/io/text_input.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace quadrille::tb {
namespace {

constexpr std::string_view quad_line = "4 4 0.5 1 40 6 0.5 1 50 44 0.5 1 6 50 0.5 1 0.5 -0.25 1 0.125\n";

std::string refusal(const std::string& text) {
  try {
    WorstQuads::parse(text, "w.quads");
  } catch (const golden::InputError& error) {
    return error.what();
  }
  return "nothing";
}

TEST(WorstQuads, AreReadAndWritten) {
  const std::string quad(quad_line);
  const WorstQuads read = WorstQuads::parse(
      "# found by: a command\n# size 64x32\n# set significand_bits=12\n# a comment\n# reflex weight 1.250000 at "
      "10,11\n" +
          quad + "# tiny depth 0.5 at 63,31\r\n" + quad,
      "w.quads");
  EXPECT_EQ(read.found_by, "a command");
  EXPECT_EQ(read.width, 64);
  EXPECT_EQ(read.height, 32);
  EXPECT_EQ(read.config.significand_bits, 12);
  ASSERT_EQ(read.quads.size(), 2u);
  EXPECT_EQ(read.quads[0].family, golden::StressFamily::reflex);
  EXPECT_EQ(read.quads[0].output, Output::weight);
  EXPECT_EQ(read.quads[0].units, 1.25);
  EXPECT_EQ(read.quads[1].output, Output::depth);
  EXPECT_EQ(read.quads[1].at.x, 63);
  EXPECT_EQ(read.quads[1].quad.vertex[2].x, 50);
  EXPECT_EQ(read.quads[1].quad.attribute[3], std::vector<double>{0.125});
  const std::string text = read.text();
  EXPECT_EQ(WorstQuads::parse(text, "again").text(), text);
  EXPECT_NE(text.find("# set significand_bits=12\n# reflex weight 1.250000 at 10,11\n4 4 0.5 1 "), text.npos) << text;
}

TEST(WorstQuads, BadFilesAreRefused) {
  const std::string quad(quad_line), record = "# reflex weight 1.25 at 10,11\n";
  const auto expect = [](const std::string& text, const std::string& piece) {
    EXPECT_NE(refusal(text).find(piece), std::string::npos) << refusal(text) << "\nof " << text;
  };
  expect(quad, "w.quads:1: quad without a record");
  expect(record + quad + quad, "w.quads:3: quad without a record");
  expect(record + record + quad, "w.quads:2: record without a quad");
  expect(record + quad + record, "record without a quad");
  expect("# reflex weight 1.25 10,11\n" + quad, "w.quads:1: expected # reflex weight ERROR at X,Y");
  expect("# reflex weight nan at 10,11\n" + quad, "expected # reflex weight");
  expect("# reflex weight -1 at 10,11\n" + quad, "expected # reflex weight");
  expect("# reflex weight 1.25 at 10,11 px\n" + quad, "expected # reflex weight");
  expect("# reflex weight 1.25 at 10,64\n" + quad, "outside 64x64");
  expect("# reflexes weight 1.25 at 10,11\n" + quad, "quad without a record");
  expect("# size 0x7\n" + record + quad, "w.quads:1: expected # size");
  expect("# set significand_bits=twelve\n" + record + quad, "w.quads:1: expected # set");
  expect("# set significand_bit=12\n" + record + quad, "w.quads:1: ");
  expect("# set significand_bits=99\n" + record + quad, "significand_bits");
  expect(record + "1 2 3\n", "fields");
  expect(record + "4 4 0.5 1 40 6 0.5 1 50 44 0.5 1 6 50 0.5 1\n", "0 attributes; one is expected");
  expect("", "no quad");
}

/// An error other than the recorded one, nothing drawn at the pixel.
TEST(WorstQuads, FaultsAreTold) {
  const std::string quad(quad_line);
  WorstQuads quads =
      WorstQuads::parse("# reflex weight 1 at 20,20\n" + quad + "# tiny depth 1 at 63,0\n" + quad, "w.quads");
  std::vector<PixelError> now = quads.measure();
  ASSERT_EQ(now.size(), 2u);
  EXPECT_GT(now[0].units, 0);
  EXPECT_EQ(now[1].units, -1);
  std::vector<std::string> faults = quads.faults(now);
  ASSERT_EQ(faults.size(), 2u);
  EXPECT_NE(faults[0].find("reflex weight 1.000000 at 20,20: the error is now "), std::string::npos) << faults[0];
  EXPECT_NE(faults[1].find("nothing is drawn"), std::string::npos) << faults[1];
  quads.quads.pop_back();
  now.pop_back();
  quads.quads[0].units = now[0].units;
  EXPECT_TRUE(quads.faults(now).empty());
  quads.quads[0].units = now[0].units = 8.5;
  faults = quads.faults(now);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_NE(faults[0].find("beyond the bound"), std::string::npos);
  EXPECT_FALSE(same_units(1.25, 1.250001));
  EXPECT_TRUE(same_units(1.25, 1.2500004));
}

class KeptWorstQuads : public testing::TestWithParam<int> {
 protected:
  std::string path() const {
    return QUADRILLE_SOURCE_DIR "/tb/judge/worst_quads/s" + std::to_string(GetParam()) + ".quads";
  }
};

/// Every family and output once, with the errors that the file states, all within the bound.
TEST_P(KeptWorstQuads, AreCompleteAndAsBadAsTheyWere) {
  const WorstQuads kept = WorstQuads::load(path());
  EXPECT_EQ(kept.config.significand_bits, GetParam());
  std::map<std::pair<golden::StressFamily, Output>, int> count;
  for (const WorstQuad& worst : kept.quads) ++count[{worst.family, worst.output}];
  for (const golden::StressFamilyInfo& info : golden::stress_families())
    for (const Output output : {Output::weight, Output::attribute, Output::depth})
      EXPECT_EQ((count[{info.family, output}]), 1)
          << info.name << " " << output_names[static_cast<std::size_t>(output)];
  for (const WorstQuad& worst : kept.quads) {
    const auto& v = worst.quad.vertex;
    const bool constant =
        std::ranges::all_of(v, [&](const WindowVertex& at) { return std::fabs(at.z / at.w - v[0].z / v[0].w) < 1e-9; });
    const double least = worst.output == Output::weight || worst.output == Output::attribute ? 1.5 : constant ? 0 : 0.5;
    EXPECT_GE(worst.units, least) << golden::stress_family_name(worst.family);
    EXPECT_LE(worst.units, bound_units);
  }
  for (const std::string& fault : kept.faults(kept.measure())) ADD_FAILURE() << fault;
  EXPECT_LT(golden::read_file(path(), "kept quads").size(), 25'000u);
}

/// With a guard bit less, and with finer tables, some errors are others: such a change of the arithmetic shows.
TEST_P(KeptWorstQuads, ShowAChangeOfTheArithmetic) {
  const WorstQuads kept = WorstQuads::load(path());
  const auto changed = [&](const Config& config) {
    WorstQuads other = kept;
    other.config = config;
    const std::vector<PixelError> now = other.measure();
    std::size_t count = 0;
    for (std::size_t i = 0; i < now.size(); ++i) count += !same_units(kept.quads[i].units, now[i].units);
    return count;
  };
  Config less = kept.config, finer = kept.config;
  less.align_guard_bits -= 1;
  finer.sqrt_segments_log2 = kept.config.sqrt_segments() + 1;
  const std::size_t by_guard = changed(less), by_table = changed(finer);
  EXPECT_GT(by_guard, 0u);
  EXPECT_GT(by_table, 0u);
  EXPECT_EQ(changed(kept.config), 0u);
  RecordProperty("other_with_a_guard_bit_less", std::to_string(by_guard));
  RecordProperty("other_with_finer_tables", std::to_string(by_table));
}

INSTANTIATE_TEST_SUITE_P(Widths, KeptWorstQuads, testing::Values(8, 12, 18, 26));

}  // namespace
}  // namespace quadrille::tb
