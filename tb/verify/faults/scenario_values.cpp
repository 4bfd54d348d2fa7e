#include "golden/scenes/random_quads.hpp"
#include "tb/verify/faults/scenario_draws.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace quadrille::tb {

/// Values at and beyond the ends of their formats, and values that are constant: bases of every kind. Attributes: one
/// for all corners, at an end of the format with differences of a code or less, at opposite ends, any. Depths: one for
/// all corners, at znear or zfar, below 0, above 1. Of some the codes of the corners are others than snapping gives.
Scenario bases() {
  LockstepOptions o = options(exact(), 48);
  o.state.znear = 0.25;
  o.state.zfar = 0.75;
  Scenario scenario{
      "bases", o, drawn(o, 18, 300, [&](golden::Prng& random) {
        static constexpr double w[]{1, 1, 1, 1, 1, 1, 0.5, -1};
        WindowQuad quad = on_grid(random, 9, w);
        const std::uint64_t depths = random.below(6);
        const double one = depths == 1 ? 0.25 : depths == 2 ? 0.75 : random.uniform(-0.2, 1.2);
        for (WindowVertex& v : quad.vertex)
          v.z = (depths < 4 ? one : random.uniform(depths == 4 ? -2 : 0, depths == 4 ? 3 : 1)) * v.w;
        const double end = std::ldexp(1, o.config.attribute_int_bits), code = std::ldexp(1, -o.config.attribute_frac());
        for (int j = 0; j < o.config.attribute_slots; ++j) {
          const std::uint64_t kind = random.below(5);
          const double any = random.uniform(-7, 7), side = random.chance(0.5) ? 1 : -1,
                       near_end = code * random.uniform(0.01, 1.3);
          for (std::size_t i = 0; i < 4; ++i) {
            const double at = kind == 0   ? any
                              : kind == 1 ? side * (end - (i == 0 ? near_end : code * 0.01))
                              : kind == 2 ? (random.chance(0.5) ? 1 : -1) * random.uniform(0.8, 0.999) * end
                                          : random.uniform(-7, 7);
            quad.attribute[i].push_back(at);
          }
        }
        return quad;
      })};
  golden::Prng random(19);
  const int one = 1 << o.config.depth_bits;
  for (SnappedQuad& quad : scenario.quads) {
    // Vertex 0's attributes are not looked at.
    for (PortNumber& number : quad.vertex[0].attribute)
      number = {random.chance(0.5), static_cast<std::int32_t>(random.integer(-9, 6)),
                std::uint32_t{1} << (o.config.significand_bits - 1)};
    if (!random.chance(0.3)) continue;
    const auto code = [&] { return static_cast<std::int32_t>(random.integer(-1, one + 1)); };
    std::tie(quad.base.depth_low, quad.base.depth_high) = std::minmax({code(), code()});
  }
  return scenario;
}

/// Upright rectangles whose values are constant along one pair of sides or the other, some of them but for a bit of one
/// value or a step of one corner; a slot that is not in use differs everywhere.
Scenario sprites() {
  LockstepOptions o = options(plane_weights(), 64);
  o.state.skip |= skip_plane;
  o.state.attributes = 2;
  golden::Prng random(40);
  Scenario scenario{"sprites", o, {}};
  for (std::uint32_t id = 0; id < 200; ++id) {
    WindowQuad quad;
    quad.id = id;
    const bool on_centres = random.chance(0.5);
    const double offset = on_centres ? 0.5 : 0, grid = on_centres ? 1 : 0.0625;
    const auto up_to = [&](double low, double high) { return std::floor(random.uniform(low, high) / grid) * grid; };
    const double x = std::floor(random.uniform(0, 60)) + offset, y = std::floor(random.uniform(0, 60)) + offset,
                 width = up_to(1, 9), height = up_to(1, 9);
    quad.vertex = {{{x, y, 0, 1}, {x + width, y, 0, 1}, {x + width, y + height, 0, 1}, {x, y + height, 0, 1}}};
    const auto constant_along = [&](int pair) {  // 0: v0 = v1, v2 = v3; 1: v0 = v3, v1 = v2
      const double one = random.uniform(0.1, 0.9), other = random.uniform(0.1, 0.9);
      return pair == 0 ? std::array{one, one, other, other} : std::array{one, other, other, one};
    };
    const auto depth = constant_along(static_cast<int>(random.below(2)));
    for (std::size_t i = 0; i < 4; ++i) quad.vertex[i].z = depth[i];
    for (int j = 0; j < o.config.attribute_slots; ++j) {
      const auto value = constant_along(static_cast<int>(random.below(2)));
      for (std::size_t i = 0; i < 4; ++i)
        quad.attribute[i].push_back(j < o.state.attributes ? value[i] : random.uniform(-7, 7));
    }
    SnappedQuad snapped = snap_quad(quad, o.config, o.state);
    SnappedVertex& v = snapped.vertex[random.below(4)];
    const int far = random.chance(0.5) ? 2 << o.config.frac() : 1;
    const auto value = [&](PortNumber& number) -> PortNumber& {  // constant ones are zeros: then the least that differs
      if (number.sig == 0) number = {false, -20, std::uint32_t{1} << (o.config.significand_bits - 1)};
      return number;
    };
    switch (random.below(12)) {
      case 0:
        v.x += far;
        break;
      case 1:
        v.y -= far;
        break;
      case 2:
        value(v.z).sig ^= 1;
        break;
      case 3:
        value(v.attribute[random.below(2)]).sig ^= 1;
        break;
      case 4:
        value(v.attribute[random.below(2)]).neg = true;
        break;
      case 5:
        value(v.attribute[random.below(2)]).exp -= 1;
        break;
      default:
        break;
    }
    scenario.quads.push_back(snapped);
  }
  return scenario;
}

