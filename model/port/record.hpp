// A record: one wide unsigned number, its fields, and its line of hexadecimal digits (golden/vectors/README.md). Laid
// out as Verilator lays out a packed struct: bit 0 of the struct is bit 0 of word 0.
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille {

/// One field: the bits [position +: width] of a record, width 1-64.
struct RecordField {
  std::string name{};
  int index = -1;  ///< element of an array, or -1
  int width = 1;
  int position = 0;
  bool is_signed = false;              ///< two's complement
  std::optional<int> fraction_bits{};  ///< f: the value is the integer · 2^-f
  std::string unit{};
  std::string meaning{};
  std::string encoding{};  ///< of 64 bits that are no integer ("ieee754-binary64"); empty: an integer

  /// "name" or "name[index]".
  std::string label() const { return index < 0 ? name : name + "[" + std::to_string(index) + "]"; }

  friend bool operator==(const RecordField&, const RecordField&) = default;
};

/// The fields of a record, most significant first.
class RecordLayout {
 public:
  /// Appends a field below those already there; its `position` is computed. Throws std::invalid_argument for a width
  /// outside 1-64.
  void add(RecordField field);
  /// Appends an array of `count` elements, the last one most significant.
  void add_array(const RecordField& element, int count);

  int bits() const { return bits_; }
  std::size_t digits() const { return static_cast<std::size_t>((bits_ + 3) / 4); }
  const std::vector<RecordField>& fields() const { return fields_; }
  /// The field of that name; throws std::out_of_range.
  const RecordField& field(std::string_view name, int index = -1) const;

  friend bool operator==(const RecordLayout&, const RecordLayout&) = default;

 private:
  std::vector<RecordField> fields_;
  int bits_ = 0;
};

/// What is wrong with a line of digits; the reader adds file and line.
struct HexError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class Record {
 public:
  Record() = default;
  /// All bits 0.
  explicit Record(int bits) : words_(static_cast<std::size_t>((bits + 63) / 64)), bits_(bits) {}

  /// The first `bits` bits of 32-bit words, least significant word first.
  static Record from_words(const std::uint32_t* words, int bits);

  int bits() const { return bits_; }
  /// ceil(bits/64) words, bit 0 of the record is bit 0 of the first one.
  std::uint64_t* words() { return words_.data(); }

  /// Bits [position +: width], width 1-64, inside the record.
  std::uint64_t get(int position, int width) const;
  std::int64_t get_signed(int position, int width) const {
    return static_cast<std::int64_t>(get(position, width) << (64 - width)) >> (64 - width);
  }
  /// Writes the low `width` bits of value.
  void set(int position, int width, std::uint64_t value);

  std::uint64_t get(const RecordField& f) const { return get(f.position, f.width); }
  std::int64_t get_signed(const RecordField& f) const { return get_signed(f.position, f.width); }
  void set(const RecordField& f, std::uint64_t value) { set(f.position, f.width, value); }

  /// ceil(bits/4) lower-case digits, most significant first.
  std::string to_hex() const;
  /// Throws HexError for another number of digits, another character, or a bit set above `bits`.
  static Record from_hex(std::string_view digits, int bits);

  friend bool operator==(const Record&, const Record&) = default;

 private:
  std::vector<std::uint64_t> words_;  ///< bit 0 of the record is bit 0 of word 0
  int bits_ = 0;
};

/// Hexadecimal digits of `width` bits behind "0x", leading zeros included.
std::string hex(std::uint64_t value, int width);

/// The value of a field for people: "0x2a (42)", with the number that it stands for when it has fraction bits.
std::string describe(const Record& record, const RecordField& field);

/// The first (most significant) field in which two records differ, or nullptr.
const RecordField* first_different_field(const RecordLayout& layout, const Record& a, const Record& b);

/// The same as "field: expected …, actual …"; empty if none does.
std::string first_difference(const RecordLayout& layout, const Record& expected, const Record& actual);

}  // namespace quadrille
