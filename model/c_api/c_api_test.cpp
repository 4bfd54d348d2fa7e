// The C interface against the C++ one, bit for bit and clock for clock, and its errors.
#include "golden/scenes/scenes.hpp"
#include "golden/scenes/stress.hpp"
#include "model/c_api/quadrille.h"
#include "model/clocked.hpp"
#include "model/port/bit_vector.hpp"
#include "model/port/boundaries.hpp"
#include "model/port/config_text.hpp"
#include "model/port/draw_state.hpp"
#include "model/port/snap.hpp"
#include "model/support/prng.hpp"
#include "model/untimed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace quadrille {
namespace {

constexpr int side = 64;

struct Setting {
  const char* config;
  std::uint32_t skip;
  int attributes;
  bool perspective, depth;
};

constexpr std::array settings{
    Setting{"", skip_default, 4, true, true},
    Setting{"significand_bits = 12\nattribute_slots = 2\npixels_per_clock = 4", 0, 2, false, true},
    Setting{"pixels_per_clock=2 attribute_slots=8 dot_units=4", skip_default, 3, true, false},
    Setting{"hierarchical_z_bits=12 plane_quads=1", skip_default | skip_hidden | skip_plane, 4, true, true},
};

Config config_of(const Setting& setting) {
  Config config;
  apply_config_text(setting.config, config);
  return config;
}

DrawState state_of(const Setting& setting) {
  DrawState state;
  state.width = state.height = side;
  state.scissor_x0 = 3;
  state.scissor_y1 = state.scissor_x1 = side - 1;
  state.attributes = setting.attributes;
  state.perspective = setting.perspective;
  state.depth = setting.depth;
  state.zfar = 0.9375;
  state.skip = setting.skip;
  return state;
}

quadrille_draw_state c_state_of(const Setting& setting) {
  quadrille_draw_state state;
  EXPECT_EQ(quadrille_draw_state_init(&state, sizeof state, side, side), QUADRILLE_OK);
  state.scissor_x0 = 3;
  state.scissor_y1 = state.scissor_x1 = side - 1;
  state.attributes = setting.attributes;
  state.perspective = setting.perspective;
  state.depth = setting.depth;
  state.zfar = 0.9375;
  state.skip = setting.skip;
  return state;
}

/// A figure with a vertex behind the eye, and some quads of every stress family.
std::vector<WindowQuad> quads_of(int attributes) {
  auto quads = golden::scene_quads(golden::make_scene("fig8_behind"), side, side);
  for (const auto& info : golden::stress_families())
    for (const WindowQuad& quad : golden::make_stress(info.family, 2, 7, 1.0, side, side, attributes))
      quads.push_back(quad);
  for (std::size_t i = 0; i < quads.size(); ++i) {
    quads[i].id = static_cast<std::uint32_t>(100 + i);
    for (auto& values : quads[i].attribute) values.resize(static_cast<std::size_t>(attributes));
  }
  return quads;
}

std::vector<quadrille_vertex> c_vertices(const std::vector<WindowQuad>& quads) {
  std::vector<quadrille_vertex> vertices;
  for (const WindowQuad& quad : quads)
    for (std::size_t i = 0; i < 4; ++i) {
      quadrille_vertex v{quad.vertex[i].x, quad.vertex[i].y, quad.vertex[i].z, quad.vertex[i].w, {}};
      // What the draw state does not use must not matter.
      std::fill(std::begin(v.attribute), std::end(v.attribute), std::numeric_limits<double>::quiet_NaN());
      std::copy(quad.attribute[i].begin(), quad.attribute[i].end(), v.attribute);
      vertices.push_back(v);
    }
  return vertices;
}

::testing::AssertionResult same(const quadrille_fragment& c, const Fragment& f) {
  Fragment copy;
  copy.quad = c.quad;
  copy.x = c.x;
  copy.y = c.y;
  copy.front = c.front != 0;
  copy.flags = c.flags;
  copy.depth = c.depth;
  std::copy(std::begin(c.attribute), std::end(c.attribute), copy.attribute.begin());
  if (copy == f && c.reserved == 0) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "quad " << c.quad << " (" << c.x << ", " << c.y << "), expected quad "
                                       << f.quad << " (" << f.x << ", " << f.y << ")";
}

void expect_same(const std::vector<quadrille_fragment>& actual, const std::vector<Fragment>& expected) {
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t i = 0; i < actual.size(); ++i) ASSERT_TRUE(same(actual[i], expected[i])) << i;
}

std::string error() { return quadrille_last_error(); }

/// Takes what waits, a few at a time.
template <class Machine, class Pending, class Take>
std::vector<quadrille_fragment> take_all(Machine* machine, Pending pending, Take take) {
  std::size_t count = 0;
  EXPECT_EQ(pending(machine, &count), QUADRILLE_OK);
  std::vector<quadrille_fragment> all(count + 1);
  std::size_t taken = 0;
  for (std::size_t at = 0; at < count; at += taken) {
    EXPECT_EQ(take(machine, all.data() + at, 100, &taken), QUADRILLE_OK);
    if (taken == 0) break;
    all.resize(std::max(all.size(), at + taken + 101));
  }
  EXPECT_EQ(take(machine, all.data(), 1, &taken), QUADRILLE_OK);
  EXPECT_EQ(taken, 0u);
  all.resize(count);
  return all;
}

