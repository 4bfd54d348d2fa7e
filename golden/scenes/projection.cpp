#include "golden/scenes/projection.hpp"

#include "golden/scenes/polygon.hpp"
#include "golden/scenes/scene_builders.hpp"
#include "model/support/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>

namespace quadrille::golden {
namespace {

Vec3 operator-(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Nothing for a zero or non-finite vector. Scaled first, so that no square overflows or vanishes.
std::optional<Vec3> normalised(const Vec3& v) {
  const double largest = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
  if (!(largest > 0) || !std::isfinite(largest)) return std::nullopt;
  const Vec3 scaled{v[0] / largest, v[1] / largest, v[2] / largest};
  const double length = std::sqrt(dot(scaled, scaled));
  return Vec3{scaled[0] / length, scaled[1] / length, scaled[2] / length};
}

bool finite(const Vec3& v) { return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]); }

void check_size(int width, int height) {
  if (width < 1 || height < 1) {
    throw std::invalid_argument("size " + std::to_string(width) + "x" + std::to_string(height) +
                                ": must be at least 1x1");
  }
}

Matrix4 multiply(const Matrix4& a, const Matrix4& b) {
  Matrix4 product{};
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      for (std::size_t k = 0; k < 4; ++k) product[row * 4 + column] += a[row * 4 + k] * b[k * 4 + column];
    }
  }
  return product;
}

const Vec3& position_of(const Mesh& mesh, std::size_t face, const Corner& corner) {
  if (corner.position < 0 || static_cast<std::size_t>(corner.position) >= mesh.positions.size()) {
    throw std::invalid_argument("face " + std::to_string(face) + ": position index " + std::to_string(corner.position) +
                                " is out of range");
  }
  return mesh.positions[static_cast<std::size_t>(corner.position)];
}

void check_face(const Mesh& mesh, std::size_t face) {
  const Face& corners = mesh.faces[face];
  if (corners.size() < 3) {
    throw std::invalid_argument("face " + std::to_string(face) + ": only " + std::to_string(corners.size()) +
                                " corner(s)");
  }
  for (const Corner& corner : corners) {
    position_of(mesh, face, corner);
    if (corner.texcoord >= 0 && static_cast<std::size_t>(corner.texcoord) >= mesh.texcoords.size()) {
      throw std::invalid_argument("face " + std::to_string(face) + ": texture coordinate index " +
                                  std::to_string(corner.texcoord) + " is out of range");
    }
    if (corner.normal >= 0 && static_cast<std::size_t>(corner.normal) >= mesh.normals.size()) {
      throw std::invalid_argument("face " + std::to_string(face) + ": normal index " + std::to_string(corner.normal) +
                                  " is out of range");
    }
  }
}

/// Appends the primitives of a face with checked corners. One that crosses itself, as a warped one of a mesh may, still
/// closes the mesh as a fan.
void add_pieces(const Mesh& mesh, std::size_t face, std::vector<Piece>& pieces, std::size_t& crossed_faces) {
  const Face& corners = mesh.faces[face];
  if (corners.size() <= 4) {
    pieces.push_back({0, 1, 2, corners.size() - 1});
    return;
  }
  std::vector<Vec3> positions;
  for (const Corner& corner : corners) positions.push_back(position_of(mesh, face, corner));
  std::vector<Piece> cut;
  try {
    cut = cut_polygon(positions);
  } catch (const std::invalid_argument&) {
    ++crossed_faces;
    cut = polygon_fan(corners.size());
  }
  pieces.insert(pieces.end(), cut.begin(), cut.end());
}

}  // namespace

std::span<const std::string_view> attribute_names(AttributeSet set) {
  static constexpr std::array<std::string_view, 5> uv_normal{"u", "v", "nx", "ny", "nz"};
  static constexpr std::array<std::string_view, 4> weights{"w0", "w1", "w2", "w3"};
  static constexpr std::array<std::string_view, 3> position{"px", "py", "pz"}, colour{"red", "green", "blue"};
  switch (set) {
    case AttributeSet::none:
      return {};
    case AttributeSet::uv:
      return std::span(uv_normal).first(2);
    case AttributeSet::normal:
      return std::span(uv_normal).last(3);
    case AttributeSet::weights:
      return weights;
    case AttributeSet::uv_normal:
      return uv_normal;
    case AttributeSet::position:
      return position;
    case AttributeSet::colour:
      return colour;
  }
  return {};
}

