#include "golden/analysis/hardware_cost.hpp"

#include "model/port/latency.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

namespace quadrille {

namespace {

constexpr std::array fields{
    &HardwareCost::state_bits, &HardwareCost::multiplier_bits, &HardwareCost::adder_bits,  &HardwareCost::table_bits,
    &HardwareCost::dsps,       &HardwareCost::join_bits,       &HardwareCost::memory_bits, &HardwareCost::block_rams};

}  // namespace

HardwareCost& HardwareCost::operator+=(const HardwareCost& other) {
  for (const auto field : fields) this->*field += other.*field;
  return *this;
}

namespace {

using Bits = std::uint64_t;

Bits u(int width) { return static_cast<Bits>(width); }

HardwareCost operator+(HardwareCost a, const HardwareCost& b) { return a += b; }

HardwareCost operator*(int instances, HardwareCost cost) {
  for (const auto field : fields) cost.*field *= u(instances);
  return cost;
}

// ---- What the counts are made of

HardwareCost state(int bits) { return {.state_bits = u(bits)}; }
/// One partial product bit for each pair of operand bits; blocks of 18 × 18, which factors of one bit do not take.
HardwareCost multiplier(int a, int b) {
  constexpr int block = 18;
  const int rows = (a + block - 1) / block, columns = (b + block - 1) / block;
  if (a < 2 || b < 2) return {.multiplier_bits = u(a) * u(b)};
  // The blocks of a row add up to a product by 18 bits of a, the rows to the whole; the lowest 18 bits pass each sum
  // by.
  return {.multiplier_bits = u(a) * u(b),
          .dsps = u(rows) * u(columns),
          .join_bits = u(rows) * u(columns - 1) * u(b) + u(rows - 1) * u(a + b - block)};
}
/// Adder, subtracter, negation, comparison by magnitude: a bit of a carry chain.
HardwareCost adder(int width) { return {.adder_bits = u(width)}; }
/// `choices` to one, the first that holds: a two-to-one multiplexer a bit for each choice but the first. An enable, or
/// a zero instead, is the register's.
HardwareCost mux(int width, int choices) { return {.adder_bits = u(width) * u(choices - 1)}; }
/// By a number of two bits: two LUTs of four inputs a bit.
HardwareCost one_of_four(int width) { return mux(width, 3); }
/// Block RAMs of 18 Kbit for words of `width` bits: of 512 words of 36 bits to 16 K of one, side by side and one behind
/// the other, those of which the fewest are needed.
int blocks_of(int width, int words) {
  constexpr int widths[] = {36, 18, 9, 4, 2, 1};
  int fewest = std::numeric_limits<int>::max(), depth = 512;
  for (const int wide : widths) {
    fewest = std::min(fewest, (words + depth - 1) / depth * ((width + wide - 1) / wide));
    depth *= 2;
  }
  return fewest;
}
/// Words of `width` bits. Up to 32 of them are in small RAMs of 16 words, six LUTs for four bits, with a copy for each
/// read port, or in registers where those are fewer than the LUTs that hold bits; more words (which have one port) are
/// in block RAM, where a word written and read in one clock goes around it.
HardwareCost memory(int width, int words, int ports) {
  HardwareCost cost{.state_bits = u(width * words), .memory_bits = u(width * words)};
  if (words > 32) {
    cost.block_rams = u(blocks_of(width, words));
    return cost + state(width + 1) + mux(width, 2);
  }
  const int blocks = (words + 15) / 16;
  if (width * words <= ports * blocks * 4 * ((width + 3) / 4)) return state(width * words) + ports * mux(width, words);
  return cost + ports * (blocks * adder(6 * ((width + 3) / 4)) + mux(width, blocks));
}
/// Words of `width` bits in block RAM by demand, with the register in which a read ends.
HardwareCost block_memory(int width, int words) {
  const Bits bits = u(width * (words + 1));
  return {.state_bits = bits, .memory_bits = bits, .block_rams = u(blocks_of(width, words))};
}
/// Test for zero or equality with a constant: a tree of wide gates, about a third of a comparison.
HardwareCost zero_test(int width) { return {.adder_bits = u((width + 2) / 3)}; }

/// Counters, decoding and handshakes that no width changes, in LUTs as synthesised.
HardwareCost control(int luts) { return {.adder_bits = u(luts)}; }

int stages_of(int width) { return std::bit_width(static_cast<unsigned>(width - 1)); }

/// Shifter to the right by up to width - 1. A stage chooses between the bits that it has both of; above them zeros come
/// in, half a LUT for each bit that any stage clears.
HardwareCost shifter(int width) {
  HardwareCost cost = adder(width / 2);
  for (int stage = 0; stage < stages_of(width); ++stage) cost += mux(width - (1 << stage), 2);
  return cost;
}

/// Highest one to the top by halving, levels first down to last, `kept` bits used behind them: a level tests 2^level
/// bits and makes those that the shorter shifts after it can still bring among the kept ones.
HardwareCost shift_to_top(int width, int kept, int first, int last) {
  HardwareCost cost;
  for (int level = first; level >= last; --level)
    cost += zero_test(1 << level) + mux(std::min(width, kept + (1 << level) - (1 << last)), 2);
  return cost;
}

/// Factor times an unsigned number of few bits: a selection for each digit in radix 4, an adder for each but the first.
HardwareCost small_multiply(int factor, int number) {
  HardwareCost cost;
  for (int digit = 0; digit <= number / 2; ++digit) {
    const int bits = factor + number - 2 * digit;
    cost += mux(bits, 2);
    if (digit > 0) cost += adder(bits);
  }
  return cost;
}

// ---- Modules that others instantiate

/// The widths that formulas use, under their names in rtl/quadrille_pkg.sv.
struct Widths {
  explicit Widths(const Config& c)
      : S(c.significand_bits),
        E(Config::exp_bits),
        PE(Config::port_exp_bits),
        N(c.attribute_slots),
        V(c.viewport_bits),
        T(c.t_bits()),
        W(c.w_bits()),
        VAL(c.val_bits()),
        GRAD(c.grad_bits()),
        CURV(c.curv_bits()),
        QVAL(c.qval_bits()),
        QGRAD(c.qgrad_bits()),
        QCURV(c.qcurv_bits()),
        LENGTH2(c.length2_bits()),
        TC(c.tc_bits()),
        SLOT(c.quad_slots_log2),
        RING(c.ring_log2()),
        FIFO(c.stamp_fifo_log2),
        TL(c.tile_log2),
        TILE(c.tile()),
        ID(c.quad_id_bits),
        DB(c.depth_bits),
        P(c.pixels_per_clock),
        PAIRS(c.dot_units / 2),
        FRAC(c.frac()),
        AO(c.attr_out_bits()),
        LIMITS(3 + 2 * (c.depth_bits + 1)),
        NUMBER(E + S),
        WORD(1 + PE + S),
        RANK(E + 1),
        TERM(c.prec_bits() + 2),
        DET(T + GRAD + 4),
        REACH(GRAD + 1 + TL + block_log2),
        FRAGMENT(ID + 2 * V + 1 + 8 + DB + 1 + N * AO) {}