class CApi : public testing::TestWithParam<Setting> {
 protected:
  void SetUp() override {
    ASSERT_EQ(quadrille_untimed_create(GetParam().config, &untimed_), QUADRILLE_OK) << error();
    ASSERT_EQ(quadrille_clocked_create(GetParam().config, &clocked_), QUADRILLE_OK) << error();
    const quadrille_draw_state state = c_state_of(GetParam());
    ASSERT_EQ(quadrille_untimed_set_state(untimed_, &state), QUADRILLE_OK) << error();
    ASSERT_EQ(quadrille_clocked_set_state(clocked_, &state), QUADRILLE_OK) << error();
    for (const WindowQuad& quad : given_) snapped_.push_back(snap_quad(quad, config_, state_));
  }
  void TearDown() override {
    quadrille_untimed_destroy(untimed_);
    quadrille_clocked_destroy(clocked_);
  }

  Config config_ = config_of(GetParam());
  DrawState state_ = state_of(GetParam());
  std::vector<WindowQuad> given_ = quads_of(GetParam().attributes);
  std::vector<quadrille_vertex> vertices_ = c_vertices(given_);
  std::vector<SnappedQuad> snapped_;
  quadrille_untimed* untimed_ = nullptr;
  quadrille_clocked* clocked_ = nullptr;
};

TEST_P(CApi, UntimedIsTheUntimedModel) {
  std::vector<Fragment> expected;
  UntimedModel model(config_, state_);
  for (const SnappedQuad& quad : snapped_)
    model.draw(quad, [&](auto fragments) { expected.insert(expected.end(), fragments.begin(), fragments.end()); });
  ASSERT_GT(expected.size(), 1000u);
  ASSERT_EQ(quadrille_untimed_draw(untimed_, 100, vertices_.data(), given_.size()), QUADRILLE_OK) << error();
  expect_same(take_all(untimed_, quadrille_untimed_pending, quadrille_untimed_take), expected);
  std::uint64_t value = 0;
  ASSERT_EQ(quadrille_untimed_counter(untimed_, "fragments", &value), QUADRILLE_OK);
  EXPECT_EQ(value, expected.size());
  ASSERT_EQ(quadrille_untimed_counter(untimed_, "quads_empty", &value), QUADRILLE_OK);
  EXPECT_EQ(value, model.stats().rejected[static_cast<std::size_t>(QuadReject::empty)]);
  ASSERT_EQ(quadrille_untimed_counter(untimed_, "tiles_hidden", &value), QUADRILLE_OK);
  EXPECT_EQ(value, model.stats().tiles_hidden);
}

TEST_P(CApi, UntimedCountersAreListed) {
  UntimedModel model(config_, state_);
  for (const SnappedQuad& quad : snapped_) model.draw(quad, [](auto) {});
  ASSERT_EQ(quadrille_untimed_draw(untimed_, 100, vertices_.data(), given_.size()), QUADRILLE_OK) << error();
  const DrawStats& s = model.stats();
  const auto rejected = [&](QuadReject reason) { return s.rejected[static_cast<std::size_t>(reason)]; };
  const std::map<std::string, std::uint64_t> expected{{"quads", s.quads},
                                                      {"quads_empty", rejected(QuadReject::empty)},
                                                      {"quads_behind", rejected(QuadReject::behind)},
                                                      {"quads_depth", rejected(QuadReject::depth)},
                                                      {"quads_line", rejected(QuadReject::line)},
                                                      {"quads_culled", rejected(QuadReject::culled)},
                                                      {"quads_outside", rejected(QuadReject::outside)},
                                                      {"quads_homogeneous", s.homogeneous_quads},
                                                      {"blocks_tested", s.blocks_tested},
                                                      {"blocks_hidden", s.blocks_hidden},
                                                      {"tiles_tested", s.tiles_tested},
                                                      {"tiles_entered", s.tiles_entered},
                                                      {"tiles_hidden", s.tiles_hidden},
                                                      {"tiles_masked", s.tiles_masked},
                                                      {"stamps", s.stamps_covered},
                                                      {"pixels", s.pixels},
                                                      {"fragments", s.fragments}};
  std::map<std::string, std::uint64_t> actual;
  for (std::uint32_t index = 0; const char* name = quadrille_untimed_counter_name(index); ++index)
    ASSERT_EQ(quadrille_untimed_counter(untimed_, name, &actual[name]), QUADRILLE_OK) << error();
  EXPECT_EQ(actual, expected);
  EXPECT_GT(expected.at("tiles_entered"), expected.at("quads_homogeneous"));
  EXPECT_GT(expected.at("quads_homogeneous"), 0u);
}

/// The same again after a clear of the depth buffer gives the same again.
TEST_P(CApi, ClearHiddenForgetsWhatWasDrawn) {
  std::vector<quadrille_fragment> drawn[2];
  for (auto& fragments : drawn) {
    ASSERT_EQ(quadrille_untimed_draw(untimed_, 100, vertices_.data(), given_.size()), QUADRILLE_OK) << error();
    fragments = take_all(untimed_, quadrille_untimed_pending, quadrille_untimed_take);
    ASSERT_EQ(quadrille_untimed_clear_hidden(untimed_), QUADRILLE_OK) << error();
  }
  ASSERT_EQ(drawn[0].size(), drawn[1].size());
  for (std::size_t i = 0; i < drawn[0].size(); ++i) {
    EXPECT_EQ(drawn[0][i].quad, drawn[1][i].quad);
    EXPECT_EQ(drawn[0][i].x, drawn[1][i].x);
    EXPECT_EQ(drawn[0][i].y, drawn[1][i].y);
  }
}

