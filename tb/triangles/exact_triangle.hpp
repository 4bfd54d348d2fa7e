// A snapped triangle in exact arithmetic, from the port's integers alone: three edge functions, their ties, areas as
// weights. The reference of the triangle machine; nothing of it comes from the model or the RTL.
#pragma once

#include "golden/reference/port_number.hpp"
#include "model/port/config.hpp"
#include "tb/triangles/machine.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace quadrille::tb {

__extension__ using Wide = __int128;
__extension__ using Real = __float128;

class ExactTriangle {
 public:
  /// A weighted mean of the corners' differences to the base, and what its error depends on.
  struct Mean {
    double value = 0;
    double moved = 0;    ///< sum of weight |difference - value|: what relative errors of the weights move
    double largest = 0;  ///< of the terms
  };
  struct Pixel {
    bool front = false, on_edge = false;
    std::array<Mean, max_attribute_slots> attribute{};
    Mean depth;
  };

  ExactTriangle(const SnappedTriangle& triangle, const Config& config, const DrawState& state)
      : triangle_(triangle), config_(config), state_(state) {
    for (std::size_t i = 0; i < 3; ++i) {
      const SnappedVertex &a = triangle.vertex[i], &b = triangle.vertex[(i + 1) % 3];
      edge_[i] = {Wide{a.x} * b.y - Wide{a.y} * b.x, Wide{a.y} * b.w - Wide{a.w} * b.y,
                  Wide{a.w} * b.x - Wide{a.x} * b.w};
    }
    const SnappedVertex& c = triangle.vertex[2];
    const Wide determinant = edge_[0][1] * c.x + edge_[0][2] * c.y + edge_[0][0] * c.w;
    sense_ = (determinant > 0) - (determinant < 0);
  }

  /// Not culled, in front of the eye, inside the scissor; else nothing.
  std::optional<Pixel> at(int x, int y) const {
    std::array<Wide, 3> value{};
    Pixel pixel;
    if (x < state_.scissor_x0 || x >= state_.scissor_x1 || y < state_.scissor_y0 || y >= state_.scissor_y1) return {};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [constant, gx, gy] = edge_[i];
      value[i] = constant + x * gx + y * gy;
      const Wide decides = value[i] != 0 ? value[i] : gx != 0 ? gx : gy;
      if (sense_ == 0 || decides == 0 || (decides > 0) != (sense_ > 0)) return {};
      pixel.on_edge = pixel.on_edge || value[i] == 0;
    }
    pixel.front = sense_ < 0;
    if (state_.cull == (pixel.front ? Cull::front : Cull::back)) return {};
    fill(pixel, value);
    return pixel;
  }

 private:
  void fill(Pixel& pixel, const std::array<Wide, 3>& value) const {
    const int s = config_.significand_bits;
    std::array<Real, 3> by_k{}, by_w{};
    std::array<std::array<Real, 3>, max_attribute_slots> attribute{};
    std::array<Real, 3> z{};
    for (std::size_t i = 0; i < 3; ++i) {
      const SnappedVertex& v = triangle_.vertex[i];
      const Wide opposite = value[(i + 1) % 3];
      const Real area = static_cast<Real>(opposite < 0 ? -opposite : opposite);
      by_w[i] = area * std::ldexp(v.w, -config_.frac());
      by_k[i] = state_.perspective ? area * golden::port_value(v.k, s) : by_w[i];
      z[i] = area * golden::port_value(v.z, s);
      for (std::size_t slot = 0; i != 0 && slot < attribute.size(); ++slot)
        attribute[slot][i] = area * golden::port_value(v.attribute[slot], s);
    }
    for (std::size_t slot = 0; slot < attribute.size(); ++slot) pixel.attribute[slot] = mean(attribute[slot], by_k);
    pixel.depth = mean(z, by_w);
  }

  static Mean mean(const std::array<Real, 3>& terms, const std::array<Real, 3>& weights) {
    const Real sum = weights[0] + weights[1] + weights[2], value = (terms[0] + terms[1] + terms[2]) / sum;
    Mean mean;
    mean.value = static_cast<double>(value);
    for (std::size_t i = 0; i < 3; ++i) {
      mean.moved += std::fabs(static_cast<double>((terms[i] - weights[i] * value) / sum));
      mean.largest = std::max(mean.largest, std::fabs(static_cast<double>(terms[i] / sum)));
    }
    return mean;
  }

  const SnappedTriangle& triangle_;
  const Config& config_;
  const DrawState& state_;
  std::array<std::array<Wide, 3>, 3> edge_{};  ///< 01, 12, 20: value, gx, gy
  int sense_ = 0;                              ///< of the determinant: the orientation that is in front of the eye
};

}  // namespace quadrille::tb
