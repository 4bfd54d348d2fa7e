#include "tb/studies/shader/quad_shader_source.hpp"

#include "tb/studies/shader/golden_glsl.hpp"

#include <algorithm>

namespace quadrille::tb {
namespace {

/// What a fragment gets of its quad, the same at each vertex, and planes through three corners.
constexpr const char* interface_text = R"(
#define NULL_VECTOR (FORM == DETERMINANT || FORM == BILINEAR)
#if PICTURE && FORM == DETERMINANT
flat LINK vec4 vx, vy, n, twist;
noperspective LINK vec4 plane;   // z, u k, v k, k
#elif PICTURE && FORM == BILINEAR
flat LINK vec4 twist;
flat LINK float square;
noperspective LINK vec4 plane;
noperspective LINK vec3 linear;
#else
flat LINK vec4 vx, vy, vw, vk, value[VALUES];   // z, attributes
#if NULL_VECTOR
flat LINK vec4 n;
flat LINK vec3 origin;   // a pixel near the quad, and whether it is turned
#endif
#endif
)";

/// Every vertex fetches its quad. The position is in homogeneous window coordinates; OpenGL gets it with z = 0, so that
/// of its clip volume |x|, |y|, |z| <= w nothing but the viewport and w >= 0 is left: what lies behind the eye goes
/// (section 3.2), depth is the fragment shader's (section 4.3).
constexpr const char* vertex_text = R"(
uniform samplerBuffer quads;   // of a vertex X, Y, W, k: k times the given vertex; Z, then attributes
uniform vec2 viewport;         // pixels
uniform float to_centre;       // what is added to the coordinates to have pixel centres at +0.5

vec4 fetch(int vertex, int i) { return texelFetch(quads, vertex * VECTORS + i); }
vec4 corners(int first, int i) {
  int v = 1 + i / 4, c = i % 4;
  return vec4(fetch(first, v)[c], fetch(first + 1, v)[c], fetch(first + 2, v)[c], fetch(first + 3, v)[c]);
}
#if NULL_VECTOR
bool turned;
vec4 turn(vec4 v) { return turned ? v.zwxy : v; }
#else
vec4 turn(vec4 v) { return v; }
#endif

void main() {
  int own = gl_VertexID, first = own & ~3;
  vec4 point = fetch(own, 0), p0 = fetch(first, 0), p1 = fetch(first + 1, 0), p2 = fetch(first + 2, 0),
       p3 = fetch(first + 3, 0);
  gl_Position = vec4(2.0 * (point.xy + to_centre * point.z) / viewport - point.z, 0.0, point.z);
  vec4 x = vec4(p0.x, p1.x, p2.x, p3.x), y = vec4(p0.y, p1.y, p2.y, p3.y), w = vec4(p0.z, p1.z, p2.z, p3.z);
#if PICTURE
  x += to_centre;
  y += to_centre;
#endif
  vec4 k = vec4(p0.w, p1.w, p2.w, p3.w);
#if NULL_VECTOR
  vec2 near = w.x > 0.0 ? clamp(round(vec2(x.x, y.x) / w.x), vec2(0.0), viewport) : 0.5 * viewport;
  vec4 sx = x - near.x * w, sy = y - near.y * w;
  vec4 null = mean_value_n(vec3(sx.x, sy.x, w.x), vec3(sx.y, sy.y, w.y), vec3(sx.z, sy.z, w.z), vec3(sx.w, sy.w, w.w));
  turned = mean_value_turned(null);
  null = turn(null);
#endif
#if PICTURE && NULL_VECTOR
  vec4 z = turn(corners(first, 0)), u = turn(corners(first, 1)), v = turn(corners(first, 2));
  k = turn(k);
  twist = vec4(mean_value_twist(null, z), mean_value_twist(null, u), mean_value_twist(null, v), mean_value_twist(null, k));
  vec4 values = fetch(own, 1);
  int corner = turned ? (own - first) ^ 2 : own - first;
  plane = vec4(values.xyz, point.w) - (corner == 3 ? twist : vec4(0.0));
#if FORM == DETERMINANT
  vx = turn(x);
  vy = turn(y);
  n = null;
#else
  // Barycentric a of triangle 012 and their share of the middle coefficient.
  null /= null.w;
  square = null.x * null.z - null.y;
  vec3 a = corner == 0 ? vec3(1, 0, 0) : corner == 1 ? vec3(0, 1, 0) : corner == 2 ? vec3(0, 0, 1) : -null.xyz;
  linear = vec3(a.x, a.z, a.x * null.z + a.z * null.x - a.y);
#endif
#else
  // The printed form is in window coordinates, the others are homogeneous.
  vec4 divisor = FORM == PRINTED ? w : vec4(1.0);
#if NULL_VECTOR
  n = null;
  origin = vec3(near, turned);
  x = sx;
  y = sy;
#endif
  vx = turn(x / divisor);
  vy = turn(y / divisor);
  vw = turn(FORM == PRINTED ? sign(w) : w);
  vk = turn(k / divisor);
  for (int i = 0; i < VALUES; ++i)
    value[i] = turn(corners(first, i) * (i == 0 || ATTRIBUTES_OVER_W ? vec4(1.0) : w) / divisor);
#endif
}
)";

