// Searches a stress family for the quad and the pixel at which an output of the model is farthest from the truth.
#pragma once

#include "golden/reference/truth.hpp"
#include "golden/scenes/stress.hpp"
#include "model/port/config.hpp"
#include "model/port/records.hpp"
#include "tb/judge/pixel_error.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace quadrille::tb {

struct FamilySearch {
  golden::StressFamily family = golden::StressFamily::general;
  Output output = Output::weight;
  Config config;
  int width = 64, height = 64;
  std::uint64_t evaluations = 20'000;
  std::uint64_t seed = 1;
  bool leave = false;  ///< climbs move vertices, whatever the family holds (vertex_moves.hpp)
};

/// What a search looks at: a quad of the family and one of its pixels.
struct FamilyCandidate {
  golden::StressDrawing drawing;
  WindowQuad quad;  ///< with one attribute
  golden::PixelPlace at;
};

struct FamilySummit {
  FamilyCandidate candidate;
  double units = -1;  ///< the measure's
};

/// An eighth of the evaluations looks at pixels of quads as the family draws them, its knob anywhere; from the best of
/// them as many climbs, in turn, with the rest. A step changes some of the random words that the family's code draws
/// the quad from (by any power of two of their range, or to others), the knob, the attribute or the pixel: what the
/// family holds, it holds, unless `leave` is set. Returns the climbs' ends, the highest first; none when all
/// evaluations met no drawn pixel. The same for the same arguments.
std::vector<FamilySummit> search_family(const FamilySearch& search,
                                        const std::function<double(const FamilyCandidate&)>& measure);
/// The same by PixelErrors::measure.
std::vector<FamilySummit> search_family(const FamilySearch& search);
/// The worst of these ends by PixelErrors::judge; none when nothing was drawn.
std::optional<FamilySummit> worst_of_family(const FamilySearch& search);

/// The quad as a draw that is about this output wants it: with the weights as attributes, or its own.
WindowQuad quad_for(const WindowQuad& quad, Output output);

/// The draw state of a search: the default one of this size.
DrawState search_state(int width, int height);

}  // namespace quadrille::tb
