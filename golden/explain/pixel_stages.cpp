#include "golden/analysis/error_bound.hpp"
#include "golden/explain/numbers.hpp"
#include "golden/explain/stages.hpp"
#include "golden/reference/port_number.hpp"
#include "golden/reference/rsqrt.hpp"
#include "model/pixel/root_ratio.hpp"
#include "model/port/boundaries.hpp"
#include "model/port/snap.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace quadrille::explain {
namespace {

std::string at(const char* name, std::size_t i) { return name + std::to_string(i); }

class PixelStages {
 public:
  PixelStages(const Subject& s, const JudgedQuad& judged)
      : s_(s),
        c_(s.config()),
        p_(s.machine.trace),
        view_(s.snapped, p_.x, p_.y),
        exact_(s.snapped, judged.truth(), s.machine, s.context),
        held_((s.state().skip & skip_operands) != 0 && (p_.two_corner || p_.on_vertex)),
        claimed_(judged.bounded() && !judged.may_cancel()) {}

  Stage differences() const {
    Stage stage{
        "diff",
        "Areas, dot products and squared distances at the pixel",
        "forward_difference, law_of_cosines",
        "diff",
        {"A_ij = S_i × S_j, D_ij = S_i · S_j, R²_i = |S_i|², with S_i = (X_i - W_i x, Y_i - W_i y)",
         s_.machine.setup.homogeneous ? "from the tile's functions"
                                      : "A and R² from the tile's functions; D_ij = (R²_i + R²_j - |V_i - V_j|²) / 2"},
        "Hormann & Tarini, section 4.2: A_i, D_i, and the squares of r_i",
        {},
        {},
        {}};
    if (c_.qdrop() == 0)
      stage.remarks.push_back("Integers: nothing is rounded up to here.");
    else
      stage.remarks.push_back("quadratic_frac_bits drops " + std::to_string(c_.qdrop()) + " bits of D and R².");
    each(Boundary::diff, stage, [&](Draft& d, std::size_t i) {
      if (d.stem == "a") d.number.name = std::string("A") + pair_name(i), integer(d, view_.linear(i).value, true);
      if (d.stem == "d") d.number.name = std::string("D") + pair_name(i), integer(d, view_.quadratic(i).value, false);
      if (d.stem == "r2") d.number.name = at("R²", i), integer(d, view_.quadratic(linear_count + i).value, false);
    });
    return stage;
  }

  Stage significands() const {
    Stage stage{
        "norm",
        "The leading " + std::to_string(c_.significand_bits) + " bits of A, D and R²; which special case the pixel is",
        "normalise, singular_class",
        "norm",
        {"number = ± sig · 2^(exp - " + std::to_string(c_.significand_bits - 1) + "), the rest is cut off",
         "corner: R² = 0. On an edge: A = 0 and D < 0"},
        "",
        {},
        {},
        {}};
    const auto unit = std::ldexp(1.0, -c_.quadratic_frac());
    each(Boundary::norm, stage, [&](Draft& d, std::size_t i) {
      if (d.stem == "a")
        d.number.name = std::string("A") + pair_name(i), cut(d, view_.linear(i).value, held_);
      else if (d.stem == "d")
        d.number.name = std::string("D") + pair_name(i), cut(d, view_.quadratic(i).value, without_distances());
      else if (d.stem == "r2")
        d.number.name = at("R²", i), cut(d, view_.quadratic(linear_count + i).value, without_distances());
      else
        return;
      if (!d.number.exact) set_unit(d.number, unit, "px²");
    });
    if (held_)
      stage.remarks.push_back(
          "The pixel is on a corner: these numbers are not needed, and held at 0 (skip: operands).");
    return stage;
  }

  Stage roots() const {
    Stage stage{"sqrt",
                "Distances to the corners",
                "sqrt",
                "sqrt",
                {"r_i = sqrt(R²_i), from a table of quadratics"},
                "Hormann & Tarini, section 3: r_i",
                {},
                {},
                {}};
    const TableError error = sqrt_error(c_);
    const double relative = std::max(std::expm1(error.high), -std::expm1(error.low));
    each(Boundary::sqrt, stage, [&](Draft& d, std::size_t i) {
      d.number.name = at("r", i);
      set_raw(d, in_units(exact_.root[i], 1), std::sqrt(std::ldexp(1.0, -c_.quadratic_frac())), "px", relative,
              without_distances());
    });
    return stage;
  }

