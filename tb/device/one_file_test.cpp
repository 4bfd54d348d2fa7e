// The RTL as one text: a small source with everything that the rewriting has to tell apart. scripts/export_test.py has
// tools read the machine's.
#include "tb/device/one_file.hpp"

#include "tb/device/scratch.hpp"
#include "tb/support/environment_error.hpp"

#include <fstream>

namespace quadrille::tb {
namespace {

namespace fs = std::filesystem;

class OneFile : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(scratch_.path / "include");
    write("quadrille.f", "// a list\n+incdir+include\nquadrille_pkg.sv\nquadrille.sv\n");
    write("include/quadrille_show.svh",
          "`ifndef QUADRILLE_SHOW_SVH\n`define QUADRILLE_SHOW_SVH\n`ifdef YOSYS\n`define QUADRILLE_SHOW(x)\n`else\n"
          "`define QUADRILLE_SHOW(x) \\\n  $display(`\"x`\", x);\n`endif\n`endif\n");
    write("quadrille_pkg.sv",
          "// SPDX-License-Identifier: Apache-2.0\n// A macro for each key:\n//\n`ifndef QUADRILLE_DEPTH_BITS\n`define "
          "QUADRILLE_DEPTH_BITS "
          "99\n`endif\n"
          "package quadrille_pkg;\n  localparam int D = `QUADRILLE_DEPTH_BITS;\nendpackage\n");
    write("quadrille.sv",
          "`include \"quadrille_show.svh\"\n`include \"quadrille_show.svh\"\n// quadrille calls quadrille_unit\n"
          "module quadrille; /* \" */\n  logic u_quadrille_unit, my_quadrille;\n"
          "  initial $display(\"quadrille \\\"quadrille_pkg\", quadrille_pkg::D);  // `QUADRILLE_SHOW\n  initial "
          "`QUADRILLE_SHOW(1)\n"
          "`ifdef QUADRILLE_NEVER\n`ifdef YOSYS\n  gone\n`endif\n`elsif QUADRILLE_DEPTH_BITS\n  kept\n`else\n  "
          "gone\n`endif\n"
          "endmodule\n");
  }
  void write(const std::string& name, const std::string& text) const { std::ofstream(scratch_.path / name) << text; }
  std::string made() const {
    Config config;
    config.depth_bits = 16;
    return with_prefix(one_file(scratch_.path, config), "left");
  }
  std::string refusal() const {
    try {
      made();
    } catch (const SystemError& error) {
      return error.what();
    }
    return "nothing";
  }

  Scratch scratch_;
};

TEST_F(OneFile, WhatEachPieceBecomes) {
  EXPECT_EQ(made(),
            "package left_pkg;\n  localparam int D = 16;\nendpackage\n\n"
            "`ifdef YOSYS\n`define LEFT_SHOW(x)\n`else\n`define LEFT_SHOW(x) \\\n  $display(`\"x`\", x);\n`endif\n"
            "// quadrille calls left_unit\n"
            "module left; /* \" */\n  logic u_quadrille_unit, my_quadrille;\n"
            "  initial $display(\"quadrille \\\"left_pkg\", left_pkg::D);  // `LEFT_SHOW\n  initial `LEFT_SHOW(1)\n"
            "  kept\nendmodule\n\n`undef LEFT_SHOW\n");
}

TEST_F(OneFile, RefusesWhatItCannotRename) {
  write("quadrille_pkg.sv", "module sqrt; endmodule\n");
  EXPECT_NE(refusal().find("the module sqrt does not begin with quadrille_"), std::string::npos) << refusal();
  write("quadrille_pkg.sv", "\n`define SHOW(x) x\n");
  EXPECT_NE(refusal().find("quadrille_pkg.sv:2: the macro SHOW does not begin"), std::string::npos) << refusal();
  write("quadrille_pkg.sv", "`ifdef YOSYS\n`elsif QUADRILLE_SHOW\n`endif\n");
  EXPECT_NE(refusal().find("quadrille_pkg.sv:2: a condition"), std::string::npos) << refusal();
  write("quadrille_pkg.sv", "`ifdef YOSYS\n");
  EXPECT_NE(refusal().find("without `endif"), std::string::npos) << refusal();
  write("quadrille_pkg.sv", "`include \"none.svh\"\n");
  EXPECT_NE(refusal().find("cannot find \"none.svh\""), std::string::npos) << refusal();
  fs::remove(scratch_.path / "quadrille_pkg.sv");
  EXPECT_NE(refusal().find("cannot be read"), std::string::npos) << refusal();
}

TEST(Prefix, Faults) {
  for (const char* good : {"a", "_x", "left_2", "quadrille", "smaller"}) EXPECT_EQ(prefix_fault(good), "") << good;
  for (const char* bad : {"", "2x", "a-b", "Left", "a b", "é", "small", "table", "endmodule", "xor"})
    EXPECT_NE(prefix_fault(bad), "") << bad;
}

}  // namespace
}  // namespace quadrille::tb
