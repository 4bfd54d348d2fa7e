#include "tb/check/check.hpp"

#include "golden/reference/truth.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <tuple>

namespace quadrille::cli {
namespace {

using golden::Coverage;
using golden::ReferenceSample;
using golden::TruthQuad;

constexpr std::size_t fragments_per_job = 2048;
constexpr std::size_t quads_per_job = 256;
constexpr std::size_t pixels_per_job = 16384;

constexpr double near_edge_distance = 1.0 / 16;  // pixels
constexpr double near_vertex_distance = 1;

constexpr std::uint8_t compared_flags =
    flag_on_edge | flag_on_vertex | flag_two_corner | flag_two_edge | flag_tie | flag_homogeneous;

constexpr std::pair<std::uint8_t, std::uint64_t CheckResult::*> counted_flags[]{
    {flag_on_edge, &CheckResult::on_edge},
    {flag_on_vertex, &CheckResult::on_vertex},
    {flag_two_corner, &CheckResult::two_corner},
    {flag_two_edge, &CheckResult::two_edge},
    {flag_tie, &CheckResult::tie},
    {flag_homogeneous, &CheckResult::homogeneous},
    {flag_cured, &CheckResult::cured},
    {flag_saturated, &CheckResult::saturated}};

auto order(const Place& p) { return std::tuple(p.index, p.y, p.x); }

double real(const PortNumber& n, const Config& config) {
  const double value = std::ldexp(static_cast<double>(n.sig), n.exp - (config.significand_bits - 1));
  return n.neg ? -value : value;
}

std::string text_of(const Place& place, const std::string& what) {
  char head[96];
  std::snprintf(head, sizeof head, "quad %u, pixel (%d, %d): ", place.quad, place.x, place.y);
  return head + what;
}

/// Distances of a pixel centre to edges and corners, in double: for counting only.
struct Vicinity {
  bool near_edge = false, near_vertex = false;
};

Vicinity vicinity(const SnappedQuad& quad, int px, int py) {
  std::array<double, 4> x{}, y{}, w{};
  Vicinity result;
  for (std::size_t i = 0; i < 4; ++i) {
    w[i] = quad.vertex[i].w;
    x[i] = quad.vertex[i].x - w[i] * px;
    y[i] = quad.vertex[i].y - w[i] * py;
    const double distance = std::hypot(x[i], y[i]);
    if (w[i] != 0 && distance <= std::fabs(w[i]) * near_vertex_distance) result.near_vertex = true;
    if (w[i] != 0 && distance <= std::fabs(w[i]) * near_edge_distance) result.near_edge = true;
  }
  for (std::size_t i = 0; i < 4 && !result.near_edge; ++i) {
    const std::size_t j = (i + 1) % 4;
    if (x[i] * x[j] + y[i] * y[j] > 0) continue;  // beside the edge, not on its line beyond the ends
    const double area = x[i] * y[j] - y[i] * x[j];
    const double slope = std::hypot(y[i] * w[j] - w[i] * y[j], w[i] * x[j] - x[i] * w[j]);
    if (std::fabs(area) <= slope * near_edge_distance) result.near_edge = true;
  }
  return result;
}

}  // namespace

double weight_bound(const Config& config) { return std::ldexp(1.0, -(config.significand_bits - 3)); }

void QuantityErrors::merge(const QuantityErrors& other) {
  lambda.merge(other.lambda);
  attribute.merge(other.attribute);
  depth.merge(other.depth);
}

bool CheckResult::ok() const {
  return compared > 0 && std::ranges::all_of(fault_counters, [this](const auto& c) { return this->*c.value == 0; });
}

void CheckResult::merge(const CheckResult& other) {
  add_counters(*this, other, check_counters);
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
    using Wide = std::int64_t;
    const bool parallel =
        Wide{a.y} * b.w == Wide{a.w} * b.y && Wide{a.w} * b.x == Wide{a.x} * b.w && Wide{a.x} * b.y == Wide{a.y} * b.x;
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

/// One quad's truths and facts.
struct FragmentChecker::Reference {
  TruthQuad snapped;
  std::optional<TruthQuad> given;
  const SnappedQuad& quad;
  const Config& config;
  bool eye_crossing, tiny, behind;

  Reference(const FragmentChecker& checker, std::size_t index)
      : snapped(checker.snapped_[index], checker.settings_.config, truth_state(checker)),
        quad(checker.snapped_[index]),
        config(checker.settings_.config),
        eye_crossing(is_eye_crossing(quad)),
        tiny(is_tiny(quad, config)),
        behind(std::any_of(quad.vertex.begin(), quad.vertex.end(), [](const SnappedVertex& v) { return v.w <= 0; })) {
    if (checker.settings_.snapping)
      given.emplace(pass_quad(checker.given_[index], checker.settings_.pass), truth_state(checker));
  }

  /// The weights come with every sample; only true attributes are asked for.
  static DrawState truth_state(const FragmentChecker& checker) {
    DrawState state = checker.settings_.state;
    const std::vector<int>& columns = checker.settings_.pass.columns;
    if (std::all_of(columns.begin(), columns.end(), [](int column) { return column < 4; })) state.attributes = 0;
    return state;
  }

  /// How far the machine's window z may be from the truth's: each M carries the weights' relative error. Infinite where
  /// sum(M w) cancels to what that error leaves of it.
  double depth_tolerance(int x, int y, double bound) const {
    const auto m = snapped.homogeneous_weights(x, y);
    double numerator = 0, spread = 0, denominator = 0, z = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const double mi = static_cast<double>(m[i]),
                   w = std::ldexp(static_cast<double>(quad.vertex[i].w), -config.frac());
      numerator += std::fabs(mi * real(quad.vertex[i].z, config));
      z += mi * real(quad.vertex[i].z, config);
      spread += std::fabs(mi * w);
      denominator += mi * w;
    }
    const double scale = std::fabs(denominator), lost = 2 * bound * (spread / scale);
    if (!(lost < 1)) return std::numeric_limits<double>::infinity();
    return (2 * bound * (numerator / scale) + std::fabs(z) / scale * lost) / (1 - lost) +
           std::ldexp(1.0, -config.depth_bits);
  }

  /// Whether a window z that far from the truth's is within depth_tolerance(), which is never below the first line.
  bool depth_holds(const Fragment& fragment, const ReferenceSample& truth, double error, double bound) const {
    if (std::fabs(error) <= bound * std::fabs(truth.z) + std::ldexp(1.0, -config.depth_bits)) return true;
    return std::fabs(error) <= depth_tolerance(fragment.x, fragment.y, bound);
  }

  /// How far attribute `slot` may be from the truth's: a = sum(lambda' a_i), each lambda' within `bound`, and one unit
  /// of the output format.
  double attribute_tolerance(std::size_t slot, bool perspective, double bound) const {
    double sum = 0;
    for (const SnappedVertex& v : quad.vertex) {
      const double k = perspective ? real(v.k, config) : std::ldexp(static_cast<double>(v.w), -config.frac());
      sum += std::fabs(real(v.attribute[slot], config) / k);
    }
    return bound * sum + std::ldexp(1.0, -config.attribute_frac());
  }
};

FragmentChecker::FragmentChecker(const Settings& settings, std::span<const WindowQuad> given,
                                 std::span<const SnappedQuad> snapped, WorkQueue& queue)
    : settings_(settings), given_(given), snapped_(snapped), queue_(queue), bound_(weight_bound(settings.config)) {
  covered_.emplace_back();
}

void FragmentChecker::add(const CheckResult& part) {
  std::lock_guard lock(mutex_);
  result_.merge(part);
}

void FragmentChecker::fragment(const Fragment& fragment) {
  if (settings_.first_pass) {
    if (fragment.quad < current_ || fragment.quad >= snapped_.size()) {
      CheckResult part;
      part.mismatches = 1;
      part.first = {true, {fragment.quad, fragment.quad, fragment.x, fragment.y}, ""};
      part.first.text = text_of(part.first.place, "a fragment of a quad that is not being drawn");
      add(part);
      return;
    }
    if (fragment.quad != current_) quads_done(fragment.quad);
    covered_.back().push_back(static_cast<std::uint32_t>(fragment.y) << 16 | fragment.x);
    ++covered_pixels_;
  }
  batch_.push_back(fragment);
  if (batch_.size() >= fragments_per_job) flush_fragments();
}

void FragmentChecker::flush_fragments() {
  if (batch_.empty()) return;
  queue_.push([this, fragments = std::move(batch_)] { compare(fragments); });
  batch_ = {};
}

/// The quads before `end` are complete.
void FragmentChecker::quads_done(std::size_t end) {
  while (current_ < end) {
    ++current_;
    if (current_ - covered_first_ >= quads_per_job || covered_pixels_ >= pixels_per_job) flush_coverage();
    covered_.emplace_back();
  }
}

/// Hands the complete quads covered_first_ … current_-1 over.
void FragmentChecker::flush_coverage() {
  if (current_ == covered_first_) return;
  const auto pixels = std::make_shared<const std::vector<std::vector<std::uint32_t>>>(std::move(covered_));
  // One quad over much of the viewport is worth several jobs.
  const int height = settings_.state.height;
  const int rows = current_ - covered_first_ == 1 ? std::max(1, height / 8) : height;
  for (int y = 0; y < height; y += rows)
    queue_.push(
        [this, first = covered_first_, pixels, y, end = std::min(height, y + rows)] { cover(first, *pixels, y, end); });
  covered_.clear();
  covered_first_ = current_;
  covered_pixels_ = 0;
}

void FragmentChecker::finish(bool complete) {
  flush_fragments();
  if (!settings_.first_pass) return;
  if (complete) {
    quads_done(snapped_.size());
    covered_.pop_back();
  } else if (!covered_.empty()) {
    covered_.pop_back();  // the last quad was cut off
  }
  flush_coverage();
}

void FragmentChecker::compare(const std::vector<Fragment>& fragments) {
  CheckResult part;
  std::optional<Reference> reference;
  std::size_t current = 0;
  const Config& config = settings_.config;
  const DrawState& state = settings_.state;
  const std::vector<int>& columns = settings_.pass.columns;

  for (const Fragment& fragment : fragments) {
    if (!reference || fragment.quad != current) {
      current = fragment.quad;
      reference.emplace(*this, current);
    }
    const Place place{fragment.quad, given_[current].id, fragment.x, fragment.y};
    const auto differs = [&](const std::string& what) {
      ++part.mismatches;
      if (!part.first.any || order(place) < order(part.first.place)) part.first = {true, place, text_of(place, what)};
    };
    const ReferenceSample truth = reference->snapped.sample(fragment.x, fragment.y);
    ++part.compared;

    // Whether it should be there at all.
    if (settings_.first_pass) {
      if (fragment.x < state.scissor_x0 || fragment.x >= state.scissor_x1 || fragment.y < state.scissor_y0 ||
          fragment.y >= state.scissor_y1) {
        differs("drawn outside the scissor rectangle");
        continue;
      }
      if (!truth.covered) {
        differs("drawn, but the truth does not cover it");
        continue;
      }
      if (!truth.visible) {
        if (!truth.eye_in_hull || !(std::fabs(truth.visible_margin) < bound_)) {
          differs("drawn, but the truth has it behind the eye");
          continue;
        }
        ++part.tolerated_visible;
        continue;
      }
      if (truth.front != fragment.front) differs(fragment.front ? "drawn as front face" : "drawn as back face");
      if (state.cull == (truth.front ? Cull::front : Cull::back)) differs("drawn, but culled by its facing");
      if (state.depth && !(truth.z >= state.znear && truth.z <= state.zfar)) {
        const double tolerance = reference->depth_tolerance(fragment.x, fragment.y, bound_);
        if (truth.z < state.znear - tolerance || truth.z > state.zfar + tolerance)
          differs("drawn, but window z is outside znear and zfar");
        else
          ++part.tolerated_depth;
      }
      if (config.qdrop() == 0 && ((truth.flags ^ fragment.flags) & compared_flags) != 0) {
        char text[80];
        std::snprintf(text, sizeof text, "flags 0x%02x, expected 0x%02x", fragment.flags & compared_flags,
                      truth.flags & compared_flags);
        differs(text);
      }
    } else if (!truth.covered || !truth.visible) {
      continue;  // the first pass has said so
    }

    // What it should be.
    const bool exempt = !state.perspective && reference->behind;
    const double bound = bound_ * (config.notch_exact ? 1 : std::max(1.0, truth.condition));
    double lambda_error = 0, attribute_error = 0;
    bool attributes_hold = true;
    int weight = 0;
    bool weights = false, attributes = false;
    for (std::size_t slot = 0; slot < columns.size(); ++slot) {
      const double value = std::ldexp(static_cast<double>(fragment.attribute[slot]), -config.attribute_frac());
      if (columns[slot] < 4) {
        weights = true;
        const double error = std::fabs(value - truth.lambda[static_cast<std::size_t>(columns[slot])]);
        if (!(error <= lambda_error)) lambda_error = error, weight = columns[slot];
      } else {
        attributes = true;
        const double error = std::fabs(value - truth.attribute[slot]);
        if (!(error <= attribute_error)) attribute_error = error;
        attributes_hold = attributes_hold && error <= reference->attribute_tolerance(slot, state.perspective, bound);
      }
    }
    if (exempt) {
      if (settings_.first_pass) ++part.bound_exempt;
    } else {
      if (weights) {
        part.arithmetic.lambda.add(lambda_error);
        const double ratio = lambda_error / bound;
        if (settings_.apply_bound && !(ratio <= 1)) ++part.beyond_bound;
        if (!(ratio <= part.worst.ratio) || (ratio == part.worst.ratio && order(place) < order(part.worst.place)))
          part.worst = {ratio, lambda_error, bound, truth.condition, weight, place};
      }
      if (attributes) {
        part.arithmetic.attribute.add(attribute_error);
        if (settings_.apply_bound && !attributes_hold && (fragment.flags & flag_saturated) == 0)
          ++part.beyond_attribute;
      }
    }
    if (settings_.first_pass && state.depth) {
      const double error = std::ldexp(static_cast<double>(fragment.depth), -config.depth_bits) - truth.z;
      part.arithmetic.depth.add(error);
      if (settings_.apply_bound && !reference->depth_holds(fragment, truth, error, bound)) ++part.beyond_depth;
    }

    // What snapping did.
    if (reference->given) {
      const ReferenceSample given = reference->given->sample(fragment.x, fragment.y);
      if (!given.covered || !given.visible) {
        if (settings_.first_pass) ++part.coverage_flips;
      } else if (!exempt) {
        double lambda_shift = 0, attribute_shift = 0;
        for (std::size_t i = 0; i < 4; ++i)
          lambda_shift = std::max(lambda_shift, std::fabs(truth.lambda[i] - given.lambda[i]));
        for (std::size_t slot = 0; slot < columns.size(); ++slot)
          if (columns[slot] >= 4)
            attribute_shift = std::max(attribute_shift, std::fabs(truth.attribute[slot] - given.attribute[slot]));
        if (weights) part.snapping.lambda.add(lambda_shift);
        if (attributes) part.snapping.attribute.add(attribute_shift);
        if (settings_.first_pass && state.depth) part.snapping.depth.add(truth.z - given.z);
      }
    }

    // What it was.
    if (settings_.first_pass) {
      for (const auto& [flag, counter] : counted_flags) part.*counter += (fragment.flags & flag) != 0;
      part.eye_crossing += reference->eye_crossing;
      part.tiny += reference->tiny;
      const Vicinity near = vicinity(reference->quad, fragment.x, fragment.y);
      part.near_edge += near.near_edge;
      part.near_vertex += near.near_vertex;
    }
  }
  add(part);
}

/// Every pixel of rows y0 … y1-1 that the truth covers must have been drawn, once.
void FragmentChecker::cover(std::size_t first, const std::vector<std::vector<std::uint32_t>>& pixels, int y0, int y1) {
  CheckResult part;
  const DrawState& state = settings_.state;
  std::vector<std::uint32_t> drawn;
  for (std::size_t n = 0; n < pixels.size(); ++n) {
    const std::size_t index = first + n;
    const auto differs = [&](int x, int y, const char* what) {
      const Place place{static_cast<std::uint32_t>(index), given_[index].id, x, y};
      ++part.mismatches;
      if (!part.first.any || order(place) < order(part.first.place)) part.first = {true, place, text_of(place, what)};
    };
    drawn.clear();
    for (const std::uint32_t pixel : pixels[n])
      if (const int y = static_cast<int>(pixel >> 16); y >= y0 && y < y1) drawn.push_back(pixel);
    std::sort(drawn.begin(), drawn.end());
    for (std::size_t i = 1; i < drawn.size(); ++i)
      if (drawn[i] == drawn[i - 1])
        differs(static_cast<int>(drawn[i] & 0xffff), static_cast<int>(drawn[i] >> 16), "drawn twice");

    const Reference reference(*this, index);
    const golden::PixelRect bounds = reference.snapped.bounds();
    std::size_t next = 0;
    for (int y = std::max(y0, bounds.y0); y < std::min(y1, bounds.y1); ++y) {
      for (int x = bounds.x0; x < bounds.x1; ++x) {
        const std::uint32_t pixel = static_cast<std::uint32_t>(y) << 16 | static_cast<std::uint32_t>(x);
        while (next < drawn.size() && drawn[next] < pixel) ++next;
        if (next < drawn.size() && drawn[next] == pixel) continue;  // compare() judges what was drawn
        const Coverage coverage = reference.snapped.cover(x, y);
        if (!coverage.covered || !coverage.visible || state.cull == (coverage.front ? Cull::front : Cull::back))
          continue;
        const ReferenceSample truth = reference.snapped.sample(x, y);
        if (truth.eye_in_hull && std::fabs(truth.visible_margin) < bound_) {
          ++part.tolerated_visible;
          continue;
        }
        if (state.depth && !(truth.z >= state.znear && truth.z <= state.zfar)) {
          ++part.discarded;
          continue;
        }
        if (state.depth) {
          const double tolerance = reference.depth_tolerance(x, y, bound_);
          if (truth.z < state.znear + tolerance || truth.z > state.zfar - tolerance) {
            ++part.tolerated_depth;
            continue;
          }
        }
        differs(x, y, "the truth covers it, but it was not drawn");
      }
    }
  }
  add(part);
}

}  // namespace quadrille::cli
