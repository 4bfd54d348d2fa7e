// The stage suites: where their bits are, what their stimuli hold, and responses against independent evaluation.
#include "golden/vectors/stage_suite.hpp"
#include "golden/io/test_support.hpp"
#include "golden/vectors/patterns.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace {

using namespace quadrille;
using namespace quadrille::vectors;
namespace fs = std::filesystem;

const StageSuite& stage_suite(const std::string& name) { return dynamic_cast<const StageSuite&>(find_suite(name)); }

std::vector<std::string> stage_names() {
  std::vector<std::string> names;
  for (const auto& suite : suites())
    if (dynamic_cast<const StageSuite*>(suite.get()) != nullptr) names.push_back(suite->info().name);
  return names;
}

Config small_config() {
  Config c;
  c.set("significand_bits", 11);
  c.set("viewport_bits", 8);
  c.set("homogeneous_frac_bits", 5);
  c.set("subpixel_bits", 4);
  c.set("quadratic_frac_bits", 12);
  c.set("attribute_slots", 3);
  c.set("tile_log2", 2);
  c.validate();
  return c;
}

/// A record with its layout: fields by name, and numbers as long double (exponents up to ±1300 fit).
class Values {
 public:
  Values(const Record& record, const RecordLayout& layout) : record_(record), layout_(layout) {}
  std::int64_t integer(const std::string& name, int index = -1) const {
    const RecordField& f = layout_.field(name, index);
    return f.is_signed ? record_.get_signed(f) : static_cast<std::int64_t>(record_.get(f));
  }
  /// sig · 2^(exp - (S-1)), with the sign of PREFIX_neg when there is one.
  long double number(const std::string& prefix, int index = -1, bool has_sign = false) const {
    const RecordField& f = layout_.field(prefix + "sig", index);
    const long double magnitude = ldexpl(static_cast<long double>(record_.get(f)),
                                         static_cast<int>(integer(prefix + "exp", index)) - (f.width - 1));
    return has_sign && integer(prefix + "neg", index) != 0 ? -magnitude : magnitude;
  }

 private:
  const Record& record_;
  const RecordLayout& layout_;
};

/// Calls check(stimulus, response) for every vector of a suite of about `limit`.
template <class Check>
void for_each(const std::string& name, const Config& config, std::uint64_t limit, const Check& check) {
  const auto stage = stage_suite(name).stage(config);
  GenerateOptions options;
  options.config = config;
  options.limit = limit;
  const StageSuite::Stimuli stimuli = stage_suite(name).stimuli(options);
  for (const auto* list : {&stimuli.corner, &stimuli.random, &stimuli.realistic}) {
    ASSERT_FALSE(list->empty());
    for (const Record& stimulus : *list) {
      const Record response = stage->respond(stimulus);
      check(Values(stimulus, stage->stimulus_layout()), Values(response, stage->response_layout()));
      if (testing::Test::HasFailure()) {
        ADD_FAILURE() << name << ": stimulus " << stimulus.to_hex() << " response " << response.to_hex();
        return;
      }
    }
  }
}

// ---- Places of the bits ----

// Widths of golden/vectors/README.md for the default configuration, added up by hand: T = 32, W = 17, V = 12, TC = 10,
// VAL = QVAL = 63, GRAD = QGRAD = 48, QCURV = 32, LENGTH2 = 64, S = 18, E = 12, PE = 9, N = 4, DB = 24, TL = 3,
// AO = 32.
TEST(StageSuites, WidthsByHand) {
  const std::map<std::string, std::pair<int, int>> bits{
      {"snapping", {1 + 16 * 64 + 16 * 64, 1 + 4 * (2 * 32 + 17 + 9 + 18 + 28) + 12 * 28 + 4 * 32 + 25 + 26 + 26}},
      {"setup", {8 * 32 + 4 * 17 + 4 * 13, 3 + 4 * 10 + 2 + 4 + 6 * (63 + 48 + 48) + 6 * 64}},
      {"tile_context", {1 + 8 * 32 + 4 * 17 + 20, 10 * (63 + 48 + 48 + 32)}},
      {"coverage", {2 + 4 * 13 + 20 + 5 * (63 + 48 + 48) + 4, 3 * 64}},
      {"forward_difference", {3 + 3 + 1 + 6 * (63 + 48 + 48) + 10 * (63 + 48 + 48 + 32) + 6 * 64, 16 * 63}},
      {"normalise", {16 * 63, 4 + 12 * 31 + 4 * 30}},
      {"sqrt", {4 * 30, 4 * 30}},
      {"reciprocal", {31, 31}},
      {"ratios", {6 * 30 + 6 * 31 + 4 * 30, 12 * 30}},
      {"weights", {8 + 6 + 4 + 4 * 28 + 4 * 30 + 12 * 30, 4 * 30}},
      {"interpolation", {4 * 30 + 24 * 28, 7 * 31}},
      {"depth", {1 + 25 + 25 + 4 + 1 + 4 * 32 + 25 + 26 + 26 + 7 * 31, 1 + 1 + 25 + 4 * 32}},
  };
  ASSERT_EQ(stage_names().size(), bits.size());
  for (const auto& [name, widths] : bits) {
    const auto stage = stage_suite(name).stage(Config{});
    EXPECT_EQ(stage->stimulus_layout().bits(), widths.first) << name;
    EXPECT_EQ(stage->response_layout().bits(), widths.second) << name;
  }
}

