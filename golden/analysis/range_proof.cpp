#include "golden/analysis/range_proof.hpp"

#include "model/port/tables.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace quadrille {
namespace {

using Wide = __int128;

Wide power(int exponent) { return Wide{1} << exponent; }
Wide floor_shift(Wide v, int shift) { return v >> shift; }
double below(Wide v) {
  const auto d = static_cast<double>(v);
  return static_cast<Wide>(d) <= v ? d : std::nextafter(d, -std::numeric_limits<double>::infinity());
}
double above(Wide v) { return 0 - below(-v); }

/// Binary exponents of a positive magnitude: floor(log2) of its least and largest value.
struct ExponentRange {
  int lo = 0, hi = 0;
};
/// A product truncated to S bits: the carry may add one, and truncation never falls below a power of two.
ExponentRange operator*(ExponentRange a, ExponentRange b) { return {a.lo + b.lo, a.hi + b.hi + 1}; }
ExponentRange hull(ExponentRange a, ExponentRange b) { return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)}; }

int log2_of(Wide v) {
  int p = -1;
  for (; v > 0; v >>= 1) ++p;
  return p;
}

class RangeList {
 public:
  void add(std::string name, Wide low, Wide high, int bits, bool is_signed = true) {
    const bool fits = is_signed ? low >= -power(bits - 1) && high < power(bits - 1) : low >= 0 && high < power(bits);
    proof_.signals.push_back({std::move(name), below(low), above(high), bits, is_signed, fits});
  }
  void add_exponent(const std::string& name, ExponentRange e, int bits) {
    add("exponent of " + name, e.lo, e.hi, bits);
    // wide_lanes carry the same number as a double, exactly: normal, products of 2 S <= 52 bits
    // included.
    const bool fits = e.lo >= -1022 && e.hi <= 1023;
    proof_.signals.push_back(
        {name + " as a double", static_cast<double>(e.lo), static_cast<double>(e.hi), 11, true, fits});
  }
  RangeProof result() {
    proof_.proved = std::all_of(proof_.signals.begin(), proof_.signals.end(), [](const auto& s) { return s.fits; });
    return std::move(proof_);
  }

 private:
  RangeProof proof_;
};

/// The exact integers up to the normalisation, in units of their least bits.
struct FrontRange {
  Wide a, d_low, d_high, r2_high;  ///< |A|; D; r²
  Wide dropped;                    ///< D and r² are off by at most this through dropped bits
};

