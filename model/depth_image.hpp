// A picture: of each pixel the depth and the attributes of the nearest fragment, in planes of floats or doubles.
#pragma once

#include "model/port/config.hpp"
#include "model/port/fragment_arrays.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace quadrille {

/// Doubles hold every code exactly. Floats round attributes to 24 bits. They also round depths of more than 24
/// depth_bits, before these are compared.
template <class Real>
class DepthImage {
 public:
  /// Of fragments of that configuration with so many attributes, cleared. `depth`: the test is LESS, else none. `ids`:
  /// it remembers whose fragments it shows.
  DepthImage(int width, int height, int attributes, const Config& config, bool depth, bool ids = false);

  static constexpr std::uint32_t no_quad = 0xffffffff;
  /// Depth 1, attributes 0, no_quad.
  void clear();
  /// Of equal depths the earlier fragment stays; without the test the later one. All lie within the picture.
  void write(const FragmentArrays& fragments);
  /// What a pixel shows from now on.
  void overwrite(std::size_t pixel, Real depth, std::span<const Real> attributes, std::uint32_t quad);

  /// Fragments that wait go to their pixels. Who looks settles too: after a write one thread has to before several do.
  void settle() const {
    if (blocks_[newer_].size != 0) settle_all();
  }
  int width() const { return width_; }
  int height() const { return height_; }
  /// The numbers of all pixels, row by row from the top.
  std::span<const Real> depth() const { return plane(0); }
  std::span<const Real> attribute(int j) const { return plane(1 + static_cast<std::size_t>(j)); }
  /// Ids as given by FragmentArrays; empty without `ids`.
  std::span<const std::uint32_t> quads() const {
    settle();
    return quads_;
  }

 private:
  static constexpr std::size_t most_planes = 1 + max_attribute_slots;
  static constexpr std::size_t block_size = 512;
  /// Fragments that wait until the memory of their pixels is near.
  struct Block {
    std::size_t size = 0;
    std::array<std::uint32_t, block_size> pixel, quad;
    std::array<std::array<Real, block_size>, most_planes> value;
  };

  std::span<const Real> plane(std::size_t i) const {
    settle();
    return planes_[i];
  }
  template <std::size_t planes>
  void append(const FragmentArrays& fragments);
  void settle_all() const;
  template <std::size_t planes>
  void settle(Block& block) const;
  /// Calls f with the number of planes as a constant.
  template <class F>
  void with_planes(F&& f) const;

  int width_, height_;
  bool depth_;
  Real depth_unit_, attribute_unit_;
  // What waits is settled when somebody looks.
  mutable std::vector<std::vector<Real>> planes_;
  mutable std::vector<std::uint32_t> quads_;
  mutable std::array<Block, 2> blocks_;
  std::size_t newer_ = 0;
};

extern template class DepthImage<float>;
extern template class DepthImage<double>;

}  // namespace quadrille
