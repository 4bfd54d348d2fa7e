// Fragments as records of one block of memory, which becomes a structured NumPy array without a copy.
#pragma once

#include "model/port/config.hpp"
#include "model/port/records.hpp"
#include "tb/engines/engine.hpp"

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace quadrille::python {

/// A field of a record: `format` as NumPy writes it, such as "u4" or "f8".
struct RecordField {
  std::string name, format;
  std::size_t offset = 0;
};

/// What a record holds: quad, x, y, front, flags; depth; weights l0 to l3; attributes by their names. Values are
/// doubles; of the machine each has its code beside it (`depth_code`, `u_code`), the integer of the output format.
struct RecordContents {
  bool depth = true, weights = false, codes = false;
  std::vector<std::string> attributes;
};

/// Grows as fragments are added. Throws std::bad_alloc.
class FragmentRecords {
 public:
  FragmentRecords(const Config& config, const RecordContents& contents);

  /// Fields in the order in which they are shown.
  const std::vector<RecordField>& fields() const { return fields_; }
  std::size_t record_bytes() const { return bytes_; }
  std::size_t size() const { return size_; }

  void add(const tb::QuadFragments& quad);
  void add(std::span<const tb::EngineSample> samples);
  /// Of the clocked model; without weights.
  void add(const Fragment& fragment);

  struct Free {
    void operator()(std::byte* memory) const { std::free(memory); }
  };
  using Memory = std::unique_ptr<std::byte, Free>;
  /// The records; none are left.
  Memory release();

 private:
  struct Value {
    std::size_t column, real, code;  ///< column as in tb::Pass; offsets
  };

  std::size_t add_field(const std::string& name, const std::string& format, std::size_t bytes);
  /// Places for `count` more.
  std::byte* extend(std::size_t count);
  void put_code(std::byte* at, std::int64_t code) const;

  std::vector<RecordField> fields_;
  std::size_t bytes_ = 0, size_ = 0, capacity_ = 0;
  Memory memory_;
  bool codes_ = false, wide_codes_ = false;
  double depth_unit_, attribute_unit_;
  std::size_t depth_ = 0, depth_code_ = 0;  ///< offsets, 0: not there
  std::vector<Value> values_;
};

}  // namespace quadrille::python