  static constexpr int block_log2 = 3;  ///< a block is 8 × 8 tiles

  int S, E, PE, N, V, T, W, VAL, GRAD, CURV, QVAL, QGRAD, QCURV, LENGTH2, TC, SLOT, RING, FIFO, TL, TILE, ID, DB, P,
      PAIRS, FRAC, AO, LIMITS;
  int NUMBER;  ///< exponent and significand
  int WORD;    ///< sign, port exponent, significand
  int RANK;    ///< exponent in the order of unsigned numbers
  int TERM;    ///< one aligned term of a sum: a product has two integer bits
  int DET;
  int REACH;  ///< of an edge function over a block
  int FRAGMENT;
};

/// Two stages, which share the levels of shift_to_top, with `exp` bits of exponent that differ from one another.
HardwareCost fp_normalise(const Widths& w, int width, int exp, bool registered = true) {
  constexpr int split = 3;
  const int kept = w.S + (1 << split) - 1, wide = std::max(width, kept), count = stages_of(wide);
  HardwareCost cost = shift_to_top(wide, kept, count - 1, split) + shift_to_top(kept, w.S, split - 1, 0) + adder(exp);
  if (registered) cost += state(kept + count - split + (exp == w.E ? w.E : 0)) + state(exp + w.S);
  return cost;
}

/// Exponent's sum and the product's carry into it; the product is taken one bit higher or lower.
HardwareCost fp_multiply(const Widths& w) {
  return state(w.NUMBER) + multiplier(w.S, w.S) + adder(w.E) + mux(w.S, 2) + zero_test(2 * w.S);
}

HardwareCost fp_raw_product(const Widths& w) { return state(1 + w.E + 2 * w.S) + multiplier(w.S, w.S) + adder(w.E); }

/// Sum of exponents, gated by the factors' top bits, and the product's upper bits.
HardwareCost fp_term(const Widths& w) { return state(w.TERM) + multiplier(w.S, w.S) + adder(2 * w.E); }

/// fp_multiply with the rank; the upper bits for a sum are registers beside.
HardwareCost fp_product(const Widths& w) { return fp_multiply(w) + adder(w.E); }

HardwareCost fp_sum(const Widths& w, int terms, bool with_sign) {
  // The last of three terms is a pair alone.
  const int pairs = (terms + 1) / 2, whole = terms / 2, magnitude = w.TERM + stages_of(terms), sum = magnitude + 1;
  // The higher rank of each pair, then the highest; distances to it.
  HardwareCost cost = state((terms + pairs) * w.RANK) + (terms - 1) * (adder(w.RANK) + mux(w.RANK, 2));
  cost += terms * (state(w.E + w.TERM + 1) + adder(w.E)) + state(w.E);
  // Far terms by the registers' reset.
  cost += terms * (state(w.TERM) + shifter(w.TERM) + zero_test(w.E - stages_of(w.TERM)));
  cost += state(whole + (pairs - 1) + 1 + w.E);
  // The others are added in the sign of the first.
  cost += whole * (adder(w.TERM + 2) + mux(w.TERM, 2)) + (pairs - 1) * (adder(sum) + mux(w.TERM + 2, 2));
  cost += state(sum + 1 + w.E) + adder(sum) + mux(magnitude, 2) + state((with_sign ? 1 : 0) + magnitude + w.E);
  cost += adder(w.E);  // less the fraction bits
  if (with_sign) cost += zero_test(magnitude) + state(2);
  return cost + fp_normalise(w, magnitude, w.E);
}

HardwareCost fp_add(const Widths& w) {
  // Both differences of the ranks, of which one is the distance; the larger first.
  HardwareCost cost = 2 * adder(w.RANK + 1) + 2 * mux(w.TERM, 2) + 2 * mux(w.E, 2) + state(2 * w.TERM + 2 * w.E);
  cost += shifter(w.TERM) + zero_test(w.E - stages_of(w.TERM)) + state(2 * w.TERM + w.E);
  return cost + adder(w.TERM + 1) + mux(w.S, 3) + adder(w.E) + state(w.NUMBER);
}

/// A table: its words {C0, C1, C2} without the bits that are the same in all of them, and where it is.
struct Table {
  int c0, c1, c2, entries_log2;

