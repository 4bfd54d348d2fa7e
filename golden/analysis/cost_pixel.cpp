// The pixel pipeline: from a pixel's functions to its fragment.
#include "golden/analysis/cost_parts.hpp"

namespace quadrille::cost {
namespace {

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
  // A word is the fragments of a clock, and which of them there are.
  const int places = fragment_places();
  return block_memory(w.P * (1 + w.FRAGMENT), 1 << places) + state(3 * places + 1 + 3) + adder(4 * places) +
         control(55);
}

/// Of a lane: areas in the place of r; around the products of the weights.
HardwareCost area_weights(const Widths& w, const Config& c) {
  using namespace latency;
  if (c.plane_quads == 0) return {};
  return 2 * (mux(w.NUMBER, 3) + mux(w.NUMBER, 2)) + 4 * (2 * state(w.NUMBER) + mux(w.NUMBER, 2)) +
         state(2 * (ratio_stage - norm_stage) + (n_stage - ratio_stage) + 3);
}

}  // namespace

std::vector<ModuleCost> pixel_modules(const Widths& w, const Config& c) {
  return {
      {"pixel_pipeline", pixel_pipeline(w)},
      {"row_functions", row_functions(w)},
      {"pixel_lane", w.P * pixel_lane(w)},
      {"forward_difference_column", w.P * forward_difference_column(w)},
      {"law_of_cosines", w.P * law_of_cosines(w)},
      {"normalise", w.P * normalise(w)},
      {"singular_class", w.P * singular_class(w)},
      {"sqrt", w.P * (4 * fp_sqrt(w, c))},
      {"mean_value_ratios", w.P * mean_value_ratios(w)},
      {"mean_value_weights", w.P * (mean_value_weights(w, c) + area_weights(w, c))},
      {"interpolate", w.P * interpolate(w)},
      {"reciprocal", w.P * (2 * reciprocal(w, c))},
      {"fragment_output", w.P * fragment_output(w, c)},
      {"fragment_fifo", fragment_fifo(w)},
  };
}

}  // namespace quadrille::cost
