#include "golden/io/interrupt.hpp"

#include <pthread.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <set>
#include <system_error>
#include <thread>
#include <vector>

namespace quadrille::golden {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds second_signal_ignored{2};

struct Registry {
  std::mutex mutex;  ///< an interruption takes it and keeps it
  std::set<fs::path> temporaries;
  std::set<pid_t> children;
  std::vector<std::string> outputs;
  std::string hint;
  std::atomic<bool> watched{false}, interrupted{false};
};

/// Never destroyed: the watching thread outlives main().
Registry& registry() {
  static Registry& instance = *new Registry;
  return instance;
}

void say(const Registry& r, int signal) {
  std::string line = isatty(STDERR_FILENO) != 0 ? "\r\033[K" : "";  // a progress line may stand there
  line += signal == SIGINT ? "quadrille: interrupted" : "quadrille: terminated";
  for (std::size_t i = 0; i < r.outputs.size(); ++i) line += (i == 0 ? "; not written: " : ", ") + r.outputs[i];
  if (!r.hint.empty()) line += "; " + r.hint;
  line += "\n";
  // Not through stdio, whose lock another thread may hold.
  [[maybe_unused]] const ssize_t ignored = ::write(STDERR_FILENO, line.data(), line.size());
}

void end_children(const std::set<pid_t>& children) {
  using Clock = std::chrono::steady_clock;
  for (const pid_t pid : children) ::kill(-pid, SIGTERM);
  const Clock::time_point deadline = Clock::now() + std::chrono::seconds(2);
  const auto ended = [](pid_t pid) {
    siginfo_t info{};
    return ::waitid(P_PID, static_cast<id_t>(pid), &info, WEXITED | WNOHANG | WNOWAIT) != 0 || info.si_pid == pid;
  };
  while (!std::ranges::all_of(children, ended) && Clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  for (const pid_t pid : children) ::kill(-pid, SIGKILL);
}

/// From here on a signal ends the process at once. Those that came before are forgotten.
void end_at_signals(const sigset_t& signals) {
  const timespec now{};
  while (sigtimedwait(&signals, nullptr, &now) > 0) {
  }
  for (const int each : {SIGINT, SIGTERM, SIGHUP})
    if (sigismember(&signals, each) == 1) ::signal(each, SIG_DFL);
  pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
}

[[noreturn]] void interrupt(int signal, const sigset_t& signals) {
  Registry& r = registry();
  r.interrupted = true;
  // timeout(1), batch systems and terminals send the same signal twice in a moment: the second must not cut off the
  // tidying. After a while it ends the process, wherever the tidying hangs.
  try {
    std::thread([&signals] {
      std::this_thread::sleep_for(second_signal_ignored);
      end_at_signals(signals);
      for (;;) ::pause();  // the one thread that signals reach
    }).detach();
  } catch (const std::system_error&) {
    end_at_signals(signals);
  }

  r.mutex.lock();
  say(r, signal);
  end_children(r.children);
  for (const fs::path& path : r.temporaries) {
    std::error_code error;
    // Other threads may still be adding files.
    for (int attempt = 0; attempt < 5 && fs::exists(fs::symlink_status(path, error)); ++attempt)
      fs::remove_all(path, error);
  }
  end_at_signals(signals);
  ::kill(getpid(), signal);
  for (;;) ::pause();
}

}  // namespace

void watch_interrupts() {
  static sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction now {};
    if (::sigaction(signal, nullptr, &now) == 0 && now.sa_handler != SIG_IGN) sigaddset(&signals, signal);
  }
  if (pthread_sigmask(SIG_BLOCK, &signals, nullptr) != 0) return;
  try {
    std::thread([] {
      for (int signal = 0;;)
        if (sigwait(&signals, &signal) == 0) interrupt(signal, signals);
    }).detach();
    registry().watched = true;
  } catch (const std::system_error&) {  // no thread to be had: the signals do what they always did
    pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
  }
}

bool interrupts_watched() { return registry().watched; }

void yield_to_interrupt() {
  while (registry().interrupted) ::pause();
}

void announce_output(const std::string& path) {
  if (path.empty() || path == "-") return;
  const std::lock_guard lock(registry().mutex);
  registry().outputs.push_back(path);
}

void output_written(const std::string& path) {
  const std::lock_guard lock(registry().mutex);
  std::erase(registry().outputs, path);
}

void set_interrupt_hint(std::string hint) {
  const std::lock_guard lock(registry().mutex);
  registry().hint = std::move(hint);
}

void without_interrupt(const std::function<void()>& change) {
  const std::lock_guard lock(registry().mutex);
  change();
}

void remember_temporary(const fs::path& path) { registry().temporaries.insert(path); }
void forget_temporary(const fs::path& path) { registry().temporaries.erase(path); }
void remember_child(pid_t pid) { registry().children.insert(pid); }
void forget_child(pid_t pid) { registry().children.erase(pid); }

}  // namespace quadrille::golden