int attribute_count(AttributeSet set) { return static_cast<int>(attribute_names(set).size()); }

AttributeSet attributes_for_shade(std::string_view shade) {
  if (shade == "uv" || shade == "texture") return AttributeSet::uv;
  if (shade == "normal") return AttributeSet::normal;
  if (shade == "planes") return AttributeSet::position;
  if (shade == "colour") return AttributeSet::colour;
  if (shade == "lambda") return AttributeSet::weights;
  if (shade == "depth" || shade == "quad") return AttributeSet::none;
  throw std::invalid_argument("unknown shading mode '" + std::string(shade) +
                              "' (uv, texture, normal, planes, colour, lambda, depth, quad)");
}

Matrix4 camera_matrix(const Camera& camera, int width, int height) {
  check_size(width, height);
  if (camera.matrix) {
    for (const double m : *camera.matrix) {
      if (!std::isfinite(m)) throw std::invalid_argument("camera: the matrix has a number that is not finite");
    }
    return *camera.matrix;
  }
  if (!finite(camera.eye) || !finite(camera.target) || !finite(camera.up)) {
    throw std::invalid_argument("camera: eye, target and up must be finite");
  }
  if (!(camera.fovy > 0 && camera.fovy < 180))
    throw std::invalid_argument("camera: fovy must lie between 0 and 180 degrees");
  if (!(camera.near > 0) || !(camera.far > camera.near) || !std::isfinite(camera.far)) {
    throw std::invalid_argument("camera: 0 < near < far is required");
  }
  const auto forward = normalised(camera.target - camera.eye);
  if (!forward) throw std::invalid_argument("camera: eye and target are the same point");
  const auto up = normalised(camera.up);
  const auto side = up ? normalised(cross(*forward, *up)) : std::nullopt;
  if (!side) throw std::invalid_argument("camera: up is zero or parallel to the direction of view");
  const Vec3 top = cross(*side, *forward);

  const Matrix4 view{(*side)[0],
                     (*side)[1],
                     (*side)[2],
                     -dot(*side, camera.eye),
                     top[0],
                     top[1],
                     top[2],
                     -dot(top, camera.eye),
                     -(*forward)[0],
                     -(*forward)[1],
                     -(*forward)[2],
                     dot(*forward, camera.eye),
                     0,
                     0,
                     0,
                     1};
  const double focal = 1 / std::tan(camera.fovy * std::numbers::pi / 360);
  const double aspect = static_cast<double>(width) / height;
  const double depth = camera.far - camera.near;
  Matrix4 perspective{};
  perspective[0] = focal / aspect;
  perspective[5] = focal;
  perspective[10] = -(camera.far + camera.near) / depth;
  perspective[11] = -2 * camera.far * camera.near / depth;
  perspective[14] = -1;
  return multiply(perspective, view);
}

WindowVertex project_point(const Matrix4& m, const Vec3& p, int width, int height) {
  std::array<double, 4> clip{};
  for (std::size_t row = 0; row < 4; ++row) {
    clip[row] = m[row * 4] * p[0] + m[row * 4 + 1] * p[1] + m[row * 4 + 2] * p[2] + m[row * 4 + 3];
  }
  return {(clip[0] + clip[3]) / 2 * width, (clip[3] - clip[1]) / 2 * height, (clip[2] + clip[3]) / 2, clip[3]};
}

Sides sides_of(const Vec3& up) {
  const auto u = normalised(up);
  if (!u) throw std::invalid_argument("the direction of up is zero or not finite");
  const bool z_up = std::abs((*u)[2]) > std::max(std::abs((*u)[0]), std::abs((*u)[1]));
  const Vec3 nominal = z_up ? Vec3{0, -1, 0} : Vec3{0, 0, 1};
  const double along = dot(nominal, *u);
  const Vec3 front =
      *normalised({nominal[0] - along * (*u)[0], nominal[1] - along * (*u)[1], nominal[2] - along * (*u)[2]});
  return {cross(*u, front), *u, front};
}

