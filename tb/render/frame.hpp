// A frame: which fragment each pixel shows, and what it looks like.
#pragma once

#include "golden/io/frame_image.hpp"
#include "golden/io/png.hpp"
#include "golden/scenes/mesh.hpp"
#include "tb/engines/engine.hpp"
#include "tb/options/input.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace quadrille::tb {

/// Depth test over samples in draw order: LESS against 1 at first, so of equal depths the earlier quad stays. With
/// depth off the later quad stays. An undefined sample (float engine) shows only where nothing else does.
class FrameBuffer {
 public:
  FrameBuffer(int width, int height, bool depth);

  void add(std::span<const EngineSample> samples);
  /// For attributes that come in a later pass over the same quads: writes the columns into the sample that the pixel
  /// shows, if it is of the same quad of the draw.
  void amend(const Fragment& fragment, std::uint32_t index, const Pass& pass, const Config& config);

  bool drawn(int x, int y) const { return at(x, y).drawn; }
  const EngineSample& shown(int x, int y) const { return at(x, y).sample; }
  int width() const { return width_; }
  int height() const { return height_; }
  std::uint64_t fragments() const { return fragments_; }
  std::uint64_t undefined() const { return undefined_; }
  std::uint64_t pixels_drawn() const;

 private:
  struct Pixel {
    bool drawn = false;
    EngineSample sample;
  };
  const Pixel& at(int x, int y) const {
    return pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
  }

  int width_, height_;
  bool depth_;
  std::vector<Pixel> pixels_;
  std::uint64_t fragments_ = 0, undefined_ = 0;
};

/// Colour of a texture at (u, v); v up.
using TextureFunction = std::function<golden::Vec3(double u, double v)>;

/// The texture of a PNG file, or the input's own pattern when `file` is empty.
TextureFunction make_texture(const std::string& file, const DrawInput& input);

/// What a shading takes from its input. The numbers are slots among the attributes, -1 for none.
struct ShadeSlots {
  int uv = -1, normal = -1;
  int position = -1, colour = -1;
  golden::CuttingPlanes planes;      ///< for planes
  std::vector<golden::Vec3> facets;  ///< for planes: a normal of every quad of the draw, of any length
};
/// Throws UsageError when the shading needs what the input does not have. Texture coordinates of a quads file are its
/// first two attributes, a normal the first three (of three or four) or those from the third (of five and more);
/// without attributes the quad is the unit square.
ShadeSlots shade_slots(const std::string& shade, const DrawInput& input);

struct ShadeSettings {
  std::string shade;  ///< one of shade_modes()
  ShadeSlots slots;
  TextureFunction texture;  ///< for texture
  Lighting lighting;
  bool depth = true;
  unsigned threads = 1;
};

/// Colours, depths, weights and ids of a frame.
golden::FrameImage shade_frame(const FrameBuffer& frame, const ShadeSettings& settings);

/// Adds the layers L0-L3: weight minus the truth's, of the shown fragments, on snapped input or on the given one.
void add_error_layers(const FrameBuffer& frame, std::span<const WindowQuad> quads, const Config& config,
                      const DrawState& state, bool snap, unsigned threads, golden::FrameImage& image);

/// 8 bits a channel over a neutral background, opaque.
golden::Image8 frame_picture(const golden::FrameImage& image);
void save_frame_png(const std::string& path, const golden::FrameImage& image);

}  // namespace quadrille::tb
