#include "model/front/tile_context.hpp"

namespace quadrille {
namespace {

QuadraticForm dot(const RelativeVertex& a, const RelativeVertex& b, int drop) {
  return {(a.x * b.x + a.y * b.y) >> drop, -(a.x * b.w + a.w * b.x) >> drop, -(a.y * b.w + a.w * b.y) >> drop,
          (a.w * b.w) >> drop};
}

}  // namespace

std::array<QuadraticForm, quadratic_count> tile_context(const QuadConstants& quad, int x, int y, int drop) {
  std::array<RelativeVertex, 4> s = quad.vertex;
  for (RelativeVertex& v : s) {
    v.x -= v.w * x;
    v.y -= v.w * y;
  }
  std::array<QuadraticForm, quadratic_count> f{};
  if (quad.homogeneous)
    for (std::size_t k = 0; k < linear_count; ++k) f[k] = dot(s[vertex_pair[k][0]], s[vertex_pair[k][1]], drop);
  for (std::size_t i = 0; i < 4; ++i) f[linear_count + i] = dot(s[i], s[i], drop);
  return f;
}

}  // namespace quadrille
