#include "golden/vectors/manifest_test_support.hpp"

namespace quadrille::vectors {
namespace {

TEST_F(Set, NothingIsReplacedUnasked) {
  const std::string before = read(path("set/manifest.json"));
  EXPECT_NE(golden::input_error_of([&] { generate("set", {"sqrt"}); }).find("--force"), std::string::npos);
  EXPECT_EQ(read(path("set/manifest.json")), before);
  generate("set", {"sqrt"}, true);
  EXPECT_EQ(SetReader(path("set")).suites(), std::vector<std::string>{"sqrt"});
  // What is no set stays, even when asked to replace it.
  write("set/thesis.txt", "mine");
  EXPECT_NE(golden::input_error_of([&] { generate("set", {"sqrt"}, true); }).find("does not belong"),
            std::string::npos);
  EXPECT_EQ(read(path("set/thesis.txt")), "mine");
  fs::remove(path("set/thesis.txt"));
  write("set/sqrt/thesis.txt", "mine");
  EXPECT_NE(golden::input_error_of([&] { generate("set", {"sqrt"}, true); }), "");
  EXPECT_EQ(read(path("set/sqrt/thesis.txt")), "mine");
  fs::create_directory(path("other"));
  write("other/file", "mine");
  EXPECT_NE(golden::input_error_of([&] { generate("other", {"sqrt"}, true); }), "");
  fs::create_directory(path("empty"));
  generate("empty", {"sqrt"});
  EXPECT_EQ(check(path("empty")), check(path("empty")));
}

TEST_F(Set, AnUnfinishedSetLeavesNothing) {
  const std::size_t before = entries();
  {
    SetWriter writer(path("new"), info(), false);
    writer.add(find_suite("sqrt").info(), [&](SuiteWriter& out) { find_suite("sqrt").write(out, options()); });
  }
  EXPECT_EQ(entries(), before);
  SetWriter empty(path("new"), info(), false);
  EXPECT_NE(golden::input_error_of([&] { empty.commit(false); }).find("no suite"), std::string::npos);
  EXPECT_FALSE(fs::exists(path("new")));
}

// Two runs that found the name free: the set that is there first stays.
TEST_F(Set, ASetThatAppearsMeanwhileIsNotReplaced) {
  SetWriter late(path("new"), info(), false);
  late.add(find_suite("depth").info(), [&](SuiteWriter& out) { find_suite("depth").write(out, options()); });
  generate("new", {"sqrt"});
  const std::string message = golden::input_error_of([&] { late.commit(false); });
  EXPECT_EQ(message.find(path("new") + ": was written by another run"), 0u) << message;
  EXPECT_EQ(SetReader(path("new")).suites(), std::vector<std::string>{"sqrt"});
  // With --force the last one wins, whole.
  SetWriter forced(path("new"), info(), true);
  forced.add(find_suite("depth").info(), [&](SuiteWriter& out) { find_suite("depth").write(out, options()); });
  generate("new", {"coverage"}, true);
  forced.commit(false);
  EXPECT_EQ(SetReader(path("new")).suites(), std::vector<std::string>{"depth"});
}

TEST_F(Set, LinksLeadToTheSetAndNotOutOfIt) {
  fs::create_directory(path("target"));
  fs::create_directory_symlink("target", path("link"));
  generate("link", {"sqrt"});
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(SetReader(path("target")).suites(), std::vector<std::string>{"sqrt"});
  generate("link", {"depth"}, true);
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(check(path("link")), check(path("target")));
  fs::create_directory_symlink("nothing", path("dangling"));
  EXPECT_EQ(golden::input_error_of([&] { generate("dangling", {"sqrt"}); }),
            path("dangling") + ": is a symbolic link to nothing");

  for (const char* name : {"set/sqrt/response.hex", "set/sqrt/manifest.json", "set/depth", "set/manifest.json"}) {
    fs::rename(path(name), path("outside"));
    fs::create_symlink(path("outside"), path(name));
    EXPECT_EQ(complaint().find(path(name) + ": "), 0u) << complaint();
    fs::remove(path(name));
    fs::rename(path("outside"), path(name));
  }
  EXPECT_GT(check(path("set")), 0u);
}

TEST_F(Set, OnlyRegularFilesAreOpened) {
  for (const char* name : {"set/sqrt/response.hex", "set/sqrt/manifest.json", "set/manifest.json"}) {
    fs::rename(path(name), path("outside"));
    ASSERT_EQ(::mkfifo(path(name).c_str(), 0600), 0);
    EXPECT_EQ(complaint().find(path(name) + ": "), 0u);
    fs::remove(path(name));
    fs::rename(path("outside"), path(name));
  }
}

TEST_F(Set, TheCurrentDirectoryIsNotReplaced) {
  const fs::path before = fs::current_path();
  fs::create_directories(path("here/below"));
  fs::current_path(path("here/below"));
  for (const char* name : {".", "..", "../"})
    EXPECT_NE(golden::input_error_of([&] { SetWriter(name, info(), false); }).find("holds the current directory"),
              std::string::npos);
  fs::current_path(before);
}

}  // namespace
}  // namespace quadrille::vectors
