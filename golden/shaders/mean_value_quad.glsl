// Mean value coordinates of a quad in GLSL: the determinant form. Include this file behind `#version`. Apache-2.0.
//
// 1. A corner is (x, y, w), homogeneous window coordinates in pixels: of clip coordinates c and a viewport at (0, 0)
//    x = (c.x + c.w) / 2 * width, y = (c.y + c.w) / 2 * height, w = c.w, of any sign or 0. Corners 0 to 3 go around
//    the quad, either way. p is the pixel centre in the same pixels, gl_FragCoord.xy. Not in normalized device
//    coordinates: unequal scaling of x and y changes the weights.
// 2. Per quad: mean_value_n, and the order that mean_value_turned asks for.
// 3. Draw triangles 012 and 023, or 013 and 123: either pair covers the quad, also a concave or crossed one.
// 4. Per pixel: M = mean_value_weights; a common factor does not matter. The pixel is in the quad where no two M differ
//    in sign, and before the eye where sum(M w) has their sign, too: discard others. A convex quad before the eye needs
//    no test.
// 5. Perspective-correct value of corners' values f: sum(M f) / sum(M). Depth: sum(M z) / sum(M w), z homogeneous like
//    w. If corners were divided by their w, which then is 1: sum(M k f) / sum(M k) with k = 1 / w, and
//    sum(M z) / sum(M).
//
// Why: with S_i = (x_i, y_i) - w_i p and R_i = |S_i|, sum M_i S_i = 0 and sum (-1)^i R_i M_i = 0. Hence M = a - t n: a
// are the edge functions of triangle 012, n does not depend on p. No tangent, no guard, finite on edges and at corners,
// unless two corners meet there. Errors and when not to use this: golden/shaders/README.md.

// Once per quad: sum n_i (x_i, y_i, w_i) = 0. Subtract w times a pixel near the quad from x and y before: n stays the
// same, its rounding errors shrink. Who weighs pixels by these corners, too, subtracts that pixel from p.
vec4 mean_value_n(vec3 v0, vec3 v1, vec3 v2, vec3 v3) {
  vec3 v01 = cross(v0, v1);
  vec3 v23 = cross(v2, v3);
  return vec4(dot(v1, v23), -dot(v0, v23), dot(v3, v01), -dot(v2, v01));
}

// Whether triangle 230 is the larger one. Then take the corners in the order 2, 3, 0, 1, here and in all that follows:
// every vec4 of corners is v.zwxy, n too.
bool mean_value_turned(vec4 n) {
  return abs(n.y) > abs(n.w);
}

struct MeanValueT {
  float t;
  vec4 a;
};

// Once per pixel: t, and a of M = a - t n. x, y, w and n hold four corners each.
MeanValueT mean_value_t(vec4 x, vec4 y, vec4 w, vec4 n, vec2 p) {
  vec4 sx = x - w * p.x;
  vec4 sy = y - w * p.y;
  vec4 r = sqrt(sx * sx + sy * sy);
  vec4 a = vec4(sx.y * sy.z - sy.y * sx.z, sx.z * sy.x - sy.z * sx.x, sx.x * sy.y - sy.x * sx.y, 0.0);
  float t = (r.x * a.x - r.y * a.y + r.z * a.z) / (r.x * n.x - r.y * n.y + r.z * n.z - r.w * n.w);
  return MeanValueT(t, a);
}

vec4 mean_value_weights(vec4 x, vec4 y, vec4 w, vec4 n, vec2 p) {
  MeanValueT result = mean_value_t(x, y, w, n, p);
  return result.a - result.t * n;
}

// The quickest way where all w are 1: each value f is a plane plus t * twist. A vertex passes f on, vertex 3 f - twist,
// with `noperspective`; a fragment adds t * twist. For perspective do so with k f and with k, and divide.
float mean_value_twist(vec4 n, vec4 f) {
  return dot(n, f) / n.w;
}
