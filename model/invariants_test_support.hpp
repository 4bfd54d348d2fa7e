// The cases of invariants_test.cpp: what RapidCheck draws, prints and shrinks, and how the machine draws them.
#pragma once

#include "golden/scenes/stress.hpp"
#include "model/front/covered_pixels.hpp"
#include "model/front/quad_setup.hpp"
#include "model/pixel/pixel_pipeline.hpp"
#include "model/port/snap.hpp"
#include "model/untimed.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <memory>
#include <ostream>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace quadrille {
namespace {

inline constexpr int size = 32;        ///< of the viewport in which most cases are drawn
inline constexpr int subpixels = 64;   ///< of a corner's grid
inline constexpr int extra_slots = 4;  ///< attributes behind the weights, which are in slots 0 to 3
inline constexpr int weight_slots = 4;

/// A corner of a case. Its numbers are exact at the port for every configuration of these tests: snapping moves
/// nothing, k is a power of two, and attributes have few bits.
struct Corner {
  int x = 0, y = 0;          ///< 1/64 px, relative to the centre of pixel (0, 0); of side 0 a direction
  int side = 1, octave = 0;  ///< w = side * 2^octave
  int z = 8;                 ///< window z in 1/16; of side 0 z~
  int a = 0;                 ///< an attribute in 1/64

  friend bool operator==(const Corner&, const Corner&) = default;
};

inline WindowVertex window_vertex(const Corner& c) {
  const double x = static_cast<double>(c.x) / subpixels, y = static_cast<double>(c.y) / subpixels;
  if (c.side == 0) return {x, y, c.z / 16.0, 0};
  const double w = c.side * std::ldexp(1.0, c.octave);
  return {(x + 0.5) * w, (y + 0.5) * w, c.z / 16.0 * w, w};
}

using Corners = std::array<Corner, 4>;

struct Machine {
  int significand_bits = 18, tile_log2 = 3;
  bool lanes = false;

  Config config() const {
    Config c;
    c.set("viewport_bits", 7);
    c.set("significand_bits", significand_bits);
    c.set("tile_log2", tile_log2);
    c.set("attribute_slots", weight_slots + extra_slots);
    c.validate();
    return c;
  }
};

/// Corners of its own, or a quad of a stress family.
struct Case {
  Corners corner;
  Machine machine;
  int family = -1;
  int seed = 0;

  WindowQuad quad() const;
};

inline constexpr int family_quads = 8;  ///< the last of them is drawn

inline WindowQuad quad_of(const Corners& corners) {
  WindowQuad quad;
  for (std::size_t i = 0; i < 4; ++i) {
    quad.vertex[i] = window_vertex(corners[i]);
    quad.attribute[i].assign(weight_slots, 0);
    quad.attribute[i][i] = 1;
    quad.attribute[i].push_back(corners[i].a / 64.0);
    quad.attribute[i].resize(weight_slots + extra_slots);
  }
  return quad;
}

WindowQuad Case::quad() const {
  if (family < 0) return quad_of(corner);
  WindowQuad quad = golden::make_stress(static_cast<golden::StressFamily>(family), family_quads,
                                        static_cast<std::uint64_t>(seed), 1.0, size, size, weight_slots + extra_slots)
                        .back();
  quad.id = 0;
  return quad;
}

/// A command line that draws the case, and of corners the quad as a .quads file has it.
inline std::ostream& operator<<(std::ostream& out, const Case& c) {
  std::ostringstream text;
  text.precision(17);
  const std::string machine =
      " --size 32x32 --set viewport_bits=7 --set significand_bits=" + std::to_string(c.machine.significand_bits) +
      " --set tile_log2=" + std::to_string(c.machine.tile_log2) + " --out -";
  if (c.family >= 0) {
    text << "quadrille fragments --stress " << golden::stress_family_name(static_cast<golden::StressFamily>(c.family))
         << " --count " << family_quads << " --quad " << family_quads - 1 << " --seed " << c.seed << machine;
  } else {
    text << "echo '";
    for (const Corner& v : c.corner) {
      const WindowVertex w = window_vertex(v);
      text << w.x << ' ' << w.y << ' ' << w.z << ' ' << w.w << "  ";
    }
    for (const Corner& v : c.corner) text << v.a / 64.0 << ' ';
    text << "' | quadrille fragments --quads /dev/stdin" << machine;
  }
  return out << text.str() << (c.machine.lanes ? " (lanes)" : " (plain)");
}

// ---- Generators ----

/// From low to high, both included, evenly, whatever RapidCheck's size is.
inline int pick(int low, int high) { return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(low, high + 1)); }
inline bool chance(int percent) { return pick(0, 99) < percent; }

enum class Kind { ordinary, lattice, homogeneous };

