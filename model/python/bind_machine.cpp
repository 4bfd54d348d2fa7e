// The clocked model, beat by beat.
#include "model/c_api/clocked.hpp"
#include "model/port/performance_counters.hpp"
#include "model/python/binding.hpp"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace quadrille::python {
namespace {

using namespace nb::literals;

/// The machine of the C interface, with names for attributes.
struct Machine {
  Machine(const Config& config, DrawState state, std::vector<std::string> attributes)
      : names(std::move(attributes)), inner_(config, with_attributes(state, names, config)) {}

  static DrawState with_attributes(DrawState state, const std::vector<std::string>& attributes, const Config& config) {
    check_names(attributes);
    state.attributes = static_cast<int>(attributes.size());
    check_draw_state(state, config);
    return state;
  }

  /// For one thread at a time: run() gives up the interpreter's lock.
  quadrille_clocked& inner() {
    api::require(!running_, QUADRILLE_BUSY, "another thread is in run() of this machine");
    return inner_;
  }

  void push(const Quads& quads) {
    api::require(quads.attributes.size() == names.size(), QUADRILLE_BAD_ARGUMENT,
                 "push: as many attributes as the machine was made for are expected");
    std::vector<SnappedQuad> snapped;
    for (const WindowQuad& quad : quads.quads) snapped.push_back(snap_quad(quad, inner().config, inner().state));
    inner().queue.insert(inner().queue.end(), snapped.begin(), snapped.end());
  }

  std::uint32_t clock(bool vertex_valid, bool fragment_ready, bool reset, bool clear_hidden, bool flush) {
    const auto bit = [](bool set, std::uint32_t which) { return set ? which : 0u; };
    const std::uint32_t inputs = bit(reset, QUADRILLE_RESET) | bit(vertex_valid, QUADRILLE_VERTEX_VALID) |
                                 bit(fragment_ready, QUADRILLE_FRAGMENT_READY) |
                                 bit(clear_hidden, QUADRILLE_CLEAR_HIDDEN) | bit(flush, QUADRILLE_FLUSH);
    const std::size_t before = inner().waiting.size();
    inner().clock(inputs);
    clocks = reset ? 0 : clocks + 1;
    return static_cast<std::uint32_t>(inner().waiting.size() - before);
  }

  std::uint64_t run(std::uint64_t most) {
    quadrille_clocked& machine = inner();
    const std::uint64_t before = clocks;
    struct Running {
      explicit Running(bool& flag) : flag_(flag) { flag_ = true; }
      ~Running() { flag_ = false; }
      bool& flag_;
    } const running(running_);
    const nb::gil_scoped_release released;
    Interruptible interruptible;
    while (clocks - before < most && !machine.idle()) {
      machine.clock(QUADRILLE_VERTEX_VALID | QUADRILLE_FRAGMENT_READY);
      if (++clocks % 65536 == 0) interruptible();
    }
    return clocks - before;
  }

  FragmentRecords records() { return {inner().config, {inner().state.depth, false, true, names}}; }

  nb::tuple take() {
    FragmentRecords taken = records();
    std::vector<quadrille_fragment> fragments(inner().waiting.size());
    inner().waiting.take(fragments.data(), fragments.size());
    for (const quadrille_fragment& f : fragments) {
      Fragment fragment{f.quad, f.x, f.y, f.front != 0, f.flags, f.depth, {}};
      std::copy_n(f.attribute, fragment.attribute.size(), fragment.attribute.begin());
      taken.add(fragment);
    }
    return array_of(std::move(taken));
  }

  nb::tuple on_offer() {
    FragmentRecords offered = records();
    if (const ClockedOutputs now = inner().model.comb(); now.fragment_valid)
      now.for_each_fragment([&](const Fragment& fragment) { offered.add(fragment); });
    return array_of(std::move(offered));
  }

  std::vector<std::string> words() {
    std::vector<std::string> words;
    if (const ClockedOutputs now = inner().model.comb(); now.fragment_valid)
      now.for_each_fragment(
          [&](const Fragment& fragment) { words.push_back(fragment_word(fragment, inner().config)); });
    return words;
  }

  nb::dict counters() {
    nb::dict result;
    const PerformanceCounters now = inner().model.counters();
    for (std::size_t i = 0; i < counter_count; ++i) result[std::string(counter_info[i].name).c_str()] = now.value[i];
    return result;
  }

  std::vector<std::string> names;
  std::uint64_t clocks = 0;

 private:
  quadrille_clocked inner_;
  bool running_ = false;  // the interpreter's lock guards it
};

}  // namespace

void bind_machine(nb::module_& m) {
  nb::register_exception_translator([](const std::exception_ptr& p, void*) {
    try {
      std::rethrow_exception(p);
    } catch (const api::Failure& failure) {
      PyErr_SetString(failure.status == QUADRILLE_BUSY ? PyExc_RuntimeError : PyExc_ValueError, failure.text.c_str());
    }
  });
  nb::class_<Machine>(m, "Machine")
      .def(
          "__init__",
          [](Machine* self, const Config& config, const DrawState& state, const nb::list& names) {
            std::vector<std::string> attributes;
            for (const nb::handle name : names) attributes.push_back(nb::cast<std::string>(name));
            new (self) Machine(config, state, std::move(attributes));
          },
          "config"_a, "state"_a, "names"_a)
      .def("push", &Machine::push, "quads"_a)
      .def("clock", &Machine::clock, "vertex_valid"_a, "fragment_ready"_a, "reset"_a, "clear_hidden"_a, "flush"_a)
      .def("run", &Machine::run, "most"_a)
      .def("take", &Machine::take)
      .def("on_offer", &Machine::on_offer)
      .def("words", &Machine::words)
      .def("counters", &Machine::counters)
      .def_ro("clocks", &Machine::clocks)
      .def_prop_ro("waiting", [](Machine& self) { return self.inner().waiting.size(); })
      .def_prop_ro("queued", [](Machine& self) { return 4 * self.inner().queue.size() - self.inner().beat; })
      .def_prop_ro("idle", [](Machine& self) { return self.inner().idle(); })
      .def_prop_ro("vertex_ready", [](Machine& self) { return self.inner().model.comb().vertex_ready; })
      .def_prop_ro("fragment_valid", [](Machine& self) { return self.inner().model.comb().fragment_valid; })
      .def_prop_ro("fragment_mask",
                   [](Machine& self) {
                     const ClockedOutputs now = self.inner().model.comb();
                     return now.fragment_valid ? now.fragment_mask() : 0u;
                   })
      .def_prop_ro("busy", [](Machine& self) { return self.inner().model.comb().busy; });
}

}  // namespace quadrille::python