/// Clock by clock beside the C++ model, with gaps and stalls; the ports as words too.
TEST_P(CApi, ClockedIsTheClockedModelInEveryClock) {
  ClockedModel model(config_, state_);
  ClockedInputs inputs;
  inputs.reset = true;
  model.clock(inputs);
  inputs.reset = false;
  while (model.comb().busy) model.clock(inputs);
  quadrille_clocked* by_ports = nullptr;
  ASSERT_EQ(quadrille_clocked_create(GetParam().config, &by_ports), QUADRILLE_OK);
  std::vector<std::uint32_t> words = tb::pack_state(state_, config_);
  words.resize(QUADRILLE_STATE_WORDS);
  ASSERT_EQ(quadrille_clocked_state_port(by_ports, words.data()), QUADRILLE_OK) << error();
  const int bits = boundary_layout(Boundary::fragment, config_).bits();

  ASSERT_EQ(quadrille_clocked_push(clocked_, 100, vertices_.data(), given_.size()), QUADRILLE_OK) << error();
  golden::Prng random(11);
  std::vector<Fragment> expected;
  std::size_t beat = 0, stalled = 0, flushed = 0;
  std::uint64_t cycle = 0;
  std::array<std::array<std::uint32_t, QUADRILLE_VERTEX_WORDS>, 4> beats{};
  std::array<double, 16> positions{};
  std::array<double, std::size_t{4} * QUADRILLE_MAX_ATTRIBUTES> attributes{};
  for (;; ++cycle) {
    ASSERT_LT(cycle, 2'000'000u);
    const ClockedOutputs now = model.comb();
    if (beat == 4 * snapped_.size() && !now.busy) break;

    quadrille_outputs outputs;
    ASSERT_EQ(quadrille_clocked_outputs(clocked_, &outputs), QUADRILLE_OK);
    std::array<std::int32_t, 4> port{};
    std::array<std::uint32_t, QUADRILLE_FRAGMENT_WORDS> fragments;
    ASSERT_EQ(quadrille_clocked_output_ports(by_ports, &port[0], &port[1], &port[2], &port[3], fragments.data()),
              QUADRILLE_OK);
    ASSERT_EQ((std::array<std::uint32_t, 4>{outputs.vertex_ready, outputs.fragment_valid, outputs.busy,
                                            outputs.fragment_mask}),
              (std::array<std::uint32_t, 4>{now.vertex_ready, now.fragment_valid, now.busy, now.fragment_mask()}))
        << cycle;
    ASSERT_EQ((std::array<std::int32_t, 4>{now.vertex_ready, now.fragment_valid, now.busy,
                                           static_cast<std::int32_t>(now.fragment_mask())}),
              port)
        << cycle;
    const Record lanes = Record::from_words(fragments.data(), 32 * QUADRILLE_FRAGMENT_WORDS);
    for (std::size_t lane = 0; lane < now.fragment.size(); ++lane) {
      if (now.fragment[lane] == nullptr) continue;
      ASSERT_TRUE(same(outputs.fragment[lane], *now.fragment[lane])) << cycle;
      std::vector<std::uint32_t> one;
      for (int at = 0; at < bits; at += 32)
        one.push_back(
            static_cast<std::uint32_t>(lanes.get(static_cast<int>(lane) * bits + at, std::min(32, bits - at))));
      ASSERT_EQ(tb::unpack_fragment(one.data(), bits, config_), *now.fragment[lane]) << cycle;
    }

    inputs.vertex_valid = beat < 4 * snapped_.size() && random.below(4) != 0;
    inputs.fragment_ready = random.below(3) != 0;
    std::array<std::uint32_t, QUADRILLE_VERTEX_WORDS> vertex{};
    if (inputs.vertex_valid) {
      inputs.vertex = beat_of(snapped_[beat / 4], beat % 4);
      for (std::size_t i = 0; i < 4 && beat % 4 == 0; ++i) {
        const quadrille_vertex& v = vertices_[beat + i];
        std::ranges::copy(std::array{v.x, v.y, v.z, v.w}, positions.begin() + static_cast<std::ptrdiff_t>(4 * i));
        std::ranges::copy(v.attribute, attributes.begin() + static_cast<std::ptrdiff_t>(QUADRILLE_MAX_ATTRIBUTES * i));
      }
      if (beat % 4 == 0) {
        ASSERT_EQ(quadrille_quad_port(by_ports, inputs.vertex.id, positions.data(), attributes.data(), beats[0].data()),
                  QUADRILLE_OK)
            << error();
      }
      vertex = beats[beat % 4];
    }
    if (now.fragment_valid && inputs.fragment_ready)
      now.for_each_fragment([&](const Fragment& f) { expected.push_back(f); });
    stalled += now.fragment_valid && !inputs.fragment_ready;
    inputs.flush = random.below(40) == 0;
    inputs.clear_hidden = now.busy && random.below(4) == 0;  // ignored; the queue's clock() would refuse it
    const bool taken = inputs.vertex_valid && now.vertex_ready;
    if (inputs.flush && (taken || beat % 4 != 0)) {
      beat += 4 - beat % 4;  // the queue's quad is gone with its beats
      ++flushed;
    } else {
      beat += taken;
    }
    ASSERT_EQ(quadrille_clocked_clock(clocked_, 0u | (inputs.vertex_valid ? +QUADRILLE_VERTEX_VALID : 0) |
                                                    (inputs.fragment_ready ? +QUADRILLE_FRAGMENT_READY : 0) |
                                                    (inputs.flush ? +QUADRILLE_FLUSH : 0)),
              QUADRILLE_OK);
    ASSERT_EQ(quadrille_clocked_flush_port(by_ports, inputs.flush), QUADRILLE_OK);
    ASSERT_EQ(quadrille_clocked_clock_ports(by_ports, 0, inputs.clear_hidden, inputs.vertex_valid, vertex.data(),
                                            inputs.fragment_ready),
              QUADRILLE_OK)
        << error();
    model.clock(inputs);
  }
  EXPECT_GT(stalled, 100u);
  EXPECT_GT(flushed, 5u);
  ASSERT_GT(expected.size(), 1000u);
  expect_same(take_all(clocked_, quadrille_clocked_pending, quadrille_clocked_take), expected);
  std::size_t waiting = 1;
  EXPECT_EQ(quadrille_clocked_pending(by_ports, &waiting), QUADRILLE_OK);
  EXPECT_EQ(waiting, 0u);
  std::uint32_t index = 0;
  for (; const char* name = quadrille_clocked_counter_name(index); ++index) {
    std::array<std::uint64_t, 2> value{};
    ASSERT_EQ(quadrille_clocked_counter(clocked_, name, &value[0]), QUADRILLE_OK);
    ASSERT_EQ(quadrille_clocked_counter(by_ports, name, &value[1]), QUADRILLE_OK);
    EXPECT_EQ(value[0], model.counters().value[index]) << name;
    EXPECT_EQ(value[1], model.counters().value[index]) << name;
  }
  EXPECT_EQ(index, counter_count);
  quadrille_clocked_destroy(by_ports);
}

