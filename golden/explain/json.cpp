#include "model/support/json.hpp"
#include "golden/explain/explain.hpp"

#include <cmath>
#include <cstdio>

namespace quadrille::explain {
namespace {

/// 17 significant digits; null of nothing and of what is not finite.
std::string digits(const std::optional<double>& v) {
  if (!v || !std::isfinite(*v)) return "null";
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", *v);
  return text;
}

std::string texts(const std::vector<std::string>& list) { return Json::list(list, Json::quoted); }

const char* format_name(Number::Format format) {
  return format == Number::Format::integer ? "integer" : format == Number::Format::fixed ? "fixed" : "significand";
}

std::string fields_json(const std::vector<Field>& fields) {
  Json json;
  for (const Field& field : fields) json.raw(field.label(), field.text());
  return json.text();
}

std::string number_json(const Number& n) {
  Json json;
  json.put("name", n.name)
      .put("meaning", n.meaning)
      .put("unit", n.unit)
      .put("format", format_name(n.format))
      .put("fraction_bits", n.fraction_bits)
      .raw("stored", fields_json(n.stored))
      .raw("value", digits(n.value))
      .put("unused", n.unused)
      .raw("exact", digits(n.exact))
      .put("exact_digits", n.exact_digits)
      .raw("error_ulp", digits(n.exact ? std::optional(n.error_ulp) : std::nullopt))
      .raw("bound_ulp", digits(n.bound_ulp))
      .raw("of_bound", digits(n.of_bound))
      .raw("given", digits(n.given));
  if (!n.other.empty()) json.raw("other", fields_json(n.other)).put("differs", n.differs);
  return json.text();
}

std::string stage_json(const Stage& s) {
  using enum Stage::Compared;
  return Json()
      .put("name", s.name)
      .put("title", s.title)
      .put("unit", s.unit)
      .put("boundary", s.boundary)
      .raw("formulas", texts(s.formulas))
      .put("source", s.source)
      .raw("remarks", texts(s.remarks))
      .put("compared", s.compared == no     ? "no"
                       : s.compared == same ? "same"
                                            : "differs")
      .raw("numbers", Json::list(s.numbers, number_json))
      .text();
}

std::string edge_json(const Edge& e) {
  return Json()
      .put("name", e.name)
      .raw("value", digits(e.value))
      .raw("distance", digits(e.distance))
      .put("sign", e.sign)
      .put("tie", e.tie)
      .put("why", e.why)
      .text();
}

}  // namespace

std::string to_json(const Explanation& e) {
  constexpr std::array rejects{"none", "empty", "behind", "depth", "line", "culled", "outside"};
  return Json()
      .raw("quad", std::to_string(e.quad))
      .raw("index", std::to_string(e.index))
      .raw("x", std::to_string(e.x))
      .raw("y", std::to_string(e.y))
      .put("outcome", outcome_name(e.outcome))
      .put("reject", rejects[static_cast<std::size_t>(e.reject)])
      .put("why", e.why)
      .raw("missed_by", digits(e.outcome == Outcome::outside ? std::optional(e.missed_by) : std::nullopt))
      .put("seen", e.seen)
      .put("homogeneous", e.homogeneous)
      .put("clause", e.clause)
      .put("front", e.front)
      .raw("edges", Json::list(e.edges, edge_json))
      .put("place", e.place)
      .raw("flags", texts(e.flags))
      .raw("remarks", texts(e.remarks))
      .raw("stages", Json::list(e.stages, stage_json))
      .text();
}

}  // namespace quadrille::explain