/// Unnormalised weights of the forms, and t of those whose values are plane + t * twist.
constexpr const char* weights_text = R"(
float sum(vec4 v) { return v.x + v.y + v.z + v.w; }
// The solution of linear + t square in 0 ... 1, of a convex quad.
float bilinear_t(float square, float a0, float a2, float middle) {
  float last = a0 * a2;
  return -2.0 * last / (middle - sqrt(max(middle * middle - 4.0 * square * last, 0.0)));
}
#if PICTURE && FORM == BILINEAR
float quad_t(vec2 p) { return bilinear_t(square, linear.x, linear.y, linear.z); }
#elif PICTURE && FORM == DETERMINANT
float quad_t(vec2 p) { return mean_value_t(vx, vy, vec4(1.0), n, p).t; }
#elif FORM == BILINEAR
vec4 weights(vec2 p) {
  vec4 a = mean_value_t(vx, vy, vw, n, p - origin.xy).a / -n.w;
  vec4 m = n / n.w;
  float t = bilinear_t(m.x * m.z - m.y, a.x, a.z, a.x * m.z + a.z * m.x - a.y);
  return a + t * m;
}
#elif FORM == DETERMINANT
vec4 weights(vec2 p) { return mean_value_weights(vx, vy, vw, n, p - origin.xy); }
#else
#if PICTURE
const vec4 w = vec4(1.0);
#else
#define w vw
#endif
float facing;
#if FORM == PRINTED
vec4 weights(vec2 p) {
  vec4 mu = paper_weights(vx, vy, w, p, 1e-6);
  facing = sum(mu);
  return mu / facing;
}
#else
vec4 weights(vec2 p) {
  vec4 sx = vx - w * p.x, sy = vy - w * p.y;
  vec4 r = sqrt(sx * sx + sy * sy);
  vec4 area = sx * sy.yzwx - sy * sx.yzwx;
  vec4 inner = sx * sx.yzwx + sy * sy.yzwx;
  vec4 product = r * r.yzwx;
  bvec4 obtuse = lessThan(inner, vec4(0.0));
  vec4 t = mix(area, product - inner, obtuse) / mix(product + inner, area, obtuse);
  return (t.wxyz + t) / r;
}
#endif
#endif
)";

constexpr const char* picture_text = R"(
layout(location = 0) out vec4 target;
void main() {
#if NULL_VECTOR
  vec4 values = plane + quad_t(gl_FragCoord.xy) * twist;
#else
  vec4 m = weights(gl_FragCoord.xy);
  vec4 values = vec4(sum(m * value[0]), sum(m * value[1]), sum(m * value[2]), sum(m * vk));
  if (FORM != PRINTED) values.x /= sum(m);
#endif
  target = vec4(values.yz * (1.0 / values.w), values.x, 1.0);
  gl_FragDepth = values.x;
}
)";

/// Eqs. (10), (11) and (4). What the two triangles have outside the quad is killed by the signs of the weights (section
/// 5.1), and so is what lies behind the eye.
constexpr const char* fragment_text = R"(
uniform float to_centre;
uniform vec2 depths;      // znear, zfar
uniform bvec2 cull;       // back, front
layout(location = 0) out vec4 target[TARGETS];

void main() {
  vec4 m = weights(gl_FragCoord.xy - to_centre);
  float over_w = sum(m * vk), all = FORM == PRINTED ? 1.0 : sum(m * vw);
  if (any(lessThan(m * vk * over_w, vec4(0.0))) || over_w * all <= 0.0) discard;
#if FORM == PRINTED
  bool front = facing < 0.0;  // y points down
#else
  const bool front = false;
#endif
  if (front ? cull.y : cull.x) discard;

  float result[TARGETS * 4];
  for (int i = 0; i < TARGETS * 4; ++i) result[i] = 0.0;
  result[3] = front ? 2.0 : 1.0;
#if DEPTH
  result[2] = sum(m * value[0]) / all;
  if (result[2] < depths.x || result[2] > depths.y) discard;
#endif
  for (int i = 1; i < VALUES; ++i)
    result[i < 3 ? i - 1 : i + 1] = sum(m * value[i]) / (PERSPECTIVE ? over_w : all);
#if WEIGHTS
  vec4 lambda = PERSPECTIVE ? m * vk / over_w : FORM == PRINTED ? m : m * vw / all;
#if NULL_VECTOR
  if (origin.z != 0.0) lambda = lambda.zwxy;
#endif
  for (int i = 0; i < 4; ++i) result[TARGETS * 4 - 4 + i] = lambda[i];
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

ShaderSource quad_shader_source(const ShaderVariant& variant) {
  const auto number = [](const char* name, int value) {
    return std::string("#define ") + name + " " + std::to_string(value) + "\n";
  };
  const auto boolean = [](const char* name, bool value) {
    return std::string("#define ") + name + (value ? " true\n" : " false\n");
  };
  const std::string head =
      "#version 450 core\n" + number("PRINTED", 0) + number("NO_SMALL_A", 1) + number("DETERMINANT", 2) +
      number("BILINEAR", 3) + number("FORM", static_cast<int>(variant.form)) + number("PICTURE", variant.picture) +
      number("VALUES", 1 + variant.attributes) + number("VECTORS", vertex_vectors(variant.attributes)) +
      number("TARGETS", shader_targets(variant).all) + number("DEPTH", variant.depth) +
      number("WEIGHTS", variant.weights) + boolean("PERSPECTIVE", variant.perspective) +
      boolean("ATTRIBUTES_OVER_W", variant.attributes_over_w) + std::string(golden_glsl);
  return {
      head + "#define LINK out\n" + interface_text + vertex_text,
      head + "#define LINK in\n" + interface_text + weights_text + (variant.picture ? picture_text : fragment_text)};
}

}  // namespace quadrille::tb
