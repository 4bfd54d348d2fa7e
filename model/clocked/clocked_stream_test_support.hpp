// The clocked model alone behind a vertex port with gaps and a fragment port with stalls.
#pragma once

#include "model/clocked.hpp"
#include "model/support/prng.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace quadrille {

/// The fragments of all quads in the order in which the port gives them. In a clock with probability `gap` no new beat
/// is offered, with probability `stall` nothing is taken. Fails when the port's rules are broken: valid and payload
/// stay until they are taken.
inline std::vector<Fragment> clocked_stream(const std::vector<SnappedQuad>& quads, const Config& c, const DrawState& s,
                                            std::uint64_t seed, double gap, double stall) {
  golden::Prng rng(seed);
  ClockedModel model(c, s);
  ClockedInputs in;
  in.reset = true;
  model.clock(in);
  in.reset = false;
  std::vector<Fragment> out;
  std::size_t beat = 0;
  bool held = false, offered = false;
  std::vector<Fragment> held_fragments;
  for (std::uint64_t clock = 0; clock < 40'000'000; ++clock) {
    if (beat < 4 * quads.size()) {
      // Valid, once up, stays until accepted.
      in.vertex_valid = offered || !rng.chance(gap);
      in.vertex = in.vertex_valid ? beat_of(quads[beat / 4], beat % 4) : VertexBeat{};
    } else {
      in.vertex_valid = false;
    }
    in.fragment_ready = !rng.chance(stall);
    const ClockedOutputs o = model.comb();
    std::vector<Fragment> offered_fragments;
    o.for_each_fragment([&](const Fragment& f) { offered_fragments.push_back(f); });
    if (held) {
      EXPECT_TRUE(o.fragment_valid) << "valid dropped under stall";
      EXPECT_EQ(offered_fragments, held_fragments) << "payload changed under stall";
    }
    EXPECT_EQ(o.fragment_valid, !offered_fragments.empty());
    held = o.fragment_valid && !in.fragment_ready;
    if (o.fragment_valid && in.fragment_ready)
      out.insert(out.end(), offered_fragments.begin(), offered_fragments.end());
    held_fragments = std::move(offered_fragments);
    offered = in.vertex_valid && !o.vertex_ready;
    if (in.vertex_valid && o.vertex_ready) ++beat;
    if (beat == 4 * quads.size() && !o.busy && !in.vertex_valid) return out;
    model.clock(in);
  }
  ADD_FAILURE() << "the machine does not become idle";
  return out;
}

}  // namespace quadrille
