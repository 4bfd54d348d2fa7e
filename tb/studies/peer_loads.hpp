// What `bench --peers` draws: quads with texture coordinates, in perspective, the same on every machine up to libm.
#pragma once

#include "model/port/records.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace quadrille::tb {

inline constexpr int peer_attributes = 2;  ///< u, v

/// One convex quad in perspective that fills nearly all of the viewport.
std::vector<WindowQuad> large_quad(int width, int height);

/// A sphere of `n` quads around and `n` from pole to pole, its back too.
std::vector<WindowQuad> sphere_quads(int n, int width, int height);

/// Convex quads of about side * side pixels, turned at random, anywhere in a viewport of `size` * `size`; w of their
/// corners between 1 and 2. The i-th quad depends on seed and i alone, its id is i.
class ScatteredQuads {
 public:
  /// side <= size / 2.
  ScatteredQuads(std::uint64_t seed, double side, int size) : seed_(seed), side_(side), size_(size) {}
  WindowQuad quad(std::uint32_t i) const;

 private:
  std::uint64_t seed_;
  double side_;
  int size_;
};

}  // namespace quadrille::tb
