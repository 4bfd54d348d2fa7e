// The records of one pixel are those that the boundaries had, spoiled or not.
#include "tb/lockstep/pixel_watch.hpp"

#include "golden/scenes/random_quads.hpp"
#include "tb/lockstep/lockstep.hpp"
#include "tb/lockstep/model_device.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <span>

namespace quadrille::tb {
namespace {

TEST(PixelWatch, KeepsWhatTheBoundariesHad) {
  for (const int lanes : {1, 4}) {
    LockstepOptions options;
    options.config.set("pixels_per_clock", lanes);
    options.state = small_state(options.config);
    options.stop_at_first = false;
    std::size_t watched = 0;
    for (const SnappedQuad& quad : random_quads(options.config, options.state, 5, 12)) {
      std::optional<PixelTrace> pixel;  // one of those that give a fragment
      ModelDevice sound(options.config, options.state, [&](std::uint64_t, ModelDevice::Outputs& out) {
        for (int lane = 0; lane < lanes; ++lane)
          if (const PixelTrace* t = out.model.probes.lane[lane].diff; t != nullptr && t->drawn) pixel = *t;
      });
      run_lockstep(sound, std::span(&quad, 1), options);
      if (!pixel) continue;
      ++watched;
      constexpr auto weight = static_cast<std::size_t>(Boundary::weight);
      ModelDevice spoiled(options.config, options.state, [&](std::uint64_t, ModelDevice::Outputs& out) {
        for (std::size_t lane = 0; lane < static_cast<std::size_t>(lanes); ++lane)
          if ((out.sample.probe[weight].valid >> lane & 1) != 0) out.words[weight][lane][0] ^= 2u;
      });
      PixelWatch watch(spoiled, options.config, pixel->x, pixel->y);
      run_lockstep(watch, std::span(&quad, 1), options);
      for (const Boundary b :
           {Boundary::diff, Boundary::norm, Boundary::sqrt, Boundary::ratio, Boundary::weight, Boundary::sum}) {
        const Record expected = pack_record(boundary_layout(b, options.config).bits(),
                                            [&](auto& f) { visit(*pixel, b, options.config, f); });
        ASSERT_TRUE(watch.at(b)) << boundary_name(b);
        EXPECT_EQ(*watch.at(b) == expected, b != Boundary::weight) << boundary_name(b);
      }
      const Record fragment = pack_record(boundary_layout(Boundary::fragment, options.config).bits(),
                                          [&](auto& f) { visit(pixel->fragment, options.config, f); });
      EXPECT_EQ(watch.at(Boundary::fragment), fragment);
      ASSERT_TRUE(watch.at(Boundary::setup) && watch.at(Boundary::tile) && watch.at(Boundary::stamp));
      const auto column =
          watch.at(Boundary::tile)->get(boundary_layout(Boundary::tile, options.config).field("tile_x"));
      EXPECT_EQ(static_cast<int>(column), pixel->x >> options.config.tile_log2);
      const auto mask = watch.at(Boundary::stamp)->get(boundary_layout(Boundary::stamp, options.config).field("mask"));
      EXPECT_TRUE(mask >> (pixel->x & (options.config.tile() - 1)) & 1);
    }
    EXPECT_GT(watched, 4u);
  }
}

}  // namespace
}  // namespace quadrille::tb
