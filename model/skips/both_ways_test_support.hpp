// Draws quads with some skips and without them; and the small grids that the skips' tests draw.
#pragma once

#include "model/front/quad_reject.hpp"
#include "model/untimed.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace quadrille {

using RejectCounts = std::array<std::uint64_t, quad_reject_count>;
inline constexpr std::array<const char*, quad_reject_count> reject_reasons{"none", "empty",  "behind", "depth",
                                                                           "line", "culled", "outside"};

/// Draws with and without the skips of `bits`, all others as the state says, and compares.
class BothWays {
 public:
  BothWays(const Config& config, const DrawState& state, std::uint32_t bits)
      : config_(config),
        state_(skipping(state, state.skip | bits)),
        with_(config, skipping(state, state.skip | bits), PixelEngine::plain),
        without_(config, skipping(state, state.skip & ~bits), PixelEngine::plain) {}

  /// Fragments of the quad; differences are failures.
  std::size_t draw(const SnappedQuad& quad) {
    std::vector<Fragment> kept, all;
    with_.draw(quad, [&](std::span<const Fragment> f) { kept.insert(kept.end(), f.begin(), f.end()); });
    without_.draw(quad, [&](std::span<const Fragment> f) { all.insert(all.end(), f.begin(), f.end()); });
    EXPECT_TRUE(kept == all) << kept.size() << " fragments of " << all.size() << ", " << reason(quad);
    return all.size();
  }
  RejectCounts rejected() const { return with_.stats().rejected; }

 private:
  std::string reason(const SnappedQuad& quad) const {
    std::string text = reject_reasons[static_cast<std::size_t>(quad_reject(quad, config_, state_))];
    for (const SnappedVertex& v : quad.vertex)
      text += " (" + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " + std::to_string(v.w) + ")";
    return text;
  }
  static DrawState skipping(DrawState state, std::uint32_t skip) {
    state.skip = skip;
    return state;
  }

  Config config_;
  DrawState state_;
  UntimedModel with_, without_;
};

inline void add(RejectCounts& to, const RejectCounts& of) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += of[i];
}

inline void print(const char* what, const RejectCounts& counts) {
  std::printf("%s:", what);
  for (std::size_t i = 0; i < counts.size(); ++i)
    std::printf(" %s %llu", reject_reasons[i], static_cast<unsigned long long>(counts[i]));
  std::printf("\n");
}

inline Config tiny() {
  Config c;
  for (const auto& [key, value] : std::initializer_list<std::pair<const char*, int>>{
           {"viewport_bits", 6}, {"subpixel_bits", 2}, {"homogeneous_frac_bits", 4}, {"significand_bits", 8}})
    c.set(key, value);
  c.validate();
  return c;
}

/// The points of a 3 by 3 grid, two pixels apart, with w of -1, 0 and 1; of w = 0 directions, eight.
inline std::vector<SnappedVertex> grid_vertices(const Config& c) {
  std::vector<SnappedVertex> vertices;
  const int one = 1 << c.frac();
  for (const int w : {-1, 0, 1})
    for (const int x : {0, 2, 4})
      for (const int y : {0, 2, 4}) {
        if (w == 0 && x == 2 && y == 2) continue;  // (0, 0, 0) relative to the grid's middle is no vertex
        SnappedVertex v;
        v.x = (w == 0 ? x - 2 : x * w) * one;
        v.y = (w == 0 ? y - 2 : y * w) * one;
        v.w = w * one;
        v.k = {false, 0, 1u << (c.significand_bits - 1)};
        v.z = {false, -1, 1u << (c.significand_bits - 1)};  // Z = 1/2
        vertices.push_back(v);
      }
  return vertices;
}

/// All quads of these vertices are numbered from 0.
inline SnappedQuad grid_quad(std::span<const SnappedVertex> vertices, std::uint64_t number) {
  const std::uint64_t n = vertices.size();
  SnappedQuad q;
  q.vertex = {vertices[number % n], vertices[number / n % n], vertices[number / n / n % n],
              vertices[number / n / n / n]};
  return q;
}

}  // namespace quadrille
