// The weights of a pixel, and which quad is seen there. The signs of the weights kill what the two triangles of a quad
// have outside it and what is behind the eye.
flat in vec4 x, y, w, k, z, n;
flat in vec3 origin;
flat in float quad;
uniform bvec2 cull;   // back, front
uniform vec2 depths;  // znear, zfar
uniform bool perspective, depth;
layout(location = 0) out vec4 weights;
layout(location = 1) out vec4 seen;  // the quad + 1, window z, negative: a front

float sum(vec4 v) { return v.x + v.y + v.z + v.w; }

void main() {
  vec2 p = gl_FragCoord.xy - 0.5;
#if DETERMINANT
  MeanValueT found = mean_value_t(x, y, w, n, p - origin.xy);
  vec4 m = found.a - found.t * n;
  // Their common factor has any sign: the pixel is in triangle 012 or 023, on either side of the diagonal.
  bool first = min(found.a.x, found.a.z) * found.a.y >= 0.0 && max(found.a.x, found.a.z) * found.a.y >= 0.0;
  float facing = first ? found.a.y : -found.a.y, all = sum(m * w);
#else
  vec4 m = paper_weights(x, y, w, p, 0.0);
  float facing = sum(m), all = 1.0;
  m /= facing;
#endif
  float over_w = sum(m * k);
  if (any(lessThan(m * k * over_w, vec4(0.0))) || over_w * all <= 0.0) discard;
  if (facing < 0.0 ? cull.y : cull.x) discard;  // y points down
  float window_z = sum(m * z) / all;
  if (depth && (window_z < depths.x || window_z > depths.y)) discard;
  weights = perspective ? m * k / over_w : DETERMINANT != 0 ? m * w / all : m;
#if DETERMINANT
  if (origin.z != 0.0) weights = weights.zwxy;
#endif
  seen = vec4(quad + 1.0, window_z, facing, 0.0);
  // What is no number lies behind all that is one.
  gl_FragDepth = window_z >= 0.0 ? window_z : 0.9999999;
}
