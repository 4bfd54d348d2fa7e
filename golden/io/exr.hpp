// OpenEXR pictures.
#pragma once

#include "golden/io/frame_image.hpp"

#include <map>
#include <span>
#include <string>
#include <vector>

namespace quadrille::golden {

/// Writes float channels R G B A Z L0 L1 L2 L3, uint `quad` and a float `error.<name>` for each error layer, `<name>`
/// for each other one. Lossless (PIZ), without time stamps: the bytes depend on the values and OpenEXR's version.
/// Throws InputError when writing fails; an older file then stays.
void save_exr(const std::string& path, const FrameImage& frame);

/// Channels by name, width × height values each, rows from the top; half-precision channels become float.
struct ExrImage {
  int width = 0, height = 0;
  std::map<std::string, std::vector<float>> floats;
  std::map<std::string, std::vector<std::uint32_t>> uints;
};

/// Reads the named channels, or all of them when no name is given, from any single-part scan line or tiled file. Throws
/// InputError for a file that cannot be read, is damaged or is larger than max_image_side, and for channels that it
/// does not have or that are subsampled.
ExrImage load_exr(const std::string& path, std::span<const std::string> channels = {});

}  // namespace quadrille::golden
