// The instruction set that the lanes' code (model/fast, golden/reference/truth_lanes.hpp) runs on. It is compiled for
// each target; all give the same bits, and the best that the processor has is in use unless another is chosen.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace quadrille {

// The short build with sanitizers has the baseline alone.
#if defined(__x86_64__) && !defined(QUADRILLE_BASELINE_LANES)
#define QUADRILLE_LANE_TARGETS
#endif

/// What the compiler's base ABI has: SSE2, NEON; x86-64-v2: SSE4; x86-64-v3: AVX2; x86-64-v4: AVX-512.
enum class LaneTarget { baseline, v2, v3, v4 };

/// Targets that the code is compiled for, from the plainest on.
std::span<const LaneTarget> lane_targets();
/// "baseline", "v2", "v3", "v4".
std::string_view name(LaneTarget target);
/// Whether the code is compiled for it and this processor can run it.
bool can_run(LaneTarget target);

/// The one in use.
LaneTarget lane_target();
/// Chooses for the whole program; not while another thread draws. Throws std::invalid_argument when the processor
/// cannot run it.
void set_lane_target(LaneTarget target);
/// The same by name; throws std::invalid_argument with the names there are.
void set_lane_target(std::string_view name);

}  // namespace quadrille
