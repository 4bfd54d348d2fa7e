#include "tb/studies/shader/paper_shader_source.hpp"

#include <algorithm>

namespace quadrille::tb {
namespace {

/// Per vertex what does not depend on the pixel. The position is in homogeneous window coordinates; OpenGL gets it with
/// z = 0, so that of its clip volume |x|, |y|, |z| <= w nothing but the viewport and w >= 0 is left: what lies behind
/// the eye goes (section 3.2), znear and zfar are the fragment shader's (section 4.3).
constexpr const char* vertex_text = R"(
layout(location = 0) in vec4 point;  // X, Y, W, k: k times the given vertex
layout(location = 1) in vec4 values[VALUE_VECTORS];  // Z, then attributes
uniform vec2 viewport;     // pixels
uniform float to_centre;   // what is added to the coordinates to have pixel centres at +0.5
out Vertex {
  vec2 screen;      // v
  float inverse_w;  // 1 / w of the given vertex
  float values[VALUE_VECTORS * 4];  // z of eq. (4); a / w, without perspective a
} result;

void main() {
  vec2 corner = point.xy + to_centre * point.z;
  gl_Position = vec4(2.0 * corner / viewport - point.z, 0.0, point.z);
  result.screen = point.xy / point.z;
  result.inverse_w = point.w / point.z;
  for (int i = 0; i < VALUES; ++i) {
    float divisor = i == 0 || ATTRIBUTES_OVER_W ? point.z : 1.0;
    result.values[i] = values[i / 4][i % 4] / divisor;
  }
}
)";

/// A quad comes as lines with adjacency, the one primitive of four vertices, and leaves as the two triangles 012 and
/// 023 with what all of its fragments need of all corners.
constexpr const char* geometry_text = R"(
layout(lines_adjacency) in;
layout(triangle_strip, max_vertices = 4) out;
in Vertex {
  vec2 screen;
  float inverse_w;
  float values[VALUE_VECTORS * 4];
} corner[4];
flat out vec4 vx, vy, inverse_w, value[VALUES];

void main() {
  const int strip[4] = int[4](1, 2, 0, 3);
  for (int i = 0; i < 4; ++i) {
    gl_Position = gl_in[strip[i]].gl_Position;
    vx = vec4(corner[0].screen.x, corner[1].screen.x, corner[2].screen.x, corner[3].screen.x);
    vy = vec4(corner[0].screen.y, corner[1].screen.y, corner[2].screen.y, corner[3].screen.y);
    inverse_w = vec4(corner[0].inverse_w, corner[1].inverse_w, corner[2].inverse_w, corner[3].inverse_w);
    for (int a = 0; a < VALUES; ++a)
      value[a] = vec4(corner[0].values[a], corner[1].values[a], corner[2].values[a], corner[3].values[a]);
    EmitVertex();
  }
}
)";

/// The pseudo-code of section 4.2 line by line, then eqs. (10), (11) and (4). What the two triangles have outside the
/// quad is killed by the signs of the barycentric coordinates (section 5.1), here those of eq. (10), so that it holds
/// with vertices behind the eye too; a sum(lambda / w) that is not positive lies behind the eye.
constexpr const char* fragment_text = R"(
flat in vec4 vx, vy, inverse_w, value[VALUES];
uniform float centre;     // of a pixel
uniform vec2 depths;      // znear, zfar
uniform bvec2 cull;       // back, front
layout(location = 0) out vec4 target[TARGETS];

float sum(vec4 v) { return v.x + v.y + v.z + v.w; }

void main() {
  vec2 v = gl_FragCoord.xy - 0.5 + centre;
  vec4 sx = vx - v.x, sy = vy - v.y;
  vec4 area = sx * sy.yzwx - sy * sx.yzwx;
  vec4 inner = sx * sx.yzwx + sy * sy.yzwx;
  vec4 r = sqrt(sx * sx + sy * sy) * sign(inverse_w);
  vec4 t = (r * r.yzwx - inner) / area;
  vec4 mu = (t.wxyz + t) / r;
  float sum_mu = sum(mu);
  vec4 lambda = mu / sum_mu;

  vec4 over_w = lambda * inverse_w;
  float sum_over_w = sum(over_w);
  if (any(lessThan(over_w, vec4(0.0))) || sum_over_w <= 0.0) discard;
  bool front = sum_mu < 0.0;  // y points down
  if (front ? cull.y : cull.x) discard;

  float result[TARGETS * 4];
  for (int i = 0; i < TARGETS * 4; ++i) result[i] = 0.0;
  result[0] = front ? 2.0 : 1.0;
#if DEPTH
  result[1] = sum(lambda * value[0]);
  if (result[1] < depths.x || result[1] > depths.y) discard;
#endif
  for (int a = 1; a < VALUES; ++a) {
    float mean = sum(lambda * value[a]);
    result[a + 1] = PERSPECTIVE ? mean / sum_over_w : mean;
  }
#if WEIGHTS
  vec4 weights = PERSPECTIVE ? over_w / sum_over_w : lambda;
  for (int i = 0; i < 4; ++i) result[TARGETS * 4 - 4 + i] = weights[i];
#endif
  for (int i = 0; i < TARGETS; ++i)
    target[i] = vec4(result[4 * i], result[4 * i + 1], result[4 * i + 2], result[4 * i + 3]);
}
)";

}  // namespace

int vertex_vectors(int attributes) { return 1 + (1 + attributes + 3) / 4; }

ShaderTargets shader_targets(const ShaderVariant& variant) {
  ShaderTargets targets;
  targets.attributes = 1 + (std::max(0, variant.attributes - ShaderTargets::attributes_in_first) + 3) / 4;
  targets.all = targets.attributes + (variant.weights ? 1 : 0);
  return targets;
}

ShaderSource paper_shader_source(const ShaderVariant& variant) {
  const auto number = [](const char* name, int value) {
    return std::string("#define ") + name + " " + std::to_string(value) + "\n";
  };
  const auto boolean = [](const char* name, bool value) {
    return std::string("#define ") + name + (value ? " true\n" : " false\n");
  };
  const std::string head = "#version 450 core\n" + number("VALUES", 1 + variant.attributes) +
                           number("VALUE_VECTORS", vertex_vectors(variant.attributes) - 1) +
                           number("TARGETS", shader_targets(variant).all) + number("DEPTH", variant.depth) +
                           number("WEIGHTS", variant.weights) + boolean("PERSPECTIVE", variant.perspective) +
                           boolean("ATTRIBUTES_OVER_W", variant.attributes_over_w);
  return {head + vertex_text, head + geometry_text, head + fragment_text};
}

}  // namespace quadrille::tb
