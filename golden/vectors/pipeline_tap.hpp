// What the stages of the machine really see: stress quads drawn by the model, with a few places of each recorded.
#pragma once

#include "golden/vectors/stage_suite.hpp"

#include <cstdint>
#include <functional>

namespace quadrille::vectors {

/// How many units of realistic stimuli there are a round: the stress families.
std::size_t tap_families();

/// Draws a few quads of one family (unit mod the number of families) and hands `sink` the data of some of their
/// vertices, quads, tiles or pixels, complete up to the fragment. The state of the draw varies with the unit. The same
/// arguments give the same data.
void tap_pipeline(std::size_t unit, std::uint64_t seed, Source source, const Config& config,
                  const StageUnderTest::Sink& sink);

}  // namespace quadrille::vectors
