// When a port waits: at a chance in each clock, or in patterns that a chance hardly meets.
#pragma once

#include "model/support/prng.hpp"

#include <cstdint>
#include <span>
#include <string_view>

namespace quadrille::tb {

enum class WaitKind {
  chance,  ///< each clock by itself
  bursts,  ///< runs without a wait, then long ones
  sparse,  ///< nearly always
  locked,  ///< every so many clocks, or between quads alone: the same number for a while, then another
  mixed,   ///< all of these and none, in turn
};

/// Names in the order of the enumeration.
std::span<const std::string_view> wait_kind_names();
/// Throws std::invalid_argument listing the names.
WaitKind parse_wait_kind(std::string_view name);

/// The waits of one port, clock by clock, by seed.
class WaitPattern {
 public:
  /// Of the input: waits before a beat. Of the output: clocks without ready.
  enum class Port { input, output };
  WaitPattern(WaitKind kind, Port port, std::uint64_t seed);

  /// Whether this clock waits. Of the input a beat is offered in each clock that does not.
  bool next();

 private:
  void choose();
  void choose_run();
  bool draw();

  WaitKind kind_, now_;  ///< now_: of `mixed`, which one
  Port port_;
  golden::Prng random_;
  double chance_ = 0;
  std::uint64_t stretch_ = 0;          ///< clocks or beats until something else is chosen
  std::uint64_t run_ = 0, waits_ = 0;  ///< left of a run without waits, and of one with
  std::uint64_t period_ = 1;
  std::uint64_t beats_ = 0;  ///< clocks without a wait so far
  bool by_quad_ = false;
};

}  // namespace quadrille::tb
