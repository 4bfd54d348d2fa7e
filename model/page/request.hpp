// What the page asks for, as text: one `key=value` a line, the same words as in its address.
#pragma once

#include "golden/scenes/mesh.hpp"
#include "model/port/config.hpp"
#include "model/port/records.hpp"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace quadrille::page {

struct Request {
  std::string scene = "fig10_convex";
  int width = 512, height = 512;  ///< pixels
  /// Of the mesh about its middle: degrees about the picture's vertical and horizontal axis.
  double yaw = 0, pitch = 0;
  /// Towards the eye, in units of the middle's distance: 1 has the eye in the middle.
  double dolly = 0;
  std::map<int, golden::Vec3> vertices;  ///< positions of the mesh that are elsewhere
  Config config;
  std::string shade, texture;  ///< empty: the scene's
  std::optional<bool> perspective;
  std::optional<Cull> cull;
  bool depth = true;
  std::optional<std::array<int, 2>> pixel;  ///< to be taken apart
  std::string view;                         ///< what stands beside the machine's picture; empty: nothing

  /// The quads are those of the scene as the program has it.
  bool is_scene() const { return yaw == 0 && pitch == 0 && dolly == 0 && vertices.empty(); }
};

/// Keys: scene, size=WxH, yaw, pitch, dolly, vN=X,Y,Z, shade, texture, perspective=0|1, cull=none|front|back,
/// depth=0|1, pixel=X,Y, view, and every key of the configuration. Throws std::invalid_argument for anything else,
/// ConfigError for a configuration that cannot be built.
Request parse_request(std::string_view text);

}  // namespace quadrille::page
