#include "golden/explain/layout.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

namespace quadrille::explain {

const char* const legend =
    "exact: the same formula in 113 bits on the snapped corners. ulp: the error, value - exact, in last\n"
    "stored places. bound: |error| as a part of what is proved or specified; 'none' means no error is\n"
    "possible, a blank that no bound is known. unsnapped: exact, of the corners as given, before they\n"
    "became integers.";

namespace {

std::string format(const char* how, double v) {
  char text[40];
  std::snprintf(text, sizeof text, how, v);
  return text;
}

/// Code points: every character here has the width of one.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, [](char c) { return (c & 0xc0) != 0x80; }));
}

std::string padded(const std::string& text, std::size_t width, bool right) {
  const std::string space(width - std::min(width, width_of(text)), ' ');
  return right ? space + text : text + space;
}

/// Rows of cells below one another; the first column is left-aligned, the others right.
class Table {
 public:
  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  std::string text(const std::string& indent) const {
    if (rows_.size() < 2) return "";  // nothing below the head
    std::vector<std::size_t> width;
    for (const auto& row : rows_)
      for (std::size_t i = 0; i < row.size(); ++i) {
        if (i == width.size()) width.push_back(0);
        width[i] = std::max(width[i], width_of(row[i]));
      }
    std::string out;
    for (const auto& row : rows_) {
      std::string line = indent;
      for (std::size_t i = 0; i < row.size(); ++i)
        line += (i == 0 ? "" : "  ") + padded(row[i], width[i], i != 0 && i != left_);
      out += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    }
    return out;
  }
  /// This column is left-aligned too.
  void left(std::size_t column) { left_ = column; }

 private:
  std::vector<std::vector<std::string>> rows_;
  std::size_t left_ = 0;
};

/// Lines of at most 100 columns; those behind the first begin with `indent` spaces.
std::string wrapped(const std::string& text, std::size_t indent) {
  std::string out, line;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at + 1), text.size());
    const std::string word = text.substr(at, end - at);
    if (width_of(line) + width_of(word) > 100 && line.find_first_not_of(' ') != std::string::npos) {
      out += line + "\n";
      line = std::string(indent - 1, ' ') + word;
    } else {
      line += word;
    }
    at = end;
  }
  return out + line + "\n";
}

std::string joined(const std::vector<std::string>& list, const char* between) {
  std::string out;
  for (const std::string& one : list) out += (out.empty() ? "" : between) + one;
  return out;
}

/// A bit for each pixel of a row, or for each clause of expression (12), or for each flag.
bool is_mask(const Number& n) {
  return n.name == "mask" || n.name == "visible" || n.name == "flags" ||
         (n.stored.front().width > 1 && (n.name == "front" || n.name == "tie"));
}
std::string binary(const Field& field) {
  std::string text = "0b";
  for (int bit = field.width; bit-- > 0;) text += (field.value >> bit & 1) != 0 ? '1' : '0';
  return text;
}

std::string stage_text(const Stage& stage, std::size_t place, bool whole) {
  std::string out = std::to_string(place) + ". " + stage.title + "  [" + stage.name + "]";
  if (stage.compared != Stage::Compared::no)
    out += stage.compared == Stage::Compared::same ? "  (RTL: the same)" : "  (RTL: differs)";
  out += "\n";
  for (const std::string& formula : stage.formulas) out += wrapped("     " + formula, 7);
  if (!stage.source.empty()) out += "     " + stage.source + "\n";
  for (const std::string& remark : stage.remarks) out += wrapped("   - " + remark, 5);
  Table table;
  const bool beside = std::ranges::any_of(stage.numbers, [](const Number& n) { return n.exact.has_value(); });
  const bool given = std::ranges::any_of(stage.numbers, [](const Number& n) { return n.given.has_value(); });
  std::vector<std::string> head{"", "stored", "value"};
  if (beside) head.insert(head.end(), {"exact", "ulp", "bound"});
  if (given) head.emplace_back("unsnapped");
  table.add(std::move(head));
  std::size_t left_out = 0, not_needed = 0;
  for (const Number& n : stage.numbers) {
    if (!whole && !n.differs && (n.unused || is_coefficient(stage, n))) {
      ++(n.unused ? not_needed : left_out);
      continue;
    }
    std::vector<std::string> row{n.name, stored_text(n, n.stored), value_text(n)};
    if (beside && n.exact) row.insert(row.end(), {exact_text(n), ulp_text(n), bound_text(n)});
    if (n.given) row.push_back(real_text(*n.given));
    table.add(std::move(row));
    if (n.differs) table.add({"  RTL", stored_text(n, n.other)});
  }
  out += table.text("     ");
  if (not_needed > 0)
    out += "     (" + std::to_string(not_needed) + (not_needed == 1 ? " number is" : " numbers are") +
           " not needed at this pixel, and 0)\n";
  if (left_out > 0) out += "     (" + std::to_string(left_out) + " coefficients more with --verbose)\n";
  return out;
}

}  // namespace

std::string real_text(double v) { return format("%.10g", v); }