TEST(StageSuites, StimulusFieldsInTheStatedOrder) {
  const auto order = [](const std::string& name) {
    const auto stage = stage_suite(name).stage(Config{});
    std::string text;
    for (const RecordField& f : stage->stimulus_layout().fields())
      if (f.index <= 0) text += (text.empty() ? "" : " ") + f.name;
    return text;
  };
  EXPECT_EQ(order("snapping"), "perspective x y z w attr");
  EXPECT_EQ(order("setup"), "x y w scissor_x0 scissor_y0 scissor_x1 scissor_y1");
  EXPECT_EQ(order("tile_context"), "homogeneous x y w column row");
  EXPECT_EQ(order("coverage"),
            "cull scissor_x0 scissor_y0 scissor_x1 scissor_y1 tile_x tile_y lin_value lin_gx lin_gy visible");
  EXPECT_EQ(order("forward_difference"),
            "row dx homogeneous lin_value lin_gx lin_gy quad_value quad_gx quad_gy quad_q length2");
  EXPECT_EQ(order("normalise"), "a d r2");
  EXPECT_EQ(order("reciprocal"), "neg exp sig");
  EXPECT_EQ(order("ratios"), "a_exp a_sig d_neg d_exp d_sig root_exp root_sig");
  EXPECT_EQ(order("weights"), "a_sign d_negative corner k_neg k_exp k_sig root_exp root_sig u_exp u_sig v_exp v_sig");
  EXPECT_EQ(order("interpolation"),
            "m_exp m_sig k_neg k_exp k_sig w_neg w_exp w_sig z_neg z_exp z_sig b_neg b_exp b_sig");
  EXPECT_EQ(order("depth"),
            "depth_on znear zfar attributes hull base_attr base_depth depth_low depth_high attr_neg attr_exp attr_sig "
            "z_neg z_exp z_sig den_k_neg den_k_exp den_k_sig den_w_neg den_w_exp den_w_sig");
}

// ---- Stimuli ----

// constrain() is the contract: what it would change is not legal.
TEST(StageSuites, StimuliKeepTheirContract) {
  for (const Config& config : {Config{}, small_config()})
    for (const std::string& name : stage_names()) {
      SCOPED_TRACE(name);
      const auto stage = stage_suite(name).stage(config);
      GenerateOptions options;
      options.config = config;
      options.limit = 900;
      const StageSuite::Stimuli stimuli = stage_suite(name).stimuli(options);
      for (const auto* list : {&stimuli.corner, &stimuli.random, &stimuli.realistic})
        for (const Record& stimulus : *list) {
          for (const RecordField& f : stage->stimulus_layout().fields()) {
            const std::int64_t v =
                f.is_signed || f.width == 64 ? stimulus.get_signed(f) : static_cast<std::int64_t>(stimulus.get(f));
            const FieldRange range = stage->range(f);
            const bool zero = f.name.ends_with("exp") && v == 0;                  // of a zero
            const bool one = (f.name == "n_exp" || f.name == "d_exp") && v == 1;  // 1 + |cos| = 2
            ASSERT_TRUE(range.contains(v) || zero || one) << f.label() << " = " << v << " in " << stimulus.to_hex();
          }
          if (list == &stimuli.realistic && config.qdrop() > 0) continue;  // r² and A are rounded apart there
          StageData data;
          stage->unpack_stimulus(stimulus, data);
          ASSERT_EQ(stage->pack_stimulus(data), stimulus);
          stage->constrain(data);
          ASSERT_EQ(stage->pack_stimulus(data).to_hex(), stimulus.to_hex());
        }
    }
}

/// A stimulus from elsewhere with one field out of its range is named, not computed: 15 attributes would index past an
/// array of eight.
TEST(StageSuites, StimuliOutOfRangeAreNamed) {
  std::size_t refused = 0;
  for (const std::string& name : stage_names()) {
    SCOPED_TRACE(name);
    const auto stage = stage_suite(name).stage(Config{});
    const StimulusCheck check(*stage);
    GenerateOptions options;
    options.limit = 300;
    const StageSuite::Stimuli stimuli = stage_suite(name).stimuli(options);
    for (const auto* list : {&stimuli.corner, &stimuli.random, &stimuli.realistic})
      for (const Record& stimulus : *list) ASSERT_EQ(check.fault(stimulus), "") << stimulus.to_hex();
    for (const RecordField& f : stage->stimulus_layout().fields()) {
      const FieldRange range = stage->range(f);
      const int bits = f.is_signed ? f.width - 1 : f.width;
      if (bits >= 63 || range.hi >= (std::int64_t{1} << bits) - 1) continue;  // the field holds nothing larger
      if (f.name.ends_with("exp") && range.hi < 1) continue;                  // 0 and 1 are always accepted
      Record stimulus = stimuli.corner.front();
      stimulus.set(f, static_cast<std::uint64_t>(range.hi + 1));
      EXPECT_EQ(check.fault(stimulus).find(f.label() + " = "), 0u) << f.label() << ": " << check.fault(stimulus);
      ++refused;
    }
  }
  EXPECT_GT(refused, 20u);
  const auto depth = stage_suite("depth").stage(Config{});
  Record stimulus = stage_suite("depth").stimuli({}).corner.front();
  stimulus.set(depth->stimulus_layout().field("attributes", -1), 15);
  EXPECT_EQ(StimulusCheck(*depth).fault(stimulus), "attributes = 0xf (15); the stage can be given 0..4");
}

