#pragma once

#include "model/c_api/common.hpp"
#include "model/clocked.hpp"
#include "model/port/boundaries.hpp"

struct quadrille_clocked {
  quadrille_clocked(const quadrille::Config& c, const quadrille::DrawState& s)
      : config(c),
        state(s),
        vertex_bits(quadrille::vertex_layout(c).bits()),
        state_bits(quadrille::state_layout(c).bits()),
        fragment_bits(quadrille::boundary_layout(quadrille::Boundary::fragment, c).bits()),
        model(c, s) {
    inputs.reset = true;
    model.clock(inputs);
    inputs = {};
    while (model.comb().busy) model.clock(inputs);
  }

  bool idle() const { return queue.empty() && !model.comb().busy; }

  void set_state(const quadrille::DrawState& s) {
    check_draw_state(s, config);
    api::require(queue.empty() && !model.quads_under_way(), QUADRILLE_BUSY,
                 "the draw state cannot change while the machine is busy or quads are queued");
    model.set_state(s);
    state = s;
  }

  void clock(std::uint32_t given) {
    const quadrille::ClockedOutputs outputs = model.comb();
    api::require((given & QUADRILLE_CLEAR_HIDDEN) == 0 || !outputs.busy, QUADRILLE_BUSY,
                 "hidden tiles cannot be cleared while the machine is busy");
    inputs.reset = (given & QUADRILLE_RESET) != 0;
    inputs.vertex_valid = (given & QUADRILLE_VERTEX_VALID) != 0 && !queue.empty();
    inputs.fragment_ready = (given & QUADRILLE_FRAGMENT_READY) != 0;
    inputs.clear_hidden = (given & QUADRILLE_CLEAR_HIDDEN) != 0;
    inputs.flush = (given & QUADRILLE_FLUSH) != 0;
    if (inputs.vertex_valid) inputs.vertex = quadrille::beat_of(queue.front(), beat);
    if (outputs.fragment_valid && inputs.fragment_ready && !inputs.reset)
      outputs.for_each_fragment([&](const quadrille::Fragment& f) { waiting.add(f); });
    const bool taken = inputs.vertex_valid && outputs.vertex_ready;
    model.clock(inputs);
    if (inputs.reset) {
      queue.clear();
      beat = 0;
      return;
    }
    beat += taken ? 1 : 0;
    if (beat == 4 || (inputs.flush && beat != 0)) {
      queue.pop_front();
      beat = 0;
    }
  }

  quadrille::Config config;
  quadrille::DrawState state;
  int vertex_bits, state_bits, fragment_bits;
  quadrille::ClockedModel model;
  quadrille::ClockedInputs inputs;
  std::deque<quadrille::SnappedQuad> queue;
  std::size_t beat = 0;        ///< of the first quad, the next to be taken
  bool flush_at_port = false;  ///< in the next clock port by port
  api::Waiting waiting;
};
