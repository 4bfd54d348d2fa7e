#include "tb/mutants/scenario.hpp"

#include "golden/scenes/corner_quads.hpp"
#include "golden/scenes/random_quads.hpp"
#include "model/snap.hpp"
#include "model/support/prng.hpp"
#include "tb/check/directed.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>

namespace quadrille::tb {
namespace {

/// Everything exact, few bits.
Config exact() {
  Config config;
  config.set("significand_bits", 12);
  return config;
}

/// What the other has not: bits of D and r² dropped, no flag of notches, buffers of the least size, other widths.
Config reduced() {
  Config config;
  config.set("significand_bits", 15);
  config.set("quadratic_frac_bits", 8);
  config.set("notch_exact", 0);
  config.set("tile_log2", 2);
  config.set("dot_units", 4);
  config.set("quad_slots_log2", 1);
  config.set("tile_slots_log2", 1);
  config.set("stamp_fifo_log2", 1);
  config.set("attribute_slots", 3);
  config.set("depth_bits", 16);
  config.set("performance_counters", 1);
  return config;
}

/// Four pixels a clock; few slots, for a machine that is quick to build.
Config four_lanes() {
  Config config;
  config.set("significand_bits", 12);
  config.set("attribute_slots", 1);
  config.set("pixels_per_clock", 4);
  config.set("performance_counters", 1);
  return config;
}

/// Hidden tiles. Tags of two bits and four epochs: what memory holds before it is wiped is soon taken for an entry.
Config hiding() {
  Config config = four_lanes();
  config.set("viewport_bits", 7);
  config.set("attribute_slots", 3);
  config.set("hierarchical_z_bits", 12);
  config.set("hierarchical_z_tiles_log2", 6);
  return config;
}

/// Six columns of blocks of tiles at four places.
Config hiding_blocks() {
  Config config = hiding();
  config.set("viewport_bits", 8);
  config.set("tile_log2", 2);
  return config;
}

/// Areas for weights where values are plane, a pixel a clock.
Config plane_weights() {
  Config config;
  config.set("significand_bits", 12);
  config.set("attribute_slots", 3);
  config.set("plane_quads", 1);
  config.set("performance_counters", 1);
  return config;
}

LockstepOptions options(const Config& config, int edge) {
  LockstepOptions o;
  o.config = config;
  o.state = small_state(config, edge);
  o.seed = 5;
  o.watchdog = 20'000;
  return o;
}

using Draw = std::function<WindowQuad(golden::Prng&)>;

/// `count` quads that snapping takes, of what `draw` draws.
std::vector<SnappedQuad> drawn(const LockstepOptions& o, std::uint64_t seed, int count, const Draw& draw) {
  golden::Prng random(seed, 17);
  std::vector<SnappedQuad> quads;
  while (static_cast<int>(quads.size()) < count) {
    WindowQuad quad = draw(random);
    quad.id = static_cast<std::uint32_t>(quads.size());
    for (auto& list : quad.attribute)  // slots that are not in use too
      while (static_cast<int>(list.size()) < o.config.attribute_slots) list.push_back(random.uniform(-7.9, 7.9));
    try {
      quads.push_back(snap_quad(quad, o.config, o.state));
    } catch (const SnapError&) {  // no point of the machine's space: draw another
    }
  }
  return quads;
}

/// Corners on the pixel centres of a square of `edge` pixels: ties, collinear and coincident corners, crossings. Each w
/// is one of `w`, a power of two with sign: positions stay exact.
WindowQuad on_grid(golden::Prng& random, int edge, std::span<const double> w) {
  WindowQuad quad;
  const double left = static_cast<double>(random.below(8)), top = static_cast<double>(random.below(8));
  for (WindowVertex& v : quad.vertex) {
    v.w = w[random.below(w.size())];
    v.x = (left + static_cast<double>(random.below(static_cast<std::uint64_t>(edge))) + 0.5) * v.w;
    v.y = (top + static_cast<double>(random.below(static_cast<std::uint64_t>(edge))) + 0.5) * v.w;
    v.z = random.uniform(0.05, 0.95) * v.w;
  }
  return quad;
}

bool corners_meet(const WindowQuad& quad) {
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const WindowVertex &a = quad.vertex[i], &b = quad.vertex[j];
      if (a.x * b.w == b.x * a.w && a.y * b.w == b.y * a.w) return true;
    }
  return false;
}

/// A strip of one or two pixels from the upper to the lower end of the viewport, or from left to right.
WindowQuad strip(golden::Prng& random, double edge) {
  WindowQuad quad;
  const double a = random.uniform(0, edge), b = random.uniform(0, edge), width = random.uniform(0.5, 2);
  const double along[4] = {1, 1, edge - 1, edge - 1}, across[4] = {a, a + width, b + width, b};
  const bool upright = random.chance(0.7);
  for (std::size_t i = 0; i < 4; ++i) {
    WindowVertex& v = quad.vertex[i];
    v = {across[i], along[i], random.uniform(0.1, 0.9), 1};
    if (!upright) std::swap(v.x, v.y);
  }
  return quad;
}

Scenario mixture() {
  LockstepOptions o = options(exact(), 64);
  o.state.scissor_x0 = 1;
  o.state.scissor_y1 -= 3;
  o.state.scissor_x1 -= 3;  // not on a tile's border
  o.stall = 0.3;
  o.gap = 0.1;
  return {"mixture", o, random_quads(o.config, o.state, 31, 300)};
}

Scenario flat() {
  LockstepOptions o = options(exact(), 64);
  o.state.perspective = false;
  o.state.cull = Cull::back;
  o.state.attributes = 2;
  o.state.znear = 0.25;
  o.state.zfar = 0.75;
  o.stall = 0.1;
  return {"flat", o, random_quads(o.config, o.state, 32, 250)};
}

Scenario grid() {
  LockstepOptions o = options(exact(), 16);
  static constexpr double w[]{1, 0.5, 2, 4};
  return {"grid", o, drawn(o, 1, 500, [](golden::Prng& random) { return on_grid(random, 5, w); })};
}

Scenario signed_grid() {
  LockstepOptions o = options(exact(), 16);
  static constexpr double w[]{1, -1, 2, -0.5};
  return {"signed grid", o, drawn(o, 2, 500, [](golden::Prng& random) { return on_grid(random, 4, w); })};
}

Scenario flat_signed_grid() {
  LockstepOptions o = options(exact(), 16);
  o.state.perspective = false;
  o.state.cull = Cull::front;
  static constexpr double w[]{1, -1, 0.25, -0.5};
  // Without perspective a pixel on two corners of which one is behind the eye has no interpolation to be held to.
  return {"flat signed grid", o, drawn(o, 3, 500, [](golden::Prng& random) {
            WindowQuad quad = on_grid(random, 4, w);
            while (corners_meet(quad)) quad = on_grid(random, 4, w);
            return quad;
          })};
}

/// Window z exactly on the limits: powers of two, all corners alike. Some have a corner beyond the guard band that is
/// the only one inside them.
Scenario depth_limits() {
  LockstepOptions o = options(exact(), 16);
  o.state.znear = 0.25;
  o.state.zfar = 0.5;
  return {"depth limits", o, drawn(o, 4, 200, [](golden::Prng& random) {
            static constexpr double w[]{1}, depths[]{0.25, 0.5, 0, -0.0009765625};
            WindowQuad quad = on_grid(random, 5, w);
            const double z = depths[random.below(4)];
            for (WindowVertex& v : quad.vertex) v.z = random.chance(0.9) ? z : -z;
            if (random.chance(0.25)) {
              for (WindowVertex& v : quad.vertex) v.z = 0.625;
              WindowVertex& far = quad.vertex[random.below(4)];
              far.x += 50'000;
              far.z = 0.5;
            }
            return quad;
          })};
}

/// Beyond four blocks in both directions.
Scenario wide() {
  LockstepOptions o = options(exact(), 400);
  o.state.attributes = 1;
  return {"wide", o, drawn(o, 6, 12, [](golden::Prng& random) { return strip(random, 400); })};
}

/// No depth, no tile left out, few attributes.
Scenario depth_off() {
  LockstepOptions o = options(exact(), 64);
  o.state.depth = false;
  o.state.skip = 0;
  o.state.attributes = 3;
  o.state.znear = 0.25;
  o.state.scissor_y0 = 5;
  return {"depth off", o, random_quads(o.config, o.state, 34, 60)};
}

/// W = ONE/2 at two corners: no bounding box.
void halve(SnappedQuad& quad) {
  for (const std::size_t i : {1, 3}) {
    SnappedVertex& v = quad.vertex[i];
    v.x /= 2;
    v.y /= 2;
    v.w /= 2;
    if (v.z.sig != 0) v.z.exp -= 1;
  }
}

/// Homogeneous quads that reach over a border of the scissor by quarters of a pixel, or not, some of them turned a
/// little.
Scenario beside_scissor() {
  LockstepOptions o = options(exact(), 64);
  o.state.scissor_x0 = 9;
  o.state.scissor_x1 = 53;
  o.state.scissor_y0 = 7;
  o.state.scissor_y1 = 50;
  Scenario result{"beside the scissor", o, drawn(o, 8, 150, [&](golden::Prng& random) {
                    const bool along_y = random.chance(0.5), far = random.chance(0.5);
                    const double low = along_y ? o.state.scissor_y0 : o.state.scissor_x0,
                                 high = along_y ? o.state.scissor_y1 : o.state.scissor_x1;
                    const double reach = static_cast<double>(random.below(13)) * 0.25 - 1.5;
                    const double inner = far ? high - 0.5 - reach : low + 0.5 + reach, outer = far ? high + 9 : low - 9;
                    const double turned = random.chance(0.5) ? (far ? 0.5 : -0.5) : 0;
                    const double across[4] = {inner, inner + turned, outer, outer}, along[4] = {1, 62, 62, 1};
                    WindowQuad quad;
                    for (std::size_t i = 0; i < 4; ++i) {
                      quad.vertex[i] = {across[i], along[i], random.uniform(0.05, 0.95), 1};
                      if (along_y) std::swap(quad.vertex[i].x, quad.vertex[i].y);
                    }
                    return quad;
                  })};
  for (SnappedQuad& quad : result.quads) halve(quad);
  return result;
}

/// Neither depth nor all attributes in use, the eye in the hull of some: with these a pixel leaves out most.
Scenario held(const std::string& name, const Config& config, int attributes) {
  LockstepOptions o = options(config, 64);
  o.state.depth = false;
  o.state.attributes = attributes;
  o.stall = 0.2;
  return {name, o, random_quads(o.config, o.state, 36, 150)};
}

Scenario dropped_bits() {
  LockstepOptions o = options(reduced(), 64);
  o.stall = 0.3;
  return {"dropped bits", o, random_quads(o.config, o.state, 33, 200)};
}

Scenario dropped_bits_signed() {
  LockstepOptions o = options(reduced(), 16);
  o.state.perspective = false;
  o.gap = 0.3;
  static constexpr double w[]{1, -1, 0.25, -0.5};
  return {"dropped bits, signed grid", o, drawn(o, 7, 300, [](golden::Prng& random) { return on_grid(random, 4, w); })};
}

/// Depth limits discard some of a clock's pixels, stalls fill the fragment FIFO, two of three quads are homogeneous.
Scenario lanes() {
  LockstepOptions o = options(four_lanes(), 64);
  o.state.attributes = 1;
  o.state.znear = 0.25;
  o.state.zfar = 0.75;
  o.stall = 0.6;
  return {"four lanes", o, random_quads(o.config, o.state, 35, 150)};
}

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
  LockstepOptions o = options(hiding_blocks(), 168);
  o.state.height = o.state.scissor_y1 = 36;
  o.state.attributes = 1;
  o.state.skip |= skip_hidden;
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
  LockstepOptions o = options(hiding(), 64);
  o.state.attributes = 1;
  o.state.skip |= skip_hidden;
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
  LockstepOptions o = options(hiding(), 128);
  o.state.attributes = 1;
  o.state.skip |= skip_hidden;
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
  LockstepOptions o = options(hiding(), 72);
  o.state.attributes = 1;
  o.state.skip |= skip_hidden;
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
  LockstepOptions o = options(hiding(), 64);
  o.state.attributes = 1;
  o.state.skip |= skip_hidden;
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

/// Layers at depths about 1, the last codes there are.
Scenario far_end() {
  LockstepOptions o = options(hiding(), 48);
  o.state.attributes = 1;
  o.state.skip |= skip_hidden;
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

/// The first clocks after reset, from registers that held anything.
Scenario after_reset(std::uint64_t seed) {
  Scenario scenario = sprites();
  scenario.name = "after reset, " + std::to_string(seed);
  scenario.options.seed = seed;
  scenario.quads.resize(4);
  return scenario;
}

/// Crossings, ties and corners on pixels where areas may be weights.
Scenario plane_grid() {
  LockstepOptions o = options(plane_weights(), 16);
  o.state.skip |= skip_plane;
  static constexpr double w[]{1, 1, 1, 1, 0.5, 2};
  return {"grid, plane weights", o, drawn(o, 10, 300, [](golden::Prng& random) { return on_grid(random, 5, w); })};
}

/// One of two bits of the skip mask.
Scenario one_skip(const std::string& name, std::uint32_t skip) {
  LockstepOptions o = options(exact(), 64);
  o.state.skip = skip;
  o.state.cull = Cull::front;
  return {name, o, random_quads(o.config, o.state, 41, 80)};
}

}  // namespace

std::span<const Scenario> scenarios() {
  static const std::vector<Scenario> list = [] {
    std::vector<Scenario> all{mixture(),
                              flat(),
                              grid(),
                              signed_grid(),
                              flat_signed_grid(),
                              depth_limits(),
                              wide(),
                              depth_off(),
                              dropped_bits(),
                              dropped_bits_signed(),
                              lanes(),
                              beside_scissor(),
                              layers(),
                              sprites(),
                              bases(),
                              unwiped("unwiped", 1),
                              unwiped("unwiped, another seed", 2),
                              unwiped("unwiped, a third seed", 3),
                              block_layers("block layers", false),
                              block_layers("block layers, near together", true)};
    const auto add = [&](const Config& config, const std::string& before, golden::CornerDraw draw) {
      for (std::size_t i = 0; i < draw.quads.size(); ++i) draw.quads[i].id = static_cast<std::uint32_t>(i);
      LockstepOptions o = options(config, draw.state.width);
      o.state = draw.state;
      o.stall = draw.stall;
      if (draw.group == "den_w_zero")  // with limits that tell above from below, and neither discarded
        for (std::size_t i = 0; i < draw.quads.size(); i += 2) {
          QuadBase& base = draw.quads[i].base;
          base.depth_low = static_cast<std::int32_t>(base.depth / 2);
          base.depth_high = static_cast<std::int32_t>((base.depth + (1u << config.depth_bits)) / 2);
          if (i % 4 == 0)
            for (SnappedVertex& v : draw.quads[i].vertex) v.z.neg = v.z.sig != 0 && !v.z.neg;
        }
      if (draw.group == "far_corner") return;  // its walk takes longer than all the others together
      const std::string name = before + std::string(draw.group);
      if (std::ranges::count(all, name, &Scenario::name) == 0)
        all.push_back({name, o, std::move(draw.quads), draw.group == "at_infinity"});
    };
    for (golden::CornerDraw& draw : golden::corner_draws(exact(), 11)) add(exact(), "", std::move(draw));
    for (golden::CornerDraw& draw : cli::directed_draws(exact())) add(exact(), "", std::move(draw));  // those not there
    for (golden::CornerDraw& draw : golden::corner_draws(reduced(), 11)) add(reduced(), "reduced, ", std::move(draw));
    // What a pixel leaves out hides faults of it: in one of them, with faults of their own.
    for (Scenario& s : all) s.options.state.skip &= ~std::uint32_t{skip_operands};
    all.push_back(held("held", exact(), 2));
    all.push_back(held("held, four lanes", four_lanes(), 1));  // counted
    all.push_back(flushes_and_clears());
    return all;
  }();
  return list;
}

std::span<const Scenario> further_scenarios() {
  static const std::vector<Scenario> list = [] {
    std::vector<Scenario> all;
    all.push_back(joined_layers());
    all.push_back(acute_layers());
    all.push_back(far_end());
    for (const int width : {8, 16, 32})
      for (const int height : {8, 16, 32}) all.push_back(wiped(width, height));
    all.push_back(far_exponents());
    all.push_back(far_scissor());
    all.push_back(far_scissor_homogeneous());
    all.push_back(one_skip("tiles left out", skip_tiles));
    all.push_back(one_skip("quads left out", skip_quads));
    all.push_back(plane_grid());
    all.push_back(flat_at_infinity());
    for (std::uint64_t seed = 1; seed <= 24; ++seed) all.push_back(after_reset(seed));
    return all;
  }();
  return list;
}

}  // namespace quadrille::tb
