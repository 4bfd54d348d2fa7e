// From a mesh and a camera to the quads of a draw: projection, framing, decomposition of faces, attribute layouts.
#pragma once

#include "golden/scenes/mesh.hpp"
#include "model/port/records.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace quadrille::golden {

/// What the attributes of a projected quad are, in slot order.
enum class AttributeSet {
  none,       ///< nothing
  uv,         ///< u, v
  normal,     ///< nx, ny, nz (unit, in the mesh's space)
  weights,    ///< (1,0,0,0), (0,1,0,0), (0,0,1,0), (0,0,0,1): the attributes are the weights themselves
  uv_normal,  ///< u, v, nx, ny, nz (needs five attribute slots)
  position,   ///< x, y, z in the mesh's space
  colour,     ///< red, green, blue (the mesh needs colours)
};

/// Names of the attributes in slot order: of columns of tables.
std::span<const std::string_view> attribute_names(AttributeSet set);
int attribute_count(AttributeSet set);

/// The layout that a shading mode needs: uv, texture → uv; normal → normal; planes → position; colour → colour;
/// lambda → weights; depth, quad → none.
/// Throws std::invalid_argument for any other name.
AttributeSet attributes_for_shade(std::string_view shade);

struct ProjectOptions {
  AttributeSet attributes = AttributeSet::weights;
  bool strict = false;  ///< refuse faces with more than four corners
  unsigned threads = 1;
};

struct Projection {
  std::vector<WindowQuad> quads;              ///< id = 0-based face index; the primitives of one fanned face share it
  std::vector<std::array<Vec3, 4>> corners;   ///< of every quad, in the mesh's space
  std::vector<std::array<Vec2, 4>> textures;  ///< of every quad: what AttributeSet::uv gives
  std::size_t triangles = 0;                  ///< primitives drawn as (a, b, c, c), those of fans included
  std::size_t fanned_faces = 0;               ///< faces with more than four corners
  std::size_t fan_primitives = 0;             ///< quads and triangles that those faces were cut into
  std::size_t crossed_faces = 0;              ///< of them those that no cut covers once: fans from the first corner
};

/// clip = M · (x, y, z, 1), NDC y up, z −1..1 (OpenGL's look-at times perspective when the camera has no matrix; aspect
/// = width / height). Uses tan of libm: the last bit may differ between C libraries. Throws std::invalid_argument for a
/// size below 1, non-finite numbers, eye = target, up parallel to the view, fovy outside (0, 180), near ≤ 0, far ≤
/// near.
Matrix4 camera_matrix(const Camera& camera, int width, int height);

/// x̃ = (clip.x + clip.w)/2 · width, ỹ = (clip.w − clip.y)/2 · height (y down), z̃ = (clip.z + clip.w)/2, w = clip.w.
WindowVertex project_point(const Matrix4& matrix, const Vec3& point, int width, int height);

/// The sides of a mesh as unit vectors of its space, at right angles. `front` is +z, or −y where the largest component
/// of `up` is z (as modellers with z up have it), made perpendicular to `up`; right = up × front.
struct Sides {
  Vec3 right, up, front;
};
/// Throws std::invalid_argument for an `up` that is zero or not finite.
Sides sides_of(const Vec3& up);

/// From where an automatic camera looks, in the mesh's space; neither needs unit length.
struct Viewpoint {
  Vec3 up{0, 1, 0};
  std::optional<Vec3> from;  ///< from the mesh to the eye; none: 0.5 right + 0.4 up + front
};
inline constexpr double auto_frame_fovy = 35;  ///< degrees, vertical

/// A camera that shows the whole mesh: fovy 35 degrees; the sphere around the bounding box's centre that holds every
/// vertex of a face fits the narrower field of view with 5 % to spare, near and far likewise. Seen straight from the
/// top the front is at the picture's bottom edge, from the bottom at its top edge. Throws std::invalid_argument for a
/// direction that is zero or not finite.
Camera frame_mesh(const Mesh& mesh, int width, int height, const Viewpoint& view = {});

/// Unit vector from what a camera looks at to the eye, in the mesh's space, at the middle of the picture.
Vec3 direction_to_eye(const Camera& camera);

/// One unit normal per position: the sum of the vector areas (Newell) of the faces around it; (0, 0, 1) where that is
/// zero.
std::vector<Vec3> smooth_normals(const Mesh& mesh);

/// Faces in order. A triangle (a, b, c) becomes (a, b, c, c); a face with n > 4 corners what cut_polygon() makes of it:
/// if convex, a fan from its first corner, as quads then (n odd) a triangle; so also one that it refuses. A face in
/// which a corner has no texture coordinate gets the unit square (0,0) (1,0) (1,1) (0,1) per primitive (a triangle: its
/// fourth corner repeats the third); a corner without normal gets the smooth one. Normals are normalised. Throws
/// std::invalid_argument with the face number for fewer than three corners, an index out of range, and with `strict`
/// for more than four corners; without one for AttributeSet::colour when the mesh has not one colour per position.
Projection project_mesh(const Mesh& mesh, const Camera& camera, int width, int height,
                        const ProjectOptions& options = {});

}  // namespace quadrille::golden