  Stage ratios() const {
    Stage stage{"ratio",
                "Sum and area of each pair, whose ratio is the tangent of half the angle",
                "mean_value_ratios",
                "ratio",
                {"u = r_i r_j + |D_ij|, v = |A_ij|",
                 "|tan(α_ij/2)| = |r_i r_j - D| / |A| = v/u if D >= 0, u/v if D < 0: no difference of like numbers"},
                "Hormann & Tarini, section 4.2: tan(α_i/2)",
                {},
                {},
                {}};
    const double unit = std::ldexp(1.0, -c_.quadratic_frac());
    each(Boundary::ratio, stage, [&](Draft& d, std::size_t i) {
      d.number.name = (d.stem == "u" ? "u" : "v") + std::string(pair_name(i));
      const bool sum = d.stem == "u";
      set_raw(d, in_units(sum ? exact_.u[i] : exact_.v[i], 2), unit, "px²", sum ? sum_of_roots() : one_ulp,
              sum ? without_distances() : held_);
    });
    return stage;
  }

  Stage weights() const {
    Stage stage{"weight", "The corners' weights, up to a common factor", "mean_value_weights", "weight", {}, "", {}, {},
                {}};
    if (p_.two_corner) {
      stage.formulas = {"Two corners i, j are at the pixel: M_i = |k_j|, M_j = |k_i|, the others 0"};
    } else if (p_.on_vertex) {
      stage.formulas = {"One corner is at the pixel: its M is 1, the others 0"};
    } else if (p_.two_edge) {
      stage.formulas = {"Two edges meet at the pixel: the mean of the two interpolations along them",
                        "M_i = r of the edge's other end · |r k + r k of the other edge|"};
    } else if (s_.machine.data.plane) {
      stage.formulas = {"Plane quad: areas of the triangle 012 or 023 that the pixel is in, for M"};
    } else {
      stage.formulas = {
          "M_0 : M_1 : M_2 : M_3 = a b c : a : c : b", "a = sqrt(q23/q01), b = sqrt(q12/q30), c = sqrt(q13/q20)",
          "q_ij = r_i r_j + D_ij of an edge, r_i r_j - D_ij of a diagonal: u, or v²/u where it would cancel"};
      stage.source = "Hormann & Tarini, eq. (8): M_i = (t_{i-1} + t_i) / R_i, multiplied out";
      const auto ratio = [&](std::size_t near, std::size_t far) {
        const RootRatio r = root_ratio(p_, near, far, s_.context);
        char text[32];
        const double num = std::ldexp(r.num.sig, r.num.exp), den = std::ldexp(r.den.sig, r.den.exp);
        std::snprintf(text, sizeof text, "%.6g", num / den);
        return std::string(text);
      };
      stage.remarks.push_back("Here a = " + ratio(0, 2) + ", b = " + ratio(3, 1) + ", c = " + ratio(4, 5) + ".");
    }
    stage.remarks.push_back("exact: scaled so that the sum of M |k| is the same; a common factor changes no output.");
    each(Boundary::weight, stage, [&](Draft& d, std::size_t i) {
      d.number.name = at("M", i);
      // The share of λ' that is off, where no sum cancels.
      std::optional<double> bound;
      if (claimed_ && s_.state().perspective)
        bound = weight_bound(c_) * static_cast<double>(exact_.den_k) /
                golden::port_value(s_.snapped.vertex[i].k, c_.significand_bits);
      set_exact(d.number, {exact_.m[i], 1, "", {}, bound, {}});
    });
    return stage;
  }

  Stage sums() const {
    Stage stage{
        "sum",
        "Weighted sums",
        "interpolate",
        "sum",
        {s_.state().perspective ? "sums over the corners of M k, M W, M Z, M b"
                                : "sums over the corners of M k (here k is W: perspective is off), M W, M Z, M b"},
        "Hormann & Tarini, eqs. (4), (10), (11)",
        {},
        {},
        {}};
    each(Boundary::sum, stage, [&](Draft& d, std::size_t i) {
      const bool depth = d.stem == "z", attribute = d.stem == "attr";
      d.number.name = attribute           ? "sum M b." + std::to_string(i)
                      : depth             ? "sum M Z"
                      : d.stem == "den_k" ? "sum M k"
                                          : "sum M W";
      const bool skips = (s_.state().skip & skip_operands) != 0;
      if (attribute) d.number.unused = i >= s_.attributes();
      if (depth) d.number.unused = !s_.state().depth;
      if (d.stem == "den_k") d.number.unused = s_.attributes() == 0;
      if (d.stem == "den_w") d.number.unused = !s_.state().depth && !s_.machine.data.hull;
      if (d.number.unused && (skips || attribute)) return;
      d.number.unused = false;
      set_exact(d.number, {attribute           ? exact_.num_a[i]
                           : depth             ? exact_.num_z
                           : d.stem == "den_k" ? exact_.den_k
                                               : exact_.den_w,
                           1,
                           "",
                           {},
                           {},
                           {}});
    });
    if (s_.attributes() < static_cast<std::size_t>(c_.attribute_slots))
      std::erase_if(stage.numbers, [](const Number& n) { return n.unused && n.name.starts_with("sum M b"); });
    return stage;
  }

