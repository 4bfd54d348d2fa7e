#include "tb/judge/judge.hpp"

#include "golden/reference/port_number.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace quadrille::tb {
namespace {

/// One draw of the machine over `snapped` (ids are positions).
CheckResult judge_pass(std::span<const WindowQuad> given, std::span<const SnappedQuad> snapped, const Config& config,
                       const DrawState& state, const Pass& pass, bool first, PixelEngine engine) {
  FragmentChecker::Settings settings;
  settings.config = config;
  settings.state = state;
  settings.pass = pass;
  settings.first_pass = first;
  settings.snapping = false;
  return check_here(settings, given, snapped, [&](const auto& sink) {
    UntimedModel model(config, state, engine);
    for (const SnappedQuad& quad : snapped)
      model.draw(quad, [&](std::span<const Fragment> fragments) { std::ranges::for_each(fragments, sink); });
    return true;
  });
}

/// Weight 0 as a base of 1 and differences of -k_eff, the others as k_eff at their vertex.
SnappedQuad with_weights(SnappedQuad quad, const Pass& pass, const Config& config, const DrawState& state) {
  quad.base.attribute = {};
  for (std::size_t slot = 0; slot < pass.columns.size(); ++slot)
    if (pass.columns[slot] == 0) quad.base.attribute[slot] = std::int64_t{1} << config.attribute_frac();
  for (std::size_t i = 0; i < 4; ++i) {
    SnappedVertex& v = quad.vertex[i];
    v.attribute = {};
    const PortNumber k =
        state.perspective ? v.k : golden::nearest_port_number(std::ldexp(v.w, -config.frac()), config.significand_bits);
    for (std::size_t slot = 0; i > 0 && slot < pass.columns.size(); ++slot) {
      if (pass.columns[slot] == static_cast<int>(i)) v.attribute[slot] = k;
      if (pass.columns[slot] == 0 && k.sig != 0) v.attribute[slot] = {!k.neg, k.exp, k.sig};
    }
  }
  return quad;
}

}  // namespace

CheckResult judge_untimed(std::span<const WindowQuad> quads, int attributes, const Config& config,
                          const DrawState& draw_state, PixelEngine engine) {
  check_quad_count(quads.size(), config);
  const std::vector<Pass> passes = plan_judged_passes(attributes, config.attribute_slots);
  CheckResult sum;
  for (std::size_t p = 0; p < passes.size(); ++p) {
    DrawState state = draw_state;
    state.attributes = static_cast<int>(passes[p].columns.size());
    const std::vector<SnappedQuad> snapped = snap_pass(quads, passes[p], config, state);
    sum.merge(judge_pass(quads, snapped, config, state, passes[p], p == 0, engine));
  }
  return sum;
}

CheckResult judge_untimed(std::span<const SnappedQuad> quads, const Config& config, const DrawState& draw_state,
                          PixelEngine engine) {
  check_quad_count(quads.size(), config);
  std::vector<WindowQuad> names(quads.size());
  for (std::size_t i = 0; i < quads.size(); ++i) names[i].id = quads[i].id;
  CheckResult sum;
  bool first = true;
  const auto judge = [&](const Pass& pass, const auto& quad_of) {
    DrawState state = draw_state;
    state.attributes = static_cast<int>(pass.columns.size());
    std::vector<SnappedQuad> snapped;
    for (const SnappedQuad& quad : quads) {
      snapped.push_back(quad_of(quad, state));
      snapped.back().id = static_cast<std::uint32_t>(snapped.size() - 1);
    }
    sum.merge(judge_pass(names, snapped, config, state, pass, first, engine));
    first = false;
  };
  for (const Pass& pass : plan_passes(0, true, config))
    judge(pass,
          [&](const SnappedQuad& quad, const DrawState& state) { return with_weights(quad, pass, config, state); });
  if (draw_state.attributes > 0) {
    Pass pass;
    pass.columns.resize(static_cast<std::size_t>(draw_state.attributes));
    std::iota(pass.columns.begin(), pass.columns.end(), 4);
    judge(pass, [](const SnappedQuad& quad, const DrawState&) { return quad; });
  }
  return sum;
}

}  // namespace quadrille::tb
