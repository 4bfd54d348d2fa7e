#include "model/pixel_pipeline.hpp"

namespace quadrille {
namespace {

struct Fixed {
  bool neg = false;
  bool overflow = false;
  std::uint64_t q = 0;  ///< magnitude
};

/// |num·rec| truncated to `frac` fraction bits, clamped below 2^int_bits.
Fixed to_fixed(const PipelineFloat& num, const PipelineFloat& rec, int int_bits, int frac, const SignificandFormat& f) {
  const RawProduct r = raw_product(num, rec);
  if (r.p == 0) return {};
  const int exponent = r.exp + static_cast<int>(r.p >> (2 * f.s - 1));  // floor(log2 value)
  if (exponent >= int_bits) return {r.neg, true, (std::uint64_t{1} << (int_bits + frac)) - 1};
  const int shift = r.exp + frac - (2 * f.s - 2);
  return {r.neg, false, shift >= 0 ? r.p << shift : shift < -63 ? 0 : r.p >> -shift};
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

  bool saturated = false;
  for (int j = 0; j < c.state.attributes; ++j) {
    const Fixed a =
        to_fixed(p.num_a[static_cast<std::size_t>(j)], rec_k, c.config.attribute_int_bits, c.attribute_frac, c.format);
    saturated |= a.overflow;
    const auto q = static_cast<std::int64_t>(a.q);
    g.attribute[static_cast<std::size_t>(j)] = a.neg ? -q : q;
  }

  bool discard = quad.hull && (p.den_w.neg || p.den_w.sig == 0);
  if (c.state.depth) {
    Fixed z = to_fixed(p.num_z, rec_w, 1, c.config.depth_bits, c.format);
    if (p.den_w.sig == 0) z = {false, true, (std::uint64_t{2} << c.config.depth_bits) - 1};
    discard |= (z.neg && z.q != 0) || z.q < c.znear || z.q > c.zfar;
    g.depth = static_cast<std::uint32_t>(z.q);
  }
  g.flags = static_cast<std::uint8_t>((p.on_edge ? flag_on_edge : 0) | (p.on_vertex ? flag_on_vertex : 0) |
                                      (p.two_corner ? flag_two_corner : 0) | (p.two_edge ? flag_two_edge : 0) |
                                      (p.tie ? flag_tie : 0) | (p.homogeneous ? flag_homogeneous : 0) |
                                      (p.notch ? flag_notch : 0) | (saturated ? flag_saturated : 0));
  p.drawn = p.valid && !discard;
}

}  // namespace quadrille
