// How work over quads and over blocks is cut into units for threads, and how it is ended before its end.
#pragma once

#include <atomic>
#include <cstddef>
#include <stdexcept>

namespace quadrille::sweep {

/// Units of `per_unit` that hold `n`; the last may be smaller.
constexpr std::size_t units_of(std::size_t n, std::size_t per_unit) { return (n + per_unit - 1) / per_unit; }

/// Thrown by work that was asked to end.
struct Stopped : std::runtime_error {
  Stopped() : std::runtime_error("stopped") {}
};

/// A request, from any thread, that long work end; asked for before each unit. Without a flag there is none.
struct Stop {
  const std::atomic<bool>* flag = nullptr;

  void check() const {
    if (flag != nullptr && *flag) throw Stopped();
  }
};

}  // namespace quadrille::sweep
