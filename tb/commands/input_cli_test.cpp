// Input that is wrong or odd, as a user meets it: a clear reason, advice that works, and nothing overwritten.
#include "tb/commands/cli_fixture.hpp"

#include <sys/stat.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cstdlib>
#include <sstream>
#include <vector>

namespace {

using namespace quadrille::cli_test;
using nlohmann::json;

constexpr const char* bare_mesh = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n";
constexpr const char* mesh_with_vt =
    "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\nf 1 2 3 4\n";

TEST_F(Cli, SeedsThatDoNotFitAreRefused) {
  for (const char* command :
       {"render --scene bowtie --png a.png", "cosim --scene bowtie", "fragments --scene bowtie --out a",
        "sweep --out d", "golden generate --out d", "compare --scene bowtie --out d"})
    for (const char* seed : {"18446744073709551616", "99999999999999999999999", "1.5", "0x1g", "+"})
      refuses(2, std::string(command) + " --seed " + seed, {"--seed", "whole number from 0 to 18446744073709551615"});
  EXPECT_EQ(run("fragments --scene bowtie --size 16x16 --quiet --out a.csv --seed 18446744073709551615").status, 0);
}

TEST_F(Cli, TextureWithoutCoordinatesIsSaid) {
  write("bare.obj", bare_mesh);
  write("partly.obj", mesh_with_vt);
  const std::string options = " --size 32x32 --png a.png --no-error";
  for (const char* shade : {"texture", "uv"}) {
    const Outcome bare = run("render --mesh bare.obj --shade " + std::string(shade) + options);
    EXPECT_EQ(bare.status, 0);
    EXPECT_EQ(bare.err, "quadrille: bare.obj: no face has texture coordinates (vt); --shade " + std::string(shade) +
                            " puts the whole picture on each\n");
    EXPECT_NE(run("render --mesh partly.obj --shade " + std::string(shade) + options).err.find("1 of 2 faces have no"),
              std::string::npos);
  }
  EXPECT_EQ(run("render --mesh bare.obj --shade texture --quiet" + options).err, "");
  EXPECT_EQ(run("render --mesh bare.obj --shade normal" + options).err, "");
  EXPECT_EQ(run("render --scene sphere" + options).err, "");
}

// The same number in a file, in --set and, in the interfaces to other languages, in a text.
TEST_F(Cli, NumbersOfAConfigurationAreThoseOfToml) {
  const auto bits = [&](const std::string& arguments) {
    const Outcome outcome = run("config --quiet --json r.json " + arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return nlohmann::json::parse(read(file("r.json")))["config"]["significand_bits"].get<int>();
  };
  for (const std::string value : {"0x0c", "0b1100", "0o14", "+12", "1_2"}) {
    EXPECT_EQ(bits("--set significand_bits=" + value), 12) << value;
    write("c.toml", "significand_bits = " + value + "\n");
    EXPECT_EQ(bits("--config c.toml"), 12) << value;
  }
  for (const std::string value : {"012", "0X0c", "1e1", "12.0", "_12"}) {
    refuses(2, "config --set significand_bits=" + value,
            {"--set significand_bits", "TOML integer", "\"" + value + "\""});
    write("c.toml", "significand_bits = " + value + "\n");
    EXPECT_EQ(run("config --config c.toml").status, 2) << value;
  }
  EXPECT_EQ(run("sweep --scene bowtie --size 32x32 --cosim none --axis significand_bits=0x0c,18 --out d").status, 0);
}

TEST_F(Cli, AutoInConfigurationFiles) {
  write("c.toml", "attribute_frac_bits = 24\nquadratic_frac_bits = \"auto\"\n");
  write("d.toml", "attribute_frac_bits = \"auto\"\n");
  EXPECT_EQ(run("config --config c.toml").status, 0);
  EXPECT_EQ(run("config --config d.toml").out, run("config").out);
  write("bad.toml", "\nsignificand_bits = \"auto\"\n");
  refuses(2, "config --config bad.toml", {"bad.toml:2", "significand_bits", "auto", "8..26"});
  write("bad.toml", "significand_bits = \"automatic\"\n");
  refuses(2, "config --config bad.toml", {"bad.toml:1", "a string", "integer"});
  refuses(2, "config --set significand_bits=auto", {"significand_bits", "auto", "8..26"});
}

// The advice of the error, followed to the letter.
TEST_F(Cli, TheAdviceOnSizesWorks) {
  const auto advice = [&](const std::string& arguments) {
    const std::string text = run(arguments).err, mark = "for this size ";
    const std::size_t at = text.find(mark);
    return at == std::string::npos ? text : text.substr(at + mark.size(), text.find('\n') - at - mark.size());
  };
  for (const char* size : {"4097x1", "1x8193", "16384x1"}) {
    const std::string command = "fragments --quads q --out a.csv --quiet --size " + std::string(size);
    write("q", "0 0 0.5 1  1 0 0.5 1  1 1 0.5 1  0 1 0.5 1\n");
    EXPECT_EQ(run(command).status, 2);
    const std::string options = advice(command);
    EXPECT_TRUE(options.starts_with("--set viewport_bits=")) << options;
    EXPECT_EQ(run(command + " " + options).status, 0) << options;
    // Also from a configuration that leaves no room: homogeneous fraction bits of its own.
    const std::string full = command + " --set homogeneous_frac_bits=8 --set guard_bits=2";
    EXPECT_EQ(run(full + " " + advice(full)).status, 0) << advice(full);
  }
  refuses(2, "fragments --quads q --out a.csv --size 16385x4", {"1 to 4096", "viewport_bits = 12)\n"});
  // One that is too small is not cured by a larger viewport.
  for (const std::string size : {"0x0", "0x5", "640x0", "-1x5", "5x-1"}) {
    refuses(2, "fragments --quads q --out a.csv --size " + size, {"--size " + size, "must be at least 1"});
    EXPECT_EQ(run("fragments --quads q --out a.csv --size " + size).err.find("viewport_bits"), std::string::npos);
  }
}

TEST_F(Cli, ScissorsSayWhatIsWrong) {
  refuses(2, "render --scene bowtie --png a.png --scissor 9,0,3,5", {"--scissor 9,0,3,5", "X0 must not exceed X1"});
  refuses(2, "render --scene bowtie --png a.png --scissor 0,9,3,5", {"Y0 exceed Y1"});
  refuses(2, "render --scene bowtie --png a.png --scissor 0,0,600,5", {"inside the viewport 512x512"});
  refuses(2, "render --scene bowtie --png a.png --scissor -1,0,6,5", {"inside the viewport"});
}

TEST_F(Cli, HintsOnlyWhereSomethingIsNear) {
  for (const char* arguments :
       {"xyzzy", "render --scene cow --png a.png", "render --scene q --png a.png", "config --set colour_depth=3",
        "render --cull sideways --scene sphere --png a.png", "render --method photon --scene sphere --png a.png",
        "render --xyzzy", "sweep --target-error brightness=1 --out d", "golden generate --suite foo --out d"}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.err.find("did you mean"), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.err.find("nearest"), std::string::npos) << outcome.err;
  }
  refuses(2, "config --set signficand_bits=3", {"did you mean \"significand_bits\"", "quadrille config"});
  // Capitals, as the RTL's parameters have them, everywhere that a name is chosen.
  refuses(2, "config --set SIGNIFICAND_BITS=12", {"did you mean \"significand_bits\""});
  refuses(2, "sweep --scene bowtie --axis SIGNIFICAND_BITS=8:9 --out d", {"did you mean \"significand_bits\""});
  refuses(2, "render --scene SPHERE --png a.png", {"did you mean \"sphere\""});
  refuses(2, "RENDER", {"did you mean \"render\""});
  refuses(2, "render --scene fig10 --png a.png", {"did you mean \"fig10_"});
}

// Both found the name free; the first to finish has it.
TEST_F(Cli, TwoRunsIntoOneNewSet) {
  const std::string program = "'" QUADRILLE_PROGRAM "' golden generate --suite sqrt --limit 400000 --out set";
  write("both", program + " --seed 1 >/dev/null 2>e1 & a=$!\n" + program +
                    " --seed 2 >/dev/null 2>e2; second=$?\nwait $a; echo $? $second >statuses\n");
  const std::string line = "cd '" + file("").string() + "' && sh ./both";
  ASSERT_EQ(std::system(line.c_str()), 0);
  const std::string statuses = read(file("statuses"));
  EXPECT_TRUE(statuses == "0 2\n" || statuses == "2 0\n") << statuses;
  const std::string text = read(file("e1")) + read(file("e2"));
  EXPECT_NE(text.find("quadrille: set: "), std::string::npos) << text;
  EXPECT_NE(text.find("--force"), std::string::npos) << text;
  EXPECT_EQ(run("golden verify set --quiet").status, 0);
}

TEST_F(Cli, ReadOnlyFilesAndDanglingLinksStay) {
  write("kept.png", "kept");
  ASSERT_EQ(::chmod(file("kept.png").c_str(), 0444), 0);
  refuses(2, "render --scene bowtie --png kept.png", {"kept.png", "read-only"});
  EXPECT_EQ(read(file("kept.png")), "kept");
  fs::create_symlink("nowhere.json", file("link"));
  refuses(2, "config --json link", {"link", "symbolic link to nowhere.json"});
  EXPECT_FALSE(fs::exists(file("nowhere.json")));
  write("nowhere.json", "old");  // now it leads somewhere
  EXPECT_EQ(run("config --json link --quiet").status, 0);
  EXPECT_TRUE(fs::is_symlink(file("link")));
  EXPECT_TRUE(json::parse(read(file("nowhere.json"))).contains("config"));
}

TEST_F(Cli, OnlyFilesAndPipesAreRead) {
  ASSERT_EQ(::mkfifo(file("pipe").c_str(), 0600), 0);
  fs::create_directory(file("folder"));
  write("good.obj", bare_mesh);
  for (const char* option : {"--mesh ", "--quads ", "--mesh good.obj --camera ", "--scene bowtie --config ",
                             "--scene bowtie --shade texture --texture "}) {
    const std::string command = "render --png a.png --size 16x16 " + std::string(option);
    refuses(2, command + "/dev/zero", {"/dev/zero: cannot be read: it is a device"});
    refuses(2, command + "pipe", {"pipe: cannot be read: it is a named pipe"});
    refuses(2, command + "folder", {"folder: cannot be read: Is a directory"});
  }
  const Outcome piped =
      run("render --mesh /dev/fd/3 --png a.png --size 16x16 --quiet 3<&0", "(sleep 0.2; cat good.obj) | env");
  EXPECT_EQ(piped.status, 0) << piped.err;
}

TEST_F(Cli, ColonsInNames) {
  write("a:b.obj", "v 0 0 0\nf 1 2 3\n");
  refuses(2, "render --mesh a:b.obj --png a.png", {"quadrille: a:b.obj:2: face corner 2"});
  write("c:d.obj", bare_mesh);
  EXPECT_EQ(run("render --mesh c:d.obj --size 16x16 --png e:f.png --out g:h.exr --json i:j.json --quiet").status, 0);
  for (const char* name : {"e:f.png", "g:h.exr", "i:j.json"}) EXPECT_TRUE(fs::exists(file(name))) << name;
  // Nobody asked for a colon in these.
  EXPECT_EQ(run("compare --mesh c:d.obj --methods refine:4,mvc --reference refine:8 --size 32x32 --repeats 1 "
                "--crease-sizes 32 --quiet --out d")
                .status,
            0);
  for (const fs::directory_entry& entry : fs::directory_iterator(file("d")))
    EXPECT_EQ(entry.path().filename().string().find(':'), std::string::npos) << entry.path();
  EXPECT_TRUE(fs::exists(file("d/refine-4.exr")));
  EXPECT_EQ(json::parse(read(file("d/table.json")))["methods"][0]["method"], "refine:4");
}

TEST_F(Cli, OneInputIsOne) {
  const std::string text = run("bench --error --no-rtl --scene bowtie --size 32x32 --repeat 1").out;
  EXPECT_NE(text.find("\n1 input, "), std::string::npos) << text;
}

TEST_F(Cli, ScenesAsJson) {
  const std::string bare = run("scenes --json").out;
  EXPECT_EQ(json::parse(bare)[0].size(), 4u);
  EXPECT_EQ(run("scenes --json -").out, bare);
  const Outcome to_file = run("scenes --json s.json");
  EXPECT_EQ(to_file.status, 0);
  EXPECT_EQ(to_file.out, run("scenes").out);
  EXPECT_EQ(read(file("s.json")), bare);
  EXPECT_EQ(run("scenes --json --stress").out, run("scenes --stress --json -").out);
  EXPECT_EQ(json::parse(run("scenes --stress --json").out)[0].size(), 3u);
  refuses(2, "scenes --json no/s.json", {"no/s.json", "No such file"});
}

TEST_F(Cli, NoCreaseHasAReason) {
  // Quads of two pixels: no row of eight pixels lies in one.
  std::string fine;
  for (int y = 0; y <= 16; ++y)
    for (int x = 0; x <= 16; ++x) fine += "v " + std::to_string(x) + " " + std::to_string(y) + " 0\n";
  for (int y = 0; y < 16; ++y)
    for (int x = 1; x <= 16; ++x) {
      const int a = 17 * y + x;
      fine += "f " + std::to_string(a) + " " + std::to_string(a + 1) + " " + std::to_string(a + 18) + " " +
              std::to_string(a + 17) + "\n";
    }
  write("fine.obj", fine);
  write("one.obj", bare_mesh);
  const std::string options = " --methods mvc --reference refine:2 --size 40x40 --crease-sizes 40 --repeats 1 --out ";
  const std::string small = run("compare --mesh fine.obj --shade uv" + options + "a").out;
  EXPECT_NE(small.find("No crease: "), std::string::npos) << small;
  EXPECT_NE(small.find("too small"), std::string::npos);
  EXPECT_EQ(run("compare --mesh one.obj --shade uv" + options + "b").out.find("No crease"), std::string::npos);
}

// The user's sources are input: 2. A missing tool is not: 3.
TEST_F(Cli, BadRtlIsAnInputError) {
  fs::create_directory(file("empty"));
  refuses(2, "cosim --scene bowtie --rtl empty", {"--rtl empty", "no quadrille.sv in this directory"});
  write("bad.v", "module quadrille(input clk\n");
  refuses(2, "cosim --scene bowtie --rtl bad.v", {"--rtl bad.v: ", "bad.v:", "syntax error"});
  EXPECT_EQ(run("cosim --scene bowtie --rtl bad.v", "PATH=/nowhere").status, 3);
}

/// A method instead of an engine, on every kind of input. Expected by hand: split02 draws a square from 0 to 16 as the
/// triangles 0 1 2 and 0 2 3, each with its barycentric coordinates.
TEST_F(Cli, FragmentsByAMethod) {
  write("square.quads", "0 0 0.5 1  16 0 0.5 1  16 16 0.5 1  0 16 0.5 1\n");
  const std::string fragments = "fragments --method split02 --size 16x16 --quiet --out - ";
  const Outcome outcome = run(fragments + "--quads square.quads --json f.json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::istringstream lines(outcome.out);
  std::string line;
  std::getline(lines, line);
  int rows = 0;
  for (; std::getline(lines, line); ++rows) {
    std::istringstream cells(line);
    std::vector<double> v;
    for (std::string cell; std::getline(cells, cell, ',');) v.push_back(std::strtod(cell.c_str(), nullptr));
    ASSERT_GE(v.size(), 9u);
    const double x = (v[1] + 0.5) / 16, y = (v[2] + 0.5) / 16;
    const std::array<double, 4> wanted = x >= y ? std::array{1 - x, x - y, y, 0.0} : std::array{1 - y, 0.0, x, y - x};
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(v[5 + i], wanted[i], 1e-14) << line;
  }
  EXPECT_EQ(rows, 16 * 16);
  const json report = json::parse(read(file("f.json")));
  EXPECT_EQ(report.at("method"), "split02");
  EXPECT_FALSE(report.contains("engine"));
  // One quad of a mesh for a method that looks at the object: the same as that quad among all.
  write("m.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0.3\nv 0 1 0\nv 2 0 0\nv 2 1 0\nf 1 2 3 4\nf 2 5 6 3\n");
  const std::string adaptive = "fragments --method adaptive --mesh m.obj --size 48x48 --quiet --out ";
  ASSERT_EQ(run(adaptive + "all.csv").status, 0);
  ASSERT_EQ(run(adaptive + "one.csv --quad 1").status, 0);
  const std::string all = read(file("all.csv")), one = read(file("one.csv"));
  const std::size_t first = one.find("\n1,");
  ASSERT_NE(first, std::string::npos);
  ASSERT_NE(all.find("\n1,"), std::string::npos);
  EXPECT_EQ(all.substr(all.find("\n1,")), one.substr(first));
  for (const char* input : {"--scene bowtie", "--stress eye_crossing --count 3", "--corner face_plane"})
    EXPECT_EQ(run(fragments + input).status, 0) << input;
  refuses(2, fragments + "--quads square.quads --errors", {"--errors", "--method"});
  refuses(2, fragments + "--quads square.quads --engine truth", {"--method"});
  refuses(2, "fragments --method splt02 --quads square.quads --out -", {"splt02", "did you mean \"split02\""});
}

}  // namespace