/// Beats of a quad that is not complete keep the machine busy until a flush; what follows is drawn as if they had not
/// come. A quad that is complete stays.
TEST_P(CApi, AFlushDiscardsAnIncompleteQuadAlone) {
  const auto clock = [&](std::uint32_t inputs, int clocks) {
    for (int i = 0; i < clocks; ++i) ASSERT_EQ(quadrille_clocked_clock(clocked_, inputs), QUADRILLE_OK) << error();
  };
  const auto busy = [&] {
    quadrille_outputs outputs;
    EXPECT_EQ(quadrille_clocked_outputs(clocked_, &outputs), QUADRILLE_OK);
    return outputs.busy != 0;
  };
  const std::array<quadrille_vertex, 4> square{
      {{8, 8, 0.5, 1, {1}}, {8, 20, 0.5, 1, {2}}, {20, 20, 0.5, 1, {}}, {20, 8, 0.5, 1, {}}}};
  for (int beats = 1; beats < 4; ++beats) {
    ASSERT_EQ(quadrille_clocked_push(clocked_, 7, square.data(), 1), QUADRILLE_OK) << error();
    clock(QUADRILLE_VERTEX_VALID, beats);
    clock(QUADRILLE_FRAGMENT_READY, 2000);
    EXPECT_TRUE(busy());
    clock(QUADRILLE_FLUSH | QUADRILLE_FRAGMENT_READY, 1);
    EXPECT_FALSE(busy());
    std::uint64_t clocks = 1;
    ASSERT_EQ(quadrille_clocked_run(clocked_, 1000, &clocks), QUADRILLE_OK);
    EXPECT_EQ(clocks, 0u) << "the quad is gone from the queue";
  }
  ASSERT_EQ(quadrille_untimed_draw(untimed_, 100, square.data(), 1), QUADRILLE_OK) << error();
  ASSERT_EQ(quadrille_clocked_push(clocked_, 100, square.data(), 1), QUADRILLE_OK) << error();
  clock(QUADRILLE_VERTEX_VALID, 4);
  clock(QUADRILLE_FLUSH, 1);
  ASSERT_EQ(quadrille_clocked_run(clocked_, 1u << 20, nullptr), QUADRILLE_OK);
  const auto clocked = take_all(clocked_, quadrille_clocked_pending, quadrille_clocked_take);
  const auto untimed = take_all(untimed_, quadrille_untimed_pending, quadrille_untimed_take);
  ASSERT_EQ(untimed.size(), 144u);
  ASSERT_EQ(clocked.size(), untimed.size());
  for (std::size_t i = 0; i < clocked.size(); ++i)
    ASSERT_EQ(std::memcmp(&clocked[i], &untimed[i], sizeof clocked[i]), 0) << i;
}

TEST_P(CApi, ARunGivesWhatTheUntimedModelDraws) {
  ASSERT_EQ(quadrille_untimed_draw(untimed_, 100, vertices_.data(), given_.size()), QUADRILLE_OK) << error();
  ASSERT_EQ(quadrille_clocked_push(clocked_, 100, vertices_.data(), given_.size()), QUADRILLE_OK) << error();
  std::uint64_t first = 0, rest = 0, before = 0, counted = 0;
  ASSERT_EQ(quadrille_clocked_counter(clocked_, "clocks", &before), QUADRILLE_OK);
  ASSERT_EQ(quadrille_clocked_run(clocked_, 500, &first), QUADRILLE_OK);
  EXPECT_EQ(first, 500u);
  ASSERT_EQ(quadrille_clocked_run(clocked_, std::uint64_t{1} << 40, &rest), QUADRILLE_OK);
  ASSERT_EQ(quadrille_clocked_counter(clocked_, "clocks", &counted), QUADRILLE_OK);
  EXPECT_EQ(counted - before, first + rest);
  const auto clocked = take_all(clocked_, quadrille_clocked_pending, quadrille_clocked_take);
  const auto untimed = take_all(untimed_, quadrille_untimed_pending, quadrille_untimed_take);
  ASSERT_GT(untimed.size(), 1000u);
  if ((GetParam().skip & skip_hidden) != 0) return;  // what is hidden depends on when a tile's depth is known
  ASSERT_EQ(clocked.size(), untimed.size());
  for (std::size_t i = 0; i < clocked.size(); ++i)
    ASSERT_EQ(std::memcmp(&clocked[i], &untimed[i], sizeof clocked[i]), 0) << i;
}