/// The first clocks after reset, from registers that held anything.
Scenario after_reset(std::uint64_t seed) {
  Scenario scenario = sprites();
  scenario.name = "after reset, " + std::to_string(seed);
  scenario.options.seed = seed;
  scenario.quads.resize(4);
  return scenario;
}

/// A scissor rectangle far from the origin and quads about its borders: coordinates with many bits.
Scenario far_scissor() {
  LockstepOptions o = options(exact(), 1400);
  o.state.scissor_x0 = 1290;
  o.state.scissor_x1 = 1347;
  o.state.scissor_y0 = 771;
  o.state.scissor_y1 = 830;
  o.state.attributes = 1;
  return {"far scissor", o, drawn(o, 13, 80, [](golden::Prng& random) {
            const double x = random.uniform(1280, 1357), y = random.uniform(761, 840), size = random.uniform(2, 20);
            WindowQuad quad;
            for (WindowVertex& v : quad.vertex)
              v = {x + random.uniform(-size, size), y + random.uniform(-size, size), random.uniform(0.1, 0.9), 1};
            return quad;
          })};
}

/// Quads with W = ONE/2 at two corners, which have no bounding box, in and around a scissor that lies over three
/// columns of blocks far from the first one, and begins in a row of blocks that the walk goes through to the left.
Scenario far_scissor_homogeneous() {
  LockstepOptions o = options(exact(), 400);
  o.state.scissor_x0 = 211;
  o.state.scissor_x1 = 347;
  o.state.scissor_y0 = 87;
  o.state.scissor_y1 = 140;
  o.state.attributes = 1;
  o.stall = 0.1;
  Scenario result{
      "far scissor, homogeneous", o, drawn(o, 14, 40, [](golden::Prng& random) {
        const double x = random.uniform(190, 360), y = random.uniform(75, 150), size = random.uniform(4, 60);
        WindowQuad quad;
        for (WindowVertex& v : quad.vertex)
          v = {x + random.uniform(-size, size), y + random.uniform(-size, size), random.uniform(0.1, 0.9), 1};
        return quad;
      })};
  for (SnappedQuad& quad : result.quads) halve(quad);
  return result;
}

/// Exponents at the limits of the port, which snapping never gives.
Scenario far_exponents() {
  LockstepOptions o = options(exact(), 32);
  Scenario scenario{"far exponents", o, random_quads(o.config, o.state, 42, 120)};
  golden::Prng random(43);
  constexpr int limit = 1 << (Config::port_exp_bits - 1);
  const auto at_limit = [&](PortNumber& number) {
    if (number.sig != 0 && random.chance(0.5)) number.exp = random.chance(0.5) ? limit - 1 : -limit;
  };
  for (SnappedQuad& quad : scenario.quads)
    for (SnappedVertex& v : quad.vertex) {
      at_limit(v.k);
      at_limit(v.z);
      for (PortNumber& number : v.attribute) at_limit(number);
    }
  return scenario;
}

/// Without perspective, a corner at infinity: a weight of 0. Of half of the quads an edge goes there from far away,
/// through pixel centres where another edge crosses it.
Scenario flat_at_infinity() {
  LockstepOptions o = options(exact(), 16);
  o.state.perspective = false;
  static constexpr double w[]{1};
  Scenario scenario{"flat, at infinity", o, drawn(o, 14, 400, [](golden::Prng& random) {
                      WindowQuad quad = on_grid(random, 5, w);
                      while (corners_meet(quad)) quad = on_grid(random, 5, w);
                      WindowVertex& v = quad.vertex[random.below(4)];
                      v.x = static_cast<double>(random.integer(-2, 2));
                      v.y = static_cast<double>(random.integer(0, 1)) * 2 - 1;
                      v.w = 0;
                      return quad;
                    })};
  golden::Prng random(15);
  const int frac = o.config.frac(), limit = 1 << (o.config.viewport_bits + o.config.guard_bits + frac);
  for (std::size_t n = 0; n < scenario.quads.size(); n += 2) {
    const auto whole = [&](int low, int high) { return static_cast<int>(random.integer(low, high)); };
    const int x = whole(3, 12), y = whole(3, 12), dx = whole(-1, 1), dy = dx == 0 ? 1 : whole(-1, 1);
    const int weight = 1 << (frac - whole(3, 9)), away = limit / 2 - (whole(0, 1000) << frac);
    const std::size_t first = random.below(4);
    std::array<SnappedVertex, 4>& v = scenario.quads[n].vertex;
    const auto place = [&](std::size_t i, int at_x, int at_y, int at_w) {
      SnappedVertex& corner = v[(first + i) % 4];
      corner.x = at_x;
      corner.y = at_y;
      corner.w = at_w;
    };
    place(0, weight * x - away * dx, weight * y - away * dy, weight);
    place(1, limit / 2 * dx, limit / 2 * dy, 0);
    const int across = whole(1, 9), along = whole(-2, 2);
    const int ex = -dy * across + dx * along, ey = dx * across + dy * along;
    place(2, (x + ex) << frac, (y + ey) << frac, 1 << frac);
    place(3, (x - ex) << frac, (y - ey) << frac, 1 << frac);
  }
  return scenario;
}

}  // namespace quadrille::tb
