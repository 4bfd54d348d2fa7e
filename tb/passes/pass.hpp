// Draws of the machine that together give the weights and every attribute of a quad, whatever its attribute slots.
#pragma once

#include "model/port/config.hpp"
#include "model/port/records.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace quadrille::tb {

/// One draw of the machine: which columns its attribute slots carry. Columns 0-3 are the weights, column 4 + j
/// attribute j.
struct Pass {
  std::vector<int> columns;
};

/// As few passes as `slots` attributes in use allow; without any column one pass with none.
std::vector<Pass> plan_passes(int attributes, bool weights, int slots);
/// The same with all of the configuration's slots.
std::vector<Pass> plan_passes(int attributes, bool weights, const Config& config);

/// The weights, then the attributes in passes of their own: what a judge compares with the truth. The first
/// `weight_passes` of them carry weights.
std::vector<Pass> plan_judged_passes(int attributes, int slots, std::size_t* weight_passes = nullptr);

/// The quad with the pass's columns as attributes.
WindowQuad pass_quad(const WindowQuad& quad, const Pass& pass);
/// pass_quad() is the quad itself.
bool is_whole(const Pass& pass, const WindowQuad& quad);

/// Snaps a quad under another id, its position in the draw say: ids of an input may repeat. Errors name the quad's own
/// id.
SnappedQuad snap_as(const WindowQuad& quad, std::uint32_t id, const Config& config, const DrawState& state);

/// A pass of a draw, its quads under their positions.
std::vector<SnappedQuad> snap_pass(std::span<const WindowQuad> quads, const Pass& pass, const Config& config,
                                   const DrawState& state);

/// Throws UsageError when `quads` positions do not fit the machine's quad ids.
void check_quad_count(std::size_t quads, const Config& config);

/// The draw state of a pass, `first` or another. Of plane quads the last bits of depth depend on whether a pass's
/// columns are plane too (skip_plane). Then the first pass alone decides by depth which fragments there are: the others
/// give these fragments and, where the first has discarded or hidden some, more.
DrawState state_of_pass(DrawState state, const Pass& pass, bool first);

/// The configuration that snaps `attributes` attributes whatever the machine's slots are; vertices and weights are the
/// same.
Config snapping_config(Config config, int attributes);

}  // namespace quadrille::tb