TEST(StageSuites, CornersOfEveryFieldOccur) {
  for (const std::string& name : stage_names()) {
    SCOPED_TRACE(name);
    if (name == "ratios" || name == "coverage" || name == "forward_difference") continue;  // ends do not fit together
    const auto stage = stage_suite(name).stage(Config{});
    const StageSuite::Stimuli stimuli = stage_suite(name).stimuli({});
    std::map<std::string, std::set<std::int64_t>> seen;
    for (const auto* list : {&stimuli.corner, &stimuli.random, &stimuli.realistic})
      for (const Record& stimulus : *list)
        for (const RecordField& f : stage->stimulus_layout().fields())
          seen[f.label()].insert(f.is_signed || f.width == 64 ? stimulus.get_signed(f)
                                                              : static_cast<std::int64_t>(stimulus.get(f)));
    for (const RecordField& f : stage->stimulus_layout().fields()) {
      const FieldRange range = stage->range(f);
      EXPECT_TRUE(seen[f.label()].contains(range.lo)) << f.label() << " never is " << range.lo;
      EXPECT_TRUE(seen[f.label()].contains(range.hi)) << f.label() << " never is " << range.hi;
    }
  }
}

class StageSets : public golden::InDirectory {
 protected:
  std::string generate(const std::string& name, std::uint64_t seed, unsigned threads) const {
    GenerateOptions options;
    options.seed = seed;
    options.threads = threads;
    options.limit = 200;
    SetWriter writer(path(name), {1, seed, options.config, options.limit}, false);
    for (const std::string& suite : stage_names())
      writer.add(find_suite(suite).info(), [&](SuiteWriter& out) { find_suite(suite).write(out, options); });
    writer.commit(true);
    return read(path(name + "/manifest.json"));  // holds the hashes of everything
  }
};

TEST_F(StageSets, BytesDependOnTheSeedAndNotOnThreads) {
  const std::string one = generate("one", 1, 1);
  EXPECT_EQ(generate("three", 1, 3), one);
  EXPECT_NE(generate("two", 2, 1), one);
  for (const std::string& name : stage_names()) {
    const SuiteReader a = SetReader(path("one")).suite(name), b = SetReader(path("two")).suite(name);
    EXPECT_NE(a.manifest()["files"]["stimulus.hex"]["sha256"], b.manifest()["files"]["stimulus.hex"]["sha256"]) << name;
    EXPECT_TRUE(find_suite(name).verify(a, 2).ok());
    EXPECT_EQ(a.manifest()["counts"]["vectors"], a.lines("stimulus"));
  }
}

// ---- Responses against evaluation of another kind ----

// The widest range whose size fits 64 bits: every one of 256 equal parts of it is reached, and its ends stay rare.
TEST(StageSuites, WeightedNumbersReachTheWholeOfAWideRange) {
  const std::int64_t lo = std::numeric_limits<std::int64_t>::min() + 1, hi = -lo;
  golden::Prng prng(1);
  std::set<std::int64_t> parts;
  int at_the_low_end = 0;
  const int draws = 20000;
  for (int i = 0; i < draws; ++i) {
    const std::int64_t v = weighted(prng, {lo, hi});
    ASSERT_GE(v, lo);
    parts.insert(v >> 56);
    at_the_low_end += v <= lo + 1;
  }
  EXPECT_EQ(parts.size(), 256u);
  EXPECT_LT(at_the_low_end, draws / 20);
}

