#include "tb/check/knob_errors.hpp"

#include "golden/reference/paper_float.hpp"
#include "model/snap.hpp"
#include "tb/check/judge.hpp"
#include "tb/check/judged_quad.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

namespace quadrille::cli {
namespace {

using golden::ReferenceSample;

/// One pixel as the truth has it, and what the bound allows there.
struct Expected {
  Place place;
  ReferenceSample truth;
  std::array<double, max_attribute_slots> attribute_tolerance{};
  double depth_tolerance = 0;
};

auto order(const Place& p) { return std::tuple(p.index, p.y, p.x); }

class Meter {
 public:
  Meter(std::span<const WindowQuad> quads, int attributes, const Config& config, const DrawState& state)
      : quads_(quads), attributes_(attributes), config_(config), snapping_(snapping_config(config, attributes)) {
    state_ = state;
    state_.attributes = attributes;
    bound_ = weight_bound(config);
    for (std::size_t i = 0; i < quads.size(); ++i)
      snapped_.push_back(snap_as(quads[i], static_cast<std::uint32_t>(i), snapping_, state_));
  }

  std::vector<EngineSample> draw(EngineKind kind) const {
    EngineSettings settings;
    settings.kind = kind;
    settings.config = config_;
    settings.state = state_;
    std::vector<EngineSample> out;
    make_engine(settings)->draw(quads_, attributes_, true, [&](std::span<const EngineSample> samples) {
      out.insert(out.end(), samples.begin(), samples.end());
    });
    return out;
  }

  /// Of the pixels that the truth draws among these.
  void expect(const std::vector<EngineSample>& drawn) {
    std::optional<JudgedQuad> quad;
    std::uint32_t current = 0;
    for (const EngineSample& sample : drawn) {
      if (!quad || sample.index != current) {
        current = sample.index;
        quad.emplace(snapped_[current], snapping_, state_, state_);
      }
      Expected e;
      e.place = {sample.index, sample.quad, sample.x, sample.y};
      e.truth = quad->truth().sample(sample.x, sample.y);
      // Drawn by the model all the same: tolerated by the judge where sum(M w) is near 0, or z near its limits.
      if (!e.truth.covered || !e.truth.visible || !in_depth(e.truth)) continue;
      const double attribute_unit = attribute_format(config_).unit();
      for (std::size_t a = 0; a < static_cast<std::size_t>(attributes_); ++a)
        e.attribute_tolerance[a] =
            quad->attribute_tolerance(a, e.truth.attribute[a], sample.x, sample.y, bound_) + attribute_unit;
      if (state_.depth)
        e.depth_tolerance = quad->depth_tolerance(sample.x, sample.y, bound_) + depth_format(config_).unit();
      expected_.push_back(e);
    }
    std::ranges::sort(expected_, {}, [](const Expected& e) { return order(e.place); });
  }

  BodyErrors compare(std::vector<EngineSample> samples, std::vector<WeightErrors>* weights = nullptr) const {
    const auto place_of = [](const EngineSample& s) { return std::tuple(s.index, int{s.y}, int{s.x}); };
    std::ranges::sort(samples, {}, place_of);
    BodyErrors out;
    for (const Expected& e : expected_) {
      const auto found = std::ranges::lower_bound(samples, order(e.place), {}, place_of);
      if (found == samples.end() || place_of(*found) != order(e.place)) {
        ++out.missing;
      } else if (found->undefined) {
        ++out.undefined;
      } else {
        const std::array<double, 4> errors = add(e, *found, out);
        if (weights)
          weights->push_back(
              {e.place.index, static_cast<std::uint16_t>(e.place.x), static_cast<std::uint16_t>(e.place.y), errors});
      }
    }
    return out;
  }

  /// The paper's formulas at the same pixels.
  template <class Quad>
  BodyErrors compare_paper() const {
    BodyErrors out;
    std::optional<Quad> quad;
    std::uint32_t current = 0;
    for (const Expected& e : expected_) {
      if (!quad || e.place.index != current) {
        current = e.place.index;
        quad.emplace(snapped_[current], snapping_, state_);
      }
      const ReferenceSample s = quad->sample(e.place.x, e.place.y);
      if (s.covered && s.undefined)
        ++out.undefined;
      else if (!s.covered || !s.visible || !in_depth(s))
        ++out.missing;
      else
        add(e, s, out);
    }
    return out;
  }

 private:
  bool in_depth(const ReferenceSample& s) const { return !state_.depth || (s.z >= state_.znear && s.z <= state_.zfar); }

