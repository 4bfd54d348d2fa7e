#include "tb/support/progress.hpp"

#include "golden/io/text_input.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace quadrille::tb {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// Asked each time, since windows are resized; 80 where the terminal does not know.
int terminal_columns() {
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

std::string whole(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f", value);
  return text;
}

}  // namespace

std::string progress_text(const std::string& label, std::uint64_t done, std::uint64_t total, double elapsed,
                          const std::string& detail, int columns, bool bar) {
  constexpr int widest_bar = 32, narrowest_bar = 8;
  constexpr double judged_part = 0.02, judged_seconds = 2;
  std::string after;
  if (total == 0) {
    after = std::to_string(done) + "  " + whole(elapsed) + " s";
    bar = false;
  } else {
    const double part = std::clamp(static_cast<double>(done) / static_cast<double>(total), 0.0, 1.0);
    after = whole(100 * part) + " %  " + whole(elapsed) + " s";
    if (part >= judged_part && elapsed >= judged_seconds)
      after += ", about " + whole(elapsed * (1 - part) / part) + " s left";
  }
  if (!detail.empty()) after += "  " + detail;

  std::string text = label + "  ";
  const int room = columns - static_cast<int>(text.size() + after.size()) - 3;  // brackets and a blank
  if (bar && room >= narrowest_bar) {
    const int width = std::min(room, widest_bar);
    const auto filled = static_cast<std::size_t>(
        static_cast<double>(width) * static_cast<double>(std::min(done, total)) / static_cast<double>(total));
    text += "[" + std::string(filled, '#') + std::string(static_cast<std::size_t>(width) - filled, '.') + "] ";
  }
  text = golden::printable(text + after);
  text.resize(std::min(text.size(), static_cast<std::size_t>(std::max(columns, 0))));
  return text;
}

Progress::Progress(std::string label, std::uint64_t total, bool enabled)
    : label_(std::move(label)),
      total_(total),
      active_(enabled),
      terminal_(isatty(STDERR_FILENO) != 0),
      start_(std::chrono::steady_clock::now()),
      last_(start_) {}

Progress::~Progress() { finish(); }

void Progress::set(std::uint64_t done, const std::string& detail) {
  if (!active_) return;
  const auto now = std::chrono::steady_clock::now();
  const auto pause = terminal_ ? milliseconds(100) : now - start_ < seconds(70) ? seconds(10) : seconds(60);
  if (now - last_ < pause) return;
  last_ = now;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  if (terminal_) {
    // The last column stays free: a cursor beyond it would be on the next line.
    const std::string text = progress_text(label_, done, total_, elapsed, detail, terminal_columns() - 1, true);
    std::fprintf(stderr, "\r\033[K%s", text.c_str());
    drawn_ = true;
  } else {
    constexpr int log_columns = 160;
    std::fprintf(stderr, "%s\n", progress_text(label_, done, total_, elapsed, detail, log_columns, false).c_str());
  }
  std::fflush(stderr);
}

void Progress::finish() {
  if (drawn_) std::fputs("\r\033[K", stderr);
  drawn_ = false;
}

}  // namespace quadrille::tb
