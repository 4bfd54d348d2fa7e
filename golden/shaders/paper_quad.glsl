// Mean value coordinates of a quad in GLSL: the formulas of Hormann and Tarini (2004, section 4.2) as printed, for
// comparisons. mean_value_quad.glsl is better. Apache-2.0.

// x, y: corners' window coordinates, divided by their w; w_sign: the signs of w; p: the pixel centre in the same pixels.
// Returns mu: of the weights lambda = mu / sum(mu). No number at edges and corners. Where |A| < least_area a tangent
// counts as 0: 1e-6 is Bloomenthal's guard, 0 the printed formulas. Where y points down, sum(mu) < 0 is a front.
vec4 paper_weights(vec4 x, vec4 y, vec4 w_sign, vec2 p, float least_area) {
  vec4 sx = x - p.x, sy = y - p.y;
  vec4 r = sqrt(sx * sx + sy * sy) * w_sign;
  vec4 area = sx * sy.yzwx - sy * sx.yzwx;
  vec4 inner = sx * sx.yzwx + sy * sy.yzwx;
  vec4 product = r * r.yzwx;
  vec4 t = mix((product - inner) / area, vec4(0.0), lessThan(abs(area), vec4(least_area)));
  return (t.wxyz + t) / r;
}
