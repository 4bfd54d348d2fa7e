// The lockstep loop against devices that are the model itself with one thing broken: no Verilator needed, and the place
// that the report must name is known.
#include "tb/lockstep/lockstep.hpp"

#include "golden/scenes/random_quads.hpp"
#include "model/clocked.hpp"
#include "model/front/quad_reject.hpp"
#include "model/port/bit_vector.hpp"
#include "model/support/refused_threads.hpp"
#include "tb/lockstep/driven_device.hpp"
#include "tb/lockstep/model_device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>

namespace quadrille::tb {
namespace {

/// With the device in the loop's thread and in one of its own: the same reports.
class Lockstep : public testing::TestWithParam<unsigned> {
 protected:
  Lockstep() {
    options.config.set("significand_bits", 12);
    options.state = small_state(options.config);
    options.stall = 0.2;
    options.gap = 0.2;
    options.threads = GetParam();
    quads = random_quads(options.config, options.state, 5, 40);
  }
  LockstepReport run(ModelDevice::Fault fault) {
    ModelDevice device(options.config, options.state, std::move(fault));
    return run_lockstep(device, quads, options);
  }
  LockstepOptions options;
  std::vector<SnappedQuad> quads;
};

INSTANTIATE_TEST_SUITE_P(Threads, Lockstep, testing::Values(1u, 2u),
                         [](const auto& threads) { return threads.param == 1 ? "one" : "two"; });

TEST_P(Lockstep, AgreesWithItself) {
  std::uint64_t seen = 0;
  ModelDevice device(options.config, options.state);
  const LockstepReport report = run_lockstep(device, quads, options, [&](const Fragment&) { ++seen; });
  EXPECT_TRUE(report.agreed()) << report.first_divergence.value_or("");
  EXPECT_TRUE(report.complete);
  EXPECT_EQ(report.quads, quads.size());
  EXPECT_GT(report.fragments, 500u);
  EXPECT_EQ(report.fragments, seen);
  EXPECT_GE(report.pixels, report.fragments);
  EXPECT_EQ(report.cycles_rtl, report.cycles_model);
  ASSERT_EQ(report.boundaries.size(), probe_count + 1);
  for (const BoundaryCount& count : report.boundaries) EXPECT_GT(count.beats, 0u) << count.name;
  const auto taken = std::ranges::count_if(
      quads, [&](const SnappedQuad& q) { return quad_reject(q, options.config, options.state) == QuadReject::none; });
  EXPECT_LT(static_cast<std::size_t>(taken), quads.size());
  EXPECT_EQ(report.boundaries[0].beats, static_cast<std::uint64_t>(taken));

  const AloneRun alone = run_clocked_model_alone(quads, options);
  EXPECT_EQ(alone.fragment_hash, report.fragment_hash);
  EXPECT_EQ(alone.fragments, report.fragments);
  EXPECT_EQ(alone.cycles, report.cycles_model);
}

TEST_P(Lockstep, FlushesReachBothSides) {
  options.gap = 0.5;  // the beats bound the clocks
  const LockstepReport without = run({});
  options.flush = 0.2;
  options.clear = 0.2;
  const LockstepReport flushed = run({});
  EXPECT_TRUE(flushed.agreed() && flushed.complete) << flushed.first_divergence.value_or("");
  EXPECT_EQ(flushed.quads, quads.size());
  EXPECT_EQ(flushed.fragment_hash, without.fragment_hash);
  EXPECT_GT(flushed.cycles_model, without.cycles_model);
  ModelDevice device(options.config, options.state);
  device.ignores_flush = true;
  EXPECT_FALSE(run_lockstep(device, quads, options).agreed());
}

/// The lanes of the port change when fragments leave, not which, nor their order.
TEST_P(Lockstep, TheSameFragmentsInEveryNumberOfLanes) {
  const LockstepReport one = run({});
  for (const int lanes : {2, 4}) {
    options.config.set("pixels_per_clock", lanes);
    const LockstepReport report = run({});
    EXPECT_TRUE(report.agreed()) << report.first_divergence.value_or("");
    EXPECT_TRUE(report.complete);
    EXPECT_EQ(report.fragments, one.fragments) << lanes;
    EXPECT_EQ(report.fragment_hash, one.fragment_hash) << lanes;
    EXPECT_EQ(report.pixels, one.pixels) << lanes;
    EXPECT_LT(report.cycles_model, one.cycles_model) << lanes;
  }
}

/// Every bit of every lane counts: of its valid, of its payload, of its fragment.
TEST_P(Lockstep, SeesEveryLane) {
  options.config.set("pixels_per_clock", 4);
  const auto expect = [&](const std::string& text, ModelDevice::Fault fault) {
    const LockstepReport report = run(std::move(fault));
    EXPECT_EQ(report.mismatches + report.cycle_mismatches, 1u) << text;
    ASSERT_TRUE(report.first_divergence) << text;
    EXPECT_NE(report.first_divergence->find(text), std::string::npos) << *report.first_divergence;
  };
  constexpr auto first_pixel_boundary = static_cast<std::size_t>(Boundary::diff);
  for (std::size_t lane = 0; lane < 4; ++lane) {
    const std::string name = "lane " + std::to_string(lane);
    for (std::size_t i = first_pixel_boundary; i < probe_count; ++i) {
      const std::string stage = name + ", stage " + boundary_name(static_cast<Boundary>(i));
      expect(stage + ", valid", [=](auto cycle, auto& o) {
        if (cycle == 350) o.sample.probe[i].valid ^= 1u << lane;
      });
      expect(stage + ", field", [=](auto cycle, auto& o) {
        if (cycle > 300 && (o.sample.probe[i].valid >> lane & 1) != 0) o.words[i][lane][0] ^= 1u;
      });
    }
    expect("fragment_mask: expected", [=](auto cycle, auto& o) {
      if (cycle == 400) o.sample.fragment_mask ^= 1u << lane;
    });
    expect(name + ", stage fragment, field", [=](auto cycle, auto& o) {
      if (cycle == 400) o.words[probe_count][lane][0] ^= 1u;
    });
  }
}

TEST_P(Lockstep, NamesTheFieldThatDiffers) {
  // Bit 2 of root[1]'s significand in the stage register, from cycle 300 on.
  std::uint64_t at = 0;
  PixelTrace pixel;
  const RecordField field = boundary_layout(Boundary::sqrt, options.config).field("sig", 1);
  const LockstepReport report = run([&](std::uint64_t cycle, ModelDevice::Outputs& out) {
    if (cycle < 300 || !out.sample.probe[static_cast<std::size_t>(Boundary::sqrt)].valid) return;
    if (at == 0) {
      at = cycle;
      pixel = *out.model.probes.lane[0].sqrt;
    }
    const int bit = field.position + 2;
    out.words[static_cast<std::size_t>(Boundary::sqrt)][0][static_cast<std::size_t>(bit / 32)] ^= std::uint32_t{1}
                                                                                                  << bit % 32;
  });
  EXPECT_EQ(report.mismatches, 1u);
  EXPECT_EQ(report.cycle_mismatches, 0u);
  EXPECT_FALSE(report.complete);
  ASSERT_TRUE(report.first_divergence);
  const std::uint32_t sig = pixel.root[1].sig;
  EXPECT_EQ(*report.first_divergence, "cycle " + std::to_string(at) + ", quad " + std::to_string(pixel.quad) +
                                          ", pixel (" + std::to_string(pixel.x) + ", " + std::to_string(pixel.y) +
                                          "), stage sqrt, field sig[1]: expected " + hex(sig, 12) +
                                          " (model), actual " + hex(sig ^ 4u, 12) + " (RTL); seed 1");
  ASSERT_TRUE(report.first_pixel);
  EXPECT_EQ(report.first_pixel->quad, pixel.quad);
  EXPECT_EQ(report.first_pixel->x, pixel.x);
  EXPECT_EQ(report.first_pixel->y, pixel.y);
}

/// A stamp has a pointer to its tile; tiles of homogeneous quads take several places of the ring.
TEST_P(Lockstep, NamesTheRowOfAStamp) {
  constexpr auto stamp = static_cast<std::size_t>(Boundary::stamp);
  const int log2 = options.config.tile_log2;
  std::vector<std::array<int, 3>> rows;  // quad, x of the tile, y, by the pixels that come of each stamp
  bool homogeneous = false;
  run([&](std::uint64_t, ModelDevice::Outputs& out) {
    const PixelTrace* pixel = out.model.probes.lane[0].diff;
    if (pixel == nullptr) return;
    homogeneous = homogeneous || pixel->homogeneous;
    const std::array<int, 3> row{static_cast<int>(pixel->quad), pixel->x >> log2 << log2, pixel->y};
    if (rows.empty() || rows.back() != row) rows.push_back(row);
  });
  EXPECT_TRUE(homogeneous);
  ASSERT_GT(rows.size(), 200u);
  for (std::size_t wanted = 0; wanted < rows.size(); wanted += 37) {
    std::size_t stamps = 0;
    const LockstepReport report = run([&](std::uint64_t, ModelDevice::Outputs& out) {
      const StampEntry* at = out.model.probes.stamp;
      if (at != nullptr && !at->end && stamps++ == wanted) out.words[stamp][0][0] ^= 1u;
    });
    const auto [quad, x, y] = rows[wanted];
    const std::string place =
        "quad " + std::to_string(quad) + ", row at (" + std::to_string(x) + ", " + std::to_string(y) + "), stage stamp";
    ASSERT_TRUE(report.first_divergence);
    EXPECT_NE(report.first_divergence->find(place), std::string::npos) << *report.first_divergence << "\n" << place;
    EXPECT_FALSE(report.first_pixel);
  }
}

TEST_P(Lockstep, EveryPerformanceCounterIsCompared) {
  for (std::size_t i = 0; i <= counter_count; ++i) {
    for (const int there : {0, 1}) {
      options.config.set("performance_counters", there);
      ModelDevice device(options.config, options.state);
      device.wrong_counter = i;
      const LockstepReport report = run_lockstep(device, quads, options);
      EXPECT_EQ(report.mismatches, there == 1 && i < counter_count ? 1u : 0u) << i;
      EXPECT_EQ(report.counters[PerformanceCounter::clocks], report.cycles_model);
      EXPECT_EQ(report.counters[PerformanceCounter::fragments], report.fragments);
      if (report.mismatches == 0) continue;
      const std::string name = "performance counter " + std::string(counter_info[i].name) + ": expected ";
      EXPECT_NE(report.first_divergence->find(name), std::string::npos) << *report.first_divergence;
    }
  }
}

TEST_P(Lockstep, CountsOnWhenAsked) {
  options.stop_at_first = false;
  const LockstepReport report = run([&](std::uint64_t cycle, ModelDevice::Outputs& out) {
    if (out.sample.fragment_valid && cycle % 7 == 0) out.words[probe_count][0][0] ^= 1u;
  });
  EXPECT_GT(report.mismatches, 10u);
  EXPECT_EQ(report.cycle_mismatches, 0u);
  EXPECT_TRUE(report.complete);
  options.limit_differences = 3;
  EXPECT_EQ(run([&](std::uint64_t, ModelDevice::Outputs& out) { out.sample.busy = !out.sample.busy; }).cycle_mismatches,
            3u);
}

TEST_P(Lockstep, SeesTimingOfEverySignal) {
  const auto expect_timing = [&](const char* name, ModelDevice::Fault fault) {
    const LockstepReport report = run(std::move(fault));
    EXPECT_EQ(report.cycle_mismatches, 1u) << name;
    ASSERT_TRUE(report.first_divergence) << name;
    EXPECT_NE(report.first_divergence->find(name), std::string::npos) << *report.first_divergence;
  };
  expect_timing("vertex_ready: expected", [](auto cycle, auto& o) {
    if (cycle == 50) o.sample.vertex_ready = !o.sample.vertex_ready;
  });
  expect_timing("busy: expected", [](auto cycle, auto& o) {
    if (cycle == 50) o.sample.busy = !o.sample.busy;
  });
  expect_timing("fragment_mask: expected", [](auto cycle, auto& o) {
    if (cycle == 400) o.sample.fragment_mask ^= 1u;
  });
  expect_timing("fragment_valid: expected", [](auto cycle, auto& o) {
    if (cycle == 400) o.sample.fragment_valid = !o.sample.fragment_valid;
  });
  for (std::size_t i = 0; i < probe_count; ++i) {
    const std::string name = std::string("stage ") + boundary_name(static_cast<Boundary>(i)) + ", valid";
    expect_timing(name.c_str(), [i](auto cycle, auto& o) {
      if (cycle == 350) o.sample.probe[i].valid ^= 1u;
    });
  }
}

TEST_P(Lockstep, FragmentBitsCountWhenNotValidToo) {
  const LockstepReport report = run([&](std::uint64_t, ModelDevice::Outputs& out) {
    if (!out.sample.fragment_valid) out.words[probe_count][0][1] ^= 0x10u;
  });
  EXPECT_EQ(report.mismatches, 1u);
  EXPECT_EQ(report.cycle_mismatches, 0u);
}

/// A run that fails fails alike with its waits listed in the place of the chances, and the list says all: the same at
/// both numbers of threads.
TEST_P(Lockstep, ListedWaitsRepeatARun) {
  // Stalled three clocks in a row with a fragment waiting, the device gives another one.
  const auto fault = [stalls = std::uint64_t{0}](std::uint64_t, ModelDevice::Outputs& out) mutable {
    stalls = out.sample.fragment_valid && !out.ready ? stalls + 1 : 0;
    if (stalls == 3) out.words[probe_count][0][0] ^= 1;
  };
  const LockstepReport drawn = run(fault);
  ASSERT_TRUE(drawn.first_divergence);
  LockstepOptions listed = options;
  listed.stall = listed.gap = 0;
  listed.waits = recorded_waits(quads, options, drawn.cycles_rtl, 4 * drawn.quads + 4);
  ModelDevice device(listed.config, listed.state, fault);
  const LockstepReport again = run_lockstep(device, quads, listed);
  EXPECT_EQ(again.first_divergence, drawn.first_divergence);
  EXPECT_EQ(again.fragment_hash, drawn.fragment_hash);
  EXPECT_EQ(again.cycles_rtl, drawn.cycles_rtl);
  EXPECT_EQ(again.compared_bits, drawn.compared_bits);

  // Without the last of its stalls it goes on.
  listed.waits.stall_clocks.pop_back();
  ModelDevice other(listed.config, listed.state, fault);
  EXPECT_GT(run_lockstep(other, quads, listed).cycles_rtl, drawn.cycles_rtl);
}

TEST_P(Lockstep, StoppedDeviceIsAMismatch) {
  const LockstepReport report = run([](std::uint64_t cycle, ModelDevice::Outputs&) {
    if (cycle == 77) throw DeviceError("assertion at x.sv:1");
  });
  EXPECT_EQ(report.mismatches, 1u);
  ASSERT_TRUE(report.first_divergence);
  EXPECT_EQ(*report.first_divergence, "cycle 77, the RTL stopped: assertion at x.sv:1; seed 1");
}

/// What the edge of a clock throws belongs to that clock: at the ends of DeviceAhead's batches of 256 too, and in the
/// first clock, whose reset it may be.
TEST_P(Lockstep, DeviceStoppedByAnEdge) {
  for (const std::uint64_t at : {0u, 1u, 254u, 255u, 256u, 511u, 512u}) {
    ModelDevice device(options.config, options.state);
    device.stops_at_edge = at;
    const LockstepReport report = run_lockstep(device, quads, options);
    EXPECT_EQ(report.mismatches, 1u);
    ASSERT_TRUE(report.first_divergence);
    EXPECT_EQ(*report.first_divergence, "cycle " + std::to_string(at) + ", the RTL stopped: at its edge; seed 1");
  }
}

/// A difference long after the first batches, with more clocks of the device behind it than are kept.
TEST_P(Lockstep, LateDifference) {
  const LockstepReport whole = run({});
  ASSERT_GT(whole.cycles_rtl, 3000u);
  const std::uint64_t at = whole.cycles_rtl - 1;
  const LockstepReport report = run([at](std::uint64_t cycle, ModelDevice::Outputs& out) {
    if (cycle >= at) out.sample.busy = !out.sample.busy;
  });
  EXPECT_EQ(report.cycle_mismatches, 1u);
  ASSERT_TRUE(report.first_divergence);
  EXPECT_EQ(report.first_divergence->find("cycle " + std::to_string(at) + ", busy"), 0u) << *report.first_divergence;
  EXPECT_EQ(report.fragment_hash, whole.fragment_hash);
}

/// Where the system refuses the device's thread, both run in one, with the same report.
TEST_P(Lockstep, WithoutAThreadForTheDevice) {
  const LockstepReport whole = run({});
  const ThreadLimit limit(0);
  const LockstepReport report = run({});
  EXPECT_EQ(limit.refused(), options.threads > 1 ? 1 : 0);
  EXPECT_TRUE(report.agreed());
  EXPECT_EQ(report.fragment_hash, whole.fragment_hash);
  EXPECT_EQ(report.cycles_rtl, whole.cycles_rtl);
}

TEST_P(Lockstep, DeviceThatNeverEndsIsGivenUp) {
  options.stop_at_first = false;
  options.limit_differences = 0;
  options.watchdog = 2000;
  const LockstepReport report = run([](std::uint64_t, ModelDevice::Outputs& out) { out.sample.busy = true; });
  EXPECT_FALSE(report.complete);
  EXPECT_GT(report.cycle_mismatches, 0u);
}

TEST_P(Lockstep, WatchdogEndsARunWithoutProgress) {
  options.stall = 0.999;
  options.watchdog = 200;
  EXPECT_THROW(run({}), WatchdogError);
  EXPECT_THROW(run_clocked_model_alone(quads, options), WatchdogError);
}

/// Quads without a fragment walk one after the other, with all vertices in: as many as have a slot.
TEST_P(Lockstep, WatchdogWaitsForAllSilentWalks) {
  options.state = DrawState();
  options.state.width = options.state.height = options.state.scissor_x1 = options.state.scissor_y1 = 512;
  options.state.skip = 0;
  quads.assign(12, quads.front());
  for (SnappedQuad& quad : quads)
    for (SnappedVertex& v : quad.vertex) v.w = -2 << options.config.frac();  // behind the eye
  const AloneRun alone = run_clocked_model_alone(quads, options);
  EXPECT_TRUE(alone.complete);
  EXPECT_EQ(alone.fragments, 0u);
  EXPECT_GT(alone.cycles, 10u * 64 * 64 * 8);  // tiles and rows
}

TEST_P(Lockstep, LimitOfFragments) {
  options.limit_fragments = 100;
  const LockstepReport report = run({});
  EXPECT_EQ(report.fragments, 100u);
  EXPECT_FALSE(report.complete);
  EXPECT_TRUE(report.agreed());
}

TEST_P(Lockstep, NoQuadsNoFragments) {
  quads.clear();
  const LockstepReport report = run({});
  EXPECT_EQ(report.fragments, 0u);
  EXPECT_TRUE(report.complete);
}

}  // namespace
}  // namespace quadrille::tb
