// Corner groups about exact boundaries: boxes at pixel centres, plane quads but for one bit, coarse depth codes and
// depth limits of quads beyond the guard band.
#include "golden/scenes/corner_batch.hpp"
#include "model/port/stages.hpp"

#include <algorithm>
#include <cmath>

namespace quadrille::golden {
namespace {

double code_depth(const Batch& b, double code) { return std::ldexp(code, -b.config.depth_bits); }

std::array<WindowVertex, 4> rectangle(double left, double top, double right, double bottom, double z) {
  return {{{left, top, z, 1}, {left, bottom, z, 1}, {right, bottom, z, 1}, {right, top, z, 1}}};
}

/// A side at a pixel centre, or a unit of the grid before or behind it: in the middle, or at the border of a tile.
double side_at(Batch& b, int last) {
  const double unit = std::ldexp(1.0, -b.config.subpixel_bits);
  const int tile = b.config.tile(), pixel = b.integer(0, last);
  const int place = b.rng.chance(0.5) ? pixel : std::min(last, (pixel / tile) * tile + b.integer(-1, 0));
  return place + 0.5 + unit * b.integer(-1, 1);
}

}  // namespace

void box(Batch& b) {
  const int right = std::min(b.state.width, 40), bottom = std::min(b.state.height, 40);
  for (int count = 0; count < 120; ++count) {
    const double x = side_at(b, right), y = side_at(b, bottom);
    // Half of them of a pixel or two in a direction, so that a side decides whether there is any.
    const double wide = b.rng.chance(0.5) ? side_at(b, right) : x + b.integer(0, 2);
    const double high = b.rng.chance(0.5) ? side_at(b, bottom) : y + b.integer(0, 2);
    b.quads.push_back(rectangle(x, y, wide, high, b.rng.uniform(0.1, 0.9)));
    if (count % 4 == 1) std::swap(b.quads.back()[1], b.quads.back()[3]);
    std::array<WindowVertex, 4>& quad = b.quads.back();
    if (count % 4 == 2)  // the same without a bounding box: it ends beyond the guard band
      quad[2].x = quad[3].x = std::ldexp(1.0, b.config.pos_int() + 1);
    if (count % 4 == 3)
      for (const std::size_t i : {1, 2}) {
        WindowVertex& v = quad[i];
        v = {v.x / 2, v.y / 2, v.z / 2, 0.5};
      }
  }
}

void plane(Batch& b) {
  enum Defect { none, position, sign_of_z, code_of_z, double_z, other_k, kinds };
  for (int count = 0; count < 120; ++count) {
    const int x = b.integer(4, 16), y = b.integer(4, 16);
    const int ux = b.integer(-3, 9), uy = b.integer(4, 9), vx = b.integer(4, 9), vy = b.integer(-3, 3);
    std::array<WindowVertex, 4> quad{{{x + 0.5, y + 0.5, 0, 1},
                                      {x + ux + 0.5, y + uy + 0.5, 0, 1},
                                      {x + ux + vx + 0.5, y + uy + vy + 0.5, 0, 1},
                                      {x + vx + 0.5, y + vy + 0.5, 0, 1}}};
    // Constant along 01 and 23, or along 03 and 12: the one side's depth is the base's.
    const bool along_first = b.rng.chance(0.5);
    const std::array<std::size_t, 2> other =
        along_first ? std::array<std::size_t, 2>{2, 3} : std::array<std::size_t, 2>{1, 2};
    const double base = std::ldexp(b.integer(3, 5), -3), step = b.rng.sign() * std::ldexp(1.0, -b.integer(3, 7));
    for (WindowVertex& v : quad) v.z = base;
    for (const std::size_t i : other) quad[i].z = base + step;
    const std::size_t one = other[b.rng.below(2)];
    switch (static_cast<Defect>(count % kinds)) {
      case position:
        (b.rng.chance(0.5) ? quad[2].x : quad[2].y) += b.rng.sign() * std::ldexp(1.0, -b.config.subpixel_bits);
        break;
      case sign_of_z:
        quad[one].z = base - step;
        break;
      case code_of_z:
        quad[b.rng.below(4)].z += b.rng.sign() * code_depth(b, 1);
        break;
      case double_z:
        quad[one].z = base + 2 * step;
        break;
      case other_k: {  // of one corner, or along the other sides
        const std::size_t first = b.rng.below(4);
        const double w = b.rng.chance(0.5) ? 0.5 : 2;
        for (std::size_t i = first; i < first + (b.rng.chance(0.5) ? 1 : 2); ++i) {
          WindowVertex& v = quad[i % 4];
          v = {v.x * w, v.y * w, v.z * w, w};
        }
        break;
      }
      case none:
      case kinds:
        break;
    }
    b.quads.push_back(quad);
  }
}

std::array<double, 4> plane_values(Batch& b) {
  const double unit = std::ldexp(1.0, -b.config.attribute_frac()),
               step = b.rng.sign() * std::ldexp(1.0, -b.integer(1, 6));
  std::array<double, 4> values{};
  values.fill(std::ldexp(b.integer(-3, 3), -3));
  const bool along_first = b.rng.chance(0.5);
  const std::array<std::size_t, 2> other =
      along_first ? std::array<std::size_t, 2>{2, 3} : std::array<std::size_t, 2>{1, 2};
  for (const std::size_t i : other) values[i] += step;
  const std::size_t one = other[b.rng.below(2)];
  const std::uint64_t kind = b.rng.below(16);
  if (kind == 0) values[one] = values[0] - step;
  if (kind == 1) values[one] += step;
  if (kind == 2) values[1 + b.rng.below(3)] += b.rng.sign() * unit;
  return values;
}

void coarse_depth(Batch& b) {
  const int bits = b.config.hierarchical_z_bits != 0 ? b.config.hierarchical_z_bits : std::min(8, b.config.depth_bits);
  const double coarse = std::ldexp(1.0, b.config.depth_bits - bits), last = std::ldexp(1.0, bits);
  const int tile = b.config.tile();
  double middle = 0;
  for (int count = 0; count < 160; ++count) {
    if (count % 20 == 0) {  // few codes for a while, nearer and nearer: what one hides depends on a code
      constexpr std::array<double, 4> parts{0.75, 1, 0.5, 0};
      const double part = parts[static_cast<std::size_t>(count / 20) % 4];
      middle = part == 0.75 || part == 0.5 ? std::floor(last * part) : part * last;
    }
    const double code = std::clamp(middle + b.integer(-2, 2), 0.0, last) * coarse + b.integer(-1, 1);
    const double z = code_depth(b, code);
    // From tile to tile, of which a few are covered whole.
    const int half = b.rng.chance(0.4) ? tile / 2 : 0;  // two of which make one
    const int x = tile * b.integer(0, 2) + half, y = tile * b.integer(0, 2);
    const int bottom = y + tile * b.integer(1, 3), right = x + tile * b.integer(1, 3);
    std::array<WindowVertex, 4> quad = rectangle(x, y, right, bottom, z);
    if (count % 5 == 4) quad[2].z += code_depth(b, coarse * b.integer(-1, 1) + b.integer(-1, 1));
    if (count % 7 == 6) quad[2].x -= b.integer(1, tile);  // part of a tile
    b.quads.push_back(quad);
  }
}

void far_depth(Batch& b) {
  for (int count = 0; count < 120; ++count) {
    const double limit = depth_code(b.rng.chance(0.5) ? b.state.znear : b.state.zfar, b.config);
    const double reach = std::ldexp(1.0, b.config.pos_int());  // the end of the guard band
    const auto end = [&] { return b.rng.sign() * reach * b.rng.uniform(0.99, 1.5); };
    std::array<WindowVertex, 4> quad = lattice_polygon(b);
    if (count % 3 == 0) {  // around the viewport
      const double far = std::fabs(end());
      quad = {{{-far, -far, 0, 1}, {-far, far, 0, 1}, {far, far, 0, 1}, {far, -far, 0, 1}}};
    } else {  // some corners beyond the guard band
      for (int corner = b.integer(1, 2); corner > 0; --corner) {
        WindowVertex& v = quad[b.rng.below(4)];
        (b.rng.chance(0.5) ? v.x : v.y) = end();
      }
    }
    // On one side of the limit and at it, or on both.
    const int side = b.integer(-1, 1), nearest = b.integer(0, 1);
    for (WindowVertex& v : quad) {
      const int apart =
          b.rng.chance(0.25) ? 1 << b.integer(2, std::max(2, b.config.depth_bits - 4)) : nearest + b.integer(0, 1);
      v.z = code_depth(b, limit + (side == 0 ? b.rng.sign() : side) * apart) * v.w;
    }
    if (count % 4 == 3) {
      WindowVertex& v = quad[b.rng.below(4)];
      v = {-v.x / 4, -v.y / 4, -v.z / 4, -v.w / 4};  // behind the eye: its depth lies anywhere
    }
    b.quads.push_back(quad);
  }
}

}  // namespace quadrille::golden
