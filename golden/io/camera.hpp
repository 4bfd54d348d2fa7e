// The camera file.
#pragma once

#include "golden/scenes/mesh.hpp"

#include <string>
#include <string_view>

namespace quadrille::golden {

/// Reads a JSON object with either
/// - `"matrix"`: 16 numbers, row-major, clip = M · (x, y, z, 1), NDC y up, z −1..1; or
/// - all of `"eye"`, `"target"`, `"up"` (3 numbers each), `"fovy"` (degrees, inside (0, 180)), `"near"` and `"far"` (0
/// < near < far,
///   distances along the view direction). The aspect ratio is that of the viewport.
///
/// Throws InputError naming file, line and field for syntax errors, unknown, repeated, missing or conflicting fields,
/// wrong types, numbers that are not finite or above 2^80 in magnitude, eye == target, and up zero or parallel to the
/// view direction.
Camera load_camera(const std::string& path);

/// The same for a text in memory; `name` stands for the file in messages.
Camera parse_camera(std::string_view text, const std::string& name);

/// The camera as such a text; reading it gives the same doubles back.
std::string camera_text(const Camera& camera);

}  // namespace quadrille::golden
