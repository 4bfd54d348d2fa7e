// Records of model/stages.hpp as flat bit vectors, laid out as Verilator lays out a packed struct: bit 0 of the struct
// is bit 0 of word 0. The first field that visit() names is the most significant one.
#pragma once

#include "model/config.hpp"
#include "model/records.hpp"
#include "model/stages.hpp"

#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace quadrille::tb {

static_assert(std::endian::native == std::endian::little, "64-bit writes are read back as 32-bit words");

constexpr std::size_t words_for(int width) { return static_cast<std::size_t>((width + 31) / 32); }

/// Packs fields from the most significant one down into ceil(width/64) 64-bit words. Every bit of these is written.
class BitPacker {
 public:
  BitPacker(std::uint64_t* words, int width)
      : word_(words + (width + 63) / 64 - 1), free_(width - 64 * ((width + 63) / 64 - 1)) {}

  /// The low `width` bits (1-64) of value.
  void put(int width, std::uint64_t value) {
    value &= ~std::uint64_t{0} >> (64 - width);
    if (width <= free_) {
      free_ -= width;
      bits_ |= value << free_;
    } else {
      const int rest = width - free_;  // 1-64 bits go to the next lower word
      *word_-- = bits_ | (rest == 64 ? 0 : value >> rest);
      free_ = 64 - rest;
      bits_ = value << free_;
    }
  }

  /// For visit(): f(name, index, width, value).
  template <class T>
  void operator()(const char*, int, int width, T value) {
    put(width, static_cast<std::uint64_t>(static_cast<std::int64_t>(value)));
  }

  /// Writes the last word. All fields must have been put.
  void finish() { *word_ = bits_; }

 private:
  std::uint64_t* word_;
  std::uint64_t bits_ = 0;
  int free_;  ///< bits of *word_ below the last field
};

/// Bits [lsb, lsb + width) of a vector, width 1-64.
std::uint64_t extract(const std::uint32_t* words, int lsb, int width);
/// The same, read as two's complement.
std::int64_t extract_signed(const std::uint32_t* words, int lsb, int width);

struct Field {
  std::string name;
  int index;  ///< element of an array, or -1
  int lsb, width;

  std::string label() const { return index < 0 ? name : name + "[" + std::to_string(index) + "]"; }
};

/// The fields of one vector, most significant first.
class Layout {
 public:
  /// Lays out the fields that `fields` lists as (name, index, width) in visit() order.
  explicit Layout(std::vector<Field> fields);

  int width() const { return width_; }
  std::size_t words() const { return words_for(width_); }
  const std::vector<Field>& fields() const { return fields_; }
  /// The first (most significant) field in which two vectors differ, or nullptr.
  const Field* first_difference(const std::uint32_t* a, const std::uint32_t* b) const;
  /// Field by name and index; throws std::out_of_range.
  const Field& field(const std::string& name, int index = -1) const;

 private:
  std::vector<Field> fields_;
  int width_ = 0;
};

const char* boundary_name(Boundary b);
Layout boundary_layout(Boundary b, const Config& config);
Layout vertex_layout(const Config& config);
Layout state_layout(const Config& config);

std::vector<std::uint32_t> pack_vertex(std::uint32_t id, const SnappedVertex& vertex, const Config& config);
std::vector<std::uint32_t> pack_state(const DrawState& state, const Config& config);

/// Packs into `words` (see BitPacker for its size).
void pack_fragment(const Fragment& fragment, const Config& config, std::uint64_t* words, int width);
Fragment unpack_fragment(const std::uint32_t* words, const Config& config);

/// A hexadecimal numeral of `width` bits, leading zeros included.
std::string hex(std::uint64_t value, int width);

}  // namespace quadrille::tb
