// One list of fields, four uses: layout, pack, unpack, tables for people. A list calls f(type, index, value) for every
// field, the most significant first; arrays come from the last element down. model/port/boundaries.hpp has the lists.
#pragma once

#include "model/port/record.hpp"

#include <bit>
#include <concepts>
#include <cstdint>
#include <optional>
#include <utility>

namespace quadrille {

/// A width or a number of fraction bits, with what rtl/SPEC.md calls it (nullptr: it is the same in every
/// configuration).
struct Bits {
  constexpr Bits(int v, const char* s = nullptr) : value(v), symbol(s) {}
  constexpr operator int() const { return value; }

  int value;
  const char* symbol;
};

/// A field, or each element of an array.
struct FieldType {
  const char* name;
  Bits width;
  bool is_signed = false;  ///< two's complement
  std::optional<Bits> fraction_bits{};
  const char* unit = "";
  const char* meaning = "";
  // Where a probe finds it (tb/device/probes.cpp).
  const char* signal = nullptr;  ///< of the RTL, in its boundary's scope unless it has a dot; nullptr: the name
  const char* active = nullptr;  ///< a wire: while it is low the probe shows 0
  int element = -1;              ///< its first element of the array `signal`; -1: all of it

  /// The same field, found there.
  constexpr FieldType at(const char* where) const {
    FieldType type = *this;
    type.signal = where;
    return type;
  }
};

/// An unsigned field.
constexpr FieldType plain(const char* name, Bits width, const char* meaning, const char* unit = "") {
  return {name, width, false, {}, unit, meaning};
}
/// A number in two's complement with fraction bits.
constexpr FieldType fixed(const char* name, Bits width, Bits fraction, const char* unit, const char* meaning) {
  return {name, width, true, fraction, unit, meaning};
}
/// The same field of which a list has something else to say.
constexpr FieldType reworded(FieldType type, const char* meaning) {
  type.meaning = meaning;
  return type;
}

/// Collects a layout.
struct LayoutLister {
  RecordLayout layout;
  template <class T>
  void operator()(const FieldType& type, int index, const T&) {
    layout.add({type.name, index, type.width, 0, type.is_signed,
                type.fraction_bits ? std::optional<int>(*type.fraction_bits) : std::nullopt, type.unit, type.meaning,
                std::same_as<T, double> ? "ieee754-binary64" : ""});
  }
};

/// Bits of a field's value: a double is its IEEE-754 pattern.
template <class T>
constexpr std::uint64_t field_bits(const T& value) {
  if constexpr (std::same_as<T, double>)
    return std::bit_cast<std::uint64_t>(value);
  else
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(value));
}

/// Packs fields from the most significant one down into ceil(width/64) words, bit 0 of the record in bit 0 of the first
/// word. Every bit of these is written.
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

  template <class T>
  void operator()(const FieldType& type, int, const T& value) {
    put(type.width, field_bits(value));
  }

  /// Writes the last word. All fields must have been put.
  void finish() { *word_ = bits_; }

 private:
  std::uint64_t* word_;
  std::uint64_t bits_ = 0;
  int free_;  ///< bits of *word_ below the last field
};

/// Gives fields the values that a record holds.
class RecordUnpacker {
 public:
  explicit RecordUnpacker(const Record& record) : record_(record), position_(record.bits()) {}
  template <class T>
  void operator()(const FieldType& type, int, T& value) {
    position_ -= type.width;
    if constexpr (std::same_as<T, double>)
      value = std::bit_cast<double>(record_.get(position_, type.width));
    else
      value = type.is_signed ? static_cast<T>(record_.get_signed(position_, type.width))
                             : static_cast<T>(record_.get(position_, type.width));
  }

 private:
  const Record& record_;
  int position_;
};

/// The layout of the fields that list(f) lists.
template <class List>
RecordLayout layout_of(List&& list) {
  LayoutLister lister;
  list(lister);
  return std::move(lister.layout);
}

/// Their values in a record of `bits` bits, which is what they have.
template <class List>
Record pack_record(int bits, List&& list) {
  Record record(bits);
  BitPacker packer(record.words(), bits);
  list(packer);
  packer.finish();
  return record;
}

/// An array whose element i is get(i).
template <class F, class Get>
void visit_array(F&& f, const FieldType& type, int count, Get&& get) {
  for (int i = count; i-- > 0;) f(type, i, get(static_cast<std::size_t>(i)));
}

/// Names of the fields of significand numbers; `neg` nullptr: magnitudes.
struct FpType {
  const char *neg, *exp, *sig;
  Bits exp_bits, significand_bits;
  const char* meaning;
  // As FieldType's; with an element the arrays are neg, exp and sig.
  const char* active = nullptr;
  int element = -1;

  FieldType neg_type() const { return found("neg", plain(neg, 1, "sign of the number that sig holds")); }
  FieldType exp_type() const {
    return found("exp", {exp, exp_bits, true, {}, "log2", "exponent of the number that sig holds"});
  }
  FieldType sig_type() const {
    return found("sig", {sig, significand_bits, false, Bits{significand_bits - 1, "S−1"}, "1", meaning});
  }
  FpType while_active(const char* wire) const {
    FpType type = *this;
    type.active = wire;
    return type;
  }
  FpType from_element(int first) const {
    FpType type = *this;
    type.element = first;
    return type;
  }

 private:
  FieldType found(const char* array, FieldType type) const {
    if (element >= 0) type.signal = array;
    type.active = active;
    type.element = element;
    return type;
  }
};

/// Arrays of signs, exponents and significands of `count` numbers (PipelineFloat or PortNumber).
template <class F, class Get>
void visit_numbers(F&& f, const FpType& type, int count, Get&& get) {
  if (type.neg != nullptr)
    visit_array(
        f, type.neg_type(), count, [&](std::size_t i) -> auto& { return get(i).neg; });
  visit_array(
      f, type.exp_type(), count, [&](std::size_t i) -> auto& { return get(i).exp; });
  visit_array(
      f, type.sig_type(), count, [&](std::size_t i) -> auto& { return get(i).sig; });
}

/// The fields of one number.
template <class F, class Number>
void visit_number(F&& f, const FpType& type, Number& number) {
  if (type.neg != nullptr) f(type.neg_type(), -1, number.neg);
  f(type.exp_type(), -1, number.exp);
  f(type.sig_type(), -1, number.sig);
}

}  // namespace quadrille
