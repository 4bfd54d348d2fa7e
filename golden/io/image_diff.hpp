// How two EXR pictures differ.
#pragma once

#include "golden/io/exr.hpp"
#include "golden/io/png.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace quadrille::golden {

/// One channel of both pictures. Two NaNs are equal. A NaN against a number differs: it counts in `count` and `nans`,
/// and has no size, so that max, rms, x and y are of the other pixels.
struct ChannelDiff {
  std::string name;
  double max = 0, rms = 0;      ///< of |a − b| over all pixels (uint channels: of the numbers)
  std::uint64_t count = 0;      ///< pixels that differ
  int x = -1, y = -1;           ///< where the largest difference is, the first of equal ones; -1 without any
  std::uint64_t nans = 0;       ///< pixels with a NaN on one side
  int nan_x = -1, nan_y = -1;   ///< the first of them
  double nan_a = 0, nan_b = 0;  ///< its values
};

struct ImageDiff {
  int width = 0, height = 0;
  std::vector<ChannelDiff> channels;        ///< in the order of names
  std::vector<std::string> only_a, only_b;  ///< channels that the other does not have
  std::vector<float> largest;               ///< largest difference of a float channel at each pixel

  bool same() const;
};

/// Throws InputError for pictures of different sizes (`a_name`, `b_name` are for the message).
ImageDiff diff_images(const ExrImage& a, const ExrImage& b, const std::string& a_name, const std::string& b_name);

/// A difference as a colour: black for 0, then from dark violet (most·2^-octaves and below) to yellow (most and above)
/// on a logarithmic scale; white for what is not finite.
std::array<std::uint8_t, 3> heat_colour(double value, double most, int octaves);

/// The largest differences as colours: black where there is none, then from dark violet to yellow on a logarithmic
/// scale from max·2^-16 to max; white for what is not finite. The scale is below (heat_scale.hpp).
Image8 heat_map(const ImageDiff& diff);

}  // namespace quadrille::golden
