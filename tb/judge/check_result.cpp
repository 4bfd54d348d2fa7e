// What checks find, put together, and facts about quads.
#include "tb/judge/fragment_reference.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace quadrille::tb {

void QuantityErrors::merge(const QuantityErrors& other) {
  lambda.merge(other.lambda);
  attribute.merge(other.attribute);
  depth.merge(other.depth);
}

bool CheckResult::ok() const { return compared > 0 && faults() == 0; }

void CheckResult::merge(const CheckResult& other) {
  for (const CheckCounter& counter : check_counters) this->*counter.value += other.*counter.value;
  weight.merge(other.weight);
  attribute.merge(other.attribute);
  depth.merge(other.depth);
  arithmetic.merge(other.arithmetic);
  snapping.merge(other.snapping);
  if (other.worst.ratio > worst.ratio ||
      (other.worst.ratio == worst.ratio && order(other.worst.place) < order(worst.place)))
    worst = other.worst;
  if (other.first.any && (!first.any || order(other.first.place) < order(first.place))) first = other.first;
}

bool is_eye_crossing(const SnappedQuad& quad) {
  const auto in_front = [](const SnappedVertex& v) { return v.w > 0; };
  return std::any_of(quad.vertex.begin(), quad.vertex.end(), in_front) &&
         !std::all_of(quad.vertex.begin(), quad.vertex.end(), in_front);
}

bool has_antipodal_edge(const SnappedQuad& quad) {
  const auto antipodal = [](const SnappedVertex& a, const SnappedVertex& b) {
    using Integer = std::int64_t;
    const bool parallel = Integer{a.y} * b.w == Integer{a.w} * b.y && Integer{a.w} * b.x == Integer{a.x} * b.w &&
                          Integer{a.x} * b.y == Integer{a.y} * b.x;
    // Parallel vectors: the sign of any product of two components is the sign of the scale.
    const __int128 dot =
        static_cast<__int128>(a.x) * b.x + static_cast<__int128>(a.y) * b.y + static_cast<__int128>(a.w) * b.w;
    return parallel && dot < 0;
  };
  for (std::size_t i = 0; i < 4; ++i)
    if (antipodal(quad.vertex[i], quad.vertex[(i + 1) % 4])) return true;
  return false;
}

bool is_tiny(const SnappedQuad& quad, const Config& config) {
  const std::int32_t one = 1 << config.frac();
  const auto [left, right] = std::minmax_element(quad.vertex.begin(), quad.vertex.end(),
                                                 [](const auto& a, const auto& b) { return a.x < b.x; });
  const auto [top, bottom] = std::minmax_element(quad.vertex.begin(), quad.vertex.end(),
                                                 [](const auto& a, const auto& b) { return a.y < b.y; });
  return std::all_of(quad.vertex.begin(), quad.vertex.end(), [&](const SnappedVertex& v) { return v.w == one; }) &&
         std::int64_t{right->x} - left->x < std::int64_t{4} * one &&
         std::int64_t{bottom->y} - top->y < std::int64_t{4} * one;
}

}  // namespace quadrille::tb