  int columns() const { return c0 + c1 + c2; }
  int blocks() const { return blocks_of(columns(), 1 << entries_log2); }
  /// As Yosys decides: a block RAM is worth 2,048 bits in logic.
  bool in_block_ram() const { return columns() << entries_log2 > 2048 * blocks(); }
};

/// C1 and C2 are the slope and half the bend of a function times 2^-K and 2^-2K, K log2 of the segments. Degree 1 has
/// no C2.
Table sqrt_table(const Config& c) {
  const int s = c.significand_bits, k = c.sqrt_segments();
  return {s + 2, s - k + 2, c.sqrt_degree == 2 ? std::max(s - 2 * k, 0) : 0, k + 1};
}
Table reciprocal_table(const Config& c) {
  const int s = c.significand_bits, k = c.recip_segments();
  return {s + 4, s - k + 3, c.recip_degree == 2 ? std::max(s - 2 * k + 3, 0) : 0, k};
}

HardwareCost table_polynomial(const Widths& w, const Table& table, int segments_log2) {
  const int rest = std::max(w.S - 1 - segments_log2, 1), accumulator = w.S + 4;
  // The word and dx; inner factor (C1 alone for degree 1), C0 and dx; outer product; clamp. A block RAM has the word's
  // register.
  HardwareCost cost =
      state(rest) + state(table.c1 + table.c0 + rest) + state(accumulator) + adder(accumulator) + mux(w.S, 2);
  if (table.in_block_ram()) {
    cost.block_rams += u(table.blocks());
  } else {
    cost.table_bits += u(table.columns() << table.entries_log2);
    cost += state(table.columns());
  }
  if (table.c2 > 0) cost += adder(table.c1);
  // Blocks are made for the factors as they are declared, before constant bits are seen: two products even for
  // degree 1.
  HardwareCost products = 2 * multiplier(w.S, rest);
  products.multiplier_bits = u(table.c1 * rest) + u(table.c2 * rest);
  if (table.c2 == 0) products.join_bits /= 2;
  return cost + products;
}

HardwareCost fixed_point(const Widths& w, int integer_bits, int fraction_bits) {
  const int out = integer_bits + fraction_bits, kept = std::min(2 * w.S, out);
  return mux(kept, 2) + adder(w.E + 1) + state(w.E + 1 + kept + 1) + shifter(out) +
         zero_test(w.E + 1 - stages_of(out)) + state(1 + out);
}

// ---- The front

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
  return state(quad + 4 * (vertex + w_number) + 3 + 1 + 4 * w.T) + 4 * adder(w.T) + zero_test(w.W) + adder(w.W) +
         mux(w.W, 2) + fp_normalise(w, w.W, w.PE, false) + quad_reject(w) + 2 * range_empty(w) + control(30);
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

/// Places of the fragment FIFO, log2.
int fragment_places() { return stages_of(latency::pipeline + 7); }

HardwareCost pixel_emit(const Widths& w) {
  // Free places, part; each lane has the lowest pixel that those below it leave, its column, front and tie.
  const int spare = fragment_places() + 2;
  const int digits = 2 * (w.TL / 2 + 1) - 2;  // of the row, in radix 4; the lowest is its two bits
  const HardwareCost lane = state(w.TL + 3) + adder(w.TILE) + (w.TL + 2) * zero_test(w.TILE) + mux(w.TILE, 2);
  return state(spare + w.TILE + 5 + w.RING + 1 + w.TL + digits) + adder(spare) + adder(digits) + mux(w.TILE, 2) +
         w.P * lane + state(2 * (3 + w.TL + digits + w.P * (w.TL + 3)));
}

// ---- The pixel pipeline

/// What the pixels of a clock have in common.
HardwareCost pixel_pipeline(const Widths& w) {
  using namespace latency;
  constexpr int vertices = 4;
  // End bits; slot, tile column and row; what is read of the slots.
  const int tag = w.SLOT + w.V - w.TL + w.V;
  HardwareCost cost = state(pipeline + (pipeline - 1) * tag + tag - w.SLOT);
  cost += state(vertices * (2 * w.WORD - 1) + (3 * vertices + 3 * w.N) * w.WORD + w.ID + 2);
  cost += state(w.N * w.AO + w.DB + 1 + 2 * w.LIMITS);
  // Part, slot and squared lengths for the law of cosines.
  return cost + state(forward_difference_stages * (2 + w.SLOT) + 1 + 6 * w.LENGTH2) + control(140);
}

/// What a pixel has of its own, between the units.
HardwareCost pixel_lane(const Widths& w) {
  using namespace latency;
  // Valid bit; column, front and tie; from the norm boundary on what the fragment shows of the class; class and signs
  // of D for the weights.
  HardwareCost cost = state(pipeline + (norm_stage + 1) * (w.TL + 2) + (pipeline - 1 - norm_stage) * (w.TL + 2 + 5));
  cost += state((ratio_stage - norm_stage) * (9 + 6));
  // Digits of the column and of r² + dx²; D of the parts before; A and r² beside the law of cosines; numerators.
  cost += state(2 * (w.TL / 2 + 1) + 2 * (w.TL + 1)) + adder(4 * w.TL + w.TILE) + state(6 * w.QVAL);
  cost += state(law_of_cosines_stages * (6 * w.VAL + 4 * w.QVAL));
  return cost + state(reciprocal_stages * (1 + w.N) * (1 + w.NUMBER));
}

HardwareCost row_functions(const Widths& w) {
  const auto one = [&](int value, int gradient) {
    return state(value + gradient) + small_multiply(gradient, w.TL) + adder(value);
  };
  return 6 * one(w.VAL, w.GRAD) + 4 * (one(w.QVAL, w.QGRAD) + state(w.QCURV));
}

HardwareCost forward_difference_column(const Widths& w) {
  // A quadratic function has the bend q (r² + dx²) besides.
  const int norm = 2 * w.TL + 1;
  const auto one = [&](int value, int gradient) {
    return state(2 * value) + small_multiply(gradient, w.TL) + adder(value);
  };
  const HardwareCost bend = state(w.QCURV + norm + 1) + small_multiply(w.QCURV, norm) + adder(w.QVAL);
  return 6 * one(w.VAL, w.GRAD) + 4 * (one(w.QVAL, w.QGRAD) + bend);
}

HardwareCost law_of_cosines(const Widths& w) {
  return 6 * (2 * adder(w.QVAL + 1) + mux(w.QVAL, 2) + state(2 * w.QVAL + 1));
}

HardwareCost normalise(const Widths& w) {
  // The exponent of an integer is a small number. r² has no sign.
  const auto magnitude = [&](int width) { return fp_normalise(w, width, stages_of(std::max(width, w.S + 7)) + 1); };
  const auto with_sign = [&](int width) { return magnitude(width) + state(width + 3) + adder(width) + mux(width, 2); };
  return 6 * with_sign(w.VAL) + 6 * with_sign(w.QVAL) + 4 * (magnitude(w.QVAL) + state(w.QVAL - 1));
}

HardwareCost singular_class(const Widths& w) {
  return state(16 + 2 * 9) + 4 * (zero_test(w.VAL) + zero_test(w.QVAL)) + mux(30, 2);
}

HardwareCost fp_sqrt(const Widths& w, const Config& c) {
  // Half the exponent, and whether the number is zero, wait for the polynomial.
  return table_polynomial(w, sqrt_table(c), c.sqrt_segments()) +
         state(latency::sqrt_stages * (w.E - 1) + (latency::sqrt_stages - 1) + w.S) + zero_test(w.S);
}

HardwareCost reciprocal(const Widths& w, const Config& c) {
  return table_polynomial(w, reciprocal_table(c), c.recip_segments()) +
         state(latency::reciprocal_stages * (w.E + 1) + (latency::reciprocal_stages - 1) * 2 + w.S) + adder(w.E) +
         mux(w.E, 2) + zero_test(2 * w.S) + mux(w.S, 2);
}

HardwareCost mean_value_ratios(const Widths& w) {
  using namespace latency;
  // |D| waits for the product, v for u.
  const int waits = sqrt_stages + product_stages + ratio_stage - norm_stage;
  return 6 * (fp_term(w) + state(w.RANK) + state(waits * w.NUMBER) + fp_add(w));
}

HardwareCost root_ratio(const Widths& w, const Config& c) {
  // The root, v·s, what waits for them; numerator and denominator are one of three each.
  using namespace latency;
  const int waits = sqrt_stages + 2 * product_stages + sqrt_stages + product_stages;
  return fp_sqrt(w, c) + fp_multiply(w) + state(waits * w.NUMBER + 2 * (sqrt_stages + product_stages)) +
         2 * (mux(w.NUMBER, 3) + state(w.NUMBER));
}

HardwareCost mean_value_weights(const Widths& w, const Config& c) {
  using namespace latency;
  // r and the class wait for the denominators and the overrides.
  HardwareCost cost = state((n_stage - root_stage) * 4 * w.NUMBER + (n_stage - ratio_stage) * 7);
  cost += state((1 + product_stages) * 5 + fp_add_stages * 5);
  // Two edges' r and k; the operands of z and w of three ratios, or of those edges' products.
  cost += 4 * (one_of_four(w.NUMBER) + one_of_four(w.WORD)) + 8 * mux(w.NUMBER, 2) + 3 * mux(w.NUMBER, 3);
  cost += state(12 * w.NUMBER) + (1 + product_stages) * state(3 * w.NUMBER + 10);
  cost += 6 * fp_product(w) + 4 * state(w.TERM) + 3 * root_ratio(w, c) + 2 * fp_sum(w, 2, false);
  // Factors of M_i: the ratios', or r, N, k or one; their products.
  cost += 2 * one_of_four(w.PE + w.S);
  cost += 4 * (mux(w.NUMBER, 5) + mux(w.NUMBER, 3) + mux(w.NUMBER, 2) + adder(10) + state(3 * w.NUMBER));
  cost += 4 * (2 * fp_multiply(w) + state(w.NUMBER) + state((fp_add_stages - product_stages) * w.NUMBER));
  // The corner on both edges; which class and which operands hold.
  return cost + 2 * one_of_four(w.NUMBER) + fp_add(w) + 4 * (mux(w.NUMBER, 2) + state(w.NUMBER)) + control(125);
}

HardwareCost interpolate(const Widths& w) {
  // Attributes are counted from vertex 0's.
  const auto sum = [&](int terms) { return terms * fp_term(w) + state(terms) + fp_sum(w, terms, true); };
  return 3 * sum(4) + w.N * sum(3);
}

HardwareCost fragment_output(const Widths& w, const Config& c) {
  // Sums with the bases, in two's complement; their ends; slots not in use. Depth between the corners, which are its
  // ends. The output register, which is cleared when not valid.
  const int sum = w.AO + 2, z_sum = w.DB + 3;
  const HardwareCost attribute = fp_raw_product(w) + fixed_point(w, c.attribute_int_bits + 1, c.attribute_frac() + 1) +
                                 state(2 + sum + 2 + 1 + w.AO) + adder(sum) + mux(w.AO, 2) + zero_test(w.AO);
  const HardwareCost depth = fp_raw_product(w) + fixed_point(w, 1, w.DB + 1) +
                             state(2 + 2 * 3 + z_sum + 3 + w.DB + 1 + 2) + 3 * adder(z_sum) + mux(w.DB + 1, 3);
  return w.N * attribute + depth + state(1 + w.FRAGMENT);
}

HardwareCost fragment_fifo(const Widths& w) {
  // A word is the fragments of a clock and, of several lanes, which of them there are.
  const int places = fragment_places(), word = w.P * w.FRAGMENT;
  HardwareCost cost =
      memory(word, 1 << places, 1) + state(3 * places + 1 + 3 + word) + adder(4 * places) + mux(word, 2) + control(55);
  if (w.P > 1) cost += memory(w.P, 1 << places, 1) + state(w.P) + mux(w.P, 2);
  return cost;
}

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

/// Of a lane: areas in the place of r; around the products of the weights.
HardwareCost area_weights(const Widths& w, const Config& c) {
  using namespace latency;
  if (c.plane_quads == 0) return {};
  return 2 * (mux(w.NUMBER, 3) + mux(w.NUMBER, 2)) + 4 * (2 * state(w.NUMBER) + mux(w.NUMBER, 2)) +
         state(2 * (ratio_stage - norm_stage) + (n_stage - ratio_stage) + 3);
}

HardwareCost performance_counters(const Widths& w) {
  // Of lanes that are not there nothing is counted.
  const int counters = 37 + w.P;
  constexpr int bits = 32;
  return counters * (state(bits) + adder(bits)) + mux(bits, counters) + state(12 * (3 + w.N) + 4 * w.P) +
         w.P * adder(9) + control(900);
}

}  // namespace

std::vector<ModuleCost> module_costs(const Config& config) {
  constexpr int product_clocks = 6;  // from a job of vertex_products to its results
  const Widths w(config);
  std::vector<ModuleCost> modules{
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
      {"pixel_pipeline", pixel_pipeline(w)},
      {"row_functions", row_functions(w)},
      {"pixel_lane", w.P * pixel_lane(w)},
      {"forward_difference_column", w.P * forward_difference_column(w)},
      {"law_of_cosines", w.P * law_of_cosines(w)},
      {"normalise", w.P * normalise(w)},
      {"singular_class", w.P * singular_class(w)},
      {"sqrt", w.P * (4 * fp_sqrt(w, config))},
      {"mean_value_ratios", w.P * mean_value_ratios(w)},
      {"mean_value_weights", w.P * (mean_value_weights(w, config) + area_weights(w, config))},
      {"interpolate", w.P * interpolate(w)},
      {"reciprocal", w.P * (2 * reciprocal(w, config))},
      {"fragment_output", w.P * fragment_output(w, config)},
      {"fragment_fifo", fragment_fifo(w)},
  };
  if (config.hierarchical_z_bits != 0) {
    const HiddenWidths h(config);
    modules.push_back({"depth_interval", depth_interval(w, h)});
    modules.push_back({"hierarchical_z", hierarchical_z(w, config, h)});
    modules.push_back({"masked_depth", masked_depth(w, h)});
  }
  if (config.plane_quads != 0) modules.push_back({"plane_quad", plane_quad(w)});
  if (config.performance_counters != 0) modules.push_back({"performance_counters", performance_counters(w)});
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
