#pragma once

#include "model/clocked.hpp"
#include "model/front/quad_reject.hpp"
#include "model/pixel/pixel_pipeline.hpp"
#include "model/skips/plane_quad.hpp"

namespace quadrille::clocked {

/// A quad, and its number: those before it.
struct NumberedQuad {
  SnappedQuad quad;
  std::size_t number = 0;
};

/// Four beats make a quad, which then waits for setup while the next one's come.
struct VertexAssembly : NumberedQuad {
  int count = 0;
  bool full = false;
  QuadReject reject = QuadReject::none;  ///< by the vertices, once full
  bool waits = false;                    ///< `waiting` has not started
  NumberedQuad waiting;

  void reset() {
    number = 0;
    count = 0;
    full = waits = false;
  }
  bool busy() const { return full || count != 0 || waits; }
  /// The quad is left out in this clock.
  bool drops() const { return full && reject != QuadReject::none; }
  /// The quad begins to wait in the next clock.
  bool moves() const { return full && reject == QuadReject::none && !waits; }
  bool ready() const { return !full || drops() || moves(); }

  void count_quads(PerformanceCounters& to, bool starting, const PipelineContext& c) const {
    using enum PerformanceCounter;
    to[quads] += starting || drops();
    if (drops())
      ++to[reject == QuadReject::empty ? quads_empty : reject == QuadReject::behind ? quads_behind : quads_depth];
    to[quads_plane] += starting && plane_quad(waiting.quad, c.config, c.state);
  }

  /// The edge. `starts`: the waiting quad; `accept`: the beat is taken.
  void clock(const ClockedInputs& in, bool starts, bool accept, const PipelineContext& c) {
    const bool moving = moves();
    if (moving) waiting = *this;
    if (moving || drops()) {
      full = false;
      ++number;
    }
    waits = moving || (waits && !starts);
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
