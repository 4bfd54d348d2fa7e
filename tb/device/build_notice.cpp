#include "tb/device/build_notice.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>

namespace quadrille::tb {

namespace {

std::atomic<bool> silent{false};

std::size_t terminal_columns() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 ? size.ws_col : 80;
}

}  // namespace

BuildNotice::BuildNotice(std::string what) : what_(std::move(what)), terminal_(isatty(STDERR_FILENO) != 0) {}

BuildNotice::~BuildNotice() {
  if (drawn_ && terminal_) std::fputs("\r\033[K", stderr);
}

void BuildNotice::silence() { silent = true; }

void BuildNotice::say(const std::string& text) {
  if (!silent) std::fprintf(stderr, "quadrille: %s\n", text.c_str());
}

double BuildNotice::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void BuildNotice::show(const std::string& text) {
  if (silent) return;
  drawn_ = true;
  char elapsed[40];
  std::snprintf(elapsed, sizeof elapsed, ", %.0f s", seconds());
  if (!terminal_) {
    std::fprintf(stderr, "quadrille: %s%s\n", text.c_str(), elapsed);
    return;
  }
  // What changes comes first: it is seen on a narrow terminal too.
  const std::string line = text + elapsed;
  std::fprintf(stderr, "\r\033[K%s", line.substr(0, terminal_columns() - 1).c_str());
  std::fflush(stderr);
}

void BuildNotice::start(std::size_t total) {
  start_ = std::chrono::steady_clock::now();
  done(0, total);
}

void BuildNotice::done(std::size_t steps, std::size_t total) {
  const std::string state =
      "building " + what_ + ": " + std::to_string(std::min(steps, total)) + " of " + std::to_string(total) + " steps";
  if (state == state_) return;
  state_ = state;
  show(state_);
}

void BuildNotice::tick() {
  if (terminal_ && !state_.empty()) show(state_);
}

void BuildNotice::waiting(long pid) {
  const std::string state = "waiting for " + (pid > 0 ? "process " + std::to_string(pid) : std::string("a process")) +
                            (pid == getpid() ? " (this one)" : "") + ", which builds " + what_;
  if (state != state_ || terminal_) show(state);
  state_ = state;
}

void BuildNotice::finished() {
  if (!terminal_ && drawn_) show("built " + what_);
}

}  // namespace quadrille::tb
