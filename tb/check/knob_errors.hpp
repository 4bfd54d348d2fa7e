// Errors of several bodies on the same quads, in units of the bound: what `quadrille stress` draws against a knob.
#pragma once

#include "tb/check/check.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::cli {

enum class KnobBody { model, paper_float, fp32, shader, rtl };
/// `float`: the paper's formulas as printed in double precision, `fp32` the same in single precision.
inline constexpr std::array<std::string_view, 5> knob_body_names{"model", "float", "fp32", "shader", "rtl"};

/// One body on some quads, at the pixels that model and truth draw.
struct BodyErrors {
  std::uint64_t fragments = 0;  ///< compared
  std::uint64_t undefined = 0;  ///< a division by zero or a result that is not finite; not compared
  std::uint64_t missing = 0;    ///< not drawn
  /// The largest, as parts of what the bound allows: a weight 2^-(s-3), attributes and depth their tolerances
  /// (judged_quad.hpp) and a unit of the output.
  double weight = 0, attribute = 0, depth = 0;
  Place worst;  ///< of the largest weight error

  void merge(const BodyErrors& other);
};

/// Signed errors of the model's weights at one pixel, in units of the bound.
struct WeightErrors {
  std::uint32_t index;
  std::uint16_t x, y;
  std::array<double, 4> error;
};

struct KnobErrors {
  CheckResult verdict;  ///< of the model (judge.hpp), all its draws
  std::array<BodyErrors, knob_body_names.size()> body;
  std::vector<WeightErrors> weights;  ///< of the model, in its order
  std::string difference;             ///< where the RTL differs from the model first
};

/// Draws the quads with the model and the bodies of `bodies`, each bit a KnobBody. Throws SnapError for a quad that
/// cannot be drawn, and what the engines throw. The configuration must keep all bits of D and R² (else no bound is
/// claimed).
KnobErrors measure_knob(std::span<const WindowQuad> quads, int attributes, const Config& config, const DrawState& state,
                        unsigned bodies);

/// How far errors of the model change from one draw of the same quads to another.
struct ErrorJump {
  std::uint64_t pixels = 0;  ///< of both
  double largest = 0;        ///< of one weight, in units of the bound
};
ErrorJump error_jump(std::span<const WeightErrors> from, std::span<const WeightErrors> to);

}  // namespace quadrille::cli
