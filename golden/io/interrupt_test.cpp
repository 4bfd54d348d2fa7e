// A second signal while the first one's tidying goes on.
#include "golden/io/interrupt.hpp"

#include "golden/io/temporary.hpp"
#include "golden/io/test_support.hpp"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <thread>

namespace quadrille::golden {
namespace {

class Interrupt : public InDirectory {
 protected:
  /// A process that watches signals and does `work`; returns once it has written `ready`.
  pid_t start(const std::function<void()>& work) const {
    const pid_t pid = ::fork();
    if (pid == 0) {
      for (const int each : {SIGINT, SIGTERM, SIGHUP}) ::signal(each, SIG_DFL);
      [[maybe_unused]] const auto* quiet = std::freopen("/dev/null", "w", stderr);
      ::alarm(20);  // the end of a process that nothing else ends
      watch_interrupts();
      work();
      ::_exit(0);
    }
    for (int i = 0; i < 20'000 && !std::filesystem::exists(path("ready")); ++i) pause_ms(1);
    EXPECT_TRUE(std::filesystem::exists(path("ready")));
    return pid;
  }
  void say_ready() const { write("ready", ""); }
  static void pause_ms(int n) { std::this_thread::sleep_for(std::chrono::milliseconds(n)); }
  static int end_of(pid_t pid) {
    int status = 0;
    ::waitpid(pid, &status, 0);
    return status;
  }
};

// As timeout(1) sends it: to the process, then to its group.
TEST_F(Interrupt, ASecondSignalDoesNotCutTheTidyingOff) {
  for (const int second : {SIGTERM, SIGINT, SIGHUP}) {
    for (const int gap : {0, 1, 20, 200}) {
      SCOPED_TRACE("signal " + std::to_string(second) + " after " + std::to_string(gap) + " ms");
      const pid_t pid = start([&] {
        const Temporary folder(path(""), Temporary::Kind::folder);
        const pid_t child = ::fork();
        if (child == 0) {  // a tool that takes its time to end
          ::setpgid(0, 0);
          ::signal(SIGTERM, [](int) { ::usleep(400'000), ::_exit(0); });
          sigset_t none;
          sigemptyset(&none);
          ::pthread_sigmask(SIG_SETMASK, &none, nullptr);
          ::alarm(20);
          write("armed", "");
          for (;;) ::pause();
        }
        ::setpgid(child, child);
        without_interrupt([&] { remember_child(child); });
        while (!std::filesystem::exists(path("armed"))) pause_ms(1);
        say_ready();
        for (;;) ::pause();
      });
      ::kill(pid, SIGTERM);
      pause_ms(gap);
      ::kill(pid, second);
      const int status = end_of(pid);
      ASSERT_TRUE(WIFSIGNALED(status));
      // Of two that are there together the system gives the lower number first.
      if (gap >= 200 || WTERMSIG(status) != second) {
        EXPECT_EQ(WTERMSIG(status), SIGTERM);
      }
      for (const char* name : {"ready", "armed"}) std::filesystem::remove(path(name));
      EXPECT_EQ(entries(), 0u);
    }
  }
}

TEST_F(Interrupt, ALaterSignalEndsAProcessThatHangs) {
  const pid_t pid = start([&] {
    without_interrupt([&] {
      say_ready();
      for (;;) pause_ms(1000);
    });
  });
  ::kill(pid, SIGTERM);
  pause_ms(2300);
  EXPECT_EQ(::waitpid(pid, nullptr, WNOHANG), 0) << "ended without a second signal";
  ::kill(pid, SIGINT);
  const int status = end_of(pid);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGINT);
}

}  // namespace
}  // namespace quadrille::golden
