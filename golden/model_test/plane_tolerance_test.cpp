// Quads whose values are nearly plane (skip_plane with a tolerance): which are taken, by the reference's deviation; the
// deviation itself, against mean values; what is drawn, against the truth, and by both engines of the model.
#include "model/plane_tolerance.hpp"
#include "golden/reference/plane_deviation.hpp"
#include "golden/reference/port_number.hpp"
#include "golden/reference/truth.hpp"
#include "golden/scenes/nearly_plane.hpp"
#include "model/plane_quad.hpp"
#include "model/snap.hpp"
#include "model/support/prng.hpp"
#include "model/untimed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace quadrille {
namespace {

using golden::Prng;

constexpr int size = 64;
constexpr int slots = 3;

Config machine(int significand_bits, int tolerance_bits) {
  Config c;
  c.set("viewport_bits", 8);
  c.set("significand_bits", significand_bits);
  c.set("plane_tolerance_bits", tolerance_bits);
  c.validate();
  return c;
}

DrawState draw_state(bool perspective) {
  DrawState s;
  s.width = s.height = s.scissor_x1 = s.scissor_y1 = size;
  s.attributes = slots;
  s.perspective = perspective;
  s.skip = skip_default | skip_plane;
  return s;
}

std::vector<Fragment> draw(const Config& c, const DrawState& s, const SnappedQuad& quad,
                           PixelEngine engine = PixelEngine::plain) {
  UntimedModel model(c, s, engine);
  std::vector<Fragment> all;
  model.draw(quad, [&](std::span<const Fragment> f) { all.insert(all.end(), f.begin(), f.end()); });
  return all;
}

/// `bend` is what one value is off at corner 3.
WindowQuad turned_rectangle(Prng& rng, std::uint32_t id, double bend, double tilt) {
  golden::NearlyPlane kind;
  kind.attributes = slots;
  kind.bend = bend;
  kind.tilt = tilt;
  return golden::nearly_plane_quad(rng, id, kind);
}

struct Setting {
  int significand_bits, tolerance_bits;
  bool perspective;
  double tilt;
};

std::vector<Setting> settings() {
  std::vector<Setting> all;
  for (const auto& [s, t] : {std::pair{18, 10}, {18, 4}, {12, 6}, {26, 14}, {18, 1}, {8, 5}, {22, 16}})
    for (const auto& [perspective, tilt] : {std::pair{false, 0.0}, {true, 0.0}, {true, 0.3}})
      all.push_back({s, t, perspective, tilt});
  return all;
}

/// The largest deviation of any kind, of weights too: what areas give against what mean values give, in the reference's
/// arithmetic, at every pixel inside.
void expect_deviation_bounds_the_difference(const SnappedQuad& quad, const Config& c, const DrawState& s,
                                            const golden::PlaneDeviation& deviation, double& closest) {
  const golden::TruthQuad truth(quad, c, s);
  const double unit = std::ldexp(1, -c.frac());
  for (int y = 0; y < size; y += 3) {
    for (int x = 0; x < size; x += 3) {
      const golden::ReferenceSample sample = truth.sample(x, y);
      if (!sample.covered) continue;
      std::array<double, 4> px, py;
      for (std::size_t i = 0; i < 4; ++i) {
        px[i] = quad.vertex[i].x * unit - x;
        py[i] = quad.vertex[i].y * unit - y;
      }
      const auto area = [&](std::size_t i, std::size_t j) { return px[i] * py[j] - py[i] * px[j]; };
      const double all = area(0, 1) + area(1, 2) + area(2, 0);
      const double rest = area(0, 2) + area(2, 3) + area(3, 0);
      // In the triangle whose three areas have its own sign.
      const bool first = area(2, 0) * all >= 0;
      const std::array<double, 4> m = first ? std::array{area(1, 2) / all, area(2, 0) / all, area(0, 1) / all, 0.0}
                                            : std::array{area(2, 3) / rest, 0.0, area(3, 0) / rest, area(0, 2) / rest};
      for (std::size_t j = 0; j < static_cast<std::size_t>(s.attributes); ++j) {
        double num = 0, den = 0;
        for (std::size_t i = 0; i < 4; ++i) {
          num += m[i] * golden::port_value(quad.vertex[i].attribute[j], c.significand_bits);
          den += m[i] * (s.perspective ? golden::port_value(quad.vertex[i].k, c.significand_bits) : 1);
        }
        const double difference = std::fabs(num / den - sample.attribute[j]),
                     bound = deviation.attribute[j] * deviation.attribute_range[j];
        ASSERT_LE(difference, bound + 1e-9) << "quad " << quad.id << " pixel " << x << ", " << y << " slot " << j;
        if (bound > 1e-6) closest = std::max(closest, difference / bound);
      }
    }
  }
}

TEST(PlaneDeviation, BoundsWhatAreasChange) {
  for (const double tilt : {0.0, 0.3}) {
    const Config c = machine(26, 10);
    const DrawState s = draw_state(true);
    Prng rng(7);
    double closest = 0;
    for (std::uint32_t id = 0; id < 200; ++id) {
      const SnappedQuad quad = snap_quad(turned_rectangle(rng, id, rng.uniform(-0.5, 0.5), tilt), c, s);
      const golden::PlaneDeviation deviation = golden::plane_deviation(quad, c, s);
      ASSERT_TRUE(deviation.possible);
      expect_deviation_bounds_the_difference(quad, c, s, deviation, closest);
    }
    EXPECT_GT(closest, 0.1) << "a bound that nothing comes near says little";
    std::printf("tilt %.1f: areas change %.3f of the bound at most\n", tilt, closest);
  }
}

/// Taken quads are within the tolerance by the reference; those far within are taken, in all widths.
TEST(PlaneTolerance, TakesWhatTheReferenceAllows) {
  for (const auto& [bits, t, perspective, tilt] : settings()) {
    const Config c = machine(bits, t);
    const DrawState s = draw_state(perspective);
    Prng rng(static_cast<std::uint64_t>(bits * 100 + t));
    int taken = 0, refused = 0, within = 0;
    for (std::uint32_t id = 0; id < 2000; ++id) {
      const double bend = id % 4 == 0 ? 0 : std::ldexp(rng.uniform(-1, 1), -t + 3 - static_cast<int>(id % 9));
      const SnappedQuad quad = snap_quad(turned_rectangle(rng, id, bend, tilt), c, s);
      const golden::PlaneDeviation deviation = golden::plane_deviation(quad, c, s);
      const bool takes = plane_tolerance(quad, c, s), allowed = golden::plane_allowance(deviation, c, s) != 0;
      ASSERT_TRUE(!takes || allowed) << "quad " << id << " deviates by " << deviation.largest();
      ++(takes ? taken : refused);
      within += allowed;
      // Halves: the range by its power of two, the largest triangle by half the area, truncation of the test.
      if (tilt == 0 && deviation.largest() < std::ldexp(1, -t - 3)) {
        ASSERT_TRUE(takes) << "quad " << id << " deviates by " << deviation.largest();
      }
    }
    std::printf("S = %d, t = %d, perspective %d, tilt %.1f: %d taken, %d within the tolerance, of 2000\n", bits, t,
                perspective, tilt, taken, within);
    EXPECT_GT(refused, 50);
    // In perspective the limit is a sixteenth, and truncation leaves nothing of it where S is not well above t.
    if (tilt == 0 || bits >= t + 10) {
      EXPECT_GT(taken, 50);
    }
  }
}

/// Where truncation takes most: areas of P = t + 6 bits, the largest magnitude a power of two, so that the limit has no
/// other room, and deviations a little beyond it.
TEST(PlaneTolerance, TruncationTakesNothingBeyondTheTolerance) {
  for (const auto& [bits, t] : {std::pair{12, 6}, {18, 12}, {22, 16}}) {
    const Config c = machine(bits, t);
    DrawState s = draw_state(false);
    s.depth = false;
    s.attributes = 1;
    Prng rng(static_cast<std::uint64_t>(bits));
    int beyond = 0;
    for (std::uint32_t id = 0; id < 4000; ++id) {
      WindowQuad q = turned_rectangle(rng, id, 0, 0);
      auto& list = q.attribute;
      std::size_t largest = 0;
      for (std::size_t i = 1; i < 4; ++i)
        if (std::fabs(list[i][0]) > std::fabs(list[largest][0])) largest = i;
      const double scale = 1 / std::fabs(list[largest][0]);
      for (auto& values : list) values[0] *= scale;
      double& bent = list[(largest + 2) % 4][0];
      bent += (bent > 0 ? -1 : 1) * std::ldexp(rng.uniform(0.9, 1.3), -t);
      const SnappedQuad quad = snap_quad(q, c, s);
      const golden::PlaneDeviation deviation = golden::plane_deviation(quad, c, s);
      const bool allowed = golden::plane_allowance(deviation, c, s) != 0;
      ASSERT_TRUE(!plane_tolerance(quad, c, s) || allowed)
          << "S " << bits << ", quad " << id << " deviates by " << deviation.largest() * std::ldexp(1, t)
          << " of the tolerance";
      beyond += !allowed && deviation.largest() < std::ldexp(1.2, -t);
    }
    EXPECT_GT(beyond, 500);
  }
}

TEST(PlaneTolerance, LooksAtEveryValueAndTheShape) {
  const Config c = machine(18, 8);
  const DrawState s = draw_state(true);
  const auto taken = [&](const WindowQuad& q, const DrawState& state) {
    const SnappedQuad quad = snap_quad(q, c, state);
    return plane_tolerance(quad, c, state) && takes_areas(quad, c, state);
  };
  Prng rng(3);
  for (std::uint32_t id = 0; id < 50; ++id) {
    const WindowQuad good = turned_rectangle(rng, id, 0, 0);
    ASSERT_TRUE(taken(good, s)) << id;
    ASSERT_FALSE(plane_quad(snap_quad(good, c, s), c, s)) << "not exactly";
    for (std::size_t i = 0; i < 4; ++i) {
      WindowQuad q = good;
      q.vertex[i].z += 1.0 / 32;
      EXPECT_FALSE(taken(q, s)) << "z of " << i;
      DrawState other = s;
      other.depth = false;
      EXPECT_TRUE(taken(q, other)) << "z of " << i << " is not in use";
      for (std::size_t j = 0; j < slots; ++j) {
        q = good;
        q.attribute[i][j] += 1.0 / 16;
        EXPECT_FALSE(taken(q, s)) << "attribute " << j << " of " << i;
        other = s;
        other.attributes = static_cast<int>(j);
        EXPECT_TRUE(taken(q, other)) << "attribute " << j << " of " << i << " is not in use";
      }
      q = good;  // the same place, another k, and the same depth and attributes there
      q.vertex[i] = {good.vertex[i].x * 1.125, good.vertex[i].y * 1.125, good.vertex[i].z * 1.125, 1.125};
      EXPECT_FALSE(taken(q, s)) << "k of " << i;
      q = good;
      q.vertex[i].w = -1;
      EXPECT_FALSE(taken(q, s)) << "w of " << i;
      // Corner i beyond the other diagonal, values plane as before: a concave quad, of which each corner in turn is the
      // one that turns back.
      q = good;
      const std::size_t opposite = (i + 2) % 4;
      const auto back = [&](double a, double b) { return a + 0.75 * (b - a); };
      q.vertex[i].x = back(good.vertex[i].x, good.vertex[opposite].x);
      q.vertex[i].y = back(good.vertex[i].y, good.vertex[opposite].y);
      q.vertex[i].z = back(good.vertex[i].z, good.vertex[opposite].z);
      for (std::size_t j = 0; j < slots; ++j)
        q.attribute[i][j] = back(good.attribute[i][j], good.attribute[opposite][j]);
      EXPECT_FALSE(taken(q, s)) << "concave at " << i;
      EXPECT_FALSE(golden::plane_deviation(snap_quad(q, c, s), c, s).possible) << "concave at " << i;
      // And with an attribute such that the areas, taken as those of a convex quad, call it plane.
      const auto area = [&](std::size_t l, std::size_t m, std::size_t n) {
        const auto &a = q.vertex[l], &b = q.vertex[m], &d = q.vertex[n];
        return std::fabs((b.x - a.x) * (d.y - a.y) - (b.y - a.y) * (d.x - a.x));
      };
      auto& list = q.attribute;
      for (std::size_t n = 1; n < 4; ++n) list[n][0] = 0.25 * static_cast<double>(n);
      list[0][0] =
          (area(0, 2, 3) * list[1][0] - area(0, 1, 3) * list[2][0] + area(0, 1, 2) * list[3][0]) / area(1, 2, 3);
      const double most = std::max(1.0, std::fabs(list[0][0]));
      for (auto& values : list) values[0] /= most;
      DrawState one = s;
      one.depth = false;
      one.attributes = 1;
      EXPECT_FALSE(taken(q, one)) << "concave at " << i << ", made to look plane";
      q = good;
      std::swap(q.vertex[i], q.vertex[(i + 1) % 4]);
      std::swap(q.attribute[i], q.attribute[(i + 1) % 4]);
      EXPECT_FALSE(taken(q, s)) << "a bow-tie";
    }
    DrawState off = s;
    off.skip &= ~std::uint32_t{skip_plane};
    EXPECT_FALSE(taken(good, off));
    Config exact = c;
    exact.set("plane_tolerance_bits", 31);
    EXPECT_FALSE(plane_tolerance(snap_quad(good, exact, s), exact, s));
  }
}

/// Pixels, facing and flags of the other way; attributes and depth within the machine's bound and the tolerance.
TEST(PlaneTolerance, IsDrawnWithinTheBoundAndTheTolerance) {
  for (const auto& [bits, t, perspective, tilt] : settings()) {
    const Config c = machine(bits, t);
    const DrawState s = draw_state(perspective);
    DrawState without = s;
    without.skip &= ~std::uint32_t{skip_plane};
    Prng rng(static_cast<std::uint64_t>(bits));
    std::uint64_t pixels = 0, taken = 0;
    double worst = 0;
    const double weight_bound = std::ldexp(1, 3 - bits), tolerance = std::ldexp(1, -t);
    for (std::uint32_t id = 0; id < 150; ++id) {
      const double bend = std::ldexp(rng.uniform(-1, 1), -t - static_cast<int>(id % 5));
      const SnappedQuad quad = snap_quad(turned_rectangle(rng, id, bend, tilt), c, s);
      if (!takes_areas(quad, c, s)) continue;
      ++taken;
      const std::vector<Fragment> on = draw(c, s, quad), off = draw(c, without, quad);
      EXPECT_EQ(on, draw(c, s, quad, PixelEngine::lanes)) << "quad " << id;
      ASSERT_EQ(on.size(), off.size()) << "quad " << id;
      const golden::TruthQuad truth(quad, c, s);
      const golden::PlaneDeviation deviation = golden::plane_deviation(quad, c, s);
      for (std::size_t i = 0; i < on.size(); ++i) {
        const Fragment &f = on[i], &g = off[i];
        ASSERT_TRUE(f.x == g.x && f.y == g.y && f.front == g.front && f.flags == g.flags)
            << "quad " << id << " pixel " << f.x << ", " << f.y;
        const golden::ReferenceSample exact = truth.sample(f.x, f.y);
        for (std::size_t j = 0; j < slots; ++j) {
          const double unit = std::ldexp(1, -c.attribute_frac()), range = deviation.attribute_range[j];
          const double error = std::fabs(static_cast<double>(f.attribute[j]) * unit - exact.attribute[j]);
          ASSERT_LE(error, (4 * weight_bound + tolerance) * range + unit) << "quad " << id << " slot " << j;
          worst = std::max(worst, error / range);
        }
        const double unit = std::ldexp(1, -c.depth_bits);
        ASSERT_LE(std::fabs(f.depth * unit - exact.z), (4 * weight_bound + tolerance) * deviation.depth_range + unit)
            << "quad " << id;
      }
      pixels += on.size();
    }
    std::printf("S = %d, t = %d, perspective %d, tilt %.1f: %llu of 150 quads taken, %llu pixels, worst %.3f of 2^-t\n",
                bits, t, perspective, tilt, static_cast<unsigned long long>(taken),
                static_cast<unsigned long long>(pixels), worst / tolerance);
    if (tilt == 0) {
      EXPECT_GT(taken, 20u);
    }
  }
}

}  // namespace
}  // namespace quadrille
