#include "model/port/performance_counters.hpp"

#include <numeric>

namespace quadrille {

constinit const std::array<CounterInfo, counter_count> counter_info{{
    {"clocks", "clocks since reset"},
    {"quads", "quads that left vertex_assembly, for setup or left out"},
    {"quads_empty", "left out: no pixel centre of the scissor in the bounding box"},
    {"quads_behind", "left out: no w > 0"},
    {"quads_depth", "left out: outside [znear, zfar]"},
    {"quads_line", "left out by setup: both triangles without area"},
    {"quads_culled", "left out by setup: no wanted face possible, or none that meets the scissor"},
    {"quads_ordinary", "taken by the walk, all W = ONE"},
    {"quads_homogeneous", "taken by the walk, others"},
    {"quads_plane", "of the quads that setup took, those that take areas for weights"},
    {"blocks_tested", "tests of blocks that counted"},
    {"blocks_entered", "of these, those that were hit, and whose tiles were tested"},
    {"blocks_hidden", "of those that were hit, those of which nothing can be seen: no tile of them was tested"},
    {"tiles_tested", "tests of tiles"},
    {"tiles_entered", "of these, those that were hit and pushed"},
    {"tiles_hidden", "of the tiles that were hit, those of which nothing can be seen: not pushed"},
    {"tiles_masked", "of the tiles that were pushed, those whose rows coverage left out: nothing of them can be seen"},
    {"rows_tested", "rows of tiles that coverage tested"},
    {"stamps", "of these, those with a covered pixel"},
    {"pixels_lane0", "covered pixels of lane 0"},
    {"pixels_lane1", "of lane 1"},
    {"pixels_lane2", "of lane 2"},
    {"pixels_lane3", "of lane 3"},
    {"pixels_plane", "of all lanes, those of such quads"},
    {"fragments", "pixels that were not discarded"},
    {"products_vertex_products", "multiplications of setup and tile contexts"},
    {"products_sqrt", "of the roots"},
    {"products_mean_value_ratios", "of the ratios"},
    {"products_mean_value_weights", "of the weights"},
    {"products_interpolate", "of the sums"},
    {"products_reciprocal", "of the reciprocals"},
    {"products_fragment_output", "of the quotients"},
    {"bound_pixels", "clocks in which emission took from the head stamp, or an end entry"},
    {"bound_output", "in which the head stamp waited for places of the fragment FIFO"},
    {"bound_stamps", "bound by coverage"},
    {"bound_walk", "by walk and tile contexts"},
    {"bound_setup", "by setup, or by quad slots"},
    {"bound_vertices", "by vertices that are not here yet"},
    {"bound_wipe", "by the wiping of what is hidden, behind reset and clears"},
    {"bound_drain", "in which only the pipeline and what is between units held anything"},
    {"bound_idle", "in which the machine was not busy"},
}};

namespace {

std::uint64_t sum(const PerformanceCounters& counters, PerformanceCounter first, PerformanceCounter last) {
  const auto begin = counters.value.begin();
  return std::accumulate(begin + static_cast<std::ptrdiff_t>(first), begin + static_cast<std::ptrdiff_t>(last) + 1,
                         std::uint64_t{0});
}

}  // namespace

std::uint64_t PerformanceCounters::pixels() const {
  return sum(*this, PerformanceCounter::pixels_lane0, PerformanceCounter::pixels_lane3);
}
std::uint64_t PerformanceCounters::products() const {
  return sum(*this, PerformanceCounter::products_vertex_products, PerformanceCounter::products_fragment_output);
}
std::uint64_t PerformanceCounters::quads_left_out() const {
  return sum(*this, PerformanceCounter::quads_empty, PerformanceCounter::quads_culled);
}

UnitProducts::UnitProducts(const Config& c)
    : vertex_products(4 * c.product_pairs()),      // two dot units of two products each
      sqrt(4 * c.sqrt_degree),                     // four roots
      mean_value_ratios(6),                        // r·r' of the pairs
      weight_ratios(3 * (2 + c.sqrt_degree + 1)),  // z, w', root and v·s of three ratios
      weight_factors(4 * 2),                       // x·y·z of four weights
      reciprocal(c.recip_degree) {}

WantedSums::WantedSums(const Config& c, const DrawState& state, bool hull) {
  const bool held = (state.skip & skip_operands) != 0;
  const int attributes = held ? state.attributes : c.attribute_slots;
  const int k = !held || attributes > 0, w = !held || state.depth || hull, z = !held || state.depth;
  terms = 4 * (k + w + z) + 3 * attributes;
  denominators = k + w;
  quotients = attributes + z;
}

PerformanceCounter bound_of(const BoundInputs& in) {
  if (in.head) return in.head_waits ? PerformanceCounter::bound_output : PerformanceCounter::bound_pixels;
  if (in.rows && in.rows_behind) return PerformanceCounter::bound_stamps;
  if (in.walk_behind) return PerformanceCounter::bound_walk;
  if (in.setup_behind) return PerformanceCounter::bound_setup;
  if (in.rows) return PerformanceCounter::bound_stamps;
  if (in.walk) return PerformanceCounter::bound_walk;
  if (in.setup) return PerformanceCounter::bound_setup;
  if (in.assembly) return PerformanceCounter::bound_vertices;
  if (in.wipe) return PerformanceCounter::bound_wipe;
  return in.busy ? PerformanceCounter::bound_drain : PerformanceCounter::bound_idle;
}

}  // namespace quadrille
