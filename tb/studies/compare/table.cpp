#include "tb/studies/compare/table.hpp"

#include "tb/support/csv.hpp"

#include <array>
#include <cmath>
#include <cstdio>

namespace quadrille::compare {
namespace {

std::string number(const Row& value, const char* format) {
  if (value.is_null()) return {};
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_integer()) return std::to_string(value.get<std::int64_t>());
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), format, value.get<double>());
  return text.data();
}

std::string cell(const Row& row, const std::string& key) {
  const auto found = row.find(key);
  if (found == row.end() || found->is_null()) return "—";
  if (found->is_number_float()) {
    const double value = found->get<double>();
    if (value == 0) return "0";
    if (key == "ns_per_pixel") return number(*found, "%.3g");
    return number(*found, "%.1e");
  }
  return number(*found, "%.3g");
}

std::string joined(const Row& row, const std::vector<std::string>& keys) {
  std::string text;
  bool any = false;
  for (const std::string& key : keys) {
    const std::string value = cell(row, key);
    any = any || value != "—";
    text += (text.empty() ? "" : " / ") + value;
  }
  return any ? text : "—";
}

}  // namespace

std::string table_csv(const std::vector<Row>& rows) {
  std::string text;
  if (rows.empty()) return text;
  for (const auto& [key, value] : rows.front().items()) text += (text.empty() ? "" : ",") + key;
  text += "\n";
  for (const Row& row : rows) {
    bool first = true;
    for (const auto& [key, value] : row.items()) {
      if (!first) text += ",";
      first = false;
      text += tb::csv_cell(number(value, "%.9g"));
    }
    text += "\n";
  }
  return text;
}

std::string table_markdown(const std::vector<Row>& rows, const std::vector<int>& sizes, const std::string& reference) {
  struct Column {
    std::string title;
    std::vector<std::string> keys;
  };
  std::string at;
  std::vector<std::string> crease02, crease13, jump;
  for (const int size : sizes) {
    const std::string s = std::to_string(size);
    at += (at.empty() ? "" : " / ") + s;
    crease02.push_back("crease02_" + s);
    crease13.push_back("crease13_" + s);
    jump.push_back("jump_inside_" + s);
  }
  const std::vector<Column> columns{
      {"method", {"method"}},
      {"pixels", {"covered"}},
      {"missing / extra / undefined / wrong (more than 1e-3 from exact mean value)",
       {"missing", "extra", "undefined", "truth_wrong"}},
      {"from " + reference + ": max / p99.9 / RMS", {"reference_max", "reference_p999", "reference_rms"}},
      {"from exact mean value: max / p99.9 / RMS", {"truth_max", "truth_p999", "truth_rms"}},
      {"crease on 0–2 at " + at + " px", crease02},
      {"crease on 1–3 at " + at + " px", crease13},
      {"largest jump inside at " + at + " px", jump},
      {"gap between neighbours: max / RMS / pixels", {"gap_max", "gap_rms", "gap_pixels"}},
      {"quads / triangles set up / T-vertices", {"emitted_quads", "triangles", "t_vertices"}},
      {"quads given / refused / affine", {"quads", "refused", "affine"}},
      {"ns per pixel", {"ns_per_pixel"}},
  };
  std::string text, rule;
  for (const Column& column : columns) text += "| " + column.title + " ", rule += "|---";
  text += "|\n" + rule + "|\n";
  for (const Row& row : rows) {
    for (const Column& column : columns) text += "| " + joined(row, column.keys) + " ";
    text += "|\n";
  }
  return text;
}

}  // namespace quadrille::compare
