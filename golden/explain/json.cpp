#include "golden/explain/explain.hpp"

#include <cmath>
#include <cstdio>
#include <string_view>

namespace quadrille::explain {
namespace {

/// Writes values in order; commas come by themselves.
class Writer {
 public:
  void key(std::string_view name) {
    string(name);
    out_ += ": ";
    fresh_ = true;
  }
  void open(char bracket) {
    separate();
    out_ += bracket;
    fresh_ = true;
  }
  void close(char bracket) {
    out_ += bracket;
    fresh_ = false;
  }
  void string(std::string_view text) {
    separate();
    out_ += '"';
    for (const char c : text) {
      if (c == '"' || c == '\\') out_ += '\\';
      if (static_cast<unsigned char>(c) >= 0x20) {
        out_ += c;
      } else {
        char code[8];
        std::snprintf(code, sizeof code, "\\u%04x", static_cast<unsigned>(c));
        out_ += code;
      }
    }
    out_ += '"';
  }
  void raw(std::string_view text) {
    separate();
    out_ += text;
  }
  /// 17 significant digits; what is not finite becomes null.
  void number(double v) {
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", v);
    raw(std::isfinite(v) ? text : "null");
  }
  void number(const std::optional<double>& v) { v ? number(*v) : raw("null"); }
  void boolean(bool v) { raw(v ? "true" : "false"); }
  template <class List, class Write>
  void list(const List& list, Write&& write) {
    open('[');
    for (const auto& one : list) write(one);
    close(']');
  }
  void strings(const std::vector<std::string>& list) {
    this->list(list, [&](const std::string& one) { string(one); });
  }
  std::string take() { return std::move(out_); }

 private:
  void separate() {
    if (!fresh_) out_ += ", ";
    fresh_ = false;
  }

  std::string out_;
  bool fresh_ = true;
};

const char* format_name(Number::Format format) {
  return format == Number::Format::integer ? "integer" : format == Number::Format::fixed ? "fixed" : "significand";
}

void write_fields(Writer& w, const std::vector<Field>& fields) {
  w.open('{');
  for (const Field& field : fields) {
    w.key(field.label());
    w.raw(field.text());
  }
  w.close('}');
}

void write(Writer& w, const Number& n) {
  w.open('{');
  w.key("name"), w.string(n.name);
  w.key("meaning"), w.string(n.meaning);
  w.key("unit"), w.string(n.unit);
  w.key("format"), w.string(format_name(n.format));
  w.key("fraction_bits"), w.raw(std::to_string(n.fraction_bits));
  w.key("stored"), write_fields(w, n.stored);
  w.key("value"), w.number(n.value);
  w.key("unused"), w.boolean(n.unused);
  w.key("exact"), w.number(n.exact);
  w.key("exact_digits"), w.string(n.exact_digits);
  w.key("error_ulp"), w.number(n.exact ? std::optional(n.error_ulp) : std::nullopt);
  w.key("bound_ulp"), w.number(n.bound_ulp);
  w.key("of_bound"), w.number(n.of_bound);
  w.key("given"), w.number(n.given);
  if (!n.other.empty()) {
    w.key("other"), write_fields(w, n.other);
    w.key("differs"), w.boolean(n.differs);
  }
  w.close('}');
}

void write(Writer& w, const Stage& s) {
  w.open('{');
  w.key("name"), w.string(s.name);
  w.key("title"), w.string(s.title);
  w.key("unit"), w.string(s.unit);
  w.key("boundary"), w.string(s.boundary);
  w.key("formulas"), w.strings(s.formulas);
  w.key("source"), w.string(s.source);
  w.key("remarks"), w.strings(s.remarks);
  w.key("compared");
  w.string(s.compared == Stage::Compared::no ? "no" : s.compared == Stage::Compared::same ? "same" : "differs");
  w.key("numbers"), w.list(s.numbers, [&](const Number& n) { write(w, n); });
  w.close('}');
}

void write(Writer& w, const Edge& e) {
  w.open('{');
  w.key("name"), w.string(e.name);
  w.key("value"), w.number(e.value);
  w.key("distance"), w.number(e.distance);
  w.key("sign"), w.raw(std::to_string(e.sign));
  w.key("tie"), w.boolean(e.tie);
  w.key("why"), w.string(e.why);
  w.close('}');
}

}  // namespace

std::string to_json(const Explanation& e) {
  constexpr std::array rejects{"none", "empty", "behind", "depth", "line", "culled", "outside"};
  Writer w;
  w.open('{');
  w.key("quad"), w.raw(std::to_string(e.quad));
  w.key("index"), w.raw(std::to_string(e.index));
  w.key("x"), w.raw(std::to_string(e.x));
  w.key("y"), w.raw(std::to_string(e.y));
  w.key("outcome"), w.string(outcome_name(e.outcome));
  w.key("reject"), w.string(rejects[static_cast<std::size_t>(e.reject)]);
  w.key("why"), w.string(e.why);
  w.key("missed_by"), w.number(e.outcome == Outcome::outside ? std::optional(e.missed_by) : std::nullopt);
  w.key("seen"), w.boolean(e.seen);
  w.key("homogeneous"), w.boolean(e.homogeneous);
  w.key("clause"), w.raw(std::to_string(e.clause));
  w.key("front"), w.boolean(e.front);
  w.key("edges"), w.list(e.edges, [&](const Edge& edge) { write(w, edge); });
  w.key("place"), w.string(e.place);
  w.key("flags"), w.strings(e.flags);
  w.key("remarks"), w.strings(e.remarks);
  w.key("stages"), w.list(e.stages, [&](const Stage& stage) { write(w, stage); });
  w.close('}');
  return w.take();
}

}  // namespace quadrille::explain
