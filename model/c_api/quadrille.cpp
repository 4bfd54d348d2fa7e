// quadrille.h over the C++ models: checks, copies and errors; no arithmetic of its own.
#include "model/c_api/quadrille.h"

#include "model/bit_vector.hpp"
#include "model/boundaries.hpp"
#include "model/clocked.hpp"
#include "model/config_text.hpp"
#include "model/draw_state.hpp"
#include "model/snap.hpp"
#include "model/untimed.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <deque>
#include <exception>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::c_api {
namespace {

static_assert(sizeof(quadrille_vertex) == 96 && sizeof(quadrille_fragment) == 80 &&
                  sizeof(quadrille_draw_state) == 64 && sizeof(quadrille_outputs) == 328,
              "structs changed: raise QUADRILLE_ABI");
static_assert(QUADRILLE_MAX_ATTRIBUTES == max_attribute_slots && QUADRILLE_MAX_LANES == Config::most_pixels_per_clock);
static_assert(+QUADRILLE_SKIP_TILES == +skip_tiles && +QUADRILLE_SKIP_QUADS == +skip_quads &&
              +QUADRILLE_SKIP_HIDDEN == +skip_hidden && +QUADRILLE_SKIP_WALK == +skip_walk &&
              +QUADRILLE_SKIP_OPERANDS == +skip_operands && +QUADRILLE_SKIP_PLANE == +skip_plane);

struct Failure {
  quadrille_status status;
  std::string text;
};

/// Held without allocation: an error of memory has its words too.
constinit thread_local std::array<char, 1024> last_error{};

quadrille_status failed(quadrille_status status, const char* text) noexcept {
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

void require(bool ok, quadrille_status status, const char* text) {
  if (!ok) throw Failure{status, text};
}

/// Throws for a null pointer.
template <class... Pointers>
void require_pointers(const char* names, Pointers... pointers) {
  if (((pointers == nullptr) || ...)) throw Failure{QUADRILLE_BAD_ARGUMENT, std::string("NULL among ") + names};
}

std::string_view view(const char* text) { return text == nullptr ? std::string_view() : std::string_view(text); }

Config config_of(const char* text) {
  Config config;
  apply_config_text(view(text), config);
  return config;
}

// ---- Draw states ----

DrawState default_state(const Config& config) {
  const int side = std::min(512, 1 << config.viewport_bits);
  return draw_state_for(config, side, side);
}

quadrille_draw_state c_state_of(const DrawState& s) {
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
std::size_t known_size(std::size_t size) {
  constexpr std::size_t first = offsetof(quadrille_draw_state, height) + sizeof(std::int32_t),
                        reals = offsetof(quadrille_draw_state, znear), largest = 1024;
  const bool ends_a_member = size >= first && (size <= reals ? size % 4 == 0 : size % 8 == 0);
  require(ends_a_member && size <= largest, QUADRILLE_BAD_ARGUMENT,
          "draw state: size is not sizeof(quadrille_draw_state) of this header or an older one; "
          "quadrille_draw_state_init() sets it");
  return std::min(size, sizeof(quadrille_draw_state));
}

DrawState checked_state(const quadrille_draw_state& given, const Config& config) {
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

std::vector<SnappedQuad> snapped(std::uint32_t first_id, const quadrille_vertex* vertices, std::size_t quads,
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

quadrille_fragment fragment_of(const Fragment& f) {
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

// ---- Counters ----

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

Failure unknown_counter(const char* name) {
  return {QUADRILLE_BAD_ARGUMENT, "no counter \"" + std::string(view(name)) + "\"; counter_name() lists them"};
}

}  // namespace
}  // namespace quadrille::c_api

namespace api = quadrille::c_api;

// ---- The machines ----

struct quadrille_untimed {
  quadrille_untimed(const quadrille::Config& c, const quadrille::DrawState& s) : config(c), state(s), model(c, s) {}

  quadrille::Config config;
  quadrille::DrawState state;
  quadrille::UntimedModel model;
  api::Waiting waiting;
};

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

namespace quadrille::c_api {
namespace {

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

/// A beat as the port may have it: what snapping can give.
void check_vertex(const SnappedVertex& v, const Config& config, int attributes) {
  const auto refuse = [](const char* text) {
    throw Failure{QUADRILLE_BAD_VERTEX, std::string("vertex port: ") + text};
  };
  const std::int64_t position = std::int64_t{1} << (config.pos_int() + config.frac());
  const std::int64_t unit = std::int64_t{1} << config.frac();
  if (std::abs(std::int64_t{v.x}) > position || std::abs(std::int64_t{v.y}) > position)
    refuse("x or y is outside the guard band");
  if (std::abs(std::int64_t{v.w}) > unit) refuse("w is larger than 1");
  const auto legal = [&](const PortNumber& n) {
    return n.sig >> (config.significand_bits - 1) != 0 || (n.sig == 0 && n.exp == 0 && !n.neg);
  };
  if (v.k.sig == 0 || !legal(v.k)) refuse("k is not normalised");
  if (!legal(v.z)) refuse("z is not normalised");
  for (int i = 0; i < attributes; ++i)
    if (!legal(v.attribute[static_cast<std::size_t>(i)])) refuse("an attribute is not normalised");
}

void write_words(const std::uint64_t* from, int bits, std::uint32_t* to, int words) {
  for (int i = 0; i < words; ++i) to[i] = 32 * i < bits ? static_cast<std::uint32_t>(from[i / 2] >> 32 * (i % 2)) : 0;
}

void write_fragments(const quadrille_clocked& m, const ClockedOutputs& outputs, std::uint32_t* words) {
  Record lanes(m.fragment_bits * m.config.pixels_per_clock);
  std::vector<std::uint64_t> packed(static_cast<std::size_t>((m.fragment_bits + 63) / 64));
  for (int lane = 0; lane < m.config.pixels_per_clock; ++lane) {
    const Fragment* fragment = outputs.fragment[static_cast<std::size_t>(lane)];
    if (fragment == nullptr) continue;
    tb::pack_fragment(*fragment, m.config, packed.data(), m.fragment_bits);
    for (int at = 0; at < m.fragment_bits; at += 64)
      lanes.set(lane * m.fragment_bits + at, std::min(64, m.fragment_bits - at),
                packed[static_cast<std::size_t>(at / 64)]);
  }
  write_words(lanes.words(), lanes.bits(), words, QUADRILLE_FRAGMENT_WORDS);
}

}  // namespace
}  // namespace quadrille::c_api

extern "C" {

// ---- The library ----

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

// ---- The untimed model ----

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

// ---- The clocked model ----

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

// ---- The clocked model, port by port ----

quadrille_status quadrille_quad_port(const quadrille_clocked* machine, uint32_t id, const double* positions,
                                     const double* attributes, uint32_t* beats) {
  return api::guarded([&] {
    api::require_pointers("machine, positions, attributes, beats", machine, positions, attributes, beats);
    quadrille::WindowQuad given;
    given.id = id;
    for (std::size_t i = 0; i < 4; ++i) {
      const double *at = positions + 4 * i, *values = attributes + QUADRILLE_MAX_ATTRIBUTES * i;
      given.vertex[i] = {at[0], at[1], at[2], at[3]};
      given.attribute[i].assign(values, values + machine->state.attributes);
    }
    const quadrille::SnappedQuad quad = snap_quad(given, machine->config, machine->state);
    for (std::size_t i = 0; i < 4; ++i) {
      std::array<std::uint64_t, QUADRILLE_VERTEX_WORDS / 2> words{};
      quadrille::BitPacker packer(words.data(), machine->vertex_bits);
      const quadrille::VertexBeat beat = quadrille::beat_of(quad, i);
      quadrille::visit(beat, machine->config, packer);
      packer.finish();
      api::write_words(words.data(), machine->vertex_bits, beats + QUADRILLE_VERTEX_WORDS * i, QUADRILLE_VERTEX_WORDS);
    }
  });
}

quadrille_status quadrille_clocked_state_port(quadrille_clocked* machine, const uint32_t* state) {
  return api::guarded([&] {
    api::require_pointers("machine, state", machine, state);
    const std::vector<std::uint32_t> now = quadrille::tb::pack_state(machine->state, machine->config);
    if (std::equal(now.begin(), now.end(), state)) return;
    const quadrille::Record record = quadrille::Record::from_words(state, machine->state_bits);
    quadrille::DrawState s;
    std::uint32_t znear = 0, zfar = 0;
    quadrille::visit_state(s, znear, zfar, machine->config, quadrille::RecordUnpacker(record));
    s.width = s.height = 1 << machine->config.viewport_bits;
    s.znear = std::ldexp(znear, -machine->config.depth_bits);
    s.zfar = std::ldexp(zfar, -machine->config.depth_bits);
    machine->set_state(s);
  });
}

quadrille_status quadrille_clocked_output_ports(const quadrille_clocked* machine, int32_t* vertex_ready,
                                                int32_t* fragment_valid, int32_t* busy, int32_t* fragment_mask,
                                                uint32_t* fragment) {
  return api::guarded([&] {
    api::require_pointers("machine and outputs", machine, vertex_ready, fragment_valid, busy, fragment_mask, fragment);
    const quadrille::ClockedOutputs now = machine->model.comb();
    *vertex_ready = now.vertex_ready;
    *fragment_valid = now.fragment_valid;
    *busy = now.busy;
    *fragment_mask = static_cast<std::int32_t>(now.fragment_mask());
    api::write_fragments(*machine, now, fragment);
  });
}

quadrille_status quadrille_clocked_flush_port(quadrille_clocked* machine, int32_t flush) {
  return api::guarded([&] {
    api::require_pointers("machine", machine);
    machine->flush_at_port = flush != 0;
  });
}

quadrille_status quadrille_clocked_clock_ports(quadrille_clocked* machine, int32_t reset, int32_t clear_hidden,
                                               int32_t vertex_valid, const uint32_t* vertex, int32_t fragment_ready) {
  return api::guarded([&] {
    api::require_pointers("machine, vertex", machine, vertex);
    quadrille::ClockedInputs inputs;
    inputs.reset = reset != 0;
    inputs.clear_hidden = clear_hidden != 0;
    inputs.vertex_valid = vertex_valid != 0;
    inputs.fragment_ready = fragment_ready != 0;
    inputs.flush = machine->flush_at_port;
    if (inputs.vertex_valid) {
      const quadrille::Record record = quadrille::Record::from_words(vertex, machine->vertex_bits);
      quadrille::visit(inputs.vertex, machine->config, quadrille::RecordUnpacker(record));
      api::check_vertex(inputs.vertex.vertex, machine->config, machine->config.attribute_slots);
    }
    machine->model.clock(inputs);
    machine->flush_at_port = false;
  });
}

}  // extern "C"
