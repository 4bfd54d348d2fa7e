// The error of one quad at one pixel: what searches for the largest error climb on, and their verdict.
#pragma once

#include "golden/analysis/judged_quad.hpp"
#include "model/pixel/pixel_pipeline.hpp"
#include "model/port/config.hpp"
#include "model/port/records.hpp"
#include "model/untimed.hpp"
#include "tb/support/outputs.hpp"

#include <array>
#include <optional>
#include <string_view>

namespace quadrille::tb {

/// What the bound allows, in units of 2^-s of weights 1 to 3. Of weight 0, attributes and depth a unit is an eighth of
/// what their bound allows them at the pixel (judged_quad.hpp), and the error begins where the output's rounding ends:
/// 8 is where the judge finds a fault, for values of any spread.
inline constexpr double bound_units = 8;

struct PixelError {
  double units = -1;  ///< −1: nothing is drawn there, or no bound is claimed
  double condition = 0;
  unsigned flags = 0;
};

/// Of one output. For the weights the quads' attributes are (1,0,0,0), (0,1,0,0) …; of attributes slot 0 is looked at.
class PixelErrors {
 public:
  /// As many of the draw state's attributes are in use as the output needs.
  PixelErrors(const Config& config, const DrawState& state, Output output);

  /// The quick measure: the model's pure functions at one pixel against an 80-bit evaluation of the truth's formulas.
  /// −1 where the pixel is not drawn or singular, or no bound is claimed.
  double measure(const WindowQuad& quad, int x, int y) const;

  /// The verdict: the fragment as the untimed model draws it, with either engine, against TruthQuad.
  PixelError judge(const WindowQuad& quad, int x, int y);

 private:
  struct QuickTruth;
  std::optional<QuickTruth> quick_truth(const SnappedQuad& quad, int x, int y) const;
  double units_of(const Fragment& fragment, const SnappedQuad& quad, const QuickTruth& truth) const;
  void judge(UntimedModel& model, const SnappedQuad& quad, const golden::TruthQuad& truth, int x, int y,
             PixelError& error) const;
  double weight(const Fragment& fragment, std::size_t i) const;

  Config config_;
  DrawState state_;
  Output output_;
  PipelineContext context_;
  Bounds bounds_;
  UntimedModel plain_, lanes_;
};

}  // namespace quadrille::tb