TEST(StageResponses, Snapping) {
  const Config c;
  std::uint64_t accepted = 0, refused = 0, ordinary = 0, behind = 0, constant = 0, beyond = 0;
  for_each("snapping", c, 3000, [&](const Values& in, const Values& out) {
    const auto real = [&](const char* name, int index) {
      return static_cast<long double>(std::bit_cast<double>(in.integer(name, index)));
    };
    bool bad = false;
    for (int i = 0; i < 4; ++i) {
      const long double x = real("x", i), y = real("y", i), z = real("z", i), w = real("w", i);
      bad = bad || !std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z) || !std::isfinite(w);
      const long double extent = fmaxl(fmaxl(fabsl(x), fabsl(y)), fabsl(w));
      bad = bad || extent > 0x1p80L || extent < 0x1p-80L || fabsl(z) > 0x1p80L || (x == w / 2 && y == w / 2 && w == 0);
      for (int j = 0; j < 4; ++j) bad = bad || !(fabsl(real("attr", 4 * i + j)) < 128);
    }
    if (bad) {
      ++refused;
      EXPECT_EQ(out.integer("refused"), 1);
      EXPECT_EQ(out.integer("k_sig", 2), 0);
      EXPECT_EQ(out.integer("depth_low"), 0);
      EXPECT_EQ(out.integer("depth_high"), 0);
      return;
    }
    EXPECT_EQ(out.integer("refused"), 0);
    ++accepted;

    // Bases: the nearest code of vertex 0's attribute, and of the first depth before the eye.
    constexpr long double depth_one = 0x1p24L;
    const auto depth_of = [&](int i) { return depth_one * real("z", i) / real("w", i); };
    int first = 0;
    while (first < 4 && !(real("w", first) > 0)) ++first;
    const auto base_depth = static_cast<long double>(out.integer("base_depth"));
    if (first == 4)
      EXPECT_EQ(base_depth, 0);
    else
      EXPECT_LE(fabsl(base_depth - fminl(fmaxl(depth_of(first), 0), depth_one)), 0.5L + 0x1p-30L);
    for (int j = 0; j < 4; ++j)
      EXPECT_LE(fabsl(static_cast<long double>(out.integer("base_attr", j)) - 0x1p24L * real("attr", j)),
                0.5L + (fabsl(real("attr", j)) > 127.9L ? 0.5L : 0))
          << j;
    // The corners' codes, halves up.
    bool bounded = true;
    long double low = HUGE_VALL, high = -HUGE_VALL;
    for (int i = 0; i < 4; ++i) {
      bounded = bounded && real("w", i) > 0;
      low = fminl(low, depth_of(i)), high = fmaxl(high, depth_of(i));
    }
    if (bounded) {
      const auto code = [&](long double z) { return fminl(fmaxl(floorl(z + 0.5L), -1), depth_one + 1); };
      // A quotient of doubles is rounded; its half is exact only where w is a power of two.
      for (const auto& [name, z] : {std::pair{"depth_low", low}, std::pair{"depth_high", high}}) {
        const auto actual = static_cast<long double>(out.integer(name));
        EXPECT_GE(actual, code(z - fabsl(z) * 0x1p-62L)) << name;
        EXPECT_LE(actual, code(z + fabsl(z) * 0x1p-62L)) << name;
      }
      beyond += high > depth_one || low < 0;
    } else {
      ++behind;
      EXPECT_EQ(out.integer("depth_low"), -1);
      EXPECT_EQ(out.integer("depth_high"), (1 << 24) + 1);
    }

    for (int i = 0; i < 4; ++i) {
      // The snapped point is k times the given one (shifted by half a pixel) within half a step of the grid and the
      // rounding of k. Differences are k times those to the base, within the roundings of k and their own.
      const long double x = real("x", i), y = real("y", i), z = real("z", i), w = real("w", i);
      const long double k = out.number("k_", i), ulp = 0x1p-17L;
      const bool on_grid =
          out.integer("w", i) == 1 << 15 && out.integer("x", i) % 128 == 0 && out.integer("y", i) % 128 == 0;
      ordinary += on_grid;
      const long double step = on_grid ? 0x1p-9L : 0x1p-16L;
      const auto close = [&](const char* name, long double given) {
        EXPECT_LE(fabsl(ldexpl(static_cast<long double>(out.integer(name, i)), -15) - k * given),
                  step + fabsl(k * given) * ulp)
            << name << i;
      };
      close("x", x - w / 2);
      close("y", y - w / 2);
      close("w", w);
      const auto near = [&](long double actual, long double exact, long double terms) {
        return fabsl(actual - exact) <= fmaxl(fabsl(exact) * ulp + terms * 0x1p-62L, 0x1p-256L);
      };
      const long double from = w * base_depth / depth_one;
      EXPECT_TRUE(near(out.number("z_", i, true), k * (z - from), k * (fabsl(z) + fabsl(from)))) << i;
      const long double scale =
          in.integer("perspective") != 0 ? k : ldexpl(static_cast<long double>(out.integer("w", i)), -15);
      for (int j = 0; i > 0 && j < 4; ++j) {
        const long double a = real("attr", 4 * i + j),
                          base = 0x1p-24L * static_cast<long double>(out.integer("base_attr", j));
        const long double actual = out.number("attr_", 4 * (i - 1) + j, true);
        if (a == real("attr", j)) {
          ++constant;
          EXPECT_EQ(actual, 0) << i << j;
        } else {
          EXPECT_TRUE(near(actual, scale * (a - base), fabsl(scale) * (fabsl(a) + fabsl(base)))) << i << j;
        }
      }
    }
  });
  EXPECT_GT(refused, 300u);
  EXPECT_GT(accepted, 1000u);
  EXPECT_GT(ordinary, 1000u);
  EXPECT_GT(behind, 300u);
  EXPECT_GT(constant, 300u);
  EXPECT_GT(beyond, 100u);
}

