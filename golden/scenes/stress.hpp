// Stress families: quads that contain, on purpose, the conditions under which a quad rasterizer goes wrong.
#pragma once

#include "model/port/records.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace quadrille::golden {

enum class StressFamily {
  general,
  perspective,
  any_w,
  near_edge,
  on_edge,
  near_vertex,
  on_vertex,
  sliver,
  collapsed_edge,
  straight_corner,
  reflex,
  bowtie,
  tiny,
  huge,
  eye_crossing,
  eye_in_hull,
  w_zero,
  shared_edge,
  shared_vertex,
  coplanar,
  long_span,
  coincident,
};

struct StressFamilyInfo {
  StressFamily family;
  std::string_view name;
  std::string_view stresses;  ///< what the family holds and what that is hard on
  std::string_view knob;      ///< what the knob scales
};

/// StressFamilyInfo::knob of families in which it changes nothing.
inline constexpr std::string_view no_stress_knob = "nothing";

/// All families in the order of the enumeration.
std::span<const StressFamilyInfo> stress_families();
std::string_view stress_family_name(StressFamily family);
/// Throws std::invalid_argument listing the families for an unknown name.
StressFamily parse_stress_family(std::string_view name);

/// `count` quads of a family for a viewport, id = index. The same arguments give the same bits on every machine, and
/// the geometry does not depend on `attributes`. Slots 0-3 hold the weights (1,0,0,0) (0,1,0,0) …, further ones random
/// values in [−1, 1], the odd ones of them close together and far from 0. Positions and w are finite, zero or of
/// magnitude 2^−80 to 2^80; x̃ = ỹ = w = 0 does not occur. Families of ordinary vertices use depths in [0.1, 0.9]; those
/// with w ≤ 0 use z̃ = a w − b with small b, as a camera does, so that visible pixels lie in [0, 1] unless they are very
/// close to the eye (coplanar: one depth for all corners). Of every fourth quad, but in families whose quads share
/// corners, depths are drawn together to a spread of 2^−1 to 2^−24 of theirs. Families in which chance alone gives few
/// visible pixels (any_w, huge, eye_crossing, eye_in_hull, w_zero) draw until some of 256 probes are visible, 64 times
/// at most. Knob 1 is the standard setting, more or less of it as the table says; it must lie in [2^−6, 2^6]. Throws
/// std::invalid_argument for a knob, size or attribute count out of range.
std::vector<WindowQuad> make_stress(StressFamily family, std::size_t count, std::uint64_t seed, double knob = 1.0,
                                    int width = 512, int height = 512, int attributes = 4);

/// What one quad of a family is drawn from: the random words that its generator takes, in order. With other words it is
/// another quad of the same family.
struct StressDrawing {
  double knob = 1.0;
  std::uint64_t seed = 1;              ///< of the words that are missing
  std::vector<std::uint64_t> words{};  ///< afterwards those that were taken, which make the same quad again
  std::size_t member = 0;              ///< which quad of a group (shared_edge, shared_vertex), modulo its size
};

/// That quad, without attributes, id 0; `drawing.words` are completed. Attempts of the families that look whether a
/// quad is visible are left out of the words, but for the last. Throws as make_stress does.
WindowQuad draw_stress(StressFamily family, StressDrawing& drawing, int width, int height);

/// The quads of make_stress with `attributes` random attributes alone: without the weights, which a draw may measure by
/// itself.
std::vector<WindowQuad> make_stress_without_weights(StressFamily family, std::size_t count, std::uint64_t seed,
                                                    int width, int height, int attributes, double knob = 1.0);

}  // namespace quadrille::golden
