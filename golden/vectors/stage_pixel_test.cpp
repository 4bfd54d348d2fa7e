#include "golden/vectors/stage_suite_test_support.hpp"

#include <algorithm>
#include <set>

namespace {

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