INSTANTIATE_TEST_SUITE_P(Settings, CApi, testing::ValuesIn(settings));

// ---- Errors ----

class CApiErrors : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(quadrille_untimed_create(nullptr, &untimed_), QUADRILLE_OK);
    ASSERT_EQ(quadrille_clocked_create("", &clocked_), QUADRILLE_OK);
    ASSERT_EQ(quadrille_draw_state_init(&state_, sizeof state_, side, side), QUADRILLE_OK);
    vertices_ = {{{8, 8, 0.5, 1, {}}, {8, 40, 0.5, 1, {}}, {40, 40, 0.5, 1, {}}, {40, 8, 0.5, 1, {}}}};
  }
  void TearDown() override {
    quadrille_untimed_destroy(untimed_);
    quadrille_clocked_destroy(clocked_);
  }
  static void expect_error(quadrille_status actual, quadrille_status expected, const char* words) {
    EXPECT_EQ(actual, expected) << words;
    EXPECT_NE(error().find(words), std::string::npos) << error();
  }

  quadrille_untimed* untimed_ = nullptr;
  quadrille_clocked* clocked_ = nullptr;
  quadrille_draw_state state_{};
  std::array<quadrille_vertex, 4> vertices_{};
};

TEST_F(CApiErrors, Configurations) {
  quadrille_untimed* untimed = untimed_;
  expect_error(quadrille_untimed_create("significand_bits = 18\nsignificant_bits = 3", &untimed), QUADRILLE_BAD_CONFIG,
               "line 2");
  EXPECT_EQ(untimed, nullptr);
  quadrille_clocked* clocked = nullptr;
  expect_error(quadrille_clocked_create("viewport_bits=14 guard_bits=4", &clocked), QUADRILLE_BAD_CONFIG, "VAL_BITS");
  expect_error(quadrille_clocked_create("", nullptr), QUADRILLE_BAD_ARGUMENT, "NULL");
  expect_error(quadrille_clocked_create("plane_tolerance_bits=31", &clocked), QUADRILLE_BAD_CONFIG, "plane_quads = 1");
  ASSERT_EQ(quadrille_clocked_create("plane_tolerance_bits=0", &clocked), QUADRILLE_OK);
  quadrille_clocked_destroy(clocked);
  std::int32_t value = 0;
  EXPECT_EQ(quadrille_config_value("significand_bits=12", "attribute_frac_bits", &value), QUADRILLE_OK);
  EXPECT_EQ(value, 24);
  EXPECT_EQ(quadrille_config_value(nullptr, "VAL_BITS", &value), QUADRILLE_OK);
  EXPECT_EQ(value, 63);
  expect_error(quadrille_config_value(nullptr, "VAL", &value), QUADRILLE_BAD_ARGUMENT, "\"VAL\"");
}

TEST_F(CApiErrors, DrawStates) {
  const quadrille_draw_state good = state_;
  const auto refused = [&](quadrille_status status, const char* words) {
    expect_error(quadrille_untimed_set_state(untimed_, &state_), status, words);
    expect_error(quadrille_clocked_set_state(clocked_, &state_), status, words);
    state_ = good;
  };
  state_.size = 8;
  refused(QUADRILLE_BAD_ARGUMENT, "sizeof");
  state_.width = 5000;
  refused(QUADRILLE_BAD_STATE, "viewport");
  state_.scissor_x1 = side + 1;
  refused(QUADRILLE_BAD_STATE, "scissor");
  state_.scissor_y0 = -1;
  refused(QUADRILLE_BAD_STATE, "scissor");
  state_.cull = 3;
  refused(QUADRILLE_BAD_STATE, "cull");
  state_.cull = 258;
  refused(QUADRILLE_BAD_STATE, "cull");
  state_.zfar = 1.5;
  refused(QUADRILLE_BAD_STATE, "zfar");
  state_.znear = std::numeric_limits<double>::quiet_NaN();
  refused(QUADRILLE_BAD_STATE, "znear");
  state_.attributes = 5;
  refused(QUADRILLE_BAD_STATE, "attribute_slots");
  state_.attributes = -1;
  refused(QUADRILLE_BAD_STATE, "attributes");
  state_.skip = 64;
  refused(QUADRILLE_BAD_STATE, "skip");
  state_.attributes = 9;
  refused(QUADRILLE_BAD_STATE, "attribute_slots");
  state_.height = 0;
  refused(QUADRILLE_BAD_STATE, "viewport");
  state_.scissor_x0 = side;
  state_.scissor_x1 = side - 1;
  refused(QUADRILLE_BAD_STATE, "X0 must not exceed X1");
  state_.skip |= QUADRILLE_SKIP_HIDDEN;
  refused(QUADRILLE_BAD_STATE, "hierarchical_z_bits");
  state_.skip |= QUADRILLE_SKIP_PLANE;
  refused(QUADRILLE_BAD_STATE, "plane_quads");
}

/// Every size that an older header may have had: what lies behind is not read, and is as quadrille_draw_state_init()
/// sets it. A struct of a newer header counts if what this library does not know is 0.
class CApiSizes : public CApiErrors {
 protected:
  using Bytes = std::vector<std::uint64_t>;  ///< aligned as the struct is

