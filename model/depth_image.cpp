#include "model/depth_image.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace quadrille {

template <class Real>
DepthImage<Real>::DepthImage(int width, int height, int attributes, const Config& config, bool depth, bool ids)
    : width_(width),
      height_(height),
      depth_(depth),
      depth_unit_(std::ldexp(Real{1}, -config.depth_bits)),
      attribute_unit_(std::ldexp(Real{1}, -config.attribute_frac())),
      planes_(1 + static_cast<std::size_t>(attributes)) {
  if (planes_.size() > most_planes) throw std::invalid_argument("DepthImage: more than 8 attributes");
  if (ids) quads_.emplace_back();
  clear();
}

template <class Real>
void DepthImage<Real>::clear() {
  for (Block& block : blocks_) block.size = 0;
  const std::size_t pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  for (std::vector<Real>& plane : planes_) plane.assign(pixels, static_cast<Real>(&plane == &planes_.front()));
  if (!quads_.empty()) quads_.assign(pixels, no_quad);
}

template <class Real>
template <class F>
void DepthImage<Real>::with_planes(F&& f) const {
  [&]<std::size_t... n>(std::index_sequence<n...>) {
    ((planes_.size() == n + 1 ? f(std::integral_constant<std::size_t, n + 1>{}) : void()), ...);
  }
  (std::make_index_sequence<most_planes>{});
}

template <class Real>
void DepthImage<Real>::write(const FragmentArrays& fragments) {
  with_planes([&](auto planes) { append<planes>(fragments); });
}

template <class Real>
void DepthImage<Real>::overwrite(std::size_t pixel, Real depth, std::span<const Real> attributes, std::uint32_t quad) {
  settle();
  planes_[0][pixel] = depth;
  for (std::size_t j = 1; j < planes_.size(); ++j) planes_[j][pixel] = attributes[j - 1];
  if (!quads_.empty()) quads_[pixel] = quad;
}

template <class Real>
void DepthImage<Real>::settle_all() const {
  with_planes([&](auto planes) {
    settle<planes>(blocks_[newer_ ^ 1]);
    settle<planes>(blocks_[newer_]);
  });
}

template <class Real>
template <std::size_t planes>
void DepthImage<Real>::append(const FragmentArrays& fragments) {
  std::array<const Real*, planes> plane;
  for (std::size_t j = 0; j < planes; ++j) plane[j] = planes_[j].data();
  const auto width = static_cast<std::uint32_t>(width_);
  for (std::size_t done = 0; done < fragments.size;) {
    if (blocks_[newer_].size == block_size) settle<planes>(blocks_[newer_ ^= 1]);
    Block& block = blocks_[newer_];
    const std::size_t end = std::min(fragments.size, done + block_size - block.size);
    std::size_t at = block.size;
    for (std::size_t i = done; i < end; ++i, ++at) {
      const std::uint32_t pixel = fragments.place[i].y * width + fragments.place[i].x;
      for (std::size_t j = 0; j < planes; ++j) __builtin_prefetch(plane[j] + pixel, 1, 2);
      block.pixel[at] = pixel;
      // A code is at most 2^30: signed numbers are the quick ones to convert.
      block.value[0][at] = static_cast<Real>(static_cast<std::int32_t>(fragments.depth[i])) * depth_unit_;
      for (std::size_t j = 1; j < planes; ++j)
        block.value[j][at] = static_cast<Real>(fragments.attribute[j - 1][i]) * attribute_unit_;
    }
    std::fill(block.quad.begin() + static_cast<std::ptrdiff_t>(block.size),
              block.quad.begin() + static_cast<std::ptrdiff_t>(at), fragments.quad);
    block.size = at;
    done = end;
  }
}

template <class Real>
template <std::size_t planes>
void DepthImage<Real>::settle(Block& block) const {
  std::array<Real*, planes> plane;
  for (std::size_t j = 0; j < planes; ++j) plane[j] = planes_[j].data();
  std::uint32_t* const quads = quads_.empty() ? nullptr : quads_.data();
  for (std::size_t i = 0; i < block.size; ++i) {
    const std::size_t pixel = block.pixel[i];
    if (depth_ && !(block.value[0][i] < plane[0][pixel])) continue;
    for (std::size_t j = 0; j < planes; ++j) plane[j][pixel] = block.value[j][i];
    if (quads != nullptr) quads[pixel] = block.quad[i];
  }
  block.size = 0;
}

template class DepthImage<float>;
template class DepthImage<double>;

}  // namespace quadrille
