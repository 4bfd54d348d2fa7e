#include "golden/explain/coverage.hpp"

#include "model/front/inside_expression.hpp"
#include "model/front/quad_reject.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace quadrille::explain {
namespace {

constexpr std::size_t diagonal = 4;

/// One clause of expression (12), for positive or negative edge functions.
struct Clause {
  int number;                              ///< 1 or 2
  int sign;                                ///< 1: as printed, a back face; -1: negated, a front face
  std::array<std::size_t, 2> all, either;  ///< edges; the diagonal has the sign in clause 1, the other in clause 2

  int diagonal_sign() const { return number == 1 ? sign : -sign; }
  /// In the order of SetupResult::visible.
  std::size_t bit() const { return static_cast<std::size_t>((sign < 0 ? 2 : 0) + number - 1); }
};
constexpr std::array<Clause, 4> clauses{
    {{1, 1, {0, 1}, {2, 3}}, {2, 1, {2, 3}, {0, 1}}, {1, -1, {0, 1}, {2, 3}}, {2, -1, {2, 3}, {0, 1}}}};

std::string short_number(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", v);
  return text;
}

const char* sign_word(int sign) { return sign > 0 ? "positive" : "negative"; }
const char* ordinal(int clause) { return clause == 1 ? "first" : "second"; }

Edge edge_of(const Subject& s, std::size_t k) {
  constexpr std::array<const char*, 5> names{"E01", "E12", "E23", "E30", "E20"};
  const std::int64_t code = s.machine.trace.a[k], gx = s.machine.constants.gx[k], gy = s.machine.constants.gy[k];
  Edge edge;
  edge.name = names[k];
  edge.value = std::ldexp(static_cast<double>(code), -2 * s.config().frac());
  const double slope = std::hypot(static_cast<double>(gx), static_cast<double>(gy));
  if (slope > 0) edge.distance = static_cast<double>(code) / slope;
  edge.sign = (code > 0) - (code < 0);
  if (code != 0) return edge;
  edge.sign = s.machine.constants.tie_pos[k] ? 1 : s.machine.constants.tie_neg[k] ? -1 : 0;
  edge.tie = edge.sign != 0;
  if (!edge.tie)
    edge.why = "the corners coincide: neither positive nor negative";
  else if (gx != 0)
    edge.why = std::string(gx > 0 ? "grows" : "falls") + " to the right: " + sign_word(edge.sign);
  else
    edge.why =
        std::string("constant to the right, ") + (gy > 0 ? "grows" : "falls") + " downward: " + sign_word(edge.sign);
  return edge;
}

/// By the machine's own expression, without visibility and culling.
std::optional<Clause> clause_that_holds(const Explanation& e) {
  EdgeSigns signs[5];
  for (std::size_t k = 0; k < 5; ++k) signs[k] = {e.edges[k].sign > 0, e.edges[k].sign < 0};
  for (const Clause& clause : clauses) {
    const InsidePlaces inside = inside_expression(signs, 1u << clause.bit(), Cull::none);
    if ((inside.back | inside.front) != 0) return clause;
  }
  return std::nullopt;
}

std::string holds_text(const Explanation& e, const Clause& c) {
  std::string text = std::string(c.sign < 0 ? "front" : "back") + " face by the " + ordinal(c.number) +
                     " clause of expression (12)" + (c.sign < 0 ? ", negated" : "") + ": E20 is " +
                     sign_word(c.diagonal_sign()) + ", " + e.edges[c.all[0]].name + " and " + e.edges[c.all[1]].name +
                     " are " + sign_word(c.sign) + ", and so is ";
  const bool first = e.edges[c.either[0]].sign == c.sign, second = e.edges[c.either[1]].sign == c.sign;
  text += first ? e.edges[c.either[0]].name : e.edges[c.either[1]].name;
  if (first && second) text += " (and " + e.edges[c.either[1]].name + ")";
  return text;
}

/// The clause with the fewest terms that fail, and these.
std::string outside_text(const Explanation& e) {
  const Clause* nearest = nullptr;
  std::vector<std::string> why;
  double least = 0;
  for (const Clause& c : clauses) {
    std::vector<std::string> failing;
    double far = 0;  // of the failing edges, to choose between clauses
    const auto must = [&](std::size_t k, int sign) {
      const Edge& edge = e.edges[k];
      if (edge.sign == sign) return;
      far += std::fabs(edge.distance);
      const std::string is = edge.sign == 0 ? "has no sign" : std::string("is ") + sign_word(edge.sign);
      failing.push_back(edge.name + " " + is + ", not " + sign_word(sign) + " (" +
                        short_number(std::fabs(edge.distance)) + " px from its line)");
    };
    must(diagonal, c.diagonal_sign());
    for (const std::size_t k : c.all) must(k, c.sign);
    if (e.edges[c.either[0]].sign != c.sign && e.edges[c.either[1]].sign != c.sign) {
      far += std::min(std::fabs(e.edges[c.either[0]].distance), std::fabs(e.edges[c.either[1]].distance));
      failing.push_back("neither " + e.edges[c.either[0]].name + " nor " + e.edges[c.either[1]].name + " is " +
                        sign_word(c.sign));
    }
    if (nearest != nullptr && std::pair(failing.size(), far) >= std::pair(why.size(), least)) continue;
    nearest = &c;
    why = failing;
    least = far;
  }
  std::string text = "no clause of expression (12) holds. Nearest is the ";
  text += std::string(ordinal(nearest->number)) + (nearest->sign < 0 ? ", negated (front face): " : " (back face): ");
  for (std::size_t i = 0; i < why.size(); ++i) text += (i == 0 ? "" : "; ") + why[i];
  return text;
}

/// Of the pixel centre from the quad's outline on the screen; infinite where a corner is not in front of the eye.
double distance_to(const SnappedQuad& quad, int px, int py) {
  std::array<double, 4> x, y;
  for (std::size_t i = 0; i < 4; ++i) {
    const SnappedVertex& v = quad.vertex[i];
    if (v.w <= 0) return std::numeric_limits<double>::infinity();
    x[i] = static_cast<double>(v.x) / v.w - px;
    y[i] = static_cast<double>(v.y) / v.w - py;
  }
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = (i + 1) % 4;
    const double dx = x[j] - x[i], dy = y[j] - y[i], length2 = dx * dx + dy * dy;
    const double t = length2 > 0 ? std::clamp(-(x[i] * dx + y[i] * dy) / length2, 0.0, 1.0) : 0;
    least = std::min(least, std::hypot(x[i] + t * dx, y[i] + t * dy));
  }
  return least;
}

