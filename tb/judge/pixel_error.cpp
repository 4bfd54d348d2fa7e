#include "tb/judge/pixel_error.hpp"

#include "golden/analysis/judged_quad.hpp"
#include "golden/reference/port_number.hpp"
#include "golden/reference/truth.hpp"
#include "golden/scenes/regular_weights.hpp"
#include "model/one_pixel.hpp"
#include "model/port/snap.hpp"
#include "tb/judge/check.hpp"

#include <algorithm>
#include <cmath>

namespace quadrille::tb {
namespace {

DrawState with_output(DrawState state, Output output) {
  state.attributes = output == Output::weight ? 4 : output == Output::attribute ? 1 : 0;
  if (output == Output::depth) state.depth = true;
  return state;
}

/// Four slots for the weights, whatever the machine has.
Config with_slots(const Config& config) { return snapping_config(config, 4); }

}  // namespace

/// The truth's formulas in 80-bit arithmetic on exact integers. Attributes and depth need more than weights do.
struct PixelErrors::QuickTruth {
  std::array<long double, 4> lambda{};
  double above = 0;      ///< attribute or depth, without its base
  double tolerance = 0;  ///< of it; of weight 0
};

PixelErrors::PixelErrors(const Config& config, const DrawState& state, Output output)
    : config_(with_slots(config)),
      state_(with_output(state, output)),
      output_(output),
      context_(config_, state_),
      bounds_(config_),
      plain_(config_, state_, PixelEngine::plain),
      lanes_(config_, state_, PixelEngine::lanes) {}

/// Nothing at singular pixels.
std::optional<PixelErrors::QuickTruth> PixelErrors::quick_truth(const SnappedQuad& q, int px, int py) const {
  using Product = __int128;
  std::int64_t x[4], y[4];
  std::array<long double, 4> length, rho, both, dots, areas;
  for (std::size_t i = 0; i < 4; ++i) {
    x[i] = q.vertex[i].x - std::int64_t{q.vertex[i].w} * px;
    y[i] = q.vertex[i].y - std::int64_t{q.vertex[i].w} * py;
    const Product r2 = static_cast<Product>(x[i]) * x[i] + static_cast<Product>(y[i]) * y[i];
    if (r2 == 0) return std::nullopt;
    length[i] = std::sqrt(static_cast<long double>(r2));
    rho[i] = 1 / length[i];
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = (i + 1) & 3;
    const Product a = static_cast<Product>(x[i]) * y[j] - static_cast<Product>(y[i]) * x[j];
    const Product d = static_cast<Product>(x[i]) * x[j] + static_cast<Product>(y[i]) * y[j];
    if (d < 0 && a == 0) return std::nullopt;
    areas[i] = static_cast<long double>(a);
    dots[i] = static_cast<long double>(d);
    both[i] = length[i] * length[j];
  }
  const std::array<long double, 4> m = golden::RegularWeights<long double>(both, dots, areas, rho).m;
  const auto port = [&](const PortNumber& number) { return golden::port_value(number, config_.significand_bits); };
  QuickTruth truth;
  long double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    truth.lambda[i] = m[i] * static_cast<long double>(port(q.vertex[i].k));
    sum += truth.lambda[i];
  }
  for (long double& l : truth.lambda) l /= sum;
  truth.tolerance = bounds_.value;
  if (output_ == Output::weight) return truth;

