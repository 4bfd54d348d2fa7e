// Words of the machine's ports, for a bench of one's own: the hexadecimal digits of packed structs.
#include "model/port/bit_vector.hpp"
#include "model/port/draw_state.hpp"
#include "model/port/record.hpp"
#include "model/port/snap.hpp"
#include "model/python/binding.hpp"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>

namespace quadrille::python {
namespace {

using namespace nb::literals;

std::vector<std::uint32_t> words_of(const Record& record) {
  std::vector<std::uint32_t> words;
  for (int at = 0; at < record.bits(); at += 32)
    words.push_back(static_cast<std::uint32_t>(record.get(at, std::min(32, record.bits() - at))));
  return words;
}

int fragment_bits(const Config& config) { return boundary_layout(Boundary::fragment, config).bits(); }

std::vector<std::string> vertex_words(const Quads& quads, const Config& config, DrawState state) {
  state.attributes = static_cast<int>(quads.attributes.size());
  check_draw_state(state, config);
  const int bits = vertex_layout(config).bits();
  std::vector<std::string> words;
  for (const WindowQuad& quad : quads.quads) {
    const SnappedQuad snapped = snap_quad(quad, config, state);
    for (std::size_t i = 0; i < 4; ++i) {
      const VertexBeat beat = beat_of(snapped, i);
      words.push_back(pack_record(bits, [&](auto& f) { visit(beat, config, f); }).to_hex());
    }
  }
  return words;
}

std::string state_word(const Config& config, DrawState state, int attributes) {
  state.attributes = attributes;
  check_draw_state(state, config);
  const std::vector<std::uint32_t> words = tb::pack_state(state, config);
  return Record::from_words(words.data(), state_layout(config).bits()).to_hex();
}

nb::tuple fragments_of(const std::vector<std::string>& words, const Config& config, bool depth,
                       const std::vector<std::string>& names) {
  check_names(names);
  if (names.size() > static_cast<std::size_t>(config.attribute_slots))
    throw std::invalid_argument(std::to_string(names.size()) + " names; a fragment has attribute_slots = " +
                                std::to_string(config.attribute_slots) + " attributes");
  FragmentRecords fragments(config, {depth, false, true, names});
  const int bits = fragment_bits(config);
  for (std::size_t i = 0; i < words.size(); ++i) {
    try {
      fragments.add(tb::unpack_fragment(words_of(Record::from_hex(words[i], bits)).data(), bits, config));
    } catch (const HexError& error) {
      throw std::invalid_argument("fragment " + std::to_string(i) + ": " + error.what());
    }
  }
  return array_of(std::move(fragments));
}

}  // namespace

std::string fragment_word(const Fragment& fragment, const Config& config) {
  const int bits = fragment_bits(config);
  return pack_record(bits, [&](auto& f) { visit(fragment, config, f); }).to_hex();
}

void bind_ports(nb::module_& m) {
  m.def("vertex_words", vertex_words, "quads"_a, "config"_a, "state"_a);
  m.def("state_word", state_word, "config"_a, "state"_a, "attributes"_a);
  m.def("fragments_of_words", fragments_of, "words"_a, "config"_a, "depth"_a, "names"_a);
  m.def("fragment_bits", fragment_bits, "config"_a);
}

}  // namespace quadrille::python
