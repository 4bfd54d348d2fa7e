#include "tb/verify/faults/scenario.hpp"

#include "golden/scenes/corner_quads.hpp"
#include "golden/scenes/random_quads.hpp"
#include "tb/judge/directed.hpp"
#include "tb/verify/faults/scenario_draws.hpp"

#include <algorithm>

namespace quadrille::tb {
namespace {

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
    for (golden::CornerDraw& draw : directed_draws(exact())) add(exact(), "", std::move(draw));  // those not there
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
