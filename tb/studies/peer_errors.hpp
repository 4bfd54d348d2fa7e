// Errors of the shader's forms in fp32 against the truth.
#pragma once

#include "model/port/config.hpp"
#include "model/port/records.hpp"
#include "tb/studies/shader/quad_shader.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace quadrille::tb {

struct FormErrors {
  double weight = 0, depth = 0;  ///< largest
  std::uint64_t undefined = 0;   ///< pixels that are not finite
  std::uint64_t missing = 0;     ///< pixels that the truth draws and the shader does not
};

struct PeerErrors {
  std::size_t quads = 0;
  std::uint64_t pixels = 0;                             ///< that the truth draws
  double condition = 0;                                 ///< largest K of the determinant form
  std::array<FormErrors, shader_forms.size()> forms{};  ///< of mean value forms
};

/// K = max |n| sum(R |lambda|) / |sum((-1)^i R n)| at a pixel: what the determinant form makes of rounding errors.
double determinant_condition(const SnappedQuad& quad, const Config& config, int x, int y);

class PeerErrorBench {
 public:
  /// In perspective, nothing culled.
  PeerErrorBench(const Config& config, int width, int height);
  /// On the first quads that have `least` pixels, 16 quads at least.
  PeerErrors errors(std::span<const WindowQuad> quads, std::uint64_t least);
  const DrawState& state() const { return state_; }

 private:
  DrawState state_;  ///< its attributes are weights
  Config config_;
  QuadShader shader_;
};

}  // namespace quadrille::tb
