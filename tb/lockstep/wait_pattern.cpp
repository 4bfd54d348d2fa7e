#include "tb/lockstep/wait_pattern.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace quadrille::tb {

namespace {

constexpr std::array<std::string_view, 5> names{"chance", "bursts", "sparse", "locked", "mixed"};
constexpr std::uint64_t input_stream = 5, output_stream = 6;

}  // namespace

std::span<const std::string_view> wait_kind_names() { return names; }

WaitKind parse_wait_kind(std::string_view name) {
  const auto found = std::ranges::find(names, name);
  if (found != names.end()) return static_cast<WaitKind>(found - names.begin());
  std::string list;
  for (const std::string_view known : names) list += (list.empty() ? "" : ", ") + std::string(known);
  throw std::invalid_argument("\"" + std::string(name) + "\": expected one of " + list);
}

WaitPattern::WaitPattern(WaitKind kind, Port port, std::uint64_t seed)
    : kind_(kind), now_(kind), port_(port), random_(seed, port == Port::input ? input_stream : output_stream) {}

/// What holds for the next stretch.
void WaitPattern::choose() {
  const bool input = port_ == Port::input;
  stretch_ = input ? 16 + random_.below(64) : 64 + random_.below(512);
  if (kind_ == WaitKind::mixed) now_ = static_cast<WaitKind>(random_.below(4));
  chance_ = now_ == WaitKind::sparse ? (input ? 0.97 : 0.93) : 0.3 * static_cast<double>(random_.below(3));
  // A quad's beats one after the other, then a wait: the next quad meets every step of the one before.
  by_quad_ = input && random_.chance(0.5);
  period_ = input ? (by_quad_ ? 1 + random_.below(160) : 1 + random_.below(48)) : 2 + random_.below(20);
  waits_ = run_ = 0;
}

/// A run without waits, then one with.
void WaitPattern::choose_run() {
  const bool input = port_ == Port::input;
  run_ = input ? 4 * (1 + random_.below(12)) : 1 + random_.below(60);
  waits_ = 1 + random_.below(random_.chance(0.5) ? 16 : input ? 400 : 120);
}

bool WaitPattern::draw() {
  switch (now_) {
    case WaitKind::chance:
    case WaitKind::sparse:
      return random_.chance(chance_);
    case WaitKind::bursts:
      if (run_ == 0 && waits_ == 0) choose_run();
      if (run_ == 0) return --waits_, true;
      return --run_, false;
    case WaitKind::locked:
      if (waits_ > 0) return --waits_, true;
      // Behind this clock without a wait: of a quad's first three beats none.
      if (!by_quad_ || beats_ % 4 == 3) waits_ = period_ - 1;
      return false;
    case WaitKind::mixed:
      break;
  }
  return false;
}

bool WaitPattern::next() {
  if (stretch_ == 0) choose();
  const bool waits = draw();
  beats_ += waits ? 0 : 1;
  // The input's stretches are of beats: how long a beat waits must not matter, nor must how soon it is taken.
  if (port_ == Port::output || !waits) --stretch_;
  return waits;
}

}  // namespace quadrille::tb
