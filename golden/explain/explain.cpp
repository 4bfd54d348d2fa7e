#include "golden/explain/explain.hpp"

#include "golden/explain/coverage.hpp"
#include "golden/explain/stages.hpp"
#include "model/front/quad_reject.hpp"
#include "model/port/draw_state.hpp"
#include "model/port/snap.hpp"

#include <algorithm>
#include <stdexcept>

namespace quadrille::explain {
namespace {

void check(const Config& config, const DrawState& state, int x, int y) {
  config.validate();
  check_draw_state(state, config);
  if (x < 0 || y < 0 || x >= state.width || y >= state.height)
    throw std::invalid_argument("pixel (" + std::to_string(x) + ", " + std::to_string(y) +
                                ") is outside the viewport of " + std::to_string(state.width) + "x" +
                                std::to_string(state.height));
}

std::string place_of(const PixelTrace& p) {
  if (p.two_corner) return "on two corners";
  if (p.on_vertex) return "on a corner";
  if (p.two_edge) return "on two edges";
  if (p.on_edge) return "on an edge";
  return "inside";
}

std::vector<std::string> flag_names(unsigned flags) {
  constexpr std::array names{"on_edge", "on_vertex",   "two_corner", "two_edge",
                             "tie",     "homogeneous", "notch",      "saturated"};
  std::vector<std::string> out;
  for (std::size_t bit = 0; bit < names.size(); ++bit)
    if ((flags >> bit & 1) != 0) out.emplace_back(names[bit]);
  return out;
}

/// `all_stages`: also of a pixel that is not covered, those of the front.
Explanation explain_one(const PipelineContext& context, const SnappedQuad& snapped, const WindowQuad* given, int x,
                        int y, bool all_stages) {
  Explanation out;
  out.quad = snapped.id;
  out.x = x;
  out.y = y;
  const OnePixel machine = one_pixel(snapped, context, x, y);
  const Subject subject{context, snapped, machine, given};
  explain_coverage(subject, out);
  const bool covered = out.covered();
  if (!covered && !all_stages) return out;
  out.stages.push_back(snapping_stage(context, snapped, given));
  for (Stage& stage : front_stages(subject)) out.stages.push_back(std::move(stage));
  if (!covered) return out;
  out.place = place_of(machine.trace);
  out.flags = flag_names(machine.trace.fragment.flags);
  explain_place(subject, out);
  for (Stage& stage : pixel_stages(subject)) out.stages.push_back(std::move(stage));
  return out;
}

/// With a depth test the nearest of what is drawn, by the codes that the depth buffer has, of equal ones the earlier
/// quad; without one the last.
void mark_seen(std::vector<Explanation>& all, const std::vector<std::uint32_t>& depth, bool by_depth) {
  std::size_t best = all.size();
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].outcome == Outcome::drawn && (best == all.size() || !by_depth || depth[i] < depth[best])) best = i;
  if (best < all.size()) all[best].seen = true;
}

}  // namespace

bool Explanation::covered() const {
  return outcome == Outcome::drawn || outcome == Outcome::eye_in_hull || outcome == Outcome::depth_limits;
}

const char* outcome_name(Outcome outcome) {
  constexpr std::array names{"drawn",  "refused", "left out",    "outside",     "behind the eye",
                             "culled", "scissor", "eye in hull", "depth limits"};
  return names[static_cast<std::size_t>(outcome)];
}

std::vector<Explanation> explain(const Config& config, const DrawState& state, std::span<const WindowQuad> quads, int x,
                                 int y) {
  check(config, state, x, y);
  const PipelineContext context(config, state);
  std::vector<Explanation> all;
  std::vector<std::uint32_t> depth;
  for (const WindowQuad& quad : quads) {
    Explanation& one = all.emplace_back();
    depth.push_back(0);
    try {
      one = explain_one(context, snap_quad(quad, config, state), &quad, x, y, quads.size() == 1);
    } catch (const SnapError& error) {
      one.quad = quad.id;
      one.x = x;
      one.y = y;
      one.outcome = Outcome::refused;
      one.why = error.what();
    }
    one.index = all.size() - 1;
    for (const Stage& stage : one.stages)
      for (const Number& number : stage.numbers)
        if (stage.name == "fragment" && number.name == "z")
          depth.back() = static_cast<std::uint32_t>(number.stored.front().value);
  }
  mark_seen(all, depth, state.depth);
  return all;
}

Explanation explain(const Config& config, const DrawState& state, const SnappedQuad& quad, int x, int y) {
  check(config, state, x, y);
  Explanation out = explain_one(PipelineContext(config, state), quad, nullptr, x, y, true);
  out.seen = out.outcome == Outcome::drawn;
  return out;
}

}  // namespace quadrille::explain
