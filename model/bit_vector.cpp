#include "model/bit_vector.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace quadrille::tb {

namespace {

/// Collects what visit() names.
struct FieldLister {
  std::vector<Field> fields;
  template <class T>
  void operator()(const char* name, int index, int width, T) {
    fields.push_back({name, index, 0, width});
  }
};

std::vector<std::uint32_t> to_words(const std::vector<std::uint64_t>& wide, int width) {
  std::vector<std::uint32_t> words(words_for(width));
  std::memcpy(words.data(), wide.data(), words.size() * sizeof(std::uint32_t));
  return words;
}

}  // namespace

std::uint64_t extract(const std::uint32_t* words, int lsb, int width) {
  unsigned __int128 window = 0;
  const int first = lsb / 32, last = (lsb + width - 1) / 32;
  for (int i = last; i >= first; --i) window = (window << 32) | words[i];
  return static_cast<std::uint64_t>(window >> (lsb % 32)) & (~std::uint64_t{0} >> (64 - width));
}

std::int64_t extract_signed(const std::uint32_t* words, int lsb, int width) {
  return static_cast<std::int64_t>(extract(words, lsb, width) << (64 - width)) >> (64 - width);
}

Layout::Layout(std::vector<Field> fields) : fields_(std::move(fields)) {
  for (const Field& f : fields_) width_ += f.width;
  int lsb = width_;
  for (Field& f : fields_) f.lsb = lsb -= f.width;
}

const Field* Layout::first_difference(const std::uint32_t* a, const std::uint32_t* b) const {
  for (const Field& f : fields_) {
    if (extract(a, f.lsb, f.width) != extract(b, f.lsb, f.width)) return &f;
  }
  return nullptr;
}

const Field& Layout::field(const std::string& name, int index) const {
  const auto found =
      std::find_if(fields_.begin(), fields_.end(), [&](const Field& f) { return f.name == name && f.index == index; });
  if (found == fields_.end()) throw std::out_of_range("no field " + name + "[" + std::to_string(index) + "]");
  return *found;
}

const char* boundary_name(Boundary b) {
  constexpr const char* names[] = {"setup", "tile",  "stamp",  "diff", "norm",
                                   "rsqrt", "ratio", "weight", "sum",  "fragment"};
  return names[static_cast<std::size_t>(b)];
}

Layout boundary_layout(Boundary b, const Config& config) {
  FieldLister list;
  switch (b) {
    case Boundary::setup:
      visit(SetupResult{}, config, list);
      break;
    case Boundary::tile:
      visit(TileEntry{}, config, list);
      break;
    case Boundary::stamp:
      visit(StampEntry{}, config, list);
      break;
    case Boundary::fragment:
      visit(Fragment{}, config, list);
      break;
    default:
      visit(PixelTrace{}, b, config, list);
      break;
  }
  return Layout(std::move(list.fields));
}

Layout vertex_layout(const Config& config) {
  FieldLister list;
  visit_vertex(0, SnappedVertex{}, config, list);
  return Layout(std::move(list.fields));
}

Layout state_layout(const Config& config) {
  FieldLister list;
  visit_state(DrawState{}, config, list);
  return Layout(std::move(list.fields));
}

std::vector<std::uint32_t> pack_vertex(std::uint32_t id, const SnappedVertex& vertex, const Config& config) {
  const int width = vertex_layout(config).width();
  std::vector<std::uint64_t> wide(static_cast<std::size_t>((width + 63) / 64));
  BitPacker packer(wide.data(), width);
  visit_vertex(id, vertex, config, packer);
  packer.finish();
  return to_words(wide, width);
}

std::vector<std::uint32_t> pack_state(const DrawState& state, const Config& config) {
  const int width = state_layout(config).width();
  std::vector<std::uint64_t> wide(static_cast<std::size_t>((width + 63) / 64));
  BitPacker packer(wide.data(), width);
  visit_state(state, config, packer);
  packer.finish();
  return to_words(wide, width);
}

void pack_fragment(const Fragment& fragment, const Config& config, std::uint64_t* words, int width) {
  BitPacker packer(words, width);
  visit(fragment, config, packer);
  packer.finish();
}

Fragment unpack_fragment(const std::uint32_t* words, const Config& config) {
  int lsb = 0;
  const auto take = [&](int width) {
    lsb += width;
    return extract(words, lsb - width, width);
  };
  Fragment f;
  for (int i = 0; i < config.attribute_slots; ++i) {
    const int width = config.attr_out_bits();
    f.attribute[static_cast<std::size_t>(i)] = static_cast<std::int64_t>(take(width) << (64 - width)) >> (64 - width);
  }
  f.depth = static_cast<std::uint32_t>(take(config.depth_bits + 1));
  f.flags = static_cast<std::uint8_t>(take(8));
  f.front = take(1) != 0;
  f.y = static_cast<std::uint16_t>(take(config.viewport_bits));
  f.x = static_cast<std::uint16_t>(take(config.viewport_bits));
  f.quad = static_cast<std::uint32_t>(take(config.quad_id_bits));
  return f;
}

std::string hex(std::uint64_t value, int width) {
  std::string text = "0x";
  for (int digit = (width + 3) / 4 - 1; digit >= 0; --digit) text += "0123456789abcdef"[value >> (4 * digit) & 15u];
  return text;
}

}  // namespace quadrille::tb