std::string reject_text(QuadReject reject) {
  switch (reject) {
    case QuadReject::empty:
      return "no pixel centre lies both in the quad's bounding box and in the scissor rectangle";
    case QuadReject::behind:
      return "no corner is in front of the eye (no w > 0)";
    case QuadReject::depth:
      return "every depth of the quad is outside [znear, zfar]";
    case QuadReject::line:
      return "the triangles 012 and 023 of expression (12) have no area";
    case QuadReject::culled:
      return "no pixel can have a face that culling keeps";
    case QuadReject::outside:
      return "no triangle of expression (12) with a wanted face meets the scissor rectangle";
    case QuadReject::none:
      break;
  }
  return "";
}

std::string depth_text(const Subject& s) {
  const std::uint32_t code = s.machine.trace.fragment.depth;  // a z below 0 is stored as 0
  const bool far = code > s.context.zfar;
  const std::string z = short_number(std::ldexp(static_cast<double>(code), -s.config().depth_bits));
  const std::string limit = short_number(far ? s.state().zfar : s.state().znear);
  return "covered, but window z" + (z == limit ? "" : " = " + z) + " is " + (far ? "above zfar = " : "below znear = ") +
         limit;
}

}  // namespace

void explain_coverage(const Subject& s, Explanation& out) {
  const DrawState& state = s.state();
  out.homogeneous = s.machine.setup.homogeneous;
  for (std::size_t k = 0; k < 5; ++k) out.edges[k] = edge_of(s, k);
  const std::optional<Clause> clause = clause_that_holds(out);
  if (clause) {
    out.clause = clause->number;
    out.front = clause->sign < 0;
  }
  const auto decide = [&](Outcome outcome, std::string why) {
    out.outcome = outcome;
    out.why = std::move(why);
  };
  out.reject = quad_reject(s.snapped, s.config(), state);
  if (out.reject != QuadReject::none)
    return decide(Outcome::left_out, "the whole quad is left out: " + reject_text(out.reject));
  if (!clause) {
    out.missed_by = distance_to(s.snapped, out.x, out.y);
    return decide(Outcome::outside, outside_text(out));
  }
  const std::string holds = holds_text(out, *clause);
  if ((s.machine.setup.visible >> clause->bit() & 1) == 0)
    return decide(Outcome::behind_eye, holds + "; but that part of the quad is behind the eye: triangle " +
                                           (clause->number == 1 ? "012" : "023") +
                                           " turns the other way as seen from the eye");
  if (state.cull == (out.front ? Cull::front : Cull::back))
    return decide(Outcome::culled, holds + "; such faces are culled");
  if (out.x < state.scissor_x0 || out.x >= state.scissor_x1 || out.y < state.scissor_y0 || out.y >= state.scissor_y1)
    return decide(Outcome::scissor, holds + "; but the pixel is outside the scissor rectangle");
  if (s.machine.trace.drawn) return decide(Outcome::drawn, holds);
  const PipelineFloat& w = s.machine.trace.den_w;
  if (s.machine.data.hull && (w.neg || w.sig == 0))
    return decide(Outcome::eye_in_hull,
                  holds + "; but sum M W is not positive: behind the eye (the eye is in the corners' hull)");
  decide(Outcome::depth_limits, holds + "; " + depth_text(s));
}

void explain_place(const Subject& s, Explanation& out) {
  const PixelTrace& p = s.machine.trace;
  if (p.notch)
    out.remarks.push_back("notch: neighbouring A differ in sign, so an edge turns backward as seen from the pixel");
  if (s.machine.setup.hull)
    out.remarks.push_back("the eye is in the hull of the corners: a pixel is in front of it where sum M W > 0");
  if (s.machine.data.plane)
    out.remarks.push_back("plane quad: areas for weights, which give the same values (skip: plane)");
  const golden::ReferenceSample truth =
      golden::TruthQuad(s.snapped, s.config(), s.state()).sample(p.x, p.y, golden::TruthQuad::Effort::all_bits);
  const unsigned notch = truth.notch && s.config().notch_exact ? flag_notch : 0;
  const unsigned expected = truth.flags | notch, flags = p.fragment.flags & ~unsigned{flag_saturated};
  if (!truth.covered || truth.front != p.front || expected != flags)
    out.remarks.push_back("the truth differs in coverage, face or flags: " + std::to_string(expected) + ", not " +
                          std::to_string(flags));
  if (truth.visible != (out.outcome != Outcome::eye_in_hull))
    out.remarks.push_back("the truth has this pixel " + std::string(truth.visible ? "in front of" : "behind") +
                          " the eye");
}

}  // namespace quadrille::explain
