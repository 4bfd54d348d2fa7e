// quadrille export: its files and its refusals. scripts/export_test.py has tools read and simulate them.
#include "tb/commands/cli_fixture.hpp"

#include <nlohmann/json.hpp>

#include <set>

namespace {

using namespace quadrille::cli_test;
using nlohmann::json;

std::set<std::string> names_in(const fs::path& directory) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(directory)) names.insert(entry.path().filename().string());
  return names;
}

TEST_F(Cli, ExportWritesASelfContainedMachine) {
  const Outcome outcome =
      run("export --set attribute_slots=1 --set significand_bits=12 --prefix left --out ip --json r.json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::set<std::string> expected{"left.f",          "left.sdc",          "left.sv",   "left_response.hex",
                                       "left_states.hex", "left_stimulus.hex", "left_tb.sv"};
  EXPECT_EQ(names_in(file("ip")), expected);
  const std::string machine = read(file("ip/left.sv"));
  for (const std::string piece :
       {"\nmodule left (", "\nmodule left_sqrt", "\npackage left_tables_pkg;", "int SIGNIFICAND_BITS = 12;",
        "ATTRIBUTE_SLOTS /*verilator public*/ = 1;", "estimated", "// SPDX-License-Identifier"})
    EXPECT_NE(machine.find(piece), std::string::npos) << piece;
  for (const std::string piece : {"QUADRILLE_", "quadrille_pkg", "`include", "module quadrille"})
    EXPECT_EQ(machine.find(piece), std::string::npos) << piece;
  EXPECT_NE(read(file("ip/left_tb.sv")).find("module left_tb;"), std::string::npos);
  // The draw is one of many fragments, of all quads.
  const json report = json::parse(read(file("r.json")));
  EXPECT_EQ(report["files"].size(), expected.size());
  const std::string beats = read(file("ip/left_stimulus.hex")), fragments = read(file("ip/left_response.hex"));
  EXPECT_EQ(std::count(beats.begin(), beats.end(), '\n'), 4 * report["quads"].get<int>());
  EXPECT_EQ(std::count(fragments.begin(), fragments.end(), '\n'), report["fragments"].get<int>());
  EXPECT_GE(report["fragments"], 200);

  // A second machine stands beside the first, an older one of that name is replaced, and other files stay.
  ASSERT_EQ(run("export --prefix right --out ip --quiet").status, 0);
  write("ip/left.sv", "old");
  write("ip/own.sv", "own");
  ASSERT_EQ(run("export --set attribute_slots=1 --set significand_bits=12 --prefix left --out ip").status, 0);
  EXPECT_EQ(read(file("ip/left.sv")), machine);
  EXPECT_EQ(read(file("ip/own.sv")), "own");
  EXPECT_EQ(names_in(file("ip")).size(), 2 * expected.size() + 1);
}

TEST_F(Cli, ExportRefuses) {
  refuses(2, "export", {"--out DIR is missing", ""});
  refuses(2, "export --out ip.sv", {"--out", "ip.sv", "a folder", "such as ip"});
  refuses(2, "export --out ip --prefix Left", {"--prefix Left", "lower case"});
  refuses(2, "export --out ip --prefix 2d", {"--prefix 2d", "a letter or _ first"});
  refuses(2, "export --out ip --prefix small", {"--prefix small", "keyword"});
  refuses(2, "export --out ip --prefix ''", {"--prefix", "empty"});
  refuses(2, "export --out ip --set significand_bits=40", {"significand_bits"});
  EXPECT_FALSE(fs::exists(file("ip")));
  // Nothing is replaced when something cannot be.
  write("file", "");
  refuses(2, "export --out file", {"--out file", "cannot be written"});
  ASSERT_EQ(run("export --out ip --quiet").status, 0);
  const std::string before = read(file("ip/quadrille.sv"));
  fs::remove(file("ip/quadrille.f"));
  fs::create_directory(file("ip/quadrille.f"));
  refuses(2, "export --set significand_bits=12 --out ip", {"quadrille.f", "is a directory"});
  EXPECT_EQ(read(file("ip/quadrille.sv")), before);
}

}  // namespace
