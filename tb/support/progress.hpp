// Progress of a command on standard error. On a terminal: one line, redrawn at most ten times a second, no longer than
// the terminal is wide, wiped at the end. In a log: a plain line every ten seconds, every minute after the first.
// (Debian 12 has no C++ library for this.)
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace quadrille::tb {

class Progress {
 public:
  /// total 0: unknown; then only the count is shown. `enabled` false: does nothing.
  Progress(std::string label, std::uint64_t total, bool enabled);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void set(std::uint64_t done, const std::string& detail = {});
  void finish();

 private:
  std::string label_;
  std::uint64_t total_;
  bool active_, terminal_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point start_, last_;
};

/// What a line says: label, bar (left out where there is no room), part, seconds so far, an estimate of those left once
/// there is something to judge by, detail; cut to `columns`. ASCII: other bytes become '?', since how wide they are is
/// the terminal's secret.
std::string progress_text(const std::string& label, std::uint64_t done, std::uint64_t total, double seconds,
                          const std::string& detail, int columns, bool bar);

}  // namespace quadrille::tb
