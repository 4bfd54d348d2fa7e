#include "model/fast/lane_quad.hpp"

#include <bit>
#include <cmath>
#include <functional>
#include <limits>

namespace quadrille {
namespace {

bool all_zero(const std::array<double, 4>& values) { return values == std::array<double, 4>{}; }

/// The factor ±2^n or 0 by which `of` gives `values`, if there is one.
QuadLanes::Factor power_of_two_factor(const std::array<double, 4>& values, const std::array<double, 4>& of) {
  double factor = 0;
  for (std::size_t i = 0; i < 4 && factor == 0; ++i)
    if (of[i] != 0) factor = values[i] / of[i];
  constexpr std::uint64_t fraction = (std::uint64_t{1} << 52) - 1;
  if ((std::bit_cast<std::uint64_t>(factor) & fraction) != 0) return std::nullopt;
  for (std::size_t i = 0; i < 4; ++i)
    if (values[i] != of[i] * factor) return std::nullopt;
  return factor;
}

}  // namespace

double to_double(const PipelineFloat& v, int s) {
  const double size = v.neg ? -static_cast<double>(v.sig) : static_cast<double>(v.sig);
  const int exponent = v.exp - (s - 1);
  return std::abs(exponent) < 1000 ? size * power_of_two(exponent) : std::ldexp(size, exponent);
}

QuadLanes::QuadLanes(const QuadData& quad, const PipelineContext& c) {
  const int s = c.format.s;
  for (std::size_t i = 0; i < 4; ++i) {
    k[i] = to_double(quad.k[i], s);
    w[i] = to_double(quad.w[i], s);
    z[i] = to_double(quad.z[i], s);
    for (std::size_t j = 0; j < static_cast<std::size_t>(c.state.attributes); ++j) b[j][i] = to_double(quad.b[i][j], s);
  }
  constant_depth = quad.base.depth_low == quad.base.depth_high;
  sum_z = c.state.depth && !constant_depth && !all_zero(z);
  for (std::size_t j = 0; j < static_cast<std::size_t>(c.state.attributes); ++j)
    sum_b[j] = !all_zero(b[j]) || std::abs(quad.base.attribute[j]) > c.config.attribute_limit();
  if ((c.state.skip & skip_operands) == 0) return;
  sum_k = quad.sum_k && std::ranges::any_of(sum_b, std::identity());
  sum_w = (c.state.depth && !constant_depth) || quad.hull;
  if (sum_k && sum_w)
    if (const Factor factor = power_of_two_factor(w, k); factor && *factor != 0) w_of_k = factor;
}

template <class Real>
LaneTableOf<Real>::LaneTableOf(const Table& table, int octave_bits)
    : rest_bits(fraction_bits - table.segments_log2),
      last_place(integer * static_cast<Real>(power_of_two(-rest_bits))),
      offset_mask(((1u << (table.segments_log2 + octave_bits)) - 1) * static_cast<std::uint32_t>(sizeof(Entry))),
      in_columns(table.entries.size() <= column_size) {
  const std::size_t size = table.entries.size(), octave = octave_bits == 0 ? 0 : size / 2;
  const auto scale = static_cast<Real>(power_of_two(-rest_bits));
  for (std::size_t i = 0; i < size; ++i) {
    const TableEntry& e = table.entries[i ^ octave];
    entries.push_back({static_cast<Real>(e.c0) + integer, (static_cast<Real>(e.c1) + integer) * scale,
                       static_cast<Real>(e.c2) * scale * scale});
  }
  if (!in_columns) return;
  for (std::size_t i = 0; i < column_size; ++i) {
    const Entry& e = entries[i % size];
    column[0][i] = e.c0;
    column[1][i] = e.c1;
    column[2][i] = e.c2;
  }
}
template struct LaneTableOf<float>;
template struct LaneTableOf<double>;

template <class Real>
LaneColumnOf<Real>::LaneColumnOf(const std::array<double, 4>& values, int prec) {
  bool some_negative = false, some_positive = false;
  for (std::size_t i = 0; i < 4; ++i) {
    const double v = values[i];
    if (v == 0) continue;
    const int exponent = static_cast<int>(std::bit_cast<std::uint64_t>(v) >> 52 & 0x7ff) - 1023;
    (v < 0 ? negative : positive)[i] = static_cast<Real>(std::fabs(v));
    align[i] = static_cast<Real>(power_of_two(exponent + LaneTableOf<Real>::fraction_bits - prec));
    (v < 0 ? some_negative : some_positive) = true;
  }
  any = some_negative || some_positive;
  mixed = some_negative && some_positive;
  if (some_negative && !some_positive) {
    std::swap(positive, negative);
    flip = std::numeric_limits<decltype(flip)>::min();
  }
}
template struct LaneColumnOf<float>;
template struct LaneColumnOf<double>;

template <class Real>
LaneFormatOf<Real>::LaneFormatOf(const PipelineContext& c)
    : s(c.format.s),
      prec(c.config.prec_bits()),
      attributes(c.state.attributes),
      attribute_frac(c.attribute_frac),
      depth_bits(c.config.depth_bits),
      depth(c.state.depth),
      notch(c.config.notch_exact != 0),
      znear(static_cast<std::int32_t>(c.znear)),
      zfar(static_cast<std::int32_t>(c.zfar)),
      sqrt(c.sqrt_table, 1),
      recip(c.recip_table, 0) {}
template struct LaneFormatOf<float>;
template struct LaneFormatOf<double>;

}  // namespace quadrille
