// Errors of several bodies on the same quads, in units of the bound: what `quadrille stress` draws against a knob.
#pragma once

#include "golden/analysis/allowed_errors.hpp"
#include "golden/scenes/approach.hpp"
#include "tb/engines/engine.hpp"
#include "tb/judge/check.hpp"
#include "tb/judge/pixel_error.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::tb {

/// The bodies of `quadrille stress`, in the order of its report.
inline constexpr std::array knob_engines{EngineKind::model, EngineKind::paper_float, EngineKind::paper_single,
                                         EngineKind::shader, EngineKind::rtl};

/// The largest error of one output, as a part of what ErrorBounds allow.
struct LargestError {
  double part = 0;
  Place place;
};

/// One body on some quads, at the pixels that model and truth draw.
struct BodyErrors {
  std::uint64_t fragments = 0;  ///< compared
  std::uint64_t beyond = 0;     ///< of these, with a weight, attribute or depth beyond the bound
  std::uint64_t undefined = 0;  ///< a division by zero or a result that is not finite; not compared
  std::uint64_t missing = 0;    ///< not drawn
  std::array<LargestError, output_names.size()> largest;
  Place lost;  ///< the first undefined or missing pixel

  const LargestError& of(Output output) const { return largest[static_cast<std::size_t>(output)]; }
  std::uint64_t pixels_lost() const { return undefined + missing; }
  void merge(const BodyErrors& other);
};

/// Signed errors of the model's outputs at every pixel, in units of the bound: the weights, the attributes, depth.
struct PixelSeries {
  struct Pixel {
    std::uint32_t index;
    std::uint16_t x, y;
  };
  std::vector<Pixel> pixels;  ///< by index, y, x
  std::vector<float> errors;  ///< as many for each of them
  bool empty() const { return pixels.empty(); }
};

struct KnobErrors {
  CheckResult verdict;  ///< of the model (judge.hpp), all its draws
  PerEngine<BodyErrors> body;
  PerEngine<BodyErrors> near_case;  ///< of the pixels near the special case alone
  PixelSeries model;
  std::string difference;  ///< where the RTL differs from the model first
};

/// Draws the quads with the model and the bodies of `bodies`, each bit an EngineKind. `places`: of each quad the place
/// of its special case, or none. Throws SnapError for a quad that cannot be drawn, and what the engines throw. The
/// configuration must keep all bits of D and R² (else no bound is claimed).
KnobErrors measure_knob(std::span<const WindowQuad> quads, std::span<const golden::ApproachPlace> places,
                        int attributes, const Config& config, const DrawState& state, unsigned bodies);

/// How far errors of the model change from one draw to another of the same quads, each in units of its own bound.
struct ErrorJump {
  std::uint64_t pixels = 0;  ///< of both
  std::array<double, output_names.size()> largest{};

  void merge(const ErrorJump& other);
};
/// Both with as many attributes.
ErrorJump error_jump(const PixelSeries& from, const PixelSeries& to);

}  // namespace quadrille::tb
