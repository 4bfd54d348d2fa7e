#include "model/skips/scissor_separation.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace quadrille {
namespace {

using Wide = __int128;

/// A side of the rectangle: what lies at `at` or beyond is outside, or with `below` what lies before it.
struct Side {
  bool along_y;
  bool below;
  std::int64_t at;  ///< pixels
};

/// All corners of the triangle's part in front of the eye are outside the side.
bool outside_side(const SetupResult& quad, const std::array<SnappedVertex, 4>& vertex,
                  std::span<const std::size_t> corners, std::span<const std::size_t> edges, const Side& side) {
  for (const std::size_t i : corners) {
    const SnappedVertex& v = vertex[i];
    const std::int64_t from = (side.along_y ? v.y : v.x) - v.w * side.at;
    if (v.w >= 0 && (from < 0) != side.below) return false;
  }
  for (const std::size_t k : edges) {
    const auto [i, j] = vertex_pair[k];
    const bool behind = vertex[i].w < 0;
    if (behind == (vertex[j].w < 0)) continue;
    // The direction is (gy, -gx) from a vertex in front of the eye, the opposite from one behind it.
    const bool negative = side.along_y ? quad.linear[k].gx >= 0 : quad.linear[k].gy < 0;
    if ((negative != behind) != side.below) return false;
  }
  return true;
}

/// The edge function, times -1 if `negated`, is negative in all of the rectangle.
bool outside_edge(const LinearForm& edge, bool negated, const DrawState& state) {
  const auto at = [&](int x, int y) {
    return static_cast<Wide>(edge.value) + static_cast<Wide>(edge.gx) * x + static_cast<Wide>(edge.gy) * y;
  };
  const auto [least, greatest] =
      std::minmax({at(state.scissor_x0, state.scissor_y0), at(state.scissor_x1, state.scissor_y0),
                   at(state.scissor_x0, state.scissor_y1), at(state.scissor_x1, state.scissor_y1)});
  return negated ? least > 0 : greatest < 0;
}

}  // namespace

unsigned scissor_separation(const SetupResult& quad, const std::array<SnappedVertex, 4>& vertex,
                            const DrawState& state) {
  struct Triangle {
    std::array<std::size_t, 3> corner, edge;
    std::array<bool, 3> reversed;  ///< the edge function has the opposite sense in this clause
  };
  constexpr std::array<Triangle, 2> triangles{
      {{{0, 1, 2}, {0, 1, 4}, {false, false, false}}, {{0, 2, 3}, {2, 3, 4}, {false, false, true}}}};
  const std::array<Side, 4> sides{{{false, true, state.scissor_x0},
                                   {false, false, state.scissor_x1},
                                   {true, true, state.scissor_y0},
                                   {true, false, state.scissor_y1}}};
  unsigned separated = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Triangle& triangle = triangles[t];
    const bool front = (quad.clauses >> (t + 2) & 1) != 0;
    if (!front && (quad.clauses >> t & 1) == 0) continue;
    bool out = std::ranges::any_of(
        sides, [&](const Side& s) { return outside_side(quad, vertex, triangle.corner, triangle.edge, s); });
    for (std::size_t k = 0; k < 3; ++k)
      out |= outside_edge(quad.linear[triangle.edge[k]], front != triangle.reversed[k], state);
    separated |= out ? 1u << t : 0u;
  }
  return separated;
}

}  // namespace quadrille
