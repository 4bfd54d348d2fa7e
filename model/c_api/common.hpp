// What both models have in common behind quadrille.h: errors, draw states, vertices, fragments.
#pragma once

#include "model/c_api/quadrille.h"

#include "model/port/config_text.hpp"
#include "model/port/draw_state.hpp"
#include "model/port/snap.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <deque>
#include <exception>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::c_api {

struct Failure {
  quadrille_status status;
  std::string text;
};

/// Held without allocation: an error of memory has its words too.
inline constinit thread_local std::array<char, 1024> last_error{};

inline quadrille_status failed(quadrille_status status, const char* text) noexcept {
  std::snprintf(last_error.data(), last_error.size(), "%s", text);
  return status;
}

/// Runs `body` with every exception turned into a status and a text.
template <class F>
quadrille_status guarded(F&& body) noexcept {
  try {
    body();
    return QUADRILLE_OK;
  } catch (const Failure& f) {
    return failed(f.status, f.text.c_str());
  } catch (const ConfigError& e) {
    return failed(QUADRILLE_BAD_CONFIG, e.what());
  } catch (const SnapError& e) {
    return failed(QUADRILLE_BAD_VERTEX, e.what());
  } catch (const DrawStateError& e) {
    return failed(QUADRILLE_BAD_STATE, e.what());
  } catch (const std::exception& e) {
    return failed(QUADRILLE_FAILED, e.what());
  } catch (...) {
    return failed(QUADRILLE_FAILED, "unknown error");
  }
}

inline void require(bool ok, quadrille_status status, const char* text) {
  if (!ok) throw Failure{status, text};
}

/// Throws for a null pointer.
template <class... Pointers>
void require_pointers(const char* names, Pointers... pointers) {
  if (((pointers == nullptr) || ...)) throw Failure{QUADRILLE_BAD_ARGUMENT, std::string("NULL among ") + names};
}

inline std::string_view view(const char* text) { return text == nullptr ? std::string_view() : std::string_view(text); }

inline Config config_of(const char* text) {
  Config config;
  apply_config_text(view(text), config);
  return config;
}

// ---- Draw states ----

inline DrawState default_state(const Config& config) {
  const int side = std::min(512, 1 << config.viewport_bits);
  return draw_state_for(config, side, side);
}

inline quadrille_draw_state c_state_of(const DrawState& s) {
  return {sizeof(quadrille_draw_state),
          s.width,
          s.height,
          s.scissor_x0,
          s.scissor_y0,
          s.scissor_x1,
          s.scissor_y1,
          static_cast<std::int32_t>(s.cull),
          s.perspective,
          s.depth,
          s.attributes,
          s.skip,
          s.znear,
          s.zfar};
}

/// Bytes of a caller's struct that this library has, all or those before a member that the caller's header lacks;
/// throws where a member would be cut.
inline std::size_t known_size(std::size_t size) {
  constexpr std::size_t first = offsetof(quadrille_draw_state, height) + sizeof(std::int32_t),
                        reals = offsetof(quadrille_draw_state, znear), largest = 1024;
  const bool ends_a_member = size >= first && (size <= reals ? size % 4 == 0 : size % 8 == 0);
  require(ends_a_member && size <= largest, QUADRILLE_BAD_ARGUMENT,
          "draw state: size is not sizeof(quadrille_draw_state) of this header or an older one; "
          "quadrille_draw_state_init() sets it");
  return std::min(size, sizeof(quadrille_draw_state));
}