Vec3 direction_to_eye(const Camera& camera) {
  if (!camera.matrix) return normalised(camera.eye - camera.target).value_or(Vec3{0, 0, 1});
  // w grows away from the eye. Without perspective it is constant, and depth grows along the line of constant x and y.
  const Matrix4& m = *camera.matrix;
  if (const auto away = normalised({m[12], m[13], m[14]})) return {-(*away)[0], -(*away)[1], -(*away)[2]};
  const Vec3 line = normalised(cross({m[0], m[1], m[2]}, {m[4], m[5], m[6]})).value_or(Vec3{0, 0, 1});
  return dot(line, {m[8], m[9], m[10]}) * m[15] > 0 ? Vec3{-line[0], -line[1], -line[2]} : line;
}

Camera frame_mesh(const Mesh& mesh, int width, int height, const Viewpoint& view) {
  check_size(width, height);
  const Sides sides = sides_of(view.up);
  Vec3 from{};
  for (std::size_t i = 0; i < 3; ++i) from[i] = 0.5 * sides.right[i] + 0.4 * sides.up[i] + sides.front[i];
  const auto direction = normalised(view.from.value_or(from));
  if (!direction) throw std::invalid_argument("the direction of view is zero or not finite");
  Vec3 low{}, high{};
  bool any = false;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (const Corner& corner : mesh.faces[f]) {
      const Vec3& p = position_of(mesh, f, corner);
      for (std::size_t i = 0; i < 3; ++i) {
        low[i] = any ? std::min(low[i], p[i]) : p[i];
        high[i] = any ? std::max(high[i], p[i]) : p[i];
      }
      any = true;
    }
  }
  const Vec3 centre{low[0] / 2 + high[0] / 2, low[1] / 2 + high[1] / 2, low[2] / 2 + high[2] / 2};
  double radius = 0;
  for (const Face& face : mesh.faces) {
    for (const Corner& corner : face) {
      const Vec3 d = mesh.positions[static_cast<std::size_t>(corner.position)] - centre;
      radius = std::max(radius, std::hypot(d[0], d[1], d[2]));
    }
  }
  if (radius == 0) radius = std::max({1.0, std::abs(centre[0]), std::abs(centre[1]), std::abs(centre[2])}) * 0x1p-10;
  radius *= 1.05;

  // The sphere touches the sides of the frustum at distance r / sin(half the narrower angle).
  const double half_height = std::tan(auto_frame_fovy * std::numbers::pi / 360);
  const double half = std::min(half_height, half_height * width / height);
  const double distance = radius * std::sqrt(1 + half * half) / half;
  Camera camera;
  camera.target = centre;
  for (std::size_t i = 0; i < 3; ++i) camera.eye[i] = centre[i] + distance * (*direction)[i];
  camera.up = sides.up;
  // Nearer than this to the line of view `up` would leave the picture's turn to rounding: the front decides it.
  const Vec3 sine = cross(*direction, sides.up);
  if (dot(sine, sine) < 1e-12)
    for (std::size_t i = 0; i < 3; ++i) camera.up[i] = dot(*direction, sides.up) > 0 ? -sides.front[i] : sides.front[i];
  camera.fovy = auto_frame_fovy;
  camera.near = std::max(distance - radius, distance * 0x1p-10);
  camera.far = distance + radius;
  return camera;
}

std::vector<Vec3> smooth_normals(const Mesh& mesh) {
  std::vector<Vec3> normals(mesh.positions.size(), Vec3{});
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Face& face = mesh.faces[f];
    Vec3 area{};
    for (std::size_t i = 0; i < face.size(); ++i) {
      const Vec3& a = position_of(mesh, f, face[i]);
      const Vec3& b = position_of(mesh, f, face[(i + 1) % face.size()]);
      area[0] += (a[1] - b[1]) * (a[2] + b[2]);
      area[1] += (a[2] - b[2]) * (a[0] + b[0]);
      area[2] += (a[0] - b[0]) * (a[1] + b[1]);
    }
    for (const Corner& corner : face) {
      for (std::size_t i = 0; i < 3; ++i) normals[static_cast<std::size_t>(corner.position)][i] += area[i];
    }
  }
  for (Vec3& n : normals) n = normalised(n).value_or(Vec3{0, 0, 1});
  return normals;
}

