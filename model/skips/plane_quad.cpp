#include "model/skips/plane_quad.hpp"

#include <algorithm>
#include <cstdint>

namespace quadrille {
namespace {

/// v0 + v2 = v1 + v3.
bool opposite_sums_agree(const SnappedQuad& quad, std::int32_t SnappedVertex::*coordinate) {
  const auto at = [&](std::size_t i) { return std::int64_t{quad.vertex[i].*coordinate}; };
  return at(0) + at(2) == at(1) + at(3);
}

/// Constant along the sides 01 and 23, or along 12 and 30; `value` gives a vertex's.
template <class Value>
bool constant_along_sides(const SnappedQuad& quad, const Value& value) {
  const auto same = [&](std::size_t i, std::size_t j) {
    const PortNumber a = value(quad.vertex[i]), b = value(quad.vertex[j]);
    return a.neg == b.neg && a.exp == b.exp && a.sig == b.sig;
  };
  return (same(0, 1) && same(2, 3)) || (same(0, 3) && same(1, 2));
}

}  // namespace

bool takes_plane_quads(const Config& config, const DrawState& state) {
  return config.plane_quads != 0 && (state.skip & skip_plane) != 0;
}

bool plane_quad(const SnappedQuad& quad, const Config& config, const DrawState& state) {
  if (!takes_plane_quads(config, state)) return false;
  const std::int32_t one = std::int32_t{1} << config.frac();
  if (!std::ranges::all_of(quad.vertex, [&](const SnappedVertex& v) { return v.w == one; })) return false;
  if (!opposite_sums_agree(quad, &SnappedVertex::x) || !opposite_sums_agree(quad, &SnappedVertex::y)) return false;
  if (state.perspective && !constant_along_sides(quad, [](const SnappedVertex& v) { return v.k; })) return false;
  if (state.depth && !constant_along_sides(quad, [](const SnappedVertex& v) { return v.z; })) return false;
  for (std::size_t j = 0; j < static_cast<std::size_t>(state.attributes); ++j)
    if (!constant_along_sides(
            quad, [&](const SnappedVertex& v) { return &v == quad.vertex.data() ? PortNumber{} : v.attribute[j]; }))
      return false;
  return true;
}

}  // namespace quadrille
