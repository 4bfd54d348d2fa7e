// A request as quads with a draw state, and what the machine draws of them.
#pragma once

#include "golden/io/png.hpp"
#include "golden/scenes/scenes.hpp"
#include "model/depth_image.hpp"
#include "model/page/request.hpp"
#include "model/untimed.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace quadrille::page {

/// The input of a draw: what `quadrille` makes of --scene, or of a file of these quads.
struct Drawing {
  Request request;
  golden::Scene scene;     ///< with the vertices that are elsewhere
  golden::Matrix4 matrix;  ///< clip = matrix · (x, y, z, 1)
  DrawState state;
  std::string shade;
  std::string texture;                                    ///< its name
  std::function<golden::Vec3(double u, double v)> texel;  ///< its colour at (u, v), v up
  std::vector<WindowQuad> quads;                          ///< with the attributes of the shading
  std::vector<std::array<golden::Vec3, 4>> corners;       ///< of every quad, in the mesh's space
  std::vector<std::array<golden::Vec2, 4>> textures;
  int attributes = 0;  ///< per vertex
  golden::Vec3 to_eye{0, 0, 1};
  golden::CuttingPlanes planes;
};

/// A picture of the viewer's, rows from the top: the texture `own` from then on.
void set_own_picture(golden::Image8 picture);

/// Throws std::invalid_argument for an unknown scene, vertex, shading or texture.
Drawing make_drawing(const Request& request);

/// The quads as the machine takes them for weights alone, ids from 0 on, and their state: without attributes.
struct BareQuads {
  DrawState state;
  std::vector<SnappedQuad> quads;
};
BareQuads bare_quads(const Drawing& drawing);

/// The quad with its weights as attributes, or with those of the shading.
enum class Values { weights, shading };

/// The nearest fragments of a picture: attributes are the four weights or the shading's values.
struct Picture {
  DepthImage<double> image;
  DrawStats stats;
  LanePixels lanes;
};
Picture draw_picture(const Drawing& drawing, Values values);
/// What the shading shows: its attributes or, where there are none that it needs, the weights.
Values values_of(const Drawing& drawing);

/// Every fragment in the machine's order, of all passes that the weights and attributes take: as `quadrille fragments`
/// has them.
struct FragmentTable {
  int columns = 0;                   ///< l0 l1 l2 l3, then the attributes
  std::vector<std::uint32_t> quads;  ///< of each, from 0 on
  std::vector<std::uint32_t> heads;  ///< quad's id, x, y, front, flags, depth of each
  std::vector<std::int64_t> codes;   ///< `columns` of each
  DrawStats stats;                   ///< of the first pass
  LanePixels lanes;
};
FragmentTable draw_fragments(const Drawing& drawing);

/// Red, green, blue, 255 of each pixel, as `quadrille render --png` has them. Values of pixels as functions (pixel,
/// column); `shown` says whether there are any.
class Shader {
 public:
  explicit Shader(const Drawing& drawing) : drawing_(drawing), to_light_(golden::Vec3{0.35, 0.8, 0.6}) {}
  /// `values`: what the image's attributes are.
  std::vector<std::uint8_t> shade(const DepthImage<double>& image, Values values) const;

 private:
  const Drawing& drawing_;
  golden::Vec3 to_light_;
};

}  // namespace quadrille::page
