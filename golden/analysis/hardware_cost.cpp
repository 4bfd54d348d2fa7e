#include "golden/analysis/hardware_cost.hpp"

#include "golden/analysis/cost_parts.hpp"

#include <iterator>

namespace quadrille {

HardwareCost& HardwareCost::operator+=(const HardwareCost& other) {
  for (const auto field : cost::fields) this->*field += other.*field;
  return *this;
}

namespace cost {
namespace {

// ---- What is there by a key

/// Codes of depth and where they are kept: hierarchical_z_bits, hierarchical_z_tiles_log2.
struct HiddenWidths {
  explicit HiddenWidths(const Config& c)
      : H(c.hierarchical_z_bits),
        PLACE(c.hierarchical_z_tiles_log2),
        EPOCH(PLACE - section_log2),
        TAG(std::max(c.tc_bits() - 1 - (PLACE - PLACE / 2), 1) + std::max(c.tc_bits() - 1 - PLACE / 2, 1)) {}

  static constexpr int section_log2 = 4;  ///< places that a clear wipes
  int H, PLACE, EPOCH, TAG;
};

HardwareCost depth_interval(const Widths& w, const HiddenWidths& h) {
  // Codes not below 0; the farthest rounded up; of each what is left against the last code.
  return state(2 * h.H + 1) + adder(w.DB + 2) + 2 * (adder(h.H + 2) + mux(h.H, 2)) + 2 * zero_test(3);
}

/// Blocks of tiles, in the unit of hierarchical_z.
HardwareCost hidden_blocks(const Widths& w, const Config& c, const HiddenWidths& h) {
  constexpr int edge = 3, tiles = 64, banks = 4;
  const int row = std::max(h.PLACE / 2 - edge, 2), column = std::max(h.PLACE - h.PLACE / 2 - edge, 2);
  const int coordinate = c.tc_bits() - 1 - edge;
  const int tag = std::max(coordinate - row, 1) + std::max(coordinate - column, 1);
  const int places = row + column, bound = tag + h.EPOCH + h.H, word = bound + h.H + tiles;
  const int known = 2 * (tag + h.EPOCH);
  // The block under test.
  HardwareCost cost =
      banks * (memory(bound, 1 << (places - 2), 1) + state(bound + tag + 1) + zero_test(known) + adder(h.H));
  cost += 2 * (adder(w.TC) + adder(edge + 1) + adder(coordinate));
  // The tile, and its block's word: known or not, those of the two tiles before, the tile in the mask, a mask of all.
  const int held = 2 * h.H + tiles;
  cost += 1 << places > 32 ? block_memory(word, 1 << places) : memory(word, 1 << places, 1) + state(word);
  cost += state(4 + 3 * places + 2 * tag + 2 * 2 * edge + h.H + 2 * held);
  cost += 2 * zero_test(2 * places) + 5 * mux(held, 2) + zero_test(known) + 2 * adder(h.H) + 2 * mux(h.H, 2);
  return cost + tiles * adder(1) + 2 * zero_test(tiles) + mux(2 * places, 2);
}

HardwareCost hierarchical_z(const Widths& w, const Config& c, const HiddenWidths& h) {
  const int interval = 2 * h.H + 1, word = h.TAG + h.EPOCH + h.H;
  HardwareCost cost = memory(interval, 1 << w.SLOT, 1) + memory(word, 1 << h.PLACE, 1);
  cost += state(word + 1 + w.SLOT + interval + 2 * w.TC + h.PLACE + h.TAG + 1 + 2 + h.PLACE + h.EPOCH);
  // The tile; whether it is inside the scissor; the test; what is written.
  cost += 2 * adder(w.TC) + 4 * adder(w.V + 1) + zero_test(2 * (h.TAG + h.EPOCH)) + 2 * adder(h.H);
  cost += mux(h.PLACE, 2) + mux(h.H, 2) + adder(h.PLACE + 2 * h.EPOCH) + mux(h.PLACE, 2);
  return cost + hidden_blocks(w, c, h) + control(210);
}

HardwareCost masked_depth(const Widths& w, const HiddenWidths& h) {
  constexpr int low = 3;
  const int interval = 2 * h.H + 1, tagged = h.PLACE + h.TAG + 2 * h.H + w.TL + 3;
  HardwareCost cost = memory(interval, 1 << w.SLOT, 1) + state(1 + w.SLOT) +
                      block_memory(h.TAG + h.EPOCH + 2 * h.H, 1 << h.PLACE) +
                      w.TILE * block_memory(w.TILE, 1 << h.PLACE);
  // The context register; the rows register; the way of a row; tiles that may still write.
  cost += state(h.PLACE + h.TAG + w.TL + 2 * h.H);
  cost += state(h.PLACE + h.TAG + w.TL + 5 + 2 * (h.H + 3) + 3 * h.H + w.TILE * w.TILE);
  cost += state(3 * tagged + 10 + 3 * w.TILE + 4) + state(5 * 2 * low + 5);
  // What is known of the tile and what the quad makes of it; its row of the mask, and the rows behind the last one.
  cost += zero_test(2 * (h.TAG + h.EPOCH)) + 4 * adder(h.H) + 3 * adder(h.H + 3) + mux(h.H, 2);
  cost += mux(w.TILE, w.TILE) + w.TILE * (zero_test(w.TILE) + adder(1));
  cost += 3 * adder(w.TILE) + 3 * zero_test(w.TILE) + w.TILE * adder(2) + mux(2 * h.H, 2) + mux(h.PLACE, 2);
  return cost + 5 * zero_test(4 * low) + control(200);
}

HardwareCost plane_quad(const Widths& w) {
  // Two words are the same: five quarters of a LUT a bit, as synthesised.
  const auto same = [](int width) { return adder(width + width / 4); };
  const int values = 2 + w.N;
  // An attribute is 0 at vertex 0.
  return 4 * adder(w.T + 1) + 2 * same(w.T + 1) + 2 * 4 * same(w.WORD) +
         w.N * (2 * same(w.WORD) + 2 * zero_test(w.WORD)) + state(values + 2);
}

HardwareCost performance_counters(const Widths& w) {
  // Of lanes that are not there nothing is counted.
  const int counters = 37 + w.P;
  constexpr int bits = 32;
  return counters * (state(bits) + adder(bits)) + mux(bits, counters) + state(12 * (3 + w.N) + 4 * w.P) +
         w.P * adder(9) + control(900);
}

}  // namespace
}  // namespace cost

std::vector<ModuleCost> module_costs(const Config& config) {
  const cost::Widths w(config);
  std::vector<ModuleCost> modules = cost::front_modules(w);
  std::ranges::copy(cost::pixel_modules(w, config), std::back_inserter(modules));
  if (config.hierarchical_z_bits != 0) {
    const cost::HiddenWidths h(config);
    modules.push_back({"depth_interval", cost::depth_interval(w, h)});
    modules.push_back({"hierarchical_z", cost::hierarchical_z(w, config, h)});
    modules.push_back({"masked_depth", cost::masked_depth(w, h)});
  }
  if (config.plane_quads != 0) modules.push_back({"plane_quad", cost::plane_quad(w)});
  if (config.performance_counters != 0) modules.push_back({"performance_counters", cost::performance_counters(w)});
  return modules;
}

HardwareCost hardware_cost(const Config& config) {
  HardwareCost sum;
  for (const ModuleCost& module : module_costs(config)) sum += module.cost;
  return sum;
}

double lut_cost(const HardwareCost& cost, const CostWeights& weights) {
  return weights.state * static_cast<double>(cost.state_bits) +
         weights.multiplier * static_cast<double>(cost.multiplier_bits) +
         weights.adder * static_cast<double>(cost.adder_bits) + weights.table * static_cast<double>(cost.table_bits) +
         weights.join * static_cast<double>(cost.join_bits);
}

double scalar_cost(const HardwareCost& cost, const CostWeights& weights) {
  return lut_cost(cost, weights) + weights.dsp * static_cast<double>(cost.dsps) +
         weights.block_ram * static_cast<double>(cost.block_rams);
}

}  // namespace quadrille
