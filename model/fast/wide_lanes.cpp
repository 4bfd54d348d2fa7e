#include "model/fast/wide_lanes.hpp"

#include "model/fast/targets.hpp"
#include "model/fast/toward_zero.hpp"
#include "model/front/tile_context.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>

namespace quadrille {
namespace {

// Each function of the kernel is compiled for the target around it.
namespace baseline {
#include "model/fast/wide_portable.hpp"

#include "model/fast/wide_front.hpp"

#include "model/fast/kernel.hpp"
}  // namespace baseline
#ifdef QUADRILLE_LANE_TARGETS
QUADRILLE_TARGET_V2
namespace v2 {
#include "model/fast/wide_portable.hpp"

#include "model/fast/wide_front.hpp"

#include "model/fast/kernel.hpp"
}  // namespace v2
QUADRILLE_TARGET_END
QUADRILLE_TARGET_V3
namespace v3 {
#include "model/fast/wide_avx2.hpp"

#include "model/fast/wide_front.hpp"

#include "model/fast/kernel.hpp"
}  // namespace v3
QUADRILLE_TARGET_END
QUADRILLE_TARGET_V4
namespace v4 {
#include "model/fast/wide_avx512.hpp"

#include "model/fast/wide_front.hpp"

#include "model/fast/kernel.hpp"
}  // namespace v4
QUADRILLE_TARGET_END
#endif

/// By LaneTarget.
constexpr decltype(&baseline::draw) draws[]{
    baseline::draw,
#ifdef QUADRILLE_LANE_TARGETS
    v2::draw,
    v3::draw,
    v4::draw,
#endif
};

#ifdef __wasm__
/// The functions as doubles; false where some sum of parts may have more than 53 bits.
bool to_forms(WideQuad& quad) {
  const double x = std::max(quad.right, 0), y = std::max(quad.bottom, 0);
  std::uint64_t any_bits = 0;
  double most = 0;
  const auto form = [&](std::int64_t value, std::int64_t gx, std::int64_t gy, std::int64_t q) {
    any_bits |= static_cast<std::uint64_t>(value | gx | gy | q);
    const WideQuad::Form out{static_cast<double>(value), static_cast<double>(gx), static_cast<double>(gy),
                             static_cast<double>(q)};
    most = std::max(most, std::fabs(out.value) + std::fabs(out.gx) * x + std::fabs(out.gy) * y +
                              std::fabs(out.q) * (x * x + y * y));
    return out;
  };
  for (std::size_t k = 0; k < linear_count; ++k) {
    const LinearForm& f = quad.linear[k];
    quad.linear_forms[k] = form(f.value, f.gx, f.gy, 0);
    any_bits |= quad.length2[k];
    quad.length2_values[k] = static_cast<double>(quad.length2[k]);
    most = std::max(most, quad.length2_values[k]);
  }
  for (std::size_t k = quad.homogeneous ? 0 : linear_count; k < quadratic_count; ++k) {
    const QuadraticForm& f = quad.quadratic[k];
    quad.quadratic_forms[k] = form(f.value, f.gx, f.gy, f.q);
  }
  // Three of them in the law of cosines.
  return most < std::ldexp(1.0, std::countr_zero(any_bits | 1ull << 62) + 51);
}
#endif

}  // namespace

WideLanes::WideLanes(const PipelineContext& c)
    : format_(c),
      state_(c.state),
      attribute_limit_(static_cast<double>(c.config.attribute_limit())),
      a_scale_(std::ldexp(1.0, c.quadratic_bias)),
      tile_log2_(c.config.tile_log2),
      qdrop_(c.config.qdrop()),
      by_tile_(c.config.qdrop() != 0) {}

void WideLanes::take(const SetupResult& setup, const QuadData& data, const QuadLanes& values, WideQuad& out) const {
  out.homogeneous = setup.homogeneous;
  out.hull = setup.hull;
  out.marks = setup.homogeneous ? flag_homogeneous << 8 : 0;
  out.a_scale = a_scale_;
  out.areas = data.plane;
  out.x0 = setup.tile_x0 << tile_log2_;
  out.y0 = setup.tile_y0 << tile_log2_;
  // Whatever the tiles have.
  out.left = state_.scissor_x0 - out.x0;
  out.top = state_.scissor_y0 - out.y0;
  out.right = state_.scissor_x1 - 1 - out.x0;
  out.bottom = state_.scissor_y1 - 1 - out.y0;
  out.linear = setup.linear;
  out.length2 = setup.length2;
  out.quadratic = tile_context(QuadConstants(setup), 0, 0, qdrop_);
#ifdef __wasm__  // else FloatLanes has those that are many
  out.in_doubles = !by_tile_ && to_forms(out);
#endif

  out.sum_k = values.sum_k;
  out.sum_w = values.sum_w;
  out.sum_z = values.sum_z;
  out.sum_b = values.sum_b;
  out.w_of_k = values.w_of_k;
  out.w_may_vanish = !values.constant_depth && values.sum_w;
  out.k = LaneColumnOf<double>(values.k, format_.prec);
  out.w = LaneColumnOf<double>(values.w, format_.prec);
  out.z = LaneColumnOf<double>(values.z, format_.prec);
  out.depth = {static_cast<double>(data.base.depth), static_cast<double>(data.base.depth_low),
               static_cast<double>(data.base.depth_high)};
  for (std::size_t j = 0; j < static_cast<std::size_t>(format_.attributes); ++j) {
    out.b[j] = LaneColumnOf<double>(values.b[j], format_.prec);
    out.attribute[j] = {static_cast<double>(data.base.attribute[j]), -attribute_limit_, attribute_limit_};
  }
}

void WideLanes::move_to(const TileEntry& tile, WideQuad& quad) const {
  const int x = tile.tile_x << tile_log2_, y = tile.tile_y << tile_log2_;
  quad.left += quad.x0 - x;
  quad.right += quad.x0 - x;
  quad.top += quad.y0 - y;
  quad.bottom += quad.y0 - y;
  quad.x0 = x;
  quad.y0 = y;
  for (std::size_t k = 0; k < linear_count; ++k) quad.linear[k].value = tile.linear[k];
  quad.quadratic = tile.quadratic;
}

void WideLanes::draw(const WideQuad& quad, const PixelList& list, int count, LaneResults& out) const {
  out.begin();
  const TowardZero mode;
  draws[static_cast<std::size_t>(lane_target())](format_, quad, list, count, out);
}

}  // namespace quadrille
