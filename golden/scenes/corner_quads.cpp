#include "golden/scenes/corner_quads.hpp"

#include "golden/scenes/corner_batch.hpp"
#include "golden/scenes/generators.hpp"
#include "golden/scenes/random_quads.hpp"
#include "model/port/snap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

namespace quadrille::golden {
namespace {

struct Generator {
  CornerGroupInfo info;
  void (*make)(Batch&);
};

constexpr std::array<Generator, 21> generators{{
    {{CornerGroup::face_plane, "face_plane",
      "every combination of signs of the determinants d_012, d_023, d_123, d_013, zero included: the eye in the plane "
      "of a face",
      ""},
     face_plane},
    {{CornerGroup::flat, "flat",
      "four vertices in one plane with the eye, seen edge-on along pixel centres: pixels in several singular classes, "
      "and "
      "sum(M W) = 0 with the eye in the hull",
      "depth off, for the second"},
     flat},
    {{CornerGroup::den_w_zero, "den_w_zero",
      "an edge with nearly antipodal ends along pixel centres, whose W are equal once truncated: sum(M W) = 0 without "
      "an eye in the hull",
      "significand_bits below subpixel_bits + homogeneous_frac_bits, depth"},
     den_w_zero},
    {{CornerGroup::negative_r2, "negative_r2",
      "corners next to pixel centres far from the origin pixel, where dropped bits make r^2 negative; several in a "
      "pixel",
      "quadratic_frac_bits of a few bits"},
     negative_r2},
    {{CornerGroup::z_limits, "z_limits",
      "corners' depth codes at znear and zfar and beside them by one, window z there and between",
      "depth, znear > 0, "
      "zfar < 1"},
     z_limits},
    {{CornerGroup::minus_zero, "minus_zero", "window z just below 0: codes 0 and -1", "depth, znear 0"}, minus_zero},
    {{CornerGroup::two_corner, "two_corner", "two corners of different w at a pixel centre", "perspective"},
     two_corner},
    {{CornerGroup::two_edge, "two_edge", "two edges crossing at a pixel centre, W of either sign at their ends",
      "perspective off"},
     two_edge},
    {{CornerGroup::tall, "tall", "slanted strips over the whole height of the viewport, several blocks wide",
      "a viewport of more than four blocks in height and two in width"},
     tall},
    {{CornerGroup::burst, "burst",
      "quads of one pixel, quick one after the other behind one that fills the fragment FIFO: every quad slot in use",
      "a stall of 0.95"},
     burst},
    {{CornerGroup::extreme, "extreme", "X, Y and W of every vertex at an end of their ranges: the widest gradients",
      ""},
     extreme},
    {{CornerGroup::far_corner, "far_corner",
      "vertices behind the eye at the end of the guard band, pixels at the other end: the widest edge functions and "
      "dot "
      "products",
      "a viewport of 2^viewport_bits pixels in width and height"},
     far_corner},
    {{CornerGroup::constant_depth, "constant_depth",
      "one depth code at all corners: at znear and zfar and beside them; ordinary, perspective, beyond the guard band, "
      "w of either sign",
      "depth, znear > 0"},
     constant_depth},
    {{CornerGroup::one_corner, "one_corner",
      "values of one corner alone that differ from the others', by one code or the whole range", "depth"},
     one_corner},
    {{CornerGroup::far_base, "far_base", "attributes at the ends of their format, depth near 1, spread over few codes",
      "depth"},
     far_base},
    {{CornerGroup::ties, "ties", "corners at pixel centres half a code from the base's grid, above and below", "depth"},
     ties},
    {{CornerGroup::saturation, "saturation",
      "quotients beyond the format and sums beyond it, in either direction, which the port alone can give", "depth"},
     saturation},
    {{CornerGroup::box, "box",
      "rectangles with sides at pixel centres and one unit of the grid beside them, at borders of tiles too", ""},
     box},
    {{CornerGroup::plane, "plane",
      "parallelograms with plane values, or plane but for a sign, a code or a factor of two at one corner",
      "plane_quads, skip plane"},
     plane},
    {{CornerGroup::coarse_depth, "coarse_depth",
      "layers over whole tiles with depths at coarse codes of hierarchical_z_bits and one code beside them",
      "hierarchical_z_bits, skip hidden"},
     coarse_depth},
    {{CornerGroup::far_depth, "far_depth",
      "corners beyond the guard band or behind the eye, depth codes at znear and zfar and on one side of them",
      "depth, znear > 0"},
     far_depth},
}};

constexpr auto infos = infos_of(generators);

}  // namespace

std::span<const CornerGroupInfo> corner_groups() { return infos; }

CornerGroup parse_corner_group(std::string_view name) {
  std::string names;
  for (const CornerGroupInfo& info : infos) {
    if (info.name == name) return info.group;
    names += " " + std::string(info.name);
  }
  throw std::invalid_argument("unknown corner group \"" + std::string(name) + "\"; the groups are" + names);
}

std::vector<WindowQuad> make_corner(CornerGroup group, const Config& config, const DrawState& state, std::uint64_t seed,
                                    int attributes) {
  check_attributes("corner group", attributes, max_attribute_slots);
  constexpr std::uint64_t first_stream = 100;
  Batch batch{Prng(seed, first_stream + static_cast<std::uint64_t>(group)), config, state};
  generators[static_cast<std::size_t>(group)].make(batch);
  std::vector<WindowQuad> quads(batch.quads.size());
  for (std::size_t i = 0; i < quads.size(); ++i) {
    quads[i].id = static_cast<std::uint32_t>(i);
    quads[i].vertex = batch.quads[i];
    for (int j = 0; j < attributes; ++j) {
      const std::array<double, 4> values = corner_values(group, batch, i);
      for (std::size_t v = 0; v < 4; ++v) quads[i].attribute[v].push_back(values[v]);
    }
  }
  return quads;
}

std::vector<CornerDraw> corner_draws(const Config& config, std::uint64_t seed) {
  std::vector<CornerDraw> draws;
  for (const CornerGroupInfo& info : infos) {
    CornerDraw draw{info.name, tb::small_state(config, 32), 0, {}};
    DrawState& state = draw.state;
    state.attributes = 1 + static_cast<int>(info.group) % config.attribute_slots;
    if (info.group == CornerGroup::z_limits) state.znear = 0.25, state.zfar = 0.75;
    if (info.group == CornerGroup::constant_depth) state.znear = 0.5;
    if (info.group == CornerGroup::far_depth) state.znear = 0.25, state.zfar = 0.5;
    if (info.group == CornerGroup::plane && config.plane_quads != 0) state.skip |= skip_plane;
    if (info.group == CornerGroup::coarse_depth && config.hierarchical_z_bits != 0) state.skip |= skip_hidden;
    if (info.group == CornerGroup::flat) state.depth = false;
    if (info.group == CornerGroup::two_edge) state.perspective = false;
    if (info.group == CornerGroup::tall) {
      const int block = 8 * config.tile(), most = 1 << config.viewport_bits;
      state.width = state.scissor_x1 = std::min(3 * block, most);
      state.height = state.scissor_y1 = std::min(10 * block, most);
    }
    if (info.group == CornerGroup::burst) draw.stall = 0.95;
    if (info.group == CornerGroup::far_corner)
      state.width = state.height = state.scissor_x1 = state.scissor_y1 = 1 << config.viewport_bits;
    constexpr std::uint64_t first_port_stream = 150;
    Batch batch{Prng(seed, first_port_stream + static_cast<std::uint64_t>(info.group)), config, state};
    for (const WindowQuad& quad : make_corner(info.group, config, state, seed, state.attributes)) {
      draw.quads.push_back(snap_quad(quad, config, state));
      change_at_port(info.group, batch, draw.quads.back());
    }
    draws.push_back(std::move(draw));
  }
  return draws;
}

}  // namespace quadrille::golden
