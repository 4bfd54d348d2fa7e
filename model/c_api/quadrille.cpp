// The library itself. quadrille.h over the C++ models is checks, copies and errors; no arithmetic of its own.
#include "model/c_api/common.hpp"

namespace quadrille::c_api {

static_assert(sizeof(quadrille_vertex) == 96 && sizeof(quadrille_fragment) == 80 &&
                  sizeof(quadrille_draw_state) == 64 && sizeof(quadrille_outputs) == 328,
              "structs changed: raise QUADRILLE_ABI");
static_assert(QUADRILLE_MAX_ATTRIBUTES == max_attribute_slots && QUADRILLE_MAX_LANES == Config::most_pixels_per_clock);
static_assert(+QUADRILLE_SKIP_TILES == +skip_tiles && +QUADRILLE_SKIP_QUADS == +skip_quads &&
              +QUADRILLE_SKIP_HIDDEN == +skip_hidden && +QUADRILLE_SKIP_WALK == +skip_walk &&
              +QUADRILLE_SKIP_OPERANDS == +skip_operands && +QUADRILLE_SKIP_PLANE == +skip_plane);

}  // namespace quadrille::c_api

extern "C" {

const char* quadrille_version(void) { return QUADRILLE_VERSION; }
uint32_t quadrille_abi(void) { return QUADRILLE_ABI; }
const char* quadrille_last_error(void) { return api::last_error.data(); }

quadrille_status quadrille_config_value(const char* config, const char* name, int32_t* value) {
  return api::guarded([&] {
    api::require_pointers("name, value", name, value);
    const std::optional<int> found = quadrille::config_number(api::config_of(config), name);
    if (!found)
      throw api::Failure{QUADRILLE_BAD_ARGUMENT,
                         "no key and no derived width \"" + std::string(name) + "\"; `quadrille config` lists them"};
    *value = *found;
  });
}

quadrille_status quadrille_draw_state_init(quadrille_draw_state* state, size_t size, int32_t width, int32_t height) {
  return api::guarded([&] {
    api::require_pointers("state", state);
    const std::size_t known = api::known_size(size);
    quadrille::DrawState s;
    s.width = s.scissor_x1 = width;
    s.height = s.scissor_y1 = height;
    quadrille_draw_state all = api::c_state_of(s);
    all.size = static_cast<std::uint32_t>(size);
    std::memset(state, 0, size);
    std::memcpy(state, &all, known);
  });
}

}  // extern "C"
