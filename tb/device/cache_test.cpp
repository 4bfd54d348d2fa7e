#include "tb/device/cache.hpp"

#include "tb/device/build_notice.hpp"
#include "tb/device/scratch.hpp"
#include "tb/support/environment_error.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <functional>
#include <thread>

namespace quadrille::tb {
namespace {

namespace fs = std::filesystem;

class Cache : public testing::Test {
 protected:
  const Scratch scratch;
  const fs::path directory = scratch.path / "cache";
  const Variable cache{"QUADRILLE_CACHE", directory.string()};
  const Variable size{"QUADRILLE_CACHE_SIZE", ""};

  /// An entry of about `kilobytes`; how often it was built is counted.
  CacheEntry entry(const std::string& name, std::size_t kilobytes = 1) {
    return cached(name, "what " + name + " is", [&](const fs::path& work) {
      ++built;
      std::ofstream(work / "data") << std::string(1024 * kilobytes, 'x');
    });
  }
  void age(const std::string& name, int hours) {
    fs::last_write_time(directory / name, fs::file_time_type::clock::now() - std::chrono::hours(hours));
  }
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const fs::directory_entry& e : fs::directory_iterator(directory)) all.push_back(e.path().filename().string());
    std::sort(all.begin(), all.end());
    return all;
  }
  /// In a process of its own that may not write there, whoever runs the tests; its exit status.
  static int as_nobody(const std::function<int()>& work) {
    const pid_t child = fork();
    if (child == 0) {
      constexpr unsigned nobody = 65534;
      if (geteuid() == 0 && (setgid(nobody) != 0 || setuid(nobody) != 0)) _exit(99);
      _exit(work());
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
  }
  std::atomic<int> built{0};
};

TEST_F(Cache, BuildsOnceAndLeavesNothingElse) {
  const fs::path first = entry("kind-1").path(), second = entry("kind-1").path();
  EXPECT_EQ(first, directory / "kind-1");
  EXPECT_EQ(first, second);
  EXPECT_EQ(built, 1);
  EXPECT_EQ(names(), std::vector<std::string>{"kind-1"});
  EXPECT_THROW(cached("kind-2", "", [](const fs::path&) { throw std::runtime_error("no"); }), std::runtime_error);
  EXPECT_EQ(names(), std::vector<std::string>{"kind-1"});
}

/// What was damaged is said and built again, and then serves.
TEST_F(Cache, ADamagedEntryIsBuiltAgain) {
  const fs::path data = entry("kind-1", 10).path() / "data", sums = directory / "kind-1" / "checksums.txt";
  const struct {
    const char* what;
    std::function<void()> damage;
    const char* said;
  } cases[]{
      {"truncated", [&] { fs::resize_file(data, 10 * 1024 - 1); }, "data has other bytes"},
      {"empty", [&] { fs::resize_file(data, 0); }, "data has other bytes"},
      {"a bit flipped", [&] { std::fstream(data, std::ios::in | std::ios::out).seekp(10 * 1024 - 1).put('x' ^ 0x40); },
       "data has other bytes"},
      {"a byte more", [&] { std::ofstream(data, std::ios::app) << '\0'; }, "data has other bytes"},
      {"removed", [&] { fs::remove(data); }, "a file is missing"},
      {"a file more", [&] { std::ofstream(directory / "kind-1" / "more") << 1; }, "more has other bytes"},
      {"no checksums", [&] { fs::remove(sums); }, "it has no checksums"},
      {"checksums of nothing", [&] { fs::resize_file(sums, 0); }, "has other bytes"},
  };
  for (int count = 1; const auto& c : cases) {
    c.damage();
    testing::internal::CaptureStderr();
    EXPECT_EQ(entry("kind-1", 10).path(), directory / "kind-1") << c.what;
    const std::string said = testing::internal::GetCapturedStderr();
    EXPECT_NE(said.find("what kind-1 is, built again"), said.npos) << c.what << ": " << said;
    EXPECT_NE(said.find(c.said), said.npos) << c.what << ": " << said;
    EXPECT_EQ(built, ++count) << c.what;
    EXPECT_EQ(read_text(data), std::string(10 * 1024, 'x')) << c.what;
    entry("kind-1", 10);
    EXPECT_EQ(built, count) << c.what << ", then served";
  }
}

/// Nobody builds under the hands of whoever uses it.
TEST_F(Cache, ADamagedEntryInUseIsRefused) {
  const CacheEntry held = entry("kind-1");
  fs::resize_file(held.path() / "data", 1);
  testing::internal::CaptureStderr();
  EXPECT_THROW(entry("kind-1"), SystemError);
  testing::internal::GetCapturedStderr();
  EXPECT_EQ(built, 1);
}

TEST_F(Cache, ServesWhatItHasWhenItCannotBeWritten) {
  entry("kind-1");
  const auto before = fs::last_write_time(directory / "kind-1");
  fs::permissions(directory / "kind-1", fs::perms(0555));
  fs::permissions(directory, fs::perms(0555));
  EXPECT_EQ(as_nobody([&] { return entry("kind-1").path() == directory / "kind-1" && built == 1 ? 7 : 8; }), 7);
  EXPECT_EQ(as_nobody([&] {
              try {
                entry("kind-2");
                return 8;
              } catch (const SystemError&) {
                return 7;
              }
            }),
            7);
  fs::permissions(directory, fs::perms(0755));
  EXPECT_EQ(names(), std::vector<std::string>{"kind-1"});
  EXPECT_EQ(fs::last_write_time(directory / "kind-1"), before);
}

TEST_F(Cache, WhatWasNotUsedForLongestGoes) {
  for (const char* name : {"kind-1", "kind-2", "kind-3"}) entry(name, 100);
  age("kind-1", 3);
  age("kind-2", 2);
  age("kind-3", 1);
  entry("kind-1", 100);  // used again
  const Variable limit("QUADRILLE_CACHE_SIZE", "320K");
  entry("kind-4", 100);
  EXPECT_EQ(names(), (std::vector<std::string>{"kind-1", "kind-3", "kind-4"}));
}

TEST_F(Cache, NothingInUseGoes) {
  const CacheEntry held = entry("kind-1", 100);
  age("kind-1", 3);
  const Variable limit("QUADRILLE_CACHE_SIZE", "150K");
  const CacheEntry also_held = entry("kind-2", 100);
  EXPECT_EQ(names(), (std::vector<std::string>{"kind-1", "kind-2"})) << "over the limit, but both are in use";
  for (const CacheItem& item : cache_items()) EXPECT_TRUE(item.in_use) << item.name;
  EXPECT_TRUE(clear_cache().empty());
  EXPECT_TRUE(fs::exists(held.path() / "data"));
}

TEST_F(Cache, ListsAndClears) {
  entry("kind-1", 100);
  std::ofstream(directory / "failed-kind-9.log") << "log";
  fs::create_directory(directory / ".quadrille-1-0.tmp");  // its process is gone
  std::ofstream(directory / "kind-2.lock") << 1;
  age("kind-1", 3);
  const std::vector<CacheItem> items = cache_items();
  ASSERT_EQ(items.size(), 2u);
  EXPECT_EQ(items[0].name, "kind-1");
  EXPECT_EQ(items[0].description, "what kind-1 is");
  EXPECT_GE(items[0].bytes, 102400u);
  EXPECT_LT(items[0].bytes, 103000u);
  EXPECT_FALSE(items[0].in_use);
  EXPECT_NEAR(std::chrono::duration<double>(std::chrono::system_clock::now() - items[0].used).count(), 3 * 3600, 60);
  EXPECT_EQ(clear_cache().size(), 2u);
  EXPECT_TRUE(names().empty());
}

TEST_F(Cache, NoCacheIsEmpty) {
  EXPECT_TRUE(cache_items().empty());
  EXPECT_TRUE(clear_cache().empty());
  EXPECT_FALSE(fs::exists(directory));
}

TEST_F(Cache, WhatStoppedBuildsLeftIsSwept) {
  fs::create_directories(directory / ".quadrille-1-0.tmp" / "deep");
  entry("kind-2");
  EXPECT_EQ(names(), std::vector<std::string>{"kind-2"});
}

TEST_F(Cache, SecondBuilderWaitsForTheFirst) {
  std::atomic<bool> started{false}, waited{false};
  const auto build = [&](const fs::path& work) {
    started = true;
    while (!waited) std::this_thread::yield();
    ++built;
    std::ofstream(work / "data") << "x";
  };
  std::thread first([&] { cached("kind-1", "", build); });
  while (!started) std::this_thread::yield();
  const CacheEntry second = cached("kind-1", "", build, [&](long pid) {
    EXPECT_EQ(pid, getpid());
    waited = true;
  });
  first.join();
  EXPECT_TRUE(waited);
  EXPECT_EQ(built, 1);
  EXPECT_TRUE(fs::exists(second.path() / "data"));
}

TEST_F(Cache, Limit) {
  EXPECT_EQ(cache_limit(), std::uintmax_t{1} << 30);
  const auto of = [](const char* text) {
    const Variable limit("QUADRILLE_CACHE_SIZE", text);
    return cache_limit();
  };
  EXPECT_EQ(of("0"), 0u);
  EXPECT_EQ(of("12345"), 12345u);
  EXPECT_EQ(of("3K"), 3072u);
  EXPECT_EQ(of("5M"), 5u << 20);
  EXPECT_EQ(of("2G"), std::uintmax_t{2} << 30);
  for (const char* wrong : {"much", "-1", "1.5G", "1T", "99999999999G"}) EXPECT_THROW(of(wrong), SystemError) << wrong;
}

TEST_F(Cache, CannotBeWritten) {
  fs::create_directories(directory);
  std::ofstream(directory / "file") << "no directory";
  const Variable below("QUADRILLE_CACHE", (directory / "file" / "cache").string());
  EXPECT_THROW(writable_cache_directory(), SystemError);
}

TEST_F(Cache, DirectoryByPrecedence) {
  const Variable home("HOME", (scratch.path / "home").string());
  EXPECT_EQ(cache_directory(), directory);
  const Variable none("QUADRILLE_CACHE", "");
  {
    const Variable xdg("XDG_CACHE_HOME", (scratch.path / "xdg").string());
    EXPECT_EQ(cache_directory(), scratch.path / "xdg" / "quadrille");
  }
  const Variable xdg("XDG_CACHE_HOME", "");
  EXPECT_EQ(cache_directory(), scratch.path / "home" / ".cache" / "quadrille");
}

TEST(Fingerprint, DependsOnEveryPieceAndOnTheirBorders) {
  const auto of = [](std::initializer_list<std::string_view> pieces) {
    Fingerprint f;
    for (const std::string_view piece : pieces) f.add(piece);
    return f.hex();
  };
  EXPECT_EQ(of({}), "6c62272e07bb014262b821756295c58d");  // the offset basis of FNV-1a with 128 bits
  EXPECT_EQ(of({"ab", "c"}), of({"ab", "c"}));
  EXPECT_NE(of({"ab", "c"}), of({"a", "bc"}));
  EXPECT_NE(of({"ab"}), of({"ab", ""}));
  EXPECT_NE(of({"ab"}), of({"aB"}));
}

/// What `work` writes to standard error when that is a terminal.
std::string on_a_terminal(const std::function<void()>& work) {
  const int terminal = posix_openpt(O_RDWR | O_NOCTTY);
  if (terminal < 0 || grantpt(terminal) != 0 || unlockpt(terminal) != 0) return {};
  const int slave = open(ptsname(terminal), O_RDWR | O_NOCTTY), before = dup(STDERR_FILENO);
  std::fflush(stderr);
  dup2(slave, STDERR_FILENO);
  work();
  std::fflush(stderr);
  dup2(before, STDERR_FILENO);
  close(slave),
      close(before);  // then reading ends, with an error, behind the last byte; one read may bring only a part
  std::string said;
  char text[4096];
  for (ssize_t n; (n = read(terminal, text, sizeof text)) > 0;) said.append(text, static_cast<std::size_t>(n));
  close(terminal);
  return said;
}

void build_in_two_steps() {
  BuildNotice notice("a thing");
  notice.waiting(4711);
  notice.waiting(4711);
  notice.start(2);
  notice.tick();
  notice.done(1, 2);
  notice.done(1, 2);
  notice.finished();
}

TEST(BuildNotice, PlainLinesInALog) {
  testing::internal::CaptureStderr();
  build_in_two_steps();
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "quadrille: waiting for process 4711, which builds a thing, 0 s\n"
            "quadrille: building a thing: 0 of 2 steps, 0 s\n"
            "quadrille: building a thing: 1 of 2 steps, 0 s\n"
            "quadrille: built a thing, 0 s\n");
}

TEST(BuildNotice, OneLineOnATerminal) {
  const std::string said = on_a_terminal(build_in_two_steps);
  if (said.empty()) GTEST_SKIP() << "no pseudo-terminal to be had";
  EXPECT_EQ(said.find('\n'), std::string::npos) << said;
  EXPECT_NE(said.find("\r\033[Kbuilding a thing: 1 of 2 steps, 0 s"), std::string::npos) << said;
  EXPECT_TRUE(said.ends_with("\r\033[K")) << "the line is wiped at the end";
}

}  // namespace
}  // namespace quadrille::tb
