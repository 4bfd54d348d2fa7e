// What the parts of the module share: quads with what belongs to them, and arrays that take over memory.
#pragma once

#include "golden/scenes/mesh.hpp"
#include "model/port/records.hpp"
#include "model/python/fragment_records.hpp"
#include "tb/support/errors.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <array>
#include <chrono>
#include <stdexcept>
#include <string>
#include <vector>

namespace quadrille::python {

namespace nb = nanobind;

/// What a draw is given: quads in window coordinates and what their attributes are called.
struct Quads {
  std::string name;
  std::vector<WindowQuad> quads;
  std::vector<std::string> attributes;
  std::vector<std::array<golden::Vec3, 4>> corners;   ///< in the mesh's space; none of arrays and families
  std::vector<std::array<golden::Vec2, 4>> textures;  ///< likewise
  int width = 0, height = 0;                          ///< viewport that they were made for; 0: any
  bool perspective = true;
  Cull cull = Cull::none;
  std::vector<std::string> notes;  ///< what a reader of files found
};

using View = nb::ndarray<nb::numpy, const double>;

/// An array that owns the values.
template <class Values>
View copied(Values&& values, std::initializer_list<std::size_t> shape) {
  auto* const memory = new std::vector<double>(std::forward<Values>(values));
  const nb::capsule owner(memory, [](void* p) noexcept { delete static_cast<std::vector<double>*>(p); });
  return View(memory->data(), shape, owner);
}

/// The quads of a mesh; throws InputError, `name` being the file.
Quads projected(const golden::Mesh& mesh, const golden::Camera& camera, int width, int height,
                const std::string& attributes, bool strict, std::string name);

/// The records as bytes, with the fields that numpy.dtype needs: (bytes, [(name, format, offset)], bytes of a record).
nb::tuple array_of(FragmentRecords&& records);

/// Field names of a record must differ. Throws std::invalid_argument.
void check_names(const std::vector<std::string>& names);

/// A fragment at the port: the hexadecimal digits of fragment_t.
std::string fragment_word(const Fragment& fragment, const Config& config);

/// What `make` gives; a name that it does not know is a UsageError.
auto named(const auto& make) {
  try {
    return make();
  } catch (const std::invalid_argument& error) {
    throw tb::UsageError(error.what());
  }
}

/// For work without the interpreter's lock: lets Ctrl-C end it. Asks at most ten times a second.
class Interruptible {
 public:
  void operator()();

 private:
  std::chrono::steady_clock::time_point next_ = std::chrono::steady_clock::now();
};

void bind_config(nb::module_& m);
void bind_input(nb::module_& m);
void bind_mesh(nb::module_& m);
void bind_draw(nb::module_& m);
void bind_explain(nb::module_& m);
void bind_machine(nb::module_& m);
void bind_ports(nb::module_& m);
void bind_sweep(nb::module_& m);

}  // namespace quadrille::python
