#include "golden/reference/exact_coverage.hpp"

#include <array>

namespace quadrille::golden {

namespace {

using Wide = __int128;  // three factors of 31 bits and six terms: below 2^97
using Vector = std::array<Wide, 3>;

/// Rule of Sarrus.
Wide determinant(const Vector& a, const Vector& b, const Vector& c) {
  return a[0] * b[1] * c[2] + a[1] * b[2] * c[0] + a[2] * b[0] * c[1] - a[2] * b[1] * c[0] - a[1] * b[0] * c[2] -
         a[0] * b[2] * c[1];
}

int sign_of(Wide value) { return (value > 0) - (value < 0); }

/// Sign for all sufficiently small eps > 0 of det(p + eps e_x + eps^2 e_y, b, c), a polynomial in eps whose
/// coefficients decide in turn.
int perturbed_sign(const Vector& p, const Vector& b, const Vector& c) {
  constexpr Vector first{1, 0, 0}, second{0, 1, 0};
  for (const Vector& coefficient : {p, first, second}) {
    const int sign = sign_of(determinant(coefficient, b, c));
    if (sign != 0) return sign;
  }
  return 0;
}

struct Triangle {
  int orientation = 0;    ///< common sign of the numerators; 0: not covered
  bool in_front = false;  ///< all c_i > 0
};

Triangle triangle(const Vector& p, const Vector& a, const Vector& b, const Vector& c) {
  // c_a = det(p, b, c) / det(a, b, c), and cyclic.
  const int na = perturbed_sign(p, b, c), nb = perturbed_sign(p, c, a), nc = perturbed_sign(p, a, b);
  if (na == 0 || na != nb || nb != nc) return {};
  return {na, na * sign_of(determinant(a, b, c)) > 0};
}

}  // namespace

ExactCoverage exact_coverage(const SnappedQuad& quad, int px, int py) {
  const auto vector = [&](int i) { return Vector{quad.vertex[i].x, quad.vertex[i].y, quad.vertex[i].w}; };
  const Vector p{px, py, 1};
  const Triangle first = triangle(p, vector(0), vector(1), vector(2));
  const Triangle second = triangle(p, vector(0), vector(2), vector(3));
  // The shared diagonal runs in opposite directions, so two covering triangles have opposite orientations and cancel.
  const int sum = first.orientation + second.orientation;
  if (sum == 0) return {};
  return {true, sum < 0, first.orientation != 0 ? first.in_front : second.in_front};
}

}  // namespace quadrille::golden
