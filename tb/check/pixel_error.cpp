#include "tb/check/pixel_error.hpp"

#include "golden/reference/port_number.hpp"
#include "golden/reference/truth.hpp"
#include "model/quad_setup.hpp"
#include "model/snap.hpp"
#include "model/stamp_coverage.hpp"
#include "model/tile_context.hpp"
#include "tb/check/check.hpp"
#include "tb/check/judged_quad.hpp"

#include <algorithm>
#include <cmath>

namespace quadrille::cli {
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
  double value = 0;      ///< attribute or depth
  double tolerance = 0;  ///< of it
};

PixelErrors::PixelErrors(const Config& config, const DrawState& state, Output output)
    : config_(with_slots(config)),
      state_(with_output(state, output)),
      output_(output),
      context_(config_, state_),
      plain_(config_, state_, PixelEngine::plain),
      lanes_(config_, state_, PixelEngine::lanes) {}

/// Nothing at singular pixels.
std::optional<PixelErrors::QuickTruth> PixelErrors::quick_truth(const SnappedQuad& q, int px, int py) const {
  using Wide = __int128;
  std::int64_t x[4], y[4];
  long double length[4];
  for (std::size_t i = 0; i < 4; ++i) {
    x[i] = q.vertex[i].x - std::int64_t{q.vertex[i].w} * px;
    y[i] = q.vertex[i].y - std::int64_t{q.vertex[i].w} * py;
    const Wide r2 = static_cast<Wide>(x[i]) * x[i] + static_cast<Wide>(y[i]) * y[i];
    if (r2 == 0) return std::nullopt;
    length[i] = std::sqrt(static_cast<long double>(r2));
  }
  long double t[4];
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = (i + 1) & 3;
    const Wide a = static_cast<Wide>(x[i]) * y[j] - static_cast<Wide>(y[i]) * x[j];
    const Wide d = static_cast<Wide>(x[i]) * x[j] + static_cast<Wide>(y[i]) * y[j];
    const long double area = static_cast<long double>(a), dot = static_cast<long double>(d),
                      both = length[i] * length[j];
    if (d < 0 && a == 0) return std::nullopt;
    t[i] = d < 0 ? (both - dot) / area : area / (both + dot);
  }
  const auto port = [&](const PortNumber& number) { return golden::port_value(number, config_.significand_bits); };
  QuickTruth truth;
  std::array<long double, 4> m;
  long double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    m[i] = (t[(i + 3) & 3] + t[i]) / length[i];
    truth.lambda[i] = m[i] * static_cast<long double>(port(q.vertex[i].k));
    sum += truth.lambda[i];
  }
  for (long double& l : truth.lambda) l /= sum;
  if (output_ == Output::weight) return truth;

  const long double bound = weight_bound(config_);
  long double value = 0, tolerance = 0;
  if (output_ == Output::attribute) {
    for (std::size_t i = 0; i < 4; ++i) {
      const long double a = port(q.vertex[i].attribute[0]) / port(q.vertex[i].k);
      value += truth.lambda[i] * a;
      tolerance += bound * std::fabs(a);
    }
  } else {
    // As JudgedQuad::depth_tolerance.
    long double sum_z = 0, sum_w = 0, above = 0, below = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const long double z = m[i] * port(q.vertex[i].z),
                        w = m[i] * std::ldexp(static_cast<long double>(q.vertex[i].w), -config_.frac());
      sum_z += z, sum_w += w, above += std::fabs(z), below += std::fabs(w);
    }
    const long double scale = std::fabs(sum_w), lost = 2 * bound * (below / scale);
    if (!(lost < 1)) return std::nullopt;
    value = sum_z / sum_w;
    tolerance = (2 * bound * (above / scale) + std::fabs(value) * lost) / (1 - lost);
  }
  truth.value = static_cast<double>(value);
  truth.tolerance = static_cast<double>(tolerance);
  return truth;
}

double PixelErrors::units_of(const Fragment& fragment, const QuickTruth& truth) const {
  if (output_ == Output::weight) {
    double worst = 0;
    for (std::size_t i = 0; i < 4; ++i)
      worst = std::max(worst, std::fabs(weight(fragment, i) - static_cast<double>(truth.lambda[i])));
    return std::ldexp(worst, config_.significand_bits);
  }
  const bool attribute = output_ == Output::attribute;
  const FixedPoint format = attribute ? attribute_format(config_) : depth_format(config_);
  if (!(truth.tolerance > 0) || std::fabs(truth.value) + truth.tolerance >= format.limit()) return -1;
  return bound_units * format.distance(attribute ? fragment.attribute[0] : fragment.depth, truth.value) /
         truth.tolerance;
}

double PixelErrors::measure(const WindowQuad& quad, int px, int py) const {
  SnappedQuad q;
  try {
    q = snap_quad(quad, config_, state_);
  } catch (const SnapError&) {
    return -1;
  }
  const SetupResult setup = quad_setup(q, config_, state_);
  const QuadConstants constants(setup);
  TileEntry tile;
  tile.tile_x = px >> config_.tile_log2;
  tile.tile_y = py >> config_.tile_log2;
  const int x = (tile.tile_x - setup.tile_x0) * config_.tile(), y = (tile.tile_y - setup.tile_y0) * config_.tile();
  WalkState walk;
  for (std::size_t k = 0; k < linear_count; ++k) walk.linear[k] = setup.linear[k].value;
  walk_step(walk, constants, x, y);
  tile.linear = walk.linear;
  tile.quadratic = tile_context(constants, x, y, config_.qdrop());
  const int dx = px & (config_.tile() - 1), row = py & (config_.tile() - 1);
  if (!(stamp_coverage(tile, constants, row, config_, state_).mask >> dx & 1)) return -1;
  const auto truth = quick_truth(q, px, py);
  if (!truth) return -1;
  PixelTrace p;
  pixel_pipeline(p, tile, constants, quad_data(q, setup, config_, state_), dx, row, context_);
  return p.drawn ? units_of(p.fragment, *truth) : -1;
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
      if (output_ != Output::weight) {
        const JudgedQuad judged(q, config_, state_);
        const double bound = weight_bound(config_);
        exact.value = output_ == Output::attribute ? s.attribute[0] : s.z;
        exact.tolerance = output_ == Output::attribute ? judged.attribute_tolerance(0, s.attribute[0], x, y, bound)
                                                       : judged.depth_tolerance(x, y, bound);
        if (!std::isfinite(exact.tolerance)) continue;
      }
      error.condition = s.condition;
      error.flags = f.flags;
      error.units = std::max(error.units, units_of(f, exact));
    }
  });
}

double PixelErrors::weight(const Fragment& f, std::size_t i) const {
  return std::ldexp(static_cast<double>(f.attribute[i]), -config_.attribute_frac());
}

}  // namespace quadrille::cli
