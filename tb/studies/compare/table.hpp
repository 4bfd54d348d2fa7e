// The figures of one comparison as table.json, table.csv and table.md.
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace quadrille::compare {

/// A flat object a method, the same keys in the same order; null: not measurable there.
using Row = nlohmann::ordered_json;

/// RFC 4180; numbers with 9 significant digits, null as an empty field.
std::string table_csv(const std::vector<Row>& rows);

/// The columns that a person compares, as a Markdown table; `wrong` pixels are off by more than 1e-3 from exact
/// mean value coordinates (keys truth_*), which the method mvc computes.
/// `sizes`: of the crease columns ("crease02_512").
std::string table_markdown(const std::vector<Row>& rows, const std::vector<int>& sizes, const std::string& reference);

}  // namespace quadrille::compare
