#include "model/port/draw_state.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace quadrille {
namespace {

constexpr std::uint32_t every_skip = skip_default | skip_hidden | skip_plane;

std::string size_text(int width, int height) { return std::to_string(width) + "x" + std::to_string(height); }

std::string rectangle(const DrawState& s) {
  return std::to_string(s.scissor_x0) + "," + std::to_string(s.scissor_y0) + "," + std::to_string(s.scissor_x1) + "," +
         std::to_string(s.scissor_y1);
}

}  // namespace

void check_draw_state(const DrawState& s, const Config& c) {
  const auto require = [](bool right, const char* field, const std::string& value, const std::string& rule) {
    if (!right) throw DrawStateError(field, value, rule);
  };
  const int side = 1 << c.viewport_bits;
  require(s.width >= 1 && s.height >= 1 && s.width <= side && s.height <= side, "viewport",
          size_text(s.width, s.height), "from 1x1 to " + size_text(side, side) + " (viewport_bits)");
  require(s.scissor_x0 <= s.scissor_x1 && s.scissor_y0 <= s.scissor_y1, "scissor", rectangle(s),
          "X0 must not exceed X1, nor Y0 exceed Y1 (left, top, right, bottom)");
  require(s.scissor_x0 >= 0 && s.scissor_y0 >= 0 && s.scissor_x1 <= s.width && s.scissor_y1 <= s.height, "scissor",
          rectangle(s), "the rectangle must lie inside the viewport " + size_text(s.width, s.height));
  require(s.cull <= Cull::back, "cull", std::to_string(static_cast<int>(s.cull)), "0 (none), 1 (front) or 2 (back)");
  require(s.znear >= 0 && s.znear <= s.zfar && s.zfar <= 1, "znear..zfar",
          std::to_string(s.znear) + ".." + std::to_string(s.zfar), "0 <= znear <= zfar <= 1 is required");
  require(s.attributes >= 0 && s.attributes <= c.attribute_slots, "attributes", std::to_string(s.attributes),
          "from 0 to " + std::to_string(c.attribute_slots) + " (attribute_slots)");
  require((s.skip & ~every_skip) == 0, "skip", std::to_string(s.skip),
          "only the bits of " + std::to_string(every_skip) + " are defined");
  require((s.skip & skip_hidden) == 0 || (c.hierarchical_z_bits != 0 && s.depth), "skip", std::to_string(s.skip),
          "skip hidden needs depth and hierarchical_z_bits");
  require((s.skip & skip_plane) == 0 || c.plane_quads != 0, "skip", std::to_string(s.skip),
          "skip plane needs plane_quads");
}

DrawState draw_state_for(const Config& config, int width, int height) {
  DrawState state;
  state.width = state.scissor_x1 = width;
  state.height = state.scissor_y1 = height;
  state.attributes = std::min(state.attributes, config.attribute_slots);
  return state;
}

DrawState with_possible_skips(DrawState state, const Config& config) {
  if (config.hierarchical_z_bits == 0 || !state.depth) state.skip &= ~std::uint32_t{skip_hidden};
  if (config.plane_quads == 0) state.skip &= ~std::uint32_t{skip_plane};
  return state;
}

// znear rounds up and zfar down would cut valid fragments apart by rounding alone; nearest is what a register write
// does.
std::uint32_t depth_code(double z, const Config& c) {
  return static_cast<std::uint32_t>(std::llround(std::ldexp(std::clamp(z, 0.0, 1.0), c.depth_bits)));
}

}  // namespace quadrille
