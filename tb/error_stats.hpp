// Statistics of errors that do not depend on the order in which they are added: maxima, a log histogram for quantiles,
// an integer sum for the root mean square. Two threads may each fill one and merge.
#pragma once

#include <array>
#include <cstdint>

namespace quadrille::cli {

/// Counts of values in bins of 1/16 octave from 2^-64 to 2^16; zero and smaller values share bin 0, larger ones the
/// last bin.
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
  static int index(double value);
  std::array<std::uint64_t, bin_count> bins_{};
  std::uint64_t total_ = 0;
};

/// Maximum, quantiles and root mean square of absolute errors.
class ErrorStats {
 public:
  void add(double error);
  void merge(const ErrorStats& other);
  std::uint64_t count() const { return histogram_.total(); }
  double max() const { return max_; }
  double p999() const;
  double rms() const;

 private:
  LogHistogram histogram_;
  double max_ = 0;
  unsigned __int128 squares_ = 0;  ///< sum of the squares in units of 2^-96, each truncated: exact addition, any order
};

}  // namespace quadrille::cli
