// PNG pictures with 8 bits a channel.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace quadrille::golden {

/// Largest width and height of a picture that is read or written.
inline constexpr int max_image_side = 16384;

/// Rows from the top, pixels from the left, 4 bytes each: R G B A, alpha not premultiplied.
struct Image8 {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;
};

enum class PngFormat { rgb8, rgba8 };

/// Reads any PNG colour type and depth, interlaced or not. Values as stored: no gamma or colour profile is applied;
/// 16-bit values are rounded to 8 bits, grey goes to all of R, G, B, opaque where nothing is said. Throws InputError
/// for what is not a complete PNG.
Image8 load_png(const std::string& path);

/// Writes without time stamps, with fixed compression settings: the same bytes for the same pixels and zlib. rgb8 drops
/// alpha. Throws InputError when writing fails (an older file then stays as it was) and for sizes
/// outside 1..max_image_side.
void save_png(const std::string& path, const Image8& image, PngFormat format);

}  // namespace quadrille::golden
