#include "model/port/record.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace quadrille {
namespace {

constexpr std::string_view hex_digits = "0123456789abcdef";

constexpr std::uint64_t low_bits(int width) { return ~std::uint64_t{0} >> (64 - width); }

std::string shortest(double value) {
  std::array<char, 40> buffer{};
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return error == std::errc{} ? std::string(buffer.data(), end) : std::string("?");
}

}  // namespace

void RecordLayout::add(RecordField field) {
  if (field.width < 1 || field.width > 64)
    throw std::invalid_argument("field " + field.label() + " has " + std::to_string(field.width) +
                                " bits; a field has 1 to 64");
  for (RecordField& above : fields_) above.position += field.width;
  bits_ += field.width;
  field.position = 0;
  fields_.push_back(std::move(field));
}

void RecordLayout::add_array(const RecordField& element, int count) {
  for (int i = count; i-- > 0;) {
    RecordField f = element;
    f.index = i;
    add(std::move(f));
  }
}

const RecordField& RecordLayout::field(std::string_view name, int index) const {
  const auto found = std::find_if(fields_.begin(), fields_.end(),
                                  [&](const RecordField& f) { return f.name == name && f.index == index; });
  if (found == fields_.end())
    throw std::out_of_range("no field " + std::string(name) + "[" + std::to_string(index) + "]");
  return *found;
}

Record Record::from_words(const std::uint32_t* words, int bits) {
  Record record(bits);
  for (int at = 0; at < bits; at += 32) record.set(at, std::min(32, bits - at), words[at / 32]);
  return record;
}

std::uint64_t Record::get(int position, int width) const {
  const auto word = static_cast<std::size_t>(position / 64);
  const int shift = position % 64;
  std::uint64_t value = words_[word] >> shift;
  if (shift + width > 64) value |= words_[word + 1] << (64 - shift);
  return value & low_bits(width);
}

void Record::set(int position, int width, std::uint64_t value) {
  const auto word = static_cast<std::size_t>(position / 64);
  const int shift = position % 64;
  value &= low_bits(width);
  words_[word] = (words_[word] & ~(low_bits(width) << shift)) | value << shift;
  if (shift + width > 64) {
    const int rest = shift + width - 64;
    words_[word + 1] = (words_[word + 1] & ~low_bits(rest)) | value >> (64 - shift);
  }
}

std::string Record::to_hex() const {
  std::string text(static_cast<std::size_t>((bits_ + 3) / 4), '0');
  for (std::size_t i = 0; i < text.size(); ++i)
    text[text.size() - 1 - i] = hex_digits[words_[i / 16] >> (4 * (i % 16)) & 15u];
  return text;
}

Record Record::from_hex(std::string_view digits, int bits) {
  Record record(bits);
  const auto expected = static_cast<std::size_t>((bits + 3) / 4);
  if (digits.size() != expected)
    throw HexError("has " + std::to_string(digits.size()) + " characters; a record of " + std::to_string(bits) +
                   " bits has " + std::to_string(expected) + " digits");
  for (std::size_t i = 0; i < digits.size(); ++i) {
    const std::size_t value = hex_digits.find(digits[digits.size() - 1 - i]);
    if (value == std::string_view::npos)
      throw HexError("column " + std::to_string(digits.size() - i) + " is not a lower-case hexadecimal digit");
    record.words_[i / 16] |= static_cast<std::uint64_t>(value) << (4 * (i % 16));
  }
  if (bits % 64 != 0 && record.words_.back() >> (bits % 64) != 0)
    throw HexError("has a bit set above bit " + std::to_string(bits - 1));
  return record;
}

std::string hex(std::uint64_t value, int width) {
  std::string text = "0x";
  for (int digit = (width + 3) / 4; digit-- > 0;) text += hex_digits[value >> (4 * digit) & 15u];
  return text;
}

std::string describe(const Record& record, const RecordField& field) {
  const std::uint64_t raw = record.get(field);
  std::string text = hex(raw, field.width);
  const std::int64_t value = record.get_signed(field);
  text += " (" + (field.is_signed ? std::to_string(value) : std::to_string(raw));
  if (field.fraction_bits && *field.fraction_bits != 0) {
    const double number = field.is_signed ? static_cast<double>(value) : static_cast<double>(raw);
    text += " = " + shortest(std::ldexp(number, -*field.fraction_bits));
  }
  return text + ")";
}

const RecordField* first_different_field(const RecordLayout& layout, const Record& a, const Record& b) {
  const auto found = std::ranges::find_if(layout.fields(), [&](const RecordField& f) { return a.get(f) != b.get(f); });
  return found == layout.fields().end() ? nullptr : &*found;
}

std::string first_difference(const RecordLayout& layout, const Record& expected, const Record& actual) {
  const RecordField* f = first_different_field(layout, expected, actual);
  return f == nullptr ? std::string()
                      : f->label() + ": expected " + describe(expected, *f) + ", actual " + describe(actual, *f);
}

}  // namespace quadrille
