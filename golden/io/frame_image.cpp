#include "golden/io/frame_image.hpp"

#include "golden/io/error.hpp"
#include "golden/io/png.hpp"

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

}  // namespace quadrille::golden