  /// Returns the weights' signed errors in units of the bound.
  template <class Sample>
  std::array<double, 4> add(const Expected& e, const Sample& s, BodyErrors& out) const {
    ++out.fragments;
    const auto raise = [](double part, double& largest) { largest = part > largest ? part : largest; };
    std::array<double, 4> errors;
    for (std::size_t i = 0; i < 4; ++i) {
      errors[i] = (s.lambda[i] - e.truth.lambda[i]) / bound_;
      if (std::fabs(errors[i]) > out.weight) out.weight = std::fabs(errors[i]), out.worst = e.place;
    }
    for (std::size_t a = 0; a < static_cast<std::size_t>(attributes_); ++a)
      raise(std::fabs(s.attribute[a] - e.truth.attribute[a]) / e.attribute_tolerance[a], out.attribute);
    if (state_.depth && std::isfinite(e.depth_tolerance))
      raise(std::fabs(s.z - e.truth.z) / e.depth_tolerance, out.depth);
    return errors;
  }

  std::span<const WindowQuad> quads_;
  int attributes_;
  Config config_, snapping_;
  DrawState state_;
  double bound_ = 0;
  std::vector<SnappedQuad> snapped_;
  std::vector<Expected> expected_;
};

std::string first_difference(std::span<const EngineSample> model, std::span<const EngineSample> rtl) {
  const auto same = [](const EngineSample& a, const EngineSample& b) {
    return a.index == b.index && a.x == b.x && a.y == b.y && a.front == b.front && a.flags == b.flags && a.z == b.z &&
           a.lambda == b.lambda && a.attribute == b.attribute;
  };
  const auto [m, r] = std::ranges::mismatch(model, rtl, same);
  if (m == model.end() && r == rtl.end()) return {};
  const auto text = [](const auto& at, const auto& end) {
    return at == end ? std::string("nothing")
                     : "quad " + std::to_string(at->quad) + " at (" + std::to_string(at->x) + ", " +
                           std::to_string(at->y) + ")";
  };
  return "rtl differs from model: " + text(m, model.end()) + " and " + text(r, rtl.end());
}

}  // namespace

void BodyErrors::merge(const BodyErrors& other) {
  fragments += other.fragments;
  undefined += other.undefined;
  missing += other.missing;
  if (other.weight > weight) worst = other.worst;
  weight = std::max(weight, other.weight);
  attribute = std::max(attribute, other.attribute);
  depth = std::max(depth, other.depth);
}

KnobErrors measure_knob(std::span<const WindowQuad> quads, int attributes, const Config& config, const DrawState& state,
                        unsigned bodies) {
  KnobErrors out;
  out.verdict = judge_untimed(quads, attributes, config, state, PixelEngine::lanes);
  Meter meter(quads, attributes, config, state);
  const std::vector<EngineSample> model = meter.draw(EngineKind::model);
  meter.expect(model);
  const auto wanted = [&](KnobBody body) { return (bodies >> static_cast<unsigned>(body) & 1) != 0; };
  const auto errors = [&](KnobBody body) -> BodyErrors& { return out.body[static_cast<std::size_t>(body)]; };
  errors(KnobBody::model) = meter.compare(model, &out.weights);
  if (wanted(KnobBody::paper_float)) errors(KnobBody::paper_float) = meter.compare_paper<golden::PaperFp64Quad>();
  if (wanted(KnobBody::fp32)) errors(KnobBody::fp32) = meter.compare_paper<golden::PaperFp32Quad>();
  if (wanted(KnobBody::shader)) errors(KnobBody::shader) = meter.compare(meter.draw(EngineKind::shader));
  if (wanted(KnobBody::rtl)) {
    const std::vector<EngineSample> rtl = meter.draw(EngineKind::rtl);
    out.difference = first_difference(model, rtl);
    errors(KnobBody::rtl) = meter.compare(rtl);
  }
  return out;
}

ErrorJump error_jump(std::span<const WeightErrors> from, std::span<const WeightErrors> to) {
  std::map<std::tuple<std::uint32_t, int, int>, const WeightErrors*> places;
  for (const WeightErrors& e : from) places[{e.index, e.x, e.y}] = &e;
  ErrorJump jump;
  for (const WeightErrors& e : to) {
    const auto found = places.find({e.index, e.x, e.y});
    if (found == places.end()) continue;
    ++jump.pixels;
    for (std::size_t i = 0; i < 4; ++i)
      jump.largest = std::max(jump.largest, std::fabs(e.error[i] - found->second->error[i]));
  }
  return jump;
}

}  // namespace quadrille::cli
