// Meshes and cameras, and the quads that they give.
#include "golden/io/camera.hpp"
#include "golden/io/error.hpp"
#include "golden/io/import_mesh.hpp"
#include "golden/io/merge_pairs.hpp"
#include "golden/io/mesh_format.hpp"
#include "golden/io/obj.hpp"
#include "golden/scenes/projection.hpp"
#include "model/python/binding.hpp"
#include "tb/support/choices.hpp"

#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace quadrille::python {
namespace {

using namespace nb::literals;
using golden::AttributeSet;

AttributeSet attribute_set(const std::string& name) {
  return static_cast<AttributeSet>(
      tb::choose("attributes", name, {"none", "uv", "normal", "weights", "uv_normal", "position", "colour"}));
}

std::vector<std::string> names_of(AttributeSet set) {
  const auto names = golden::attribute_names(set);
  return {names.begin(), names.end()};
}

golden::Mesh load_mesh(const std::filesystem::path& file, bool pairs) {
  const std::string path = file.string();
  if (const golden::MeshFormat format = golden::format_of_mesh(path); format != golden::MeshFormat::obj) {
#ifdef QUADRILLE_MESH_IMPORT
    return golden::import_mesh(path, pairs);
#else
    throw golden::InputError(path + ": this build reads no " + std::string(golden::name_of(format)) +
                             "; install assimp (Debian: libassimp-dev) and build again, or use OBJ");
#endif
  }
  golden::Mesh mesh = golden::load_obj(path);
  if (pairs) golden::merge_pairs(mesh);
  return mesh;
}

template <std::size_t n>
View points_of(const std::vector<std::array<double, n>>& list) {
  std::vector<double> values;
  for (const auto& point : list) values.insert(values.end(), point.begin(), point.end());
  return copied(std::move(values), {list.size(), n});
}

/// 16 numbers, row-major, of any shape that NumPy takes for an array.
std::optional<golden::Matrix4> matrix_of(const nb::object& given) {
  if (given.is_none()) return {};
  const nb::object flat = nb::module_::import_("numpy").attr("ravel")(given).attr("tolist")();
  golden::Matrix4 matrix;
  if (nb::len(flat) != 16 || !nb::try_cast(flat, matrix))
    throw std::invalid_argument("matrix: 16 numbers are expected, row by row");
  return matrix;
}

}  // namespace

Quads projected(const golden::Mesh& mesh, const golden::Camera& camera, int width, int height,
                const std::string& attributes, bool strict, std::string name) {
  const AttributeSet set = attribute_set(attributes);
  golden::ProjectOptions options;
  options.attributes = set;
  options.strict = strict;
  golden::Projection projection;
  try {
    projection = golden::project_mesh(mesh, camera, width, height, options);
  } catch (const std::invalid_argument& error) {
    throw golden::InputError(name + ": " + error.what());
  }
  Quads result;
  result.name = std::move(name);
  result.quads = std::move(projection.quads);
  result.attributes = names_of(set);
  result.corners = std::move(projection.corners);
  result.textures = std::move(projection.textures);
  result.width = width;
  result.height = height;
  result.notes = mesh.notes;
  return result;
}

