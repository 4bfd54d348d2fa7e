#include "golden/analysis/hardware_cost.hpp"

#include <algorithm>
#include <bit>

namespace quadrille {

HardwareCost& HardwareCost::operator+=(const HardwareCost& other) {
  state_bits += other.state_bits;
  multiplier_bits += other.multiplier_bits;
  adder_bits += other.adder_bits;
  table_bits += other.table_bits;
  dsps += other.dsps;
  join_bits += other.join_bits;
  return *this;
}

namespace {

using Bits = std::uint64_t;

Bits u(int width) { return static_cast<Bits>(width); }

HardwareCost operator+(HardwareCost a, const HardwareCost& b) { return a += b; }

HardwareCost operator*(int instances, const HardwareCost& cost) {
  const Bits n = u(instances);
  return {n * cost.state_bits, n * cost.multiplier_bits, n * cost.adder_bits, n * cost.table_bits,
          n * cost.dsps,       n * cost.join_bits};
}

// ---- What the counts are made of
// --------------------------------------------------------------------------------------

HardwareCost state(int bits) { return {.state_bits = u(bits)}; }
/// One partial product bit for each pair of operand bits, or blocks of 18 × 18.
HardwareCost in_blocks(int a, int b) {
  constexpr int block = 18;
  const int rows = (a + block - 1) / block, columns = (b + block - 1) / block;
  // The blocks of a row add up to a product by 18 bits of a, the rows to the whole; the lowest 18 bits pass each sum
  // by.
  return {.dsps = u(rows) * u(columns), .join_bits = u(rows) * u(columns - 1) * u(b) + u(rows - 1) * u(a + b - block)};
}
HardwareCost multiplier(int a, int b) {
  HardwareCost cost = in_blocks(a, b);
  cost.multiplier_bits = u(a) * u(b);
  return cost;
}
/// Adder, subtracter, negation, comparison by magnitude: a bit of a carry chain.
HardwareCost adder(int width) { return {.adder_bits = u(width)}; }
/// `choices` to one: a two-to-one multiplexer a bit for each choice but the first.
HardwareCost mux(int width, int choices) { return {.adder_bits = u(width) * u(choices - 1)}; }
/// Words of `width` bits; every read port gives a word. With the depths here (at most 32) a port is a small RAM or a
/// multiplexer tree, hardly dearer for more words; the words themselves are state.
HardwareCost memory(int width, int words) { return state(width * words); }
HardwareCost read_port(int width) { return mux(width, 2); }
/// Test for zero or equality with a constant: a tree of wide gates, about a third of a comparison.
HardwareCost zero_test(int width) { return {.adder_bits = u((width + 2) / 3)}; }

int stages_of(int width) { return std::bit_width(static_cast<unsigned>(width - 1)); }

/// Barrel shifter by up to width - 1 of which `kept` bits are used: the last stage makes those, each stage before it at
/// most twice as many as the next.
HardwareCost shifter(int width, int kept) {
  HardwareCost cost;
  for (int stage = 0, bits = kept; stage < stages_of(width); ++stage, bits *= 2) cost += mux(std::min(width, bits), 2);
  return cost;
}

/// Highest one to the top by halving, `kept` bits used: a level tests 2^level bits and makes those that the shorter
/// shifts after it can still bring among the kept ones.
HardwareCost shift_to_top(int width, int kept) {
  HardwareCost cost;
  for (int level = 0; level < stages_of(width); ++level)
    cost += zero_test(1 << level) + mux(std::min(width, kept + (1 << level) - 1), 2);
  return cost;
}

/// Factor times an unsigned number of few bits: a selection for each digit in radix 4, an adder for each but the first.
HardwareCost small_multiply(int factor, int number) {
  const int digits = number / 2 + 1;
  return digits * mux(factor, 2) + (digits - 1) * adder(factor + number);
}

// ---- Modules that others instantiate
// ----------------------------------------------------------------------------------

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
        TC(c.tc_bits()),
        SLOT(c.quad_slots_log2),
        RING(c.tile_slots_log2),
        FIFO(c.stamp_fifo_log2),
        TL(c.tile_log2),
        TILE(c.tile()),
        ID(c.quad_id_bits),
        DB(c.depth_bits),
        FRAC(c.frac()),
        AO(c.attr_out_bits()),
        NUMBER(E + S),
        TERM(1 + PE + S),
        ALIGNED(c.prec_bits() + 2),
        DET(T + GRAD + 4),
        REACH(GRAD + 1 + TL + 3),
        FRAGMENT(ID + 2 * V + 1 + 8 + DB + 1 + N * AO) {}