  Stage reciprocals() const {
    Stage stage{"reciprocal",
                "One division for all values, as a product",
                "reciprocal",
                "",
                {"1 / sum M k, 1 / sum M W, from a table of quadratics"},
                "",
                {},
                {},
                {}};
    const auto add = [&](const char* name, const PipelineFloat& of, Float113 exact) {
      if (of.sig == 0) return;
      Number n = significand_number(reciprocal(of, s_.context.recip_table, s_.context.format), c_.significand_bits);
      n.name = name;
      n.meaning = "reciprocal of that sum";
      set_exact(n, {exact == 0 ? exact : 1 / exact, 1, "", {}, {}, {}});
      stage.numbers.push_back(std::move(n));
    };
    add("1/sum M k", p_.den_k, exact_.den_k);
    add("1/sum M W", p_.den_w, exact_.den_w);
    return stage;
  }

  Stage fragment(const AllowedErrors& allowed, const golden::ReferenceSample* given) const {
    Stage stage{"fragment",
                "What leaves the machine",
                "fragment_output",
                "fragment",
                {"attribute = base + sum M b / sum M k, rounded to nearest",
                 "window z = base + sum M Z / sum M W, rounded to nearest, not beyond the corners'"},
                "Hormann & Tarini, eqs. (11) and (4)",
                {},
                {},
                {}};
    if (c_.qdrop() != 0) stage.remarks.push_back("No bound is claimed where quadratic_frac_bits drops bits.");
    if (!p_.drawn) stage.remarks.push_back("The fragment is discarded: this is what it would have been.");
    const auto limit = scaled(Float113(c_.attribute_limit()), -c_.attribute_frac());
    for (Draft& d : drafts_of([&](auto& f) { visit(p_.fragment, c_, f); })) {
      Number& n = d.number;
      const auto i = static_cast<std::size_t>(std::max(d.index, 0));
      n.name = d.stem;
      if (d.stem == "attr") {
        if (i >= s_.attributes()) continue;
        n.name = at("a", i);
        const Float113 exact = std::min(std::max(exact_.attribute[i], -limit), limit);
        if (exact != exact_.attribute[i])
          stage.remarks.push_back("a" + std::to_string(i) + " is clamped to its format.");
        set_exact(n, {exact, 1, "", {}, bound(allowed.attribute[i]), {}});
        if (given != nullptr) n.given = given->attribute[i];
      }
      if (d.stem == "depth") {
        n.name = "z";
        n.unused = !s_.state().depth;
        // -1 stands for below 0.
        if (!n.unused) set_exact(n, {std::max(exact_.z, Float113(0)), 1, "", {}, bound(allowed.depth), {}});
        if (!n.unused && given != nullptr) n.given = given->z;
      }
      stage.numbers.push_back(std::move(n));
    }
    return stage;
  }

  /// As the machine measures them: attributes that are 1 at one corner and 0 at the others.
  Stage lambda(const AllowedErrors& allowed, const golden::ReferenceSample* given) const {
    Stage stage{"lambda",
                "The weights that every attribute has",
                "fragment_output",
                "",
                {s_.state().perspective ? "λ'_i = M_i k_i / sum M k" : "λ_i = M_i W_i / sum M W"},
                "Hormann & Tarini, eq. (10)",
                {},
                {},
                {}};
    stage.remarks.push_back(
        "Measured as an attribute that is 1 at this corner and 0 at the others. All four add up to 1.");
    PipelineContext context = s_.context;
    context.state.attributes = 1;
    for (std::size_t i = 0; i < 4; ++i) {
      WindowQuad quad = *s_.given;
      for (std::size_t j = 0; j < 4; ++j) quad.attribute[j] = {i == j ? 1.0 : 0.0};
      QuadData data = quad_data(snap_quad(quad, c_, context.state), s_.machine.setup, c_, context.state);
      PixelTrace trace = p_;
      interpolate(trace, data, context);
      fragment_output(trace, data, context);
      Number n;
      n.name = at("λ'", i);
      n.meaning = "weight of corner " + std::to_string(i);
      n.format = Number::Format::fixed;
      n.fraction_bits = c_.attribute_frac();
      n.stored = {{"attr", -1, c_.attr_out_bits(), true, field_bits(trace.fragment.attribute[0])}};
      set_exact(n, {exact_.lambda[i], 1, "", {}, claimed_ ? bound(allowed.weight[i]) : std::nullopt, {}});
      if (given != nullptr) n.given = given->lambda[i];
      stage.numbers.push_back(std::move(n));
    }
    return stage;
  }