FrontRange prove_front(const Config& c, const ProofWidths& w, RangeList& list) {
  const Wide edge = power(c.pos_int() + c.frac()), one = power(c.frac());  // |X|, |Y| <= edge, |W| <= one
  const Wide viewport = power(c.viewport_bits), tile = c.tile();
  const int drop = c.qdrop();
  list.add("X, Y", -edge, edge, w.position);
  list.add("W", -one, one, w.weight);

  // Seen from a tile's origin pixel: that of the walk (a tile of the viewport for an ordinary quad, (0, 0) for any
  // other), then that of each tile that is hit. S = X - W·x; W has either sign, hence S has.
  const auto reach = [&](Wide pixel) { return edge + one * pixel; };
  const Wide origin = viewport - tile, moved = reach(origin);
  list.add("T", -moved, moved, w.position);
  list.add("tile", 0, viewport / tile - 1, w.tile, false);
  list.add("tile count", 0, viewport / tile, w.tile, false);
  // 2^32: half a determinant's. Differences of vertices do not depend on the origin.
  const Wide operand = std::max({moved, 2 * edge, power(32) - 1});
  list.add("dot unit operand", -operand, operand, w.dot_operand);
  const Wide longest = 2 * (2 * edge) * (2 * edge);
  const Wide widest = std::max({2 * moved * moved, longest, 2 * edge * (power(32) - 1)});
  list.add("dot unit result", -widest, widest, w.dot_result);
  list.add("length2", 0, floor_shift(longest, drop), w.length2, false);

  const auto products = [&](Wide pixel) { return 2 * reach(pixel) * reach(pixel); };
  // Block origins are tiles of the viewport, so a block's far corner is up to 7 tiles outside.
  const Wide last = viewport - 1, corner = viewport + (Config::block_tiles - 1) * tile - 1;
  FrontRange f{products(last), 0, 0, 0, 0};
  list.add("A", -f.a, f.a, w.value);
  list.add("A at the corner of a block", -products(corner), products(corner), w.value);
  list.add("gx of A", -2 * edge * one, 2 * edge * one, w.grad);

  // Value, gradient and curvature are each rounded down by `drop` bits at the tile's origin and then multiplied by the
  // way from there to the pixel: each of `terms` takes less than a unit.
  const auto floored = [&](Wide low, Wide high, Wide terms) {
    return std::pair{floor_shift(low - (power(drop) - 1) * terms, drop), floor_shift(high, drop)};
  };
  const Wide way = 1 + 2 * (tile - 1) + 2 * (tile - 1) * (tile - 1);
  const auto [r2_low, r2_high] = floored(0, f.a, way);
  list.add("r²", r2_low, r2_high, w.qvalue);
  f.r2_high = r2_high;
  // A homogeneous quad's own functions; by the law of cosines half of two r², low by the way, and of a squared length,
  // whose lost unit makes D high.
  const auto [own_low, own_high] = floored(-f.a, f.a, way);
  const Wide lost = power(drop) - 1;
  f.d_low = std::min(own_low, floor_shift(-2 * f.a - 2 * lost * way, drop + 1));
  f.d_high = std::max(own_high, floor_shift(2 * f.a + lost, drop + 1));
  list.add("D", f.d_low, f.d_high, w.qvalue);
  f.dropped = drop > 0 ? way + 1 : 0;
  const Wide slope = 2 * moved * one;
  const auto [gx_low, gx_high] = floored(-slope, slope, 1);
  list.add("gx of D, r²", gx_low, gx_high, w.qgrad);
  const auto [q_low, q_high] = floored(-one * one, one * one, 1);
  list.add("q of D, r²", q_low, q_high, w.qcurv);

  const Wide determinant = 2 * edge * (2 * edge * one) + one * (2 * edge * edge);
  list.add("determinant", -determinant, determinant, w.determinant);
  return f;
}

void prove_tables(const Config& c, const ProofWidths& w, RangeList& list) {
  const auto prove = [&](const std::string& name, const Table& table) {
    Wide c0 = 0, c1 = 0, inner_low = 0, low = power(62), high = 0;
    for (const TableEntry& e : table.entries) {
      c0 = std::max<Wide>(c0, e.c0);
      c1 = std::max<Wide>({c1, e.c1, e.c2});
      inner_low = std::min<Wide>(inner_low, Wide{e.c1} - e.c2);
      low = std::min<Wide>(low, Wide{e.c0} - e.c1);
      high = std::max<Wide>(high, e.c0);
    }
    list.add(name + " C0", 0, c0, w.table_word, false);
    list.add(name + " C1, C2", inner_low, c1, w.table_factor, false);
    list.add(name + " before the clamp", low >> Config::table_guard, high >> Config::table_guard, w.table_factor + 1,
             false);
  };
  prove("sqrt", make_sqrt_table(c));
  prove("reciprocal", make_recip_table(c));
}

/// A sum of positive terms.
ExponentRange sum(ExponentRange a, int log2_terms) { return {a.lo, a.hi + 1 + log2_terms}; }

/// Up to u, in units of D's and r²'s least bit.
struct FrontExponents {
  ExponentRange a, d, r2, root, u;

  FrontExponents(const Config& c, const FrontRange& front)
      : a{-c.qdrop(), log2_of(front.a) - c.qdrop()},
        d{0, log2_of(std::max(front.d_high, -front.d_low))},
        r2{0, log2_of(front.r2_high)},
        root{0, r2.hi / 2},
        u(sum(hull(root * root, d), 1)) {}
};

