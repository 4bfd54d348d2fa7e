// The methods that the papers describe or compare with, as floating-point renderers behind one interface: a quad goes
// in, and for every pixel that the method draws the weights of the quad's four corners come out, so that any attribute
// is sum(lambda_i a_i). Double precision unless a method says otherwise; nothing here is shared with the model, the
// reference or the RTL.
#pragma once

#include "golden/scenes/mesh.hpp"
#include "model/port/records.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::golden::methods {

/// A quad with what the methods look at. Triangles repeat their third corner.
struct Quad {
  std::array<WindowVertex, 4> vertex{};  ///< homogeneous window coordinates: pixels, y down, centres at +0.5
  std::array<Vec3, 4> object{};          ///< corners in the mesh's space (adaptive, affine)
  std::array<Vec2, 4> texture{};         ///< texture coordinates, the unit square where there are none (adaptive)
  std::array<std::vector<double>, 4> attribute{};  ///< what is shaded (affine); the same count at every corner
};

/// Constant over a draw.
struct View {
  int width = 512, height = 512;  ///< viewport in pixels
  bool perspective = true;        ///< false: attributes are interpolated in screen space
};

/// One fragment. With `undefined` the method covers the pixel but has no number for it: z and lambda are NaN.
struct MethodSample {
  int x = 0, y = 0;
  bool front = false;  ///< counter-clockwise as seen on the screen
  bool undefined = false;
  double z = 0;                    ///< window z
  std::array<double, 4> lambda{};  ///< effective weights of the corners, perspective included; sum 1
};

inline constexpr MethodSample undefined_sample(int x, int y, bool front) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  return {x, y, front, true, nan, {nan, nan, nan, nan}};
}

/// What a draw needs before any pixel: geometry that goes through setup.
struct Census {
  std::uint64_t quads = 0;          ///< given
  std::uint64_t refused = 0;        ///< of these: the method cannot draw them
  std::uint64_t emitted_quads = 0;  ///< quads set up or split further (refine, adaptive: after subdivision)
  std::uint64_t triangles = 0;      ///< triangles set up; 0 for a method that sets up quads
  std::uint64_t t_vertices = 0;     ///< vertices of an emitted quad inside an edge of another (adaptive)
  std::uint64_t affine = 0;         ///< quads, triangles among them, that are drawn without mean value work (affine)

  friend bool operator==(const Census&, const Census&) = default;
};

class Method {
 public:
  virtual ~Method() = default;
  /// As it was asked for, with its knob: "refine:20".
  virtual std::string name() const = 0;
  /// Looks at Quad::object, which not every input has.
  virtual bool needs_object_space() const { return false; }
  /// Appends the visible fragments of one quad in any order; a pixel may occur twice where the method draws it twice (a
  /// fold). Pixels outside the view, behind the eye or uncovered do not occur. z is not clipped.
  virtual void draw(const Quad& quad, const View& view, std::vector<MethodSample>& out) const = 0;
  virtual Census census(std::span<const Quad> quads, const View& view) const = 0;
  /// The outlines of what is set up for the quad, to be drawn over a picture: closed polygons in homogeneous window
  /// coordinates. By default the quad itself.
  virtual std::vector<std::vector<WindowVertex>> wireframe(const Quad& quad, const View&) const {
    return {{quad.vertex.begin(), quad.vertex.end()}};
  }
};

struct MethodInfo {
  std::string_view name;    ///< "refine"
  std::string_view knob;    ///< what may follow after a colon, with its default: "N = 20"; empty: nothing
  std::string_view source;  ///< paper and section
  std::string_view what;    ///< a line on what it does
};

/// All methods in their stated order.
std::span<const MethodInfo> list_methods();

/// "mvc", "refine", "refine:20" … Throws std::invalid_argument for a missing name, an unknown one (the nearest is
/// named) or a knob that does not parse or is out of range (the range is named).
std::unique_ptr<Method> make_method(std::string_view spec);

}  // namespace quadrille::golden::methods
