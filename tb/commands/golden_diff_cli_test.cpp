// quadrille golden diff on sets and pictures.
#include "golden/io/exr.hpp"
#include "tb/commands/cli_fixture.hpp"

#include <nlohmann/json.hpp>

#include <limits>
#include <map>

namespace {

using namespace quadrille::cli_test;
using nlohmann::json;

class GoldenDiffCli : public Cli {
 protected:
  void generate(const std::string& out, const std::string& more) const {
    const Outcome outcome = run("golden generate --level 1 --limit 40 --quiet --out " + out + " " + more);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }
};

TEST_F(GoldenDiffCli, SetsThatAreEqual) {
  generate("a", "--suite sqrt --suite stress_bowtie");
  generate("b", "--suite sqrt --suite stress_bowtie --threads 3");
  const Outcome outcome = run("golden diff a b --json d.json");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "2 suites are equal\n");
  const json report = json::parse(read(file("d.json")));
  EXPECT_TRUE(report.at("same"));
  EXPECT_FALSE(report.contains("seed"));
  EXPECT_FALSE(report.contains("config"));
  ASSERT_EQ(report.at("sets").size(), 2u);
  EXPECT_EQ(report["sets"][1]["set"], "b");
  EXPECT_EQ(report["sets"][1]["seed"], 1);
  EXPECT_EQ(report["sets"][1]["config"]["significand_bits"], 18);
  generate("one", "--suite sqrt");
  EXPECT_EQ(run("golden diff one one").out, "1 suite is equal\n");
  refuses(2, "golden diff a/sqrt b/sqrt", {"a/sqrt/manifest.json", "one suite"});
}

TEST_F(GoldenDiffCli, TheFirstDifferingFieldIsNamed) {
  generate("a", "--suite sqrt");
  generate("b", "--suite sqrt --seed 2");
  const Outcome other_seed = run("golden diff a b");
  EXPECT_EQ(other_seed.status, 1);
  EXPECT_NE(other_seed.out.find("sqrt/stimulus.hex: "), std::string::npos) << other_seed.out;
  EXPECT_NE(other_seed.out.find("lines differ; the first, line "), std::string::npos) << other_seed.out;
  EXPECT_NE(other_seed.out.find("exp["), std::string::npos) << other_seed.out;

  generate("c", "--suite sqrt --suite reciprocal --set significand_bits=12");
  const Outcome other_machine = run("golden diff a c");
  EXPECT_EQ(other_machine.status, 1);
  EXPECT_NE(other_machine.out.find("significand_bits = 18 against 12"), std::string::npos) << other_machine.out;
  EXPECT_NE(other_machine.out.find("suite reciprocal is in the second only"), std::string::npos) << other_machine.out;
  EXPECT_NE(other_machine.out.find(": the records have"), std::string::npos) << other_machine.out;
}

TEST_F(GoldenDiffCli, Pictures) {
  for (const char* s : {"18", "12"})
    ASSERT_EQ(run(std::string("render --scene bowtie --size 40x30 --quiet --set significand_bits=") + s + " --out p" +
                  s + ".exr")
                  .status,
              0);
  const Outcome same = run("golden diff p18.exr p18.exr");
  EXPECT_EQ(same.status, 0) << same.out;
  const Outcome outcome = run("golden diff p18.exr p12.exr --heat-map h.png --json -");
  EXPECT_EQ(outcome.status, 1);
  std::map<std::string, json> channels;
  for (const json report = json::parse(outcome.out); const json& channel : report.at("channels"))
    channels[channel.at("channel")] = channel;
  EXPECT_EQ(channels["quad"], (json{{"channel", "quad"}, {"count", 0}}));
  const json weight = channels["L0"];
  EXPECT_GT(weight.at("count"), 0);
  EXPECT_LT(weight.at("max"), 1.0 / 512);  // 2^-(12-3)
  EXPECT_GT(weight.at("max"), 0);
  EXPECT_LE(weight.at("rms"), weight.at("max"));
  EXPECT_EQ(read(file("h.png")).substr(1, 3), "PNG");

  // How far apart ids are means nothing.
  ASSERT_EQ(run("render --scene sphere --size 40x30 --quiet --out s.exr").status, 0);
  const std::string text = run("golden diff p18.exr s.exr").out;
  const std::size_t quad = text.find("quad ");
  ASSERT_NE(quad, std::string::npos) << text;
  EXPECT_EQ(text.substr(quad, text.find('\n', quad) - quad).find("max"), std::string::npos) << text;
}

TEST_F(GoldenDiffCli, WhatIsNoFiniteNumberIsNamed) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  quadrille::golden::FrameImage image(4, 3);
  const auto save = [&](const char* name) { quadrille::golden::save_exr(file(name).string(), image); };
  save("plain.exr");
  image.z[6] = nan;  // (2, 1)
  save("nan.exr");
  image.z[0] = 0.25f;
  save("nan_and_small.exr");
  image.z[6] = image.z[0] = 1;
  image.z[11] = infinity;
  save("infinite.exr");
  const auto z_line = [&](const std::string& pictures) {
    const Outcome outcome = run("golden diff " + pictures + " --json d.json");
    EXPECT_EQ(outcome.status, 1) << outcome.err;
    const std::size_t z = outcome.out.find("Z  ");
    return outcome.out.substr(z, outcome.out.find('\n', z) - z);
  };
  const auto z_json = [&] {
    for (const json report = json::parse(read(file("d.json"))); const json& channel : report.at("channels"))
      if (channel.at("channel") == "Z") return channel;
    return json();
  };
  EXPECT_EQ(z_line("plain.exr nan.exr"),
            "Z          1 pixel differs, 1 of them NaN on one side, the first at (2, 1): 1 against nan");
  EXPECT_EQ(z_json().at("nans"), 1);
  EXPECT_EQ(z_json().at("nan_x"), 2);
  EXPECT_EQ(z_line("nan_and_small.exr plain.exr"),
            "Z          2 pixels differ, 1 of them NaN on one side, the first at (2, 1): nan against 1, max 0.75 at "
            "(0, 0), RMS 0.216506");
  EXPECT_EQ(z_line("plain.exr infinite.exr"), "Z          1 pixel differs, max inf at (3, 2), RMS inf");
  EXPECT_EQ(z_json().at("max"), "inf");  // JSON has no infinity, and null would be read as nothing
  EXPECT_EQ(run("golden diff nan.exr nan.exr").status, 0);
}

TEST_F(GoldenDiffCli, BadInput) {
  generate("a", "--suite sqrt");
  write("x.exr", "no picture");
  refuses(2, "golden diff a x.exr", {"two sets"});
  refuses(2, "golden diff x.exr x.exr", {"x.exr"});
  refuses(2, "golden diff a a --heat-map h.png", {"--heat-map"});
  refuses(2, "golden diff a nowhere", {"nowhere"});
  write("a/sqrt/response.hex", "00\n");
  refuses(2, "golden diff a a", {"response.hex"});
}

}  // namespace
