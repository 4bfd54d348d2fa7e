// Quad interpolation in GLSL: the forms of the weights, and the shaders around them.
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace quadrille::tb {

enum class ShaderForm { printed, no_small_a, determinant, bilinear };

struct ShaderFormInfo {
  ShaderForm form;
  std::string_view name;
  bool mean_value;  ///< the papers' interpolation
};
inline constexpr std::array<ShaderFormInfo, 4> shader_forms{{
    {ShaderForm::printed, "printed", true},  // Hormann and Tarini's formulas, |A| < 1e-6 guarded as Bloomenthal does
    {ShaderForm::no_small_a, "no small A", true},    // the same with A / (r r' + D) where D >= 0
    {ShaderForm::determinant, "determinant", true},  // golden/shaders/mean_value_quad.glsl
    {ShaderForm::bilinear, "bilinear", false},       // inverse bilinear from barycentric coordinates, for convex quads
}};

/// The two triangles of a quad.
enum class Triangles { split_013_123, split_012_023 };

/// What a program is compiled for.
struct ShaderVariant {
  ShaderForm form = ShaderForm::printed;
  /// The quickest program for a picture of ordinary quads (w is 1): two attributes in perspective and depth, nothing is
  /// killed, the depth buffer decides.
  bool picture = false;
  int attributes = 0;  ///< of a vertex, 0 to max_attribute_slots
  bool weights = false;
  bool perspective = true;
  bool depth = true;
  /// Attributes come as k a (W a without perspective) and are divided by W; otherwise they come as they are.
  bool attributes_over_w = true;

  friend bool operator==(const ShaderVariant&, const ShaderVariant&) = default;
};

/// RGBA32F targets: the first is (a0, a1, z, state), further ones four attributes each, the last the weights, if
/// wanted. The state is 0 where nothing was drawn, 2 at a front-facing fragment of the printed form, else 1.
struct ShaderTargets {
  static constexpr int attributes_in_first = 2;

  int attributes = 1;  ///< targets that hold state, depth and attributes
  int all = 1;
};
ShaderTargets shader_targets(const ShaderVariant& variant);

/// vec4s of a vertex: (X, Y, W, k), then Z and the attributes without gaps.
int vertex_vectors(int attributes);

struct ShaderSource {
  std::string vertex, fragment;
};
ShaderSource quad_shader_source(const ShaderVariant& variant);

}  // namespace quadrille::tb
