// The stored numbers of an explanation are those that the clocked model has at its boundaries, which the co-simulation
// compares with the RTL in every clock, and those of the kept golden vectors, field by field.
#include "model/port/boundaries.hpp"
#include "golden/explain/compare.hpp"
#include "golden/explain/explain.hpp"
#include "golden/scenes/corner_quads.hpp"
#include "golden/scenes/projection.hpp"
#include "golden/scenes/scenes.hpp"
#include "golden/scenes/stress.hpp"
#include "golden/vectors/machine_records.hpp"
#include "model/drive.hpp"
#include "model/port/latency.hpp"
#include "model/port/snap.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace quadrille::explain {
namespace {

constexpr std::array pixel_boundaries{Boundary::diff,  Boundary::norm,   Boundary::sqrt,
                                      Boundary::ratio, Boundary::weight, Boundary::sum};

template <class Visit>
Record packed(Boundary b, const Config& config, Visit&& visit_fields) {
  return pack_record(boundary_layout(b, config).bits(), visit_fields);
}

/// What the clocked model shows of one quad, by pixel.
struct Shown {
  std::optional<Record> setup;
  std::map<std::pair<int, int>, Record> tiles, stamps;  ///< by tile; by tile column and pixel row
  std::map<std::pair<int, int>, std::map<Boundary, Record>> pixels;
  std::map<std::pair<int, int>, Fragment> fragments;
  std::map<std::pair<int, int>, unsigned> classes;  ///< of covered pixels: flags of what they are
};

Shown clocked(const SnappedQuad& quad, const Config& config, const DrawState& state) {
  Shown shown;
  DrivenModel machine(config, state, Probes::all);
  machine.wait_idle();
  SteadyBeats beats(std::span(&quad, 1));
  std::vector<std::pair<int, int>> ring(static_cast<std::size_t>(2 * ring_entries(config)));
  std::size_t ring_write = 0;
  const auto record = [&](Boundary b, const auto& of) {
    return packed(b, config, [&](auto& f) { visit(of, config, f); });
  };
  drive(machine, beats, [&](std::uint64_t, const ClockedOutputs& out, bool) {
    if (out.probes.setup != nullptr) shown.setup = record(Boundary::setup, *out.probes.setup);
    if (const TileEntry* tile = out.probes.tile) {
      ring[ring_write] = {tile->tile_x, tile->tile_y};
      const bool parts = !tile->end && !is_ordinary(quad, config);
      ring_write = (ring_write + (parts ? latency::homogeneous_parts : 1)) % ring.size();
      if (!tile->end) shown.tiles.emplace(std::pair(tile->tile_x, tile->tile_y), record(Boundary::tile, *tile));
    }
    if (const StampEntry* stamp = out.probes.stamp; stamp != nullptr && !stamp->end) {
      const auto& tile = ring[stamp->tile_ptr % ring.size()];
      shown.stamps.emplace(std::pair(tile.first, tile.second * config.tile() + stamp->row),
                           record(Boundary::stamp, *stamp));
    }
    for (std::size_t lane = 0; lane < static_cast<std::size_t>(config.pixels_per_clock); ++lane) {
      const LaneProbes& p = out.probes.lane[lane];
      const std::array traces{p.diff, p.norm, p.sqrt, p.ratio, p.weight, p.sum};
      for (std::size_t i = 0; i < traces.size(); ++i) {
        if (traces[i] == nullptr) continue;
        const PixelTrace& t = *traces[i];
        const Boundary b = pixel_boundaries[i];
        shown.pixels[{t.x, t.y}].emplace(b, packed(b, config, [&](auto& f) { visit(t, b, config, f); }));
        shown.classes[{t.x, t.y}] = t.fragment.flags;
      }
    }
    out.for_each_fragment([&](const Fragment& g) { shown.fragments.emplace(std::pair(int{g.x}, int{g.y}), g); });
    return !beats.done() || out.busy;
  });
  return shown;
}

struct Seen {
  std::size_t covered = 0, not_covered = 0, fields = 0;
  std::array<std::size_t, 8> flag{};  ///< pixels by bit of their flags
  std::size_t hull = 0, plane = 0;
};

/// Fields of the machine's bookkeeping, which no pixel has of its own.
bool is_bookkeeping(const std::string& name) { return name == "slot" || name == "tile_ptr" || name == "end_token"; }

/// Every field of the record has the explanation's value, and the explanation has every field.
void expect_record(const Stage& stage, Boundary b, const Record& record, const Config& config, const DrawState& state,
                   Seen& seen) {
  const RecordLayout layout = boundary_layout(b, config);
  std::set<std::string> named;
  for (const Number& number : stage.numbers)
    for (const Field& field : number.stored) {
      EXPECT_TRUE(named.insert(field.label()).second) << stage.name << " " << field.label() << " twice";
      const RecordField& at = layout.field(field.name, field.index);
      const std::uint64_t mask = ~std::uint64_t{0} >> (64 - at.width);
      EXPECT_EQ(field.value & mask, record.get(at)) << stage.name << " " << field.label();
      ++seen.fields;
    }
  for (const RecordField& field : layout.fields()) {
    if (is_bookkeeping(field.name) || (field.name.starts_with("attr") && field.index >= state.attributes)) continue;
    EXPECT_EQ(named.count(field.label()), 1u) << stage.name << " lacks " << field.label();
  }
}

const Stage* find(const Explanation& e, Boundary b) {
  for (const Stage& stage : e.stages)
    if (stage.boundary == boundary_name(b)) return &stage;
  return nullptr;
}

void expect_pixel(const Shown& shown, const SnappedQuad& quad, const Config& config, const DrawState& state, int x,
                  int y, Seen& seen) {
  SCOPED_TRACE("quad " + std::to_string(quad.id) + ", pixel " + std::to_string(x) + "," + std::to_string(y));
  const Explanation e = explain(config, state, quad, x, y);
  const std::pair at(x, y);
  const auto pixel = shown.pixels.find(at);
  ASSERT_EQ(e.covered(), pixel != shown.pixels.end()) << e.why;
  EXPECT_EQ(e.outcome == Outcome::drawn, shown.fragments.count(at) == 1) << e.why;
  if (!e.covered()) {
    ++seen.not_covered;
    EXPECT_FALSE(e.why.empty());
    return;
  }
  ++seen.covered;
  const auto expect = [&](Boundary b, const Record& record) {
    const Stage* stage = find(e, b);
    ASSERT_NE(stage, nullptr) << boundary_name(b);
    expect_record(*stage, b, record, config, state, seen);
  };
  const int tile_x = x >> config.tile_log2;
  const auto tile = shown.tiles.find({tile_x, y >> config.tile_log2});
  const auto stamp = shown.stamps.find({tile_x, y});
  ASSERT_TRUE(shown.setup && tile != shown.tiles.end() && stamp != shown.stamps.end());
  expect(Boundary::setup, *shown.setup);
  expect(Boundary::tile, tile->second);
  expect(Boundary::stamp, stamp->second);
  for (const Boundary b : pixel_boundaries) expect(b, pixel->second.at(b));
  if (const auto fragment = shown.fragments.find(at); fragment != shown.fragments.end())
    expect(Boundary::fragment,
           packed(Boundary::fragment, config, [&](auto& f) { visit(fragment->second, config, f); }));
  for (std::size_t bit = 0; bit < 8; ++bit) seen.flag[bit] += shown.classes.at(at) >> bit & 1;
  seen.hull += shown.setup->get(boundary_layout(Boundary::setup, config).field("hull"));
}

/// Some pixels of a quad: a few of each kind that is special, a few others, and a few that are not covered.
void expect_quad(const SnappedQuad& quad, const Config& config, const DrawState& state, Seen& seen) {
  const Shown shown = clocked(quad, config, state);
  std::map<unsigned, int> kinds;
  int others = 0;
  for (const auto& [at, flags] : shown.classes) {
    const unsigned kind = flags & ~unsigned{flag_homogeneous | flag_saturated};
    if (kinds[kind]++ < (kind != 0 ? 2 : 3)) expect_pixel(shown, quad, config, state, at.first, at.second, seen);
  }
  for (int i = 0; i < 40 && others < 3; ++i) {
    const int x = i * 29 % state.width, y = i * 17 % state.height;
    if (shown.pixels.count({x, y}) != 0) continue;
    expect_pixel(shown, quad, config, state, x, y, seen);
    ++others;
  }
}

DrawState small_state(const Config& config, int size) {
  DrawState state;
  state.width = state.height = state.scissor_x1 = state.scissor_y1 = size;
  state.attributes = config.attribute_slots;
  return state;
}

void set(Config& config, std::initializer_list<std::pair<const char*, int>> keys) {
  for (const auto& [key, value] : keys) config.set(key, value);
  config.validate();
}

/// Some quads of every corner group in the state that it needs, and of every stress family.
Seen expect_groups_and_families(const Config& config, std::uint32_t skip, std::size_t some) {
  Seen seen;
  for (golden::CornerDraw draw : golden::corner_draws(config, 3)) {
    SCOPED_TRACE(draw.group);
    if (skip == 0 && draw.state.height > 64) continue;  // every tile of the viewport would be walked
    draw.state.skip = skip & ~std::uint32_t{skip_hidden};
    for (std::size_t i = 0; i < draw.quads.size(); i += draw.quads.size() / (4 * some) + 1)
      expect_quad(draw.quads[i], config, draw.state, seen);
  }
  std::size_t turn = 0;
  for (const golden::StressFamilyInfo& family : golden::stress_families()) {
    SCOPED_TRACE(family.name);
    DrawState state = small_state(config, 48);
    state.skip = skip;
    state.perspective = ++turn % 3 != 0;
    state.depth = turn % 5 != 0;
    for (const WindowQuad& quad :
         golden::make_stress(family.family, some, 7, 1.0, state.width, state.height, config.attribute_slots))
      expect_quad(snap_quad(quad, config, state), config, state, seen);
  }
  return seen;
}

TEST(ExplainBoundaries, OfTheDefaultMachine) {
  const Seen seen = expect_groups_and_families(Config{}, skip_default, 2);
  EXPECT_GT(seen.covered, 600u);
  EXPECT_GT(seen.not_covered, 300u);
  EXPECT_GT(seen.fields, 150'000u);
  EXPECT_GT(seen.hull, 10u);
  for (std::size_t bit = 0; bit < seen.flag.size(); ++bit) EXPECT_GE(seen.flag[bit], 3u) << "flag " << bit;
}

TEST(ExplainBoundaries, WithoutSkips) {
  const Seen seen = expect_groups_and_families(Config{}, 0, 1);
  EXPECT_GT(seen.covered, 200u);
}

/// No key at its default that changes a number.
TEST(ExplainBoundaries, OfAnOddMachine) {
  Config config;
  set(config, {{"viewport_bits", 9},
               {"guard_bits", 2},
               {"subpixel_bits", 5},
               {"homogeneous_frac_bits", 6},
               {"quadratic_frac_bits", 17},
               {"significand_bits", 12},
               {"notch_exact", 0},
               {"align_guard_bits", 0},
               {"attribute_slots", 3},
               {"attribute_int_bits", 4},
               {"depth_bits", 16},
               {"tile_log2", 2},
               {"pixels_per_clock", 4},
               {"dot_units", 4}});
  const Seen seen = expect_groups_and_families(config, skip_default, 2);
  EXPECT_GT(seen.covered, 500u);
}

TEST(ExplainBoundaries, OfPlaneQuads) {
  Config config;
  set(config, {{"plane_quads", 1}, {"tile_log2", 4}});
  Seen seen;
  DrawState state = small_state(config, 48);
  state.skip |= skip_plane;
  state.attributes = 1;
  WindowQuad quad;
  quad.vertex = {{{3, 5, 0.25, 1}, {41, 5, 0.25, 1}, {41, 33, 0.75, 1}, {3, 33, 0.75, 1}}};
  quad.attribute = {{{1}, {1}, {-2}, {-2}}};
  expect_quad(snap_quad(quad, config, state), config, state, seen);
  EXPECT_GE(seen.covered, 3u);
  const std::vector<Explanation> e = explain(config, state, std::span(&quad, 1), 20, 20);
  ASSERT_EQ(e.front().remarks.size(), 1u);
  EXPECT_NE(e.front().remarks.front().find("plane quad"), std::string::npos);
}

TEST(ExplainBoundaries, OfScenes) {
  Seen seen;
  const Config config;
  for (const char* name : {"fig10_concave", "bowtie", "fig8_behind", "sphere", "eye_in_hull", "fig10_crossed"}) {
    SCOPED_TRACE(name);
    DrawState state = small_state(config, 64);
    const std::vector<WindowQuad> quads = golden::scene_quads(golden::make_scene(name), 64, 64);
    for (std::size_t i = 0; i < quads.size(); i += quads.size() / 12 + 1)
      expect_quad(snap_quad(quads[i], config, state), config, state, seen);
  }
  EXPECT_GT(seen.covered, 60u);
  EXPECT_GT(seen.flag[6], 0u);  // the notch of a reflex corner
}

// ---- Kept golden vectors ----

std::vector<std::string> lines(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::string> out;
  for (std::string line; std::getline(file, line);) out.push_back(line);
  return out;
}

/// The fragments that were recorded, from the vertices that were.
TEST(ExplainBoundaries, OfKeptVectors) {
  const Config config;  // that of the kept set
  const vectors::Layouts layouts(config);
  std::size_t fragments = 0;
  for (const char* suite : {"machine", "stress_bowtie", "stress_eye_crossing", "stress_reflex"}) {
    SCOPED_TRACE(suite);
    const std::string folder = std::string(QUADRILLE_SOURCE_DIR) + "/golden/vectors/kept/" + suite + "/";
    std::vector<DrawState> states;
    for (const std::string& line : lines(folder + "states.hex")) {
      auto record = vectors::unpacked<vectors::StateRecord>(Record::from_hex(line, layouts.state.bits()), config);
      record.state.width = record.state.scissor_x1;
      record.state.height = record.state.scissor_y1;
      record.state.znear = std::ldexp(record.znear, -config.depth_bits);
      record.state.zfar = std::ldexp(record.zfar, -config.depth_bits);
      record.state.skip &= ~std::uint32_t{skip_hidden};
      states.push_back(record.state);
    }
    std::map<std::pair<std::uint32_t, std::uint32_t>, SnappedQuad> quads;
    const std::vector<std::string> beats = lines(folder + "stimulus.hex");
    ASSERT_EQ(beats.size() % 4, 0u);
    for (std::size_t i = 0; i < beats.size(); i += 4) {
      SnappedQuad quad;
      std::uint32_t draw = 0;
      for (std::size_t v = 0; v < 4; ++v) {
        const auto record =
            vectors::unpacked<vectors::VertexRecord>(Record::from_hex(beats[i + v], layouts.vertex.bits()), config);
        if (v == 0) quad.id = record.beat.id, quad.base = record.beat.base, draw = record.draw;
        quad.vertex[v] = record.beat.vertex;
      }
      quads[{draw, quad.id}] = quad;
    }
    const std::vector<std::string> response = lines(folder + "response.hex");
    for (std::size_t i = 0; i < response.size(); i += 3) {
      const auto record =
          vectors::unpacked<vectors::FragmentRecord>(Record::from_hex(response[i], layouts.fragment.bits()), config);
      const Fragment& g = record.fragment;
      SCOPED_TRACE("line " + std::to_string(i + 1));
      const DrawState& state = states.at(record.draw);
      Explanation e = explain(config, state, quads.at({record.draw, g.quad}), g.x, g.y);
      ASSERT_EQ(e.outcome, Outcome::drawn) << e.why;
      Stage stage = *find(e, Boundary::fragment);
      const Record expected = packed(Boundary::fragment, config, [&](auto& f) { visit(g, config, f); });
      compare(stage, boundary_layout(Boundary::fragment, config), &expected);
      EXPECT_EQ(stage.compared, Stage::Compared::same);
      ++fragments;
    }
  }
  EXPECT_GT(fragments, 200u);
}

}  // namespace
}  // namespace quadrille::explain