std::string stored_text(const Number& n, const std::vector<Field>& fields) {
  if (n.format == Number::Format::integer) return is_mask(n) ? binary(fields.front()) : fields.front().text();
  if (n.format == Number::Format::fixed) return fields.front().text() + " / 2^" + std::to_string(n.fraction_bits);
  const Field &sig = fields.back(), &exp = fields[fields.size() - 2];
  if (sig.value == 0) return "0";
  const std::string sign = fields.size() == 3 && fields.front().value != 0 ? "-" : "";
  return sign + sig.text() + " · 2^" + std::to_string(static_cast<std::int64_t>(exp.value) - n.fraction_bits);
}

std::string value_text(const Number& n) {
  if (n.unused) return "not needed";
  if (n.format == Number::Format::integer) return "";
  return real_text(n.value) + (n.unit.empty() ? "" : " " + n.unit);
}

std::string exact_text(const Number& n) { return n.exact ? real_text(*n.exact) : ""; }

std::string ulp_text(const Number& n) {
  if (!n.exact) return "";
  // Less is the rounding of 113 bits.
  return std::fabs(n.error_ulp) < 1e-9 ? "0" : format(std::fabs(n.error_ulp) < 1e4 ? "%+.2f" : "%+.2e", n.error_ulp);
}

std::string bound_text(const Number& n) {
  if (!n.of_bound) return "";
  if (n.bound_ulp && *n.bound_ulp == 0 && *n.of_bound == 0) return "none";
  return format("%.3f", *n.of_bound);
}

std::string sentence(const std::string& why) {
  std::string text = why;
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text + ".";
}

std::string headline(const Explanation& e) {
  std::string text = "quad " + std::to_string(e.quad) + ": ";
  if (e.outcome == Outcome::drawn) return text + (e.seen ? "drawn" : "drawn, but another quad is seen here");
  return text + "not drawn (" + outcome_name(e.outcome) + ")";
}

bool is_coefficient(const Stage& stage, const Number& n) {
  if (stage.name != "setup" && stage.name != "tile") return false;
  return n.name.ends_with(" gx") || n.name.ends_with(" gy") || n.name.ends_with(" q") || n.name.starts_with("|V");
}

std::string to_text(const Explanation& e, bool whole) {
  std::string out = "Pixel (" + std::to_string(e.x) + ", " + std::to_string(e.y) + "), " + headline(e) + "\n" +
                    wrapped("  " + sentence(e.why), 4);
  if (e.outcome == Outcome::refused) return out;
  if (e.covered()) {
    out += "  The pixel centre is " + e.place + ".";
    if (!e.flags.empty()) out += " Flags: " + joined(e.flags, ", ") + ".";
    out += "\n";
  }
  for (const std::string& remark : e.remarks) out += wrapped("  " + sentence(remark), 4);
  Table edges;
  edges.add({"edge function", "at the pixel", "centre is", "counts as"});
  for (const Edge& edge : e.edges)
    edges.add({edge.name, real_text(edge.value) + " px²", format("%.4g px", std::fabs(edge.distance)) + " from it",
               std::string(edge.sign > 0   ? "positive"
                           : edge.sign < 0 ? "negative"
                                           : "neither") +
                   (edge.value == 0 ? " (" + std::string(edge.tie ? "tie: " : "") + edge.why + ")" : "")});
  edges.left(3);
  out += edges.text("     ");
  for (std::size_t i = 0; i < e.stages.size(); ++i) out += "\n" + stage_text(e.stages[i], i + 1, whole);
  if (!e.stages.empty()) out += std::string("\n") + legend + "\n";
  return out;
}

namespace {

std::string near_text(const Explanation& e, bool nearest) {
  if (!nearest) return ": ";
  return std::isfinite(e.missed_by) ? ", the nearest (its outline is " + format("%.3g", e.missed_by) + " px away): "
                                    : ", for one: ";
}

}  // namespace

const Explanation* nearest_outside(std::span<const Explanation> all) {
  const Explanation* nearest = nullptr;
  for (const Explanation& e : all)
    if (e.outcome == Outcome::outside && (nearest == nullptr || e.missed_by < nearest->missed_by)) nearest = &e;
  return nearest;
}

std::string summary(std::span<const Explanation> all) {
  std::map<Outcome, std::size_t> count;
  const Explanation* const nearest = nearest_outside(all);
  for (const Explanation& e : all) ++count[e.outcome];
  std::string out;
  for (const auto& [outcome, quads] : count) {
    if (outcome == Outcome::drawn) continue;
    out += "  " + std::to_string(quads) + " " + outcome_name(outcome) + "\n";
    std::size_t shown = 0;
    for (const Explanation& e : all)
      if (e.outcome == outcome && (outcome != Outcome::outside || &e == nearest)) {
        if (outcome == Outcome::left_out && e.reject == QuadReject::empty) continue;
        if (++shown > 3) break;
        out += wrapped("    quad " + std::to_string(e.quad) + near_text(e, &e == nearest) + e.why, 6);
      }
  }
  return out;
}

}  // namespace quadrille::explain