  static constexpr std::size_t ends[] = {12, 16, 20, 24, 28, 32, 36, 40, 44, 48, 56, 64};

  /// The first `size` bytes of a state in memory that ends with them, as far as eight bytes allow.
  static Bytes cut(const quadrille_draw_state& state, std::size_t size) {
    Bytes bytes((size + 7) / 8, ~std::uint64_t{0});
    std::memcpy(bytes.data(), &state, std::min(size, sizeof state));
    const auto said = static_cast<std::uint32_t>(size);
    std::memcpy(bytes.data(), &said, sizeof said);
    return bytes;
  }
  static const quadrille_draw_state* as_state(const Bytes& bytes) {
    return reinterpret_cast<const quadrille_draw_state*>(bytes.data());
  }

  /// What both machines draw with the state that they have.
  std::array<std::vector<quadrille_fragment>, 2> drawn() {
    std::array<std::vector<quadrille_fragment>, 2> out;
    std::array<quadrille_vertex, 8> quads{};
    for (std::size_t i = 0; i < 4; ++i) {
      quadrille_vertex& v = quads[i];
      v = vertices_[i];
      v.z = i < 2 ? 0.125 : 0.625;  // cut by znear and zfar
      for (int a = 0; a < 8; ++a) v.attribute[a] = i == 2 ? 1 + a : -a;
      if (i == 2) v.x *= 2, v.y *= 2, v.z *= 2, v.w = 2;
      quads[7 - i] = v;  // the other face
    }
    std::size_t count = 0;
    EXPECT_EQ(quadrille_untimed_draw(untimed_, 0, quads.data(), 2), QUADRILLE_OK) << error();
    EXPECT_EQ(quadrille_untimed_pending(untimed_, &count), QUADRILLE_OK);
    out[0].resize(count);
    EXPECT_EQ(quadrille_untimed_take(untimed_, out[0].data(), count, &count), QUADRILLE_OK);
    EXPECT_EQ(quadrille_clocked_push(clocked_, 0, quads.data(), 2), QUADRILLE_OK) << error();
    EXPECT_EQ(quadrille_clocked_run(clocked_, 1u << 20, nullptr), QUADRILLE_OK);
    EXPECT_EQ(quadrille_clocked_pending(clocked_, &count), QUADRILLE_OK);
    out[1].resize(count);
    EXPECT_EQ(quadrille_clocked_take(clocked_, out[1].data(), count, &count), QUADRILLE_OK);
    return out;
  }
  static bool same(const std::vector<quadrille_fragment>& a, const std::vector<quadrille_fragment>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0);
  }
};

TEST_F(CApiSizes, OlderOnesHaveTheDefaultsOfWhatTheyLack) {
  quadrille_draw_state other = state_;
  other.width = 60, other.height = 52;
  other.scissor_x0 = 10, other.scissor_y0 = 11, other.scissor_x1 = 35, other.scissor_y1 = 36;
  other.cull = QUADRILLE_CULL_BACK, other.perspective = 0, other.depth = 1, other.attributes = 2, other.skip = 0;
  other.znear = 0.25, other.zfar = 0.5;
  std::array<std::vector<quadrille_fragment>, 2> before{};
  std::size_t changes = 0;
  for (const std::size_t size : ends) {
    SCOPED_TRACE(size);
    const Bytes bytes = cut(other, size);
    ASSERT_EQ(quadrille_untimed_set_state(untimed_, as_state(bytes)), QUADRILLE_OK) << error();
    ASSERT_EQ(quadrille_clocked_set_state(clocked_, as_state(bytes)), QUADRILLE_OK) << error();
    const auto actual = drawn();
    quadrille_draw_state whole{};
    ASSERT_EQ(quadrille_draw_state_init(&whole, sizeof whole, other.width, other.height), QUADRILLE_OK);
    std::memcpy(&whole, &other, size);
    ASSERT_EQ(quadrille_untimed_set_state(untimed_, &whole), QUADRILLE_OK) << error();
    ASSERT_EQ(quadrille_clocked_set_state(clocked_, &whole), QUADRILLE_OK) << error();
    const auto expected = drawn();
    for (std::size_t machine = 0; machine < 2; ++machine) {
      EXPECT_FALSE(actual[machine].empty());
      EXPECT_TRUE(same(actual[machine], expected[machine]));
    }
    changes += !same(actual[0], before[0]);
    before = actual;
  }
  EXPECT_EQ(changes, 10u) << "of twelve sizes; those that end with `depth` and `skip` add nothing to be seen";

  // init writes what the caller has room for and no more.
  for (const std::size_t size : ends) {
    Bytes bytes(16, 0x5555555555555555u);
    auto* const state = reinterpret_cast<quadrille_draw_state*>(bytes.data());
    ASSERT_EQ(quadrille_draw_state_init(state, size, side, side), QUADRILLE_OK) << error();
    EXPECT_EQ(state->size, size);
    quadrille_draw_state good = state_;
    good.size = static_cast<std::uint32_t>(size);
    EXPECT_EQ(std::memcmp(bytes.data(), &good, size), 0);
    const auto* const all = reinterpret_cast<const unsigned char*>(bytes.data());
    EXPECT_TRUE(std::all_of(all + size, all + 128, [](unsigned char byte) { return byte == 0x55; })) << size;
  }
}

TEST_F(CApiSizes, AttributesThatAnOlderOneLacksAreThoseOfTheConfiguration) {
  quadrille_untimed* one = nullptr;
  ASSERT_EQ(quadrille_untimed_create("attribute_slots=1", &one), QUADRILLE_OK);
  const Bytes bytes = cut(state_, 40);
  EXPECT_EQ(quadrille_untimed_set_state(one, as_state(bytes)), QUADRILLE_OK) << error();
  quadrille_untimed_destroy(one);
}

