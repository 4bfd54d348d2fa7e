// Climbing: the highest candidate so far, from which the next one is made.
#pragma once

#include "golden/reference/truth.hpp"
#include "model/port/records.hpp"
#include "model/support/prng.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace quadrille::tb {

/// `Measure` gives a candidate's height, negative for one that does not count.
template <class Candidate, class Measure>
class Climb {
 public:
  Climb(Candidate first, Measure measure) : best_(std::move(first)), measure_(std::move(measure)) {}

  const Candidate& best() const { return best_; }
  double height() const { return height_; }
  std::uint64_t evaluations() const { return evaluations_; }

  /// One of many starts: a later one of the same height does not replace it. Returns its height.
  double start(const Candidate& c) {
    const double height = look(c);
    if (height > height_) take(c, height);
    return height;
  }
  /// One made from the best: of the same height it replaces it, so that a level is crossed.
  void step(const Candidate& c) {
    const double height = look(c);
    if (height >= height_) take(c, height);
  }

 private:
  double look(const Candidate& c) {
    ++evaluations_;
    return measure_(c);
  }
  void take(const Candidate& c, double height) {
    best_ = c;
    height_ = height;
  }

  Candidate best_;
  Measure measure_;
  double height_ = -1;
  std::uint64_t evaluations_ = 0;
};

/// Where a quad's pixels may be: around an ordinary quad, else the whole viewport.
class PixelBox {
 public:
  PixelBox(const WindowQuad& quad, int width, int height) : last_{width - 1, height - 1} {
    for (std::size_t axis = 0; axis < 2; ++axis) hi_[axis] = last_[axis];
    if (!std::ranges::all_of(quad.vertex, [](const WindowVertex& v) { return v.w > 0; })) return;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      double low = last_[axis] + 1, high = 0;
      for (const WindowVertex& v : quad.vertex) {
        low = std::min(low, (axis == 0 ? v.x : v.y) / v.w);
        high = std::max(high, (axis == 0 ? v.x : v.y) / v.w);
      }
      lo_[axis] = std::max(0.0, std::floor(low) - 1);
      hi_[axis] = std::min<double>(last_[axis], std::ceil(high));
    }
  }

  golden::PixelPlace pick(golden::Prng& rng) const {
    const auto along = [&](std::size_t axis) {
      return std::clamp(static_cast<int>(rng.uniform(lo_[axis], hi_[axis] + 1)), 0, last_[axis]);
    };
    const int x = along(0);
    return {x, along(1)};
  }

 private:
  int last_[2];
  double lo_[2]{0, 0}, hi_[2]{};
};

/// A pixel up to three away.
inline golden::PixelPlace near_pixel(golden::PixelPlace from, int width, int height, golden::Prng& rng) {
  const int x = std::clamp(from.x + static_cast<int>(rng.integer(-3, 3)), 0, width - 1);
  return {x, std::clamp(from.y + static_cast<int>(rng.integer(-3, 3)), 0, height - 1)};
}

}  // namespace quadrille::tb
