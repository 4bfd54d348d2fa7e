// What a draw state may be, for everyone who takes one: both models, the C interface, the commands, golden vectors.
#pragma once

#include "model/port/config.hpp"
#include "model/port/records.hpp"

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace quadrille {

/// A draw state that the configuration cannot have.
struct DrawStateError : std::invalid_argument {
  DrawStateError(const char* which, const std::string& value, const std::string& what_is_right)
      : std::invalid_argument("draw state: " + std::string(which) + " " + value + ": " + what_is_right),
        field(which),
        rule(what_is_right) {}
  std::string field;  ///< viewport, scissor, cull, znear..zfar, attributes or skip
  std::string rule;   ///< what would be right
};

/// Throws DrawStateError unless each field is in its range: the viewport from 1x1 to 2^viewport_bits, the scissor
/// inside it, cull one of the three, 0 <= znear <= zfar <= 1, attributes from 0 to attribute_slots, and no bit of skip
/// that is unknown or asks for what the configuration has not.
void check_draw_state(const DrawState& state, const Config& config);

/// The standard state for a viewport: all of it drawn, four attributes or as many as the configuration has.
DrawState draw_state_for(const Config& config, int width, int height);

/// The state without what it asks to skip and this configuration cannot: of one that serves several configurations.
DrawState with_possible_skips(DrawState state, const Config& config);

/// Of the bits of DrawState::skip, from the lowest on.
inline constexpr std::array<std::string_view, 6> skip_names{"tiles", "quads", "hidden", "walk", "operands", "plane"};

/// Window z as the port has it: depth_bits fraction bits.
std::uint32_t depth_code(double z, const Config& config);

}  // namespace quadrille
