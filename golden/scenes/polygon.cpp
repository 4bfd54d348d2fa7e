#include "golden/scenes/polygon.hpp"

#include "model/support/float113.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

namespace quadrille::golden {
namespace {

/// The polygon seen along an axis, its area positive.
struct Outline {
  std::vector<Vec2> points;

  std::size_t size() const { return points.size(); }
  const Vec2& at(std::size_t i) const { return points[i % points.size()]; }

  /// Sign of the area of a triangle: 1 for a turn to the left.
  int turn(std::size_t i, std::size_t j, std::size_t k) const {
    const Vec2 &a = at(i), &b = at(j), &c = at(k);
    const double left = (b[0] - a[0]) * (c[1] - a[1]), right = (b[1] - a[1]) * (c[0] - a[0]);
    const double area = left - right;
    // Six roundings of at most 2^-53 each, so far from zero the sign is right; near it 113 bits decide.
    if (std::fabs(area) > (std::fabs(left) + std::fabs(right)) * 0x1p-49) return area > 0 ? 1 : -1;
    using Wide = Float113;
    const Wide exact = (Wide{b[0]} - a[0]) * (Wide{c[1]} - a[1]) - (Wide{b[1]} - a[1]) * (Wide{c[0]} - a[0]);
    return (exact > 0) - (exact < 0);
  }
};

Outline outline_of(std::span<const Vec3> corners) {
  Vec3 area{};
  const Vec3& origin = corners.front();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 &p = corners[i], &q = corners[(i + 1) % corners.size()];
    Vec3 a{}, b{};
    for (std::size_t c = 0; c < 3; ++c) a[c] = p[c] - origin[c], b[c] = q[c] - origin[c];
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t d = (c + 1) % 3, e = (c + 2) % 3;
      area[c] += a[d] * b[e] - a[e] * b[d];
    }
  }
  std::size_t axis = 0;
  for (std::size_t c = 1; c < 3; ++c)
    if (std::fabs(area[c]) > std::fabs(area[axis])) axis = c;
  if (area[axis] == 0) throw std::invalid_argument("encloses no area: it is folded flat, or its edges cross");
  std::size_t x = (axis + 1) % 3, y = (axis + 2) % 3;
  if (area[axis] < 0) std::swap(x, y);
  Outline outline;
  for (const Vec3& corner : corners) outline.points.push_back({corner[x], corner[y]});
  return outline;
}

/// No turn to the right, and once around: each coordinate rises once and falls once.
bool convex(const Outline& o) {
  for (std::size_t i = 0; i < o.size(); ++i)
    if (o.turn(i, i + 1, i + 2) < 0) return false;
  for (std::size_t c = 0; c < 2; ++c) {
    int changes = 0, first = 0, last = 0;
    for (std::size_t i = 0; i < o.size(); ++i) {
      const double step = o.at(i + 1)[c] - o.at(i)[c];
      const int direction = (step > 0) - (step < 0);
      if (direction == 0) continue;
      if (first == 0) first = direction;
      changes += last != 0 && direction != last;
      last = direction;
    }
    if (changes + (last != first) > 2) return false;
  }
  return true;
}

void refuse_crossing(const Outline& o) {
  for (std::size_t i = 0; i < o.size(); ++i) {
    for (std::size_t j = i + 2; j < o.size(); ++j) {
      if (o.turn(i, i + 1, j) * o.turn(i, i + 1, j + 1) < 0 && o.turn(j, j + 1, i) * o.turn(j, j + 1, i + 1) < 0) {
        const auto edge = [&](std::size_t k) {
          return std::to_string(k + 1) + "-" + std::to_string((k + 1) % o.size() + 1);
        };
        throw std::invalid_argument("the edges between corners " + edge(i) + " and " + edge(j) + " cross");
      }
    }
  }
}

/// Every triangle of the fan lies inside of a polygon whose edges do not cross.
bool sees_all(const Outline& o, std::size_t start) {
  for (std::size_t i = start + 1; i + 1 < start + o.size(); ++i) {
    const int turn = o.turn(start, i, i + 1);
    if (turn < 0) return false;
    if (turn > 0) continue;
    // On one line with the start: on one side of it, or the edge would run through it.
    const Vec2 &s = o.at(start), &a = o.at(i), &b = o.at(i + 1);
    if ((a[0] - s[0]) * (b[0] - s[0]) + (a[1] - s[1]) * (b[1] - s[1]) < 0) return false;
  }
  return true;
}

class EarCutter {
 public:
  explicit EarCutter(const Outline& outline) : o_(outline), ring_(outline.size()) {
    std::iota(ring_.begin(), ring_.end(), std::size_t{0});
  }

  std::vector<Piece> cut() {
    // A corner without area is cut off too: its neighbours' faces may use it, and a thin triangle leaves no crack.
    while (ring_.size() > 3)
      if (!cut_first(&EarCutter::clear_ear) && !cut_first(&EarCutter::straight) && !cut_first(&EarCutter::touched_ear))
        throw std::invalid_argument("is too warped, or touches itself too often, to be cut into triangles");
    take(1);
    return std::move(pieces_);
  }

 private:
  using Test = bool (EarCutter::*)(std::size_t) const;

  std::size_t ring(std::size_t i) const { return ring_[i % ring_.size()]; }
  std::size_t before(std::size_t i) const { return ring(i + ring_.size() - 1); }

  bool cut_first(Test test) {
    for (std::size_t i = 0; i < ring_.size(); ++i) {
      if (!(this->*test)(i)) continue;
      take(i);
      return true;
    }
    return false;
  }

  void take(std::size_t i) {
    pieces_.push_back({before(i), ring(i), ring(i + 1), ring(i + 1)});
    ring_.erase(ring_.begin() + static_cast<std::ptrdiff_t>(i));
  }

  bool straight(std::size_t i) const { return o_.turn(before(i), ring(i), ring(i + 1)) == 0; }
  bool clear_ear(std::size_t i) const { return ear(i, 0); }
  bool touched_ear(std::size_t i) const { return ear(i, 1); }

  /// A turn to the left, no other corner in its triangle. `least`: 0 counts the triangle's border in, 1 leaves it out.
  bool ear(std::size_t i, int least) const {
    const std::size_t a = before(i), b = ring(i), c = ring(i + 1);
    if (o_.turn(a, b, c) <= 0) return false;
    return std::ranges::none_of(ring_, [&](std::size_t p) {
      const Vec2& point = o_.at(p);
      if (point == o_.at(a) || point == o_.at(b) || point == o_.at(c)) return false;  // themselves, or a bridge's end
      return o_.turn(a, b, p) >= least && o_.turn(b, c, p) >= least && o_.turn(c, a, p) >= least;
    });
  }

  const Outline& o_;
  std::vector<std::size_t> ring_;
  std::vector<Piece> pieces_;
};

}  // namespace

std::vector<Piece> polygon_fan(std::size_t corners, std::size_t start) {
  std::vector<Piece> pieces;
  for (std::size_t i = 1; i + 1 < corners; i += 2) {
    const std::size_t last = std::min(i + 2, corners - 1);
    pieces.push_back({start, (start + i) % corners, (start + i + 1) % corners, (start + last) % corners});
  }
  return pieces;
}

std::vector<Piece> cut_polygon(std::span<const Vec3> corners) {
  const Outline outline = outline_of(corners);
  if (convex(outline)) return polygon_fan(corners.size());
  refuse_crossing(outline);
  for (std::size_t start = 0; start < corners.size(); ++start)
    if (sees_all(outline, start)) return polygon_fan(corners.size(), start);
  return EarCutter(outline).cut();
}

}  // namespace quadrille::golden