/// What the weights of a regular pixel go through, from A, u in units of D's and r²'s least bit.
struct RegularExponents {
  ExponentRange product;        ///< z = u u'
  ExponentRange fraction;       ///< numerator and denominator of a ratio as they come: u, v, s = sqrt(z), v' u, v s
  ExponentRange factor;         ///< the same in balance
  ExponentRange first, weight;  ///< x y, and M = x y z

  /// With v <= 2^slack u the ratios lie between 1 and its largest value, that of one whose terms both cancel:
  /// (v'/v) sqrt(u/u') = (v'/sqrt(u')) (sqrt(u)/v) <= 2^slack sqrt(u') sqrt(u) / v. |A| <= r r' <= u, but for bits that
  /// were dropped: r² of `dropped` + 1 units at most may be stored as 1. Two roundings are less than 2.
  RegularExponents(ExponentRange v, ExponentRange u, Wide dropped) {
    const int slack = dropped > 0 ? log2_of(dropped + 1) + 1 : 0;
    product = u * u;
    const ExponentRange root{product.lo / 2, product.hi / 2};
    fraction = hull(hull(hull(v, u), root), hull(v * u, v * root));
    const int reach = std::max(u.hi - v.lo, v.hi - u.lo) + slack + 2;
    factor = {-(reach + 1) / 2, (reach + 1) / 2};
    first = factor * factor;
    weight = first * factor;
  }
};

void prove_exponents(const Config& c, const ProofWidths& w, const FrontRange& front, RangeList& list) {
  const int prec = c.prec_bits(), e = w.exponent;
  // A sum whose terms may cancel keeps at least the least bit of its window.
  const auto cancelling = [&](ExponentRange a, int log2_terms) {
    return ExponentRange{a.lo - prec, a.hi + 1 + log2_terms};
  };

  // What snapping lets through: |x|, |y|, |w| <= 2^80, one of them >= 2^-80, |z| <= 2^80, |a| < 2^int_bits. Half a
  // pixel and the guard band enlarge the first by a factor of 2 and reduce the second by 2^-(POS_INT+1). A difference
  // to a base (times w, for z) may be twice as large.
  const ExponentRange k{-82, 81 + c.pos_int()}, weight{-c.frac(), 0};
  const int underflow = -(1 << (Config::port_exp_bits - 1));  // below, snapping gives zero
  const ExponentRange z{underflow, k.hi + 82}, b{underflow, k.hi + c.attribute_int_bits + 1};
  list.add("exponent of k", k.lo, k.hi, w.port_exponent);
  list.add("exponent of Z", z.lo, z.hi, w.port_exponent);
  list.add("exponent of b", b.lo, b.hi, w.port_exponent);

  const auto [a, d, r2, root, u] = FrontExponents(c, front);
  list.add_exponent("A", a, e);
  list.add_exponent("D", d, e);
  list.add_exponent("r²", r2, e);
  list.add_exponent("r", root, e);
  list.add_exponent("u", u, e);

  // Of two pairs' ratio: the root of u u', and v = |A| times u or times that root.
  const RegularExponents regular(a, u, front.dropped);
  list.add_exponent("u u'", regular.product, e);
  list.add_exponent("fraction of M", regular.fraction, e);
  list.add_exponent("factors of M", regular.factor, e);
  const ExponentRange k_eff = hull(k, weight);
  const ExponentRange denominator = cancelling(root * k_eff, 1);
  list.add_exponent("N of an edge", denominator, e);
  const ExponentRange singular = hull(sum(root * denominator, 1), hull(k_eff, {0, 0}));
  list.add_exponent("first product of M", hull(regular.first, singular), e);
  const ExponentRange m = hull(regular.weight, singular);
  list.add_exponent("M", m, e);

  const ExponentRange den_k = cancelling(m * k_eff, 2), den_w = cancelling(m * weight, 2);
  const ExponentRange num_z = cancelling(m * z, 2), num_a = cancelling(m * b, 2);
  list.add_exponent("Σ M·k", den_k, e);
  list.add_exponent("Σ M·W", den_w, e);
  list.add_exponent("Σ M·Z", num_z, e);
  list.add_exponent("Σ M·b", num_a, e);
  const auto inverse = [](ExponentRange x) { return ExponentRange{-x.hi - 1, -x.lo}; };
  list.add_exponent("1 / Σ M·k", inverse(den_k), e);
  list.add_exponent("1 / Σ M·W", inverse(den_w), e);
  list.add_exponent("attribute before the fixed point", num_a * inverse(den_k), e);
  list.add_exponent("z before the fixed point", num_z * inverse(den_w), e);
}

}  // namespace