inline Corner pick_corner(Kind kind) {
  Corner c;
  // Around the viewport; at pixel centres, or anywhere on the grid.
  const int unit = kind == Kind::lattice || chance(30) ? subpixels : 1;
  const auto coordinate = [&] { return pick(-4 * subpixels / unit, (size + 4) * subpixels / unit) * unit; };
  c.x = coordinate();
  c.y = coordinate();
  c.octave = pick(-2, 2);
  if (kind == Kind::homogeneous) {
    const int n = pick(0, 9);
    c.side = n == 0 ? 0 : n < 4 ? -1 : 1;
  }
  if (c.side == 0) {  // the larger one a power of two, and k is one
    const int larger = 1 << pick(6, 11);
    c.x = chance(50) ? larger : -larger;
    c.y = pick(-larger, larger);
    if (chance(50)) std::swap(c.x, c.y);
    c.octave = 0;
  }
  c.z = pick(1, 15);
  c.a = pick(-64, 64);
  return c;
}

inline Corners pick_corners(Kind kind) {
  Corners corners;
  for (Corner& c : corners) c = pick_corner(kind);
  const auto any = [&]() -> Corner& { return corners[static_cast<std::size_t>(pick(0, 3))]; };
  if (chance(10)) any() = Corner(any());
  if (chance(20)) {  // two corners at one place, each with its own w
    const Corner& at = any();
    Corner& moved = any();
    if (at.side != 0 && moved.side != 0) moved.x = at.x, moved.y = at.y;
  }
  return corners;
}

inline Machine pick_machine() { return {6 * pick(2, 4), pick(2, 4), chance(50)}; }

inline Kind pick_kind() { return static_cast<Kind>(pick(0, 2)); }

inline rc::Gen<Case> exact_cases() {
  return rc::gen::exec([] { return Case{pick_corners(pick_kind()), pick_machine()}; });
}

/// A third of them of families.
inline rc::Gen<Case> any_cases() {
  return rc::gen::exec([] {
    Case c{pick_corners(pick_kind()), pick_machine()};
    if (chance(33)) {
      c.family = pick(0, static_cast<int>(golden::stress_families().size()) - 1);
      c.seed = pick(1, 1000);
    }
    return c;
  });
}

// ---- Drawing ----

inline DrawState draw_state(int extent = size) {
  DrawState state;
  state.width = state.height = state.scissor_x1 = state.scissor_y1 = extent;
  state.attributes = weight_slots + extra_slots;
  return state;
}

/// The fragments by row and column; the models are kept, for their tables.
inline std::vector<Fragment> draw(const Machine& machine, const WindowQuad& quad, const DrawState& state) {
  static std::map<std::tuple<int, int, bool>, std::unique_ptr<UntimedModel>> models;
  const Config config = machine.config();
  auto& model = models[{machine.significand_bits, machine.tile_log2, machine.lanes}];
  if (!model)
    model = std::make_unique<UntimedModel>(config, state, machine.lanes ? PixelEngine::lanes : PixelEngine::plain);
  model->set_state(state);
  std::vector<Fragment> out;
  model->draw(snap_quad(quad, config, state),
              [&](std::span<const Fragment> f) { out.insert(out.end(), f.begin(), f.end()); });
  std::ranges::sort(out, {}, [](const Fragment& f) { return std::pair(f.y, f.x); });
  return out;
}

/// The claim about every weight, attributes in [-1, 1] and their sums: 2^-(s-3).
inline double bound(const Machine& machine) { return std::ldexp(1.0, 3 - machine.significand_bits); }
/// A code of an attribute: 2^-24, or 2^-(s+2) if that is less.
inline double unit(const Machine& machine) { return std::ldexp(1.0, -std::max(24, machine.significand_bits + 2)); }

inline double value(const Fragment& f, std::size_t slot, const Machine& machine) {
  return static_cast<double>(f.attribute[slot]) * unit(machine);
}

/// Where two lists differ first, in words; nothing where they are equal.
inline std::string difference(const std::vector<Fragment>& a, const std::vector<Fragment>& b) {
  const auto [in_a, in_b] = std::ranges::mismatch(a, b);
  if (in_a == a.end() && in_b == b.end()) return "";
  const auto text = [](const auto& at, const auto& end) {
    if (at == end) return std::string("no fragment");
    std::ostringstream out;
    out << "(" << at->x << ", " << at->y << ") front " << at->front << " flags " << int{at->flags} << " depth "
        << at->depth;
    for (const std::int64_t code : at->attribute) out << ' ' << code;
    return out.str();
  };
  return text(in_a, a.end()) + " and " + text(in_b, b.end());
}

/// A property that compares nothing shows nothing: `seen` must have become large.
template <class Property>
void check(const char* what, std::uint64_t least, const std::uint64_t& seen, Property&& property) {
  EXPECT_TRUE(rc::check(what, std::forward<Property>(property)));
  EXPECT_GE(seen, least) << what << ": too little was compared";
}

}  // namespace
}  // namespace quadrille
