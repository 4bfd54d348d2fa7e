// The proofs against what can be computed without them: extreme inputs, every argument of a table, narrower widths, and
// the largest errors that climbing has found.
#include "golden/analysis/error_bound.hpp"

#include "golden/scenes/stress.hpp"
#include "model/front/quad_setup.hpp"
#include "model/front/tile_context.hpp"
#include "model/pixel/pixel_pipeline.hpp"
#include "model/pixel/weight_factors.hpp"
#include "model/port/snap.hpp"
#include "model/support/prng.hpp"
#include "model/untimed.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace quadrille {
namespace {

Config with_significand(int s) {
  Config c;
  c.significand_bits = s;
  c.validate();
  return c;
}

std::map<std::string, SignalRange> by_name(const RangeProof& proof) {
  std::map<std::string, SignalRange> map;
  for (const SignalRange& s : proof.signals) map[s.signal] = s;
  return map;
}

std::string misfits(const RangeProof& proof) {
  std::string text;
  for (const SignalRange& s : proof.signals)
    if (!s.fits)
      text += s.signal + " [" + std::to_string(s.low) + ", " + std::to_string(s.high) + "] in " +
              std::to_string(s.bits) + " bits; ";
  return text;
}

TEST(RangeProof, HoldsForRandomConfigurations) {
  golden::Prng rng(7);
  int accepted = 0, reduced = 0, refused_tables = 0;
  for (int n = 0; n < 5'000; ++n) {
    Config c;
    for (const ConfigKey& key : Config::keys()) {
      const bool automatic = key.standard == -1 && rng.chance(key.name == "quadratic_frac_bits" ? 0.4 : 0.9);
      const auto value = automatic ? -1 : static_cast<int>(rng.integer(key.minimum, key.maximum));
      c.set(key.name, value);
    }
    try {
      c.validate();
    } catch (const ConfigError&) {
      continue;
    }
    try {
      const RangeProof proof = prove_ranges(c);
      ++accepted;
      reduced += c.qdrop() > 0;
      std::string keys;
      if (!proof.proved)
        for (const ConfigKey& key : Config::keys())
          keys += std::string(key.name) + "=" + std::to_string(c.get(key.name)) + " ";
      ASSERT_TRUE(proof.proved) << misfits(proof) << keys;
      ASSERT_TRUE(prove_regular_range(c).proved) << misfits(prove_regular_range(c)) << keys;
    } catch (const ConfigError&) {
      ++refused_tables;
    }
  }
  std::printf("%d configurations, %d with dropped bits; %d without a table\n", accepted, reduced, refused_tables);
  EXPECT_GT(accepted, 1'000);
  EXPECT_GT(reduced, 300);
}

/// Every combination of the keys that the exact front depends on.
TEST(RangeProof, HoldsForEveryFront) {
  int accepted = 0;
  for (int v = 6; v <= 14; ++v)
    for (int g = 1; g <= 4; ++g)
      for (int sub = 2; sub <= 8; sub += 3)
        for (int hom = 4; hom <= 10; hom += 2)
          for (int tile = 2; tile <= 4; ++tile)
            for (const int quadratic : {-1, 0, 9}) {
              Config c;
              c.significand_bits = 8;
              c.viewport_bits = v, c.guard_bits = g, c.subpixel_bits = sub, c.homogeneous_frac_bits = hom;
              c.tile_log2 = tile, c.quadratic_frac_bits = quadratic;
              try {
                c.validate();
              } catch (const ConfigError&) {
                continue;
              }
              ++accepted;
              const RangeProof proof = prove_ranges(c);
              ASSERT_TRUE(proof.proved) << misfits(proof) << "viewport_bits=" << v << " guard_bits=" << g
                                        << " subpixel_bits=" << sub << " homogeneous_frac_bits=" << hom
                                        << " tile_log2=" << tile << " quadratic_frac_bits=" << quadratic;
              ASSERT_TRUE(prove_regular_range(c).proved) << misfits(prove_regular_range(c));
            }
  EXPECT_GT(accepted, 1'000);
}

/// Each width with the bits that it could spare at the defaults, from the values that must fit: one bit less fails.
TEST(RangeProof, FailsWithANarrowerWidth) {
  struct Spare {
    const char* name;
    int ProofWidths::*width;
    int bits;
  };
  const Spare widths[] = {
      {"T: 1.125 * 2^30", &ProofWidths::position, 0},
      {"W: 2^15 inclusive", &ProofWidths::weight, 0},
      {"2 (1.125 * 2^30)^2 = 1.27 * 2^61", &ProofWidths::value, 0},
      {"2^46 inclusive", &ProofWidths::grad, 0},
      {"as A", &ProofWidths::qvalue, 0},
      {"1.125 * 2^46", &ProofWidths::qgrad, 0},
      {"2^30 inclusive", &ProofWidths::qcurv, 0},
      {"2^63 inclusive", &ProofWidths::length2, 0},
      {"512 tiles", &ProofWidths::tile, 0},
      {"2^32 - 1, signed", &ProofWidths::dot_operand, 0},
      {"2^63 inclusive: 65 bits", &ProofWidths::dot_result, 2},
      {"6 * 2^75: 79 bits", &ProofWidths::determinant, 5},
      {"beyond 2^-512", &ProofWidths::exponent, 1},
      {"-256", &ProofWidths::port_exponent, 0},
      {"product below 4 with 19 fraction bits", &ProofWidths::term, 0},
      {"C0 above 8 * 2^18", &ProofWidths::table_word, 0},
      {"2^18 before the clamp", &ProofWidths::table_factor, 0},
      {"saturated", &ProofWidths::attribute, 0},
      {"2^24 + 1", &ProofWidths::depth, 0},
  };
  const Config config;
  for (const Spare& s : widths) {
    ProofWidths w(config);
    EXPECT_TRUE(prove_ranges(config, w).proved);
    w.*s.width -= s.bits;
    EXPECT_TRUE(prove_ranges(config, w).proved) << s.name << ": " << misfits(prove_ranges(config, w));
    w.*s.width -= 1;
    EXPECT_FALSE(prove_ranges(config, w).proved) << s.name;
  }
}

/// The farthest vertex of the guard band at the farthest pixel has exactly the largest r² and D, and the largest
/// gradient at the farthest tile; from there to the opposite corner is the largest length.
TEST(RangeProof, LargestValuesOccur) {
  for (const int guard : {1, 2, 3}) {
    Config c;
    c.guard_bits = guard;
    c.validate();
    const auto signal = by_name(prove_ranges(c));
    const std::int32_t edge = 1 << (c.pos_int() + c.frac()), one = 1 << c.frac();
    SnappedQuad q;
    q.vertex[0].x = q.vertex[0].y = q.vertex[1].x = q.vertex[1].y = -edge;
    q.vertex[0].w = q.vertex[1].w = one;
    q.vertex[2].x = q.vertex[3].x = q.vertex[3].y = edge;  // points at infinity: the walk starts at (0, 0)
    DrawState state;
    state.width = state.height = state.scissor_x1 = state.scissor_y1 = 1 << c.viewport_bits;
    const SetupResult setup = quad_setup(q, c, state);
    ASSERT_EQ(setup.tile_x0, 0);
    const int last = (1 << c.viewport_bits) - 1, origin = last + 1 - c.tile();
    const QuadConstants constants(setup);
    const auto pixel = tile_context(constants, last, last, 0), tile = tile_context(constants, origin, origin, 0);
    EXPECT_EQ(static_cast<double>(pixel[6].value), signal.at("r²").high);
    EXPECT_EQ(static_cast<double>(pixel[0].value), signal.at("D").high);
    EXPECT_EQ(static_cast<double>(tile[6].gx), signal.at("gx of D, r²").high);
    EXPECT_EQ(static_cast<double>(setup.length2[3]), signal.at("length2").high);
  }
}

/// Floor of D or r² of a quad at a pixel, exactly: the oracle of the dropped bits.
__int128 dot_at(const SnappedQuad& q, std::size_t i, std::size_t j, int x, int y) {
  const auto sx = [&](std::size_t k) { return q.vertex[k].x - static_cast<__int128>(q.vertex[k].w) * x; };
  const auto sy = [&](std::size_t k) { return q.vertex[k].y - static_cast<__int128>(q.vertex[k].w) * y; };
  return sx(i) * sx(j) + sy(i) * sy(j);
}

/// A random pixel of a random tile right of and below the quad's origin, as the machine has it.
struct TilePixel {
  int x = 0, y = 0, dx = 0, row = 0;
  PixelTrace trace;

  TilePixel(const SetupResult& setup, const Config& c, golden::Prng& rng) {
    const QuadConstants constants(setup);
    const std::int64_t last = (1 << (c.viewport_bits - c.tile_log2)) - 1;
    TileEntry tile;
    tile.tile_x = static_cast<int>(rng.integer(setup.tile_x0, last));
    tile.tile_y = static_cast<int>(rng.integer(setup.tile_y0, last));
    tile.quadratic = tile_context(constants, (tile.tile_x - setup.tile_x0) * c.tile(),
                                  (tile.tile_y - setup.tile_y0) * c.tile(), c.qdrop());
    dx = static_cast<int>(rng.below(static_cast<std::uint64_t>(c.tile())));
    row = static_cast<int>(rng.below(static_cast<std::uint64_t>(c.tile())));
    x = tile.tile_x * c.tile() + dx;
    y = tile.tile_y * c.tile() + row;
    forward_difference(trace, tile, constants, dx, row);
  }
};

DrawState whole_viewport(const Config& c) {
  DrawState state;
  state.width = state.height = state.scissor_x1 = state.scissor_y1 = 1 << c.viewport_bits;
  return state;
}

/// Ordinary vertices lose nothing up to 2 homogeneous_frac_bits dropped bits, for every pair of grids, and something
/// with one bit more.
TEST(DroppedBits, OrdinaryQuadsLoseNoneUpToTheRule) {
  golden::Prng rng(11);
  for (int sub = 2; sub <= 8; ++sub)
    for (int hom = 4; hom <= 10; ++hom)
      for (const int more : {0, 1}) {
        Config c;
        c.viewport_bits = 8;
        c.subpixel_bits = sub;
        c.homogeneous_frac_bits = hom;
        c.tile_log2 = static_cast<int>(rng.integer(2, 4));
        c.quadratic_frac_bits = 2 * sub - more;
        c.validate();
        EXPECT_EQ(keeps_ordinary_products(c), more == 0);
        const DrawState state = whole_viewport(c);
        const int drop = c.qdrop();
        int lost = 0;
        for (int n = 0; n < 200; ++n) {
          WindowQuad given;
          const double reach = n % 2 == 0 ? 300 : 1900;  // the guard band is 2^11 wide
          for (WindowVertex& v : given.vertex) {
            const double w = rng.log2_spread(-3, 3);
            v = {rng.uniform(-reach, reach) * w, rng.uniform(-reach, reach) * w, 0, w};
          }
          const SnappedQuad q = snap_quad(given, c, state);
          const SetupResult setup = quad_setup(q, c, state);
          ASSERT_FALSE(setup.homogeneous);
          const TilePixel at(setup, c, rng);
          const auto check = [&](__int128 kept, __int128 exact, const char* what) {
            const bool same = kept * (__int128{1} << drop) == exact;
            lost += !same;
            EXPECT_TRUE(same || more == 1)
                << what << " with subpixel_bits " << sub << ", homogeneous_frac_bits " << hom;
          };
          for (std::size_t k = 0; k < linear_count; ++k) {
            const auto [i, j] = vertex_pair[k];
            const __int128 x = __int128{q.vertex[i].x} - q.vertex[j].x, y = __int128{q.vertex[i].y} - q.vertex[j].y;
            check(setup.length2[k], x * x + y * y, "length2");
            check(at.trace.d[k], dot_at(q, i, j, at.x, at.y), "D");
          }
          for (std::size_t i = 0; i < 4; ++i) check(at.trace.r2[i], dot_at(q, i, i, at.x, at.y), "r²");
        }
        EXPECT_EQ(lost > 0, more == 1);
      }
}

/// The rule as a user sees it: the fragments of ordinary quads are the same bits with all of the bits of D and r² and
/// with those of products on the ordinary grid alone, and with one bit less they are not.
TEST(DroppedBits, OrdinaryFragmentsAreTheSameUpToTheRule) {
  DrawState state;
  state.width = state.height = state.scissor_x1 = state.scissor_y1 = 64;
  std::size_t compared = 0;
  for (const int sub : {4, 8}) {
    Config all;
    all.subpixel_bits = sub;
    all.significand_bits = 24;
    all.validate();
    Config least = all, below = all;
    least.quadratic_frac_bits = 2 * sub;
    below.quadratic_frac_bits = 2 * sub - 1;
    std::size_t lost = 0;
    for (const auto& info : golden::stress_families()) {
      std::vector<SnappedQuad> quads;
      for (const WindowQuad& given : golden::make_stress(info.family, 40, 9, 1.0, 64, 64, 4))
        if (const SnappedQuad q = snap_quad(given, all, state); has_ordinary_vertices(q, all)) quads.push_back(q);
      const auto fragments = [&](const Config& c) {
        std::vector<Fragment> out;
        UntimedModel model(c, state, PixelEngine::lanes);
        for (const SnappedQuad& q : quads)
          model.draw(q, [&](std::span<const Fragment> f) { out.insert(out.end(), f.begin(), f.end()); });
        return out;
      };
      const std::vector<Fragment> drawn = fragments(all);
      EXPECT_EQ(fragments(least), drawn) << info.name << ", subpixel_bits " << sub;
      const std::vector<Fragment> other = fragments(below);
      for (std::size_t n = 0; n < std::min(drawn.size(), other.size()); ++n) lost += !(drawn[n] == other[n]);
      compared += drawn.size();
    }
    EXPECT_GT(lost, 100u) << "subpixel_bits " << sub;
  }
  EXPECT_GT(compared, 20'000u);
}

/// What is dropped counts from the tile's origin: never more than the way inside a tile, however far the quad's is.
TEST(DroppedBits, LossIsThatOfTheWayInsideATile) {
  golden::Prng rng(12);
  int homogeneous = 0, ordinary = 0, most = 0;
  for (const int quadratic : {20, 15, 8, 0}) {
    Config c;
    c.quadratic_frac_bits = quadratic;
    c.validate();
    const DrawState state = whole_viewport(c);
    const int drop = c.qdrop();
    const __int128 unit = __int128{1} << drop;
    const std::int64_t edge = std::int64_t{1} << (c.pos_int() + c.frac()), one = std::int64_t{1} << c.frac();
    for (int n = 0; n < 2000; ++n) {
      SnappedQuad q;
      for (SnappedVertex& v : q.vertex)  // ordinary by their w alone: beside the subpixel grid
        v = {static_cast<std::int32_t>(rng.integer(-edge, edge)),
             static_cast<std::int32_t>(rng.integer(-edge, edge)),
             static_cast<std::int32_t>(n % 2 == 0 ? one : rng.integer(-one, one)),
             {},
             {},
             {}};
      const SetupResult setup = quad_setup(q, c, state);
      const TilePixel at(setup, c, rng);
      const __int128 way = (unit - 1) * (1 + at.dx + at.row + at.dx * at.dx + at.row * at.row);
      ++(setup.homogeneous ? homogeneous : ordinary);
      const auto loss = [&](std::int64_t kept, std::size_t i, std::size_t j) {
        const __int128 lost = dot_at(q, i, j, at.x, at.y) - kept * unit;
        most = std::max(most, static_cast<int>(lost >> drop));
        return lost;
      };
      for (std::size_t i = 0; i < 4; ++i) {
        const __int128 lost = loss(at.trace.r2[i], i, i);
        ASSERT_TRUE(0 <= lost && lost <= way) << "r² " << i;
      }
      for (std::size_t k = 0; k < linear_count; ++k) {
        const __int128 lost = loss(at.trace.d[k], vertex_pair[k][0], vertex_pair[k][1]);
        if (setup.homogeneous)
          ASSERT_TRUE(0 <= lost && lost <= way) << "D " << k;
        else  // half of what two r² are low and a length is high, and of the sum's last bit
          ASSERT_TRUE(-(unit - 1) <= 2 * lost && 2 * lost <= 2 * way + unit) << "D " << k;
      }
    }
  }
  EXPECT_GT(homogeneous, 1'000);
  EXPECT_GT(ordinary, 1'000);
  EXPECT_GT(most, 20) << "the bound of 113 is not touched at all";
}

/// Every stage of the pipeline at random pixels of the stress families.
TEST(RangeProof, HoldsWhatThePipelineComputes) {
  for (const int quadratic : {-1, 16, 8}) {
    Config c;
    c.quadratic_frac_bits = quadratic;
    c.validate();
    const auto signal = by_name(prove_ranges(c));
    DrawState state;
    const PipelineContext context(c, state);
    golden::Prng rng(3);
    std::size_t pixels = 0, regular = 0;
    const auto regular_range = by_name(prove_regular_range(c));
    int farthest = 0;  // exponent of a regular weight
    // In powers of pixels of this degree / 2.
    const auto in_pixels = [&](const char* name, const PipelineFloat& v, int degree) {
      if (v.sig == 0) return;
      const SignalRange& s = regular_range.at(name);
      const int e = v.exp - degree * c.quadratic_frac();
      EXPECT_TRUE(s.low <= e && e <= s.high) << name << " 2^" << e << " [" << s.low << ", " << s.high << "]";
      EXPECT_LE(std::abs(e), regular_exponent_limit) << name;
    };
    const auto inside = [&](const char* name, double value) {
      const SignalRange& s = signal.at(name);
      EXPECT_TRUE(s.low <= value && value <= s.high) << name << " " << value << " [" << s.low << ", " << s.high << "]";
    };
    const auto exponent = [&](const char* name, const PipelineFloat& v) {
      if (v.sig != 0) inside(name, v.exp);
    };
    for (const auto& info : golden::stress_families())
      for (const WindowQuad& given : golden::make_stress(info.family, 40, 5)) {
        const SnappedQuad q = snap_quad(given, c, state);
        const SetupResult setup = quad_setup(q, c, state);
        const QuadConstants constants(setup);
        const QuadData data = quad_data(q, setup, c, state);
        for (std::size_t i = 0; i < 4; ++i) {
          exponent("exponent of k", data.k[i]);
          exponent("exponent of Z", data.z[i]);
        }
        for (int n = 0; n < 10; ++n) {
          TileEntry tile;
          tile.tile_x = static_cast<int>(rng.integer(setup.tile_x0, 63));
          tile.tile_y = static_cast<int>(rng.integer(setup.tile_y0, 63));
          const int x = (tile.tile_x - setup.tile_x0) * 8, y = (tile.tile_y - setup.tile_y0) * 8;
          WalkState walk;
          for (std::size_t k = 0; k < linear_count; ++k) walk.linear[k] = setup.linear[k].value;
          walk_step(walk, constants, x, y);
          tile.linear = walk.linear;
          tile.quadratic = tile_context(constants, x, y, c.qdrop());
          for (const QuadraticForm& f : tile.quadratic) {
            inside("gx of D, r²", static_cast<double>(f.gx));
            inside("gx of D, r²", static_cast<double>(f.gy));
            inside("q of D, r²", static_cast<double>(f.q));
          }
          for (const std::uint64_t v : setup.length2) inside("length2", static_cast<double>(v));
          PixelTrace p;
          pixel_pipeline(p, tile, constants, data, static_cast<int>(rng.below(8)), static_cast<int>(rng.below(8)),
                         context);
          ++pixels;
          for (std::size_t k = 0; k < 6; ++k) {
            inside("A", static_cast<double>(p.a[k]));
            inside("D", static_cast<double>(p.d[k]));
            exponent("exponent of A", p.a_fp[k]);
            exponent("exponent of D", p.d_fp[k]);
            exponent("exponent of u", p.u[k]);
          }
          for (std::size_t i = 0; i < 4; ++i) {
            inside("r²", static_cast<double>(p.r2[i]));
            exponent("exponent of r", p.root[i]);
            exponent("exponent of M", p.m[i]);
          }
          exponent("exponent of Σ M·k", p.den_k);
          exponent("exponent of Σ M·W", p.den_w);
          exponent("exponent of Σ M·Z", p.num_z);
          for (const PipelineFloat& v : p.num_a) exponent("exponent of Σ M·b", v);
          if (p.two_corner || p.on_vertex || p.two_edge) continue;
          ++regular;
          const SignificandFormat& f = context.format;
          for (std::size_t k = 0; k < 6; ++k) {
            in_pixels("A, D, r²", p.a_fp[k], 1);
            in_pixels("A, D, r²", p.d_fp[k], 1);
            in_pixels("u", p.u[k], 1);
          }
          for (const auto& [near, far] : {std::pair<std::size_t, std::size_t>{0, 2}, {3, 1}, {4, 5}}) {
            const PipelineFloat product = fp_multiply(p.u[near], p.u[far], f);
            in_pixels("u u'", product, 2);
            in_pixels("v u, v s", fp_multiply(p.v[far], p.u[near], f), 2);
            in_pixels("v u, v s", fp_multiply(p.v[near], fp_sqrt(product, context.sqrt_table, f), f), 2);
          }
          const std::array<WeightFactors, 4> factors = weight_factors(p, data, context);
          for (std::size_t i = 0; i < 4; ++i) {
            in_pixels("A, D, r²", p.r2_fp[i], 1);
            for (const PipelineFloat& v : {factors[i].x, factors[i].y, factors[i].z}) in_pixels("factors of M", v, 0);
            in_pixels("first product of M", fp_multiply(factors[i].x, factors[i].y, f), 0);
            in_pixels("M", p.m[i], 0);
            if (p.m[i].sig != 0) farthest = std::max(farthest, std::abs(p.m[i].exp));
          }
        }
      }
    EXPECT_GT(pixels, 5'000u);
    EXPECT_GT(regular, 4'000u);
    EXPECT_GT(farthest, 15) << "no weight is far from 1";
  }
}

/// What the headers of sqrt and reciprocal say is proved, in units of 2^-(S-1).
TEST(TableErrors, AreWithinWhatTheHeadersSay) {
  for (int s = 8; s <= 26; ++s) {
    const Config c = with_significand(s);
    const double unit = std::ldexp(1.0, 1 - s);
    const TableError root = sqrt_error(c), inverse = reciprocal_error(c);
    EXPECT_TRUE(std::expm1(root.low) > -1.13 * unit && std::expm1(root.high) < 0.76 * unit) << "s " << s;
    EXPECT_TRUE(std::expm1(inverse.low) > -0.76 * unit && std::expm1(inverse.high) < 0.65 * unit) << "s " << s;
  }
}

/// Every argument: the analysis is never below the truth, and above it by little.
TEST(TableErrors, HoldForEveryArgument) {
  for (int s = 8; s <= 17; ++s)
    for (int degree = 1; degree <= 2; ++degree)
      for (const int segments : {-1, 4}) {
        Config c;
        c.significand_bits = s;
        c.sqrt_degree = c.recip_degree = degree;
        c.sqrt_segments_log2 = c.recip_segments_log2 = segments;
        c.validate();
        const SignificandFormat f{s, 2};
        const Table root = make_sqrt_table(c), inverse = make_recip_table(c);
        TableError seen_root, seen_inverse;
        const auto see = [](TableError& seen, double log) {
          seen.low = std::min(seen.low, log);
          seen.high = std::max(seen.high, log);
        };
        const double one = std::ldexp(1.0, s - 1);
        for (std::uint32_t sig = 1u << (s - 1); sig < 1u << s; ++sig) {
          const double x = sig / one, next = (sig + 1.0) / one;
          const PipelineFloat y = reciprocal({false, 0, sig}, inverse, f);
          see(seen_inverse, std::log(std::ldexp(y.sig / one, y.exp) * x));
          for (int octave = 0; octave < 2; ++octave) {
            const PipelineFloat r = fp_sqrt({false, octave, sig}, root, f);
            // The argument stands for everything in [x, next).
            const double result = std::ldexp(r.sig / one, r.exp);
            see(seen_root, std::log(result / std::sqrt(std::ldexp(x, octave))));
            see(seen_root, std::log(result / std::sqrt(std::ldexp(next, octave))));
          }
        }
        const auto compare = [&](const char* name, const TableError& bound, const TableError& seen) {
          const std::string where = std::string(name) + " s " + std::to_string(s) + " degree " +
                                    std::to_string(degree) + " segments " + std::to_string(segments);
          EXPECT_LE(bound.low, seen.low) << where;
          EXPECT_GE(bound.high, seen.high) << where;
          const double slack = std::ldexp(0.4, -s);
          EXPECT_GE(bound.low, 1.1 * seen.low - slack) << where;
          EXPECT_LE(bound.high, 1.1 * seen.high + slack) << where;
        };
        compare("sqrt", sqrt_error(c), seen_root);
        compare("reciprocal", reciprocal_error(c), seen_inverse);
      }
}

/// Largest |Δλ'| in units of 2^-s that `quadrille stress --search --leave` has found: tb/MEASUREMENTS.md,
/// Errors.
TEST(ErrorBound, LiesAboveWhatClimbingFindsAndNotFar) {
  const std::pair<int, double> found[] = {{8, 3.39}, {12, 3.50}, {18, 3.46}, {26, 3.66}};
  for (const auto& [s, units] : found) {
    const double bound = std::ldexp(bound_lambda(with_significand(s)).value, s);
    EXPECT_GT(bound, units);
    EXPECT_LT(bound, 4 * units);
  }
}

/// The rule of thumb that is checked everywhere, 2^-(s-3), is what is proved of the machine as it is configured.
TEST(ErrorBound, ProvesTheRule) {
  for (int s = 8; s <= 26; ++s) {
    const ErrorBound bound = bound_lambda(with_significand(s));
    EXPECT_TRUE(bound.proved);
    EXPECT_LE(bound.value, std::ldexp(1.0, 3 - s)) << s;
  }
}

/// What a sum of four positive products loses, against what the bound takes for it: the less where no term has most of
/// the sum. Terms with many ones behind the window, sums a little above a power of two.
TEST(ErrorBound, HoldsWhatASumOfFourLoses) {
  for (const int s : {8, 12, 26})
    for (int g = 0; g <= 3; ++g) {
      const SignificandFormat f{s, g};
      const double u = std::ldexp(1.0, 1 - s), guard = std::ldexp(1.0, -g);
      const double all = 1 + 3 * guard, half = 1 + 1.5 * guard, part = half / all / (1 + u * all);
      golden::Prng rng(static_cast<std::uint64_t>(100 * s + g));
      double nearest = 0, nearest_shared = 0;
      for (int n = 0; n < 400'000; ++n) {
        std::array<RawProduct, 4> term;
        double sum = 0, largest = 0;
        const double first = rng.uniform(0, 2);
        for (std::size_t i = 0; i < 4; ++i) {
          const std::uint64_t low = std::uint64_t{1} << (s - 1);
          const PipelineFloat a{false, 0, static_cast<std::uint32_t>(low + rng.below(low))};
          const int exp = i == 0 ? 0 : -static_cast<int>(rng.below(i < 2 ? 2 : 12));
          // The first ones near 1 or 1/2, or anything.
          const PipelineFloat b{
              false, exp, static_cast<std::uint32_t>(low + (first < 1 ? rng.below(1 + low / 32) : rng.below(low)))};
          term[i] = raw_product(a, b);
          const double value = std::ldexp(static_cast<double>(term[i].p), term[i].exp - (2 * s - 2));
          sum += value;
          largest = std::max(largest, value);
        }
        const PipelineFloat stored = fp_sum(term, f);
        const double m = std::ldexp(static_cast<double>(stored.sig), 1 - s);
        const double lost = (sum - std::ldexp(m, stored.exp)) / std::ldexp(m, stored.exp);
        ASSERT_LE(lost, u * all / m);
        nearest = std::max(nearest, lost / (u * all));
        if (largest > part * sum) continue;
        ASSERT_LE(lost, u * std::min(half, all / m)) << "S " << s << ", G " << g << ", sum " << sum;
        nearest_shared = std::max(nearest_shared, lost / (u * half));
      }
      std::printf("S = %d, G = %d: %.2f of what any sum may lose, %.2f where the terms share it\n", s, g, nearest,
                  nearest_shared);
      EXPECT_GT(nearest_shared, 0.8);
    }
}

/// Every term of first order is a truncation or a table's error, both proportional to 2^-s; the tables' segments differ
/// from width to width by a few percent of that.
TEST(ErrorBound, OneMoreBitHalvesIt) {
  for (int s = 8; s < 26; ++s) {
    const ErrorBound wide = bound_lambda(with_significand(s)), narrow = bound_lambda(with_significand(s + 1));
    EXPECT_TRUE(wide.proved && narrow.proved);
    EXPECT_NEAR(narrow.value / wide.value, 0.5, 0.025) << s;
  }
}

/// c <= 1.1 at every width with the default guard bits, 1.25 where W is cut; more guard bits, less.
TEST(ErrorBound, ProvesTheFactorOfValues) {
  for (int s = 8; s <= 26; ++s) {
    double before = 2.3;
    for (int g = 0; g <= 6; ++g) {
      Config c = with_significand(s);
      c.align_guard_bits = g;
      const double factor = value_bound_factor(c), of_cut_w = value_bound_factor(c, true);
      EXPECT_LT(factor, of_cut_w);
      EXPECT_LT(of_cut_w, before);
      before = of_cut_w;
      EXPECT_LE(factor, g >= 2 ? 1.1 : 2) << "s " << s << ", G " << g;
      EXPECT_LE(of_cut_w, g >= 2 ? 1.25 : 2.3) << "s " << s;
      // Fewer terms lose less, and one weight is a value.
      const double rule = std::ldexp(1.0, 3 - s), code = std::ldexp(0.5, -c.attribute_frac());
      EXPECT_LT(bound_attribute(c, 1).value, rule * factor + code);
      EXPECT_GT(bound_attribute(c, 1).value, bound_lambda(c).value);
      EXPECT_NEAR(bound_depth(c, 1).value, rule * factor + std::ldexp(0.5, -c.depth_bits), rule * 1e-4);
    }
  }
}

/// What a sum of products of any signs loses, against what the bound takes for it: of one sign u + (n-1) g of itself;
/// of both, (n-1) g of the largest term away from zero, u of the sum and that much toward it.
TEST(ErrorBound, HoldsWhatASumOfAnySignsLoses) {
  for (const int s : {8, 26})
    for (int g = 0; g <= 3; ++g)
      for (const std::size_t n : {std::size_t{3}, std::size_t{4}}) {
        const SignificandFormat f{s, g};
        const double u = std::ldexp(1.0, 1 - s), grain = std::ldexp(u, -g) * static_cast<double>(n - 1);
        golden::Prng rng(static_cast<std::uint64_t>(1000 * s + 10 * g) + n);
        double away = 0, toward = 0;
        for (int trial = 0; trial < 300'000; ++trial) {
          std::array<RawProduct, 4> term;
          const std::uint64_t low = std::uint64_t{1} << (s - 1);
          __int128 sum = 0;  // in units of 2^(-2 s - 60)
          double largest = 0;
          const int far = static_cast<int>(rng.below(3)) * s;
          for (std::size_t i = 0; i < n; ++i) {
            const auto significand = [&] {
              return static_cast<std::uint32_t>(rng.chance(0.4) ? low + rng.below(3) : low + rng.below(low));
            };
            const int exp =
                i == 0 ? 0 : -static_cast<int>(rng.below(static_cast<std::uint64_t>(std::min(3 + far, 50))));
            const PipelineFloat a{rng.chance(0.5), 0, significand()}, b{false, exp, significand()};
            term[i] = raw_product(a, b);
            const __int128 value = static_cast<__int128>(term[i].p) << (62 + exp);
            sum += term[i].neg ? -value : value;
            largest = std::max(largest, static_cast<double>(value));
          }
          const PipelineFloat stored = fp_sum(std::span<const RawProduct>(term).first(n), f);
          const auto magnitude = static_cast<__int128>(stored.sig);
          const int shift = stored.exp + s - 1 + 62;
          const __int128 kept = stored.sig == 0 ? 0 : shift >= 0 ? magnitude << shift : magnitude >> -shift;
          const bool neg = stored.sig == 0 ? sum < 0 : stored.neg;
          const auto lost = static_cast<double>((neg ? -sum : sum) - kept), size = std::fabs(static_cast<double>(sum));
          ASSERT_LE(-lost, grain * largest * (1 + u));
          ASSERT_LE(lost, u * size + grain * largest * (1 + u));
          away = std::max(away, -lost / (grain * largest));
          toward = std::max(toward, lost / (u * size + grain * largest));
        }
        EXPECT_GT(away, 0.5) << "S " << s << ", G " << g << ", " << n << " terms";
        EXPECT_GT(toward, 0.5);
      }
}

TEST(ErrorBound, FollowsTheConfiguration) {
  const Config standard;
  for (int g = 0; g < 6; ++g) {
    Config less = standard, more = standard;
    less.align_guard_bits = g;
    more.align_guard_bits = g + 1;
    EXPECT_GT(bound_lambda(less).value, bound_lambda(more).value);
    EXPECT_GT(bound_attribute(less, 1).value, bound_attribute(more, 1).value);
    EXPECT_GT(bound_depth(less, 1).value, bound_depth(more, 1).value);
  }
  // A coarse table has an error of its own, in M and in the quotient.
  for (const char* key : {"sqrt_segments_log2", "recip_segments_log2"}) {
    Config coarse = with_significand(24);
    const double fine = bound_lambda(coarse).value;
    coarse.set(key, 3);
    EXPECT_GT(bound_lambda(coarse).value, 4 * fine) << key;
  }
  // Half a code of the output's grid is added once.
  Config grid = standard;
  grid.attribute_frac_bits = 18;
  EXPECT_NEAR(bound_attribute(grid, 1).value - bound_attribute(standard, 1).value, 0x1p-19 - 0x1p-25, 0x1p-32);
  // An attribute's error is proportional to its spread beyond that grid.
  EXPECT_NEAR(bound_attribute(standard, 4).value - 0x1p-25, 4 * (bound_attribute(standard, 1).value - 0x1p-25),
              0x1p-30);
  EXPECT_NEAR(bound_attribute(standard, 0).value, 0x1p-25, 0x1p-40);
}

TEST(ErrorBound, IsNotClaimedWithoutItsAssumptions) {
  Config homogeneous, dropped;
  homogeneous.quadratic_frac_bits = 16;  // all bits of positions on the grid of 1/256
  dropped.quadratic_frac_bits = 15;
  const double rule = 0x1p-15;
  EXPECT_FALSE(bound_lambda(homogeneous).proved);
  EXPECT_EQ(bound_lambda(homogeneous).value, rule);
  EXPECT_FALSE(bound_attribute(homogeneous, 3).proved);
  EXPECT_NEAR(bound_attribute(homogeneous, 3).value, 3 * rule * value_bound_factor(homogeneous) + 0x1p-25, 0x1p-28);
  EXPECT_FALSE(bound_lambda(homogeneous).reason.empty());
  EXPECT_TRUE(bound_depth(homogeneous, 1).proved);
  EXPECT_EQ(bound_depth(homogeneous, 1).value, bound_depth(Config{}, 1).value);
  for (const ErrorBound& b : {bound_lambda(dropped), bound_attribute(dropped, 1), bound_depth(dropped, 1)}) {
    EXPECT_FALSE(b.proved);
    EXPECT_TRUE(std::isinf(b.value));
  }
  EXPECT_TRUE(bound_lambda(Config{}).proved);
}

}  // namespace
}  // namespace quadrille
