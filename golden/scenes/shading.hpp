// What a pixel looks like by the values that it shows: the picture of the program and of the page.
#pragma once

#include "golden/scenes/mesh.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace quadrille::golden {

inline constexpr Vec3 background_colour{0.22, 0.22, 0.23};
inline constexpr Vec3 undefined_colour{1, 0, 1};

/// Of unit length; (0, 0, 1) of no direction.
Vec3 unit_vector(const Vec3& v);

/// In [0, 1] for any finite coordinate; 1 stays 1. Less than a step of 8 bits beyond an end is that end: an attribute
/// may pass its corners' by the machine's bound.
double wrapped(double c);

/// Phong's model with one distant light, both sides lit alike. Directions of unit length.
Vec3 phong(Vec3 n, const Vec3& to_eye, const Vec3& to_light);

/// The vector area of a quad.
Vec3 facet_normal(const std::array<Vec3, 4>& corner);

/// The corners' colours, mixed by the weights.
Vec3 weight_colour(const std::array<double, 4>& lambda);

/// One of many well-separated colours, which an eye tells from what is not drawn and from what is undefined.
Vec3 id_colour(std::uint32_t id);

/// A flat colour with a line of constant width where a plane cuts the surface; dark and bright take turns. `height`:
/// above the first plane in spacings, `steepness`: its change from pixel to pixel.
Vec3 cut_colour(const Vec3& flat, double height, double steepness);

/// A channel in 8 bits.
inline std::uint8_t to_byte(double channel) {
  return static_cast<std::uint8_t>(255 * std::clamp(channel, 0.0, 1.0) + 0.5);
}

}  // namespace quadrille::golden
