#include "model/untimed.hpp"
#include "model/c_api/common.hpp"

struct quadrille_untimed {
  quadrille_untimed(const quadrille::Config& c, const quadrille::DrawState& s) : config(c), state(s), model(c, s) {}

  quadrille::Config config;
  quadrille::DrawState state;
  quadrille::UntimedModel model;
  api::Waiting waiting;
};

namespace quadrille::c_api {
namespace {

struct DrawCounter {
  const char* name;
  std::uint64_t (*value)(const DrawStats&);
};

template <QuadReject reason>
std::uint64_t rejected(const DrawStats& s) {
  return s.rejected[static_cast<std::size_t>(reason)];
}
template <std::uint64_t DrawStats::*member>
std::uint64_t counted(const DrawStats& s) {
  return s.*member;
}

constexpr std::array draw_counters{
    DrawCounter{"quads", counted<&DrawStats::quads>},
    DrawCounter{"quads_empty", rejected<QuadReject::empty>},
    DrawCounter{"quads_behind", rejected<QuadReject::behind>},
    DrawCounter{"quads_depth", rejected<QuadReject::depth>},
    DrawCounter{"quads_line", rejected<QuadReject::line>},
    DrawCounter{"quads_culled", rejected<QuadReject::culled>},
    DrawCounter{"quads_outside", rejected<QuadReject::outside>},
    DrawCounter{"quads_homogeneous", counted<&DrawStats::homogeneous_quads>},
    DrawCounter{"blocks_tested", counted<&DrawStats::blocks_tested>},
    DrawCounter{"blocks_hidden", counted<&DrawStats::blocks_hidden>},
    DrawCounter{"tiles_tested", counted<&DrawStats::tiles_tested>},
    DrawCounter{"tiles_entered", counted<&DrawStats::tiles_entered>},
    DrawCounter{"tiles_hidden", counted<&DrawStats::tiles_hidden>},
    DrawCounter{"tiles_masked", counted<&DrawStats::tiles_masked>},
    DrawCounter{"stamps", counted<&DrawStats::stamps_covered>},
    DrawCounter{"pixels", counted<&DrawStats::pixels>},
    DrawCounter{"fragments", counted<&DrawStats::fragments>},
};

}  // namespace
}  // namespace quadrille::c_api

extern "C" {

quadrille_status quadrille_untimed_create(const char* config, quadrille_untimed** machine) {
  return api::create(config, machine);
}
void quadrille_untimed_destroy(quadrille_untimed* machine) { delete machine; }

quadrille_status quadrille_untimed_set_state(quadrille_untimed* machine, const quadrille_draw_state* state) {
  return api::guarded([&] {
    api::require_pointers("machine, state", machine, state);
    const quadrille::DrawState s = api::checked_state(*state, machine->config);
    machine->model.set_state(s);
    machine->state = s;
  });
}

quadrille_status quadrille_untimed_clear_hidden(quadrille_untimed* machine) {
  return api::guarded([&] {
    api::require_pointers("machine", machine);
    machine->model.clear_hidden();
  });
}

quadrille_status quadrille_untimed_draw(quadrille_untimed* machine, uint32_t first_id, const quadrille_vertex* vertices,
                                        size_t quads) {
  return api::guarded([&] {
    api::require_pointers("machine", machine);
    if (quads != 0) api::require_pointers("vertices", vertices);
    for (const quadrille::SnappedQuad& quad : api::snapped(first_id, vertices, quads, machine->config, machine->state))
      machine->model.draw(quad, [&](std::span<const quadrille::Fragment> fragments) {
        for (const quadrille::Fragment& f : fragments) machine->waiting.add(f);
      });
  });
}

quadrille_status quadrille_untimed_pending(const quadrille_untimed* machine, size_t* fragments) {
  return api::pending(machine, fragments);
}
quadrille_status quadrille_untimed_take(quadrille_untimed* machine, quadrille_fragment* fragments, size_t capacity,
                                        size_t* taken) {
  return api::take(machine, fragments, capacity, taken);
}

const char* quadrille_untimed_counter_name(uint32_t index) {
  return index < api::draw_counters.size() ? api::draw_counters[index].name : nullptr;
}
quadrille_status quadrille_untimed_counter(const quadrille_untimed* machine, const char* name, uint64_t* value) {
  return api::guarded([&] {
    api::require_pointers("machine, name, value", machine, name, value);
    for (const api::DrawCounter& counter : api::draw_counters)
      if (counter.name == std::string_view(name))
        return static_cast<void>(*value = counter.value(machine->model.stats()));
    throw api::unknown_counter(name);
  });
}

}  // extern "C"
