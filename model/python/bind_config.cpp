// Configurations, what follows from them, and draw states.
#include "golden/analysis/error_bound.hpp"
#include "golden/analysis/hardware_cost.hpp"
#include "model/port/config.hpp"
#include "model/port/config_text.hpp"
#include "model/port/draw_state.hpp"
#include "model/port/tables.hpp"
#include "model/python/binding.hpp"
#include "tb/support/choices.hpp"

#include <nanobind/operators.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <optional>
#include <tuple>

namespace quadrille::python {
namespace {

using namespace nb::literals;

/// Sets keys from Python: whole numbers, or "auto" where a key has it.
void set_keys(Config& config, const nb::kwargs& keys) {
  for (const auto& [name, value] : keys) {
    const auto key = nb::cast<std::string>(name);
    if (nb::isinstance<nb::str>(value) && nb::cast<std::string>(value) == "auto") {
      config.set(key, -1);
      continue;
    }
    int number = 0;
    if (PyLong_Check(value.ptr()) && !nb::try_cast(value, number))
      throw ConfigError("configuration key '" + key + "' = " + nb::cast<std::string>(nb::repr(value)) + " is outside " +
                        std::to_string(Config::key(key).minimum) + ".." + std::to_string(Config::key(key).maximum));
    if (!nb::try_cast(value, number))
      throw ConfigError(key + " = " + nb::cast<std::string>(nb::repr(value)) + ": not a whole number" +
                        (Config::key(key).standard == -1 ? " or \"auto\"" : ""));
    config.set(key, number);
  }
  config.validate();
}

nb::list list_keys() {
  nb::list keys;
  for (const ConfigKey& key : Config::keys()) {
    nb::dict entry;
    entry["name"] = std::string(key.name);
    entry["default"] = key.standard == -1 ? nb::object(nb::str("auto")) : nb::object(nb::int_(key.standard));
    entry["minimum"] = key.minimum;
    entry["maximum"] = key.maximum;
    entry["unit"] = std::string(key.unit);
    entry["meaning"] = std::string(key.meaning);
    keys.append(entry);
  }
  return keys;
}

nb::dict derived_of(const Config& config) {
  nb::dict derived;
  for (const DerivedWidth& width : config.derived()) derived[width.name.c_str()] = width.value;
  return derived;
}

nb::dict bounds_of(const Config& config) {
  config.validate();
  nb::dict bounds;
  bounds["weight"] = bound_lambda(config).value;
  bounds["attribute"] = bound_attribute(config, 1).value;
  bounds["depth"] = bound_depth(config, 1).value;
  return bounds;
}

nb::dict cost_of(const Config& config) {
  config.validate();
  const HardwareCost cost = hardware_cost(config);
  nb::dict result;
  result["cost"] = scalar_cost(cost, ecp5_weights);
  result["luts"] = lut_cost(cost, ecp5_weights);
  result["flip_flops"] = cost.state_bits - cost.memory_bits;
  result["dsps"] = cost.dsps;
  result["block_rams"] = cost.block_rams;
  return result;
}

Config parsed(const std::string& text) {
  Config config;
  apply_config_text(text, config);
  return config;
}

void bind_class(nb::module_& m) {
  nb::class_<Config> config(
      m, "Config",
      "A configuration of the machine: every width, as keys. Config(significand_bits=12) sets keys, the others have "
      "their defaults;\nConfig.keys() lists them. A key may be \"auto\" (-1) where that is its default. Cannot be "
      "changed; replace() makes another.\nRaises ConfigError for an unknown key, a value out of range and a "
      "combination "
      "that cannot be built.");
  config
      .def(
          "__init__",
          [](Config* self, const nb::kwargs& keys) {
            Config made;
            set_keys(made, keys);
            new (self) Config(made);
          },
          nb::sig("def __init__(self, **keys: int | str) -> None"))
      .def(
          "replace",
          [](const Config& self, const nb::kwargs& keys) {
            Config made = self;
            set_keys(made, keys);
            return made;
          },
          nb::sig("def replace(self, **keys: int | str) -> Config"), "The same with other values of these keys.")
      .def_static("parse", parsed, "text"_a,
                  "Of the text of a configuration file: lines of `key = value`. Raises ConfigError with the line.")
      .def_static("keys", list_keys, nb::sig("def keys() -> list[dict[str, int | str]]"),
                  "Every key: name, default (\"auto\": derived), minimum, maximum, unit, meaning.")
      .def(
          "resolved", [](const Config& self, const std::string& key) { return self.resolved(key); }, "key"_a,
          "The value of a key, with \"auto\" replaced by the value that it stands for.")
      .def("derived", derived_of, nb::sig("def derived(self) -> dict[str, int]"),
           "Every derived width by its name in the RTL.")
      .def("bounds", bounds_of, nb::sig("def bounds(self) -> dict[str, float]"),
           "Bounds of absolute errors against exact arithmetic on the snapped quad: weight (λ′1 to λ′3); attribute and "
           "depth where the "
           "corners'\nvalues differ by at most 1 (unit of the value); depth where every w is positive.")
      .def("cost", cost_of, nb::sig("def cost(self) -> dict[str, float]"),
           "Estimated hardware on an ECP5: cost (LUTs with blocks at their price), luts, flip_flops, dsps, block_rams.")
      .def(
          "tables", [](const Config& self) { return tables_package(self); },
          "quadrille_tables_pkg.sv of this configuration, the one generated source of its RTL.")
      .def(nb::self == nb::self, nb::sig("def __eq__(self, other: object, /) -> bool"))
      .def("__hash__", [](const Config& self) { return std::hash<std::string>()(changed_keys(self, " ")); })
      .def("__getstate__", [](const Config& self) { return changed_keys(self, " "); })
      .def("__setstate__", [](Config& self, const std::string& text) { new (&self) Config(parsed(text)); })
      .def("__repr__", [](const Config& self) {
        const std::string keys = changed_keys(self, ", ");
        return "Config(" + (keys.empty() ? keys : keys.substr(2)) + ")";
      });
#define KEY(name, ...) \
  config.def_prop_ro(  \
      #name, [](const Config& self) { return self.name; }, Config::key(#name).meaning.data());
#include "model/port/config_keys.h"
#undef KEY
}

using Rectangle = std::tuple<int, int, int, int>;

DrawState make_state(const Config& config, int width, int height, const std::optional<Rectangle>& scissor,
                     const std::string& cull, bool perspective, bool depth, double znear, double zfar,
                     const std::optional<std::vector<std::string>>& skip) {
  DrawState state = draw_state_for(config, width, height);
  if (scissor) std::tie(state.scissor_x0, state.scissor_y0, state.scissor_x1, state.scissor_y1) = *scissor;
  state.cull = static_cast<Cull>(tb::choose("cull mode", cull, {"none", "front", "back"}));
  state.perspective = perspective;
  state.depth = depth;
  state.znear = znear;
  state.zfar = zfar;
  if (skip) {
    const std::vector<std::string> names(skip_names.begin(), skip_names.end());
    state.skip = 0;
    for (const std::string& name : *skip) state.skip |= 1u << tb::choose("skip", name, names);
  }
  check_draw_state(state, config);
  return state;
}

}  // namespace

void bind_config(nb::module_& m) {
  bind_class(m);
  nb::class_<DrawState>(m, "DrawState", "What stays constant over a draw.")
      .def_ro("width", &DrawState::width)
      .def_ro("height", &DrawState::height);
  m.def("make_state", make_state, "config"_a, "width"_a, "height"_a, "scissor"_a.none(), "cull"_a, "perspective"_a,
        "depth"_a, "znear"_a, "zfar"_a, "skip"_a.none());
}

}  // namespace quadrille::python
