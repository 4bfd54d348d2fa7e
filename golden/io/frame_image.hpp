// A rendered frame in floating point, with what is known about each pixel.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace quadrille::golden {

/// FrameImage::quad where nothing was drawn.
inline constexpr std::uint32_t no_quad = 0xffffffff;

/// Channels of width × height values, rows from the top, pixels from the left.
struct FrameImage {
  /// Black, transparent, depth 1 (the far plane), weights 0, no_quad. Throws InputError for sizes
  /// outside 1..max_image_side.
  FrameImage(int frame_width, int frame_height);

  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }

  int width, height;
  std::vector<float> r, g, b, a;
  std::vector<float> z;                      ///< window z in [0, 1]
  std::array<std::vector<float>, 4> lambda;  ///< weights of the four vertices
  std::vector<std::uint32_t> quad;           ///< quad id
  std::map<std::string, std::vector<float>>
      error;  ///< optional layers, named by the channel they judge: "L0" becomes `error.L0`
  std::map<std::string, std::vector<float>> layer;  ///< further ones, by their own names
};

/// The channels by the names that picture files have: R G B A Z L0 to L3, error.NAME, further layers; quad apart.
/// Throws std::logic_error for one that has not one value per pixel.
std::map<std::string, const std::vector<float>*> float_channels(const FrameImage& frame);

/// The channels as arrays of (height, width) for numpy.load(): float32, quad uint32. Throws as save_npz() does.
void save_frame_npz(const std::string& path, const FrameImage& frame);

}  // namespace quadrille::golden
