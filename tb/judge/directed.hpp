// The directed draws through the untimed model and before the truth: cases in which a fault shows that chance hardly
// draws.
#pragma once

#include "golden/scenes/corner_quads.hpp"
#include "tb/judge/judge.hpp"

#include <vector>

namespace quadrille::tb {

/// The corner quads of golden/scenes, thinned where a group has many of a kind and without those on a large viewport,
/// which are about the walk; and two more groups:
///   at_infinity   every w is 0: sum(M w) is a sum of zeros and nothing of the quad is in front of the eye
///   saturated     attributes beyond the format, of either sign, over all of a quad and over part of one
std::vector<golden::CornerDraw> directed_draws(const Config& config);

/// All of them, every fragment judged (judge.hpp); some 0.2 s. A message begins with the draw's name.
CheckResult judge_directed(const Config& config, PixelEngine engine = PixelEngine::plain);

}  // namespace quadrille::tb
