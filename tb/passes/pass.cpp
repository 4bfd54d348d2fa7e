#include "tb/passes/pass.hpp"

#include "model/port/snap.hpp"
#include "tb/support/errors.hpp"

#include <algorithm>
#include <string>

namespace quadrille::tb {

std::vector<Pass> plan_passes(int attributes, bool weights, int slots) {
  std::vector<int> columns;
  for (int column = weights ? 0 : 4; column < 4 + attributes; ++column) columns.push_back(column);
  std::vector<Pass> passes;
  const auto width = static_cast<std::size_t>(slots);
  for (std::size_t first = 0; first < columns.size(); first += width) {
    Pass pass;
    for (std::size_t i = first; i < std::min(columns.size(), first + width); ++i) pass.columns.push_back(columns[i]);
    passes.push_back(std::move(pass));
  }
  if (passes.empty()) passes.emplace_back();
  return passes;
}

std::vector<Pass> plan_passes(int attributes, bool weights, const Config& config) {
  return plan_passes(attributes, weights, config.attribute_slots);
}

std::vector<Pass> plan_judged_passes(int attributes, int slots, std::size_t* weight_passes) {
  std::vector<Pass> passes = plan_passes(0, true, slots);
  if (weight_passes != nullptr) *weight_passes = passes.size();
  if (attributes > 0)
    for (Pass& pass : plan_passes(attributes, false, slots)) passes.push_back(std::move(pass));
  return passes;
}

WindowQuad pass_quad(const WindowQuad& quad, const Pass& pass) {
  WindowQuad result;
  result.id = quad.id;
  result.vertex = quad.vertex;
  for (std::size_t v = 0; v < 4; ++v) {
    const std::vector<double>& given = quad.attribute[v];
    for (const int column : pass.columns) {
      const auto c = static_cast<std::size_t>(column);
      double value = 0;
      if (c < 4)
        value = c == v ? 1 : 0;
      else if (c - 4 < given.size())
        value = given[c - 4];
      result.attribute[v].push_back(value);
    }
  }
  return result;
}

bool is_whole(const Pass& pass, const WindowQuad& quad) {
  for (std::size_t i = 0; i < pass.columns.size(); ++i)
    if (pass.columns[i] != 4 + static_cast<int>(i)) return false;
  return std::ranges::all_of(quad.attribute, [&](const auto& a) { return a.size() == pass.columns.size(); });
}

SnappedQuad snap_as(const WindowQuad& quad, std::uint32_t id, const Config& config, const DrawState& state) {
  try {
    if (quad.id == id) return snap_quad(quad, config, state);
    WindowQuad renamed = quad;
    renamed.id = id;
    return snap_quad(renamed, config, state);
  } catch (const SnapError& error) {
    std::string text = error.what();  // "quad N, vertex M: what is wrong"
    if (const std::size_t colon = text.find(": "); colon != std::string::npos) text.erase(0, colon + 2);
    throw SnapError(quad.id, error.vertex, text);
  }
}

std::vector<SnappedQuad> snap_pass(std::span<const WindowQuad> quads, const Pass& pass, const Config& config,
                                   const DrawState& state) {
  std::vector<SnappedQuad> snapped;
  snapped.reserve(quads.size());
  for (std::size_t i = 0; i < quads.size(); ++i)
    snapped.push_back(snap_as(pass_quad(quads[i], pass), static_cast<std::uint32_t>(i), config, state));
  return snapped;
}

void check_quad_count(std::size_t quads, const Config& config) {
  if (config.quad_id_bits < 32 && quads > std::size_t{1} << config.quad_id_bits)
    throw UsageError(std::to_string(quads) + " quads are more than quad_id_bits = " +
                     std::to_string(config.quad_id_bits) + " allows; use --set quad_id_bits=32");
}

DrawState state_of_pass(DrawState state, const Pass& pass, bool first) {
  state.attributes = static_cast<int>(pass.columns.size());
  if (!first && (state.skip & skip_plane) != 0) {
    state.depth = false;
    state.skip &= ~std::uint32_t{skip_hidden};
  }
  return state;
}

Config snapping_config(Config config, int attributes) {
  config.attribute_slots = std::max(config.attribute_slots, attributes);
  return config;
}

}  // namespace quadrille::tb
