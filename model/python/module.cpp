// quadrille._core: what quadrille/__init__.py wraps.
#include "golden/io/error.hpp"
#include "model/port/config.hpp"
#include "model/port/draw_state.hpp"
#include "model/port/snap.hpp"
#include "model/python/binding.hpp"
#include "tb/support/errors.hpp"

#include <type_traits>

NB_MODULE(_core, m) {
  namespace nb = nanobind;
  m.doc() = "The C++ libraries behind the package quadrille.";
  m.attr("version") = QUADRILLE_VERSION;
  // Each is a ValueError, with the words of the program.
  const auto refusal = [&]<class Error>(const char* name, const char* doc, std::type_identity<Error>) {
    nb::exception<Error>(m, name, PyExc_ValueError).attr("__doc__") = doc;
  };
  refusal("ConfigError", "A configuration that cannot be built.", std::type_identity<quadrille::ConfigError>());
  refusal("DrawStateError", "A draw state that the configuration cannot have.",
          std::type_identity<quadrille::DrawStateError>());
  refusal("SnapError", "A vertex that is no point of the machine's input, or an attribute outside its format.",
          std::type_identity<quadrille::SnapError>());
  refusal("InputError", "What is wrong in a file, with its place.",
          std::type_identity<quadrille::golden::InputError>());
  refusal("UsageError", "A name or option that does not exist.", std::type_identity<quadrille::tb::UsageError>());
  quadrille::python::bind_config(m);
  quadrille::python::bind_input(m);
  quadrille::python::bind_mesh(m);
  quadrille::python::bind_draw(m);
  quadrille::python::bind_explain(m);
  quadrille::python::bind_machine(m);
  quadrille::python::bind_ports(m);
  quadrille::python::bind_sweep(m);
}
