// The C interface against the C++ one, bit for bit and clock for clock, and its errors.
#include "golden/scenes/scenes.hpp"
#include "golden/scenes/stress.hpp"
#include "model/c_api/c_api_test_support.hpp"
#include "model/port/bit_vector.hpp"
#include "model/port/config_text.hpp"
#include "model/port/snap.hpp"
#include "model/support/prng.hpp"
#include "model/untimed.hpp"

#include <array>
#include <limits>
#include <map>
#include <vector>

namespace quadrille {
namespace {

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

void expect_same(const std::vector<quadrille_fragment>& actual, const std::vector<Fragment>& expected) {
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t i = 0; i < actual.size(); ++i) ASSERT_TRUE(same(actual[i], expected[i])) << i;
}

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
    inputs.flush = random.below(20) == 0;
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

}  // namespace
}  // namespace quadrille
