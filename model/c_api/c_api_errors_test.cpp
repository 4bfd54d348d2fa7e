#include "golden/scenes/stress.hpp"
#include "model/c_api/c_api_test_support.hpp"
#include "model/port/bit_vector.hpp"
#include "model/support/prng.hpp"

#include <array>
#include <limits>
#include <vector>

namespace quadrille {
namespace {

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
