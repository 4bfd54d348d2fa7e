// An input as the machine takes it in one pass: with as many of its attributes as have a slot.
#pragma once

#include "tb/options/input.hpp"
#include "tb/options/options.hpp"

#include <vector>

namespace quadrille::tb {

struct SnappedInput {
  DrawInput input;
  DrawState state;
  std::vector<SnappedQuad> quads;

  /// Prints the input's remark. Throws UsageError.
  SnappedInput(const InputOptions& options, const CommonOptions& common, const Config& config);
};

}  // namespace quadrille::tb
