// What tests of `quadrille sweep` share: its tables.
#pragma once

#include "tb/commands/cli_fixture.hpp"

#include <nlohmann/json.hpp>

#include <map>

namespace quadrille::cli_test {

using nlohmann::json;

using Table = std::vector<std::map<std::string, std::string>>;

/// A CSV file whose quoted cells hold no line breaks.
inline Table table(const fs::path& file) {
  std::ifstream in(file);
  std::vector<std::string> names;
  Table rows;
  for (std::string line; std::getline(in, line);) {
    std::vector<std::string> cells{""};
    bool quoted = false;
    for (const char c : line) {
      if (c == '"')
        quoted = !quoted;
      else if (c == ',' && !quoted)
        cells.emplace_back();
      else
        cells.back() += c;
    }
    if (names.empty()) {
      names = cells;
      continue;
    }
    EXPECT_EQ(cells.size(), names.size());
    auto& row = rows.emplace_back();
    for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = cells[i];
  }
  return rows;
}

class SweepCli : public Cli {
 protected:
  static constexpr const char* small = " --scene fig10_concave --size 48x48 --cosim none ";
  /// How often each stage was executed.
  std::map<std::string, int> settings(const std::string& directory) const {
    std::map<std::string, int> out;
    for (const auto& row : table(file(directory) / "stages.csv")) out[row.at("stage")] = std::stoi(row.at("settings"));
    return out;
  }
  json manifest(const std::string& directory) const { return json::parse(read(file(directory) / "manifest.json")); }
};

}  // namespace quadrille::cli_test
