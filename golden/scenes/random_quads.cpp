#include "golden/scenes/random_quads.hpp"

#include "model/port/draw_state.hpp"
#include "model/port/snap.hpp"
#include "model/support/prng.hpp"

#include <algorithm>
#include <cmath>

namespace quadrille::tb {

namespace {

int pick(golden::Prng& random, int low, int high) { return static_cast<int>(random.integer(low, high)); }

/// Window depths within 2^-1 to 2^-26 of the first vertex's, or all equal.
void draw_depths_together(golden::Prng& random, WindowQuad& q) {
  const WindowVertex& first = q.vertex[0];
  const double depth = first.w == 0 ? 0.5 : first.z / first.w;
  const double part = random.chance(0.25) ? 0 : std::exp2(random.uniform(-26, -1));
  for (WindowVertex& v : q.vertex) v.z = depth * v.w + part * (v.z - depth * v.w);
}

/// An attribute of any magnitude at each vertex, or one of any magnitude and others close to it or equal.
void add_attribute(golden::Prng& random, WindowQuad& q, double limit) {
  const auto any = [&] {
    const double magnitude = limit * std::exp2(random.uniform(-12, -0.01));
    return random.chance(0.1) ? 0.0 : (random.chance(0.5) ? magnitude : -magnitude);
  };
  const bool together = random.chance(0.25);
  const double first = any(), part = together && random.chance(0.75) ? std::exp2(random.uniform(-32, -1)) : 0;
  for (std::size_t i = 0; i < 4; ++i)
    q.attribute[i].push_back(i == 0 ? first : together ? first - part * random.uniform() * first : any());
}

/// One quad of family `family`, positions within `edge` pixels.
WindowQuad random_quad(golden::Prng& random, int family, double edge, int attributes, double attribute_limit) {
  WindowQuad q;
  const double size = family == 3 ? random.uniform(0.2, 4) : random.uniform(2, 24);
  const double cx = random.uniform(0, edge), cy = random.uniform(0, edge);
  for (WindowVertex& v : q.vertex) {
    v = {cx + random.uniform(-size, size), cy + random.uniform(-size, size), random.uniform(0.05, 0.95), 1.0};
  }
  const auto whole = [&](double scale) {
    for (WindowVertex& v : q.vertex) {
      v.x = std::floor(v.x / scale) * scale + 0.5;
      v.y = std::floor(v.y / scale) * scale + 0.5;
    }
  };
  const auto perspective = [&](int i, double w) {
    WindowVertex& v = q.vertex[static_cast<std::size_t>(i)];
    v = {v.x * w, v.y * w, v.z * w, w};
  };
  switch (family) {
    case 1: {  // a bow-tie whose edges 01 and 23 cross at a pixel centre
      const double x = std::floor(cx) + 0.5, y = std::floor(cy) + 0.5;
      const double a = pick(random, -9, 9), b = pick(random, -9, 9), c = pick(random, -9, 9), d = pick(random, -9, 9);
      const double place[4][2] = {{x - a, y - b}, {x + a, y + b}, {x - c, y - d}, {x + c, y + d}};
      for (std::size_t i = 0; i < 4; ++i) {
        q.vertex[i].x = place[i][0];
        q.vertex[i].y = place[i][1];
      }
      break;
    }
    case 2:  // pixel centres everywhere
      whole(1);
      break;
    case 4:  // many pixels on edges and crossings
      whole(4);
      break;
    case 5:  // a collapsed edge
      whole(1);
      q.vertex[static_cast<std::size_t>(pick(random, 0, 3))] = q.vertex[static_cast<std::size_t>(pick(random, 0, 3))];
      break;
    case 6:  // a triangle
      q.vertex[3] = q.vertex[2];
      break;
    case 7:  // perspective, in front of the eye
      for (int i = 0; i < 4; ++i) perspective(i, std::exp2(random.uniform(-3, 3)));
      break;
    case 8:  // w of any sign
      for (int i = 0; i < 4; ++i) perspective(i, random.uniform(-1, 1));
      break;
    case 9:  // one or two vertices behind the eye
      for (int i = 0; i < pick(random, 1, 2); ++i) {
        const double w = random.uniform(-1, -0.1);
        perspective(pick(random, 0, 3), w);
      }
      break;
    case 10: {  // at infinity
      WindowVertex& v = q.vertex[static_cast<std::size_t>(pick(random, 0, 3))];
      v = {v.x - edge / 2, v.y - edge / 2, 0.5, 0.0};
      break;
    }
    case 11:  // mostly or wholly off screen
      for (WindowVertex& v : q.vertex) {
        v.x = (v.x - edge / 2) * 4;
        v.y = (v.y - edge / 2) * 4;
      }
      break;
    case 12: {  // a thin notch
      q.vertex[2] = {(q.vertex[1].x + q.vertex[3].x) / 2 + random.uniform(-0.05, 0.05),
                     (q.vertex[1].y + q.vertex[3].y) / 2 + random.uniform(-0.05, 0.05), 0.5, 1.0};
      break;
    }
    case 13:  // depth outside, for the discard
      for (WindowVertex& v : q.vertex) v.z = random.uniform(-0.5, 1.5);
      break;
    default:
      break;
  }
  if (random.chance(0.25)) draw_depths_together(random, q);
  for (int j = 0; j < attributes; ++j) add_attribute(random, q, attribute_limit);
  if (family == 6) q.attribute[3] = q.attribute[2];
  return q;
}

/// What no vertices give and the output must clamp: attributes four times as large as the format holds, bases of other
/// quads, corner codes that have nothing to do with the depths.
void change_at_port(golden::Prng& random, SnappedQuad& quad, const Config& config) {
  QuadBase& base = quad.base;
  if (random.chance(0.5))
    for (SnappedVertex& v : quad.vertex)
      for (PortNumber& b : v.attribute)
        if (b.sig != 0) b.exp += 2;
  if (random.chance(0.5))
    for (std::int64_t& code : base.attribute)
      if (code != 0) code = random.integer(-config.attribute_limit(), config.attribute_limit());
  const std::int32_t one = std::int32_t{1} << config.depth_bits;
  if (random.chance(0.5)) base.depth = static_cast<std::uint32_t>(random.integer(0, one));
  if (random.chance(0.5)) {
    base.depth_low = pick(random, -1, one + 1);
    base.depth_high = pick(random, base.depth_low, one + 1);
  }
}

}  // namespace

DrawState small_state(const Config& config, int edge) {
  const int side = std::min(edge, 1 << config.viewport_bits);
  return draw_state_for(config, side, side);
}

std::vector<SnappedQuad> random_quads(const Config& config, const DrawState& state, std::uint64_t seed, int count) {
  golden::Prng random(seed, 3);
  std::vector<SnappedQuad> quads;
  while (static_cast<int>(quads.size()) < count) {
    WindowQuad quad = random_quad(random, pick(random, 0, 13), state.width, state.attributes,
                                  std::ldexp(1.0, config.attribute_int_bits));
    quad.id = static_cast<std::uint32_t>(quads.size());
    try {
      SnappedQuad snapped = snap_quad(quad, config, state);
      if (random.chance(0.15)) change_at_port(random, snapped, config);
      quads.push_back(snapped);
    } catch (const SnapError&) {  // no point of the machine's space: draw another
    }
  }
  return quads;
}

}  // namespace quadrille::tb