  const golden::ReferenceSample& truth() const { return exact_.truth; }

 private:
  /// The fields of a boundary of the pixel; name(draft, element) names them and sets what is exact.
  template <class Name>
  void each(Boundary boundary, Stage& stage, Name&& name) const {
    for (Draft& d : drafts_of([&](auto& f) { visit(p_, boundary, c_, f); })) {
      if (d.stem == "slot") continue;
      if (d.number.format == Number::Format::integer) d.number.name = d.stem;
      name(d, static_cast<std::size_t>(std::max(d.index, 0)));
      stage.numbers.push_back(std::move(d.number));
    }
  }

  void integer(Draft& d, __int128 exact, bool all_bits) const {
    std::optional<double> bound;
    if (all_bits || c_.qdrop() == 0) bound = 0;
    set_exact(d.number, {scaled(Float113(exact), -2 * c_.frac()), 1, "px²", bound, {}, {}});
  }

  /// Units of 2^-FRAC to the power of `dimension` as those of normalised numbers, 2^-quadratic_frac of squares.
  Float113 in_units(Float113 v, int dimension) const {
    const int halves = c_.qdrop() * dimension;
    if (halves % 2 == 0) return scaled(v, -halves / 2);
    return scaled(v * 2 * golden::rsqrt(2), -(halves + 1) / 2);
  }

  void cut(Draft& d, __int128 exact, bool unused) const {
    d.number.unused = unused;
    if (unused) return;
    const Float113 v = scaled(Float113(exact), c_.quadratic_frac() - 2 * c_.frac());
    std::optional<double> bound;
    if (c_.qdrop() == 0 || d.stem == "a") bound = 1;
    set_exact(d.number, {v, std::ldexp(1.0, -c_.quadratic_frac()), "px²", bound, {}, {}});
  }

  static constexpr double one_ulp = -1;
  /// `relative`: the bound of the error beside the exact number, or one_ulp.
  void set_raw(Draft& d, Float113 exact, double scale, const char* unit, double relative, bool unused) const {
    d.number.unused = unused;
    if (unused) return set_unit(d.number, scale, unit);
    Beside beside{exact, scale, unit, {}, {}, {}};
    if (c_.qdrop() == 0 && relative == one_ulp) beside.ulps = 1;
    if (c_.qdrop() == 0 && relative != one_ulp) beside.absolute = relative * static_cast<double>(exact);
    set_exact(d.number, beside);
  }

  /// Relative error of r r' + |D| (golden/analysis/README.md, step 2): two roots, D's truncation, the sum's.
  double sum_of_roots() const {
    const TableError root = sqrt_error(c_);
    const double place = std::ldexp(1.0, 1 - c_.significand_bits);
    const double sum = std::log1p(place * (1 + std::ldexp(1.0, -c_.align_guard_bits)));
    return std::max(std::expm1(2 * root.high), -std::expm1(std::min(2 * root.low, -std::log1p(place)) - sum));
  }

  /// Where the sum of M W may cancel the bound is of this pixel, or infinite.
  std::optional<double> bound(double value) const {
    if (c_.qdrop() != 0 || !std::isfinite(value)) return std::nullopt;
    return value;
  }
  bool without_distances() const { return held_ || (s_.machine.data.plane); }

  const Subject& s_;
  const Config& c_;
  const PixelTrace& p_;
  ExactView view_;
  ExactPixel exact_;
  bool held_;     ///< numbers that a pixel on a corner does not need
  bool claimed_;  ///< there is a bound
};

}  // namespace

std::vector<Stage> pixel_stages(const Subject& s) {
  const Bounds bounds(s.config());
  const JudgedQuad judged(s.snapped, s.config(), bounds, s.state());
  const PixelStages stages(s, judged);
  const int x = s.machine.trace.x, y = s.machine.trace.y;
  const AllowedErrors allowed = ErrorBounds(judged, s.config(), s.state()).at(stages.truth(), x, y);
  std::optional<golden::ReferenceSample> given;
  if (s.given != nullptr) given = golden::TruthQuad(*s.given, s.state()).sample(x, y);
  if (given && !given->covered) given.reset();
  const golden::ReferenceSample* as_given = given ? &*given : nullptr;
  std::vector<Stage> all{
      stages.differences(), stages.significands(), stages.roots(),       stages.ratios(),
      stages.weights(),     stages.sums(),         stages.reciprocals(), stages.fragment(allowed, as_given)};
  if (s.given != nullptr && !s.machine.data.plane) all.push_back(stages.lambda(allowed, as_given));
  return all;
}

}  // namespace quadrille::explain
