// Draws: the untimed model, the truth, the paper's formulas, the papers' methods; and snapping.
#include "model/python/binding.hpp"
#include "tb/engines/machine_engine.hpp"
#include "tb/engines/reference_engine.hpp"
#include "tb/studies/method_engine.hpp"
#include "tb/support/choices.hpp"
#include "tb/support/errors.hpp"

#include "model/port/draw_state.hpp"
#include "model/port/snap.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <utility>

namespace quadrille::python {
namespace {

using namespace nb::literals;
using tb::EngineKind;

std::unique_ptr<tb::Engine> engine_of(const Quads& quads, const std::optional<std::string>& given_method,
                                      const tb::EngineSettings& settings) {
  if (!given_method)
    return settings.kind == EngineKind::model ? make_model_engine(settings) : make_reference_engine(settings);
  const std::string& method = *given_method;
  const bool has_object_space = quads.corners.size() == quads.quads.size();
  if (!has_object_space && named([&] { return golden::methods::make_method(method); })->needs_object_space())
    throw tb::UsageError("method " + method + " needs corners in object space, which " + quads.name + " does not have");
  std::vector<golden::methods::Quad> given(quads.quads.size());
  for (std::size_t i = 0; i < given.size(); ++i) {
    static_cast<void>(snap_quad(quads.quads[i], settings.config, settings.state));  // refuses what no engine draws
    given[i].vertex = quads.quads[i].vertex;
    given[i].attribute = quads.quads[i].attribute;
    if (has_object_space) given[i].object = quads.corners[i], given[i].texture = quads.textures[i];
  }
  return tb::make_method_engine(method, std::move(given), settings);
}

/// `engine`: model, truth, float or fp32. `method` replaces it.
nb::tuple draw(const Quads& quads, const Config& config, const DrawState& state, const std::string& engine,
               const std::optional<std::string>& method, bool snap, bool weights, unsigned threads) {
  constexpr std::array kinds{EngineKind::model, EngineKind::truth, EngineKind::paper_float, EngineKind::paper_single};
  tb::EngineSettings settings;
  settings.kind = kinds[tb::choose("engine", engine, {"model", "truth", "float", "fp32"})];
  settings.config = config;
  settings.state = state;
  settings.snap = snap;
  settings.threads = threads;
  const bool codes = settings.kind == EngineKind::model && !method;
  const auto attributes = static_cast<int>(quads.attributes.size());
  FragmentRecords records(config, {state.depth, weights, codes, quads.attributes});
  {
    const nb::gil_scoped_release released;
    Interruptible interruptible;
    const std::unique_ptr<tb::Engine> made = engine_of(quads, method, settings);
    if (codes)
      made->draw_quads(quads.quads, attributes, weights, [&](const tb::QuadFragments& quad) {
        records.add(quad);
        interruptible();
      });
    else
      made->draw(quads.quads, attributes, weights, [&](std::span<const tb::EngineSample> samples) {
        records.add(samples);
        interruptible();
      });
  }
  return array_of(std::move(records));
}

// ---- Snapping ----

nb::dict numpy_type(std::initializer_list<std::tuple<const char*, nb::object, std::size_t>> fields, std::size_t bytes) {
  nb::list names, formats, offsets;
  for (const auto& [name, format, offset] : fields) names.append(name), formats.append(format), offsets.append(offset);
  nb::dict type;
  type["names"] = names, type["formats"] = formats, type["offsets"] = offsets, type["itemsize"] = bytes;
  return type;
}

nb::object format(const char* name) { return nb::str(name); }
nb::object several(const nb::object& type, std::size_t count) { return nb::make_tuple(type, nb::make_tuple(count)); }

/// SnappedQuad as numpy.dtype takes it.
nb::dict snapped_type(std::size_t attributes) {
  const nb::object number = numpy_type({{"neg", format("?"), offsetof(PortNumber, neg)},
                                        {"exp", format("i4"), offsetof(PortNumber, exp)},
                                        {"sig", format("u4"), offsetof(PortNumber, sig)}},
                                       sizeof(PortNumber));
  const nb::object vertex = numpy_type({{"x", format("i4"), offsetof(SnappedVertex, x)},
                                        {"y", format("i4"), offsetof(SnappedVertex, y)},
                                        {"w", format("i4"), offsetof(SnappedVertex, w)},
                                        {"k", number, offsetof(SnappedVertex, k)},
                                        {"z", number, offsetof(SnappedVertex, z)},
                                        {"attribute", several(number, attributes), offsetof(SnappedVertex, attribute)}},
                                       sizeof(SnappedVertex));
  constexpr std::size_t base = offsetof(SnappedQuad, base);
  return numpy_type({{"id", format("u4"), offsetof(SnappedQuad, id)},
                     {"base_attribute", several(format("i8"), attributes), base + offsetof(QuadBase, attribute)},
                     {"base_depth", format("u4"), base + offsetof(QuadBase, depth)},
                     {"depth_low", format("i4"), base + offsetof(QuadBase, depth_low)},
                     {"depth_high", format("i4"), base + offsetof(QuadBase, depth_high)},
                     {"vertex", several(vertex, 4), offsetof(SnappedQuad, vertex)}},
                    sizeof(SnappedQuad));
}

nb::tuple snap(const Quads& quads, const Config& config, DrawState state) {
  state.attributes = static_cast<int>(quads.attributes.size());
  check_draw_state(state, config);
  auto* const snapped = new std::vector<SnappedQuad>;
  const nb::capsule owner(snapped, [](void* p) noexcept { delete static_cast<std::vector<SnappedQuad>*>(p); });
  {
    const nb::gil_scoped_release released;
    snapped->reserve(quads.quads.size());
    for (const WindowQuad& quad : quads.quads) snapped->push_back(snap_quad(quad, config, state));
  }
  nb::ndarray<nb::numpy, std::uint8_t> bytes(reinterpret_cast<std::uint8_t*>(snapped->data()),
                                             {snapped->size() * sizeof(SnappedQuad)}, owner);
  return nb::make_tuple(bytes, snapped_type(quads.attributes.size()));
}

}  // namespace

nb::tuple array_of(FragmentRecords&& records) {
  const std::size_t bytes = records.size() * records.record_bytes();
  FragmentRecords::Memory memory = records.release();
  if (!memory) memory.reset(static_cast<std::byte*>(std::malloc(1)));  // a capsule holds something
  std::byte* const first = memory.release();
  const nb::capsule owner(first, [](void* p) noexcept { std::free(p); });
  nb::ndarray<nb::numpy, std::uint8_t> array(reinterpret_cast<std::uint8_t*>(first), {bytes}, owner);
  nb::list fields;
  for (const RecordField& field : records.fields())
    fields.append(nb::make_tuple(field.name, field.format, field.offset));
  return nb::make_tuple(array, fields, records.record_bytes());
}

void Interruptible::operator()() {
  const auto now = std::chrono::steady_clock::now();
  if (now < next_) return;
  next_ = now + std::chrono::milliseconds(100);
  const nb::gil_scoped_acquire lock;
  if (PyErr_CheckSignals() != 0) throw nb::python_error();
}

void bind_draw(nb::module_& m) {
  m.def("draw", draw, "quads"_a, "config"_a, "state"_a, "engine"_a, "method"_a.none(), "snap"_a, "weights"_a,
        "threads"_a);
  m.def("snap", snap, "quads"_a, "config"_a, "state"_a);
}

}  // namespace quadrille::python
