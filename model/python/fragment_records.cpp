#include "model/python/fragment_records.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <new>

namespace quadrille::python {
namespace {

constexpr std::size_t quad_at = 0, x_at = 4, y_at = 6, front_at = 8, flags_at = 10, first_free = 12;

template <class T>
void put(std::byte* at, T value) {
  std::memcpy(at, &value, sizeof value);
}

/// The first touch of each page costs more than drawing what fits on it.
void ask_for_large_pages([[maybe_unused]] std::byte* memory, [[maybe_unused]] std::size_t bytes) {
#ifdef MADV_HUGEPAGE
  constexpr std::uintptr_t page = 1 << 21;
  const std::uintptr_t first = (reinterpret_cast<std::uintptr_t>(memory) + page - 1) / page * page;
  const std::uintptr_t last = (reinterpret_cast<std::uintptr_t>(memory) + bytes) / page * page;
  if (first < last) static_cast<void>(madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE));
#endif
}

}  // namespace

FragmentRecords::FragmentRecords(const Config& config, const RecordContents& contents)
    : codes_(contents.codes),
      wide_codes_(config.attr_out_bits() > 32),
      depth_unit_(std::ldexp(1.0, -config.depth_bits)),
      attribute_unit_(std::ldexp(1.0, -config.attribute_frac())) {
  fields_ = {{"quad", "u4", quad_at},
             {"x", "u2", x_at},
             {"y", "u2", y_at},
             {"front", "?", front_at},
             {"flags", "u2", flags_at}};
  // Codes first: fields stand in the order of their offsets, as numpy.save wants them.
  std::size_t code_at = first_free;
  const auto add_code = [&](const std::string& name, const char* format, std::size_t bytes) {
    code_at = (code_at + bytes - 1) / bytes * bytes;
    fields_.push_back({name + "_code", format, code_at});
    code_at += bytes;
    return code_at - bytes;
  };
  if (codes_ && contents.depth) depth_code_ = add_code("depth", "u4", 4);
  std::vector<std::pair<std::string, std::size_t>> columns;
  if (contents.weights)
    for (std::size_t i = 0; i < 4; ++i) columns.emplace_back("l" + std::to_string(i), i);
  for (std::size_t j = 0; j < contents.attributes.size(); ++j) columns.emplace_back(contents.attributes[j], 4 + j);
  for (const auto& [name, column] : columns)
    values_.push_back({column, 0, codes_ ? add_code(name, wide_codes_ ? "i8" : "i4", wide_codes_ ? 8 : 4) : 0});
  bytes_ = (code_at + 7) / 8 * 8;
  if (contents.depth) depth_ = add_field("depth", "f8", 8);
  for (std::size_t i = 0; i < columns.size(); ++i) values_[i].real = add_field(columns[i].first, "f8", 8);
}

std::size_t FragmentRecords::add_field(const std::string& name, const std::string& format, std::size_t bytes) {
  fields_.push_back({name, format, bytes_});
  bytes_ += bytes;
  return bytes_ - bytes;
}

std::byte* FragmentRecords::extend(std::size_t count) {
  if (size_ + count > capacity_) {
    // Pages that are never written cost nothing; growing costs as much as drawing.
    constexpr std::size_t first_places = 1 << 21;
    const std::size_t capacity = std::max({size_ + count, 2 * capacity_, first_places});
    auto* const larger = static_cast<std::byte*>(std::realloc(memory_.get(), capacity * bytes_));
    if (larger == nullptr) throw std::bad_alloc();
    static_cast<void>(memory_.release());
    memory_.reset(larger);
    capacity_ = capacity;
    ask_for_large_pages(larger, capacity * bytes_);
  }
  std::byte* const at = memory_.get() + size_ * bytes_;
  size_ += count;
  return at;
}

void FragmentRecords::put_code(std::byte* at, std::int64_t code) const {
  if (wide_codes_)
    put(at, code);
  else
    put(at, static_cast<std::int32_t>(code));
}

void FragmentRecords::add(const tb::QuadFragments& quad) {
  const FragmentArrays& common = quad.common;
  std::byte* at = extend(common.size);
  // A field at a time, of as many records as the first cache holds.
  constexpr std::size_t block = 128;
  for (std::size_t first = 0; first < common.size; first += block, at += block * bytes_) {
    const std::size_t n = std::min(block, common.size - first);
    for (std::size_t i = 0; i < n; ++i) {
      std::byte* const record = at + i * bytes_;
      put(record + quad_at, quad.quad);
      put(record + x_at, common.place[first + i]);
      put(record + front_at, std::array{common.marks[first + i].front, false});
      put(record + flags_at, static_cast<std::uint16_t>(common.marks[first + i].flags));
    }
    if (depth_ != 0) {
      const std::uint32_t* const depth = common.depth + first;
      for (std::size_t i = 0; i < n; ++i) {
        put(at + i * bytes_ + depth_code_, depth[i]);
        put(at + i * bytes_ + depth_, depth[i] * depth_unit_);
      }
    }
    for (const Value& value : values_) {
      const std::int64_t* const code = quad.column[value.column] + first;
      for (std::size_t i = 0; i < n; ++i) {
        put(at + i * bytes_ + value.real, static_cast<double>(code[i]) * attribute_unit_);
        put_code(at + i * bytes_ + value.code, code[i]);
      }
    }
  }
}

void FragmentRecords::add(std::span<const tb::EngineSample> samples) {
  std::byte* record = extend(samples.size());
  for (const tb::EngineSample& sample : samples) {
    put(record + quad_at, sample.quad);
    put(record + x_at, FragmentPlace{sample.x, sample.y});
    put(record + front_at, std::array{sample.front, false});
    put(record + flags_at, static_cast<std::uint16_t>(sample.flags | (sample.undefined ? tb::flag_undefined : 0u)));
    if (depth_ != 0) put(record + depth_, sample.z);
    for (const Value& value : values_)
      put(record + value.real, value.column < 4 ? sample.lambda[value.column] : sample.attribute[value.column - 4]);
    record += bytes_;
  }
}

void FragmentRecords::add(const Fragment& fragment) {
  const FragmentPlace place{fragment.x, fragment.y};
  const FragmentMarks marks{fragment.front, fragment.flags};
  tb::QuadFragments quad;
  quad.quad = fragment.quad;
  quad.common = {fragment.quad, 1, &place, &marks, &fragment.depth, 0, {}};
  for (const Value& value : values_) quad.column[value.column] = &fragment.attribute[value.column - 4];
  add(quad);
}

FragmentRecords::Memory FragmentRecords::release() {
  // What was reserved and not written is given back. A small block moves: one of few pages is no mapping of its own.
  constexpr std::size_t small = 1 << 17;
  const std::size_t bytes = size_ * bytes_;
  if (bytes != 0 && bytes < small) {
    auto* const moved = static_cast<std::byte*>(std::malloc(bytes));
    if (moved == nullptr) throw std::bad_alloc();
    std::memcpy(moved, memory_.get(), bytes);
    memory_.reset(moved);
  } else if (bytes != 0 && size_ != capacity_) {
    if (auto* const exact = static_cast<std::byte*>(std::realloc(memory_.get(), bytes)); exact != nullptr) {
      static_cast<void>(memory_.release());
      memory_.reset(exact);
    }
  }
  size_ = capacity_ = 0;
  return std::move(memory_);
}

}  // namespace quadrille::python