TEST(StageResponses, Setup) {
  const Config c;
  constexpr int first[] = {0, 1, 2, 3, 2, 1}, second[] = {1, 2, 3, 0, 0, 3};
  std::uint64_t empty = 0, hull = 0;
  for_each("setup", c, 1500, [&](const Values& in, const Values& out) {
    // A function at a pixel is the cross product of the vectors S_i = V_i - W_i (pixel) to the vertices there.
    const std::int64_t ox = out.integer("tile_x0") * 8, oy = out.integer("tile_y0") * 8;
    for (const auto& [dx, dy] : {std::pair{0, 0}, {1, 0}, {3, 5}}) {
      __int128 sx[4], sy[4];
      for (int i = 0; i < 4; ++i) {
        sx[i] = in.integer("x", i) - in.integer("w", i) * (ox + dx);
        sy[i] = in.integer("y", i) - in.integer("w", i) * (oy + dy);
      }
      for (int k = 0; k < 6; ++k) {
        const int i = first[k], j = second[k];
        const __int128 value = out.integer("lin_value", k) + static_cast<__int128>(out.integer("lin_gx", k)) * dx +
                               static_cast<__int128>(out.integer("lin_gy", k)) * dy;
        EXPECT_TRUE(value == sx[i] * sy[j] - sy[i] * sx[j]) << "lin_" << k;
      }
    }
    for (int k = 0; k < 6; ++k) {
      const __int128 x = in.integer("x", first[k]) - in.integer("x", second[k]),
                     y = in.integer("y", first[k]) - in.integer("y", second[k]);
      EXPECT_TRUE(static_cast<std::uint64_t>(out.integer("length2", k)) ==
                  static_cast<unsigned __int128>(x * x + y * y))
          << k;
    }
    const auto at = [](const std::array<std::int64_t, 4>& v) { return std::minmax_element(v.begin(), v.end()); };
    std::array<std::int64_t, 4> x{}, y{}, w{};
    for (std::size_t i = 0; i < 4; ++i)
      x[i] = in.integer("x", static_cast<int>(i)), y[i] = in.integer("y", static_cast<int>(i)),
      w[i] = in.integer("w", static_cast<int>(i));
    const bool homogeneous = std::ranges::any_of(w, [](std::int64_t v) { return v != 1 << 15; });
    EXPECT_EQ(out.integer("homogeneous") != 0, homogeneous);
    empty += out.integer("tiles_x") == 0;
    hull += out.integer("hull") != 0;
    if (!homogeneous) {
      EXPECT_EQ(out.integer("visible"), 15);
      if (out.integer("tiles_x") > 0) {
        // The last tile column holds the last pixel at or left of the rightmost vertex, inside the scissor.
        const double right = std::min(std::floor(static_cast<double>(*at(x).second) / 32768.0),
                                      static_cast<double>(in.integer("scissor_x1") - 1));
        const double left = std::max(std::ceil(static_cast<double>(*at(x).first) / 32768.0),
                                     static_cast<double>(in.integer("scissor_x0")));
        EXPECT_EQ(out.integer("tile_x0"), static_cast<std::int64_t>(std::floor(left / 8)));
        EXPECT_EQ(out.integer("tile_x0") + out.integer("tiles_x") - 1,
                  static_cast<std::int64_t>(std::floor(right / 8)));
      }
    }
  });
  EXPECT_GT(empty, 50u);
  EXPECT_GT(hull, 20u);
}

TEST(StageResponses, TileContext) {
  constexpr int first[] = {0, 1, 2, 3, 2, 1, 0, 1, 2, 3}, second[] = {1, 2, 3, 0, 0, 3, 0, 1, 2, 3};
  for (const Config& c : {Config{}, small_config()}) {
    int homogeneous = 0, ordinary = 0, turned = 0;
    const __int128 dropped = static_cast<__int128>(1) << c.qdrop();
    for_each("tile_context", c, 3000, [&](const Values& in, const Values& out) {
      const bool own = in.integer("homogeneous") != 0;
      ++(own ? homogeneous : ordinary);
      for (int k = 0; k < 10; ++k) {
        const __int128 value = out.integer("quad_value", k), gx = out.integer("quad_gx", k),
                       gy = out.integer("quad_gy", k), q = out.integer("quad_q", k);
        if (!own && k < 6) {
          EXPECT_TRUE(value == 0 && gx == 0 && gy == 0 && q == 0) << k;
          continue;
        }
        // The vectors to two vertices from a pixel of the tile, multiplied; what the floors of the coefficients take
        // away shows most at the pixels that one of them counts at alone.
        for (const auto& [dx, dy] : {std::pair{0, 0}, {1, 0}, {0, 1}, {3, 2}}) {
          const auto to = [&](const char* coordinate, int i, std::int64_t pixel) {
            return static_cast<__int128>(in.integer(coordinate, i)) - static_cast<__int128>(in.integer("w", i)) * pixel;
          };
          const std::int64_t x = in.integer("column") * c.tile() + dx, y = in.integer("row") * c.tile() + dy;
          const int i = first[k], j = second[k];
          const __int128 exact = to("x", i, x) * to("x", j, x) + to("y", i, y) * to("y", j, y);
          const __int128 rest = exact - (value + gx * dx + gy * dy + q * (dx * dx + dy * dy)) * dropped;
          EXPECT_TRUE(rest >= 0 && rest <= (dropped - 1) * (1 + dx + dy + dx * dx + dy * dy)) << k << " " << dx << dy;
        }
        turned += q < 0;
      }
    });
    EXPECT_GT(homogeneous, 1000);
    EXPECT_GT(ordinary, 1000);
    EXPECT_GT(turned, 1000);
  }
}

