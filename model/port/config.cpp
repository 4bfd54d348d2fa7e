#include "model/port/config.hpp"

#include "model/support/edit_distance.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace quadrille {
namespace {

struct Entry {
  ConfigKey key;
  int Config::*member;
};

constexpr auto entries = [] {
  using enum ConfigKey::Trait;
  return std::array{
#define KEY(name, minimum, maximum, standard, unit, stage, errors, traits, axis, meaning)                           \
  Entry{{#name, minimum, maximum, standard, unit, ConfigKey::Stage::stage, ConfigKey::Errors::errors, traits, axis, \
         meaning},                                                                                                  \
        &Config::name},
#include "model/port/config_keys.h"
#undef KEY
  };
}();

static_assert(entries.size() <= Config::most_keys);

constexpr auto key_list = [] {
  std::array<ConfigKey, entries.size()> list{};
  for (std::size_t i = 0; i < entries.size(); ++i) list[i] = entries[i].key;
  return list;
}();

/// Names that keys had while the tables were of 1/sqrt: files and scripts have them.
constexpr std::array<std::array<std::string_view, 2>, 2> former_names{
    {{"rsqrt_segments_log2", "sqrt_segments_log2"}, {"rsqrt_degree", "sqrt_degree"}}};

constexpr std::array removed_keys{
    RemovedKey{"plane_tolerance_bits", 0, "quads nearly plane are no longer treated apart",
               "the tolerance was removed (it saved no clock); for exactly plane quads, formerly 31, set plane_quads = "
               "1"},
};

const Entry& find(std::string_view key) {
  for (const auto& [former, name] : former_names)
    if (key == former) key = name;
  for (const Entry& e : entries)
    if (e.key.name == key) return e;
  if (const RemovedKey* removed = Config::removed(key))
    throw ConfigError(std::string(key) + ": " + std::string(removed->reason));
  throw ConfigError("unknown configuration key '" + std::string(key) + "'" +
                    did_you_mean(key, entries, [](const Entry& e) { return e.key.name; }) +
                    " (`quadrille config` lists all)");
}

int ceil_div(int a, int b) { return (a + b - 1) / b; }

void require(bool ok, const std::string& rule) {
  if (!ok) throw ConfigError("impossible configuration: " + rule);
}

}  // namespace

std::span<const ConfigKey> Config::keys() { return key_list; }

const ConfigKey& Config::key(std::string_view name) { return find(name).key; }

std::string_view Config::present_name(std::string_view name) {
  return removed(name) != nullptr ? name : key(name).name;
}

const RemovedKey* Config::removed(std::string_view name) {
  const auto found = std::ranges::find(removed_keys, name, &RemovedKey::name);
  return found == removed_keys.end() ? nullptr : &*found;
}

std::string Config::note(std::string_view name) {
  const RemovedKey* removed = Config::removed(name);
  if (removed == nullptr) return "";
  return std::string(name) + " = " + std::to_string(removed->off) +
         " is no longer needed: " + std::string(removed->note);
}

int Config::get(std::string_view key) const {
  const RemovedKey* removed = Config::removed(key);
  return removed != nullptr ? removed->off : this->*find(key).member;
}

int Config::resolved(std::string_view given) const {
  if (removed(given) != nullptr) return get(given);
  const std::string_view key = find(given).key.name;
  if (key == "quadratic_frac_bits") return quadratic_frac();
  if (key == "sqrt_segments_log2") return sqrt_segments();
  if (key == "recip_segments_log2") return recip_segments();
  if (key == "attribute_frac_bits") return attribute_frac();
  return get(key);
}

void Config::set(std::string_view key, int value) {
  if (const RemovedKey* removed = Config::removed(key)) {
    if (value == removed->off) return;
    throw ConfigError(std::string(key) + " = " + std::to_string(value) + ": " + std::string(removed->reason));
  }
  const Entry& e = find(key);
  const bool automatic = value == -1 && e.key.standard == -1;
  if (!automatic && (value < e.key.minimum || value > e.key.maximum)) {
    const std::string given = value == -1 ? "auto (-1)" : std::to_string(value);
    throw ConfigError("configuration key '" + std::string(key) + "' = " + given + " is outside " +
                      std::to_string(e.key.minimum) + ".." + std::to_string(e.key.maximum) +
                      (e.key.standard == -1 ? " (or -1 for auto)" : ""));
  }
  this->*e.member = value;
}

int Config::quadratic_frac() const { return quadratic_frac_bits == -1 ? 2 * frac() : quadratic_frac_bits; }

int Config::sqrt_segments() const {
  if (sqrt_segments_log2 != -1) return sqrt_segments_log2;
  const int s = significand_bits;
  return std::clamp(sqrt_degree == 2 ? ceil_div(s - 4, 3) : ceil_div(s, 2), 3, 14);
}

int Config::recip_segments() const {
  if (recip_segments_log2 != -1) return recip_segments_log2;
  const int s = significand_bits;
  return std::clamp(recip_degree == 2 ? ceil_div(s - 2, 3) : ceil_div(s + 1, 2), 3, 14);
}

int Config::attribute_frac() const {
  return attribute_frac_bits == -1 ? std::max(24, significand_bits + 2) : attribute_frac_bits;
}

