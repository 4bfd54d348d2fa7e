#include "golden/analysis/range_proof.hpp"
#include "golden/scenes/stress.hpp"
#include "model/front/quad_setup.hpp"
#include "model/front/tile_context.hpp"
#include "model/pixel/pixel_pipeline.hpp"
#include "model/pixel/weight_factors.hpp"
#include "model/port/snap.hpp"
#include "model/support/prng.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <string>

namespace quadrille {
namespace {

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
          const auto row = static_cast<int>(rng.below(8)), dx = static_cast<int>(rng.below(8));
          pixel_pipeline(p, tile, constants, data, dx, row, context);
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

}  // namespace
}  // namespace quadrille
