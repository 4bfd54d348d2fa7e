// One pixel of a draw, taken apart.
#include "golden/explain/explain.hpp"
#include "model/python/binding.hpp"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <span>

namespace quadrille::python {
namespace {

using namespace nb::literals;
using quadrille::explain::Explanation;

std::vector<Explanation> explained(const Quads& quads, const Config& config, DrawState state, int x, int y) {
  state.attributes = static_cast<int>(quads.attributes.size());
  const nb::gil_scoped_release released;
  return explain::explain(config, state, quads.quads, x, y);
}

}  // namespace

void bind_explain(nb::module_& m) {
  nb::class_<Explanation>(
      m, "Explanation",
      "A quad at a pixel: which rule covered or rejected it, and each number that the machine forms "
      "on the way, beside the exact one.")
      .def_ro("quad", &Explanation::quad, "Its id.")
      .def_ro("index", &Explanation::index, "Its position in the draw.")
      .def_prop_ro(
          "outcome", [](const Explanation& self) { return explain::outcome_name(self.outcome); },
          "What became of it, such as drawn.")
      .def_ro("why", &Explanation::why, "The rule, as a sentence.")
      .def_ro("seen", &Explanation::seen, "Nearest of the fragments at the pixel, or the only one.")
      .def_ro("place", &Explanation::place, "Where in the quad the pixel is.")
      .def_ro("flags", &Explanation::flags, "Of the fragment, by name.")
      .def("json", explain::to_json, "All of it as the text of a JSON object.")
      .def("text", explain::to_text, "whole"_a = false, "All of it for 100 columns; whole: with coefficients.")
      .def("__str__", [](const Explanation& self) { return explain::to_text(self); })
      .def("__repr__", [](const Explanation& self) {
        return "<quad " + std::to_string(self.quad) + ": " + explain::outcome_name(self.outcome) + ", " + self.why +
               ">";
      });
  m.def("explain", explained, "quads"_a, "config"_a, "state"_a, "x"_a, "y"_a);
  m.def(
      "explain_html",
      [](const std::vector<Explanation>& list, const std::string& title) { return explain::to_html(list, title, ""); },
      "explanations"_a, "title"_a);
}

}  // namespace quadrille::python
