// Cameras and light of a mesh as a user gives them: what is seen, where it lies, how bright it is, and the saved
// camera.
#include "golden/io/png.hpp"
#include "tb/commands/cli_fixture.hpp"

#include <algorithm>

namespace {

using namespace quadrille::cli_test;

class ViewOptions : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    // A box, longest along z, with a foot that sticks out towards +x at its -z end: no two sides look alike.
    write("box.obj",
          "v -1 -1 -2\nv 1 -1 -2\nv 1 1 -2\nv -1 1 -2\nv -1 -1 2\nv 1 -1 2\nv 1 1 2\nv -1 1 2\nv 3 -1 -2\nv 3 1 -2\n"
          "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\nf 2 9 10 3\n");
  }

  /// The largest channel of the brightest pixel, and the box around everything that is not background (56, 56, 59).
  struct Seen {
    int brightest = 0, left = 1000, right = -1, top = 1000, bottom = -1;
    int width() const { return right - left; }
    int height() const { return bottom - top; }
  };
  Seen look(const std::string& options) const {
    SCOPED_TRACE(options);
    const Outcome outcome = run("render --mesh box.obj --size 96x96 --png v.png --quiet " + options);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const auto picture = quadrille::golden::load_png(file("v.png").string());
    Seen seen;
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x) {
        const std::uint8_t* p = &picture.rgba[static_cast<std::size_t>(y * picture.width + x) * 4];
        if (p[0] == 56 && p[1] == 56 && p[2] == 59) continue;
        seen.brightest = std::max<int>(seen.brightest, *std::max_element(p, p + 3));
        seen.left = std::min(seen.left, x), seen.right = std::max(seen.right, x);
        seen.top = std::min(seen.top, y), seen.bottom = std::max(seen.bottom, y);
      }
    return seen;
  }
};

TEST_F(ViewOptions, NoSideIsDark) {
  for (const char* view : {"front", "back", "left", "right", "top", "bottom", "-z", "+x", "1,-2,-0.5"})
    for (const char* up : {"y", "z", "-z", "x", "0.1,1,0.3"})
      EXPECT_GT(look(std::string("--view ") + view + " --up " + up).brightest, 150) << view << " " << up;
  EXPECT_GT(look("--up z").brightest, 150);
  write("behind.json",
        R"({"eye": [0, 0, -9], "target": [0, 0, 0], "up": [0, 1, 0], "fovy": 40, "near": 1, "far": 20})");
  EXPECT_GT(look("--camera behind.json").brightest, 150);
  // A light that is asked for stays where it is: the side away from it has the ambient part alone.
  EXPECT_LT(look("--view back --light z").brightest, 40);
  EXPECT_GT(look("--view back --light -z").brightest, 150);
  EXPECT_LT(look("--camera behind.json --light z").brightest, 40);
}

TEST_F(ViewOptions, SidesAreWhatTheySay) {
  // Up is y: from the front 4 wide (the foot) and 2 high, from the right 4 wide, from the top 4 wide and 4 high.
  const Seen front = look("--view front"), right = look("--view right"), top = look("--view top");
  EXPECT_GT(front.width(), front.height() * 3 / 2);
  EXPECT_GT(right.width(), right.height() * 3 / 2);
  EXPECT_LT(std::abs(top.width() - top.height()), 12);
  // Up is z: the front is -y, and shows the long side upright.
  const Seen z_up = look("--up z --view front");
  EXPECT_GT(z_up.height(), front.height() * 3 / 2);
  EXPECT_EQ(look("--view z").width(), front.width());
}

TEST_F(ViewOptions, ASavedCameraDrawsTheSameBytes) {
  for (const char* view : {"", "--view -z", "--view top --up z", "--view 1,2,-3 --up 0.1,0,1"}) {
    SCOPED_TRACE(view);
    const std::string size = " --mesh box.obj --size 80x60 --quiet ";
    ASSERT_EQ(run("render --png a.png --out a.exr --save-camera c.json" + size + view).status, 0);
    ASSERT_EQ(run("render --png b.png --out b.exr --camera c.json --save-camera d.json" + size).status, 0);
    EXPECT_EQ(read(file("a.png")), read(file("b.png")));
    EXPECT_EQ(read(file("a.exr")), read(file("b.exr")));
    EXPECT_EQ(read(file("c.json")), read(file("d.json")));
  }
}

TEST_F(ViewOptions, EveryCommandThatTakesAMesh) {
  const std::string view = " --mesh box.obj --view back --up z --save-camera ";
  ASSERT_EQ(run("render --size 48x48 --png r.png --quiet" + view + "render.json").status, 0);
  ASSERT_EQ(run("fragments --size 48x48 --out f.csv --quiet" + view + "fragments.json").status, 0);
  ASSERT_EQ(
      run("sweep --size 48x48 --axis significand_bits=12 --cosim none --out s --quiet" + view + "sweep.json").status,
      0);
  ASSERT_EQ(run("bench --error --no-rtl --repeat 1 --size 48x48 --quiet" + view + "bench.json").status, 0);
  ASSERT_EQ(run("compare --size 48x48 --methods mvc --light x --out c --quiet" + view + "compare.json").status, 0);
  for (const char* command : {"fragments", "sweep", "bench", "compare"})
    EXPECT_EQ(read(file(std::string(command) + ".json")), read(file("render.json"))) << command;
  // What a report says to paste draws the same view.
  const std::string points = read(file("s") / "points.csv");
  EXPECT_NE(points.find("--mesh box.obj --view back --up z"), std::string::npos);
}

TEST_F(ViewOptions, BadOptions) {
  const std::string render = "render --png a.png --mesh box.obj ";
  refuses(2, render + "--view behind", {"--view behind", "back", "X,Y,Z"});
  refuses(2, render + "--view 0,0,0", {"--view 0,0,0"});
  refuses(2, render + "--view 1,2", {"--view 1,2"});
  refuses(2, render + "--view 1,nan,2", {"--view 1,nan,2"});
  refuses(2, render + "--up w", {"--up w", "x, y or z"});
  refuses(2, render + "--light lamp", {"--light lamp", "headlight"});
  refuses(2, render + "--save-camera box.obj", {"box.obj", "JSON"});
  refuses(2, render + "--save-camera a.png", {"a.png", "JSON"});
  refuses(2, render + "--save-camera -", {"-"});
  refuses(2, "render --png a.png --scene sphere --view top", {"--view needs --mesh"});
  refuses(2, "render --png a.png --scene sphere --save-camera c.json", {"--save-camera needs --mesh"});
  write("c.json", R"({"eye": [0, 0, 5], "target": [0, 0, 0], "up": [0, 1, 0], "fovy": 40, "near": 1, "far": 9})");
  refuses(2, render + "--camera c.json --up z", {"--up", "--camera c.json"});
}

}  // namespace
