// Everything there is, at small widths, against exact integers: every quad of a small grid with w of -1, 0 and 1, every
// pair of operands of the arithmetic, every argument of the tables. The oracles are written from rtl/SPEC.md and use
// nothing of the model.
#include "golden/analysis/judged_quad.hpp"
#include "golden/reference/exact_coverage.hpp"
#include "golden/reference/truth.hpp"
#include "model/front/quad_setup.hpp"
#include "model/pixel/reciprocal.hpp"
#include "model/pixel/significand.hpp"
#include "model/pixel/sqrt.hpp"
#include "model/skips/both_ways_test_support.hpp"
#include "model/support/parallel.hpp"
#include "tb/judge/check.hpp"
#include "tb/judge/exact_number.hpp"
#include "tb/judge/function_check.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <set>

namespace quadrille::tb {
namespace {

using exact::Number;
using exact::Term;
using exact::value_of;
using exact::Wide;

// ---- Quads of a small grid ----

constexpr int extent = 5;  ///< pixels of the viewport: the grid's points are at 0, 2 and 4

using Vector = std::array<std::int64_t, 3>;

Vector vector_of(const SnappedVertex& v) { return {v.x, v.y, v.w}; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
std::int64_t dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
bool null(const Vector& v) { return v == Vector{}; }
bool opposite(const Vector& a, const Vector& b) { return null(cross(a, b)) && dot(a, b) < 0; }

/// The origin in the triangle of three vectors, its sides and corners included: 0 = a + b + c with factors that are not
/// negative and not all 0.
bool origin_in_triangle(const Vector& a, const Vector& b, const Vector& c) {
  if (opposite(a, b) || opposite(b, c) || opposite(c, a)) return true;
  // No two opposite, so all three count: coplanar, and each between the others' opposites.
  const Vector n = cross(a, b), m = cross(b, c), o = cross(c, a);
  return dot(n, c) == 0 && dot(n, m) > 0 && dot(m, o) > 0 && dot(o, n) > 0;
}

/// Of the four vectors, inside or on a face: by the faces first, then each vector and the face opposite it on different
/// sides of the eye.
bool origin_in_hull(const std::array<Vector, 4>& v) {
  for (std::size_t i = 0; i < 4; ++i)
    if (origin_in_triangle(v[(i + 1) & 3], v[(i + 2) & 3], v[(i + 3) & 3])) return true;
  // -v3 strictly inside the cone of the other three.
  const std::int64_t whole = dot(cross(v[0], v[1]), v[2]);
  if (whole == 0) return false;
  const Vector d{-v[3][0], -v[3][1], -v[3][2]};
  const std::array<std::int64_t, 3> parts{dot(cross(d, v[1]), v[2]), dot(cross(v[0], d), v[2]),
                                          dot(cross(v[0], v[1]), d)};
  return std::ranges::all_of(parts, [&](std::int64_t p) { return whole > 0 ? p > 0 : p < 0; });
}

/// Flags of a covered pixel (rtl/SPEC.md), from the vertices relative to it.
unsigned flags_of(const std::array<Vector, 4>& v, int x, int y, bool homogeneous) {
  constexpr std::array<std::array<std::size_t, 2>, 5> edges{{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {2, 0}}};
  std::array<std::int64_t, 4> rx{}, ry{};
  int corners = 0, on_edges = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    rx[i] = v[i][0] - v[i][2] * x;
    ry[i] = v[i][1] - v[i][2] * y;
    corners += rx[i] == 0 && ry[i] == 0;
  }
  std::array<std::int64_t, 5> area{};
  bool tie = false;
  for (std::size_t k = 0; k < 5; ++k) {
    const auto [i, j] = edges[k];
    area[k] = rx[i] * ry[j] - ry[i] * rx[j];
    if (k < 4) on_edges += area[k] == 0 && rx[i] * rx[j] + ry[i] * ry[j] < 0;
    const Vector normal = cross(v[i], v[j]);
    tie = tie || (area[k] == 0 && (normal[0] != 0 || normal[1] != 0));
  }
  unsigned flags = 0;
  if (tie) flags |= flag_tie;
  if (homogeneous) flags |= flag_homogeneous;
  if (corners >= 2) return flags | flag_two_corner;
  if (corners == 1) return flags | flag_on_vertex;
  if (on_edges >= 2) return flags | flag_two_edge;
  if (on_edges == 1) flags |= flag_on_edge;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::int64_t before = area[(i + 3) & 3];
    if ((before < 0 && area[i] > 0) || (before > 0 && area[i] < 0)) flags |= flag_notch;
  }
  return flags;
}

struct GridCounts {
  std::uint64_t quads = 0, drawn = 0, hulls = 0;
};

/// All quads whose number is `first` modulo `stride`.
GridCounts grid(std::uint64_t first, std::uint64_t stride, int significand_bits = 8) {
  Config config = tiny();
  config.set("significand_bits", significand_bits);
  const Bounds bounds(config);
  const std::vector<SnappedVertex> vertices = grid_vertices(config);
  DrawState state;
  state.width = state.height = state.scissor_x1 = state.scissor_y1 = extent;
  state.attributes = 0;
  state.depth = false;
  UntimedModel model(config, state, PixelEngine::plain), lanes(config, state, PixelEngine::lanes);
  GridCounts counts;
  const std::uint64_t n = vertices.size();
  for (std::uint64_t number = first; number < n * n * n * n; number += stride) {
    const SnappedQuad quad = grid_quad(vertices, number);
    std::array<Vector, 4> v;
    for (std::size_t i = 0; i < 4; ++i) v[i] = vector_of(quad.vertex[i]);
    const bool homogeneous =
        std::ranges::any_of(quad.vertex, [&](const SnappedVertex& at) { return at.w != 1 << config.frac(); });
    const bool in_hull = homogeneous && origin_in_hull(v);
    const SetupResult setup = quad_setup(quad, config, state);
    // All four in one plane with the eye: the rule of signs says hull whether the eye is in it or not (nothing tells
    // otherwise), and each pixel's visibility is asked for.
    const auto det = [&](std::size_t a, std::size_t b, std::size_t c) { return dot(cross(v[a], v[b]), v[c]); };
    const bool flat = det(0, 1, 2) == 0 && det(0, 1, 3) == 0 && det(0, 2, 3) == 0 && det(1, 2, 3) == 0;
    if (setup.hull != (homogeneous && (flat || in_hull))) ADD_FAILURE() << "hull of quad " << number;
    const bool hull = setup.hull;
    counts.hulls += in_hull;

    std::array<const Fragment*, extent * extent> at{};
    std::vector<Fragment> fragments, quick;
    model.draw(quad, [&](std::span<const Fragment> f) { fragments.insert(fragments.end(), f.begin(), f.end()); });
    lanes.draw(quad, [&](std::span<const Fragment> f) { quick.insert(quick.end(), f.begin(), f.end()); });
    if (fragments != quick) ADD_FAILURE() << "the engines differ on quad " << number;
    for (const Fragment& f : fragments) at.at(static_cast<std::size_t>(f.y * extent + f.x)) = &f;
    counts.drawn += fragments.size();
    ++counts.quads;

    // Where (12) contradicts itself on an edge through the eye it covers nothing (exact_coverage.hpp).
    const bool antipodal = has_antipodal_edge(quad);
    std::optional<JudgedQuad> judged;
    for (int y = 0; y < extent; ++y)
      for (int x = 0; x < extent; ++x) {
        const Fragment* f = at[static_cast<std::size_t>(y * extent + x)];
        const golden::ExactCoverage expected = golden::exact_coverage(quad, x, y);
        bool drawn = expected.covered && expected.visible && !antipodal;
        if (expected.covered && hull && !antipodal) {  // by the sign of sum(M w)
          if (!judged) judged.emplace(quad, config, bounds, state);
          const golden::ReferenceSample truth = judged->truth().sample(x, y);
          drawn = truth.visible;
          if (judged->tolerates_visibility(truth)) drawn = f != nullptr;
        }
        if (drawn != (f != nullptr)) {
          ADD_FAILURE() << "quad " << number << (drawn ? " misses " : " draws ") << x << ", " << y;
          return counts;
        }
        if (f == nullptr) continue;
        if (f->front != expected.front || f->flags != flags_of(v, x, y, homogeneous)) {
          ADD_FAILURE() << "quad " << number << " at " << x << ", " << y << ": front " << f->front << " flags "
                        << int{f->flags} << ", expected " << expected.front << " " << flags_of(v, x, y, homogeneous);
          return counts;
        }
      }
  }
  return counts;
}

/// Coverage, facing, visibility, flags and hull of every quad whose corners are of 26 points and directions.
TEST(Exhaustive, SomeOfASmallGrid) {
  const GridCounts n = grid(5, 11);
  EXPECT_GT(n.drawn, 10'000u);
  EXPECT_GT(n.hulls, 1000u);
}
TEST(Exhaustive, AllOfASmallGrid) {
  const GridCounts n = grid(0, 1);
  EXPECT_EQ(n.quads, 26u * 26u * 26u * 26u);
}
/// With wide significands, where what remains within the bound is Σ M·W = 0.
TEST(Exhaustive, AllOfASmallGridWithWideSignificands) {
  const GridCounts n = grid(0, 1, 26);
  EXPECT_EQ(n.quads, 26u * 26u * 26u * 26u);
}

// ---- Arithmetic at S = 8 ----

constexpr int narrow = 8;
constexpr std::uint32_t half = 1u << (narrow - 1);

PipelineFloat number(std::uint32_t sig, int exp, bool neg) { return {neg, exp, sig}; }

TEST(Exhaustive, AllProducts) {
  const SignificandFormat f{narrow, 2};
  std::uint64_t pairs = 0;
  for (std::uint32_t a = half; a < 2 * half; ++a)
    for (std::uint32_t b = half; b < 2 * half; ++b)
      for (const int exponent : {-300, -1, 0, 1, 300})
        for (const bool neg : {false, true}) {
          const PipelineFloat x = number(a, exponent, neg), y = number(b, 7, true);
          const PipelineFloat r = fp_multiply(x, y, f);
          ++pairs;
          ASSERT_TRUE(
              exact::is(r, exact::cut(exact::product(value_of(x, narrow), value_of(y, narrow)), narrow), narrow))
              << a << " times " << b << ", exponent " << exponent;
        }
  for (std::uint32_t a = half; a < 2 * half; ++a) {
    ASSERT_EQ(fp_multiply({}, number(a, 3, true), f), PipelineFloat{});
    ASSERT_EQ(fp_multiply(number(a, 3, true), {}, f), PipelineFloat{});
  }
  EXPECT_EQ(pairs, 128u * 128u * 10u);
}

/// Two terms of every significand, as far apart as anything of the smaller one remains and further, of both signs.
void sums(std::initializer_list<int> guards) {
  for (const int g : guards) {
    const SignificandFormat f{narrow, g};
    for (int apart = -18; apart <= 18; ++apart)
      for (std::uint32_t a = half; a < 2 * half; ++a)
        for (std::uint32_t b = half; b < 2 * half; ++b)
          for (const bool neg : {false, true}) {
            const PipelineFloat x = number(a, apart, false), y = number(b, 0, neg);
            const PipelineFloat r = fp_sum({raw_from_fp(x, f), raw_from_fp(y, f)}, f);
            const std::array<Term, 2> terms{{{value_of(x, narrow)}, {value_of(y, narrow)}}};
            if (!exact::is(r, exact::sum(terms, narrow, g), narrow))
              FAIL() << a << " * 2^" << apart << (neg ? " - " : " + ") << b << ", G = " << g;
          }
  }
}

TEST(Exhaustive, SumsOfTwoNumbers) { sums({2}); }
TEST(Exhaustive, SumsOfTwoNumbersEveryG) { sums({0, 1, 2, 3, 4, 5, 6}); }

/// The same of every product that there is, against every other.
void product_sums(std::uint32_t stride, std::initializer_list<int> distances) {
  constexpr int g = 2;
  const SignificandFormat f{narrow, g};
  std::set<std::uint32_t> found;
  for (std::uint32_t a = half; a < 2 * half; ++a)
    for (std::uint32_t b = half; b < 2 * half; ++b) found.insert(a * b);
  const std::vector<std::uint32_t> products(found.begin(), found.end());
  for (std::size_t i = 0; i < products.size(); i += stride)
    for (const std::uint32_t q : products)
      for (const int apart : distances)
        for (const bool neg : {false, true}) {
          const std::uint32_t p = products[i];
          const PipelineFloat r = fp_sum({RawProduct{neg, apart, p}, RawProduct{false, 0, q}}, f);
          const int unit = -(2 * narrow - 2);
          // As one factor: exact::sum looks for the exponents of factors, so the product's own carry must not count.
          const int largest = std::max(apart, 0), grain = largest - (narrow - 1) - g;
          const Number first = exact::truncated({neg ? -Wide{p} : Wide{p}, apart + unit}, grain),
                       second = exact::truncated({q, unit}, grain);
          Number total{0, grain};
          for (const Number& n : {first, second})
            if (!n.zero()) total.m += n.m << (n.e - grain);
          if (!exact::is(r, exact::cut(total, narrow), narrow))
            FAIL() << p << " * 2^" << apart << (neg ? " subtracted from " : " added to ") << q;
        }
}

TEST(Exhaustive, SumsOfTwoProducts) { product_sums(29, {0, 1, 9}); }
TEST(Exhaustive, SumsOfTwoProductsAllPairs) { product_sums(1, {-1, 0, 1, 9}); }

// ---- Tables ----

/// Every argument of both tables, within the limit that follows from their layout (function_check.hpp) on the exact
/// square and product; powers of four and two exactly.
void tables(int s) {
  Config config;
  config.set("significand_bits", s);
  config.validate();
  const SignificandFormat f{s, config.align_guard_bits};
  const Table roots = make_sqrt_table(config), inverses = make_recip_table(config);
  const auto low_of = [](const TableLimit& limit) { return static_cast<Wide>(std::ceil(limit.below * 32)); };
  const auto high_of = [](const TableLimit& limit) { return static_cast<Wide>(std::ceil(limit.above * 32)); };
  const TableLimit of_root = sqrt_limit(config), of_inverse = reciprocal_limit(config);
  const std::uint32_t first = 1u << (s - 1);
  std::uint64_t beyond = 0;
  for (std::uint32_t sig = first; sig < 2 * first; ++sig) {
    for (const int octave : {0, 1}) {
      const PipelineFloat r = fp_sqrt({false, octave, sig}, roots, f);
      const Wide square = Wide{sig} << (octave + s - 1 + 16), low = (Wide{r.sig} << 8) - high_of(of_root),
                 high = (Wide{r.sig} << 8) + low_of(of_root);
      beyond +=
          r.exp != 0 || low * low > square || square > high * high || (sig == first && octave == 0 && r.sig != first);
    }
    const PipelineFloat r = reciprocal({false, 0, sig}, inverses, f);
    // sig 2^-(S-1) times r.sig 2^(exp-(S-1)) is 1.
    const Wide one = Wide{1} << (2 * (s - 1) - r.exp + 8), product = Wide{sig} * r.sig << 8;
    beyond += r.exp != (sig == first ? 0 : -1) || product - Wide{sig} * high_of(of_inverse) > one ||
              one > product + Wide{sig} * low_of(of_inverse) || (sig == first && r.sig != first);
  }
  EXPECT_EQ(beyond, 0u) << "s = " << s;
}

TEST(Exhaustive, TablesUpTo20Bits) {
  for (int s = 8; s <= 20; ++s) tables(s);
}
TEST(Exhaustive, TablesBeyond20Bits) {
  for (int s = 21; s <= 26; ++s) tables(s);
}

}  // namespace
}  // namespace quadrille::tb
