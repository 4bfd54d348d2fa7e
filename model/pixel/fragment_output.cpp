#include "model/pixel/pixel_pipeline.hpp"

#include <algorithm>
#include <cstdint>

namespace quadrille {
namespace {

/// A quotient in codes.
struct Quotient {
  bool neg = false;
  bool overflow = false;  ///< its magnitude is at least 2^int_bits
  std::int64_t code = 0;  ///< else: to nearest, halves away from zero

  std::int64_t signed_code() const { return neg ? -code : code; }
};

Quotient to_codes(const PipelineFloat& num, const PipelineFloat& rec, int int_bits, int frac,
                  const SignificandFormat& f) {
  const RawProduct r = raw_product(num, rec);
  if (r.p == 0) return {};
  const int exponent = r.exp + static_cast<int>(r.p >> (2 * f.s - 1));  // floor(log2 value)
  if (exponent >= int_bits) return {r.neg, true, 0};
  const int shift = r.exp + frac - (2 * f.s - 2) + 1;  // with the bit that rounds
  const std::uint64_t twice = shift >= 0 ? r.p << shift : shift < -63 ? 0 : r.p >> -shift;
  return {r.neg, false, static_cast<std::int64_t>((twice + 1) >> 1)};
}

}  // namespace

void fragment_output(PixelTrace& p, const QuadData& quad, const PipelineContext& c) {
  const PipelineFloat rec_k = reciprocal(p.den_k, c.recip_table, c.format);
  const PipelineFloat rec_w = reciprocal(p.den_w, c.recip_table, c.format);
  Fragment& g = p.fragment;
  g = {};
  g.quad = quad.id;
  g.x = static_cast<std::uint16_t>(p.x);
  g.y = static_cast<std::uint16_t>(p.y);
  g.front = p.front;

  // A difference of two values has one bit more than a value.
  bool saturated = false;
  const std::int64_t limit = c.config.attribute_limit();
  for (std::size_t j = 0; j < static_cast<std::size_t>(c.state.attributes); ++j) {
    const Quotient q = to_codes(p.num_a[j], rec_k, c.config.attribute_int_bits + 1, c.attribute_frac, c.format);
    const std::int64_t sum = q.overflow ? (q.neg ? -limit - 1 : limit + 1) : quad.base.attribute[j] + q.signed_code();
    saturated |= sum < -limit || sum > limit;
    g.attribute[j] = std::clamp(sum, -limit, limit);
  }

  bool discard = quad.hull && (p.den_w.neg || p.den_w.sig == 0);
  if (c.state.depth) {
    Quotient q = to_codes(p.num_z, rec_w, 1, c.config.depth_bits, c.format);
    if (p.den_w.sig == 0) q = {false, true, 0};
    const std::int64_t low = quad.base.depth_low, high = quad.base.depth_high;
    const std::int64_t z =
        q.overflow ? (q.neg ? low : high) : std::min(std::max(quad.base.depth + q.signed_code(), low), high);
    discard |= z < std::int64_t{c.znear} || z > std::int64_t{c.zfar};
    g.depth = static_cast<std::uint32_t>(std::max<std::int64_t>(z, 0));
  }
  g.flags = static_cast<std::uint8_t>((p.on_edge ? flag_on_edge : 0) | (p.on_vertex ? flag_on_vertex : 0) |
                                      (p.two_corner ? flag_two_corner : 0) | (p.two_edge ? flag_two_edge : 0) |
                                      (p.tie ? flag_tie : 0) | (p.homogeneous ? flag_homogeneous : 0) |
                                      (p.notch ? flag_notch : 0) | (saturated ? flag_saturated : 0));
  p.drawn = p.valid && !discard;
}

}  // namespace quadrille
