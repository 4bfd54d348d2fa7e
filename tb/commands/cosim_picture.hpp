// --out and --png of `quadrille cosim`: the picture of an input's fragments.
#pragma once

#include "tb/commands/cosim_options.hpp"
#include "tb/engines/engine.hpp"
#include "tb/options/input.hpp"
#include "tb/render/frame.hpp"

#include <cstddef>
#include <vector>

namespace quadrille::tb {

class CosimPicture {
 public:
  /// All must outlive it. Reads the texture.
  CosimPicture(const CosimOptions& options, const Config& config, const DrawInput& input, const DrawState& state);

  /// A pass of the input, of which the first `weight_passes` give the weights; then its fragments, in order.
  void begin_pass(const Pass& pass, std::size_t number, std::size_t weight_passes);
  void fragment(const Fragment& fragment);
  void end_pass();
  /// Writes both files, where they are asked for.
  void save();

 private:
  const CosimOptions& options_;
  const Config& config_;
  const DrawInput& input_;
  const DrawState& state_;
  FrameBuffer frame_;
  ShadeSettings shading_;
  const Pass* pass_ = nullptr;
  std::size_t number_ = 0, weight_passes_ = 0;
  /// With several weight passes a picture needs whole samples: they are collected in order first.
  std::vector<EngineSample> samples_;
  std::size_t position_ = 0;  ///< in samples_, of a further pass
};

}  // namespace quadrille::tb