TEST_F(CApiSizes, NewerOnesMayNotSetWhatIsUnknown) {
  for (const std::size_t size : {72u, 128u, 1024u}) {
    Bytes bytes(size / 8, 0);
    std::memcpy(bytes.data(), &state_, sizeof state_);
    const auto said = static_cast<std::uint32_t>(size);
    std::memcpy(bytes.data(), &said, sizeof said);
    EXPECT_EQ(quadrille_untimed_set_state(untimed_, as_state(bytes)), QUADRILLE_OK) << error();
    bytes.back() = 1;
    expect_error(quadrille_untimed_set_state(untimed_, as_state(bytes)), QUADRILLE_BAD_ARGUMENT, "older");
    expect_error(quadrille_clocked_set_state(clocked_, as_state(bytes)), QUADRILLE_BAD_ARGUMENT, "older");
    ASSERT_EQ(quadrille_draw_state_init(reinterpret_cast<quadrille_draw_state*>(bytes.data()), size, side, side),
              QUADRILLE_OK);
    EXPECT_EQ(bytes.back(), 0u);
  }
  for (const std::size_t size : {0u, 4u, 8u, 11u, 13u, 46u, 52u, 60u, 63u, 65u, 68u, 1032u, 0xfffffff8u}) {
    quadrille_draw_state bad = state_;
    bad.size = static_cast<std::uint32_t>(size);
    expect_error(quadrille_untimed_set_state(untimed_, &bad), QUADRILLE_BAD_ARGUMENT, "sizeof");
    expect_error(quadrille_clocked_set_state(clocked_, &bad), QUADRILLE_BAD_ARGUMENT, "sizeof");
    expect_error(quadrille_draw_state_init(&bad, size, side, side), QUADRILLE_BAD_ARGUMENT, "sizeof");
  }
}

TEST_F(CApiErrors, VerticesDrawNothingOfTheirCall) {
  std::array<quadrille_vertex, 8> two{};
  std::copy(vertices_.begin(), vertices_.end(), two.begin());
  std::copy(vertices_.begin(), vertices_.end(), two.begin() + 4);
  two[6].x = std::numeric_limits<double>::infinity();
  expect_error(quadrille_untimed_draw(untimed_, 30, two.data(), 2), QUADRILLE_BAD_VERTEX, "quad 31");
  expect_error(quadrille_clocked_push(clocked_, 30, two.data(), 2), QUADRILLE_BAD_VERTEX, "vertex 2");
  std::size_t pending = 1;
  EXPECT_EQ(quadrille_untimed_pending(untimed_, &pending), QUADRILLE_OK);
  EXPECT_EQ(pending, 0u);
  std::uint64_t clocks = 1;
  EXPECT_EQ(quadrille_clocked_run(clocked_, 1000, &clocks), QUADRILLE_OK);
  EXPECT_EQ(clocks, 0u) << "nothing was queued";
  expect_error(quadrille_untimed_draw(untimed_, 1u << 24, vertices_.data(), 1), QUADRILLE_BAD_VERTEX, "quad_id_bits");
  expect_error(quadrille_untimed_draw(untimed_, 0xffffffffu, two.data(), 2), QUADRILLE_BAD_ARGUMENT, "ids");
  expect_error(quadrille_untimed_draw(untimed_, 0, nullptr, 1), QUADRILLE_BAD_ARGUMENT, "NULL");
  EXPECT_EQ(quadrille_untimed_draw(untimed_, 0, nullptr, 0), QUADRILLE_OK);
}

TEST_F(CApiErrors, StatesChangeWhileIdleAlone) {
  ASSERT_EQ(quadrille_clocked_push(clocked_, 0, vertices_.data(), 1), QUADRILLE_OK);
  expect_error(quadrille_clocked_set_state(clocked_, &state_), QUADRILLE_BUSY, "queued");
  ASSERT_EQ(quadrille_clocked_run(clocked_, 20, nullptr), QUADRILLE_OK);
  expect_error(quadrille_clocked_set_state(clocked_, &state_), QUADRILLE_BUSY, "busy");
  expect_error(quadrille_clocked_clock(clocked_, QUADRILLE_CLEAR_HIDDEN), QUADRILLE_BUSY, "hidden");
  expect_error(quadrille_clocked_clock(clocked_, 32), QUADRILLE_BAD_ARGUMENT, "inputs");
  ASSERT_EQ(quadrille_clocked_run(clocked_, 1u << 20, nullptr), QUADRILLE_OK);
  ASSERT_EQ(quadrille_clocked_set_state(clocked_, &state_), QUADRILLE_OK) << error();
  ASSERT_EQ(quadrille_clocked_clock(clocked_, QUADRILLE_CLEAR_HIDDEN), QUADRILLE_OK) << error();
  // Reset: what is queued and on its way is gone.
  ASSERT_EQ(quadrille_clocked_push(clocked_, 0, vertices_.data(), 1), QUADRILLE_OK);
  ASSERT_EQ(quadrille_clocked_run(clocked_, 20, nullptr), QUADRILLE_OK);
  ASSERT_EQ(quadrille_clocked_clock(clocked_, QUADRILLE_RESET), QUADRILLE_OK);
  EXPECT_EQ(quadrille_clocked_set_state(clocked_, &state_), QUADRILLE_OK) << error();
}

