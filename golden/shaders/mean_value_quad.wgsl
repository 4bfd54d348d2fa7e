// Mean value coordinates of a quad in WGSL: the determinant form. Apache-2.0. mean_value_quad.glsl has inputs,
// conventions and steps. Here p is @builtin(position).xy, and y = (c.w - c.y) / 2 * height.

// Once per quad: sum n_i (x_i, y_i, w_i) = 0. Subtract w times a pixel near the quad from x and y before: n stays the
// same, its rounding errors shrink. Who weighs pixels by these corners, too, subtracts that pixel from p.
fn mean_value_n(v0: vec3f, v1: vec3f, v2: vec3f, v3: vec3f) -> vec4f {
  let v01 = cross(v0, v1);
  let v23 = cross(v2, v3);
  return vec4f(dot(v1, v23), -dot(v0, v23), dot(v3, v01), -dot(v2, v01));
}

// Whether triangle 230 is the larger one. Then take the corners in the order 2, 3, 0, 1, here and in all that follows:
// every vec4f of corners is v.zwxy, n too.
fn mean_value_turned(n: vec4f) -> bool {
  return abs(n.y) > abs(n.w);
}

struct MeanValueT {
  t: f32,
  a: vec4f,
}

// Once per pixel: t, and a of M = a - t n. x, y, w and n hold four corners each.
fn mean_value_t(x: vec4f, y: vec4f, w: vec4f, n: vec4f, p: vec2f) -> MeanValueT {
  let sx = x - w * p.x;
  let sy = y - w * p.y;
  let r = sqrt(sx * sx + sy * sy);
  let a = vec4f(sx.y * sy.z - sy.y * sx.z, sx.z * sy.x - sy.z * sx.x, sx.x * sy.y - sy.x * sx.y, 0.0);
  let t = (r.x * a.x - r.y * a.y + r.z * a.z) / (r.x * n.x - r.y * n.y + r.z * n.z - r.w * n.w);
  return MeanValueT(t, a);
}

fn mean_value_weights(x: vec4f, y: vec4f, w: vec4f, n: vec4f, p: vec2f) -> vec4f {
  let result = mean_value_t(x, y, w, n, p);
  return result.a - result.t * n;
}

// The quickest way where all w are 1: each value f is a plane plus t * twist. A vertex passes f on, vertex 3 f - twist,
// with @interpolate(linear); a fragment adds t * twist. For perspective do so with k f and with k, and divide.
fn mean_value_twist(n: vec4f, f: vec4f) -> f32 {
  return dot(n, f) / n.w;
}