Projection project_mesh(const Mesh& mesh, const Camera& camera, int width, int height, const ProjectOptions& options) {
  const Matrix4 matrix = camera_matrix(camera, width, height);
  const AttributeSet set = options.attributes;
  if (set == AttributeSet::colour && (mesh.colours.empty() || mesh.colours.size() != mesh.positions.size()))
    throw std::invalid_argument("the mesh has no colours; one of every vertex is expected");
  const bool wants_uv = set == AttributeSet::uv || set == AttributeSet::uv_normal;
  const bool wants_normal = set == AttributeSet::normal || set == AttributeSet::uv_normal;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) check_face(mesh, f);

  std::vector<Vec3> smooth;
  if (wants_normal) {
    const bool missing = std::any_of(mesh.faces.begin(), mesh.faces.end(), [](const Face& face) {
      return std::any_of(face.begin(), face.end(), [](const Corner& c) { return c.normal < 0; });
    });
    if (missing) smooth = smooth_normals(mesh);
  }

  Projection result;
  std::vector<Piece> pieces;  // of all faces, one after the other
  std::vector<std::uint32_t> face_of;
  pieces.reserve(mesh.faces.size());
  face_of.reserve(mesh.faces.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const std::size_t corners = mesh.faces[f].size(), before = pieces.size();
    if (corners > 4 && options.strict)
      throw std::invalid_argument("face " + std::to_string(f) + ": " + std::to_string(corners) +
                                  " corners (strict: at most 4)");
    add_pieces(mesh, f, pieces, result.crossed_faces);
    face_of.resize(pieces.size(), static_cast<std::uint32_t>(f));
    result.triangles +=
        static_cast<std::size_t>(std::count_if(pieces.begin() + static_cast<std::ptrdiff_t>(before), pieces.end(),
                                               [](const Piece& p) { return p[2] == p[3]; }));
    if (corners <= 4) continue;
    ++result.fanned_faces;
    result.fan_primitives += pieces.size() - before;
  }

  constexpr std::size_t block = 4096;
  const auto in_blocks = [&](std::size_t count, const auto& body) {
    parallel_for((count + block - 1) / block, options.threads, [&](std::size_t unit) {
      for (std::size_t i = unit * block; i < std::min(count, (unit + 1) * block); ++i) body(i);
    });
  };
  std::vector<WindowVertex> window(mesh.positions.size());
  in_blocks(window.size(), [&](std::size_t i) { window[i] = project_point(matrix, mesh.positions[i], width, height); });
  result.quads.resize(pieces.size());
  result.corners.resize(pieces.size());
  result.textures.resize(pieces.size());
  in_blocks(pieces.size(), [&](std::size_t n) {
    const Face& face = mesh.faces[face_of[n]];
    const bool textured = std::all_of(face.begin(), face.end(), [](const Corner& c) { return c.texcoord >= 0; });
    const bool triangle = pieces[n][2] == pieces[n][3];
    WindowQuad& quad = result.quads[n];
    quad.id = face_of[n];
    std::array<Vec3, 4>& positions = result.corners[n];
    std::array<Vec2, 4>& textures = result.textures[n];
    for (std::size_t i = 0; i < 4; ++i) {
      const Corner& corner = face[pieces[n][i]];
      const auto position = static_cast<std::size_t>(corner.position);
      positions[i] = mesh.positions[position];
      textures[i] = textured ? mesh.texcoords[static_cast<std::size_t>(corner.texcoord)]
                             : unit_square[triangle ? std::min<std::size_t>(i, 2) : i];
      quad.vertex[i] = window[position];
      std::vector<double>& attribute = quad.attribute[i];
      attribute.reserve(static_cast<std::size_t>(attribute_count(set)));
      if (set == AttributeSet::weights) {
        attribute.assign(4, 0.0);
        attribute[i] = 1;
      }
      if (wants_uv) attribute.insert(attribute.end(), textures[i].begin(), textures[i].end());
      if (wants_normal) {
        const Vec3 normal =
            corner.normal >= 0
                ? normalised(mesh.normals[static_cast<std::size_t>(corner.normal)]).value_or(Vec3{0, 0, 1})
                : smooth[position];
        attribute.insert(attribute.end(), normal.begin(), normal.end());
      }
      if (set == AttributeSet::position) attribute.assign(positions[i].begin(), positions[i].end());
      if (set == AttributeSet::colour) attribute.assign(mesh.colours[position].begin(), mesh.colours[position].end());
    }
  });
  return result;
}

}  // namespace quadrille::golden