  int S, E, PE, N, V, T, W, VAL, GRAD, CURV, QVAL, QGRAD, QCURV, TC, SLOT, RING, FIFO, TL, TILE, ID, DB, FRAC, AO;
  int NUMBER;   ///< exponent and significand
  int TERM;     ///< sign, port exponent, significand
  int ALIGNED;  ///< one aligned term of a sum: a product has two integer bits
  int DET;
  int REACH;  ///< of an edge function over a block
  int FRAGMENT;
};

HardwareCost fp_normalise(const Widths& w, int width) { return shift_to_top(width, w.S) + adder(w.E); }

HardwareCost fp_multiply(const Widths& w) {
  // The exponents' sum takes the carry as carry-in; the product is taken one bit higher or lower.
  return state(w.NUMBER) + multiplier(w.S, w.S) + adder(w.E) + mux(w.S, 2) + zero_test(2 * w.S);
}

HardwareCost fp_raw_product(const Widths& w) { return state(1 + w.E + 2 * w.S) + multiplier(w.S, w.S) + adder(w.E); }

HardwareCost fp_sum(const Widths& w, int terms) {
  const int magnitude = w.ALIGNED + stages_of(terms), sum = magnitude + 1;
  // Largest exponent of the non-zero terms.
  HardwareCost cost = (terms - 1) * (adder(w.E + 1) + mux(w.E + 1, 2));
  // Distance to it; the shift clears a term when the distance has a bit above its stages.
  cost += terms * (adder(w.E) + shifter(w.ALIGNED, w.ALIGNED) + mux(w.ALIGNED, 2));
  // The others are added in the sign of the first.
  cost += (terms - 1) * (adder(sum) + mux(w.ALIGNED, 2));
  cost += adder(sum) + mux(magnitude, 2) + state(1 + magnitude + w.E);
  return cost + adder(w.E) + fp_normalise(w, magnitude) + state(1 + w.NUMBER);
}

/// 1 + c: only c is aligned, and the one is added to two bits. Without exact D and r² it is a sum as any other.
HardwareCost one_plus(const Widths& w) {
  if (w.QVAL < w.VAL) return fp_sum(w, 2);
  return adder(w.E) + shifter(w.ALIGNED, w.ALIGNED) + mux(w.ALIGNED, 2) + mux(w.S, 2) + state(w.ALIGNED + 1 + w.S);
}

HardwareCost table_polynomial(const Widths& w, int segments_log2, int degree) {
  const int rest = w.S - 1 - segments_log2, accumulator = w.S + 4;
  // Inner factor (C1 alone for degree 1), outer product, clamp.
  HardwareCost cost = state(w.S + accumulator + rest) + state(accumulator) + state(w.S);
  if (degree == 2) cost += multiplier(w.S, rest) + adder(w.S);
  return cost + multiplier(w.S, rest) + adder(accumulator) + mux(w.S, 2);
}

/// C0 has S + 4 bits, C1 and C2 have S; C2 is zero throughout for degree 1 and takes no hardware.
HardwareCost table(const Widths& w, int entries_log2, int degree) {
  return {.table_bits = (Bits{1} << entries_log2) * u((1 + degree) * w.S + 4)};
}

HardwareCost fixed_point(const Widths& w, int integer_bits, int fraction_bits) {
  const int out = integer_bits + fraction_bits;
  return mux(2 * w.S, 2) + adder(w.E + 1) + adder(w.E + 1) + adder(w.E + 1) + zero_test(2 * w.S) + shifter(out, out) +
         mux(out, 2);
}

// ---- Modules of the pipeline
// ------------------------------------------------------------------------------------------

HardwareCost vertex_assembly(const Widths& w) {
  const int vertex = 2 * w.T + w.W + (w.PE + w.S) + (1 + w.PE + w.S) + w.N * w.TERM;
  return state(w.ID + 4 * vertex + 3);
}

HardwareCost bounding_range(const Widths& w) {
  const int whole = w.T - w.FRAC;
  return 6 * (adder(w.T) + mux(w.T, 2)) + adder(w.T) + 4 * adder(whole) + 4 * mux(whole, 2) + adder(w.V + 1) +
         2 * adder(w.TC);
}

HardwareCost dot_unit(const Widths& w, int b) {
  // a·b ± c·d: operand and product registers; the other operand of a product has T bits. Logic takes the bits that are
  // used, DSP blocks are divided among the operands as they stand.
  const int operand = std::max(w.T, std::min(w.VAL, 32) + 1);
  HardwareCost cost = 2 * in_blocks(operand, operand);
  cost.multiplier_bits = 2 * u(w.T) * u(b);
  return cost + state(2 * (w.T + b) + 2 * (w.T + b) + 2) + adder(w.T + b + 1) + mux(w.T + b + 1, 2);
}

HardwareCost quad_setup(const Widths& w) {
  // Unit 0 also takes the low 32 bits of a linear function, unsigned; unit 1 the rest, no wider than T.
  const int low_half = std::min(w.VAL, 32) + 1;
  HardwareCost cost = dot_unit(w, low_half) + dot_unit(w, w.T);
  cost += 2 * bounding_range(w) + 4 * zero_test(w.W);
  // Control, jobs in flight, tile rectangle, vertices.
  cost += state(3 + 6 + 1 + 1 + 2 * 15 + w.SLOT + 4 * w.TC + 8 * w.T + 4 * w.W);
  cost += 8 * (adder(w.T) + mux(w.T, 2)) + 4 * mux(w.TC, 2);
  // Operands: a pair of the four vertices a unit, one of four edges for the determinants, then one of the five kinds of
  // job.
  cost += 4 * mux(2 * w.T + w.W, 4) + mux(w.VAL, 4) + 2 * mux(w.GRAD, 4);
  cost += 2 * mux(low_half, 5) + 6 * mux(w.T, 5);
  // Functions load from buses; sums of coordinates take the place of a product's gradient in an ordinary quad.
  cost += 6 * state(w.VAL + 2 * w.GRAD) + 10 * state(w.QVAL + 2 * w.QGRAD + w.QCURV);
  cost += 4 * (adder(w.T + 1) + state(2 * (w.T + 1))) + 2 * mux(w.T + 1, 2);
  cost += 6 * mux(w.GRAD, 2) + 4 * adder(w.GRAD) + 2 * mux(w.QCURV, 2);
  // Reach and tie signs of the edges, one edge after the other.
  cost += 4 * mux(w.GRAD, 2) + 6 * adder(w.REACH) + 2 * zero_test(w.GRAD) + 5 * state(4 * w.REACH + 2);
  // The determinants accumulate both units' results one after the other; signs of three are kept.
  return cost + state(w.DET + 6) + 2 * adder(w.DET) + mux(w.DET, 2) + zero_test(w.DET);
}

HardwareCost tile_walk(const Widths& w) {
  HardwareCost cost = state(2 + 4 * w.TC + 2 * w.TC + 1 + 6 + 1 + w.SLOT + 4) + 14 * adder(w.TC);
  // A step of a linear function: gy or ±gx by a tile or a block, added to the tile's or the block's value, both of
  // which may also be loaded.
  cost += 6 * (state(2 * w.GRAD + 2 * w.VAL) + mux(w.GRAD, 2) + 3 * mux(w.VAL, 2) + adder(w.VAL));
  // Extremes of an edge function over the extent.
  cost += 5 * (state(4 * w.REACH) + 2 * (mux(w.REACH, 2) + adder(w.VAL)));
  // A step of a quadratic function: twice half the bend onto one of four slopes, the slope halfway onto the value.
  cost += 10 * (state(w.QCURV + 2 * w.QVAL + 4 * w.QGRAD) + mux(w.QCURV, 2) + mux(w.QGRAD, 4) + 2 * adder(w.QGRAD) +
                3 * mux(w.QVAL, 2) + adder(w.QVAL) + 4 * mux(w.QGRAD, 2));
  return cost;
}

HardwareCost tile_ring(const Widths& w) {
  const int tag = 1 + w.SLOT + 2 * w.TC, values = 6 * w.VAL + 10 * w.QVAL + 20 * w.QGRAD;
  return memory(tag + values, 1 << w.RING) + state(w.RING + 1) + 3 * adder(w.RING + 1) + read_port(tag + 5 * w.VAL) +
         read_port(tag - 1 + values);
}

HardwareCost quad_slots(const Widths& w) {
  const int vertices = 4 * (3 + w.N) * w.TERM + w.ID, functions = 12 * w.GRAD + 10 * w.QCURV + 16;
  HardwareCost cost =
      memory(vertices + functions, 1 << w.SLOT) + state(2 * w.SLOT + 1) + adder(w.SLOT) + 2 * adder(w.SLOT + 1);
  // Blend terms and id; k for the weights' products and, without sign, for the overrides; functions for emission and,
  // five of the six linear ones, for coverage.
  cost += read_port(vertices) + read_port(4 * w.TERM) + read_port(4 * (w.TERM - 1)) + read_port(functions) +
          read_port(10 * w.GRAD);
  // W as a significand number; k_eff.
  return cost + 4 * (adder(w.W) + mux(w.W, 2) + fp_normalise(w, w.W) + mux(w.PE + w.S, 2));
}

HardwareCost stamp_coverage(const Widths& w) {
  HardwareCost cost = state(w.RING + 1 + w.TL);
  // Of each edge function the row's value and that of its other pixels.
  cost += 5 * (state(w.VAL) + mux(w.VAL, 2) + adder(w.VAL) + (w.TILE - 1) * adder(w.VAL) + w.TILE * zero_test(w.VAL));
  // Scissor; clauses: about two gates an edge function.
  return cost + w.TILE * mux(12, 2) + 2 * adder(w.V + 1) + 2 * (adder(w.TC) + zero_test(w.TC));
}

HardwareCost sync_fifo(const Widths& w) {
  const int stamp = 1 + w.RING + 1 + w.TL + 3 * w.TILE;
  return memory(stamp, 1 << w.FIFO) + state(3 * w.FIFO + 1) + 3 * adder(w.FIFO) + read_port(stamp);
}

HardwareCost pixel_emit(const Widths& w) {
  // Remaining pixels, the lowest of them, front and tie there.
  return state(w.TILE) + adder(w.TILE) + 4 * mux(w.TILE, 2);
}

/// The side band alone: valid and end bits, the pixel's slot, position and flags from stage 0 and its class from stage
/// 3 to stage 24 (eight class bits only to stage 14), numerators waiting for the reciprocals.
HardwareCost pixel_pipeline(const Widths& w) {
  const int tag = w.SLOT + 2 * w.V + 2;
  return state(25 + 26 + 4 * tag + 21 * (tag + 13) - 10 * 8 + 3 * (1 + w.N) * (1 + w.NUMBER));
}

HardwareCost forward_difference(const Widths& w) {
  // Row, then column, with the digits of the column in between; a quadratic has the bend q (r² + dx²) besides.
  const int norm = 2 * w.TL + 1;
  const HardwareCost linear =
      state(w.VAL + w.GRAD + w.TL + 1 + w.VAL) + 2 * (small_multiply(w.GRAD, w.TL) + adder(w.VAL));
  const HardwareCost quadratic = state(w.QVAL + w.QGRAD + w.TL + 1 + w.QCURV + norm + 1 + w.QVAL) +
                                 2 * (small_multiply(w.QGRAD, w.TL) + adder(w.QVAL)) + small_multiply(w.QCURV, norm) +
                                 adder(w.QVAL);
  return 6 * linear + 10 * quadratic;
}

HardwareCost normalise(const Widths& w) {
  const auto one = [&](int width) {
    const int kept = w.S + 7, wide = std::max(width, kept);  // shifts by 8 and more, then the short ones
    return adder(width) + mux(width, 2) + shift_to_top(wide, w.S) + state(1 + kept + stages_of(wide) - 3) + adder(w.E) +
           state(1 + w.NUMBER);
  };
  return 6 * one(w.VAL) + 10 * one(w.QVAL);
}

HardwareCost singular_class(const Widths& w) {
  return state(16 + 13) + 4 * (zero_test(w.VAL) + zero_test(w.QVAL)) + mux(30, 2);
}

/// Exponent of an inverse, exact powers, and what waits for the polynomial: `flags` bits and the exponent.
HardwareCost inverse(const Widths& w, int flags) {
  return state(3 * (w.E + flags)) + adder(w.E) + mux(w.E, 2) + zero_test(2 * w.S) + mux(w.S, 2);
}

HardwareCost fp_sqrt(const Widths& w, const Config& c) {
  const int segments = c.sqrt_segments();
  return 4 * (inverse(w, 2) + table_polynomial(w, segments, c.sqrt_degree) + table(w, segments + 1, c.sqrt_degree));
}

HardwareCost reciprocal(const Widths& w, const Config& c) {
  const int segments = c.recip_segments();
  return 2 * (inverse(w, 3) + table_polynomial(w, segments, c.recip_degree) + table(w, segments, c.recip_degree));
}

HardwareCost mean_value_ratios(const Widths& w) {
  // |A|, |D| wait for ρρ'; v waits for u; the sign of D crosses n and d.
  const HardwareCost delays = state(4 * w.NUMBER + 4 * (1 + w.NUMBER) + 2 + 2 * w.NUMBER + 1);
  return 6 * (delays + 2 * fp_multiply(w) + fp_raw_product(w) + one_plus(w) + 4 * mux(w.NUMBER, 2));
}

HardwareCost mean_value_weights(const Widths& w, bool notch_exact) {
  HardwareCost cost = state(8 * 4 * w.NUMBER);  // ρ for stages 11 and 15
  // N_i from ratios or from ρ and k, cured or not; e_i and its delay.
  cost += 4 * (4 * mux(w.NUMBER, 2) + 2 * fp_raw_product(w) + fp_sum(w, 2) + fp_multiply(w) + state(3 * w.NUMBER));
  // Two edges: the two sums, their sum, all sums delayed. Two corners: their k.
  cost += 2 * mux(w.NUMBER, 4) + fp_sum(w, 2) + state(6 * w.NUMBER) + 2 * mux(w.PE + w.S, 4);
  // Overrides, h_i and M_i.
  cost += 4 * (state(3 * w.NUMBER + 1) + mux(w.NUMBER, 6) + 3 * mux(w.NUMBER, 2) + 2 * fp_multiply(w));
  if (notch_exact) {
    // The factors f of the cure and their delay; N_i = n n' + d d'; g_i = ρ' f'.
    cost += 3 * (fp_multiply(w) + state(3 * w.NUMBER));
    cost += 4 * (2 * mux(w.NUMBER, 2) + mux(w.NUMBER, 3) + state(w.NUMBER) + fp_multiply(w));
  } else {
    cost += 4 * state(w.NUMBER);  // ρ' passes g's register
  }
  return cost;
}

HardwareCost interpolate(const Widths& w) { return (3 + w.N) * (4 * fp_raw_product(w) + fp_sum(w, 4)); }

HardwareCost fragment_output(const Widths& w, const Config& c) {
  // Two's complement, slots not in use, z interval, and the output register, which is cleared when not valid.
  const HardwareCost attribute =
      fp_raw_product(w) + fixed_point(w, c.attribute_int_bits, c.attribute_frac()) + adder(w.AO) + mux(w.AO, 2);
  const HardwareCost depth =
      fp_raw_product(w) + fixed_point(w, 1, w.DB) + state(2) + 2 * adder(w.DB + 1) + 2 * mux(w.DB + 1, 2);
  return w.N * attribute + depth + state(1 + w.FRAGMENT) + mux(w.FRAGMENT, 2);
}

}  // namespace

std::vector<ModuleCost> module_costs(const Config& config) {
  const Widths w(config);
  return {
      {"vertex_assembly", vertex_assembly(w)},
      {"quad_setup", quad_setup(w)},
      {"quad_slots", quad_slots(w)},
      {"tile_walk", tile_walk(w)},
      {"tile_ring", tile_ring(w)},
      {"stamp_coverage", stamp_coverage(w)},
      {"sync_fifo", sync_fifo(w)},
      {"pixel_emit", pixel_emit(w)},
      {"pixel_pipeline", pixel_pipeline(w)},
      {"forward_difference", forward_difference(w)},
      {"normalise", normalise(w)},
      {"singular_class", singular_class(w)},
      {"sqrt", fp_sqrt(w, config)},
      {"mean_value_ratios", mean_value_ratios(w)},
      {"mean_value_weights", mean_value_weights(w, config.notch_exact != 0)},
      {"interpolate", interpolate(w)},
      {"reciprocal", reciprocal(w, config)},
      {"fragment_output", fragment_output(w, config)},
  };
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
  return lut_cost(cost, weights) + weights.dsp * static_cast<double>(cost.dsps);
}

}  // namespace quadrille
