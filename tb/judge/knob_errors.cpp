#include "tb/judge/knob_errors.hpp"

#include "golden/analysis/judged_quad.hpp"
#include "golden/reference/paper_float.hpp"
#include "golden/reference/port_number.hpp"
#include "model/port/snap.hpp"
#include "tb/judge/drawn_depths.hpp"
#include "tb/judge/judge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>

namespace quadrille::tb {
namespace {

using golden::ReferenceSample;

/// One pixel as the truth has it, and what the bound allows there.
struct Expected {
  Place place;
  bool near_case = false;
  ReferenceSample truth;
  AllowedErrors allowed;
};

auto order(const Place& p) { return std::tuple(p.index, p.y, p.x); }

/// Of value i of `count`: the weights, the attributes, depth.
std::size_t output_of(std::size_t i, std::size_t count) {
  if (i < 4) return static_cast<std::size_t>(Output::weight);
  return static_cast<std::size_t>(i + 1 == count ? Output::depth : Output::attribute);
}

class Meter {
 public:
  Meter(std::span<const WindowQuad> quads, std::span<const golden::ApproachPlace> places, int attributes,
        const Config& config, const DrawState& state)
      : quads_(quads),
        places_(places),
        attributes_(attributes),
        config_(config),
        snapping_(snapping_config(config, attributes)),
        bounds_(config),
        limits_(config, state) {
    state_ = state;
    state_.attributes = attributes;
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
  void expect(std::vector<EngineSample> drawn) {
    std::ranges::stable_sort(drawn, {}, &EngineSample::index);
    for (std::size_t first = 0; first < drawn.size();) {
      std::size_t last = first;
      while (last < drawn.size() && drawn[last].index == drawn[first].index) ++last;
      expect_quad(std::span(drawn).subspan(first, last - first));
      first = last;
    }
    std::ranges::sort(expected_, {}, [](const Expected& e) { return order(e.place); });
  }

  /// The body's errors to `out`; those of every pixel to `series`, if there is one.
  void compare(EngineKind body, std::vector<EngineSample> samples, KnobErrors& out,
               PixelSeries* series = nullptr) const {
    const auto place_of = [](const EngineSample& s) { return std::tuple(s.index, int{s.y}, int{s.x}); };
    std::ranges::sort(samples, {}, place_of);
    for (const Expected& e : expected_) {
      const auto found = std::ranges::lower_bound(samples, order(e.place), {}, place_of);
      const bool missing = found == samples.end() || place_of(*found) != order(e.place);
      if (missing || found->undefined)
        lose(body, e, missing, out);
      else
        add(body, e, *found, out, series);
    }
  }

  /// The paper's formulas at the same pixels.
  template <class Quad>
  void compare_paper(EngineKind body, KnobErrors& out) const {
    std::optional<Quad> quad;
    std::uint32_t current = 0;
    for (const Expected& e : expected_) {
      if (!quad || e.place.index != current) {
        current = e.place.index;
        quad.emplace(snapped_[current], snapping_, state_);
      }
      const ReferenceSample s = quad->sample(e.place.x, e.place.y);
      if (s.covered && s.undefined)
        lose(body, e, false, out);
      else if (!s.covered || !s.visible || !in_depth(s))
        lose(body, e, true, out);
      else
        add(body, e, s, out, nullptr);
    }
  }

 private:
  void expect_quad(std::span<const EngineSample> drawn) {
    const std::uint32_t index = drawn.front().index;
    const JudgedQuad quad(snapped_[index], snapping_, bounds_, state_);
    const ErrorBounds limits(quad, config_, state_);
    std::vector<golden::PixelPlace> pixels;
    for (const EngineSample& sample : drawn) pixels.push_back({sample.x, sample.y});
    std::vector<ReferenceSample> truths(pixels.size());
    quad.truth().samples(pixels, truths);
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      const ReferenceSample& truth = truths[i];
      const int x = drawn[i].x, y = drawn[i].y;
      // Drawn by the model all the same: tolerated by the judge where sum(M w) is near 0, or z near its limits.
      if (!truth.covered || !truth.visible || !in_depth(truth)) continue;
      expected_.push_back({{index, drawn[i].quad, x, y},
                           !places_.empty() && places_[index].is_near(x, y),
                           truth,
                           limits.at(truth, x, y)});
    }
  }

  /// By codes, as the machine discards.
  bool in_depth(const ReferenceSample& s) const { return !state_.depth || limits_.side(s.z, 0) >= 0; }

  /// To the sum over all pixels and to that over those near the case.
  template <class Change>
  static void change(EngineKind body, const Expected& e, KnobErrors& out, const Change& what) {
    what(out.body[body]);
    if (e.near_case) what(out.near_case[body]);
  }

