// The stages of one pixel as records. Not for use outside this folder.
#pragma once

#include "golden/analysis/allowed_errors.hpp"
#include "golden/explain/exact_pixel.hpp"
#include "golden/explain/explain.hpp"

namespace quadrille::explain {

/// A quad at a pixel with all that the stages are made from. What it refers to must outlive it.
struct Subject {
  const PipelineContext& context;
  const SnappedQuad& snapped;
  const OnePixel& machine;
  const WindowQuad* given = nullptr;  ///< none of a quad at the port

  const Config& config() const { return context.config; }
  const DrawState& state() const { return context.state; }
  std::size_t attributes() const { return static_cast<std::size_t>(context.state.attributes); }
};

Stage snapping_stage(const PipelineContext& context, const SnappedQuad& snapped, const WindowQuad* given);
/// Setup, tile, stamp.
std::vector<Stage> front_stages(const Subject& subject);
/// From the distances to the fragment, and the weights λ' where the quad is as given.
std::vector<Stage> pixel_stages(const Subject& subject);

}  // namespace quadrille::explain
