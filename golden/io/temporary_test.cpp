#include "golden/io/temporary.hpp"

#include "golden/io/interrupt.hpp"
#include "golden/io/test_support.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <optional>

namespace quadrille::golden {
namespace {

namespace fs = std::filesystem;
using Kind = Temporary::Kind;

class TemporaryTest : public InDirectory {
 protected:
  /// Runs `body` in a process that watches for signals; it reports "ready" when it is to be signalled. What it wrote
  /// to standard error, and how it ended.
  struct Ended {
    std::string text;
    int status = 0;
  };
  template <typename Body>
  Ended interrupted(int signal, const Body& body) const {
    int ready[2];
    if (::pipe(ready) != 0) throw std::runtime_error("no pipe");
    const pid_t pid = ::fork();
    if (pid == 0) {
      if (std::freopen(path("stderr").c_str(), "w", stderr) == nullptr) ::_exit(99);
      std::signal(signal, SIG_DFL);
      watch_interrupts();
      body([&] { return ::write(ready[1], "x", 1); });
      for (;;) ::pause();
    }
    char byte = 0;
    EXPECT_EQ(::read(ready[0], &byte, 1), 1);
    ::kill(pid, signal);
    Ended ended;
    EXPECT_EQ(::waitpid(pid, &ended.status, 0), pid);
    ::close(ready[0]), ::close(ready[1]);
    ended.text = read(path("stderr"));
    fs::remove(path("stderr"));
    return ended;
  }
};

TEST_F(TemporaryTest, GoesUnlessPublished) {
  { const Temporary file(path("."), Kind::file), folder(path("."), Kind::folder); }
  EXPECT_EQ(entries(), 0u);
  write("old", "old");
  Temporary file(path("."), Kind::file);
  ASSERT_EQ(::write(file.descriptor(), "new", 3), 3);
  file.publish(path("old"));
  EXPECT_EQ(read(path("old")), "new");
  EXPECT_EQ(entries(), 1u);
}

TEST_F(TemporaryTest, AFolderTakesAFreeNameOnly) {
  Temporary folder(path("."), Kind::folder);
  std::ofstream(folder.path() / "f") << "new";
  fs::create_directory(path("set"));
  write("set/f", "old");
  EXPECT_THROW(folder.publish(path("set")), std::system_error);
  EXPECT_EQ(read(path("set/f")), "old");
  folder.replace(path("set"));
  EXPECT_EQ(read(path("set/f")), "new");
  fs::create_directory(path("empty"));
  Temporary(path("."), Kind::folder).publish(path("empty"));
}

// Each sweeps what it takes for stale, and may meet the other's folder before that is locked.
TEST_F(TemporaryTest, ProcessesDoNotTakeEachOthers) {
  const auto make = [&] {
    for (int i = 0; i < 1500; ++i) {
      const Temporary folder(path("."), Kind::folder);
      if (!fs::exists(folder.path())) throw std::runtime_error(folder.path().string() + " is gone");
    }
  };
  const pid_t other = ::fork();
  if (other == 0) {
    try {
      make();
    } catch (const std::exception&) {
      ::_exit(1);
    }
    ::_exit(0);
  }
  EXPECT_NO_THROW(make());
  int status = 0;
  ASSERT_EQ(::waitpid(other, &status, 0), other);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(entries(), 0u);
}

// What is left is known by its name, and as stale by the lock that ended with its process.
TEST_F(TemporaryTest, SweepsWhatKilledProcessesLeft) {
  write(".quadrille-1-0.tmp", "left");
  fs::create_directories(path(".quadrille-1-1.tmp/below"));
  write(".quadrille-1-1.tmp/below/f", "left");
  write(".quadrille-notes", "kept");
  write("f.tmp", "kept");
  write(".quadrille-1-2.tmp", "alive");
  const int alive = ::open(path(".quadrille-1-2.tmp").c_str(), O_RDONLY);
  ASSERT_EQ(::flock(alive, LOCK_EX), 0);
  const Temporary first(path("."), Kind::folder);
  const Temporary second(path("."), Kind::file);
  EXPECT_TRUE(fs::exists(first.path()));
  EXPECT_FALSE(fs::exists(path(".quadrille-1-0.tmp")));
  EXPECT_FALSE(fs::exists(path(".quadrille-1-1.tmp")));
  for (const char* kept : {".quadrille-notes", "f.tmp", ".quadrille-1-2.tmp"}) EXPECT_TRUE(fs::exists(path(kept)));
  ::close(alive);
}

TEST_F(TemporaryTest, ASignalRemovesThemSaysSoAndEndsTheProcess) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const Ended ended = interrupted(signal, [&](const auto& ready) {
      const Temporary file(path("."), Kind::file), folder(path("."), Kind::folder);
      std::ofstream(folder.path() / "f") << "half";
      announce_output("a.png");
      announce_output("b.exr");
      announce_output("c.json");
      announce_output("-");
      output_written("b.exr");
      set_interrupt_hint("the rest is kept");
      ready();
      for (;;) ::pause();
    });
    ASSERT_TRUE(WIFSIGNALED(ended.status));
    EXPECT_EQ(WTERMSIG(ended.status), signal);
    EXPECT_EQ(ended.text, std::string("quadrille: ") + (signal == SIGINT ? "interrupted" : "terminated") +
                              "; not written: a.png, c.json; the rest is kept\n");
    EXPECT_EQ(entries(), 0u);
  }
}

TEST_F(TemporaryTest, AChildEndsWithItsChildren) {
  const Ended ended = interrupted(SIGTERM, [&](const auto& ready) {
    pid_t child = 0;
    without_interrupt([&] {
      child = ::fork();
      if (child != 0) remember_child(child);
    });
    if (child == 0) {
      ::setpgid(0, 0);
      const pid_t grandchild = ::fork();
      if (grandchild == 0) {
        std::signal(SIGTERM, SIG_IGN);  // a stubborn one
        sigset_t none;
        sigemptyset(&none);
        ::sigprocmask(SIG_SETMASK, &none, nullptr);
        ready();
        for (;;) ::pause();
      }
      std::ofstream(path("grandchild")) << grandchild;
      for (;;) ::pause();
    }
    for (;;) ::pause();
  });
  EXPECT_EQ(WTERMSIG(ended.status), SIGTERM);
  pid_t grandchild = 0;
  std::ifstream(path("grandchild")) >> grandchild;
  ASSERT_GT(grandchild, 0);
  // Killed, though nobody may have waited for it yet.
  bool gone = false;
  for (int i = 0; i < 500 && !gone; ++i) {
    std::string state = read("/proc/" + std::to_string(grandchild) + "/stat");
    gone = state.empty() || state.find(") Z") != std::string::npos;
    ::usleep(10'000);
  }
  EXPECT_TRUE(gone);
}

TEST_F(TemporaryTest, AnIgnoredSignalStaysIgnored) {  // nohup
  const pid_t pid = ::fork();
  if (pid == 0) {
    std::signal(SIGHUP, SIG_IGN);
    watch_interrupts();
    ::kill(::getpid(), SIGHUP);
    ::usleep(100'000);
    ::_exit(7);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(pid, &status, 0), pid);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 7);
}

}  // namespace
}  // namespace quadrille::golden