  void lose(EngineKind body, const Expected& e, bool missing, KnobErrors& out) const {
    change(body, e, out, [&](BodyErrors& errors) {
      if (errors.pixels_lost() == 0) errors.lost = e.place;
      ++(missing ? errors.missing : errors.undefined);
    });
  }

  template <class Sample>
  void add(EngineKind body, const Expected& e, const Sample& s, KnobErrors& out, PixelSeries* series) const {
    std::array<double, 4 + max_attribute_slots + 1> errors{};
    const auto attributes = static_cast<std::size_t>(attributes_);
    const std::size_t count = 4 + attributes + 1;
    for (std::size_t i = 0; i < 4; ++i) errors[i] = (s.lambda[i] - e.truth.lambda[i]) / e.allowed.weight[i];
    for (std::size_t a = 0; a < attributes; ++a)
      errors[4 + a] = (s.attribute[a] - e.truth.attribute[a]) / e.allowed.attribute[a];
    if (state_.depth) errors[count - 1] = (s.z - e.truth.z) / e.allowed.depth;  // 0 where nothing can be said
    if (series) {
      series->pixels.push_back(
          {e.place.index, static_cast<std::uint16_t>(e.place.x), static_cast<std::uint16_t>(e.place.y)});
      for (std::size_t i = 0; i < count; ++i) series->errors.push_back(static_cast<float>(errors[i]));
    }
    std::array<double, output_names.size()> largest{};
    for (std::size_t i = 0; i < count; ++i) {
      double& part = largest[output_of(i, count)];
      part = std::max(part, std::fabs(errors[i]));
    }
    change(body, e, out, [&](BodyErrors& sum) {
      ++sum.fragments;
      sum.beyond += std::ranges::any_of(largest, [](double part) { return part > 1; });
      for (std::size_t o = 0; o < largest.size(); ++o)
        if (largest[o] > sum.largest[o].part) sum.largest[o] = {largest[o], e.place};
    });
  }

  std::span<const WindowQuad> quads_;
  std::span<const golden::ApproachPlace> places_;
  int attributes_;
  Config config_, snapping_;
  Bounds bounds_;
  DepthLimits limits_;
  DrawState state_;
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
  if (pixels_lost() == 0) lost = other.lost;
  fragments += other.fragments;
  beyond += other.beyond;
  undefined += other.undefined;
  missing += other.missing;
  for (std::size_t o = 0; o < largest.size(); ++o)
    if (other.largest[o].part > largest[o].part) largest[o] = other.largest[o];
}

KnobErrors measure_knob(std::span<const WindowQuad> quads, std::span<const golden::ApproachPlace> places,
                        int attributes, const Config& config, const DrawState& state, unsigned bodies) {
  KnobErrors out;
  out.verdict = judge_untimed(quads, attributes, config, state, PixelEngine::lanes);
  Meter meter(quads, places, attributes, config, state);
  const std::vector<EngineSample> model = meter.draw(EngineKind::model);
  meter.expect(model);
  const auto wanted = [&](EngineKind body) { return (bodies >> static_cast<unsigned>(body) & 1) != 0; };
  meter.compare(EngineKind::model, model, out, &out.model);
  if (wanted(EngineKind::paper_float)) meter.compare_paper<golden::PaperFp64Quad>(EngineKind::paper_float, out);
  if (wanted(EngineKind::paper_single)) meter.compare_paper<golden::PaperFp32Quad>(EngineKind::paper_single, out);
  if (wanted(EngineKind::shader)) meter.compare(EngineKind::shader, meter.draw(EngineKind::shader), out);
  if (wanted(EngineKind::rtl)) {
    const std::vector<EngineSample> rtl = meter.draw(EngineKind::rtl);
    out.difference = first_difference(model, rtl);
    meter.compare(EngineKind::rtl, rtl, out);
  }
  return out;
}

void ErrorJump::merge(const ErrorJump& other) {
  pixels += other.pixels;
  for (std::size_t o = 0; o < largest.size(); ++o) largest[o] = std::max(largest[o], other.largest[o]);
}

ErrorJump error_jump(const PixelSeries& from, const PixelSeries& to) {
  ErrorJump jump;
  if (from.empty() || to.empty()) return jump;
  const auto place_of = [](const PixelSeries::Pixel& p) { return std::tuple(p.index, p.y, p.x); };
  const std::size_t count = from.errors.size() / from.pixels.size();
  for (std::size_t f = 0, t = 0; f < from.pixels.size() && t < to.pixels.size();) {
    const auto a = place_of(from.pixels[f]), b = place_of(to.pixels[t]);
    if (a == b) {
      ++jump.pixels;
      for (std::size_t i = 0; i < count; ++i) {
        double& largest = jump.largest[output_of(i, count)];
        largest = std::max(largest, std::fabs(double{from.errors[f * count + i]} - double{to.errors[t * count + i]}));
      }
    }
    f += a <= b;
    t += b <= a;
  }
  return jump;
}

}  // namespace quadrille::tb
