#include "model/plane_tolerance.hpp"

#include "model/plane_quad.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <optional>

namespace quadrille {
namespace {

using Wide = __int128;
using Areas = std::array<std::uint64_t, 4>;  ///< c_i, of P bits and one scale
using Values = std::array<PortNumber, 4>;

/// Twice the signed areas of the triangles 123, 023, 013, 012: without corner 0, 1, 2, 3.
std::array<Wide, 4> signed_areas(const SnappedQuad& quad) {
  const auto area = [&](std::size_t i, std::size_t j, std::size_t k) {
    const SnappedVertex &a = quad.vertex[i], &b = quad.vertex[j], &c = quad.vertex[k];
    return Wide{std::int64_t{b.x} - a.x} * (std::int64_t{c.y} - a.y) -
           Wide{std::int64_t{b.y} - a.y} * (std::int64_t{c.x} - a.x);
  };
  return {area(1, 2, 3), area(0, 2, 3), area(0, 1, 3), area(0, 1, 2)};
}

/// The magnitudes with the highest one of all at bit P-1, the bits below 0 dropped. At most 2^62 each.
Areas scaled_areas(const SnappedQuad& quad, int p) {
  const std::array<Wide, 4> exact = signed_areas(quad);
  Areas c;
  std::uint64_t all = 0;
  for (std::size_t i = 0; i < 4; ++i) all |= c[i] = static_cast<std::uint64_t>(exact[i] < 0 ? -exact[i] : exact[i]);
  const int drop = static_cast<int>(std::bit_width(all)) - p;
  for (std::uint64_t& v : c) v = drop >= 0 ? v >> drop : v << -drop;
  return c;
}

bool all_same(const Values& v) {
  return std::all_of(v.begin() + 1, v.end(),
                     [&](const PortNumber& n) { return n.neg == v[0].neg && n.exp == v[0].exp && n.sig == v[0].sig; });
}

/// The largest exponent of a number that is not 0.
std::optional<int> highest_exponent(const Values& v) {
  std::optional<int> highest;
  for (const PortNumber& n : v)
    if (n.sig != 0) highest = std::max(highest.value_or(n.exp), n.exp);
  return highest;
}

/// |D| and what it may be off by are at most 2^-(t + further) of half of c_1 + c_3 times 2^(P-1), which no value's
/// largest magnitude is below: c in units of its scale, values in units of 2^-(P-1) of the highest power of two.
bool deviates_little(const Areas& c, const Values& v, int further, const Config& config) {
  const int p = plane_sig_bits(config);
  const int highest = highest_exponent(v).value_or(0);
  std::int64_t d = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (v[i].sig == 0) continue;
    const int distance = std::min(highest - v[i].exp, 63);
    const std::uint64_t f = (std::uint64_t{v[i].sig} << (p - config.significand_bits)) >> distance;
    const auto product = static_cast<std::int64_t>(c[i] * f);
    d += (i % 2 != 0) != v[i].neg ? -product : product;
  }
  const auto limit = static_cast<std::int64_t>((c[1] + c[3]) << (p - 2 - config.plane_tolerance_bits) >> further);
  return std::abs(d) <= limit - (std::int64_t{1} << (p + 3));
}

}  // namespace

bool strictly_convex(const SnappedQuad& quad) {
  const std::array<Wide, 4> area = signed_areas(quad);
  return std::ranges::all_of(area, [](Wide a) { return a > 0; }) ||
         std::ranges::all_of(area, [](Wide a) { return a < 0; });
}

bool plane_tolerance_tests(const SnappedQuad& quad, const Config& config, const DrawState& state) {
  const std::int32_t one = std::int32_t{1} << config.frac();
  return has_plane_tolerance(config) && takes_plane_quads(config, state) &&
         std::ranges::all_of(quad.vertex, [&](const SnappedVertex& v) { return v.w == one; }) &&
         !plane_quad(quad, config, state);
}

bool plane_tolerance(const SnappedQuad& quad, const Config& config, const DrawState& state) {
  if (!plane_tolerance_tests(quad, config, state) || !strictly_convex(quad)) return false;
  const Areas c = scaled_areas(quad, plane_sig_bits(config));
  const auto values = [&](const auto& value) {
    return Values{value(quad.vertex[0]), value(quad.vertex[1]), value(quad.vertex[2]), value(quad.vertex[3])};
  };
  // Σ λ b / Σ λ k, with k that differ: the errors of both, over the least k, whose place among the powers of two is
  // all that is known of it. 31 is more than any limit has room for.
  int further = 0;
  if (state.perspective) {
    const Values k = values([](const SnappedVertex& v) { return v.k; });
    if (!all_same(k)) {
      const auto [low, high] = std::ranges::minmax(k, {}, &PortNumber::exp);
      further = std::min(2 + high.exp - low.exp, 31);
      if (!deviates_little(c, k, further, config)) return false;
    }
  }
  if (state.depth && !deviates_little(c, values([](const SnappedVertex& v) { return v.z; }), 0, config)) return false;
  for (std::size_t j = 0; j < static_cast<std::size_t>(state.attributes); ++j)
    if (!deviates_little(c, values([&](const SnappedVertex& v) { return v.attribute[j]; }), further, config))
      return false;
  return true;
}

bool takes_areas(const SnappedQuad& quad, const Config& config, const DrawState& state) {
  return plane_quad(quad, config, state) || plane_tolerance(quad, config, state);
}

}  // namespace quadrille
