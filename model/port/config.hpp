// The configuration: every width of the machine, from one list (config_keys.h). C++ reads it at run time; the RTL gets
// the same keys as macros QUADRILLE_<KEY> (rtl/quadrille_pkg.sv) and derives its widths itself; a test proves both
// sides equal.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille {

/// A configuration that cannot be built; the message names the rule that it breaks and a way out.
struct ConfigError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// One key of the configuration with everything that listings, sweeps, searches and files need to know of it.
struct ConfigKey {
  /// Where its value first shows in the numbers of a fragment, in the order of the machine. `ratios` includes the
  /// weights, `reciprocal` the output; none: nowhere.
  enum class Stage { positions, differences, normalise, sqrt, ratios, interpolate, reciprocal, plane, none };
  /// none: no number and no flag of a fragment depends on it, nor which quads are refused (flag 6 apart, which is
  /// notch_exact). ordered: with more of it errors are no larger, up to noise, and no more is refused. unordered: two
  /// values do not rule each other out; all keys that move snapped positions, since where the input lies decides which
  /// errors it meets.
  enum class Errors { none, ordered, unordered };
  /// clocks: of some draw, without stalls. proofs: of bounds and ranges (golden/analysis). added: after the kept golden
  /// vectors were made, so that a manifest names it only where it is not at its default.
  enum Trait : unsigned { nothing = 0, clocks = 1, area = 2, proofs = 4, added = 8 };

  std::string_view name;
  int minimum, maximum, standard;  ///< standard -1: derived ("auto")
  std::string_view unit;
  Stage stage;
  Errors errors;
  unsigned traits;
  std::string_view axis;  ///< values that a sweep tries where none are named
  std::string_view meaning;

  constexpr bool has(Trait trait) const { return (traits & trait) != 0; }
};

/// A key that there is no more. Old files and scripts may set it to the value with which nothing of it was there.
struct RemovedKey {
  std::string_view name;
  int off;                  ///< the value that is read and ignored
  std::string_view note;    ///< why nobody needs to set it
  std::string_view reason;  ///< why any other value is refused, and what to set instead
};

/// A derived quantity with the reason for its value.
struct DerivedWidth {
  std::string name;
  int value;
  std::string reason;
};

struct Config {
  // Keys, as given; -1 = auto where the key allows it. Read the resolved values below the line.
#define KEY(name, minimum, maximum, standard, ...) int name = standard;
#include "model/port/config_keys.h"
#undef KEY

  /// At most so many keys: what a user is asked to look through.
  static constexpr std::size_t most_keys = 32;
  /// The keys in order, with range, default, unit and meaning.
  static std::span<const ConfigKey> keys();
  /// A key by its name, or by the one that it had before (rsqrt_segments_log2, rsqrt_degree); throws ConfigError for an
  /// unknown name (the nearest one is suggested) and for a removed key.
  static const ConfigKey& key(std::string_view name);
  /// The name that a key has now: its own, but for one that had another before; of a removed key the one given. Throws
  /// ConfigError for an unknown name.
  static std::string_view present_name(std::string_view name);
  /// A key that was removed, by its name; else none.
  static const RemovedKey* removed(std::string_view name);
  /// What to tell a user who sets a key: "NAME = VALUE is no longer needed: …" of a removed one, else nothing.
  static std::string note(std::string_view name);
  /// Value of a key by name, of a removed one that at which it was off; throws ConfigError for an unknown name (the
  /// nearest one is suggested).
  int get(std::string_view key) const;
  /// The same with auto replaced by the value that it stands for.
  int resolved(std::string_view key) const;
  /// Sets a key; throws ConfigError for an unknown name or a value outside the key's range. A removed key takes the
  /// value at which it was off, which changes nothing, and refuses any other.
  void set(std::string_view key, int value);
  /// Throws ConfigError when the combination cannot be built.
  void validate() const;

  // ---- resolved and derived (each formula has its reason in derived()) ----
  int quadratic_frac() const;  ///< kept fraction bits of D and R²
  int sqrt_segments() const;   ///< log2 of the segments per octave
  int recip_segments() const;
  int attribute_frac() const;
  int pos_int() const { return viewport_bits + guard_bits; }
  int frac() const { return subpixel_bits + homogeneous_frac_bits; }
  int t_bits() const { return pos_int() + frac() + 2; }
  int w_bits() const { return frac() + 2; }
  int val_bits() const { return 2 * (pos_int() + frac()) + (guard_bits >= 2 ? 3 : 4); }
  int grad_bits() const { return t_bits() + w_bits() - 1; }
  int curv_bits() const { return 2 * frac() + 2; }
  int qdrop() const { return 2 * frac() - quadratic_frac(); }
  int qval_bits() const { return val_bits() - qdrop(); }
  int length2_bits() const { return 2 * (pos_int() + frac()) + 4 - qdrop(); }
  int qgrad_bits() const { return grad_bits() - qdrop(); }
  int qcurv_bits() const { return curv_bits() - qdrop(); }
  int prec_bits() const { return significand_bits - 1 + align_guard_bits; }
  int tile() const { return 1 << tile_log2; }
  int tc_bits() const { return viewport_bits - tile_log2 + 1; }
  int attr_port_bits() const { return 1 + port_exp_bits + significand_bits; }
  int attr_out_bits() const { return 1 + attribute_int_bits + attribute_frac(); }
  /// A corner's depth code is -1 to this: above 1.
  std::int32_t depth_above() const { return (std::int32_t{1} << depth_bits) + 1; }
  /// The largest code of an attribute; the least is its negative.
  std::int64_t attribute_limit() const { return (std::int64_t{1} << (attribute_int_bits + attribute_frac())) - 1; }
  /// Pairs of dot units: each has a job a clock.
  int product_pairs() const { return dot_units / 2; }
  int quad_slots() const { return 1 << quad_slots_log2; }
  int tile_slots() const { return 1 << tile_slots_log2; }
  /// The tile ring: as many entries again as tiles in flight, for those on the way from the walk to their first stamp.
  int ring_log2() const { return tile_slots_log2 + 1; }
  int stamp_fifo() const { return 1 << stamp_fifo_log2; }

  static constexpr int most_pixels_per_clock = 4;
  static constexpr int widest_tile = 16;  ///< tile() of the largest tile_log2
  static constexpr int exp_bits = 12;
  static constexpr int port_exp_bits = 9;
  static constexpr int table_guard = 3;
  static constexpr int block_tiles = 8;

  /// Every derived width (upper-case names of rtl/quadrille_pkg.sv) with its reason.
  std::vector<DerivedWidth> derived() const;

  friend bool operator==(const Config&, const Config&) = default;
};

}  // namespace quadrille
