// The RTL's numbers beside the model's, of one pixel of one quad.
#pragma once

#include "golden/explain/explain.hpp"
#include "tb/lockstep/lockstep.hpp"

#include <string>

namespace quadrille::tb {

class ExplainByRtl {
 public:
  /// Builds the simulator of `options` (its state is that of the explanation), or finds it in the cache.
  explicit ExplainByRtl(const LockstepOptions& options);

  /// Draws the quad alone, after a reset, and its weights in passes of their own; sets what compare() sets. False where
  /// the RTL differs from the model, which a remark says where no number shows it.
  bool compare(explain::Explanation& explanation, const WindowQuad& quad) const;

 private:
  LockstepOptions options_;
  Simulator simulator_;
};

}  // namespace quadrille::tb
