// quadrille compare and render --method, run as a user does.
#include "golden/io/png.hpp"
#include "tb/commands/cli_fixture.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdint>
#include <set>
#include <sstream>

namespace {

using namespace quadrille::cli_test;
using nlohmann::json;

class CompareCli : public Cli {
 protected:
  json table(const std::string& arguments, const std::string& out = "d") const {
    const Outcome outcome = run("compare --repeats 1 --quiet --out " + out + " " + arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.out + outcome.err, "");
    return json::parse(read(file(out + "/table.json")));
  }
  static json row(const json& table, const std::string& method) {
    for (const json& r : table.at("methods"))
      if (r.at("method") == method) return r;
    ADD_FAILURE() << method;
    return {};
  }
};

// mvc computes what "wrong" is measured against: its nearness is no finding, and is said to be none.
TEST_F(CompareCli, WhatIsExactIsNamed) {
  const Outcome outcome = run("compare --repeats 1 --scene fig10_convex --size 64x64 --methods mvc,split02 --out d");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("from exact MV"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("above 0.001 from exact mean value"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("by definition"), std::string::npos) << outcome.out;
  const std::string markdown = read(file("d/table.md"));
  EXPECT_NE(markdown.find("from exact mean value"), std::string::npos) << markdown;
  for (const std::string& text : {outcome.out, markdown})
    EXPECT_EQ(text.find("truth"), std::string::npos) << "whose truth? " << text;
}

TEST_F(CompareCli, EveryMethodDrawsAndIsWritten) {
  const json report = table("--scene fig10_convex --size 64x64");
  std::set<std::string> names;
  for (const json& r : report.at("methods")) {
    const std::string name = r.at("method");
    names.insert(name);
    EXPECT_GT(r.at("covered"), 1000) << name;
    EXPECT_EQ(r.at("missing"), 0) << name;
    std::string picture = name + ".exr";
    std::ranges::replace(picture, ':', '-');
    EXPECT_GT(fs::file_size(file("d/" + picture)), 4 * r.at("covered").get<std::uintmax_t>());
  }
  EXPECT_EQ(names, (std::set<std::string>{"mvc", "split02", "split13", "triangle", "twofold", "projective", "bilinear",
                                          "refine:20", "adaptive", "hybrid:pixels", "hybrid:ndc", "affine"}));
  EXPECT_EQ(read(file("d/sheet.png")).substr(1, 3), "PNG");
  // The same rows and columns in CSV, a line a method in Markdown.
  std::istringstream csv(read(file("d/table.csv")));
  std::string line;
  std::getline(csv, line);
  std::size_t columns = 0;
  for (const auto& [key, value] : report["methods"][0].items()) columns += !key.empty();
  EXPECT_EQ(static_cast<std::size_t>(std::count(line.begin(), line.end(), ',')), columns - 1);
  std::size_t lines = 0;
  for (; std::getline(csv, line); ++lines)
    EXPECT_EQ(static_cast<std::size_t>(std::count(line.begin(), line.end(), ',')), columns - 1);
  EXPECT_EQ(lines, names.size());
  const std::string markdown = read(file("d/table.md"));
  EXPECT_EQ(static_cast<std::size_t>(std::count(markdown.begin(), markdown.end(), '\n')), names.size() + 2);
}

// The claim of the papers: the crease of a split stays, that of mean value coordinates halves with every doubling.
TEST_F(CompareCli, CreaseOfASplitStaysAndOfMeanValueCoordinatesHalves) {
  const json report = table("--scene fig10_convex --methods split02,split13,mvc --crease-sizes 128,256,512");
  const json split02 = row(report, "split02"), split13 = row(report, "split13"), mvc = row(report, "mvc");
  for (const auto& [diagonal, split] : {std::pair{"crease02_", &split02}, std::pair{"crease13_", &split13}}) {
    const auto at = [d = std::string(diagonal)](const json& r, int size) {
      return r.at(d + std::to_string(size)).get<double>();
    };
    // From pixel to pixel a crease may fall between two changes of the slope; the fit has all of it.
    const std::string fit = diagonal + std::string("fit_");
    EXPECT_NEAR(split->at(fit + "512").get<double>() / split->at(fit + "128").get<double>(), 1, 0.05);
    EXPECT_NEAR(at(mvc, 128) / at(mvc, 256), 2, 0.15);
    EXPECT_NEAR(at(mvc, 256) / at(mvc, 512), 2, 0.15);
    EXPECT_GE(at(*split, 512), 100 * at(mvc, 512));
  }
  // Each split is smooth across the other diagonal.
  EXPECT_LT(split02.at("crease13_512"), 0.1 * split13.at("crease13_512").get<double>());
}

// The scissor is of the picture's size, which creases are not measured at.
TEST_F(CompareCli, CreasesAreOfWholeQuads) {
  const std::string arguments = "--scene fig10_convex --size 64x64 --methods split02 --crease-sizes 32,64";
  json whole = row(table(arguments), "split02");
  json part = row(table(arguments + " --scissor 5,5,50,50", "e"), "split02");
  EXPECT_GT(whole.at("covered"), part.at("covered"));
  for (const char* crease : {"crease02_32", "crease02_64"}) {
    EXPECT_GT(whole.at(crease), 0);
    EXPECT_EQ(whole.at(crease), part.at(crease)) << crease;
  }
}

TEST_F(CompareCli, AgainstTheTruthAndTheReference) {
  const json report = table("--scene sphere --size 96x96 --methods mvc,hybrid,split02,projective,affine,refine:20");
  EXPECT_LT(row(report, "mvc").at("truth_max"), 1e-9);
  EXPECT_EQ(row(report, "refine:20").at("reference_max"), 0);
  EXPECT_GT(row(report, "hybrid").at("truth_max"), 1e-9) << "single precision";
  EXPECT_GT(row(report, "split02").at("truth_rms"), 1e-3);
  // 32 quads have a collapsed edge: the projective map refuses them.
  EXPECT_EQ(row(report, "projective").at("refused"), 32);
  EXPECT_GT(row(report, "projective").at("other_quad"), 0) << "where they are missing the far side shows";
  EXPECT_EQ(row(report, "mvc").at("quads"), 128);
  EXPECT_EQ(row(report, "refine:20").at("emitted_quads"), 128 * 400);
}

TEST_F(CompareCli, UndefinedPixelsAreCounted) {
  const json a = table("--scene bloomenthal14_a --size 64x64 --methods bilinear,mvc", "a"),
             b = table("--scene bloomenthal14_b --size 64x64 --methods bilinear,mvc", "b"),
             c = table("--scene bloomenthal14_c --size 64x64 --methods bilinear,mvc", "c");
  const auto share = [](const json& report) {
    const json r = row(report, "bilinear");
    return r.at("undefined").get<double>() / r.at("covered").get<double>();
  };
  EXPECT_GT(share(a), 0);
  EXPECT_GT(share(b), share(a));
  EXPECT_GT(share(c), share(b));
  EXPECT_EQ(row(c, "mvc").at("undefined"), 0);
}

TEST_F(CompareCli, QuadsEmittedFollowTheProjectedArea) {
  std::uint64_t before = 0;
  for (const char* area : {"197", "795", "3051", "11879", "33600"}) {
    const json report = table(std::string("--methods adaptive --scene oliveira13_") + area, area);
    const std::uint64_t emitted = row(report, "adaptive").at("emitted_quads");
    if (before == 0) {
      EXPECT_EQ(emitted, 1u) << "197 pixels are below the 200 of the paper";
    }
    EXPECT_GT(emitted, before) << area;
    before = emitted;
  }
}

TEST_F(CompareCli, SameBytesForAnyNumberOfThreads) {
  table("--scene bowtie --size 48x48 --methods mvc,hybrid --wireframe --threads 1", "a");
  table("--scene bowtie --size 48x48 --methods mvc,hybrid --wireframe --threads 3", "b");
  for (const char* name : {"mvc.exr", "hybrid.exr", "sheet.png"})
    EXPECT_EQ(read(file(std::string("a/") + name)), read(file(std::string("b/") + name))) << name;
  // Of the tables everything but the command and the times.
  json a = json::parse(read(file("a/table.json"))), b = json::parse(read(file("b/table.json")));
  for (json* report : {&a, &b}) {
    report->erase("command");
    for (json& r : report->at("methods")) r.erase("ns_per_pixel");
  }
  EXPECT_EQ(a, b);
}

/// The sheet holds the crop's pixels as blocks of --zoom, with the colours that `render` gives.
TEST_F(CompareCli, CropAndZoom) {
  const std::string scene = "--scene fig10_concave --size 64x64 ";
  table(scene + "--methods split02,mvc --crop 20,24,44,40 --zoom 5");
  ASSERT_EQ(run("render --quiet --method split02 " + scene + "--png whole.png").status, 0);
  const quadrille::golden::Image8 whole = quadrille::golden::load_png(file("whole.png")),
                                  sheet = quadrille::golden::load_png(file("d/sheet.png"));
  const auto at = [](const quadrille::golden::Image8& image, int x, int y) {
    const auto first = image.rgba.begin() + (static_cast<std::ptrdiff_t>(y) * image.width + x) * 4;
    return std::vector<std::uint8_t>(first, first + 3);
  };
  int found = 0;
  for (int oy = 0; oy + 16 * 5 <= sheet.height; ++oy)
    for (int ox = 0; ox + 24 * 5 <= sheet.width; ++ox) {
      bool same = true;
      for (int y = 0; y < 16 * 5 && same; ++y)
        for (int x = 0; x < 24 * 5 && same; ++x) same = at(sheet, ox + x, oy + y) == at(whole, 20 + x / 5, 24 + y / 5);
      found += same;
    }
  EXPECT_EQ(found, 1);
}

/// A wireframe has a row of its own: all rows above are those of a sheet without.
TEST_F(CompareCli, WireframesLeaveThePictures) {
  const std::string options = "--scene fig10_convex --size 64x64 --methods split02,refine:8 --crease-sizes 64 ";
  table(options, "plain");
  table(options + "--wireframe", "mesh");
  const quadrille::golden::Image8 plain = quadrille::golden::load_png(file("plain/sheet.png")),
                                  mesh = quadrille::golden::load_png(file("mesh/sheet.png"));
  ASSERT_EQ(plain.width, mesh.width);
  EXPECT_GE(mesh.height, plain.height + 256);
  const auto differs = std::ranges::mismatch(plain.rgba, mesh.rgba).in1 - plain.rgba.begin();
  constexpr int legend = 120, rows = 4 * 256;
  EXPECT_GT(differs / 4 / plain.width, rows);
  EXPECT_GT(differs / 4 / plain.width, plain.height - legend);
}

TEST_F(CompareCli, OddShapesGiveASheet) {
  for (const char* size : {"1x512", "512x1", "3x2"})
    table(std::string("--scene fig1_flat --methods mvc,split02 --size ") + size, size);
  const json depth = table("--scene fig1_flat --size 32x32 --shade depth --methods projective,mvc");
  EXPECT_EQ(depth.at("differences_of"), "window depth");
}

TEST_F(CompareCli, Plot) {
  table("--scene fig1_flat --size 32x32 --methods mvc --plot");
  const json plot = json::parse(read(file("d/plot.json")));
  EXPECT_EQ(plot.at("reference"), "refine:200");
  EXPECT_EQ(plot.at("curves").size(), 11u);
  for (const json& curve : plot.at("curves")) {
    EXPECT_FALSE(curve.at("points").empty());
    for (const json& point : curve["points"]) EXPECT_GT(point.at("seconds"), 0) << curve["method"];
  }
  // More cells are nearer to the limit.
  const json refine = plot["curves"][7];
  ASSERT_EQ(refine.at("method"), "refine");
  EXPECT_LT(refine["points"][5].at("error_rms"), 0.1 * refine["points"][2].at("error_rms").get<double>());
  for (const char* name : {"d/plot_time.png", "d/plot_setup.png"}) EXPECT_EQ(read(file(name)).substr(1, 3), "PNG");
}

// The projective map is linear in its own square, not on the edges: neighbours disagree there.
TEST_F(CompareCli, GapsBetweenNeighbours) {
  write("m.obj",
        "v 0.3 0 0\nv 1 0.2 0\nv 1 1 0\nv 0 1.4 0\nv 2 0.5 0\nv 1.6 0.8 0\n"
        "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 2 0\nvt 2 1\nf 1/1 2/2 3/3 4/4\nf 2/2 5/5 6/6 3/3\n");
  const json report = table("--mesh m.obj --size 128x128 --shade uv --methods mvc,split02,projective");
  for (const char* exact : {"mvc", "split02"}) {
    EXPECT_GT(row(report, "projective").at("gap_max"), 100 * row(report, exact).at("gap_max").get<double>()) << exact;
    EXPECT_EQ(row(report, exact).at("gap_pixels"), 0);
  }
}

TEST_F(CompareCli, PlotOfMethodsThatDrawNothing) {
  table("--scene bloomenthal14_b --size 32x32 --methods mvc --plot --crease-sizes 32");
  const json plot = json::parse(read(file("d/plot.json")));
  for (const json& curve : plot.at("curves"))
    for (const json& point : curve.at("points"))
      EXPECT_EQ(point.at("error_rms").is_null(), point.at("compared") == 0) << point;
  EXPECT_EQ(plot["curves"][4].at("method"), "twofold");
  EXPECT_EQ(plot["curves"][4]["points"][0].at("compared"), 0) << "refuses a vertex behind the eye";
}

TEST_F(CompareCli, MeshesAndRenderByMethod) {
  write("m.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0.3\nv 0 1 0\nv 2 0 0\nv 2 1 0\nf 1 2 3 4\nf 2 5 6 3\n");
  const json report = table("--mesh m.obj --size 48x48 --shade uv --methods mvc,affine,adaptive");
  EXPECT_EQ(row(report, "mvc").at("quads"), 2);
  EXPECT_EQ(
      run("render --method split13 --mesh m.obj --shade lambda --size 48x48 --quiet --png m.png --out m.exr").status,
      0);
  EXPECT_GT(fs::file_size(file("m.exr")), 1000u);
}

/// Quads that were never an object in space. Expected values by hand: the square's centre is a pixel's; there mean
/// value coordinates give 0, 1, 0, 1 at the corners 1/2, and the diagonal of split02, whose ends have 0, gives 0.
TEST_F(CompareCli, QuadsOfAFile) {
  write("small.quads", "4 4 0.5 1  37 4 0.5 1  37 37 0.5 1  4 37 0.5 1  0 1 0 1\n");
  write("large.quads", "8 8 0.5 1  74 8 0.5 1  74 74 0.5 1  8 74 0.5 1  0 1 0 1\n");
  const json small = table("--quads small.quads --size 48x48 --crease-sizes 48,96", "small");
  EXPECT_EQ(small.at("methods").size(), 10u) << "all but adaptive and affine";
  EXPECT_EQ(row(small, "split02").at("covered"), 33 * 33);
  EXPECT_NEAR(row(small, "split02").at("truth_max").get<double>(), 0.5, 1e-12);
  EXPECT_LT(row(small, "mvc").at("truth_max").get<double>(), 1e-12);
  // At another size the same picture, scaled.
  const json large = table("--quads large.quads --size 96x96 --crease-sizes 96 --methods split02", "large");
  const double crease = row(small, "split02").at("crease02_96").get<double>();
  EXPECT_GT(crease, 0.5);
  EXPECT_NEAR(crease, row(large, "split02").at("crease02_96").get<double>(), 1e-9);
  // What looks at an object in space is refused by name; the plot leaves it out.
  refuses(2, "compare --quads small.quads --size 48x48 --methods mvc,affine --out r", {"affine", "object space"});
  EXPECT_FALSE(fs::exists(file("r")));
}

/// Families and corner groups, with vertices behind the eye and at infinity.
TEST_F(CompareCli, FamiliesAndCornerGroups) {
  for (const std::string input :
       {"--stress eye_crossing --count 3", "--stress any_w --count 3", "--corner face_plane"}) {
    const json report = table(input + " --size 32x32 --methods split02,mvc --crease-sizes 32", "f");
    EXPECT_GT(row(report, "mvc").at("covered"), 20) << input;
    EXPECT_LT(row(report, "mvc").at("truth_rms").get<double>(), 1e-6) << input;
  }
}

TEST_F(CompareCli, BadInput) {
  std::string many;  // sixteen methods that differ
  for (int n = 1; n <= 16; ++n) many += (n > 1 ? ",refine:" : "refine:") + std::to_string(n);
  refuses(2, "compare --scene fig1_flat", {"--out"});
  refuses(2, "compare --out d", {"--scene NAME, --mesh F.obj, --quads F.quads"});
  refuses(2, "compare --scene fig1_flat --out d --methods mvc,splt02", {"splt02", "did you mean \"split02\""});
  refuses(2, "compare --scene fig1_flat --out d --methods mvc,mvc", {"mvc", "twice"});
  refuses(2, "compare --scene fig1_flat --out d --methods refine:20,refine", {"refine", "twice"});
  refuses(2, "compare --scene fig1_flat --out d --cell 2048 --methods " + many, {"16 columns", "--cell 2048"});
  refuses(2, "compare --scene fig1_flat --out d --crop 0,0,600,10", {"--crop", "X1 <= 512"});
  refuses(2, "compare --scene fig1_flat --out d --crop 9,0,9,10", {"--crop", "X0 < X1"});
  refuses(2, "compare --scene fig1_flat --out d --crop 9,0,9", {"--crop"});
  refuses(2, "compare --scene fig1_flat --out d --zoom 4 --cell 100", {"--zoom", "--cell"});
  refuses(2, "compare --scene fig1_flat --size 64x64 --crop 0,0,64,64 --out d --zoom 64",
          {"--zoom 64", "4096", "--crop"});
  refuses(2, "compare --scene fig1_flat --out d --methods refine:0", {"refine:0", "1 to 1000"});
  refuses(2, "compare --scene fig1_flat --out d --methods mvc:3", {"mvc has no knob"});
  refuses(2, "compare --scene fig1_flat --out d --reference nothing", {"--reference", "nothing"});
  refuses(2, "compare --scene fig1_flat --out d --crease-sizes 4", {"--crease-sizes", "16 to 4096"});
  refuses(2, "compare --scene fig1_flat --out d --shade colour", {"colour"});
  EXPECT_FALSE(fs::exists(file("d"))) << "nothing is written before the input is known to be good";
  // Nothing of a run that fails appears, and nothing of an earlier one is lost.
  table("--scene fig1_flat --size 24x24 --methods mvc,split02 --crease-sizes 24", "e");
  const std::string before = read(file("e/table.json"));
  fs::remove(file("e/table.csv"));
  fs::create_directory(file("e/table.csv"));
  refuses(2, "compare --scene fig1_flat --size 24x24 --methods mvc --crease-sizes 24 --repeats 1 --quiet --out e",
          {"table.csv", "is a directory"});
  EXPECT_EQ(read(file("e/table.json")), before);
  EXPECT_TRUE(fs::exists(file("e/split02.exr")));
  fs::remove(file("e/table.csv"));
  table("--scene fig1_flat --size 24x24 --methods mvc --crease-sizes 24", "e");
  EXPECT_FALSE(fs::exists(file("e/split02.exr"))) << "of the earlier run";
  for (const fs::directory_entry& entry : fs::directory_iterator(file("e")))
    EXPECT_EQ(entry.path().filename().string().find(".staged"), std::string::npos) << "the stage is gone";
  write("f", "kept");
  refuses(2, "compare --scene fig1_flat --out f", {"f", "directory"});
  EXPECT_EQ(read(file("f")), "kept");
  refuses(2, "render --method adaptive --stress general --count 3 --png x.png", {"adaptive", "object space"});
  refuses(2, "render --method mvc --engine truth --scene fig1_flat --png x.png", {"--method"});
}

}  // namespace
