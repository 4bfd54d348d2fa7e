// One list of fields, four uses: layout, pack, unpack. A list calls f(type, index, value) for every field, the most
// significant first; arrays come from the last element down.
#pragma once

#include "golden/suites/record.hpp"

#include <bit>
#include <concepts>
#include <cstdint>
#include <optional>
#include <type_traits>

namespace quadrille::vectors {

/// A field, or each element of an array.
struct FieldType {
  const char* name;
  int width;
  bool is_signed = false;
  std::optional<int> fraction_bits;
  const char* unit = "";
  const char* meaning = "";
};

/// Collects a layout.
struct LayoutLister {
  RecordLayout layout;
  template <class T>
  void operator()(const FieldType& type, int index, const T&) {
    layout.add({type.name, index, type.width, 0, type.is_signed, type.fraction_bits, type.unit, type.meaning,
                std::same_as<T, double> ? "ieee754-binary64" : ""});
  }
};

/// Bits of a field's value: a double is its IEEE-754 pattern.
template <class T>
std::uint64_t field_bits(const T& value) {
  if constexpr (std::same_as<T, double>)
    return std::bit_cast<std::uint64_t>(value);
  else
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(value));
}

class RecordPacker {
 public:
  explicit RecordPacker(int bits) : record_(bits), position_(bits) {}
  template <class T>
  void operator()(const FieldType& type, int, const T& value) {
    position_ -= type.width;
    record_.set(position_, type.width, field_bits(value));
  }
  Record take() { return std::move(record_); }

 private:
  Record record_;
  int position_;
};

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

/// An array whose element i is get(i).
template <class F, class Get>
void visit_array(F&& f, const FieldType& type, int count, Get&& get) {
  for (int i = count; i-- > 0;) f(type, i, get(static_cast<std::size_t>(i)));
}

/// Names of the fields of significand numbers; `neg` nullptr: magnitudes.
struct FpType {
  const char *neg, *exp, *sig;
  int exp_bits, significand_bits;
  const char* unit;
  const char* meaning;

  FieldType neg_type() const { return {neg, 1, false, {}, "", "sign of the number that sig holds"}; }
  FieldType exp_type() const { return {exp, exp_bits, true, {}, "log2", "exponent of the number that sig holds"}; }
  FieldType sig_type() const { return {sig, significand_bits, false, significand_bits - 1, unit, meaning}; }
};

/// Arrays of signs, exponents and significands of `count` numbers (Fp or PortNumber).
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

}  // namespace quadrille::vectors
