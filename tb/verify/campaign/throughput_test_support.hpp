// What the tests of throughput share.
#pragma once

#include "model/drive.hpp"
#include "model/port/snap.hpp"
#include "model/support/prng.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace quadrille::campaign {
namespace {

using golden::Prng;

/// From quad to quad: beats and bounding box, or the steps. The pipeline of the dot units is not in it.
/// A homogeneous quad's depend on skip_walk, whether it is asked whether it misses the scissor.
constexpr double setup_clocks = 7, setup_clocks_homogeneous = 20, setup_clocks_homogeneous_walk = 40;
constexpr double setup_clocks_four_units = 6, setup_clocks_homogeneous_four_units = 12,
                 setup_clocks_homogeneous_walk_four_units = 25;
constexpr std::uint64_t most_small_quad_clocks = 8;
/// Of a slot, from a small quad's start until its end leaves the pixel pipeline.
constexpr std::uint64_t most_slot_clocks = 97;
constexpr std::uint64_t most_setup_latency = 18, most_setup_latency_homogeneous = 32,
                        most_setup_latency_homogeneous_walk = 52;
/// What rtl/MEASUREMENTS.md claims to its last digit: clocks are exact, so any loss is one of the
/// machine.
constexpr double turned_squares_per_clock = 0.9985, concave_per_clock = 0.9815;
/// Quads of 6x6 pixels; homogeneous ones of 12x12, whose pixels take three clocks each, with two tiles in flight.
constexpr double small_per_clock = 0.964, small_homogeneous_per_clock = 0.266;
constexpr std::uint64_t most_clocks = 100'000'000;

struct Session {
  std::uint64_t clocks = 0;                    ///< from the first beat until idle
  std::uint64_t fragments = 0;                 ///< accepted at the port
  std::vector<Fragment> stream;                ///< they, in order
  std::vector<std::uint64_t> accepted, taken;  ///< per quad: clock of the fourth beat, clock of the setup probe
};

inline Session run(const std::vector<SnappedQuad>& quads, const Config& config, const DrawState& state) {
  DrivenModel model(config, state);
  SteadyBeats beats(quads);
  Session r;
  r.clocks = drive(model, beats, [&](std::uint64_t cycle, const ClockedOutputs& o, bool taken) {
    o.for_each_fragment([&](const Fragment& f) { r.stream.push_back(f); });
    if (o.probes.setup != nullptr) r.taken.push_back(cycle);
    if (taken && beats.taken() % 4 == 3) r.accepted.push_back(cycle);
    return (!beats.done() || o.busy) && cycle < most_clocks;
  });
  r.fragments = r.stream.size();
  EXPECT_LT(r.clocks, most_clocks) << "the machine does not become idle";
  return r;
}

inline DrawState draw_state() {
  DrawState s;
  s.depth = false;  // every covered pixel becomes a fragment
  return s;
}

inline SnappedQuad snapped(const double (&p)[4][2], std::uint32_t id, const Config& config) {
  WindowQuad q;
  q.id = id;
  for (std::size_t i = 0; i < 4; ++i) q.vertex[i] = {p[i][0], p[i][1], 0.5, 1};
  return snap_quad(q, config, draw_state());
}

inline std::vector<SnappedQuad> turned_squares(int count, const Config& config, std::uint64_t seed) {
  Prng rng(seed);
  std::vector<SnappedQuad> out;
  for (int n = 0; n < count; ++n) {
    const double angle = rng.uniform(0, 2 * std::acos(-1.0)), cx = rng.uniform(30, 480), cy = rng.uniform(30, 480);
    double p[4][2];
    for (int i = 0; i < 4; ++i) {
      p[i][0] = cx + 16 * std::sqrt(2.0) * std::cos(angle + i * std::acos(0.0));
      p[i][1] = cy + 16 * std::sqrt(2.0) * std::sin(angle + i * std::acos(0.0));
    }
    out.push_back(snapped(p, static_cast<std::uint32_t>(n), config));
  }
  return out;
}

/// Convex quads of about `extent` pixels with one vertex that is homogeneous (W < 1) but where the ordinary one would
/// be.
inline std::vector<SnappedQuad> homogeneous_quads(int count, double extent, const Config& config, std::uint64_t seed) {
  Prng rng(seed);
  std::vector<SnappedQuad> out;
  for (int n = 0; n < count; ++n) {
    const double x = rng.uniform(0, 60), y = rng.uniform(0, 60);
    const double p[4][2] = {{x, y}, {x + extent, y}, {x + extent, y + extent}, {x, y + extent}};
    SnappedQuad q = snapped(p, static_cast<std::uint32_t>(n), config);
    q.vertex[2].x /= 2, q.vertex[2].y /= 2, q.vertex[2].w /= 2;
    q.vertex[2].k.exp -= 1;
    out.push_back(q);
  }
  return out;
}

inline double pixels_per_clock(const Session& r) {
  return static_cast<double>(r.fragments) / static_cast<double>(r.clocks);
}

}  // namespace
}  // namespace quadrille::campaign
