// What the counts of hardware_cost.hpp are made of: registers, adders, multipliers, memories, and the floating point
// modules that others instantiate. Not for use outside this folder.
#pragma once

#include "golden/analysis/hardware_cost.hpp"
#include "model/port/latency.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

namespace quadrille::cost {

inline constexpr std::array fields{
    &HardwareCost::state_bits, &HardwareCost::multiplier_bits, &HardwareCost::adder_bits,  &HardwareCost::table_bits,
    &HardwareCost::dsps,       &HardwareCost::join_bits,       &HardwareCost::memory_bits, &HardwareCost::block_rams};

using Bits = std::uint64_t;

inline Bits u(int width) { return static_cast<Bits>(width); }

inline HardwareCost operator+(HardwareCost a, const HardwareCost& b) { return a += b; }

inline HardwareCost operator*(int instances, HardwareCost cost) {
  for (const auto field : fields) cost.*field *= u(instances);
  return cost;
}

inline HardwareCost state(int bits) { return {.state_bits = u(bits)}; }
/// One partial product bit for each pair of operand bits; blocks of 18 × 18, which factors of one bit do not take.
inline HardwareCost multiplier(int a, int b) {
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
inline HardwareCost adder(int width) { return {.adder_bits = u(width)}; }
/// `choices` to one, the first that holds: a two-to-one multiplexer a bit for each choice but the first. An enable, or
/// a zero instead, is the register's.
inline HardwareCost mux(int width, int choices) { return {.adder_bits = u(width) * u(choices - 1)}; }
/// By a number of two bits: two LUTs of four inputs a bit.
inline HardwareCost one_of_four(int width) { return mux(width, 3); }
/// Block RAMs of 18 Kbit for words of `width` bits: of 512 words of 36 bits to 16 K of one, side by side and one behind
/// the other, those of which the fewest are needed.
inline int blocks_of(int width, int words) {
  constexpr int widths[] = {36, 18, 9, 4, 2, 1};
  int fewest = std::numeric_limits<int>::max(), depth = 512;
  for (const int wide : widths) {
    fewest = std::min(fewest, (words + depth - 1) / depth * ((width + wide - 1) / wide));
    depth *= 2;
  }
  return fewest;
}
/// Words of `width` bits. Up to 32 of them are in small RAMs of 16 words, six LUTs for four bits, with a copy for each
/// read port; more words (which have one port) are in block RAM, where a word written and read in one clock goes around
/// it.
inline HardwareCost memory(int width, int words, int ports) {
  HardwareCost cost{.state_bits = u(width * words), .memory_bits = u(width * words)};
  if (words > 32) {
    cost.block_rams = u(blocks_of(width, words));
    return cost + state(width + 1) + mux(width, 2);
  }
  const int blocks = (words + 15) / 16;
  return cost + ports * (blocks * adder(6 * ((width + 3) / 4)) + mux(width, blocks));
}
/// Words of `width` bits in block RAM by demand, with the register in which a read ends.
inline HardwareCost block_memory(int width, int words) {
  const Bits bits = u(width * (words + 1));
  return {.state_bits = bits, .memory_bits = bits, .block_rams = u(blocks_of(width, words))};
}
/// Test for zero or equality with a constant: a tree of wide gates, about a third of a comparison.
inline HardwareCost zero_test(int width) { return {.adder_bits = u((width + 2) / 3)}; }

/// Counters, decoding and handshakes that no width changes, in LUTs as synthesised.
inline HardwareCost control(int luts) { return {.adder_bits = u(luts)}; }

inline int stages_of(int width) { return std::bit_width(static_cast<unsigned>(width - 1)); }

/// Shifter to the right by up to width - 1. A stage chooses between the bits that it has both of; above them zeros come
/// in, half a LUT for each bit that any stage clears.
inline HardwareCost shifter(int width) {
  HardwareCost cost = adder(width / 2);
  for (int stage = 0; stage < stages_of(width); ++stage) cost += mux(width - (1 << stage), 2);
  return cost;
}

/// Highest one to the top by halving, levels first down to last, `kept` bits used behind them: a level tests 2^level
/// bits and makes those that the shorter shifts after it can still bring among the kept ones.
inline HardwareCost shift_to_top(int width, int kept, int first, int last) {
  HardwareCost cost;
  for (int level = first; level >= last; --level)
    cost += zero_test(1 << level) + mux(std::min(width, kept + (1 << level) - (1 << last)), 2);
  return cost;
}

/// Factor times an unsigned number of few bits: a selection for each digit in radix 4, an adder for each but the first.
inline HardwareCost small_multiply(int factor, int number) {
  HardwareCost cost;
  for (int digit = 0; digit <= number / 2; ++digit) {
    const int bits = factor + number - 2 * digit;
    cost += mux(bits, 2);
    if (digit > 0) cost += adder(bits);
  }
  return cost;
}

/// Of two significands. Behind 18 bits and the leading one a block is 18 × 18, adders take the strips below it; a digit
/// of them behind two others costs its selection one and a half LUTs a bit more, as synthesised.
inline HardwareCost significand_product(int s) {
  constexpr int block = 18;
  if (s <= block) return multiplier(s, s);
  const int low = s - 1 - block;
  HardwareCost cost = multiplier(block, block) + adder(s) + adder(s + 1);
  if (low == 0) return cost;
  cost += adder(s + low + 1) + adder(2 * s - low);
  if (low == 1) return cost + mux(s - 1 + block, 2);
  cost += small_multiply(s, low) + small_multiply(block + 1, low);
  return cost + mux(3 * (s + block + 1) / 2, std::max(low / 2, 1));
}

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
inline HardwareCost fp_normalise(const Widths& w, int width, int exp, bool registered = true) {
  constexpr int split = 3;
  const int kept = w.S + (1 << split) - 1, wide = std::max(width, kept), count = stages_of(wide);
  HardwareCost cost = shift_to_top(wide, kept, count - 1, split) + shift_to_top(kept, w.S, split - 1, 0) + adder(exp);
  if (registered) cost += state(kept + count - split + (exp == w.E ? w.E : 0)) + state(exp + w.S);
  return cost;
}

/// Exponent's sum and the product's carry into it; the product is taken one bit higher or lower.
inline HardwareCost fp_multiply(const Widths& w) {
  return state(w.NUMBER) + significand_product(w.S) + adder(w.E) + mux(w.S, 2) + zero_test(2 * w.S);
}

inline HardwareCost fp_raw_product(const Widths& w) {
  return state(1 + w.E + 2 * w.S) + significand_product(w.S) + adder(w.E);
}

/// Sum of exponents, gated by the factors' top bits, and the product's upper bits.
inline HardwareCost fp_term(const Widths& w) { return state(w.TERM) + significand_product(w.S) + adder(2 * w.E); }

/// fp_multiply with the rank; the upper bits for a sum are registers beside.
inline HardwareCost fp_product(const Widths& w) { return fp_multiply(w) + adder(w.E); }

inline HardwareCost fp_sum(const Widths& w, int terms, bool with_sign) {
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

inline HardwareCost fp_add(const Widths& w) {
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
inline Table sqrt_table(const Config& c) {
  const int s = c.significand_bits, k = c.sqrt_segments();
  return {s + 2, s - k + 2, c.sqrt_degree == 2 ? std::max(s - 2 * k, 0) : 0, k + 1};
}
inline Table reciprocal_table(const Config& c) {
  const int s = c.significand_bits, k = c.recip_segments();
  return {s + 4, s - k + 3, c.recip_degree == 2 ? std::max(s - 2 * k + 3, 0) : 0, k};
}

inline HardwareCost table_polynomial(const Widths& w, const Table& table, int segments_log2) {
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

inline HardwareCost fixed_point(const Widths& w, int integer_bits, int fraction_bits) {
  const int out = integer_bits + fraction_bits, kept = std::min(2 * w.S, out);
  return mux(kept, 2) + adder(w.E + 1) + state(w.E + 1 + kept + 1) + shifter(out) +
         zero_test(w.E + 1 - stages_of(out)) + state(1 + out);
}

/// Places of the fragment FIFO, log2.
inline int fragment_places() { return stages_of(latency::pipeline + 7); }

/// The modules of each half, front to back, in all their instances.
std::vector<ModuleCost> front_modules(const Widths& w);                   ///< cost_front.cpp
std::vector<ModuleCost> pixel_modules(const Widths& w, const Config& c);  ///< cost_pixel.cpp

}  // namespace quadrille::cost