TEST_F(CApiErrors, PortsThatNoMachineMayBeGiven) {
  std::array<std::uint32_t, QUADRILLE_VERTEX_WORDS> vertex;
  vertex.fill(0);
  expect_error(quadrille_clocked_clock_ports(clocked_, 0, 0, 1, vertex.data(), 1), QUADRILLE_BAD_VERTEX,
               "k is not normalised");
  std::array<double, 16> positions{};
  std::array<double, std::size_t{4} * QUADRILLE_MAX_ATTRIBUTES> attributes{};
  for (std::size_t i = 0; i < 4; ++i)
    std::ranges::copy(std::array{vertices_[i].x, vertices_[i].y, vertices_[i].z, vertices_[i].w},
                      positions.begin() + static_cast<std::ptrdiff_t>(4 * i));
  std::array<std::uint32_t, std::size_t{4} * QUADRILLE_VERTEX_WORDS> beats{};
  ASSERT_EQ(quadrille_quad_port(clocked_, 5, positions.data(), attributes.data(), beats.data()), QUADRILLE_OK);
  std::copy_n(beats.begin() + QUADRILLE_VERTEX_WORDS, QUADRILLE_VERTEX_WORDS, vertex.begin());
  expect_error(quadrille_quad_port(clocked_, 5, positions.data(), attributes.data(), nullptr), QUADRILLE_BAD_ARGUMENT,
               "NULL");
  positions[6] = std::nan("");
  expect_error(quadrille_quad_port(clocked_, 5, positions.data(), attributes.data(), beats.data()),
               QUADRILLE_BAD_VERTEX, "vertex 1");
  const RecordLayout layout = vertex_layout(Config());
  const auto with = [&](const char* field, std::uint64_t value) {
    Record record = Record::from_words(vertex.data(), layout.bits());
    record.set(layout.field(field, std::string(field) == "attr_sig" ? 2 : -1), value);
    std::array<std::uint32_t, QUADRILLE_VERTEX_WORDS> words{};
    for (int at = 0; at < layout.bits(); at += 32)
      words[static_cast<std::size_t>(at / 32)] =
          static_cast<std::uint32_t>(record.get(at, std::min(32, layout.bits() - at)));
    return quadrille_clocked_clock_ports(clocked_, 0, 0, 1, words.data(), 1);
  };
  expect_error(with("x", (1u << 30) + 1), QUADRILLE_BAD_VERTEX, "guard band");
  expect_error(with("w", (1u << 15) + 1), QUADRILLE_BAD_VERTEX, "w is larger");
  expect_error(with("z_sig", 1), QUADRILLE_BAD_VERTEX, "z is not");
  expect_error(with("attr_sig", 1), QUADRILLE_BAD_VERTEX, "attribute");
  EXPECT_EQ(with("x", 1u << 30), QUADRILLE_OK) << error();
  EXPECT_EQ(quadrille_clocked_clock_ports(clocked_, 0, 0, 0, vertex.data(), 1), QUADRILLE_OK)
      << "not valid: not looked at";
  std::array<std::uint32_t, QUADRILLE_STATE_WORDS> state;
  state.fill(0xffffffffu);
  expect_error(quadrille_clocked_state_port(clocked_, state.data()), QUADRILLE_BAD_STATE, "draw state");
  // Each field by itself, as DPI gives it.
  const RecordLayout state_fields = state_layout(Config());
  const std::vector<std::uint32_t> good_state = tb::pack_state(draw_state_for(Config(), 512, 512), Config());
  const auto state_with = [&](const char* field, std::uint64_t value) {
    Record record = Record::from_words(good_state.data(), state_fields.bits());
    record.set(state_fields.field(field, -1), value);
    std::array<std::uint32_t, QUADRILLE_STATE_WORDS> words{};
    for (int at = 0; at < state_fields.bits(); at += 32)
      words[static_cast<std::size_t>(at / 32)] =
          static_cast<std::uint32_t>(record.get(at, std::min(32, state_fields.bits() - at)));
    return quadrille_clocked_state_port(clocked_, words.data());
  };
  expect_error(state_with("attributes", 5), QUADRILLE_BAD_STATE, "attribute_slots");
  expect_error(state_with("attributes", 9), QUADRILLE_BAD_STATE, "attribute_slots");
  expect_error(state_with("cull", 3), QUADRILLE_BAD_STATE, "cull");
  expect_error(state_with("scissor_x0", 513), QUADRILLE_BAD_STATE, "X0 must not exceed X1");
  expect_error(state_with("scissor_y1", 4097), QUADRILLE_BAD_STATE, "viewport");
  expect_error(state_with("zfar", (1u << 24) + 1), QUADRILLE_BAD_STATE, "zfar <= 1");
  expect_error(state_with("skip", 32 + 1), QUADRILLE_BAD_STATE, "plane_quads");
  expect_error(state_with("attributes", 3), QUADRILLE_BUSY, "busy");
  std::uint64_t value = 0;
  expect_error(quadrille_clocked_counter(clocked_, "nothing", &value), QUADRILLE_BAD_ARGUMENT, "\"nothing\"");
  expect_error(quadrille_untimed_counter(untimed_, "nothing", &value), QUADRILLE_BAD_ARGUMENT, "\"nothing\"");
  expect_error(quadrille_untimed_clear_hidden(nullptr), QUADRILLE_BAD_ARGUMENT, "NULL");
  expect_error(quadrille_untimed_counter(untimed_, nullptr, &value), QUADRILLE_BAD_ARGUMENT, "NULL");
}

}  // namespace
}  // namespace quadrille
