#include "model/c_api/clocked.hpp"

extern "C" {

quadrille_status quadrille_clocked_create(const char* config, quadrille_clocked** machine) {
  return api::create(config, machine);
}
void quadrille_clocked_destroy(quadrille_clocked* machine) { delete machine; }

quadrille_status quadrille_clocked_set_state(quadrille_clocked* machine, const quadrille_draw_state* state) {
  return api::guarded([&] {
    api::require_pointers("machine, state", machine, state);
    machine->set_state(api::checked_state(*state, machine->config));
  });
}

quadrille_status quadrille_clocked_push(quadrille_clocked* machine, uint32_t first_id, const quadrille_vertex* vertices,
                                        size_t quads) {
  return api::guarded([&] {
    api::require_pointers("machine", machine);
    if (quads != 0) api::require_pointers("vertices", vertices);
    const auto new_quads = api::snapped(first_id, vertices, quads, machine->config, machine->state);
    machine->queue.insert(machine->queue.end(), new_quads.begin(), new_quads.end());
  });
}

quadrille_status quadrille_clocked_outputs(const quadrille_clocked* machine, quadrille_outputs* outputs) {
  return api::guarded([&] {
    api::require_pointers("machine, outputs", machine, outputs);
    const quadrille::ClockedOutputs now = machine->model.comb();
    *outputs = {};
    outputs->vertex_ready = now.vertex_ready;
    outputs->fragment_valid = now.fragment_valid;
    outputs->busy = now.busy;
    outputs->fragment_mask = now.fragment_mask();
    for (std::size_t lane = 0; lane < now.fragment.size(); ++lane)
      if (now.fragment[lane] != nullptr) outputs->fragment[lane] = api::fragment_of(*now.fragment[lane]);
  });
}

quadrille_status quadrille_clocked_clock(quadrille_clocked* machine, uint32_t inputs) {
  return api::guarded([&] {
    api::require_pointers("machine", machine);
    api::require((inputs & ~31u) == 0, QUADRILLE_BAD_ARGUMENT, "unknown bits of inputs");
    machine->clock(inputs);
  });
}

quadrille_status quadrille_clocked_run(quadrille_clocked* machine, uint64_t max_clocks, uint64_t* clocks) {
  return api::guarded([&] {
    api::require_pointers("machine", machine);
    std::uint64_t done = 0;
    for (; done < max_clocks && !machine->idle(); ++done)
      machine->clock(QUADRILLE_VERTEX_VALID | QUADRILLE_FRAGMENT_READY);
    if (clocks != nullptr) *clocks = done;
  });
}

quadrille_status quadrille_clocked_pending(const quadrille_clocked* machine, size_t* fragments) {
  return api::pending(machine, fragments);
}
quadrille_status quadrille_clocked_take(quadrille_clocked* machine, quadrille_fragment* fragments, size_t capacity,
                                        size_t* taken) {
  return api::take(machine, fragments, capacity, taken);
}

const char* quadrille_clocked_counter_name(uint32_t index) {
  return index < quadrille::counter_count ? quadrille::counter_info[index].name.data() : nullptr;
}
quadrille_status quadrille_clocked_counter(const quadrille_clocked* machine, const char* name, uint64_t* value) {
  return api::guarded([&] {
    api::require_pointers("machine, name, value", machine, name, value);
    for (std::size_t i = 0; i < quadrille::counter_count; ++i)
      if (quadrille::counter_info[i].name == name)
        return static_cast<void>(*value = machine->model.counters().value[i]);
    throw api::unknown_counter(name);
  });
}

}  // extern "C"
