#include "golden/explain/layout.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>

namespace quadrille::explain {
namespace {

// Colours follow the reader's system; below 620 px a row of a table becomes a block of its own.
constexpr std::string_view style = R"css(
:root { color-scheme: light dark; --line: #d0d0d0; --soft: #666; --mark: #1f5fa8; --fill: #e3ecf7; --bar: #a9c8ef; --bad: #a11; --page: #fff; --text: #1a1a1a }
@media (prefers-color-scheme: dark) {
  :root { --line: #444; --soft: #aaa; --mark: #8ab8f0; --fill: #223044; --bar: #3a5f94; --bad: #ff8a80; --page: #161616; --text: #e8e8e8 }
}
* { box-sizing: border-box }
body { margin: 0 auto; max-width: 62rem; padding: 1rem; background: var(--page); color: var(--text);
  font: 15px/1.45 system-ui, sans-serif; overflow-wrap: anywhere }
h1 { font-size: 1.5rem; margin: 0 0 .3rem } h2 { font-size: 1.2rem; margin: 2rem 0 .3rem } h2.first { margin-top: 1rem }
code, .formula, td, th { font-family: ui-monospace, monospace; font-size: .86rem }
p { margin: .4rem 0 } ul { margin: .3rem 0; padding-left: 1.2rem }
.soft { color: var(--soft) } .bad { color: var(--bad); font-weight: bold }
.quad { display: flex; flex-wrap: wrap; gap: 1rem; align-items: flex-start }
.quad > div { flex: 1 1 22rem } .quad svg { flex: 0 1 16rem; width: 16rem; max-width: 100%; height: auto; border: 1px solid var(--line) }
svg text { font: 9px ui-monospace, monospace; fill: var(--text) }
details { border: 1px solid var(--line); border-radius: 6px; margin: .5rem 0; padding: 0 .7rem }
summary { cursor: pointer; padding: .45rem 0; font-weight: 600 } summary .soft { font-weight: normal }
.formula { margin: .2rem 0; padding: .15rem .5rem; background: var(--fill); border-radius: 4px; white-space: pre-wrap }
table { border-collapse: collapse; width: 100%; margin: .5rem 0 .8rem }
td, th { text-align: right; padding: .12rem .5rem; border-bottom: 1px solid var(--line); vertical-align: top }
td:first-child, th:first-child, td.left, th.left { text-align: left } th { color: var(--soft); font-weight: normal }
.share { background: linear-gradient(to left, var(--bar) var(--part), transparent 0) }
@media (max-width: 620px) {
  body { padding: .6rem } thead { display: none } tr { display: block; border-bottom: 1px solid var(--line); padding: .25rem 0 }
  td { display: flex; justify-content: space-between; gap: 1rem; border: 0; padding: 0 .2rem; text-align: right }
  td:first-child { font-weight: bold } td:empty { display: none }
  td[data-label]::before { content: attr(data-label); color: var(--soft); font-weight: normal; flex: none }
}
)css";

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

std::string fixed(double v, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*f", digits, v);
  return text;
}

std::string cell(const std::string& text, const char* label, const std::string& more = "") {
  return "<td data-label=\"" + std::string(label) + "\"" + more + ">" + escaped(text) + "</td>";
}

std::string list_of(const std::vector<std::string>& items) {
  if (items.empty()) return "";
  std::string out = "<ul>";
  for (const std::string& item : items) out += "<li>" + escaped(item) + "</li>";
  return out + "</ul>\n";
}

/// `beside`: with the columns of exact numbers; `given`: with that of corners as given.
std::string number_row(const Number& n, bool beside, bool given) {
  std::string fields;
  for (const Field& field : n.stored) fields += (fields.empty() ? "" : ", ") + field.label() + " = " + field.text();
  const std::string about = escaped(n.meaning + (n.meaning.empty() ? "" : ". ") + fields);
  std::string out = "<tr><td title=\"" + about + "\">" + escaped(n.name) + "</td>";
  out += cell(stored_text(n, n.stored), "stored") + cell(value_text(n), "value");
  if (beside) {
    out += cell(exact_text(n), "exact", n.exact ? " title=\"" + n.exact_digits + "\"" : "");
    out += cell(ulp_text(n), "error, ulp");
    std::string bar;
    if (n.of_bound)
      bar = std::string(" class=\"share") + (*n.of_bound > 1 ? " bad" : "") +
            "\" style=\"--part: " + fixed(100 * std::min(*n.of_bound, 1.0), 1) + "%\"";
    out += cell(bound_text(n), "of bound", bar);
  }
  if (given) out += cell(n.given ? real_text(*n.given) : "", "unsnapped");
  out += "</tr>\n";
  if (n.differs)
    out += "<tr><td class=\"bad\">" + escaped(n.name) + " by the RTL</td>" +
           cell(stored_text(n, n.other), "stored", " class=\"bad\"") + "</tr>\n";
  return out;
}

std::string stage_section(const Stage& s, std::size_t place) {
  double worst = 0;
  bool any = false;  // a number has an exact one beside it
  const bool given = std::ranges::any_of(s.numbers, [](const Number& n) { return n.given.has_value(); });
  const bool differs = s.compared == Stage::Compared::differs;
  for (const Number& n : s.numbers)
    if (n.exact) any = true, worst = std::max(worst, std::fabs(n.error_ulp));
  const bool open = differs || s.name == "stamp" || s.name == "weight" || s.name == "fragment" || s.name == "lambda";
  std::string out =
      std::string("<details") + (open ? " open" : "") + "><summary>" + std::to_string(place) + ". " + escaped(s.title);
  out += " <span class=\"soft\">" + escaped(s.name);
  if (any) out += worst == 0 ? ", no error" : ", largest error " + fixed(worst, 2) + " ulp";
  if (s.compared == Stage::Compared::same) out += ", RTL the same";
  out += "</span>";
  if (differs) out += " <span class=\"bad\">the RTL differs</span>";
  out += "</summary>\n";
  for (const std::string& formula : s.formulas) out += "<div class=\"formula\">" + escaped(formula) + "</div>\n";
  std::string source = escaped(s.source);
  if (!s.unit.empty())
    source += (source.empty() ? "" : ". ") + std::string("RTL: <code>") + escaped(s.unit) + "</code>";
  if (!source.empty()) out += "<p class=\"soft\">" + source + "</p>\n";
  out += list_of(s.remarks);
  out += "<table><thead><tr><th></th><th>stored</th><th>value</th>";
  if (any) out += "<th>exact</th><th>error, ulp</th><th>of bound</th>";
  if (given) out += "<th>unsnapped</th>";
  out += "</tr></thead>\n<tbody>\n";
  for (const Number& n : s.numbers) out += number_row(n, any, given);
  return out + "</tbody></table></details>\n";
}

const Number* find(const Explanation& e, const std::string& name) {
  for (const Stage& stage : e.stages) {
    if (stage.name != "snapping") continue;
    for (const Number& n : stage.numbers)
      if (n.name == name) return &n;
  }
  return nullptr;
}

/// The quad on the screen with the pixel; nothing where a corner is not in front of the eye.
std::string drawing(const Explanation& e) {
  std::array<double, 5> x, y;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::string corner = std::to_string(i);
    const Number *nx = find(e, "X" + corner), *ny = find(e, "Y" + corner), *nw = find(e, "W" + corner);
    if (nx == nullptr || ny == nullptr || nw == nullptr || nw->value <= 0) return "";
    x[i] = nx->value / nw->value;
    y[i] = ny->value / nw->value;
  }
  x[4] = e.x;
  y[4] = e.y;
  const auto [x0, x1] = std::minmax_element(x.begin(), x.end());
  const auto [y0, y1] = std::minmax_element(y.begin(), y.end());
  const double size = std::max({*x1 - *x0, *y1 - *y0, 1.0}), scale = 150 / size;
  const double left = (*x0 + *x1 - size) / 2, top = (*y0 + *y1 - size) / 2;
  const auto px = [&](std::size_t i) { return 25 + (x[i] - left) * scale; };
  const auto py = [&](std::size_t i) { return 25 + (y[i] - top) * scale; };
  std::string out = "<svg viewBox=\"0 0 200 200\" role=\"img\" aria-label=\"The quad and the pixel\">";
  const auto at = [&](std::size_t i) { return fixed(px(i), 2) + "," + fixed(py(i), 2); };
  out += "<polygon points=\"" + at(0) + " " + at(1) + " " + at(2) + " " + at(3) +
         "\" fill=\"var(--fill)\" fill-rule=\"nonzero\" stroke=\"var(--mark)\" stroke-width=\"1.2\"/>";
  out += "<polyline points=\"" + at(0) + " " + at(2) +
         "\" stroke=\"var(--mark)\" stroke-dasharray=\"3 3\" stroke-width=\".8\"/>";
  for (std::size_t i = 0; i < 4; ++i) {
    out += "<polyline points=\"" + at(i) + " " + at(4) + "\" stroke=\"var(--soft)\" stroke-width=\".5\"/>";
    // Away from the middle of the picture.
    const double dx = px(i) < 100 ? -8 : 3, dy = py(i) < 100 ? -4 : 10;
    out +=
        "<text x=\"" + fixed(px(i) + dx, 2) + "\" y=\"" + fixed(py(i) + dy, 2) + "\">" + std::to_string(i) + "</text>";
  }
  out +=
      "<circle cx=\"" + fixed(px(4), 2) + "\" cy=\"" + fixed(py(4), 2) + "\" r=\"2.6\" fill=\"var(--bad)\"/></svg>\n";
  return out;
}

std::string quad_section(const Explanation& e, bool first) {
  std::string out = std::string("<h2") + (first ? " class=\"first\"" : "") + ">" + escaped(headline(e)) +
                    "</h2>\n<div class=\"quad\"><div>\n";
  out += "<p>" + escaped(sentence(e.why)) + "</p>\n";
  if (e.outcome == Outcome::refused) return out + "</div></div>\n";
  if (e.covered()) {
    out += "<p>The pixel centre is " + e.place + ".";
    if (!e.flags.empty()) {
      out += " Flags:";
      for (std::size_t i = 0; i < e.flags.size(); ++i) out += (i == 0 ? " " : ", ") + e.flags[i];
      out += ".";
    }
    out += "</p>\n";
  }
  std::vector<std::string> remarks;
  for (const std::string& remark : e.remarks) remarks.push_back(sentence(remark));
  out += list_of(remarks);
  out +=
      "<table><thead><tr><th class=\"left\">edge function</th><th>at the pixel, px²</th><th>px from its line</th><th "
      "class=\"left\">counts as</th></tr></thead>\n<tbody>\n";
  for (const Edge& edge : e.edges) {
    const std::string sign = edge.sign > 0 ? "positive" : edge.sign < 0 ? "negative" : "neither";
    out += "<tr><td>" + edge.name + "</td>" + cell(real_text(edge.value), "at the pixel, px²") +
           cell(fixed(std::fabs(edge.distance), 3), "px from its line") +
           cell(sign + (edge.value == 0 ? (edge.tie ? ", a tie: " : ": ") + edge.why : ""), "counts as",
                " class=\"left\"") +
           "</tr>\n";
  }
  out += "</tbody></table></div>\n" + drawing(e) + "</div>\n";
  for (std::size_t i = 0; i < e.stages.size(); ++i) out += stage_section(e.stages[i], i + 1);
  return out;
}

}  // namespace

std::string to_html(std::span<const Explanation> explanations, const std::string& title, const std::string& command) {
  std::string out =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
      escaped(title) + "</title>\n<style>";
  out += style;
  out += "</style></head><body>\n<h1>" + escaped(title) + "</h1>\n";
  if (!command.empty()) out += "<p><code>" + escaped(command) + "</code></p>\n";
  out += "<p class=\"soft\">" + escaped(legend) + "</p>\n";
  std::size_t shown = 0;
  for (const bool seen : {true, false})
    for (const Explanation& e : explanations)
      if (e.seen == seen && (e.covered() || explanations.size() == 1)) out += quad_section(e, shown++ == 0);
  if (shown == 0) out += "<p>No quad covers this pixel.</p>\n";
  if (explanations.size() > 1) {
    const std::string others = summary(explanations);
    if (!others.empty())
      out += "<h2>" + std::string(shown == 0 ? "Why not" : "The other quads") + "</h2>\n<div class=\"formula\">" +
             escaped(others) + "</div>\n";
  }
  return out + "</body></html>\n";
}

}  // namespace quadrille::explain
