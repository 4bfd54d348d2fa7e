// The records of machine suites, and the state of draws that have pictures. Not for use outside this folder.
#pragma once

#include "golden/scenes/random_quads.hpp"
#include "golden/vectors/machine_run.hpp"
#include "golden/vectors/machine_suite.hpp"
#include "model/port/boundaries.hpp"
#include "model/port/draw_state.hpp"

#include <algorithm>
#include <concepts>
#include <type_traits>

namespace quadrille::vectors {

inline constexpr int picture_size = 64;  // pixels of a side

inline DrawState picture_state(const Config& config) {
  DrawState state = tb::small_state(config, picture_size);
  state.attributes = std::min(4, config.attribute_slots);
  return state;
}

struct StateRecord {
  DrawState state;
  std::uint32_t znear = 0, zfar = 0;
};

template <class R, class F>
void visit_record(R& r, const Config& c, F&& f) requires std::same_as<std::remove_const_t<R>, StateRecord> {
  visit_state(r.state, r.znear, r.zfar, c, f);
}

struct VertexRecord {
  std::uint32_t draw = 0;
  VertexBeat beat;
};

inline constexpr FieldType draw_field = plain("draw", 16, "line of states.hex");

template <class R, class F>
void visit_record(R& r, const Config& c, F&& f) requires std::same_as<std::remove_const_t<R>, VertexRecord> {
  f(draw_field, -1, r.draw);
  visit(r.beat, c, f);
}

struct FragmentRecord {
  std::uint32_t draw = 0, clock = 0, clock_stalled = 0;
  Fragment fragment;
};

template <class R, class F>
void visit_record(R& r, const Config& c, F&& f) requires std::same_as<std::remove_const_t<R>, FragmentRecord> {
  f(draw_field, -1, r.draw);
  f(plain("clock", 32, "handed over in this clock of the draw, without stalls", "clocks"), -1, r.clock);
  f(plain("clock_stalled", 32, "the same with the pattern of stalls.hex", "clocks"), -1, r.clock_stalled);
  visit(r.fragment, c, f);
}

/// A line for each line of stimulus.hex.
struct BeatRecord {
  std::uint32_t draw = 0, clock = 0, clock_stalled = 0;
};

template <class R, class F>
void visit_record(R& r, const Config&, F&& f) requires std::same_as<std::remove_const_t<R>, BeatRecord> {
  f(draw_field, -1, r.draw);
  f(plain("clock", 32, "the beat is taken in this clock of the draw, without stalls", "clocks"), -1, r.clock);
  f(plain("clock_stalled", 32, "the same with the pattern of stalls.hex", "clocks"), -1, r.clock_stalled);
}

template <class R, class F>
void visit_record(R& r, const Config&, F&& f) requires std::same_as<std::remove_const_t<R>, StallClock> {
  f(plain("offer", 1, "a beat may be offered from this clock on"), -1, r.offer);
  f(plain("ready", 1, "a fragment is taken in this clock"), -1, r.ready);
}

template <class R>
RecordLayout record_layout(const Config& config) {
  return layout_of([&, record = R{}](auto& f) { visit_record(record, config, f); });
}

template <class R>
Record packed(const R& record, const Config& config, const RecordLayout& layout) {
  return pack_record(layout.bits(), [&](auto& f) { visit_record(record, config, f); });
}

template <class R>
R unpacked(const Record& bits, const Config& config) {
  R record;
  visit_record(record, config, RecordUnpacker(bits));
  return record;
}

/// The records of a machine suite for one configuration.
struct Layouts {
  RecordLayout state, vertex, beat, fragment, stall;

  explicit Layouts(const Config& config)
      : state(record_layout<StateRecord>(config)),
        vertex(record_layout<VertexRecord>(config)),
        beat(record_layout<BeatRecord>(config)),
        fragment(record_layout<FragmentRecord>(config)),
        stall(record_layout<StallClock>(config)) {}
};

}  // namespace quadrille::vectors
