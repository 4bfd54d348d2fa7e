// Mean value weights of a snapped quad by the determinant form, in 113 bits: an oracle for the truth, with which it
// shares the definitions of S and R only. No half-angle, no choice by a sign, no singular case.
//
// A pixel sees vertex i at S_i = (X_i − W_i x, Y_i − W_i y), R_i = |S_i|. Three equations hold for the weights M:
//   Σ M_i S_i = 0           Hormann & Tarini (2004), eq. (9): the surface point lies on the pixel's ray; two rows
//   Σ (−1)^i R_i M_i = 0    eq. (8): R_i M_i = t_{i−1} + t_i, t_i = tan(α_i / 2), and each t_i occurs with both signs
// M is their null vector where their rank is 3. Else all determinants of three columns vanish. These are
// 4 ΠR_i Π cos(α_i / 2) times M_i, which is finite and not 0 on one edge (cos = 0, tan infinite) and at one corner
// (R = 0): it is 0 on two edges, at two corners, and at a corner on another edge.
// Two null vectors of the first two rows combine to it:
//   a, of one triangle      its edge functions (Cramer's rule), 0 at the fourth vertex
//   n, of the whole quad    determinants of three (X, Y, W): Σ n_i (X_i, Y_i, W_i) = 0 by Cramer's rule, at every pixel
//   M = a Σ(−1)^i R_i n_i − n Σ(−1)^i R_i a_i, which is a − n t without its division
#pragma once

#include "golden/reference/float113_test_support.hpp"
#include "golden/reference/port_number.hpp"
#include "model/port/config.hpp"
#include "model/port/records.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace quadrille::golden::test {

/// S of a vertex; its products are exact.
struct PixelOffset {
  __int128 x, y;

  PixelOffset(const SnappedVertex& v, int px, int py)
      : x(v.x - static_cast<__int128>(v.w) * px), y(v.y - static_cast<__int128>(v.w) * py) {}
  Float113 length() const { return sqrtq(static_cast<Float113>(x * x + y * y)); }
};

struct DeterminantWeights {
  std::array<Float113, 4> lambda{};  ///< M_i k_i / Σ M_j k_j, eq. (10); 0 where not `determined`
  /// No less than the error of any lambda: 16 roundings' worth of the sum of the magnitudes that form M, over |Σ M k|.
  double error = 0;
  bool determined = false;  ///< Σ M k is more than twice its error
  bool flat = false;        ///< n = 0: eye and vertices lie in one plane
};

class DeterminantQuad {
 public:
  explicit DeterminantQuad(const SnappedQuad& quad, const Config& config = {}) : quad_(quad) {
    const auto& v = quad.vertex;
    const auto minor = [&](int i, int j, int k) {  // exact: below 2^97
      const auto cross = [&](int p, int q) {
        return static_cast<__int128>(v[p].x) * v[q].y - static_cast<__int128>(v[q].x) * v[p].y;
      };
      return static_cast<Float113>(v[i].w * cross(j, k) + v[j].w * cross(k, i) + v[k].w * cross(i, j));
    };
    n_ = {minor(1, 2, 3), -minor(0, 2, 3), minor(0, 1, 3), -minor(0, 1, 2)};
    for (std::size_t i = 0; i < 4; ++i) k_[i] = port_value(v[i].k, config.significand_bits);
  }

  DeterminantWeights at(int px, int py) const {
    const auto& v = quad_.vertex;
    const std::array<PixelOffset, 4> s{{{v[0], px, py}, {v[1], px, py}, {v[2], px, py}, {v[3], px, py}}};
    const Four r{s[0].length(), -s[1].length(), s[2].length(), -s[3].length()};  // with (−1)^i
    const auto area = [&](int i, int j) { return static_cast<Float113>(s[i].x * s[j].y - s[j].x * s[i].y); };
    const auto of_triangle = [&](int without) {  // (A_jk, A_ki, A_ij) at its vertices i, j, k
      const int i = (without + 1) & 3, j = (without + 2) & 3, k = (without + 3) & 3;
      Four a{};
      a[i] = area(j, k), a[j] = area(k, i), a[k] = area(i, j);
      return a;
    };

    DeterminantWeights out;
    int without = largest(n_);  // the triangle with the largest determinant
    Four n = n_;
    out.flat = n[without] == 0;
    if (out.flat) {  // two triangles with a shared pair of vertices of the largest A do as well
      constexpr int pairs[][4] = {{0, 1, 2, 3}, {1, 2, 3, 0}, {2, 3, 0, 1}, {3, 0, 1, 2}, {0, 2, 1, 3}, {1, 3, 0, 2}};
      const auto& pair =
          *std::ranges::max_element(pairs, {}, [&](const auto& p) { return magnitude(area(p[0], p[1])); });
      without = pair[2];
      n = of_triangle(pair[3]);
    }
    const Four a = of_triangle(without);

    Float113 along_n = 0, along_a = 0, sum = 0;
    double size_n = 0, size_a = 0, size_sum = 0;
    for (int i = 0; i < 4; ++i) {
      along_n += r[i] * n[i], along_a += r[i] * a[i];
      size_n += magnitude(r[i] * n[i]), size_a += magnitude(r[i] * a[i]);
    }
    std::array<double, 4> size;
    for (int i = 0; i < 4; ++i) {
      out.lambda[i] = (a[i] * along_n - n[i] * along_a) * k_[i];
      sum += out.lambda[i];
      size[i] = (magnitude(a[i]) * size_n + magnitude(n[i]) * size_a) * k_[i];
      size_sum += size[i];
    }
    // Roundings, each of 2^-113 of the magnitudes: root 2 (one unit of the last place),
    // product 1, sum of four 3; product, difference, k: 3; sum of four 3; quotient 1: 13. The other three are for the
    // second order and for `size`, in double.
    constexpr double roundings = 16 * 0x1p-113;
    const double sum_size = magnitude(sum);
    out.determined = sum_size > 2 * roundings * size_sum;
    if (!out.determined) return out.lambda = {}, out;
    for (int i = 0; i < 4; ++i) {
      out.lambda[i] /= sum;
      // Of numerator and denominator; the latter is at least sum_size / 2.
      out.error = std::max(out.error, 2 * roundings * (size[i] + magnitude(out.lambda[i]) * size_sum) / sum_size);
    }
    return out;
  }

 private:
  using Four = std::array<Float113, 4>;

  static double magnitude(Float113 value) { return std::fabs(static_cast<double>(value)); }
  static int largest(const Four& of) {
    int at = 0;
    for (int i = 1; i < 4; ++i)
      if (magnitude(of[i]) > magnitude(of[at])) at = i;
    return at;
  }

  SnappedQuad quad_;
  Four n_{};
  std::array<double, 4> k_{};
};

}  // namespace quadrille::golden::test
