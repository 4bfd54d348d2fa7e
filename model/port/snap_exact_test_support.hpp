// For tests: snap_quad against slow_snap.hpp in each rounding mode, and with subnormal numbers taken for 0.
#pragma once

#include "model/port/slow_snap.hpp"
#include "model/port/snap.hpp"

#include <gtest/gtest.h>

#include <cfenv>
#include <cstdint>
#include <vector>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace quadrille {

/// All numbers in a row, to compare and print.
inline std::vector<std::int64_t> numbers(const SnappedQuad& q) {
  std::vector<std::int64_t> all{q.id, q.base.depth, q.base.depth_low, q.base.depth_high};
  all.insert(all.end(), q.base.attribute.begin(), q.base.attribute.end());
  const auto add = [&](const PortNumber& n) {
    for (const std::int64_t part : {std::int64_t{n.neg}, std::int64_t{n.exp}, std::int64_t{n.sig}}) all.push_back(part);
  };
  for (const SnappedVertex& v : q.vertex) {
    for (const std::int64_t part : {v.x, v.y, v.w}) all.push_back(part);
    add(v.k);
    add(v.z);
    for (const PortNumber& a : v.attribute) add(a);
  }
  return all;
}

/// snap_quad with each rounding mode, and with subnormal numbers taken for 0.
inline std::vector<SnappedQuad> in_every_mode(const WindowQuad& quad, const Config& c, const DrawState& s) {
  std::vector<SnappedQuad> out;
  for (const int mode : {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    std::fesetround(mode);
    out.push_back(snap_quad(quad, c, s));
  }
  std::fesetround(FE_TONEAREST);
#if defined(__SSE2__)
  const unsigned before = _mm_getcsr();
  _mm_setcsr(before | _MM_FLUSH_ZERO_ON | 0x40);  // denormals are zeros
  out.push_back(snap_quad(quad, c, s));
  _mm_setcsr(before);
#endif
  return out;
}

inline void expect_exact(const WindowQuad& quad, const Config& c, const DrawState& s, bool every_mode = true) {
  const auto expected = numbers(slow::snap_quad(quad, c, s));
  if (!every_mode) {
    ASSERT_EQ(numbers(snap_quad(quad, c, s)), expected);
    return;
  }
  for (const SnappedQuad& got : in_every_mode(quad, c, s)) ASSERT_EQ(numbers(got), expected);
}

/// All of one w.
inline WindowQuad square_of(double w) {
  WindowQuad q;
  q.vertex = {WindowVertex{w, w, 0, w}, {9 * w, w, 0, w}, {9 * w, 9 * w, 0, w}, {w, 9 * w, 0, w}};
  for (auto& a : q.attribute) a = {0.0};
  return q;
}

}  // namespace quadrille
