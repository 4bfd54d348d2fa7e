// Fragments of one quad in arrays, a value's numbers one after the other: what vector units write, and whoever reads
// only some of the values.
#pragma once

#include "model/port/records.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace quadrille {

struct FragmentPlace {
  std::uint16_t x = 0, y = 0;
};

struct FragmentMarks {
  bool front = false;
  std::uint8_t flags = 0;  ///< FragmentFlag
};

/// A view: `size` fragments of quad `quad`, in the machine's order. Formats are those of Fragment.
struct FragmentArrays {
  std::uint32_t quad = 0;
  std::size_t size = 0;
  const FragmentPlace* place = nullptr;
  const FragmentMarks* marks = nullptr;
  const std::uint32_t* depth = nullptr;  ///< zeros when depth is off
  int attributes = 0;                    ///< in use; an array each
  std::array<const std::int64_t*, max_attribute_slots> attribute{};

  Fragment operator[](std::size_t i) const {
    Fragment f;
    copy(i, f);
    return f;
  }
  /// All of them as records. What those have of attributes that are not in use stays.
  void copy_to(Fragment* records) const {
    for (std::size_t i = 0; i < size; ++i) copy(i, records[i]);
  }

 private:
  void copy(std::size_t i, Fragment& f) const {
    f.quad = quad;
    f.x = place[i].x;
    f.y = place[i].y;
    f.front = marks[i].front;
    f.flags = marks[i].flags;
    f.depth = depth[i];
    for (std::size_t j = 0; j < static_cast<std::size_t>(attributes); ++j) f.attribute[j] = attribute[j][i];
  }
};

/// Owns such arrays, of a fixed number of places.
class FragmentBuffer {
 public:
  FragmentBuffer() = default;
  FragmentBuffer(std::size_t places, int attributes)
      : attributes_(attributes), place_(places), marks_(places), depth_(places) {
    for (std::size_t j = 0; j < static_cast<std::size_t>(attributes); ++j) attribute_[j].resize(places);
  }

  std::size_t places() const { return place_.size(); }
  FragmentPlace* place() { return place_.data(); }
  FragmentMarks* marks() { return marks_.data(); }
  std::uint32_t* depth() { return depth_.data(); }
  std::int64_t* attribute(std::size_t j) { return attribute_[j].data(); }
  const FragmentMarks& marks(std::size_t i) const { return marks_[i]; }

  /// The first `size` places, of quad `quad`.
  FragmentArrays view(std::uint32_t quad, std::size_t size) const {
    FragmentArrays v{quad, size, place_.data(), marks_.data(), depth_.data(), attributes_, {}};
    for (std::size_t j = 0; j < static_cast<std::size_t>(attributes_); ++j) v.attribute[j] = attribute_[j].data();
    return v;
  }

  void put(std::size_t i, const Fragment& f) {
    place_[i] = {f.x, f.y};
    marks_[i] = {f.front, f.flags};
    depth_[i] = f.depth;
    for (std::size_t j = 0; j < static_cast<std::size_t>(attributes_); ++j) attribute_[j][i] = f.attribute[j];
  }

  void move(std::size_t from, std::size_t to) { copy(*this, from, to); }
  void copy(const FragmentBuffer& of, std::size_t from, std::size_t to) {
    place_[to] = of.place_[from];
    marks_[to] = of.marks_[from];
    depth_[to] = of.depth_[from];
    for (std::size_t j = 0; j < static_cast<std::size_t>(attributes_); ++j) attribute_[j][to] = of.attribute_[j][from];
  }

 private:
  int attributes_ = 0;
  std::vector<FragmentPlace> place_;
  std::vector<FragmentMarks> marks_;
  std::vector<std::uint32_t> depth_;
  std::array<std::vector<std::int64_t>, max_attribute_slots> attribute_;
};

}  // namespace quadrille
