// The clocked model port by port.
#include "model/c_api/clocked.hpp"
#include "model/port/bit_vector.hpp"

#include <cmath>

namespace quadrille::c_api {
namespace {

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