  if (output_ == Output::attribute) {
    long double above = 0;
    for (std::size_t i = 1; i < 4; ++i)
      above += truth.lambda[i] * (static_cast<long double>(port(q.vertex[i].attribute[0])) / port(q.vertex[i].k));
    truth.above = static_cast<double>(above);
    truth.tolerance = bounds_.value * attribute_spread(q, 0, config_, true);
    return truth;
  }
  long double sum_z = 0, sum_w = 0, above = 0, below = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const long double z = m[i] * port(q.vertex[i].z),
                      w = m[i] * std::ldexp(static_cast<long double>(q.vertex[i].w), -config_.frac());
    sum_z += z, sum_w += w, above += std::fabs(z), below += std::fabs(w);
  }
  if (std::ranges::all_of(q.vertex, [](const SnappedVertex& v) { return v.w > 0; })) {
    truth.tolerance = (cuts_w(q, config_) ? bounds_.value_of_cut_w : bounds_.value) * depth_spread(q, config_);
  } else {
    // As JudgedQuad::cancelled_tolerance.
    const long double scale = std::fabs(sum_w), error = 2 * bounds_.weight, lost = error * (below / scale);
    if (!(lost < 1)) return std::nullopt;
    truth.tolerance = static_cast<double>((error * (above / scale) + std::fabs(sum_z / sum_w) * lost) / (1 - lost));
  }
  const double unit = depth_format(config_).unit(), base = q.base.depth;
  truth.above = std::clamp(static_cast<double>(sum_z / sum_w), (q.base.depth_low - base) * unit,
                           (q.base.depth_high - base) * unit);
  return truth;
}

double PixelErrors::units_of(const Fragment& fragment, const SnappedQuad& quad, const QuickTruth& truth) const {
  const bool depth = output_ == Output::depth;
  const FixedPoint format = depth ? depth_format(config_) : attribute_format(config_);
  if (output_ == Output::weight) {
    double worst = 0;
    for (std::size_t i = 1; i < 4; ++i)
      worst = std::max(worst, std::fabs(weight(fragment, i) - static_cast<double>(truth.lambda[i])));
    const double first = format.distance(fragment.attribute[0], static_cast<double>(truth.lambda[0]));
    return std::max(std::ldexp(worst, config_.significand_bits), bound_units * first / truth.tolerance);
  }
  const std::int64_t base = depth ? quad.base.depth : quad.base.attribute[0];
  const std::int64_t code = depth ? fragment.depth : fragment.attribute[0];
  const double value = static_cast<double>(base) * format.unit() + truth.above;
  if (!(truth.tolerance > 0) || std::fabs(value) + truth.tolerance >= format.limit()) return -1;
  return bound_units * format.distance(code - base, truth.above) / truth.tolerance;
}

double PixelErrors::measure(const WindowQuad& quad, int px, int py) const {
  SnappedQuad q;
  try {
    q = snap_quad(quad, config_, state_);
  } catch (const SnapError&) {
    return -1;
  }
  const OnePixel pixel = one_pixel(q, context_, px, py);
  if (!pixel.covered || !pixel.trace.drawn) return -1;
  const auto truth = quick_truth(q, px, py);
  return truth ? units_of(pixel.trace.fragment, q, *truth) : -1;
}

PixelError PixelErrors::judge(const WindowQuad& quad, int x, int y) {
  const SnappedQuad q = snap_quad(quad, config_, state_);
  const golden::TruthQuad truth(q, config_, state_);
  PixelError error;
  for (UntimedModel* model : {&plain_, &lanes_}) judge(*model, q, truth, x, y, error);
  return error;
}

void PixelErrors::judge(UntimedModel& model, const SnappedQuad& q, const golden::TruthQuad& truth, int x, int y,
                        PixelError& error) const {
  model.draw(q, [&](std::span<const Fragment> fragments) {
    for (const Fragment& f : fragments) {
      if (f.x != x || f.y != y) continue;
      const golden::ReferenceSample s = truth.sample(x, y);
      if (!s.covered) continue;
      QuickTruth exact;
      std::ranges::copy(s.lambda, exact.lambda.begin());
      exact.tolerance = bounds_.value;
      if (output_ != Output::weight) {
        const JudgedQuad judged(q, config_, bounds_, state_);
        const bool attribute = output_ == Output::attribute;
        exact.above = attribute ? s.attribute_above[0] : s.z_above;
        exact.tolerance = attribute ? judged.attribute_tolerance(0, x, y) : judged.depth_tolerance(x, y);
        if (!std::isfinite(exact.tolerance)) continue;
      }
      error.condition = s.condition;
      error.flags = f.flags;
      error.units = std::max(error.units, units_of(f, q, exact));
    }
  });
}

double PixelErrors::weight(const Fragment& f, std::size_t i) const {
  return std::ldexp(static_cast<double>(f.attribute[i]), -config_.attribute_frac());
}

}  // namespace quadrille::tb
