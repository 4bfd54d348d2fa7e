// Quads: from arrays, scenes, stress families, corner groups and files.
#include "golden/io/quads_file.hpp"
#include "golden/methods/method.hpp"
#include "golden/scenes/corner_quads.hpp"
#include "golden/scenes/scenes.hpp"
#include "golden/scenes/stress.hpp"
#include "model/python/binding.hpp"
#include "tb/support/choices.hpp"

#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <optional>
#include <set>
#include <stdexcept>
#include <string_view>

namespace quadrille::python {
namespace {

using namespace nb::literals;
using Doubles = nb::ndarray<const double, nb::c_contig, nb::device::cpu>;
using Ids = nb::ndarray<const std::uint32_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

std::vector<std::string> numbered(std::size_t count) {
  std::vector<std::string> names;
  for (std::size_t j = 0; j < count; ++j) names.push_back("a" + std::to_string(j));
  return names;
}

Quads from_arrays(const Doubles& vertices, const Doubles& values, std::vector<std::string> names,
                  const std::optional<Ids>& ids, const Quads* like) {
  const std::size_t count = vertices.shape(0), attributes = values.shape(2);
  if (attributes > max_attribute_slots)
    throw std::invalid_argument(std::to_string(attributes) + " attributes; at most " +
                                std::to_string(max_attribute_slots));
  check_names(names);
  Quads result;
  if (like != nullptr)
    result = *like;
  else
    result.name = "arrays";
  result.attributes = std::move(names);
  result.quads.assign(count, {});
  const double* v = vertices.data();
  const double* a = values.data();
  for (std::size_t i = 0; i < count; ++i) {
    WindowQuad& quad = result.quads[i];
    quad.id = ids ? ids->data()[i] : static_cast<std::uint32_t>(i);
    for (std::size_t corner = 0; corner < 4; ++corner, v += 4, a += attributes) {
      quad.vertex[corner] = {v[0], v[1], v[2], v[3]};
      quad.attribute[corner].assign(a, a + attributes);
    }
  }
  return result;
}

Quads scene(const std::string& name, int width, int height, const std::string& attributes) {
  const golden::Scene made = named([&] { return golden::make_scene(name); });
  Quads result = projected(made.mesh, made.camera, width, height, attributes, false, made.name);
  result.perspective = made.perspective;
  result.cull = made.cull;
  return result;
}

Quads stress(const std::string& family, std::size_t count, std::uint64_t seed, int width, int height, int attributes) {
  const auto known = named([&] { return golden::parse_stress_family(family); });
  Quads result;
  result.name = family;
  result.quads = golden::make_stress_without_weights(known, count, seed, width, height, attributes);
  result.attributes = numbered(static_cast<std::size_t>(attributes));
  result.width = width;
  result.height = height;
  return result;
}

Quads corner(const std::string& group, const Config& config, const DrawState& state, std::uint64_t seed,
             int attributes) {
  const auto known = named([&] { return golden::parse_corner_group(group); });
  Quads result;
  result.name = group;
  result.quads = golden::make_corner(known, config, state, seed, attributes);
  result.attributes = numbered(static_cast<std::size_t>(attributes));
  result.width = state.width;
  result.height = state.height;
  return result;
}

Quads load_quads(const std::filesystem::path& path) {
  Quads result;
  result.name = path.filename().string();
  result.quads = golden::load_quads(path.string(), &result.attributes);
  if (result.attributes.empty()) result.attributes = numbered(result.quads.front().attribute[0].size());
  return result;
}

Quads picked(const Quads& quads, const std::vector<std::size_t>& positions) {
  for (const std::size_t i : positions)
    if (i >= quads.quads.size())
      throw std::out_of_range("quad " + std::to_string(i) + " of " + std::to_string(quads.quads.size()));
  Quads result = quads;
  const auto pick = [&](auto& list) {
    if (list.empty()) return;
    auto all = std::move(list);
    list.clear();
    for (const std::size_t i : positions) list.push_back(all[i]);
  };
  pick(result.quads);
  pick(result.corners);
  pick(result.textures);
  return result;
}

// ---- Arrays ----

/// Without a copy: the vertices lie in the quads, which the array keeps.
View vertices_of(nb::handle self) {
  const auto& quads = nb::cast<const Quads&>(self).quads;
  static_assert(sizeof(WindowQuad) % sizeof(double) == 0);
  constexpr std::int64_t between = sizeof(WindowQuad) / sizeof(double);
  const double* const first = quads.empty() ? nullptr : &quads.front().vertex[0].x;
  return View(first, {quads.size(), 4, 4}, self, {between, 4, 1});
}

View values_of(const Quads& self) {
  std::vector<double> values;
  for (const WindowQuad& quad : self.quads)
    for (const std::vector<double>& corner : quad.attribute) values.insert(values.end(), corner.begin(), corner.end());
  return copied(std::move(values), {self.quads.size(), 4, self.attributes.size()});
}

nb::ndarray<nb::numpy, const std::uint32_t> ids_of(const Quads& self) {
  auto* const ids = new std::vector<std::uint32_t>;
  const nb::capsule owner(ids, [](void* p) noexcept { delete static_cast<std::vector<std::uint32_t>*>(p); });
  for (const WindowQuad& quad : self.quads) ids->push_back(quad.id);
  return {ids->data(), {ids->size()}, owner};
}

template <std::size_t n>
View corners_of(const std::vector<std::array<std::array<double, n>, 4>>& list) {
  std::vector<double> values;
  for (const auto& corners : list)
    for (const auto& corner : corners) values.insert(values.end(), corner.begin(), corner.end());
  return copied(std::move(values), {list.size(), 4, n});
}

template <std::size_t n>
std::vector<std::array<std::array<double, n>, 4>> corners_from(const Doubles& values) {
  std::vector<std::array<std::array<double, n>, 4>> list(values.shape(0));
  if (!list.empty()) std::memcpy(list.data(), values.data(), values.size() * sizeof(double));
  return list;
}

/// All of it, for pickle; what `restore` takes.
nb::tuple state_of(const nb::handle self) {
  const auto& q = nb::cast<const Quads&>(self);
  return nb::make_tuple(vertices_of(self), values_of(q), q.attributes, ids_of(q), q.name, corners_of(q.corners),
                        corners_of(q.textures), std::array{q.width, q.height}, q.perspective, static_cast<int>(q.cull),
                        q.notes);
}

void restore(Quads& self, const nb::tuple& state) {
  auto* const quads =
      new (&self) Quads(from_arrays(nb::cast<Doubles>(state[0]), nb::cast<Doubles>(state[1]),
                                    nb::cast<std::vector<std::string>>(state[2]), nb::cast<Ids>(state[3]), nullptr));
  quads->name = nb::cast<std::string>(state[4]);
  quads->corners = corners_from<3>(nb::cast<Doubles>(state[5]));
  quads->textures = corners_from<2>(nb::cast<Doubles>(state[6]));
  const auto size = nb::cast<std::array<int, 2>>(state[7]);
  quads->width = size[0], quads->height = size[1];
  quads->perspective = nb::cast<bool>(state[8]);
  quads->cull = static_cast<Cull>(nb::cast<int>(state[9]));
  quads->notes = nb::cast<std::vector<std::string>>(state[10]);
}

nb::list listed(const std::vector<golden::SceneInfo>& scenes) {
  nb::list result;
  for (const golden::SceneInfo& info : scenes) {
    nb::dict entry;
    entry["name"] = info.name;
    entry["title"] = info.title;
    entry["paper"] = info.paper;
    entry["quads"] = info.quads;
    result.append(entry);
  }
  return result;
}

template <class List, class Entry>
nb::dict described(const List& list, Entry&& entry) {
  nb::dict result;
  for (const auto& one : list) result[std::string(one.name).c_str()] = std::string(entry(one));
  return result;
}

void bind_quads(nb::module_& m) {
  nb::class_<Quads>(m, "Quads",
                    "Quads of a draw in window coordinates: pixels, y down, pixel centres at +0.5, times w; window z "
                    "in [0, 1] times w.")
      .def("__len__", [](const Quads& self) { return self.quads.size(); })
      .def("__repr__",
           [](const Quads& self) {
             std::string names;
             for (const std::string& name : self.attributes) names += (names.empty() ? " of " : ", ") + name;
             return "<" + std::to_string(self.quads.size()) + (self.quads.size() == 1 ? " quad of " : " quads of ") +
                    self.name + ", " + std::to_string(self.attributes.size()) +
                    (self.attributes.size() == 1 ? " attribute" : " attributes") + names + ">";
           })
      .def("__getstate__", state_of)
      .def("__setstate__", restore)
      .def("pick", picked, "positions"_a, "The quads at these positions; `quadrille.pick()` takes slices too.")
      .def_ro("name", &Quads::name, "Of the scene, file or family.")
      .def_ro("names", &Quads::attributes, "Names of the attributes.")
      .def_ro("notes", &Quads::notes, "What the reader of a file found that its user should know.")
      .def_prop_ro("vertices", vertices_of, nb::rv_policy::automatic, nb::sig("def vertices(self) -> numpy.ndarray"),
                   "(n, 4, 4) float64, read-only, no copy: x̃, ỹ, z̃, w of each corner.")
      .def_prop_ro("attributes", values_of, nb::rv_policy::automatic, nb::sig("def attributes(self) -> numpy.ndarray"),
                   "(n, 4, a) float64, a copy: each corner's values.")
      .def_prop_ro("ids", ids_of, nb::rv_policy::automatic, nb::sig("def ids(self) -> numpy.ndarray"),
                   "(n,) uint32: what fragments call their quad.")
      .def_prop_ro(
          "corners", [](const Quads& self) { return corners_of(self.corners); }, nb::rv_policy::automatic,
          nb::sig("def corners(self) -> numpy.ndarray"),
          "(n, 4, 3) float64: corners in the mesh's space; (0, 4, 3) of arrays.")
      .def_prop_ro(
          "size",
          [](const Quads& self) {
            return self.width == 0 ? nb::object(nb::none()) : nb::object(nb::make_tuple(self.width, self.height));
          },
          nb::sig("def size(self) -> tuple[int, int] | None"), "Viewport that they were made for, in pixels.")
      .def_ro("perspective", &Quads::perspective, "As the scene wants it.")
      .def_prop_ro(
          "cull",
          [](const Quads& self) {
            return std::array{"none", "front", "back"}[static_cast<std::size_t>(self.cull)];
          },
          "As the scene wants it: none, front, back.");
  m.def("from_arrays", from_arrays, "vertices"_a, "values"_a, "names"_a, "ids"_a.none(), "like"_a.none());
}

}  // namespace

void check_names(const std::vector<std::string>& names) {
  std::set<std::string> taken{"quad", "x", "y", "front", "flags", "depth", "depth_code", "l0", "l1", "l2", "l3"};
  for (const std::string& name : names)
    if (name.empty() || !taken.insert(name).second || !taken.insert(name + "_code").second)
      throw std::invalid_argument("attribute name \"" + name +
                                  "\" is empty or taken: names must differ from each other and from " +
                                  "quad, x, y, front, flags, depth and l0 to l3");
}

void bind_input(nb::module_& m) {
  bind_quads(m);
  m.def("scene", scene, "name"_a, "width"_a, "height"_a, "attributes"_a);
  m.def("list_scenes", [] { return listed(golden::list_scenes()); });
  m.def("list_workloads", [] { return listed(golden::list_workloads()); });
  m.def("stress", stress, "family"_a, "count"_a, "seed"_a, "width"_a, "height"_a, "attributes"_a);
  m.def("list_stress",
        [] { return described(golden::stress_families(), [](const auto& info) { return info.stresses; }); });
  m.def("corner", corner, "group"_a, "config"_a, "state"_a, "seed"_a, "attributes"_a);
  m.def("list_corners", [] { return described(golden::corner_groups(), [](const auto& info) { return info.holds; }); });
  m.def("load_quads", load_quads, "path"_a);
  m.def(
      "save_quads",
      [](const std::filesystem::path& path, const Quads& quads) {
        const bool named = quads.attributes != numbered(quads.attributes.size());
        golden::save_quads(path.string(), quads.quads, named ? quads.attributes : std::vector<std::string>{});
      },
      "path"_a, "quads"_a);
  m.def("list_methods",
        [] { return described(golden::methods::list_methods(), [](const auto& info) { return info.what; }); });
}

}  // namespace quadrille::python