TEST(StageResponses, Coverage) {
  const Config c;
  std::uint64_t covered = 0, ties = 0;
  for_each("coverage", c, 3000, [&](const Values& in, const Values& out) {
    for (int row = 0; row < 8; ++row)
      for (int dx = 0; dx < 8; ++dx) {
        int sign[5];
        bool tie = false;
        for (int k = 0; k < 5; ++k) {
          const __int128 gx = in.integer("lin_gx", k), gy = in.integer("lin_gy", k);
          const __int128 e = in.integer("lin_value", k) + gx * dx + gy * row;
          // The sign infinitesimally to the right, and below.
          const __int128 decides = e != 0 ? e : gx != 0 ? gx : gy;
          sign[k] = decides > 0 ? 1 : decides < 0 ? -1 : 0;
          tie = tie || (e == 0 && sign[k] != 0);
        }
        const auto half = [&](int s, int diagonal, int a, int b, int c1, int c2) {
          return sign[4] == diagonal && sign[a] == s && sign[b] == s && (sign[c1] == s || sign[c2] == s);
        };
        const std::int64_t visible = in.integer("visible"), cull = in.integer("cull");
        const bool back =
            ((half(1, 1, 0, 1, 2, 3) && (visible & 1)) || (half(1, -1, 2, 3, 0, 1) && (visible & 2))) && cull != 2;
        const bool front =
            ((half(-1, -1, 0, 1, 2, 3) && (visible & 4)) || (half(-1, 1, 2, 3, 0, 1) && (visible & 8))) && cull != 1;
        const std::int64_t x = in.integer("tile_x") * 8 + dx, y = in.integer("tile_y") * 8 + row;
        const bool inside = x >= in.integer("scissor_x0") && x < in.integer("scissor_x1") &&
                            y >= in.integer("scissor_y0") && y < in.integer("scissor_y1");
        const bool drawn = inside && (back || front);
        EXPECT_EQ(out.integer("mask", row) >> dx & 1, drawn) << row << " " << dx;
        EXPECT_EQ(out.integer("front", row) >> dx & 1, drawn && front) << row << " " << dx;
        EXPECT_EQ(out.integer("tie", row) >> dx & 1, drawn && tie) << row << " " << dx;
        covered += drawn;
        ties += drawn && tie;
      }
  });
  EXPECT_GT(covered, 5000u);
  EXPECT_GT(ties, 500u);
}

TEST(StageResponses, ForwardDifference) {
  constexpr int first[] = {0, 1, 2, 3, 2, 1}, second[] = {1, 2, 3, 0, 0, 3};
  for (const Config& c : {Config{}, small_config()}) {
    int homogeneous = 0, ordinary = 0, odd = 0;
    for_each("forward_difference", c, 1500, [&](const Values& in, const Values& out) {
      const std::int64_t x = in.integer("dx"), y = in.integer("row");
      const auto at = [&](const std::string& name, int k) {
        return in.integer(name + "value", k) + static_cast<__int128>(in.integer(name + "gx", k)) * x +
               static_cast<__int128>(in.integer(name + "gy", k)) * y;
      };
      const auto quadratic = [&](int k) {
        return at("quad_", k) + static_cast<__int128>(in.integer("quad_q", k)) * (x * x + y * y);
      };
      for (int k = 0; k < 4; ++k) EXPECT_TRUE(out.integer("r2", k) == quadratic(6 + k)) << k;
      const bool own = in.integer("homogeneous") != 0;
      ++(own ? homogeneous : ordinary);
      for (int k = 0; k < 6; ++k) {
        EXPECT_TRUE(out.integer("a", k) == at("lin_", k)) << k;
        if (own) {
          EXPECT_TRUE(out.integer("d", k) == quadratic(k)) << k;
          continue;
        }
        // 2 D = r2 + r2' - length2, or one less.
        const __int128 rest = quadratic(6 + first[k]) + quadratic(6 + second[k]) -
                              static_cast<__int128>(static_cast<std::uint64_t>(in.integer("length2", k))) -
                              2 * static_cast<__int128>(out.integer("d", k));
        EXPECT_TRUE(rest == 0 || rest == 1) << k;
        odd += rest == 1;
      }
    });
    EXPECT_GT(homogeneous, 300);
    EXPECT_GT(ordinary, 300);
    EXPECT_GT(odd, 300);
  }
}