inline DrawState checked_state(const quadrille_draw_state& given, const Config& config) {
  const std::size_t known = known_size(given.size);
  const auto* const bytes = reinterpret_cast<const unsigned char*>(&given);
  require(std::all_of(bytes + known, bytes + given.size, [](unsigned char byte) { return byte == 0; }),
          QUADRILLE_BAD_ARGUMENT, "draw state: a member is set that this library does not have: it is older");
  quadrille_draw_state all = c_state_of(draw_state_for(config, given.width, given.height));
  std::memcpy(&all, bytes, known);
  require(all.cull >= 0 && all.cull <= 2, QUADRILLE_BAD_STATE, "draw state: cull must be 0, 1 or 2");
  DrawState state;
  state.width = all.width;
  state.height = all.height;
  state.scissor_x0 = all.scissor_x0;
  state.scissor_y0 = all.scissor_y0;
  state.scissor_x1 = all.scissor_x1;
  state.scissor_y1 = all.scissor_y1;
  state.cull = static_cast<Cull>(all.cull);
  state.perspective = all.perspective != 0;
  state.depth = all.depth != 0;
  state.znear = all.znear;
  state.zfar = all.zfar;
  state.attributes = all.attributes;
  state.skip = all.skip;
  return state;
}

// ---- Vertices and fragments ----

inline std::vector<SnappedQuad> snapped(std::uint32_t first_id, const quadrille_vertex* vertices, std::size_t quads,
                                        const Config& config, const DrawState& state) {
  require(quads == 0 || quads - 1 <= std::numeric_limits<std::uint32_t>::max() - first_id, QUADRILLE_BAD_ARGUMENT,
          "quads: their ids pass 2^32 - 1");
  std::vector<SnappedQuad> result;
  result.reserve(quads);
  WindowQuad quad;
  for (std::size_t q = 0; q < quads; ++q) {
    quad.id = first_id + static_cast<std::uint32_t>(q);
    for (std::size_t i = 0; i < 4; ++i) {
      const quadrille_vertex& v = vertices[4 * q + i];
      quad.vertex[i] = {v.x, v.y, v.z, v.w};
      quad.attribute[i].assign(v.attribute, v.attribute + state.attributes);
    }
    result.push_back(snap_quad(quad, config, state));
  }
  return result;
}

inline quadrille_fragment fragment_of(const Fragment& f) {
  quadrille_fragment result{};
  result.quad = f.quad;
  result.x = f.x;
  result.y = f.y;
  result.front = f.front;
  result.flags = f.flags;
  result.depth = f.depth;
  std::copy(f.attribute.begin(), f.attribute.end(), result.attribute);
  return result;
}

/// Fragments that wait to be taken.
class Waiting {
 public:
  void add(const Fragment& fragment) { fragments_.push_back(fragment_of(fragment)); }
  std::size_t size() const { return fragments_.size(); }
  std::size_t take(quadrille_fragment* out, std::size_t capacity) {
    const std::size_t count = std::min(capacity, fragments_.size());
    const auto end = fragments_.begin() + static_cast<std::ptrdiff_t>(count);
    std::copy(fragments_.begin(), end, out);
    fragments_.erase(fragments_.begin(), end);
    return count;
  }

 private:
  std::deque<quadrille_fragment> fragments_;
};

inline Failure unknown_counter(const char* name) {
  return {QUADRILLE_BAD_ARGUMENT, "no counter \"" + std::string(view(name)) + "\"; counter_name() lists them"};
}

// ---- Functions that both have ----

template <class Machine>
quadrille_status create(const char* config, Machine** machine) {
  return guarded([&] {
    require_pointers("machine", machine);
    *machine = nullptr;
    const Config c = config_of(config);
    *machine = new Machine(c, default_state(c));
  });
}

template <class Machine>
quadrille_status pending(const Machine* machine, std::size_t* fragments) {
  return guarded([&] {
    require_pointers("machine, fragments", machine, fragments);
    *fragments = machine->waiting.size();
  });
}

template <class Machine>
quadrille_status take(Machine* machine, quadrille_fragment* fragments, std::size_t capacity, std::size_t* taken) {
  return guarded([&] {
    require_pointers("machine, taken", machine, taken);
    if (capacity != 0) require_pointers("fragments", fragments);
    *taken = machine->waiting.take(fragments, capacity);
  });
}

}  // namespace quadrille::c_api

namespace api = quadrille::c_api;
