#include "golden/io/exr.hpp"

#include "golden/io/test_support.hpp"

#include <random>

namespace quadrille::golden {
namespace {

class ExrTest : public InDirectory {};

FrameImage random_frame(int width, int height, bool errors) {
  FrameImage frame(width, height);
  std::mt19937 random(11);
  std::vector<std::vector<float>*> channels{&frame.r, &frame.g, &frame.b, &frame.a, &frame.z};
  for (auto& lambda : frame.lambda) channels.push_back(&lambda);
  if (errors) {
    for (const char* name : {"L0", "L1", "L2", "L3"})
      channels.push_back(&(frame.error[name] = std::vector<float>(frame.pixels())));
  }
  for (std::vector<float>* channel : channels) {
    for (float& value : *channel) value = static_cast<float>(random()) * 0x1p-30f - 1;
  }
  for (std::uint32_t& id : frame.quad) id = static_cast<std::uint32_t>(random());
  return frame;
}

TEST_F(ExrTest, RoundTripsDeterministically) {
  const FrameImage frame = random_frame(31, 17, true);
  save_exr(path("a.exr"), frame);
  save_exr(path("b.exr"), frame);
  EXPECT_EQ(read(path("a.exr")), read(path("b.exr")));
  EXPECT_EQ(read(path("a.exr")).find("capDate"), std::string::npos);

  const ExrImage image = load_exr(path("a.exr"));
  EXPECT_EQ(image.width, 31);
  EXPECT_EQ(image.height, 17);
  EXPECT_EQ(image.floats.size(), 13u);
  EXPECT_EQ(image.floats.at("R"), frame.r);
  EXPECT_EQ(image.floats.at("A"), frame.a);
  EXPECT_EQ(image.floats.at("Z"), frame.z);
  EXPECT_EQ(image.floats.at("L3"), frame.lambda[3]);
  EXPECT_EQ(image.floats.at("error.L2"), frame.error.at("L2"));
  ASSERT_EQ(image.uints.size(), 1u);
  EXPECT_EQ(image.uints.at("quad"), frame.quad);
}

// What a picture mostly is: smooth. PIZ takes it apart without zlib, whose version would show in the bytes.
TEST_F(ExrTest, SmoothPicturesAreSmall) {
  FrameImage frame(256, 256);
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 256; ++x) frame.r[frame.index(x, y)] = static_cast<float>(x * y) * 0x1p-16f;
  save_exr(path("a.exr"), frame);
  EXPECT_LT(read(path("a.exr")).size(), 10u * 4 * 256 * 256 / 8);
  EXPECT_EQ(read(path("a.exr")).find("zip"), std::string::npos);
  EXPECT_EQ(load_exr(path("a.exr")).floats.at("R"), frame.r);
}

TEST_F(ExrTest, ReadsOnlyTheNamedChannels) {
  save_exr(path("a.exr"), random_frame(5, 4, false));
  const std::string names[] = {"quad", "L1"};
  const ExrImage image = load_exr(path("a.exr"), names);
  EXPECT_EQ(image.floats.size(), 1u);
  EXPECT_EQ(image.floats.count("L1"), 1u);
  EXPECT_EQ(image.uints.size(), 1u);
  const std::string missing[] = {"error.L0"};
  expect_input_error([&] { load_exr(path("a.exr"), missing); }, path("a.exr"), {"no channel \"error.L0\"", "quad"});
}

TEST_F(ExrTest, NewFramesAreCleared) {
  const FrameImage frame(3, 2);
  EXPECT_EQ(frame.z, std::vector<float>(6, 1.0f));
  EXPECT_EQ(frame.quad, std::vector<std::uint32_t>(6, no_quad));
  EXPECT_EQ(frame.index(2, 1), 5u);
  EXPECT_THROW(FrameImage(0, 5), InputError);
  EXPECT_THROW(FrameImage(5, -1), InputError);
  EXPECT_THROW(FrameImage(1 << 20, 1), InputError);
}

TEST_F(ExrTest, FailedWritesLeaveTheOldFile) {
  const FrameImage frame = random_frame(64, 64, false);
  expect_input_error([&] { save_exr(path("no/a.exr"), frame); }, path("no/a.exr"), {"No such file"});
  std::filesystem::create_directory(path("d"));
  expect_input_error([&] { save_exr(path("d"), frame); }, path("d"), {"Is a directory"});
  expect_input_error([&] { save_exr("-", frame); }, "-", {"standard output"});
  if (std::filesystem::is_character_file("/dev/full")) {
    expect_input_error([&] { save_exr("/dev/full", frame); }, "/dev/full", {"No space left"});
    expect_input_error([&] { save_exr("/dev/full", random_frame(512, 512, false)); }, "/dev/full", {"No space left"});
  }
  EXPECT_EQ(entries(), 1u);
}

TEST_F(ExrTest, RefusesDamagedFiles) {
  expect_input_error([&] { load_exr(path("absent")); }, path("absent"), {"OpenEXR", "No such file"});
  const std::string text = write("text", "this is not a picture at all");
  expect_input_error([&] { load_exr(text); }, text, {"not a readable OpenEXR"});
  save_exr(path("good"), random_frame(9, 9, false));
  const std::string good = read(path("good"));
  for (std::size_t size = 0; size < good.size(); size += 97) {
    const std::string file = write("cut", good.substr(0, size));
    expect_input_error([&] { load_exr(file); }, file, {});
  }
}

}  // namespace
}  // namespace quadrille::golden