void Config::validate() const {
  for (const Entry& e : entries) {
    Config scratch;
    scratch.set(e.key.name, this->*e.member);
  }
  require(val_bits() <= 64,
          "VAL_BITS = 2·(viewport_bits + guard_bits + subpixel_bits + homogeneous_frac_bits) + 3 (4 when guard_bits = "
          "1) = " +
              std::to_string(val_bits()) + " exceeds 64; lower one of these four");
  require(quadratic_frac() <= 2 * frac(), "quadratic_frac_bits = " + std::to_string(quadratic_frac()) +
                                              " exceeds the 2·(subpixel_bits + homogeneous_frac_bits) = " +
                                              std::to_string(2 * frac()) + " fraction bits that D and r² have");
  // |S| <= 2^pos_int + the viewport + one block, and |A|, |D|, r² <= 2 |S|^2 must fit the sign and VAL_BITS - 1 bits.
  const double reach = 1.0 + std::ldexp(1.0, -guard_bits) + std::ldexp(1.0, tile_log2 + 3 - pos_int());
  require(2 * reach * reach < std::ldexp(1.0, val_bits() - 1 - 2 * (pos_int() + frac())),
          "a block of 8 tiles reaches too far outside the viewport for VAL_BITS; raise viewport_bits or guard_bits, or "
          "lower tile_log2");
  require(attribute_frac() >= significand_bits, "attribute_frac_bits = " + std::to_string(attribute_frac()) +
                                                    " is below significand_bits = " + std::to_string(significand_bits) +
                                                    "; outputs keep at least s fraction bits");
  require(attribute_frac() <= 30, "attribute_frac_bits exceeds 30");
  require(sqrt_segments() <= significand_bits - 2, "sqrt_segments_log2 must be at most significand_bits - 2");
  require(recip_segments() <= significand_bits - 2, "recip_segments_log2 must be at most significand_bits - 2");
  require(dot_units != 3, "dot_units = 3; it must be 2 or 4");
  require(tile_log2 < viewport_bits, "tile_log2 must be below viewport_bits");
  require(hierarchical_z_bits == 0 || hierarchical_z_bits >= 4,
          "hierarchical_z_bits = " + std::to_string(hierarchical_z_bits) + "; it must be 0 or at least 4");
  require(hierarchical_z_bits <= depth_bits, "hierarchical_z_bits = " + std::to_string(hierarchical_z_bits) +
                                                 " exceeds depth_bits = " + std::to_string(depth_bits));
  require(pixels_per_clock != 3, "pixels_per_clock = 3; it must be 1, 2 or 4");
}

std::vector<DerivedWidth> Config::derived() const {
  return {
      {"POS_INT", pos_int(), "viewport_bits + guard_bits: integer bits of a position, sign apart"},
      {"FRAC", frac(), "subpixel_bits + homogeneous_frac_bits: fraction bits of X, Y, W"},
      {"T_BITS", t_bits(),
       "POS_INT + FRAC + 2, signed: |X| reaches 2^(POS_INT+FRAC) inclusive, and S = X - W·x adds less than that again"},
      {"W_BITS", w_bits(), "FRAC + 2, signed: |W| reaches 1 inclusive"},
      {"VAL_BITS", val_bits(), "2·(POS_INT + FRAC) + 3 (4 for one guard bit), signed: |A|, |D|, r² <= 2·max|S|²"},
      {"GRAD_BITS", grad_bits(), "T_BITS + W_BITS - 1, signed: two products T·W"},
      {"CURV_BITS", curv_bits(), "2·FRAC + 2, signed: |W·W'| reaches 1 inclusive"},
      {"QDROP", qdrop(), "2·FRAC - quadratic_frac_bits: low bits of D and r² that are dropped"},
      {"QVAL_BITS", qval_bits(), "VAL_BITS - QDROP"},
      {"LENGTH2_BITS", length2_bits(),
       "2·(POS_INT + FRAC) + 4 - QDROP, unsigned: two squares of at most twice a position"},
      {"QGRAD_BITS", qgrad_bits(), "GRAD_BITS - QDROP"},
      {"QCURV_BITS", qcurv_bits(), "CURV_BITS - QDROP"},
      {"QUADRATIC_FRAC", quadratic_frac(), "quadratic_frac_bits, resolved"},
      {"EXP_BITS", exp_bits,
       "signed: numbers of the port, weights, sums and a quotient of two sums stay within ±2^10, a bit to spare"},
      {"PORT_EXP_BITS", port_exp_bits, "signed: inputs are refused outside 2^±80, so k, Z, b stay within ±2^8"},
      {"PREC_BITS", prec_bits(), "S - 1 + align_guard_bits: fraction bits of an aligned sum"},
      {"TABLE_GUARD", table_guard, "accumulator bits of a table below its S-bit result"},
      {"SQRT_SEGMENTS", sqrt_segments(), "sqrt_segments_log2, resolved: cubic error of a segment about 1/8 ulp"},
      {"RECIP_SEGMENTS", recip_segments(), "recip_segments_log2, resolved: cubic error of a segment about 1/8 ulp"},
      {"ATTRIBUTE_FRAC", attribute_frac(),
       "attribute_frac_bits, resolved: rounding is 1/8 of 2^-s, and a value far from 0 keeps 24 bits"},
      {"TILE", tile(), "2^tile_log2 pixels"},
      {"TC_BITS", tc_bits(), "viewport_bits - tile_log2 + 1: tile coordinate or count"},
      {"ATTR_PORT_BITS", attr_port_bits(), "sign + PORT_EXP_BITS + S"},
      {"ATTR_OUT_BITS", attr_out_bits(), "sign + attribute_int_bits + ATTRIBUTE_FRAC"},
  };
}

}  // namespace quadrille