TEST(StageResponses, Normalise) {
  for (const Config& c : {Config{}, small_config()}) {
    const int s = c.significand_bits;
    std::set<std::int64_t> classes;
    for_each("normalise", c, 3000, [&](const Values& in, const Values& out) {
      const auto check = [&](std::int64_t v, const std::string& prefix, int index, int bias, bool has_sign) {
        // Repeated doubling or halving of the magnitude until its top bit is that of a significand.
        unsigned __int128 m =
            static_cast<unsigned __int128>(v < 0 ? -static_cast<__int128>(v) : static_cast<__int128>(v));
        int exp = bias + s - 1;
        while (m >> s != 0) m >>= 1, ++exp;
        while (m != 0 && m >> (s - 1) == 0) m <<= 1, --exp;
        EXPECT_EQ(out.integer(prefix + "sig", index), static_cast<std::int64_t>(m)) << prefix << index;
        EXPECT_EQ(out.integer(prefix + "exp", index), m == 0 ? 0 : exp) << prefix << index;
        if (has_sign) {
          EXPECT_EQ(out.integer(prefix + "neg", index), v < 0) << prefix << index;
        }
      };
      int corners = 0, edges = 0;
      for (int i = 0; i < 6; ++i) {
        check(in.integer("a", i), "a_", i, -c.qdrop(), true);
        check(in.integer("d", i), "d_", i, 0, true);
        if (i >= 4) continue;
        check(std::max<std::int64_t>(0, in.integer("r2", i)), "r2_", i, 0, false);
        corners += in.integer("r2", i) <= 0;
        edges += in.integer("a", i) == 0 && in.integer("d", i) < 0;
      }
      const std::int64_t found = 8 * out.integer("two_corner") + 4 * out.integer("on_vertex") +
                                 2 * out.integer("two_edge") + out.integer("on_edge");
      EXPECT_EQ(found, corners > 1 ? 8 : corners == 1 ? 4 : edges > 1 ? 2 : edges);
      classes.insert(found);
    });
    EXPECT_EQ(classes, (std::set<std::int64_t>{0, 1, 2, 4, 8}));
  }
}

TEST(StageResponses, SqrtAndReciprocalWithinOneUlp) {
  for (const Config& c : {Config{}, small_config()}) {
    const int s = c.significand_bits;
    const auto faithful = [&](long double actual, long double exact) {
      if (exact == 0) return actual == 0;
      int exponent = 0;
      frexpl(exact, &exponent);
      return fabsl(actual - exact) < ldexpl(1, exponent - s);  // one unit in the last place of S bits
    };
    for_each("sqrt", c, 6000, [&](const Values& in, const Values& out) {
      for (int i = 0; i < 4; ++i) {
        const long double a = in.number("", i);
        EXPECT_TRUE(faithful(out.number("", i), sqrtl(a))) << i;
      }
    });
    for_each("reciprocal", c, 6000, [&](const Values& in, const Values& out) {
      const long double a = in.number("", -1, true);
      EXPECT_TRUE(faithful(fabsl(out.number("")), a == 0 ? 0 : fabsl(1 / a)));
      EXPECT_EQ(out.integer("neg"), a < 0);
    });
  }
}

TEST(StageResponses, Ratios) {
  constexpr int first[] = {0, 1, 2, 3, 2, 1}, second[] = {1, 2, 3, 0, 0, 3};
  for_each("ratios", Config{}, 3000, [&](const Values& in, const Values& out) {
    for (int k = 0; k < 6; ++k) {
      const long double exact = in.number("root_", first[k]) * in.number("root_", second[k]) + in.number("d_", k);
      // One truncation, of 2^-17; the alignment takes up to 2^-19 more.
      EXPECT_LE(out.number("u_", k), exact) << k;
      EXPECT_GE(out.number("u_", k), exact * (1 - 0x5p-19L)) << k;
      EXPECT_EQ(out.number("v_", k), in.number("a_", k)) << k;
    }
  });
}

TEST(StageResponses, Weights) {
  std::uint64_t plain = 0, vertex = 0;
  for_each("weights", Config{}, 6000, [&](const Values& in, const Values& out) {
    int corners = 0, on_edge = 0, at = 0;
    for (int i = 0; i < 4; ++i) {
      if (in.integer("corner", i) != 0) ++corners, at = i;
      on_edge += in.integer("a_sign", i) == 0 && in.integer("d_negative", i) != 0;
    }
    if (corners == 1) {
      ++vertex;
      for (int i = 0; i < 4; ++i) EXPECT_EQ(out.number("", i), i == at ? 1.0L : 0.0L);
    }
    if (corners > 0 || on_edge > 0) return;
    // The weight of a corner is the square root of the product of q over the three pairs without it: q_k = u or v²/u.
    long double q[6], product[4];
    for (int k = 0; k < 6; ++k) {
      const long double u = in.number("u_", k), v = in.number("v_", k);
      q[k] = (in.integer("d_negative", k) != 0) == (k < 4) ? v * v / u : u;
      if (q[k] == 0) return;
    }
    ++plain;
    product[0] = q[1] * q[2] * q[5];
    product[1] = q[2] * q[3] * q[4];
    product[2] = q[3] * q[0] * q[5];
    product[3] = q[0] * q[1] * q[4];
    for (int i = 1; i < 4; ++i) {
      const long double ratio = out.number("", i) / out.number("", 0), exact = sqrtl(product[i] / product[0]);
      // Of each of two ratios a truncated root of a truncated argument and up to two truncated products; two products
      // in each weight: below 11 of 2^-17.
      EXPECT_NEAR(static_cast<double>(ratio / exact), 1, 11 * 0x1p-17) << i;
    }
  });
  EXPECT_GT(plain, 500u);
  EXPECT_GT(vertex, 100u);
}

