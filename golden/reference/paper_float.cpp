#include "golden/reference/paper_float.hpp"

#include "golden/reference/port_number.hpp"

#include <cmath>

namespace quadrille::golden {

namespace {

template <class Real>
Real sign(Real v) {
  return static_cast<Real>((v > 0) - (v < 0));
}

int next(int i) { return (i + 1) & 3; }
int previous(int i) { return (i + 3) & 3; }

}  // namespace

template <class Real>
PaperQuad<Real>::PaperQuad(const SnappedQuad& quad, const Config& config, const DrawState& draw)
    : attributes_(draw.attributes), perspective_(draw.perspective) {
  const int frac = config.frac();
  const auto port = [&](const PortNumber& number) {
    return static_cast<Real>(port_value(number, config.significand_bits));
  };
  const auto base_z = static_cast<Real>(std::ldexp(static_cast<double>(quad.base.depth), -config.depth_bits));
  for (int i = 0; i < 4; ++i) {
    const SnappedVertex& v = quad.vertex[i];
    x_[i] = std::ldexp(static_cast<double>(v.x), -frac);
    y_[i] = std::ldexp(static_cast<double>(v.y), -frac);
    w_[i] = std::ldexp(static_cast<double>(v.w), -frac);
    homogeneous_ = homogeneous_ || w_[i] != 1;
    const auto w = static_cast<Real>(w_[i]);
    vx_[i] = static_cast<Real>(x_[i]) / w;
    vy_[i] = static_cast<Real>(y_[i]) / w;
    w_sign_[i] = sign(w);
    inverse_w_[i] = port(v.k) / w;
    z_over_w_[i] = base_z + port(v.z) / w;
    for (int a = 0; a < attributes_; ++a) {
      const auto base =
          static_cast<Real>(std::ldexp(static_cast<double>(quad.base.attribute[a]), -config.attribute_frac()));
      // The difference is k (a - base) with perspective, W (a - base) without; vertex 0 has the base itself.
      const Real value = i == 0 ? base : base + port(v.attribute[a]) / (perspective_ ? port(v.k) : w);
      a_[a][i] = perspective_ ? value * inverse_w_[i] : value;
    }
  }
  find_rows(draw);
}

template <class Real>
PaperQuad<Real>::PaperQuad(const WindowQuad& quad, const DrawState& draw)
    : centre_(0.5), attributes_(draw.attributes), perspective_(draw.perspective) {
  for (int i = 0; i < 4; ++i) {
    const WindowVertex& v = quad.vertex[i];
    x_[i] = v.x;
    y_[i] = v.y;
    w_[i] = v.w;
    homogeneous_ = homogeneous_ || !(v.w > 0);
    const auto w = static_cast<Real>(v.w);
    vx_[i] = static_cast<Real>(v.x) / w;
    vy_[i] = static_cast<Real>(v.y) / w;
    w_sign_[i] = sign(w);
    inverse_w_[i] = 1 / w;
    z_over_w_[i] = static_cast<Real>(v.z) / w;
    for (int a = 0; a < attributes_; ++a) {
      const bool given = a < static_cast<int>(quad.attribute[i].size());
      const auto value = static_cast<Real>(given ? quad.attribute[i][a] : 0.0);
      a_[a][i] = perspective_ ? value / w : value;
    }
  }
  find_rows(draw);
}

template <class Real>
void PaperQuad<Real>::find_rows(const DrawState& draw) {
  std::array<CoverageRows::Vertex, 4> vertex;
  for (std::size_t i = 0; i < 4; ++i) vertex[i] = {x_[i], y_[i], w_[i]};
  rows_ = {vertex, centre_, scissor_of(draw), CoverageRows::Eye::anywhere};
}

/// Membership: expression (12) on homogeneous edge functions; true, false, or neither for an all-zero edge.
template <class Real>
void PaperQuad<Real>::cover(int px, int py, ReferenceSample& out) const {
  const double x = px + centre_, y = py + centre_;
  bool tie = false;
  const auto edge = [&](int i, int j) {
    const double six = x_[i] - w_[i] * x, siy = y_[i] - w_[i] * y;
    const double sjx = x_[j] - w_[j] * x, sjy = y_[j] - w_[j] * y;
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
}

template <class Real>
typename PaperQuad<Real>::Pixel PaperQuad<Real>::interpolate(int px, int py) const {
  const auto x = static_cast<Real>(px + centre_), y = static_cast<Real>(py + centre_);

  // The pseudo-code, line by line.
  std::array<Real, 4> sx, sy, lambda;
  for (int i = 0; i < 4; ++i) {
    sx[i] = vx_[i] - x;
    sy[i] = vy_[i] - y;
  }
  Pixel p{PaperWeights<Real>(sx, sy, w_sign_)};
  p.sum_mu = p.mu[0] + p.mu[1] + p.mu[2] + p.mu[3];
  for (int i = 0; i < 4; ++i) lambda[i] = p.mu[i] / p.sum_mu;

  // Eq. (10), (11), (4).
  for (int i = 0; i < 4; ++i) {
    p.sum_inverse_w += lambda[i] * inverse_w_[i];
    p.z += lambda[i] * z_over_w_[i];
  }
  p.defined = std::isfinite(p.sum_mu) && std::isfinite(p.sum_inverse_w) && std::isfinite(p.z);
  for (int i = 0; i < 4; ++i) {
    p.lambda[i] = perspective_ ? lambda[i] * inverse_w_[i] / p.sum_inverse_w : lambda[i];
    p.defined = p.defined && std::isfinite(p.lambda[i]);
  }
  for (int a = 0; a < attributes_; ++a) {
    Real sum = 0;
    for (int i = 0; i < 4; ++i) sum += lambda[i] * a_[a][i];
    p.attribute[a] = perspective_ ? sum / p.sum_inverse_w : sum;
    p.defined = p.defined && std::isfinite(p.attribute[a]);
  }
  return p;
}

template <class Real>
ReferenceSample PaperQuad<Real>::sample(int px, int py) const {
  ReferenceSample out;
  cover(px, py, out);
  if (!out.covered) return out;
  const Pixel p = interpolate(px, py);

  int corners = 0, edges = 0;
  for (int i = 0; i < 4; ++i) {
    corners += p.r[i] == 0;
    // The signed lengths turn the sense of D on an exterior edge, exactly as S = w s does.
    edges += p.area[i] == 0 && p.dot[i] * w_sign_[i] * w_sign_[next(i)] < 0;
  }
  if (corners > 0) {
    out.flags |= corners > 1 ? flag_two_corner : flag_on_vertex;
  } else if (edges > 0) {
    out.flags |= edges > 1 ? flag_two_edge : flag_on_edge;
  }

  for (int i = 0; i < 4; ++i) out.lambda[i] = p.lambda[i];
  for (int a = 0; a < attributes_; ++a) out.attribute[a] = p.attribute[a];
  out.z = p.z;
  out.undefined = !p.defined;
  if (out.undefined) return out;

  Real spread = 0, size_inverse = 0, size_mu = 0;
  for (int i = 0; i < 4; ++i) {
    size_inverse += p.mu[i] * inverse_w_[i];
    size_mu += std::abs(p.mu[i]);
    spread += (std::abs(p.t[previous(i)]) + std::abs(p.t[i])) * std::abs(inverse_w_[i] / p.r[i]);
  }
  out.visible = p.sum_inverse_w > 0;
  out.visible_margin = p.sum_mu / size_mu * sign(size_inverse);
  out.condition = spread / std::abs(size_inverse);
  out.z_condition = size_mu / std::abs(p.sum_mu);
  return out;
}

template class PaperQuad<float>;
template class PaperQuad<double>;

}  // namespace quadrille::golden
