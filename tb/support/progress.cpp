#include "tb/support/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace quadrille::cli {

Progress::Progress(std::string label, std::uint64_t total, bool enabled)
    : label_(std::move(label)),
      total_(total),
      active_(enabled && isatty(STDERR_FILENO) != 0),
      start_(std::chrono::steady_clock::now()),
      last_(start_) {}

Progress::~Progress() { finish(); }

void Progress::set(std::uint64_t done, const std::string& detail) {
  if (!active_) return;
  const auto now = std::chrono::steady_clock::now();
  if (now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  drawn_ = true;
  const double seconds = std::chrono::duration<double>(now - start_).count();
  if (total_ == 0) {
    std::fprintf(stderr, "\r\033[K%s  %llu  %.0f s  %s", label_.c_str(), static_cast<unsigned long long>(done), seconds,
                 detail.c_str());
  } else {
    constexpr int width = 32;
    const double part = std::clamp(static_cast<double>(done) / static_cast<double>(total_), 0.0, 1.0);
    const int filled = static_cast<int>(part * width);
    std::string bar(static_cast<std::size_t>(filled), '#');
    bar.resize(width, '.');
    const double left = part > 0 ? seconds * (1 - part) / part : 0;
    std::fprintf(stderr, "\r\033[K%s  [%s] %3.0f %%  %.0f s, about %.0f s left  %s", label_.c_str(), bar.c_str(),
                 part * 100, seconds, left, detail.c_str());
  }
  std::fflush(stderr);
}

void Progress::finish() {
  if (drawn_) std::fputs("\r\033[K", stderr);
  drawn_ = false;
}

}  // namespace quadrille::cli
