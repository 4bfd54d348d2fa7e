// Exact arithmetic on the quads as they were given, unsnapped: once per input.
#pragma once

#include "tb/sweep/measured_columns.hpp"
#include "tb/sweep/work_units.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace quadrille::sweep {

/// The pixels that the given quads draw: covered, visible, not culled, window z in the interval (depth on).
class GivenTruth {
 public:
  GivenTruth(const SweepInput& input, unsigned threads, const Stop& stop = {});

  std::size_t pixels() const { return pixel_.size(); }
  /// Where quad `index`'s pixels begin; they rise by y, then x. `index` may be the number of quads.
  std::size_t first(std::size_t index) const { return first_[index]; }
  std::uint32_t pixel(std::size_t n) const { return pixel_[n]; }
  /// Window z, then the columns.
  const double* values(std::size_t n) const { return values_.data() + n * stride_; }
  std::size_t bytes() const { return pixel_.size() * (sizeof(std::uint32_t) + stride_ * sizeof(double)); }

 private:
  std::size_t stride_;
  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> pixel_;
  std::vector<double> values_;
};

}  // namespace quadrille::sweep
