// Twin of rtl/quadrille_performance_counters.sv: what the machine did, clock by clock, from what each of its units does
// in a clock (rtl/SPEC.md, Performance counters).
#pragma once

#include "model/port/config.hpp"
#include "model/port/records.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace quadrille {

/// The counters in the order of their indices.
enum class PerformanceCounter : std::uint8_t {
  clocks,
  // Quads by what became of them
  quads,
  quads_empty,
  quads_behind,
  quads_depth,
  quads_line,
  quads_culled,
  quads_ordinary,
  quads_homogeneous,
  quads_plane,
  // Walk and coverage
  blocks_tested,
  blocks_entered,
  blocks_hidden,
  tiles_tested,
  tiles_entered,
  tiles_hidden,
  tiles_masked,
  rows_tested,
  stamps,
  // Pixels by lane of the port and by kind of weights, fragments of them
  pixels_lane0,
  pixels_lane1,
  pixels_lane2,
  pixels_lane3,
  pixels_plane,
  fragments,
  // Products by unit
  products_vertex_products,
  products_sqrt,
  products_mean_value_ratios,
  products_mean_value_weights,
  products_interpolate,
  products_reciprocal,
  products_fragment_output,
  // Clocks by what bound them
  bound_pixels,
  bound_output,
  bound_stamps,
  bound_walk,
  bound_setup,
  bound_vertices,
  bound_wipe,
  bound_drain,
  bound_idle,
};

struct CounterInfo {
  std::string_view name;     ///< as in the enumeration: of reports
  std::string_view meaning;  ///< what it counts
};

inline constexpr std::size_t counter_count = 41;
/// By index.
extern const std::array<CounterInfo, counter_count> counter_info;

/// Bits of a counter of the RTL, which wraps around; those of the model do not.
inline constexpr int counter_bits = 32;

struct PerformanceCounters {
  std::array<std::uint64_t, counter_count> value{};

  std::uint64_t& operator[](PerformanceCounter counter) { return value[static_cast<std::size_t>(counter)]; }
  std::uint64_t operator[](PerformanceCounter counter) const { return value[static_cast<std::size_t>(counter)]; }
  PerformanceCounters& operator+=(const PerformanceCounters& other) {
    for (std::size_t i = 0; i < counter_count; ++i) value[i] += other.value[i];
    return *this;
  }

  /// Pixels of all lanes.
  std::uint64_t pixels() const;
  /// Products of all units.
  std::uint64_t products() const;
  /// Quads that were left out, whatever the reason.
  std::uint64_t quads_left_out() const;

  friend bool operator==(const PerformanceCounters&, const PerformanceCounters&) = default;
};

/// Products of the units: of vertex_products in one step of setup or tile context, all pairs of dot units together; of
/// the others of one pixel, those of reciprocal of one denominator.
struct UnitProducts {
  int vertex_products, sqrt, mean_value_ratios;
  int weight_ratios, weight_factors;  ///< mean_value_weights: up to the ratios of roots, and the weights made of them
  int reciprocal;

  explicit UnitProducts(const Config& config);
};

/// Sums and quotients of a pixel whose operands switch: all that the machine has, or with skip_operands those that a
/// fragment depends on.
struct WantedSums {
  int terms;         ///< of the sums: k, W and Z of four corners, attributes of three
  int denominators;  ///< k and W
  int quotients;     ///< attributes and z

  /// `hull`: the eye is in the quad's hull, so that the sign of ΣM·W counts.
  WantedSums(const Config& config, const DrawState& state, bool hull);
};

/// What bounds a clock, from what the units hold in it.
struct BoundInputs {
  bool head = false;          ///< emission has a stamp or an end entry
  bool head_waits = false;    ///< and no place for its fragments
  bool rows = false;          ///< coverage has a tile or an end entry
  bool rows_behind = false;   ///< and another one behind it
  bool walk = false;          ///< the walk has a quad
  bool walk_behind = false;   ///< a complete quad waits for it
  bool setup = false;         ///< setup has a quad
  bool setup_behind = false;  ///< a quad waits for setup or a slot
  bool assembly = false;      ///< vertices or a quad are in front of setup
  bool wipe = false;          ///< hierarchical_z wipes places: after reset, or a clear
  bool busy = false;
};
/// bound_pixels to bound_idle.
PerformanceCounter bound_of(const BoundInputs& inputs);

}  // namespace quadrille
