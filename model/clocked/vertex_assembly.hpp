#pragma once

#include "model/clocked.hpp"
#include "model/front/quad_reject.hpp"
#include "model/pixel/pixel_pipeline.hpp"
#include "model/skips/plane_quad.hpp"

namespace quadrille::clocked {

/// Four beats make a quad.
struct VertexAssembly {
  SnappedQuad quad;
  std::size_t number = 0;  ///< of the quad: those before it
  int count = 0;
  bool full = false;
  QuadReject reject = QuadReject::none;  ///< by the vertices, once full

  void reset() {
    number = 0;
    count = 0;
    full = false;
  }
  bool busy() const { return full || count != 0; }
  /// The quad is left out in this clock.
  bool drops() const { return full && reject != QuadReject::none; }

  void count_quads(PerformanceCounters& to, bool starting, const PipelineContext& c) const {
    using enum PerformanceCounter;
    to[quads] += starting || drops();
    if (drops())
      ++to[reject == QuadReject::empty ? quads_empty : reject == QuadReject::behind ? quads_behind : quads_depth];
    to[quads_plane] += starting && plane_quad(quad, c.config, c.state);
  }

  /// The edge. `leaves`: the quad starts or is left out; `accept`: the beat is taken.
  void clock(const ClockedInputs& in, bool leaves, bool accept, const PipelineContext& c) {
    if (leaves) {
      full = false;
      ++number;
    }
    if (in.flush) {
      count = 0;
    } else if (accept) {
      if (count == 0) {
        quad.id = in.vertex.id;
        quad.base = in.vertex.base;
      }
      quad.vertex[static_cast<std::size_t>(count)] = in.vertex.vertex;
      full = count == 3;
      if (full) reject = reject_by_vertices(quad, c.config, c.state);
      count = (count + 1) % 4;
    }
  }
};

}  // namespace quadrille::clocked
