#include "model/port/bit_vector.hpp"

#include <algorithm>

namespace quadrille::tb {

std::vector<std::uint32_t> pack_state(const DrawState& state, const Config& config) {
  const std::uint32_t znear = depth_code(state.znear, config), zfar = depth_code(state.zfar, config);
  const int bits = state_layout(config).bits();
  const Record record = pack_record(bits, [&](auto& f) { visit_state(state, znear, zfar, config, f); });
  std::vector<std::uint32_t> words;
  for (int at = 0; at < bits; at += 32)
    words.push_back(static_cast<std::uint32_t>(record.get(at, std::min(32, bits - at))));
  return words;
}

void pack_fragment(const Fragment& fragment, const Config& config, std::uint64_t* words, int width) {
  BitPacker packer(words, width);
  visit(fragment, config, packer);
  packer.finish();
}

Fragment unpack_fragment(const std::uint32_t* words, int width, const Config& config) {
  Fragment fragment;
  const Record record = Record::from_words(words, width);
  visit(fragment, config, RecordUnpacker(record));
  return fragment;
}

}  // namespace quadrille::tb
