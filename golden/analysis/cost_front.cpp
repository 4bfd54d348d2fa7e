// The front: from vertices to the pixels of a clock.
#include "golden/analysis/cost_parts.hpp"

namespace quadrille::cost {
namespace {

/// The corners' codes against znear and zfar; the narrower of both intervals; no w above 0 so far.
HardwareCost quad_reject(const Widths& w) {
  return state(1 + w.LIMITS) + 4 * adder(w.DB + 2) + 2 * mux(w.DB + 1, 2) + zero_test(w.W);
}

/// Of one axis: a vertex before, behind, on a pixel's centre, in the same pixel as those before it.
HardwareCost range_empty(const Widths& w) {
  const int whole = w.T - w.FRAC;
  return state(4) + 3 * adder(whole) + adder(w.V + 1) + zero_test(w.FRAC) + zero_test(2 * whole);
}

HardwareCost vertex_assembly(const Widths& w) {
  // The vertices; whether all are ordinary; least and greatest coordinates; W as a significand number beside W.
  const int vertex = 2 * w.T + w.W + (w.PE + w.S) + w.WORD;
  // Of the quad: bases, two codes; attributes of three vertices.
  const int quad = w.ID + w.N * w.AO + w.DB + 1 + 2 * (w.DB + 2) + 3 * w.N * w.WORD;
  // Of W's exponent, -FRAC to 0, and its significand the bits that may differ from another.
  const int w_number = 1 + stages_of(w.FRAC + 1) + 1 + std::min(w.S, w.W - 1);
  // Held twice: by assembly, and while the quad waits for setup, with its depth limits and whether it is empty.
  const int held = quad + 4 * (vertex + w_number) + 1 + 4 * w.T;
  return state(held + 3 + held + w.LIMITS + 2) + 4 * adder(w.T) + zero_test(w.W) + adder(w.W) + mux(w.W, 2) +
         fp_normalise(w, w.W, w.PE, false) + quad_reject(w) + 2 * range_empty(w) + control(30);
}

HardwareCost bounding_range(const Widths& w) {
  const int whole = w.T - w.FRAC;
  return state(2 * whole) + adder(w.T) + 3 * adder(whole) + 4 * mux(whole, 2) + 2 * adder(w.TC);
}

HardwareCost quad_setup(const Widths& w, int clocks) {
  // Bounding box, control; of the quads that do their steps, that wait for results to come, whose results come and that
  // wait to be taken the slot, tile rectangle and vertices relative to the origin.
  const int place = w.SLOT + 4 * w.TC + w.TL + 1 + 4 * (2 * w.T + w.W);
  HardwareCost cost = 2 * bounding_range(w) + state(2 + 4 * w.TC + w.TL + 5 + 6 + 4 * place) + 8 * adder(w.T);
  // Jobs under way, and a quad's end.
  cost += state(clocks * 8 + clocks + w.PAIRS - 1 + 4);
  // Of a determinant one of four edge functions; differences of coordinates wait for an ordinary quad's gradients;
  // reach and tie signs of an edge.
  HardwareCost pair = one_of_four(w.VAL + 2 * w.GRAD) + state((clocks - 1) * 2 * (w.T + 1)) + 2 * mux(w.GRAD, 2);
  pair += state(2 * w.GRAD) + 4 * mux(w.GRAD, 2) + 2 * adder(w.GRAD + 1) + 4 * adder(w.REACH) + 2 * zero_test(w.GRAD);
  // The determinants accumulate both results one after the other; signs of those before are kept.
  pair += state(w.DET + 2 * (4 / w.PAIRS - 1)) + 2 * adder(w.DET) + mux(w.DET, 2) + zero_test(w.DET);
  // Left out by its triangles' areas, which add up as values come, or by the determinants' signs.
  const int area = w.VAL + 2;
  cost += 4 * adder(area) + 2 * zero_test(area) + state(2 * area + 4 + 1) + control(200);
  // The functions as they come, and of the quad that waits to be taken; steps.
  return cost + w.PAIRS * pair + 2 * (6 * state(w.VAL + w.LENGTH2 + 2 * w.GRAD) + 5 * state(4 * w.REACH + 2)) +
         state(5) + control(130);
}

HardwareCost dot_unit(const Widths& w) {
  // Two products of three multipliers each, by halves: operands, products of the halves and the halves' sums, the
  // sums' product, the whole. One factor of a product is a coordinate.
  constexpr int operand = 33, low = 16, high = operand - low, sum = high + 1, out = 2 * operand + 1;
  const int upper = std::clamp(w.T - low, 1, high);
  HardwareCost product = state(upper + high + 2 * low + 2 * high + 2 * low + 2 * sum + 2 * sum + (2 * high + 2 * low) +
                               2 * sum - 1 + 2 * operand);
  // Logic has no product of bits that are only sign.
  HardwareCost upper_halves = multiplier(high, high);
  upper_halves.multiplier_bits = u(upper) * u(std::clamp(std::max(w.T, w.VAL) - low, 1, high));
  product += multiplier(low, low) + multiplier(sum, sum) + upper_halves;
  product += 2 * adder(sum) + 2 * adder(2 * sum) + adder(2 * operand - low);
  return 2 * product + state(4 + out) + 2 * adder(out) + mux(out, 2);
}

HardwareCost vertex_products(const Widths& w) {
  constexpr int operand = 33;
  // A pair of units: its job's vertices, and how far they are apart.
  HardwareCost pair = 2 * one_of_four(2 * w.T + w.W) + 2 * adder(w.T + 1);
  pair += state(3 + 4 * w.T + 2 * w.W + w.VAL + 2 * w.GRAD);
  // The eight operands have 39 choices in all, by the eight kinds of job; some are no wider than a coordinate.
  pair += 31 * mux(std::min(operand, w.T), 2) + 2 * dot_unit(w);
  return mux(4 * (2 * w.T + w.W), 2) + w.PAIRS * pair;  // one of two users
}

HardwareCost tile_walk(const Widths& w) {
  constexpr int block = Widths::block_log2;
  HardwareCost cost = state(3 + 1 + 18 * w.TC + 4 + 5 * block + 3 * w.SLOT + 2 * w.TL + 4 + 2 + 3 + 10 + 2) +
                      14 * adder(w.TC) + 10 * mux(w.TC, 2) + control(45);
  // A step of a linear function: gx or gy, by a tile or a block, to the left or the right, added to the tile's value,
  // which may also be that of a block, of the walked block's first tile, or a new quad's.
  cost += 6 * (state(2 * w.GRAD + 4 * w.VAL) + mux(w.GRAD, 2) + mux(w.GRAD + block, 2) + adder(w.VAL) + mux(w.VAL, 2) +
               mux(w.VAL, 4));
  // Extremes of an edge function over the extent.
  return cost + 5 * (state(4 * w.REACH) + 2 * (mux(w.REACH, 2) + adder(w.VAL)));
}

HardwareCost tile_context(const Widths& w, int clocks) {
  HardwareCost cost = state(3 + 6 + 2 * w.TC + w.RING + 1 + 2 * 4 * (2 * w.T + w.W) + clocks * (10 + w.RING));
  // Vertices, moved to the tile or by the products; of a shifted offset the low bits are zero.
  cost += 8 * (adder(w.T - w.FRAC - w.TL) + mux(w.T, 2));
  // Gradients, of squares a clock after the job; q; a value's bus.
  return cost + w.PAIRS * (4 * (adder(w.GRAD) + mux(w.GRAD, 2)) + mux(w.QCURV, 2) + mux(w.QVAL, 2)) +
         adder(w.T - w.FRAC) + 6 * adder(4 + w.RING) + control(85);
}

HardwareCost tile_ring(const Widths& w) {
  const int words = 1 << w.RING, tag = 2 + w.SLOT + 2 * w.TC, word = w.QVAL + 2 * w.QGRAD + w.QCURV;
  HardwareCost cost = state(3 * (w.RING + 1) + 2 * w.RING) + 5 * adder(w.RING + 1);
  cost += memory(tag, words, 2) + state(tag + 2 * (tag - 2)) + memory(w.TL, words, 1) + state(w.TL);
  cost += 5 * memory(w.VAL, words, 2) + memory(w.VAL, words, 1) + state(11 * w.VAL);
  for (const int width : {w.QVAL, w.QGRAD, w.QGRAD, w.QCURV}) cost += 4 * memory(width, words, 1);
  return cost + state(4 * word);
}

HardwareCost quad_slots(const Widths& w) {
  const int words = 1 << w.SLOT;
  // Terms for the sums; k_eff, chosen at the start, for the weights' products and the overrides too.
  HardwareCost cost = block_memory((2 * 4 + 3 * w.N) * w.WORD, words) + 4 * (memory(w.WORD, words, 3) + state(w.WORD)) +
                      4 * mux(w.WORD, 2);
  // Bases and limits, for the output.
  cost += block_memory(w.N * w.AO + w.DB + 1 + w.LIMITS, words);
  // Gradients for emission and, of the five edges, for coverage; what ends in registers here.
  cost += 10 * memory(w.GRAD, words, 2) + 2 * memory(w.GRAD, words, 1) + state(22 * w.GRAD);
  cost += block_memory(6 * w.LENGTH2, words) + memory(14, words, 1) + state(14) + memory(2, words, 1) +
          memory(w.ID, words, 1);
  // The next slot, those of end beats on their way; a bit for each slot that is in use, set and cleared by its number.
  return cost + state(3 * w.SLOT) + adder(w.SLOT) + state(words) + mux(words, 4) + zero_test(2 * words) + control(150);
}

HardwareCost stamp_coverage(const Widths& w) {
  const int multiple = w.GRAD + w.TL, close = std::min(multiple + 2, w.VAL), places = (1 << w.FIFO) + 4;
  const int room = stages_of(places + 1);
  // Pointers, valid bits, tags, the row; three registers of a row on its way.
  HardwareCost cost = state(3 * (w.RING + 1) + 4 + room + 2 * (2 + 2 * w.TC) + 14 + 3 * w.TL) + 3 * adder(w.RING + 1);
  cost += state(3 + 3 * (w.RING + 1) + 6 + 3 * w.TL + 2 * 14 + 3 * w.TILE) + adder(2 * room) + adder(w.TL);
  // Of each edge function the row's value; the odd multiples of gx; a sum, its sign and whether it is zero a pixel.
  HardwareCost edge = state(w.VAL + w.GRAD + 2 + w.TILE / 2 * multiple + w.TILE * close + 2 * w.TILE);
  edge += adder(w.VAL) + mux(w.VAL, 2) + zero_test(2 * (w.VAL - close + 2));
  edge += (w.TILE / 2 - 1) * adder(multiple) + w.TILE * (zero_test(close) + mux(1, 2));
  for (int dx = 1; dx < w.TILE; ++dx) edge += adder(close - std::countr_zero(static_cast<unsigned>(dx)));
  // Scissor; clauses, about three gates an edge function.
  return cost + 5 * edge + w.TILE * adder(5 * 4 + 8) + state(5 + w.TILE) + 2 * adder(w.V + 1) + 4 * adder(w.TC) +
         w.TILE * adder(w.TL) + control(60);
}

HardwareCost sync_fifo(const Widths& w) {
  const int stamp = 2 + w.RING + 1 + w.TL + 3 * w.TILE, places = (1 << w.FIFO) + 4;
  const int pointer = stages_of(places), count = stages_of(places + 1);
  return memory(stamp, 1 << pointer, 1) + state(stamp + 2 * pointer + count + 1) + 2 * adder(2 * pointer + count);
}

HardwareCost pixel_emit(const Widths& w) {
  // Free places, part; each lane has the lowest pixel that those below it leave, its column, front and tie.
  const int spare = fragment_places() + 2;
  const int digits = 2 * (w.TL / 2 + 1) - 2;  // of the row, in radix 4; the lowest is its two bits
  const HardwareCost lane = state(w.TL + 3) + adder(w.TILE) + (w.TL + 2) * zero_test(w.TILE) + mux(w.TILE, 2);
  return state(spare + w.TILE + 5 + w.RING + 1 + w.TL + digits) + adder(spare) + adder(digits) + mux(w.TILE, 2) +
         w.P * lane + state(2 * (3 + w.TL + digits + w.P * (w.TL + 3)));
}

}  // namespace

std::vector<ModuleCost> front_modules(const Widths& w) {
  constexpr int product_clocks = 6;  // from a job of vertex_products to its results
  return {
      {"vertex_assembly", vertex_assembly(w)},
      {"quad_setup", quad_setup(w, product_clocks)},
      {"vertex_products", vertex_products(w)},
      {"quad_slots", quad_slots(w)},
      {"tile_walk", tile_walk(w)},
      {"tile_context", tile_context(w, product_clocks)},
      {"tile_ring", tile_ring(w)},
      {"stamp_coverage", stamp_coverage(w)},
      {"sync_fifo", sync_fifo(w)},
      {"pixel_emit", pixel_emit(w)},
  };
}

}  // namespace quadrille::cost