bool keeps_ordinary_products(const Config& c) { return c.qdrop() <= 2 * c.homogeneous_frac_bits; }

ProofWidths::ProofWidths(const Config& c)
    : position(c.t_bits()),
      weight(c.w_bits()),
      value(c.val_bits()),
      grad(c.grad_bits()),
      qvalue(c.qval_bits()),
      qgrad(c.qgrad_bits()),
      qcurv(c.qcurv_bits()),
      length2(c.length2_bits()),
      tile(c.tc_bits()),
      dot_operand(33),
      dot_result(67),
      determinant(c.t_bits() + c.grad_bits() + 4),
      exponent(Config::exp_bits),
      port_exponent(Config::port_exp_bits),
      term(c.significand_bits + 1 + c.align_guard_bits),
      table_word(c.significand_bits + 4),
      table_factor(c.significand_bits),
      attribute(c.attr_out_bits()),
      depth(c.depth_bits + 1) {}

RangeProof prove_ranges(const Config& config) { return prove_ranges(config, ProofWidths(config)); }

RangeProof prove_ranges(const Config& config, const ProofWidths& w) {
  RangeList list;
  const FrontRange front = prove_front(config, w, list);
  prove_tables(config, w, list);
  prove_exponents(config, w, front, list);
  // The largest product of two significands, cut to the window.
  const int s = config.significand_bits;
  const Wide significand = power(s) - 1;
  const Wide term = (significand * significand) >> (2 * s - 2 - config.prec_bits());
  list.add("aligned term", 0, term, w.term, false);
  list.add("sum of two terms", -2 * term, 2 * term, w.term + 2);
  list.add("sum of four terms", -4 * term, 4 * term, w.term + 3);
  const Wide attribute = power(config.attribute_int_bits + config.attribute_frac()) - 1;  // saturated
  list.add("attribute", -attribute, attribute, w.attribute);
  list.add("depth", 0, power(config.depth_bits) + 1, w.depth, false);  // of fragments that are discarded too
  return list.result();
}

RangeProof prove_regular_range(const Config& config) {
  RangeList unused;
  const FrontRange front = prove_front(config, ProofWidths(config), unused);
  const FrontExponents e(config, front);
  const RegularExponents regular(e.a, e.u, front.dropped);
  RangeProof proof;
  // `degree` of a square of pixels: the least bits are 2^-quadratic_frac of it.
  const auto add = [&](const char* signal, ExponentRange v, int degree) {
    const double low = v.lo - degree * config.quadratic_frac(), high = v.hi - degree * config.quadratic_frac();
    const bool fits = low >= -regular_exponent_limit && high < regular_exponent_limit;
    proof.signals.push_back({signal, low, high, 0, true, fits});
  };
  add("A, D, r²", hull(hull(e.a, e.d), e.r2), 1);
  add("u", e.u, 1);
  add("u u'", regular.product, 2);
  add("v u, v s", hull(e.a * e.u, e.a * ExponentRange{regular.product.lo / 2, regular.product.hi / 2}), 2);
  add("factors of M", regular.factor, 0);
  add("first product of M", regular.first, 0);
  add("M", regular.weight, 0);
  proof.proved = std::all_of(proof.signals.begin(), proof.signals.end(), [](const auto& s) { return s.fits; });
  return proof;
}

}  // namespace quadrille
