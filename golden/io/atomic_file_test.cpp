#include "golden/io/atomic_file.hpp"

#include "golden/io/test_support.hpp"

#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <cstdio>

namespace quadrille::golden {
namespace {

constexpr auto refused = AtomicFile::Dash::refused;

class AtomicFileTest : public InDirectory {};

TEST_F(AtomicFileTest, AppearsOnlyWithCommit) {
  const std::string file = write("f", "old");
  {
    AtomicFile out(file, refused);
    out.write("new");
    EXPECT_EQ(read(file), "old");
    EXPECT_EQ(entries(), 2u);
    out.commit();
    EXPECT_EQ(read(file), "new");
  }
  EXPECT_EQ(entries(), 1u);
}

TEST_F(AtomicFileTest, LeavesNothingWithoutCommit) {
  const std::string file = write("f", "old");
  {
    AtomicFile out(file, refused);
    out.write(std::string(1 << 20, 'x'));
  }
  EXPECT_EQ(read(file), "old");
  EXPECT_EQ(entries(), 1u);
}

TEST_F(AtomicFileTest, WritesLargeAndSmallBlocksInOrder) {
  std::string expected;
  AtomicFile out(path("f"), refused);
  for (std::size_t size : {3u, 100000u, 200000u, 5u, 262144u, 262143u, 1u, 700000u, 9u}) {
    const std::string block(size, static_cast<char>('a' + size % 26));
    expected += block;
    out.write(block);
    EXPECT_EQ(out.tell(), expected.size());
  }
  out.seek(2);
  out.write("seek");
  expected.replace(2, 4, "seek");
  out.commit();
  EXPECT_EQ(read(path("f")), expected);
}

TEST_F(AtomicFileTest, KeepsPermissionsAndFollowsLinks) {
  const std::string file = write("f", "old");
  ASSERT_EQ(::chmod(file.c_str(), 0640), 0);
  std::filesystem::create_symlink("f", path("link"));
  write_file(path("link"), "new", refused);
  EXPECT_TRUE(std::filesystem::is_symlink(path("link")));
  EXPECT_EQ(read(file), "new");
  struct stat status {};
  ASSERT_EQ(::stat(file.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0640u);
}

// Renaming would replace a file that cannot be written, and root may write everything: the mode decides.
TEST_F(AtomicFileTest, ReadOnlyFilesStay) {
  const std::string file = write("f", "old");
  ASSERT_EQ(::chmod(file.c_str(), 0444), 0);
  std::filesystem::create_symlink("f", path("link"));
  for (const std::string& name : {file, path("link")})
    expect_input_error([&] { write_file(name, "new", refused); }, name, {"read-only"});
  EXPECT_EQ(read(file), "old");
  EXPECT_EQ(entries(), 2u);
}

TEST_F(AtomicFileTest, DanglingLinksAreRefused) {
  std::filesystem::create_symlink("nothing", path("link"));
  expect_input_error([&] { write_file(path("link"), "x", refused); }, path("link"), {"link to nothing", "not exist"});
  EXPECT_TRUE(std::filesystem::is_symlink(path("link")));
  EXPECT_EQ(entries(), 1u);
}

TEST_F(AtomicFileTest, AcceptsTheLongestName) {
  const std::string file = path(std::string(255, 'n'));
  write_file(file, "x", refused);
  EXPECT_EQ(read(file), "x");
  expect_input_error([&] { write_file(file + "n", "x", refused); }, file + "n", {"File name too long"});
  EXPECT_EQ(entries(), 1u);
}

TEST_F(AtomicFileTest, NamesPathAndReason) {
  expect_input_error([&] { write_file(path("no/f"), "x", refused); }, path("no/f"), {"No such file or directory"});
  const std::string file = write("f", "old");
  expect_input_error([&] { write_file(path("f/g"), "x", refused); }, path("f/g"), {"Not a directory"});
  std::filesystem::create_directory(path("d"));
  expect_input_error([&] { write_file(path("d"), "x", refused); }, path("d"), {"Is a directory"});
  EXPECT_TRUE(std::filesystem::is_directory(path("d")));
  EXPECT_NE(input_error_of([&] { write_file("", "x", refused); }).find("path is empty"), std::string::npos);
  expect_input_error([&] { write_file("-", "x", refused); }, "-", {"standard output"});
  EXPECT_EQ(read(file), "old");
  EXPECT_EQ(entries(), 2u);
}

TEST_F(AtomicFileTest, RenameFailureKeepsTheOldState) {
  // The target turns into a directory while the file is being written.
  AtomicFile out(path("f"), refused);
  out.write("x");
  std::filesystem::create_directory(path("f"));
  expect_input_error([&] { out.commit(); }, path("f"), {"rename"});
  EXPECT_EQ(entries(), 1u);
}

TEST_F(AtomicFileTest, FullDiskKeepsTheOldFile) {
  // A limit on the size of files fails a write half-way, as a full disk does.
  const std::string file = write("f", "old");
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit low{100000, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &low), 0);
  const std::string message = input_error_of([&] { write_file(file, std::string(1 << 20, 'x'), refused); });
  const std::string late =
      input_error_of([&] { write_file(file, std::string(150000, 'x'), refused); });  // only flushed by commit
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  for (const std::string& text : {message, late})
    EXPECT_NE(text.find(file + ": cannot write: File too large"), std::string::npos) << text;
  EXPECT_EQ(read(file), "old");
  EXPECT_EQ(entries(), 1u);
}

TEST_F(AtomicFileTest, FullDeviceIsAnErrorAndStaysADevice) {
  if (!std::filesystem::is_character_file("/dev/full")) GTEST_SKIP() << "no /dev/full";
  expect_input_error([&] { write_file("/dev/full", "x", refused); }, "/dev/full", {"No space left"});
  expect_input_error([&] { write_file("/dev/full", std::string(1 << 20, 'x'), refused); }, "/dev/full",
                     {"No space left"});
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
  write_file("/dev/null", "x", refused);
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST_F(AtomicFileTest, DashIsStandardOutput) {
  ::testing::internal::CaptureStdout();
  std::printf("before ");
  write_file("-", "bytes\n", AtomicFile::Dash::standard_output);
  std::printf("after");
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "before bytes\nafter");
}

}  // namespace
}  // namespace quadrille::golden
