// Says on standard error what is being built on demand, from the first second: on a terminal one line that changes, in
// a log a plain line at the start, at each step and at the end. There is no estimate of the rest: nearly all the time
// goes into one step.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace quadrille::tb {

class BuildNotice {
 public:
  /// `what`: "the simulator of significand_bits=20 with probes".
  explicit BuildNotice(std::string what);
  ~BuildNotice();
  BuildNotice(const BuildNotice&) = delete;
  BuildNotice& operator=(const BuildNotice&) = delete;

  /// The building starts, with so many steps.
  void start(std::size_t total);
  /// So many of them are done.
  void done(std::size_t steps, std::size_t total);
  /// To be called about every second: the time that has passed.
  void tick();
  /// Process `pid` (0: unknown) builds the same thing; to be called again and again.
  void waiting(long pid);
  void finished();

  /// A line by itself.
  static void say(const std::string& text);

  /// No program of this process says anything from now on (--quiet).
  static void silence();

 private:
  double seconds() const;
  void show(const std::string& text);

  std::string what_, state_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  bool terminal_, drawn_ = false;
};

}  // namespace quadrille::tb
