// A progress line on standard error: only when that is a terminal, at most ten times a second, wiped at the end.
// (Debian 12 has no C++ library for this.)
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>

namespace quadrille::cli {

class Progress {
 public:
  /// total 0: unknown; then only the count is shown. `enabled` false or no terminal: does nothing.
  Progress(std::string label, std::uint64_t total, bool enabled);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void set(std::uint64_t done, const std::string& detail = {});
  void finish();

 private:
  std::string label_;
  std::uint64_t total_;
  bool active_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point start_, last_;
};

}  // namespace quadrille::cli
