// The evaluator against a slow path written here: the plain untimed model and the truth, one pass of columns and one
// pixel at a time, every pixel of the viewport.
#include "tb/sweep/evaluator.hpp"

#include "golden/analysis/error_bound.hpp"
#include "golden/reference/truth.hpp"
#include "golden/scenes/stress.hpp"
#include "model/port/snap.hpp"
#include "model/skips/plane_quad.hpp"
#include "model/support/prng.hpp"
#include "model/untimed.hpp"
#include "tb/lockstep/lockstep.hpp"
#include "tb/sweep/point_draws.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>

namespace quadrille::sweep {
namespace {

constexpr int size = 40;

SweepInput stress_input(golden::StressFamily family, std::size_t count = 3, int attributes = 6) {
  SweepInput input;
  // These cover few pixels each.
  using enum golden::StressFamily;
  if (family == tiny || family == sliver || family == coincident) count *= 12;
  input.quads = golden::make_stress(family, count, 7, 1.0, size, size, attributes);
  input.attributes = attributes;
  input.state.width = input.state.height = input.state.scissor_x1 = input.state.scissor_y1 = size;
  return input;
}

Config config(std::initializer_list<std::pair<const char*, int>> values) {
  Config c;
  for (const auto& [key, value] : values) c.set(key, value);
  c.validate();
  return c;
}

using Place = std::tuple<std::uint32_t, int, int>;  // quad, y, x

/// All column vectors of a quad: weights, attributes, colours.
std::vector<std::array<double, 4>> columns_of(const WindowQuad& quad, int attributes) {
  std::vector<std::array<double, 4>> out;
  for (std::size_t i = 0; i < 4; ++i) {
    out.emplace_back();
    out.back()[i] = 1;
  }
  for (std::size_t j = 0; j < static_cast<std::size_t>(attributes); ++j) {
    out.emplace_back();
    for (std::size_t i = 0; i < 4; ++i) out.back()[i] = j < quad.attribute[i].size() ? quad.attribute[i][j] : 0.0;
  }
  out.push_back({1, 1, 0, 0});  // R: v0 and v1
  out.push_back({0, 1, 1, 0});  // G: v1 and v2
  out.push_back({1, 0, 1, 0});  // B: v0 and v2
  return out;
}

struct Slow {
  std::uint64_t fragments = 0, coverage_gained = 0, coverage_lost = 0, discard_differs = 0, colour_codes = 0,
                saturated = 0;
  std::set<std::uint32_t> quads, plane_quads;
  std::uint64_t plane_fragments = 0;
  std::uint64_t colour_ties = 0;  ///< channels so near a rounding tie that either code is right
  std::array<std::vector<double>, 4> snapping, arithmetic;
  double z_condition = 1;  ///< largest of a pixel that is measured
  double worst = -1;
  std::set<Place> worst_places;  ///< within rounding of the worst
  std::map<Place, double> lambda_errors;
};

/// One drawn pixel of one quad, or one pixel of the truth.
struct Values {
  double z = 0, z_condition = 1;
  std::vector<double> column;
};

int code(double v) { return static_cast<int>(std::floor(std::clamp(v, 0.0, 1.0) * 255 + 0.5)); }

/// Columns come in passes of five, the last first; where quads may be drawn with areas the input's own attributes
/// first, which decide what is drawn and its depth, then weights and colours with nothing discarded.
Slow slow_path(const SweepInput& input, const Config& given_config) {
  Config c = given_config;
  const bool planes = c.plane_quads != 0 && (input.state.skip & skip_plane) != 0;
  c.attribute_slots = planes ? 8 : 5;
  c.quad_id_bits = 32;
  const std::size_t columns = 7 + static_cast<std::size_t>(input.attributes);
  Slow out;
  std::map<Place, Values> machine, truth, given;
  std::map<Place, bool> visible;
  std::set<Place> saturated;
  std::set<std::uint32_t> unmeasured;  // quads

  std::vector<std::vector<std::size_t>> passes;
  if (planes) {
    passes.resize(2);
    for (std::size_t j = 0; j < columns; ++j) passes[j < 4 || j >= columns - 3].push_back(j);
  } else {
    for (std::size_t end = columns; end > 0; end -= std::min<std::size_t>(5, end)) {
      passes.emplace_back();
      for (std::size_t j = end - std::min<std::size_t>(5, end); j < end; ++j) passes.back().push_back(j);
    }
  }

  for (const std::vector<std::size_t>& pass : passes) {
    const bool decides = !planes || &pass == passes.data();
    DrawState state = with_possible_skips(input.state, c);
    state.attributes = static_cast<int>(pass.size());
    for (std::size_t q = 0; q < input.quads.size(); ++q) {
      WindowQuad quad = input.quads[q];
      const auto all = columns_of(quad, input.attributes);
      quad.id = static_cast<std::uint32_t>(q);
      for (std::size_t i = 0; i < 4; ++i) {
        quad.attribute[i].clear();
        for (const std::size_t j : pass) quad.attribute[i].push_back(all[j][i]);
      }
      const SnappedQuad snapped = snap_quad(quad, c, state);
      for (const SnappedVertex& v : snapped.vertex)
        if (!state.perspective && v.w <= 0) unmeasured.insert(quad.id);
      const auto put = [&](std::map<Place, Values>& to, const Place& place, double z, double condition,
                           const auto& value) {
        Values& v = to[place];
        if (decides) {
          v.z = z;
          v.z_condition = condition;
        }
        v.column.resize(columns);
        for (std::size_t slot = 0; slot < pass.size(); ++slot) v.column[pass[slot]] = value(slot);
      };

      const bool taken = plane_quad(snapped, c, state);
      EXPECT_TRUE(decides || !taken) << "a pass of weights";
      DrawState kept = state;
      if (!decides) kept.depth = false;
      UntimedModel model(c, kept, PixelEngine::plain);
      model.draw(snapped, [&](std::span<const Fragment> fragments) {
        for (const Fragment& f : fragments) {
          const Place place{f.quad, f.y, f.x};
          if (!decides && !machine.contains(place)) continue;
          if (taken) ++out.plane_fragments;
          put(machine, place, std::ldexp(f.depth, -c.depth_bits), 1, [&](std::size_t slot) {
            return std::ldexp(static_cast<double>(f.attribute[slot]), -c.attribute_frac());
          });
          if (f.flags & flag_saturated) saturated.insert(place);
        }
      });
      // A quad counts if it covers pixels, though its depth may leave it out before setup.
      DrawState whole = kept;
      whole.depth = false;
      whole.skip = 0;
      UntimedModel covering(c, whole);
      covering.draw(snapped, [](auto) {});
      if (covering.stats().pixels != 0) out.quads.insert(quad.id);
      if (covering.stats().pixels != 0 && taken) out.plane_quads.insert(quad.id);

      const auto sample_all = [&](const golden::TruthQuad& exact, std::map<Place, Values>& drawn, bool snapped_truth) {
        const golden::PixelRect box = exact.bounds();
        for (int y = box.y0; y < box.y1; ++y)
          for (int x = box.x0; x < box.x1; ++x) {
            if (!exact.cover(x, y).covered) continue;
            const golden::ReferenceSample s = exact.sample(x, y);
            if (state.cull == (s.front ? Cull::front : Cull::back)) continue;
            const Place place{q, y, x};
            if (snapped_truth) visible[place] = s.visible;
            const bool inside = !state.depth || (s.z >= state.znear && s.z <= state.zfar);
            if (!s.visible || (!snapped_truth && !inside)) continue;
            put(drawn, place, s.z, s.z_condition,
                [&](std::size_t slot) { return pass[slot] < 4 ? s.lambda[pass[slot]] : s.attribute[slot]; });
          }
      };
      sample_all(golden::TruthQuad(snapped, c, state), truth, true);
      sample_all(golden::TruthQuad(quad, state), given, false);
    }
  }

  const auto in_interval = [&](const Values& v) {
    return !input.state.depth || (v.z >= input.state.znear && v.z <= input.state.zfar);
  };
  const auto output = [&](std::size_t column) {
    return static_cast<std::size_t>(column < 4             ? Output::weight
                                    : column < columns - 3 ? Output::attribute
                                                           : Output::colour);
  };
  const auto add = [&](std::array<std::vector<double>, 4>& to, const Values& a, const Values& b) {
    for (std::size_t j = 0; j < columns; ++j) to[output(j)].push_back(std::fabs(a.column[j] - b.column[j]));
    if (input.state.depth) to[static_cast<std::size_t>(Output::depth)].push_back(std::fabs(a.z - b.z));
    out.z_condition = std::max({out.z_condition, a.z_condition, b.z_condition});
  };

  out.fragments = machine.size();
  out.saturated = saturated.size();
  for (const auto& [place, m] : machine) {
    out.coverage_gained += !given.contains(place);
    if (!visible.at(place) || unmeasured.contains(std::get<0>(place))) continue;
    const Values& t = truth.at(place);
    add(out.arithmetic, m, t);
    for (std::size_t j = columns - 3; j < columns; ++j) {
      out.colour_codes += code(m.column[j]) != code(t.column[j]);
      const double scaled = t.column[j] * 255 + 0.5;
      out.colour_ties += std::fabs(scaled - std::round(scaled)) < 1e-9;
    }
    double error = 0;
    for (std::size_t j = 0; j < 4; ++j) error = std::max(error, std::fabs(m.column[j] - t.column[j]));
    out.lambda_errors[place] = error;
    out.worst = std::max(out.worst, error);
  }
  for (const auto& [place, error] : out.lambda_errors)
    if (error >= out.worst - 1e-12) out.worst_places.insert(place);
  for (const auto& [place, g] : given) out.coverage_lost += !machine.contains(place);
  for (const auto& [place, seen] : visible)
    out.discard_differs += machine.contains(place) != (seen && in_interval(truth.at(place)));
  for (const auto& [place, t] : truth)
    if (in_interval(t) && given.contains(place) && !unmeasured.contains(std::get<0>(place)))
      add(out.snapping, t, given.at(place));
  return out;
}

void expect_summary(const ErrorSummary& got, std::vector<double> errors, double condition, const std::string& what) {
  SCOPED_TRACE(what);
  ASSERT_EQ(got.count, errors.size());
  if (errors.empty()) return;
  std::sort(errors.begin(), errors.end());
  long double sum = 0, squares = 0;
  for (const double e : errors) sum += e, squares += static_cast<long double>(e) * e;
  const auto n = static_cast<long double>(errors.size());
  // The evaluator's truth is rounded to double before the quotients; the reference's afterwards.
  const double rounding = 1e-15 * condition + 1e-11 * errors.back();
  EXPECT_NEAR(got.max, errors.back(), rounding);
  EXPECT_NEAR(got.mean, static_cast<double>(sum / n), rounding);
  EXPECT_NEAR(got.rms, static_cast<double>(std::sqrt(squares / n)), rounding);
  const auto rank = static_cast<std::size_t>(std::ceil(0.999 * static_cast<double>(errors.size())));
  const double p999 = errors[rank - 1];
  EXPECT_GE(got.p999, p999 - rounding);
  EXPECT_LE(got.p999, std::min(p999 * (1 + 1.0 / 16), errors.back()) + rounding);
}

void expect_slow(const PointResult& got, const Slow& want) {
  ASSERT_EQ(got.refused, "");
  EXPECT_EQ(got.fragments, want.fragments);
  EXPECT_EQ(got.coverage_gained, want.coverage_gained);
  EXPECT_EQ(got.coverage_lost, want.coverage_lost);
  EXPECT_EQ(got.discard_differs, want.discard_differs);
  EXPECT_EQ(got.saturated, want.saturated);
  EXPECT_EQ(got.quads, want.quads.size());
  EXPECT_EQ(got.plane_quads, want.plane_quads.size());
  EXPECT_EQ(got.plane_fragments, want.plane_fragments);
  EXPECT_NEAR(static_cast<double>(got.colour_codes), static_cast<double>(want.colour_codes),
              static_cast<double>(want.colour_ties));
  for (std::size_t q = 0; q < 4; ++q) {
    const std::string name(outputs[q].column);
    const double condition = static_cast<Output>(q) == Output::depth ? want.z_condition : 1;
    expect_summary(got.arithmetic[q], want.arithmetic[q], condition, "arithmetic " + name);
    expect_summary(got.snapping[q], want.snapping[q], condition, "snapping " + name);
  }
  ASSERT_EQ(got.worst.any, want.worst >= 0);
  if (!got.worst.any) return;
  EXPECT_NEAR(got.worst.error, want.worst, 1e-13 + 1e-11 * want.worst);
  EXPECT_TRUE(want.worst_places.contains(Place{got.worst.index, got.worst.y, got.worst.x}));
}

struct Variant {
  const char* name;
  Config config;
  void (*draw)(DrawState&) = [](DrawState&) {};
};

std::vector<Variant> variants() {
  return {
      {"default", Config{}},
      {"S 8", config({{"significand_bits", 8}})},
      {"S 12, no notch flag", config({{"significand_bits", 12}, {"notch_exact", 0}})},
      {"S 26, G 5", config({{"significand_bits", 26}, {"align_guard_bits", 5}, {"depth_bits", 30}})},
      {"quadratic 12", config({{"quadratic_frac_bits", 12}, {"significand_bits", 14}})},
      {"quadratic 2, small tiles", config({{"quadratic_frac_bits", 2}, {"tile_log2", 2}})},
      {"degree 1", config({{"sqrt_degree", 1}, {"recip_degree", 1}, {"significand_bits", 16}})},
      {"coarse", config({{"subpixel_bits", 4}, {"homogeneous_frac_bits", 5}, {"tile_log2", 4}})},
      {"few outputs", config({{"attribute_int_bits", 1}, {"attribute_frac_bits", 18}, {"depth_bits", 8}})},
      {"no perspective", Config{}, [](DrawState& s) { s.perspective = false; }},
      {"no depth", config({{"significand_bits", 10}}), [](DrawState& s) { s.depth = false; }},
      {"cull back", config({{"quadratic_frac_bits", 6}}), [](DrawState& s) { s.cull = Cull::back; }},
      {"scissor", config({{"significand_bits", 20}}),
       [](DrawState& s) {
         s.scissor_x0 = 5, s.scissor_y0 = 11, s.scissor_x1 = 33;
         s.znear = 0.3, s.zfar = 0.6;
       }},
  };
}

class Families : public testing::TestWithParam<int> {};

TEST_P(Families, StatisticsAreThoseOfTheSlowPath) {
  const auto& info = golden::stress_families()[static_cast<std::size_t>(GetParam())];
  std::uint64_t fragments = 0;
  for (const Variant& v : variants()) {
    SCOPED_TRACE(std::string(info.name) + ", " + v.name);
    SweepInput input = stress_input(info.family);
    v.draw(input.state);
    Evaluator evaluator(input, {.threads = 2, .cycles = false});
    const PointResult got = evaluator.evaluate(v.config);
    expect_slow(got, slow_path(input, v.config));
    if (HasFailure()) return;
    fragments += got.fragments;
  }
  EXPECT_GT(fragments, 100u) << info.name << " draws too little to test anything";
}
INSTANTIATE_TEST_SUITE_P(EveryFamily, Families, testing::Range(0, static_cast<int>(golden::stress_families().size())),
                         [](const auto& p) {
                           return std::string(golden::stress_families()[static_cast<std::size_t>(p.param)].name);
                         });

/// Quads on a lattice of pixel centres, w of either sign and no round numbers, that cover pixels of every singular
/// class, in front of the eye and not.
SweepInput singular_input(std::map<std::pair<int, bool>, int>& classes) {
  SweepInput input = stress_input(golden::StressFamily::general, 0);
  golden::Prng rng(5);
  for (int n = 0; n < 40000 && input.quads.size() < 60; ++n) {
    WindowQuad quad;
    quad.id = static_cast<std::uint32_t>(input.quads.size());
    const bool hull = rng.chance(0.7);
    for (std::size_t i = 0; i < 4; ++i) {
      const double w = rng.uniform(0.3, 3) * (hull && rng.chance(0.5) ? -1 : 1);
      quad.vertex[i] = {(4 * static_cast<double>(rng.below(3)) + 4.5) * w,
                        (4 * static_cast<double>(rng.below(3)) + 4.5) * w, 0.5 * w, w};
      for (int j = 0; j < input.attributes; ++j) quad.attribute[i].push_back(rng.uniform(-1, 1));
    }
    const golden::TruthQuad exact(snap_quad(quad, Config{}, input.state), Config{}, input.state);
    bool wanted = false;
    for (int y = 4; y <= 12; y += 2)
      for (int x = 4; x <= 12; x += 2) {
        if (!exact.cover(x, y).covered) continue;
        const golden::ReferenceSample s = exact.sample(x, y);
        const int flags = s.flags & (flag_on_vertex | flag_two_corner | flag_two_edge);
        if (flags != 0 && ++classes[{flags, s.visible}] <= 8) wanted = true;
      }
    if (wanted) input.quads.push_back(quad);
  }
  return input;
}

TEST(Evaluator, SingularPixelsFollowTheNumbersAtThePort) {
  std::map<std::pair<int, bool>, int> classes;
  SweepInput input = singular_input(classes);
  EXPECT_GE(classes.size(), 5u);  // two corners of one pixel are on one side of the eye
  for (const auto& [key, count] : classes) EXPECT_GE(count, 4) << key.first << " visible " << key.second;
  for (const bool perspective : {true, false}) {
    input.state.perspective = perspective;
    // One evaluator: what it keeps from a setting must not reach the next.
    Evaluator evaluator(input, {.cycles = false});
    for (const auto& [s, g] : {std::pair{8, 0}, {8, 6}, {26, 2}, {14, 2}}) {
      SCOPED_TRACE("S " + std::to_string(s) + ", G " + std::to_string(g));
      const Config c = config({{"significand_bits", s}, {"align_guard_bits", g}, {"notch_exact", s == 14}});
      expect_slow(evaluator.evaluate(c), slow_path(input, c));
    }
  }
}

/// Every member as text, doubles in full.
std::string text(const PointResult& r) {
  std::string out = r.refused;
  const auto put = [&](double v) {
    char digits[40];
    std::snprintf(digits, sizeof digits, " %a", v);
    out += digits;
  };
  const auto count = [&](std::uint64_t v) { out += " " + std::to_string(v); };
  for (const auto* list : {&r.snapping, &r.arithmetic})
    for (const ErrorSummary& s : *list) {
      count(s.count);
      for (const double v : {s.max, s.p999, s.rms, s.mean}) put(v);
    }
  for (const std::uint64_t v : {r.fragments, r.coverage_gained, r.coverage_lost, r.discard_differs, r.colour_codes,
                                r.saturated, r.cycles, r.quads, r.plane_quads, r.plane_fragments})
    count(v);
  out += r.worst.any ? " worst" : " none";
  count(r.worst.index);
  count(static_cast<std::uint64_t>(r.worst.x));
  count(static_cast<std::uint64_t>(r.worst.y));
  put(r.worst.error);
  put(r.attribute_spread);
  put(r.depth_spread);
  return out;
}

/// Parallelograms with values constant along two sides; of every second one a value is bent.
SweepInput plane_input(std::uint64_t seed = 11) {
  SweepInput input = stress_input(golden::StressFamily::general, 0, 3);
  input.state.skip |= skip_plane;
  golden::Prng rng(seed);
  for (std::uint32_t id = 0; id < 30; ++id) {
    WindowQuad quad;
    quad.id = id;
    const double x = rng.uniform(0, size / 2.0), y = rng.uniform(0, size / 2.0), lean = std::floor(rng.uniform(-4, 5));
    const double width = std::floor(rng.uniform(3, 12)), height = std::floor(rng.uniform(3, 12));
    quad.vertex = {{{x, y, 0.45, 1},
                    {x + width, y, 0.45, 1},
                    {x + width + lean, y + height, 0.55, 1},
                    {x + lean, y + height, 0.55, 1}}};
    for (std::size_t j = 0; j < 3; ++j) {
      const double low = rng.uniform(-1, 1), high = rng.uniform(-1, 1);
      const std::array<double, 4> along = j == 1 ? std::array{low, high, high, low} : std::array{low, low, high, high};
      for (std::size_t i = 0; i < 4; ++i) quad.attribute[i].push_back(along[i]);
    }
    if (id % 2 != 0) quad.attribute[2][rng.below(3)] += 0.25;
    input.quads.push_back(quad);
  }
  return input;
}

TEST(Evaluator, PlaneQuadsAreThoseOfTheSlowPath) {
  for (const bool perspective : {true, false}) {
    SweepInput input = plane_input();
    input.state.perspective = perspective;
    // One evaluator: both share what is before them.
    Evaluator evaluator(input, {.threads = 2, .cycles = false});
    for (const auto& [s, g] : {std::pair{18, 2}, {12, 0}, {26, 3}})
      for (const int on : {0, 1}) {
        SCOPED_TRACE("S " + std::to_string(s) + (on != 0 ? ", plane quads" : "") +
                     (perspective ? ", perspective" : ""));
        const Config c = config({{"significand_bits", s}, {"align_guard_bits", g}, {"plane_quads", on}});
        const PointResult got = evaluator.evaluate(c);
        expect_slow(got, slow_path(input, c));
        EXPECT_EQ(got.plane_quads, on != 0 ? 15u : 0u);
        // Within the bound of mean values; attributes of this input are below 2.
        EXPECT_LE(got.arithmetic[static_cast<std::size_t>(Output::attribute)].max, bound_attribute(c, 2).value);
      }
  }
  // The draw may refuse.
  SweepInput input = plane_input();
  input.state.skip &= ~std::uint32_t{skip_plane};
  const Config c = config({{"plane_quads", 1}});
  expect_slow(Evaluator(input, {.cycles = false}).evaluate(c), slow_path(input, c));
  // Interval and scissor, and what a stress family has of it.
  input.state.skip |= skip_plane;
  input.state.znear = 0.47, input.state.zfar = 0.53, input.state.scissor_x0 = 15;
  expect_slow(Evaluator(input, {.cycles = false}).evaluate(c), slow_path(input, c));
  for (const auto family : {golden::StressFamily::on_vertex, golden::StressFamily::coplanar}) {
    SweepInput stress = stress_input(family);
    stress.state.skip |= skip_plane;
    expect_slow(Evaluator(stress, {.cycles = false}).evaluate(c), slow_path(stress, c));
  }
}

/// One fragment at a time, with a scissor of its pixel, the evaluator's largest errors are that fragment's.
TEST(Evaluator, AFragmentOfAPlaneQuadIsTheModels) {
  const SweepInput all = plane_input(12);
  std::size_t taken_fragments = 0, other_fragments = 0;
  const Config c = config({{"plane_quads", 1}});
  Config wide = c;
  wide.attribute_slots = 8;
  for (std::size_t q = 0; q < all.quads.size(); ++q) {
    SweepInput one = all;
    one.quads = {all.quads[q]};
    DrawState state = one.state;
    state.attributes = one.attributes;
    const SnappedQuad snapped = snap_quad(one.quads[0], wide, state);
    const golden::TruthQuad truth(snapped, wide, state);
    const bool taken = plane_quad(snapped, wide, state);
    std::vector<Fragment> fragments;
    UntimedModel model(wide, state, PixelEngine::plain);
    model.draw(snapped,
               [&](std::span<const Fragment> list) { fragments.insert(fragments.end(), list.begin(), list.end()); });
    for (std::size_t n = 0; n < fragments.size(); ++n) {
      const Fragment& f = fragments[n];
      const golden::ReferenceSample s = truth.sample(f.x, f.y);
      double attribute = 0;
      for (std::size_t j = 0; j < 3; ++j)
        attribute = std::max(attribute, std::fabs(std::ldexp(static_cast<double>(f.attribute[j]), -c.attribute_frac()) -
                                                  s.attribute[j]));
      one.state.scissor_x0 = f.x, one.state.scissor_x1 = f.x + 1;
      one.state.scissor_y0 = f.y, one.state.scissor_y1 = f.y + 1;
      const PointResult got = Evaluator(one, {.cycles = false}).evaluate(c);
      ASSERT_EQ(got.fragments, 1u);
      ASSERT_EQ(got.plane_fragments, taken ? 1u : 0u);
      // A unit in the last place of either format is 9e-7 and 6e-8.
      ASSERT_NEAR(got.arithmetic[static_cast<std::size_t>(Output::attribute)].max, attribute, 1e-13);
      ASSERT_NEAR(got.arithmetic[static_cast<std::size_t>(Output::depth)].max,
                  std::fabs(std::ldexp(f.depth, -c.depth_bits) - s.z), 1e-13);
      (taken ? taken_fragments : other_fragments)++;
    }
  }
  EXPECT_GT(taken_fragments, 500u);
  EXPECT_GT(other_fragments, 500u);
}

TEST(Evaluator, OfEqualErrorsTheFirstIsTheWorst) {
  SweepInput input = stress_input(golden::StressFamily::general, 1);
  const PointResult alone = Evaluator(input, {.cycles = false}).evaluate(Config{});
  input.quads.resize(30, input.quads[0]);
  for (int n = 0; n < 10; ++n) {
    const PointResult r = Evaluator(input, {.threads = 3, .cycles = false}).evaluate(Config{});
    ASSERT_EQ(r.fragments, 30 * alone.fragments);
    ASSERT_EQ(std::tuple(r.worst.index, r.worst.x, r.worst.y, r.worst.error),
              std::tuple(0u, alone.worst.x, alone.worst.y, alone.worst.error));
  }
  // Whichever thread had it.
  const WorstPixel early{true, 3, 9, 5, 0.25}, late{true, 3, 8, 6, 0.25};
  for (const bool swap : {false, true}) {
    DrawTotals a, b;
    (swap ? b : a).worst = early;
    (swap ? a : b).worst = late;
    a.merge(b);
    EXPECT_EQ(a.worst.y, 5);
  }
}

struct Outcome {
  std::vector<std::string> results;  ///< in the order of the points
  std::vector<std::vector<std::size_t>> batches;
  StageCounters executed;
};

Outcome run(Evaluator& evaluator, const std::vector<Config>& points) {
  Outcome out;
  out.results.resize(points.size(), "not delivered");
  evaluator.evaluate(points, [&](const Batch& b) {
    ASSERT_EQ(b.points.size(), b.results.size());
    out.batches.push_back(b.points);
    out.executed += b.executed;
    for (std::size_t n = 0; n < b.points.size(); ++n) {
      EXPECT_EQ(out.results[b.points[n]], "not delivered");
      out.results[b.points[n]] = text(b.results[n]);
    }
  });
  return out;
}

/// Some quads of several families, several hundred pixels of every kind.
SweepInput mixed_input() {
  SweepInput input = stress_input(golden::StressFamily::general);
  for (const auto family : {golden::StressFamily::on_vertex, golden::StressFamily::eye_in_hull,
                            golden::StressFamily::reflex, golden::StressFamily::coincident})
    for (const WindowQuad& q : stress_input(family).quads) input.quads.push_back(q);
  return input;
}

std::vector<Config> mixed_points() {
  std::vector<Config> points;
  for (const int output : {20, 26})
    for (const int s : {18, 12, 9})
      for (const int quadratic : {-1, 8})
        for (const int recip : {2, 1})
          for (const int g : {2, 0})
            points.push_back(config({{"significand_bits", s},
                                     {"quadratic_frac_bits", quadratic},
                                     {"recip_degree", recip},
                                     {"align_guard_bits", g},
                                     {"attribute_frac_bits", output}}));
  points.push_back(config({{"subpixel_bits", 3}}));
  points.push_back(config({{"tile_log2", 2}}));
  points.push_back(config({{"viewport_bits", 5 + 1}, {"guard_bits", 4}}));
  points.push_back(points[5]);                         // twice
  points.push_back(config({{"stamp_fifo_log2", 1}}));  // other cycles alone
  return points;
}

/// W = 1 is not enough: a vertex in the last half step of the guard band keeps the bits that ordinary ones have not.
TEST(OrdinaryInput, AVertexAtTheEndOfTheGuardBandIsNot) {
  const Config config;
  const double edge = std::ldexp(1.0, config.pos_int()) + 0.5, step = std::ldexp(1.0, -config.subpixel_bits);
  for (const double from_edge : {step / 4, step}) {
    SweepInput input = stress_input(golden::StressFamily::coincident);
    input.quads.resize(1);
    for (WindowVertex& v : input.quads[0].vertex) v = {10, 10, 0, 1};
    ASSERT_TRUE(OrdinaryInput(input)(config));
    input.quads[0].vertex[2].x = edge - from_edge;
    EXPECT_EQ(OrdinaryInput(input)(config), from_edge == step);
  }
}

TEST(Evaluator, ThreadsBatchesAndHistoryDoNotMatter) {
  const SweepInput input = mixed_input();
  const std::vector<Config> points = mixed_points();
  Evaluator one(input, {.threads = 1});
  const Outcome first = run(one, points);
  EXPECT_EQ(std::count(first.results.begin(), first.results.end(), "not delivered"), 0);
  EXPECT_EQ(first.results[5], first.results[points.size() - 2]);
  for (const std::size_t batch_points : {1u, 5u, 1000u}) {
    Evaluator other(input, {.threads = 3, .batch_points = batch_points});
    const Outcome again = run(other, points);
    EXPECT_EQ(first.results, again.results);
    // Batches do not depend on threads; none is larger than asked for, save points that share a leaf.
    Evaluator single(input, {.threads = 1, .batch_points = batch_points});
    EXPECT_EQ(run(single, points).batches, again.batches);
    for (const auto& batch : again.batches) EXPECT_LE(batch.size(), std::max<std::size_t>(batch_points, 3));
    // In another order, after all that, by hand.
    std::vector<Config> reversed(points.rbegin(), points.rend());
    Outcome back = run(other, reversed);
    std::reverse(back.results.begin(), back.results.end());
    EXPECT_EQ(first.results, back.results);
    EXPECT_EQ(text(other.evaluate(points[7])), first.results[7]);
  }
}

TEST(Evaluator, RefusedPointsLeaveTheOthersAlone) {
  SweepInput input = mixed_input();
  input.quads[1].attribute[2][5] = 2.5;  // needs two integer bits
  input.quads[1].id = 77;
  const std::size_t few = input.quads.size();
  while (input.quads.size() <= 256) input.quads.push_back(input.quads[input.quads.size() % few]);
  input.quads.resize(257);
  std::vector<Config> points{config({{"attribute_int_bits", 1}}), Config{}, config({{"quad_id_bits", 8}}),
                             config({{"significand_bits", 10}}), config({{"attribute_int_bits", 2}})};
  Evaluator evaluator(input, {.cycles = false});
  std::vector<PointResult> results(points.size());
  evaluator.evaluate(points, [&](const Batch& b) {
    for (std::size_t n = 0; n < b.points.size(); ++n) results[b.points[n]] = b.results[n];
  });
  EXPECT_NE(results[0].refused.find("quad 77, vertex 2"), std::string::npos) << results[0].refused;
  EXPECT_NE(results[0].refused.find("attribute 5 = 2.5"), std::string::npos) << results[0].refused;
  EXPECT_EQ(results[0].fragments, 0u);
  EXPECT_NE(results[2].refused.find("257 quads"), std::string::npos) << results[2].refused;
  for (const std::size_t good : {1u, 3u, 4u}) {
    EXPECT_EQ(results[good].refused, "");
    EXPECT_GT(results[good].fragments, 0u);
    Evaluator fresh(input, {.cycles = false});
    EXPECT_EQ(text(fresh.evaluate(points[good])), text(results[good]));
  }

  SweepInput wide = stress_input(golden::StressFamily::general);
  wide.state.width = 65;
  Evaluator other(wide, {});
  const PointResult small = other.evaluate(config({{"viewport_bits", 6}, {"tile_log2", 2}}));
  EXPECT_NE(small.refused.find("viewport_bits = 6"), std::string::npos) << small.refused;
  const std::vector<float> map = other.error_map(config({{"viewport_bits", 6}, {"tile_log2", 2}}));
  EXPECT_EQ(map, std::vector<float>(65 * size, -1.0f));
}

TEST(Evaluator, NothingToDraw) {
  for (const bool empty : {true, false}) {
    SweepInput input = stress_input(golden::StressFamily::general);
    if (empty) input.quads.clear();
    for (WindowQuad& q : input.quads)
      for (WindowVertex& v : q.vertex) v.x += 100 * v.w;
    Evaluator evaluator(input, {.threads = 2});
    const PointResult r = evaluator.evaluate(Config{});
    EXPECT_EQ(r.refused, "");
    EXPECT_EQ(r.fragments, 0u);
    EXPECT_EQ(r.arithmetic[0].count, 0u);
    EXPECT_EQ(r.arithmetic[0].max, 0.0);
    EXPECT_FALSE(r.worst.any);
    EXPECT_EQ(r.coverage_lost, 0u);
    EXPECT_EQ(evaluator.error_map(Config{}), std::vector<float>(size * size, -1.0f));
  }
  const SweepInput input = stress_input(golden::StressFamily::general);
  Evaluator evaluator(input, {});
  evaluator.evaluate({}, [](const Batch&) { FAIL() << "a batch of no points"; });
}

std::uint64_t settings(const StageCounters& c, Stage stage) { return c.settings[static_cast<std::size_t>(stage)]; }

TEST(Evaluator, WhatPointsShareIsExecutedOnce) {
  const SweepInput input = mixed_input();
  std::vector<Config> points;
  // Positions vary fastest, and two keys move no error: the order of the list must not matter.
  for (const int notch : {0, 1})
    for (const int slots : {2, 8})
      for (const int depth : {16, 24})
        for (const int quadratic : {10, -1, 30})  // auto is 30
          for (const int subpixel : {6, 8})
            if (quadratic != 30 || subpixel == 8)
              points.push_back(config({{"notch_exact", notch},
                                       {"attribute_slots", slots},
                                       {"depth_bits", depth},
                                       {"quadratic_frac_bits", quadratic},
                                       {"subpixel_bits", subpixel}}));
  Evaluator evaluator(input, {.threads = 2});
  const Outcome r = run(evaluator, points);
  const StageCounters& c = evaluator.counters();
  EXPECT_EQ(c.settings, r.executed.settings);
  EXPECT_EQ(c.fragments, r.executed.fragments);
  // Two positions, of each two quadratic widths and two depths; clocks of each position and depth.
  EXPECT_EQ(c.settings, (std::array<std::uint64_t, stage_count>{1, 2, 8, 4}));
  std::uint64_t covered = 0;  // by the model, drawn or not
  for (const int subpixel : {6, 8})
    for (const WindowQuad& q : input.quads) {
      const Config at = config({{"subpixel_bits", subpixel}});
      UntimedModel model(at, input.state);
      model.draw(snap_quad(q, at, input.state), [](auto) {});
      covered += model.stats().pixels;
    }
  EXPECT_EQ(c.fragments[static_cast<std::size_t>(Stage::snap_truth)], covered);
  EXPECT_EQ(c.fragments[static_cast<std::size_t>(Stage::draw)], 4 * covered);

  // Truth and clocks stay.
  const StageCounters before = evaluator.counters();
  evaluator.evaluate(config({{"significand_bits", 9}}));
  const StageCounters& after = evaluator.counters();
  for (const Stage stage : {Stage::given_truth, Stage::snap_truth, Stage::cycles})
    EXPECT_EQ(settings(after, stage), settings(before, stage));
  EXPECT_EQ(settings(after, Stage::draw), settings(before, Stage::draw) + 1);
}

/// A quad above the size of a part is drawn in bands of rows: it has the errors of other, smaller bands by scissor.
TEST(Evaluator, ALargeQuadInBandsIsItsRows) {
  SweepInput input;
  WindowQuad& quad = input.quads.emplace_back();
  quad.vertex = {{{3, 2, 0.1, 1}, {610, 5, 0.2, 1.25}, {590, 420, 0.4, 1.5}, {8, 401, 0.3, 1}}};
  input.state.width = input.state.scissor_x1 = 620;
  input.state.height = input.state.scissor_y1 = 430;
  const Config c = config({{"significand_bits", 10}, {"viewport_bits", 10}});
  const PointResult whole = Evaluator(input, {.threads = 2, .cycles = false}).evaluate(c);
  const DrawState state = input.state;
  std::uint64_t fragments = 0, codes = 0;
  WorstPixel worst;
  std::array<double, outputs.size()> largest{};
  for (int y = 0; y < state.height; y += 43) {
    input.state.scissor_y0 = y;
    input.state.scissor_y1 = std::min(y + 43, state.height);
    const PointResult part = Evaluator(input, {.cycles = false}).evaluate(c);
    fragments += part.fragments;
    codes += part.colour_codes;
    for (std::size_t q = 0; q < outputs.size(); ++q) largest[q] = std::max(largest[q], part.arithmetic[q].max);
    if (part.worst.any && (!worst.any || part.worst.error > worst.error)) worst = part.worst;
  }
  EXPECT_GT(fragments, 2u << 16) << "more than two parts";
  EXPECT_EQ(whole.fragments, fragments);
  EXPECT_EQ(whole.colour_codes, codes);
  EXPECT_EQ(whole.quads, 1u);
  EXPECT_EQ(std::tuple(whole.worst.error, whole.worst.x, whole.worst.y), std::tuple(worst.error, worst.x, worst.y));
  for (std::size_t q = 0; q < outputs.size(); ++q) EXPECT_EQ(whole.arithmetic[q].max, largest[q]);

  // A plane one is one quad.
  quad.vertex = {{{3, 2, 0.1, 1}, {603, 2, 0.1, 1}, {603, 402, 0.1, 1}, {3, 402, 0.1, 1}}};
  input.state = state;
  input.state.skip |= skip_plane;
  const PointResult plane =
      Evaluator(input, {.threads = 2, .cycles = false}).evaluate(config({{"viewport_bits", 10}, {"plane_quads", 1}}));
  EXPECT_EQ(plane.plane_quads, 1u);
  EXPECT_EQ(plane.plane_fragments, 600u * 400u);
}

TEST(Evaluator, MemoryIsBoundedAndForgettingIsHarmless) {
  const SweepInput input = mixed_input();
  const std::vector<Config> points{config({{"quadratic_frac_bits", 10}}), config({{"quadratic_frac_bits", 20}}),
                                   config({{"subpixel_bits", 5}}), config({{"quadratic_frac_bits", 10}})};
  Evaluator ample(input, {.cycles = false});
  Evaluator tight(input, {.cycles = false, .memory_bytes = 1});
  for (const Config& point : points) EXPECT_EQ(text(ample.evaluate(point)), text(tight.evaluate(point)));
  EXPECT_EQ(settings(ample.counters(), Stage::snap_truth), 2u);
  EXPECT_EQ(settings(tight.counters(), Stage::snap_truth), 3u);
}

TEST(Evaluator, CyclesAreTheClockedModels) {
  const SweepInput input = mixed_input();
  const std::vector<Config> points{
      Config{},
      config({{"significand_bits", 8}, {"align_guard_bits", 0}}),
      config({{"significand_bits", 26}, {"notch_exact", 0}, {"depth_bits", 8}}),
      config({{"quadratic_frac_bits", 4}}),
      config({{"tile_log2", 2}}),
      config({{"stamp_fifo_log2", 1}, {"tile_slots_log2", 1}}),
      config({{"quad_slots_log2", 1}}),
      config({{"dot_units", 4}}),
      config({{"subpixel_bits", 3}}),
  };
  Evaluator evaluator(input, {.threads = 2});
  std::set<std::uint64_t> different;
  for (const Config& c : points) {
    // With all its attributes and widths, unlike the evaluator's own run.
    tb::LockstepOptions options;
    options.config = c;
    options.config.attribute_slots = 8;
    options.state = input.state;
    options.state.attributes = 4;
    std::vector<SnappedQuad> snapped;
    for (const WindowQuad& q : input.quads) snapped.push_back(snap_quad(q, options.config, options.state));
    const std::uint64_t clocks = tb::run_clocked_model_alone(snapped, options).cycles;
    EXPECT_EQ(evaluator.evaluate(c).cycles, clocks);
    different.insert(clocks);
  }
  // Of depth_bits too, though these quads lie within the limits; widths alone move none.
  EXPECT_EQ(settings(evaluator.counters(), Stage::cycles), 7u);

  EXPECT_GE(different.size(), 3u);
  EXPECT_EQ(Evaluator(input, {.cycles = false}).evaluate(Config{}).cycles, 0u);
}

TEST(Evaluator, ErrorMapHoldsTheLargestErrorOfEachPixel) {
  const SweepInput input = mixed_input();
  const Config c = config({{"significand_bits", 11}});
  Evaluator evaluator(input, {.threads = 2});
  const std::vector<float> map = evaluator.error_map(c);
  ASSERT_EQ(map.size(), static_cast<std::size_t>(size * size));
  std::vector<double> want(map.size(), -1);
  for (const auto& [place, error] : slow_path(input, c).lambda_errors) {
    double& at = want[static_cast<std::size_t>(std::get<1>(place) * size + std::get<2>(place))];
    at = std::max(at, error);
  }
  float largest = -1;
  for (std::size_t n = 0; n < map.size(); ++n) {
    ASSERT_NEAR(map[n], want[n], 1e-6) << n;
    largest = std::max(largest, map[n]);
  }
  EXPECT_EQ(largest, static_cast<float>(evaluator.evaluate(c).arithmetic[0].max));
  EXPECT_EQ(std::count(want.begin(), want.end(), -1.0) > 0, true);
}

TEST(Evaluator, EveryStageEndsOnRequest) {
  const SweepInput input = mixed_input();
  const std::vector<Config> points = mixed_points();
  std::atomic<bool> flag = true;
  const Stop stop{&flag};
  EXPECT_THROW(GivenTruth(input, 2, stop), Stopped);
  const GivenTruth given(input, 1);
  EXPECT_THROW(PositionData(input, given, points[0], 2, stop), Stopped);
  const PositionData positions(input, given, points[0], 1);
  EXPECT_THROW(PortQuads(input, given, positions, points[0], 2, stop), Stopped);
  for (const unsigned threads : {1u, 3u}) {
    Evaluator evaluator(input, {.threads = threads, .batch_points = 4, .stop = stop});
    flag = true;
    EXPECT_THROW(evaluator.evaluate(points, [](const Batch&) {}), Stopped);
    EXPECT_THROW(evaluator.error_map(points[0]), Stopped);
    flag = false;
    EXPECT_THROW(evaluator.evaluate(points, [&](const Batch&) { flag = true; }), Stopped);
    flag = false;
    Evaluator fresh(input, {.threads = 1});
    EXPECT_EQ(run(evaluator, points).results, run(fresh, points).results);
  }
}

TEST(Evaluator, AnExceptionOfACallbackPassesThrough) {
  const SweepInput input = mixed_input();
  const std::vector<Config> points = mixed_points();
  for (const unsigned threads : {1u, 3u}) {
    Evaluator evaluator(input, {.threads = threads, .batch_points = 4});
    int batches = 0;
    const auto stop = [&](const Batch&) {
      if (++batches == 2) throw std::runtime_error("enough");
    };
    EXPECT_THROW(evaluator.evaluate(points, stop), std::runtime_error);
    EXPECT_EQ(batches, 2);
    const auto no = [](double) { throw std::runtime_error("enough"); };
    EXPECT_THROW(evaluator.evaluate(
                     points, [](const Batch&) {}, no),
                 std::runtime_error);
    Evaluator fresh(input, {.threads = 1});
    EXPECT_EQ(run(evaluator, points).results, run(fresh, points).results);
    double last = 0;
    evaluator.evaluate(
        points, [](const Batch&) {},
        [&](double part) {
          EXPECT_GE(part, last);
          last = part;
        });
    EXPECT_EQ(last, 1.0);
  }
}

}  // namespace
}  // namespace quadrille::sweep
