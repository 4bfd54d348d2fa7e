#include "tb/verify/faults/scenario_draws.hpp"

#include <array>
#include <cmath>

namespace quadrille::tb {
namespace {

LockstepOptions hidden(const Config& config, int edge) {
  LockstepOptions o = options(config, edge);
  o.state.attributes = 1;
  o.state.skip |= skip_hidden;
  return o;
}

}  // namespace

/// Layers over the whole viewport, some of them at an angle, a few codes apart: hidden or just not, by codes of a few
/// steps of the depths; some hide nothing, being outside znear and zfar or partly so, culled or not all over a tile.
/// Then level ones before all others, each twice, the second time a quarter of a code nearer: seen, though their codes
/// are alike.
Scenario layers() {
  LockstepOptions o = options(hiding(), 72);  // more tiles than places
  o.state.attributes = 1;
  o.state.skip = skip_hidden;  // quads turned away are walked
  o.state.znear = 0.2;
  o.state.zfar = 0.75;
  o.state.cull = Cull::front;
  o.state.scissor_x0 = 3;
  o.state.scissor_y1 = 70;
  o.stall = 0.2;
  constexpr int first_level = 140;
  return {"layers", o, drawn(o, 8, 160, [n = 0, quad = WindowQuad{}](golden::Prng& random) mutable {
            const int level = n++ - first_level;
            if (level >= 0 && level % 2 == 1) {
              for (WindowVertex& v : quad.vertex) v.z -= std::ldexp(1, -14);
              return quad;
            }
            quad = {};
            const double step = std::ldexp(1, -13), z = random.chance(0.7)
                                                            ? 0.4 + step * std::floor(64 * random.uniform())
                                                            : random.uniform(0.1, random.chance(0.3) ? 0.22 : 0.9);
            const double left = random.uniform(-20, 30), top = random.uniform(-20, 30), width = random.uniform(30, 90),
                         height = random.uniform(30, 90), lean = random.chance(0.3) ? 0 : random.uniform(-9, 9);
            quad.vertex = {{{left, top + lean, z, 1},
                            {left + lean, top + height, z + step, 1},
                            {left + width, top + height + lean, z + step * random.uniform(), 1},
                            {left + width, top, z, 1}}};
            if (random.chance(0.2)) quad.vertex[2].z += random.uniform(-0.3, 0.3);
            if (z < 0.22) quad.vertex[2].z -= random.uniform(0, 0.4);  // some below 0
            if (random.chance(0.15)) std::swap(quad.vertex[1], quad.vertex[3]);
            if (random.chance(0.1)) std::swap(quad.vertex[0], quad.vertex[1]);
            if (level >= 0)
              for (WindowVertex& v : quad.vertex) v.z = std::ldexp(853.4 - level, -12);
            return quad;
          })};
}

/// The same while clears come that must be ignored, for they come while the machine is busy, but for a few, and flushes
/// that begin quads anew.
Scenario flushes_and_clears() {
  Scenario scenario = layers();
  scenario.name = "flushes and clears";
  scenario.options.gap = 0.2;
  scenario.options.clear = 0.1;
  scenario.options.flush = 0.1;
  return scenario;
}

/// Rectangles over some blocks of tiles, the borders of many half a tile from a block's: of a few depths, so that some
/// are as far as what is before them; `near_together` of fewer, with codes between them that margins keep apart.
Scenario block_layers(const std::string& name, bool near_together) {
  LockstepOptions o = hidden(hiding_blocks(), 168);
  o.state.height = o.state.scissor_y1 = 36;
  o.stall = 0.2;
  return {name, o, drawn(o, 21, 160, [near_together](golden::Prng& random) {
            const auto border = [&random](int blocks) {
              const double at = 32 * static_cast<double>(random.below(static_cast<std::uint64_t>(blocks)));
              return at + (random.chance(0.4) ? random.uniform(-20, 20) : random.uniform(-2, 2));
            };
            const double left = border(5), right = left + random.uniform(20, 80),
                         top = random.chance(0.6) ? -3 : border(2),
                         bottom = random.chance(0.6) ? 39 : top + random.uniform(8, 30), step = std::ldexp(1, -12);
            double z = 0.9 - 128 * step * std::floor(random.uniform(0, near_together ? 10 : 24));
            if (near_together) z += step * std::floor(random.uniform(0, 16));
            WindowQuad quad;
            quad.vertex = {
                {{left, top, z, 1}, {left, bottom, z + step, 1}, {right, bottom, z + 2 * step, 1}, {right, top, z, 1}}};
            return quad;
          })};
}

/// All tiles, far away: hidden by whatever memory happens to hold, which is another with every seed.
Scenario unwiped(const std::string& name, std::uint64_t seed) {
  LockstepOptions o = hidden(hiding(), 64);
  o.seed = seed;
  return {name, o, drawn(o, 10, 2, [](golden::Prng&) {
            WindowQuad quad;
            quad.vertex = {{{0, 0, 0.9, 1}, {0, 64, 0.9, 1}, {64, 64, 0.9, 1}, {64, 0, 0.9, 1}}};
            return quad;
          })};
}

/// A layer, something before it in a part of every tile, and a quad before all that covers some tiles: drawn again
/// after a reset, the first must be there again. What the unit still holds is of the last quad's end, which points at a
/// tile beside the quad's, and of the mask that was there.
Scenario wiped(int width, int height) {
  LockstepOptions o = hidden(hiding(), 128);
  const int tile = o.config.tile(), tiles = 128 / tile, count = tiles * tiles + 2;
  const auto rectangle = [](double x, double y, double right, double bottom, double z) {
    WindowQuad quad;
    quad.vertex = {{{x, y, z, 1}, {x, bottom, z, 1}, {right, bottom, z, 1}, {right, y, z, 1}}};
    return quad;
  };
  int n = 0;
  Scenario scenario{"wiped, " + std::to_string(width) + "x" + std::to_string(height), o,
                    drawn(o, 10, count, [=](golden::Prng&) mutable {
                      const int i = n++, x = (i - 1) % tiles * tile, y = (i - 1) / tiles * tile;
                      if (i == 0) return rectangle(0, 0, 128, 128, 0.9);
                      if (i == count - 1) return rectangle(0, 0, width, height, 0.2);
                      return rectangle(x, y, x + tile / 2, y + tile / 2, 0.3);
                    })};
  scenario.again = true;
  return scenario;
}

/// Halves of the viewport that meet along a slanted edge, in either order of corners, each pair before the last one or
/// a code behind it; behind them quads about that edge, whose tiles the two halves hide together or not.
Scenario joined_layers() {
  LockstepOptions o = hidden(hiding(), 72);
  o.stall = 0.2;
  int n = 0;
  double z = 0.9, split = 0, lean = 0, stretch = 0;
  bool upright = false;
  return {"joined layers", o, drawn(o, 9, 160, [=](golden::Prng& random) mutable {
            const int place = n++ % 10;
            if (place == 0) {
              z -= random.chance(0.7) ? 0.03 : -std::ldexp(1, -11);
              split = random.uniform(12, 60);
              lean = random.uniform(-12, 12);
              stretch = random.uniform(0, 30);
              upright = random.chance(0.5);
            }
            WindowQuad quad;
            const double step = std::ldexp(1, -12);
            if (place < 2) {
              const double outer = place == 0 ? -stretch : 72 + stretch;
              const double across[4] = {outer, split + lean, split - lean, outer}, along[4] = {-5, -5, 77, 77};
              for (std::size_t i = 0; i < 4; ++i) quad.vertex[i] = {across[i], along[i], z, 1};
            } else {
              const double middle = split + random.uniform(-16, 16), at = random.uniform(0, 72),
                           a = random.uniform(1, 14), b = random.uniform(1, 14);
              const double across[4] = {middle - a, middle + b, middle + a, middle - b},
                           along[4] = {at - b, at - a, at + b, at + a};
              const double depth =
                  z + (random.chance(0.3) ? step * std::floor(random.uniform(-2, 4)) : random.uniform(-0.06, 0.06));
              for (std::size_t i = 0; i < 4; ++i) quad.vertex[i] = {across[i], along[i], depth, 1};
            }
            if (upright)
              for (WindowVertex& v : quad.vertex) std::swap(v.x, v.y);
            if (random.chance(0.5)) std::swap(quad.vertex[1], quad.vertex[3]);
            return quad;
          })};
}

/// Kites with a sharp corner, each nearer than all before it; behind each a quad over the whole viewport, nearer than
/// all before both: where tiles are about a sharp corner's edges and diagonal, it shows what the kite has covered of
/// them.
Scenario acute_layers() {
  LockstepOptions o = hidden(hiding(), 64);
  int n = 0;
  double z = 0.95;
  return {
      "acute layers", o, drawn(o, 12, 120, [=](golden::Prng& random) mutable {
        WindowQuad quad;
        const bool behind = n++ % 2 != 0;
        if (!behind) z -= 0.015;
        const double x = random.uniform(-8, 72), y = random.uniform(-8, 72), turn = random.uniform(0, 6.3),
                     half = random.uniform(0.05, 0.5), size = random.uniform(20, 70);
        const double at[4][2] = {{0, 0}, {size, half * size}, {1.3 * size, 0.2 * half * size}, {size, -half * size}};
        const std::size_t first = random.below(4);
        for (std::size_t i = 0; i < 4; ++i) {
          const auto& [u, v] = at[(first + i) % 4];
          quad.vertex[i] = {x + std::cos(turn) * u - std::sin(turn) * v, y + std::sin(turn) * u + std::cos(turn) * v, z,
                            1};
          if (behind) quad.vertex[i] = {i == 1 || i == 2 ? 70.0 : -6.0, i >= 2 ? 70.0 : -6.0, z + 0.005, 1};
        }
        if (random.chance(0.5)) std::swap(quad.vertex[1], quad.vertex[3]);
        return quad;
      })};
}

/// Layers at depths about 1, the last codes there are.
Scenario far_end() {
  LockstepOptions o = hidden(hiding(), 48);
  return {
      "far end", o, drawn(o, 16, 120, [](golden::Prng& random) {
        const double left = random.uniform(-20, 30), top = random.uniform(-20, 30), size = random.uniform(10, 70);
        const double z = 1 - std::ldexp(std::floor(random.uniform(-1, 12)), -13);
        WindowQuad quad;
        quad.vertex = {
            {{left, top, z, 1}, {left, top + size, z, 1}, {left + size, top + size, z, 1}, {left + size, top, z, 1}}};
        return quad;
      })};
}

}  // namespace quadrille::tb
