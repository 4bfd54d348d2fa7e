#include "golden/reference/paper_float.hpp"

#include "golden/reference/port_number.hpp"

#include <cmath>

namespace quadrille::golden {

namespace {

double sign(double v) { return static_cast<double>((v > 0) - (v < 0)); }

}  // namespace

PaperFloatQuad::PaperFloatQuad(const SnappedQuad& quad, const Config& config, const DrawState& draw)
    : attributes_(draw.attributes), perspective_(draw.perspective) {
  const int frac = config.frac(), bits = config.significand_bits;
  for (int i = 0; i < 4; ++i) {
    const SnappedVertex& v = quad.vertex[i];
    x_[i] = std::ldexp(static_cast<double>(v.x), -frac);
    y_[i] = std::ldexp(static_cast<double>(v.y), -frac);
    w_[i] = std::ldexp(static_cast<double>(v.w), -frac);
    homogeneous_ = homogeneous_ || w_[i] != 1;
    inverse_w_[i] = port_value(v.k, bits) / w_[i];
    z_over_w_[i] = port_value(v.z, bits) / w_[i];
    // b is k a with perspective and W a without, so one division serves both.
    for (int a = 0; a < attributes_; ++a) a_[a][i] = port_value(v.attribute[a], bits) / w_[i];
  }
}

PaperFloatQuad::PaperFloatQuad(const WindowQuad& quad, const DrawState& draw)
    : centre_(0.5), attributes_(draw.attributes), perspective_(draw.perspective) {
  for (int i = 0; i < 4; ++i) {
    const WindowVertex& v = quad.vertex[i];
    x_[i] = v.x;
    y_[i] = v.y;
    w_[i] = v.w;
    homogeneous_ = homogeneous_ || !(v.w > 0);
    inverse_w_[i] = 1 / v.w;
    z_over_w_[i] = v.z / v.w;
    for (int a = 0; a < attributes_; ++a) {
      const double value = a < static_cast<int>(quad.attribute[i].size()) ? quad.attribute[i][a] : 0.0;
      a_[a][i] = perspective_ ? value / v.w : value;
    }
  }
}

ReferenceSample PaperFloatQuad::sample(int px, int py) const {
  ReferenceSample out;
  const double vx = px + centre_, vy = py + centre_;
  const auto next = [](int i) { return (i + 1) & 3; };

  // Membership: expression (12) on homogeneous edge functions; true, false, or neither for an all-zero edge.
  bool tie = false;
  const auto edge = [&](int i, int j) {
    const double six = x_[i] - w_[i] * vx, siy = y_[i] - w_[i] * vy;
    const double sjx = x_[j] - w_[j] * vx, sjy = y_[j] - w_[j] * vy;
    const double e = six * sjy - siy * sjx;
    if (e != 0) return sign(e);
    const double dx = y_[i] * w_[j] - w_[i] * y_[j];
    const double by_tie = dx != 0 ? sign(dx) : sign(w_[i] * x_[j] - x_[i] * w_[j]);
    tie = tie || by_tie != 0;  // an all-zero edge decides nothing
    return by_tie;
  };
  const double e01 = edge(0, 1), e12 = edge(1, 2), e23 = edge(2, 3), e30 = edge(3, 0), e20 = edge(2, 0);
  const auto inside = [&](double o) {
    return (e20 == o && e01 == o && e12 == o && (e23 == o || e30 == o)) ||
           (e20 == -o && e23 == o && e30 == o && (e01 == o || e12 == o));
  };
  const bool back = inside(1.0);
  out.covered = back || inside(-1.0);
  out.front = out.covered && !back;
  out.flags = static_cast<std::uint8_t>((tie ? flag_tie : 0) | (homogeneous_ ? flag_homogeneous : 0));
  if (!out.covered) return out;

  // The pseudo-code, line by line.
  std::array<double, 4> sx, sy, area, dot, r, t, mu, lambda;
  for (int i = 0; i < 4; ++i) {
    sx[i] = x_[i] / w_[i] - vx;
    sy[i] = y_[i] / w_[i] - vy;
  }
  for (int i = 0; i < 4; ++i) {
    area[i] = sx[i] * sy[next(i)] - sy[i] * sx[next(i)];
    dot[i] = sx[i] * sx[next(i)] + sy[i] * sy[next(i)];
    r[i] = std::sqrt(sx[i] * sx[i] + sy[i] * sy[i]) * sign(w_[i]);
  }
  for (int i = 0; i < 4; ++i) t[i] = (r[i] * r[next(i)] - dot[i]) / area[i];
  for (int i = 0; i < 4; ++i) mu[i] = (t[(i + 3) & 3] + t[i]) / r[i];
  const double total = mu[0] + mu[1] + mu[2] + mu[3];
  for (int i = 0; i < 4; ++i) lambda[i] = mu[i] / total;

  int corners = 0, edges = 0;
  for (int i = 0; i < 4; ++i) {
    corners += r[i] == 0;
    // The signed lengths turn the sense of D on an exterior edge, exactly as S = w s does.
    edges += area[i] == 0 && dot[i] * sign(w_[i]) * sign(w_[next(i)]) < 0;
  }
  if (corners > 0) {
    out.flags |= corners > 1 ? flag_two_corner : flag_on_vertex;
  } else if (edges > 0) {
    out.flags |= edges > 1 ? flag_two_edge : flag_on_edge;
  }

  // Eq. (10), (11), (4).
  double sum_inverse = 0, spread = 0, size_inverse = 0, size_mu = 0;
  for (int i = 0; i < 4; ++i) {
    sum_inverse += lambda[i] * inverse_w_[i];
    size_inverse += mu[i] * inverse_w_[i];
    size_mu += std::abs(mu[i]);
    spread += (std::abs(t[(i + 3) & 3]) + std::abs(t[i])) * std::abs(inverse_w_[i] / r[i]);
    out.z += lambda[i] * z_over_w_[i];
  }
  bool finite = std::isfinite(total) && std::isfinite(sum_inverse) && std::isfinite(out.z);
  for (int i = 0; i < 4; ++i) {
    out.lambda[i] = perspective_ ? lambda[i] * inverse_w_[i] / sum_inverse : lambda[i];
    finite = finite && std::isfinite(out.lambda[i]);
  }
  for (int a = 0; a < attributes_; ++a) {
    double sum = 0;
    for (int i = 0; i < 4; ++i) sum += lambda[i] * a_[a][i];
    out.attribute[a] = perspective_ ? sum / sum_inverse : sum;
    finite = finite && std::isfinite(out.attribute[a]);
  }
  out.undefined = !finite;
  if (out.undefined) return out;
  out.visible = sum_inverse > 0;
  out.visible_margin = total / size_mu * sign(size_inverse);
  out.condition = spread / std::abs(size_inverse);
  out.z_condition = size_mu / std::abs(total);
  return out;
}

}  // namespace quadrille::golden
