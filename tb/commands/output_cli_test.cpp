// What a command writes and says: the format that a name promises, and what was written where.
#include "tb/commands/cli_fixture.hpp"

#include <regex>
#include <set>

namespace {

using namespace quadrille::cli_test;

// Whatever option of whatever command names a file in its help is tried, so that a new one cannot be forgotten.
TEST_F(Cli, AFileHasTheFormatOfItsName) {
  const std::set<std::string> inputs{"--config", "--mesh", "--camera", "--quads", "--texture", "--kept"};
  const std::regex option(R"((--[a-z-]+) \[?(F\.([a-z]+)|DIR)\b)");
  std::size_t tried = 0;
  for (const std::string command :
       {"cosim", "render", "fragments", "config", "scenes", "bench", "sweep", "compare", "stress", "cache", "export",
        "golden generate", "golden merge", "golden verify", "golden diff"}) {
    const std::string help = run(command + " --help").out;
    for (std::sregex_iterator match(help.begin(), help.end(), option), end; match != end; ++match) {
      const std::string name = (*match)[1], ending = (*match)[3];
      if (inputs.contains(name)) continue;
      ++tried;
      for (const std::string other : {"png", "exr", "JPG", "json", "csv", "quads", "parquet"}) {
        if (other == ending) continue;
        std::vector<std::string> pieces{name, "x." + other + ": "};
        if (!ending.empty()) pieces.push_back("such as x." + ending);
        refuses(2, command + " " + name + " x." + other, pieces);
        EXPECT_FALSE(fs::exists(file("x." + other)));
      }
    }
  }
  EXPECT_GE(tried, 25u);
  refuses(2, "render --scene bowtie --out p.png", {"--out", "writes OpenEXR", "or --png for PNG"});
  refuses(2, "render --scene bowtie --png p.exr", {"--png", "writes PNG", "or --out for OpenEXR"});
  refuses(2, "render --scene bowtie --png p.jpeg", {"JPEG", "such as p.png"});
}

TEST_F(Cli, ANameThatPromisesNothingIsTaken) {
  for (const char* name : {"p.PNG", "p", "p.1", "p.tmp"})
    EXPECT_EQ(run(std::string("render --scene bowtie --size 32x32 --no-error --quiet --png ") + name).status, 0)
        << name;
}

TEST_F(Cli, RenderSaysWhatItWrote) {
  const Outcome outcome = run("render --scene bowtie --size 32x32 --out p.exr --png p.png --json r.json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  for (const char* name : {"p.exr", "p.png", "r.json"})
    EXPECT_NE(outcome.out.find("\nwrote " + std::string(name) + "\n"), std::string::npos) << outcome.out;
  EXPECT_EQ(run("render --scene bowtie --size 32x32 --png p.png --quiet").out, "");
  EXPECT_EQ(run("render --scene bowtie --size 32x32 --png p.png").out.find("p.exr"), std::string::npos);
}

// Latin-1, as older file systems have it.
TEST_F(Cli, AFileNameNeedNotBeUtf8) {
  const std::string name = "caf\xe9.quads";
  write(name, good_quad);
  for (const std::string command : {"render --size 64x64 --png p.png", "fragments --size 64x64 --out f.csv",
                                    "golden generate --size 64x64 --out set",
                                    "sweep --axis significand_bits=12,18 --size 64x64 --cosim none --out d",
                                    "bench --skips --size 64x64 --repeat 1"}) {
    SCOPED_TRACE(command);
    const Outcome outcome = run(command + " --quiet --json r.json --quads '" + name + "'");
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const std::string report = read(file("r.json"));
    EXPECT_NE(report.find(R"($'caf\\xe9.quads')"), std::string::npos) << report.substr(0, 2000);  // JSON's \\ is one
  }
}

TEST_F(Cli, NotesOfAMesh) {
  write("m.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nusemtl dir\\sub\\\nf 1 2 3 4\nf 4 3 2 1\n");
  for (const char* command : {"render --png p.png", "fragments --out f.csv", "golden generate --out set",
                              "compare --repeats 1 --methods mvc --crease-sizes 64 --out d",
                              "sweep --axis significand_bits=12,18 --cosim none --out s", "bench --skips --repeat 1"}) {
    const Outcome outcome = run(std::string(command) + " --mesh m.obj --size 64x64");
    EXPECT_EQ(outcome.status, 0) << command << outcome.err;
    EXPECT_NE(outcome.err.find("m.obj: line 6, 'f', is not read: the backslash that ends line 5"), std::string::npos)
        << command << ": " << outcome.err;
  }
}

TEST_F(Cli, ConcaveFacesAreCounted) {
  // An L from the end of an arm, where a fan would paint outside.
  write("l.obj", "v 0 0 0\nv 3 0 0\nv 3 1 0\nv 1 1 0\nv 1 3 0\nv 0 3 0\nf 2 3 4 5 6 1\nf 3 4 5 6 1 2\n");
  const Outcome outcome = run("render --mesh l.obj --view front --size 64x64 --png p.png");
  EXPECT_NE(outcome.out.find("2 faces with more than four corners were cut into 4 primitives"), std::string::npos)
      << outcome.out;
  write("star.obj", "v 0 3 0\nv 2 -3 0\nv -3 1 0\nv 3 1 0\nv -2 -3 0\nf 1 2 3 4 5\n");
  const Outcome star = run("render --mesh star.obj --view front --size 64x64 --png p.png");
  EXPECT_NE(star.out.find("1 of these faces"), std::string::npos) << star.out;
}

TEST_F(Cli, AttributesHaveNames) {
  const auto head = [&](const std::string& arguments) {
    const Outcome outcome = run("fragments --size 16x16 --out - " + arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out.substr(0, outcome.out.find('\n'))
        .substr(std::string("quad,x,y,front,flags,l0,l1,l2,l3,z").size());
  };
  EXPECT_EQ(head("--scene sphere --shade uv"), ",u,v");
  EXPECT_EQ(head("--scene phong_mesh --shade normal"), ",nx,ny,nz");
  EXPECT_EQ(head("--scene sphere --shade planes"), ",px,py,pz");
  EXPECT_EQ(head("--scene sphere --shade depth"), "");
  EXPECT_EQ(head("--stress general"), ",a0,a1,a2,a3");
  const Outcome errors = run("fragments --size 16x16 --out - --scene sphere --shade uv --errors");
  EXPECT_NE(errors.out.find(",v,"), std::string::npos) << errors.err;
}

TEST_F(Cli, ArraysForNumpy) {
  ASSERT_EQ(run("fragments --scene sphere --size 32x24 --out f.npz --quiet").status, 0);
  ASSERT_EQ(run("render --scene sphere --size 32x24 --out r.npz --quiet").status, 0);
  write("read.py",
        "import io, sys, zipfile\n"
        "for path, names in (('f.npz', ['quad', 'u', 'z']), ('r.npz', ['Z', 'quad', 'error.L0'])):\n"
        "    archive = zipfile.ZipFile(path)\n"
        "    assert archive.testzip() is None, path\n"
        "    missing = [n for n in names if n + '.npy' not in archive.namelist()]\n"
        "    assert not missing, (path, missing)\n");
  EXPECT_EQ(std::system(("cd '" + file("").string() + "' && python3 read.py").c_str()), 0);
  refuses(2, "fragments --scene sphere --errors --out e.npz", {"--errors writes CSV", "e.csv"});
  refuses(2, "fragments --scene sphere --out e.exr", {"e.exr", "CSV or NumPy arrays, not OpenEXR", "e.csv"});
  refuses(2, "render --scene sphere --out e.csv", {"OpenEXR or NumPy arrays, not CSV", "e.exr"});
}

TEST_F(Cli, EmptyValuesAreRefused) {
  for (const char* command : {"fragments --scene bowtie --size 32x32 --out - --pixel",
                              "render --scene bowtie --size 32x32 --png a.png --scissor",
                              "render --scene bowtie --size 32x32 --png a.png --znear",
                              "sweep --scene bowtie --out s --objective", "explain --pixel 3,3 --scene"})
    refuses(2, std::string(command) + " ''",
            {"empty", std::string(command).substr(std::string(command).rfind(' ') + 1)});
}

TEST_F(Cli, OptionsOfAnotherInputAreRefused) {
  refuses(2, "render --scene bowtie --count 5 --png a.png", {"--count needs --stress"});
  refuses(2, "render --scene bowtie --strict --png a.png", {"--strict needs --mesh"});
  refuses(2, "render --scene bowtie --merge-pairs --png a.png", {"--merge-pairs needs --mesh"});
}

}  // namespace
