#include "golden/io/frame_image.hpp"

#include "golden/io/error.hpp"
#include "golden/io/npy.hpp"
#include "golden/io/png.hpp"

#include <stdexcept>

namespace quadrille::golden {

FrameImage::FrameImage(int frame_width, int frame_height) : width(frame_width), height(frame_height) {
  if (width < 1 || height < 1 || width > max_image_side || height > max_image_side) {
    throw InputError("frame size " + std::to_string(width) + "x" + std::to_string(height) + " is impossible; 1 to " +
                     std::to_string(max_image_side) + " pixels a side are expected");
  }
  for (std::vector<float>* channel : {&r, &g, &b, &a, &lambda[0], &lambda[1], &lambda[2], &lambda[3]})
    channel->assign(pixels(), 0.0f);
  z.assign(pixels(), 1.0f);
  quad.assign(pixels(), no_quad);
}

std::map<std::string, const std::vector<float>*> float_channels(const FrameImage& frame) {
  std::map<std::string, const std::vector<float>*> channels{
      {"R", &frame.r}, {"G", &frame.g}, {"B", &frame.b}, {"A", &frame.a}, {"Z", &frame.z}};
  for (std::size_t i = 0; i < 4; ++i) channels["L" + std::to_string(i)] = &frame.lambda[i];
  for (const auto& [name, values] : frame.error) channels["error." + name] = &values;
  for (const auto& [name, values] : frame.layer) channels[name] = &values;
  const auto check = [&](const std::string& name, std::size_t size) {
    if (size != frame.pixels()) throw std::logic_error("FrameImage: channel " + name + " has not one value per pixel");
  };
  for (const auto& [name, values] : channels) check(name, values->size());
  check("quad", frame.quad.size());
  return channels;
}

void save_frame_npz(const std::string& path, const FrameImage& frame) {
  const std::vector<std::size_t> shape{static_cast<std::size_t>(frame.height), static_cast<std::size_t>(frame.width)};
  std::vector<NpzArray> arrays;
  for (const auto& [name, values] : float_channels(frame)) arrays.push_back(npz_column(name, "<f4", *values));
  arrays.push_back(npz_column("quad", "<u4", frame.quad));
  for (NpzArray& array : arrays) array.shape = shape;
  save_npz(path, arrays);
}

}  // namespace quadrille::golden
