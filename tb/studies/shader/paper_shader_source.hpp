// The shaders of Hormann and Tarini's hybrid implementation (2004, section 5.1) in GLSL.
#pragma once

#include <string>

namespace quadrille::tb {

/// What a program is compiled for.
struct ShaderVariant {
  int attributes = 0;  ///< of a vertex, 0 to max_attribute_slots
  bool weights = false;
  bool perspective = true;
  bool depth = true;
  /// Attributes come as k a (W a without perspective) and are divided by W; otherwise they come as they are.
  bool attributes_over_w = true;

  friend bool operator==(const ShaderVariant&, const ShaderVariant&) = default;
};

/// RGBA32F targets: the first is (state, z, a0, a1), further ones four attributes each, the last the weights, if
/// wanted. The state is 0 where nothing was drawn, 1 at a back-facing fragment, 2 at a front-facing one.
struct ShaderTargets {
  static constexpr int attributes_in_first = 2;

  int attributes = 1;  ///< targets that hold state, depth and attributes
  int all = 1;
};
ShaderTargets shader_targets(const ShaderVariant& variant);

/// vec4s of a vertex: (X, Y, W, k), then Z and the attributes without gaps.
int vertex_vectors(int attributes);

struct ShaderSource {
  std::string vertex, geometry, fragment;
};
ShaderSource paper_shader_source(const ShaderVariant& variant);

}  // namespace quadrille::tb
