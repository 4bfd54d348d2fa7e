#include "tb/judge/hidden_check.hpp"

#include <algorithm>
#include <cmath>

namespace quadrille::tb {
namespace {

DrawState with_nothing_hidden(DrawState state) {
  state.skip &= ~std::uint32_t{skip_hidden};
  return state;
}

}  // namespace

HiddenCheck::HiddenCheck(const Config& config, const DrawState& state, HiddenDepths* before, bool exact)
    : width_(state.width),
      height_(state.height),
      depth_bits_(config.depth_bits),
      exact_(exact),
      everything_(config, with_nothing_hidden(state)),
      own_(before == nullptr ? state.width : 0, before == nullptr ? state.height : 0),
      depth_(before == nullptr ? own_ : *before) {}

void HiddenCheck::fragment(const Fragment& fragment) { drawn_.push_back(fragment); }

std::optional<HiddenCheck::Fault> HiddenCheck::quad_done(const SnappedQuad& quad) {
  std::optional<Fault> fault;
  auto next = drawn_.begin();
  const auto compare = [&](std::span<const Fragment> fragments) {
    for (const Fragment& f : fragments) {
      if (next != drawn_.end() && next->x == f.x && next->y == f.y) {
        if (!fault && !(*next == f)) fault = Fault{f.x, f.y, "differs from what is drawn with nothing hidden"};
        ++next;
        continue;
      }
      ++left_out_;
      const std::uint32_t nearest = depth_.at(f.x, f.y);
      if (!fault && f.depth < nearest)
        fault = Fault{f.x, f.y,
                      "left out with depth code " + std::to_string(f.depth) + ", but the depth buffer holds " +
                          (nearest == HiddenDepths::nothing ? "nothing" : std::to_string(nearest))};
    }
  };
  if (exact_) everything_.draw(quad, compare);
  if (exact_ && !fault && next != drawn_.end())
    fault = Fault{next->x, next->y, "drawn, but not with nothing hidden, or out of order"};
  for (const Fragment& f : drawn_)
    if (f.x < width_ && f.y < height_) depth_.at(f.x, f.y) = std::min(depth_.at(f.x, f.y), f.depth);
  drawn_.clear();
  return fault;
}

bool HiddenCheck::may_refuse(int x, int y, double z, double tolerance) const {
  // A code is the nearest one.
  return std::ldexp(z + tolerance, depth_bits_) + 0.5 >= depth_.at(x, y);
}

}  // namespace quadrille::tb