void bind_mesh(nb::module_& m) {
  nb::class_<golden::Camera>(
      m, "Camera",
      "A camera: eye, target, up (mesh's space), fovy (degrees), near, far (distances); or a matrix of 4×4 numbers,\n"
      "clip = M·(x, y, z, 1), y up, z −1 to 1.")
      .def(
          "__init__",
          [](golden::Camera* self, const std::optional<golden::Vec3>& eye, const std::optional<golden::Vec3>& target,
             const std::optional<golden::Vec3>& up, std::optional<double> fovy, std::optional<double> near,
             std::optional<double> far, const nb::object& matrix) {
            if (!matrix.is_none() && (eye || target || up || fovy || near || far))
              throw std::invalid_argument("matrix: eye, target, up, fovy, near and far cannot be given too");
            new (self) golden::Camera{matrix_of(matrix),
                                      eye.value_or(golden::Vec3{0, 0, 1}),
                                      target.value_or(golden::Vec3{}),
                                      up.value_or(golden::Vec3{0, 1, 0}),
                                      fovy.value_or(45.0),
                                      near.value_or(0.1),
                                      far.value_or(100.0)};
          },
          "eye"_a.none() = nb::none(), "target"_a.none() = nb::none(), "up"_a.none() = nb::none(),
          "fovy"_a.none() = nb::none(), "near"_a.none() = nb::none(), "far"_a.none() = nb::none(),
          "matrix"_a.none() = nb::none(),
          nb::sig("def __init__(self, eye: collections.abc.Sequence[float] = (0, 0, 1), "
                  "target: collections.abc.Sequence[float] = (0, 0, 0), "
                  "up: collections.abc.Sequence[float] = (0, 1, 0), fovy: float = 45, near: float = 0.1, "
                  "far: float = 100, matrix: numpy.typing.ArrayLike | None = None) -> None"))
      .def_static(
          "load", [](const std::filesystem::path& path) { return golden::load_camera(path.string()); }, "path"_a,
          "Of a JSON file. Raises InputError with file, line and field.")
      .def("text", golden::camera_text, "The camera as such a file's text.")
      .def("__getstate__",
           [](const golden::Camera& c) {
             return nb::make_tuple(c.eye, c.target, c.up, std::array{c.fovy, c.near, c.far}, c.matrix);
           })
      .def("__setstate__",
           [](golden::Camera& self, const std::tuple<golden::Vec3, golden::Vec3, golden::Vec3, golden::Vec3,
                                                     std::optional<golden::Matrix4>>& state) {
             const auto& [eye, target, up, lens, matrix] = state;
             new (&self) golden::Camera{matrix, eye, target, up, lens[0], lens[1], lens[2]};
           })
      .def_ro("eye", &golden::Camera::eye)
      .def_ro("target", &golden::Camera::target)
      .def_ro("up", &golden::Camera::up)
      .def_ro("fovy", &golden::Camera::fovy)
      .def_ro("near", &golden::Camera::near)
      .def_ro("far", &golden::Camera::far)
      .def_ro("matrix", &golden::Camera::matrix)
      .def("__repr__", [](const golden::Camera& self) { return "Camera(" + golden::camera_text(self) + ")"; });
  nb::class_<golden::Mesh>(m, "Mesh", "A polygon mesh as a file has it.")
      .def_static(
          "load", load_mesh, "path"_a, "merge_pairs"_a = false,
          "Of a file in OBJ (v, vt, vn, f), PLY, OFF or glTF, by its name's ending.\n\n"
          "merge_pairs: joins neighbouring triangles to quads (golden/io/README.md), which glTF does not hold.\n"
          "Raises InputError with the file and, of OBJ, the line.")
      .def_static(
          "parse", [](const std::string& text, const std::string& name) { return golden::parse_obj(text, name); },
          "text"_a, "name"_a = "text", "Of an OBJ file's text; `name` stands for the file in messages.")
      .def_prop_ro(
          "positions", [](const golden::Mesh& self) { return points_of(self.positions); }, nb::rv_policy::automatic,
          nb::sig("def positions(self) -> numpy.ndarray"), "(n, 3) float64.")
      .def_prop_ro(
          "faces",
          [](const golden::Mesh& self) {
            nb::list faces;
            for (const golden::Face& face : self.faces) {
              nb::list corners;
              for (const golden::Corner& corner : face) corners.append(corner.position);
              faces.append(nb::tuple(corners));
            }
            return faces;
          },
          nb::sig("def faces(self) -> list[tuple[int, ...]]"), "Of each face the positions of its corners.")
      .def_ro("notes", &golden::Mesh::notes, "What the reader found that its user should know.")
      .def_ro("skipped_lines", &golden::Mesh::skipped_lines, "Lines that were valid and not used.");
  m.def(
      "frame_mesh",
      [](const golden::Mesh& mesh, int width, int height, const golden::Vec3& up,
         const std::optional<golden::Vec3>& from) {
        return golden::frame_mesh(mesh, width, height, {up, from});
      },
      "mesh"_a, "width"_a, "height"_a, "up"_a, "view_from"_a.none());
  m.def(
      "project",
      [](const golden::Mesh& mesh, const golden::Camera& camera, int width, int height, const std::string& attributes,
         bool strict,
         std::string name) { return projected(mesh, camera, width, height, attributes, strict, std::move(name)); },
      "mesh"_a, "camera"_a, "width"_a, "height"_a, "attributes"_a, "strict"_a, "name"_a);
}

}  // namespace quadrille::python
