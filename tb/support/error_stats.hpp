// Statistics of errors that do not depend on the order in which they are added: maxima, a log histogram for quantiles,
// integer sums for the mean and the root mean square. Two threads may each fill one and merge.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace quadrille::tb {

/// Counts of values in bins of 1/16 octave from 2^-64 to 2^16; zero and smaller values share bin 0, larger ones and NaN
/// the last bin.
class LogHistogram {
 public:
  static constexpr int octave_min = -64, octave_max = 16, bins_per_octave = 16;
  static constexpr int bin_count = (octave_max - octave_min) * bins_per_octave + 2;

  void add(double value) { ++bins_[index(value)], ++total_; }
  void merge(const LogHistogram& other);
  std::uint64_t total() const { return total_; }
  /// Upper edge of the bin that holds the quantile `q` in (0, 1]; 0 when it lies in bin 0 or nothing was added.
  double quantile(double q) const;

 private:
  /// The exponent and the four leading fraction bits of a double are octave and step.
  static std::size_t index(double value) {
    constexpr std::int64_t first = (std::int64_t{1023} + octave_min) * bins_per_octave;
    const auto step = static_cast<std::int64_t>(std::bit_cast<std::uint64_t>(std::fabs(value)) >> 48);
    return static_cast<std::size_t>(std::clamp<std::int64_t>(step - first + 1, 0, bin_count - 1));
  }
  std::array<std::uint64_t, bin_count> bins_{};
  std::uint64_t total_ = 0;
};

/// Maximum, quantiles, mean and root mean square of absolute errors.
class ErrorStats {
 public:
  void add(double error) {
    const double magnitude = std::fabs(error);
    histogram_.add(magnitude);
    if (!(magnitude <= max_) && !std::isnan(max_)) max_ = magnitude;  // a NaN is kept, and then stays
    // Larger terms would not fit the sums; the maximum tells of such errors.
    sum_ += fixed(std::min(magnitude, 0x1p20), sum_frac);
    squares_ += fixed(std::min(magnitude * magnitude, 0x1p20), square_frac);
  }
  void merge(const ErrorStats& other);
  std::uint64_t count() const { return histogram_.total(); }
  double max() const { return max_; }
  double p999() const;
  double mean() const;
  double rms() const;

 private:
  using Wide = unsigned __int128;
  static constexpr int sum_frac = 80, square_frac = 96;

  /// 0 <= value <= 2^20 truncated to `frac` fraction bits; 0 for NaN.
  static Wide fixed(double value, int frac) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    const int exponent = static_cast<int>(bits >> 52);
    const std::uint64_t significand = (bits & ((std::uint64_t{1} << 52) - 1)) | std::uint64_t{1} << 52;
    const int shift = exponent - 1075 + frac;
    if (shift <= -53 || exponent == 0x7ff) return 0;
    return shift < 0 ? Wide{significand >> -shift} : Wide{significand} << shift;
  }

  LogHistogram histogram_;
  double max_ = 0;
  Wide sum_ = 0, squares_ = 0;  ///< in units of 2^-frac, each term truncated: exact addition, any order
};

/// Mean of signed errors: what truncation does on the average, which maxima do not show. Adding is exact, in any order.
class MeanError {
 public:
  /// |error| is taken as at most 2^20; NaN adds nothing but to the count.
  void add(double error) {
    ++count_;
    if (!std::isnan(error)) sum_ += static_cast<__int128>(std::ldexp(std::clamp(error, -0x1p20, 0x1p20), frac));
  }
  void merge(const MeanError& other) { sum_ += other.sum_, count_ += other.count_; }
  std::uint64_t count() const { return count_; }
  double mean() const {
    return count_ == 0 ? 0 : std::ldexp(static_cast<double>(sum_), -frac) / static_cast<double>(count_);
  }

 private:
  static constexpr int frac = 60;
  __int128 sum_ = 0;  ///< in units of 2^-frac, each term truncated
  std::uint64_t count_ = 0;
};

}  // namespace quadrille::tb
