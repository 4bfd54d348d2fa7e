#include "tb/judge/vertex_moves.hpp"

#include "tb/judge/climb.hpp"

#include <algorithm>
#include <cmath>

namespace quadrille::tb {
namespace {

using golden::Prng;

/// The attribute of a vertex, in [-1, 1], or its window z, in [0, 1]: anywhere, at an end, or a step away.
void change_value(WindowQuad& quad, Output output, Prng& rng) {
  const std::size_t i = rng.below(4);
  WindowVertex& v = quad.vertex[i];
  const bool depth = output == Output::depth;
  if (depth && v.w == 0) return;
  const double low = depth ? 0 : -1;
  double value = depth ? v.z / v.w : quad.attribute[i][0];
  switch (rng.below(4)) {
    case 0:
      value = rng.chance(0.5) ? low : 1;
      break;
    case 1:
      value = rng.uniform(low, 1);
      break;
    case 2: {
      const WindowVertex& next = quad.vertex[(i + 1) % 4];
      value = !depth ? quad.attribute[(i + 1) % 4][0] : next.w != 0 ? next.z / next.w : value;
      break;
    }
    default:
      value += rng.sign() * rng.log2_spread(-20, -1);
  }
  value = std::clamp(value, low, 1.0);
  (depth ? v.z : quad.attribute[i][0]) = depth ? value * v.w : value;
}

}  // namespace

void move_vertices(WindowQuad& quad, golden::PixelPlace& at, Output output, int width, int height, Prng& rng) {
  if (output != Output::weight && rng.chance(0.3)) {
    change_value(quad, output, rng);
    return;
  }
  const auto step = [&] { return rng.sign() * rng.log2_spread(-9, rng.chance(0.3) ? 8 : 2); };
  const auto moved = [](WindowVertex& v, double dx, double dy) {
    const double scale = v.w != 0 ? std::fabs(v.w) : 1;
    v.x += scale * dx;
    v.y += scale * dy;
  };
  const auto moved_anywhere = [&](WindowVertex& v) {
    const double dy = step();  // a draw each statement: a call's arguments have no order
    moved(v, step(), dy);
  };
  for (std::uint64_t changes = 1 + rng.below(3); changes > 0; --changes) {
    WindowVertex& v = quad.vertex[rng.below(4)];
    switch (rng.below(9)) {
      case 0:
      case 1:
        moved_anywhere(v);
        break;
      case 2:
        moved(v, rng.chance(0.5) ? 1 / 256.0 : -1 / 256.0, 0);
        break;
      case 3:
        moved(v, 0, rng.chance(0.5) ? 1 / 256.0 : -1 / 256.0);
        break;
      case 4: {  // the same position, another w
        const double f = rng.chance(0.5) ? rng.log2_spread(-2, 2) : 1 + rng.uniform(-0.01, 0.01);
        v.x *= f, v.y *= f, v.z *= f, v.w *= f;
        break;
      }
      case 5:
        v.w *= 1 + rng.uniform(-0.1, 0.1);
        break;
      case 6:
        at = near_pixel(at, width, height, rng);
        break;
      case 7: {  // the whole quad against the pixel
        const double dx = step(), dy = step();
        for (WindowVertex& u : quad.vertex) moved(u, dx, dy);
        break;
      }
      default:  // closer to the pixel or farther from it
        if (v.w > 0) {
          const double f = rng.log2_spread(-2, 1), px = at.x + 0.5, py = at.y + 0.5;
          v.x = v.w * (px + (v.x / v.w - px) * f);
          v.y = v.w * (py + (v.y / v.w - py) * f);
        } else {
          moved_anywhere(v);
        }
    }
  }
}

}  // namespace quadrille::tb
