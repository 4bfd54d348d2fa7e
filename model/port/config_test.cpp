// The configuration: ranges, automatic values and refusals as the table of README.md states them.
#include "model/port/config.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <string>
#include <string_view>

namespace quadrille {
namespace {

struct Row {
  std::string_view key;
  int standard, minimum, maximum;  ///< standard -1: automatic
};

// README.md, Configuration, key by key.
constexpr Row table[] = {
    {"viewport_bits", 12, 6, 14},
    {"guard_bits", 3, 1, 4},
    {"subpixel_bits", 8, 2, 8},
    {"homogeneous_frac_bits", 7, 4, 10},
    {"quadratic_frac_bits", -1, 0, 36},  // 2·FRAC at most; the key alone can only be held to the largest of these
    {"significand_bits", 18, 8, 26},
    {"notch_exact", 1, 0, 1},
    {"sqrt_segments_log2", -1, 3, 14},
    {"sqrt_degree", 2, 1, 2},
    {"recip_segments_log2", -1, 3, 14},
    {"recip_degree", 2, 1, 2},
    {"align_guard_bits", 2, 0, 6},
    {"attribute_slots", 4, 1, 8},
    {"attribute_int_bits", 7, 1, 15},
    {"attribute_frac_bits", -1, 8, 30},
    {"depth_bits", 24, 8, 30},
    {"tile_log2", 3, 2, 4},
    {"pixels_per_clock", 1, 1, 4},
    {"dot_units", 2, 2, 4},
    {"quad_slots_log2", 3, 1, 4},
    {"tile_slots_log2", 2, 1, 4},
    {"stamp_fifo_log2", 3, 1, 5},
    {"hierarchical_z_bits", 0, 0, 16},
    {"hierarchical_z_tiles_log2", 12, 6, 16},
    {"plane_quads", 0, 0, 1},
    {"quad_id_bits", 24, 8, 32},
    {"performance_counters", 0, 0, 1},
};

std::string refusal(const auto& action) {
  try {
    action();
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

std::string refusal_of(std::initializer_list<std::pair<const char*, int>> values) {
  Config c;
  for (const auto& [key, value] : values) c.set(key, value);
  return refusal([&] { c.validate(); });
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Config, KeysAreThoseOfTheTable) {
  ASSERT_EQ(Config::keys().size(), std::size(table));
  EXPECT_LE(Config::keys().size(), 32u);
  std::set<std::string_view> names;
  for (const ConfigKey& k : Config::keys()) {
    names.insert(k.name);
    EXPECT_FALSE(k.meaning.empty()) << k.name;
  }
  EXPECT_EQ(names.size(), std::size(table));
  for (const Row& row : table) {
    const auto found = std::ranges::find(Config::keys(), row.key, &ConfigKey::name);
    ASSERT_NE(found, Config::keys().end()) << row.key;
    EXPECT_EQ(found->standard, row.standard) << row.key;
    EXPECT_EQ(found->minimum, row.minimum) << row.key;
    EXPECT_EQ(found->maximum, row.maximum) << row.key;
    EXPECT_EQ(Config().get(row.key), row.standard) << row.key;
  }
}

TEST(Config, SetAndGetOverTheWholeRange) {
  for (const Row& row : table) {
    Config c;
    for (int v = row.minimum; v <= row.maximum; ++v) {
      ASSERT_NO_THROW(c.set(row.key, v)) << row.key << " = " << v;
      EXPECT_EQ(c.get(row.key), v);
    }
    const Config before = c;
    for (const int v : {row.minimum - 1, row.maximum + 1, -2, 1000, -2147483647 - 1}) {
      if (v >= row.minimum && v <= row.maximum) continue;
      if (v == -1 && row.standard == -1) continue;
      const std::string what = refusal([&] { c.set(row.key, v); });
      EXPECT_TRUE(contains(what, std::string(row.key))) << row.key << " = " << v << ": " << what;
      EXPECT_TRUE(contains(what, std::to_string(row.maximum))) << what;
      EXPECT_EQ(c, before) << "a refused value changed the configuration";
    }
    if (row.standard == -1) {
      ASSERT_NO_THROW(c.set(row.key, -1));
      EXPECT_EQ(c.get(row.key), -1);
    } else if (row.minimum > -1) {
      EXPECT_THROW(c.set(row.key, -1), ConfigError) << row.key << " has no automatic value";
    }
  }
}

TEST(Config, UnknownKeySuggestsTheNearest) {
  const std::pair<const char*, const char*> cases[] = {{"significant_bits", "significand_bits"},
                                                       {"viewport_bit", "viewport_bits"},
                                                       {"tile_log", "tile_log2"},
                                                       {"NOTCH_EXACT ", "'"},
                                                       {"sqrt_segment_log2", "sqrt_segments_log2"},
                                                       {"recip_degre", "recip_degree"},
                                                       {"depthbits", "depth_bits"}};
  for (const auto& [wrong, right] : cases) {
    Config c;
    const std::string set = refusal([&, key = wrong] { c.set(key, 1); });
    const std::string get = refusal([&, key = wrong] { static_cast<void>(c.get(key)); });
    EXPECT_TRUE(contains(set, wrong) && contains(set, right)) << set;
    EXPECT_TRUE(contains(get, right)) << get;
  }
  EXPECT_FALSE(refusal([] { static_cast<void>(Config().get("")); }).empty());
}

TEST(Config, AutomaticValues) {
  // ceil((S-4)/3), ceil(S/2) for degree 1, ceil((S-2)/3), ceil((S+1)/2), at least 3; written out, not computed.
  constexpr int sqrt2[] = {3, 3, 3, 3, 3, 3, 4, 4, 4, 5, 5, 5, 6, 6, 6, 7, 7, 7, 8};  // S = 8..26
  constexpr int sqrt1[] = {4, 5, 5, 6, 6, 7, 7, 8, 8, 9, 9, 10, 10, 11, 11, 12, 12, 13, 13};
  constexpr int recip2[] = {3, 3, 3, 3, 4, 4, 4, 5, 5, 5, 6, 6, 6, 7, 7, 7, 8, 8, 8};
  constexpr int recip1[] = {5, 5, 6, 6, 7, 7, 8, 8, 9, 9, 10, 10, 11, 11, 12, 12, 13, 13, 14};
  for (int s = 8; s <= 26; ++s) {
    Config c;
    c.set("significand_bits", s);
    EXPECT_EQ(c.sqrt_segments(), sqrt2[s - 8]) << "S = " << s;
    EXPECT_EQ(c.recip_segments(), recip2[s - 8]) << "S = " << s;
    EXPECT_EQ(c.attribute_frac(), s <= 22 ? 24 : s + 2);
    c.set("sqrt_degree", 1);
    c.set("recip_degree", 1);
    EXPECT_EQ(c.sqrt_segments(), sqrt1[s - 8]) << "S = " << s;
    EXPECT_EQ(c.recip_segments(), recip1[s - 8]) << "S = " << s;
    c.set("sqrt_segments_log2", 5);
    c.set("recip_segments_log2", 6);
    EXPECT_EQ(c.sqrt_segments(), 5);
    EXPECT_EQ(c.recip_segments(), 6);
  }
  Config c;
  EXPECT_EQ(c.quadratic_frac(), 30);
  c.set("quadratic_frac_bits", 0);
  EXPECT_EQ(c.quadratic_frac(), 0);
  EXPECT_EQ(c.qdrop(), 30);
}

TEST(Config, ResolvedValuesReplaceAuto) {
  Config c;
  for (const ConfigKey& key : Config::keys()) {
    const int value = c.resolved(key.name);
    if (key.standard != -1) {
      EXPECT_EQ(value, key.standard) << key.name;
      continue;
    }
    EXPECT_NE(value, -1) << key.name;
    Config given = c;
    given.set(key.name, value);  // giving the value changes nothing
    EXPECT_EQ(given.resolved(key.name), value) << key.name;
    EXPECT_NE(given, c) << key.name;
  }
  EXPECT_EQ(c.resolved("quadratic_frac_bits"), 30);
  EXPECT_EQ(c.resolved("attribute_frac_bits"), 24);
}

TEST(Config, DerivedWidthsOfTheDefault) {
  // rtl/SPEC.md, Widths, for viewport 12, guard 3, 8 + 7 fraction bits, S = 18, G = 2.
  const Config c;
  ASSERT_NO_THROW(c.validate());
  EXPECT_EQ(c.pos_int(), 15);
  EXPECT_EQ(c.frac(), 15);
  EXPECT_EQ(c.t_bits(), 32);
  EXPECT_EQ(c.w_bits(), 17);
  EXPECT_EQ(c.val_bits(), 63);
  EXPECT_EQ(c.grad_bits(), 48);
  EXPECT_EQ(c.curv_bits(), 32);
  EXPECT_EQ(c.qdrop(), 0);
  EXPECT_EQ(c.prec_bits(), 19);
  EXPECT_EQ(c.tile(), 8);
  EXPECT_EQ(c.tc_bits(), 10);
  EXPECT_EQ(c.attr_port_bits(), 28);
  EXPECT_EQ(c.attr_out_bits(), 32);
  EXPECT_EQ(c.attribute_frac(), 24);
  Config one;
  one.set("guard_bits", 1);
  EXPECT_EQ(one.val_bits(), 2 * (13 + 15) + 4);
  std::set<std::string> names;
  for (const DerivedWidth& d : c.derived()) {
    EXPECT_FALSE(d.reason.empty()) << d.name;
    EXPECT_TRUE(names.insert(d.name).second) << d.name << " twice";
  }
  for (const char* name : {"POS_INT", "FRAC", "T_BITS", "W_BITS", "VAL_BITS", "GRAD_BITS", "CURV_BITS", "QDROP",
                           "QVAL_BITS", "QGRAD_BITS", "QCURV_BITS", "EXP_BITS", "PORT_EXP_BITS", "PREC_BITS",
                           "TABLE_GUARD", "TILE", "TC_BITS", "ATTR_PORT_BITS", "ATTR_OUT_BITS"})
    EXPECT_TRUE(names.contains(name)) << name;
}

TEST(Config, ImpossibleCombinationsNameTheirRule) {
  EXPECT_TRUE(contains(refusal_of({{"viewport_bits", 14}, {"homogeneous_frac_bits", 10}}), "VAL_BITS"));
  EXPECT_TRUE(contains(refusal_of({{"viewport_bits", 14}, {"guard_bits", 2}}), ""));
  EXPECT_TRUE(contains(refusal_of({{"pixels_per_clock", 3}}), "it must be 1, 2 or 4"));
  EXPECT_TRUE(contains(refusal_of({{"hierarchical_z_bits", 3}}), "it must be 0 or at least 4"));
  EXPECT_TRUE(contains(refusal_of({{"hierarchical_z_bits", 12}, {"depth_bits", 10}}), "exceeds depth_bits = 10"));
  EXPECT_EQ(refusal_of({{"hierarchical_z_bits", 10}, {"depth_bits", 10}}), "");
  EXPECT_TRUE(contains(refusal_of({{"quadratic_frac_bits", 31}}), "quadratic_frac_bits"));
  EXPECT_TRUE(contains(refusal_of({{"dot_units", 3}}), "dot_units = 3"));
  EXPECT_TRUE(contains(refusal_of({{"attribute_frac_bits", 17}}), "attribute_frac_bits"));
  EXPECT_TRUE(contains(refusal_of({{"significand_bits", 8}, {"sqrt_segments_log2", 7}}), "sqrt_segments_log2"));
  EXPECT_TRUE(contains(refusal_of({{"significand_bits", 8}, {"recip_segments_log2", 7}}), "recip_segments_log2"));
  EXPECT_TRUE(contains(refusal_of({{"viewport_bits", 6}, {"guard_bits", 1}, {"tile_log2", 4}}), "tile_log2"));
  // |A| could reach 2^(VAL_BITS-1) exactly, one too many; rtl/quadrille_config_check.sv refuses it too.
  EXPECT_TRUE(contains(refusal_of({{"viewport_bits", 6}, {"guard_bits", 1}, {"tile_log2", 3}}), "tile_log2"));
  EXPECT_TRUE(contains(refusal_of({{"viewport_bits", 7}, {"guard_bits", 1}, {"tile_log2", 4}}), "tile_log2"));
  EXPECT_EQ(refusal_of({{"viewport_bits", 7}, {"guard_bits", 1}, {"tile_log2", 3}}), "");
  // The edges of the same rules are possible.
  EXPECT_EQ(refusal_of({{"viewport_bits", 14}, {"guard_bits", 1}}), "");
  EXPECT_EQ(refusal_of({{"quadratic_frac_bits", 30}}), "");
  EXPECT_EQ(refusal_of({{"pixels_per_clock", 4}, {"tile_log2", 2}}), "");
  EXPECT_EQ(refusal_of({{"attribute_frac_bits", 18}}), "");
  EXPECT_EQ(refusal_of({{"significand_bits", 8}, {"sqrt_segments_log2", 6}, {"recip_segments_log2", 6}}), "");
  Config wild;
  wild.significand_bits = 40;  // past set()
  EXPECT_TRUE(contains(refusal([&] { wild.validate(); }), "significand_bits"));
}

/// No accepted configuration has a width that its own rule (VAL_BITS <= 64, operands of 33 bits) does not cover.
TEST(Config, EveryAcceptedGeometryFitsSixtyFourBits) {
  int accepted = 0, refused = 0;
  for (int vp = 6; vp <= 14; ++vp)
    for (int guard = 1; guard <= 4; ++guard)
      for (int sub = 2; sub <= 8; ++sub)
        for (int hom = 4; hom <= 10; ++hom)
          for (int tile = 2; tile <= 4; ++tile) {
            Config c;
            c.viewport_bits = vp;
            c.guard_bits = guard;
            c.subpixel_bits = sub;
            c.homogeneous_frac_bits = hom;
            c.tile_log2 = tile;
            if (!refusal([&] { c.validate(); }).empty()) {
              ++refused;
              continue;
            }
            ++accepted;
            // The largest |S|: a vertex at the guard band, the last pixel of a block that starts inside the viewport.
            const int unit = vp + guard + sub + hom;
            const __int128 reach = (static_cast<__int128>(1) << unit) +
                                   ((static_cast<__int128>((1 << vp) + (8 << tile) - 2)) << (sub + hom));
            const __int128 most = 2 * reach * reach;
            ASSERT_LE(c.val_bits(), 64);
            ASSERT_LE(c.t_bits(), 33) << "dot unit operands have 33 bits";
            ASSERT_LT(most, static_cast<__int128>(1) << (c.val_bits() - 1))
                << vp << " " << guard << " " << sub << " " << hom << " " << tile;
          }
  EXPECT_GT(accepted, 1000);
  EXPECT_GT(refused, 100);
}

TEST(Config, FormerNamesOfKeysAreKnown) {
  Config config;
  config.set("rsqrt_segments_log2", 7);
  config.set("rsqrt_degree", 1);
  EXPECT_EQ(config.get("sqrt_segments_log2"), 7);
  EXPECT_EQ(config.sqrt_degree, 1);
  EXPECT_EQ(config.resolved("rsqrt_segments_log2"), 7);
  EXPECT_EQ(Config::key("rsqrt_degree").name, "sqrt_degree");
  EXPECT_THROW(config.set("rsqrt", 1), ConfigError);
}

TEST(Config, RemovedKeysAreReadWhereTheyWereOff) {
  const Config standard;
  Config config;
  config.set("plane_tolerance_bits", 0);
  EXPECT_EQ(config, standard);
  EXPECT_EQ(config.get("plane_tolerance_bits"), 0);
  EXPECT_EQ(config.resolved("plane_tolerance_bits"), 0);
  EXPECT_EQ(Config::note("plane_tolerance_bits"),
            "plane_tolerance_bits = 0 is no longer needed: quads nearly plane are no longer treated apart");
  EXPECT_EQ(Config::note("plane_quads"), "");
  for (const int value : {10, 31, -1}) {
    const std::string what = refusal([&] { config.set("plane_tolerance_bits", value); });
    EXPECT_TRUE(what.starts_with("plane_tolerance_bits = " + std::to_string(value) + ": the tolerance was removed"))
        << what;
    EXPECT_TRUE(contains(what, "plane_quads = 1")) << what;
  }
  EXPECT_EQ(config, standard);
  EXPECT_TRUE(contains(refusal([] { static_cast<void>(Config::key("plane_tolerance_bits")); }), "was removed"));
  for (const ConfigKey& key : Config::keys()) EXPECT_EQ(Config::removed(key.name), nullptr) << key.name;
}

}  // namespace
}  // namespace quadrille
