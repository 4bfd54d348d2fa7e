#include "tb/support/error_stats.hpp"

namespace quadrille::tb {

void LogHistogram::merge(const LogHistogram& other) {
  for (std::size_t i = 0; i < bins_.size(); ++i) bins_[i] += other.bins_[i];
  total_ += other.total_;
}

double LogHistogram::quantile(double q) const {
  if (total_ == 0) return 0;
  const auto rank = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::ceil(q * static_cast<double>(total_))));
  std::uint64_t seen = 0;
  for (int i = 0; i < bin_count; ++i) {
    seen += bins_[static_cast<std::size_t>(i)];
    if (seen < rank) continue;
    if (i == 0) return 0;
    const int octave = (i - 1) / bins_per_octave, step = (i - 1) % bins_per_octave + 1;
    return std::ldexp(1.0 + static_cast<double>(step) / bins_per_octave, octave + octave_min);
  }
  return 0;
}

void ErrorStats::merge(const ErrorStats& other) {
  histogram_.merge(other.histogram_);
  if (!(other.max_ <= max_) && !std::isnan(max_)) max_ = other.max_;
  sum_ += other.sum_;
  squares_ += other.squares_;
}

double ErrorStats::p999() const { return std::min(histogram_.quantile(0.999), max_); }

double ErrorStats::mean() const {
  if (count() == 0) return 0;
  return std::ldexp(static_cast<double>(sum_), -sum_frac) / static_cast<double>(count());
}

double ErrorStats::rms() const {
  if (count() == 0) return 0;
  return std::sqrt(std::ldexp(static_cast<double>(squares_), -square_frac) / static_cast<double>(count()));
}

}  // namespace quadrille::tb
