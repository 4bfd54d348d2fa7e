#include "tb/commands/error_stats.hpp"

#include <algorithm>
#include <cmath>

namespace quadrille::cli {

int LogHistogram::index(double value) {
  const double magnitude = std::fabs(value);
  if (!(magnitude >= std::ldexp(1.0, octave_min))) return std::isnan(magnitude) ? bin_count - 1 : 0;
  if (magnitude >= std::ldexp(1.0, octave_max)) return bin_count - 1;
  int exponent = 0;
  const double mantissa = std::frexp(magnitude, &exponent);  // [1/2, 1)
  const int step = static_cast<int>((mantissa - 0.5) * 2 * bins_per_octave);
  return 1 + (exponent - 1 - octave_min) * bins_per_octave + step;
}

void LogHistogram::merge(const LogHistogram& other) {
  for (int i = 0; i < bin_count; ++i) bins_[i] += other.bins_[i];
  total_ += other.total_;
}

double LogHistogram::quantile(double q) const {
  if (total_ == 0) return 0;
  const auto rank = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::ceil(q * static_cast<double>(total_))));
  std::uint64_t seen = 0;
  for (int i = 0; i < bin_count; ++i) {
    seen += bins_[i];
    if (seen < rank) continue;
    if (i == 0) return 0;
    const int octave = (i - 1) / bins_per_octave, step = (i - 1) % bins_per_octave + 1;
    return std::ldexp(1.0 + static_cast<double>(step) / bins_per_octave, octave + octave_min);
  }
  return 0;
}

void ErrorStats::add(double error) {
  const double magnitude = std::fabs(error);
  histogram_.add(magnitude);
  if (!(magnitude <= max_)) max_ = magnitude;  // a NaN is kept, and then stays
  // Squares above 2^20 would not fit the sum; the maximum tells of such errors.
  const double square = std::min(magnitude * magnitude, 0x1p20);
  if (square == square) squares_ += static_cast<unsigned __int128>(std::ldexp(square, 96));
}

void ErrorStats::merge(const ErrorStats& other) {
  histogram_.merge(other.histogram_);
  if (!(other.max_ <= max_)) max_ = other.max_;
  squares_ += other.squares_;
}

double ErrorStats::p999() const { return std::min(histogram_.quantile(0.999), max_); }

double ErrorStats::rms() const {
  if (count() == 0) return 0;
  return std::sqrt(std::ldexp(static_cast<double>(squares_), -96) / static_cast<double>(count()));
}

}  // namespace quadrille::cli
