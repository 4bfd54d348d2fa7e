#include "golden/vectors/stage_suite_test_support.hpp"

#include <algorithm>
#include <cmath>

namespace {

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

}  // namespace