TEST(StageResponses, Interpolation) {
  for_each("interpolation", Config{}, 3000, [&](const Values& in, const Values& out) {
    // `element(i)`: of corner i; attributes have no corner 0.
    const auto check = [&](const std::string& from, const std::string& to, int index, int first, auto&& element) {
      long double exact = 0, largest = 0;
      for (int i = first; i < 4; ++i) {
        const long double term = in.number("m_", i) * in.number(from, element(i), true);
        exact += term;
        largest = fmaxl(largest, fabsl(term));
      }
      // Terms cut 19 bits below the binary order of the largest, and the sum to 18 bits.
      EXPECT_LE(fabsl(out.number(to, index, true) - exact), largest * (4 - first) * 0x1p-19L + fabsl(exact) * 0x1p-17L)
          << to << index;
    };
    const auto corner = [](int i) { return i; };
    check("k_", "den_k_", -1, 0, corner);
    check("w_", "den_w_", -1, 0, corner);
    check("z_", "z_", -1, 0, corner);
    for (int j = 0; j < 4; ++j) check("b_", "attr_", j, 1, [&](int i) { return 3 * j + i - 1; });
  });
}

TEST(StageResponses, Depth) {
  std::uint64_t valid = 0, discarded = 0, saturated = 0, clamped_z = 0;
  for_each("depth", Config{}, 6000, [&](const Values& in, const Values& out) {
    const long double w = in.number("den_w_", -1, true), k = in.number("den_k_", -1, true);
    const auto integer = [&](const char* name, int index = -1) {
      return static_cast<long double>(in.integer(name, index));
    };
    // Window z in codes: its base and the quotient, between the corners'. A truncated reciprocal of 18 bits, half a
    // code.
    const long double low = integer("depth_low"), high = integer("depth_high");
    const auto clamp = [](long double v, long double lo, long double hi) { return fmaxl(lo, fminl(hi, v)); };
    const long double quotient = w == 0 ? 0 : ldexpl(in.number("z_", -1, true) / w, 24);
    const long double sum = integer("base_depth") + quotient, error = fabsl(quotient) * 3 * 0x1p-17L + 0.5L;
    const long double z_low = w == 0 ? high : clamp(sum - error, low, high),
                      z_high = w == 0 ? high : clamp(sum + error, low, high);
    const bool depth = in.integer("depth_on") != 0;
    const long double near = integer("znear"), far = integer("zfar");
    const bool behind = in.integer("hull") != 0 && !(w > 0);
    const bool out_of_range = depth && (z_high < near || z_low > far);
    const bool inside = !depth || (z_low >= near && z_high <= far);
    if (behind || out_of_range) {
      EXPECT_EQ(out.integer("valid"), 0);
    }
    if (!behind && inside) {
      EXPECT_EQ(out.integer("valid"), 1);
    }
    if (out.integer("valid") == 0) {
      ++discarded;
      EXPECT_EQ(out.integer("depth"), 0);
      for (int j = 0; j < 4; ++j) EXPECT_EQ(out.integer("attr", j), 0);
      return;
    }
    ++valid;
    const auto code = static_cast<long double>(out.integer("depth"));
    if (!depth) {
      EXPECT_EQ(code, 0);
    } else {
      EXPECT_GE(code, z_low);
      EXPECT_LE(code, z_high);
      clamped_z += w != 0 && (sum < low || sum > high);
    }
    bool clamped = false, uncertain = false;
    for (int j = 0; j < 4; ++j) {
      const auto actual = static_cast<long double>(out.integer("attr", j));
      if (j >= in.integer("attributes")) {
        EXPECT_EQ(actual, 0);
        continue;
      }
      const long double q = k == 0 ? 0 : ldexpl(in.number("attr_", j, true) / k, 24);
      const long double a = integer("base_attr", j) + q, slack = fabsl(q) * 3 * 0x1p-17L + 0.5L;
      const long double limit = 0x1p31L - 1;
      clamped = clamped || fabsl(a) - slack > limit;
      uncertain = uncertain || fabsl(fabsl(a) - limit) <= slack + 0.5L;
      EXPECT_GE(actual, clamp(a - slack, -limit, limit)) << j;
      EXPECT_LE(actual, clamp(a + slack, -limit, limit)) << j;
    }
    if (!uncertain) {
      EXPECT_EQ(out.integer("saturated"), clamped);
    }
    saturated += clamped;
  });
  EXPECT_GT(valid, 1000u);
  EXPECT_GT(discarded, 1000u);
  EXPECT_GT(saturated, 100u);
  EXPECT_GT(clamped_z, 100u);
}

}  // namespace
