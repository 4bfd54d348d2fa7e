// A frame: which fragment each pixel shows, and what it looks like.
#pragma once

#include "golden/io/frame_image.hpp"
#include "golden/io/png.hpp"
#include "golden/scenes/mesh.hpp"
#include "model/depth_image.hpp"
#include "tb/engines/engine.hpp"
#include "tb/options/input.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace quadrille::tb {

/// Depth test over fragments in draw order: LESS against 1 at first, so of equal depths the earlier quad stays. With
/// depth off the later quad stays. An undefined sample (float engine) shows only where nothing else does.
class FrameBuffer {
 public:
  /// `config`: of the machine, where fragments come as QuadFragments.
  FrameBuffer(int width, int height, bool depth, const Config& config = {}, int attributes = max_attribute_slots,
              bool weights = true);

  void add(std::span<const EngineSample> samples);
  void add(const QuadFragments& fragments);
  /// For attributes that come in a later pass over the same quads: writes the columns into the sample that the pixel
  /// shows, if it is of the same quad of the draw.
  void amend(const Fragment& fragment, std::uint32_t index, const Pass& pass, const Config& config);

  /// After the last fragment, before several threads look.
  void settle() const {
    attributes_.settle();
    if (weights_) weights_->settle();
  }
  bool drawn(int x, int y) const { return attributes_.quads()[at(x, y)] != DepthImage<double>::no_quad; }
  /// Without front and flags.
  EngineSample shown(int x, int y) const;
  int width() const { return attributes_.width(); }
  int height() const { return attributes_.height(); }
  std::uint64_t fragments() const { return fragments_; }
  std::uint64_t undefined() const { return undefined_; }
  std::uint64_t pixels_drawn() const;

 private:
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width()) + static_cast<std::size_t>(x);
  }
  void name(std::uint32_t index, std::uint32_t quad);
  void show(const EngineSample& sample);

  bool depth_;
  int attribute_count_;
  DepthImage<double> attributes_;              ///< its ids: positions of quads in the draw
  std::optional<DepthImage<double>> weights_;  ///< of the same depths
  std::vector<std::uint32_t> quad_of_index_;
  std::vector<std::uint8_t> shows_undefined_;
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

/// Whether the colours are made of weights.
bool shades_weights(const ShadeSettings& settings);
/// Colours, depths, weights and ids of a frame.
golden::FrameImage shade_frame(const FrameBuffer& frame, const ShadeSettings& settings);

/// Adds the layers L0-L3: weight minus the truth's, of the shown fragments, on snapped input or on the given one.
void add_error_layers(const FrameBuffer& frame, std::span<const WindowQuad> quads, const Config& config,
                      const DrawState& state, bool snap, unsigned threads, golden::FrameImage& image);

/// 8 bits a channel over a neutral background, opaque.
golden::Image8 frame_picture(const golden::FrameImage& image);
void save_frame_png(const std::string& path, const golden::FrameImage& image);

}  // namespace quadrille::tb
