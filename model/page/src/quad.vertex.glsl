// A quad is an instance: attributes hold its four corners. Row y of the target is row y of the picture.
in vec4 corners_x, corners_y, corners_w, corners_k, corners_z;  // k times the vertex as given, from pixel centres
uniform vec2 viewport;                                           // pixels
flat out vec4 x, y, w, k, z, n;
flat out vec3 origin;  // a pixel near the quad, and whether it is turned
flat out float quad;

void main() {
  const int corner[6] = int[](0, 1, 2, 0, 2, 3);
  int own = corner[gl_VertexID];
  x = corners_x;
  y = corners_y;
  w = corners_w;
  k = corners_k;
  z = corners_z;
  quad = float(gl_InstanceID);
  // With z = 0 OpenGL clips what is behind the eye, and by the viewport alone.
  gl_Position = vec4(2.0 * (vec2(x[own], y[own]) + 0.5 * w[own]) / viewport - w[own], 0.0, w[own]);
#if DETERMINANT
  origin.xy = w.x > 0.0 ? clamp(round(vec2(x.x, y.x) / w.x), vec2(0.0), viewport) : 0.5 * viewport;
  x -= origin.x * w;
  y -= origin.y * w;
  n = mean_value_n(vec3(x.x, y.x, w.x), vec3(x.y, y.y, w.y), vec3(x.z, y.z, w.z), vec3(x.w, y.w, w.w));
  origin.z = float(mean_value_turned(n));
  if (origin.z != 0.0) {
    x = x.zwxy;
    y = y.zwxy;
    w = w.zwxy;
    k = k.zwxy;
    z = z.zwxy;
    n = n.zwxy;
  }
#else
  n = vec4(0.0);
  origin = vec3(0.0);
  x /= w;
  y /= w;
  k /= w;
  z /= w;
  w = sign(w);
#endif
}
